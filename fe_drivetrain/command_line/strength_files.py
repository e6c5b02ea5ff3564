"""Files of ``strength``: its tables as CSV."""

from __future__ import annotations

from fe_drivetrain.command_line.table_files import write_tables
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.shaft_strength import StrengthResult

_TABLES = ("sections", "stresses", "joints", "histories")


def write_strength(run: Run, page: Page, result: StrengthResult) -> None:
    """Write the tables of a shaft's strength, and list them on the page.

    Parameters
    ----------
    run : Run
        Its folder takes the files.
    page : Page
        Takes the list.
    result : StrengthResult
        What was found.
    """
    tables = {name: result.tables[name] for name in _TABLES}
    facts = {"units": "as in the heads of columns", "x": "along the shaft, downwind"}
    write_tables(run.folder, tables, dict.fromkeys(tables, facts))
    page.section("Tables")
    names = ", ".join(f"{name}.csv" for name, rows in tables.items() if rows)
    page.text(f"Beside this page: {names}, and results.json with the numbers of all charts.")
