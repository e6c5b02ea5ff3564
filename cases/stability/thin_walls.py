"""Tubes of a wall down to 1/2000 of the radius: multigrid, direct solvers and patches."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import solver_trials as trials
from fe_drivetrain.cases.references import thin_bodies as bodies
from fe_drivetrain.cases.stability import solver_sweep as sweep
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import FOUR_DIGITS
from fe_drivetrain.elasticity.solve import TOLERANCE, multigrid, schwarz
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run

DIAMETER, LENGTH = 3.0, 3.0  # m
#: Radius over wall.
THINNESS = (5, 20, 40, 75, 150, 400, 2000)
QUICK_THINNESS = (5, 40, 400)
#: Elements round the tube and along it.
MESH, QUICK_MESH = (14, 4), (8, 3)

#: Nodes of a patch and thresholds of the coarse space that are compared at the thinnest wall.
OPTIONS = ((100, 0.03), (100, 0.1), (100, 0.3), (60, 0.1), (200, 0.1))

AXIS = "radius over wall"
EXPONENT = "condition number over radius / wall, from 40 on: exponent"
PATCHES = "patches: most iterations over least"


def tube(thinness: float, turn: int, along: int) -> bodies.Problem:
    """A tube with a free end, twisted, and under a pressure that makes it oval."""
    shaft = bodies.uniform(DIAMETER, DIAMETER / 2.0 / thinness, LENGTH)
    return bodies.cantilever(shaft, LENGTH / along * (1.0 + 1e-9), turn, rigid=False)


def compliances(problem: bodies.Problem) -> tuple[Floats, float]:
    """Compliances of torsion and oval, and the relative scatter of direct solvers in the oval."""
    # the oval has no closed form on a mesh: the mean of the refined factors of all solvers
    oval = [
        trials.factored(problem.system, problem.F, method).refined[1]
        for method in trials.installed()
    ]
    reference = np.array([bodies.torsional_compliance(problem), np.mean(oval)])
    return reference, float(np.ptp(oval) / np.mean(oval))


def with_options(problem: bodies.Problem, nodes: int, threshold: float) -> Record:
    """Patches of another size, another coarse space."""
    system = problem.system
    made = schwarz.build(system, schwarz.Options(nodes=nodes, threshold=threshold))
    found = multigrid.conjugate_gradients(system.K, problem.F, made.precondition, TOLERANCE)
    return {
        "nodes of a patch": nodes,
        "threshold": threshold,
        "iterations": found.iterations,
        "coarse space over unknowns (%)": 100.0 * made.n_coarse / system.n_free,
        "memory (MiB)": made.bytes / 2**20,
    }


@case(
    "Thin walls: where multigrid stops, and what holds",
    source="Spillane, Dolean, Hauret, Nataf, Pechstein and Scheichl 2014, Numer. Math. 126, "
    "741-770; Saint-Venant's torsion",
)
def run(run: Run, page: Page) -> None:
    """Sweep the wall of a tube under torsion and under a pressure that makes it oval."""
    turn, along = QUICK_MESH if run.quick else MESH
    points: list[sweep.Point] = []
    for thinness in QUICK_THINNESS if run.quick else THINNESS:
        with run.step(f"radius over wall {thinness}"):
            problem = tube(thinness, turn, along)
            reference, spread = compliances(problem)
            points.append(sweep.measured(float(thinness), problem, reference))
    tried = [
        run.timed("options of patches", with_options, problem, *options)
        for options in (() if run.quick else OPTIONS)
    ]
    exponent = check(page, points)
    show(page, points, turn, exponent)
    if tried:
        page.table("Patches of other sizes, other coarse spaces, thinnest wall", tried)
    sweep.show_errors(
        page,
        points,
        AXIS,
        (None, sweep.safe_by_multigrid(points)),
        "True error of the compliance, in torsion or of the oval, whichever is worse. Shaded: "
        "multigrid converges",
        "The reference of the oval is the mean of all direct solvers, refined; at the thinnest "
        f"wall they differ by {spread:.1e}.",
    )
    sweep.show_condition(page, points, AXIS, (None, sweep.safe_by_factor(points)))
    page.image(
        "A tube of a wall of a tenth of its radius",
        run.sketch(bodies.uniform(DIAMETER, DIAMETER / 20.0, LENGTH)),
    )
    page.data("thinness", [p.value for p in points])
    page.data("multigrid_iterations", [p.iterations["multigrid"].iterations for p in points])
    page.data("patch_iterations", [p.iterations["schwarz"].iterations for p in points])


def check(page: Page, points: list[sweep.Point]) -> float:
    """The condition number's growth, which is returned, and the errors of each solver."""
    thin = [p for p in points if p.value >= 40]
    exponent = page.exponent(
        EXPONENT,
        [p.value for p in thin],
        [p.condition for p in thin],
        2.0,
        within=0.4,
        relative=False,
        why="one power is the shell's, the other the element's own flatness; the estimate of a "
        "one-norm may be wrong by a factor of 2.5, which over one decade is 0.4 of a slope",
        source="energy of bending over that of stretching a shell's element, (t / R)^2",
    )
    page.vanishes(
        "torsional compliance, all direct solvers: largest error",
        max(error for p in points for error in p.torsion_errors),
        within=1e-7,
        why="four decades of a condition number of 1e11 are left at 1e-16",
        source="L / (G J) of the meshed cross-section, exact in these elements",
    )
    page.vanishes(
        "compliance of torsion and of the oval by patches: largest error",
        max(p.iterations_error("schwarz") for p in points),
        within=1e-7,
        why="iterations stop at an energy error of 1e-9; round-off is above",
        source="torsion exact; oval by direct solvers",
    )
    patches = [p.iterations["schwarz"].iterations for p in points]
    sweep.check_patches(page, PATCHES, patches, "seven")
    sweep.check_multigrid(
        page, points, "aggregates that move as rigid bodies cannot bend as a wall does"
    )
    return exponent


def answer(page: Page, points: list[sweep.Point], patches: list[int], patch_error: float) -> None:
    """State the thinnest wall that multigrid solves, and what holds beyond."""
    safe, thinnest = sweep.safe_by_multigrid(points), points[-1].value
    wrong = max(p.iterations_error("multigrid") for p in points)
    within = patch_error <= FOUR_DIGITS
    page.answer(
        "How thin may the wall of a tube be for the iterative solvers?",
        f"Multigrid converges only for walls of at least 1/{formatted(safe or 0.0)} of the radius; "
        f"the patch solver down to 1/{thinnest:g} in {min(patches)} to {max(patches)} iterations"
        + ("." if within else ", not accurately."),
        [
            *(
                []
                if safe is None
                else [page.value("largest radius over wall with which multigrid converges", safe)]
            ),
            page.judged(PATCHES, "most over least iterations of the patch solver", "theorem"),
            page.value(
                "worst relative error of the patch solver",
                patch_error,
                at_most=FOUR_DIGITS,
            ),
            page.value("worst error of multigrid where it does not converge [%]", 100 * wrong),
            page.judged(EXPONENT, "exponent of radius over wall in the condition number", "theory"),
        ],
        hero=sweep.ITERATIONS_CHART,
        cautions=[
            "The patch solver's preconditioner solves overlapping blocks of the body (patches).",
            "Direct solvers work for every wall, as long as their factor fits in memory.",
        ],
    )


def show(page: Page, points: list[sweep.Point], turn: int, exponent: float) -> None:
    """Answer, limits, and the chart of iterations."""
    safe_multigrid, safe_direct = sweep.safe_by_multigrid(points), sweep.safe_by_factor(points)
    patches = [p.iterations["schwarz"].iterations for p in points]
    patch_error = max(p.iterations_error("schwarz") for p in points)
    torsion = max(error for p in points for error in p.torsion_errors)
    worst = max(points, key=lambda p: p.iterations_error("multigrid"))
    wrong = f"{worst.iterations_error('multigrid'):.1%} at {worst.value:g}"
    answer(page, points, patches, patch_error)
    page.say(
        f"Direct solvers are right to {torsion:.0e} in torsion at every wall: the condition "
        f"number grows as (R/t)^{exponent:.2f} only.",
    )
    parameter = f"radius over wall of a tube, {turn} elements round it"
    page.limit(
        sweep.MULTIGRID,
        parameter,
        high=safe_multigrid,
        criterion=f"energy error of 1e-9 within {trials.ITERATIONS} iterations",
        beyond=f"a true failure: error of the compliance {wrong}",
        program=sweep.MULTIGRID_FALLBACK,
        remedy=f"patches with a spectral coarse space: {min(patches)} to {max(patches)} iterations",
    )
    page.limit(
        "direct solvers in double precision",
        parameter,
        high=safe_direct,
        criterion="error of the compliance below 1e-4, refined",
        beyond=f"not reached: condition number {points[-1].condition:.0e} at {points[-1].value:g}",
        program="gives a bound of round-off with each answer, here at most "
        f"{max(p.answers['auto'].round_off for p in points):.0e}",
        remedy="none needed",
    )
    page.section("Iterations")
    sweep.show_iterations(page, points, AXIS, (None, safe_multigrid))
