"""Error against cost: Pareto front, growth with size, and the limit that a series of meshes has."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from fe_drivetrain.elasticity import Floats, Ints
from fe_drivetrain.errors import InputError

_ORDERS = 0.2, 8.0
_LEAST_SHARE = 1 / 3


def pareto_front(seconds: ArrayLike, errors: ArrayLike, gain: float = 0.0) -> Ints:
    """Choices that no other one beats in both time and error.

    Parameters
    ----------
    seconds, errors
        (n,) of each choice; a choice with an error that is not a number is on no front.
    gain
        By what share of its error a slower choice has to be better to count as better.

    Returns
    -------
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


@dataclass(frozen=True)
class Limit:
    """What a series of meshes tends to.

    Attributes
    ----------
    value
        At element size zero.
    uncertainty
        Half width of the band that the limit is expected in, in the unit of the value.
    order
        Observed order of convergence; NaN where the last three values show none.
    """

    value: float
    uncertainty: float
    order: float


def richardson(sizes: ArrayLike, values: ArrayLike, order: float) -> float:
    """The limit of two values whose error is proportional to size^order.

    Parameters
    ----------
    sizes, values
        (2,), coarse first.
    """
    h, v = np.asarray(sizes, dtype=float), np.asarray(values, dtype=float)
    return float(v[1] - (v[0] - v[1]) / ((h[0] / h[1]) ** order - 1.0))


def extrapolate(sizes: ArrayLike, values: ArrayLike, least_order: float = 1.0) -> Limit:
    """The limit of a series of meshes, and how sure it is.

    The last three values give the order and the limit (Richardson). What the series is expected
    to do at the worst, `least_order`, gives another limit from the last two; where there are
    four values, the first three of the last four give a third. The band is the largest
    difference between these, and at least a third of what is still missing: unstructured meshes
    are never quite similar.

    Parameters
    ----------
    sizes, values
        (n,), n >= 3, coarse first: element size and what was computed with it.
    least_order
        Order to be expected where stress is singular.

    Raises
    ------
    InputError
        There are fewer than three values, or the sizes do not descend.
    """
    h, v = np.asarray(sizes, dtype=float), np.asarray(values, dtype=float)
    if len(h) < 3 or len(h) != len(v) or np.any(np.diff(h) >= 0):
        raise InputError(
            f"extrapolation of {len(v)} values over the sizes {h.tolist()} needs at least three "
            "sizes that descend: add finer meshes"
        )
    slowest = richardson(h[-2:], v[-2:], least_order)
    order = _observed_order(h[-3:], v[-3:])
    if np.isnan(order):
        # no order to be seen: anything between the last values and the slow limit
        return Limit(slowest, float(max(abs(slowest - v[-1]), np.ptp(v[-3:]))), order)
    value = richardson(h[-2:], v[-2:], order)
    differences = [abs(value - slowest), _LEAST_SHARE * abs(value - v[-1])]
    if len(h) > 3:
        before = _observed_order(h[-4:-1], v[-4:-1])
        if not np.isnan(before):
            differences.append(abs(value - richardson(h[-3:-1], v[-3:-1], before)))
    return Limit(value, float(max(differences)), order)


def _observed_order(h: Floats, v: Floats) -> float:
    """The p of v = v0 + c h^p through three values; NaN where there is none in sight."""
    first, second = v[0] - v[1], v[1] - v[2]

    def excess(p: float) -> float:
        steps = -np.diff((h / h[0]) ** p)
        return float(first * steps[1] - second * steps[0])

    if first * second <= 0.0 or excess(_ORDERS[0]) * excess(_ORDERS[1]) >= 0.0:
        return float("nan")
    return float(brentq(excess, *_ORDERS))
