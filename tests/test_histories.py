"""Distributions over levels, statistics and spectra of channels: sums, limits, known signals."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.histories.levels import (
    equivalent_level,
    even_levels,
    revolutions_at_level,
    time_at_level,
    torque_reversals,
)


def test_time_and_turns_at_level_add_up(rng: np.random.Generator) -> None:
    torque, speed = rng.normal(5.0, 1.0, 1000), rng.uniform(-1.0, 2.0, 1000)
    edges = even_levels(torque.min(), torque.max())
    duration = time_at_level(torque, 0.05, edges)
    assert duration.amount.sum() == pytest.approx(50.0)
    assert duration.at_least[0] == pytest.approx(50.0)
    turns = revolutions_at_level(torque, speed, 0.05, edges)
    assert turns.amount.sum() == pytest.approx(np.abs(speed).sum() * 0.05 / (2 * np.pi))
    constant = revolutions_at_level(torque, 2.0 * np.pi, 0.05, edges)
    np.testing.assert_allclose(constant.amount, duration.amount)
    both = duration + duration
    np.testing.assert_allclose(both.amount, 2.0 * duration.amount)
    # a transient of 30 ms adds exactly its time
    extended = time_at_level([*torque, torque.max()], 0.05, edges)
    assert (extended.amount - duration.amount)[-1] == pytest.approx(0.05)
    for power in (1.0, 3.0, 10.0):
        level = equivalent_level(torque, power)
        assert np.abs(torque).mean() <= level * (1 + 1e-12)
        assert level <= np.abs(torque).max()
        binned = (duration.amount @ np.abs(duration.middles) ** power / 50.0) ** (1 / power)
        assert level == pytest.approx(binned, rel=2e-3)
    with pytest.raises(InputError, match="let them hold every sample"):
        time_at_level(torque, 0.05, [0.0, 1.0])
    with pytest.raises(InputError, match="different limits"):
        duration + time_at_level([0.5], 0.05, [0.0, 1.0])


def test_a_constant_load_is_at_one_level() -> None:
    found = time_at_level(np.full(10, 3.0), 1.0, even_levels(3.0, 3.0, 4))
    assert sorted(found.amount) == [0.0, 0.0, 0.0, 10.0]
    assert equivalent_level([3.0, -3.0], 3.0) == pytest.approx(3.0)
    assert equivalent_level([0.0], 3.0) == 0.0


def test_reversals_of_torque_do_not_count_noise_within_the_band() -> None:
    time = np.arange(0.0, 10.0, 0.01)
    torque = np.cos(2 * np.pi * time)  # crosses zero twice a period
    noisy = torque + 0.09 * np.cos(2 * np.pi * 23.0 * time)
    assert torque_reversals(torque, 0.01).count == 20
    assert torque_reversals(noisy, 0.01).count > 20
    found = torque_reversals(noisy, 0.01, band=0.15)
    assert (found.count, found.band) == (20, 0.15)
    assert found.seconds == pytest.approx(5.0, abs=0.2)
    assert found.least == pytest.approx(-1.09, abs=0.02)
    assert torque_reversals(2.0 + torque, 0.01).seconds == 0.0
