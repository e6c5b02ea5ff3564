"""Ratings of the gears of a drivetrain: by hand, against printed ones, and what is refused."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from math import cos, pi, radians, sqrt, tan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_drivetrain.cases.references.rated_gears import rated_meshes
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.dynamics.bodies.condensed_rungs import plain_rungs
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.machine import machine_of
from fe_drivetrain.dynamics.bodies.mesh_loads import MeshResponses
from fe_drivetrain.gear.load_factors import LoadFactors, face_factor, resonance_speed
from fe_drivetrain.studies.gear_levels import LoadSpread, Spread
from fe_drivetrain.studies.gear_machine import gear_train
from fe_drivetrain.studies.gear_meshes import gear_meshes
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.gear_ratings import GearsResult, gears
from fe_drivetrain.studies.gear_stresses import MeshStresses
from fe_drivetrain.studies.torque_classes import torque_classes
from fe_drivetrain.turbine_loads.histories.sites import Site

SMALL = """\
title: A small gearbox of one planetary stage, the same in all directions
rotor: {inertia: 1.0, mass: 1.0e-3}
shaft: {length: 0.5, torsion: 1.0e7}
gearbox:
  stages:
    - kind: planetary
      planets: 3
      teeth: {ring: 72, planet: 24, sun: 24}
      module: 0.01
      shifts: {ring: 0.0, planet: 0.0, sun: 0.0}
      tips: {ring: 0.706, planet: 0.26, sun: 0.26}
      centre_distance: 0.24
      face_width: 0.1
      stiffness_of: line
      cutter: 30
      carrier: {inertia: 1.0e-4, mass: 1.0e-3}
      planet: {inertia: 1.0e-5, mass: 1.0e-3}
      sun: {inertia: 1.0e-5, mass: 1.0e-3}
      ring_planet: 1.4e9
      sun_planet: 1.2e9
      pins:
        - {name: upwind, offset: -0.02, stiffness: [1.0e8, 1.0e9, 1.0e9, 0, 0, 0]}
        - {name: downwind, offset: 0.02, stiffness: [1.0e8, 1.0e9, 1.0e9, 0, 0, 0]}
      strength:
        gears:
          ring: {steel: through-hardened, contact_limit: 7.0e8, root_limit: 2.9e8,
                 yield_strength: 1.0e9, brinell: 240}
          planet: {steel: case-hardened, contact_limit: 1.5e9, root_limit: 4.3e8}
          sun: {steel: case-hardened, contact_limit: 1.5e9, root_limit: 4.3e8}
  shafts:
    - {name: HSS, length: 0.3, torsion: 1.0e6, kind: coupling}
  bearings:
    - {name: front, holds: main shaft, at: 0.1, stiffness: [1.0e8, 1.0e9, 1.0e9, 0, 1.0e6, 1.0e6]}
    - {name: carrier, holds: stage 1 carrier, stiffness: [1.0e8, 1.0e9, 1.0e9, 0, 1.0e6, 1.0e6]}
    - {name: sun, holds: stage 1 sun, stiffness: [1.0e8, 1.0e6, 1.0e6, 0, 1.0e5, 1.0e5]}
generator: {inertia: 10}
operation: {rated_power: 1.0e5, rotor_speed: [1.0, 2.0], lubricant: VG 320}
"""
TORQUE, SPEED = 5e4, 2.0  # N m, rad/s
FEW = {"azimuths": 6, "slices": 3}


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Drivetrain:
    return read_drivetrain(_file(tmp_path_factory.mktemp("gears")))


def _file(folder: Path, **changed: str) -> Path:
    text = SMALL
    for old, new in changed.items():
        assert old in text
        text = text.replace(old, new)
    (folder / "small.yaml").write_text(text)
    return folder / "small.yaml"


def _rated(drivetrain: Drivetrain, torque: float | None = None, **options: Any) -> GearsResult:
    return gears(drivetrain, torque, options=GearOptions(**{**FEW, **options}))


def test_planets_share_equally_where_nothing_is_uneven(small: Drivetrain) -> None:
    """No weight to speak of, bearings the same in all directions, spur teeth."""
    for level in ("rigid", "flexible"):
        found = _rated(small, level=level)
        for mesh in found.meshes.values():
            assert mesh.spread.share == pytest.approx(np.ones((6, 3)), abs=1e-6)
            assert mesh.spread.face == pytest.approx(np.ones((6, 3, 5)), abs=1e-6)
            assert mesh.balance == pytest.approx(1.0, rel=1e-9)
        teeth = found.gears["stage 1 ring"].life
        assert teeth is not None
        assert np.ptp(teeth.of_teeth) == pytest.approx(0.0, abs=1e-3 * teeth.of_teeth.max())


def test_force_and_contact_stress_of_a_pair_by_hand(small: Drivetrain) -> None:
    """Sun and planet: F_t of torque and radius, sigma_H0 by its formula, printed factors."""
    found = _rated(small)
    torque = TORQUE / (1.0 + 72.0 / 24.0) / 3.0  # of the sun, over three planets
    force = torque / 0.12  # 24 teeth of 10 mm
    mesh = found.meshes["stage 1 sun-planet"]
    assert mesh.torque == pytest.approx(torque, rel=1e-12)
    assert mesh.force == pytest.approx(force, rel=1e-12)
    tip, base = 0.13, 0.12 * cos(radians(20))
    reach = 2.0 * sqrt(tip**2 - base**2) - 0.24 * tan(radians(20)) * cos(radians(20))
    ratio = reach / (pi * 0.01 * cos(radians(20)))
    assert mesh.pair is not None
    assert mesh.pair.transverse_ratio == pytest.approx(ratio, rel=1e-9)
    Z_H = sqrt(2.0 / (cos(radians(20)) ** 2 * tan(radians(20))))
    Z_E, Z_epsilon = 189.812e3, sqrt((4.0 - ratio) / 3.0)
    nominal = Z_H * Z_E * Z_epsilon * sqrt(force / (0.24 * 0.1) * 2.0)
    # from the pitch point to the inner point of single contact, the same for equal gears
    from_end = sqrt(tip**2 - base**2) - pi * 0.01 * cos(radians(20))
    pitch = 0.12 * 2.0 * tan(radians(20)) * cos(radians(20)) / 2.0
    single = sqrt(pitch**2 / (from_end * (2.0 * pitch - from_end)))
    sun = found.gears["stage 1 sun"]
    assert sun.contact_stress == pytest.approx(nominal * max(single, 1.0), rel=1e-5)


@pytest.fixture(scope="module")
def printed() -> GearsResult:
    """The NREL 5 MW gearbox with the factors that a user of KISSsoft typed in."""
    torque = 5.0e6 / 1.2671  # of the electrical power, as that user typed it in
    return _rated(read_drivetrain("nrel_5mw"), torque=torque, level="torsional")


@pytest.mark.parametrize(
    ("mesh", "flanks"),
    [
        ("stage 1, sun and planet", ("stage 1 sun", "stage 1 planet, flank to sun")),
        ("stage 1, planet and ring", ("stage 1 planet, flank to ring", "stage 1 ring")),
        ("stage 2, sun and planet", ("stage 2 sun", "stage 2 planet, flank to sun")),
        ("stage 2, planet and ring", ("stage 2 planet, flank to ring", "stage 2 ring")),
        ("stage 3", ("stage 3 pinion", "stage 3 gear")),
    ],
)
def test_safeties_of_the_nrel_5mw_gears_are_those_that_kisssoft_prints(
    printed: GearsResult, mesh: str, flanks: tuple[str, str]
) -> None:
    """Two decimals; K_v of the file's inertias, and tooth heights as cut, change 0.5 % at most."""
    of = rated_meshes()[f"NREL 5 MW, {mesh}"].printed
    for number, name in enumerate(flanks):
        found = printed.gears[name]
        S_H, S_F = float(of["S_H"][number]), float(of["S_F"][number])
        assert found.contact_safety == pytest.approx(S_H, abs=0.005 + 0.005 * S_H), name
        assert found.root_safety == pytest.approx(S_F, abs=0.005 + 0.005 * S_F), name


def test_the_ring_lasts_as_long_as_kisssoft_prints(printed: GearsResult) -> None:
    """1005 h with S_H = 1.25, where K_v was typed in; half of the last digit, rounded shifts."""
    assert printed.gears["stage 1 ring"].life_hours == pytest.approx(1005.0, abs=1.0)
    assert printed.answer.verdict.endswith("lasts 1\u202f005\u00a0h.")
    assert printed.answer.status == "bad"


def test_damage_of_two_torques_by_hand(small: Drivetrain) -> None:
    """Hours at each over what the line from 5e7 to 1e10 loads endures, by Miner's rule."""
    torques, hours = (2.2e5, 1.9e5), (300.0, 900.0)
    name, loads = "stage 1 sun", 3.0 * 3.0  # planets, and turns against the carrier per turn
    fall = np.log(1.0 / 0.85) / np.log(1e10 / 5e7)
    expected = 0.0
    for torque, time in zip(torques, hours, strict=True):
        alone = _rated(small, torque, level="torsional", hours=time).gears[name]
        cycles = time * 3600.0 * SPEED / (2.0 * pi) * loads
        # stress endured at the knee, from what S_H says of these cycles before it
        first, static = 1e5, 1.6 * 1500e6
        assert alone.contact_safety is not None
        endured = alone.contact_safety * alone.contact_stress
        slope = np.log(cycles / first) / np.log(5e7 / first)
        knee = static * (endured / static) ** (1.0 / slope)
        stress = 1.25 * alone.contact_stress
        if stress <= knee:
            lasts = 5e7 * (knee / stress) ** (1.0 / fall)
        else:
            lasts = first * (static / stress) ** (np.log(5e7 / first) / np.log(static / knee))
        expected += cycles / lasts
    rows = list(zip(torques, hours, strict=True))
    options = GearOptions(**{**FEW, "level": "torsional"})
    found = gears(small, 2e5, options=options, spectrum=rows).gears[name]
    assert found.life is not None
    assert expected > 1e-3
    assert found.life.damage.flank == pytest.approx(expected, rel=1e-6)
    assert found.life_hours == pytest.approx(sum(hours) / expected, rel=1e-6)


def test_the_safety_over_a_spectrum_just_brings_failure(small: Drivetrain) -> None:
    """All stresses times that factor, which is the torque times its square, and damage is 1."""
    rows = [(2.2e5, 3000.0), (1.9e5, 9000.0)]
    options = GearOptions(**{**FEW, "level": "torsional"})
    first = gears(small, 2e5, options=options, spectrum=rows).gears["stage 1 sun"].life
    assert first is not None
    scale = (first.contact_safety / 1.25) ** 2
    more = [(scale * torque, time) for torque, time in rows]
    found = gears(small, 2e5, options=options, spectrum=more).gears["stage 1 sun"].life
    assert found is not None
    assert found.damage.flank == pytest.approx(1.0, rel=1e-3)


def test_a_negative_torque_uses_up_the_other_flank(small: Drivetrain) -> None:
    options = GearOptions(**{**FEW, "level": "torsional"})
    forth, back = (
        gears(small, 2e5, options=options, spectrum=[(sign * 2.2e5, 900.0)]) for sign in (1, -1)
    )
    for name in forth.gears:
        one, other = forth.gears[name].life, back.gears[name].life
        assert one is not None
        assert other is not None
        assert (one.damage.flank, one.damage.back) == (other.damage.back, other.damage.flank)
    assert any("Negative torques" in note for note in back.notes)


def test_a_moment_on_the_hub_loads_the_ends_of_the_face(small: Drivetrain) -> None:
    still = _rated(small, level="rigid")
    options = GearOptions(**{**FEW, "level": "rigid"})
    tilted = gears(small, options=options, hub={"My": 2e5})
    name = "stage 1 ring-planet"
    assert tilted.meshes[name].spread.face_load > 1.01 * still.meshes[name].spread.face_load
    ring = tilted.gears["stage 1 ring"].life
    assert ring is not None
    assert len(ring.of_teeth) == 6


def test_the_ladder_says_which_level_is_enough(small: Drivetrain) -> None:
    found = _rated(small)
    assert [one.name for one in found.levels] == ["torsional", "rigid bodies", "flexible shafts"]
    torsional = found.levels[0]
    assert torsional.factors["stage 1 sun-planet"] == (1.10, 1.0)
    # of equal planets the formula is sqrt(1.1) - 1 too high
    assert torsional.difference == pytest.approx(sqrt(1.1) - 1.0, abs=1e-6)
    assert found.enough == "torsional"
    assert _rated(small, tolerance=0.04).enough == "rigid bodies"


def test_what_is_not_stated_is_named_and_not_rated(tmp_path: Path) -> None:
    without = read_drivetrain(_file(tmp_path, **{", lubricant: VG 320": ""}))
    found = _rated(without)
    assert all(one.contact_safety is None for one in found.gears.values())
    assert "operation.lubricant" in found.notes[0]
    assert found.answer.verdict.startswith("The largest contact stress is ")
    assert _rated(without, lubricant=320.0).gears["stage 1 sun"].contact_safety is not None


def test_the_750kw_gears_have_stresses_and_no_safety() -> None:
    """Their materials are not public."""
    found = _rated(read_drivetrain("nrel_750kw"), 3.2e5, level="torsional", rotor_speed_rpm=22.0)
    assert all(one.contact_safety is None and one.life is None for one in found.gears.values())
    assert all(0.0 < one.contact_stress < 3e9 for one in found.gears.values())
    assert "strength of stage 1, stage 2, stage 3" in found.notes[0]


def test_gears_without_teeth_have_loads_alone() -> None:
    found = _rated(read_drivetrain("park_2021"), 1e6, level="rigid")
    assert not found.gears
    assert found.chart().figure["data"][0]["x"]
    assert "teeth, module, shifts of stage 1, stage 2, stage 3" in found.notes[0]
    assert found.meshes["stage 1 ring-planet"].spread.sharing >= 1.0


def _write(path: Path, torque: float, wind: float, tail: str = "") -> None:
    rows = [
        f"{0.5 * k},0,0,0,{torque},0,0,19.0985932,{wind + 0.1 * (k % 3 - 1)}" for k in range(60)
    ]
    head = "time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m],rotor speed [rpm],"
    path.write_text("\n".join([f"{head}wind speed [m/s]", *rows, tail]).strip() + "\n")


def test_files_make_the_spectrum_and_a_site_weights_them(small: Drivetrain, tmp_path: Path) -> None:
    """At the site each wind has its share of twenty years, and its own torque."""
    _write(tmp_path / "a.csv", 1.9e5, 8.0)
    _write(tmp_path / "b.csv", 2.2e5, 12.0)
    site = Site(mean_wind=8.5)
    options = GearOptions(**{**FEW, "level": "torsional"})
    found = gears(small, 2e5, str(tmp_path / "*.csv"), site, options)
    assert found.spectrum is not None
    hours = site.hours([6.0, 10.0, 14.0])
    assert found.spectrum.torques == pytest.approx([1.9e5, 2.2e5])
    assert found.spectrum.seconds / 3600.0 == pytest.approx(hours)
    assert found.spectrum.turns == pytest.approx(3600.0 * hours * SPEED / (2.0 * pi), rel=1e-6)
    rows = list(zip((1.9e5, 2.2e5), hours.tolist(), strict=True))
    stated = gears(small, 2e5, options=options, spectrum=rows)
    for name, one in found.gears.items():
        life, other = one.life, stated.gears[name].life
        assert life is not None
        assert other is not None
        assert life.damage.flank == pytest.approx(other.damage.flank, rel=1e-5)
        assert one.life_hours == pytest.approx(20.0 * 8760.0 / life.damage.largest)
    assert found.hours == 20.0 * 8760.0
    again = gears(small, 2e5, str(tmp_path / "*.csv"), site, options, resume=True)
    assert again.spectrum is not None
    assert again.spectrum.turns == pytest.approx(found.spectrum.turns, rel=1e-15)


def test_a_measured_torque_alone_is_enough(small: Drivetrain, tmp_path: Path) -> None:
    """The sharing is that of the rotor's weight, and turns are as those of all six loads."""
    rows = [f"{0.5 * k},{2.2e5},19.0985932" for k in range(60)]
    head = "time [s],Mx [N m],rotor speed [rpm]"
    (tmp_path / "torque.csv").write_text("\n".join([head, *rows]) + "\n")
    _write(tmp_path / "all.csv", 2.2e5, 8.0)
    options = GearOptions(**{**FEW, "level": "torsional"})
    alone, whole = (
        gears(small, 2e5, tmp_path / name, options=options) for name in ("torque.csv", "all.csv")
    )
    assert alone.notes[0].startswith("Files have the torque without all other loads")
    for name, one in alone.gears.items():
        life, other = one.life, whole.gears[name].life
        assert life is not None
        assert other is not None
        assert life.damage.flank == pytest.approx(other.damage.flank, rel=1e-6)


def test_a_file_of_what_turns_alone_has_ratings_by_formula(tmp_path: Path) -> None:
    """Without the rotor's mass there are no statics in three dimensions."""
    file = _file(tmp_path, **{"rotor: {inertia: 1.0, mass: 1.0e-3}": "rotor: {inertia: 1.0}"})
    found = _rated(read_drivetrain(file))
    assert found.level == "torsional"
    assert [one.name for one in found.levels] == ["torsional"]
    assert "rotor: mass" in found.notes[0]
    with pytest.raises(InputError, match="rotor: mass"):
        _rated(read_drivetrain(file), level="rigid")


def test_moments_of_files_are_moved_to_where_loads_enter(tmp_path: Path) -> None:
    """From a metre upwind of the shaft's front: M + r x F with r = (-1, 0, 0) m."""
    scene = read_drivetrain("nrel_5mw", {"hub.loads_at": -1.333})
    _write(tmp_path / "a.csv", 4e6, 8.0)
    text = (tmp_path / "a.csv").read_text().replace(",0,0,0,4000000.0", ",0,0,-1e6,4000000.0")
    (tmp_path / "a.csv").write_text(text)
    options = GearOptions(**{**FEW, "level": "torsional"})
    found = gears(scene, loads=tmp_path / "a.csv", options=options)
    assert found.hub == pytest.approx([0.0, 0.0, -1e6, 0.0, -1e6, 0.0])


def test_the_command_writes_a_page_and_tables(
    tmp_path: Path, invoke: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = _file(tmp_path)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "spectrum.csv").write_text("torque [kNm],time [h]\n220,300\n190,900\n")
    words = ("--spectrum", "spectrum.csv", "--torque", "2e5", "--azimuths", "6", "--slices", "3")
    status, out, _ = invoke("gears", str(file), *words, "--json", "--out", "found")
    assert status == 0
    plain = json.loads(out)
    assert plain["schema"] == "fe-drivetrain/gears/1"
    assert len(plain["answer"]["verdict"].split(" ")) <= 25
    assert {row["gear"] for row in plain["tables"]["gears"]} == {
        "stage 1 sun",
        "stage 1 planet, flank to sun",
        "stage 1 planet, flank to ring",
        "stage 1 ring",
    }
    written = {path.name for path in (tmp_path / "found").glob("*.csv")}
    assert {"gears.csv", "meshes.csv", "levels.csv", "sharing.csv", "face.csv"} <= written
    assert (tmp_path / "found" / "report.html").exists()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--torque", "-3"), "torque of the rotor is -3 N m but must be above 0"),
        (("--site", "II"), "--site weights files of hub loads: give --loads, too"),
        (("--level", "solid"), "no level 'solid': use one of torsional, rigid, flexible"),
        (("--azimuths", "7"), "azimuths is 7 but must be even"),
        (("--slices", "1"), "slices is 1 but must be a whole number from 3"),
        (("--hours", "0"), "hours is 0 h but must be above 0"),
        (("--load", "hub.Mx=1"), "--load 'hub.Mx' is unknown"),
        (("--lubricant", "thick"), "--lubricant thick: give a grade"),
        (("--spectrum", "none.csv"), "none.csv"),
        (("--spectrum", "backwards.csv"), "has a speed of -12 1/min but must have one from 0 to"),
        (("--loads", "none.csv"), "none.csv"),
    ],
)
def test_a_mistake_ends_with_one_sentence_and_leaves_nothing(
    tmp_path: Path,
    invoke: Any,
    monkeypatch: pytest.MonkeyPatch,
    words: tuple[str, ...],
    sentence: str,
) -> None:
    file = _file(tmp_path)
    monkeypatch.chdir(tmp_path)
    table = "torque [kNm],time [h],rotor speed [rpm]\n200,100,-12\n"
    (tmp_path / "backwards.csv").write_text(table)
    status, _, error = invoke("gears", str(file), *words, "--out", "found")
    assert status == 2
    assert sentence in error
    assert not (tmp_path / "found").exists()


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        ({"operation: {rated_power: 1.0e5,": "operation: {"}, "states no torque: give generator"),
        (
            {"          ring: {steel: t": "          wheel: {steel: t"},
            "has the gears wheel, planet",
        ),
    ],
)
def test_a_file_that_lacks_what_is_needed_is_refused(
    tmp_path: Path, changed: Mapping[str, str], sentence: str
) -> None:
    with pytest.raises(InputError, match=sentence):
        _rated(read_drivetrain(_file(tmp_path, **changed)))


def test_arguments_that_contradict_each_other_are_refused(small: Drivetrain) -> None:
    with pytest.raises(InputError, match="is no load of the hub beside its torque"):
        gears(small, hub={"Mx": 1.0})
    with pytest.raises(InputError, match="has no class"):
        gears(small, spectrum=[])
    with pytest.raises(InputError, match="class 1 of the torque spectrum is"):
        gears(small, spectrum=[(1e5, -1.0)])
    with pytest.raises(InputError, match="lasts 0 h"):
        gears(small, spectrum=[(1e5, 0.0)])


BY_FORMULA = {
    f"gearbox.stages.{k}.strength.{key}": None for k in range(3) for key in ("face_load", "dynamic")
}
"""The NREL 5 MW gears with K_Hbeta and K_v by their accuracy grade."""


@pytest.mark.parametrize("application", [1.0, 1.25])
@pytest.mark.parametrize("share", [0.05, 0.5, 1.0])
def test_a_turning_gear_without_torque_is_not_stressed_more(
    share: float, application: float
) -> None:
    """K_v and K_Hbeta grow without bound as the torque falls; the stress falls all the same.

    Up to 0.5 times its resonance at any torque a gear is in one range of K_v, which jumps between
    ranges.
    """
    drivetrain = read_drivetrain("nrel_5mw", BY_FORMULA)
    train = gear_train(drivetrain, GearOptions(), None)
    meshes, _ = gear_meshes(train.machine, train.strengths)
    assert train.conditions.speed is not None
    speed = share * train.conditions.speed
    torques = train.torque * np.geomspace(1e-6, 2.0, 120)
    for mesh in meshes.values():
        own = MeshStresses(mesh, train.conditions)
        teeth = abs(mesh.pair.first.teeth)
        first = resonance_speed(mesh.stiffness.mesh, mesh.mass, teeth)
        assert speed * mesh.speed_ratio < 0.5 * first
        stresses = []
        for torque in torques.tolist():
            sharing, face = own.formula(torque, speed, application)
            start = LoadFactors(application, sharing, 1.0, face)
            stresses.append(own.contact(torque, own.factors(torque, speed, start).contact))
        assert (np.diff(np.array(stresses)[:, 0]) > 0.0).all(), mesh.name


def test_the_face_load_factor_is_that_of_all_load_factors_before_it() -> None:
    """F_m = F_t K_A K_gamma K_v, by hand from the factors of the answer."""
    drivetrain = read_drivetrain("nrel_5mw", BY_FORMULA)
    found = gears(drivetrain, options=GearOptions(**{**FEW, "level": "torsional"}))
    train = gear_train(drivetrain, GearOptions(), None)
    meshes, _ = gear_meshes(train.machine, train.strengths)
    for name, mesh in meshes.items():
        answer, K = found.meshes[name], found.meshes[name].factors
        assert mesh.deviations is not None
        load = answer.force * K.K_A * K.K_gamma * K.K_v / mesh.pair.face_width
        exact = face_factor(mesh.deviations[2], mesh.stiffness.misaligned, load)
        assert K.K_v > 1.0
        assert K.K_Hbeta == pytest.approx(exact, rel=1e-12)


def test_a_planet_that_hardly_carries_makes_no_face_load_factor() -> None:
    """K_gamma K_Hbeta is the largest load of any place, over the mean of all planets."""
    share = np.array([[1.9, 1.0, 0.1]])
    face = np.array([[[1.2, 0.8], [1.0, 1.0], [1.9, 0.1]]])
    spread = Spread(np.zeros(1), share, face)
    assert spread.sharing * spread.face_load == pytest.approx(1.9 * 1.2)


def test_a_mesh_that_carries_nothing_has_no_spread(small: Drivetrain) -> None:
    """As where a torque is round-off of the weights beside it."""
    machine = machine_of(small)
    rung = plain_rungs(small, machine)[-1]
    spread = LoadSpread(machine, {}, rung, 2, 3, True, TORQUE)
    found = spread.statics(TORQUE, np.zeros(6))
    assert found is not None
    none = replace(found, slices={name: 0.0 * of for name, of in found.slices.items()})
    with pytest.raises(InputError, match=r"torque of the rotor of 50000 N m .* a larger torque"):
        spread.spread(none, TORQUE, SPEED)


@pytest.mark.parametrize(
    ("row", "sentence"),
    [
        ((2e5, 1.0, -2.0), "speed of -19.1 1/min but must have one from 0 to 38.2 1/min"),
        ((2e5, 1.0, 20.0), "speed of 191 1/min but must have one from 0 to 38.2 1/min"),
        ((1e13, 1.0), "torque of 1e\\+13 N m but must be below 1e\\+12 N m"),
    ],
)
def test_classes_of_a_spectrum_are_within_reach_of_the_rotor(
    small: Drivetrain, row: tuple[float, ...], sentence: str
) -> None:
    with pytest.raises(InputError, match=f"class 2 of the torque spectrum has a {sentence}"):
        gears(small, spectrum=[(2e5, 1.0, 3.9), row])


def test_without_a_rated_speed_a_spectrum_states_speeds_that_are_not_negative() -> None:
    with pytest.raises(
        InputError, match=r"of -1\.91 1/min but must have one from 0 to 954.9 1/min"
    ):
        torque_classes([(2e5, 1.0, -0.2)], None)
    with pytest.raises(InputError, match="no speed of the rotor is known"):
        torque_classes([(2e5, 1.0)], None)
    assert torque_classes([(-2e5, 1.0, 0.3)], None) == [(-2e5, 1.0, 0.3)]


@pytest.mark.parametrize("key", ["gearbox.stages.2.stiffness", "gearbox.stages.0.ring_planet"])
def test_the_stiffest_that_a_file_may_state_is_as_good_as_rigid(key: str) -> None:
    """Beyond it statics would take other springs for none, and said that something moves freely."""
    with pytest.raises(InputError, match="1e\\+20 but must be at most 1e\\+16"):
        read_drivetrain("nrel_5mw", {key: 1e20})
    sums = []
    for stiffness in (1e13, 1e16):
        machine = machine_of(read_drivetrain("nrel_5mw", {key: stiffness}))
        loads = MeshResponses(machine, Level.FLEXIBLE, 1, 3).under(4e6)
        sums.append([one.sum() for one in loads.slices.values()])
    np.testing.assert_allclose(sums[1], sums[0], rtol=3e-8)


@pytest.mark.parametrize(("share", "said"), [(1.0, False), (0.03, True)])
def test_a_large_dynamic_factor_is_named_beside_statics(share: float, said: bool) -> None:
    drivetrain = read_drivetrain("nrel_5mw", BY_FORMULA)
    options = GearOptions(level="rigid", azimuths=4, slices=3)
    found = gears(drivetrain, share * 4.18e6, options=options)
    assert (found.meshes["stage 3 mesh"].factors.K_v > 1.5) == said
    assert any("K_v of stage 3 mesh is" in note for note in found.notes) == said
