"""A machine that runs, against closed forms, statics, and the shutdown of torsional tables."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from small_drivetrain import GENERATOR, ROTOR, SPEED, STIFFNESS, TORQUE, two_masses

from fe_drivetrain.cases.references import published_drivetrains
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.drivetrain_file import DampingRatios
from fe_drivetrain.dynamics import (
    Brake,
    Level,
    Machine,
    StopSequence,
    damped_by_ratio,
    library_machine,
    machine_of,
    shutdown,
    torsional,
    transient,
)
from fe_drivetrain.dynamics.bodies.damping_ratios import element_of
from fe_drivetrain.dynamics.time.machine_channels import Channels, machine_channels
from fe_drivetrain.dynamics.time.motion import Motion
from fe_drivetrain.dynamics.time.running import running
from fe_drivetrain.dynamics.time.stopping import stop_phases

RATED = 2e6 / 1.895
RATIOS = DampingRatios(shafts=0.006, meshes=0.1)


def sliced_once(name: str) -> Machine:
    """A library machine whose meshes are in one point each."""
    machine = library_machine(name)
    stages = tuple(stage.model_copy(update={"slices": 1}) for stage in machine.stages)
    return machine.model_copy(update={"stages": stages})


def stopped(machine: Machine, level: Level, when: StopSequence) -> tuple[Motion, Channels]:
    of = running(machine, level, RATED, 1.895, RATIOS)
    torque = abs(of.turning.generator_torque)
    disc = Brake(of.disc("generator"), torque, when.braked, when.rise)
    phases, start = stop_phases(of.equations, of.turning, when, [disc], 0.01)
    return transient(phases, 1e-3, start), machine_channels(of)


def test_a_stop_is_that_of_the_torsional_table() -> None:
    """Inertias are the same: planets of the table have no mass that goes round with a carrier."""
    when = StopSequence(off=0.2, pitched=1.0, braked=1.0, end=3.0)
    machine = library_machine("synthetic_2mw")
    motion, channels = stopped(machine, Level.TORSIONAL, when)
    table, first = published_drivetrains.table("drivetrain_c"), machine.stages[0]
    round_it = first.planets * first.planet.mass * first.centre_distance**2
    stage = table.stages[0].model_copy(update={"carrier": table.stages[0].carrier + round_it})
    table = table.model_copy(update={"stages": (stage, *table.stages[1:])})
    known = shutdown(table, RATED, 1.895, 1.0, when, dt=1e-3, ratios=(0.006, 0.1))
    for shaft in ("LSS", "HSS"):
        k = channels.names.index(f"torque of {shaft}")
        own = channels.of(motion)[:, k] / channels.rated[k]
        assert_allclose(own, known.ratio(shaft), atol=1e-6)


def test_dampers_of_the_torsional_level_are_those_by_ratio() -> None:
    machine = sliced_once("synthetic_2mw")
    simple = torsional(machine)
    meshes = {e.name for e in simple.elements if e.name.startswith("stage")}
    named = {e.name: 0.1 if e.name in meshes else 0.006 for e in simple.elements}
    known = {e.name: e.damping for e in damped_by_ratio(simple, named).elements}
    found = running(machine, Level.TORSIONAL, RATED, 1.895, RATIOS).system
    for name, own in zip(found.spring_names, found.damping, strict=True):
        if name.removesuffix(" rx") in known:
            assert_allclose(own, known[name.removesuffix(" rx")], rtol=1e-9)


@pytest.mark.parametrize("level", [Level.RIGID, Level.FLEXIBLE])
def test_torsion_is_damped_equally_at_every_level(level: Level) -> None:
    """Sums over slices, and damping over stiffness of elements in series."""
    machine = library_machine("nrel_5mw")
    simple, full = (
        running(machine, one, 3.9e6, 1.267, RATIOS).system for one in (Level.TORSIONAL, level)
    )
    for name in ("stage 1 sun-planet 1", "stage 3 mesh"):
        sums = [
            sum(
                c
                for c, spring in zip(one.damping, one.spring_names, strict=True)
                if element_of(spring) == name
            )
            for one in (simple, full)
        ]
        assert_allclose(*sums, rtol=1e-9)
    whole = 1.0 / sum(
        1.0 / c
        for c, spring in zip(full.damping, full.spring_names, strict=True)
        if element_of(spring) == "LSS rx"
    )
    assert_allclose(whole, simple.damping[simple.spring("LSS rx")], rtol=1e-9)


@pytest.mark.parametrize("level", list(Level))
def test_nothing_rings_before_anything_happens(level: Level) -> None:
    when = StopSequence(off=0.5, pitched=0.6, braked=0.55, end=0.7)
    motion, channels = stopped(library_machine("park_2021"), level, when)
    before = channels.of(motion)[motion.times < 0.5]
    size = np.abs(before).max(axis=0)
    assert (np.ptp(before, axis=0) < 1e-6 * size.max()).all()
    assert motion.relative_imbalance < 1e-8
    torques = np.array([kind == "torque" for kind in channels.kinds])
    assert_allclose(before[0, torques], channels.rated[torques], rtol=1e-9)


def test_forces_at_rated_torque_are_those_of_statics() -> None:
    """Torque of each shaft by its ratio; force of a mesh by the torque over its base radius."""
    machine = library_machine("synthetic_2mw")
    channels = machine_channels(running(machine, Level.TORSIONAL, RATED, 1.895))
    rated = dict(zip(channels.names, channels.rated, strict=True))
    for shaft, ratio in zip(machine.shafts, machine.speeds, strict=True):
        assert_allclose(rated[f"torque of {shaft.name}"], RATED / abs(ratio), rtol=1e-9)
    stage = machine.stages[-1]
    mesh = stage.meshing
    lever = stage.gear_radius * np.cos(mesh.pressure_angle) * np.cos(mesh.base_helix)
    torque = RATED / abs(machine.speeds[-2])
    assert_allclose(rated["force of stage 3 mesh"], torque / lever, rtol=1e-9)
    assert all(value > 0.0 for value in rated.values())


def two_mass(level: Level = Level.TORSIONAL) -> tuple[Machine, Floats]:
    return machine_of(two_masses()), np.array([ROTOR, GENERATOR])


def test_losing_the_generator_swings_as_two_masses_do() -> None:
    """T (J2 - J1) / (J1 + J2) with the rotor's torque held."""
    machine, (J1, J2) = two_mass()
    of = running(machine, Level.TORSIONAL, TORQUE, SPEED, DampingRatios())
    when = StopSequence(off=0.1, pitched=1e3, left=1.0, end=2.0)
    phases, start = stop_phases(of.equations, of.turning, when, [], 0.01)
    motion = transient(phases, 5e-4, start)
    channels = machine_channels(of)
    torque = channels.of(motion)[:, channels.names.index("torque of shaft")]
    assert_allclose(torque.max(), TORQUE, rtol=1e-6)
    assert_allclose(torque.min(), TORQUE * (J2 - J1) / (J1 + J2), rtol=2e-4)
    period = 2 * np.pi / np.sqrt(STIFFNESS * (1 / J1 + 1 / J2))
    assert_allclose((motion.times[torque.argmin()] - 0.1) / period % 1.0, 0.5, atol=2e-3)


def test_a_brake_takes_momentum_by_its_torque_until_the_disc_stands() -> None:
    """J1 w1 + J2 w2 falls by the brake's torque times time, whatever the shaft does."""
    machine, J = two_mass()
    of = running(machine, Level.TORSIONAL, TORQUE, SPEED, DampingRatios())
    when = StopSequence(off=0.1, pitched=0.1001, braked=0.5, end=8.0)
    disc = Brake(of.disc("generator"), 2e6, 0.5)
    phases, start = stop_phases(of.equations, of.turning, when, [disc], 0.01)
    motion = transient(phases, 1e-3, start)
    momentum = motion.velocity @ J
    first = motion.braking.events[0][0]
    begun = float(J.sum() * SPEED)
    slips = (motion.times > 0.5) & (motion.times < first)
    ideal = begun - 2e6 * (motion.times[slips] - 0.5)
    # the rotor's torque falls within a tenth of a millisecond, evenly
    assert_allclose(momentum[slips], ideal + 0.5 * 1e-4 * TORQUE, rtol=0, atol=1e-4 * begun)
    # all of the kinetic energy is gone when both stand: half of J w^2 over the power of the brake
    still = begun / 2e6 + 0.5
    period = 2 * np.pi * np.sqrt(ROTOR / STIFFNESS)
    stands = [t for t, what in motion.braking.events if what == "sticks"][-1]
    assert abs(stands - still) < period


def test_a_disc_stands_on_a_shaft_or_a_body_that_turns() -> None:
    of = running(library_machine("synthetic_2mw"), Level.TORSIONAL, RATED, 1.895)
    assert_allclose(of.disc("HSS"), of.row("stage 3 pinion"))
    assert_allclose(of.disc("LSS"), of.row("rotor"))
    with pytest.raises(InputError, match=r"brake on 'HSP'.*use one of LSS"):
        of.disc("HSP")
    with pytest.raises(InputError, match="does not turn"):
        of.disc("stage 1 ring")


@pytest.mark.parametrize(
    ("torque", "speed", "backlash", "said"),
    [
        (0.0, 1.0, 0.0, "rated torque of the rotor is 0 N m but must be above 0"),
        (1e6, np.nan, 0.0, "rated speed of the rotor is nan rad/s"),
        (1e6, 1.0, 0.02, "backlash is 0.02 m but must be from 0 to 0.01 m"),
    ],
)
def test_what_cannot_run_is_refused(
    torque: float, speed: float, backlash: float, said: str
) -> None:
    machine = library_machine("park_2021")
    with pytest.raises(InputError, match=said):
        running(machine, Level.TORSIONAL, torque, speed, backlash=backlash)


def test_loads_at_the_hub_hold_what_the_rotor_takes() -> None:
    """Without the rotor's mass across the axis, with its weight and its polar inertia."""
    machine = library_machine("synthetic_2mw")
    whole, light = (
        running(machine, Level.RIGID, RATED, 1.895, hub_loads=own) for own in (False, True)
    )
    assert_allclose(light.turning.beside, whole.turning.beside)
    assert_allclose(light.inertia, whole.inertia, rtol=1e-9)
    at = whole.system.place("rotor uy")
    gone = whole.system.mass[at, at] - light.system.mass[at, at]
    assert 0.99 * machine.rotor.mass < gone < machine.rotor.mass
    rated = [machine_channels(of).rated for of in (whole, light)]
    assert_allclose(*rated, rtol=1e-6, atol=1.0)
