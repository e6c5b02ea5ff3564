"""Error against time of each method on a motion, and what each program takes at an equal error."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fe_drivetrain.cases.performance.motion_problems import RECORD, Problem, error_of
from fe_drivetrain.cases.performance.motion_programs import OURS, Method
from fe_drivetrain.common import Floats, Times, held_to_one_thread, timed_runs
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.report.suite import Record

ERRORS = (1e-3, 1e-5)
"""Errors of the mesh's elongation over the largest, at which programs are compared."""

#: Steps between records that are tried in turn, and the longest run that is begun [s].
COUNTS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 128, 256, 512, 1024, 2048, 4096)
LONGEST = 1.5
QUICK_COUNTS = (8, 32)


@dataclass(frozen=True)
class Point:
    """Runs of a method with one length of step.

    Attributes
    ----------
    method : Method
        The method.
    steps : int
        Steps between records.
    error : float
        Largest error of a mesh's elongation at the records, over the largest elongation.
    times : Times
        Times of all runs, for the whole duration.
    """

    method: Method
    steps: int
    error: float
    times: Times

    __repr__ = short_repr


def sweep(
    problem: Problem, method: Method, exact: Floats, repeats: int, quick: bool
) -> list[Point]:
    """Ever shorter steps, until the error is below the smallest that is compared.

    Runs whose motion grows without bounds are left out; steps without an error are taken once, as
    long as records are apart.
    """
    found: list[Point] = []
    for steps in (1,) if method.exact else QUICK_COUNTS if quick else COUNTS:
        with held_to_one_thread():
            run = method.solve(steps)
            with np.errstate(all="ignore"):
                q, first = timed_runs(run, 1)  # compiles what is not compiled yet
                error = error_of(problem, q, exact)
                if not error < 1.0:
                    continue
                times = timed_runs(run, repeats)[1]
        found.append(Point(method, steps, error, times))
        if error < min(ERRORS) or 2.0 * min(first.median, times.median) > LONGEST:
            break
    return found


def seconds_at(points: Sequence[Point], error: float) -> tuple[Times, float] | None:
    """Least, median and most time, and steps between records, at an error.

    Between two runs in logarithms; those of the longest step that is stable, where its error is
    below; None where no run is.
    """
    if not points or min(p.error for p in points) > error:
        return None
    if points[0].error <= error:
        return spread(points[0].times), float(points[0].steps)
    for coarse, fine in pairwise(points):
        if coarse.error > error >= fine.error:
            share = np.log(coarse.error / error) / np.log(coarse.error / fine.error)

            def between(one: float, other: float, share: float = share) -> float:
                return float(one * (other / one) ** share)

            ends = zip(spread(coarse.times).seconds, spread(fine.times).seconds, strict=True)
            return Times(tuple(between(*of) for of in ends)), between(coarse.steps, fine.steps)
    return None


def spread(times: Times) -> Times:
    """Least, median and most alone."""
    return Times((times.least, times.median, times.most))


def at_equal_error(problem: Problem, sweeps: Sequence[Sequence[Point]]) -> list[Record]:
    """What the best method of each program takes for a second of motion, error by error."""
    found: list[Record] = []
    for error in ERRORS:
        best: dict[str, tuple[Times, float, Method]] = {}
        for points in sweeps:
            reached = seconds_at(points, error)
            if reached is None:
                continue
            method = points[0].method
            if method.program not in best or (reached[0].median < best[method.program][0].median):
                best[method.program] = (*reached, method)
        own = best.get(OURS)
        for program, (times, steps, method) in best.items():
            found.append(
                {
                    "problem": problem.title,
                    "error": error,
                    "program": program,
                    "its fastest method": method.name,
                    "step [µs]": 1e6 * RECORD / steps,
                    "least [s]": times.least / problem.duration,
                    "time for a second of motion [s]": times.median / problem.duration,
                    "most [s]": times.most / problem.duration,
                    "steps a second": steps * problem.records / times.median,
                    "time over ours": times.median / own[0].median if own else None,
                }
            )
    return found


def step_by_step(problem: Problem, sweeps: Sequence[Sequence[Point]]) -> list[Record]:
    """Time of one step of the second-order method that all have, at the most steps of each."""
    found: list[Record] = []
    for points in sweeps:
        if points and points[0].method.name in SECOND_ORDER:
            last = points[-1]
            each = 1e6 / (last.steps * problem.records)
            found.append(
                {
                    "problem": problem.title,
                    "program": last.method.program,
                    "method": last.method.name,
                    "steps": last.steps * problem.records,
                    "a step, least [µs]": each * last.times.least,
                    "a step, median [µs]": each * last.times.median,
                    "a step, most [µs]": each * last.times.most,
                    "steps a second": 1e6 / (each * last.times.median),
                }
            )
    return found


SECOND_ORDER = ("average acceleration", "generalised alpha", "Newmark")
"""Names of the same method: without numerical damping the three leave the same error."""


def rows_of(problem: Problem, points: Sequence[Point]) -> list[Record]:
    """All runs of a method in numbers, for a second of motion."""
    return [
        {
            "problem": problem.title,
            "program": p.method.program,
            "method": p.method.name,
            "step [µs]": 1e6 * RECORD / p.steps,
            "error": p.error,
            "least [s]": p.times.least / problem.duration,
            "median [s]": p.times.median / problem.duration,
            "most [s]": p.times.most / problem.duration,
            "steps a second": p.steps * problem.records / p.times.median,
        }
        for p in points
    ]
