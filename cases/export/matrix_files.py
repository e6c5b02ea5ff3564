"""Condensed matrices as JSON, CSV, Matrix Market and HDF5, read by what others read them with."""

from importlib import import_module

from fe_drivetrain import export
from fe_drivetrain.cases import case
from fe_drivetrain.cases.export.matrix_readers import READERS
from fe_drivetrain.cases.export.samples import matrices, samples, show
from fe_drivetrain.common import MissingToolError, max_difference, scratch_folder
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, column, grouped

WRITTEN = "the matrix before it was written"
#: Allowed difference, of a unit diagonal.
WITHIN = 1e-15
BY_FORMAT = "Largest difference of each format; the shortest bars stand for none"
FORMATS = {"json": "JSON", "csv": "CSV", "mtx": "Matrix Market", "mtx-mass": "Matrix Market, mass"}
FORMATS |= {"hdf5": "HDF5"}
DIFFERENCE = "difference of a unit diagonal"


def answer(page: Page, rows: list[Record]) -> None:
    """State how far matrices that are read are from those that were written, by format."""
    worst = {FORMATS[name]: max(column(of, DIFFERENCE)) for name, of in grouped(rows, "format")}
    largest = max(worst.values())
    libraries = ", ".join(dict.fromkeys(column(rows, "read by")))
    page.answer(
        "Do other libraries read the exported matrices as they were written?",
        f"Read by other libraries, {len(rows)} matrices of {len(worst)} formats differ by at most "
        f"{formatted(largest, 2, '')} of a unit diagonal from those that were written.",
        [
            page.value(
                f"largest difference, {name}, of a unit diagonal",
                value,
                at_most=WITHIN,
                by="as written",
            )
            for name, value in worst.items()
        ],
        hero=BY_FORMAT,
    )
    page.say(f"They are read by {libraries}, which know nothing of this project.")
    page.add(bars(BY_FORMAT, {DIFFERENCE: worst}, DIFFERENCE, least=1e-18))


@case(
    "JSON, CSV, Matrix Market and HDF5 of a shaft and a bearing, read by others",
    source="Boisvert, Pozo and Remington 1996, The Matrix Market Exchange Formats, NISTIR 5935; "
    "scipy and h5py, run here",
)
def run(run: Run, page: Page) -> None:
    """Write, read by the library of each format, compare."""
    try:
        import_module("h5py")
    except ImportError as error:
        raise MissingToolError(
            'HDF5 needs h5py: install it with pip install "fe-drivetrain[hdf5]"'
        ) from error
    rows: list[Record] = []
    elements = samples(run)
    with run.step("write and read"), scratch_folder() as folder:
        for label, element in elements.items():
            written = matrices(element)
            for format, library, kinds, read in READERS:
                if not written.keys() & set(kinds):
                    continue
                path = folder / f"{element.name}_{format}{export.FORMATS[format].suffix}"
                export.write_superelement(path, element, format)
                rows += [
                    {
                        "superelement": label,
                        "format": format,
                        "read by": library,
                        "matrix": kind,
                        "size [bytes]": path.stat().st_size,
                        DIFFERENCE: max_difference(read(path, kind), written[kind]),
                    }
                    for kind in kinds
                    if kind in written
                ]
    why = "seventeen digits, or the bits, name every double; the rest is one addition of the halves"
    for row in rows:
        kind, name = row["matrix"], f"{row['superelement']}, {row['format']}"
        title = f"{name}: {kind} read less {kind} written, of a unit diagonal"
        page.vanishes(title, row[DIFFERENCE], within=WITHIN, why=why, source=WRITTEN)
    answer(page, rows)
    show(run, page)
    page.section("Files")
    page.table("Largest difference between what was written and what is read", rows)
