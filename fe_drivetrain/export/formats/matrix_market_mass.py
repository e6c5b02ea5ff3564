"""Matrix Market: the mass, in a second file beside the stiffness."""

from __future__ import annotations

from pathlib import Path

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats.matrix_market import write_matrix
from fe_drivetrain.export.superelement import Superelement


def write(path: Path, element: Superelement) -> None:
    """Write the mass; numbers keep every digit.

    Raises
    ------
    InputError
        The superelement has none.
    """
    if element.mass is None:
        raise InputError(
            f"superelement {element.name!r} has no mass: export the free shaft at level 2 or 3"
        )
    write_matrix(path, element, "mass", element.mass)
