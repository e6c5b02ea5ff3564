"""Nastran OUTPUT4 as text: KGG, MGG and the points' positions XYZ, in double precision.

The format has room for matrices alone: names, source, uncertainty and supports are not in it.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats.dmig import places_of
from fe_drivetrain.export.formats.labelled_matrices import (
    TAKEN_AS_IT_IS,
    Matrix,
    Naming,
    superelement_of,
)
from fe_drivetrain.export.formats.nastran import pynastran
from fe_drivetrain.export.formats.op4_records import matrices_of
from fe_drivetrain.export.superelement import ALLOWED, Superelement

_SYMMETRIC, _RECTANGULAR = 6, 2
_STIFFNESS, _MASS, _POSITIONS = "KGG", "MGG", "XYZ"


def write(path: Path, element: Superelement) -> None:
    """Write matrices and positions; numbers keep every digit.

    Raises
    ------
    MissingToolError
        pyNastran is not installed.
    """
    matrices = {_STIFFNESS: (_SYMMETRIC, 0.5 * (element.stiffness + element.stiffness.T))}
    if element.mass is not None:
        matrices[_MASS] = (_SYMMETRIC, 0.5 * (element.mass + element.mass.T))
    matrices[_POSITIONS] = (_RECTANGULAR, np.asarray(element.positions, dtype=float))
    op4 = pynastran("op4.op4").OP4(debug=False)
    op4.write_op4(str(path), matrices, list(matrices), precision="double", is_binary=False)


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
