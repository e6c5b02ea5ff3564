"""Files of ``life``: its tables as CSV."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from itertools import chain, count
from pathlib import Path

import numpy as np

from fe_drivetrain.command_line.table_files import write_tables
from fe_drivetrain.common.csv_cells import comment_line, table_row
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.response.stated import HUB_LOADS
from fe_drivetrain.studies.bearing_lives import LifeResult
from fe_drivetrain.studies.life_series import LoadSeries, has_series
from fe_drivetrain.turbine_loads.hub_loads.recorded import short_name


class SeriesFiles:
    """Files of loads over time, each written as it comes.

    Parameters
    ----------
    files : sequence of Path
        All files with hub loads, whose names tell them apart.
    """

    def __init__(self, files: Sequence[Path]) -> None:
        self._files = files
        self.written: list[Record] = []

    def into(self, folder: Path) -> Callable[[LoadSeries], None]:
        """What writes a series to a folder.

        Parameters
        ----------
        folder : Path
            Takes series_BEARING_FILE.csv.
        """
        return lambda series: self._write(folder, series)

    def _write(self, folder: Path, series: LoadSeries) -> None:
        history = short_name(series.file, self._files)
        words = [
            re.sub(r"[^\w.-]+", "-", word)
            for word in (series.bearing, history.removesuffix(".csv"))
        ]
        stem = f"series_{'_'.join(words)}"
        used = {row["file"] for row in self.written}
        # names that differ only where no file's name may
        numbered = (f"{stem}_{k}.csv" for k in count(2))
        name = next(one for one in chain([f"{stem}.csv"], numbered) if one not in used)
        facts = {
            "bearing": series.bearing,
            "file": history,
            "raceway": "sum of the contact loads of all rolling elements of the row",
            "places": "held; 0 right, 90 deg on top, looking downwind",
        }
        np.savetxt(
            folder / name,
            np.column_stack([series.time, series.values]),
            delimiter=",",
            fmt="%.9g",
            header="\n".join(
                [
                    *(comment_line(f"{fact} = {value}") for fact, value in facts.items()),
                    table_row(["time [s]", *series.columns]),
                ]
            ),
            comments="",
            encoding="utf-8",
        )
        self.written.append(
            {"bearing": series.bearing, "history": history, "file": name, "rows": len(series.time)}
        )


def write_life(run: Run, page: Page, result: LifeResult, series: Sequence[Record] = ()) -> None:
    """Write the tables of lives, and list them on the page.

    Parameters
    ----------
    run : Run
        Its folder takes the files.
    page : Page
        Takes the list.
    result : LifeResult
        What was found.
    series : sequence of dict
        Files of loads over time, see `SeriesFiles.written`.
    """
    known = result.all_tables()
    tables: dict[str, list[Record]] = {
        name: known[name]
        for name in ("lives", "events", "levels", "files", "winds", "places", "rollers", "laminae")
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
    if series:
        page.table("Loads over time, a file for each bearing and each file of loads", series)
        left = [life.name for life in result.lives if not has_series(life.bearing)]
        if left:
            page.text(
                f"No loads over time of {', '.join(left)}: they go with the planets' carrier, too."
            )
    page.text(f"Beside this page: {names}, and results.json with the numbers of all charts.")
