"""How loose an iterative solver may be for four digits of stiffness."""

from collections.abc import Iterable

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.solid_shafts import straight
from fe_drivetrain.cases.stability import solver_steps
from fe_drivetrain.common import Floats
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import FOUR_DIGITS, decades, safe_range
from fe_drivetrain.elasticity.solve import TOLERANCE
from fe_drivetrain.report import marked, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run

TOLERANCES = decades(-12, -1, 2)

#: Error below which round-off of the direct solution counts, too.
FLOOR = 1e-12

LOOSEST = "loosest tolerance"
ERROR = f"error at {TOLERANCE:.0e}"


@case(
    "Tolerance of the solver against the error of a stiffness",
    source="Hestenes and Stiefel 1952, J. Res. Nat. Bur. Stand. 49, 409; Meurant, Papez, Tichy "
    "2021, Accurate error estimation in CG",
)
def run(run: Run, page: Page) -> None:
    """Follow conjugate gradients step by step, and the stiffnesses that each step would give."""
    rows: list[Record] = []
    for name, build in solver_steps.PROBLEMS.items():
        with run.step(f"{name}: mesh, assembly and direct solution"):
            problem = build(run.quick)
        with run.step(f"{name}: multigrid"):
            steps = solver_steps.followed(problem)
        rows += [check(page, name, problem, steps, figure) for figure in problem.figures]
        check_estimate(page, name, steps)
        show(page, name, problem, steps)
    loosest = {
        f"{row['problem']}, {row['stiffness']}": row[LOOSEST] or TOLERANCES[-1] for row in rows
    }
    answer(page, rows, loosest)
    page.say(
        "The error of a load's own stiffness is the square of the energy error, as theory says; "
        "that of a motion elsewhere falls as the energy error itself.",
    )
    page.section("Loosest tolerances")
    page.table(
        "Loosest tolerance with four digits, and iterations that it takes and that the program's "
        "takes",
        rows,
    )
    page.image(
        "The hollow shaft, first of the problems", run.sketch(straight((0.0, 2.0), 0.7, 0.3))
    )
    page.data("loosest", loosest)


def answer(page: Page, rows: list[Record], loosest: dict[str, float]) -> None:
    """State the loosest tolerance for four digits of each stiffness, beside the program's."""
    enough, left = min(loosest.values()), max(row[ERROR] for row in rows)
    hardest = sorted(loosest, key=lambda name: loosest[name])
    page.answer(
        "How loose may the tolerance of an iterative solver be?",
        f"A tolerance of {formatted(enough, 2, '')} on the energy error makes every stiffness "
        f"correct to four digits; the program's {formatted(TOLERANCE, 2, '')} leaves errors up to "
        f"{formatted(left, unit='')}.",
        [
            page.value(
                "loosest tolerance for four correct digits, all stiffnesses",
                enough,
                at_least=TOLERANCE,
                by="program",
            ),
            *(
                page.value(f"loosest tolerance, {name}", rounded([loosest[name]], 2)[0])
                for name in (*hardest[1:3], hardest[-1])
            ),
            page.value(
                "worst relative error at the program's tolerance",
                left,
                at_most=FOUR_DIGITS,
                by="four digits",
            ),
        ],
        hero=caption_of_errors(rows[-1]["problem"]),
        cautions=[
            "The tolerance is on the error in the energy norm: a residual of the same size says "
            "little about a stiffness."
        ],
    )


def caption_of_errors(problem: str) -> str:
    """Caption of the chart of one problem."""
    return (
        f"Error of stiffnesses over the energy error of each step, {problem}; shaded: four digits "
        "of every one of them"
    )


def check(
    page: Page, name: str, problem: solver_steps.Problem, steps: solver_steps.Steps, figure: str
) -> Record:
    """One stiffness: how its error falls, its limit, and its row of the table."""
    error = steps.error[figure]
    is_own = figure == problem.own
    exponent = page.exponent(
        f"{name}, {figure}: error against the energy error, exponent",
        steps.energy_error,
        error,
        2.0 if is_own else 1.0,
        within=0.02 if is_own else 0.3,
        between=(1e2 * FLOOR, 1e-1),
        why="exact in exact arithmetic, from a start at zero: what is left is round-off near the "
        "lower end of the fit, a hundredth of the error there"
        if is_own
        else "its sign changes as the iteration goes on, and with it its size by a decade at "
        "single steps: over the several decades of the fit that changes a slope by 0.3",
        source="Galerkin orthogonality: f.(u - u_k) is the squared energy error"
        if is_own
        else "Cauchy and Schwarz: |l.(u - u_k)| is within the energy error times the energy norm "
        "of what l would do as a load",
    )
    # the error of the first iterate that the estimate accepts
    stopped = [
        float(error[int(np.argmax(steps.estimate <= t))])
        if (steps.estimate <= t).any()
        else float("nan")
        for t in TOLERANCES
    ]
    _, high = safe_range(TOLERANCES, stopped, FOUR_DIGITS)
    at_tolerance = stopped[int(np.argmin(np.abs(TOLERANCES / TOLERANCE - 1.0)))]
    page.vanishes(
        f"{name}, {figure}: error at the program's tolerance of {TOLERANCE:.0e}",
        at_tolerance,
        within=1e-7,
        why="a rotation read off one place is bound by the energy error times the root of its own "
        "compliance over the load's: below a hundred",
        source="the same system by a direct solver",
    )
    page.limit(
        f"multigrid: {name}, {figure}",
        "tolerance of the energy error",
        high=high,
        criterion="error of the stiffness below 1e-4",
        beyond=f"the error of the stiffness is as the tolerance to the power of {exponent:.1f}",
        program=f"stops at {TOLERANCE:.0e}",
        remedy=f"at {TOLERANCE:.0e} the error is {at_tolerance:.0e}",
    )
    return {
        "problem": name,
        "stiffness": figure,
        "exponent of the error": exponent,
        LOOSEST: high,
        "iterations": int(np.argmax(steps.estimate <= (high or TOLERANCES[-1]))) + 1,
        f"iterations to {TOLERANCE:.0e}": int(np.argmax(steps.estimate <= TOLERANCE)) + 1,
        ERROR: at_tolerance,
    }


def check_estimate(page: Page, name: str, steps: solver_steps.Steps) -> None:
    """The estimate by which the program stops, against the true energy error."""
    usable = (steps.energy_error > 1e-8) & (steps.estimate > 0)
    effectivity = steps.estimate[usable] / steps.energy_error[usable]
    page.vanishes(
        f"{name}: estimated over true energy error, the least [decades]",
        float(np.log10(effectivity.min())),
        within=0.5,
        why="half a decade: the estimate is of use where the tolerance is known to that",
        source="true energy error, from the direct solution",
    )


def show(page: Page, name: str, problem: solver_steps.Problem, steps: solver_steps.Steps) -> None:
    """Errors of every stiffness over the energy error."""
    energy = steps.energy_error
    page.section(name.capitalize())
    page.chart(
        caption_of_errors(name),
        [
            *(
                marked(figure, energy, np.maximum(error, 1e-16))
                for figure, error in steps.error.items()
            ),
            trace(
                "energy error squared", energy, np.maximum(energy**2, 1e-16), line={"dash": "dash"}
            ),
            trace("estimated energy error", energy, steps.estimate, True),
            trace("relative residual", energy, steps.residual, line={"dash": "dot"}),
        ],
        "relative error in the energy norm",
        "relative",
        "xy",
        (None, float(energy[first_safe(steps.error.values())])),
    )
    page.text(
        f"Conjugate gradients in {problem.unknowns:,} unknowns. The residual is "
        f"{steps.residual[first_safe([steps.error[problem.own]])]:.1e} where {problem.own} has "
        "four digits: it says little about a stiffness."
    )


def first_safe(errors: Iterable[Floats]) -> int:
    """The first step from which on every error stays below four digits."""
    bad = np.max(np.array(list(errors)), axis=0) >= FOUR_DIGITS
    return int(np.flatnonzero(bad)[-1] + 1) if bad.any() else 0
