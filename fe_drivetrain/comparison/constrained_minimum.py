"""The least value of a function within limits, its multipliers, and which limits conflict.

Sequential quadratic programming of SciPy (Kraft 1988, DFVLR-FB 88-28) finds it from each of several
starts. Variables go from 0 to 1, the function and the limits are relative, so that one step of a
difference and one tolerance serve all. Multipliers are the non-negative ones that balance the
gradients best (Karush, Kuhn and Tucker; Nocedal and Wright 2006, Numerical Optimization, 12.3).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr

Functions = Callable[[Floats], Floats]
"""(1 + m,) of a point (d,): the value, and m limits, each at most zero where it is kept."""

STEP = 1e-4
"""Step of a difference, of the range of a variable: its error is some 1e-8 of a smooth function."""

ACTIVE = 1e-5
"""A limit this near to zero, and a variable this near to an end of its range, is active."""

_ACCURACY = 1e-10
_STEPS = 40


@dataclass(frozen=True, eq=False)
class Minimum:
    """A point that no other one nearby beats within the limits.

    Attributes
    ----------
    at : Floats
        (d,) the point, each variable from 0 to 1.
    values : Floats
        (1 + m,) value and limits there.
    multipliers : Floats
        (m,) of limits: by how much the value falls where a limit is relaxed by one; zero of those
        that are not active.
    at_ends : Floats
        (d,) of the ends of ranges, negative at the lower ones.
    residual : float
        Part of the gradient that no multiplier balances, over the gradient; zero at a minimum.
    """

    at: Floats
    values: Floats
    multipliers: Floats
    at_ends: Floats
    residual: float

    __repr__ = short_repr

    @property
    def violation(self) -> float:
        """Largest amount by which a limit is not kept; negative or zero where all are."""
        return float(self.values[1:].max(initial=-np.inf))


def slopes(functions: Functions, at: Floats, step: float = STEP) -> Floats:
    """(1 + m, d) derivatives by central differences; at the ends of ranges by points inside alone.

    Parameters
    ----------
    functions : callable
        The functions.
    at : ndarray, (d,)
        The point, each variable from 0 to 1.
    step : float
        Step of the differences.
    """
    columns = []
    for k in range(len(at)):
        unit = np.eye(len(at))[k] * step
        if at[k] < step or at[k] > 1.0 - step:
            way = 1.0 if at[k] < step else -1.0
            first, second, third = (functions(at + way * n * unit) for n in (0, 1, 2))
            columns.append(way * (-3.0 * first + 4.0 * second - third) / (2.0 * step))
        else:
            columns.append((functions(at + unit) - functions(at - unit)) / (2.0 * step))
    return np.column_stack(columns)


def constrained_minimum(functions: Functions, start: Floats, step: float = STEP) -> Minimum:
    """The minimum that is found from a start.

    Parameters
    ----------
    functions : callable
        Value and limits of a point; both count relative to one.
    start : ndarray, (d,)
        Each variable from 0 to 1; without variables the start is the answer.
    step : float
        Step of the differences that the gradients are taken from.

    Returns
    -------
    Minimum
        Where limits conflict near there, its ``violation`` is positive.
    """
    if len(start) == 0:
        values = functions(start)
        return Minimum(start, values, np.zeros(len(values) - 1), np.zeros(0), 0.0)
    at = _solved(functions, start, step, lambda x: slopes(functions, x, step))
    return _judged(functions(at), slopes(functions, at, step), at)


def least_violation(functions: Functions, start: Floats, step: float = STEP) -> Minimum:
    """The point where the worst limit is violated least, and the limits that conflict there.

    Parameters
    ----------
    functions : callable
        Value and limits of a point; the value does not count.
    start : ndarray, (d,)
        Each variable from 0 to 1.
    step : float
        Step of the differences.

    Returns
    -------
    Minimum
        Its multipliers are the shares of limits in the conflict; they add up to one.
    """
    if len(start) == 0:
        values = functions(start)
        shares = np.where(values[1:] >= values[1:].max() - ACTIVE, 1.0, 0.0)
        return Minimum(start, values, shares / shares.sum(), np.zeros(0), 0.0)

    worst = max(float(functions(start)[1:].max()), 0.0)

    def raised(x: Floats) -> Floats:
        """Value the allowed violation, limits less that."""
        found = functions(x[:-1])
        return np.concatenate([x[-1:] * (1.0 + worst), found[1:] - x[-1] * (1.0 + worst)])

    def raised_slopes(x: Floats) -> Floats:
        found = slopes(functions, x[:-1], step)
        found[0] = 0.0
        last = np.full(len(found), -(1.0 + worst))
        last[0] = 1.0 + worst
        return np.column_stack([found, last])

    begin = np.append(start, worst / (1.0 + worst))
    x = _solved(raised, begin, step, raised_slopes)
    judged = _judged(raised(x), raised_slopes(x), x)
    values = functions(x[:-1])
    shares = judged.multipliers / max(judged.multipliers.sum(), 1e-300)
    return Minimum(x[:-1], values, shares, judged.at_ends[:-1], judged.residual)


def starting_points(first: Floats, count: int, seed: int = 0) -> list[Floats]:
    """Points to start from: the one that is given, and others that fill the ranges evenly.

    Parameters
    ----------
    first : ndarray, (d,)
        The first, each variable from 0 to 1.
    count : int
        How many in all.
    seed : int
        Seed of the others.
    """
    from scipy.stats import qmc

    if len(first) == 0 or count < 2:
        return [first]
    rest = qmc.LatinHypercube(d=len(first), rng=seed).random(count - 1)
    return [first, *rest]


def _solved(
    functions: Functions, start: Floats, step: float, gradients: Callable[[Floats], Floats]
) -> Floats:
    """The point at which SLSQP ends."""
    from scipy.optimize import minimize

    def limits(x: Floats) -> Floats:
        return np.asarray(-functions(x)[1:])

    def limit_slopes(x: Floats) -> Floats:
        return np.asarray(-gradients(x)[1:])

    begin = np.clip(start, 0.0, 1.0)
    found = minimize(
        lambda x: float(functions(x)[0]),
        begin,
        jac=lambda x: gradients(x)[0],
        bounds=[(0.0, 1.0)] * len(begin),
        constraints={"type": "ineq", "fun": limits, "jac": limit_slopes},
        method="SLSQP",
        options={"ftol": _ACCURACY, "maxiter": _STEPS},
    )
    return np.asarray(np.clip(found.x, 0.0, 1.0), dtype=np.float64)


def _judged(values: Floats, gradients: Floats, at: Floats) -> Minimum:
    """A point with the multipliers that balance its gradients best."""
    from scipy.optimize import nnls

    d, m = len(at), len(values) - 1
    limits = np.flatnonzero(values[1:] > -ACTIVE)
    low, high = np.flatnonzero(at < ACTIVE), np.flatnonzero(at > 1.0 - ACTIVE)
    ends = np.zeros((d, len(low) + len(high)))
    ends[low, np.arange(len(low))] = -1.0
    ends[high, len(low) + np.arange(len(high))] = 1.0
    active = np.hstack([gradients[1 + limits].T, ends])
    multipliers, at_ends = np.zeros(m), np.zeros(d)
    size = float(np.linalg.norm(gradients[0]))
    left = size
    if active.shape[1]:
        found, left = nnls(active, -gradients[0])
        multipliers[limits] = found[: len(limits)]
        at_ends[low] = -found[len(limits) : len(limits) + len(low)]
        at_ends[high] = found[len(limits) + len(low) :]
    return Minimum(at, values, multipliers, at_ends, left / size if size > 0.0 else 0.0)


def distinct_minima(found: Sequence[Minimum], allowed: float, apart: float = 1e-3) -> list[Minimum]:
    """Minima within the limits, the least first; those that differ in their points.

    Parameters
    ----------
    found : sequence of Minimum
        From all starts.
    allowed : float
        Violation that still counts as kept.
    apart : float
        Largest difference of a variable up to which two are one.
    """
    kept: list[Minimum] = []
    for one in sorted(found, key=lambda one: float(one.values[0])):
        same = any(np.abs(one.at - other.at).max(initial=0.0) <= apart for other in kept)
        if one.violation <= allowed and not same:
            kept.append(one)
    return kept
