"""Hours and weights of sites: printed tables to the digit, sums, limits."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.histories.sites import (
    Site,
    Transient,
    lifetime_damage,
    midpoint_edges,
    site_life,
    site_of_class,
    time_factors,
)

#: Al-Hamadani 2018, Table 7.1: hours in 20 years and time factors of 20 s, at 4, 5, ... 25 m/s.
HOURS = (8733, 10545, 11916, 12817, 13251, 13247, 12856, 12146, 11194, 10080, 8878, 7655, 6467)
HOURS += (5356, 4351, 3468, 2713, 2084, 1573, 1165, 848, 607)
FACTORS = (1571855, 1898039, 2144818, 2307084, 2385178, 2384376, 2313997, 2186246, 2014953)
FACTORS += (1814352, 1598001, 1377938, 1164124, 964148, 783209, 624278, 488421, 375193, 283052)
FACTORS += (209761, 152726, 109270)

#: Table 7.2 at 12, 14, ... 24 m/s: planet, ring, sun, IMS gear and pinion, HSS gear and pinion.
TEETH = (58, 145, 116, 116, 464, 464, 1776)
ADJUSTED = """34741 13896 17370 17370 4343 4343 1135
27552 11021 13776 13776 3444 3444 900
20071 8028 10036 10036 2509 2509 655
13504 5401 6752 6752 1688 1688 441
8421 3368 4211 4211 1053 1053 275
4880 1952 2440 2440 610 610 159
2633 1053 1317 1317 329 329 86"""


def test_hours_and_time_factors_of_a_thesis() -> None:
    hours = Site(10.0).hours(np.arange(3.0, 26.0))
    factors = time_factors(hours, 20.0)
    assert tuple(np.round(hours).astype(int)) == HOURS
    assert tuple(np.round(factors).astype(int)) == FACTORS
    assert round(float(hours.sum())) == 161950
    for row, line in zip(factors[8::2], ADJUSTED.splitlines(), strict=True):
        assert [round(float(row) / teeth) for teeth in TEETH] == [int(n) for n in line.split()]


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
