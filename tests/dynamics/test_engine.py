"""All that acts in time, together: each combination against a closed form or another method."""

from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from test_travelling import in_space, moving_plane, plane

from fe_drivetrain.bearing.arrangements import cylindrical, double_row_tapered
from fe_drivetrain.bearing.contact import ContactLaw
from fe_drivetrain.bearing.contact_forces import forces
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.bodies import Body, assemble
from fe_drivetrain.dynamics.bodies.equations import (
    Equations,
    equations_of,
    equations_of_motion,
    fourier_wave,
    joined_laws,
    spring_laws,
    steady,
    summed,
    varying,
)
from fe_drivetrain.dynamics.bodies.mesh_errors import harmonic_error
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.roller_seats import seat, without_bearings
from fe_drivetrain.dynamics.bodies.springs import Place, bushing
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.dynamics.time.base_motion import base_motion, on_base, read_base_motion
from fe_drivetrain.dynamics.time.brakes import Brake
from fe_drivetrain.dynamics.time.integration import Phase, integrate, transient
from fe_drivetrain.dynamics.time.machines import slip_line
from fe_drivetrain.dynamics.time.mechanism import Act
from fe_drivetrain.dynamics.time.motion import Motion, State
from fe_drivetrain.dynamics.time.rolling_bearings import bearings_on, rolling_bearings
from fe_drivetrain.dynamics.time.schemes import LINEAR, generalised_alpha
from fe_drivetrain.dynamics.time.step_control import StepControl
from fe_drivetrain.dynamics.time.superposition import exact_steps
from fe_drivetrain.dynamics.time.travelling import Travelling, TravellingCarriers, travelling_of

SHAFT = Place("shaft", (0.0, 0.0, 0.0))
AT = (0.3, 0.1, -0.2)
FIVE = [0, 1, 2, 4, 5]
WEAK = np.array([1e8, 1e8, 1e8, 0.0, 1e6, 1e6])


def tapered(law: ContactLaw | None = None, clearance: float = -20e-6) -> Bearing:
    return double_row_tapered("pair", 20, 0.03, 0.04, 0.3, 15, 0.08, "O", law, clearance=clearance)


def shaft_on(stiffness: Floats) -> System:
    """A shaft in one bearing, free to turn."""
    body = Body("shaft", mass=100.0, polar=4.0, transverse=9.0)
    return assemble([body], bushing("b", SHAFT, None, AT, stiffness))


def on_rollers(bearing: Bearing, damping: float = 0.0) -> tuple[Equations, Act]:
    bare = without_bearings(shaft_on(WEAK), seats := [seat("b", bearing, SHAFT, None, AT)])
    return equations_of(bare), rolling_bearings(bare, seats, damping)


def linear_pair() -> tuple[Equations, Act, Equations]:
    """Rollers of a linear law, all in contact, and the bushing that they are."""
    bearing = tapered(ContactLaw(5e8, 1.0), clearance=-300e-6)
    whole = np.zeros((6, 6))
    tangent = forces(bearing, np.zeros((1, 5)))[1][0]
    whole[np.ix_(FIVE, FIVE)] = (tangent + tangent.T) / 2
    return *on_rollers(bearing), equations_of(shaft_on(whole))


# a calliper at a radius of 0.4 m: its friction turns the disc and pushes it into the bearing
CALLIPER = Brake(np.array([0.0, 0.0, 1.0, 0.4, 0.0, 0.0]), 3e4, 2e-3, 1e-3)
TURNING = State(np.zeros(6), np.array([0.0, 0.0, 0.0, 9.0, 0.0, 0.0]), np.zeros(6))
PUSH = varying([2e3, -1e3, 4e3, 5e3, 100.0, -50.0], [0.0, 4e-3, 2e-2], [0.0, 1.0, 0.2])


def test_a_brake_on_rollers_is_one_on_the_bushing_that_they_are() -> None:
    on_rolls, bearings, plain = linear_pair()
    begin = replace(TURNING, velocity=TURNING.velocity / 10)
    one = integrate(plain, [PUSH, CALLIPER], 3.5e-3, 2.5e-5, start=begin)
    other = integrate(on_rolls, [PUSH, bearings, CALLIPER], 3.5e-3, 2.5e-5, start=begin)
    assert [what for _, what in other.braking.events] == [what for _, what in one.braking.events]
    assert {"stops", "sticks"} <= {what for _, what in one.braking.events}
    times = [[t for t, _ in motion.braking.events] for motion in (one, other)]
    assert_allclose(times[1], times[0], rtol=1e-7)
    assert_allclose(other.q, one.q, rtol=0, atol=1e-7 * np.abs(one.q).max())
    torque = np.abs(one.braking.torque).max()
    assert_allclose(other.braking.torque, one.braking.torque, rtol=0, atol=1e-6 * torque)


def order_of_imbalance(run: object, steps: tuple[float, float]) -> float:
    coarse, fine = (run(step) for step in steps)  # type: ignore[operator]
    assert coarse.converged
    assert fine.converged
    return float(coarse.relative_imbalance / fine.relative_imbalance)


def test_energy_closes_with_a_brake_on_rollers_that_leave_and_come_back() -> None:
    equations, bearings = on_rollers(tapered(clearance=30e-6), damping=1e-5)

    def run(dt: float) -> Motion:
        return integrate(equations, [PUSH, bearings, CALLIPER], 0.02, dt, start=TURNING)

    assert order_of_imbalance(run, (5e-5, 2.5e-5)) > 3.0
    found = run(5e-5)
    loads = np.abs(found.bearings.loads).max(axis=(1, 2))
    assert loads.min() < 1e-3 * loads.max()
    # friction takes energy at the calliper, and the bearing's damper its own
    assert found.energies[-1, 2] < 0.0
    assert found.energies[-1, 3] > 0.0


def test_a_disc_held_beside_a_stiffness_by_angle_is_its_equation_of_motion() -> None:
    """Slip and stick of a shaft whose stiffness goes with its angle, by solve_ivp."""
    J, k, friction = (3.0, 1.0), 50.0, 30.0
    wave = fourier_wave([0.3], [0.1])
    laws = spring_laws([[1.0, -1.0]], k).in_phase(turns=[[0.4, 0.0]]).with_waves(wave[None])

    def kappa(phase: float) -> tuple[float, float]:
        w = 2 * pi
        c, s = np.cos(w * phase), np.sin(w * phase)
        return 1 + 0.3 * c + 0.1 * s, w * (0.1 * c - 0.3 * s)

    def forces_on(y: Floats) -> tuple[float, float]:
        value, slope = kappa(0.4 * y[0])
        wound = y[0] - y[1]
        return -k * value * wound - 0.4 * 0.5 * k * slope * wound**2, k * value * wound

    def slips(_: float, y: Floats) -> list[float]:
        rotor, disc = forces_on(y)
        return [y[2], y[3], rotor / J[0], (disc - friction) / J[1]]

    def stands(_: float, y: Floats) -> list[float]:
        return [y[2], 0.0, forces_on(y)[0] / J[0], 0.0]

    def speed(_: float, y: Floats) -> float:
        return float(y[3])

    speed.terminal = True  # type: ignore[attr-defined]
    given = {"rtol": 1e-11, "atol": 1e-12}
    one = solve_ivp(slips, (0.0, 3.0), [0.0, 0.0, 1.0, 1.0], events=speed, **given)
    at = float(one.t_events[0][0])
    held = solve_ivp(stands, (at, 1.0), [*one.y[:3, -1], 0.0], **given)
    equations = equations_of_motion(J, laws)
    begin = State(np.zeros(2), np.ones(2), np.zeros(2))
    disc = Brake(np.array([0.0, 1.0]), friction, 0.0)
    missed = []
    for dt in (1e-3, 5e-4):
        found = integrate(equations, [disc], 1.0, dt, start=begin)
        assert [what for _, what in found.braking.events] == ["stops", "sticks"]
        assert found.braking.events[0][0] == pytest.approx(at, rel=1e-4)
        missed.append(float(np.abs(found.q[-1] - held.y[:2, -1]).max()))
    assert missed[0] / missed[1] == pytest.approx(4.0, rel=0.1)
    assert found.relative_imbalance < 1e-4


def plane_start(speed: float) -> tuple[State, Floats, Floats]:
    """Planets let go, in space; and where they are in the frame that turns."""
    shapes = system_modes(plane(0.0)).shapes[:, 1:6]
    q0, v0 = 1e-5 * shapes @ np.ones(5), 0.01 * shapes @ np.array([1.0, -1.0, 0.0, 2.0, 0.5])
    turns = (in_space(moving_plane().system, q0, 1e-6) - in_space(
        moving_plane().system, q0, -1e-6
    )) / 2e-6  # fmt: skip
    return State(q0, v0 + speed * turns, np.zeros(len(q0))), q0, v0


def test_planets_travel_with_steps_of_their_own_choice() -> None:
    """Against exact steps of the frame that turns with them."""
    speed, duration = 1000.0, 1e-3
    begin, q0, v0 = plane_start(speed)
    nothing = steady(np.zeros(len(q0)))
    start = State(q0, v0, np.zeros(len(q0)))
    frame = equations_of(plane(0.0, 1.0), speed)
    exact = exact_steps(frame, nothing, duration, duration, start)[1][-1]
    carriers = moving_plane()
    missed = {}
    for tolerance in (1e-3, 1e-5):
        found = integrate(
            equations_of(carriers.system, speed),
            [TravellingCarriers(carriers, speed)],
            duration,
            StepControl(2e-5, tolerance),
            start=begin,
        )
        assert found.control.errors.max() <= tolerance
        assert found.control.steps.sum() == pytest.approx(duration)
        assert found.azimuth[-1] == pytest.approx(speed * duration)
        end = in_space(carriers.system, found.q[-1], -speed * duration)
        missed[tolerance] = np.abs(end - exact).max() / np.abs(exact).max()
    # steps go with the cube root of the tolerance, errors with their square
    assert missed[1e-5] < 0.15 * missed[1e-3]
    assert missed[1e-5] < 1e-2


def test_a_disc_that_stands_among_planets_that_travel_is_a_very_heavy_one() -> None:
    speed = 400.0
    carriers = moving_plane()
    n = len(carriers.system.names)
    sun = carriers.system.place("sun rx")
    row = np.eye(n)[sun]
    equations = equations_of(carriers.system, speed)
    pull = steady(1e3 * np.random.default_rng(4).normal(size=n))
    turning = TravellingCarriers(carriers, speed)
    held = integrate(equations, [pull, turning, Brake(row, 1e9, 0.0)], 1e-3, 1e-5)
    heavy = replace(equations, mass=equations.mass + np.diag(1e9 * row))
    other = integrate(heavy, [pull, turning], 1e-3, 1e-5)
    assert held.braking.held.all()
    assert np.abs(held.q[:, sun]).max() == 0.0
    assert_allclose(held.q, other.q, rtol=0, atol=1e-7 * np.abs(other.q).max())
    # what holds it is what the heavy one has of inertia
    push = 1e9 * np.gradient(other.velocity[:, sun], other.times)
    torque = held.braking.torque[5:-5, 0]
    assert_allclose(torque, -push[5:-5], rtol=0, atol=2e-2 * np.abs(torque).max())


def test_rollers_in_a_carrier_that_turns_have_internal_damping() -> None:
    """m z'' + c (z' - i W z) + k z = 0, z = y + i x across the axis: closed form."""
    law = ContactLaw(2e8, 1.0)
    bearing = cylindrical("pin", 12, 0.03, 0.04, 0.2, law=law, clearance=-1e-4)
    body = Body("planet", mass=40.0, polar=1.0, transverse=1.0)
    place = Place("planet", (0.0, 0.0, 0.0))
    stiff = np.array([1e8, 1e8, 1e8, 1e6, 1e6, 1e6])

    def at(angles: object) -> tuple[System, list[object]]:
        angle = dict(angles).get(1, 0.0)  # type: ignore[call-overload]
        seats = [seat("b", bearing, place, None, (0.0, 0.0, 0.0), angle)]
        system = assemble([body], bushing("b", place, None, (0.0, 0.0, 0.0), stiff))
        return without_bearings(system, seats), seats  # type: ignore[return-value]

    carriers = travelling_of(at, {1: 1.0})  # type: ignore[arg-type]
    k = float(forces(bearing, np.zeros((1, 5)))[1][0, 1, 1])
    root = np.sqrt(k / 40.0)
    speed, seconds = 1.7 * root, 0.1 / root
    c = seconds * k
    system = carriers.system
    y, z = system.place("planet uy"), system.place("planet uz")
    q = np.zeros(6)
    q[y] = 1e-6
    duration = 4 * 2 * pi / root
    missed = []
    for steps in (400, 800):
        acting = [TravellingCarriers(carriers, speed, damping=seconds)]
        found = integrate(
            equations_of(system), acting, duration, duration / steps,
            start=State(q, np.zeros(6), np.zeros(6)),
        )  # fmt: skip
        both = np.roots([40.0, c, k - 1j * c * speed])
        share = np.linalg.solve([[1, 1], both], [1e-6, 0.0])
        exact = np.exp(np.outer(found.times, both)) @ share
        assert np.abs(exact[-1]) > 1.2 * np.abs(exact[0])  # it drives the whirl above resonance
        missed.append(float(np.abs(found.q[:, y] + 1j * found.q[:, z] - exact).max()))
        imbalance = found.relative_imbalance
    assert missed[0] / missed[1] == pytest.approx(4.0, rel=0.1)
    assert missed[1] < 0.02 * np.abs(exact).max()
    assert imbalance < 5e-3
    # the drive that holds the speed pays for it
    assert found.energies[-1, 4] > found.energies[-1, 3] > 0.0


def test_rollers_with_steps_of_their_own_choice() -> None:
    """A linear law against exact steps, and a loose bearing by its energy."""
    on_rolls, bearings, plain = linear_pair()
    held = replace(plain, extra=plain.extra + np.diag([0, 0, 0, 1e6, 0, 0.0]))
    exact = exact_steps(held, PUSH, 0.02, 0.002)[1][-1]
    same = replace(on_rolls, extra=on_rolls.extra + np.diag([0, 0, 0, 1e6, 0, 0.0]))
    missed = {}
    for tolerance in (1e-4, 1e-6):
        found = integrate(same, [PUSH, bearings], 0.02, StepControl(1e-4, tolerance))
        assert found.control.errors.max() <= tolerance
        missed[tolerance] = np.abs(found.q[-1] - exact).max() / np.abs(exact).max()
    assert missed[1e-6] < 0.15 * missed[1e-4]
    assert missed[1e-6] < 1e-3
    equations, loose = on_rollers(tapered(clearance=30e-6))
    lost = [
        integrate(equations, [PUSH, loose], 0.02, StepControl(1e-4, tolerance)).relative_imbalance
        for tolerance in (1e-3, 1e-5)
    ]
    assert lost[1] < 0.15 * lost[0]


def test_a_brake_with_steps_of_their_own_choice_finds_the_same_events() -> None:
    shaft = equations_of_motion([3.0, 1.0], spring_laws([[1.0, -1.0]], 50.0))
    begin = State(np.zeros(2), np.full(2, 2.0), np.zeros(2))
    disc = Brake(np.array([0.0, 1.0]), 4.0, 1.0)
    one = integrate(shaft, [disc], 9.0, 2e-4, start=begin)
    other = integrate(shaft, [disc], 9.0, StepControl(1e-2, 1e-7), start=begin)
    assert [what for _, what in other.braking.events] == [what for _, what in one.braking.events]
    times = [[t for t, _ in motion.braking.events] for motion in (one, other)]
    assert len(times[0]) > 2
    assert_allclose(times[1], times[0], rtol=1e-4)
    assert other.relative_imbalance < 1e-11
    assert len(other.control.steps) == len(other.times) - 1
    assert other.times[-1] == pytest.approx(9.0)


def test_two_brakes_share_a_load_by_the_stiffness_between_them() -> None:
    rows = [[1.0, -1.0, 0.0], [0.0, 1.0, -1.0]]
    k = np.array([30.0, 90.0])
    chain = equations_of_motion([1.0, 2.0, 1.0], spring_laws(rows, k, 0.3 * k))
    discs = [Brake(np.eye(3)[0], 40.0, 1.0), Brake(np.eye(3)[2], 60.0, 0.5)]
    load = steady([0.0, 12.0, 0.0])
    begin = State(np.zeros(3), np.full(3, 5.0), np.zeros(3))
    found = integrate(chain, [load, *discs], 30.0, 5e-3, start=begin, every=7)
    assert found.braking.held[-1].tolist() == [True, True]
    assert set(found.braking.of) == {0, 1}
    # where each disc came to stand is part of the winding
    q, wound = found.q[-1], found.forces[-1]
    assert_allclose(found.braking.torque[-1], [wound[0], -wound[1]], atol=1e-6)
    assert found.braking.torque[-1].sum() == pytest.approx(-12.0, rel=1e-6)
    assert_allclose(wound, k * (np.array(rows) @ q), atol=1e-6)
    assert np.abs(found.velocity[-1]).max() < 1e-6
    assert found.relative_imbalance < 1e-4
    # each seventh record, with those of events
    assert len(found.times) < 6000 / 7 + 3 + 2 * len(found.braking.events)
    assert {t for t, _ in found.braking.events} <= set(found.times)


def test_a_generator_in_the_list_is_one_in_the_equations() -> None:
    shaft = equations_of_motion([3.0, 1.0], spring_laws([[1.0, -1.0]], 50.0))
    law, pull = slip_line([0.0, 1.0], 10.0, 100.0, 5.0)
    drive = steady([10.0, 0.0])
    begin = State(np.zeros(2), np.full(2, 101.0), np.zeros(2))
    one = integrate(shaft, [drive, law, pull], 2.0, 1e-2, start=begin)
    whole = replace(shaft, springs=joined_laws(shaft.springs, law))
    other = integrate(whole, summed(drive, pull), 2.0, 1e-2, start=begin)
    assert_allclose(one.q, other.q, rtol=1e-13)
    assert one.forces.shape[1] == 2


TIMES = np.linspace(0.0, 2.0, 81)
SWAY = 0.05 * np.sin(3.0 * TIMES) * (1.0 - np.cos(2.0 * TIMES))


def test_a_base_that_moves_under_a_gap_by_an_explicit_method() -> None:
    """In coordinates of space: a mass between two flanks of a base that goes its way."""
    gap, k, c, m = 0.01, 400.0, 1.5, 2.0
    laws = spring_laws([[1.0]], k, lower=-gap, upper=gap)
    damped = equations_of_motion([m], joined_laws(laws, spring_laws([[1.0]], 0.0, c)))
    base = base_motion([[1.0]], TIMES, SWAY)
    path = CubicSpline(TIMES, SWAY)

    def rates(t: float, y: Floats) -> list[float]:
        x, v = y[0] - path(t), y[1] - path(t, 1)
        flank = x - np.clip(x, -gap, gap)
        return [y[1], float(-k * flank - c * v) / m]

    exact = solve_ivp(rates, (0.0, 2.0), [0.0, float(path(0.0, 1))], rtol=1e-10, atol=1e-12)
    missed = []
    for dt in (4e-3, 1e-3):
        found = integrate(damped, [base], 2.0, dt)
        missed.append(abs(found.q[-1, 0] + path(2.0) - exact.y[0, -1]))
    assert np.abs(found.q).max() > 2 * gap
    assert missed[1] < 1e-5
    assert missed[1] < 0.2 * missed[0]
    assert found.relative_imbalance < 1e-3
    with pytest.raises(InputError, match=r"known from 0 to 2 s but the run goes from 0 to 2\.5 s"):
        integrate(damped, [base], 2.5, 1e-3)


def test_a_base_that_tilts_a_disc_that_spins(tmp_path: Path) -> None:
    """Against coordinates of space, in which the base pulls by its springs."""
    body = Body("disc", (0.4, 0.0, 0.0), 40.0, 6.0, 3.5, speed=1.0)
    hold = np.array([2e6, 3e6, 3e6, 4e5, 5e5, 5e5])
    system = assemble([body], bushing("hold", Place("disc", body.position), None, (0, 0, 0), hold))
    spin = 300.0
    equations = equations_of(system, spin)
    S = on_base(system, [body])
    motion = np.zeros((len(TIMES), 6))
    motion[:, 2], motion[:, 4] = SWAY, 0.3 * SWAY
    relative = integrate(equations, [base_motion(S, TIMES, motion)], 1.0, 5e-4)
    fine = np.linspace(0.0, 1.0, 4001)
    path = CubicSpline(TIMES, motion)
    pulled = varying(system.K @ S, fine, path(fine))
    begin = State(S @ motion[0], S @ path(0.0, 1), np.zeros(6))
    start = State(np.zeros(6), begin.velocity - S @ path(0.0, 1), np.zeros(6))
    assert np.abs(start.velocity).max() == 0.0
    space = integrate(equations, pulled, 1.0, 5e-4, start=begin)
    found = relative.q + path(relative.times) @ S.T
    assert_allclose(found, space.q, rtol=0, atol=2e-4 * np.abs(relative.q).max())
    still = integrate(equations_of(system), [base_motion(S, TIMES, motion)], 1.0, 5e-4)
    assert np.abs(still.q - relative.q).max() > 0.1 * np.abs(relative.q).max()
    table = tmp_path / "base.csv"
    rows = ["time [s],uz [m],ry [rad]"]
    rows += [
        f"{t!r},{z!r},{r!r}" for t, z, r in np.column_stack([TIMES, motion[:, [2, 4]]]).tolist()
    ]
    table.write_text("\n".join(rows), encoding="utf-8")
    read = read_base_motion(table, system, [body])
    assert_allclose(integrate(equations, [read], 1.0, 5e-4).q, relative.q, atol=1e-12)
    table.write_text("time [s],uz [mm]\n0,1\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"header is 'time \[s\],uz \[mm\]' but must be"):
        read_base_motion(table, system, [body])


def everything() -> tuple[Equations, Travelling, list[Act]]:
    """Planets that travel; meshes by clock and angle, with errors and a gap; and all else."""
    carriers = moving_plane()
    system = carriers.system
    n, speed = len(system.names), 300.0
    equations = equations_of(system, speed)
    s = equations.springs
    count = len(s.rows)
    mesh = [i for i, name in enumerate(system.spring_names) if "sun-planet" in name]
    wave, low = np.full(count, -1), np.zeros(count)
    wave[mesh], low[mesh[0]] = 0, -1e-6
    turns = np.zeros((count, n))
    turns[mesh[1:], system.place("sun rx")] = 200.0
    laws = (
        spring_laws(s.rows, s.stiffness, 1e-6 * s.stiffness, lower=low, upper=-low)
        .in_phase(frequency=900.0, turns=turns)
        .with_waves(fourier_wave([0.1], [0.05])[None], wave)
        .with_errors(harmonic_error([2e-7], [0.0]).table[None], wave)
    )
    row = np.eye(n)[system.place("sun rx")]
    machine = slip_line(row, 50.0, 10.0, 20.0)
    base = np.zeros(n)
    base[[k for k, name in enumerate(system.names) if name.endswith(" uy")]] = 1.0
    times = np.linspace(0.0, 2e-3, 41)
    shake = base_motion(base, times, 1e-6 * np.sin(5e3 * times) ** 2)
    pull = steady(3e3 * np.random.default_rng(8).normal(size=n))
    bearing = cylindrical("sun", 12, 0.03, 0.04, 0.2, law=ContactLaw(1e8, 10 / 9), clearance=1e-6)
    rows = np.zeros((1, 5, n))
    rows[0, 1, system.place("sun uy")] = rows[0, 2, system.place("sun uz")] = 1.0
    place = Place("sun", (0.0, 0.0, 0.0))
    rollers = bearings_on([seat("sun", bearing, place, None, (0, 0, 0))], rows, 1e-6)
    acting: list[Act] = [
        pull, *machine, shake, rollers, TravellingCarriers(carriers, speed),
        Brake(row, 40.0, 5e-4, 2e-4),
    ]  # fmt: skip
    return replace(equations, springs=laws), carriers, acting


LEFT_OUT = ("nothing", "Loads", "SpringLaws", "BaseMotion", "RollingBearings", "Brake")


@pytest.mark.parametrize("left_out", LEFT_OUT)
def test_energy_closes_with_all_at_once_and_without_each(left_out: str) -> None:
    equations, _, acting = everything()
    some = [one for one in acting if type(one).__name__ != left_out]
    assert (len(some) < len(acting)) == (left_out != "nothing")
    begin = State(np.zeros(len(equations.mass)), np.full(len(equations.mass), 1e-2), np.zeros(1))

    def run(dt: float) -> Motion:
        return integrate(equations, some, 1.5e-3, dt, start=begin)

    assert order_of_imbalance(run, (1e-5, 5e-6)) > 2.5


def test_all_at_once_with_steps_of_their_own_choice() -> None:
    equations, _, acting = everything()
    scheme = generalised_alpha(0.9)
    exact = integrate(equations, acting, 1.5e-3, 1e-6, scheme)
    ends = {}
    for tolerance in (1e-3, 1e-5):
        found = integrate(equations, acting, 1.5e-3, StepControl(1e-5, tolerance), scheme)
        assert found.converged
        ends[tolerance] = np.abs(found.q[-1] - exact.q[-1]).max() / np.abs(exact.q).max()
    assert ends[1e-5] < 0.2 * ends[1e-3]
    assert ends[1e-5] < 5e-3


def test_phases_have_all_that_acts() -> None:
    """Rollers over a series of phases, as in one run."""
    equations, bearings = on_rollers(tapered())
    whole = integrate(equations, [PUSH, bearings], 0.01, 1e-4)
    both = transient(
        [Phase(0.004, equations, [PUSH, bearings]), Phase(0.01, equations, [bearings, PUSH])],
        1e-4,
        State(np.zeros(6), np.zeros(6), np.zeros(6)),
    )
    assert_allclose(both.q, whole.q, rtol=0, atol=1e-9 * np.abs(whole.q).max())
    assert both.bearings.loads.shape == whole.bearings.loads.shape
    assert_allclose(both.energies[-1], whole.energies[-1], rtol=1e-7, atol=1e-9)


ONE = equations_of_motion([1.0], spring_laws([[1.0]], 1.0))
REAR = Brake(np.ones(1), 1.0, 0.0)


@pytest.mark.parametrize(
    ("acting", "message"),
    [
        ([steady([0.0, 1.0])], "a Loads acts on 2 degrees of freedom and the equations have 1"),
        ([REAR, replace(REAR, torque=2.0)], "2 brakes hold motions that depend on each other"),
        ([3.0], "a float cannot act in time: give Loads"),
        ([base_motion(np.ones((2, 1)), TIMES, SWAY)], "a BaseMotion acts on 2 degrees"),
    ],
)
def test_what_cannot_act_is_refused_by_name(acting: list[Act], message: str) -> None:
    with pytest.raises(InputError, match=message):
        integrate(ONE, acting, 1.0, 0.1)


def test_combinations_that_are_not_possible_are_refused_by_name() -> None:
    carriers = moving_plane()
    equations = equations_of(carriers.system)
    two = [TravellingCarriers(carriers, 1.0), TravellingCarriers(carriers, 2.0)]
    with pytest.raises(InputError, match="2 sets of travelling carriers act together"):
        integrate(equations, two, 1.0, 0.1)
    with pytest.raises(InputError, match="linear acceleration has no estimate of its error"):
        integrate(equations, two[:1], 1.0, StepControl(0.1, 1e-3), LINEAR)
    start = State(np.zeros(1), np.zeros(1), np.zeros(1))
    on_rolls, bearings = on_rollers(tapered())
    six = State(np.zeros(6), np.zeros(6), np.zeros(6))
    with pytest.raises(InputError, match="phases have 0 and 1 rolling bearings"):
        transient([Phase(1.0, on_rolls, PUSH), Phase(2.0, on_rolls, [bearings])], 0.1, six)
    with pytest.raises(InputError, match="two rolling bearings are 'b'"):
        integrate(on_rolls, [bearings, bearings], 1.0, 0.1)
    with pytest.raises(InputError, match="every is 0 steps"):
        integrate(ONE, steady([1.0]), 1.0, 0.1, every=0)
    assert integrate(ONE, [], 1.0, 0.1, start=start).relative_imbalance == 0.0


def test_what_cannot_move_with_its_base_is_refused() -> None:
    body = Body("rotor", mass=1.0, polar=1.0, transverse=1.0, free=frozenset({"rx"}))
    held = bushing("turn", Place("rotor", (0.0, 0.0, 0.0)), None, (0, 0, 0), (0, 0, 0, 1.0, 0, 0))
    with pytest.raises(InputError, match="cannot move with its base along ux"):
        on_base(assemble([body], held), [body])
    for samples, message in ((TIMES[:3], "3 samples but must have at least 4"),):
        with pytest.raises(InputError, match=message):
            base_motion([[1.0]], samples, SWAY[: len(samples)])
    with pytest.raises(InputError, match="2 columns of numbers and moves the system in 1 ways"):
        base_motion([[1.0]], TIMES, np.column_stack([SWAY, SWAY]))


def test_discs_stop_at_the_instants_of_a_closed_form() -> None:
    """Two that nothing connects: friction alone, of which one grows for a second."""
    loose = equations_of_motion([2.0, 5.0], spring_laws([[1.0, -1.0]], 0.0))
    discs = [Brake(np.eye(2)[0], 4.0, 0.0), Brake(np.eye(2)[1], 5.0, 0.5, 1.0)]
    begin = State(np.zeros(2), np.array([3.003, 2.002]), np.zeros(2))
    found = integrate(loose, discs, 6.0, 0.01, start=begin)
    assert found.braking.of == (0, 0, 1, 1)
    first, _, second, _ = (t for t, _ in found.braking.events)
    assert first == pytest.approx(3.003 / 2.0, rel=1e-8)
    # half of a metre a second while it grows, then one for each second
    assert second == pytest.approx(1.5 + 2.002 - 0.5, rel=1e-8)
    assert found.q[-1, 0] == pytest.approx(3.003**2 / 4.0, rel=1e-8)
