"""Nastran OUTPUT4 as text: KGG, MGG and the points' positions XYZ, in double precision.

The format has room for matrices alone: names, source, uncertainty and supports are not in it.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

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
from fe_drivetrain.export.formats.op4_records import matrices_of
from fe_drivetrain.export.superelement import ALLOWED, Superelement

_SYMMETRIC, _RECTANGULAR, _DOUBLE = 6, 2, 2
_STIFFNESS, _MASS, _POSITIONS = "KGG", "MGG", "XYZ"


def write(path: Path, element: Superelement) -> None:
    """Write matrices and positions; numbers keep every digit."""
    matrices = {_STIFFNESS: (_SYMMETRIC, 0.5 * (element.stiffness + element.stiffness.T))}
    if element.mass is not None:
        matrices[_MASS] = (_SYMMETRIC, 0.5 * (element.mass + element.mass.T))
    matrices[_POSITIONS] = (_RECTANGULAR, np.asarray(element.positions, dtype=float))
    lines = (line for name, (form, m) in matrices.items() for line in _lines(name, form, m))
    path.write_text("".join(f"{line}\n" for line in lines), encoding="ascii")


def _lines(name: str, form: int, matrix: Floats) -> Iterator[str]:
    """A dense matrix of double precision as text, three numbers a line."""
    rows, columns = matrix.shape
    yield f"{columns:8}{rows:8}{form:8}{_DOUBLE:8}{name:<8}1P,3E23.16"
    for k, column in enumerate(matrix.T.tolist(), 1):
        yield f"{k:8}{1:8}{rows:8}"
        yield from _in_threes(column)
    yield f"{columns + 1:8}{1:8}{1:8}"
    yield from _in_threes([1.0])


def _in_threes(values: list[float]) -> Iterator[str]:
    for k in range(0, len(values), 3):
        yield "".join(f"{value:23.16E}" for value in values[k : k + 3])


def read(path: Path, naming: Naming = TAKEN_AS_IT_IS) -> Superelement:
    """Read matrices, and the positions that were written here or that a user gives.

    Points of a file that was written here are named by their numbers. Whether supports are in the
    stiffness is seen from it: it is free where no rigid motion is resisted.

    Parameters
    ----------
    path : Path
        The file.
    naming : Naming
        What it leaves open: of a file of another program at least where its points are.

    Raises
    ------
    InputError
        The file is no OUTPUT4, leaves something open, or holds no superelement.
    """
    found = matrices_of(path)
    positions = found.pop(_POSITIONS, None)
    if positions is None or not naming.says_nothing:
        beside = places_of(naming)
        matrices = {name: Matrix(beside.order, values) for name, values in found.items()}
        return superelement_of(path, matrices, beside.places, naming)
    if _STIFFNESS not in found:
        raise InputError(
            f"{path} holds the matrices {', '.join(found) or 'none'}: beside {_POSITIONS} it must "
            f"hold {_STIFFNESS}, and may hold {_MASS}"
        )
    points = tuple(f"point_{k + 1}" for k in range(len(positions)))
    try:
        element = Superelement(
            "element", points, positions, found[_STIFFNESS], found.get(_MASS), True
        )
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
    if element.rigid_error() > ALLOWED:
        return element
    return Superelement("element", points, positions, element.stiffness, element.mass, False)
