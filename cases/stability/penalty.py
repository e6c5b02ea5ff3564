"""Couplings by penalty springs instead of elimination: wrong when soft, wrong when stiff."""

from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.stability.penalised_couplings import (
    KINDS,
    bar,
    eliminated,
    iterated,
    penalised,
    work,
)
from fe_drivetrain.common import Bools, Floats, InputError
from fe_drivetrain.comparison import FOUR_DIGITS, decades, safe_range
from fe_drivetrain.drivetrain_file import change_scene, library_scene
from fe_drivetrain.elasticity.solve import System, solve
from fe_drivetrain.report import crosses, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run

NAMES = {
    "tie": "tie of two halves that do not match",
    "rigid": "rigid end face",
    "averaged": "mean motion of the end face, held",
}

#: Multigrid stops converging before some of the couplings are good to four digits.
ONE_PERCENT = 1e-2

PENALTY = "penalty over the mean diagonal of the stiffness"


@case(
    "Penalty against elimination: too soft, too stiff, and what needs no penalty",
    source="Felippa 2004, Introduction to finite element methods, ch. 9 (the square root rule); "
    "Bathe 1996, Finite element procedures, sec. 3.4",
)
def run(run: Run, page: Page) -> None:
    """Sweep the penalty of three couplings, with direct and iterative solvers."""
    ranges = [sweep(run, page, kind) for kind in KINDS]
    page.section("Ranges")
    page.table(
        "Penalty over the mean diagonal: range with four digits, best value, and exponents of the "
        "error on either side",
        ranges,
    )
    page.text(
        "Each row of the coupling has unit length, and the penalty is the stiffness of a spring on "
        "it. The reference is the same mesh with the same rows eliminated, so that the error is "
        "the penalty's alone."
    )
    fallback = check_protection(run, page)
    answer(page, ranges, fallback)
    page.say(
        "On either side the error grows tenfold a decade, as theory says: the compliance of "
        "the springs below, their round-off above. Multigrid stops converging decades earlier.",
    )
    page.image(
        "The first of the bars, two bodies that are coupled", run.sketch(bar(next(iter(KINDS)), 2))
    )


def answer(page: Page, ranges: list[Record], fallback: float) -> None:
    """State the penalties that keep four digits of all couplings; fallback is an error."""
    low = max(found["safe from"] or 0.0 for found in ranges)
    high = min(found["to"] or np.inf for found in ranges)
    page.answer(
        "Which penalty stiffness may replace a rigid, averaged or tied coupling?",
        (
            "All couplings are correct to four digits with penalties of "
            f"{formatted(low, 2, '')} to {formatted(high, 2, '')} times the mean stiffness; "
            if low <= high
            else "No penalty makes all couplings correct to 4 digits; "
        )
        + "the program eliminates them instead, without a penalty.",
        [
            page.value("least penalty for four correct digits, worst coupling", low),
            page.value("largest penalty for four correct digits, worst coupling", high),
            page.value(
                "error with the best penalty, worst coupling",
                max(found["least error"] for found in ranges),
                at_most=FOUR_DIGITS,
            ),
            page.value(
                "error of the program where multigrid fails with a penalty of a million",
                fallback,
                at_most=FOUR_DIGITS,
            ),
        ],
        hero=caption_of_errors(next(iter(KINDS))),
        cautions=[
            "The range depends on mesh and coupling: no penalty is known in advance to be safe."
        ],
    )


def caption_of_errors(kind: str) -> str:
    """Caption of the chart of one coupling."""
    return (
        f"Error of a bar's compliance over the penalty, {NAMES[kind]}; shaded: four digits by a "
        "direct solver, which refuses where its curve ends"
    )


@dataclass(frozen=True)
class Penalised:
    """One coupling by penalties, against its elimination.

    Attributes
    ----------
    penalties : (n,) array
        Over the mean diagonal.
    direct : (n, loads) array
        Relative error of the compliance, direct solver; NaN where it refuses.
    tried, iterated_error, arrived : (m,) array
        Penalties of multigrid, largest error, and whether it has converged.
    counts : list of int
        Its iterations.
    uncertain, by_iteration : float
        Change of the elimination by another scale, and by multigrid.
    iterations : int
        Iterations of multigrid with the elimination.
    """

    penalties: Floats
    direct: Floats
    tried: Floats
    iterated_error: Floats
    arrived: Bools
    counts: list[int]
    uncertain: float
    by_iteration: float
    iterations: int

    @property
    def error(self) -> Floats:
        """The largest error of each penalty."""
        return np.asarray(np.abs(self.direct).max(axis=1))


def sweep(run: Run, page: Page, kind: str) -> Record:
    """One coupling over all penalties: its checks, chart and limits; the range that is safe."""
    found = coupled(run, kind)
    penalties, error = found.penalties, found.error
    best = int(np.nanargmin(error))
    exponents = check_exponents(page, kind, found, 0.4 if run.quick else 0.15)
    check_elimination(page, kind, found)
    low, high = state_limits(page, kind, found)
    show(page, kind, found, (low, high))
    return {
        "coupling": NAMES[kind],
        "safe from": low,
        "to": high,
        "best": penalties[best],
        "least error": error[best],
        "exponent, soft": exponents[0],
        "exponent, stiff": exponents[1],
    }


def coupled(run: Run, kind: str) -> Penalised:
    """One coupling by elimination and by each penalty, with both solvers."""
    with run.step(f"{kind}: elimination"):
        body = bar(kind, 2)
        system, F = eliminated(body)
        exact = work(system, F, "superlu")
        by_iteration, iterations, _ = iterated(system, F)
        # a stiffness scaled by a third rounds differently everywhere
        other = work(scaled(system, 1.0 / 3.0), F, "superlu") / 3.0
    penalties = decades(-3, 14, 1 if run.quick else 3)
    with run.step(f"{kind}: penalty, direct"):
        direct = np.array([work(*penalised(body, p), "superlu") for p in penalties]) / exact - 1.0
    tried = decades(-2, 10, 0.25 if run.quick else 0.5)
    with run.step(f"{kind}: penalty, multigrid"):
        found = [iterated(*penalised(body, p)) for p in tried]
    return Penalised(
        penalties=penalties,
        direct=direct,
        tried=tried,
        iterated_error=np.array([np.abs(w / exact - 1.0).max() for w, _, _ in found]),
        arrived=np.array([converged for _, _, converged in found]),
        counts=[count for _, count, _ in found],
        uncertain=float(np.abs(other / exact - 1.0).max()),
        by_iteration=float(np.abs(by_iteration / exact - 1.0).max()),
        iterations=iterations,
    )


def check_exponents(page: Page, kind: str, found: Penalised, within: float) -> tuple[float, float]:
    """Check the exponents of the errors of soft and stiff penalties; return both."""
    penalties, error = found.penalties, found.error
    spread = np.sqrt((found.direct**2).mean(axis=1))
    best = int(np.nanargmin(error))
    soft = page.exponent(
        f"{kind}: error of a soft penalty, exponent",
        penalties[: best + 1],
        spread[: best + 1],
        -1.0,
        within=0.05,
        between=(1e-6, 1e-2),
        why="first order in the compliance: the next order is a hundredth of the leading error at "
        "most",
        source="springs in series: the penalty's own compliance is added",
    )
    stiff = page.exponent(
        f"{kind}: error of a stiff penalty, exponent",
        penalties[best:],
        spread[best:],
        1.0,
        within=within,
        between=(2.0 * spread[best], 0.1),
        why="round-off scatters by about a decade from point to point: a slope over five decades "
        "in steps of a third of one by 0.15, over the few points of a quick run by 0.4",
        source="round-off of penalty terms, 2e-16 of them, is added to the elastic ones",
    )
    return soft, stiff


def check_elimination(page: Page, kind: str, found: Penalised) -> None:
    """Check the round-off of the reference, and that both solvers agree on it."""
    page.vanishes(
        f"{kind}: elimination, stiffness scaled by a third against unscaled",
        found.uncertain,
        within=1e-10,
        why="round-off times the condition number of the bar",
        source="a linear system",
    )
    page.vanishes(
        f"{kind}: elimination, multigrid against direct",
        found.by_iteration,
        within=1e-10,
        why="iterations stop at 1e-9 in the energy norm, which counts squared",
        source="the same discrete model",
    )


def state_limits(page: Page, kind: str, found: Penalised) -> tuple[float | None, float | None]:
    """State the safe penalties of both solvers; return those of the direct one."""
    penalties, error = found.penalties, found.error
    low, high = safe_range(penalties, error, FOUR_DIGITS)
    safe_iterated = safe_range(
        found.tried, np.where(found.arrived, found.iterated_error, np.nan), ONE_PERCENT
    )
    lost = ~np.isfinite(error)
    page.limit(
        f"penalty in place of elimination, direct solver: {NAMES[kind]}",
        PENALTY,
        low=low,
        high=high,
        criterion="error of the compliance below 1e-4",
        beyond="below: the coupling yields, error as 1 / penalty; above: round-off, error as the "
        f"penalty, and no answer at all from {penalties[lost].min():.0e} on"
        if lost.any()
        else "below: the coupling yields; above: round-off",
        program="eliminates all couplings; springs above 1e16 N/m are refused",
        remedy=f"elimination: right to {found.uncertain:.0e}",
    )
    page.limit(
        f"penalty in place of elimination, multigrid: {NAMES[kind]}",
        PENALTY,
        low=safe_iterated[0],
        high=safe_iterated[1],
        criterion="converged, and error of the compliance below 1 %",
        beyond="no convergence: smoother and aggregates do not take the springs into account",
        program="gives up early and takes a direct factor, and says so",
        remedy=f"elimination: {found.iterations} iterations",
    )
    return low, high


def show(page: Page, kind: str, found: Penalised, safe: tuple[float | None, float | None]) -> None:
    """Show the errors, and keep all numbers."""
    penalties, error = found.penalties, found.error
    tried, iterated_error, arrived = found.tried, found.iterated_error, found.arrived
    lost = ~np.isfinite(error)
    page.section(NAMES[kind].capitalize())
    page.chart(
        caption_of_errors(kind),
        [
            trace("penalty, direct", penalties[~lost], error[~lost]),
            trace("penalty, multigrid, converged", tried[arrived], iterated_error[arrived], True),
            crosses("penalty, multigrid, not converged", tried[~arrived], iterated_error[~arrived]),
            trace(
                "elimination, direct: its round-off",
                [penalties[0], penalties[-1]],
                [max(found.uncertain, 1e-16)] * 2,
                line={"dash": "dash"},
            ),
        ],
        PENALTY,
        "relative error",
        "xy",
        safe,
    )
    page.data(
        kind,
        {
            "penalty": penalties,
            "error": error,
            "iterated_penalty": tried,
            "iterated_error": iterated_error,
            "iterations": found.counts,
        },
    )


def check_protection(run: Run, page: Page) -> float:
    """What the program does with a penalty that a user gives in spite of that; its error."""
    with run.step("what the program does"):
        body = bar("averaged", 2)
        exact = work(*eliminated(body), "superlu")
        system, F = penalised(body, 1e6)
        instead = solve(system, F, "multigrid")
        error = np.abs(np.einsum("nm,nm->m", F, instead.x) / exact - 1.0).max()
        penalty_scene = {"gearbox.stiffness": [0, 1e17, 1e17, "rigid", 0, 0]}
        try:
            change_scene(library_scene("main_bearing_bonded"), penalty_scene)
            refused = False
        except InputError:
            refused = True
    page.holds(
        "multigrid asked for at a penalty of 1e6: a direct factor instead",
        instead.diagnostics.method != "multigrid",
        why="without it the answer would be that of an iteration that has not converged",
        source="the iteration does not converge there",
    )
    page.at_most(
        "error of the compliance that comes of it",
        error,
        FOUR_DIGITS,
        why="four digits of stiffness",
        source="elimination",
        measure="identity",
    )
    page.holds(
        "a scene with a gearbox spring of 1e17 N/m is refused",
        refused,
        why="round-off of so stiff a spring would be added to the elastic terms",
        source="such a spring is a penalty: 'rigid' is eliminated",
    )
    return float(error)


def scaled(system: System, factor: float) -> System:
    """The same system in other units."""
    return replace(system, K=(factor * system.K).tobsr((3, 3)))
