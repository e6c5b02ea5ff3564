"""Section of the page of ``loads``: two sets of histories beside each other, by wind."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.report.charts import trace
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.studies.load_comparison import Comparison, WindComparison
from fe_drivetrain.studies.load_tables import difference_rows
from fe_drivetrain.turbine_loads.histories.sets import CHANCE
from fe_drivetrain.turbine_loads.histories.spectra import SEGMENT

_MAXIMUM = 40  # differences that are shown


def beside(page: Page, found: Comparison) -> None:
    """Add the section.

    Parameters
    ----------
    page : Page
        Takes tables and charts.
    found : Comparison
        The two sets.
    """
    names = found.names
    page.section(f"{names[0][:1].upper()}{names[0][1:]} beside {names[1]}")
    for one in found.winds:
        page.table(
            f"{one.wind}: what differs by more than the scatter of seeds (Student's test at "
            f"{CHANCE:.0%}, seeds of both sets scattering equally), farthest first",
            difference_rows(one.wind, one.beyond[:_MAXIMUM], names),
            ["quantity", names[0], names[1], "ratio", "scatter of seeds", "allowed difference"],
        )
        _spectra(page, one, names)
    if found.alone:
        page.text(f"Not compared, for want of histories of both sets: {', '.join(found.alone)}.")


def _spectra(page: Page, found: WindComparison, names: tuple[str, str]) -> None:
    """Mean spectra of both sets, of the moments across the shaft and of what bearings carry."""
    for load, densities in found.spectra.items():
        traces = [
            trace(name, np.arange(1, len(one)) / SEGMENT, one[1:] / 1e6)
            for name, one in zip(names, densities, strict=True)
        ]
        if max(max(t["y"]) for t in traces) > 0.0:
            unit = "kN" if load.rpartition(" ")[2].startswith("F") else "kN m"
            page.chart(
                f"{found.wind}: power spectral density of {load}, mean of each set, segments of "
                f"{SEGMENT:g} s",
                traces,
                "frequency [Hz]",
                f"density [({unit})²/Hz]",
                "xy",
            )
