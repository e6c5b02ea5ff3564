"""Calibration: exact where results are products of powers, corrected where they are not."""

import numpy as np
import pytest

from fe_drivetrain.cases.main_bearing.calibration import calibrated, fitted, hypercube, nearest
from fe_drivetrain.common.errors import InputError

LOW, HIGH = np.array([0.1, 0.4, 0.6]), np.array([0.3, 0.9, 1.6])
EXPONENTS = np.array([[2.7, -1.1, 0.5], [2.3, -2.0, 0.9]])
MIDDLE = np.array([0.17, 0.6, 1.0])


def plate(x):
    """Two stiffnesses that are products of powers of three dimensions."""
    return np.array([1.5e8, 4e8]) * np.exp(np.log(x / MIDDLE) @ EXPONENTS.T)


def bent(x):
    """Not a product of powers, and off by a tenth."""
    return plate(x) * (1.1 + 0.3 * np.sin(4.0 * np.log(x[..., :1])))


@pytest.fixture(scope="module")
def samples():
    return hypercube(LOW, HIGH, 40)


def test_a_latin_hypercube_has_one_sample_in_each_slice_of_each_log(samples):
    place = np.log(samples / LOW) / np.log(HIGH / LOW)
    for column in place.T:
        assert sorted(np.floor(40 * column).astype(int)) == list(range(40))


@pytest.mark.parametrize("order", [1, 2])
def test_products_of_powers_are_found_exactly(samples, order):
    surface = fitted(samples, plate(samples), order)
    elsewhere = hypercube(LOW, HIGH, 7, seed=3)
    np.testing.assert_allclose(surface(elsewhere), plate(elsewhere), rtol=1e-10)
    np.testing.assert_allclose(surface.exponents(elsewhere[0]), EXPONENTS, atol=1e-9)
    assert surface.scatter.max() < 1e-10


def test_exponents_are_the_slope_of_the_surface(samples):
    surface = fitted(samples, bent(samples), 2)
    x, step = MIDDLE, 1e-5
    slopes = np.stack(
        [
            np.log(surface(x * np.exp(step * e)) / surface(x * np.exp(-step * e))) / (2 * step)
            for e in np.eye(3)
        ],
        axis=-1,
    )
    np.testing.assert_allclose(surface.exponents(x), slopes, atol=1e-8)


def test_errors_are_those_of_a_surface_without_the_sample(samples):
    values = bent(samples)
    surface = fitted(samples, values, 1)
    without = fitted(np.delete(samples, 5, axis=0), np.delete(values, 5, axis=0), 1)
    expected = np.log(values[5] / without(samples[5]))
    np.testing.assert_allclose(surface.errors[5], expected, rtol=1e-9)


def test_the_nearest_gives_both_results_and_keeps_what_is_not_free(samples):
    surface = fitted(samples, plate(samples), 1)
    wanted = np.array([1.45e8, 3.92e8])
    x = nearest(surface, MIDDLE, (0, 2), wanted, LOW, HIGH)
    np.testing.assert_allclose(plate(x), wanted, rtol=1e-9)
    assert x[1] == MIDDLE[1]
    # the two equations are linear in logs: the exact answer
    exact = np.linalg.solve(EXPONENTS[:, [0, 2]], np.log(wanted / plate(MIDDLE)))
    np.testing.assert_allclose(np.log(x / MIDDLE)[[0, 2]], exact, atol=1e-9)


def test_with_all_dimensions_free_there_is_a_family(samples):
    surface = fitted(samples, plate(samples), 1)
    wanted = np.array([1.45e8, 3.92e8])
    found = np.array(
        [nearest(surface, x, range(3), wanted, LOW, HIGH) for x in hypercube(LOW, HIGH, 20, 5)]
    )
    hits = np.abs(plate(found) / wanted - 1).max(axis=1) < 1e-6
    assert hits.sum() > 10
    assert np.ptp(found[hits][:, 1]) > 0.05


def test_what_cannot_be_reached_stays_within_the_bounds(samples):
    surface = fitted(samples, plate(samples), 1)
    x = nearest(surface, MIDDLE, range(3), np.array([1e12, 1e12]), LOW, HIGH)
    assert (x >= LOW).all()
    assert (x <= HIGH).all()
    assert x[0] == pytest.approx(HIGH[0])


def test_out_of_reach_the_nearest_is_the_least_squares_one(samples):
    """From a start on a bound: compared with a fine grid of all dimensions."""
    surface = fitted(samples, bent(samples), 2)
    wanted = np.array([5e7, 1.5e9])
    start = MIDDLE.copy()
    start[0] = LOW[0]
    x = nearest(surface, start, range(3), wanted, LOW, HIGH)
    steps = np.linspace(0.0, 1.0, 31)
    grid = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3)
    errors = (np.log(surface(LOW * (HIGH / LOW) ** grid) / wanted) ** 2).sum(axis=1)
    own = (np.log(surface(x) / wanted) ** 2).sum()
    assert own > 0.01
    assert own <= errors.min() * (1 + 1e-9)


def test_the_model_corrects_its_surface():
    """A surface of first order that is off by tens of percent still leads to the answer."""
    x = hypercube(LOW, HIGH, 12)
    surface = fitted(x, bent(x), 1)
    wanted = np.array([1.45e8, 3.92e8])
    first = nearest(surface, MIDDLE, (0, 2), wanted, LOW, HIGH)
    assert np.abs(bent(first) / wanted - 1).max() > 0.02
    found = calibrated(bent, surface, MIDDLE, (0, 2), wanted, LOW, HIGH, 1e-4, most=12)
    np.testing.assert_allclose(bent(found.x), wanted, rtol=1e-4)
    assert found.miss <= 1e-4
    assert 1 < found.evaluations < 12


def test_what_is_known_of_the_model_beforehand_saves_rounds():
    """A model that is its surface times a factor: with that factor the first answer is right."""
    x = hypercube(LOW, HIGH, 12)
    surface = fitted(x, plate(x), 1)
    factor = np.array([0.97, 0.95])
    wanted = np.array([1.45e8, 3.92e8])

    def model(x):
        return factor * plate(x)

    args = (model, surface, MIDDLE, (0, 2), wanted, LOW, HIGH, 1e-6)
    assert calibrated(*args).evaluations == 2
    assert calibrated(*args, ratio=1.0 / factor).evaluations == 1


def test_a_miss_is_told():
    x = hypercube(LOW, HIGH, 12)
    surface = fitted(x, plate(x), 1)
    wanted = np.array([1e12, 1e12])
    found = calibrated(plate, surface, MIDDLE, (0, 1), wanted, LOW, HIGH, 1e-3, most=3)
    assert found.miss > 0.5
    assert found.evaluations == 3


def test_too_few_samples_are_refused(samples):
    with pytest.raises(InputError, match="has 10 terms but there are 10 samples"):
        fitted(samples[:10], plate(samples[:10]), 2)
