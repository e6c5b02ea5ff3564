"""Rounds of runs: every tool at every size, interleaved, and what they come to."""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.cases.performance.peers.launching import Limits, Outcome, Variant, launch

EQUAL = 1e-6
"""Tools are compared where the solver leaves less of the stiffness than this."""


@dataclass
class Row:
    """One tool with one solver on one mesh.

    Attributes
    ----------
    variant : Variant
        The tool and its solver.
    unknowns : int
        Of the mesh.
    found : list of dict
        What each run measured, see `fe_drivetrain.cases.performance.peers.runner.measure`.
    trouble : str
        Why there is nothing, or no more, in words.
    min_seconds : float or None
        The least that it takes, where it was ended or not begun [s].
    error : float or None
        Of the stiffness, against the exact solution of the same equations, the largest of all
        motions; see `judge_errors`.
    """

    variant: Variant
    unknowns: int
    found: list[dict[str, Any]] = field(default_factory=list)
    trouble: str = ""
    min_seconds: float | None = None
    error: float | None = None

    @property
    def seconds(self) -> float | None:
        """Median wall time [s]."""
        return statistics.median(f["seconds"] for f in self.found) if self.found else None

    @property
    def bytes(self) -> int | None:
        """Median peak memory."""
        return int(statistics.median(f["peak_bytes"] for f in self.found)) if self.found else None

    @property
    def stiffnesses(self) -> list[float]:
        """Stiffness of each motion; the same in all runs."""
        return self.found[0]["stiffness"] if self.found else []

    @property
    def stiffness(self) -> float | None:
        """Stiffness of the first motion."""
        return self.stiffnesses[0] if self.found else None

    @property
    def reaches(self) -> bool:
        """Whether its error is below `EQUAL`."""
        return self.error is not None and self.error < EQUAL

    @property
    def loading(self) -> float | None:
        """Median time of taking the mesh in [s]."""
        return statistics.median(f["load_seconds"] for f in self.found) if self.found else None

    def step(self, name: str) -> float | None:
        """Median time of a step [s]."""
        times = [f["steps"][name] for f in self.found if name in f["steps"]]
        return statistics.median(times) if times else None


@dataclass(frozen=True)
class Plan:
    """How often, and how long.

    Attributes
    ----------
    repetitions : int
        Runs of each row that stays within its limits.
    limits : Limits
        Of each run.
    """

    repetitions: int
    limits: Limits


Launch = Callable[[Variant, Path, Path, Limits, str], Outcome]


def run_rounds(
    variants: Sequence[tuple[Variant, str]],
    problem: Path,
    warm_up: Path,
    unknowns: int,
    plan: Plan,
    earlier: Iterable[Row] = (),
    report: Callable[[str], None] = lambda step: None,
    start: Launch = launch,
) -> list[Row]:
    """Run every tool on one mesh, once a round, in an order that turns from round to round.

    Every other round goes backwards: what ran before leaves the machine's memory in pieces
    or whole, so no tool should always come after the same other.

    Parameters
    ----------
    variants : sequence of tuple
        Tools and the interpreters that have them.
    problem, warm_up : Path
        Files of the problem and of the small one.
    unknowns : int
        Of the problem.
    plan : Plan
        Repetitions and limits.
    earlier : iterable of Row, optional
        Rows of smaller meshes: what is sure to go over a limit is not begun.
    report : callable, optional
        Called for each run.
    start : callable, optional
        Runs one; tests have another.
    """
    rows = {variant: Row(variant, unknowns) for variant, _ in variants}
    earlier = list(earlier)
    for row in rows.values():
        row.trouble, row.min_seconds = foreseen(row, earlier, plan.limits)
    for number in range(plan.repetitions):
        turn = number * len(variants) // plan.repetitions
        order = [*variants[turn:], *variants[:turn]][:: -1 if number % 2 else 1]
        for variant, interpreter in order:
            row = rows[variant]
            if row.trouble:
                continue
            report(variant.name)
            outcome = start(variant, problem, warm_up, plan.limits, interpreter)
            if outcome.status == "done":
                row.found.append(outcome.found)
                continue
            row.trouble = in_words(outcome, plan.limits)
            if outcome.status == "over time":
                row.min_seconds = plan.limits.seconds
    return list(rows.values())


def in_words(outcome: Outcome, limits: Limits) -> str:
    """Why a run came to nothing."""
    match outcome.status:
        case "over time":
            return f"over {limits.seconds:g} s"
        case "over memory":
            return f"over {limits.bytes / 2**30:g} GiB"
        case "missing":
            return f"not installed: {outcome.reason}"
        case _:
            return f"failed: {outcome.reason}"


def foreseen(row: Row, earlier: Sequence[Row], limits: Limits) -> tuple[str, float | None]:
    """Whether a row is sure to go over a limit, from the same tool on smaller meshes.

    Returns
    -------
    trouble, min_seconds : tuple
        In words, or empty; and the least time that it takes [s].
    """
    mine = [r for r in earlier if r.variant == row.variant and r.unknowns < row.unknowns]
    mine.sort(key=lambda r: r.unknowns)
    if not mine:
        return "", None
    last = mine[-1]
    if last.trouble:
        return f"not run: {last.trouble.removeprefix('not run: ')} before", last.min_seconds
    done = [r for r in mine if r.found]
    growths = (
        ("s", limits.seconds, [r.seconds for r in done]),
        ("GiB", limits.bytes / 2**30, [(r.bytes or 0) / 2**30 for r in done]),
    )
    for unit, limit, values in growths:
        expected = extrapolated([r.unknowns for r in done], values, row.unknowns)
        if expected > limit:
            least = limits.seconds if unit == "s" else None
            return f"not run: would take about {expected:.2g} {unit}", least
    return "", None


def extrapolated(unknowns: Sequence[int], values: Sequence[float | None], at: int) -> float:
    """A power law through the last two values, of power 1 at least; no less than the last value."""
    last = values[-1] or 0.0
    power = 1.0
    if len(values) > 1 and values[-2]:
        ratio = max(last / values[-2], 1e-9)
        power = max(1.0, math.log(ratio) / math.log(unknowns[-1] / unknowns[-2]))
    return float(last * (at / unknowns[-1]) ** power)


def judge_errors(rows: Sequence[Row]) -> dict[str, float]:
    """Set the error of every row of one mesh; a reference for each quadrature rule.

    All tools find u^T K u with the displacements prescribed, which is least at the solution: so a
    solver's error only ever adds. The reference is the median of the direct solvers; without one,
    the least that an iterative solver found.

    Returns
    -------
    references : dict of str to float
        By the rule, of the first motion.
    """
    references: dict[str, float] = {}
    for rule in sorted({r.variant.rule for r in rows}):
        done = [r for r in rows if r.variant.rule == rule and r.found]
        full = [r for r in done if r.variant.tool != "calculix"] or done
        exact = [r.stiffnesses for r in full if r.variant.kind == "direct"]
        if not full:
            continue
        found = np.median(exact, axis=0) if exact else np.min([r.stiffnesses for r in full], axis=0)
        references[rule] = float(found[0])
        for row in done:
            row.error = float(np.abs(row.stiffnesses / found - 1.0).max())
    return references


def fastest_peer(rows: Iterable[Row], ours: str = "this_project") -> Row | None:
    """The fastest row of any other tool that reaches the common accuracy."""
    fit = [r for r in rows if r.variant.tool != ours and r.reaches and r.seconds is not None]
    return min(fit, key=lambda r: r.seconds or 0.0, default=None)


def leanest_direct_peer(rows: Iterable[Row], ours: str = "this_project") -> Row | None:
    """The row of another tool's direct solver with the least memory."""
    fit = [r for r in rows if r.variant.tool != ours and r.variant.kind == "direct" and r.found]
    return min(fit, key=lambda r: r.bytes or 0, default=None)
