"""Numbers of the study of loads as records: rows of its tables, with units in their keys."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.load_digest import CHANNELS, LOADS, UNIT_OF, UNITS, LoadOptions
from fe_drivetrain.studies.load_lifetime import Lifetime
from fe_drivetrain.studies.load_reactions import ALONE
from fe_drivetrain.studies.load_totals import LoadTotals
from fe_drivetrain.studies.shown_units import shown_unit
from fe_drivetrain.turbine_loads.histories.level_sums import POWER
from fe_drivetrain.turbine_loads.histories.spectra import MULTIPLES
from fe_drivetrain.turbine_loads.histories.windows import COLUMNS


def statistics_rows(found: LoadTotals) -> list[Record]:
    """Statistics of all samples of each channel that the files have."""
    return [
        {"channel": name, "unit": UNIT_OF[name], **dict(zip(COLUMNS, row, strict=True))}
        for name, row in zip(CHANNELS, found.statistics.overall.tolist(), strict=True)
        if not np.isnan(row).any()
    ]


def slope_rows(loads: Floats, options: LoadOptions) -> list[Record]:
    """Damage-equivalent loads (loads, slopes) of each load and slope; none where not a number."""
    return [
        {
            "channel": name,
            "unit": unit,
            "slope": float(slope),
            f"DEL at {options.frequency:g} Hz": value,
        }
        for name, unit, row in zip(LOADS, UNITS, loads.tolist(), strict=False)
        for slope, value in zip(options.slopes, row, strict=True)
        if not np.isnan(value)
    ]


def torque_rows(found: LoadTotals) -> list[Record]:
    """Reversals of the torque, and the constant torques of the same effect on roller bearings."""
    if "Mx" not in found.loads:
        return []
    torque = found.torque
    over_time = torque.equivalent_over_time(found.files.seconds)
    rows: list[Record] = [
        {
            "quantity": "torque reversals beyond 1 % of a file's largest torque",
            "value": torque.reversals,
        },
        {"quantity": "time with negative torque [s]", "value": torque.negative_seconds},
        {
            "quantity": f"equivalent torque, exponent {POWER:.3g}, over time [kN m]",
            "value": over_time / 1e3,
        },
    ]
    over_turns = torque.equivalent_over_turns
    if over_turns is not None:
        rows += [
            {"quantity": "turns of the rotor", "value": torque.turns},
            {
                "quantity": f"equivalent torque, exponent {POWER:.3g}, over turns [kN m]",
                "value": over_turns / 1e3,
            },
        ]
    return rows


def loop_rows(found: LoadTotals) -> list[Record]:
    """Load loops of force and moment."""
    rows: list[Record] = []
    for name, plane in found.planes.items():
        durations, swept, ranges = np.concatenate(plane.loops, axis=1)
        rows.append(
            {
                "plane": name,
                "loops": plane.count,
                "share of time [%]": 100.0 * plane.loop_seconds / plane.seconds,
                "loops over blade passages (3P)": plane.over_passing,
                "median duration [s]": _median(durations),
                "median angle [deg]": _median(swept),
                "max angle [deg]": float(swept.max()) if plane.count else None,
                "median range [kN, kN m]": _median(ranges / 1e3),
                "max range [kN, kN m]": float(ranges.max()) / 1e3 if plane.count else None,
            }
        )
    return rows


def reaction_rows(found: Mapping[str, LoadTotals], options: LoadOptions) -> list[Record]:
    """Statistics, equivalent loads and multiples of each reaction that is not zero."""
    rows: list[Record] = []
    for name, one in found.items():
        equivalents, amplitudes = one.equivalent_loads(options), one.spectra.multiples
        overall = one.statistics.overall
        for c, (load, unit) in enumerate(zip(LOADS, UNITS, strict=False)):
            if not np.abs(overall[c]).max() > 0.0:
                continue
            row: Record = {"reaction": f"{name}, {load} [{shown_unit(unit)}]"}
            row |= dict(zip(COLUMNS, (overall[c] / 1e3).tolist(), strict=True))
            row |= _del_columns(equivalents[c] / 1e3, options)
            if amplitudes is not None:
                row |= multiple_columns(amplitudes[c] / 1e3)
            rows.append(row)
    return rows


def reaction_loop_rows(found: Mapping[str, LoadTotals]) -> list[Record]:
    """Load loops of each reaction across the shaft that has some."""
    return [
        {
            "reaction": f"{name}, {plane}",
            "loops": loops.count,
            "share of time [%]": 100.0 * loops.share,
            "loops over blade passages (3P)": loops.over_passing,
        }
        for name, one in found.items()
        for plane, loops in one.planes.items()
        if loops.count
    ]


def other_rows(found: Mapping[str, LoadTotals], options: LoadOptions) -> list[Record]:
    """Statistics, equivalent loads and multiples of each other channel, in its own unit."""
    place = LOADS.index(ALONE)
    rows: list[Record] = []
    for name, one in found.items():
        row: Record = {"channel": name}
        row |= dict(zip(COLUMNS, one.statistics.overall[place].tolist(), strict=True))
        row |= _del_columns(one.equivalent_loads(options)[place], options)
        if one.spectra.multiples is not None:
            row |= multiple_columns(one.spectra.multiples[place])
        rows.append(row)
    return rows


def lifetime_rows(found: Lifetime, options: LoadOptions) -> list[Record]:
    """Equivalent loads of a lifetime, of loads that every file has."""
    loads = (found.equivalent_loads(options.slopes) / 1e3).tolist()
    return [
        {"channel": f"{name} [{shown_unit(unit)}]", **slope_columns(row, options)}
        for name, unit, row in zip(LOADS, UNITS, loads, strict=False)
        if not np.isnan(row).any()
    ]


def slope_columns(values: list[float], options: LoadOptions) -> dict[str, Any]:
    """Values by slope, as columns of a table."""
    return {f"m = {m:g}": value for m, value in zip(options.slopes, values, strict=True)}


def multiple_columns(amplitudes: Floats) -> dict[str, Any]:
    """Amplitudes at multiples of the rotor speed, as columns; None where none is shown."""
    values = zip(MULTIPLES, amplitudes.tolist(), strict=True)
    return {f"{n}P": None if np.isnan(value) else value for n, value in values}


def _del_columns(loads: Floats, options: LoadOptions) -> dict[str, Any]:
    values = zip(options.slopes, loads.tolist(), strict=True)
    return {f"DEL, m = {m:g}": value for m, value in values}


def _median(values: Floats) -> float | None:
    return float(np.median(values)) if len(values) else None
