"""Sweeps over decades: the range that is safe, and the slope of an error on logarithmic axes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common import Floats
from fe_drivetrain.report import trace

#: Relative error of a stiffness that counts as safe: four digits.
FOUR_DIGITS = 1e-4


def decades(low: float, high: float, per_decade: float) -> Floats:
    """Values from 10^low to 10^high, so many a decade."""
    return np.asarray(10.0 ** np.linspace(low, high, round((high - low) * per_decade) + 1))


def safe_range(
    x: ArrayLike, error: ArrayLike, criterion: float
) -> tuple[float | None, float | None]:
    """The range of a sweep in which an error stays within a criterion.

    Parameters
    ----------
    x
        (n,) ascending.
    error
        (n,) not a number where there is no answer: that is not safe.
    criterion
        Largest error that is safe.

    Returns
    -------
    low, high
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


def slope(x: ArrayLike, y: ArrayLike, within: tuple[float, float] = (0.0, math.inf)) -> float:
    """Exponent b of y = a x^b that fits best in logarithms, of the points with y within bounds.

    NaN from fewer than two points.
    """
    at, value = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    good = np.isfinite(value) & (value > within[0]) & (value < within[1])
    if good.sum() < 2:
        return float("nan")
    return float(np.polyfit(np.log10(at[good]), np.log10(value[good]), 1)[0])


def shown(value: float | None) -> str:
    """A bound in words."""
    return "no bound" if value is None else f"{value:.2g}"


def crosses(name: str, x: ArrayLike, y: ArrayLike | None = None) -> Any:
    """Trace of points without an answer, at 1 where there is not even a wrong one."""
    at = np.asarray(x, dtype=float)
    shown_at = np.ones(len(at)) if y is None else np.nan_to_num(np.asarray(y, dtype=float), nan=1.0)
    return trace(name, at, shown_at, True, marker={"symbol": "x"})
