"""Condensed matrices as Nastran bulk data (DMIG) and OUTPUT4, read by pyNastran."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

SOURCE = "the matrices before they were written"
DMIG_REASON = (
    "sixteen characters of a field keep ten digits at least, of which half of the last is rounded"
)
OP4_REASON = "seventeen digits name every double; the rest is one addition of the two triangles"


def run(run: Run) -> Any:
    """Write, read by pyNastran, compare."""
    import tempfile
    from pathlib import Path

    import numpy as np

    from fe_drivetrain import export
    from fe_drivetrain.cases.export.samples import (
        difference,
        frequencies,
        samples,
    )
    from fe_drivetrain.export import pynastran
    from fe_drivetrain.report import Section, Table, Text, judge

    pynastran("bdf.bdf")  # absent, it is missed before anything is solved
    elements = samples(run)
    rows: list[list[Any]] = []
    verdicts = []
    with run.step("write and read"), tempfile.TemporaryDirectory() as name:
        for label, element in elements.items():
            for format, tolerance, reason in (
                ("dmig", 1e-9, DMIG_REASON),
                ("op4", 1e-15, OP4_REASON),
            ):
                path = Path(name) / f"{element.name}{export.FORMATS[format].suffix}"
                export.write(path, element, format)
                back = export.read(path, format)
                pairs = [("stiffness", back.stiffness, element.stiffness)]
                if element.mass is not None and back.mass is not None:
                    pairs.append(("mass", back.mass, element.mass))
                for kind, found, expected in pairs:
                    worst = difference(found, expected)
                    rows.append([label, format, kind, len(expected), path.stat().st_size, worst])
                    verdicts.append(
                        judge(
                            f"{label}, {format}: {kind} read less {kind} written, of a unit "
                            "diagonal",
                            worst,
                            0.0,
                            tolerance=tolerance,
                            relative=False,
                            source=SOURCE,
                            reason=reason,
                            measure="identity",
                        )
                    )
                if element.supported:
                    continue
                verdicts.append(
                    judge(
                        f"{label}, {format}: force against rigid motions",
                        back.rigid_error(),
                        0.0,
                        tolerance=1e-9,
                        relative=False,
                        source="a free body resists no rigid motion",
                        reason=DMIG_REASON,
                        measure="identity",
                    )
                )
                assert element.mass is not None
                assert back.mass is not None
                computed = frequencies(back.stiffness, back.mass, 3)
                expected_hz = frequencies(element.stiffness, element.mass, 3)
                worst_hz = int(np.argmax(np.abs(computed / expected_hz - 1.0)))
                verdicts.append(
                    judge(
                        f"{label}, {format}: natural frequency {worst_hz + 1} of the first three",
                        float(computed[worst_hz]),
                        float(expected_hz[worst_hz]),
                        unit="Hz",
                        tolerance=1e-6,
                        source=SOURCE,
                        reason="rounding by 1e-10, over the softest elastic motion's share in a "
                        "unit diagonal, which is above 1e-2",
                        measure="frequency",
                    )
                )
    worst_of = {f: max(row[-1] for row in rows if row[1] == f) for f in ("dmig", "op4")}
    return CASE.results(
        run,
        summary=[
            "pyNastran reads the exported DMIG with a largest difference of "
            f"{worst_of['dmig']:.1e} of a unit diagonal, and OUTPUT4 with {worst_of['op4']:.1e}.",
            "A symmetric DMIG holds one triangle; the whole matrix comes back from it.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Files",
                items=[
                    Table(
                        caption="Largest difference between what was written and what pyNastran "
                        "reads",
                        columns=[
                            "superelement",
                            "format",
                            "matrix",
                            "freedoms",
                            "size [bytes]",
                            "difference of a unit diagonal",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="The file of bulk data has a GRID for each point, and is included in "
                        "a model; its comments name the points, the matrices and the case control "
                        "that selects them (K2GG, M2GG)."
                    ),
                ],
            )
        ],
        figures={},
    )


CASE = Case(
    name="export/nastran",
    title="Nastran DMIG and OUTPUT4 of a shaft and a bearing, read by pyNastran",
    source="MSC Nastran Quick Reference Guide, DMIG; NX Nastran DMAP Programmer's Guide, OUTPUT4; "
    "pyNastran, run here",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
