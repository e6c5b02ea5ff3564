"""Time integration: printed tables, exact transients, energy, contact, and SciPy's integrators."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.equations import (
    Equations,
    Loads,
    equations_of_motion,
    fourier_wave,
    joined_laws,
    spring_laws,
    steady,
    summed,
    varying,
    wave_table,
)
from fe_drivetrain.dynamics.bodies.steady_state import free_motions, restoring, waves_at, wind_up
from fe_drivetrain.dynamics.time.integration import integrate
from fe_drivetrain.dynamics.time.motion import Motion, State
from fe_drivetrain.dynamics.time.schemes import AVERAGE, LINEAR, generalised_alpha
from fe_drivetrain.dynamics.time.step_control import StepControl
from fe_drivetrain.dynamics.time.superposition import energy_error, exact_steps, modal_superposition


def started(q: list[float], velocity: list[float], time: float = 0.0) -> State:
    return State(np.array(q), np.array(velocity), np.zeros(len(q)), time)


def peer(equations: Equations, loads: Loads, duration: float, start: State) -> Floats:
    """Displacements at the end by an explicit method of order 8."""
    n = len(start.q)

    def rate(t: float, y: Floats) -> Floats:
        force = restoring(equations, t, y[:n], y[n:])[0]
        return np.concatenate([y[n:], np.linalg.solve(equations.mass, loads.at(t) - force)])

    begin = np.concatenate([start.q, start.velocity])
    found = solve_ivp(rate, (0.0, duration), begin, "DOP853", rtol=1e-11, atol=1e-12, max_step=0.01)
    return np.asarray(found.y[:n, -1])


ONE = equations_of_motion([1.0], spring_laws([[1.0]], 1.0))


def frame(seed: int = 0, damping: float = 0.1) -> tuple[Equations, Loads]:
    """Four masses on six springs, some of them free at an elongation; loads with kinks."""
    rng = np.random.default_rng(seed)
    springs = spring_laws(
        rng.normal(size=(6, 4)),
        rng.uniform(1.0, 20.0, 6),
        damping * rng.uniform(0.0, 1.0, 6),
        offset=0.1 * rng.normal(size=6),
    )
    gyroscopic = rng.normal(size=(4, 4))
    equations = equations_of_motion(
        rng.uniform(1.0, 2.0, 4), springs, gyroscopic - gyroscopic.T, np.diag([0.0, 1.0, 2.0, 0.0])
    )
    return equations, varying(rng.normal(size=4), [0.0, 0.5, 1.0, 2.0], [0.0, 1.0, -1.0, 0.3])


CHOPRA = "0.0437 0.2326 0.6121 1.0825 1.4309 1.4230 0.9622 0.1908 -0.6043 -1.1441"
CHOPRA_LINEAR = "0.0300 0.2193 0.6166 1.1130 1.4782 1.4625 0.9514 0.1273 -0.6954 -1.2208"


@pytest.mark.parametrize(("scheme", "printed"), [(AVERAGE, CHOPRA), (LINEAR, CHOPRA_LINEAR)])
def test_chopras_examples_of_newmarks_method(scheme: object, printed: str) -> None:
    """Chopra, Dynamics of structures, examples 5.3 and 5.4: half-sine pulse on one mass."""
    equations = equations_of_motion([0.2533], spring_laws([[1.0]], 10.0, 0.1592))
    pulse = varying([1.0], np.arange(7) * 0.1, [0.0, 5.0, 8.6602, 10.0, 8.6603, 5.0, 0.0])
    motion = integrate(equations, pulse, 1.0, 0.1, scheme)  # type: ignore[arg-type]
    assert_allclose(motion.q[1:, 0], [float(x) for x in printed.split()], rtol=0, atol=1.01e-4)


def test_bathes_example_of_the_trapezoidal_rule() -> None:
    """Bathe, Finite element procedures, section 9.2.4: two masses, a step load, three digits."""
    springs = spring_laws([[1.0, 0.0], [1.0, -1.0], [0.0, 1.0]], [4.0, 2.0, 2.0])
    motion = integrate(equations_of_motion([2.0, 1.0], springs), steady([0.0, 10.0]), 3.36, 0.28)
    one = [0.00673, 0.0505, 0.189, 0.485, 0.961, 1.58, 2.23, 2.76, 3.00, 2.85, 2.28, 1.40]
    two = [0.364, 1.35, 2.68, 4.00, 4.95, 5.34, 5.13, 4.48, 3.64, 2.90, 2.44, 2.31]
    for found, printed in zip(motion.q.T, (one, two), strict=True):
        assert_allclose(found[1:], printed, rtol=5.1e-3)


def test_average_acceleration_keeps_energy_to_round_off() -> None:
    equations, _ = frame(damping=0.0)
    motion = integrate(
        equations, steady(np.zeros(4)), 200.0, 0.1, start=started([1, 0, 0, 0], [0] * 4)
    )
    # round-off of 2000 steps
    assert np.ptp(motion.energy) < 2000 * 1e-15 * motion.energy[0]


@pytest.mark.parametrize("step", [0.1, 0.5, 2.0])
def test_period_of_average_acceleration(step: float) -> None:
    """Each step turns the phase by 2 atan(w dt / 2)."""
    motion = integrate(ONE, steady([0.0]), 50.0 * step, step, start=started([1.0], [0.0]))
    turned = 2.0 * np.arctan(step / 2.0) * np.arange(51)
    assert_allclose(motion.q[:, 0], np.cos(turned), rtol=0, atol=1e-12)


@pytest.mark.parametrize("scheme", [AVERAGE, LINEAR, generalised_alpha(0.6)], ids=lambda s: s.name)
def test_second_order_against_the_exponential(scheme: object) -> None:
    equations, loads = frame()
    exact = exact_steps(equations, loads, 2.0, 0.5)[1][-1]
    errors = [
        np.abs(integrate(equations, loads, 2.0, dt, scheme).q[-1] - exact).max()  # type: ignore[arg-type]
        for dt in (0.01, 0.005)
    ]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


@pytest.mark.parametrize("radius", [0.0, 0.5, 0.9, 1.0])
def test_spectral_radius_of_generalised_alpha(radius: float) -> None:
    """A frequency far above that of the steps decays by its radius in each step."""
    stiff = equations_of_motion([1.0], spring_laws([[1.0]], 1e14))
    motion = integrate(
        stiff, steady([0.0]), 400.0, 1.0, generalised_alpha(radius), started([1.0], [0.0])
    )
    # the eigenvalue is triple: size goes as the square of the steps times a power of the radius
    size = np.abs(motion.q[:, 0])
    if radius == 0.0:
        assert size[10:].max() < 1e-6
    else:
        assert (size[400] / size[200] / 4.0) ** (1.0 / 200.0) == pytest.approx(radius, rel=0.01)


def test_modal_superposition_is_the_exponential_where_damping_is_modal() -> None:
    equations, loads = frame(damping=0.0)
    K = equations.K
    proportional = equations_of_motion(equations.mass, spring_laws(np.eye(4), 0.0), 0.02 * K, K)
    t, q, velocity = exact_steps(proportional, loads, 2.0, 0.1)
    found = modal_superposition(proportional, loads, 2.0, 0.1)
    assert found.coupling < 1e-9
    assert_allclose(found.q, q, rtol=0, atol=1e-11)
    assert_allclose(found.velocity, velocity, rtol=0, atol=1e-11)
    assert_allclose(found.times, t)
    assert modal_superposition(frame()[0], loads, 2.0, 0.1).coupling > 0.1


def test_modal_superposition_of_what_turns_freely() -> None:
    """A steady torque: the whole turns as a rigid body, and swings about its wind-up."""
    free = equations_of_motion([2.0, 1.0], spring_laws([[1.0, -1.0]], 6.0))
    found = modal_superposition(free, steady([3.0, 0.0]), 4.0, 0.25)
    t, omega = found.times, np.sqrt(6.0 * 1.5)
    assert_allclose(found.q @ [2.0, 1.0] / 3.0, 0.5 * t**2, atol=1e-12)
    twist = found.q[:, 0] - found.q[:, 1]
    assert_allclose(twist, (1.0 / 6.0) * (1.0 - np.cos(omega * t)), atol=1e-12)


def test_the_energy_of_a_history_closes_with_the_fourth_power_of_its_records() -> None:
    """With dampers, gyroscopic terms, a dense stiffness, and springs with offsets."""
    whole, loads = frame()
    lost = []
    for dt in (0.01, 0.005):
        t, q, v = exact_steps(whole, loads, 2.0, dt)
        lost.append(energy_error(whole, loads, t, q, v))
    assert lost[0] / lost[1] == pytest.approx(16.0, rel=0.1)
    assert lost[1] < 1e-4
    # a history that is not of these loads, or not of this damping, does not close
    twice = Loads(2.0 * loads.patterns, loads.times, loads.histories)
    assert energy_error(whole, twice, t, q, v) > 0.1
    stiffer = replace(whole, springs=replace(whole.springs, damping=2.0 * whole.springs.damping))
    assert energy_error(stiffer, loads, t, q, v) > 0.01
    assert energy_error(replace(whole, extra=2.0 * whole.extra), loads, t, q, v) > 0.01


def test_superposition_refuses_laws() -> None:
    gap = equations_of_motion([1.0], spring_laws([[1.0]], 1.0, upper=0.1))
    with pytest.raises(InputError, match="1 springs have a gap"):
        modal_superposition(gap, steady([0.0]), 1.0, 0.1)


def test_loss_of_generator_torque_of_two_masses() -> None:
    """The shaft swings between T and T (J2 - J1) / (J1 + J2); momentum grows by T t."""
    J, torque = np.array([3.0, 1.0]), 2.0
    free = equations_of_motion(J, spring_laws([[1.0, -1.0]], 50.0))
    start = wind_up(free, [torque, -torque])
    motion = integrate(
        free, steady([torque, 0.0]), 5.0, 1e-3, start=State(start.q, np.zeros(2), start.q)
    )
    twist = motion.forces[:, 0]
    assert twist.max() == pytest.approx(torque, rel=1e-6)
    assert twist.min() == pytest.approx(torque * (J[1] - J[0]) / J.sum(), rel=1e-5)
    assert_allclose(motion.velocity @ J, torque * motion.times, rtol=1e-9, atol=1e-12)
    assert motion.relative_imbalance < 1e-11


def test_torque_step_goes_to_twice_the_static_winding() -> None:
    held = equations_of_motion([2.0], spring_laws([[1.0]], 8.0))
    motion = integrate(held, steady([4.0]), 10.0, 1e-3)
    assert motion.q.max() == pytest.approx(2.0 * 4.0 / 8.0, rel=1e-6)
    assert motion.q.min() == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("scheme", [AVERAGE, generalised_alpha(0.9)], ids=lambda s: s.name)
def test_two_flanks_against_an_explicit_method(scheme: object) -> None:
    """A gap that opens and closes on both sides; error of second order and small."""
    springs = spring_laws([[1, -1], [1, 0]], [100.0, 1.0], lower=[-0.1, 0], upper=[0.1, 0])
    equations, loads = equations_of_motion([1.0, 2.0], springs), steady([1.0, -0.5])
    start = started([0.0, 0.0], [1.0, 0.0])
    exact = peer(equations, loads, 3.0, start)
    motion = integrate(equations, loads, 3.0, 2.5e-4, scheme, start)  # type: ignore[arg-type]
    assert motion.converged
    assert motion.forces[:, 0].min() < 0.0 < motion.forces[:, 0].max()
    assert_allclose(motion.q[-1], exact, rtol=0, atol=3e-4)
    assert motion.relative_imbalance < 1e-4


def test_a_closed_gap_is_a_linear_spring_to_the_last_digits() -> None:
    """With the mean stiffness in the constant matrix, a law that is linear adds nothing."""
    law = spring_laws([[1.0]], 3.0, 0.2, lower=-1e-300, upper=1e-300)
    plain = spring_laws([[1.0]], 3.0, 0.2)
    one, two = (
        integrate(
            equations_of_motion([1.0], s), steady([0.4]), 20.0, 0.1, start=started([0.1], [0])
        )
        for s in (law, plain)
    )
    assert_allclose(one.q, two.q, rtol=0, atol=1e-12)


def test_dampers_act_in_contact_only() -> None:
    """Between the flanks a mass keeps its speed, whatever its damper."""
    springs = spring_laws([[1.0]], 100.0, 50.0, lower=-1.0, upper=1.0)
    motion = integrate(
        equations_of_motion([1.0], springs), steady([0.0]), 0.9, 0.01, start=started([0.0], [1.0])
    )
    assert_allclose(motion.velocity, 1.0, rtol=1e-12)
    assert abs(motion.energies[-1, 3]) < 1e-12


def test_rollers_law_against_an_explicit_method() -> None:
    springs = spring_laws([[1.0]], 40.0, upper=0.0, lower=-np.inf, exponent=10.0 / 9.0)
    equations, loads = equations_of_motion([1.0], springs), steady([3.0])
    start = started([0.0], [0.0])
    exact = peer(equations, loads, 2.0, start)
    assert_allclose(integrate(equations, loads, 2.0, 5e-4).q[-1], exact, rtol=0, atol=1e-6)


WAVE = fourier_wave([0.3], [0.1])


def varying_with_angle() -> Equations:
    springs = (
        spring_laws([[1, -1], [0, 1]], [1e3, 50.0])
        .in_phase(turns=[[2, 0], [0, 0]])
        .with_waves([WAVE], [0, -1])
    )
    return equations_of_motion([1.0, 2.0], springs)


@pytest.fixture(scope="module")
def turning() -> dict[tuple[bool, float], Motion]:
    start = started([0.2, 0.0], [5.0, 0.0])
    return {
        (driven, dt): integrate(
            varying_with_angle(), steady([0.0, 0.0]), 1.0, dt, start=start, driven=driven
        )
        for driven in (True, False)
        for dt in (5e-4, 2.5e-4)
    }


def test_stiffness_by_angle_keeps_energy_only_with_its_force_on_the_angle(
    turning: dict[tuple[bool, float], Motion],
) -> None:
    drift = {key: motion.relative_imbalance for key, motion in turning.items()}
    assert drift[True, 5e-4] / drift[True, 2.5e-4] == pytest.approx(4.0, rel=0.2)
    assert drift[True, 2.5e-4] < 1e-4
    assert drift[False, 2.5e-4] == pytest.approx(drift[False, 5e-4], rel=0.01)
    assert drift[False, 2.5e-4] > 0.1


def test_stiffness_by_angle_against_an_explicit_method(
    turning: dict[tuple[bool, float], Motion],
) -> None:
    exact = peer(varying_with_angle(), steady([0, 0]), 1.0, started([0.2, 0.0], [5.0, 0.0]))
    coarse, fine = (turning[True, dt].q[-1] - exact for dt in (5e-4, 2.5e-4))
    # of second order: what is left of it, extrapolated, is a hundredth
    assert np.abs(fine).max() < 5e-4
    assert np.abs((4.0 * fine - coarse) / 3.0).max() < 2e-5


def test_power_of_the_clock() -> None:
    """Without loads and damping, energy changes by half of dk/dt times the elongation squared."""
    wave = fourier_wave([0.2], [0.0])
    springs = spring_laws([[1.0]], 100.0).in_phase(frequency=3.0).with_waves([wave])
    motion = integrate(
        equations_of_motion([1.0], springs), steady([0.0]), 2.0, 1e-3, start=started([1.0], [0.0])
    )
    assert np.ptp(motion.energy) > 5.0
    slope = -100.0 * 0.2 * 2.0 * np.pi * 3.0 * np.sin(2.0 * np.pi * 3.0 * motion.times)
    power = 0.5 * slope * motion.q[:, 0] ** 2
    put_in = np.concatenate([[0.0], np.cumsum(0.5 * 1e-3 * (power[1:] + power[:-1]))])
    assert_allclose(motion.energies[:, 4], put_in, rtol=0, atol=1e-9 * put_in.max())
    assert_allclose(motion.energy - motion.energy[0], put_in, rtol=0, atol=1e-4 * put_in.max())


def test_growth_of_parametric_resonance() -> None:
    """At twice the natural frequency x'' + (1 + e cos 2t) x = 0 grows at the rate e / 4."""
    e = 0.05
    springs = (
        spring_laws([[1.0]], 1.0)
        .in_phase(frequency=1.0 / np.pi)
        .with_waves([fourier_wave([e], [0])])
    )
    equations = equations_of_motion([1.0], springs)
    motion = integrate(equations, steady([0.0]), 100.0 * np.pi, 0.02, start=started([1.0], [-1.0]))
    size = np.sqrt(motion.energy)
    half = len(size) // 2
    turn = round(2.0 * np.pi / 0.02)
    late, early = size[-turn:].max(), size[half : half + turn].max()
    rate = np.log(late / early) / (motion.times[-turn] - motion.times[half])
    assert rate == pytest.approx(e / 4.0, rel=0.01)


def test_machine_of_constant_power() -> None:
    """Speed of an inertia from which constant power is drawn: w^2 falls evenly."""
    machine = spring_laws([[1.0]], 0.0).with_power(4.0)
    motion = integrate(
        equations_of_motion([2.0], machine), steady([0.0]), 3.0, 1e-3, start=started([0.0], [5.0])
    )
    assert_allclose(motion.velocity[:, 0] ** 2, 25.0 - 2.0 * 4.0 / 2.0 * motion.times, rtol=1e-7)
    assert_allclose(motion.energies[:, 3], 4.0 * motion.times, rtol=1e-6, atol=1e-9)


def test_laws_are_the_derivative_of_their_energy() -> None:
    """The compiled loop's forces, by a step with no time to move, against differences of energy."""
    rng = np.random.default_rng(3)
    springs = (
        spring_laws(
            rng.normal(size=(3, 3)),
            [3.0, 5.0, 7.0],
            lower=[-0.1, -np.inf, 0.0],
            upper=[0.2, 0.1, 0.0],
            exponent=[1.0, 1.5, 1.0],
        )
        .in_phase(turns=rng.normal(size=(3, 3)))
        .with_waves([wave_table(1.0 + 0.3 * rng.normal(size=8))], [0, -1, 0])
    )
    equations = equations_of_motion(np.ones(3), springs)

    def energy(q: Floats) -> float:
        begin = State(q, np.zeros(3), np.zeros(3))
        return float(integrate(equations, steady(np.zeros(3)), 1e-9, 1e-9, start=begin).energy[0])

    q, h = rng.normal(size=3), 1e-6
    force, tangent = restoring(equations, 0.0, q, np.zeros(3))
    slopes = [(energy(q + h * e) - energy(q - h * e)) / (2.0 * h) for e in np.eye(3)]
    assert_allclose(force, slopes, rtol=0, atol=1e-6 * np.abs(force).max())
    bent = [
        (
            restoring(equations, 0.0, q + h * e, 0 * q)[0]
            - restoring(equations, 0.0, q - h * e, 0 * q)[0]
        )
        / (2.0 * h)
        for e in np.eye(3)
    ]
    assert_allclose(tangent, np.array(bent).T, rtol=0, atol=1e-6 * np.abs(tangent).max())


def test_a_wave_goes_through_its_values() -> None:
    values = np.array([1.2, 0.9, 0.7, 1.2])
    springs = (
        spring_laws([[1.0]], 2.0)
        .in_phase(phase=np.pi / 10, frequency=1.0)
        .with_waves([wave_table(values)])
    )
    equations = equations_of_motion([1.0], springs)
    for k, value in enumerate([*values, values[0]]):
        at = k / 4 - np.pi / 10
        assert waves_at(equations, at, np.zeros(1))[0][0] == pytest.approx(value, abs=1e-12)


def test_step_control_meets_its_tolerance() -> None:
    equations, loads = frame()
    exact = exact_steps(equations, loads, 2.0, 0.5)[1][-1]
    found = {
        tolerance: integrate(equations, loads, 2.0, StepControl(0.01, tolerance))
        for tolerance in (1e-4, 1e-6)
    }
    error = {k: np.abs(a.q[-1] - exact).max() for k, a in found.items()}
    rejected = 0
    for tolerance, motion in found.items():
        rejected += motion.control.rejected
        assert motion.control.errors.max() <= tolerance
        assert motion.times[-1] == pytest.approx(2.0)
        assert motion.control.steps.sum() == pytest.approx(2.0)
        assert motion.relative_imbalance < 1e-12
    # errors go with steps^2, steps with the cube root of the tolerance
    assert error[1e-6] < 0.15 * error[1e-4]
    assert rejected > 0


def test_step_control_refuses_a_scheme_without_estimate() -> None:
    with pytest.raises(InputError, match="no estimate of its error"):
        integrate(ONE, steady([1.0]), 1.0, StepControl(0.1, 1e-3), LINEAR)


def test_wind_up_of_a_free_chain_accelerates_what_is_not_balanced() -> None:
    chain = equations_of_motion([1.0, 2.0, 3.0], spring_laws([[1, -1, 0], [0, 2, -1]], [5.0, 9.0]))
    load = np.array([4.0, 0.0, -1.0])
    found = wind_up(chain, load)
    assert free_motions(chain).shape == (3, 1)
    assert_allclose(chain.K @ found.q + chain.mass @ found.acceleration, load, atol=1e-12)
    assert_allclose([1, -1, 0] @ found.acceleration, 0.0, atol=1e-14)


def test_wind_up_through_a_gap_and_what_is_loose() -> None:
    springs = spring_laws([[1, 0], [1, -1]], [5.0, 9.0], lower=[0, -0.5], upper=[0, 0.5])
    equations = equations_of_motion([1.0, 2.0], springs)
    assert_allclose(wind_up(equations, [0.0, -3.0]).q, [-0.6, -0.6 - 0.5 - 3.0 / 9.0], rtol=1e-12)
    loose = equations_of_motion([1.0], spring_laws([[1.0]], 1.0, lower=-np.inf, upper=0.1))
    with pytest.raises(InputError, match="a part is loose"):
        wind_up(loose, [-1.0])


def test_a_sum_of_loads_and_of_laws() -> None:
    both = summed(varying([1.0, 0.0], [0.0, 2.0], [0.0, 4.0]), steady([0.0, 3.0]))
    assert_allclose(both.at([1.0, 5.0]), [[2.0, 3.0], [4.0, 3.0]])
    one = spring_laws([[1.0]], 1.0).with_waves([WAVE])
    two = joined_laws(one, spring_laws([[2.0]], 3.0), one)
    assert two.wave.tolist() == [0, -1, 1]
    assert two.waves.shape == (2, 256, 4)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: spring_laws([[1.0]], -1.0), "stiffness of spring 1 is -1"),
        (lambda: spring_laws([[1.0]], 1.0, upper=-1.0), "upper of spring 1"),
        (lambda: spring_laws([[1.0]], 1.0).with_waves([WAVE], 1), "wave of spring 1 is 1"),
        (lambda: equations_of_motion([0.0, 1.0], spring_laws([[1, 0]], 1.0)), "without inertia"),
        (lambda: equations_of_motion([1.0], spring_laws([[1, 0]], 1.0)), "rows of springs"),
        (lambda: integrate(ONE, steady([0.0]), 1.0, 0.0), "time step is 0 s"),
        (lambda: integrate(ONE, steady([0.0]), -1.0, 0.1), "duration is -1 s"),
        (lambda: generalised_alpha(1.5), "spectral radius is 1.5"),
        (lambda: varying([1.0], [0.0, 0.0], [1.0, 2.0]), "a load of 2 values"),
    ],
)
def test_messages(make: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        make()  # type: ignore[operator]


@pytest.mark.needs("pyyeti")
def test_pyyeti_superposes_the_same() -> None:
    """Another program's exact coefficients for piecewise linear loads, on the same matrices."""
    from pyyeti.ode import SolveUnc

    equations, loads = frame()
    plain = equations_of_motion(
        equations.mass,
        spring_laws(equations.springs.rows, equations.springs.stiffness, equations.springs.damping),
        equations.damping,
        equations.extra,
    )
    times, q, _ = exact_steps(plain, loads, 2.0, 0.1)
    found = SolveUnc(plain.mass, plain.C, plain.K, h=0.1).tsolve(loads.at(times).T, d0=np.zeros(4))
    assert_allclose(found.d.T, q, rtol=0, atol=1e-9)


@pytest.mark.needs("exudyn")
@pytest.mark.parametrize("radius", [1.0, 0.8])
def test_exudyn_takes_the_same_steps(radius: float) -> None:
    """Exudyn's generalised alpha is the same method, to what its Newton's method leaves."""
    from fe_drivetrain.cases.performance.exudyn_motion import exudyn_motion

    equations, loads = frame()
    _, q = exudyn_motion(equations, loads, 1.0, 0.02, radius)
    scheme = AVERAGE if radius == 1.0 else generalised_alpha(radius)
    found = integrate(equations, loads, 1.0, 0.02, scheme).q
    assert_allclose(found, q, rtol=0, atol=1e-8 * np.abs(q).max())


@pytest.mark.needs("exudyn")
def test_exudyn_on_a_stiffness_that_varies_with_an_angle() -> None:
    from fe_drivetrain.cases.performance.exudyn_motion import exudyn_motion

    equations, loads = varying_with_angle(), steady([0.0, 0.0])
    start = started([0.2, 0.0], [5.0, 0.0])
    _, q = exudyn_motion(equations, loads, 0.2, 1e-3, start=start)
    assert_allclose(integrate(equations, loads, 0.2, 1e-3, start=start).q, q, rtol=0, atol=1e-6)
