"""Series of known order, and series without one; the worked set of the procedure's authors."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison.convergence import (
    GridConvergence,
    grid_convergence,
    observed_order,
    richardson,
    scattered_band,
)

RATIOS = [(1.0, 0.5, 0.25), (1.0, 0.7, 0.5), (2.0, 1.4, 1.0, 0.7), (3.0, 2.0, 0.5)]


@given(
    st.floats(-10, 10),
    st.floats(0.1, 10) | st.floats(-10, -0.1),
    st.floats(0.5, 5.0),
    st.sampled_from(RATIOS),
)
def test_limit_and_order_of_a_power_law_are_found(limit, c, order, sizes):
    """f = f0 + c h^p through three sizes, of whatever ratios: f0 and p exactly."""
    values = limit + c * np.array(sizes) ** order
    found = grid_convergence(sizes, values)
    assert found.behaviour == "monotone"
    assert found.extrapolated == pytest.approx(limit, abs=1e-6 * abs(c))
    assert found.order == pytest.approx(order, rel=1e-5)
    assert richardson(sizes[-2:], values[-2:], order) == pytest.approx(limit, abs=1e-9 * abs(c))
    # the band is 1.25 times the error, and so holds the limit
    error = abs(values[-1] - limit)
    assert found.uncertainty == pytest.approx(1.25 * error, abs=1e-6 * abs(c))
    assert found.extrapolated_uncertainty == pytest.approx(0.25 * error, abs=1e-6 * abs(c))


def test_worked_set_of_celik_et_al():
    """Three grids in two dimensions: what follows from the formulas, to the printed digits."""
    sizes = np.array([4500, 8000, 18000]) ** -0.5
    found = grid_convergence(sizes, [5.863, 5.972, 6.063])
    assert sizes[1] / sizes[2] == pytest.approx(1.5)
    assert sizes[0] / sizes[1] == pytest.approx(4 / 3)
    # half of the last digit printed
    assert 100 * found.gci_coarse == pytest.approx(4.11, abs=0.005)
    assert 100 * found.gci_fine == pytest.approx(2.17, abs=0.005)
    assert found.asymptotic_ratio == pytest.approx(1.015, abs=0.0005)
    # Celik et al. (2008), Table 1, recalled, not re-read: 1.53 and 6.1685
    assert found.order == pytest.approx(1.53, abs=0.005)
    assert found.extrapolated == pytest.approx(6.1685, abs=0.00005)
    # the order solves their Eq 3
    r21, r32, p = 1.5, 4 / 3, found.order
    e21, e32 = 5.972 - 6.063, 5.863 - 5.972
    right = abs(np.log(abs(e32 / e21)) + np.log((r21**p - 1) / (r32**p - 1))) / np.log(r21)
    assert p == pytest.approx(right, rel=1e-9)


def test_dimension_changes_the_order_and_not_the_index():
    """Sizes from cell counts as N^(-1/d): the order is proportional to d, the GCI knows no d."""
    cells, values = np.array([4500.0, 8000, 18000]), [5.863, 5.972, 6.063]
    plane, solid = (grid_convergence(cells ** (-1 / d), values) for d in (2, 3))
    assert solid.order == pytest.approx(1.5 * plane.order)
    assert solid.gci_fine == pytest.approx(plane.gci_fine)
    assert solid.gci_coarse == pytest.approx(plane.gci_coarse)


@given(st.floats(0.5, 4.0), st.floats(0.01, 1.0), st.sampled_from(RATIOS))
def test_asymptotic_ratio_of_the_observed_order_says_nothing(order, c, sizes):
    """It is the ratio of the two finest values, whatever the series."""
    values = 3.0 + c * np.array(sizes) ** order
    found = grid_convergence(sizes, values)
    assert found.asymptotic_ratio == pytest.approx(values[-1] / values[-2], rel=1e-6)


def test_asymptotic_ratio_of_an_expected_order_says_whether_it_is_there():
    sizes = np.array([1.0, 0.5, 0.25])
    near = grid_convergence(sizes, 100.0 + sizes**2, expected_order=2.0)
    assert near.asymptotic_ratio == pytest.approx(1.0, abs=0.01)
    far = grid_convergence(sizes, 100.0 + sizes**3, expected_order=2.0)
    assert far.asymptotic_ratio == pytest.approx(2.0, abs=0.03)


def test_higher_order_than_expected_is_not_believed():
    """The limit is that of the expected order, and the safety factor that of a doubtful one."""
    sizes = np.array([1.0, 0.5, 0.25])
    values = 5.0 + sizes**3
    found = grid_convergence(sizes, values, expected_order=2.0)
    assert found.order == pytest.approx(3.0)
    assert found.extrapolated == pytest.approx(richardson(sizes[-2:], values[-2:], 2.0))
    assert found.uncertainty == pytest.approx(3.0 * abs(found.extrapolated - values[-1]))
    as_expected = grid_convergence(sizes, values, expected_order=3.0)
    assert as_expected.uncertainty == pytest.approx(1.25 * sizes[-1] ** 3)


def test_least_order_widens_the_band_to_its_limit():
    sizes = np.array([1.0, 0.5, 0.25])
    values = 5.0 + sizes**2
    found = grid_convergence(sizes, values, min_order=1.0)
    slowest = richardson(sizes[-2:], values[-2:], 1.0)
    assert found.extrapolated == pytest.approx(5.0)
    assert found.extrapolated_uncertainty == pytest.approx(abs(slowest - 5.0))
    assert found.uncertainty == pytest.approx(abs(values[-1] - 5.0) + abs(slowest - 5.0))


@pytest.mark.parametrize(("first", "second"), [(0.1, 1.0), (1.0, 1.0), (1.0, 0.1), (-0.2, 1.0)])
def test_mixture_of_two_orders_keeps_the_limit_in_its_band(first, second):
    """A first-order share that asserts itself late: the least order keeps the band wide enough."""
    sizes = np.array([1.0, 0.7, 0.5, 0.35])
    values = 5.0 + first * sizes + second * sizes**2
    found = grid_convergence(sizes, values, min_order=1.0)
    assert abs(found.extrapolated - 5.0) <= found.extrapolated_uncertainty
    assert abs(found.finest - 5.0) <= found.uncertainty


def test_fourth_mesh_that_tells_another_limit_widens_the_band():
    sizes = np.array([1.0, 0.5, 0.25, 0.125])
    regular = 5.0 + sizes
    kinked = regular + np.array([0.3, 0.0, 0.0, 0.0])
    narrow, wide = (grid_convergence(sizes, v) for v in (regular, kinked))
    before = richardson(sizes[1:3], kinked[1:3], observed_order(sizes[:3], kinked[:3]))
    assert wide.extrapolated == narrow.extrapolated
    assert wide.extrapolated_uncertainty == pytest.approx(abs(before - 5.0))
    assert wide.uncertainty > 1.5 * narrow.uncertainty


@given(st.floats(0.2, 0.95), st.floats(-5, 5))
def test_oscillation_is_told_and_its_band_holds_the_limit(shrink, limit):
    """Values on both sides of the limit, in turn."""
    values = limit + (-shrink) ** np.arange(3)
    found = grid_convergence([1.0, 0.5, 0.25], values)
    assert found.behaviour == "oscillatory"
    assert np.isnan(found.order)
    assert found.uncertainty >= 1.25 * np.ptp(values) * (1 - 1e-12)
    assert abs(found.finest - limit) <= found.uncertainty
    # nothing is averaged
    assert found.extrapolated == values[-1]


@pytest.mark.parametrize("values", [[1.0, 1.1, 1.1], [1.0, 1.1, 1.1 + 1e-9]])
def test_last_difference_near_zero_by_chance_is_no_convergence(values):
    """The series turns round there, as far as anyone can tell."""
    found = grid_convergence([1.0, 0.5, 0.25], values)
    assert found.behaviour == "oscillatory"
    assert found.uncertainty == pytest.approx(0.125)


@pytest.mark.parametrize("values", [[1.0, 1.1, 1.3], [1.0, 1.1, 1.2], [-1.0, -1.1, -1.4]])
def test_divergence_has_no_band(values):
    found = grid_convergence([1.0, 0.5, 0.25], values)
    assert found.behaviour == "divergent"
    assert found.uncertainty == np.inf
    assert "no band" in found.sentence()


def test_least_order_gives_a_band_where_no_order_is_seen():
    for values, behaviour in (([1.0, 1.1, 1.3], "divergent"), ([1.0, 1.2, 1.1], "oscillatory")):
        found = grid_convergence([1.0, 0.5, 0.25], values, min_order=1.0)
        slowest = 2 * values[-1] - values[-2]
        assert found.behaviour == behaviour
        assert found.extrapolated == pytest.approx(slowest)
        missing = abs(slowest - values[-1])
        assert found.extrapolated_uncertainty == pytest.approx(max(np.ptp(values), missing))
        scatter = scattered_band([1.0, 0.5, 0.25], values)
        assert found.uncertainty == max(1.25 * np.ptp(values), missing, scatter)


def test_scattered_band_is_three_times_the_error_where_a_line_fits():
    """Eca and Hoekstra's equation 20: 5 + 2 h and 5 + 2 h^2 leave no residual."""
    h = np.array([1.8, 1.35, 0.9])
    assert scattered_band(h, 5 + 2 * h) == pytest.approx(3 * 2 * 0.9)
    assert scattered_band(h, 5 + 2 * h**2) == pytest.approx(3 * 2 * 0.9**2)


def test_scattered_band_is_multiplied_where_no_line_fits():
    """Their equation 21, with other least squares: the standard deviation is above the range."""
    h, v = np.array([3.0, 2.0, 1.0]), np.array([0.0, 1.0, 0.0])
    found = []
    for x in (h, h**2):
        for weights in (np.ones(3), 3 / h / (1 / h).sum()):
            line = np.polynomial.Polynomial.fit(x, v, 1, w=np.sqrt(weights)).convert()
            rest = v - line(x)
            sigma = np.sqrt(weights @ rest**2)
            error = abs(line.coef[1]) * x[-1]
            found.append((sigma, 3 * sigma / 0.5 * (error + sigma + abs(rest[-1]))))
    assert min(found)[0] > 0.5
    assert scattered_band(h, v) == pytest.approx(min(found)[1])


def test_scattered_band_grows_with_the_scatter_and_knows_no_unit():
    h = [1.8, 1.35, 1.0]
    bands = [scattered_band(h, [1.0, 1.0 + up, 1.1]) for up in (0.1, 0.2, 0.4, 0.8)]
    assert np.all(np.diff(bands) > 0)
    assert scattered_band(np.multiply(h, 1e-3), [1e9, 1.2e9, 1.1e9]) == pytest.approx(
        1e9 * bands[1]
    )


@pytest.mark.parametrize("value", [5.0, -3e9, 0.0])
def test_round_off_is_converged(value, rng):
    values = value * (1.0 + 1e-15 * rng.standard_normal(4))
    found = grid_convergence([8.0, 4.0, 2.0, 1.0], values)
    assert found.behaviour == "converged"
    assert found.uncertainty <= 3e-12 * abs(value)
    assert abs(values[-1] - value) <= found.uncertainty
    # to a series of that size, the same differences mean something
    assert grid_convergence([4.0, 2.0, 1.0], [1e-15, 3e-15, 2e-15]).behaviour == "oscillatory"


@given(st.floats(0.5, 4.0), st.floats(0.1, 10), st.floats(0.1, 10), st.sampled_from(RATIOS))
def test_units_do_not_matter(order, metre, newton, sizes):
    values = 3.0 + np.array(sizes) ** order
    one = grid_convergence(sizes, values, min_order=1.0)
    other = grid_convergence(metre * np.array(sizes), newton * values, min_order=1.0)
    assert other.order == pytest.approx(one.order, rel=1e-6)
    assert other.uncertainty == pytest.approx(newton * one.uncertainty, rel=1e-6)
    assert other.gci_fine == pytest.approx(one.gci_fine, rel=1e-6)


def test_sentence_tells_order_limit_and_band():
    sizes = np.array([1.0, 0.5, 0.25])
    found = grid_convergence(sizes, 5.0 + sizes**2)
    text = found.sentence("mm")
    assert text == str(text)
    for part in ("order 2.00", "5.062 mm on the finest of 3", "5 mm extrapolated", "± 0.078 mm"):
        assert part in text
    assert isinstance(found, GridConvergence)
    assert "up and down" in str(grid_convergence(sizes, [1.0, 1.2, 1.1]))
    assert "round-off" in str(grid_convergence(sizes, [1.0, 1.0, 1.0]))


@pytest.mark.parametrize(
    ("sizes", "values", "message"),
    [
        ([1, 0.5], [1, 2], "at least three sizes that descend"),
        ([1, 0.5, 0.25], [1, 2], "a value for each"),
        ([1, 1, 0.5], [1, 2, 3], "at least three sizes that descend"),
        ([1, 2, 3], [1, 2, 3], "coarse first"),
        ([2, 1, 0], [1, 2, 3], "above zero"),
        ([3, 2, 1], [1, 2, np.nan], "finite"),
    ],
)
def test_what_is_no_series_is_refused(sizes, values, message):
    with pytest.raises(InputError, match=message):
        grid_convergence(sizes, values)
