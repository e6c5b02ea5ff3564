"""Sweeps over decades: the range that is safe, and the slope of an error on logarithmic axes."""

import math

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats

FOUR_DIGITS = 1e-4
"""Relative error of a stiffness that counts as safe."""


def decades(low: float, high: float, per_decade: float) -> Floats:
    """Values from 10^low to 10^high, evenly spaced in logarithms.

    Parameters
    ----------
    low, high : float
        Exponents of the first and the last value.
    per_decade : float
        Number of values to a decade.

    Returns
    -------
    values : (n,) array
    """
    return np.asarray(10.0 ** np.linspace(low, high, round((high - low) * per_decade) + 1))


def safe_range(
    x: ArrayLike, error: ArrayLike, criterion: float
) -> tuple[float | None, float | None]:
    """The range of a sweep in which an error stays within a criterion.

    Parameters
    ----------
    x : (n,) array
        Ascending.
    error : (n,) array
        Not a number where there is no answer: that is not safe.
    criterion : float
        Largest error that is safe.

    Returns
    -------
    low, high : float or None
        Ends of the run of safe points that holds the least error; None where the run reaches the
        end of the sweep.

    Raises
    ------
    ValueError
        No point is safe.
    """
    at, e = np.asarray(x, dtype=float), np.asarray(error, dtype=float)
    bad = ~(e <= criterion)
    if bad.all():
        raise ValueError(f"no point of the sweep has an error within {criterion:g}")
    best = int(np.argmin(np.where(bad, np.inf, e)))
    before, after = np.flatnonzero(bad[:best]), np.flatnonzero(bad[best:])
    low = float(at[before[-1] + 1]) if len(before) else None
    high = float(at[best + after[0] - 1]) if len(after) else None
    return low, high


def last_within(x: ArrayLike, error: ArrayLike, criterion: float) -> float | None:
    """The last point of a sweep up to which all errors stay within a criterion.

    Parameters
    ----------
    x : (n,) array
        In the order of the sweep.
    error : (n,) array
        With or without signs; not a number where there is no answer, which is not within.
    criterion : float
        Largest size of an error that is accepted.

    Returns
    -------
    last : float or None
        None where not even the first error is within.
    """
    within = np.abs(np.asarray(error, dtype=float)) <= criterion
    count = len(within) if within.all() else int(np.argmin(within))
    return float(np.asarray(x, dtype=float)[count - 1]) if count else None


def min_safe(x: ArrayLike, error: ArrayLike, level: float) -> float | None:
    """Least x from which on an error is below a level, to the end of the sweep.

    Parameters
    ----------
    x : (n,) array
        Ascending.
    error : (n,) array
        With its sign, which does not count.
    level : float
        In the unit of the error.

    Returns
    -------
    least : float or None
        Between points by straight lines in logarithms; the first x where the error is below the
        level everywhere, None where it is not even at the last.
    """
    x, size = np.asarray(x, dtype=float), np.abs(np.asarray(error, dtype=float))
    above = np.flatnonzero(size >= level)
    if not len(above):
        return float(x[0])
    k = int(above[-1])
    if k == len(x) - 1:
        return None
    share = np.log(size[k] / level) / np.log(size[k] / size[k + 1])
    return float(np.exp(np.log(x[k]) + share * np.log(x[k + 1] / x[k])))


def fitted_exponent(
    x: ArrayLike, y: ArrayLike, within: tuple[float, float] = (0.0, math.inf)
) -> tuple[float, float | None]:
    """Exponent b of y = a x^b that fits best in logarithms, and how well the points determine it.

    Parameters
    ----------
    x, y : (n,) array
        Positive x; y that is not a number is left out.
    within : tuple of float
        Only points with y between these are fitted.

    Returns
    -------
    exponent : float
        NaN from fewer than two points.
    band : float or None
        Twice its standard error, from the scatter of the points about the line; None from fewer
        than three points.
    """
    at, value = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    good = np.isfinite(value) & (value > within[0]) & (value < within[1])
    if good.sum() < 2:
        return math.nan, None
    log_x, log_y = np.log10(at[good]), np.log10(value[good])
    b, a = np.polyfit(log_x, log_y, 1)
    if good.sum() < 3:
        return float(b), None
    variance = ((log_y - a - b * log_x) ** 2).sum() / (good.sum() - 2)
    return float(b), float(2.0 * np.sqrt(variance / ((log_x - log_x.mean()) ** 2).sum()))


def in_words(value: float | None) -> str:
    """A bound of a safe range, or that there is none."""
    return "no bound" if value is None else f"{float(f'{value:.2g}'):g}"
