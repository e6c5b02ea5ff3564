"""Condensed matrices as JSON, CSV, Matrix Market and HDF5, read by what others read them with."""

from importlib import import_module

from fe_drivetrain import export
from fe_drivetrain.cases import case
from fe_drivetrain.cases.export.matrix_readers import READERS
from fe_drivetrain.cases.export.samples import matrices, samples, show
from fe_drivetrain.common import MissingToolError, max_difference, scratch_folder
from fe_drivetrain.report.suite import Page, Record, Run, column

WRITTEN = "the matrix before it was written"
DIFFERENCE = "difference of a unit diagonal"


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
        page.vanishes(title, row[DIFFERENCE], within=1e-15, why=why, source=WRITTEN)
    page.say(
        "JSON, CSV, Matrix Market and HDF5 give the matrices back with a largest difference of "
        f"{max(column(rows, DIFFERENCE)):.1e} of a unit diagonal, each by a library that knows "
        "nothing of this project."
    )
    show(run, page)
    page.section("Files")
    page.table("Largest difference between what was written and what is read", rows)
