"""The answer of error against time: what to take, and how long that takes."""

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.cases.performance.studies import Study
from fe_drivetrain.cases.performance.study_page import BOUNDS, errors_caption, percent
from fe_drivetrain.cases.references.stiffness_choices import CURVED, P1, STRAIGHT
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.suite import Page, Record


def answer(
    page: Page, studies: Sequence[Study], goals: Sequence[Record], growth_caption: str
) -> None:
    """State the quickest choice for the smallest error that any of them reaches.

    Parameters
    ----------
    page : Page
        Takes the answer.
    studies : sequence of Study
        Those that were run, the one that answers first.
    goals : sequence of dict
        Rows of the table of goals.
    growth_caption : str
        Caption of the chart of growth, which stands where no study was run.
    """
    known = [row for row in goals if row["measured"] is not None]
    each = [of_study(page, study) for study in studies]
    first, others = each[:1], each[1:]
    figures = [figure for of in first for figure in of]
    figures += [of_goal(page, row) for row in known]
    figures += [figure for of in others for figure in of]
    reached = sum(row["reached"] == "yes" for row in goals)
    page.answer(
        "Which element and solver give a stiffness fastest within a given error?",
        verdict(studies[0]) if studies else f"{reached} of {len(goals)} goals are reached.",
        figures[:6],
        hero=errors_caption(studies[0], 0) if studies else growth_caption,
        cautions=[
            "Times are those of this machine, with loops compiled before.",
            "Errors below the uncertainty of the reference are shown pale, and are not ranked.",
        ],
    )


IN_WORDS = {
    P1: "tetrahedra of 4 nodes",
    STRAIGHT: "straight tetrahedra of 10 nodes",
    CURVED: "curved tetrahedra of 10 nodes",
    "hex 20": "hexahedra of 20 nodes",
    "hex 27": "hexahedra of 27 nodes",
}


def verdict(study: Study) -> str:
    """The quickest choice of the smallest bound that is reached, beside the fastest of all."""
    name = f"{study.quantities[0].capitalize()} stiffness" if study.beam else study.quantities[0]
    for bound in reversed(BOUNDS):
        best = study.cheapest(0, bound)
        if best is not None:
            return (
                f"{name} within {percent(bound)} is found fastest with "
                f"{IN_WORDS.get(best.element, best.element)} and the solver {best.used}: in "
                f"{best.total:.2g}\u00a0s with meshing."
            )
    least = float(study.error(0).min())
    return (
        f"{name}: not one choice is within {percent(BOUNDS[0])}; the best mesh has an error of "
        f"{100 * least:.2g}\u00a0%."
    )


def of_study(page: Page, study: Study) -> list[KeyFigure]:
    """Times of the quickest choices by error, and the error of beam theory."""
    figures = []
    for bound in BOUNDS:
        best = study.cheapest(0, bound)
        if best is not None:
            figures.append(
                page.value(
                    f"{study.quantities[0]} within {percent(bound)}, shortest time [s]",
                    best.total,
                    0.5 * (best.most - best.least),
                )
            )
    if not figures:
        least = int(study.error(0).argmin())
        figures = [
            page.value(
                f"{study.quantities[0]}, smallest error [%]", 100.0 * float(study.error(0)[least])
            ),
            page.value(f"{study.quantities[0]}, time of that [s]", float(study.seconds()[least])),
        ]
    if study.beam is not None:
        error = 100.0 * float(np.abs(study.beam[0] / study.reference - 1.0)[0])
        figures.append(page.value("error of beam theory in torsion [%]", error))
    return figures


def of_goal(page: Page, row: Record) -> KeyFigure:
    """What was measured, beside its goal, in short words."""
    what = str(row["goal"])
    name, _, unit = what.rpartition(" [")
    short = (name or what).partition(", ")[0].replace("1e-4", "10⁻⁴")
    asked = float(str(row["asked for"]).rpartition(" ")[2])
    return page.value(
        f"{short} [{unit}" if name else short, float(row["measured"]), beside=asked, by="goal"
    )
