"""Full stiffness and mass matrices in CalculiX, as springs and masses on auxiliary nodes."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.export.calculix_runs import (
    compliance_by_calculix,
    frequencies_by_calculix,
    held,
)
from fe_drivetrain.cases.export.samples import FREE, frequencies, samples, show
from fe_drivetrain.common import scaled_to_unit_diagonal, scratch_folder
from fe_drivetrain.export import ROUNDING, find_calculix
from fe_drivetrain.report.number_text import certain_value, difference_text, formatted
from fe_drivetrain.report.suite import Page, Record, Run, Target, column

#: Natural frequencies that are compared.
COUNT = 3

SEVEN = "ccx prints seven digits"
UNCERTAIN = f"{SEVEN}, of which its eigenvalue solver leaves the last uncertain"
INVERSE, EIGENVALUES = "the inverse of the stiffness", "eigenvalues of stiffness and mass"
UNDER_FORCE = "uz of its last point under a unit force there"
HELD = "held at its first point"
FROM_MATRICES = (
    "Differences of CalculiX from the exported matrices, over what its seven digits allow"
)
OVER_ROUNDING = "difference over what printing rounds"
DIFFERENCE = "difference of a unit diagonal"


def answer(page: Page, rows: list[Record]) -> None:
    """State how far CalculiX is from the exported matrices."""
    largest, over = max(column(rows, DIFFERENCE)), max(column(rows, OVER_ROUNDING))
    how = "as" if over <= 1.0 else "not as"
    figures = [
        page.judged(
            f"{FREE}, {HELD}: natural frequency {k}", f"natural frequency {k}, {FREE}", "matrices"
        )
        for k in (1, 3)
    ]
    figures.append(
        page.judged(
            f"{FREE}: {UNDER_FORCE}", "end of the shaft under a unit force", "matrices", unit="µm/N"
        )
    )
    page.answer(
        "Does CalculiX move a condensed shaft as its exported matrices say?",
        f"It moves {how} they say: displacements differ by at most {formatted(largest, 2, '')} of "
        f"the largest, and the first natural frequency, {certain_value(figures[0])}, by "
        f"{difference_text(figures[0])}.",
        [
            *figures,
            page.value(
                "largest difference of displacements, over what seven digits round",
                over,
                at_most=1.0,
                by="seven digits",
            ),
            page.value("unit loads compared", sum(column(rows, "unit loads"))),
        ],
        hero=FROM_MATRICES,
    )
    page.errors(FROM_MATRICES, figures)


@case(
    "Stiffness and mass of a shaft and a bearing as springs and equations in CalculiX",
    source="CalculiX (Dhondt 2004, The Finite Element Method for Three-Dimensional "
    "Thermomechanical Applications), run here",
)
def run(run: Run, page: Page) -> None:
    """Write the file, let ccx move it, compare."""
    find_calculix()
    rows: list[Record] = []
    for label, element in samples(run).items():
        start = held(element)
        stiffness = element.stiffness[start:, start:]
        with run.step("CalculiX"), scratch_folder() as name:
            found = compliance_by_calculix(element, name)
        expected = np.linalg.inv(stiffness)
        size = np.sqrt(np.outer(expected.diagonal(), expected.diagonal()))
        # fourteen digits of the deck, times the condition of what is solved
        solved = 1e-13 * np.linalg.cond(scaled_to_unit_diagonal(stiffness))
        allowed = ROUNDING * np.abs(expected) + solved * size
        worst = float((np.abs(found - expected) / allowed).max())
        rows.append(
            {
                "superelement": label,
                "unit loads": len(expected),
                DIFFERENCE: (np.abs(found - expected) / size).max(),
                OVER_ROUNDING: worst,
            }
        )
        title = f"{label}: displacements under {len(expected)} unit loads, largest difference over "
        why = f"{SEVEN}; beside that only the round-off of the deck's fourteen digits"
        title += "what printing rounds"
        page.at_most(title, worst, 1.0, why=why, source=INVERSE, measure="identity")
        last = len(expected) - 4
        title, value = f"{label}: {UNDER_FORCE} [m/N]", (last, last)
        page.meets(found[value], Target(title, expected[value], 1e-6, SEVEN, INVERSE))
        if element.mass is None:
            continue
        with run.step("CalculiX"), scratch_folder() as name:
            computed = frequencies_by_calculix(element, name, COUNT)
        exact = frequencies(stiffness, element.mass[start:, start:], COUNT)
        for k in range(COUNT):
            title = f"{label}, {HELD}: natural frequency {k + 1} [Hz]"
            page.meets(computed[k], Target(title, exact[k], 1e-6, UNCERTAIN, EIGENVALUES))
    answer(page, rows)
    show(run, page)
    page.section("Displacements")
    page.text(
        "CalculiX 2.20 takes no matrix as an element. A symmetric matrix is a sum of squares of "
        "linear forms, its eigenvectors with a unit diagonal: each becomes an auxiliary node that "
        "moves by its form, through an *EQUATION, and stands on a spring (SPRING1) or carries a "
        "mass (MASS)."
    )
    page.table("Displacements by ccx less the inverse of the stiffness", rows)
