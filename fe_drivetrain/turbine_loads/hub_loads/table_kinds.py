"""Which kinds of files are tables of histories, and how each is opened."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.data_tables import (
    SheetTable,
    matlab_table,
    parquet_table,
)
from fe_drivetrain.turbine_loads.hub_loads.history_table import HistoryTable
from fe_drivetrain.turbine_loads.hub_loads.text_table import TextTable

OPENFAST = (".out", ".outb")
"""Output files of OpenFAST, which are no tables."""

_NAMED_ALONE = (".txt",)  # in folders, mostly something else

_KINDS: Mapping[str, Callable[[Path, str], HistoryTable]] = {
    **dict.fromkeys((".csv", ".tsv", ".txt"), TextTable),
    ".xlsx": SheetTable,
    ".mat": matlab_table,
    ".parquet": parquet_table,
}


def is_table(file: Path) -> bool:
    """Whether a file is a table of a history, by its suffix.

    Parameters
    ----------
    file : Path
        The file.
    """
    return file.suffix.lower() in _KINDS


def is_found(file: Path) -> bool:
    """Whether a pattern or a folder means a file: it is a history, and no text of another kind.

    Parameters
    ----------
    file : Path
        The file.
    """
    known = file.suffix.lower() in OPENFAST or is_table(file)
    return known and file.suffix.lower() not in _NAMED_ALONE and file.is_file()


def require_kind(file: Path) -> None:
    """Refuse a file that is neither of OpenFAST nor a table.

    Parameters
    ----------
    file : Path
        The file.

    Raises
    ------
    InputError
        Its suffix is another.
    """
    if file.suffix.lower() not in OPENFAST and not is_table(file):
        raise InputError(
            f"hub loads '{file}': the suffix '{file.suffix}' is not one of {', '.join(OPENFAST)} "
            f"(OpenFAST) and {', '.join(_KINDS)}; convert the file or rename it"
        )


def history_table(file: Path, kind: str = "hub loads") -> HistoryTable:
    """Open a table of a history.

    Parameters
    ----------
    file : Path
        A table of text (.csv, .tsv, .txt), of Excel (.xlsx), MATLAB (.mat) or Parquet (.parquet).
    kind : str
        What it is, for messages.

    Raises
    ------
    InputError
        It cannot be read.
    """
    return _KINDS.get(file.suffix.lower(), TextTable)(file, kind)
