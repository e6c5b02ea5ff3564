"""Full stiffness and mass matrices in CalculiX, as springs and masses on auxiliary nodes."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Natural frequencies that are compared.
COUNT = 3


def run(run: Run) -> Any:
    """Write the file, let ccx move it, compare."""
    import tempfile
    from pathlib import Path

    import numpy as np

    from fe_drivetrain.cases.export.samples import (
        frequencies,
        samples,
    )
    from fe_drivetrain.common import scaled_to_unit_diagonal
    from fe_drivetrain.export import (
        ROUNDING,
        compliance_by_calculix,
        find_calculix,
        frequencies_by_calculix,
        held,
    )
    from fe_drivetrain.report import Section, Table, Text, judge

    find_calculix()
    rows: list[list[Any]] = []
    verdicts = []
    for label, element in samples(run).items():
        start = held(element)
        stiffness = element.stiffness[start:, start:]
        with run.step("CalculiX"), tempfile.TemporaryDirectory() as name:
            found = compliance_by_calculix(element, Path(name))
        expected = np.linalg.inv(stiffness)
        size = np.sqrt(np.outer(expected.diagonal(), expected.diagonal()))
        # fourteen digits of the deck, times the condition of what is solved
        solved = 1e-13 * np.linalg.cond(scaled_to_unit_diagonal(stiffness))
        allowed = ROUNDING * np.abs(expected) + solved * size
        worst = float((np.abs(found - expected) / allowed).max())
        rows.append([label, len(expected), float((np.abs(found - expected) / size).max()), worst])
        verdicts.append(
            judge(
                f"{label}: displacements under {len(expected)} unit loads, largest difference over "
                "what printing rounds",
                worst,
                0.0,
                tolerance=1.0,
                relative=False,
                source="the inverse of the stiffness",
                reason="ccx prints seven digits; beside that only the round-off of the deck's "
                "fourteen digits",
                measure="identity",
            )
        )
        last = len(expected) - 4
        verdicts.append(
            judge(
                f"{label}: uz of its last point under a unit force there",
                float(found[last, last]),
                float(expected[last, last]),
                unit="m/N",
                tolerance=1e-6,
                source="the inverse of the stiffness",
                reason="ccx prints seven digits",
                measure="deflection",
            )
        )
        if element.mass is None:
            continue
        with run.step("CalculiX"), tempfile.TemporaryDirectory() as name:
            swings = frequencies_by_calculix(element, Path(name), COUNT)
        exact = frequencies(stiffness, element.mass[start:, start:], COUNT)
        verdicts += [
            judge(
                f"{label}, held at its first point: natural frequency {k + 1}",
                float(swings[k]),
                float(exact[k]),
                unit="Hz",
                tolerance=1e-6,
                source="eigenvalues of stiffness and mass",
                reason="ccx prints seven digits, of which its eigenvalue solver leaves the last "
                "uncertain",
                measure="frequency",
            )
            for k in range(COUNT)
        ]
    return CASE.results(
        run,
        summary=[
            "CalculiX moves under unit loads as the exported matrices say, to "
            f"{max(row[2] for row in rows):.1e} of the largest displacements: the digits that it "
            "prints.",
            "The exported mass gives the natural frequencies of the matrices, too.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Displacements",
                items=[
                    Text(
                        text="CalculiX 2.20 takes no matrix as an element. A symmetric matrix is a "
                        "sum of squares of linear forms, its eigenvectors with a unit diagonal: "
                        "each becomes an auxiliary node that moves by its form, through an "
                        "*EQUATION, and stands on a spring (SPRING1) or carries a mass (MASS)."
                    ),
                    Table(
                        caption="Displacements by ccx less the inverse of the stiffness",
                        columns=[
                            "superelement",
                            "unit loads",
                            "difference of a unit diagonal",
                            "difference over what printing rounds",
                        ],
                        rows=rows,
                    ),
                ],
            )
        ],
        figures={},
    )


CASE = Case(
    name="export/calculix_matrix",
    title="Stiffness and mass of a shaft and a bearing as springs and equations in CalculiX",
    source="CalculiX (Dhondt 2004, The Finite Element Method for Three-Dimensional "
    "Thermomechanical Applications), run here",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
