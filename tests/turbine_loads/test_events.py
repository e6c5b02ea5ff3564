"""Start-up, stops and grid loss: their cycles have the stated statistics, whatever the seed."""

from __future__ import annotations

import numpy as np
import pytest

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.histories.cycles import rainflow_cycles
from fe_drivetrain.turbine_loads.hub_loads.aero_rotor import Rotor
from fe_drivetrain.turbine_loads.hub_loads.events import (
    RATED,
    Shaft,
    State,
    Statistics,
    drawn_cycles,
    grid_loss,
    made_event,
)
from fe_drivetrain.turbine_loads.hub_loads.turbine import similar_turbine

STATES: tuple[State, ...] = ("normal operation", "start-up", "normal stop", "emergency stop")


def cycles(state: State, shaft: Shaft, seed: int) -> tuple[Floats, Floats, float]:
    """Ranges and means of whole cycles [kN m], and the duration [s]."""
    event = made_event(state, shaft, seed)
    found = rainflow_cycles(event.torque / 1e3, "repeated")
    assert (found.counts == 1.0).all()
    return found.ranges, found.means, float(event.time[-1])


def equivalent(ranges: Floats, seconds: float) -> float:
    """Damage-equivalent load at 1 Hz, slope 6 [kN m]."""
    return float(((ranges**6).sum() / seconds) ** (1.0 / 6.0))


@pytest.mark.parametrize("seed", [0, 1, 2, 97])
def test_fast_shaft_has_the_statistics_of_the_thesis(seed: int) -> None:
    """Al-Hamadani 2018, lines 761 to 822, each to the digits it states."""
    found = {state: cycles(state, "fast", seed) for state in STATES}
    normal, start, stop, emergency = (found[s] for s in STATES)
    assert normal[0].max() == pytest.approx(3.8, abs=0.05)
    assert emergency[0].max() > 19.0
    medians = [np.median(emergency[0]) / np.median(one[0]) for one in (normal, stop, start)]
    assert medians == pytest.approx([5.0, 1.3, 1.76], abs=0.005)
    means = [np.median(normal[1]) / np.median(one[1]) for one in (emergency, stop, start)]
    assert means == pytest.approx([2.0, 1.92, 2.47], abs=0.005)
    assert emergency[1].min() == pytest.approx(-4.0, abs=0.05)
    assert [emergency[1].min() / one[1].min() for one in (stop, start)] == pytest.approx(
        [4.0, 5.8], abs=0.05
    )
    assert normal[1].min() > 0.0
    largest = equivalent(*emergency[::2])
    loads = [largest / equivalent(*one[::2]) for one in (normal, stop, start)]
    assert loads == pytest.approx([3.65, 1.1, 1.43], abs=0.005)
    assert [one[2] for one in (normal, start, stop, emergency)] == [20.0, 70.0, 48.0, 30.0]
    assert start[1].max() < 10.0
    assert normal[0].max() < start[0].max() < stop[0].max() < emergency[0].max()
    # to 30 % over rated torque after braking
    assert emergency[1].max() < 1.3 * RATED["fast"] / 1e3


@pytest.mark.parametrize("seed", [0, 5])
def test_slow_shaft_has_those_that_are_stated_for_it(seed: int) -> None:
    found = {state: cycles(state, "slow", seed) for state in STATES}
    normal, start, stop, emergency = (found[s] for s in STATES)
    assert normal[0].max() == pytest.approx(250.0, abs=5.0)
    assert emergency[0].max() > 2000.0
    medians = [np.median(emergency[0]) / np.median(one[0]) for one in (normal, stop, start)]
    assert medians == pytest.approx([8.9, 1.5, 1.92], abs=0.005)
    means = [np.median(normal[1]) / np.median(one[1]) for one in (emergency, stop, start)]
    assert means == pytest.approx([2.2, 2.1, 2.6], abs=0.005)


def test_seeds_give_other_histories_and_one_seed_the_same() -> None:
    one, again, other = (made_event("emergency stop", "fast", seed) for seed in (3, 3, 4))
    assert np.array_equal(one.torque, again.torque)
    assert not np.allclose(one.torque, other.torque)
    assert one.thrust[0] == 1.0
    assert one.thrust[-1] == 0.0
    assert one.torque[0] == pytest.approx(0.8 * RATED["fast"])
    assert one.torque[-1] == 0.0


def test_statistics_that_no_cycles_have_are_refused() -> None:
    random = np.random.default_rng(0)
    with pytest.raises(InputError, match="have no equivalent load of 1"):
        drawn_cycles(Statistics(20.0, 0.5, 0.1, 0.4, None, 1.0, 0.4, 0.4), random)
    with pytest.raises(InputError, match=r"least mean -0.5 times rated torque"):
        drawn_cycles(Statistics(20.0, 0.5, 0.1, 0.4, -0.5, None, 0.4, 0.4), random)


def test_grid_loss_swings_as_two_masses_on_a_shaft_do() -> None:
    turbine = similar_turbine(Rotor(), shaft_damping=1e-3)
    torque = 1e6
    event = grid_loss(turbine, torque, 1.5, 1000.0)
    whole = turbine.rotor_inertia + turbine.generator_inertia
    rate = np.sqrt(turbine.shaft_stiffness * whole / turbine.rotor_inertia)
    rate /= np.sqrt(turbine.generator_inertia)
    # at first the rotor's torque is what it was: the generator's inertia takes its share
    early = event.time < 0.1
    share = turbine.generator_inertia / whole
    exact = torque * (share + (1.0 - share) * np.cos(rate * event.time))
    np.testing.assert_allclose(event.torque[early], exact[early], atol=0.002 * torque)
    assert event.torque.min() < -0.7 * torque
    # shaft and rotor exchange: nothing but the rotor's torque turns both
    damped = grid_loss(similar_turbine(Rotor()), torque, 20.0)
    assert abs(damped.torque[-1]) < 0.05 * torque
    assert damped.torque[0] == pytest.approx(torque)
