"""Rating life: closed forms, published lives, limits, sums that do not depend on their order."""

from math import gamma, pi, sqrt

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.bearing.arrangements import ball_row, double_row_tapered
from fe_drivetrain.bearing.distribution import sjovall
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing.rolling import equilibrium
from fe_drivetrain.bearing_life.life.load_series import equivalent_life, miner_load, years
from fe_drivetrain.bearing_life.life.lubricants import GREASE, contamination_factor
from fe_drivetrain.bearing_life.life.modified_life import (
    equivalent_loads,
    life_factor,
    modified_lamina_life,
    needed_viscosity,
    viscosity,
)
from fe_drivetrain.bearing_life.life.reference_life import (
    RowLoads,
    ball_life,
    basic_life,
    combined_life,
    lamina_life,
    reference_load,
    row_loads,
    rows_of,
    stress_riser,
)
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.histories.sites import Site, site_life

C = 6.71e6
F = 400e3
PITCH = 0.7874
ONES = np.ones(30)

#: The same rollers at two contact angles.
BEARINGS = {
    angle: double_row_tapered("S", 36, 0.065, 0.095, PITCH, angle, 0.152, arrangement)
    for angle, arrangement in ((38.0, "X"), (20.0, "O"))
}


def loaded(angle: float, *load: float, edge: float = 0.83, riser=ONES) -> list[RowLoads]:
    bearing = BEARINGS[angle]
    found = equilibrium(bearing, load, tolerance=1e-12)
    assert found.converged.all()
    return rows_of(bearing, found.displacements, C, edge=edge, riser=riser)


@pytest.fixture(scope="module", params=BEARINGS)
def radial(request: pytest.FixtureRequest) -> tuple[float, list[RowLoads]]:
    """Pure radial load: both rows equally, half of their rollers carry."""
    return request.param, loaded(request.param, 0, 0, -F, 0, 0)


@pytest.fixture(scope="module")
def uneven() -> list[RowLoads]:
    return loaded(38.0, 200e3, 0, -F, 800e3, 0, riser=None)


def test_the_stress_riser_is_that_of_the_table() -> None:
    f = stress_riser(30)
    assert_allclose(f[:4], [2.3283, 1.1266, 1.0641, 1.0418], atol=5e-5)
    assert_allclose(f[14], 1.0030, atol=5e-5)
    assert_allclose(f, f[::-1], rtol=1e-15)
    assert stress_riser(31)[15] == 1.0
    assert stress_riser(1) == [1.0]


@pytest.mark.parametrize(
    ("mean", "scale", "whole"),
    [(8, 9.0270, 0.89497), (10, 11.2838, 0.92437), (12, 13.5406, 0.91902)],
)
def test_weights_of_winds_are_those_of_the_table(mean: float, scale: float, whole: float) -> None:
    site = Site(mean)
    W = site.shares(np.arange(3.0, 26.0, 2.0))
    assert_allclose(site.scale, scale, rtol=1e-5)
    assert_allclose(W.sum(), whole, atol=5e-6)
    ends = np.exp(-((np.array([3.0, 25.0]) / site.scale) ** 2))
    assert_allclose(W.sum(), ends[0] - ends[1], rtol=1e-14)
    if mean == 8:
        assert_allclose(W[[0, 4, 10]], [0.15963, 0.10084, 0.00105], atol=5e-6)


def test_life_under_radial_load_is_the_integrals(radial) -> None:
    """Printed are 0.989 and 2.084; the integrals over the load zone have every digit."""
    angle, rows = radial
    without = loaded(angle, 0, 0, -F, 0, 0, edge=1.0)
    constant = float(lamina_life(without)[0]) * (F / C) ** 4
    assert 0.98885 < constant < 0.98935
    assert_allclose(lamina_life(rows)[0] * (F / C) ** 4, 2.084, atol=5e-4)
    assert_allclose(lamina_life(rows) / lamina_life(without), 0.83**-4, rtol=1e-12)
    # peak of half of a row in load, and means of its powers; capacities over C
    peak = 0.5 / sjovall(0.5, 1.1)[0]
    damage = 0.0
    for p, capacity in ((4.0, rows[0].inner_capacity), (4.5, rows[0].outer_capacity)):
        mean = mean_power(1.1 * p) ** (1.0 / p)
        q = peak * F / (36 * 30 * np.cos(np.radians(angle))) * mean
        damage += 2 * 30 * (q / capacity) ** 4.5
    assert_allclose(lamina_life(rows)[0], damage ** (-8 / 9), rtol=1e-4)


def mean_power(p: float) -> float:
    """Mean of cos^p over a circle of which half carries."""
    return gamma((p + 1) / 2) / (2 * sqrt(pi) * gamma(p / 2 + 1))


def test_equal_rows_and_parts_combine_by_weibulls_slope(radial) -> None:
    rows = radial[1]
    assert_allclose(lamina_life(rows), 2 ** (-8 / 9) * lamina_life(rows[:1]), rtol=1e-9)
    each = np.stack([lamina_life([row]) for row in rows], axis=-1)
    assert_allclose(combined_life(each), lamina_life(rows), rtol=1e-14)
    assert_allclose(combined_life([100.0, 200.0]), 71.4998, atol=5e-5)
    assert_allclose(combined_life([100.0, 200.0], 10 / 9), 71.0063, atol=5e-5)


def test_life_falls_with_the_fourth_power_of_all_loads(uneven) -> None:
    doubled = loaded(38.0, 400e3, 0, -2 * F, 1600e3, 0, riser=None)
    assert_allclose(lamina_life(doubled), lamina_life(uneven) / 16.0, rtol=1e-8)


def test_the_stress_riser_on_even_laminae_takes_the_printed_share(radial) -> None:
    with_riser = loaded(radial[0], 0, 0, -F, 0, 0, riser=None)
    assert_allclose(lamina_life(with_riser) / lamina_life(radial[1]), 0.2886, atol=5e-5)


def test_the_ring_that_turns_meets_all_loads() -> None:
    row = BEARINGS[38.0].rows[0]
    q = np.zeros((1, 36, 30))
    q[:, 0] = 100.0
    inner, outer = (row_loads(row, q, C, riser=ONES, turning=ring) for ring in ("inner", "outer"))
    assert_allclose(inner.inner, 100.0 * 36**-0.25, rtol=1e-14)
    assert_allclose(inner.outer, 100.0 * 36 ** (-1 / 4.5), rtol=1e-14)
    assert_allclose([outer.outer, outer.inner], [inner.inner, inner.outer], rtol=1e-14)
    empty = row_loads(row, 0.0 * q, C)
    assert lamina_life([empty]) == np.inf


#: Radial clearance [m], axial and radial force [N], MASTA's L10r [million revolutions].
MASTA = (
    (0.0, 0.0, 1e3, 13163.019),
    (0.0, 1e3, 0.0, 2222.7318),
    (1e-5, 0.0, 1e3, 10795.7948),
    (1e-5, 1e3, 0.0, 3115.8781),
    (1e-5, 1e3, 1e3, 1630.5367),
)


@pytest.mark.parametrize(("clearance", "axial", "force", "life"), MASTA)
def test_lives_of_a_ball_bearing_are_mastas(
    clearance: float, axial: float, force: float, life: float
) -> None:
    """From the tests of minzhun/ISO16281; ours has Hertz's exact stiffness for ISO's rounded."""
    row = ball_row(7, 0.0115, 0.0435, radial_clearance=clearance, youngs_modulus=210e9)
    found = equilibrium(Bearing("ball", (row,)), [axial, -force, 0, 0, 0], tolerance=1e-12)
    assert_allclose(ball_life(row, found.rollers, 23400.0), life, rtol=1e-4)


def test_the_reference_load_inverts_the_basic_life() -> None:
    P = np.array([10.0, 20.0])
    assert_allclose(reference_load(100.0, basic_life(100.0, P)), P, rtol=1e-14)
    assert_allclose(basic_life(55.3, 10.0, 3.0), 169.0, atol=0.5)  # a catalogue's example


def test_equivalent_loads_of_even_laminae_are_equal(radial) -> None:
    rows = radial[1]
    P = equivalent_loads(rows[0])
    assert_allclose(P, P.mean(), rtol=1e-12)
    assert_allclose(P / (0.5 * F), 0.868, atol=1e-3)  # printed; 0.8689 and 0.8678 of the two
    inner, outer = mean_power(4.4) ** (4.5 / 4), mean_power(4.95)
    weight = (1.038 * rows[0].inner_capacity / rows[0].outer_capacity) ** 4.5
    mixed = ((inner + weight * outer) / (1 + weight)) ** (1 / 4.5)
    assert_allclose(P / (0.5 * F), 0.323 / sjovall(0.5, 1.1)[0] * mixed, rtol=1e-4)


@pytest.mark.parametrize(
    ("kappa", "ratio", "a"),
    [
        (0.1, 0.05, 0.1),
        (0.4, 0.5, 0.2313),
        (1, 0.1, 0.3986),
        (1, 0.5, 1.7141),
        (2, 0.1, 0.5161),
        (2, 0.5, 3.0813),
        (4, 0.5, 5.5869),
    ],
)
def test_life_factors_are_those_of_the_table(kappa: float, ratio: float, a: float) -> None:
    assert_allclose(life_factor(ratio, kappa), a, atol=5.1e-5)


def test_life_factors_are_continuous_monotone_and_limited() -> None:
    ratio = np.linspace(0.0, 5.0, 101)[:, None]
    kappa = np.linspace(0.02, 6.0, 200)
    a = life_factor(ratio, kappa)
    assert (np.diff(a, axis=0) >= 0.0).all()
    # the constants of two branches meet at 0.4 to their last digit
    assert (np.diff(a, axis=1) >= -1e-4 * a[:, 1:]).all()
    assert_allclose(life_factor(0.5, 0.4), life_factor(0.5, np.nextafter(0.4, 0)), rtol=1e-5)
    assert_allclose(life_factor(0.5, 1.0), life_factor(0.5, np.nextafter(1.0, 0)), rtol=1e-14)
    assert_allclose(life_factor(0.5, 0.1), 0.1, rtol=1e-14)
    assert (a[0] == 0.1).all()
    assert (a[:, kappa < 0.1] == 0.1).all()
    assert a.max() == life_factor(np.inf, 2.0) == 50.0
    assert life_factor(0.5, 9.0) == life_factor(0.5, 4.0)
    assert life_factor(np.inf, 0.0) == 0.1


def test_modified_life_lies_between_its_factors(uneven) -> None:
    L10r = lamina_life(uneven)
    assert_allclose(modified_lamina_life(uneven, [np.ones(30)] * 2), L10r, rtol=1e-14)
    assert_allclose(modified_lamina_life(uneven, [3.0, 3.0], 0.62), 3.0 * 0.62 * L10r, rtol=1e-14)
    factors = [life_factor(0.7 * 0.5 * 1.1e6 / equivalent_loads(row), 1.4) for row in uneven]
    ratio = modified_lamina_life(uneven, factors) / L10r
    every = np.concatenate(factors, axis=1)
    assert 0.1 < every.min() < ratio < every.max() < 50.0


def test_steps_of_life_combine_by_miners_rule() -> None:
    rng = np.random.default_rng(1)
    L, t = rng.uniform(1, 100, (4, 25)), rng.uniform(0.1, 2, (4, 25))
    assert_allclose(equivalent_life(np.full(7, 12.5)), 12.5, rtol=1e-14)
    assert_allclose(equivalent_life(np.full(25, 12.5), t[0]), 12.5, rtol=1e-14)
    # weights sum to one: only shares matter
    assert_allclose(equivalent_life(L, 1e3 * t), equivalent_life(L, t), rtol=1e-13)
    split = equivalent_life(np.repeat(L[0], 3), np.repeat(t[0], 3) / 3)
    assert_allclose(split, equivalent_life(L[0], t[0]), rtol=1e-13)
    each = equivalent_life(L, t)
    assert each.shape == (4,)
    assert_allclose(equivalent_life(each, t.sum(axis=1)), equivalent_life(L.ravel(), t.ravel()))
    assert equivalent_life([5.0, 0.0, np.inf]) == 0.0
    assert_allclose(equivalent_life([5.0, np.inf]), 10.0)
    assert_allclose(equivalent_life([5.0, 1e-9]), 2e-9, rtol=1e-9)
    assert_allclose(site_life(L[0], t[0] / t[0].sum()), equivalent_life(L[0], t[0]), rtol=1e-13)


def test_a_miner_load_has_the_life_of_its_series() -> None:
    P = miner_load([10.0, 20.0], [0.9, 0.1])
    assert_allclose(P, 12.13862, atol=5e-6)
    assert_allclose(basic_life(100.0, P), 1129.196, atol=5e-4)
    steps = equivalent_life(basic_life(100.0, [10.0, 20.0]), [0.9, 0.1])
    assert_allclose(basic_life(100.0, P), steps, rtol=1e-13)


def test_twice_the_speed_is_half_of_the_years() -> None:
    assert_allclose(years(100.0, [20.0, -40.0]), 1e8 / (np.array([20, 40]) * 60 * 8760))
    assert years(100.0, 0.0) == np.inf


def test_viscosity_returns_its_inputs_and_lies_between() -> None:
    known = ((40.0, 460.0), (100.0, 30.5))
    assert_allclose(viscosity([40.0, 100.0], known), [460.0, 30.5], rtol=1e-12)
    assert_allclose(viscosity(60.0, known), 147.8, atol=0.05)


def test_needed_viscosity_is_that_of_the_table_and_steps_at_1000() -> None:
    assert_allclose(needed_viscosity([10, 18, 20], PITCH), [237.2, 145.6, 133.4], atol=0.05)
    step = needed_viscosity(1000.0, PITCH) / needed_viscosity(np.nextafter(1000.0, 0), PITCH)
    assert_allclose(step, 0.1 * 1000**0.33, rtol=1e-12)
    assert 0.97 < step < 0.98


@pytest.mark.parametrize(
    ("nu", "kappa", "factors"),
    [
        (460.0, 3.16, [0.876, 0.818, 0.701, 0.296]),
        (200.0, 1.373, [0.876, 0.704, 0.398, 0.168]),
        (80.0, 0.549, [0.876, 0.378, 0.213, 0.090]),
    ],
)
def test_contamination_of_three_greases(nu: float, kappa: float, factors: list[float]) -> None:
    found = nu / needed_viscosity(18.0, PITCH)
    assert_allclose(found, kappa, atol=5e-3)
    e_C = [
        float(contamination_factor(found, PITCH, "grease", grease)) for grease in list(GREASE)[1:]
    ]
    assert_allclose(e_C, factors, atol=5.1e-4)
    assert contamination_factor(found, PITCH, "grease", "high") > e_C[0]


def test_contamination_of_a_main_bearing_is_mastas() -> None:
    """A published 26 MW study; its class is not stated: slight to typical fits."""
    assert_allclose(
        contamination_factor(1.0, 3.3286, "grease", "slight to typical"), 0.888378, rtol=1e-3
    )


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: stress_riser(0), "0 laminae"),
        (lambda: rows_of(BEARINGS[38.0].with_rows(laminae=0), np.zeros(5), C), "laminae=30"),
        (lambda: row_loads(BEARINGS[38.0].rows[0], np.zeros((1, 5, 30)), C), "36 rollers"),
        (lambda: row_loads(BEARINGS[38.0].rows[0], np.zeros((1, 36, 30)), -1.0), "load rating"),
        (lambda: row_loads(BEARINGS[38.0].rows[0], np.zeros((1, 36, 9)), C, riser=ONES), "stress"),
        (
            lambda: row_loads(BEARINGS[38.0].rows[0], np.zeros((1, 36, 9)), C, turning="both"),
            "'inner' or 'outer'",
        ),
        (lambda: contamination_factor(1.0, 0.7, "grease", "dirty"), "very severe"),
        (lambda: viscosity(50.0, ((40, 460), (40, 30))), "two temperatures"),
        (lambda: equivalent_life([1.0, -1.0]), "0 or more"),
        (lambda: equivalent_life([1.0, 1.0], [1.0, 0.0]), "durations"),
    ],
)
def test_mistakes_are_named(call, words: str) -> None:
    with pytest.raises(InputError, match=words):
        call()
