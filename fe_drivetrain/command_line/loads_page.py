"""The page of ``loads``: what is in anyone's histories, from statistics to load loops."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from types import ModuleType

import numpy as np

from fe_drivetrain.command_line.loads_against import beside
from fe_drivetrain.command_line.loads_counts import counts
from fe_drivetrain.command_line.loads_lifetime import lifetime_section
from fe_drivetrain.command_line.loads_reactions import (
    OF_REACTIONS,
    others_section,
    reactions_section,
)
from fe_drivetrain.command_line.loads_shape import shape
from fe_drivetrain.command_line.loads_tables import write_tables
from fe_drivetrain.report.charts import trace
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.response.stated import Stated, stated_hub_loads
from fe_drivetrain.studies.load_digest import CHANNELS, UNIT_OF
from fe_drivetrain.studies.load_histories import LoadsResult
from fe_drivetrain.studies.load_winds import TURBULENCE_BIN, by_wind
from fe_drivetrain.turbine_loads.histories.sites import WIND_BIN
from fe_drivetrain.turbine_loads.histories.windows import COLUMNS

_SHOWN = 20
_MOST_BINS = 60
_SCALE = {"N": (1e3, "kN"), "N m": (1e3, "kN\u00a0m"), "rad/s": (1.0, "rad/s"), "m/s": (1.0, "m/s")}

Tables = Mapping[str, Sequence[Record]]


def show_loads(
    run: Run, page: Page, result: LoadsResult, parquet: ModuleType | None = None
) -> None:
    """Show what is in load histories, and write its tables.

    Parameters
    ----------
    run : Run
        Its folder takes the tables.
    page : Page
        Takes tables and charts.
    result : LoadsResult
        What was found.
    parquet : module, optional
        Writer of Parquet.
    """
    tables = result.file_tables()
    _channels(page, result)
    _statistics(page, result, tables)
    _capture(page, result, tables)
    shape(page, result)
    counts(page, result)
    if result.scene_reactions is not None:
        reactions_section(page, result, result.scene_reactions)
    others_section(page, result)
    if result.lifetime is not None:
        lifetime_section(page, result.lifetime, result)
    if result.comparison is not None:
        beside(page, result.comparison)
    write_tables(run.folder, tables, _facts(tables, result), parquet)
    _files(page, tables, parquet is not None)


def _files(page: Page, tables: Tables, parquet: bool) -> None:
    """Which tables stand beside the page, and which histories were read."""
    page.section("Files")
    names = [name for name, rows in tables.items() if rows]
    page.text(
        f"Tables beside this page: {', '.join(f'{name}.csv' for name in names)}"
        + (", each as .parquet, too." if parquet else ".")
    )
    rows = tables["files"]
    page.table("Histories" + (f": the first {_SHOWN}" if len(rows) > _SHOWN else ""), rows[:_SHOWN])
    page.text(
        "A file that has no wind speed or rotor speed under a known name leaves these cells empty: "
        "name its channels with --channel, as in --channel 'wind speed=Vhub'."
    )


def _at_hub(result: LoadsResult) -> Stated:
    of = result.scene_reactions
    return stated_hub_loads(None if of is None else of.scene)


def _facts(tables: Iterable[str], result: LoadsResult) -> dict[str, Mapping[str, str]]:
    """Lines before each table, by its name: of hub loads, of reactions, or of other channels."""
    found: dict[str, Mapping[str, str]] = {}
    at_hub, of = _at_hub(result), result.scene_reactions
    shared = {
        "units": "N, N m, s, Hz, rad/s, m/s",
        "channels": " | ".join(result.hub.files.channels),
        "cycles": result.asked.counted,
    }
    for name in tables:
        if name.startswith("other_"):
            found[name] = {**shared, "units": "of channels, those of the files"}
        elif of is not None and name in OF_REACTIONS:
            found[name] = {**of.stated.facts(), **shared, "model": of.model.title}
        else:
            found[name] = {**at_hub.facts(), **shared}
    if of is not None and "beside" in found:
        of_reactions = {f"{k}, of reactions": v for k, v in of.stated.facts().items()}
        found["beside"] = {**found["beside"], **of_reactions}
    return found


def _channels(page: Page, result: LoadsResult) -> None:
    """Frame and origin, and what was read."""
    page.section("Frame and channels")
    page.text(_at_hub(result).sentences())
    page.table(
        "What the loads were read from",
        [
            {"channels": channels, "files": number}
            for channels, number in list(result.hub.files.channels.items())[:_SHOWN]
        ],
    )


def _statistics(page: Page, result: LoadsResult, tables: Tables) -> None:
    page.section("Statistics")
    statistics = result.hub.statistics
    rows = [_row(name, row) for name, row in zip(CHANNELS, statistics.overall, strict=True)]
    page.table("All samples together", [row for row in rows if row is not None])
    conditions = by_wind(statistics)
    if not conditions:
        return
    rows_by_wind: list[Record] = []
    for one in conditions:
        for name in ("Fx", "Mx", "radial force", "bending moment"):
            row = _row(name, one.statistics[CHANNELS.index(name)])
            if row is not None:
                rows_by_wind.append({"wind [m/s]": one.wind, "windows": one.windows, **row})
    page.table(f"By mean wind speed in {WIND_BIN:g} m/s", rows_by_wind)
    _shown_turbulence(page, tables["wind_and_turbulence"])
    windows = statistics.joined.values
    wind = windows[:, CHANNELS.index("wind speed"), 1]
    values = windows[:, CHANNELS.index("bending moment")] / 1e3
    page.chart(
        "Bending moment at the hub in each window of ten minutes",
        [trace(name, wind, values[:, k], points=True) for k, name in enumerate(COLUMNS[:3])],
        "mean wind speed [m/s]",
        "bending moment [kN m]",
    )


def _shown_turbulence(page: Page, every: Sequence[Record]) -> None:
    """The bending moment by wind and turbulence; all channels are in a file."""
    rows = [
        {
            "wind [m/s]": row["wind [m/s]"],
            "turbulence [%]": 100.0 * float(row["turbulence [-]"]),
            "windows": row["windows"],
            **{f"{name} [kN m]": float(row[name]) / 1e3 for name in COLUMNS},
        }
        for row in every
        if row["channel"] == "bending moment"
    ]
    page.table(
        f"Bending moment by mean wind speed and turbulence intensity in {100 * TURBULENCE_BIN:g} "
        "%; every channel is in wind_and_turbulence.csv",
        rows[:_MOST_BINS],
    )


def _row(name: str, values: Sequence[float]) -> Record | None:
    if np.isnan(values).any():
        return None
    factor, unit = _SCALE[UNIT_OF[name]]
    shown = [float(v) / factor for v in values]
    return {"channel": f"{name} [{unit}]", **dict(zip(COLUMNS, shown, strict=True))}


def _capture(page: Page, result: LoadsResult, tables: Tables) -> None:
    """Windows by wind speed and turbulence."""
    page.section("Capture matrix")
    capture = result.capture
    if capture is None:
        page.text("No file has a wind speed, so that windows cannot be sorted by it.")
        return
    page.table(
        f"Windows by mean wind speed and turbulence intensity; {capture.target.windows} of each "
        "wind speed are asked for (IEC 61400-1 asks for six ten-minute series; --target takes "
        "another number, --winds the range of wind speeds)",
        tables["capture_matrix"],
    )
    if capture.unknown:
        page.text(f"{capture.unknown} windows have no wind speed.")
