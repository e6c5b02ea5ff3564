"""All that turns of a drivetrain as matrices: CSV, Matrix Market, HDF5, SIMPACK variables."""

from __future__ import annotations

import io
from functools import partial
from pathlib import Path

import numpy as np
from scipy import sparse
from scipy.io import mmwrite

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.csv_cells import SafeWriter
from fe_drivetrain.export.formats.hdf5 import h5py_module
from fe_drivetrain.export.formats.simpack import HEADER
from fe_drivetrain.export.formats.statement import comment_lines
from fe_drivetrain.export.turning import Turning

_DIGITS = 17  # a double is not changed by them
_LETTERS = {"mass": "M", "stiffness": "K", "damping": "C", "gyroscopic": "G"}


def write_csv(path: Path, turning: Turning) -> None:
    """Write all matrices as one table with labelled rows and columns."""
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = SafeWriter(file)
        rows.writerows((f"# {key}", value) for key, value in turning.statement().items())
        rows.writerow(["matrix", "freedom", *turning.names])
        for kind, matrix in turning.matrices.items():
            for label, row in zip(turning.names, matrix.tolist(), strict=True):
                rows.writerow([kind, label, *row])


def write_hdf5(path: Path, turning: Turning) -> None:
    """Write all matrices as datasets, and the statement as attributes.

    Raises
    ------
    MissingToolError
        h5py is not installed.
    """
    with h5py_module().File(path, "w", locking=False) as file:
        file.attrs.update(turning.statement())
        file["degrees_of_freedom"] = list(turning.names)
        for kind, matrix in turning.matrices.items():
            file[kind] = matrix


def write_simpack(path: Path, turning: Turning) -> None:
    """Write a variable for each entry of the upper triangles that is not zero.

    ``$_turning_K_3_9`` is the stiffness between the degrees of freedom 3 and 9, and so on with M, C
    and G, which is skew; ``$_turning_DTTorSpr`` and ``$_turning_DTTorDmp`` are the one spring.
    """
    lines = [HEADER, "", *comment_lines(turning.statement(), "!"), ""]

    def add(name: str, value: float, comment: str) -> None:
        lines.append(f"subvar($_turning_{name}, str= '{float(value)!r}') ! {comment}")

    add("DTTorSpr", turning.spring.torsion.spring, "[N m/rad]")
    add("DTTorDmp", turning.spring.torsion.damper, "[N m s/rad]")
    for kind, matrix in turning.matrices.items():
        upper = np.triu(_in_shape(kind, matrix))
        for i, j in zip(*np.nonzero(upper), strict=True):
            comment = f"{kind}: {turning.names[i]}, {turning.names[j]}"
            add(f"{_LETTERS[kind]}_{i + 1}_{j + 1}", upper[i, j], comment)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _write_matrix(kind: str, path: Path, turning: Turning) -> None:
    """Write one matrix in Matrix Market's coordinate form, with the statement in its comments."""
    entries = {"matrix": kind} | turning.statement()
    text = io.BytesIO()
    mmwrite(
        text,
        sparse.coo_array(_in_shape(kind, turning.matrices[kind])),
        # the writer puts "%" before each line, and no blank
        comment="\n".join(line.removeprefix("%") for line in comment_lines(entries, "%")),
        precision=_DIGITS,
        symmetry="skew-symmetric" if kind == "gyroscopic" else "symmetric",
    )
    path.write_bytes(text.getvalue())


def _in_shape(kind: str, matrix: Floats) -> Floats:
    """The matrix without the round-off by which it is not symmetric, or skew."""
    sign = -1.0 if kind == "gyroscopic" else 1.0
    return np.asarray(0.5 * (matrix + sign * matrix.T))


write_stiffness = partial(_write_matrix, "stiffness")
write_mass = partial(_write_matrix, "mass")
write_damping = partial(_write_matrix, "damping")
write_gyroscopic = partial(_write_matrix, "gyroscopic")
