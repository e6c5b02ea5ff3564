"""Shafts of 5 to 5000 diameters: multigrid, direct solvers and patches, against exact answers."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import solver_trials as trials
from fe_drivetrain.cases.references import thin_bodies as bodies
from fe_drivetrain.cases.stability import solver_sweep as sweep
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run

DIAMETER, WALL = 0.7, 0.175  # m
#: Elements along a shaft, at most, and round it.
ALONG, TURN = 12, 6

SLENDERNESS = (5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000)
QUICK_SLENDERNESS = (5, 100, 500, 5000)

AXIS = "L/D"
EXPONENT = "condition number over L/D, as many elements from 100 diameters on: exponent"
PATCHES = "patches: most iterations over least, wherever the program answers"
ERRORS = (
    "True error of a shaft's compliance over its slenderness, in bending or torsion, whichever is "
    "worse; shaded: four digits by direct solvers"
)
PARAMETER = f"L/D of a shaft in {ALONG} elements along it"


def solve(slenderness: int) -> sweep.Point:
    """A cantilever under torsion and under a moment, by every solver."""
    count = min(ALONG, slenderness)
    size = slenderness * DIAMETER / count
    shaft = bodies.uniform(DIAMETER, WALL, slenderness * DIAMETER)
    problem = bodies.cantilever(shaft, size * (1.0 + 1e-9), TURN)
    torsion = bodies.torsional_compliance(problem)
    bending = bodies.bending_compliance(DIAMETER, WALL, size, TURN, count)
    return sweep.measured(float(slenderness), problem, np.array([torsion, bending]))


@case(
    "Slender shafts: where multigrid stops, and where double precision ends",
    source="Spillane, Dolean, Hauret, Nataf, Pechstein and Scheichl 2014, Numer. Math. 126, "
    "741-770; Skeel 1979, J. ACM 26, 494-526; Saint-Venant's torsion; Euler-Bernoulli",
)
def run(run: Run, page: Page) -> None:
    """Sweep the slenderness of a cantilever under torsion and under a moment."""
    points = [
        run.timed(f"L/D = {slenderness}", solve, slenderness)
        for slenderness in (QUICK_SLENDERNESS if run.quick else SLENDERNESS)
    ]
    # what the program refuses, patches need not solve either
    patches = [p.iterations["schwarz"].iterations for p in points if p.answers["auto"].method]
    exponent = check(page, points, patches)
    show(page, points, patches, exponent)
    safe = (None, sweep.safe_by_factor(points))
    page.section("Iterations")
    sweep.show_iterations(page, points, AXIS, (None, sweep.safe_by_multigrid(points)))
    sweep.show_errors(
        page,
        points,
        AXIS,
        safe,
        ERRORS,
        "The reference of bending is put together from short shafts of the same elements, and "
        "exact to about 1e-6: errors below are its own. That of torsion is exact.",
    )
    sweep.show_condition(page, points, AXIS, safe)
    page.image(
        "A shaft of five diameters", run.sketch(bodies.uniform(DIAMETER, WALL, 5.0 * DIAMETER))
    )
    page.data("slenderness", [p.value for p in points])
    page.data("multigrid_iterations", [p.iterations["multigrid"].iterations for p in points])
    page.data("patch_iterations", [p.iterations["schwarz"].iterations for p in points])


def check(page: Page, points: list[sweep.Point], patches: list[int]) -> float:
    """The condition number's growth, which is returned, and what each solver makes of it."""
    long = [p for p in points if 100 <= p.value <= 1000]
    exponent = page.exponent(
        EXPONENT,
        [p.value for p in long],
        [p.condition for p in long],
        4.0,
        within=0.4,
        relative=False,
        why="the estimate of a one-norm may be wrong by a factor of 2.5, which over one decade of "
        "L/D is 0.4 of a slope",
        source="bending energy over the energy of one element, Euler-Bernoulli: (L/D)^-4",
    )
    page.vanishes(
        "torsional compliance, all direct solvers up to 500 diameters: largest error",
        max(error for p in points if p.value <= 500 for error in p.torsion_errors),
        within=1e-7,
        why="its condition number is about the square root of that of bending",
        source="L / (G J) of the meshed cross-section, exact in these elements",
    )
    sweep.check_patches(page, PATCHES, patches, "six")
    sweep.check_multigrid(
        page, points, "aggregates that move as rigid bodies make a chain of them too stiff"
    )
    page.holds(
        "the program refuses within the sweep",
        not all(p.answers["auto"].method for p in points),
        why="the last shafts have no digit left: an answer would be one of round-off",
        source="a bound of first order bounds nothing where it is not small",
    )
    return exponent


def answer(page: Page, points: list[sweep.Point], patches: list[int], within: float) -> None:
    """State where digits end, and multigrid; `within` is the worst error over its own bound."""
    digits, multigrid = sweep.safe_by_factor(points), sweep.safe_by_multigrid(points)
    refused = min((p.value for p in points if not p.answers["auto"].method), default=None)
    last = points[-1].value
    ends = {
        "largest L/D correct to four digits in bending, any solver": digits,
        "largest L/D with which multigrid converges": multigrid,
        "L/D from which the program rejects the shaft": refused,
    }
    page.answer(
        "How slender may a shaft of solid elements be?",
        "With solid elements a bent shaft is correct to four digits up to "
        f"L/D\u00a0=\u00a0{formatted(last if digits is None else digits)}; multigrid converges up "
        f"to {formatted(multigrid or 0.0)}; the program rejects "
        + ("none." if refused is None else f"L/D from {formatted(refused)}."),
        [
            *(page.value(name, value) for name, value in ends.items() if value is not None),
            page.judged(PATCHES, "most over least iterations of the patch solver", "theorem"),
            page.judged(EXPONENT, "exponent of L/D in the condition number", "theory"),
            page.value("worst error over the error that the program states", within, at_most=1.0),
        ],
        hero=ERRORS,
        cautions=[
            f"L/D is length over diameter. Shafts here have {ALONG} elements along their length; "
            "longer elements lose fewer digits, and a beam has no such limit."
        ],
    )


def show(page: Page, points: list[sweep.Point], patches: list[int], exponent: float) -> None:
    """Answer and limits."""
    safe_multigrid, safe_direct = sweep.safe_by_multigrid(points), sweep.safe_by_factor(points)
    refused = [p.value for p in points if not p.answers["auto"].method]
    within = max(
        p.error(a.compliance) / max(a.round_off, 1e-5)
        for p in points
        for a in p.answers.values()
        if a.compliance is not None
    )
    answer(page, points, patches, within)
    page.say(
        f"Patches with a spectral coarse space need {min(patches)} to {max(patches)} iterations up "
        f"to L/D = {max(p.value for p in points if p.answers['auto'].method):g}.",
        f"The condition number grows as (L/D)^{exponent:.2f}: rounding has changed the stiffness "
        "before any solver begins.",
    )
    page.limit(
        sweep.MULTIGRID,
        PARAMETER,
        high=safe_multigrid,
        criterion=f"energy error of 1e-9 within {trials.ITERATIONS} iterations",
        beyond="iterations grow with the slenderness; then a true failure, error of the compliance "
        f"{max(p.iterations_error('multigrid') for p in points if p.value <= 500):.0%} up to L/D = "
        "500",
        program=sweep.MULTIGRID_FALLBACK,
        remedy=f"patches with a spectral coarse space: at most {max(patches)} iterations",
    )
    page.limit(
        "direct solvers in double precision, and any other",
        PARAMETER,
        high=safe_direct,
        criterion="error of the compliance in bending below 1e-4, refined",
        beyond="the rounding of the stiffness itself, not the solver: refinement does not help",
        program="gives a bound with each answer, reports it from 1e-4 on, refuses above 0.1: here "
        f"from L/D = {min(refused):g} on"
        if refused
        else "gives a bound",
        remedy="a beam, or one element for many diameters",
    )
