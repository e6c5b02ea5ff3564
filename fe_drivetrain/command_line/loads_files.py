"""Files of ``loads``: its tables as CSV, and as Parquet where that is asked for."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import ModuleType

from fe_drivetrain.command_line.table_files import write_tables
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.load_histories import LoadsResult

_SHOWN = 20
_OF_REACTIONS = ("reactions", "reaction_loops")


def write_loads(
    run: Run, page: Page, result: LoadsResult, parquet: ModuleType | None = None
) -> None:
    """Write the tables of load histories, and list them and the histories on the page.

    Parameters
    ----------
    run : Run
        Its folder takes the files.
    page : Page
        Takes the lists.
    result : LoadsResult
        What was found.
    parquet : module, optional
        Writer of Parquet, of `fe_drivetrain.command_line.table_files.parquet_writer`.
    """
    tables = result.file_tables()
    write_tables(run.folder, tables, _facts(tables, result), parquet)
    page.section("Files")
    names = [name for name, rows in tables.items() if rows]
    page.text(
        f"Tables beside this page: {', '.join(f'{name}.csv' for name in names)}"
        + ("." if parquet is None else ", each as .parquet, too.")
    )
    rows = tables["files"]
    page.table("Histories" + (f": the first {_SHOWN}" if len(rows) > _SHOWN else ""), rows[:_SHOWN])
    page.text(
        "A file that has no wind speed or rotor speed under a known name leaves these cells empty: "
        "name its channels with --channel, as in --channel 'wind speed=Vhub'."
    )


def _facts(tables: Iterable[str], result: LoadsResult) -> dict[str, Mapping[str, str]]:
    """Lines before each table, by its name: of hub loads, of reactions, or of other channels."""
    found: dict[str, Mapping[str, str]] = {}
    of = result.scene_reactions
    shared = {
        "units": "N, N m, s, Hz, rad/s, m/s",
        "channels": " | ".join(result.hub.files.channels),
        "cycles": result.asked.counted,
    }
    for name in tables:
        if name.startswith("other_"):
            found[name] = {**shared, "units": "of channels, those of the files"}
        elif of is not None and name in _OF_REACTIONS:
            found[name] = {**of.stated.facts(), **shared, "model": of.model.title}
        else:
            found[name] = {**result.stated.facts(), **shared}
    if of is not None and "beside" in found:
        of_reactions = {f"{k}, of reactions": v for k, v in of.stated.facts().items()}
        found["beside"] = {**found["beside"], **of_reactions}
    return found
