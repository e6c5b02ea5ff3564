"""The page of ``loads``: what is in anyone's histories, from statistics to load loops."""

from __future__ import annotations

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.pages.loads_against import beside
from fe_drivetrain.pages.loads_counts import counts
from fe_drivetrain.pages.loads_lifetime import lifetime_section
from fe_drivetrain.pages.loads_reactions import others_section, reactions_section
from fe_drivetrain.pages.loads_shape import shape
from fe_drivetrain.report.charts import trace
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.load_digest import UNIT_OF
from fe_drivetrain.studies.load_histories import LoadsResult
from fe_drivetrain.studies.load_tables import capture_rows
from fe_drivetrain.studies.load_winds import TURBULENCE_BIN
from fe_drivetrain.studies.shown_units import shown_unit
from fe_drivetrain.studies.wind_statistics import bending_rows, channel_rows, wind_rows
from fe_drivetrain.turbine_loads.histories.sites import WIND_BIN
from fe_drivetrain.turbine_loads.histories.windows import COLUMNS

_SHOWN = 20
_MAX_BINS = 60
_MEAN = COLUMNS.index("mean")


def show_loads(run: Run, page: Page, result: LoadsResult) -> None:
    """Show what is in load histories.

    Parameters
    ----------
    run : Run
        Not used: the page has no pictures.
    page : Page
        Takes tables and charts.
    result : LoadsResult
        What was found.
    """
    _channels(page, result)
    _statistics(page, result)
    _capture(page, result)
    shape(page, result)
    counts(page, result)
    if result.scene_reactions is not None:
        reactions_section(page, result, result.scene_reactions)
    others_section(page, result)
    if result.lifetime is not None:
        lifetime_section(page, result.lifetime, result)
    if result.comparison is not None:
        beside(page, result.comparison)


def _channels(page: Page, result: LoadsResult) -> None:
    """Frame and origin, and what was read."""
    page.section("Frame and channels")
    page.text(result.stated.sentences())
    page.table(
        "What the loads were read from",
        [
            {"channels": channels, "files": number}
            for channels, number in list(result.hub.files.channels.items())[:_SHOWN]
        ],
    )


def _statistics(page: Page, result: LoadsResult) -> None:
    page.section("Statistics")
    statistics = result.hub.statistics
    page.table("All samples together", channel_rows(statistics))
    by_wind = wind_rows(statistics)
    if not by_wind:
        return
    page.table(f"By mean wind speed in {WIND_BIN:g} m/s", by_wind)
    if "bending moment" not in result.hub.loads:
        _by_wind(page, result, result.hub.loads[0])
        return
    page.table(
        f"Bending moment by mean wind speed and turbulence intensity in {100 * TURBULENCE_BIN:g} "
        "%; every channel is in wind_and_turbulence.csv",
        bending_rows(statistics)[:_MAX_BINS],
    )
    _by_wind(page, result, "bending moment")


def _by_wind(page: Page, result: LoadsResult, load: str) -> None:
    """A load in each window over its mean wind."""
    statistics = result.hub.statistics
    wind, values = statistics.of_windows("wind speed"), statistics.of_windows(load)
    unit = shown_unit(UNIT_OF[load])
    page.chart(
        f"{load[:1].upper()}{load[1:]} at the hub in each window of ten minutes",
        [
            trace(column, wind[:, _MEAN], values[:, k] / 1e3, points=True)
            for k, column in enumerate(COLUMNS[:3])
        ],
        "mean wind speed [m/s]",
        f"{load} [{unit}]",
    )


def _capture(page: Page, result: LoadsResult) -> None:
    """Windows by wind speed and turbulence."""
    page.section("Capture matrix")
    capture = result.capture
    if capture is None:
        page.text("No file has a wind speed, so that windows cannot be sorted by it.")
        return
    page.table(
        f"Windows by mean wind speed and turbulence intensity; {capture.target.windows} of each "
        "wind speed are asked for (IEC 61400-1 asks for six ten-minute series; "
        f"{argument('CaptureTarget.windows')} takes another number, "
        f"{argument('CaptureTarget.low')} the range of wind speeds)",
        capture_rows(capture),
    )
    if capture.unknown:
        page.text(f"{capture.unknown} windows have no wind speed.")
