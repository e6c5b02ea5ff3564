"""Matrix Market: one symmetric matrix a file, the stiffness; its description is in the comments.

Array form, real and symmetric: the lower triangle by columns (Boisvert, Pozo and Remington 1996,
The Matrix Market Exchange Formats, NISTIR 5935).
"""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
from scipy.io import mmwrite

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats.statement import (
    comment_lines,
    commented,
    element_of,
    statement,
    text_of,
)
from fe_drivetrain.export.superelement import Superelement

_DIGITS = 17  # a double is not changed by them


def write(path: Path, element: Superelement) -> None:
    """Write the stiffness; numbers keep every digit."""
    write_matrix(path, element, "stiffness", element.stiffness)


def read(path: Path) -> Superelement:
    """Read a stiffness and the description in its comments.

    Raises
    ------
    InputError
        The file is not Matrix Market, or its comments are not a superelement's.
    """
    text = text_of(path, "Matrix Market file")
    entries = commented(text.splitlines(), "%")
    if entries.get("matrix") == "mass":
        raise InputError(f"{path} holds a mass: read the file of the stiffness")
    try:
        matrix = _array(text)
    except (ValueError, IndexError) as error:
        raise InputError(f"{path} is no Matrix Market file: {error}") from error
    return element_of(path, entries, matrix, None)


def _array(text: str) -> Floats:
    """The matrix of a file in array form.

    Not by scipy.io.mmread, which overruns its memory where numbers are too many (scipy 1.17).
    """
    lines = text.splitlines()
    kind = lines[0].lower().split()
    if kind[:4] != ["%%matrixmarket", "matrix", "array", "real"]:
        raise ValueError("its first line must be '%%MatrixMarket matrix array real symmetric'")
    body = [line for line in lines[1:] if line.strip() and not line.startswith("%")]
    rows, columns = (int(word) for word in body[0].split())
    values = np.array(body[1:], dtype=float)
    symmetric = kind[4:] == ["symmetric"]
    expected = rows * (rows + 1) // 2 if symmetric else rows * columns
    if rows != columns or len(values) != expected or not np.isfinite(values).all():
        raise ValueError(f"{len(values)} numbers are not the {rows} by {columns} of a matrix")
    if not symmetric:
        return values.reshape(columns, rows).T
    matrix = np.zeros((rows, rows))
    # by columns, from the diagonal down: by rows, that is the upper triangle
    matrix[np.triu_indices(rows)] = values
    return matrix + np.triu(matrix, 1).T


def write_matrix(path: Path, element: Superelement, kind: str, matrix: Floats) -> None:
    """Write one matrix of a superelement, with the statement that it is ``kind``."""
    entries = {"matrix": kind} | statement(element)
    text = io.BytesIO()
    mmwrite(
        text,
        0.5 * (matrix + matrix.T),
        # the writer puts "%" before each line, and no blank
        comment="\n".join(line.removeprefix("%") for line in comment_lines(entries, "%")),
        precision=_DIGITS,
        symmetry="symmetric",
    )
    path.write_bytes(text.getvalue())
