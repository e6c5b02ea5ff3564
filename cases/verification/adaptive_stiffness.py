"""Bending stiffness of a shaft with a sharp step: meshes refined by their indicators, and uniform
ones.
"""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import rigid_ended_shafts
from fe_drivetrain.cases.verification.adaptivity import marked, refined_sizes
from fe_drivetrain.cases.verification.rigid_balance import check_balance
from fe_drivetrain.common import Floats
from fe_drivetrain.geometry import Shaft
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, column, grouped

SHAFT = "stepped, sharp"
LOAD = "bending"

#: Element sizes [m] of uniform meshes, coarse first, and as many elements a turn as are that large.
UNIFORM = ((0.19, 10), (0.135, 14), (0.1, 19), (0.073, 26))
QUICK_UNIFORM = ((0.19, 10), (0.11, 17))
#: Where refinement starts. So many elements a turn keep the error of the shape far below that of
#: the step on all meshes here.
START = (0.25, 14)
STEPS, QUICK_STEPS = 4, 1
#: Refinement ends at so many unknowns.
MAXIMUM = 60_000

ERRORS = "Error of the bending stiffness, true and as estimated on each mesh"


@dataclass(frozen=True)
class Rates:
    """Error [%] of the finest comparable adaptive mesh, that of a uniform one as large, slopes."""

    unknowns: int
    error: float
    uniform_error: float
    slope: dict[str, float]


def record(kind: str, solved: rigid_ended_shafts.Solved, exact: float, marks: int) -> Record:
    """One mesh: its stiffness, its true error and the estimated one."""
    k, estimate = solved.stiffness[LOAD], solved.estimate[LOAD]
    return {
        "meshes": kind,
        "elements": len(solved.mesh.cells),
        "marked": marks,
        "unknowns": solved.unknowns,
        "stiffness [MN m/rad]": k / 1e6,
        "± stiffness [MN m/rad]": estimate.band(k) / 1e6,
        "true error [%]": 100 * (k / exact - 1.0),
        "estimated error [%]": 100 * estimate.relative,
        "error with the estimate taken out [%]": 100 * (estimate.improved(k) / exact - 1.0),
    }


def solve_all(
    run: Run, shaft: Shaft, exact: float
) -> tuple[list[Record], list[float], rigid_ended_shafts.Solved]:
    """Rows and imbalances of uniform meshes, then of refined ones, and the last of these."""
    rows: list[Record] = []
    imbalances = []
    for size, turn in QUICK_UNIFORM if run.quick else UNIFORM:
        mesh = run.timed("uniform meshes", rigid_ended_shafts.meshed, shaft, size, turn)
        with run.step("uniform: solve and estimate"):
            solved = rigid_ended_shafts.solved(mesh, shaft, (LOAD,))
        rows.append(record("uniform", solved, exact, 0))
        imbalances.append(solved.imbalance)
    local = None
    for _ in range(1 + (QUICK_STEPS if run.quick else STEPS)):
        mesh = run.timed("adaptive meshes", rigid_ended_shafts.meshed, shaft, *START, local)
        with run.step("adaptive: solve and estimate"):
            solved = rigid_ended_shafts.solved(mesh, shaft, (LOAD,))
            cells = marked(solved.estimate[LOAD].indicators)
            local = refined_sizes(mesh, cells)
        rows.append(record("adaptive", solved, exact, len(cells)))
        imbalances.append(solved.imbalance)
        error = rows[-1]["true error [%]"] / 100
        run.report(f"adaptive: {solved.unknowns:,} unknowns, error {error:.2g}")
        if solved.unknowns > MAXIMUM:
            break
    return rows, imbalances, solved


def error_curves(rows: list[Record]) -> dict[str, Floats]:
    """(2, n) unknowns and true errors [%] by kind of mesh."""
    return {
        kind: np.array([column(series, "unknowns"), column(series, "true error [%]")])
        for kind, series in grouped(rows, "meshes")
    }


def convergence_rates(curves: dict[str, Floats]) -> Rates:
    """Adaptive meshes beside uniform ones of as many unknowns."""
    uniform, adaptive = curves["uniform"], curves["adaptive"]
    last = int(np.flatnonzero(adaptive[0] <= uniform[0, -1]).max())
    unknowns, error = int(adaptive[0, last]), adaptive[1, last]
    same = float(np.exp(np.interp(np.log(unknowns), *np.log(uniform))))
    slope = {
        kind: np.polyfit(np.log(curve[0]), np.log(curve[1]), 1)[0] for kind, curve in curves.items()
    }
    return Rates(unknowns, float(error), same, slope)


@case(
    "Adaptive and uniform refinement: bending stiffness of a shaft with a sharp step",
    source="Doerfler 1996, SIAM J. Numer. Anal. 33, 1106-1124; Zienkiewicz and Zhu 1992, Int. J. "
    "Numer. Meth. Eng. 33, 1331-1364; reference from the shaft's meridian",
)
def run(run: Run, page: Page) -> None:
    """Refine step by step, and compare with uniform meshes."""
    shaft = rigid_ended_shafts.SHAFTS[SHAFT]
    with run.step("reference"):
        exact = rigid_ended_shafts.exact(shaft, 0.1, 10)[LOAD]
        rough = rigid_ended_shafts.exact(shaft, 0.1, 5)[LOAD]
    rows, imbalances, finest = solve_all(run, shaft, exact)
    curves = error_curves(rows)
    rates = convergence_rates(curves)
    check_balance(page, imbalances)
    check(page, finest, rates, exact, doubt=abs(rough / exact - 1))
    answer(page, finest, rates, exact)
    show(page, rows, curves)
    page.image("The shaft with a sharp step", run.sketch(shaft))
    page.data("meshes", rows)


def answer(page: Page, finest: rigid_ended_shafts.Solved, rates: Rates, exact: float) -> None:
    """State what refinement by indicators gains over uniform meshes of as many unknowns."""
    k, better = finest.stiffness[LOAD], rates.error < rates.uniform_error
    page.answer(
        "Does refining where the estimated error is large beat uniform meshes at a sharp step?",
        f"{'Yes' if better else 'No'}: with {formatted(rates.unknowns)} unknowns the bending "
        f"stiffness errs by {rates.error:.2g} % on the refined mesh and by "
        f"{rates.uniform_error:.2g} % on a uniform one.",
        [
            page.value(
                f"error, refined mesh of {formatted(rates.unknowns)} unknowns [%]",
                rates.error,
                at_most=rates.uniform_error,
                by="uniform mesh of as many",
            ),
            page.value("exponent of error over unknowns, refined", rates.slope["adaptive"]),
            page.value("exponent of error over unknowns, uniform", rates.slope["uniform"]),
            page.value(
                "bending stiffness, last refined mesh [MN m/rad]",
                k / 1e6,
                finest.estimate[LOAD].band(k) / 1e6,
                beside=exact / 1e6,
                by="meridian",
            ),
        ],
        hero=ERRORS,
        cautions=["The gain is that at a sharp step, which slows uniform meshes down."],
    )


def check(
    page: Page, finest: rigid_ended_shafts.Solved, rates: Rates, exact: float, doubt: float
) -> None:
    """Adaptive meshes beat uniform ones, and the last one's band covers its error."""
    page.at_most(
        f"error of the adaptive mesh of {rates.unknowns:,} unknowns over that of a uniform one "
        "of as many",
        rates.error / rates.uniform_error,
        1.0,
        why="refinement that does not beat uniform meshes is not worth its solves",
        source="uniform meshes of this case, between two of them on logarithmic scales",
    )
    k, estimate = finest.stiffness[LOAD], finest.estimate[LOAD]
    page.equals(
        "bending stiffness on the last adaptive mesh [N m/rad]",
        k,
        exact,
        within=estimate.band(k) / exact,
        why="the band, three times the error estimated on that one mesh: the check is of the "
        "estimate, which must cover the true error",
        source="the shaft's meridian in fourth-order elements, graded to its corners; "
        f"uncertain by {doubt:.1g}",
        basis="self-consistency",
        band=estimate.band(k),
    )


def show(page: Page, rows: list[Record], curves: dict[str, Floats]) -> None:
    """Errors against unknowns."""
    page.section("Error against unknowns")
    page.chart(
        ERRORS,
        [trace(kind, *curve, mode="lines+markers") for kind, curve in curves.items()]
        + [
            trace(
                f"{kind}, estimated",
                column(series, "unknowns"),
                column(series, "estimated error [%]"),
                mode="lines+markers",
                line={"dash": "dot"},
            )
            for kind, series in grouped(rows, "meshes")
        ],
        "unknowns",
        "error [%]",
        ("x", "y"),
    )
    page.table(
        "Meshes of curved tetrahedra; marked cells hold half of the estimated error and are "
        "halved in size on the next mesh",
        rows,
    )
    page.text(
        "Each mesh is generated again from the shape, with sizes from the one before, so that its "
        "curved surfaces are as exact as it is fine."
    )
