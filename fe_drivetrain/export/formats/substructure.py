"""Matrices of a substructure in a ``.mtx`` file of Abaqus or CalculiX.

Both write a user element: nodes in comments, their degrees of freedom, and one triangle of each
matrix by rows (Abaqus Keywords Reference, *SUBSTRUCTURE MATRIX OUTPUT, *USER ELEMENT and *MATRIX;
CalculiX CrunchiX User's Manual, *SUBSTRUCTURE MATRIX OUTPUT). Of one form with Matrix Market's
ending, files of that are read by `matrix_market`.
"""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats import matrix_market
from fe_drivetrain.export.formats.labelled_matrices import (
    TAKEN_AS_IT_IS,
    Degree,
    Matrix,
    Naming,
    superelement_of,
)
from fe_drivetrain.export.formats.statement import text_of
from fe_drivetrain.export.superelement import Superelement

_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd]?[-+]?\d+)?", re.ASCII)
_NAMES = {"STIFFNESS": "K", "MASS": "M"}


def read(path: Path, naming: Naming = TAKEN_AS_IT_IS) -> Superelement:
    """Read the stiffness, and the mass where there is one.

    Parameters
    ----------
    path : Path
        The file.
    naming : Naming
        Points, which the file knows by their numbers, and where they are.

    Raises
    ------
    InputError
        The file is no such user element, is cut off, or a point is left open.
    """
    text = text_of(path, "matrix of a substructure")
    if text.lstrip().startswith("%%"):
        if naming.says_nothing:
            return matrix_market.read(path)
        raise InputError(f"{path} is Matrix Market: give it without points and names")
    try:
        return superelement_of(path, _matrices(text), {}, naming)
    except ValueError as error:
        raise InputError(
            f"{path} is no matrix of a substructure, or is cut off ({error}): write it again, whole"
        ) from None


def _matrices(text: str) -> dict[str, Matrix]:
    """Matrices by K and M, with degrees of freedom."""
    nodes: list[int] = []
    rows: list[list[int]] = []
    values: dict[str, list[float]] = {}
    section, whole = "", False
    for line in text.splitlines():
        words = "".join(line.upper().split())
        if words.startswith("**"):
            if section == "USER" and re.fullmatch(r"[\d,]+", words[2:]):
                nodes += [int(number) for number in words[2:].split(",") if number]
        elif words.startswith("*USERELEMENT"):
            section, whole = "USER", "UNSYMM" in words
        elif kind := re.match(r"\*MATRIX,.*TYPE=(\w+)", words):
            section = kind[1]
            values[section] = []
        elif words.startswith("*"):
            section = ""
        elif section == "USER":
            rows.append([int(number) for number in words.split(",") if number])
        elif section in _NAMES:
            values[section] += [_number(cell) for cell in line.split(",") if cell.strip()]
    degrees = _degrees(nodes, rows)
    return {
        _NAMES[kind]: Matrix(degrees, _square(kind, numbers, len(degrees), whole))
        for kind, numbers in values.items()
        if kind in _NAMES
    }


def _number(cell: str) -> float:
    text = cell.strip()
    if not _NUMBER.fullmatch(text):
        raise ValueError(f"{text[:20]!r} is no number")
    return float(text.upper().replace("D", "E"))


def _degrees(nodes: list[int], rows: list[list[int]]) -> list[Degree]:
    """Degrees of freedom of the nodes: those of the first, and from a place on other ones."""
    if not nodes or not rows:
        raise ValueError("it has no nodes, or no degrees of freedom")
    changes = {row[0]: row[1:] for row in rows[1:]}
    found: list[Degree] = []
    own = rows[0]
    for place, node in enumerate(nodes, 1):
        own = changes.get(place, own)
        found += [(node, component) for component in own]
    if len(set(found)) < len(found) or not all(1 <= c <= 6 for _, c in found):
        raise ValueError("its degrees of freedom are not 1 to 6 of each node, once each")
    return found


def _square(kind: str, numbers: list[float], size: int, whole: bool) -> Floats:
    """The matrix of a triangle by rows, or of all rows."""
    if whole and len(numbers) == size**2:
        return np.array(numbers).reshape(size, size)
    if len(numbers) != size * (size + 1) // 2:
        n = (math.isqrt(8 * len(numbers) + 1) - 1) / 2
        raise ValueError(
            f"its {kind.lower()} has {len(numbers)} numbers, a triangle of {n:g} rows, but the "
            f"nodes have {size} degrees of freedom"
        )
    matrix = np.zeros((size, size))
    matrix[np.tril_indices(size)] = numbers
    return matrix + np.tril(matrix, -1).T
