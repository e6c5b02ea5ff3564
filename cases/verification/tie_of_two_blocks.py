"""Square bar cut by a plane tie of meshes that do not match: torsion, bending and shear."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import two_bodies
from fe_drivetrain.cases.verification import tied_bars
from fe_drivetrain.cases.verification.tied_bars import TIES, Stiffnesses, TieKind
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import GridConvergence, grid_convergence
from fe_drivetrain.elasticity.interfaces import eliminate, mortar_tie
from fe_drivetrain.elasticity.mesh import brick
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite import Page, Record, Run

#: Divisions of the section's sides: of the slave, of the master.
RATIOS = ((2, 4), (2, 3), (2, 2), (3, 2), (4, 2))
QUICK_RATIOS = ((2, 3), (2, 2), (3, 2))
UNCUT = (2, 3, 4)
QUICK_UNCUT = (1, 2, 3)
MORTAR: tuple[Literal["dual", "standard"], ...] = ("dual", "standard")

TITLES = {"twist": "torsion", "bend": "pure bending", "across": "force across a clamped bar"}
ERROR_OF = "Error of the stiffness: {}"
UNITS = {"twist": "N m/rad", "across": "N/m"}
WORST = "worst of all ratios"


@dataclass(frozen=True)
class Found:
    """Stiffnesses of whole and tied bars.

    Attributes
    ----------
    ratios : tuple[tuple[int, int], ...]
        Divisions of slave and master.
    tied : dict[TieKind, list[Stiffnesses]]
        By kind of tie, one for each ratio.
    entries : dict[TieKind, list[int]]
        Entries of a row of the tie, mean, by kind of tie, one for each ratio.
    whole : dict[int, Stiffnesses]
        Whole bars by divisions.
    across : GridConvergence
        Convergence of the whole bar's stiffness across [N/m].
    exact : dict[str, float]
        References by quantity [N m/rad, N m/rad, N/m].
    """

    ratios: tuple[tuple[int, int], ...]
    tied: dict[TieKind, list[Stiffnesses]]
    entries: dict[TieKind, list[int]]
    whole: dict[int, Stiffnesses]
    across: GridConvergence
    exact: dict[str, float]

    @property
    def labels(self) -> list[str]:
        """Labels of the ratios."""
        return [f"{own} on {other}" for own, other in self.ratios]

    @property
    def coarse(self) -> dict[str, float]:
        """Relative errors of the whole bar of the coarser mesh."""
        bar = self.whole[2]
        return {q: abs(getattr(bar, q) / exact - 1.0) for q, exact in self.exact.items()}

    def errors(self, kind: TieKind, quantity: str) -> Floats:
        """Relative, by ratio."""
        exact = self.exact[quantity]
        return np.abs([getattr(k, quantity) / exact - 1.0 for k in self.tied[kind]])


def solved(run: Run) -> Found:
    """All bars."""
    ratios = QUICK_RATIOS if run.quick else RATIOS
    meshes = QUICK_UNCUT if run.quick else UNCUT
    with run.step("uncut bar"):
        whole = {n: tied_bars.stiffnesses(tied_bars.whole(n)) for n in meshes}
        across = grid_convergence([1.0 / n for n in meshes], [k.across for k in whole.values()])
    tied: dict[TieKind, list[Stiffnesses]] = {kind: [] for kind in TIES}
    entries: dict[TieKind, list[int]] = {kind: [] for kind in TIES}
    with run.step("tied bars"):
        for kind in TIES:
            for ratio in ratios:
                bodies, tie = tied_bars.tied(*ratio, kind)
                tied[kind].append(tied_bars.stiffnesses(bodies, tie))
                entries[kind].append(int(tie.rows.nnz / tie.rows.shape[0]))
    exact = {
        "twist": tied_bars.torsion_stiffness(),
        "bend": tied_bars.bending_stiffness(),
        "across": across.extrapolated,
    }
    return Found(ratios, tied, entries, whole, across, exact)


@case(
    "Tied bar with meshes that do not match: stiffness by mesh ratio",
    source="St Venant's torsion and bending of a square bar; the whole bar",
)
def run(run: Run, page: Page) -> None:
    """Stiffness of the tied bar beside that of the whole one."""
    found = solved(run)
    check_stiffness(page, found, "twist")
    check_stiffness(page, found, "across")
    check_bending(page, found)
    check_balance(page, found)
    answer(page, found)
    page.section("Stiffness against mesh ratio")
    for quantity in TITLES:
        add_chart(page, found, quantity)
    page.text(
        "In torsion ends turn rigidly in their plane and are free to warp, so St Venant's solution "
        "is exact in the whole bar. In pure bending the displacements are quadratic and the "
        "tractions on the tie linear: elements and standard multipliers hold both exactly, dual "
        "multipliers hold constant tractions only. The clamped bar, loaded across its end, has no "
        "closed form: the reference is the whole bar, extrapolated."
    )
    page.section("Standard and dual multipliers")
    page.text(
        "Standard multipliers are the more accurate ones, as pure bending shows. With them every "
        "node of the slave follows all nodes of the master: on large faces the stiffness fills up, "
        "and dual multipliers, which are local, are the better choice."
    )
    with run.step("fill"):
        fill = [fill_in(n) for n in ((4,) if run.quick else (4, 8))]
    page.table(
        "Faces that do not match, n on n - 1 divisions: entries of a row of the tie (mean), and of "
        "the stiffness that is factorised",
        fill,
    )
    page.table(
        "Entries of a row of the tie in the bars above (mean)",
        list(zip(found.labels, *found.entries.values(), strict=True)),
        ["slave on master", *TIES],
    )
    page.data("ratios", found.labels)
    page.data("errors", {q: {kind: found.errors(kind, q) for kind in TIES} for q in TITLES})
    whole = found.whole.values()
    page.image(
        "Both halves of the bar, of two and three elements a side",
        run.sketch(tied_bars.tied(2, 3, "standard")[0]),
    )
    page.data("whole bar", {q: [getattr(bar, q) for bar in whole] for q in TITLES})


def answer(page: Page, found: Found) -> None:
    """State the largest error of a tied bar, and that of the whole bar of the coarser mesh."""
    errors = {
        q: max(float(found.errors(kind, q).max()) for kind in MORTAR) for q in ("twist", "across")
    }
    coarse = max(found.coarse[q] for q in errors)
    ratio = max(max(r) / min(r) for r in found.ratios)
    page.answer(
        "Which error of the stiffness does a tie between meshes that do not match cause?",
        f"A bar that is cut and tied, with mesh ratios up to {ratio:g}\u00a0:\u00a01, errs by at "
        f"most {percent_text(max(errors.values()))}; its coarser mesh alone errs by "
        f"{percent_text(coarse)}.",
        [
            *(
                page.judged(
                    f"{TITLES[q]}: stiffness, standard multipliers, "
                    f"{worst(found, 'standard', q)[0]}",
                    f"{TITLES[q]}, worst ratio",
                    by,
                    unit="G" + UNITS[q],
                )
                for q, by in (("twist", "St Venant"), ("across", "whole bar"))
            ),
            page.judged(
                f"pure bending: stiffness, dual multipliers, {WORST}",
                "pure bending, worst ratio, dual multipliers",
                "E I / L",
                unit="GN m/rad",
            ),
            page.value("largest error of a tied bar [%]", 100 * max(errors.values())),
            page.value("error of the whole bar, coarser mesh [%]", 100 * coarse),
        ],
        hero=ERROR_OF.format(TITLES["twist"]),
    )


def worst(found: Found, kind: TieKind, quantity: str) -> tuple[str, float]:
    """Name of the ratio with the largest error, and the stiffness there."""
    at = int(np.argmax(found.errors(kind, quantity)))
    own, other = found.ratios[at]
    return f"{WORST} ({own} on {other})", getattr(found.tied[kind][at], quantity)


def check_stiffness(page: Page, found: Found, quantity: str) -> None:
    """The worst of all ratios, with either multipliers, against St Venant or the whole bar."""
    exact, coarse = found.exact[quantity], found.coarse[quantity]
    unit, doubt = UNITS[quantity], 0.0
    why = "twice the error of the whole bar of the coarser mesh"
    if quantity == "twist":
        why += ": a tie of optimal order adds no more than the elements' own error"
        source = "St Venant's series for the square bar (Timoshenko and Goodier art 109)"
    else:
        why += ", and the band of the reference"
        source = f"whole bar, {found.across.sentence(unit)}"
        doubt = found.across.extrapolated_uncertainty / exact
    for kind in MORTAR:
        where, stiffness = worst(found, kind, quantity)
        page.equals(
            f"{TITLES[quantity]}: stiffness, {kind} multipliers, {where} [{unit}]",
            stiffness,
            exact,
            within=2.0 * coarse + doubt,
            why=why,
            source=source,
            band=coarse * exact,
        )


def check_bending(page: Page, found: Found) -> None:
    """Pure bending: exact with standard multipliers, close with dual ones."""
    page.vanishes(
        f"pure bending: relative error of the stiffness, standard multipliers, {WORST}",
        float(found.errors("standard", "bend").max()),
        within=1e-10,
        why="elements and multipliers hold both exactly; round-off times the condition",
        source="E I / L; displacements are quadratic, tractions linear",
    )
    page.equals(
        f"pure bending: stiffness, dual multipliers, {WORST} [N m/rad]",
        worst(found, "dual", "bend")[1],
        found.exact["bend"],
        within=2.0 * found.coarse["twist"],
        why="twice the error of torsion of the coarser mesh: dual multipliers hold only constant "
        "tractions; their error with linear ones is to stay below the elements'",
        source="E I / L",
    )


def check_balance(page: Page, found: Found) -> None:
    """The tie takes from one half what it gives to the other."""
    bars = [bar for kind in MORTAR for bar in found.tied[kind]]
    for name, largest in (
        ("forces", max(bar.unbalanced_force for bar in bars)),
        ("moments", max(bar.unbalanced_moment for bar in bars)),
    ):
        page.vanishes(
            f"{name} on both sides of the tie, of the end's, worst of all",
            largest,
            within=1e-10,
            why="round-off times the bar's condition",
            source="equilibrium: the rows of the tie hold every rigid motion",
        )


def add_chart(page: Page, found: Found, quantity: str) -> None:
    """Errors of one stiffness by ratio."""
    labels, coarse = found.labels, found.coarse[quantity]
    traces = [
        trace(kind, [], np.maximum(found.errors(kind, quantity), 1e-15), mode="lines+markers")
        | {"x": labels}
        for kind in TIES
    ]
    if coarse > 1e-9:
        line = trace("whole bar, 2 divisions", [], [coarse] * len(labels), line={"dash": "dot"})
        traces.append(line | {"x": labels})
    page.chart(
        ERROR_OF.format(TITLES[quantity]),
        traces,
        "divisions of the slave on those of the master",
        "relative error",
        "y",
    )


def fill_in(divisions: int) -> Record:
    """Entries of a row of the tie, and of the stiffness, with either multipliers."""
    n = divisions
    bodies = two_bodies.together(
        brick((1, n, n), 10), brick((1, n - 1, n - 1), 10, lambda x: x + np.eye(3)[0])
    )
    K = bodies.stiffness(tied_bars.MATERIAL.lame)
    faces = bodies.faces[0]["x1"], bodies.faces[1]["x0"]
    lengths, entries = {}, {}
    for kind in MORTAR:
        tie = mortar_tie("tie", bodies.points, *faces, bodies.points.size, kind)
        elimination = eliminate([tie], bodies.points.size)
        T = elimination.T[:, elimination.free]
        lengths[f"row, {kind}"] = tie.rows.nnz / tie.rows.shape[0]
        entries[f"stiffness, {kind}"] = int((T.T @ K @ T).nnz)
    return {"divisions": n, "slave nodes": tie.rows.shape[0] // 3, **lengths, **entries}
