"""Tables of Excel, MATLAB, Parquet and HDF5; what reads them is imported late."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Iterator, Mapping
from datetime import date, datetime, time
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.turbine_loads.hub_loads.channels import is_load_unit, is_unit
from fe_drivetrain.turbine_loads.hub_loads.history_table import ArrayTable, CellTable
from fe_drivetrain.turbine_loads.hub_loads.matlab_file import matlab_variables
from fe_drivetrain.turbine_loads.hub_loads.run_files import hawc2_name
from fe_drivetrain.turbine_loads.hub_loads.run_table import distinct, map_loads

_MAX_UNPACKED = 4_000_000_000  # bytes of a sheet; a packed one may be a thousand times as large
_HDF5, _HDF5_AT = b"\x89HDF\r\n\x1a\n", 512  # how files of MATLAB 7.3 begin, and where
_CLOCK = (("time_step", 1.0), ("time_start", 0.0))
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
        openpyxl = _module("openpyxl", "Excel files", "excel", "save the sheet as CSV")
        try:
            with zipfile.ZipFile(file) as packed:
                if sum(one.file_size for one in packed.infolist()) > _MAX_UNPACKED:
                    raise ValueError("too large: save it as CSV")
            book = openpyxl.load_workbook(file, read_only=True, data_only=True)
            sheets = (list(sheet.values) for sheet in book.worksheets)
            self._sheet = next((rows for rows in sheets if any(map(any, rows))), [])
        except Exception as error:  # another project's package: it may be any
            raise self.cannot(
                f"it cannot be read as an Excel file ({error or type(error).__name__}): save it "
                "again as .xlsx, or as CSV"
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


def hdf5_table(file: Path, kind: str) -> ArrayTable:
    """Results of HAWC2 in HDF5, DTU's general time series data format (gtsdf).

    Parameters
    ----------
    file : Path
        The file (.hdf5).
    kind : str
        What it is, for messages.

    Raises
    ------
    InputError
        It cannot be read.
    MissingToolError
        There is no h5py.
    """
    h5py = _module("h5py", "results in HDF5", "hdf5", "let HAWC2 write hawc_binary")
    try:
        with h5py.File(file, "r") as store:
            names = [_plain_text(name) for name in store["attribute_names"]]
            units = [_plain_text(unit) for unit in store["attribute_units"]]
            about = [_plain_text(one) for one in store["attribute_descriptions"]]
            blocks = [store[name] for name in sorted(store) if name.startswith("block")]
            time = np.concatenate([_block_time(block) for block in blocks])
            table = np.concatenate([_block_data(block) for block in blocks])
    except Exception as error:  # another project's package: it may be any
        raise InputError(
            f"{kind} '{file}': it cannot be read as a result of HAWC2 in HDF5 "
            f"({_first_line(error)}): write it again"
        ) from error
    run = zip(names, units, about, table.T, strict=False)
    named = [(hawc2_name(name, text), unit, values) for name, unit, text, values in run]
    titles = distinct([name for name, _, _ in named])
    columns = {
        f"{title} [{unit}]" if unit not in ("", "-") else title: values
        for title, (_, unit, values) in zip(titles, named, strict=True)
    }
    found = {"Time [s]": time, **{t: v for t, v in columns.items() if t.lower() != "time [s]"}}
    opened = ArrayTable(file, kind, found, {"program": "HAWC2"})
    opened.frame_known = False
    opened.advice = map_loads([one for one in opened.titles if is_load_unit(one)])
    return opened


def _plain_text(value: Any) -> str:
    return (value.decode() if isinstance(value, bytes) else str(value)).strip()


def _block_time(block: Any) -> NDArray[np.float64]:
    """Times of a block [s]: its own, or counted by its step."""
    count = len(block["data"])
    ticks = block["time"][()] if "time" in block else np.arange(count)
    step, start = (block.attrs.get(name, usual) for name, usual in _CLOCK)
    return np.asarray(ticks * float(step) + float(start), dtype=float)


def _block_data(block: Any) -> NDArray[np.float64]:
    """Samples of a block: numbers, or integers with gains and offsets, the largest for none."""
    data = block["data"][()]
    values = np.asarray(data, dtype=float)
    if data.dtype.kind in "iu":
        values[data == np.iinfo(data.dtype).max] = np.nan
    gains = block["gains"][()] if "gains" in block else 1.0
    return np.asarray(values * gains + (block["offsets"][()] if "offsets" in block else 0.0))


def matlab_table(file: Path, kind: str) -> ArrayTable:
    """Vectors of one length of a file of MATLAB (.mat).

    Units are behind names (``Mx_kNm``, ``time_s``), or beside a matrix ``data`` of columns with
    ``names`` and ``units``, or in a struct ``units`` by name. Vectors may stand in one struct.

    Parameters
    ----------
    file : Path
        The file, of any version of MATLAB; version 7.3 needs h5py.
    kind : str
        What it is, for messages.

    Raises
    ------
    InputError
        It cannot be read, or has no vectors of one length.
    MissingToolError
        There is no h5py, and the file is of version 7.3.
    """
    try:
        found = _variables(file)
        columns = _columns_of(found)
    except MissingToolError:
        raise
    except Exception as error:  # another project's package: it may be any
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


def _variables(file: Path) -> dict[str, Any]:
    """Variables of a file by name, structs as dicts and cells as lists."""
    content = file.read_bytes()
    if content[_HDF5_AT : _HDF5_AT + len(_HDF5)] != _HDF5:
        return matlab_variables(content)
    h5py = _module("h5py", "files of MATLAB 7.3", "hdf5", "save with '-v7'")
    with h5py.File(file, "r") as store:
        return {name: _of_hdf5(h5py, store, store[name]) for name in store if name[0] != "#"}


def _of_hdf5(h5py: ModuleType, store: Any, one: Any) -> Any:
    """A struct as a dict, text as text, cells as lists, and an array in MATLAB's order."""
    if isinstance(one, h5py.Group):
        return {name: _of_hdf5(h5py, store, one[name]) for name in one}
    values = one[()]
    if one.dtype == h5py.ref_dtype:
        return [_of_hdf5(h5py, store, store[reference]) for reference in np.ravel(values)]
    if one.attrs.get("MATLAB_class") == b"char":
        return "".join(map(chr, np.ravel(values)))
    return np.squeeze(np.transpose(values))


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
    return next(iter(str(error).splitlines()), "") or type(error).__name__
