"""Power laws through points, and where the next point lies."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison.power_law import power_law


def test_an_exact_law_is_found_and_goes_on():
    x = np.array([1.0, 10.0, 50.0, 1e3])
    law = power_law(x, 3.0 * x**1.5)
    assert law.exponent == pytest.approx(1.5, abs=1e-12)
    assert law(1e6) == pytest.approx(3e9)
    assert law.misfit < 1e-12
    assert law.band(1e6) == (pytest.approx(3e9), pytest.approx(3e9))


def test_the_next_measurement_is_in_the_band_as_often_as_it_says(rng):
    """5 points that scatter by 10 %, and one far from them: 2000 times, to 3 standard errors."""
    x, at, inside = np.geomspace(1e3, 1e5, 5), 1e9, 0
    for _ in range(2000):
        y = 2.0 * x**0.3 * np.exp(0.1 * rng.standard_normal(5))
        low, high = power_law(x, y).band(at)
        inside += low < 2.0 * at**0.3 * np.exp(0.1 * rng.standard_normal()) < high
    assert abs(inside / 2000 - 0.95) < 3 * np.sqrt(0.95 * 0.05 / 2000)


def test_the_exponent_is_in_its_band_as_often_as_it_says(rng):
    """Four points that scatter by 10 %: 2000 times, to 3 standard errors."""
    x, inside = np.geomspace(1e5, 2e6, 4), 0
    for _ in range(2000):
        y = 2.0 * x**1.1 * np.exp(0.1 * rng.standard_normal(4))
        low, high = power_law(x, y).exponent_band()
        inside += low < 1.1 < high
    assert abs(inside / 2000 - 0.95) < 3 * np.sqrt(0.95 * 0.05 / 2000)


def test_two_points_say_nothing_of_their_scatter():
    assert power_law([1.0, 2.0], [1.0, 3.0]).exponent_band() == (-np.inf, np.inf)
    assert power_law([1.0, 2.0], [1.0, 3.0]).band(4.0) == (0.0, np.inf)


@pytest.mark.parametrize(("x", "y"), [([1.0, 1.0], [1.0, 2.0]), ([1.0, 2.0], [1.0, 0.0])])
def test_what_has_no_law_is_refused(x, y):
    with pytest.raises(InputError, match="positive values at two different places"):
        power_law(x, y)
