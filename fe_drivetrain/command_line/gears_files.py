"""Files of ``gears``: its tables as CSV."""

from __future__ import annotations

from fe_drivetrain.command_line.table_files import write_tables
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.gear_ratings import GearsResult

LOSS_TABLES = ("losses", "shaft_torques", "loss_levels", "losses_over_torque")
_TABLES = ("gears", "meshes", "levels", "sharing", "face", "ring", "spectrum", *LOSS_TABLES)


def write_gears(run: Run, page: Page, result: GearsResult) -> None:
    """Write the tables of a rating, and list them on the page.

    Parameters
    ----------
    run : Run
        Its folder takes the files.
    page : Page
        Takes the list.
    result : GearsResult
        What was found.
    """
    known = result.all_tables()
    tables: dict[str, list[Record]] = {name: known.get(name, []) for name in _TABLES}
    facts = {
        "units": "as in the heads of columns",
        "face": "-0.5 is the end at the smallest x, upwind; loads over the mean of all planets",
        "azimuth": "of the rotor, from y to z, where the first planet is on y at 0 deg",
    }
    write_tables(run.folder, tables, dict.fromkeys(tables, facts))
    page.section("Tables")
    names = ", ".join(f"{name}.csv" for name, rows in tables.items() if rows)
    page.text(f"Beside this page: {names}, and results.json with the numbers of all charts.")
