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

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.short_repr import short_repr

Functions = Callable[[Floats], Floats]
"""(1 + m,) of a point (d,): the value, and m limits, each at most zero where it is kept; all
infinite where there is no such point."""

STEP = 1e-4
"""Step of a difference, of the range of a variable: its error is some 1e-8 of a smooth function."""

ACTIVE = 1e-5
"""A limit this near to zero, and a variable this near to an end of its range, is active."""

_ACCURACY = 1e-10
_STEPS = 40
_BALANCE = 1e-4  # of the gradient: what multipliers may leave and still count as balancing it
_NOWHERE = 10.0  # value and limits of a point that does not exist: worse than any nearby
_HALVINGS = 20  # towards the first start, until a start exists


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
    """(1 + m, d) derivatives by central differences.

    At the ends of ranges, and beside points that do not exist, by points of the other side alone.

    Parameters
    ----------
    functions : callable
        The functions.
    at : ndarray, (d,)
        The point, each variable from 0 to 1.
    step : float
        Step of the differences.

    Returns
    -------
    ndarray, (1 + m, d)
        Zero along a variable that has no such points on either side.
    """

    def one_sided(unit: Floats, way: float) -> Floats:
        first, second, third = (functions(at + way * n * unit) for n in (0, 1, 2))
        if not np.isfinite([first, second, third]).all():
            return np.zeros_like(first)
        return np.asarray(way * (-3.0 * first + 4.0 * second - third) / (2.0 * step))

    columns = []
    for k in range(len(at)):
        unit = np.eye(len(at))[k] * step
        if at[k] < step or at[k] > 1.0 - step:
            columns.append(one_sided(unit, 1.0 if at[k] < step else -1.0))
            continue
        before, behind = functions(at - unit), functions(at + unit)
        if np.isfinite(before).all() and np.isfinite(behind).all():
            columns.append((behind - before) / (2.0 * step))
        else:
            columns.append(one_sided(unit, 1.0 if np.isfinite(behind).all() else -1.0))
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
    at = _solved(functions, start, lambda x: slopes(functions, x, step))
    return _judged(functions(at), slopes(functions, at, step), at)


def nearest_start(functions: Functions, start: Floats, known: Floats) -> Floats:
    """A start, drawn towards a point that exists until it exists itself.

    Parameters
    ----------
    functions : callable
        Value and limits of a point.
    start, known : ndarray, (d,)
        The start, and a point that exists.
    """
    for _ in range(_HALVINGS):
        if np.isfinite(functions(start)).all():
            return start
        start = 0.5 * (start + known)
    return known


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
    x = _solved(raised, begin, raised_slopes)
    judged = _judged(raised(x), raised_slopes(x), x)
    values = functions(x[:-1])
    shares = judged.multipliers / max(judged.multipliers.sum(), 1e-300)
    return Minimum(x[:-1], values, shares, judged.at_ends[:-1], judged.residual)


def multiplier_ranges(
    gradients: Floats, minimum: Minimum, groups: Sequence[int], count: int
) -> Floats:
    """Least and largest sum of the multipliers of each group of limits that balance a minimum.

    Where several limits meet and pull the same way, many multipliers balance the gradient as well:
    what one limit costs alone is then open (degenerate minima: Nocedal and Wright 2006, 12.2).

    Parameters
    ----------
    gradients : ndarray, (1 + m, d)
        Derivatives of the value and of all limits at the minimum.
    minimum : Minimum
        The minimum.
    groups : sequence of int
        Group of each of the m limits, from 0.
    count : int
        Number of groups.

    Returns
    -------
    ndarray, (count, 2)
        Equal up to a share of 1e-4 of the gradient where multipliers are unique.
    """
    from scipy.optimize import linprog

    active, numbers = _active(minimum.values, gradients, minimum.at)
    found = np.zeros((count, 2))
    size = float(np.linalg.norm(gradients[0]))
    if not active.shape[1] or size == 0.0:
        return found
    at_ends = np.abs(minimum.at_ends)
    own = np.concatenate([minimum.multipliers[numbers], at_ends[_ends(minimum.at)]])
    balanced = active @ own
    A = np.vstack([active, -active]) / size
    b = np.concatenate([balanced, -balanced]) / size + _BALANCE
    for group in {groups[number] for number in numbers}:
        of = np.zeros(len(own))
        of[: len(numbers)] = [float(groups[number] == group) for number in numbers]
        for k, way in enumerate((1.0, -1.0)):
            solved = linprog(way * of, A_ub=A, b_ub=b, bounds=(0.0, None))
            found[group, k] = of @ own if solved.x is None else way * solved.fun
    return found


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


def _solved(functions: Functions, start: Floats, gradients: Callable[[Floats], Floats]) -> Floats:
    """The point at which SLSQP ends; the last that exists, where that one does not."""
    from scipy.optimize import minimize

    begin = np.clip(start, 0.0, 1.0)
    last = [begin]

    def known(x: Floats) -> Floats:
        found = functions(x)
        if np.isfinite(found).all():
            return found
        return np.full(len(found), _NOWHERE)

    def value_slopes(x: Floats) -> Floats:
        if np.isfinite(functions(x)).all():
            last[0] = np.array(x)
        return np.asarray(gradients(x)[0])

    found = minimize(
        lambda x: float(known(x)[0]),
        begin,
        jac=value_slopes,
        bounds=[(0.0, 1.0)] * len(begin),
        constraints={
            "type": "ineq",
            "fun": lambda x: -known(x)[1:],
            "jac": lambda x: -gradients(x)[1:],
        },
        method="SLSQP",
        options={"ftol": _ACCURACY, "maxiter": _STEPS},
    )
    at = np.asarray(np.clip(found.x, 0.0, 1.0), dtype=np.float64)
    return at if np.isfinite(functions(at)).all() else last[0]


def _judged(values: Floats, gradients: Floats, at: Floats) -> Minimum:
    """A point with the multipliers that balance its gradients best."""
    from scipy.optimize import nnls

    d, m = len(at), len(values) - 1
    if not np.isfinite(values).all():
        return Minimum(at, values, np.zeros(m), np.zeros(d), np.inf)
    active, limits = _active(values, gradients, at)
    multipliers, at_ends = np.zeros(m), np.zeros(d)
    size = float(np.linalg.norm(gradients[0]))
    left = size
    if active.shape[1]:
        found, left = nnls(active, -gradients[0])
        multipliers[limits] = found[: len(limits)]
        ends = _ends(at)
        at_ends[ends] = found[len(limits) :] * np.where(at[ends] < 0.5, -1.0, 1.0)
    return Minimum(at, values, multipliers, at_ends, left / size if size > 0.0 else 0.0)


def _ends(at: Floats) -> Ints:
    """Variables that are at an end of their range."""
    return np.flatnonzero((at < ACTIVE) | (at > 1.0 - ACTIVE))


def _active(values: Floats, gradients: Floats, at: Floats) -> tuple[Floats, Ints]:
    """Gradients (d, k) of active limits, then of ends of ranges; and numbers of these limits."""
    limits, ends = np.flatnonzero(values[1:] > -ACTIVE), _ends(at)
    outwards = np.zeros((len(at), len(ends)))
    outwards[ends, np.arange(len(ends))] = np.where(at[ends] < 0.5, -1.0, 1.0)
    return np.hstack([gradients[1 + limits].T, outwards]), limits


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
