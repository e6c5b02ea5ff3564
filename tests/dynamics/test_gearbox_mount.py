"""A gearbox's housing on its mount: by hand, against the ground, without mass, and in time."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.drivetrain_file.turning_parts import DampingRatios
from fe_drivetrain.dynamics.bodies.condensed_rungs import plain_rungs
from fe_drivetrain.dynamics.bodies.equations import varying
from fe_drivetrain.dynamics.bodies.flexible import MOUNT, Flexible, Housing
from fe_drivetrain.dynamics.bodies.gearbox_mount import mass_inside, stated_mount
from fe_drivetrain.dynamics.bodies.levels import Level, assembly, machine_system, steady_load
from fe_drivetrain.dynamics.bodies.machine import Machine, machine_of
from fe_drivetrain.dynamics.bodies.mesh_loads import MeshResponses
from fe_drivetrain.dynamics.bodies.static import Static, static
from fe_drivetrain.dynamics.bodies.steady_state import wind_up
from fe_drivetrain.dynamics.time.base_motion import on_base
from fe_drivetrain.dynamics.time.integration import integrate
from fe_drivetrain.dynamics.time.machine_channels import machine_channels
from fe_drivetrain.dynamics.time.motion import State
from fe_drivetrain.dynamics.time.running import LIGHT, Running, running
from fe_drivetrain.shafts.fidelity.shafts import beam_shaft
from fe_drivetrain.studies.gear_stresses import spread_at_ends

WHOLE, TORQUE, SPEED = "grc_750kw", 3.0e5, 2.3
SOFT = (2.0e6, 3.0e7, 5.0e7, 4.0e8, 0.0, 0.0)
"""A mount that takes no tilt [N/m, N m/rad]."""


def on_soft_mount(**changes: Any) -> Drivetrain:
    return read_drivetrain(WHOLE, {"gearbox.stiffness": list(SOFT), **changes})


@pytest.fixture(scope="module")
def drivetrain() -> Drivetrain:
    return on_soft_mount()


@pytest.fixture(scope="module")
def machine(drivetrain: Drivetrain) -> Machine:
    return machine_of(drivetrain)


@pytest.fixture(scope="module")
def mount(drivetrain: Drivetrain, machine: Machine) -> Flexible:
    return stated_mount(drivetrain, machine)


def test_reactions_of_two_bodies_are_those_of_lever_arms(machine: Machine, mount: Flexible) -> None:
    """Shaft with carrier, and housing with all others, on springs: four equations by hand.

    Meshes are so soft that they carry nothing, and the main shaft does not bend.
    """
    alone = two_bodies(machine)
    hub = np.array([0.0, 0.0, -4.0e4, 0.0, 6.0e4, 0.0])
    system = machine_system(alone, Level.RIGID, held_generator=True, flexible=mount)
    found = static(system, steady_load(alone, system, 0.0, hub))
    built = assembly(alone, Level.RIGID, flexible=mount)
    springs = [  # place, stiffness, and which bodies meet there
        (built.seats["main_bearing"][1][0], 4.0e9, (1.0, 0.0)),
        (built.seats["PLC-A"][1][0], 1.0e9, (1.0, -1.0)),
        (built.seats["PLC-B"][1][0], 1.0e9, (1.0, -1.0)),
        (sum(s.length for s in alone.shafts[0].sections or ()), SOFT[2], (0.0, 1.0)),
    ]
    turning = ("rotor", "LSS", "stage 1 carrier", "stage 1 planet")
    K, load = np.zeros((4, 4)), np.zeros(4)
    rows = []
    for x, k, (first, second) in springs:
        row = np.array([first, first * x, second, second * x])
        K += k * np.outer(row, row)
        rows.append(k * row)
    for body in built.bodies:
        part = slice(0, 2) if body.name.startswith(turning) else slice(2, 4)
        load[part] -= body.mass * GRAVITY * np.array([1.0, body.position[0]])
    load[:2] += hub[2], -hub[4]  # a moment about y lifts what is upwind
    by_hand = np.array(rows) @ np.linalg.solve(K, load)
    names = ("main_bearing", "PLC-A", "PLC-B", MOUNT)
    assert [found.wrench(name)[2] for name in names] == pytest.approx(by_hand, rel=2e-4)
    assert by_hand[1] * by_hand[2] < 0.0  # they take a couple


def two_bodies(machine: Machine) -> Machine:
    """The machine with a main shaft that hardly bends, and meshes that hardly carry."""
    main = machine.shafts[0]
    assert main.sections is not None
    wide = {"outer_diameter": 5.0, "end_diameter": 5.0}
    sections = tuple(s.model_copy(update=wide) for s in main.sections)
    light = main.material.model_copy(update={"youngs_modulus": 1e13, "density": 1.0})
    stiff = main.model_copy(update={"sections": sections, "material": light})
    keys = ("ring_planet", "sun_planet", "stiffness")
    stages = tuple(
        stage.model_copy(update={key: 1e2 for key in keys if hasattr(stage, key)})
        for stage in machine.stages
    )
    shafts = (stiff, *machine.shafts[1:])
    return machine.model_copy(update={"shafts": shafts, "stages": stages})


def test_loads_of_meshes_on_a_very_stiff_mount_are_those_on_the_ground(
    machine: Machine, mount: Flexible
) -> None:
    assert isinstance(mount.housing, Housing)
    stiff = replace(mount, housing=replace(mount.housing, stiffness=np.eye(6) * 1e16))
    ground, held, soft = (
        MeshResponses(machine, Level.RIGID, 2, 3, True, way).under(TORQUE).slices
        for way in (Flexible(), stiff, mount)
    )
    for name, forces in ground.items():
        np.testing.assert_allclose(held[name], forces, rtol=1e-5, atol=1.0)
    assert np.abs(soft["stage 1 sun-planet"] / ground["stage 1 sun-planet"] - 1.0).max() > 0.02


@pytest.mark.parametrize("mesh", ["stage 2 mesh", "stage 3 mesh"])
def test_load_along_the_face_is_that_of_the_tilt(
    machine: Machine, mount: Flexible, mesh: str
) -> None:
    """The gears' tilt against each other bends the load by hand: w = (k / b) (d + tilt x)."""
    count, stage = 9, machine.stages[int(mesh.split()[1]) - 1]
    sliced = machine.model_copy(
        update={"stages": tuple(s.model_copy(update={"slices": count}) for s in machine.stages)}
    )
    found = under_torque(sliced, mount)
    names = [f"{mesh} slice {k + 1}" for k in range(count)]
    forces = np.array([found.force(name) for name in names])
    spring = found.system.spring(names[0])
    direction = found.system.directions[spring]
    whole = f"stage {mesh.split()[1]}"
    turned = found.system.motion_of(f"{whole} gear", found.q)
    turned = turned - found.system.motion_of(f"{whole} pinion", found.q)
    tilt = direction[1] * turned[5] - direction[2] * turned[4]
    stiffness = stage.along_line(stage.stiffness)  # type: ignore[union-attr]
    most = 1.0 + abs(tilt) * stiffness * stage.face_width / 2.0 / forces.sum()
    ends = spread_at_ends(forces)
    assert float(ends.max() / forces.mean()) == pytest.approx(most, rel=1e-9)
    assert most > 1.01


def under_torque(machine: Machine, flexible: Flexible) -> Static:
    system = machine_system(machine, Level.RIGID, held_generator=True, flexible=flexible)
    return static(system, steady_load(machine, system, TORQUE, np.zeros(6)))


def test_gaps_act_on_a_housing_without_mass() -> None:
    """Slices that part load a housing that has no mass, as they do one that hardly has any."""
    given = on_soft_mount(**{"gearbox.weight": 0})
    machine = machine_of(given)
    none = stated_mount(given, machine)
    assert isinstance(none.housing, Housing)
    assert none.housing.mass == 0.0
    some = replace(none, housing=replace(none.housing, mass=1e-6, polar=1e-6, transverse=1e-6))
    tilted = np.array([0.0, 0.0, 0.0, 0.0, 3.0e6, 0.0])
    loads = [
        MeshResponses(machine, Level.RIGID, 2, 5, False, way).under(TORQUE, tilted).slices
        for way in (none, some)
    ]
    assert any((forces == 0.0).any() for forces in loads[0].values())  # some have parted
    for name, forces in loads[0].items():
        np.testing.assert_allclose(loads[1][name], forces, rtol=1e-6, atol=1.0)


def running_on(flexible: Flexible, machine: Machine, **asked: Any) -> Running:
    ratios = DampingRatios(shafts=0.02, meshes=0.1)
    return running(machine, Level.RIGID, TORQUE, SPEED, ratios, flexible=flexible, **asked)


def test_without_mass_a_housing_follows_as_a_heavy_one_does_slowly(
    machine: Machine, mount: Flexible
) -> None:
    """A torque that swings slowly: forces of bearings are those of statics, with mass or not."""
    assert isinstance(mount.housing, Housing)
    none = replace(mount, housing=replace(mount.housing, mass=0.0, polar=0.0, transverse=0.0))
    slow, fast = (apart(machine, mount, none, seconds) for seconds in (16.0, 0.16))
    assert slow < 2e-3
    assert fast > 10.0 * slow


def apart(machine: Machine, heavy: Flexible, none: Flexible, period: float) -> float:
    """Largest difference of the mount's force under a hub force that swings, over its largest."""
    forces = []
    for way in (heavy, none):
        of = running_on(way, machine)
        times = np.linspace(0.0, period, 201)
        rise = 0.5 - 0.5 * np.cos(2.0 * np.pi * times / period)
        push = of.system.load_on("rotor", np.array([0.0, 0.0, 1e5, 0.0, 0.0, 0.0]))
        n = len(of.system.names)
        still = State(np.zeros(n), np.zeros(n), np.zeros(n))
        found = integrate(
            of.equations, varying(push, times, rise * 1.0), period, period / 400, start=still
        )
        forces.append(of.system.wrench(MOUNT, found.forces)[:, 2])
    return float(np.abs(forces[0] - forces[1]).max() / np.abs(forces[0]).max())


def test_teeth_and_gaps_find_some_mass_in_a_housing_that_states_none() -> None:
    given = on_soft_mount(**{"gearbox.weight": 0})
    machine = machine_of(given)
    none = stated_mount(given, machine)
    plain, teeth, gaps = (
        running_on(none, machine, **asked) for asked in ({}, {"teeth": True}, {"backlash": 1e-4})
    )
    assert "housing uz" not in plain.system.names
    for of in (teeth, gaps):
        mass = of.system.body_mass[of.system.bodies.index("housing")]
        assert mass == pytest.approx(LIGHT * mass_inside(machine))
    assert (teeth.equations.springs.wave >= 0).any()
    rated = [machine_channels(of) for of in (plain, gaps)]
    names = ("force of PLC-A", "force of main_bearing", f"force of {MOUNT}")
    for name in names:
        one, other = (of.rated[of.names.index(name)] for of in rated)
        assert other == pytest.approx(one, rel=1e-3)


def test_momentum_and_energy_close_as_the_housing_rocks(machine: Machine, mount: Flexible) -> None:
    """What weights and the ground give in sum is what the whole gains in momentum."""
    of = running_on(mount, machine)
    turning = of.turning
    assert turning.beside is not None
    q = wind_up(of.equations, turning.beside, turning.velocity).q
    kick = of.system.load_on("rotor", np.array([0.0, 3.0e4, 5.0e4, 0.0, 0.0, 0.0]))
    loads = varying(np.column_stack([turning.beside, kick]), [0.0], [[1.0, 1.0]])
    begin = State(q, turning.velocity, np.zeros(len(q)))
    found = integrate(of.equations, loads, 0.5, 1e-3, start=begin)
    assert found.relative_imbalance < 1e-9
    lifted = on_base(of.system, assembly(of.machine, of.level, flexible=of.flexible).bodies)
    held = ("main_bearing", MOUNT)
    for axis in (1, 2):
        momentum = found.velocity @ of.equations.mass @ lifted[:, axis]
        whole = sum(of.system.wrench(name, found.forces)[:, axis] for name in held)
        pulled = loads.at(0.0) @ lifted[:, axis] - whole
        gained = np.concatenate([[0.0], np.cumsum(0.5 * (pulled[1:] + pulled[:-1]) * 1e-3)])
        # the state at the beginning is none of rest: its first step is another
        assert np.ptp((momentum - gained)[1:]) < 1e-6 * np.ptp(gained)


def test_a_condensed_main_shaft_has_its_torque_and_moves_with_its_base(
    drivetrain: Any, machine: Machine, mount: Flexible
) -> None:
    way = replace(mount, shafts={"LSS": beam_shaft(drivetrain, rings=False)})
    of = running_on(way, machine)
    assert of.equations.damping.any()
    channels = machine_channels(of)
    assert channels.rated[channels.names.index("torque of LSS")] == pytest.approx(TORQUE, rel=1e-9)
    bodies = assembly(of.machine, of.level, flexible=of.flexible).bodies
    moved = on_base(of.system, bodies)
    heavy = machine_system(machine, Level.FLEXIBLE, flexible=mount)
    expected = on_base(heavy, assembly(machine, Level.FLEXIBLE, flexible=mount).bodies)
    for axis in range(3):
        mass = moved[:, axis] @ of.equations.mass @ moved[:, axis]
        known = expected[:, axis] @ heavy.mass @ expected[:, axis]
        assert mass == pytest.approx(known, rel=2e-3)


@pytest.mark.parametrize(
    ("changes", "housing", "said"),
    [
        ({}, True, "on the springs of gearbox.stiffness"),
        ({"gearbox.weight": 0}, True, "none, so that it follows its mount at once"),
        (None, False, "since a main shaft without sections has no gearbox.stiffness"),
    ],
)
def test_plain_levels_have_the_mount_that_the_file_states(
    changes: dict[str, Any] | None, housing: bool, said: str
) -> None:
    lumped = read_drivetrain("synthetic_2mw")
    torsional, *others = plain_rungs(lumped if changes is None else on_soft_mount(**changes))
    assert torsional.flexible.housing is None
    assert not torsional.assumes
    for rung in others:
        assert (rung.flexible.housing is not None) == housing
        assert any(said in what for what in rung.assumes)
        assert ("a gearbox housing that moves" in rung.neglects) != housing


def test_the_torsional_level_knows_no_mount(machine: Machine, mount: Flexible) -> None:
    one, other = (
        machine_system(machine, Level.TORSIONAL, flexible=way) for way in (Flexible(), mount)
    )
    assert one.names == other.names
    np.testing.assert_array_equal(one.K, other.K)
