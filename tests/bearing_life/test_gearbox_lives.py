"""Lives of a drivetrain's bearings: main and gearbox in one result, by hand and by level."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import parse_mapping
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.drivetrain_file.reading import library_text
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.drivetrain_file.without_weight import weightless
from fe_drivetrain.dynamics.bodies.bearing_reactions import BearingModel, bearing_reactions
from fe_drivetrain.dynamics.bodies.gearbox_mount import stated_mount
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.machine import library_machine, machine_of
from fe_drivetrain.studies import LifeOptions, LifeResult, life
from fe_drivetrain.studies.gearbox_bearings import gearbox_oil
from fe_drivetrain.studies.rolling_bearings import bearings_of

WHOLE, GEARS = "grc_750kw", "nrel_750kw"
HUB = np.array([3e4, 0.0, -1.2e5, 3.25e5, -1e5, 5e4])
RPM = 22.0
ENTRIES = {
    "stage 1 pin upwind": "planet_nj2232",
    "ISS-A": "cylindrical_nu2220",
    "LSS-B": "tapered_pair_32948",
}


def with_gears(
    entries: Mapping[str, str] = ENTRIES, stiffness: Mapping[str, float] | None = None
) -> Scene:
    """The whole 750 kW drivetrain with these entries of its gearbox, and factors on bearings."""
    data = parse_mapping(library_text(WHOLE), WHOLE)
    for bearing in data["gearbox"]["bearings"]:
        name = bearing["name"]
        factor = (stiffness or {}).get(name, 1.0)
        bearing["stiffness"] = [factor * float(k) for k in bearing["stiffness"]]
        bearing["catalogue"] = entries.get(name)
    for pin in data["gearbox"]["stages"][0]["pins"]:
        pin["catalogue"] = entries.get(f"stage 1 pin {pin['name']}")
    return Scene.model_validate(data)


MACHINE = machine_of(with_gears())
MOUNT = stated_mount(with_gears(), MACHINE)


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


def lives(file: Path, drivetrain: Drivetrain, **options: Any) -> LifeResult:
    return life(drivetrain, file, options=LifeOptions(rotor_speed_rpm=RPM, **options))


@pytest.fixture(scope="module")
def found(file: Path) -> LifeResult:
    return lives(file, with_gears())


def test_main_bearings_come_first_and_live_as_without_a_gearbox(
    file: Path, found: LifeResult
) -> None:
    names = list(found.bearings)
    assert names[0] == "main_bearing"
    assert names[1:] == ["LSS-B", "ISS-A", "stage 1 pin upwind"]
    data = with_gears().model_dump(exclude_unset=True)
    data["gearbox"] = {key: data["gearbox"][key] for key in ("stiffness", "weight")}
    alone = lives(file, Scene.model_validate(data))
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
    load = bearing_reactions(MACHINE, Level.FLEXIBLE, flexible=MOUNT)["ISS-A"].under([HUB])[0, 0]
    one = found.bearings["ISS-A"]
    P = float(np.hypot(load[1], load[2]))
    million = (one.bearing.rated.dynamic / P) ** (10 / 3)
    assert one.million_revolutions["L10"] == pytest.approx(million, rel=1e-9)
    hours = million * 1e6 / (60 * one.speed)
    assert one.years["L10"] == pytest.approx(hours / 8760, rel=1e-9)
    assert one.limits.static_safety > 0


def test_planets_have_the_mean_damage_of_the_azimuths_of_their_carrier(found: LifeResult) -> None:
    of = bearing_reactions(MACHINE, Level.FLEXIBLE, flexible=MOUNT)["stage 1 pin upwind"]
    load = of.under([HUB])[0]
    one = found.bearings["stage 1 pin upwind"]
    used = (np.hypot(load[:, 1], load[:, 2]) / one.bearing.rated.dynamic) ** (10 / 3)
    assert one.million_revolutions["L10"] == pytest.approx(1 / used.mean(), rel=1e-9)
    # the load stands on the inner ring, which is the pin's
    assert one.bearing.turning == "outer"
    assert one.bearing.planets == 3
    finer = bearing_reactions(MACHINE, Level.FLEXIBLE, 36, MOUNT)["stage 1 pin upwind"]
    load = finer.under([HUB])[0]
    fine = (np.hypot(load[:, 1], load[:, 2]) / one.bearing.rated.dynamic) ** (10 / 3)
    assert used.mean() == pytest.approx(fine.mean(), rel=2e-3)


def test_main_bearing_and_mount_share_the_hub_loads_by_lever_arms() -> None:
    """The shaft is on two supports; on rollers in equilibrium with it, the bearing has the same."""
    scene = with_gears()
    hub = np.array([0.0, 2e4, -1.2e5, 3.25e5, -1e5, 5e4])
    for level in (Level.RIGID, Level.FLEXIBLE):
        found = bearing_reactions(MACHINE, level, flexible=MOUNT)["main_bearing"]
        load = found.under([hub], weight=False)[0, 0]
        length, at = scene.shaft.rear - scene.shaft.front, -scene.shaft.front
        across_z = (hub[2] * length + hub[4]) / (length - at)
        across_y = (hub[1] * length - hub[5]) / (length - at)
        assert_allclose(load[1:3], [across_y, across_z], rtol=1e-5)
    choices = LifeOptions(weight=False).choices
    (one,) = bearings_of(weightless(scene), choices)
    on_rollers, converged = one.path.bearing_loads(hub)
    assert converged.all()
    assert_allclose(load[1:3], on_rollers[0, 1:3], rtol=1e-3)


def test_levels_say_what_rigid_bodies_would_do(found: LifeResult) -> None:
    for name in ("LSS-B", "ISS-A"):
        one = found.bearings[name]
        rated = one.bearing.rated
        loads = [
            bearing_reactions(MACHINE, level, flexible=MOUNT)[name].under([HUB])[0, 0][
                [0, 1, 2, 4, 5]
            ]
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
    size = BearingModel(MACHINE, Level.FLEXIBLE, 1, MOUNT).degrees
    assert any(f"{size} degrees of freedom" in line for line in found.details)


def test_the_stiffness_of_a_bearing_is_an_assumption(file: Path, found: LifeResult) -> None:
    softer = lives(file, with_gears(stiffness={"LSS-B": 0.5}), only="LSS-B")
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
    flanged = lives(file, with_gears({"LSS-B": "cylindrical_sl181856"}), only="LSS-B")
    axial = abs(bearing_reactions(MACHINE, flexible=MOUNT)["LSS-B"].under([HUB])[0, 0, 0])
    assert flanged.bearings["LSS-B"].flanges == pytest.approx(axial, rel=1e-6)
    said = [note for note in flanged.notes if "flanges have it" in note]
    assert len(said) == 1
    assert f"{axial / 1e3:.3g} kN" in said[0]


def test_the_gearbox_has_an_oil_of_its_own(file: Path, found: LifeResult) -> None:
    assert gearbox_oil(None, None, None).lubricant.supply == "filtered oil"
    assert gearbox_oil("VG 220", 70.0, "-/15/12").assumed == ()
    hot = lives(file, with_gears(), only="ISS-A", gearbox_temperature=80.0)
    assert hot.bearings["ISS-A"].years["L10mr"] < found.bearings["ISS-A"].years["L10mr"]
    assert hot.bearings["ISS-A"].years["L10r"] == found.bearings["ISS-A"].years["L10r"]
    assumed = {one.assumed for one in hot.bearings["ISS-A"].assumptions}
    assert "80 degC" not in assumed
    assert "VG 320" in assumed
    basic = lives(file, with_gears(), only="ISS-A", lubricant=None)
    years = basic.bearings["ISS-A"].years
    assert years["L10mr"] == pytest.approx(years["L10r"])


def test_the_oil_of_a_gearbox_is_that_of_the_files_operation(file: Path) -> None:
    data = with_gears().model_dump(exclude_unset=True)
    data["operation"] = {"temperature": 80.0, "lubricant": "VG 220"}
    stated = lives(file, Scene.model_validate(data), only="ISS-A").bearings["ISS-A"]
    asked = {"gearbox_temperature": 80.0, "gearbox_lubricant": "VG 220"}
    given = lives(file, with_gears(), only="ISS-A", **asked).bearings["ISS-A"]
    assert dict(stated.years) == given.years
    assert {one.assumed for one in stated.assumptions} == {one.assumed for one in given.assumptions}


def test_a_main_shaft_without_sections_has_its_bearings_rated_by_statics(file: Path) -> None:
    """All bearings of the library's 750 kW drivetrain, main bearing first."""
    whole = lives(file, read_drivetrain(GEARS))
    names = list(whole.bearings)
    assert names[0] == "main bearing"
    assert len(names) == 11
    assert not whole.not_rated
    main = whole.bearings["main bearing"]
    assert main.levels
    # the main bearing has the lubricant of the options, bearings of the gearbox its oil
    assert {one.assumed for one in main.assumptions} >= {"VG 460", "50 degC"}
    load = bearing_reactions(library_machine(GEARS))["main bearing"].under([HUB])[0, :, [0, 1, 2]]
    P = main.bearing.rated.equivalent_load([[*load.ravel(), 0.0, 0.0]])[0]
    million = (main.bearing.rated.dynamic / P) ** (10 / 3)
    assert main.million_revolutions["L10"] == pytest.approx(million, rel=1e-6)


def test_a_file_names_the_bearings_of_which_its_source_has_ratings(file: Path) -> None:
    found = lives(file, read_drivetrain("nrel_5mw"))
    assert list(found.bearings) == ["PLC-A", "PLC-B", "stage 1 pin upwind", "stage 1 pin downwind"]
    assert {"INP-A", "INP-B", "HS-A", "stage 2 pin upwind"} <= set(found.not_rated)
    assert found.bearings["stage 1 pin upwind"].bearing.rated.dynamic == 5.5e6


def test_main_bearings_without_entries_are_not_rated_beside_a_gearbox(file: Path) -> None:
    data = with_gears().model_dump(exclude_unset=True)
    for unit in data["bearing_units"]:
        unit.pop("catalogue")
    found = lives(file, Scene.model_validate(data))
    assert "main_bearing" in found.not_rated
    assert "main_bearing" not in found.bearings
    named = lives(file, Scene.model_validate(data), bearings={"main_bearing": "nrel_750kw_main"})
    assert next(iter(named.bearings)) == "main_bearing"
    assert not named.bearings["main_bearing"].levels


def test_a_gearbox_without_what_statics_need_leaves_main_bearings_rated(file: Path) -> None:
    data = with_gears().model_dump(exclude_unset=True)
    del data["rotor"]
    found = lives(file, Scene.model_validate(data))
    assert list(found.bearings) == ["main_bearing"]
    assert any("gearbox are not rated" in note and "rotor" in note for note in found.notes)
    with pytest.raises(InputError, match="rotor"):
        lives(file, read_drivetrain(GEARS).model_copy(update={"rotor": None}))


@pytest.mark.parametrize(
    ("bearings", "options", "words"),
    [
        ({"HS-X": "cylindrical_nu2220"}, {}, "no bearing 'HS-X'"),
        ({"ISS-A": "nothing"}, {}, "'nothing' of bearing 'ISS-A' is in no catalogue"),
        ({}, {"only": "HS-X"}, "HS-X"),
        ({}, {"only": "PLC-A"}, "'PLC-A' has no entry"),
        ({}, {"gearbox_lubricant": "honey"}, "VG 460"),
    ],
)
def test_mistakes_are_named(
    file: Path, bearings: dict[str, str], options: dict[str, Any], words: str
) -> None:
    with pytest.raises(InputError, match=words):
        lives(file, with_gears(), bearings=bearings, **options)
