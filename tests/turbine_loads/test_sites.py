"""Hours and weights of sites: printed tables to the digit, sums, limits."""

import numpy as np
import pytest

from fe_drivetrain.cases.gear import published_hours as printed
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.histories.sites import (
    Site,
    Transient,
    lifetime_damage,
    midpoint_edges,
    site_life,
    site_of_class,
    time_factors,
)


def test_hours_and_time_factors_of_a_thesis() -> None:
    hours = Site(10.0).hours(np.arange(3.0, 26.0))
    factors = time_factors(hours, 20.0)
    assert tuple(np.round(hours).astype(int)) == printed.HOURS
    assert tuple(np.round(factors).astype(int)) == printed.FACTORS
    assert round(float(hours.sum())) == 161950
    for row, line in zip(factors[8::2], printed.ADJUSTED, strict=True):
        assert [round(float(row) / d) for d in printed.DIVISORS.values()] == list(line)


@pytest.mark.parametrize(
    ("mean", "scale", "total"),
    [(8.0, 9.0270, 0.89497), (10.0, 11.2838, 0.92437), (12.0, 13.5406, 0.91902)],
)
def test_weights_of_another_thesis(mean: float, scale: float, total: float) -> None:
    """Stirling 2023, eq. 5.22, winds 4, 6, ... 24 m/s; C of 10 m/s is printed as 11.28."""
    site = Site(mean)
    edges = midpoint_edges(np.arange(4.0, 25.0, 2.0))
    assert edges.tolist() == np.arange(3.0, 26.0, 2.0).tolist()
    shares = site.shares(edges)
    assert site.scale == pytest.approx(scale, abs=5e-5)
    assert shares.sum() == pytest.approx(total, abs=5e-6)
    # the sum telescopes
    assert shares.sum() == pytest.approx(np.diff(site.below([3.0, 25.0]))[0])
    if mean == 8.0:
        assert shares[[0, 4, 10]] == pytest.approx([0.15963, 0.10084, 0.00105], abs=5e-6)


def test_the_mean_of_a_distribution_is_its_mean() -> None:
    for shape in (1.5, 2.0, 3.0):
        site = Site(8.5, shape)
        edges = np.linspace(0.0, 80.0, 8001)
        middles = 0.5 * (edges[1:] + edges[:-1])
        assert site.shares(edges) @ middles == pytest.approx(8.5, rel=1e-5)
    assert site_of_class("IIB").mean_wind == 8.5
    assert site_of_class("I") == Site(10.0)
    for wrong in ("IV", "ID", "B"):
        with pytest.raises(InputError, match="choose I, II, III"):
            site_of_class(wrong)
    with pytest.raises(InputError, match="mean_wind is 0"):
        Site(0.0)
    with pytest.raises(InputError, match="two speeds or more"):
        midpoint_edges([4.0])


def test_damage_and_lives_of_a_lifetime() -> None:
    site, edges = Site(10.0), np.arange(3.0, 26.0, 2.0)
    shares, factors = site.shares(edges), time_factors(site.hours(edges), 600.0)
    # equal damage at every wind: the life is that of one wind over the share of time
    assert site_life(np.full(11, 5.0), shares) == pytest.approx(5.0 / shares.sum())
    assert site_life(np.full(11, np.inf), shares) == np.inf
    lives = np.linspace(5.0, 50.0, 11)  # years at each wind
    damage = 600.0 / (lives * 8760.0 * 3600.0)
    assert 20.0 / lifetime_damage(damage, factors) == pytest.approx(site_life(lives, shares))
    # Germanischer Lloyd: 1000 stops a year at cut-in, 50 at rated, 50 at cut-out wind
    stops = [Transient("stop", count, 30.0) for count in (1000.0, 50.0, 50.0)]
    assert sum(stop.a_year for stop in stops) * site.years == 22_000
    assert sum(stop.hours(site.years) for stop in stops) == pytest.approx(183.3, abs=0.1)
    more = lifetime_damage(damage, factors, [(stops[0], 1e-6)])
    assert more - lifetime_damage(damage, factors) == pytest.approx(0.02)
