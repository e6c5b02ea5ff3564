"""The least design at the cheap level, corrected by what a better level says of it.

Cheap quantities are multiplied by the ratio that the better level gave at the last design, and the
search goes on from there, until both agree (multiplicative correction: Alexandrov et al. 2001, J.
Aircraft 38(6)). How the ratio changes from design to design is found by a design of the better
level along each range, where the search begins and where it would end, and between them learned
from the checks themselves (secants: Broyden 1965, Math. Comput. 19). The cheap level gives all
gradients, the better one a few values.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.comparison.constrained_minimum import (
    Minimum,
    constrained_minimum,
    distinct_minima,
    least_violation,
    multiplier_ranges,
    nearest_start,
    slopes,
)
from fe_drivetrain.shafts.uncertainty.kept_rows import EVERY
from fe_drivetrain.studies.design_request import Limit
from fe_drivetrain.studies.design_trials import DesignTrials

MARGIN = 1e-4
"""Share by which limits are kept more than exactly: what a search leaves then breaks none."""

KEPT = 0.5 * MARGIN
"""Share of a limit that a search may leave of its margin."""

SETTLED = 2e-4
"""Share of the least value that ends a search: what would gain less is as good."""

SECANT = 0.05
"""Share of a range over which the slope of a ratio is taken: more than meshes make it jump by."""

FAR = 1e-3
"""Share of a range: places that are less apart are one."""

OPEN = 0.01
"""Share of the largest price: one that may change by more is open."""

_LEAST = 1e-12  # of a limit: what is less counts as this
_STILL = 0.5 * SECANT  # a move that is less tells of jumps of meshes alone, not how ratios change


@dataclass(frozen=True, eq=False)
class Correction:
    """Ratio of the better level to the cheap one, near the design that was checked last.

    Attributes
    ----------
    at : Floats
        (d,) that design.
    logs : Mapping[str, Floats]
        (k,) logarithm of the ratio there, by quantity.
    slopes : Mapping[str, Floats]
        (k, d) of the logarithm over the ranges, as far as designs so far tell.
    taken : Floats or None
        (d,) where the slopes were found by designs along each range; None where they were not.
    """

    at: Floats
    logs: Mapping[str, Floats]
    slopes: Mapping[str, Floats]
    taken: Floats | None = None

    __repr__ = short_repr

    @property
    def is_far(self) -> bool:
        """Whether the slopes are of elsewhere: one design after another tells of one way only."""
        return self.taken is None or bool(np.abs(self.at - self.taken).max(initial=0.0) > SECANT)

    def factors(self, at: Floats) -> dict[str, Floats]:
        """Ratio of each quantity at a place."""
        moved = at - self.at
        return {name: np.exp(log + self.slopes[name] @ moved) for name, log in self.logs.items()}


def correction(
    before: Correction | None,
    at: Floats,
    better: Mapping[str, Floats],
    cheap: Mapping[str, Floats],
) -> Correction:
    """The correction after a check.

    Parameters
    ----------
    before : Correction or None
        That of the check before.
    at : ndarray, (d,)
        Design that was checked.
    better, cheap : mapping of str to ndarray
        Its quantities at both levels; where one is zero, there is no ratio.
    """
    logs, slopes = log_ratios(better, cheap), {}
    for name, own in logs.items():
        slopes[name] = np.zeros((len(own), len(at)))
        if before is not None:
            moved = at - before.at
            slopes[name] = before.slopes[name]
            if (size := float(moved @ moved)) > _STILL**2:
                expected = before.logs[name] + before.slopes[name] @ moved
                slopes[name] = slopes[name] + np.outer(own - expected, moved) / size
    return Correction(at, logs, slopes, None if before is None else before.taken)


def log_ratios(better: Mapping[str, Floats], cheap: Mapping[str, Floats]) -> dict[str, Floats]:
    """Logarithm of the ratio of both levels, by quantity; 0 where there is no ratio.

    Parameters
    ----------
    better, cheap : mapping of str to ndarray
        Quantities of a design at both levels.
    """
    found = {}
    for name, values in better.items():
        known = (values > 0.0) & (cheap[name] > 0.0)
        ratio = np.divide(values, cheap[name], out=np.ones(len(values)), where=known)
        found[name] = np.log(ratio)
    return found


def with_slopes(
    first: Correction, ratios: Callable[[Floats], Mapping[str, Floats] | None]
) -> Correction:
    """A correction with slopes of the ratio by one design along each range.

    Parameters
    ----------
    first : Correction
        The correction after a check.
    ratios : callable
        Logarithms of the ratio at a place; None of a design that cannot be built.
    """
    at = first.at
    if all(np.abs(log).max(initial=0.0) < MARGIN for log in first.logs.values()):
        return first  # both levels say the same
    middle = ratios(at)
    assert middle is not None
    slopes = {name: np.array(of) for name, of in first.slopes.items()}
    for k in range(len(at)):
        way = SECANT if at[k] < 0.5 else -SECANT
        for step in (way, -way):
            place = at + step * np.eye(len(at))[k]
            there = ratios(place) if 0.0 <= place[k] <= 1.0 else None
            if there is not None:
                for name, of in slopes.items():
                    of[:, k] = (there[name] - middle[name]) / step
                break
    return replace(first, slopes=slopes, taken=at)


@dataclass(frozen=True, eq=False)
class Trial:
    """A design on the way of a search.

    Attributes
    ----------
    start, made : int
        Number of its start, and of designs that were computed until then.
    value, violation : float
        What shall be least, and by how much the worst limit is broken, relative.
    """

    start: int
    made: int
    value: float
    violation: float


@dataclass(frozen=True, eq=False)
class Problem:
    """A search over the ranges, with one combination of values of lists.

    Attributes
    ----------
    trials : DesignTrials
        Designs.
    minimise : str
        Name of what shall be least.
    limits : tuple of Limit
        Limits.
    size : float
        Size of what shall be least, which values are relative to.
    corrected_by : Correction or None
        Ratio of a better level to that of the designs.
    """

    trials: DesignTrials
    minimise: str
    limits: tuple[Limit, ...]
    size: float
    corrected_by: Correction | None = None

    __repr__ = short_repr

    def corrected(self, at: Floats) -> dict[str, Floats] | None:
        """Quantities at a place, corrected; None of a design that cannot be built."""
        found = self.trials.quantities(at)
        if found is None:
            return None
        if self.corrected_by is None:
            return found
        factors = self.corrected_by.factors(at)
        return {name: values * factors.get(name, 1.0) for name, values in found.items()}

    def functions(self, at: Floats) -> Floats:
        """Value and limits, all relative; infinite of a design that cannot be built."""
        found = self.corrected(at)
        rows = self.rows
        if found is None:
            return np.full(1 + len(rows), np.inf)
        parts = [found[self.minimise][:1] / self.size]
        for limit in self.limits:
            parts.append(self.excess(limit, found[limit.name]) + MARGIN)
        return np.concatenate(parts)

    def excess(self, limit: Limit, values: Floats) -> Floats:
        """By how much values break a limit, relative; negative where they keep it."""
        size = limit.value * limit.size(self.trials.asked.units[limit.name])
        # of stiffness and life, which change by orders of magnitude, the logarithm is the flattest
        found = np.log(np.maximum(values / size, _LEAST))
        return np.asarray(-found if limit.at_least else found)

    @property
    def rows(self) -> list[int]:
        """Number of the limit that each row of `functions` after the first is of."""
        counts = self.trials.counts
        return [n for n, limit in enumerate(self.limits) for _ in range(counts[limit.name])]

    def with_limit(self, number: int, factor: float) -> Problem:
        """The problem with one limit times a factor."""
        limits = list(self.limits)
        limits[number] = replace(limits[number], value=limits[number].value * factor)
        return replace(self, limits=tuple(limits))

    def prices(self, minimum: Minimum) -> list[float]:
        """Relative change of the least value for a relative change of each limit, both upwards."""
        found = [0.0] * len(self.limits)
        for row, number in enumerate(self.rows):
            sign = 1.0 if self.limits[number].at_least else -1.0
            found[number] += sign * float(minimum.multipliers[row])
        value = float(minimum.values[0])
        return [price / value for price in found]

    def price_ranges(self, minimum: Minimum) -> Floats:
        """(limits, 2) least and largest size of each of `prices` that balances the minimum."""
        gradients = slopes(self.functions, minimum.at)
        count = len(self.limits)
        return multiplier_ranges(gradients, minimum, self.rows, count) / float(minimum.values[0])


def minima_of(
    problem: Problem, starts: list[Floats], report: Callable[[str], object], path: list[Trial]
) -> list[Minimum]:
    """Minima from each of several starts; what is tried on the way goes into ``path``.

    A design that cannot be built is a trial that is rejected; a start of that kind is drawn towards
    the first one.

    Parameters
    ----------
    problem : Problem
        The search.
    starts : list of ndarray
        Places to start from.
    report : callable
        Called with what is being done.
    path : list of Trial
        Takes the designs on the way.
    """
    found, shown = [], [time.monotonic()]
    for number, start in enumerate(starts, 1):

        def functions(at: Floats, number: int = number) -> Floats:
            values = problem.functions(at)
            count = problem.trials.made + problem.trials.kept
            if np.isfinite(values[0]):
                path.append(
                    Trial(number, count, float(values[0]) * problem.size, float(values[1:].max()))
                )
            now = time.monotonic()
            if now - shown[0] > EVERY:
                shown[0] = now
                report(f"start {number} of {len(starts)}, {count} designs")
            return values

        begin = nearest_start(problem.functions, start, starts[0])
        found.append(constrained_minimum(functions, begin))
    return found


def best_of(problem: Problem, found: list[Minimum]) -> list[Minimum]:
    """Distinct minima that keep all limits, the least first.

    Parameters
    ----------
    problem : Problem
        The search.
    found : list of Minimum
        From all starts.

    Raises
    ------
    InputError
        No design keeps all limits; the sentence names those that conflict.
    """
    kept = distinct_minima(found, KEPT)
    if not kept:
        raise infeasible(problem, min(found, key=lambda one: one.violation).at)
    return kept


def flat_minima(first: Minimum, others: Sequence[Minimum]) -> list[Minimum]:
    """Minima elsewhere that are as good as the first: what shall be least is flat between.

    Parameters
    ----------
    first : Minimum
        The least.
    others : sequence of Minimum
        The others.
    """
    least = float(first.values[0])
    return [one for one in others if float(one.values[0]) / least - 1.0 < SETTLED]


def open_prices(ranges: Floats) -> Bools:
    """Whether each price is open, (limits,), see `Problem.price_ranges`.

    Parameters
    ----------
    ranges : ndarray, (limits, 2)
        Least and largest of each.
    """
    return np.asarray(ranges[:, 1] - ranges[:, 0] > OPEN * np.abs(ranges).max(initial=0.0))


class ConflictError(InputError):
    """No design keeps all limits.

    Parameters
    ----------
    sentence : str
        Which limits conflict, and what comes nearest.
    violation : float
        Share by which the nearest breaks the worst limit.
    """

    def __init__(self, sentence: str, violation: float = np.inf) -> None:
        super().__init__(sentence)
        self.violation = violation


def infeasible(problem: Problem, near: Floats) -> InputError:
    """Which limits conflict, and what comes nearest to keeping them.

    Parameters
    ----------
    problem : Problem
        The search.
    near : ndarray, (d,)
        Place to begin at.
    """
    if problem.corrected(near) is None and problem.trials.fault is not None:
        return InputError(f"no such design can be built: {problem.trials.fault}")
    worst = least_violation(problem.functions, near)
    shares = np.zeros(len(problem.limits))
    for row, number in enumerate(problem.rows):
        shares[number] += worst.multipliers[row]
    violation = worst.violation - MARGIN
    sign = -1.0 if problem.limits[int(shares.argmax())].at_least else 1.0
    violation = sign * float(np.expm1(sign * violation))  # of limits the logarithm is taken
    conflict = [str(problem.limits[n]) for n in np.flatnonzero(shares > 1e-3)]
    nearest = problem.trials.in_words(worst.at)
    ends = [
        f"{key} is at the {'lower' if end < 0 else 'upper'} end of its range"
        for key, end in zip(problem.trials.asked.request.ranges, worst.at_ends, strict=True)
        if abs(end) > 1e-9
    ]
    request = problem.trials.asked.request
    fixes = ["widen the ranges"] if request.ranges else []
    fixes += ["add values to the lists"] if request.lists else []
    of = f"within the ranges{' and lists' * bool(request.lists)}" if request.ranges else "listed"
    what = (
        f"{' and '.join(conflict)} conflict: no design {of} keeps them together"
        if len(conflict) > 1
        else f"{conflict[0]} is kept by no design {of}"
        if conflict
        else f"no design {of} keeps all limits"
    )
    several = len(conflict) > 1
    there = f" ({'; '.join(ends)})" if ends else ""
    return ConflictError(
        f"{what}; the nearest, {nearest}{there}, breaks {'each' if several else 'it'} by "
        f"{100.0 * violation:.3g} %: relax {'one of them' if several else 'it'}, or "
        f"{' or '.join(fixes)}",
        abs(violation),
    )
