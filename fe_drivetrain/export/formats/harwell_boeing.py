"""A matrix in the Harwell-Boeing form, as HBMAT of Ansys writes it in ASCII.

Form: Duff, Grimes and Lewis, User's guide for the Harwell-Boeing sparse matrix collection, 1992:
columns of Fortran's fixed widths; of a symmetric matrix one triangle.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats.dmig import places_of
from fe_drivetrain.export.formats.labelled_matrices import (
    TAKEN_AS_IT_IS,
    Matrix,
    Naming,
    superelement_of,
)
from fe_drivetrain.export.formats.op4_records import MAX_SIZE
from fe_drivetrain.export.formats.statement import text_of
from fe_drivetrain.export.superelement import Superelement

_FORM = re.compile(r"\((?:\d*P,?)?\s*(\d+)[IEDFG](\d+)", re.IGNORECASE)
_Number = TypeVar("_Number", int, float)


def read(path: Path, naming: Naming = TAKEN_AS_IT_IS) -> Superelement:
    """Read the stiffness; its points are said by the user, in the order of the rows.

    Parameters
    ----------
    path : Path
        The file.
    naming : Naming
        Points and where they are.

    Raises
    ------
    InputError
        The file is no such matrix, is cut off, or its points are left open.
    """
    text = text_of(path, "Harwell-Boeing matrix")
    try:
        matrix = _matrix(text.splitlines())
    except (ValueError, IndexError) as error:
        raise InputError(
            f"{path} is no Harwell-Boeing matrix, or is cut off ({error}): write it again, whole, "
            "in ASCII"
        ) from None
    beside = places_of(naming)
    return superelement_of(path, {"K": Matrix(beside.order, matrix)}, beside.places, naming)


def _matrix(lines: list[str]) -> Floats:
    kind = lines[2][:3].upper()
    rows, columns, count = (int(lines[2][14 * k : 14 * (k + 1)]) for k in range(1, 4))
    if kind not in ("RSA", "RUA"):
        raise ValueError(f"it is of the kind {kind!r}, not RSA or RUA: real and assembled")
    if rows != columns or not 0 < rows <= MAX_SIZE or not 0 < count <= rows * columns:
        raise ValueError(f"it has {rows} rows, {columns} columns and {count} terms")
    forms = [lines[3][:16], lines[3][16:32], lines[3][32:52]]
    at = 5 if int(lines[1][56:70].strip() or 0) > 0 else 4  # a fifth line describes right sides
    starts, at = _numbers(lines, at, forms[0], columns + 1, int)
    places, at = _numbers(lines, at, forms[1], count, int)
    values, _ = _numbers(lines, at, forms[2], count, float)
    return _filled(kind, rows, starts, places, values)


def _numbers(
    lines: list[str], at: int, form: str, count: int, kind: Callable[[str], _Number]
) -> tuple[list[_Number], int]:
    """Numbers of a fixed width, and the line behind them."""
    found = _FORM.search(form)
    if found is None or int(found[1]) < 1 or int(found[2]) < 1:
        raise ValueError(f"its numbers have the form {form.strip()!r}")
    per_line, width = int(found[1]), int(found[2])
    numbers: list[_Number] = []
    while len(numbers) < count:
        line, at = lines[at], at + 1
        for k in range(min(per_line, count - len(numbers))):
            numbers.append(kind(line[width * k : width * (k + 1)].replace("D", "E")))
    return numbers, at


def _filled(
    kind: str, size: int, starts: list[int], places: list[int], values: list[float]
) -> Floats:
    if starts[0] != 1 or starts[-1] != len(values) + 1 or any(np.diff(starts) < 0):
        raise ValueError("its columns do not follow one another")
    rows = np.array(places) - 1
    if rows.min() < 0 or rows.max() >= size:
        raise ValueError(f"it has a term in row {int(rows.max()) + 1} of {size}")
    columns = np.repeat(np.arange(size), np.diff(starts))
    matrix = np.zeros((size, size))
    matrix[rows, columns] = values
    if kind == "RSA" and (np.tril(matrix, -1).any() != np.triu(matrix, 1).any()):
        with np.errstate(all="ignore"):
            return matrix + matrix.T - np.diag(np.diag(matrix))
    return matrix
