"""Side branches of rating life: two rows of balls, tables of factors, limits of some steps."""

from math import log

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.bearing.arrangements import (
    ball_row,
    cylindrical,
    double_row_tapered,
    tapered_row,
)
from fe_drivetrain.bearing.geometry import BallRow, Bearing
from fe_drivetrain.bearing.rating import ball_dynamic_rating, ratings
from fe_drivetrain.bearing_life.life.life_rules import RELIABILITY, LifeRules
from fe_drivetrain.bearing_life.life.lubricants import SUPPLIES, Lubricant, contamination_factor
from fe_drivetrain.bearing_life.life.modified_life import life_factor
from fe_drivetrain.bearing_life.life.rated import (
    ANGULAR,
    BALL_E,
    BALL_RATIO,
    BALL_Y,
    STATIC_Y,
    ball_static_rating,
    of_geometry,
    rated_bearing,
)
from fe_drivetrain.bearing_life.life.reference_life import ball_capacities
from fe_drivetrain.bearing_life.life.roller_damage import damage_of_steps
from fe_drivetrain.bearing_life.life.steps import Steps

OIL = Lubricant(100.0, 11.0, 50.0, "oil bath", "-/15/12")


def balls(rows: int, angle: float = 0.0, pitch: float = 0.06) -> Bearing:
    signs = (1.0,) if rows == 1 else (-1.0, 1.0)
    places = (0.0,) if rows == 1 else (-0.01, 0.01)
    return Bearing(
        "balls",
        tuple(
            ball_row(8, 0.01, pitch, sign * angle, place)
            for sign, place in zip(signs, places, strict=True)
        ),
    )


def test_balls_of_a_row_know_nothing_of_a_second_one() -> None:
    """The rating grows as the number of rows to the power of 0.7: what a ball carries stays."""
    one, two = balls(1), balls(2)
    C, C2 = ball_dynamic_rating(one), ball_dynamic_rating(two)
    (row,), (other, _) = one.rows, two.rows
    assert isinstance(row, BallRow)
    assert isinstance(other, BallRow)
    assert_allclose(ball_capacities(other, C2, 2), ball_capacities(row, C), rtol=1e-13)


def test_two_rows_of_balls_equally_loaded_live_as_weibulls_slope_has_it() -> None:
    """With the limit of a row on the load of a row, the factors of both rows are that of one."""
    Q = np.random.default_rng(1).uniform(100.0, 900.0, (5, 8, 1))
    lives = []
    for rows in (1, 2):
        bearing = balls(rows)
        rated = rated_bearing(bearing, ball_dynamic_rating(bearing), fatigue=100.0 * rows)
        loads = np.zeros((5, 5))
        steps = Steps(loads, (Q,) * rows, np.full(5, 900.0), np.ones(5), np.ones(5, dtype=bool))
        lives.append(damage_of_steps(steps, rated, LifeRules(OIL)).lives("Mrev"))
    one, two = lives
    assert 0.15 < one["L10mr"] / one["L10r"] < 40.0  # the factor is at none of its ends
    for kind in ("L10r", "L10mr"):
        assert_allclose(two[kind], one[kind] * 2.0**-0.9, rtol=1e-12)


@pytest.mark.parametrize(
    ("kappa", "a", "b"), [(0.2, 2.2649, 0.054381), (0.7, 1.9987, 0.19087), (2.0, 1.9987, 0.071739)]
)
def test_life_factors_of_balls_are_the_standards_equations(
    kappa: float, a: float, b: float
) -> None:
    """ISO 281:2007, Eq 31 to 33, as public code prints them."""
    ratio = 0.05
    expected = 0.1 * (1 - (2.5671 - a / kappa**b) ** 0.83 * ratio ** (1 / 3)) ** -9.3
    assert 0.1 < expected < 50.0
    assert_allclose(life_factor(ratio, kappa, "point"), expected, rtol=1e-12)


@pytest.mark.parametrize("percent", RELIABILITY)
def test_a_1_is_a_weibull_distribution_with_a_least_life(percent: float) -> None:
    """A slope of 3/2, and a twentieth of L10 that all reach (ISO/TR 1281-2), to printed digits."""
    share = log(100.0 / percent) / log(100.0 / 90.0)
    digits = 3 if percent > 99.0 else 2
    assert RELIABILITY[percent] == round(0.95 * share ** (2 / 3) + 0.05, digits)


def test_equivalent_loads_do_not_jump_where_their_factors_change() -> None:
    """X F_r + Y F_a on both sides of e, to half of the last digit of each factor printed."""
    for e, X, Y, Y1, X2, Y2 in ANGULAR.values():
        assert abs(X + Y * e - 1.0) <= 0.005 * (1.0 + e + Y)
        assert abs(X2 + Y2 * e - (1.0 + Y1 * e)) <= 0.005 * (1.0 + 2.0 * e + Y2 - Y1)
    # e of deep grooves is rounded upwards
    for e, Y in zip(BALL_E, BALL_Y, strict=True):
        assert abs(0.56 + Y * e - 1.0) <= 0.005 * (1.0 + e + 2.0 * Y)


def test_factors_change_one_way_with_the_contact_angle_and_the_load() -> None:
    columns = np.array(list(ANGULAR.values())).T
    assert (np.diff(columns[0]) > 0.0).all()
    assert (np.diff(columns[1:], axis=1) < 0.0).all()
    assert (np.diff(STATIC_Y) < 0.0).all()
    assert (np.diff(BALL_RATIO) > 0.0).all()
    assert (np.diff(BALL_E) > 0.0).all()
    assert (np.diff(BALL_Y) < 0.0).all()


@pytest.mark.parametrize(
    "bearing",
    [
        balls(1),
        balls(1, 40.0),
        balls(2, 40.0),
        Bearing("t", (tapered_row(36, 0.065, 0.095, 0.7874, 20.0),)),
        double_row_tapered("T", 36, 0.065, 0.095, 0.7874, 20.0, 0.152, "O"),
        cylindrical("c", 20, 0.03, 0.05, 0.3),
    ],
    ids=lambda bearing: f"{bearing.name}, {len(bearing.rows)} rows",
)
def test_equivalent_loads_do_not_know_directions_and_are_not_below_the_radial_force(
    bearing,
) -> None:
    rated = rated_bearing(bearing, 1e6, 1e6, 1e5)
    F = np.random.default_rng(3).uniform(0.0, 1e4, (20, 3))
    F[0] = 0.0, 3e3, 4e3
    there, back = (np.column_stack([s * F, np.zeros((20, 2))]) for s in (1.0, -1.0))
    radial = np.hypot(F[:, 1], F[:, 2])
    for load in (rated.equivalent_load, rated.static_load):
        assert_allclose(load(there), load(back), rtol=1e-14)
        assert_allclose(load(there)[0], 5e3, rtol=1e-14)  # radial alone
    assert (rated.static_load(there) >= radial * (1.0 - 1e-14)).all()


def test_two_opposed_rows_carry_twice_the_static_load_of_one() -> None:
    for one, two in (
        (balls(1, 30.0), balls(2, 30.0)),
        (
            Bearing("t", (tapered_row(36, 0.065, 0.095, 0.7874, 20.0),)),
            double_row_tapered("T", 36, 0.065, 0.095, 0.7874, 20.0, 0.152, "O"),
        ),
    ):
        assert_allclose(of_geometry(two).static, np.multiply(2.0, of_geometry(one).static))
    assert_allclose(ball_static_rating(balls(2, 30.0)), 2.0 * ball_static_rating(balls(1, 30.0)))


@pytest.mark.parametrize(("pitch", "share"), [(0.06, 1.0), (0.1, 1.0), (0.4, 4.0)])
def test_fatigue_limits_fall_beyond_a_pitch_diameter_of_100_mm(pitch: float, share: float) -> None:
    """C_0 / C_u: 22 of balls and 8.2 of rollers; beyond 100 mm by roots (ISO 281, annex B)."""
    of_balls = rated_bearing(balls(1, pitch=pitch), 1e4)
    assert_allclose(of_balls.static / of_balls.fatigue, 22.0 * share**0.5, rtol=1e-12)
    of_rollers = ratings(cylindrical("c", 12, 0.01, 0.01, pitch))
    assert_allclose(of_rollers.static / of_rollers.fatigue, 8.2 * share**0.3, rtol=1e-12)


def test_loads_beyond_half_of_the_rating_are_timed_apart_from_those_below() -> None:
    bearing = cylindrical("c", 20, 0.03, 0.05, 0.3, laminae=5)
    rated = rated_bearing(bearing, 1e6, 2e6, 1e5)
    loads = np.zeros((4, 5))
    loads[:, 2] = -1e6 * np.array([0.3, 0.7, 1.3, 2.5])
    seconds = np.array([1.0, 2.0, 4.0, 8.0])
    laminae = np.ones((4, 20, 5))
    steps = Steps(loads, (laminae,), np.full(4, 18.0), seconds, np.ones(4, dtype=bool))
    found = damage_of_steps(steps, rated, LifeRules()).limits
    assert (found.heavy, found.weak) == (14.0, 8.0)
    assert (found.max_load, found.max_static) == (2.5e6, 2.5e6)


def test_a_filter_in_the_circuit_keeps_oil_cleaner_than_a_bath() -> None:
    for name in SUPPLIES["filtered oil"]:
        kappa = np.array([0.3, 1.0, 3.0])
        filtered = contamination_factor(kappa, 0.2, "filtered oil", name)
        assert (filtered > contamination_factor(kappa, 0.2, "oil bath", name)).all()


def test_slight_contamination_of_grease_counts_more_below_500_mm() -> None:
    """ISO 281, annex A: 1.887 in the place of 1.677."""
    below, above = (
        float(contamination_factor(0.5, D, "grease", "slight to typical")) for D in (0.499999, 0.5)
    )
    root = 500.0 ** (1 / 3)
    assert below / above == pytest.approx((1 - 1.887 / root) / (1 - 1.677 / root), rel=1e-5)
