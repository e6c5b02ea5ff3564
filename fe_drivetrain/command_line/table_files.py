"""Tables as CSV, and as Parquet where pyarrow is installed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import ModuleType

from fe_drivetrain.common.csv_cells import SafeWriter
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.report.suite.records import Record


def parquet_writer() -> ModuleType:
    """The package that writes Parquet, imported when it is asked for.

    Raises
    ------
    InputError
        It is not installed, or does not work.
    """
    try:
        import pyarrow.parquet
    except ImportError as error:
        reason = str(error).splitlines()[0] if str(error) else "no reason given"
        raise InputError(
            f"--parquet needs pyarrow, which cannot be imported ({reason}): install it with pip "
            "install 'fe-drivetrain[parquet]', or leave --parquet out, since the CSV files hold "
            "the same"
        ) from error
    return pyarrow.parquet  # type: ignore[no-any-return]


def write_tables(
    folder: Path,
    tables: Mapping[str, Sequence[Record]],
    facts: Mapping[str, Mapping[str, str]],
    parquet: ModuleType | None = None,
) -> None:
    """Write tables, one file each.

    Parameters
    ----------
    folder : Path
        Takes NAME.csv, and NAME.parquet.
    tables : mapping
        Rows of equal keys, by name; tables without rows are left out.
    facts : mapping
        Lines "# key = value" above each CSV, and metadata of each Parquet file, by the table's
        name.
    parquet : module, optional
        Of `parquet_writer`.
    """
    for name, rows in tables.items():
        if not rows:
            continue
        columns = list(rows[0])
        with (folder / f"{name}.csv").open("w", encoding="utf-8", newline="") as file:
            writer = SafeWriter(file)
            writer.comments(f"{key} = {value}" for key, value in facts[name].items())
            writer.writerow(columns)
            writer.writerows([_cell(row[column]) for column in columns] for row in rows)
        if parquet is not None:
            import pyarrow

            table = pyarrow.table({column: [row[column] for row in rows] for column in columns})
            table = table.replace_schema_metadata(dict(facts[name]))
            parquet.write_table(table, folder / f"{name}.parquet")


def _cell(value: object) -> object:
    if value is None:
        return ""
    return f"{value:.9g}" if isinstance(value, float) else value
