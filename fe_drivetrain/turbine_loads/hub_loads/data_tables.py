"""Tables of Excel, MATLAB and Parquet; what reads them is imported late."""

from __future__ import annotations

import re
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from datetime import date, datetime, time
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.turbine_loads.hub_loads.channels import is_unit
from fe_drivetrain.turbine_loads.hub_loads.history_table import ArrayTable, CellTable
from fe_drivetrain.turbine_loads.hub_loads.matlab_file import matlab_variables

_MAX_UNPACKED = 4_000_000_000  # bytes of a sheet; a packed one may be a thousand times as large
_SAID = 200  # letters of another project's message
_SAVE_PLAIN = (
    "save plain vectors of one length, as in save('a.mat', 'time_s', 'Mx_kNm'), or a matrix `data` "
    "with cell arrays `names` and `units`"
)


class SheetTable(CellTable):
    """The first sheet of an Excel file (.xlsx) that has cells.

    Parameters
    ----------
    file : Path
        The file.
    kind : str
        What it is, for messages.
    """

    row = "row"

    def __init__(self, file: Path, kind: str) -> None:
        self.file, self.kind = file, kind
        _module("openpyxl", "Excel files", "excel", "save the sheet as CSV")
        stamp = file.stat()
        try:
            self._sheet = _sheet(file, stamp.st_mtime_ns, stamp.st_size)
        except Exception as error:  # another project's package: it may be any
            raise self.cannot(
                f"it cannot be read as an Excel file ({_first_line(error)}): save it again as "
                ".xlsx, or as CSV"
            ) from error
        super().__init__(file, kind)

    def cells(self) -> Iterator[tuple[int, list[str]]]:
        """Number of each row and its cells; those that are empty or comments are left out."""
        for number, values in enumerate(self._sheet, start=1):
            row = [_text(value) for value in values]
            while row and not row[-1].strip():
                row.pop()
            if not row:
                continue
            if row[0].startswith("#"):
                key, equals, value = row[0][1:].partition("=")
                if equals:
                    self.facts[key.strip()] = value.strip()
                continue
            yield number, row


@lru_cache(maxsize=1)  # a history opens its table several times
def _sheet(file: Path, changed: int, size: int) -> list[tuple[object, ...]]:
    """Rows of the first sheet that has cells."""
    with zipfile.ZipFile(file) as packed:
        if sum(one.file_size for one in packed.infolist()) > _MAX_UNPACKED:
            raise ValueError("too large: save it as CSV")
    book = import_module("openpyxl").load_workbook(file, read_only=True, data_only=True)
    sheets = (list(sheet.values) for sheet in book.worksheets)
    return next((rows for rows in sheets if any(map(any, rows))), [])


def _text(value: object) -> str:
    """A cell as text, date-times as ISO 8601 has them."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value)
    if isinstance(value, datetime | date | time):
        return value.isoformat()
    return repr(float(value)) if isinstance(value, int | float) else str(value)


def parquet_table(file: Path, kind: str) -> ArrayTable:
    """A table of Parquet (.parquet).

    Parameters
    ----------
    file : Path
        The file.
    kind : str
        What it is, for messages.

    Raises
    ------
    InputError
        It cannot be read.
    MissingToolError
        There is no pyarrow.
    """
    _module("pyarrow", "Parquet files", "parquet", "save it as CSV")
    parquet = import_module("pyarrow.parquet")
    try:
        found = parquet.read_table(file)
        columns = {name: found[name].to_numpy() for name in found.column_names}
    except Exception as error:  # another project's package: it may be any
        raise InputError(
            f"{kind} '{file}': it cannot be read as Parquet ({_first_line(error)}): write it again"
        ) from error
    return ArrayTable(file, kind, columns)


def matlab_table(file: Path, kind: str) -> ArrayTable:
    """Vectors of one length of a file of MATLAB (.mat).

    Units are behind names (``Mx_kNm``, ``time_s``), or beside a matrix ``data`` of columns with
    ``names`` and ``units``, or in a struct ``units`` by name. Vectors may stand in one struct.

    Parameters
    ----------
    file : Path
        The file, of versions 5 to 7.2.
    kind : str
        What it is, for messages.

    Raises
    ------
    InputError
        It cannot be read, or has no vectors of one length.
    """
    try:
        found = matlab_variables(file.read_bytes())
        columns = _columns_of(found)
    except (ValueError, IndexError, TypeError, zlib.error) as error:
        raise InputError(
            f"{kind} '{file}': it cannot be read as a file of MATLAB ({_first_line(error)}): "
            f"{_SAVE_PLAIN}"
        ) from error
    if not columns:
        raise InputError(
            f"{kind} '{file}': no vectors of one length are in it (it has "
            f"{', '.join(list(found)[:12]) or 'nothing'}); tables and timeseries of MATLAB cannot "
            f"be read elsewhere: {_SAVE_PLAIN}"
        )
    return ArrayTable(file, kind, columns)


def _columns_of(found: Mapping[str, Any]) -> dict[str, NDArray[np.generic]]:
    """Vectors of one length, by title with unit as far as it is known."""
    matrix, names = found.get("data"), found.get("names")
    units = found.get("units")
    if isinstance(matrix, np.ndarray) and matrix.ndim == 2 and names is not None:
        texts = [str(name).strip() for name in np.ravel(np.array(names, dtype=object))]
        known = [""] * len(texts)
        if units is not None and not isinstance(units, Mapping):
            known = [str(unit).strip() for unit in np.ravel(np.array(units, dtype=object))]
        if len(texts) == len(known) == matrix.shape[1]:
            titles = [
                f"{n} [{u}]" if u else _with_unit(n) for n, u in zip(texts, known, strict=True)
            ]
            return dict(zip(titles, matrix.T, strict=True))
    stated = units if isinstance(units, Mapping) else {}
    vectors = {
        f"{name} [{stated[name]}]" if name in stated else _with_unit(name): np.asarray(value)
        for name, value in found.items()
        if isinstance(value, np.ndarray) and value.ndim == 1 and value.dtype.kind in "buif"
    }
    lengths = [len(vector) for vector in vectors.values()]
    most = max(lengths, key=lengths.count, default=0)
    if most > 1 and lengths.count(most) > 1:
        return {title: vector for title, vector in vectors.items() if len(vector) == most}
    structs = [value for value in found.values() if isinstance(value, Mapping)]
    return next((columns for one in structs if (columns := _columns_of(one))), {})


def _with_unit(name: str) -> str:
    """The name of a variable with the unit that stands behind it, as in Mx_kNm."""
    match = re.fullmatch(r"(\w+?)_([A-Za-z]+)", name)
    return f"{match[1]} [{match[2]}]" if match is not None and is_unit(match[2]) else name


def _module(name: str, what: str, extra: str, otherwise: str) -> ModuleType:
    try:
        return import_module(name)
    except ImportError as error:
        raise MissingToolError(
            f'{what} need {name}: install it with pip install "fe-drivetrain[{extra}]", or '
            f"{otherwise}"
        ) from error


def _first_line(error: Exception) -> str:
    """What another project's package says, on one line."""
    text = next(iter(str(error).splitlines()), "") or type(error).__name__
    return "".join(c if c.isprintable() else "?" for c in text)[:_SAID]
