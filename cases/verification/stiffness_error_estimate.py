"""Error of a stiffness estimated from one mesh, against its true error."""

from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import exact_blocks, rigid_ended_shafts
from fe_drivetrain.cases.verification.rigid_balance import check_balance
from fe_drivetrain.common import Floats
from fe_drivetrain.elasticity.mesh import ELEMENT_NAMES as NAMES
from fe_drivetrain.elasticity.solve import recovery_estimate
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, column, grouped

#: Hexahedra across the bars: linear elements need more of them.
DIVISIONS = {4: (4, 8), 8: (4, 8), 10: (2, 5), 20: (2, 4), 27: (2, 4)}
QUICK_DIVISIONS = {4: (4,), 8: (4,), 10: (2, 4), 20: (2,), 27: (2,)}

#: Bars, and where their energy comes from.
BARS = {
    "cantilever with shear": (
        exact_blocks.cantilever,
        "Timoshenko and Goodier 1970, Theory of Elasticity, art. 21",
    ),
    "twisted square bar": (
        exact_blocks.twisted,
        "Saint-Venant; Timoshenko and Goodier 1970, art. 109",
    ),
}

#: Element sizes [m] of the shafts, and elements round a turn.
MESHES = ((0.25, 10), (0.16, 14))
QUICK_MESHES = ((0.25, 10),)

#: Allowed factor between the estimated and the true error.
FACTOR = 3.0

RATIOS = "Estimated over true error of the stiffness"
TRUE, ESTIMATED, EFFECTIVITY = "true error [%]", "estimated [%]", "effectivity"
SHOWN = ("problem", "element", "unknowns", TRUE, ESTIMATED, EFFECTIVITY)
LINE, SHAPE, SOURCE = "line of the chart", "error of the shape", "source"


def record(
    problem: str, element: str, unknowns: int, error: float, estimate: float, **more: Any
) -> Record:
    """One mesh: the true and the estimated error, relative, and what is left out of the table."""
    return {
        "problem": problem,
        "element": element,
        "unknowns": unknowns,
        TRUE: 100 * error,
        ESTIMATED: 100 * estimate,
        EFFECTIVITY: estimate / error,
        **more,
    }


def estimate_bar(problem: str, nodes: int, across: int) -> Record:
    """A bar of which the energy is known."""
    solve, source = BARS[problem]
    bar = solve(nodes, across)
    found = recovery_estimate(bar.block.points, [(bar.block.cells, bar.lame)], bar.u)
    # forces given: too little energy, k too high; displacements given: too much
    ratio = bar.exact / bar.energy
    error = (ratio if problem.startswith("cantilever") else 1.0 / ratio) - 1.0
    more = {LINE: f"{problem}, {nodes} nodes", SOURCE: source}
    return record(problem, NAMES[nodes], bar.unknowns, error, found.relative, **more)


def estimate_shaft(run: Run, name: str, imbalances: list[float]) -> list[Record]:
    """A shaft between rigid ends, three loads on each mesh; adds to the solver's imbalances."""
    shaft = rigid_ended_shafts.SHAFTS[name]
    with run.step("reference of the shafts"):
        exact = rigid_ended_shafts.exact(shaft, 0.1, 10)
        rough = rigid_ended_shafts.exact(shaft, 0.1, 5)
    rows = []
    for size, turn in QUICK_MESHES if run.quick else MESHES:
        mesh = run.timed("meshes of the shafts", rigid_ended_shafts.meshed, shaft, size, turn)
        found = run.timed("shafts", rigid_ended_shafts.solved, mesh, shaft)
        imbalances.append(found.imbalance)
        for load, k in found.stiffness.items():
            # a uniform shaft in torsion: the polar moment is too low, and more of the error than
            # the elements' share
            uniform = name != "stepped, sharp" and load == "torsion"
            shape = rigid_ended_shafts.polar_moment_error(mesh, shaft) if uniform else 0.0
            rows.append(
                record(
                    f"{name} shaft, {load}" + ", less shape" * uniform,
                    "curved tetrahedra of 10 nodes",
                    found.unknowns,
                    k / exact[load] - 1.0 - shape,
                    found.estimate[load].relative,
                    **{
                        LINE: f"{name} shaft, {load}",
                        SHAPE: shape,
                        SOURCE: "the shaft's meridian in fourth-order elements, graded to its "
                        f"corners; uncertain by {abs(rough[load] / exact[load] - 1):.1g}",
                    },
                )
            )
    return rows


def answer(page: Page, found: Floats) -> None:
    """State how far estimates are from true errors: estimated over true error of each mesh."""
    least, most = float(found.min()), float(found.max())
    contains = "contains" if least >= 1.0 / FACTOR else "does not always contain"
    page.answer(
        "Can the error of a stiffness be estimated from one mesh?",
        f"On {len(found)} meshes the estimate is {formatted(least, 3)} to {formatted(most, 3)} "
        f"times the true error: a band of {FACTOR:g} times the estimate {contains} the true value.",
        [
            page.value("smallest estimate over true error", least, at_least=1.0 / FACTOR),
            page.value("largest estimate over true error", most, at_most=FACTOR),
            page.value("median of estimate over true error", float(np.median(found))),
            page.value("meshes compared", len(found)),
        ],
        hero=RATIOS,
        cautions=[
            "The estimate does not see the error of the shape, as by too few elements round the "
            "circumference."
        ],
    )


@case(
    "Error of a stiffness estimated from one mesh: effectivity on exact cases",
    source="Zienkiewicz and Zhu 1987, Int. J. Numer. Meth. Eng. 24, 337-357, and 1992, ibid. 33, "
    "1331-1364; Timoshenko and Goodier 1970, Theory of Elasticity",
)
def run(run: Run, page: Page) -> None:
    """Estimate the errors of bars and shafts, and compare."""
    with run.step("bars"):
        rows = [
            estimate_bar(problem, nodes, across)
            for problem in BARS
            for nodes, series in (QUICK_DIVISIONS if run.quick else DIVISIONS).items()
            for across in series
        ]
    imbalances: list[float] = []
    for name in rigid_ended_shafts.SHAFTS:
        if not (run.quick and name == "bored"):
            rows += estimate_shaft(run, name, imbalances)
    for row in rows:
        page.between(
            f"{row['problem']}, {row['element']}, {row['unknowns']:,} unknowns: estimated over "
            "true error",
            row[EFFECTIVITY],
            1.0 / FACTOR,
            FACTOR,
            why="an estimate is of use where it is right within a factor of three: that is the "
            "factor on it that makes a band",
            source=row[SOURCE],
        )
    check_balance(page, imbalances)
    found = np.array(column(rows, EFFECTIVITY))
    answer(page, found)
    page.say(
        "The meshes are of bars in five elements with smooth solutions, and of shafts between "
        "rigid ends, whose stress is singular at the ends and at the step."
    )
    page.section("Effectivity")
    page.chart(
        RATIOS,
        [
            trace(name, column(of, "unknowns"), column(of, EFFECTIVITY), mode="lines+markers")
            for name, of in grouped(rows, LINE)
        ],
        "unknowns",
        EFFECTIVITY,
        ("x", "y"),
    )
    page.table("Error of the stiffness, which is too high, and its estimate", rows, SHOWN)
    show_shape(page, rows)
    page.image(
        "The shaft with a sharp step", run.sketch(rigid_ended_shafts.SHAFTS["stepped, sharp"])
    )
    page.data("effectivity", found)


def show_shape(page: Page, rows: list[Record]) -> None:
    """Errors of the polar moment, which estimates from stresses do not see."""
    page.section("What the estimate does not see")
    page.text(
        "Torsion of a shaft of uniform section moves points by products of two coordinates, which "
        "straight quadratic elements contain and curved ones nearly do. As large as what these "
        "miss is the error of the shape: the polar moment of the section as it is meshed. An "
        "estimate from stresses does not see that; the mesh's own moments do, and more elements "
        "round a turn reduce it. The effectivity above is that of the rest."
    )
    page.table(
        "Uniform shafts in torsion, curved tetrahedra: errors in parts per million",
        [
            {
                "shaft": row[LINE].replace(" shaft,", ","),
                "unknowns": row["unknowns"],
                "error of the stiffness": 1e4 * row[TRUE] + 1e6 * row[SHAPE],
                "error of the meshed polar moment": 1e6 * row[SHAPE],
                "the rest": 1e4 * row[TRUE],
                "estimated error": 1e4 * row[ESTIMATED],
            }
            for row in rows
            if row.get(SHAPE)
        ],
    )
