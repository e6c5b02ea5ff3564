"""Terms of dynamics that plain data leave at zero, each against a form that has them elsewhere.

A term that is zero in all test data may be wrong, or missing, and no test sees it: dense matrices
beside springs, offsets, a frame that turns, a beginning later than at 0 s, places off the origin.
"""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_travelling import plane

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.drivetrain_file.turning_parts import BearingData
from fe_drivetrain.dynamics.bodies.bodies import Body, Superelement, assemble
from fe_drivetrain.dynamics.bodies.elastic_ring import Rim
from fe_drivetrain.dynamics.bodies.equations import (
    Equations,
    Loads,
    equations_of,
    equations_of_motion,
    fourier_wave,
    spring_laws,
    varying,
)
from fe_drivetrain.dynamics.bodies.levels import Level, assembly, machine_system
from fe_drivetrain.dynamics.bodies.machine import library_machine
from fe_drivetrain.dynamics.bodies.mesh_errors import harmonic_error
from fe_drivetrain.dynamics.bodies.meshing import Meshing, varying_equations
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.response import frequency_response, mesh_response
from fe_drivetrain.dynamics.bodies.roller_seats import static_on_rollers, without_bearings
from fe_drivetrain.dynamics.bodies.springs import Place, bushing
from fe_drivetrain.dynamics.bodies.static import static
from fe_drivetrain.dynamics.bodies.steady_state import wind_up
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.dynamics.time.integration import integrate
from fe_drivetrain.dynamics.time.mechanism import mechanism_of
from fe_drivetrain.dynamics.time.motion import State
from fe_drivetrain.dynamics.time.rolling_bearings import rolling_bearings
from fe_drivetrain.dynamics.time.step_control import StepControl
from fe_drivetrain.dynamics.time.superposition import exact_steps, modal_superposition
from fe_drivetrain.dynamics.time.travelling import TravellingCarriers, travelling_of

J = np.array([3.0, 1.0, 2.0])
ROWS = np.array([[1.0, -1.0, 0.0], [0.0, 1.0, -1.0], [0.0, 0.0, 1.0]])
K, C = np.array([50.0, 30.0, 20.0]), np.array([0.4, 0.3, 0.2])
PUSH = varying([1.0, 0.0, -0.5], [0.0, 0.4, 1.0], [0.0, 2.0, -1.0])
BEGIN = State(np.array([0.1, 0.0, 0.05]), np.array([0.0, 0.4, -0.2]), np.zeros(3))


def chain(damping: Floats = C) -> Equations:
    return equations_of_motion(J, spring_laws(ROWS, K, damping))


def accelerations(equations: Equations) -> Floats:
    return mechanism_of(equations, PUSH).settled(BEGIN, PUSH).acceleration


def later(state: State, by: float) -> State:
    return State(state.q, state.velocity, state.acceleration, state.time + by)


def shifted(loads: Loads, by: float) -> Loads:
    return Loads(loads.patterns, loads.times + by, loads.histories)


def test_dense_damping_acts_from_the_first_instant() -> None:
    """Accelerations at the beginning of what already moves, and the steady state of it."""
    dense = equations_of_motion(J, spring_laws(ROWS, K), ROWS.T @ np.diag(C) @ ROWS)
    one, other = (accelerations(e) for e in (chain(), dense))
    assert_allclose(other, one, rtol=1e-12)
    assert np.abs(one - accelerations(chain(0.0 * C))).max() > 0.01
    load, speed = [1.0, 0.0, -0.5], np.array([1.0, 1.0, 0.9])
    wound = [wind_up(e, load, speed).q for e in (chain(), dense)]
    assert_allclose(wound[1], wound[0], rtol=1e-9)


def test_what_begins_later_moves_as_what_begins_at_once() -> None:
    """Equal steps, steps by a tolerance, exact steps and modes: only the clock is another."""
    by = 3.7
    one = chain()
    plain = equations_of_motion(J, spring_laws(ROWS, K, 0.01 * K))
    for name, motion in {
        "equal": lambda s, p: integrate(one, p, 1.0, 0.05, start=s),
        "adaptive": lambda s, p: integrate(one, p, 1.0, StepControl(0.1, 1e-3), start=s),
    }.items():
        now, then = motion(BEGIN, PUSH), motion(later(BEGIN, by), shifted(PUSH, by))
        assert_allclose(then.times, now.times + by, err_msg=name)
        assert_allclose(then.q, now.q, atol=1e-12, err_msg=name)
    t, q, _ = exact_steps(one, PUSH, 1.0, 0.2, BEGIN)
    moved = exact_steps(one, shifted(PUSH, by), 1.0, 0.2, later(BEGIN, by))
    assert_allclose(moved[0], t + by)
    assert_allclose(moved[1], q, atol=1e-12)
    modes = modal_superposition(plain, PUSH, 1.0, 0.2, BEGIN)
    late = modal_superposition(plain, shifted(PUSH, by), 1.0, 0.2, later(BEGIN, by))
    assert_allclose(late.times, modes.times + by)
    assert_allclose(late.q, modes.q, atol=1e-12)


def test_the_guess_of_a_steady_state_takes_offsets_and_flanks() -> None:
    """A spring that is free at an elongation: displacements are moved by it, and forces are not."""
    free = np.array([0.3, -0.2, 0.1])
    gap = {"lower": -0.01, "upper": 0.01}
    plain = equations_of_motion(J, spring_laws(ROWS, K, **gap))
    offset = equations_of_motion(J, spring_laws(ROWS, K, offset=free, **gap))
    load = np.array([1.0, 0.2, 0.7])
    one, other = (wind_up(e, load) for e in (plain, offset))
    assert_allclose(ROWS @ other.q, ROWS @ one.q + free, atol=1e-9)
    assert other.iterations <= one.iterations + 1


HOLD = np.array([2e7, 3e7, 4e7, 5e5, 6e5, 7e5])


def turning(dense: bool) -> System:
    """A disc on a bushing to ground, in a frame that turns: by springs, or by a superelement."""
    body = Body("disc", (0.2, 0.0, 0.0), 40.0, 3.0, 1.7, speed=1.0)
    place = Place("disc", (0.2, 0.0, 0.0))
    springs = bushing("hold", place, None, (0.2, 0.0, 0.0), 0.6 * HOLD if dense else HOLD)
    elements = [Superelement("rest", ("disc",), np.diag(0.4 * HOLD))] if dense else []
    return assemble([body], springs, elements, frame_speed=1.0)


@pytest.mark.parametrize("make", [equations_of, lambda s, w: varying_equations(s, {}, w)])
def test_a_superelement_turns_with_its_frame_as_springs_do(make: object) -> None:
    speed = 130.0
    springs, dense = (make(turning(kind), speed) for kind in (False, True))  # type: ignore[operator]
    assert_allclose(dense.K, springs.K, rtol=1e-12, atol=1e-3)
    assert_allclose(dense.C, springs.C, rtol=1e-12, atol=1e-9)
    assert np.abs(springs.K - turning(False).K).max() > 1e5
    assert np.abs(springs.C).max() > 100.0


def test_a_harmonic_response_has_the_terms_of_a_frame_that_turns() -> None:
    """As the equations of motion have them, which exact steps and travelling planets check."""
    system, speed, f = turning(False), 130.0, np.array([20.0, 55.0])
    load = system.load_on("disc", np.array([0.0, 1e3, 0.0, 0.0, 0.0, 50.0]))
    whole = equations_of(system, speed)
    found = frequency_response(system, load, f, speed)
    for one, q in zip(2 * np.pi * f, found, strict=True):
        inside = (whole.K - one**2 * whole.mass + 1j * one * whole.C) @ q
        assert_allclose(inside, load, atol=1e-6 * np.abs(load).max())
    still = frequency_response(system, load, f)
    assert np.abs(found - still).max() > 0.02 * np.abs(still).max()


def test_a_rim_on_an_elastic_foundation_has_its_energy() -> None:
    """Radial cos(n phi) and, without stretching, tangential -sin(n phi) / n, by quadrature."""
    steel = Material(youngs_modulus=2.06e11, poisson_ratio=0.3, density=7850.0)
    plain = Rim(0.5, 0.04, 0.2, steel)
    held = replace(plain, radial=3e8, tangential=7e8)
    phi = np.arange(720) * 2 * np.pi / 720
    for n in (2, 3):
        radial, along = np.cos(n * phi), -np.sin(n * phi) / n
        twice = (3e8 * radial**2 + 7e8 * along**2).sum() * 0.5 * 2 * np.pi / 720
        assert held.stiffness(n) - plain.stiffness(n) == pytest.approx(twice, rel=1e-10)


def test_springs_with_laws_act_beside_rollers_as_without_them() -> None:
    """Waves, errors, dampers, gaps and offsets, from a later instant on."""
    place = Place("shaft", (0.0, 0.0, 0.0))
    body = Body("shaft", mass=100.0, polar=4.0, transverse=9.0)
    springs = bushing("b", place, None, (0.3, 0.1, -0.2), np.array([1e8, 1e8, 1e8, 1e6, 1e6, 1e6]))
    system = assemble([body], springs)
    bare = without_bearings(system, [])
    count = len(system.spring_names)
    wave = np.full(count, -1)
    wave[1] = 0
    offset, low, damping = np.zeros(count), np.zeros(count), 1e-4 * system.stiffness
    offset[2], offset[3], low[2] = 2e-5, 1e-3, -1e-5
    error = np.full(count, -1)
    error[1] = 0
    laws = (
        spring_laws(system.rows, system.stiffness, damping, lower=low, upper=-low, offset=offset)
        .in_phase(frequency=35.0)
        .with_waves(fourier_wave([0.3], [0.1])[None], wave)
        .with_errors(harmonic_error([4e-6], [0.0]).table[None], error)
    )
    equations = equations_of_motion(bare.mass, laws)
    load = system.load_on("shaft", np.array([3e3, -2e3, 5e3, 100.0, 400.0, -300.0]))
    pull = varying(load, [2.0, 2.01], [0.0, 1.0])
    begin = State(np.zeros(6), np.full(6, 1e-3), np.zeros(6), 2.0)
    one = integrate(equations, pull, 0.02, 1e-4, start=begin)
    acting = [pull, rolling_bearings(bare, [])]
    other = integrate(equations, acting, 0.02, 1e-4, start=begin)
    assert_allclose(other.times, one.times)
    assert_allclose(other.q, one.q, rtol=1e-7, atol=1e-9 * np.abs(one.q).max())
    assert_allclose(other.forces, one.forces, rtol=1e-6, atol=1e-7 * np.abs(one.forces).max())
    assert_allclose(other.energies, one.energies, rtol=1e-6, atol=1e-8 * one.energies.max())
    assert other.end.time == pytest.approx(one.end.time)


def test_gaps_and_contacts_act_beside_rollers_as_without_them() -> None:
    system = turning(False)
    load = system.load_on("disc", np.array([1e3, -2e3, 900.0, 20.0, 10.0, -30.0]))
    gaps, contacts = {"hold ux": 2e-5, "hold uz": -1e-5}, ["hold uy", "hold uz"]
    held = replace(system, extra=system.extra + np.diag([0, 1e6, 1e6, 0, 0, 0.0]))
    one = static(held, load, gaps, contacts)
    other = static_on_rollers(held, load, [], gaps, contacts).static
    assert_allclose(other.q, one.q, rtol=1e-9, atol=1e-15)
    assert_allclose(other.forces, one.forces, rtol=1e-7, atol=1e-6)
    assert one.closed.tolist() != [True] * len(one.closed)


def test_a_mesh_in_a_frame_that_turns_answers_its_error_as_the_equations_of_motion_do() -> None:
    speed, f = 300.0, np.array([400.0])
    system = plane(0.3, 1.0)
    mesh = next(name for name in system.spring_names if "sun" in name and "planet" in name)
    meshing = {mesh: Meshing(1.5, 1.0, error=harmonic_error([1e-6], [0.0]))}
    found = mesh_response(system, meshing, f, speed=speed, damping=1e-6)
    e = equations_of(system, speed)
    w = 2 * np.pi * float(f[0])
    C = e.C + 1e-6 * system.rows.T @ (system.stiffness[:, None] * system.rows)
    i = system.spring_names.index(mesh)
    pushed = (1 + 1j * w * 1e-6) * system.stiffness[i] * system.rows[i] * 1e-6
    assert_allclose(
        (e.K - w**2 * e.mass + 1j * w * C) @ found.motions[0],
        pushed,
        atol=1e-9 * np.abs(pushed).max(),
    )
    still = mesh_response(system, meshing, f, damping=1e-6)
    assert np.abs(found.motions - still.motions).max() > 0.01 * np.abs(still.motions).max()


def in_matrix(system: System, which: list[int]) -> System:
    """With some springs as a dense matrix."""
    k = np.zeros(len(system.stiffness))
    k[which] = system.stiffness[which]
    extra = system.extra + system.rows.T @ (k[:, None] * system.rows)
    return replace(system, stiffness=system.stiffness - k, extra=extra)


def test_a_matrix_travels_as_its_springs_do() -> None:
    """Planets that travel: pins as springs, and as a matrix that turns with the carrier."""
    pins = [k for k, name in enumerate(plane(0.0).spring_names) if name.startswith("pin ")]
    assert pins
    kinds = [
        travelling_of(lambda at: (plane(at.get(1, 0.0)), ()), {1: 1.0}),
        travelling_of(lambda at: (in_matrix(plane(at.get(1, 0.0)), pins), ()), {1: 1.0}),
    ]
    n, speed = len(kinds[0].system.names), 300.0
    rng = np.random.default_rng(2)
    begin = State(1e-5 * rng.normal(size=n), np.zeros(n), np.zeros(n))
    pull = varying(1e3 * rng.normal(size=n), [0.0, 1e-3], [0.2, 1.0])
    one, other = (
        integrate(
            equations_of(kind.system, speed),
            [pull, TravellingCarriers(kind, speed)],
            5e-4,
            1e-5,
            start=begin,
        )
        for kind in kinds
    )
    assert_allclose(other.q, one.q, rtol=1e-7, atol=1e-9 * np.abs(one.q).max())
    assert_allclose(other.energies, one.energies, rtol=1e-6, atol=1e-7 * one.energies.max())
    # with a matrix beside that does not turn, what is beside the carriers' own
    beside = replace(equations_of(kinds[0].system), damping=0.1 * np.eye(n))
    beside = replace(beside, extra=beside.extra + 1e6 * np.eye(n))
    late = later(begin, 0.0)
    still = integrate(beside, pull, 5e-4, 1e-5, start=late)
    at_stand = TravellingCarriers(kinds[0], 0.0)
    stands = integrate(beside, [pull, at_stand], 5e-4, 1e-5, start=late)
    assert_allclose(stands.q, still.q, rtol=1e-7, atol=1e-9 * np.abs(still.q).max())
    kept = [0, 1, 2, 4]
    scale = 1e-6 * still.energies.max()
    assert_allclose(stands.energies[:, kept], still.energies[:, kept], rtol=1e-5, atol=scale)
    # losses by trapezia of the power on one side, of the force on the other: apart by the square
    finer = integrate(beside, [pull, at_stand], 5e-4, 2.5e-6, start=late)
    exact = integrate(beside, pull, 5e-4, 2.5e-6, start=late)
    far, near = (
        a.energies[-1, 3] - b.energies[-1, 3] for a, b in ((stands, still), (finer, exact))
    )
    assert far / near == pytest.approx(16.0, rel=0.3)
    moved = integrate(beside, [shifted(pull, 2.0), at_stand], 5e-4, 1e-5, start=later(begin, 2.0))
    assert_allclose(moved.times, stands.times + 2.0)
    assert moved.end.time == pytest.approx(stands.end.time + 2.0)
    assert_allclose(moved.q, stands.q, rtol=1e-7, atol=1e-9 * np.abs(still.q).max())


@pytest.mark.parametrize("kind", ["shaft", "rigid"])
def test_a_bearing_of_a_later_shaft_holds_that_shaft_where_it_is(kind: str) -> None:
    """Rigid rotations about the origin move it by its whole distance from there."""
    machine = library_machine("nrel_750kw")
    shaft = machine.shafts[1]
    given = {"kind": "rigid", "torsion": None} if kind == "rigid" else {"kind": "shaft"}
    shafts = (machine.shafts[0], shaft.model_copy(update=given), *machine.shafts[2:])
    more = BearingData(name="B", holds=shaft.name, at=0.5, stiffness=(1e8, 1e9, 1e9, 0, 0, 0))
    changed = machine.model_copy(update={"shafts": shafts, "bearings": (*machine.bearings, more)})
    parts = assembly(changed, Level.RIGID)
    at = np.array([x + d for x, d in zip(changed.axes[1], (0.5, 0.0, 0.0), strict=True)])
    centres = {body.name: np.array(body.position) for body in parts.bodies}
    by = {spring.name: spring.by for spring in parts.springs}
    for axis in np.eye(3):
        stretch = [
            sum(
                float(row[:3] @ np.cross(axis, centres[body]) + row[3:] @ axis)
                for body, row in by[f"B u{one}"].items()
            )
            for one in "xyz"
        ]
        assert_allclose(np.abs(stretch), np.abs(np.cross(axis, at)), atol=1e-9)


def test_a_ring_that_is_held_firmly_is_one_that_stands() -> None:
    machine = library_machine("park_2021")
    stage = machine.stages[0]
    body = stage.planet.model_copy(update={"inertia": 30.0, "mass": 300.0})
    firm = (1e14,) * 6
    free = stage.model_copy(update={"ring": body, "ring_support": firm})
    moved = machine.model_copy(update={"stages": (free, *machine.stages[1:])})
    stands, held = (
        system_modes(machine_system(one, Level.RIGID)).frequencies for one in (machine, moved)
    )
    low = stands[stands < 500.0]
    assert_allclose(held[: len(low)], low, rtol=1e-5, atol=1e-3)
    soft = machine.model_copy(
        update={
            "stages": (free.model_copy(update={"ring_support": (1e8,) * 6}), *machine.stages[1:])
        }
    )
    less = system_modes(machine_system(soft, Level.RIGID)).frequencies
    assert less[1] < 0.999 * stands[1]
