"""Condensed matrices as Nastran bulk data (DMIG) and OUTPUT4, read by pyNastran."""

import numpy as np

from fe_drivetrain import export
from fe_drivetrain.cases import case
from fe_drivetrain.cases.export.samples import frequencies, matrices, samples, show
from fe_drivetrain.cases.export.second_reader import pynastran
from fe_drivetrain.common import max_difference, scratch_folder
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import difference_text, formatted
from fe_drivetrain.report.suite import Page, Record, Run, Target, column, grouped

WRITTEN = "the matrices before they were written"
#: By format: largest difference that the digits of its numbers leave, and why.
DIGITS = {
    "dmig": (
        1e-9,
        "sixteen characters of a field keep ten digits at least, of which half of the last is "
        "rounded",
    ),
    "op4": (
        1e-15,
        "seventeen digits name every double; the rest is one addition of the two triangles",
    ),
}
SOFTEST = "rounding by 1e-10, over the softest elastic motion's share in a unit diagonal, which is "
SOFTEST += "above 1e-2"
BY_FORMAT = "Largest difference of matrices that pyNastran reads; the shortest bars stand for none"
NAMES = {"dmig": "DMIG", "op4": "OUTPUT4"}
DIFFERENCE = "difference of a unit diagonal"


def answer(page: Page, rows: list[Record], compared: dict[str, str]) -> None:
    """State how far matrices that pyNastran reads are from those that were written.

    Parameters
    ----------
    page : Page
        With the checks of all files.
    rows : list of dict
        A matrix of a file each.
    compared : dict
        Quantity of the check of a natural frequency, by format.
    """
    worst = {name: max(column(of, DIFFERENCE)) for name, of in grouped(rows, "format")}
    dmig, output4 = (formatted(worst[name], 2, "") for name in NAMES)
    furthest = "natural frequency furthest off, {}"
    frequency = page.judged(compared["dmig"], furthest.format("DMIG"), "as written")
    page.answer(
        "Does pyNastran read the exported matrices as they were written?",
        f"Its matrices differ by at most {dmig} of a unit diagonal by DMIG and {output4} by "
        f"OUTPUT4; natural frequencies shift by at most {difference_text(frequency)}.",
        [
            *(
                page.value(
                    f"largest difference, {NAMES[name]}, of a unit diagonal",
                    worst[name],
                    at_most=within,
                    by="digits of the file",
                )
                for name, (within, _) in DIGITS.items()
            ),
            frequency,
            page.judged(compared["op4"], furthest.format("OUTPUT4"), "as written"),
        ],
        hero=BY_FORMAT,
    )
    found = {
        kind: {f"{row['superelement']}, {NAMES[row['format']]}": row[DIFFERENCE] for row in of}
        for kind, of in grouped(rows, "matrix")
    }
    page.add(bars(BY_FORMAT, found, DIFFERENCE, least=1e-18))


@case(
    "Nastran DMIG and OUTPUT4 of a shaft and a bearing, read by pyNastran",
    source="MSC Nastran Quick Reference Guide, DMIG; NX Nastran DMAP Programmer's Guide, OUTPUT4; "
    "pyNastran, run here",
)
def run(run: Run, page: Page) -> None:
    """Write, read by pyNastran, compare."""
    pynastran("bdf.bdf")  # absent, it is missed before anything is solved
    elements = samples(run)
    rows: list[Record] = []
    compared: dict[str, str] = {}
    for label, element in elements.items():
        for format, (tolerance, digits) in DIGITS.items():
            with run.step("write and read"), scratch_folder() as folder:
                path = folder / f"{element.name}{export.FORMATS[format].suffix}"
                export.write_superelement(path, element, format)
                size, back = path.stat().st_size, export.read_superelement(path, format)
            name, found, written = f"{label}, {format}", matrices(back), matrices(element)
            for kind in written:
                worst = max_difference(found[kind], written[kind])
                what = f"{name}: {kind} read less {kind} written, of a unit diagonal"
                page.vanishes(what, worst, within=tolerance, why=digits, source=WRITTEN)
                rows.append(
                    {
                        "superelement": label,
                        "format": format,
                        "matrix": kind,
                        "degrees of freedom": len(written[kind]),
                        "size [bytes]": size,
                        DIFFERENCE: worst,
                    }
                )
            if element.supported:
                continue
            page.vanishes(
                f"{name}: force against rigid motions",
                back.rigid_error(),
                within=1e-9,
                why=DIGITS["dmig"][1],
                source="a free body resists no rigid motion",
            )
            computed, exact = (frequencies(m["stiffness"], m["mass"], 3) for m in (found, written))
            k = int(np.argmax(np.abs(computed / exact - 1.0)))
            title = f"{name}: natural frequency {k + 1} of the first three"
            compared[format] = title
            page.meets(computed[k], Target(f"{title} [Hz]", exact[k], 1e-6, SOFTEST, WRITTEN))
    answer(page, rows, compared)
    page.say("A symmetric DMIG holds one triangle; the whole matrix comes back from it.")
    show(run, page)
    page.section("Files")
    page.table("Largest difference between what was written and what pyNastran reads", rows)
    page.text(
        "The file of bulk data has a GRID for each point, and is included in a model; its comments "
        "name the points, the matrices and the case control that selects them (K2GG, M2GG)."
    )
