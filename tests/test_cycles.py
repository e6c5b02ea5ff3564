"""Cycles are those of the standard's example, and an equivalent load of a sine is its range."""

from collections import Counter
from itertools import pairwise

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.compare.cycles import (
    SLOPES,
    damage_equivalent_load,
    rainflow_cycles,
    reversals,
)
from fe_drivetrain.compare.time_weighted import (
    sample_weights,
    weighted_rms,
    weighted_statistics,
)

#: ASTM E1049-85 (2017), Fig. 6.
EXAMPLE = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0]


def counted(signal: list[float]) -> dict[float, float]:
    cycles = rainflow_cycles(signal)
    total: Counter[float] = Counter()
    for size, count in zip(cycles.ranges.tolist(), cycles.counts.tolist(), strict=True):
        total[size] += count
    return dict(total)


def test_cycles_of_the_standards_example() -> None:
    assert counted(EXAMPLE) == {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}


def test_what_lies_between_two_reversals_does_not_count(rng: np.random.Generator) -> None:
    fine: list[float] = [EXAMPLE[0]]
    for a, b in pairwise(EXAMPLE):
        fine += [*(a + (b - a) * np.sort(rng.uniform(size=5))), b, b]  # and plateaus
    assert reversals(fine).tolist() == EXAMPLE
    assert counted(fine) == counted(EXAMPLE)


def test_a_ramp_is_half_a_cycle_and_a_constant_none() -> None:
    assert counted([1.0, 2.0, 3.5]) == {2.5: 0.5}
    assert counted([1.0, 2.0]) == {1.0: 0.5}
    for flat in ([3.0], [3.0, 3.0, 3.0]):
        assert counted(flat) == {}
        assert damage_equivalent_load([rainflow_cycles(flat)], 10.0, 3.0) == 0.0


@pytest.mark.parametrize("slope", [1.0, *SLOPES, 20.0])
@pytest.mark.parametrize("frequency", [0.25, 1.0, 2.0])
def test_the_equivalent_load_of_a_sine_is_exact(slope: float, frequency: float) -> None:
    time = np.arange(0, 8001) / 100.0  # peaks are sampled, the first and the last included
    wave = 1e6 + 3e5 * np.cos(2 * np.pi * frequency * time)
    cycles = rainflow_cycles(wave)
    assert cycles.counts.sum() == pytest.approx(80 * frequency)
    found = damage_equivalent_load([cycles], 80.0, slope)
    assert found == pytest.approx(6e5 * frequency ** (1.0 / slope), rel=1e-9)
    assert damage_equivalent_load([cycles], 80.0, slope, frequency) == pytest.approx(6e5)


def test_histories_add_their_damage_and_their_time(rng: np.random.Generator) -> None:
    one, other = (rainflow_cycles(rng.standard_normal(500)) for _ in range(2))
    loads = [damage_equivalent_load([c], t, 4.0) for c, t in ((one, 100.0), (other, 50.0))]
    both = damage_equivalent_load([one, other], 150.0, 4.0)
    assert both**4 == pytest.approx((100 * loads[0] ** 4 + 50 * loads[1] ** 4) / 150)


def test_a_wrong_slope_or_time_is_refused() -> None:
    cycles = rainflow_cycles(EXAMPLE)
    for slope in (0.5, 21.0, float("nan")):
        with pytest.raises(InputError, match="must be from 1 to 20"):
            damage_equivalent_load([cycles], 10.0, slope)
    with pytest.raises(InputError, match="must be above 0"):
        damage_equivalent_load([cycles], 0.0, 3.0)
    with pytest.raises(InputError, match="not finite"):
        rainflow_cycles([0.0, np.nan, 1.0])


def test_histories_count_by_the_time_they_last(rng: np.random.Generator) -> None:
    """A history written at half the step has twice the samples and the same weight."""
    coarse, other = rng.standard_normal((100, 3)), 5.0 + rng.standard_normal((40, 3))
    fine = np.repeat(coarse, 2, axis=0)
    statistics = []
    for first, step in ((coarse, 0.2), (fine, 0.1)):
        weights = sample_weights([len(first), len(other)], [step, 0.5])
        assert weights.sum() == pytest.approx(1.0)
        samples = np.vstack([first, other])
        statistics.append(weighted_statistics(samples, weights))
        np.testing.assert_allclose(
            weighted_rms(samples, weights) ** 2,
            statistics[-1][:, 1] ** 2 + statistics[-1][:, 3] ** 2,
        )
    np.testing.assert_allclose(*statistics)
    # half of the time each
    np.testing.assert_allclose(statistics[0][:, 1], (coarse.mean(axis=0) + other.mean(axis=0)) / 2)
    equal = weighted_statistics(coarse, sample_weights([100], [0.1]))
    np.testing.assert_allclose(equal[:, 3], coarse.std(axis=0))
