"""How often a site has which wind, and what histories at single winds mean over a lifetime."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import gamma
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

HOURS_A_YEAR = 8760.0

MEAN_WIND = {"I": 10.0, "II": 8.5, "III": 7.5}
"""Annual mean at hub height [m/s] of wind turbine classes (IEC 61400-1, ed. 4, table 1)."""

TURBULENCE = {"A+": 0.18, "A": 0.16, "B": 0.14, "C": 0.12}
"""Reference turbulence intensity of their categories (the same table)."""

WIND_BIN = 1.0
"""Histories whose mean winds round to the same multiple are of one condition [m/s]."""


@dataclass(frozen=True)
class Site:
    """A Weibull distribution of ten-minute mean wind speeds, and how long a turbine stands in it.

    Attributes
    ----------
    mean_wind : float
        Mean wind speed of the year [m/s].
    shape : float
        Weibull's exponent k; 2 is Rayleigh's distribution.
    years : float
        Design life [years].

    Raises
    ------
    InputError
        A value is not positive.
    """

    mean_wind: float
    shape: float = 2.0
    years: float = 20.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not 0.0 < value < np.inf:
                raise InputError(f"site: {name} is {value:g}: give a number above 0")

    @property
    def scale(self) -> float:
        """Weibull's scale parameter C [m/s]: the mean over Gamma(1 + 1/k)."""
        return self.mean_wind / gamma(1.0 + 1.0 / self.shape)

    def below(self, speed: ArrayLike) -> Floats:
        """Share of time with a mean wind speed below one [m/s]: 1 - exp(-(U/C)^k)."""
        return np.asarray(-np.expm1(-((np.asarray(speed, dtype=float) / self.scale) ** self.shape)))

    def shares(self, edges: ArrayLike) -> Floats:
        """Share of time in each bin.

        Parameters
        ----------
        edges : array_like, (n + 1,)
            Limits of the bins [m/s], rising.

        Returns
        -------
        ndarray, (n,)
            Their sum is below 1: calm and storm are outside.
        """
        return np.asarray(np.diff(self.below(edges)))

    def hours(self, edges: ArrayLike) -> Floats:
        """Hours of the lifetime in each bin: (n,); see `shares`."""
        return HOURS_A_YEAR * self.years * self.shares(edges)


def site_of_class(name: str, years: float = 20.0) -> Site:
    """The site that a wind turbine class of IEC 61400-1 stands for: I, II or III, Rayleigh.

    Parameters
    ----------
    name : str
        The class, with or without a category of turbulence, as in "IIB".
    years : float
        Design life [years].

    Raises
    ------
    InputError
        There is no such class.
    """
    numeral = name.rstrip("ABC+")
    if numeral not in MEAN_WIND or name.removeprefix(numeral) not in ("", *TURBULENCE):
        raise InputError(
            f"wind turbine class '{name}': choose {', '.join(MEAN_WIND)}, with "
            f"{', '.join(TURBULENCE)} or without"
        )
    return Site(MEAN_WIND[numeral], years=years)


def midpoint_edges(speeds: ArrayLike) -> Floats:
    """Limits of bins about mean wind speeds of simulations: halfway between neighbours.

    Parameters
    ----------
    speeds : array_like, (n,)
        Rising [m/s], two or more.

    Returns
    -------
    ndarray, (n + 1,)
        The outermost as far out as the nearest within.
    """
    middles = np.asarray(speeds, dtype=float)
    if len(middles) < 2 or (np.diff(middles) <= 0.0).any():
        raise InputError(
            "bins about wind speeds need two speeds or more, each above the one before"
        )
    inner = 0.5 * (middles[1:] + middles[:-1])
    first, last = 2.0 * middles[0] - inner[0], 2.0 * middles[-1] - inner[-1]
    return np.concatenate([[max(first, 0.0)], inner, [last]])


def rounded_wind(wind: float) -> float:
    """Mean wind speed for which a file stands: histories of one round to one [m/s]."""
    return float(WIND_BIN * np.round(wind / WIND_BIN))


def require_winds(files: Sequence[Path], winds: Sequence[float]) -> None:
    """Refuse files that a site's winds cannot weight.

    Parameters
    ----------
    files : sequence of Path
        The histories.
    winds : sequence of float
        Mean wind speed of each [m/s]; NaN where it has none.

    Raises
    ------
    InputError
        A file has no wind speed, or all stand for one wind.
    """
    site = argument("site")
    for file, wind in zip(files, winds, strict=True):
        if np.isnan(wind):
            raise InputError(
                f"hub loads '{file}': there is no wind speed, by which {site} weights files: name "
                "its channel, as in `ChannelMap(channels={'wind speed': 'Vhub'})`, or leave "
                f"{site} out"
            )
    if len({rounded_wind(wind) for wind in winds}) < 2:
        count = f"all {len(files)} files have" if len(files) > 1 else "the one file has"
        raise InputError(
            f"{site} weights winds, and {count} a mean wind of {rounded_wind(winds[0]):g} m/s: "
            f"give files of two winds or more, or leave {site} out"
        )


def require_several(site: Site | None, count: int) -> None:
    """Refuse a site's winds for one file before anything is computed; `require_winds` does later.

    Parameters
    ----------
    site : Site or None
        Whose winds weight the files; None asks nothing of them.
    count : int
        How many files there are.

    Raises
    ------
    InputError
        There is one.
    """
    if site is not None and count == 1:
        name = argument("site")
        raise InputError(
            f"{name} weights winds, and there is one file: give files of two winds or more, or "
            f"leave {name} out"
        )


@dataclass(frozen=True)
class Transient:
    """An event that comes so many times a year, as starts and stops do.

    Attributes
    ----------
    name : str
        What it is.
    a_year : float
        How often.
    seconds : float
        How long its history is [s].
    """

    name: str
    a_year: float
    seconds: float

    def hours(self, years: float) -> float:
        """Time of all events of a lifetime [h]."""
        return self.a_year * years * self.seconds / 3600.0


def time_factors(hours: ArrayLike, seconds: ArrayLike) -> Floats:
    """How often each history of so many seconds stands for its hours: (n,)."""
    return np.asarray(3600.0 * np.asarray(hours, dtype=float) / np.asarray(seconds, dtype=float))


def lifetime_damage(
    damage: ArrayLike,
    factors: ArrayLike,
    of_transients: Sequence[tuple[Transient, float]] = (),
    years: float = 20.0,
) -> float:
    """Damage of a lifetime by Miner's rule, or any sum of n r^m.

    Parameters
    ----------
    damage : array_like, (n,)
        Damage of the history of each wind speed.
    factors : array_like, (n,)
        See `time_factors`.
    of_transients : sequence of (Transient, float)
        Each event, and the damage of one.
    years : float
        Life [years].
    """
    normal = float(np.asarray(damage, dtype=float) @ np.asarray(factors, dtype=float))
    return normal + sum(event.a_year * years * one for event, one in of_transients)


def site_life(lives: ArrayLike, shares: ArrayLike) -> float:
    """Life at a site of lives at single winds: ``1 / sum(W / L)`` (Stirling 2023, eq. 5.23).

    Parameters
    ----------
    lives : array_like, (n,)
        At each wind [any unit of time]; infinite where there is no damage.
    shares : array_like, (n,)
        Shares of time at each.

    Returns
    -------
    float
        Calendar life: time outside of all bins does no damage.
    """
    rate = float(np.sum(np.asarray(shares, dtype=float) / np.asarray(lives, dtype=float)))
    return 1.0 / rate if rate else float("inf")
