"""What is condensed of a drivetrain's file: housings at both bounds, mount, carriers, shaft."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from coarse_scenes import LENGTHS, MOUNT, coarse_drivetrain, coarse_scene

from fe_drivetrain.cases.references.machine_rungs import carrier_of
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.drivetrain_file.carriers import carriers_of
from fe_drivetrain.drivetrain_file.joint_springs import free_to_turn
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.drivetrain_file.reading import change_scene, library_component, library_text
from fe_drivetrain.drivetrain_file.scene import Scene, main_bearings
from fe_drivetrain.dynamics.bodies.advice import (
    RUNGS,
    Asked,
    Operation,
    Rung,
    ladder,
    like_mode,
)
from fe_drivetrain.dynamics.bodies.condensed_rungs import (
    SOFT_SEATS,
    STIFF_SEATS,
    UNCONDENSED,
    Rungs,
    rungs_of,
)
from fe_drivetrain.dynamics.bodies.flexible import Flexible, Housing
from fe_drivetrain.dynamics.bodies.gearbox_mount import gearbox_housing, mass_inside
from fe_drivetrain.dynamics.bodies.housing_bounds import HousingBounds, housing_bounds
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system
from fe_drivetrain.dynamics.bodies.machine import Machine, machine_of
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.static import Static, static
from fe_drivetrain.shafts.fidelity.bearing_units import unit_bounds
from fe_drivetrain.shafts.fidelity.main_supports import MainSupports, main_supports
from fe_drivetrain.shafts.fidelity.shafts import beam_shaft, meridian_shaft
from fe_drivetrain.shafts.response.bearing_stiffness import bearing_unit_stiffness, without_gearbox
from fe_drivetrain.shafts.response.model import Model, build_model
from fe_drivetrain.shafts.response.unit_loads import unit_load_response
from fe_drivetrain.studies.drivetrain_modes import modes

pytestmark = pytest.mark.usefixtures("kept_between_runs")

TORQUE, BEARING = 1.0e6, "main_bearing"
NAMES = ("torsional", "rigid bodies", "flexible shafts", SOFT_SEATS, STIFF_SEATS)


@pytest.fixture(scope="module")
def scene() -> Scene:
    return coarse_drivetrain()


@pytest.fixture(scope="module")
def machine(scene: Scene) -> Machine:
    return machine_of(scene)


@pytest.fixture(scope="module")
def supports(scene: Scene) -> MainSupports:
    return main_supports(scene)


@pytest.fixture(scope="module")
def rungs(scene: Scene) -> Rungs:
    return rungs_of(scene)


def under_torque(machine: Machine, flexible: Flexible, level: Level = Level.RIGID) -> Static:
    """Equilibrium under the rotor's torque alone, the generator held."""
    system = machine_system(machine, level, held_generator=True, flexible=flexible)
    return static(system, system.load_on("rotor", np.array([0, 0, 0, TORQUE, 0, 0])))


def test_both_bounds_enclose_the_assembly(supports: MainSupports, bonded_model: Model) -> None:
    """The same unit, its shaft a solid: neither averaged nor rigid."""
    assert np.linalg.eigvalsh(supports.stiff[BEARING] - supports.soft[BEARING]).min() > 0
    model = build_model(without_gearbox(bonded_model.scene), bonded_model.mesh)
    solved = bearing_unit_stiffness(unit_load_response(model), BEARING)
    for tilt in (4, 5):
        found = solved[tilt, tilt]
        assert supports.soft[BEARING][tilt, tilt] < found < supports.stiff[BEARING][tilt, tilt]


def test_the_seat_of_a_spring_joint_is_between_bounds_too() -> None:
    joint = {"interface": "spring", "stiffness": [1e9, 5e9, 5e9, 0, 1e8, 1e8]}
    scene = coarse_scene("bonded", **{f"bearing_units.0.{k}": v for k, v in joint.items()})
    found = main_supports(scene)
    for motion in (0, 1, 2, 4, 5):
        soft, stiff = (way[BEARING][motion, motion] for way in (found.soft, found.stiff))
        assert soft < stiff < joint["stiffness"][motion]  # type: ignore[index, operator]
    # solid models hold it on average
    np.testing.assert_allclose(unit_bounds(scene, BEARING).stiff, found.soft[BEARING], rtol=1e-12)


def test_a_shaft_turns_in_its_bearing_whatever_the_housing_does(supports: MainSupports) -> None:
    K = supports.stiff[BEARING]
    free = free_to_turn(K)
    assert not free[3].any()
    assert not free[:, 3].any()
    kept = [0, 1, 2, 4, 5]
    # without a moment about x: the compliance of the other five
    expected = np.linalg.inv(np.linalg.inv(K)[np.ix_(kept, kept)])
    np.testing.assert_allclose(free[np.ix_(kept, kept)], expected, rtol=1e-9, atol=1e-6 * K.max())
    assert free[1, 1] < 0.99 * K[1, 1]  # it rolls on its feet


def test_rows_of_main_bearings_take_the_housings(scene: Scene, supports: MainSupports) -> None:
    rows = {b.name: b for b in main_bearings(scene, supports.soft)}
    np.testing.assert_allclose(rows[BEARING].stiffness, free_to_turn(supports.soft[BEARING]))
    one = machine_system(machine_of(scene, supports.soft), Level.FLEXIBLE)
    way = Flexible(bearings={BEARING: free_to_turn(supports.soft[BEARING])})
    other = machine_system(machine_of(scene), Level.FLEXIBLE, flexible=way)
    np.testing.assert_allclose(one.K, other.K)


def test_answers_are_given_between_both_bounds(scene: Scene) -> None:
    found: HousingBounds = housing_bounds(scene, TORQUE, [0, 0, 0, 0, 5e5, 0], modes=4)
    assert not found.left_out
    for between, rigid in zip(found.frequencies, found.rigid, strict=True):
        assert between.soft <= between.stiff * (1 + 1e-12)
        assert between.stiff <= rigid * (1 + 1e-9)
        assert between.band == pytest.approx((between.stiff - between.soft) / 2)
    assert max(between.band / between.middle for between in found.frequencies) > 1e-5
    reactions = found.reactions[BEARING]
    assert reactions["Mx"].soft == pytest.approx(0, abs=1e-3)
    assert reactions["My"].soft != pytest.approx(reactions["My"].stiff, rel=1e-4)


def test_a_housing_on_a_stiff_mount_is_the_ground(scene: Scene, machine: Machine) -> None:
    own = gearbox_housing(scene, machine)
    rigid = Flexible(housing=replace(own, stiffness=np.eye(6) * 1e16), apart=frozenset({BEARING}))
    ground, held = (under_torque(machine, way) for way in (Flexible(), rigid))
    for name in ("PLC-A", "HS-B", BEARING):
        np.testing.assert_allclose(held.wrench(name), ground.wrench(name), rtol=1e-5, atol=1.0)


def test_arms_take_the_torque_that_the_generator_does_not(scene: Scene, rungs: Rungs) -> None:
    rung, machine = rungs.named("flexible shafts"), machine_of(scene)
    assert rung.flexible.apart == {BEARING}
    found = under_torque(machine, rung.flexible)
    turn = found.system.motion_of("housing", found.q)[3]
    # power: what the generator takes is the rotor's torque over the ratio, with its sign
    expected = TORQUE * (1 - 1 / machine.speeds[-1])
    assert MOUNT[3] * turn == pytest.approx(expected, rel=1e-9)
    housing = rung.flexible.housing
    assert isinstance(housing, Housing)
    assert housing.mass + mass_inside(machine) == pytest.approx(scene.gearbox.weight / 9.80665)
    assert housing.position == (sum(LENGTHS), 0.0, 0.0)


def test_a_soft_mount_lowers_the_first_torsional_mode(scene: Scene, rungs: Rungs) -> None:
    steps = (RUNGS[-1], rungs.named("flexible shafts"))
    answers = ladder(machine_of(scene), Operation(TORQUE, 5e5), steps)
    question = "first torsional frequency [Hz]"
    held, moved = (answer.values[question] for answer in answers)
    assert held is not None
    assert moved is not None
    assert moved < held


def test_modes_are_compared_at_every_level_that_the_file_states(scene: Scene) -> None:
    found = modes(scene, condensed=True)
    assert [answer.name for answer in found.ladder[:5]] == list(NAMES)
    assert found.ladder[-1].name == "main shaft in its meridian"
    first = [answer.values["first torsional frequency [Hz]"] for answer in found.ladder]
    assert all(value is not None and value > 0 for value in first)
    assert found.options["condensed"] is True
    assert any("gearbox's housing" in row.name for row in found.assumptions)


def test_nodes_of_a_condensed_shaft_are_not_those_of_the_beam(
    scene: Scene, machine: Machine
) -> None:
    """The same shaft with other nodes has the same modes, though nodes share names."""
    body = beam_shaft(scene, rings=False)
    solid = Rung(Level.FLEXIBLE, Flexible(shafts={scene.shaft.name: body}), "condensed beam")
    load = Operation(TORQUE)
    finest, plain = Asked(machine, solid, load), Asked(machine, RUNGS[-1], load)
    for number in range(1, 5):
        one, other = (like_mode(finest, number)(asked) for asked in (finest, plain))
        assert other == pytest.approx(one, rel=1e-2)


def test_a_stepped_shaft_is_the_condensed_beam(scene: Scene, machine: Machine) -> None:
    """Springs at elastic centres and a frame of beams: one theory, two codes."""
    beam = Flexible(shafts={scene.shaft.name: beam_shaft(scene, rings=False)})
    one, two = (under_torque(machine, way, Level.FLEXIBLE) for way in (Flexible(), beam))
    for name in ("PLC-A", BEARING):
        np.testing.assert_allclose(one.wrench(name), two.wrench(name), rtol=1e-6, atol=1.0)
    turned = [way.system.motion_of("rotor", way.q)[3] for way in (one, two)]
    assert turned[0] == pytest.approx(turned[1], rel=1e-9)


def test_the_meridian_moves_modes_less_than_the_shafts_differ(
    scene: Scene, machine: Machine
) -> None:
    beam, meridian = beam_shaft(scene, rings=False), meridian_shaft(scene, rings=False)
    band = StiffnessBands.of_difference(beam.stiffness, meridian.stiffness).largest
    one, two = (
        system_modes(machine_system(machine, Level.FLEXIBLE, flexible=way)).frequencies
        for way in (Flexible(shafts={scene.shaft.name: body}) for body in (beam, meridian))
    )
    first = np.flatnonzero(one > 0)[:5]
    apart = np.abs(two[first] / one[first] - 1)
    assert 1e-6 < apart.max() < band


def test_each_rung_brings_something_and_says_what_it_neglects(rungs: Rungs) -> None:
    names = [rung.name for rung in rungs.rungs]
    assert names == [*NAMES, "main shaft in its meridian"]
    assert set(rungs.left_out) == {"carriers", "solid main shaft and carriers"}
    assert rungs.rungs[-1].neglects[-2:] == ("carriers that give", UNCONDENSED[-1])
    assert len(rungs.rungs[-1].neglects) < len(rungs.rungs[2].neglects)
    assert any("housing_inertia" in what for what in rungs.rungs[-1].assumes)


def test_the_files_own_inertia_of_the_housing_counts(scene: Scene, machine: Machine) -> None:
    given = change_scene(scene, {"gearbox.housing_inertia": [5e4, 4e4]})
    found = gearbox_housing(given, machine)
    assert (found.polar, found.transverse) == (5e4, 4e4)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"gearbox.stiffness": [4e6, 8e7, 8e7, 0, 0, 0]}, "is 0 N m/rad about x"),
        ({"gearbox.weight": 2e4}, "gears and shafts in it weigh"),
    ],
)
def test_a_mount_that_cannot_be_is_left_out_by_name(
    scene: Scene, machine: Machine, changes: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        gearbox_housing(change_scene(scene, changes), machine)


def test_a_lumped_shaft_has_the_rungs_that_its_file_states(tmp_path: Path) -> None:
    found = rungs_of(read_drivetrain("synthetic_2mw"))
    assert [rung.name for rung in found.rungs] == list(NAMES[:3])
    assert "no sections" in found.left_out[STIFF_SEATS]
    own = tmp_path / "carrier.yaml"
    fitting = carrier_of(machine_of(read_drivetrain("synthetic_2mw")).stages[0].centre_distance)
    own.write_text(yaml.safe_dump(fitting.model_dump(exclude_unset=True, mode="json")))
    named = {"gearbox.stages.0.carrier.component": str(own)}
    found = rungs_of(read_drivetrain("synthetic_2mw", named))
    assert found.rungs[-1].name == "carriers of beams"
    assert list(found.rungs[-1].flexible.carriers) == [1]


@pytest.mark.parametrize(
    ("name", "component", "message"),
    [
        ("synthetic_2mw", "planet_carrier", "on a circle of .* twice the centre distance"),
        ("nrel_5mw", "gearbox_housing", "is no planet carrier"),
        ("nrel_5mw", "two_bearings", "must have one of the keys"),
    ],
)
def test_a_carrier_that_does_not_fit_is_refused(name: str, component: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_drivetrain(name, {"gearbox.stages.0.carrier.component": component})


def test_what_does_not_turn_in_space_is_torsional_alone() -> None:
    found = rungs_of(read_drivetrain("synthetic_2mw", {"rotor": {"inertia": 6e6}}))
    assert [rung.name for rung in found.rungs] == ["torsional"]
    assert "rotor: mass" in found.left_out["rigid bodies"]


def test_a_bearing_that_is_not_there_is_refused(machine: Machine) -> None:
    with pytest.raises(InputError, match="no bearing 'HS-Z'"):
        machine_system(machine, flexible=Flexible(bearings={"HS-Z": np.eye(6)}))


def test_a_carrier_of_ones_own_is_looked_for_beside_the_file(tmp_path: Path) -> None:
    own = library_component("planet_carrier").model_dump(exclude_unset=True, mode="json")
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(own))
    text = library_text("nrel_5mw")
    file = tmp_path / "drivetrain.yaml"
    named = "carrier: {component: mine.yaml, inertia: 1.9e3, mass: 5000}"
    file.write_text(text.replace("carrier: {inertia: 1.9e3, mass: 5000}", named))
    assert list(carriers_of(read_drivetrain(file))) == [1]
    (tmp_path / "mine.yaml").unlink()
    with pytest.raises(InputError, match=r"mine\.yaml"):
        read_drivetrain(file)
