"""Ties of flat faces, meshes up to twenty times apart: patch test, reactions, stress, fill."""

from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.stability.tied_strips import TIES, strip, tied_strip
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import fitted_exponent, last_within
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, column

#: Elements across the coarser side, and how many times as many across the finer.
COARSE = 2
RATIOS = (1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0)
QUICK_RATIOS = (1.0, 2.0, 5.0, 20.0)
SIDES = ("finer", "coarser")
MORTAR = ("standard", "dual")

ERROR = 0.05  # of the stress, that is accepted
#: Machine precision times the condition of strips 40 elements across, each 20 times as long as
#: wide, squared as for any second-order operator, and ten for what is not counted.
ROUND_OFF = 10 * 2.2e-16 * (40 * 20) ** 2
CONDITION = f"round-off times the condition of the finest strip: {ROUND_OFF:.1e}"

BENDING = (
    "Spurious stress in pure bending over the mesh ratio: dual multipliers fail with a coarser "
    f"slave; shaded: these within {100 * ERROR:g} %"
)
RATIO = "elements of the finer side to one of the coarser"
COARSE_SLAVE = "warns of a slave with less than half of the master's nodes to an area"


def solve(ratio: float, side: str, tie: str) -> Record:
    """A strip whose slave is so many times finer, or coarser, than its master."""
    fine = round(COARSE * ratio)
    own, other = (fine, COARSE) if side == "finer" else (COARSE, fine)
    strip = tied_strip(own, other, tie)
    return {
        "ratio": ratio,
        "slave": side,
        "tie": tie,
        "patch": strip.patch,
        "bending": strip.bending,
        "reaction": strip.reaction,
        "entries": strip.entries,
        "nodes of the master": strip.master,
        "warned": strip.warned,
    }


def series(rows: list[Record], tie: str, side: str, what: str) -> Floats:
    """One quantity over the ratios."""
    found = [row[what] for row in rows if row["tie"] == tie and row["slave"] == side]
    return np.array(found, dtype=float)


def largest(rows: list[Record], what: str, *ties: str) -> float:
    """The worst of some ties, all ratios and both sides."""
    return float(max(row[what] for row in rows if row["tie"] in ties))


@case(
    "Ties of flat faces with meshes up to twenty times apart: either side the slave",
    source="constant stress and pure bending, which the elements hold exactly; Puso 2004, Int. J. "
    "Numer. Meth. Engng 59, 315; Wohlmuth 2000, SIAM J. Numer. Anal. 38, 989",
)
def run(run: Run, page: Page) -> None:
    """Each tie at each ratio, either side the slave."""
    rows: list[Record] = []
    with run.step("tied strips"):
        for ratio in QUICK_RATIOS if run.quick else RATIOS:
            for side in SIDES:
                for tie in TIES:
                    run.report(f"{ratio:g} to 1, slave {side}, {tie}")
                    rows.append(solve(ratio, side, tie))
        matching = tied_strip(COARSE, COARSE, "node by node", grading=1.0)
    check_identities(page, rows, matching.patch)
    check_failures(page, rows)
    show(page, rows)
    page.image("The strip at one to four", run.sketch(strip(COARSE, 4 * COARSE)))
    page.data("all strips", rows)


def check_identities(page: Page, rows: list[Record], matching: float) -> None:
    """Stresses that ties have to pass to round-off."""
    for tie in MORTAR:
        page.vanishes(
            f"patch test, {tie} multipliers: largest error of all ratios, either side the slave",
            largest(rows, "patch", tie),
            within=ROUND_OFF,
            why=CONDITION,
            source="constant stress (Irons and Razzaque 1972); the multipliers sum to one",
        )
    page.vanishes(
        "remedy: standard multipliers in pure bending, largest error of the stress, either side "
        "the slave",
        largest(rows, "bending", "standard"),
        within=ROUND_OFF,
        why=CONDITION,
        source="linear tractions are among the multipliers, quadratic displacements among the "
        "elements'",
    )
    page.vanishes(
        "reactions: force and moment that ties fail to pass on, of the end's, worst of all",
        largest(rows, "reaction", *TIES),
        within=1e-12,
        why="round-off of a sum of a few hundred forces",
        source="on flat faces every tie holds for rigid motions, so its forces balance",
    )
    page.vanishes(
        "node by node, nodes that match: patch test",
        matching,
        within=ROUND_OFF,
        why=CONDITION,
        source="nodes that match are the same as shared ones",
    )


def check_failures(page: Page, rows: list[Record]) -> None:
    """Where ties fail, and whether the program warns."""
    ratios = sorted({row["ratio"] for row in rows})
    page.equals(
        "failure: node by node, patch test, ratios over one with an error of more than "
        f"{100 * ERROR:g} %, slave coarser",
        (series(rows, "node by node", "coarser", "patch")[1:] > ERROR).sum(),
        len(ratios) - 1,
        within=0.0,
        why="the forces arrive at the wrong nodes at every ratio, so none can pass",
        source="forces arrive at the nodes opposite to the slave's, not spread as the traction is",
        measure="identity",
    )
    exponent, band = fitted_exponent(ratios[1:], series(rows, "dual", "finer", "bending")[1:])
    page.at_least(
        "dual multipliers, slave finer: order of the error of bending in the slave's elements",
        -exponent,
        0.9,
        why="first order is that of the limit, less a tenth: between the few coarsest meshes the "
        "next order still has a share",
        source="they hold constant tractions only: a linear one to first order in the slave's "
        "elements",
        measure="order",
        band=band,
    )
    last = next(r for r in reversed(rows) if (r["tie"], r["slave"]) == ("standard", "coarser"))
    master = last["nodes of the master"]
    page.at_least(
        f"failure: entries of the stiffness at {ratios[-1]:g} to 1, slave coarser, against those "
        "of a full block of the master's degrees of freedom",
        last["entries"],
        (3 * master) ** 2,
        why="the block is part of the stiffness, whatever else couples",
        source=f"the slave follows every node of the master: (3 x {master})^2 = "
        f"{(3 * master) ** 2:,}",
        measure="identity",
    )
    dual = [row for row in rows if row["tie"] == "dual"]
    page.vanishes(
        "protection: ratios and sides at which dual multipliers have an error of more than "
        f"{100 * ERROR:g} % and no warning came",
        sum(row["bending"] > ERROR and not row["warned"] for row in dual),
        within=0.0,
        why="a spurious stress looks like any other",
        source="`mortar.mortar_tie` " + COARSE_SLAVE,
    )
    page.vanishes(
        "protection: warnings where the slave is the finer",
        sum(row["warned"] for row in dual if row["slave"] == "finer"),
        within=0.0,
        why="the finer slave is the right choice",
        source="a warning of what is right would teach to ignore it",
    )


def answer(page: Page, rows: list[Record], dual_high: float | None) -> None:
    """State the ratios at which ties hold; `dual_high` is that of dual multipliers in bending."""
    ratio = max(row["ratio"] for row in rows)
    coarser, finer = (series(rows, "dual", side, "bending") for side in ("coarser", "finer"))
    node = series(rows, "node by node", "coarser", "patch")
    patch = largest(rows, "patch", *MORTAR)
    kept = formatted(100 * finer.max())
    missed = sum(
        row["bending"] > ERROR and not row["warned"] for row in rows if row["tie"] == "dual"
    )
    figures = [
        page.value(
            "worst bending stress error, dual mortar ties, coarser slave [%]", 100 * coarser.max()
        ),
        page.value(
            "worst bending stress error, dual mortar ties, finer slave [%]",
            100 * finer.max(),
            at_most=100 * ERROR,
        ),
        page.value("worst error of constant stress, ties node by node [%]", 100 * node.max()),
        page.value("worst error of constant stress, mortar ties", patch, at_most=ROUND_OFF),
        page.value(f"errors above {100 * ERROR:g} % without a warning", missed, at_most=0.0),
    ]
    if dual_high is not None:
        name = f"mesh ratio for {100 * ERROR:g} % in bending, dual mortar ties, coarser slave"
        figures.insert(0, page.value(name, dual_high))
    page.answer(
        "How different may the element sizes of two tied flat faces be?",
        f"Dual mortar ties keep bending stress within {kept}\u00a0% up to element sizes "
        f"{ratio:g}\u00a0:\u00a01 if the finer face is the slave; otherwise "
        + (
            f"{100 * ERROR:g}\u00a0% only to {formatted(dual_high)}\u00a0:\u00a01."
            if dual_high is not None
            else f"never within {100 * ERROR:g}\u00a0%."
        ),
        figures,
        hero=BENDING,
        cautions=[
            "Make the finer face the slave: every mortar tie is then right, and the stiffness "
            "matrix stays sparse.",
            "Do not tie node by node: even constant stress is right only where the nodes match, "
            f"and wrong by up to {100 * node.max():.0f}\u00a0% elsewhere.",
        ],
    )


def show(page: Page, rows: list[Record]) -> None:
    """Answer, limits, charts and table."""
    ratios = np.array(sorted({row["ratio"] for row in rows}))
    entries = {side: series(rows, "standard", side, "entries") for side in SIDES}
    dual_high = last_within(ratios, series(rows, "dual", "coarser", "bending"), ERROR)
    answer(page, rows, dual_high)
    page.say(
        "With standard multipliers linear stress passes as well, either side the slave.",
        f"A coarse slave fills the stiffness: {entries['coarser'][-1] / entries['finer'][-1]:.1f} "
        f"times the entries at {ratios[-1]:g} to 1 on a strip, and the square of the face's nodes "
        "in general.",
    )
    state_limits(page, rows)
    show_stress(page, rows, dual_high)
    show_fill(page, rows, ratios)


def state_limits(page: Page, rows: list[Record]) -> None:
    """State the ratios up to which each tie passes constant and linear stress."""
    ratios = np.array(sorted({row["ratio"] for row in rows}))
    dual = series(rows, "dual", "coarser", "bending")
    page.limit(
        "mortar tie of flat faces, standard multipliers",
        RATIO,
        criterion="constant and linear stress to round-off, either side the slave",
        beyond=f"no error up to {ratios[-1]:g}; a coarser slave fills the stiffness with the "
        "square of the master's degrees of freedom",
        program=COARSE_SLAVE,
        remedy="the finer face as the slave",
    )
    page.limit(
        "mortar tie of flat faces, dual multipliers, slave coarser",
        RATIO,
        high=last_within(ratios, dual, ERROR),
        criterion=f"linear stress within {100 * ERROR:g} %",
        beyond=f"spurious stress beside the tie, up to {100 * dual.max():.2g} % of the largest",
        program=COARSE_SLAVE,
        remedy="the finer face as the slave, or standard multipliers",
    )
    for side in SIDES:
        errors = series(rows, "node by node", side, "patch")
        low, high = range_within(ratios, errors)
        page.limit(
            f"tie node by node of flat faces, slave {side}",
            f"{RATIO}; at 1 nodes that match",
            low=low,
            high=high,
            criterion=f"constant stress within {100 * ERROR:g} %",
            beyond=f"constant stress in error by up to {100 * errors.max():.3g} %",
            program="warns of a slave that is the coarser"
            if side == "coarser"
            else "nothing, but its documentation states that constant stress does not pass",
            remedy="mortar tie",
        )


def show_stress(page: Page, rows: list[Record], dual_high: float | None) -> None:
    """Show the errors of constant and of linear stress."""
    page.section("Stress")
    page.chart(
        "Patch test: largest error of a constant stress. Mortar ties pass to round-off, ties node "
        "by node fail, worst where the slave is the coarser",
        curves(rows, "patch", TIES),
        RATIO,
        "error of the stress",
        "xy",
        (None, None),
    )
    page.chart(
        BENDING,
        curves(rows, "bending", TIES),
        RATIO,
        "largest error over largest stress",
        "xy",
        (None, dual_high),
    )
    page.text(
        "Both states are among the displacements of the elements, so that all error is the tie's. "
        "The slave's divisions are graded, so that the meshes do not nest where both have the same "
        "number."
    )


def show_fill(page: Page, rows: list[Record], ratios: Floats) -> None:
    """Show the entries of the stiffness, and all numbers."""
    page.section("Fill")
    block = (3 * series(rows, "standard", "coarser", "nodes of the master")) ** 2
    full = trace(
        "full block of the master's degrees of freedom", ratios, block, line={"dash": "dot"}
    )
    page.chart(
        "Entries of the stiffness that is factorised: a coarse slave couples all nodes of the "
        "master's face",
        [*curves(rows, "entries", MORTAR), full],
        RATIO,
        "entries",
        "xy",
    )
    page.table(
        "Errors of constant and of linear stress, and entries",
        rows,
        [n for n in rows[0] if n != "reaction"],
    )


def curves(rows: list[Record], what: str, ties: tuple[str, ...]) -> list[Any]:
    """One quantity over the ratios, by tie and side."""
    ratios = sorted(set(column(rows, "ratio")))
    return [
        trace(
            f"{tie}, slave {side}",
            ratios,
            np.maximum(series(rows, tie, side, what), 1e-16),
            mode="lines+markers",
            line={} if side == "finer" else {"dash": "dash"},
        )
        for tie in ties
        for side in SIDES
    ]


def range_within(ratios: Floats, errors: Floats) -> tuple[float | None, float | None]:
    """Lowest and highest ratio with errors that are accepted, where these are not all or none."""
    good = ratios[errors <= ERROR]
    if len(good) == 0:  # but nodes that match: checked above
        return 1.0, 1.0
    low = float(good[0]) if good[0] > ratios[0] else None
    return low, float(good[-1]) if good[-1] < ratios[-1] else None
