"""openfast_io's reader of OpenFAST inputs, where it is installed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fe_drivetrain.common.errors import MissingToolError

if TYPE_CHECKING:
    from openfast_io.FAST_reader import InputReader_OpenFAST


def openfast_reader() -> InputReader_OpenFAST:
    """A reader without a file.

    Raises
    ------
    MissingToolError
        openfast_io is not installed.
    """
    try:
        from openfast_io.FAST_reader import InputReader_OpenFAST
    except ModuleNotFoundError as error:
        raise MissingToolError(
            "reading OpenFAST inputs back needs openfast_io: install it with pip install "
            '"fe-drivetrain[openfast]"'
        ) from error
    return InputReader_OpenFAST()
