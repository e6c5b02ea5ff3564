"""Which kinds of files are tables of histories, and how each is opened."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from hashlib import sha256
from pathlib import Path

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.provenance import file_digest
from fe_drivetrain.turbine_loads.hub_loads.bladed_table import SUFFIX as BLADED
from fe_drivetrain.turbine_loads.hub_loads.bladed_table import BladedTable
from fe_drivetrain.turbine_loads.hub_loads.data_tables import (
    SheetTable,
    matlab_table,
    parquet_table,
)
from fe_drivetrain.turbine_loads.hub_loads.history_table import HistoryTable
from fe_drivetrain.turbine_loads.hub_loads.run_files import flex_table, hawc2_table
from fe_drivetrain.turbine_loads.hub_loads.text_table import TextTable

OPENFAST = (".out", ".outb")
"""Output files of OpenFAST, which are no tables."""

_OTHERWISE = {
    **dict.fromkeys((".hdf5", ".h5"), "let HAWC2 write hawc_binary, or save columns as CSV"),
    **dict.fromkeys((".xls", ".ods"), "save the sheet as .xlsx, or as CSV"),
    ".tdms": "export its channels as CSV or .mat",
}
_NAMED_ALONE = (".txt", ".dat")  # in folders, mostly something else

_KINDS: Mapping[str, Callable[[Path, str], HistoryTable]] = {
    **dict.fromkeys((".csv", ".tsv", ".txt"), TextTable),
    ".xlsx": SheetTable,
    ".mat": matlab_table,
    ".parquet": parquet_table,
    **dict.fromkeys((".sel", ".dat"), hawc2_table),
    **dict.fromkeys((".int", ".res"), flex_table),
}


def is_table(file: Path) -> bool:
    """Whether a file is a table of a history, by its suffix.

    Parameters
    ----------
    file : Path
        The file.
    """
    return file.suffix.lower() in _KINDS or BLADED.fullmatch(file.suffix) is not None


def is_found(file: Path) -> bool:
    """Whether a pattern or a folder means a file: it is a history, and no text of another kind.

    Parameters
    ----------
    file : Path
        The file.
    """
    suffix = file.suffix.lower()
    known = suffix in OPENFAST or is_table(file)
    samples = re.fullmatch(r"\.\$\d+", suffix)  # of Bladed, beside their header
    return known and suffix not in _NAMED_ALONE and not samples and file.is_file()


def of_one_run(file: Path) -> bool:
    """Whether a program writes a run to several files of which each is read as the whole run.

    Parameters
    ----------
    file : Path
        The file.
    """
    return file.suffix.lower() in OPENFAST or BLADED.fullmatch(file.suffix) is not None


def beside(file: Path) -> list[Path]:
    """All files that the history of a file is read from, itself first.

    Parameters
    ----------
    file : Path
        The file.
    """
    suffix = file.suffix.lower()
    if suffix in (".sel", ".dat", ".int", ".res"):
        more = (".sel", ".dat") if suffix in (".sel", ".dat") else (".sensor",)
        stems = (file.stem.lower(), f"sensor_{file.stem}".lower(), "sensor")
        others = [o for o in sorted(file.parent.iterdir()) if o.stem.lower() in stems]
        others = [o for o in others if o.suffix.lower() in (*more, "")]
    elif BLADED.fullmatch(suffix):
        others = [o for o in sorted(file.parent.iterdir()) if o.stem == file.stem]
        others = [o for o in others if BLADED.fullmatch(o.suffix)]
    else:
        others = []
    return [file, *(other for other in others if other != file and other.is_file())]


def history_digest(file: Path) -> str:
    """SHA-256 of the content of all files that a history is read from.

    Parameters
    ----------
    file : Path
        The file.
    """
    found = [file_digest(str(one)) for one in beside(file)]
    return found[0] if len(found) == 1 else sha256("".join(found).encode()).hexdigest()


def require_kind(file: Path, kind: str = "hub loads") -> None:
    """Refuse a file that is neither of OpenFAST nor a table.

    Parameters
    ----------
    file : Path
        The file.
    kind : str
        What it holds, for messages.

    Raises
    ------
    InputError
        Its suffix is another.
    """
    suffix = file.suffix.lower()
    if suffix in _OTHERWISE:
        raise InputError(f"{kind} '{file}': '{suffix}' is not read: {_OTHERWISE[suffix]}")
    if suffix not in OPENFAST and not is_table(file):
        raise InputError(
            f"{kind} '{file}': the suffix '{file.suffix}' is not one of {', '.join(OPENFAST)} "
            f"(OpenFAST), {', '.join(_KINDS)}, and .%NN, .$PJ (Bladed); convert the file or rename "
            "it"
        )


def history_table(file: Path, kind: str = "hub loads") -> HistoryTable:
    """Open a table of a history.

    Parameters
    ----------
    file : Path
        A table of text (.csv, .tsv, .txt), of Excel (.xlsx), MATLAB (.mat) or Parquet (.parquet);
        results of HAWC2 or BHAWC (.sel, .dat), FLEX (.int, .res) or Bladed (.%NN, .$PJ).
    kind : str
        What it is, for messages.

    Raises
    ------
    InputError
        It cannot be read.
    """
    if BLADED.fullmatch(file.suffix):
        return BladedTable(file, kind)
    return _KINDS.get(file.suffix.lower(), TextTable)(file, kind)
