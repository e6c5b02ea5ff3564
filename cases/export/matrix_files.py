"""Condensed matrices as JSON, CSV, Matrix Market and HDF5, read by what others read them with."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

REASON = "seventeen digits, or the bits, name every double; the rest is one addition of the halves"


def run(run: Run) -> Any:
    """Write, read by the library of each format, compare."""
    import csv
    import json
    import tempfile
    from collections.abc import Callable
    from importlib import import_module
    from pathlib import Path

    import numpy as np
    from scipy.io import mmread

    from fe_drivetrain import export
    from fe_drivetrain.cases.export.samples import (
        difference,
        samples,
    )
    from fe_drivetrain.common import Floats, MissingToolError
    from fe_drivetrain.report import Section, Table, judge

    try:
        h5py = import_module("h5py")
    except ImportError as error:
        raise MissingToolError(
            'HDF5 needs h5py: install it with pip install "fe-drivetrain[hdf5]"'
        ) from error

    def by_json(path: Path, kind: str) -> Floats:
        return np.array(json.loads(path.read_text())[kind])

    def by_csv(path: Path, kind: str) -> Floats:
        with path.open(newline="") as file:
            return np.array([row[2:] for row in csv.reader(file) if row[0] == kind], dtype=float)

    def by_scipy(path: Path, kind: str) -> Floats:
        return np.asarray(mmread(path))

    def by_h5py(path: Path, kind: str) -> Floats:
        with h5py.File(path) as file:
            return np.asarray(file[kind])

    readers: list[tuple[str, str, tuple[str, ...], Callable[[Path, str], Floats]]] = [
        ("json", "json of Python", ("stiffness", "mass"), by_json),
        ("csv", "csv of Python", ("stiffness", "mass"), by_csv),
        ("mtx", "scipy.io.mmread", ("stiffness",), by_scipy),
        ("mtx-mass", "scipy.io.mmread", ("mass",), by_scipy),
        ("hdf5", "h5py", ("stiffness", "mass"), by_h5py),
    ]
    rows: list[list[Any]] = []
    verdicts = []
    elements = samples(run)
    with run.step("write and read"), tempfile.TemporaryDirectory() as name:
        for label, element in elements.items():
            for format, library, kinds, reader in readers:
                matrices = {"stiffness": element.stiffness, "mass": element.mass}
                if all(matrices[kind] is None for kind in kinds):
                    continue
                path = Path(name) / f"{element.name}_{format}{export.FORMATS[format].suffix}"
                export.write(path, element, format)
                for kind in kinds:
                    expected = matrices[kind]
                    if expected is None:
                        continue
                    worst = difference(reader(path, kind), expected)
                    rows.append([label, format, library, kind, path.stat().st_size, worst])
                    verdicts.append(
                        judge(
                            f"{label}, {format}: {kind} read less {kind} written, of a unit "
                            "diagonal",
                            worst,
                            0.0,
                            tolerance=1e-15,
                            relative=False,
                            source="the matrix before it was written",
                            reason=REASON,
                            measure="identity",
                        )
                    )
    return CASE.results(
        run,
        summary=[
            "JSON, CSV, Matrix Market and HDF5 give the matrices back with a largest difference of "
            f"{max(row[-1] for row in rows):.1e} of a unit diagonal, each by a library that knows "
            "nothing of this project.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Files",
                items=[
                    Table(
                        caption="Largest difference between what was written and what is read",
                        columns=[
                            "superelement",
                            "format",
                            "read by",
                            "matrix",
                            "size [bytes]",
                            "difference of a unit diagonal",
                        ],
                        rows=rows,
                    )
                ],
            )
        ],
        figures={},
    )


CASE = Case(
    name="export/matrix_files",
    title="JSON, CSV, Matrix Market and HDF5 of a shaft and a bearing, read by others",
    source="Boisvert, Pozo and Remington 1996, The Matrix Market Exchange Formats, NISTIR 5935; "
    "scipy and h5py, run here",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
