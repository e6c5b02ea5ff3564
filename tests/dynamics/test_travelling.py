"""Carriers that travel in time: the turning frame, quasi-static turns, energy, planets passing."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest

from fe_drivetrain.bearing.arrangements import cylindrical
from fe_drivetrain.cases.references.published_planetary import (
    LIN_PARKER_STAGE,
    plane_stage,
    plane_supports,
)
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.dynamics.bodies.bodies import Body, assemble
from fe_drivetrain.dynamics.bodies.elastic_ring import Rim, with_rim
from fe_drivetrain.dynamics.bodies.equations import equations_of, steady
from fe_drivetrain.dynamics.bodies.levels import Level, azimuths, machine_system, steady_load
from fe_drivetrain.dynamics.bodies.machine import library_machine
from fe_drivetrain.dynamics.bodies.meshing import Meshing, varying_equations
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.planetary import PlanetarySet, bodies_of, springs_of
from fe_drivetrain.dynamics.bodies.roller_seats import planet_seats, static_on_rollers
from fe_drivetrain.dynamics.bodies.springs import Spring
from fe_drivetrain.dynamics.bodies.static import Turn, over_a_turn
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.dynamics.time.integration import integrate
from fe_drivetrain.dynamics.time.motion import State
from fe_drivetrain.dynamics.time.schemes import generalised_alpha
from fe_drivetrain.dynamics.time.superposition import exact_steps
from fe_drivetrain.dynamics.time.travelling import (
    Travelling,
    TravellingCarriers,
    travelling,
    travelling_of,
)

GRC = library_machine("nrel_750kw")
STEEL = Material(youngs_modulus=2.06e11, poisson_ratio=0.3, density=7850.0)


def turned(stage: PlanetarySet, angle: float) -> PlanetarySet:
    return replace(stage, angles=tuple(psi + angle for psi in stage.angles))


def plane(angle: float, frame: float = 0.0) -> System:
    stage = turned(plane_stage(LIN_PARKER_STAGE, 3), angle)
    springs = [*springs_of(stage), *plane_supports(LIN_PARKER_STAGE, stage)]
    return assemble(bodies_of(stage), springs, frame_speed=frame)


def moving_plane() -> Travelling:
    return travelling_of(lambda at: (plane(at.get(1, 0.0)), ()), {1: 1.0})


def in_space(system: System, q: Floats, angle: float) -> Floats:
    """Motions of a frame that has turned by an angle, along axes that stand still."""
    found = q.copy()
    for k, name in enumerate(system.names):
        if name.endswith(" uy"):
            y, z = q[k], q[k + 1]
            found[k] = cos(angle) * y - sin(angle) * z
            found[k + 1] = sin(angle) * y + cos(angle) * z
    return found


def test_planets_that_travel_move_as_in_a_frame_that_turns_with_them() -> None:
    """Coriolis and centripetal terms of the turning frame are what rows that turn do."""
    speed = 1000.0
    frame = equations_of(plane(0.0, 1.0), speed)
    # let go where loads have bent it, so that its lowest modes move
    shapes = system_modes(plane(0.0)).shapes[:, 1:6]
    q0, v0 = 1e-5 * shapes @ np.ones(5), 0.01 * shapes @ np.array([1.0, -1.0, 0.0, 2.0, 0.5])
    duration = 1.6e-3  # 1.6 rad of the carrier
    exact = exact_steps(
        frame, steady(np.zeros(len(q0))), duration, duration, State(q0, v0, np.zeros(len(q0)))
    )[1][-1]
    carriers = moving_plane()
    system = carriers.system
    # the rate in space has the turning of the frame in it
    turns = (in_space(system, q0, 1e-6) - in_space(system, q0, -1e-6)) / 2e-6
    begin = State(q0, v0 + speed * turns, np.zeros(len(q0)))
    equations = equations_of(system, speed)
    missed = []
    for steps in (100, 200):
        found = integrate(
            equations,
            [TravellingCarriers(carriers, speed)],
            duration,
            duration / steps,
            start=begin,
        )
        assert found.converged
        end = in_space(system, found.q[-1], -speed * duration)
        missed.append(float(np.abs(end - exact).max() / np.abs(exact).max()))
    assert missed[0] / missed[1] == pytest.approx(4.0, rel=0.15)
    # at a standstill the answer is another one
    still = integrate(equations, steady(np.zeros(len(q0))), duration, duration / 400, start=begin)
    assert np.abs(still.q[-1] - exact).max() > 10 * missed[1] * np.abs(exact).max()


def test_energy_is_kept_with_what_turning_the_rows_takes() -> None:
    carriers, speed = moving_plane(), 400.0
    n = len(carriers.system.names)
    equations = equations_of(carriers.system, speed)
    damped = replace(
        equations, springs=replace(equations.springs, damping=1e-6 * equations.springs.stiffness)
    )
    rng = np.random.default_rng(2)
    begin = State(1e-5 * rng.normal(size=n), np.zeros(n), np.zeros(n))
    pull, turned_at = steady(1e3 * rng.normal(size=n)), TravellingCarriers(carriers, speed)
    for one in (equations, damped):
        lost = [
            integrate(one, [pull, turned_at], 2e-3, 2e-3 / steps, start=begin)
            for steps in (200, 400)
        ]
        ratio = lost[0].relative_imbalance / lost[1].relative_imbalance
        assert ratio == pytest.approx(4.0, rel=0.2)
        assert lost[1].relative_imbalance < 1e-2
    assert np.all(np.diff(lost[1].energies[:, 3]) >= 0.0)
    assert np.ptp(lost[1].energies[:, 4]) > 0.01 * lost[1].energies[:, 1].max()


def test_a_slow_turn_is_quasi_static() -> None:
    """Gravity, torque and a moment on the hub: loads of planet bearings over a turn."""
    speed, hub = 2.31, np.array([0, 0, 0, 0, -3e5, 0.0])
    carriers = travelling(GRC, held_generator=True)
    system = carriers.system
    load = steady_load(GRC, system, 3.25e5, hub)
    count = 24

    def at(azimuth: float) -> System:
        return machine_system(GRC, Level.RIGID, azimuth, held_generator=True)

    still = over_a_turn(at, lambda s: steady_load(GRC, s, 3.25e5, hub), azimuths(count))
    equations = varying_equations(system, {}, damping=1e-4)
    zero = np.zeros(len(load))
    begin = State(np.linalg.solve(system.K, load), zero, zero)
    dt = 2 * pi / speed / (count * 10)
    found = integrate(
        equations,
        [steady(load), TravellingCarriers(carriers, speed)],
        4 * pi / speed,
        dt,
        generalised_alpha(0.3),
        begin,
        every=10,
    )
    assert found.converged
    # the second turn
    last = found.forces[count:-1]
    moving = Turn(found.azimuth[count:-1], system.spring_names, last, system.directions)
    assert moving.azimuths == pytest.approx(2 * pi + azimuths(count), abs=1e-9)
    for name in ("stage 1 pin 1 upwind", "stage 1 pin 3 downwind"):
        mean = still.resultant(name).mean()
        assert np.ptp(still.resultant(name)) > 0.03 * mean
        # (2.3 rad/s over the lowest frequency)^2, and dampers of 1e-4 s
        assert np.abs(moving.resultant(name) - still.resultant(name)).max() < 2e-3 * mean
    # planets one after the other, each with the load of the one before it a third of a turn later
    one, two = (moving.resultant(f"stage 1 pin {k} upwind") for k in (1, 2))
    assert np.abs(np.roll(one, -count // 3) - two).max() < 2e-3 * one.mean()


def ring_with(harmonics: Sequence[int], at: Mapping[int, float]) -> tuple[System, tuple[()]]:
    stage = turned(plane_stage(LIN_PARKER_STAGE, 3), at.get(1, 0.0))
    rim = Rim(0.14, 0.02, 0.03, STEEL)
    bodies, springs = with_rim(stage, springs_of(stage), rim, harmonics)
    all_springs: list[Spring] = [*springs, *plane_supports(LIN_PARKER_STAGE, stage)]
    all_springs.append(Spring("generator", {"sun": np.eye(6)[3]}, 1e6))
    return assemble([*bodies_of(stage), *bodies], all_springs), ()


def test_planets_passing_bend_the_ring_and_mesh_lines_have_sidebands() -> None:
    speed, teeth = 2.0, 45  # a multiple of three: meshes in phase
    carriers = travelling_of(lambda at: ring_with((2, 3), at), {1: 1.0}, degree=4)
    system = carriers.system
    torque = np.zeros(6)
    torque[3] = 500.0
    load = system.load_on("carrier", torque)
    meshes = {f"ring-planet {k}": Meshing(1.6, teeth * speed / (2 * pi)) for k in (1, 2, 3)}
    count = 8 * teeth
    turn = 2 * pi / speed

    def lines(meshing: Mapping[str, Meshing]) -> Floats:
        equations = varying_equations(system, meshing, damping=2e-4)
        zero = np.zeros(len(load))
        begin = State(np.linalg.solve(system.K, load), zero, zero)
        found = integrate(
            equations,
            [steady(load), TravellingCarriers(carriers, speed)],
            2 * turn,
            turn / count,
            generalised_alpha(0.2),
            begin,
        )
        assert found.converged
        second = found.q[count:-1]
        both = [second[:, system.place(f"rim {n} cos ux")] for n in (3, 2)]
        return np.abs(np.fft.rfft(both)) * 2 / count

    # three planets bend the ring three times a turn in the third harmonic, not in the second
    three, two = lines({})
    assert three[3] > 1e3 * np.delete(three, 3).max()
    assert two.max() < 1e-6 * three[3]
    # and modulate the mesh as it is felt at a place of the ring
    mesh = lines(meshes)[0]
    beside = mesh[[teeth - 3, teeth + 3]]
    assert beside.min() > 100 * mesh[teeth]
    largest = np.argsort(mesh[teeth - 8 : teeth + 9])[-2:] - 8
    assert set(largest.tolist()) == {-3, 3}
    with pytest.raises(InputError, match=r"give n \+ 1 for a ring"):
        travelling_of(lambda at: ring_with((2, 3), at), {1: 1.0})


def test_planets_on_rollers_travel() -> None:
    bearing = cylindrical("planet bearing", 16, 0.04, 0.05, 0.225, laminae=5, clearance=20e-6)
    carriers = travelling(GRC, held_generator=True, rollers={1: bearing})
    system = carriers.system
    load = steady_load(GRC, system, 3.25e5, np.zeros(6))
    angle, speed = 1.1, 2.31

    def still(azimuth: float) -> tuple[Floats, Floats]:
        held = machine_system(GRC, Level.RIGID, azimuth, held_generator=True)
        found = static_on_rollers(held, load, planet_seats(GRC, 1, bearing, azimuth))
        assert found.converged
        return found.static.q, np.hypot(found.loads[:, 1], found.loads[:, 2])

    zero = np.zeros(len(load))
    found = integrate(
        varying_equations(system, {}, damping=1e-4),
        [steady(load), TravellingCarriers(carriers, speed)],
        angle / speed,
        angle / speed / 60,
        generalised_alpha(0.3),
        State(still(0.0)[0], zero, zero),
    )
    assert found.converged
    radial = np.hypot(*found.bearings.loads[-1, :, 1:3].T)
    assert radial == pytest.approx(still(angle)[1], rel=5e-3)
    assert np.abs(radial / still(0.0)[1] - 1).max() > 2e-2


def test_refusals() -> None:
    carriers = moving_plane()
    more = replace(carriers, rows=np.vstack([carriers.rows, carriers.rows]))
    other = TravellingCarriers(travelling(GRC), 1.0)
    with pytest.raises(InputError, match=r"a TravellingCarriers acts on \d+ degrees of freedom"):
        integrate(equations_of(carriers.system), [other], 1.0, 0.1)
    with pytest.raises(InputError, match="make them from the system of the carriers"):
        integrate(equations_of(carriers.system), [TravellingCarriers(more, 1.0)], 1.0, 0.1)
    with pytest.raises(InputError, match="time step is 0 s"):
        integrate(equations_of(carriers.system), [TravellingCarriers(carriers, 1.0)], 1.0, 0.0)

    def heavier(at: Mapping[int, float]) -> tuple[System, tuple[()]]:
        return assemble(
            [Body("disc", mass=1.0 + sum(at.values()), polar=1.0, transverse=1.0)], []
        ), ()

    with pytest.raises(InputError, match="masses of the system change"):
        travelling_of(heavier, {1: 1.0})
