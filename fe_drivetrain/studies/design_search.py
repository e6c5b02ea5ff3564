"""The design that is least in mass, cost or another quantity within limits."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, ClassVar

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.comparison.constrained_minimum import Minimum, starting_points
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.report.charts import chart, trace
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies.design_levels import CheckedQuantity, checked_quantities
from fe_drivetrain.studies.design_minima import (
    FAR,
    KEPT,
    MARGIN,
    SETTLED,
    Problem,
    Trial,
    best_of,
    correction,
    flat_minima,
    infeasible,
    log_ratios,
    minima_of,
    with_slopes,
)
from fe_drivetrain.studies.design_quantities import DesignQuantities
from fe_drivetrain.studies.design_request import DesignRequest
from fe_drivetrain.studies.design_statement import (
    FrontPoint,
    shown_size,
    state_gradients,
    state_search,
)
from fe_drivetrain.studies.design_trials import DesignTrials
from fe_drivetrain.studies.result import Result

STARTS = 4
_ROUNDS = 8  # of checks and corrections
_FRONT = np.geomspace(0.6, 1.6, 9)  # of the limit whose front is shown


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SearchResult(Result):
    """The least design within limits, what they cost, and the way of the search.

    Attributes
    ----------
    request : DesignRequest
        What was asked for.
    design : Drivetrain
        The design.
    values : Mapping[str, Any]
        Value of each key that may vary.
    quantities : Mapping[str, CheckedQuantity]
        Each quantity of the design at the level that is enough.
    units : Mapping[str, str]
        Their units.
    prices : Mapping[str, float]
        By limit, as it is written: by how much the least value grows where the limit is tightened
        by one of its unit.
    front : tuple of FrontPoint
        Least value over one limit, others as they are.
    history : tuple of Trial
        Designs on the way.
    made : int
        Designs that were computed at the cheap level, kept ones included.
    """

    STUDY: ClassVar[str] = "search"
    SCHEMA_VERSION: ClassVar[int] = 1

    request: DesignRequest
    design: Drivetrain = field(repr=False)
    values: Mapping[str, Any]
    quantities: Mapping[str, CheckedQuantity]
    units: Mapping[str, str]
    prices: Mapping[str, float]
    front: tuple[FrontPoint, ...]
    history: tuple[Trial, ...]
    made: int

    def chart(self) -> Chart:
        """Least value over one limit; without such a front, the way of the search."""
        name, unit = self.request.minimise, self.units[self.request.minimise]
        size, shown = shown_size(unit)
        y = f"{name} [{shown}]" if shown else name
        if len(self.front) > 1:
            limit = self.front[0].limit
            x = f"{limit.name} [{limit.unit or self.units[limit.name]}]"
            line = trace(
                "least within all other limits",
                [one.limit.value for one in self.front],
                [one.value / size for one in self.front],
                points=True,
            )
            return chart(f"Least {name} over the limit of {limit.name}", [line], x, y)
        return self.way()

    def way(self) -> Chart:
        """Designs on the way of the search: the least so far that keeps all limits."""
        name, unit = self.request.minimise, self.units[self.request.minimise]
        size, shown = shown_size(unit)
        least, x, y = np.inf, [], []
        for one in self.history:
            if one.violation <= KEPT and one.value < least:
                least = one.value
                x.append(one.made)
                y.append(least / size)
        line = trace("least so far within all limits", x, y, points=True)
        axis = f"{name} [{shown}]" if shown else name
        return chart("The way of the search", [line], "designs computed", axis)


@dataclass(frozen=True, eq=False)
class _Candidate:
    """The minimum of one combination of values of lists, and what a better level said of it.

    ``first`` and ``others`` are minima of the cheap level alone, ``corrected`` is the last of the
    corrected one, whose multipliers are the prices.
    """

    problem: Problem
    minimum: Minimum
    first: Minimum
    agreeing: int
    others: list[Minimum]
    path: list[Trial]
    checked: Mapping[str, CheckedQuantity] = field(default_factory=dict)
    corrected: Minimum | None = None
    unsettled: str = ""

    @property
    def value(self) -> float:
        return float(self.minimum.values[0]) * self.problem.size


def search(
    drivetrain: Drivetrain,
    request: DesignRequest,
    tolerance: float = 0.05,
    starts: int = STARTS,
    front: str | None = None,
    *,
    report: Progress = silent,
) -> SearchResult:
    """Find the design that is least in mass, cost or another quantity within limits.

    Values with a range are found by gradients of the cheapest level from several starts; each
    combination of values of lists is tried. Every quantity of the design is then checked at the
    level that is enough, and where that says otherwise the search goes on with the cheap level
    corrected, until the limits are kept at the better one. A search that was stopped goes on where
    it was.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain as it is.
    request : DesignRequest
        What may vary, what shall be least, and within which limits; see
        `fe_drivetrain.studies.design_request`.
    tolerance : float
        Band over value up to which a level is enough.
    starts : int
        Number of starts: the drivetrain itself, and others that fill the ranges.
    front : str or None
        Name of the limit whose values are swept; None for that which costs most.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        A name, a range or a limit is wrong, no design can be built, or limits conflict.
    """
    if starts < 1:
        raise InputError(f"starts is {starts} but must be 1 at least: give a number of starts")
    if not 0.0 < tolerance < 1.0:
        raise InputError(f"tolerance is {100 * tolerance:g} % but must be between 0 and 100 %")
    names = [limit.name for limit in request.limits]
    if front is not None and front not in names:
        raise InputError(f"front {front!r} is of no limit: use one of {', '.join(names)}")
    found, steps = Findings(), Steps(report)
    found.about(drivetrain)
    request.check(drivetrain)
    asked = DesignQuantities(drivetrain, request)
    request = asked.request
    with steps.step("the drivetrain as it is"):
        now = asked.values(drivetrain)
    _require_single_values(request, now)
    size = float(now[request.minimise][0])
    if not size > 0.0:
        raise InputError(f"{request.minimise} is {size:g} and cannot be made less: ask for another")
    with steps.step("search at the cheap level"):
        candidates, conflicts = _candidates(asked, now, size, starts, steps.report)
    with steps.step("check at the level that is enough"):
        best = _checked(candidates, tolerance, steps.report)
    with steps.step("front"):
        points = _front(best, front, steps.report)
    problem = best.problem
    values = problem.trials.values_at(best.minimum.at)
    prices = _prices(best)
    cautions = [best.unsettled] if best.unsettled else []
    state_search(found, best.problem, best.minimum, best.checked, prices, now, cautions)
    assert best.corrected is not None
    state_gradients(found, problem, best.corrected)
    made = sum(one.problem.trials.made + one.problem.trials.kept for one in candidates)
    _state_starts(found, best, starts, made, conflicts)
    found.data("front", [one.record(problem.trials.asked.units) for one in points])
    design = problem.trials.design(best.minimum.at)
    for one in candidates:
        one.problem.trials.keep()
    return SearchResult(
        request=request,
        design=design,
        values=values,
        quantities=best.checked,
        units=asked.units,
        prices=prices,
        front=tuple(points),
        history=tuple(best.path),
        made=made,
        **found.frozen(steps.times, **_stated(request, tolerance, starts, front)),
    )


def _require_single_values(request: DesignRequest, now: Mapping[str, Floats]) -> None:
    """Refuse to minimise what has several values, and limits that mean nothing for such."""
    if len(now[request.minimise]) > 1:
        raise InputError(
            f"{request.minimise} has {len(now[request.minimise])} values, of parts or points: give "
            f"it a limit, as in '{request.minimise}<=VALUE', and minimise another quantity, or "
            "name one part of it"
        )
    for limit in request.limits:
        if limit.at_least and limit.name.partition(".")[0] == "stress":
            raise InputError(
                f"the limit {limit} asks for stress at every point of a section, some of which "
                "carry nothing: give an upper limit, as in 'stress<=100 MPa'"
            )


def _candidates(
    asked: DesignQuantities,
    now: Mapping[str, Any],
    size: float,
    starts: int,
    report: Progress,
) -> tuple[list[_Candidate], list[InputError]]:
    """The least design of every combination of values of lists, the least of all first."""
    request = asked.request
    counts = {name: len(values) for name, values in now.items()}
    first = np.array(request.start(asked.drivetrain))
    found: list[_Candidate] = []
    conflicts: list[InputError] = []
    choices = request.choices()
    for number, choice in enumerate(choices, 1):
        trials = DesignTrials(asked, counts, choice)
        problem = Problem(trials, request.minimise, request.limits, size)
        of = f"combination {number} of {len(choices)}, " if len(choices) > 1 else ""
        path: list[Trial] = []
        try:
            minima = minima_of(
                problem,
                starting_points(first, starts),
                _named(report, f"level 1: {of}"),
                path,
            )
            kept = best_of(problem, minima)
        except InputError as error:
            conflicts.append(error)
            continue
        finally:
            trials.keep()
        near = [np.abs(one.at - kept[0].at).max(initial=0.0) < FAR for one in minima]
        found.append(_Candidate(problem, kept[0], kept[0], sum(near), kept[1:], path))
    if not found:
        raise min(conflicts, key=lambda one: getattr(one, "violation", np.inf))
    return sorted(found, key=lambda one: one.value), conflicts


def _checked(
    candidates: Sequence[_Candidate], tolerance: float, report: Callable[[str], object]
) -> _Candidate:
    """The least candidate at the level that is enough; what is more at the cheap one waits."""
    best: _Candidate | None = None
    faults = []
    for one in candidates:
        if best is not None and one.value >= best.value:
            break
        try:
            corrected = _corrected(one, tolerance, report)
        except InputError as error:
            faults.append(error)
            continue
        if best is None or corrected.value < best.value:
            best = corrected
    if best is None:
        raise faults[0]
    return best


def _corrected(one: _Candidate, tolerance: float, report: Callable[[str], object]) -> _Candidate:
    """A candidate whose limits are kept at the level that is enough."""
    problem, minimum, path = one.problem, one.minimum, list(one.path)
    trials = problem.trials
    best: _Candidate | None = None
    gain, why = np.nan, ""
    for number in range(1, _ROUNDS + 1):
        try:
            checked = checked_quantities(
                trials.asked,
                trials.design(minimum.at),
                tolerance,
                _named(report, f"round {number}: "),
            )
        except InputError as error:
            if best is None:
                raise InputError(
                    f"the least design of the cheap level, {trials.in_words(minimum.at)}, cannot "
                    f"be built at the level that is enough: make ranges narrower ({error})"
                ) from error
            why = f"the better level cannot build the next design: {error}"
            break
        cheap = trials.quantities(minimum.at)
        assert cheap is not None
        better = {name: of.values for name, of in checked.items()}
        kept = all(
            problem.excess(limit, checked[limit.name].values).max() <= 0.0
            for limit in problem.limits
        )
        before, gain = minimum.at, np.inf
        now = correction(problem.corrected_by, before, better, cheap)
        # slopes of the ratio again far from where they were found, and where the search would end
        for again in (True,) if now.is_far else (False, True):
            now = with_slopes(now, partial(_ratios, trials, report)) if again else now
            problem = replace(problem, corrected_by=now)
            values = problem.functions(before)
            (minimum,) = minima_of(problem, [before], _named(report, "corrected: "), path)
            gain = float(values[0] - minimum.values[0]) / float(values[0])
            if not (kept and gain < SETTLED):
                break
        if minimum.violation > KEPT and best is None and not kept:
            raise infeasible(problem, minimum.at)
        if kept and (best is None or values[0] < best.minimum.values[0]):
            # what was checked is what is shown
            best = replace(
                one,
                problem=problem,
                minimum=replace(minimum, at=before, values=values),
                path=path,
                checked=checked,
                corrected=minimum,
            )
        if kept and gain < SETTLED:
            break
    else:
        why = f"the last of {_ROUNDS} rounds of checks still moved it by {100 * abs(gain):.2g} %"
    if best is not None:
        said = f"The search has not settled: {why}; a lesser {problem.minimise} may be left."
        return replace(best, unsettled=said if why else "")
    raise InputError(
        f"levels 1 and {', '.join({of.level for of in checked.values()})} do not agree on a design "
        f"after {_ROUNDS} rounds: make ranges narrower, or the tolerance larger"
    )


def _ratios(
    trials: DesignTrials, report: Callable[[str], object], at: Floats
) -> Mapping[str, Floats] | None:
    """Logarithms of the ratio of levels 2 and 1 at a place; None of what cannot be built."""
    report("how levels differ from design to design, level 2")
    cheap = trials.quantities(at)
    if cheap is None:
        return None
    try:
        return log_ratios(trials.asked.values(trials.design(at), "better"), cheap)
    except InputError:
        return None


def _named(report: Callable[[str], object], words: str) -> Progress:
    """Reports what is being done with words before it."""

    def said(step: str, lane: int = 0) -> None:
        report(f"{words}{step}")

    return said


def _prices(best: _Candidate) -> dict[str, float]:
    """By how much the least value grows where a limit is tightened by one of its unit."""
    relative = best.problem.prices(best.minimum)
    found = {}
    for limit, price in zip(best.problem.limits, relative, strict=True):
        tighter = price if limit.at_least else -price
        found[str(limit)] = tighter * best.value / limit.value + 0.0  # no negative zero
    return found


def _front(best: _Candidate, name: str | None, report: Callable[[str], object]) -> list[FrontPoint]:
    """Least values over a limit, from the design outwards; where limits conflict it ends."""
    problem, limits = best.problem, best.problem.limits
    if not len(best.minimum.at):
        return []
    prices = np.abs(problem.prices(best.minimum))
    number = int(prices.argmax()) if name is None else [one.name for one in limits].index(name)
    if name is None and not prices.any():
        return []
    points = []
    for factors in (_FRONT[_FRONT <= 1.0][::-1], _FRONT[_FRONT > 1.0]):
        at = best.minimum.at
        for factor in factors:
            other = problem.with_limit(number, float(factor))
            limit = other.limits[number]
            (minimum,) = minima_of(other, [at], _named(report, f"front, {limit}: "), [])
            if minimum.violation > KEPT:
                break
            at = minimum.at
            values = problem.trials.values_at(at)
            points.append(FrontPoint(limit, float(minimum.values[0]) * problem.size, values))
    return sorted(points, key=lambda one: one.limit.value)


def _state_starts(
    found: Findings,
    best: _Candidate,
    starts: int,
    made: int,
    conflicts: Sequence[InputError],
) -> None:
    """How the search went: designs, starts that agree, other minima, combinations left out."""
    if len(best.minimum.at):
        found.say(
            f"{best.agreeing} of {starts} starts end at this design; {made} designs were computed "
            "at the cheap level."
        )
    _state_others(found, best)
    if rejected := best.problem.trials.rejected:
        found.note(
            f"{rejected} designs on the way could not be built and were rejected: "
            f"{best.problem.trials.fault}"
        )
    for conflict in conflicts:
        found.note(f"A combination of values is left out: {conflict}")


def _state_others(found: Findings, best: _Candidate) -> None:
    """Where other starts end: elsewhere at the same value, which is flat then, or at another."""
    keys = list(best.problem.trials.asked.request.ranges)
    least, name = float(best.first.values[0]), best.problem.minimise
    flat = flat_minima(best.first, best.others)
    if flat:
        apart = np.max([np.abs(one.at - best.first.at) for one in flat], axis=0)
        moved = ", ".join(
            f"{key} by {100 * far:.2g} %" for key, far in zip(keys, apart, strict=True) if far > FAR
        )
        found.note(
            f"The least {name} is flat: other starts end at designs with less than "
            f"{100 * SETTLED:g} % more that differ in {moved} of the range; any of them serves.",
            first=True,
        )
    for other in best.others:
        if other not in flat:
            more = 100.0 * (float(other.values[0]) / least - 1.0)
            found.note(
                f"Another start ends at another design, {more:+.3g} % in {name}: more starts may "
                "find more."
            )


def _stated(
    request: DesignRequest, tolerance: float, starts: int, front: str | None
) -> dict[str, Any]:
    """What was asked for, as plain data."""
    return {
        "vary": {key: list(values) for key, values in request.vary.items()},
        "minimise": request.minimise,
        "limits": [str(limit) for limit in request.limits],
        "prices": dict(request.prices),
        "load": dict(request.load),
        "tolerance": tolerance,
        "starts": starts,
        "front": front,
        "margin": MARGIN,
    }
