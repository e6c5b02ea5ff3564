"""Tables as loggers, spreadsheets and MATLAB write them: one history in each of many forms."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pytest
from hub_load_tables import LOADS, NAMES, TIME, table_cells

from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.turbine_loads.hub_loads import data_tables
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap
from fe_drivetrain.turbine_loads.hub_loads.csv_table import read_csv
from fe_drivetrain.turbine_loads.hub_loads.files import hub_load_files, read_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.matlab_file import matlab_variables
from fe_drivetrain.turbine_loads.hub_loads.number_forms import NumberForm
from fe_drivetrain.turbine_loads.hub_loads.recorded import read_recorded
from fe_drivetrain.turbine_loads.hub_loads.table_kinds import history_table

UNITS = ["s", *["kN"] * 3, *["kN m"] * 3]
HEAD = [f"{name} [{unit}]" for name, unit in zip(["time", *NAMES], UNITS, strict=True)]
BEHIND = ["Zeit / s", *(title.replace(" [", " in ")[:-1] for title in HEAD[1:])]
GERMAN = ["Zeit [s]", *HEAD[1:], "L\xfcfter"]
START = datetime(2024, 2, 28, 23, 59, 55)


def right(path: Path, mapping: ChannelMap | None = None) -> str:
    """The history is that of the cells, read as hub loads and by a mapping; how it was read."""
    found = read_recorded(path, mapping or ChannelMap()).history
    for history in (found, *([] if mapping else [read_hub_loads(path)])):
        np.testing.assert_allclose(history.time, TIME, atol=1e-9)
        np.testing.assert_allclose(history.loads, LOADS, rtol=1e-7, atol=1e-3)
    return str(found.attributes["channels"])


def text(path: Path, lines: list[list[str]], between: str = ",", code: str = "utf-8") -> Path:
    path.write_bytes("".join(f"{between.join(line)}\n" for line in lines).encode(code))
    return path


def quoted(form: str) -> list[list[str]]:
    return [[f'"{cell}"' for cell in row] for row in table_cells(form)]


def commas(form: str = "{:.9g}") -> list[list[str]]:
    return [[cell.replace(".", ",") for cell in row] for row in table_cells(form)]


def german(form: str) -> list[list[str]]:
    """With a comma before decimals and a point between thousands."""
    swap = str.maketrans(",.", ".,")
    return [[cell.translate(swap) for cell in row] for row in table_cells(form)]


FORMS: dict[str, Callable[[Path], Path]] = {
    "units in a second row": lambda p: text(p / "a.csv", [["Time", *NAMES], UNITS, *table_cells()]),
    "units in brackets in a second row": lambda p: text(
        p / "a.csv", [["Time", *NAMES], [f"[{u}]" for u in UNITS], *table_cells()]
    ),
    "tabs": lambda p: text(p / "a.csv", [HEAD, *table_cells()], "\t"),
    "tabs, .tsv": lambda p: text(p / "a.tsv", [HEAD, *table_cells()], "\t"),
    "semicolons, .txt": lambda p: text(p / "a.txt", [HEAD, *table_cells()], ";"),
    "sep=,": lambda p: text(p / "a.csv", [["sep=,"], HEAD, *table_cells()]),
    "sep=;": lambda p: text(p / "a.csv", [["sep=;"], HEAD, *table_cells()], ";"),
    "sep=tab": lambda p: text(p / "a.csv", [["sep=\t"], HEAD, *table_cells()], "\t"),
    "decimal commas": lambda p: text(p / "a.csv", [HEAD, *commas()], ";"),
    "decimal commas with exponents": lambda p: text(p / "a.csv", [HEAD, *commas("{:.8E}")], ";"),
    "decimal commas in quotes": lambda p: text(
        p / "a.csv", [HEAD, *[[f'"{cell}"' for cell in row] for row in commas()]]
    ),
    "thousands": lambda p: text(p / "a.csv", [HEAD, *quoted("{:,.6f}")]),
    "thousands with points": lambda p: text(p / "a.csv", [HEAD, *german("{:,.6f}")], ";"),
    "thousands with apostrophes": lambda p: text(
        p / "a.csv", [HEAD, *[[c.replace(",", "'") for c in r] for r in table_cells("{:,.6f}")]]
    ),
    "units behind names": lambda p: text(
        p / "a.csv",
        [["Zeit / s", *(t.replace(" [", " in ")[:-1] for t in HEAD[1:])], *table_cells()],
    ),
    "German, code page 1252": lambda p: text(
        p / "a.csv",
        [["Zeit [s]", *HEAD[1:], "L\xfcfter"], *[[*r, ""] for r in commas()]],
        ";",
        "cp1252",
    ),
    "UTF-16 of spreadsheets": lambda p: text(p / "a.csv", [HEAD, *commas()], "\t", "utf-16"),
    "date-times under time [s]": lambda p: stamped(p, "%Y-%m-%d %H:%M:%S.%f"),
    "German date-times": lambda p: stamped(p, "%d.%m.%Y %H:%M:%S,%f", "Zeitstempel", commas(), ";"),
    "date-times of a logger with four rows of header": lambda p: logged(p),
    "date-times with slashes": lambda p: stamped(p, "%Y/%m/%d %H:%M:%S.%f", "timestamp"),
}


def logged(path: Path) -> Path:
    file = stamped(path, '"%Y-%m-%d %H:%M:%S.%f"')
    _, *lines = file.read_text().splitlines()
    head = ['"TOA5","mast","CR1000","1"', ",".join(f'"{n}"' for n in ("TIMESTAMP", *NAMES))]
    head += [",".join(f'"{unit}"' for unit in ("TS", *UNITS[1:])), '"","Avg","Avg"']
    file.write_text("\n".join([*head, *lines, ""]))
    return file


def stamped(
    path: Path,
    form: str,
    title: str = "Time [s]",
    rows: list[list[str]] | None = None,
    between: str = ",",
) -> Path:
    times = [(START + timedelta(seconds=float(t))).strftime(form) for t in TIME]
    cells = [[t, *row[1:]] for t, row in zip(times, rows or table_cells(), strict=True)]
    return text(path / "a.csv", [[title, *HEAD[1:]], *cells], between)


@pytest.mark.parametrize("form", FORMS)
def test_one_history_is_read_in_each_form(tmp_path: Path, form: str) -> None:
    read = right(FORMS[form](tmp_path))
    assert ("0 s at 2024-02-28T23:59:55" in read) is ("date-times" in form)


def test_times_of_day(tmp_path: Path) -> None:
    cells = [[f"9:00:{t:06.3f}", *row[1:]] for t, row in zip(TIME, table_cells(), strict=True)]
    right(text(tmp_path / "a.csv", [["Uhrzeit", *HEAD[1:]], *cells]))


@pytest.mark.parametrize(
    ("cells", "numbers"),
    [
        (["1,5", "1.234"], None),
        (["1,5", "1.234.567,25"], [1.5, 1234567.25]),
        (["1.234.567", "2.000"], [1234567.0, 2000.0]),
        (["1,234,567.5", "-2,000"], [1234567.5, -2000.0]),
        (["1 234,5", "2\u202f000"], [1234.5, 2000.0]),
        (["1,234", "2"], None),
        (["1.234", "2"], [1.234, 2.0]),
        (["0,234", "12,345"], [0.234, 12.345]),
        (["1,234E+03", "2"], [1234.0, 2.0]),
        (["1,23,4", "2"], None),
    ],
)
def test_what_commas_and_points_mean(cells: list[str], numbers: list[float] | None) -> None:
    form = NumberForm()
    for cell in cells:
        form.learn(cell)
    if numbers is None:
        with pytest.raises(ValueError, match=r"\d"):
            [form(cell) for cell in cells]
    else:
        assert [form(cell) for cell in cells] == numbers


def test_a_column_of_three_decimals_has_the_comma_of_its_neighbours(tmp_path: Path) -> None:
    """Alone it may be of thousands; dates and words beside it say nothing."""
    file = tmp_path / "a.csv"
    head = "time [s];day;note;wind speed [m/s];" + ";".join(HEAD[1:])
    rows = [f"{t},0;1.3.2024;a.b;9,{t}19;0,5;0;-4,25;1;0;0" for t in range(5)]
    file.write_text("\n".join([head, *rows]) + "\n")
    found = history_table(file).columns([3], [])
    np.testing.assert_array_equal(found.values[3], [9.019, 9.119, 9.219, 9.319, 9.419])


@pytest.mark.parametrize("measured", [False, True])
@pytest.mark.parametrize("between", ["|", " : "])
def test_a_header_of_one_column_names_what_may_stand_between(
    tmp_path: Path, measured: bool, between: str
) -> None:
    file = tmp_path / "a.csv"
    file.write_text(between.join(HEAD) + "\n" + between.join("1" * len(HEAD)) + "\n")
    with pytest.raises(InputError, match=r"one column, .*: put commas, semicolons or tabs"):
        read_csv(file, measured)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        (
            {(4, 2): "abc"},
            "line 6, column Fy: 'abc' is not a number: correct it, or remove the line",
        ),
        ({(4, 2): ""}, "line 6, column Fy: '' is not a number: fill the cell, or remove the line"),
        ({(4, 2): "nan"}, r"Fy is nan at line 6 \(t = 2 s\).*so repair it or cut"),
        (
            {(4, 0): "1.5"},
            r"time does not increase after line 5 .*the next is 1.5 s; sort the samp",
        ),
        ({(4, 0): "0.5"}, "time does not increase after line 5 .*remove repeated ones"),
        ({(4, 0): "1/2/2024 12:00"}, "line 6, column time: '1/2/2024 12:00' may have the day or"),
        ({(4, 0): "1.75"}, r"the time step after line 5 .* is 0.25 s .*resample"),
    ],
)
@pytest.mark.parametrize("mapped", [False, True])
def test_a_fault_is_named_with_line_and_cure(
    tmp_path: Path, changes: dict[tuple[int, int], str], says: str, mapped: bool
) -> None:
    cells = table_cells()
    for (row, column), cell in changes.items():
        cells[row][column] = cell
    mapping = ChannelMap(channels={"Fy": "Fy", "time": "time"} if mapped else {})
    with pytest.raises(InputError, match=says):
        read_recorded(text(tmp_path / "a.csv", [HEAD, *cells]), mapping)


def test_a_mapping_gives_units_that_a_table_lacks(tmp_path: Path) -> None:
    file = text(tmp_path / "a.csv", [["time [s]", "Fx", *HEAD[2:]], *table_cells()])
    with pytest.raises(InputError, match="column 'Fx' has no unit"):
        read_hub_loads(file)
    right(file, ChannelMap(units={"Fx": "kN"}))


def test_a_folder_of_other_tables_is_read_where_none_is_usual(tmp_path: Path) -> None:
    tables = [text(tmp_path / f"{k}.tsv", [HEAD, *table_cells()], "\t") for k in "ab"]
    (tmp_path / "readme.txt").write_text("none")
    assert hub_load_files(str(tmp_path)) == hub_load_files(str(tmp_path / "*")) == tables
    usual = text(tmp_path / "c.csv", [HEAD, *table_cells()])
    assert hub_load_files(str(tmp_path)) == hub_load_files(str(tmp_path / "*")) == [usual]
    assert hub_load_files(str(tmp_path / "*.tsv")) == tables


# --- Excel, MATLAB, Parquet ----------------------------------------------------------------------


@pytest.mark.needs("openpyxl")
@pytest.mark.parametrize("units_below", [False, True])
@pytest.mark.parametrize("stamps", [False, True])
def test_sheets_of_excel(tmp_path: Path, units_below: bool, stamps: bool) -> None:
    import openpyxl

    book = openpyxl.Workbook()
    sheet = book.create_sheet("loads")
    for row in [["Time", *NAMES], UNITS] if units_below else [HEAD]:
        sheet.append(row)
    for time, *loads in np.column_stack([TIME, 1e-3 * LOADS]).tolist():
        sheet.append([START + timedelta(seconds=time) if stamps else time, *loads])
    book.save(tmp_path / "a.xlsx")
    assert ("0 s at 2024-02-28T23:59:55" in right(tmp_path / "a.xlsx")) is stamps
    sheet["C7"] = "fault"
    book.save(tmp_path / "a.xlsx")
    with pytest.raises(InputError, match="row 7, column Fy: 'fault' is not a number: correct it"):
        read_hub_loads(tmp_path / "a.xlsx")
    (tmp_path / "a.xlsx").write_bytes(b"PK\3\4 no workbook")
    with pytest.raises(InputError, match=r"cannot be read as an Excel file .*or as CSV"):
        read_hub_loads(tmp_path / "a.xlsx")


def test_what_reads_a_kind_of_table_may_be_absent(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def none(name: str) -> None:
        raise ImportError(name)

    monkeypatch.setattr(data_tables, "import_module", none)
    for suffix, extra in ((".xlsx", "excel"), (".parquet", "parquet")):
        (tmp_path / f"a{suffix}").write_bytes(b"")
        with pytest.raises(MissingToolError, match=rf'install "fe-drivetrain\[{extra}\]", or save'):
            read_hub_loads(tmp_path / f"a{suffix}")


def vectors() -> dict[str, np.ndarray]:
    names = [f"{n}_{'kN' if n[0] == 'F' else 'kNm'}" for n in NAMES]
    return {"time_s": TIME, **dict(zip(names, 1e-3 * LOADS.T, strict=True))}


@pytest.mark.parametrize("form", ["vectors", "struct", "matrix", "units"])
def test_vectors_of_matlab(tmp_path: Path, form: str) -> None:
    from scipy.io import savemat

    matrix = np.column_stack([TIME, 1e-3 * LOADS])
    cells = np.array(["time", *NAMES], dtype=object)
    content = {
        "vectors": {**vectors(), "about": "a note", "rate": 2.0},
        "struct": {"run": vectors()},
        "matrix": {"data": matrix, "names": cells, "units": np.array(UNITS, dtype=object)},
        "units": {
            **dict(zip(cells, matrix.T, strict=True)),
            "units": dict(zip(cells, [u.replace(" ", "") for u in UNITS], strict=True)),
        },
    }[form]
    savemat(tmp_path / "a.mat", content)
    right(tmp_path / "a.mat")


@pytest.mark.parametrize("packed", [False, True])
def test_variables_of_matlab_are_those_that_scipy_reads(tmp_path: Path, packed: bool) -> None:
    from scipy.io import loadmat, savemat

    kinds = [
        np.arange(6, dtype=kind).reshape(2, 3) for kind in ("i1", "u2", "i4", "f4", "f8", "i8")
    ]
    content = {f"a{k}": values for k, values in enumerate(kinds)} | {
        "text": "L\xfcfter",
        "struct": {"x": np.arange(3.0), "inner": {"y": np.array([1.5, 2.5]), "note": "z"}},
        "cells": np.array(["one", "two"], dtype=object),
        "complex": np.array([1.0 + 2.0j, 3.0]),
    }
    savemat(tmp_path / "a.mat", content, do_compression=packed)
    found = matlab_variables((tmp_path / "a.mat").read_bytes())
    peer = loadmat(tmp_path / "a.mat", simplify_cells=True)
    assert found["complex"] is None
    assert (found["text"], found["cells"]) == (peer["text"], list(peer["cells"]))
    assert found["struct"]["inner"]["note"] == peer["struct"]["inner"]["note"] == "z"
    for name in content.keys() - {"complex", "text", "cells", "struct"}:
        np.testing.assert_array_equal(found[name], peer[name])
    np.testing.assert_array_equal(found["struct"]["x"], peer["struct"]["x"])
    np.testing.assert_array_equal(found["struct"]["inner"]["y"], peer["struct"]["inner"]["y"])


def test_files_of_matlab_without_vectors_say_what_to_save(tmp_path: Path) -> None:
    from scipy.io import savemat

    savemat(tmp_path / "a.mat", {"text": "none", "one": 1.0})
    with pytest.raises(InputError, match=r"no vectors of one length .*it has text, one.*save"):
        read_hub_loads(tmp_path / "a.mat")
    (tmp_path / "a.mat").write_bytes(b"MATLAB 5.0 MAT-file, but not one" * 9)
    with pytest.raises(InputError, match=r"cannot be read as a file of MATLAB .*save plain vec"):
        read_hub_loads(tmp_path / "a.mat")


def test_files_of_matlab_7_3_are_to_be_saved_as_7(tmp_path: Path) -> None:
    (tmp_path / "a.mat").write_bytes(b"MATLAB 7.3 MAT-file".ljust(512) + b"\x89HDF\r\n\x1a\n")
    with pytest.raises(InputError, match=r"it is of version 7\.3: save it with '-v7'"):
        read_hub_loads(tmp_path / "a.mat")


@pytest.mark.needs("pyarrow")
@pytest.mark.parametrize("stamps", [False, True])
def test_tables_of_parquet(tmp_path: Path, stamps: bool) -> None:
    import pyarrow
    from pyarrow import parquet

    start = np.datetime64(START, "ns")
    time = start + (1e9 * TIME).astype("timedelta64[ns]") if stamps else TIME
    columns = dict(zip(HEAD, [time, *(1e-3 * LOADS.T)], strict=True))
    parquet.write_table(pyarrow.table(columns), tmp_path / "a.parquet")
    right(tmp_path / "a.parquet")
    (tmp_path / "a.parquet").write_bytes(b"PAR1 no table PAR1")
    with pytest.raises(InputError, match=r"cannot be read as Parquet .*write it again"):
        read_hub_loads(tmp_path / "a.parquet")
