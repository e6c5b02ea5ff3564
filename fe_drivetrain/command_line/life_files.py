"""Files of ``life``: its tables as CSV."""

from __future__ import annotations

from fe_drivetrain.command_line.table_files import write_tables
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.response.stated import HUB_LOADS
from fe_drivetrain.studies.bearing_lives import LifeResult


def write_life(run: Run, page: Page, result: LifeResult) -> None:
    """Write the tables of lives, and list them on the page.

    Parameters
    ----------
    run : Run
        Its folder takes the files.
    page : Page
        Takes the list.
    result : LifeResult
        What was found.
    """
    known = result.all_tables()
    tables: dict[str, list[Record]] = {
        name: known[name]
        for name in ("lives", "events", "levels", "files", "winds", "places", "laminae")
        if name in known
    }
    facts = {
        "frame": f"{HUB_LOADS.frame}; places of rollers: 0 right, 90 deg on top; of planets "
        "0 towards the sun, 90 deg along the tangent",
        "units": "as in the heads of columns",
        "lives": "with 90 % reliability but for a_1 of modified ones",
    }
    write_tables(run.folder, tables, dict.fromkeys(tables, facts))
    page.section("Tables")
    names = ", ".join(f"{name}.csv" for name, rows in tables.items() if rows)
    page.text(f"Beside this page: {names}, and results.json with the numbers of all charts.")
