"""Long tables of the study of loads, which go to files: each row of all that was counted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.load_comparison import Comparison
from fe_drivetrain.studies.load_digest import (
    CHANNELS,
    LOADS,
    UNIT_OF,
    UNITS,
    LoadOptions,
)
from fe_drivetrain.studies.load_lifetime import Lifetime
from fe_drivetrain.studies.load_reactions import ALONE
from fe_drivetrain.studies.load_totals import LoadTotals
from fe_drivetrain.studies.load_winds import Capture, by_wind_and_turbulence
from fe_drivetrain.turbine_loads.histories.classes import Classes
from fe_drivetrain.turbine_loads.histories.cycle_sums import equivalent_loads
from fe_drivetrain.turbine_loads.histories.sets import Difference
from fe_drivetrain.turbine_loads.histories.windows import COLUMNS


def file_rows(found: LoadTotals) -> list[Record]:
    """Each file; with its gaps where one has some."""
    winds, speeds = (found.statistics.mean_of(name) for name in ("wind speed", "rotor speed"))
    gaps = [steps.gaps for steps in found.files.steps]
    broken = any(len(own) for own in gaps)
    return [
        {
            "file": name,
            "from [s]": span.start,
            "to [s]": span.end,
            "step [s]": span.step,
            "samples": span.samples,
            "mean wind speed [m/s]": _known(wind),
            "mean rotor speed [rad/s]": _known(speed),
            **({"gaps": len(own), "in gaps [s]": float(own[:, 1].sum())} if broken else {}),
        }
        for name, span, wind, speed, own in zip(
            found.files.names,
            found.files.spans,
            winds.tolist(),
            speeds.tolist(),
            gaps,
            strict=True,
        )
    ]


def window_rows(found: LoadTotals) -> list[Record]:
    """Each channel of each window that has it."""
    return [
        {
            "file": file,
            "start [s]": start,
            "seconds": seconds,
            "channel": name,
            "unit": UNIT_OF[name],
            **dict(zip(COLUMNS, row, strict=True)),
        }
        for file, windows in zip(found.files.names, found.statistics.windows, strict=True)
        for start, seconds, values in zip(
            windows.start.tolist(), windows.seconds.tolist(), windows.values, strict=True
        )
        for name, row in zip(CHANNELS, values.tolist(), strict=True)
        if not np.isnan(row).any()
    ]


def other_window_rows(found: Mapping[str, LoadTotals]) -> list[Record]:
    """Each window of each other channel."""
    place, of_wind = LOADS.index(ALONE), CHANNELS.index("wind speed")
    return [
        {
            "channel": name,
            "file": file,
            "start [s]": start,
            "seconds": seconds,
            "mean wind speed [m/s]": _known(float(values[of_wind, 1])),
            **dict(zip(COLUMNS, values[place].tolist(), strict=True)),
        }
        for name, one in found.items()
        for file, windows in zip(one.files.names, one.statistics.windows, strict=True)
        for start, seconds, values in zip(
            windows.start.tolist(), windows.seconds.tolist(), windows.values, strict=True
        )
    ]


def turbulence_rows(found: LoadTotals) -> list[Record]:
    """Statistics of each channel by mean wind speed and turbulence intensity."""
    return [
        {
            "wind [m/s]": one.wind,
            "turbulence [-]": one.turbulence,
            "windows": one.windows,
            "channel": name,
            "unit": UNIT_OF[name],
            **dict(zip(COLUMNS, values.tolist(), strict=True)),
        }
        for one in by_wind_and_turbulence(found.statistics)
        for name, values in zip(CHANNELS, one.statistics, strict=True)
        if not np.isnan(values).any()
    ]


def capture_rows(found: Capture) -> list[Record]:
    """Windows of each wind speed, without turbulence that no window has."""
    matrix = found.matrix
    filled = np.flatnonzero(matrix.counts.any(axis=1)).tolist()
    limits = 100.0 * matrix.turbulence
    rows: list[Record] = []
    for c, middle in enumerate(found.middles.tolist()):
        row: Record = {"wind [m/s]": middle}
        for r in filled:
            row[f"{limits[r]:g} to {limits[r + 1]:g} %"] = int(matrix.counts[r, c])
        row |= {"all": int(matrix.counts[:, c].sum()), "missing": int(found.missing[c])}
        rows.append(row)
    return rows


def spectrum_rows(found: LoadTotals) -> list[Record]:
    """Density of each load at each frequency."""
    spectra = found.spectra
    if not len(spectra.frequency):
        return []
    places = [LOADS.index(name) for name in found.loads]
    names = [f"{LOADS[c]} [({UNITS[c]})^2/Hz]" for c in places]
    return [
        {"frequency [Hz]": float(frequency), **dict(zip(names, values.tolist(), strict=True))}
        for frequency, values in zip(spectra.frequency, spectra.density[places].T, strict=True)
    ]


def each_loop_rows(found: LoadTotals) -> list[Record]:
    """Each load loop of each file."""
    return [
        {
            "file": file,
            "plane": name,
            "duration [s]": duration,
            "swept angle [deg]": angle,
            "range of magnitude [N, N m]": size,
        }
        for name, plane in found.planes.items()
        for file, loops in zip(found.files.names, plane.loops, strict=True)
        for duration, angle, size in loops.T.tolist()
    ]


def equivalent_rows(found: LoadTotals, options: LoadOptions) -> list[Record]:
    """Damage-equivalent loads of all files and of each."""
    hertz, slopes = options.frequency, np.array(options.slopes, dtype=float)
    seconds = [span.seconds for span in found.files.spans]
    return [
        {
            "file": file,
            "channel": name,
            "unit": unit,
            "slope": slope,
            f"DEL at {hertz:g} Hz": value,
        }
        for file, damage, time in zip(
            ("all", *found.files.names),
            (found.cycles.damage, *found.damages),
            (found.files.seconds, *seconds),
            strict=True,
        )
        for name, unit, row in zip(
            LOADS, UNITS, equivalent_loads(damage, time, slopes, hertz).tolist(), strict=False
        )
        for slope, value in zip(slopes.tolist(), row, strict=True)
        if not np.isnan(value)
    ]


def range_rows(found: LoadTotals) -> list[Record]:
    """Cycles by range."""
    return [
        {"channel": name, "unit": unit, "range from": low, "range to": high, "cycles": number}
        for name, unit in zip(LOADS, UNITS, strict=False)
        if name in found.cycles.ranges
        for low, high, number in _filled(found.cycles.ranges[name])
    ]


def range_mean_rows(found: LoadTotals) -> list[Record]:
    """Cycles by range and mean, of torque and tilting moment."""
    rows: list[Record] = []
    for name, both in found.cycles.ranges_and_means.items():
        ranges, means = both.edges(0), both.edges(1)
        for r, c in np.argwhere(both.amount > 0.0).tolist():
            rows.append(
                {
                    "channel": name,
                    "range from [N m]": float(ranges[r]),
                    "range to [N m]": float(ranges[r + 1]),
                    "mean from [N m]": float(means[c]),
                    "mean to [N m]": float(means[c + 1]),
                    "cycles": float(both.amount[r, c]),
                }
            )
    return rows


def level_rows(found: LoadTotals) -> list[Record]:
    """Time and turns at each level of each load."""
    return [
        {"channel": name, "unit": unit, "of": kind, "from": low, "to": high, "amount": amount}
        for kind, own in (("seconds", found.levels.seconds), ("turns", found.levels.turns))
        for name, unit in zip(LOADS, UNITS, strict=False)
        if name in own
        for low, high, amount in _filled(own[name])
    ]


def lifetime_tables(found: Lifetime, options: LoadOptions) -> dict[str, list[Record]]:
    """Hours of each wind, sources of damage, transients, and levels of the lifetime."""
    columns = found.speeds, found.hours, found.seconds, found.factors
    tables: dict[str, list[Record]] = {
        "site": [
            {
                "mean wind speed [m/s]": speed,
                "hours": hours,
                "files last [s]": seconds,
                "time factor": factor,
            }
            for speed, hours, seconds, factor in np.column_stack(columns).tolist()
        ],
        "lifetime_damage": damage_rows(found, options),
    }
    if found.events:
        tables["transients"] = transient_rows(found)
    kinds = (("hours [h]", found.hours_at_level), ("turns [-]", found.turns_at_level))
    tables["lifetime_levels"] = [
        {"channel": name, "unit": unit, "of": kind, "from": low, "to": high, "amount": amount}
        for kind, own in kinds
        for name, unit in zip(LOADS, UNITS, strict=False)
        if name in own
        for low, high, amount in _filled(own[name])
    ]
    return tables


def damage_rows(found: Lifetime, options: LoadOptions) -> list[Record]:
    """Share of each wind and event in the damage of each load and slope."""
    return [
        {"channel": name, "slope": slope, "from": source, "share of damage [%]": share}
        for c, name in enumerate(LOADS)
        for k, slope in enumerate(options.slopes)
        if found.total[c, k] > 0.0
        for source, share in zip(
            found.sources, (100.0 * found.damage[c, k] / found.total[c, k]).tolist(), strict=True
        )
    ]


def leading_damage_rows(found: Lifetime, options: LoadOptions) -> list[Record]:
    """The wind or event that does most of the damage of each main load and slope."""
    shares = damage_rows(found, options)
    rows: list[Record] = []
    for name in ("Mx", "radial force", "bending moment"):
        for slope in dict.fromkeys(row["slope"] for row in shares):
            own = [r for r in shares if r["channel"] == name and r["slope"] == slope]
            if own:
                rows.append(max(own, key=lambda r: float(r["share of damage [%]"])))
    return rows


def transient_rows(found: Lifetime) -> list[Record]:
    """Each kind of event."""
    return [
        {
            "event": one.transient.name,
            "a year": one.transient.a_year,
            "lasts [s]": one.transient.seconds,
            "in the lifetime [h]": one.transient.hours(found.site.years),
        }
        for one in found.events
    ]


def comparison_rows(found: Comparison) -> list[Record]:
    """Every quantity of every wind."""
    return [
        row
        for one in found.winds
        for row in difference_rows(one.wind, one.differences, found.names)
    ]


def difference_rows(wind: str, found: Sequence[Difference], names: tuple[str, str]) -> list[Record]:
    """Quantities of two sets of those names at one wind."""
    return [
        {
            "wind": wind,
            "quantity": one.quantity,
            names[0]: one.one,
            names[1]: one.other,
            "ratio": _known(one.ratio),
            "scatter of seeds": one.scatter,
            "allowed difference": one.allowed,
            "beyond": one.beyond,
        }
        for one in found
    ]


def _filled(classes: Classes) -> list[tuple[float, float, float]]:
    """Limits and amounts of the classes that hold something."""
    edges = classes.edges()
    return [
        (float(edges[k]), float(edges[k + 1]), float(classes.amount[k]))
        for k in np.flatnonzero(classes.amount > 0.0).tolist()
    ]


def _known(value: float) -> float | None:
    return None if np.isnan(value) else float(value)
