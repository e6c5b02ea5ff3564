"""Events: friction that slips and sticks, machines, shutdown of published drivetrains."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.equations import (
    equations_of_motion,
    joined_laws,
    spring_laws,
    steady,
    summed,
    varying,
)
from fe_drivetrain.dynamics.time.brakes import Brake
from fe_drivetrain.dynamics.time.integration import Phase, integrate, transient
from fe_drivetrain.dynamics.time.machines import constant_power, grid_spring, slip_line
from fe_drivetrain.dynamics.time.motion import Motion, State, at_rest
from fe_drivetrain.dynamics.time.stopping import StopSequence, shutdown

J = np.array([3.0, 1.0])
SHAFT = equations_of_motion(J, spring_laws([[1.0, -1.0]], 50.0))
REAR = np.array([0.0, 1.0])


def turning(speed: float, n: int = 2) -> State:
    return State(np.zeros(n), np.full(n, speed), np.zeros(n))


def times_of(found: Motion) -> list[float]:
    return [t for t, _ in found.braking.events]


def kinds_of(found: Motion) -> list[str]:
    return [what for _, what in found.braking.events]


def torque_of(found: Motion) -> Floats:
    return found.braking.torque[:, 0]


def braked(dt: float, torque: float = 4.0, load: float = 0.0) -> Motion:
    phase = Phase(10.0, SHAFT, [steady([load, 0.0]), Brake(REAR, torque, 1.0)])
    return transient([phase], dt, turning(2.0))


def test_a_brake_step_winds_the_shaft_up_to_twice_its_mean() -> None:
    """Mean of T_b J1 / (J1 + J2), peak twice that, before the disc stops."""
    found = braked(1e-3)
    before = found.times <= times_of(found)[0]
    assert found.forces[before, 0].max() == pytest.approx(2 * 4.0 * 0.75, rel=1e-5)


def test_momentum_falls_by_the_torque_of_the_brake() -> None:
    found = braked(1e-3)
    first = next(t for t, what in found.braking.events if what == "stops")
    slipping = (found.times >= 1.0) & (found.times <= first)
    momentum = found.velocity[slipping] @ J
    assert_allclose(momentum, 8.0 - 4.0 * (found.times[slipping] - 1.0), atol=1e-9)


def test_a_disc_that_sticks_stands_still_and_holds_below_its_torque() -> None:
    found = braked(2e-3)
    held = found.braking.held[:, 0]
    assert held[-1]
    # but for the records at which it begins to slip
    assert np.abs(found.velocity[held, 1]).max() < 1e-9
    assert np.abs(torque_of(found)).max() <= 4.0 * (1.0 + 1e-9)
    # a disc that stands holds what the shaft carries
    assert_allclose(torque_of(found)[held], -found.forces[held, 0], atol=1e-8)
    assert kinds_of(found) == [
        "stops",
        "sticks",
        "slips",
        "stops",
        "sticks",
    ]


def test_a_disc_slips_where_the_shaft_exceeds_its_torque() -> None:
    found = braked(1e-3)
    slip = next(t for t, what in found.braking.events if what == "slips")
    at = int(np.argmin(np.abs(found.times - slip)))
    assert abs(found.forces[at, 0]) == pytest.approx(4.0, rel=1e-6)


def test_events_are_found_with_the_order_of_the_steps() -> None:
    times = [times_of(braked(dt))[0] for dt in (4e-3, 2e-3, 1e-3)]
    assert (times[0] - times[1]) / (times[1] - times[2]) == pytest.approx(4.0, rel=0.15)


def test_energy_closes_over_all_events() -> None:
    found = braked(4e-3)
    assert found.relative_imbalance < 1e-11
    # friction takes all that is not left in the swinging rotor
    left = found.energy[-1]
    assert -found.energies[-1, 2] == pytest.approx(0.5 * J.sum() * 4.0 - left, rel=1e-10)


def test_rotor_swings_at_its_frequency_on_a_held_shaft() -> None:
    found = braked(1e-3)
    last = times_of(found)[-1]
    t = found.times
    swing = found.velocity[t > last, 0]
    crossings = t[t > last][1:][np.diff(np.sign(swing)) != 0]
    assert np.diff(crossings).mean() == pytest.approx(np.pi / np.sqrt(50.0 / 3.0), rel=1e-3)


def test_a_strong_brake_holds_a_steady_load_for_ever() -> None:
    """With damping, what is held comes to the torque of the load."""
    damped = equations_of_motion(J, spring_laws([[1.0, -1.0]], 50.0, 4.0))
    phase = Phase(40.0, damped, [steady([2.0, 0.0]), Brake(REAR, 9.0, 0.5, 0.5)])
    found = transient([phase], 5e-3, turning(1.0))
    assert found.braking.held[:, 0][-1]
    assert torque_of(found)[-1] == pytest.approx(-2.0, rel=1e-6)
    assert found.velocity[-1, 1] == 0.0


def test_a_weak_brake_never_holds() -> None:
    found = braked(5e-3, torque=1.0, load=5.0)
    assert not found.braking.held[:, 0].any()
    assert not found.braking.events


def test_a_dense_stiffness_is_held_as_well_as_springs() -> None:
    dense = equations_of_motion(J, spring_laws(np.zeros((1, 2)), 0.0), extra=SHAFT.K)
    phase = Phase(6.0, dense, [steady([0.0, 0.0]), Brake(REAR, 4.0, 1.0)])
    found = transient([phase], 2e-3, turning(2.0))
    assert_allclose(times_of(found), times_of(braked(2e-3)), rtol=1e-9)


def test_a_dense_damping_is_held_as_well_as_dampers() -> None:
    """Matrix or damper: the same events, and the same torque of a brake that holds.

    The disc stands while the rotor swings, so that the damper of the shaft pulls at it.
    """
    law = spring_laws([[1.0, -1.0]], 50.0)
    C = 0.8 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    dampers = equations_of_motion(J, replace(law, damping=np.array([0.8])))
    found, other = (
        transient([Phase(6.0, one, [Brake(REAR, 4.0, 1.0)])], 2e-3, turning(2.0))
        for one in (equations_of_motion(J, law, C), dampers)
    )
    assert kinds_of(found) == kinds_of(other)
    assert_allclose(times_of(found), times_of(other), rtol=1e-9)
    assert_allclose(torque_of(found), torque_of(other), atol=1e-7)
    held = found.braking.held[:, 0]
    pulled = found.forces[:, 0] + 0.8 * found.velocity @ [1.0, -1.0]
    assert_allclose(torque_of(found)[held], -pulled[held], atol=1e-7)
    assert np.abs(pulled - found.forces[:, 0])[held].max() > 0.1


def test_a_spring_with_an_offset_is_held_as_one_without() -> None:
    """Displacements that begin elsewhere by the offset: the same brake, moved motion."""
    moved = equations_of_motion(J, spring_laws([[1.0, -1.0]], 50.0, offset=0.3))
    begin = State(np.array([0.3, 0.0]), np.full(2, 2.0), np.zeros(2))
    phase = Phase(10.0, moved, [Brake(REAR, 4.0, 1.0)])
    found, plain = transient([phase], 2e-3, begin), braked(2e-3)
    assert_allclose(times_of(found), times_of(plain), rtol=1e-9)
    assert_allclose(torque_of(found), torque_of(plain), atol=1e-7)
    assert_allclose(found.q, plain.q + np.array([0.3, 0.0]), atol=1e-9)
    assert_allclose(found.energy, plain.energy, atol=1e-9)


def test_slip_line() -> None:
    """Speed comes back to the line with the time constant J / slope; torque is that of the line."""
    law, pull = slip_line([1.0], 10.0, 100.0, 5.0)
    loads = summed(pull, steady([10.0]))
    found = integrate(equations_of_motion([2.0], law), loads, 2.0, 1e-3, start=turning(101.0, 1))
    assert_allclose(found.velocity[:, 0], 100.0 + np.exp(-2.5 * found.times), atol=1e-5)
    drawn = found.forces[:, 0] - pull.at(0.0)[0]
    assert_allclose(drawn, 10.0 + 5.0 * (found.velocity[:, 0] - 100.0), rtol=1e-12)


def test_constant_power_and_a_spring_to_the_grid() -> None:
    law = constant_power([1.0], 6.0, 50.0)
    found = integrate(equations_of_motion([2.0], law), steady([0.0]), 1.0, 1e-2)
    assert_allclose((50.0 + found.velocity[:, 0]) ** 2, 2500.0 - 6.0 * found.times, rtol=1e-9)
    spring, field = grid_spring([1.0], 8.0, 3.0, 5.0)
    found = integrate(equations_of_motion([2.0], spring), field, 5.0, 1e-2, start=turning(3.0, 1))
    assert_allclose(found.q[:, 0], 3.0 * found.times, atol=1e-11)


def test_phases_must_fit() -> None:
    two = equations_of_motion(J, joined_laws(SHAFT.springs, spring_laws([[0.0, 1.0]], 1.0)))
    load = steady([0.0, 0.0])
    with pytest.raises(InputError, match="1 and 2 springs"):
        transient([Phase(1.0, SHAFT, load), Phase(2.0, two, load)], 0.1, at_rest(SHAFT))
    with pytest.raises(InputError, match="order of time"):
        transient([Phase(1.0, SHAFT, load), Phase(1.0, SHAFT, load)], 0.1, at_rest(SHAFT))


#: Rated power [W] and speed [1/min] of Table 4.1 (C: Table 3.1, D: GRC), and the torque that loss
#: of the generator leaves at the least, T (J2 - J1) / (J1 + J2) over T.
TRIPS = {
    "drivetrain_a": -0.514,
    "drivetrain_b": 0.546,
    "drivetrain_c": -0.795,
    "nrel_750kw": -0.720,
}
LOSS = StopSequence(off=0.1, pitched=1e3, left=1.0, end=0.6)


@pytest.mark.parametrize("name", TRIPS)
def test_loss_of_generator_torque_of_published_drivetrains(name: str) -> None:
    """Two masses: the closed form; all gears: reversal in A, C and D only."""
    table = published.table(name)
    two = shutdown(table, 1e6, 1.5, 0.0, LOSS, dt=1e-3, lumped=True)
    J1, J2 = two.system.J
    assert pytest.approx(TRIPS[name], abs=6e-4) == (J2 - J1) / (J1 + J2)
    assert two.ratio("shafts")[0] == pytest.approx(1.0, rel=1e-9)
    damped = two.system.elements[0].damping > 0.0
    assert two.ratio("shafts").min() == pytest.approx(
        (J2 - J1) / (J1 + J2), rel=0.0, abs=1e-2 if damped else 1e-3
    )
    gears = shutdown(table, 1e6, 1.5, 0.0, LOSS, dt=1e-3)
    for shaft in ("LSS", "HSS"):
        assert gears.ratio(shaft)[0] == pytest.approx(1.0, rel=1e-6)
        assert (gears.ratio(shaft).min() < 0.0) == (name != "drivetrain_b")


def test_a_shutdown_ends_at_rest_at_the_brake() -> None:
    when = StopSequence(off=0.2, pitched=0.7, braked=0.5, end=4.0)
    found = shutdown(published.table("nrel_750kw"), 324e3, 1.0, 3.0, when, dt=2e-3)
    motion = found.motion
    assert motion.relative_imbalance < 1e-9
    assert motion.braking.held[-1, 0]
    assert motion.times[-1] == pytest.approx(4.0)
    generator = found.system.place("generator")
    assert abs(motion.velocity[-1, generator]) < 1e-9
    # momentum seen from the rotor: what torques of wind and brake have taken
    stops = next(t for t, what in motion.braking.events if what == "stops")
    assert 0.5 < stops < 4.0


def test_brake_that_grows() -> None:
    brake = Brake(REAR, 4.0, 1.0, 2.0)
    assert [brake.size(t) for t in (0.5, 1.0, 2.0, 3.0, 9.0)] == [0.0, 0.0, 2.0, 4.0, 4.0]
    found = transient(
        [Phase(2.0, SHAFT, [varying([1.0, 0.0], [0.0, 1.0], [0.0, 0.0]), brake])],
        1e-2,
        turning(5.0),
    )
    assert_allclose(found.velocity[-1] @ J, 20.0 - 1.0, rtol=1e-9)


def test_backlash_in_a_shutdown() -> None:
    """Teeth part where torque is reversed; in steady operation they stay on their flank."""
    when = StopSequence(off=0.05, pitched=1e3, left=1.0, end=0.4)
    table = published.table("nrel_750kw")
    linear, gap = (
        shutdown(table, 324e3, 2.31, 0.0, when, dt=1e-4, backlash=backlash)
        for backlash in (0.0, 2e-3)
    )
    mesh = "stage 3 mesh"
    assert linear.ratio(mesh).min() < -0.5
    assert_allclose(gap.ratio(mesh)[:400], 1.0, rtol=1e-6)
    apart = np.abs(gap.ratio(mesh)) < 1e-12
    assert apart.any()
    assert gap.ratio(mesh).min() < -0.1
    assert gap.motion.converged
    assert gap.motion.relative_imbalance < 2e-3


def test_after_a_dip_of_the_grid_the_generator_carries_rated_torque_again() -> None:
    when = StopSequence(off=0.1, pitched=1e3, left=1.0, back=0.25, end=8.0)
    found = shutdown(published.table("nrel_750kw"), 324e3, 2.31, 0.0, when, dt=2e-3, slip=0.02)
    ratio, t = found.ratio("HSS"), found.motion.times
    off = (t > 0.1) & (t < 0.25)
    # of its inertia alone: no torque at the generator, which is sped up by the shaft
    generator = found.motion.velocity[:, found.system.place("generator")]
    assert (np.abs(np.diff(generator[off])) > 0.0).all()
    assert ratio.max() > 1.2
    assert ratio[-1] == pytest.approx(1.0, abs=0.03)


def test_a_clutch_brings_two_masses_to_one_speed() -> None:
    """Friction between two bodies: momentum stays, slip ends at the closed form."""
    loose = equations_of_motion(J, spring_laws([[1.0, -1.0]], 0.0))
    clutch = Brake(np.array([1.0, -1.0]), 2.0, 0.5)
    start = State(np.zeros(2), np.array([4.0, 1.0]), np.zeros(2))
    found = transient([Phase(4.0, loose, [clutch])], 1e-2, start)
    assert_allclose(found.velocity @ J, 13.0, rtol=1e-12)
    assert times_of(found)[0] == pytest.approx(0.5 + 3.0 / (2.0 / 3.0 + 2.0 / 1.0), rel=1e-9)
    assert_allclose(found.velocity[-1], 13.0 / 4.0, rtol=1e-9)
    lost = 0.5 * (J[0] * J[1] / J.sum()) * 9.0
    assert -found.energies[-1, 2] == pytest.approx(lost, rel=1e-9)


def test_a_disc_on_a_faster_shaft_brakes_as_much_with_less_torque() -> None:
    """Row and torque of a brake go with the speed ratio: the same motion."""
    one = braked(2e-3)
    fast = Brake(5.0 * REAR, 4.0 / 5.0, 1.0)
    other = transient([Phase(10.0, SHAFT, [fast])], 2e-3, turning(2.0))
    assert_allclose(times_of(other), times_of(one), rtol=1e-9)
    assert_allclose(other.q[-1], one.q[-1], rtol=1e-9)
    assert_allclose(5.0 * torque_of(other)[-1], torque_of(one)[-1], rtol=1e-6)
