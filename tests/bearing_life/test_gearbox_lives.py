"""Lives of a drivetrain's bearings: main and gearbox in one result, by hand and by level."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.dynamics.bodies.bearing_reactions import bearing_reactions
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.tables import Machine, library_machine
from fe_drivetrain.studies import LifeOptions, LifeResult
from fe_drivetrain.studies.bearing_lives import DrivetrainBearings, lives_under
from fe_drivetrain.studies.gearbox_bearings import gearbox_oil

SCENE = "nrel_750kw_low_speed_shaft"
MACHINE = library_machine("nrel_750kw")
HUB = np.array([3e4, 0.0, -1.2e5, 3.25e5, -1e5, 5e4])
RPM = 22.0
ENTRIES = {
    "stage 1 pin upwind": "planet_nj2232",
    "ISS-A": "cylindrical_nu2220",
    "LSS-B": "tapered_pair_32948",
}


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A constant load for 10 s."""
    path = tmp_path_factory.mktemp("loads") / "constant.csv"
    units = 3 * ["N"] + 3 * ["N m"]
    names = [f"{name} [{unit}]" for name, unit in zip(FORCES, units, strict=True)]
    time = np.arange(0.0, 10.0, 0.5)
    head = ",".join(["time [s]", *names])
    table = np.column_stack([time, np.tile(HUB, (len(time), 1))])
    np.savetxt(path, table, delimiter=",", header=head, comments="", fmt="%.9g")
    return path


def lives(
    file: Path, entries: Mapping[str, str], machine: Machine | None = MACHINE, **options: Any
) -> LifeResult:
    asked = LifeOptions(rotor_speed_rpm=RPM, **options)
    scene = library_scene(SCENE)
    drivetrain = DrivetrainBearings(scene, asked, machine, entries)
    return lives_under(drivetrain, [file], None)


@pytest.fixture(scope="module")
def found(file: Path) -> LifeResult:
    return lives(file, ENTRIES)


def test_main_bearings_come_first_and_live_as_without_a_gearbox(
    file: Path, found: LifeResult
) -> None:
    names = list(found.bearings)
    assert names[0] == "main_bearing"
    assert names[1:] == ["LSS-B", "ISS-A", "stage 1 pin upwind"]
    alone = lives(file, {}, machine=None)
    assert list(alone.bearings) == ["main_bearing"]
    assert dict(alone.bearings["main_bearing"].years) == found.bearings["main_bearing"].years
    assert "levels" not in alone.tables
    assert not alone.not_rated


def test_bearings_without_an_entry_are_named_as_not_rated(found: LifeResult) -> None:
    assert set(found.not_rated) >= {"PLC-A", "PLC-B", "HSS-B", "stage 1 pin downwind"}
    rows = {row["bearing"]: row for row in found.tables["lives"]}
    assert list(rows) == [*found.bearings, *found.not_rated]
    assert rows["PLC-A"]["entry"] == "not rated: no catalogue entry"
    assert rows["PLC-A"]["L10mr [years]"] is None
    # each with the speed of its shaft, planets against their carrier
    ratio = 120 / 21
    speeds = {"PLC-A": 1.0, "LSS-B": ratio, "ISS-A": ratio * 82 / 23, "HSS-B": ratio * 82 / 23 * 4}
    speeds["stage 1 pin upwind"] = 99 / 39
    for name, over in speeds.items():
        assert rows[name]["mean speed [1/min]"] == pytest.approx(RPM * over, rel=1e-9)
    assert any("Not rated" in note and "PLC-A, PLC-B" in note for note in found.notes)
    assert found.answer is not None


def test_basic_life_of_a_shafts_bearing_is_c_over_p_by_hand(found: LifeResult) -> None:
    """(C / P)^(10/3) million turns, P the radial load of the cylindrical bearing."""
    load = bearing_reactions(MACHINE, Level.FLEXIBLE)["ISS-A"].under([HUB])[0, 0]
    one = found.bearings["ISS-A"]
    P = float(np.hypot(load[1], load[2]))
    million = (one.bearing.rated.dynamic / P) ** (10 / 3)
    assert one.million_revolutions["L10"] == pytest.approx(million, rel=1e-9)
    hours = million * 1e6 / (60 * one.speed)
    assert one.years["L10"] == pytest.approx(hours / 8760, rel=1e-9)
    assert one.limits.static_safety > 0


def test_planets_have_the_mean_damage_of_the_azimuths_of_their_carrier(found: LifeResult) -> None:
    of = bearing_reactions(MACHINE, Level.FLEXIBLE)["stage 1 pin upwind"]
    load = of.under([HUB])[0]
    one = found.bearings["stage 1 pin upwind"]
    used = (np.hypot(load[:, 1], load[:, 2]) / one.bearing.rated.dynamic) ** (10 / 3)
    assert one.million_revolutions["L10"] == pytest.approx(1 / used.mean(), rel=1e-9)
    # the load stands on the inner ring, which is the pin's
    assert one.bearing.turning == "outer"
    assert one.bearing.planets == 3
    finer = bearing_reactions(MACHINE, Level.FLEXIBLE, count=36)["stage 1 pin upwind"]
    load = finer.under([HUB])[0]
    fine = (np.hypot(load[:, 1], load[:, 2]) / one.bearing.rated.dynamic) ** (10 / 3)
    assert used.mean() == pytest.approx(fine.mean(), rel=2e-3)


def test_levels_say_what_rigid_bodies_would_do(found: LifeResult) -> None:
    for name in ("LSS-B", "ISS-A"):
        one = found.bearings[name]
        rated = one.bearing.rated
        loads = [
            bearing_reactions(MACHINE, level)[name].under([HUB])[0, 0][[0, 1, 2, 4, 5]]
            for level in (Level.RIGID, Level.FLEXIBLE)
        ]
        if name == "ISS-A":
            loads = [load * [0, 1, 1, 1, 1] for load in loads]
        rigid, flexible = (float(rated.equivalent_load(load)[0]) for load in loads)
        assert one.levels["rigid bodies"] == pytest.approx(rigid / flexible, rel=1e-9)
        assert one.levels["flexible shafts"] == 1.0
    rows = {row["bearing"]: row for row in found.tables["levels"]}
    assert rows["ISS-A"]["enough"] == "rigid bodies"
    assert "main_bearing" not in rows
    assert any("156 degrees of freedom" in line for line in found.details)


def test_the_stiffness_of_a_bearing_is_an_assumption(file: Path, found: LifeResult) -> None:
    data = MACHINE.model_dump(exclude_none=True)
    for bearing in data["bearings"]:
        if bearing["name"] == "LSS-B":
            bearing["stiffness"] = [0.5 * k for k in bearing["stiffness"]]
    softer = lives(file, ENTRIES, Machine.model_validate(data), only="LSS-B")
    assert list(softer.bearings) == ["LSS-B"]
    rows = {
        row.instead: row.years
        for row in found.bearings["LSS-B"].assumptions
        if "stiffness" in row.assumed
    }
    assert rows.keys() == {"half of it", "twice as much"}
    expected = softer.bearings["LSS-B"].years["L10mr"]
    assert rows["half of it"] == pytest.approx(expected, rel=1e-6)
    assert abs(expected / found.bearings["LSS-B"].years["L10mr"] - 1) > 1e-4


def test_axial_loads_on_cylindrical_rollers_are_cautioned(file: Path) -> None:
    flanged = lives(file, {"LSS-B": "cylindrical_sl181856"}, only="LSS-B")
    axial = abs(bearing_reactions(MACHINE)["LSS-B"].under([HUB])[0, 0, 0])
    assert flanged.bearings["LSS-B"].flanges == pytest.approx(axial, rel=1e-6)
    said = [note for note in flanged.notes if "flanges have it" in note]
    assert len(said) == 1
    assert f"{axial / 1e3:.3g} kN" in said[0]


def test_the_gearbox_has_an_oil_of_its_own(file: Path, found: LifeResult) -> None:
    assert gearbox_oil(None, None, None).lubricant.supply == "filtered oil"
    assert gearbox_oil("VG 220", 70.0, "-/15/12").assumed == ()
    hot = lives(file, ENTRIES, only="ISS-A", gearbox_temperature=80.0)
    assert hot.bearings["ISS-A"].years["L10mr"] < found.bearings["ISS-A"].years["L10mr"]
    assert hot.bearings["ISS-A"].years["L10r"] == found.bearings["ISS-A"].years["L10r"]
    assumed = {one.assumed for one in hot.bearings["ISS-A"].assumptions}
    assert "80 degC" not in assumed
    assert "VG 320" in assumed
    basic = lives(file, ENTRIES, only="ISS-A", lubricant=None)
    years = basic.bearings["ISS-A"].years
    assert years["L10mr"] == pytest.approx(years["L10r"])


@pytest.mark.parametrize(
    ("entries", "options", "words"),
    [
        ({"HS-X": "cylindrical_nu2220"}, {}, "no bearing 'HS-X'"),
        ({"ISS-A": "nothing"}, {}, "'nothing' of bearing 'ISS-A' is in no catalogue"),
        (ENTRIES, {"only": "HS-X"}, "HS-X"),
        (ENTRIES, {"only": "PLC-A"}, "'PLC-A' has no entry"),
        (ENTRIES, {"gearbox_lubricant": "honey"}, "VG 460"),
    ],
)
def test_mistakes_are_named(
    file: Path, entries: dict[str, str], options: dict[str, Any], words: str
) -> None:
    with pytest.raises(InputError, match=words):
        lives(file, entries, **options)
