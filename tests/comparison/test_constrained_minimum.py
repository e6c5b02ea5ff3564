"""Minima within limits, their multipliers, and conflicts, against closed forms."""

import numpy as np
import pytest

from fe_drivetrain.comparison.constrained_minimum import (
    constrained_minimum,
    distinct_minima,
    least_violation,
    multiplier_ranges,
    nearest_start,
    slopes,
    starting_points,
)

OUTER, STIFFNESS = 1.0, 0.5  # D, and least D^4 - d^4, of a tube whose mass is D^2 - d^2


def _tube(at):
    """Mass of a tube with free outer and inner diameter, its least stiffness, and a wall."""
    outer, inner = 0.5 + at[0] * (OUTER - 0.5), at[1] * 0.99
    wall = inner - outer + 0.01
    return np.array([outer**2 - inner**2, 1.0 - (outer**4 - inner**4) / STIFFNESS, wall])


def test_a_tube_of_least_mass_is_as_wide_as_it_may_be():
    """D is at its end and d^4 = D^4 - K there, so that the mass rises by dm/dK = 1 / (2 d^2)."""
    inner = (OUTER**4 - STIFFNESS) ** 0.25
    for start in starting_points(np.array([0.5, 0.2]), 4):
        found = constrained_minimum(_tube, start)
        assert found.violation <= 1e-8
        assert found.at == pytest.approx([1.0, inner / 0.99], abs=1e-6)
        # dm/dK = (-2 d) (-1 / 4 d^3) = 1 / (2 d^2), for a relative change times K
        assert found.multipliers == pytest.approx([STIFFNESS / (2.0 * inner**2), 0.0], rel=1e-5)
        assert found.at_ends[0] > 0.0
        assert found.at_ends[1] == 0.0
        assert found.residual < 1e-5


def test_multipliers_are_what_a_limit_costs():
    def limited(by):
        def functions(at):
            x, y = at
            return np.array([2.0 * x + y, by - x * y])

        return constrained_minimum(functions, np.array([0.5, 0.5]))

    found = limited(0.08)
    # x y = c: least of 2 x + y is 2 sqrt(2 c)
    assert found.values[0] == pytest.approx(2.0 * np.sqrt(2.0 * 0.08), rel=1e-9)
    change = (limited(0.0801).values[0] - limited(0.0799).values[0]) / 2e-4
    assert found.multipliers[0] == pytest.approx(change, rel=1e-4)


def test_conflicting_limits_share_the_conflict():
    def functions(at):
        x, y = at
        return np.array([y, 0.6 - x, x - 0.4, y - 2.0])  # x >= 0.6 and x <= 0.4

    found = least_violation(functions, np.array([0.1, 0.5]))
    assert found.violation == pytest.approx(0.1, abs=1e-7)
    assert found.multipliers == pytest.approx([0.5, 0.5, 0.0], abs=1e-6)


def test_a_limit_beyond_the_range_conflicts_with_its_end():
    found = least_violation(lambda at: np.array([0.0, 1.2 - at[0]]), np.array([0.3]))
    assert found.violation == pytest.approx(0.2, abs=1e-7)
    assert found.multipliers == pytest.approx([1.0])
    assert found.at_ends[0] > 0.0


def test_slopes_inside_and_at_both_ends():
    def cubic(at):
        return np.array([at[0] ** 3 + at[0], np.exp(at[0])])

    for x in (0.0, 0.37, 1.0):
        found = slopes(cubic, np.array([x]))
        assert found[:, 0] == pytest.approx([3.0 * x**2 + 1.0, np.exp(x)], rel=1e-6)


def test_minima_apart_are_two_and_the_same_is_one():
    def wavy(at):
        return np.array([1.0 + 0.1 * at[0] - np.sin(3.0 * np.pi * at[0]) ** 2, -1.0])

    found = [constrained_minimum(wavy, np.array([x])) for x in (0.1, 0.2, 0.5)]
    kept = distinct_minima(found, 1e-6)
    assert len(kept) == 2
    assert kept[0].values[0] < kept[1].values[0]


def test_without_variables_the_start_is_the_answer():
    found = constrained_minimum(lambda _: np.array([2.0, -0.1]), np.zeros(0))
    assert found.violation == -0.1
    assert found.residual == 0.0


def test_multipliers_of_ends_have_their_sign():
    found = constrained_minimum(
        lambda at: np.array([1.0 + at[0] - 2.0 * at[1], -1.0]), np.array([0.4, 0.6])
    )
    assert found.at == pytest.approx([0.0, 1.0], abs=1e-9)
    assert found.at_ends == pytest.approx([-1.0, 2.0], rel=1e-6)


def test_points_that_do_not_exist_are_rejected():
    """x + y is least where x y = 0.2 touches; beyond y = 0.6, and for x + y < 0.85, nothing is."""

    def functions(at):
        x, y = at
        if y > 0.6 or x + y < 0.85:
            return np.full(2, np.inf)
        return np.array([x + y, 0.2 - x * y])

    known = np.array([0.9, 0.5])
    begin = nearest_start(functions, np.array([0.1, 0.9]), known)
    assert np.isfinite(functions(begin)).all()
    found = constrained_minimum(functions, begin)
    assert found.at == pytest.approx(np.sqrt([0.2, 0.2]), abs=1e-6)
    beside = slopes(functions, np.array([0.7, 0.6]))  # one side of y does not exist
    assert beside == pytest.approx(np.array([[1.0, 1.0], [-0.6, -0.7]]), rel=1e-7)
    nowhere = constrained_minimum(lambda _: np.full(2, np.inf), known)
    assert nowhere.violation == np.inf


def test_prices_of_limits_alike_are_open():
    """The second limit is twice the first: either may have all of the price, 1 or 1/2."""

    def functions(at):
        return np.array([at[0] + at[1], 0.5 - at[0] - at[1], 1.0 - 2.0 * (at[0] + at[1])])

    found = constrained_minimum(functions, np.array([0.5, 0.5]))
    ranges = multiplier_ranges(slopes(functions, found.at), found, [0, 1], 2)
    assert ranges == pytest.approx(np.array([[0.0, 1.0], [0.0, 0.5]]), abs=1e-3)
    together = multiplier_ranges(slopes(functions, found.at), found, [0, 0], 1)
    assert together == pytest.approx(np.array([[0.5, 1.0]]), abs=1e-3)


def test_the_price_of_one_limit_is_no_range():
    found = constrained_minimum(_tube, np.array([0.5, 0.2]))
    ranges = multiplier_ranges(slopes(_tube, found.at), found, [0, 1], 2)
    assert ranges == pytest.approx(np.array([found.multipliers, found.multipliers]).T, rel=1e-3)
