"""Nastran OUTPUT4 as text: KGG, MGG and the points' positions XYZ, in double precision.

The format has room for matrices alone: names, source, uncertainty and supports are not in it.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats.nastran import pynastran, quietly
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


def read(path: Path) -> Superelement:
    """Read matrices and positions; the points are named by their numbers.

    Whether supports are in the stiffness is seen from it: it is free where no rigid motion is
    resisted.

    Raises
    ------
    InputError
        The file is no OUTPUT4, or does not hold KGG and XYZ.
    MissingToolError
        pyNastran is not installed.
    """
    op4 = pynastran("op4.op4").OP4(debug=False)
    try:
        with quietly():
            found: dict[str, Floats] = {
                name: np.asarray(matrix.data) for name, matrix in op4.read_op4(str(path)).items()
            }
    # whatever a line that cannot be read makes pyNastran raise
    except Exception as error:
        raise InputError(f"{path} is no OUTPUT4 file: {type(error).__name__} {error}") from error
    if _STIFFNESS not in found or _POSITIONS not in found:
        raise InputError(
            f"{path} holds the matrices {', '.join(found) or 'none'}: it must hold {_STIFFNESS} "
            f"and {_POSITIONS}, and may hold {_MASS}"
        )
    positions = found[_POSITIONS]
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
