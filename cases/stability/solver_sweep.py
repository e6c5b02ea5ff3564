"""Sweeps of a body's shape in which every solver is tried: points, checks, charts."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.references import solver_trials as trials
from fe_drivetrain.cases.references.thin_bodies import Problem
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.comparison import FOUR_DIGITS
from fe_drivetrain.elasticity.solve import TOLERANCE, solvers
from fe_drivetrain.report import crosses, marked, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record

#: Residual that is commonly taken for an answer.
RESIDUAL = 1e-8

#: Error of a compliance above which it has not even three digits.
WRONG = 1e-3

#: Largest ratio of iterations over a sweep, where a method holds.
BOUNDED = 2.0

MULTIGRID = "multigrid (smoothed aggregation under quadratic elements)"
MULTIGRID_FALLBACK = (
    "auto does not choose it; where asked for it, gives up early, takes a direct factor or "
    "patches, and says so"
)
ITERATIONS_CHART = (
    f"Iterations to an energy error of {formatted(TOLERANCE, 2, '')}; shaded: multigrid converges; "
    f"crosses: after {trials.ITERATIONS} it has not"
)
FAILURES = {
    "none": "none",
    "false": "false: residual above 1e-8, answer right",
    "short": "stops short: three digits",
    "true": "true: answer wrong",
}

Range = tuple[float | None, float | None]


@dataclass(frozen=True)
class Point:
    """All that is measured of one body.

    Attributes
    ----------
    value : float
        Of the parameter that is swept.
    unknowns : int
        Of the system.
    reference : (m,) array
        Exact compliance [J].
    iterations : dict
        Of conjugate gradients by preconditioner.
    factors : dict
        By direct solver; None where the matrix turned out not to be positive definite.
    answers : dict
        Of the program by the method that it was asked for.
    """

    value: float
    unknowns: int
    reference: Floats
    iterations: dict[str, trials.Iterated]
    factors: dict[str, trials.Factored | None]
    answers: dict[str, trials.Answer]

    def error(self, compliance: Floats | None) -> float:
        """Largest relative error of a compliance; NaN of none."""
        if compliance is None:
            return math.nan
        return float(np.abs(compliance / self.reference - 1.0).max())

    def iterations_error(self, method: str) -> float:
        """Error of conjugate gradients as far as they came."""
        return self.error(self.iterations[method].compliance)

    def factored_error(self, refined: bool) -> float:
        """Error of the fastest direct solver."""
        found = self.factors[trials.fastest()]
        if found is None:
            return math.nan
        return self.error(found.refined if refined else found.once)

    @property
    def condition(self) -> float:
        """Estimated condition number; NaN where there is no factor."""
        return next((f.condition for f in self.factors.values() if f is not None), math.nan)

    @property
    def silently_wrong(self) -> list[str]:
        """Methods whose error is larger than their bound of round-off, and than four digits."""
        return [
            method
            for method, answer in self.answers.items()
            if answer.compliance is not None
            and not self.error(answer.compliance) <= max(answer.round_off, FOUR_DIGITS)
        ]

    @property
    def torsion_errors(self) -> list[float]:
        """Relative errors of the first compliance by each direct solver, refined."""
        exact = self.reference[0]
        return [abs(f.refined[0] / exact - 1.0) for f in self.factors.values() if f is not None]

    @property
    def failure(self) -> str:
        """How multigrid fails, of `FAILURES`."""
        found = self.iterations["multigrid"]
        if found.converged:
            return "false" if found.residual > RESIDUAL else "none"
        error = self.error(found.compliance)
        return "true" if not error <= WRONG else "short" if error > FOUR_DIGITS else "false"


def measured(value: float, problem: Problem, reference: Floats) -> Point:
    """One point of a sweep: every solver, alone and with what the program falls back to."""
    system, F = problem.system, problem.F
    factors: dict[str, trials.Factored | None] = {}
    for method in trials.installed():
        try:
            factors[method] = trials.factored(system, F, method)
        except InputError:
            factors[method] = None
    return Point(
        value,
        system.n_free,
        reference,
        {method: trials.iterated(system, F, method) for method in solvers.ITERATIVE},
        factors,
        {m: trials.answered(system, F, m) for m in ("auto", "multigrid", "schwarz")},
    )


def max_safe(points: Sequence[Point], is_safe: Callable[[Point], bool]) -> float | None:
    """The last value before the first that is not safe, None where all are or the first is not."""
    safe = [is_safe(p) for p in points]
    if all(safe) or not safe[0]:
        return None
    return points[safe.index(False) - 1].value


def safe_by_multigrid(points: Sequence[Point]) -> float | None:
    """Up to where multigrid converges."""
    return max_safe(points, lambda p: p.iterations["multigrid"].converged)


def safe_by_factor(points: Sequence[Point]) -> float | None:
    """Up to where a refined direct solution has four digits."""
    return max_safe(points, lambda p: p.factored_error(True) <= FOUR_DIGITS)


def check_multigrid(page: Page, points: Sequence[Point], source: str) -> None:
    """The sweep reaches a failure of multigrid, and the program protects against it."""
    page.holds(
        "multigrid fails within the sweep",
        not all(p.iterations["multigrid"].converged for p in points),
        why="a sweep without a failure finds no limit",
        source=source,
    )
    page.vanishes(
        "answers whose error is larger than their own bound of round-off, and than 1e-4",
        sum(len(p.silently_wrong) for p in points),
        within=0.0,
        why="a wrong answer without a bound that admits it looks like a right one",
        source="the program's protection: fall back, or refuse",
    )


def check_patches(page: Page, quantity: str, iterations: Sequence[int], growth: str) -> None:
    """Patches need about as many iterations everywhere; `growth` is multigrid's, in words."""
    page.at_most(
        quantity,
        max(iterations) / min(iterations),
        BOUNDED,
        why="the bound of theory leaves the number itself open: twice as many iterations still "
        f"count as bounded, where those of multigrid grow {growth} times and do not suffice",
        source="Spillane et al. 2014, theorem 3.22: bounded, whatever the shape",
    )


def show_iterations(page: Page, points: Sequence[Point], x: str, safe: Range) -> None:
    """Chart of the iterations of multigrid and of patches."""
    values = [p.value for p in points]
    multigrid = [p.iterations["multigrid"] for p in points]
    stopped = [k for k, found in enumerate(multigrid) if not found.converged]
    page.chart(
        ITERATIONS_CHART,
        [
            trace("multigrid", values, [i.iterations for i in multigrid]),
            crosses(
                "multigrid, not converged",
                [values[k] for k in stopped],
                [multigrid[k].iterations for k in stopped],
            ),
            marked(
                "patches with a spectral coarse space",
                values,
                [p.iterations["schwarz"].iterations for p in points],
            ),
        ],
        x,
        "iterations",
        "xy",
        safe,
    )


def show_errors(
    page: Page, points: Sequence[Point], x: str, safe: Range, caption: str, note: str
) -> None:
    """Residuals beside true errors and the program's bound; a note on the reference; all points."""
    method = trials.fastest()
    curves = {
        "multigrid: residual": [p.iterations["multigrid"].residual for p in points],
        "multigrid: true error": [p.iterations_error("multigrid") for p in points],
        "patches: residual": [p.iterations["schwarz"].residual for p in points],
        "patches: true error": [p.iterations_error("schwarz") for p in points],
        f"{method}: true error": [p.factored_error(False) for p in points],
        f"{method}, refined: true error": [p.factored_error(True) for p in points],
        "bound of round-off, as the program gives it": [
            p.answers["schwarz"].round_off for p in points
        ],
    }
    traces = []
    for name, values in curves.items():
        shown = [(p.value, v) for p, v in zip(points, values, strict=True) if 0.0 < v < math.inf]
        line = {"dash": "dot"} if name.startswith("bound") else {}
        traces.append(trace(name, [at for at, _ in shown], [v for _, v in shown], line=line))
    page.section("Residual and true error")
    page.chart(caption, traces, x, "relative error, relative residual", "xy", safe)
    page.text(failures(points, x))
    page.text(note)
    page.table("All points", [record(p, x) for p in points])


def show_condition(page: Page, points: Sequence[Point], x: str, safe: Range) -> None:
    """Chart of the estimated condition number."""
    with_factor = [p for p in points if np.isfinite(p.condition)]
    page.section("Condition number")
    page.chart(
        "Estimated condition number of the stiffness, its diagonal scaled to one",
        [trace("estimate", [p.value for p in with_factor], [p.condition for p in with_factor])],
        x,
        "condition number",
        "xy",
        safe,
    )


def record(point: Point, parameter: str) -> Record:
    """A point as a row of the table."""
    multigrid, patches = point.iterations["multigrid"], point.iterations["schwarz"]
    return {
        parameter: point.value,
        "unknowns": point.unknowns,
        "condition number": point.condition,
        "multigrid: iterations": multigrid.iterations,
        "its residual": multigrid.residual,
        "its true error": point.iterations_error("multigrid"),
        "its failure": FAILURES[point.failure],
        "patches: iterations": patches.iterations,
        "their residual": patches.residual,
        "their true error": point.iterations_error("schwarz"),
        "direct: true error": point.factored_error(False),
        "the same, refined": point.factored_error(True),
        "auto takes": point.answers["auto"].method or "refused",
        "bound of round-off": point.answers["auto"].round_off,
    }


def failures(points: Sequence[Point], x: str) -> str:
    """Which failures of multigrid are false, and which are true."""

    def at(*kinds: str) -> str:
        return ", ".join(f"{p.value:g}" for p in points if p.failure in kinds) or "none"

    return (
        "A residual says little here. False failures, a residual above "
        f"{RESIDUAL:.0e} with the answer right to four digits: multigrid at {x} = {at('false')}. "
        f"Stopped short, with three digits: {x} = {at('short')}. True failures, an error of more "
        f"than {WRONG:.0e} after {trials.ITERATIONS} iterations: {x} = {at('true')}. A solver that "
        "watches its residual cannot distinguish them; the estimate of the energy error can."
    )
