"""Slivers driven flat, and through to the other side: the condition, the solvers, the answer."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import slivers
from fe_drivetrain.common import Bools, Floats
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.elasticity.mesh import FLATTEST, find_faults, flatness
from fe_drivetrain.elasticity.solve import MAX_ITERATIONS
from fe_drivetrain.report import crosses, marked
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, column

#: Heights of the slivers, in cubes.
HEIGHTS = (0.5, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-14)
QUICK_HEIGHTS = (0.5, 1e-2, 1e-4, 1e-6, 1e-8, 1e-11, 1e-14)
#: Flat, and inside out.
BEYOND = (0.0, -1e-4, -1e-2, -0.1, -0.3)
ACROSS, QUICK_ACROSS = 4, 2

#: Six digits of a stiffness are more than any use of it needs.
CRITERION = 1e-6

REMEDIED = (
    "bending stiffness after gmsh has taken the slivers out, worst of all heights, over the exact "
    "one, less one"
)
ERRORS = (
    "Error of the stiffness of a bar with a layer of slivers over their flatness: round-off grows "
    "until nothing is left; shaded: six digits"
)
FLATNESS = "least height over longest edge of the flattest element [-]"
EPSILON = float(np.finfo(float).eps)


def flattened(run: Run, height: float, across: int) -> Record:
    """A bar with slivers of this height: solved as it is, and after gmsh has taken them out."""
    with run.step("bars with slivers"):
        mesh = slivers.bar(height, across)
        direct = slivers.bent(mesh, "superlu", condition=True)
        multigrid = slivers.bent(mesh, "multigrid")
        linear = slivers.bent(slivers.bar(height, across, 4), "superlu")
        is_refused = bool(find_faults(mesh))
    with run.step("optimised by gmsh"):
        optimised = slivers.bent(slivers.optimised(mesh), "multigrid")
    return {
        "height / cube": height,
        "flatness": float(flatness(mesh.points, mesh.cells).min()),
        "condition number": direct.condition,
        "error of bending, direct": direct.bending,
        "iterations, multigrid": multigrid.iterations,
        "answered by": multigrid.solver[:60],
        "refused by the check": is_refused,
        "iterations, optimised": optimised.iterations,
        "error, optimised": optimised.bending,
        "error of bending, multigrid": multigrid.bending,
        "error of shear, direct": direct.shear,
        "error of shear, 4 nodes": linear.shear,
    }


def inside_out(height: float, across: int) -> Record:
    """A bar with slivers of no height, or inside out: without the check, and what it reports."""
    mesh = slivers.bar(height, across)
    found = slivers.bent(mesh, "multigrid")
    faults = find_faults(mesh)
    return {
        "height / cube": height,
        "flatness": float(flatness(mesh.points, mesh.cells).min()),
        "error of bending": found.bending,
        "error of shear": found.shear,
        "answered by": found.solver[:60],
        "the check": faults[0].sentence if faults else "nothing found",
        "refused": bool(faults),
    }


@case(
    "Sliver elements driven flat: condition, iterations, error, and what takes them out",
    source="Shewchuk 2002, What is a good linear finite element?; Timoshenko and Goodier 1970, "
    "Theory of Elasticity, art. 21",
)
def run(run: Run, page: Page) -> None:
    """Bend a bar with a layer of slivers."""
    across = QUICK_ACROSS if run.quick else ACROSS
    heights = QUICK_HEIGHTS if run.quick else HEIGHTS
    rows = [flattened(run, height, across) for height in heights]
    with run.step("flat and inside out"):
        beyond = [inside_out(height, across) for height in BEYOND]
    exponent = check_condition(page, rows)
    check_protection(page, rows, beyond)
    check_remedy(page, rows)
    state_limits(page, rows, beyond, exponent)
    show_answer(page, rows)
    show_solvers(page, rows)
    page.section("Through to the other side")
    page.table(
        "Slivers of no height, and inside out: what multigrid reports without the check, and what "
        "the check reports",
        [{k: None if v != v else v for k, v in row.items() if k != "refused"} for row in beyond],
    )
    page.image("The bar with a layer of flat elements", run.sketch(slivers.bar(0.1, across)))
    page.data("flatness", column(rows, "flatness"))
    page.data("condition", column(rows, "condition number"))


def array(rows: list[Record], name: str) -> Floats:
    """One key of all heights."""
    return np.array(column(rows, name))


def is_wrong(rows: list[Record]) -> Bools:
    """Where a direct solver has an error above the criterion, or no answer."""
    return ~(np.abs(array(rows, "error of bending, direct")) < CRITERION)


def gives_up(rows: list[Record]) -> Bools:
    """Where multigrid does not answer by itself."""
    return np.array([row["answered by"] != "multigrid" for row in rows])


def safe_to(rows: list[Record], failed: Bools) -> float | None:
    """Flatness of the last bar before the first that fails, from the roundest on; None: of all."""
    x = array(rows, "flatness")
    return float(x[: int(failed.argmax())].min()) if failed.any() else None


def check_condition(page: Page, rows: list[Record]) -> float:
    """How the condition number grows; its exponent."""
    x, condition = array(rows, "flatness"), array(rows, "condition number")
    usable = (x < 1e-2) & (condition < 1e14)
    exponent = page.exponent(
        "order of the condition number in the flatness of the slivers",
        x[usable],
        condition[usable],
        -1.0,
        within=0.1,
        relative=False,
        why="a tenth for the share of the sound elements at the round end",
        source="the volume of a sliver is as its height, its squared gradients as the height to "
        "the power of -2: its stiffness, and with it the largest eigenvalue (which Shewchuk 2002 "
        "treats in general; read in its abstract), as one over the height",
    )
    return exponent


def check_protection(page: Page, rows: list[Record], beyond: list[Record]) -> None:
    """What is solved wrong is refused, and nothing else."""
    wrong, refused = is_wrong(rows), np.array(column(rows, "refused by the check"), dtype=bool)
    page.holds(
        "the sweep goes on until the answer is wrong: flattest bar that is solved wrong or not at "
        "all",
        bool(wrong[-1]),
        why="a sweep that never fails finds no limit",
        source="round-off times the condition number reaches one",
    )
    page.vanishes(
        "bars that are solved wrong, flat or inside out, and that the check of the mesh accepts",
        int(np.count_nonzero(wrong & ~refused)) + column(beyond, "refused").count(False),
        within=0.0,
        why="a wrong stiffness looks like any other",
        source="fe_drivetrain.elasticity.mesh.checks",
    )
    page.vanishes(
        f"bars with slivers less flat than {FLATTEST:g} that the check refuses",
        int(np.count_nonzero(refused & (array(rows, "flatness") >= FLATTEST))),
        within=0.0,
        why="what is solved right must not be refused",
        source="fe_drivetrain.elasticity.mesh.checks",
    )


def check_remedy(page: Page, rows: list[Record]) -> None:
    """Without the slivers the bar is solved as any other."""
    page.vanishes(
        REMEDIED,
        np.abs(array(rows, "error, optimised")).max(),
        within=1e-8,
        why="quadratic elements hold the solution; iterations end at an energy error of 1e-9 and "
        "round-off is below",
        source="Euler-Bernoulli, exact without lateral contraction",
        measure="stiffness",
    )
    page.equals(
        "most iterations of multigrid after that, over those of the bar with the roundest slivers",
        max(column(rows, "iterations, optimised")) / rows[0]["iterations, multigrid"],
        1.0,
        within=0.25,
        why="meshes of one size and about one shape: a quarter more or less",
        source="this sweep",
    )


def answer(page: Page, rows: list[Record], inside_out: float) -> None:
    """State how flat slivers may be, and the worst error of bending with some inside out."""
    last = float(rows[-1]["flatness"])
    safe, steps = (safe_to(rows, failed) for failed in (is_wrong(rows), gives_up(rows)))
    digits, alone = (formatted(last if at is None else at, 1, "") for at in (safe, steps))
    ends = {
        "least flatness with stiffness correct to six digits": safe,
        "least flatness with which multigrid converges": steps,
    }
    page.answer(
        "How flat may the elements of a mesh be?",
        f"Stiffness is correct to six digits down to a flatness of {digits}; multigrid alone fails "
        f"below {alone}; the program rejects meshes below {formatted(FLATTEST, 2, '')}.",
        [
            *(page.value(name, rounded([at], 1)[0]) for name, at in ends.items() if at is not None),
            page.value("flatness below which the program rejects a mesh", FLATTEST),
            page.value(
                "worst error of bending with elements inside out [%]", 100 * abs(inside_out)
            ),
            page.judged(
                REMEDIED, "relative error of bending once flat elements are removed", "exact"
            ),
        ],
        hero=ERRORS,
        cautions=[
            "Flatness is the least height of an element over its longest edge; where multigrid "
            "fails, a direct solver takes over.",
            "Elements that are inside out do not show in the solution: the program rejects them.",
        ],
    )


def state_limits(page: Page, rows: list[Record], beyond: list[Record], exponent: float) -> None:
    """Answer and limits."""

    safe, safe_steps = safe_to(rows, is_wrong(rows)), safe_to(rows, gives_up(rows))
    most = max(column(rows, "iterations, optimised"))
    remaining = f"{np.abs(array(rows, 'error, optimised')).max():.1e}"
    worst = beyond[int(np.argmax(np.nan_to_num(np.abs(array(beyond, "error of bending")))))]
    answer(page, rows, worst["error of bending"])
    page.say(
        "One layer of slivers makes the condition number grow as their flatness to the power "
        f"{exponent:.2f}. gmsh takes the slivers out: then at most {most} iterations, and "
        f"{remaining} of error.",
        "Elements turned inside out give no sign of themselves: at a height of "
        f"{worst['height / cube']:g} the solver converges and the error of the bending stiffness "
        f"is {worst['error of bending']:.1e}. Only the check of the Jacobian finds them.",
    )
    page.limit(
        "stiffness from a mesh with slivers, direct solver",
        FLATNESS,
        low=safe,
        criterion=f"error of round-off below {CRITERION:g}",
        beyond="digits are lost as 1 / flatness; at 1e-14 the matrix is singular; inside out a "
        "wrong answer without any sign",
        program=f"refuses below {FLATTEST:g}, and anything inside out, with element and place",
        remedy=f"optimisation by gmsh: error {remaining}",
    )
    page.limit(
        "multigrid on a mesh with slivers",
        FLATNESS,
        low=safe_steps,
        criterion=f"converged within {MAX_ITERATIONS} iterations",
        beyond="the iteration stalls: nodes of a sliver move together more slowly than the "
        "smoother sees",
        program="stops early, and a direct solver answers, with the reason",
        remedy=f"optimisation by gmsh: at most {most} iterations",
    )


def show_answer(page: Page, rows: list[Record]) -> None:
    """Errors over the flatness."""
    x = array(rows, "flatness")
    bending, shear = "10 nodes, bending (held exactly)", "error of shear"
    errors = {
        f"direct, {bending}": "error of bending, direct",
        "multigrid, the same": "error of bending, multigrid",
        "direct, 10 nodes, shear": f"{shear}, direct",
        "direct, 4 nodes, shear": f"{shear}, 4 nodes",
        "slivers taken out, bending": "error, optimised",
    }
    failed = x[~np.isfinite(array(rows, "error of bending, multigrid"))]
    page.section("The answer")
    page.chart(
        ERRORS,
        [
            *(
                marked(name, x, np.maximum(np.abs(array(rows, key)), EPSILON))
                for name, key in errors.items()
            ),
            crosses("no answer", failed),
        ],
        FLATNESS.removesuffix(" [-]"),
        "relative error of the stiffness",
        "xy",
        (safe_to(rows, is_wrong(rows)), None),
    )
    page.text(
        "Bending by couples is held exactly by quadratic elements with straight edges, slivers or "
        "not, so that its error is the solver's alone. Shear shows that the slivers cost little "
        "accuracy as elements: the layer is thin, and what it forbids, warping of the squares, "
        "matters little beside the elements' own error."
    )


def show_solvers(page: Page, rows: list[Record]) -> None:
    """Condition and iterations over the flatness, and the table."""
    x, alone = array(rows, "flatness"), gives_up(rows)
    steps, condition = array(rows, "iterations, multigrid"), array(rows, "condition number")
    page.section("The solvers")
    page.chart(
        "Condition number and iterations. Multigrid stops early where it cannot converge, and a "
        "direct solver answers",
        [
            marked("condition number over 1e6", x, condition / 1e6),
            marked("iterations of multigrid", x[~alone], steps[~alone]),
            crosses(
                "multigrid gives up, a direct solver answers",
                x[alone],
                np.full(int(alone.sum()), MAX_ITERATIONS),
            ),
            marked(
                "iterations after the slivers are taken out",
                x,
                array(rows, "iterations, optimised"),
            ),
        ],
        FLATNESS.removesuffix(" [-]"),
        "iterations; condition number / 1e6",
        "xy",
        (safe_to(rows, alone), None),
    )
    page.table("Slivers driven flat", rows, list(rows[0])[:9])
