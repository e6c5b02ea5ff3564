"""Error against cost: Pareto front, and growth with size."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Ints


def pareto_front(seconds: ArrayLike, errors: ArrayLike, gain: float = 0.0) -> Ints:
    """Choices that no other one beats in both time and error.

    Parameters
    ----------
    seconds, errors : array_like
        (n,) of each choice; a choice with an error that is not a number is on no front.
    gain : float, optional
        By what share of its error a slower choice has to be better to count as better.

    Returns
    -------
    ndarray of int
        Indices, from the quickest to the most exact.
    """
    time, error = np.asarray(seconds, dtype=float), np.asarray(errors, dtype=float)
    front: list[int] = []
    least = np.inf
    for k in np.lexsort((error, time)):
        if error[k] < least * (1.0 - gain):
            front.append(int(k))
            least = error[k]
    return np.array(front, dtype=np.int64)


def cheapest_within(seconds: ArrayLike, errors: ArrayLike, bound: float) -> int | None:
    """The quickest choice with an error of at most `bound`; None where there is none."""
    time = np.where(np.asarray(errors) <= bound, seconds, np.inf)
    return int(np.argmin(time)) if np.isfinite(time).any() else None


def growth_exponent(unknowns: ArrayLike, cost: ArrayLike) -> float:
    """The b of cost = a n^b that fits best in logarithms; NaN from fewer than two sizes."""
    n, y = np.asarray(unknowns, dtype=float), np.asarray(cost, dtype=float)
    good = (y > 0.0) & np.isfinite(y)
    if len(np.unique(n[good])) < 2:
        return float("nan")
    return float(np.polyfit(np.log(n[good]), np.log(y[good]), 1)[0])
