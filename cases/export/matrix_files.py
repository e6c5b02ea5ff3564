"""Condensed matrices as JSON, CSV, Matrix Market and HDF5, read by what others read them with."""

import csv
import json
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from scipy.io import mmread

from fe_drivetrain import export
from fe_drivetrain.cases import case
from fe_drivetrain.cases.export.samples import matrices, samples
from fe_drivetrain.common import Floats, MissingToolError, largest_difference
from fe_drivetrain.suite import Page, Record, Run, column

WRITTEN = "the matrix before it was written"
DIFFERENCE = "difference of a unit diagonal"


def by_json(path: Path, kind: str) -> Floats:
    """A matrix of a JSON file."""
    return np.array(json.loads(path.read_text())[kind])


def by_csv(path: Path, kind: str) -> Floats:
    """A matrix of a CSV file: rows that begin with its kind and a degree of freedom."""
    with path.open(newline="") as file:
        return np.array([row[2:] for row in csv.reader(file) if row[0] == kind], dtype=float)


def by_scipy(path: Path, kind: str) -> Floats:
    """The matrix of a Matrix Market file."""
    return np.asarray(mmread(path))


def by_h5py(path: Path, kind: str) -> Floats:
    """A matrix of an HDF5 file."""
    with import_module("h5py").File(path) as file:
        return np.asarray(file[kind])


#: Format, library, matrices of the file, reader.
READERS: tuple[tuple[str, str, tuple[str, ...], Callable[[Path, str], Floats]], ...] = (
    ("json", "json of Python", ("stiffness", "mass"), by_json),
    ("csv", "csv of Python", ("stiffness", "mass"), by_csv),
    ("mtx", "scipy.io.mmread", ("stiffness",), by_scipy),
    ("mtx-mass", "scipy.io.mmread", ("mass",), by_scipy),
    ("hdf5", "h5py", ("stiffness", "mass"), by_h5py),
)


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
    with run.step("write and read"), TemporaryDirectory() as name:
        for label, element in elements.items():
            written = matrices(element)
            for format, library, kinds, reader in READERS:
                if not written.keys() & set(kinds):
                    continue
                path = Path(name) / f"{element.name}_{format}{export.FORMATS[format].suffix}"
                export.write(path, element, format)
                rows += [
                    {
                        "superelement": label,
                        "format": format,
                        "read by": library,
                        "matrix": kind,
                        "size [bytes]": path.stat().st_size,
                        DIFFERENCE: largest_difference(reader(path, kind), written[kind]),
                    }
                    for kind in kinds
                    if kind in written
                ]
    why = "seventeen digits, or the bits, name every double; the rest is one addition of the halves"
    for row in rows:
        kind, name = row["matrix"], f"{row['superelement']}, {row['format']}"
        title = f"{name}: {kind} read less {kind} written, of a unit diagonal"
        page.vanishes(title, row[DIFFERENCE], within=1e-15, why=why, source=WRITTEN)
    page.answer(
        "JSON, CSV, Matrix Market and HDF5 give the matrices back with a largest difference of "
        f"{max(column(rows, DIFFERENCE)):.1e} of a unit diagonal, each by a library that knows "
        "nothing of this project."
    )
    page.section("Files")
    page.table("Largest difference between what was written and what is read", rows)
