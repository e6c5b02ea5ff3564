"""Full stiffness and mass matrices in CalculiX, as springs and masses on auxiliary nodes."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.export.calculix_runs import (
    compliance_by_calculix,
    frequencies_by_calculix,
    held,
)
from fe_drivetrain.cases.export.samples import frequencies, samples, show
from fe_drivetrain.common import scaled_to_unit_diagonal, scratch_folder
from fe_drivetrain.export import ROUNDING, find_calculix
from fe_drivetrain.report.suite import Page, Run, Target, column

#: Natural frequencies that are compared.
COUNT = 3

SEVEN = "ccx prints seven digits"
UNCERTAIN = f"{SEVEN}, of which its eigenvalue solver leaves the last uncertain"
INVERSE, EIGENVALUES = "the inverse of the stiffness", "eigenvalues of stiffness and mass"
DIFFERENCE = "difference of a unit diagonal"


@case(
    "Stiffness and mass of a shaft and a bearing as springs and equations in CalculiX",
    source="CalculiX (Dhondt 2004, The Finite Element Method for Three-Dimensional "
    "Thermomechanical Applications), run here",
)
def run(run: Run, page: Page) -> None:
    """Write the file, let ccx move it, compare."""
    find_calculix()
    rows = []
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
                "difference over what printing rounds": worst,
            }
        )
        title = f"{label}: displacements under {len(expected)} unit loads, largest difference over "
        why = f"{SEVEN}; beside that only the round-off of the deck's fourteen digits"
        title += "what printing rounds"
        page.at_most(title, worst, 1.0, why=why, source=INVERSE, measure="identity")
        last = len(expected) - 4
        title, value = f"{label}: uz of its last point under a unit force there [m/N]", (last, last)
        page.meets(found[value], Target(title, expected[value], 1e-6, SEVEN, INVERSE))
        if element.mass is None:
            continue
        with run.step("CalculiX"), scratch_folder() as name:
            computed = frequencies_by_calculix(element, name, COUNT)
        exact = frequencies(stiffness, element.mass[start:, start:], COUNT)
        for k in range(COUNT):
            title = f"{label}, held at its first point: natural frequency {k + 1} [Hz]"
            page.meets(computed[k], Target(title, exact[k], 1e-6, UNCERTAIN, EIGENVALUES))
    page.say(
        "CalculiX moves under unit loads as the exported matrices say, to "
        f"{max(column(rows, DIFFERENCE)):.1e} of the largest displacements: the digits that it "
        "prints.",
        "The exported mass gives the natural frequencies of the matrices, too.",
    )
    show(run, page)
    page.section("Displacements")
    page.text(
        "CalculiX 2.20 takes no matrix as an element. A symmetric matrix is a sum of squares of "
        "linear forms, its eigenvectors with a unit diagonal: each becomes an auxiliary node that "
        "moves by its form, through an *EQUATION, and stands on a spring (SPRING1) or carries a "
        "mass (MASS)."
    )
    page.table("Displacements by ccx less the inverse of the stiffness", rows)
