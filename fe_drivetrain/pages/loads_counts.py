"""Sections of the page of ``loads``: cycles, equivalent loads, time and turns at level."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.report.charts import heat_map, trace
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.studies.load_digest import LOADS, UNITS
from fe_drivetrain.studies.load_histories import LoadsResult
from fe_drivetrain.studies.load_records import slope_columns, torque_rows
from fe_drivetrain.studies.shown_units import shown_unit


def counts(page: Page, result: LoadsResult) -> None:
    """Add the sections.

    Parameters
    ----------
    page : Page
        Takes tables and charts.
    result : LoadsResult
        What was found.
    """
    _cycles(page, result)
    _levels(page, result)


def _cycles(page: Page, result: LoadsResult) -> None:
    page.section("Cycles")
    options, cycles = result.asked, result.hub.cycles
    overall = result.hub.equivalent_loads(options) / 1e3
    numbers = np.column_stack([cycles.largest / 1e3, cycles.number, cycles.left_out])
    page.table(
        f"Damage-equivalent loads: range of a sine of {options.frequency:g} Hz that does the same "
        f"damage; {options.counted}",
        [
            {
                "channel": f"{name} [{shown_unit(unit)}]",
                **slope_columns(row, options),
                "largest range": largest,
                "cycles": number,
                "left out": left_out,
            }
            for name, unit, row, (largest, number, left_out) in zip(
                LOADS, UNITS, overall.tolist(), numbers.tolist(), strict=False
            )
            if name in result.hub.loads
        ],
    )
    _about_zero(page, result)
    for chosen in result.hub.by_kind:
        page.chart(*result.exceedances(chosen))
    for name, both in cycles.ranges_and_means.items():
        with np.errstate(divide="ignore"):
            shown = np.log10(both.amount)
        shown[np.isinf(shown)] = np.nan
        page.add(
            heat_map(
                f"Cycles of {name} by range and mean; {options.counted}",
                both.middles(1) / 1e3,
                both.middles(0) / 1e3,
                shown,
                ("mean [kN m]", "range [kN m]", "log10 of cycles"),
            )
        )


def _about_zero(page: Page, result: LoadsResult) -> None:
    """Equivalent loads of cycles about zero mean, where an ultimate load is given."""
    options = result.asked
    if not options.ultimate:
        return
    loads = result.hub.equivalent_loads_about_zero(options) / 1e3
    page.table(
        "The same of cycles about zero mean, their ranges changed by Goodman's straight line to "
        f"the ultimate load; {options.counted}",
        [
            {
                "channel": f"{name} [{shown_unit(unit)}]",
                "ultimate load": options.ultimate[name] / 1e3,
                **slope_columns(row, options),
            }
            for name, unit, row in zip(LOADS, UNITS, loads.tolist(), strict=False)
            if name in options.ultimate and name in result.hub.loads
        ],
    )


def _levels(page: Page, result: LoadsResult) -> None:
    page.section("Time and turns at level")
    levels = result.hub.levels
    if "Mx" not in levels.seconds:
        page.text("Both distributions of every load are in levels.csv.")
        return
    torque = levels.seconds["Mx"]
    page.chart(
        "Load duration distribution of the torque: time at a level or above it",
        [trace("time", torque.edges()[:-1] / 1e3, torque.at_least / 3600.0)],
        "torque Mx [kN m]",
        "time [h]",
    )
    if "Mx" in levels.turns:
        turns = levels.turns["Mx"]
        page.chart(
            "Load revolution distribution of the torque: turns of the rotor at each level",
            [trace("turns", turns.middles() / 1e3, turns.amount)],
            "torque Mx [kN m]",
            "turns",
        )
    page.table(
        "Torque: reversals, and the constant torque of the same effect on roller bearings",
        torque_rows(result.hub),
    )
    page.text(
        "Lives of gears and bearings follow the load and the turns at it, not counted cycles. Both "
        "distributions of every load are in levels.csv."
    )
