"""Gears and bearings in time: damage by hand, by ratings and lives of the same loads, limits."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from answer_rules import broken_rules
from numpy.testing import assert_allclose
from small_drivetrain import TORQUE, two_masses

from fe_drivetrain.bearing_life.coupled.reaction_paths import damage_of_forces
from fe_drivetrain.command_line import main
from fe_drivetrain.common.array_records import as_arrays, from_arrays
from fe_drivetrain.common.components import FORCES, GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file import Scene, read_drivetrain
from fe_drivetrain.dynamics.bodies.advice import RUNGS
from fe_drivetrain.dynamics.bodies.bearing_reactions import BearingModel
from fe_drivetrain.dynamics.bodies.condensed_rungs import plain_rungs
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.machine import machine_of
from fe_drivetrain.gear.load_factors import LoadFactors
from fe_drivetrain.gear.rating import contact_stress
from fe_drivetrain.report.results import read_results
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies import (
    DamageOptions,
    GearOptions,
    LifeOptions,
    TransientResult,
    gears,
    life,
    life_events,
    loads,
    transient,
)
from fe_drivetrain.studies.gear_machine import gear_train
from fe_drivetrain.studies.gear_meshes import gear_meshes
from fe_drivetrain.studies.gear_spectra import TorqueSpectrum
from fe_drivetrain.studies.gear_stresses import MeshStresses
from fe_drivetrain.studies.part_bearings import counted_parts
from fe_drivetrain.studies.part_damage import PartUse, times_a_year
from fe_drivetrain.studies.part_gears import GearUses
from fe_drivetrain.studies.part_loads import PartDigest
from fe_drivetrain.studies.transient_events import rated_of
from fe_drivetrain.studies.transient_parts import part_figures
from fe_drivetrain.studies.turning_model import TurningModel
from fe_drivetrain.studies.turning_quantities import turning_quantities
from fe_drivetrain.turbine_loads.histories.sites import Site

SOFT = {
    f"gearbox.stages.2.strength.gears.{gear}.{limit}": value
    for gear in ("pinion", "gear")
    for limit, value in (("contact_limit", 6.1e8), ("root_limit", 1.0e8))
}
"""Steels of the last stage that rated torque damages, and that half of it does, too."""

WHOLE = read_drivetrain("nrel_5mw", SOFT)
MACHINE, RATED = machine_of(WHOLE), rated_of(WHOLE)
STEADY = {"depth": 0.0, "start": 0.05}
PINION = abs(MACHINE.speeds[3])


@pytest.fixture(scope="module")
def steady() -> TransientResult:
    """A second at rated torque, bodies only turn."""
    return transient(WHOLE, "dip", STEADY, level="torsional", duration=1.0, step=5e-3)


@pytest.fixture(scope="module")
def carried() -> TransientResult:
    """A fifth of a second at rated torque with forces of bearings and all rollers."""
    damage = DamageOptions(rollers=True)
    return transient(WHOLE, "dip", STEADY, level="rigid", duration=0.2, step=2e-2, damage=damage)


def last_mesh() -> MeshStresses:
    train = gear_train(WHOLE, GearOptions(level="torsional"), RATED.torque)
    meshes, _ = gear_meshes(train.machine, train.strengths)
    return MeshStresses(meshes["stage 3 mesh"], train.conditions)


def test_a_constant_torque_does_the_damage_of_its_turns_by_hand(steady: TransientResult) -> None:
    """Stress by ISO 6336 at the pinion's torque, its teeth loaded once in each of its turns."""
    mesh = last_mesh()
    K = mesh.factors(RATED.torque, RATED.rotor_speed, LoadFactors(K_Hbeta=1.15))
    nominal = contact_stress(
        mesh.mesh.pair, RATED.torque / PINION, LoadFactors(), mesh.mesh.materials
    )
    stress = nominal.nominal * nominal.Z_BD[0] * np.sqrt(K.K_v * 1.15 * K.K_Halpha)
    curves = mesh.curves(RATED.torque)
    assert curves is not None
    turns = RATED.rotor_speed * PINION / (2.0 * np.pi)
    known = turns / curves[0].contact.endured([1.25 * stress])[0]
    assert steady.parts is not None
    found = steady.parts.gears["stage 3 pinion"]
    assert known > 0.0
    assert_allclose(found.damage.flank, known, rtol=1e-6)
    assert found.damage.back == 0.0
    # at the peak, which is the rated torque, by the static end of the curve
    assert_allclose(found.contact_safety, curves[0].contact.stresses[0] / stress, rtol=1e-6)


def test_a_constant_torque_does_the_damage_of_a_rating_by_its_hours(
    steady: TransientResult,
) -> None:
    hours = 1.0 / 3600.0
    rated = gears(WHOLE, spectrum=[(RATED.torque, hours)], options=GearOptions(level="torsional"))
    assert steady.parts is not None
    assert len(steady.parts.gears) == 10
    for name, one in steady.parts.gears.items():
        life_of = rated.gears[name].life
        assert life_of is not None
        assert_allclose(one.damage.flank, life_of.damage.flank, rtol=1e-6, err_msg=name)
        assert_allclose(one.damage.root, life_of.damage.root, rtol=1e-6, err_msg=name)


def digest_of(torque: float, turns: float) -> PartDigest:
    """Turns of the rotor at a torque, in all meshes."""
    names = [f"stage {k} {m}-planet" for k in (1, 2) for m in ("sun", "ring")] + ["stage 3 mesh"]
    seconds = 2.0 * np.pi * turns / RATED.rotor_speed
    spectrum = TorqueSpectrum(
        RATED.torque / 40,
        np.array([torque]),
        np.array([seconds]),
        np.array([turns]),
        np.zeros((1, 6)),
    )
    both = (max(torque, 0.0), min(torque, 0.0))
    return PartDigest(seconds, dict.fromkeys(names, spectrum), dict.fromkeys(names, both), {})


def test_levels_of_torque_add_up_and_a_reversed_one_loads_the_other_flank() -> None:
    uses = GearUses(gear_train(WHOLE, GearOptions(), RATED.torque), RUNGS[0])
    high, low, back = (digest_of(share * RATED.torque, 10.0) for share in (1.2, 0.8, -0.8))
    alone = [uses.under([one], [1.0], None)["stage 3 pinion"] for one in (high, low, back)]
    both = uses.under([high, low, back], [3.0, 5.0, 7.0], None)["stage 3 pinion"]
    assert alone[1].damage.flank > 0.0
    assert_allclose(
        both.damage.flank, 3 * alone[0].damage.flank + 5 * alone[1].damage.flank, rtol=1e-9
    )
    # the same torque of the other sense does the same to the other flank and side of the root
    assert_allclose(both.damage.back, 7 * alone[1].damage.flank, rtol=1e-9)
    assert_allclose(both.damage.root_back, 7 * alone[1].damage.root, rtol=1e-9)
    assert alone[2].damage.flank == 0.0
    assert both.of_histories == tuple(one.damage.largest for one in alone)


def test_a_loss_of_the_grid_counted_sample_by_sample() -> None:
    """Torque and speed of the last mesh over time, its load factors being constant."""
    plain = read_drivetrain("nrel_5mw", {**SOFT, "gearbox.stages.2.strength.grade": None})
    found = transient(plain, "grid_loss", {"off": 0.5}, level="torsional", duration=4.0)
    assert found.parts is not None
    use, samples = found.parts.gears["stage 3 pinion"], found.samples
    mesh = last_mesh()
    curves = mesh.curves(RATED.torque)
    assert curves is not None
    share = samples.of("force of stage 3 mesh")[1:] / found.extremes["force of stage 3 mesh"].rated
    stress = 1.25 * mesh.contact(RATED.torque * share, 1.15)[:, 0]
    turns = samples.of("speed of stage 3 pinion")[1:] * np.diff(samples.times) / (2.0 * np.pi)
    each = turns / curves[0].contact.endured(stress)
    assert (share < 0.0).any()
    for known, counted in (
        (each[share > 0.0].sum(), use.damage.flank),
        (each[share < 0.0].sum(), use.damage.back),
    ):
        assert known > 0.0
        # classes of a fortieth of the torque: a power p of it moves by p (p - 1) / 24 / 40^2
        assert_allclose(counted, known, rtol=5e-3)
    assert_allclose(use.peak, RATED.torque * np.abs(share).max(), rtol=1e-9)
    assert 0.0 < use.band < 0.1 * use.damage.largest


def test_bearings_have_the_damage_of_the_forces_that_statics_give_them(
    carried: TransientResult,
) -> None:
    """At rated torque forces are those of statics at the same azimuth, and speeds kinematic."""
    model = BearingModel(MACHINE, Level.RIGID, flexible=carried.chosen.rung.flexible)
    hub = np.array([0.0, 0.0, -GRAVITY * MACHINE.rotor.apart[0], RATED.torque, 0.0, 0.0])
    counted, unnamed = counted_parts(WHOLE, MACHINE, LifeOptions(), False)
    assert "INP-A" in unnamed
    assert carried.parts is not None
    assert list(carried.parts.bearings) == [one.name for one in counted.bearings]
    for one in counted.bearings:
        of = model.reactions(of=[one.name])[one.name]
        # bearings of the housing at the first azimuth; planets at all, as they come by
        loads = of.under(hub[None])[0]
        loads = loads if of.planets else loads[:1]
        rpm = of.speed_ratio * RATED.rotor_speed * 30.0 / np.pi
        known = damage_of_forces(one.rated, loads, rpm, 0.2 / len(loads), one.rules)
        use = carried.parts.bearings[one.name]
        near = 2e-2 if of.planets else 1e-6
        for kind, damage in known.totals.items():
            assert damage > 0.0
            assert_allclose(use.damage[kind], damage, rtol=near, err_msg=f"{one.name} {kind}")
        assert_allclose(use.turns, rpm * 0.2 / 60.0, rtol=1e-6)
        assert_allclose(use.static_safety, known.limits.static_safety, rtol=near)


def test_what_was_counted_is_kept_whole(carried: TransientResult) -> None:
    parts = carried.chosen.parts
    assert parts is not None
    again = from_arrays(PartDigest, as_arrays(parts))
    assert list(again.bearings) == list(parts.bearings)
    for name, one in parts.meshes.items():
        assert_allclose(again.meshes[name].turns, one.turns, rtol=0)
        assert again.peaks[name] == parts.peaks[name]
    one, other = (each.bearings["PLC-B"] for each in (parts, again))
    assert one.rollers is not None
    assert other.rollers is not None
    assert other.rollers.totals == one.rollers.totals
    assert other.static_load == one.static_load


def test_what_is_left_out_is_named(steady: TransientResult, carried: TransientResult) -> None:
    assert any("PLC-A, PLC-B, stage 1 pin upwind" in note for note in steady.notes)
    assert any("want of a catalogue entry: INP-A, INP-B" in note for note in carried.notes)
    without = two_masses()
    assert transient(without, "grid_loss", duration=1.2).parts is not None
    assert transient(without, "grid_loss", duration=1.2, damage=None).parts is None
    dry = read_drivetrain("nrel_5mw", {"operation.lubricant": None})
    found = transient(dry, "dip", STEADY, level="torsional", duration=0.1, step=5e-3)
    assert found.parts is not None
    assert not found.parts.gears
    assert "operation.lubricant not stated" in found.parts.left_out[0]


def test_histories_are_weighted_as_years_or_by_winds_of_a_site() -> None:
    year = 8760.0 * 3600.0
    assert times_a_year([600.0, 300.0], [9.0, np.nan], None, []) == [year / 900.0] * 2
    site, files = Site(8.5), [Path("a"), Path("b"), Path("c")]
    found = np.array(times_a_year([600.0, 600.0, 300.0], [8.1, 11.9, 7.9], site, files))
    low, high = site.shares([6.0, 10.0, 14.0])
    assert_allclose(found, [low * year / 900.0, high * year / 600.0, low * year / 900.0])
    with pytest.raises(InputError, match="there is no wind speed"):
        times_a_year([600.0, 600.0], [8.0, np.nan], site, files)


def test_operation_is_damage_of_a_year(tmp_path: Path) -> None:
    """Half of the time at rated torque, half at 0.8 of it, in two files."""
    time = np.arange(0.0, 4.01, 0.02)
    for name, share in (("a", 1.0), ("b", 0.8)):
        torque = np.full(len(time), share * RATED.torque)
        table = np.column_stack([time, torque, np.full(len(time), RATED.rotor_speed)])
        header = "time [s],Mx [N m],rotor speed [rad/s]"
        path = tmp_path / f"{name}.csv"
        np.savetxt(path, table, delimiter=",", header=header, comments="", fmt="%.9g")
    found = transient(WHOLE, "operation", loads=tmp_path, level="torsional")
    assert found.parts is not None
    hours = 8760.0 / 2.0
    spectrum = [(RATED.torque, hours), (0.8 * RATED.torque, hours)]
    rated = gears(WHOLE, spectrum=spectrum, options=GearOptions(level="torsional"))
    known = rated.gears["stage 3 pinion"].life
    assert known is not None
    one = found.parts.gears["stage 3 pinion"]
    assert_allclose(one.damage.flank, known.damage.flank, rtol=1e-2)
    assert one.of_histories[0] > one.of_histories[1] > 0.0
    assert [row["file"] for row in found.tables["file_damage"]] == ["a", "b"]


@pytest.mark.parametrize(("damage", "status"), [(0.3, "none"), (3.0, "bad"), (np.inf, "bad")])
def test_a_life_that_ends_within_a_year_or_an_event_is_beyond(
    carried: TransientResult, damage: float, status: str
) -> None:
    """A page whose bearing lasts four months is not within all limits."""
    assert carried.parts is not None
    worn = replace(carried.parts.bearings["PLC-B"], damage={"L10": damage})
    use = PartUse("year", 1.0, bearings={"PLC-B": worn})
    (figure, _) = part_figures(Findings(), use)
    assert figure.name == "damage of PLC-B, each year"
    assert figure.status == status


def test_a_catalogue_of_ones_own_leaves_the_quantities_of_all_else() -> None:
    """Nobody can give `advise` one: a bearing of it has no damage there, gears still do."""
    own = read_drivetrain("nrel_5mw", {**SOFT, "gearbox.bearings.1.catalogue": "my_own"})
    assert isinstance(own, Scene)
    name = own.gearbox.bearings[1].name
    lost = set(turning_quantities(WHOLE)) - set(turning_quantities(own))
    assert lost
    assert all(f".{name}." in one for one in lost)
    with pytest.raises(InputError, match="my_own"):
        counted_parts(own, machine_of(own), LifeOptions(), False)
    assert name in counted_parts(own, machine_of(own), LifeOptions(), False, strict=False)[1]


def test_quantities_are_those_of_events_and_lives(
    carried: TransientResult, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    known = turning_quantities(WHOLE)
    assert {"transient.stop.stage 3 mesh.damage", "transient.offset.PLC-B.S0"} <= set(known)
    model = TurningModel(WHOLE, plain_rungs(WHOLE, MACHINE)[-1])
    model._parts["dip"] = carried.parts
    assert carried.parts is not None
    use = carried.parts.bearings["PLC-B"]
    assert known["transient.dip.PLC-B.damage"].of(model) == use.damage["L10"]
    assert known["transient.dip.PLC-B.S0"].of(model) == use.static_safety
    worst = carried.parts.of_mesh("stage 1 ring-planet")
    assert worst is not None
    assert worst.damage.largest > 0.0
    mesh = known["transient.dip.stage 1 ring-planet.damage"]
    assert mesh.value(model) == worst.damage.largest
    # soft teeth under the load along their face that rigid bodies have yield at once
    with pytest.raises(InputError, match="is infinite at the level"):
        known["transient.dip.stage 3 mesh.damage"].value(model)
    # the life is that of `life` with the same constant loads
    hub = np.array([0.0, 0.0, -GRAVITY * MACHINE.rotor.apart[0], RATED.torque, 0.0, 0.0])
    units = 3 * ["N"] + 3 * ["N m"]
    head = ["time [s]", *(f"{n} [{u}]" for n, u in zip(FORCES, units, strict=True))]
    time = np.arange(0.0, 4.0, 0.5)
    table = np.column_stack([time, np.tile(hub, (len(time), 1))])
    path = tmp_path / "constant.csv"
    np.savetxt(path, table, delimiter=",", header=",".join(head), comments="", fmt="%.12g")
    rpm = RATED.rotor_speed * 30.0 / np.pi
    options = LifeOptions(rotor_speed_rpm=rpm, only="stage 1 pin upwind")
    monkeypatch.setattr(life_events, "transient", lambda *_, **__: carried)
    lived = life(WHOLE, path, options=options, events={"dip": 1e3})
    years = lived.bearings["stage 1 pin upwind"].years
    for kind in ("L10", "L10mr"):
        value = known[f"life.stage 1 pin upwind.{kind}"].value(model)
        assert_allclose(value, years[kind], rtol=1e-6)
        # a thousand events a year beside it: rates of damage add up
        once = carried.parts.bearings["stage 1 pin upwind"].damage[kind]
        with_all = lived.with_events["stage 1 pin upwind"][kind]
        assert_allclose(1.0 / with_all, 1.0 / years[kind] + 1e3 * once, rtol=1e-9)
    assert lived.answer.figures[0].name == "L10mr of bearing stage 1 pin upwind with events"
    for events, said in (({"halt": 1.0}, "halt"), ({"dip": 0.0}, "comes 0 times a year")):
        with pytest.raises(InputError, match=said):
            life(WHOLE, path, options=options, events=events)


def test_peaks_are_held_against_limits_of_the_file() -> None:
    asked: dict[str, Any] = {"level": "torsional", "duration": 2.0}
    values = {"off": 0.1, "braked": 0.5, "pitched": 0.2, "brake": 2.0}
    for share, status, words in (
        (1.05, "bad", ", beyond the limit of the shaft."),
        (9.0, "good", ""),
    ):
        limits = {"peak_torque": {"shaft": share * TORQUE}}
        found = transient(two_masses(limits=limits), "stop", values, **asked)
        (figure,) = [one for one in found.answer.figures if one.name == "peak torque of shaft"]
        assert figure.status == status
        assert_allclose(figure.limit, share * TORQUE / 1e3)
        peak = max(abs(v) for v in (found.extremes["torque of shaft"].most, 0.0))
        assert figure.value >= peak / 1e3 * (1.0 - 1e-9)
        assert found.answer.verdict.endswith(words)
        (row,) = [r for r in found.tables["extremes"] if r["channel"] == "torque of shaft"]
        assert_allclose(row["peak over its limit"] * share * TORQUE / 1e3, figure.value)
        assert any("Beyond limits of the file" in note for note in found.notes) == bool(words)


def test_a_limit_that_another_instant_of_the_brake_passes_is_in_the_verdict() -> None:
    """The peak itself is within it; the figure of all instants is not."""
    asked: dict[str, Any] = {"level": "torsional", "duration": 2.0, "damage": None}
    values = {"off": 0.1, "braked": 0.5, "pitched": 0.2, "brake": 2.0}
    free = transient(two_masses(), "stop", values, **asked)
    assert free.by_instant is not None
    own, most = free.extremes["torque of shaft"].largest, max(free.by_instant.peaks) * TORQUE
    assert most > 1.01 * own
    limits = {"peak_torque": {"shaft": 0.5 * (own + most)}}
    found = transient(two_masses(limits=limits), "stop", values, **asked)
    assert found.answer.verdict.endswith(", braked at another instant beyond its limit.")
    statuses = {one.name: one.status for one in found.answer.figures}
    assert statuses["peak torque of shaft"] == "good"
    assert "bad" in statuses.values()


def test_the_page_shows_damage_and_safety(tmp_path: Path) -> None:
    out = tmp_path / "out"
    typed = ["transient", "nrel_5mw", "dip", "--level", "torsional", "--duration", "1.2"]
    with pytest.raises(SystemExit) as ended:
        main([*typed, "--value", "start=0.5", "--step", "0.005", "--out", str(out)])
    assert ended.value.code == 0
    results = read_results(out / "results.json")
    assert broken_rules(results) == []
    titles = [section.title for section in results.sections]
    assert "Gears and bearings" in titles


@pytest.mark.parametrize(("share", "status"), [(1.2, "good"), (1.05, "bad")])
def test_histories_are_held_against_the_limit_of_the_main_shaft(
    tmp_path: Path, share: float, status: str
) -> None:
    """A torque that swings to 1.1 of rated, alone; the limit is that of the shaft it is in."""
    limits = {"limits.peak_torque": {"LSS": share * RATED.torque, "HSS": 1e9}}
    time = np.arange(0.0, 40.0, 0.1)
    table = np.column_stack([time, RATED.torque * (1.0 + 0.1 * np.cos(time))])
    path = tmp_path / "torque.csv"
    header = "time [s],Mx [N m]"
    np.savetxt(path, table, delimiter=",", header=header, comments="", fmt="%.9g")
    scene = read_drivetrain("nrel_5mw", limits)
    assert isinstance(scene, Scene)
    found = loads(path, scene=scene)
    (peak,) = [one for one in found.answer.figures if one.name == "peak torque Mx"]
    assert peak.status == status
    assert_allclose(
        [peak.value, peak.upper], [1.1 * RATED.torque / 1e3, share * RATED.torque / 1e3]
    )
