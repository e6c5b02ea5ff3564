"""Tables of a drivetrain in time: extremes, levels, files, equivalent loads, duration spectra."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import ONE_RPM
from fe_drivetrain.dynamics.time.machine_channels import of_planet
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.transient_digest import FileDigest, equivalent_range
from fe_drivetrain.studies.transient_instants import ByInstant
from fe_drivetrain.studies.transient_ladder import QUANTITIES, LevelError
from fe_drivetrain.studies.transient_runs import SMALL, Extreme, LevelRun
from fe_drivetrain.turbine_loads.histories.classes import Classes, added

_SHOWN = {"N m": ("kN m", 1e3), "N": ("kN", 1e3), "rad/s": ("rpm", ONE_RPM)}
"""Units that people use, and their size."""

_SPECTRA = ("torque", "mesh")
"""Kinds of channels of duration spectra."""


def in_shown_unit(value: float, unit: str) -> tuple[float, str]:
    """A value in the unit that people use, and that unit."""
    name, size = _SHOWN[unit]
    return value / size, name


def extreme_rows(
    extremes: Mapping[str, Extreme], limits: Mapping[str, float] | None = None
) -> list[Record]:
    """A row for each channel; of torques with their limits, where there are any."""
    rows: list[Record] = []
    for name, one in extremes.items():
        unit, size = _SHOWN[one.unit]
        row: Record = {
            "channel": name,
            "unit": unit,
            "rated": one.rated / size,
            "largest": one.most / size,
            "± of it": None if one.most_band is None else one.most_band / size,
            "at [s]": one.most_at,
            "least": one.least / size,
            "± of the least": None if one.least_band is None else one.least_band / size,
            "least at [s]": one.least_at,
            "largest over rated": one.over_rated,
            "least over rated": one.least_over_rated,
            "reversals": one.reversals,
        }
        if limits and one.kind == "torque":
            limit = limits.get(name)
            row["limit"] = None if limit is None else limit / size
            row["peak over its limit"] = None if limit is None else one.largest / limit
        rows.append(row | ({"file": one.file} if one.file else {}))
    return rows


def level_rows(
    runs: Sequence[LevelRun], errors: Sequence[Sequence[LevelError]], chosen: int
) -> list[Record]:
    """A row for each level."""
    return [
        {
            "level": run.rung.name,
            "degrees of freedom": run.degrees,
            "time [s]": run.seconds,
            "step [s]": run.step,
            **{
                f"error of {QUANTITIES[one.kind]} [%]": 100.0 * one.error
                if np.isfinite(one.error)
                else None
                for one in of
            },
            **{f"largest at, {QUANTITIES[one.kind]}": one.worst for one in of},
            "energy from nowhere": run.imbalance,
            "": "reported" if k == chosen else "",
        }
        for k, (run, of) in enumerate(zip(runs, errors, strict=True))
    ]


def bound_rows(soft: LevelRun, stiff: LevelRun) -> list[Record]:
    """A row for each channel: its largest size at both bounds of the main bearings' housings."""
    rows: list[Record] = []
    for name, one in soft.extremes.items():
        if name in stiff.extremes:
            unit, size = _SHOWN[one.unit]
            rows.append(
                {
                    "channel": name,
                    "unit": unit,
                    "largest, seats averaged": one.largest / size,
                    "largest, seats rigid": stiff.extremes[name].largest / size,
                }
            )
    return rows


def over_files(files: Mapping[str, FileDigest], run: LevelRun) -> dict[str, Extreme]:
    """Extremes of each channel over all histories; bands as shares of those of the first one.

    Parameters
    ----------
    files : Mapping[str, FileDigest]
        Digests by the name of the history.
    run : LevelRun
        Beginning of the first history, with bands.
    """
    found: dict[str, Extreme] = {}
    for name, begun in run.extremes.items():
        of = {file: digest.channels[name] for file, digest in files.items()}
        high = max(of, key=lambda file: of[file].most)
        low = min(of, key=lambda file: of[file].least)
        made = replace(
            begun,
            most=of[high].most,
            most_at=of[high].most_at,
            least=of[low].least,
            least_at=of[low].least_at,
            reversals=int(sum(one.reversals for one in of.values())),
            file=high,
        )
        share = made.largest / begun.largest
        bands = [
            None if band is None else band * share for band in (begun.most_band, begun.least_band)
        ]
        found[name] = replace(made, most_band=bands[0], least_band=bands[1])
    return found


def equivalent_rows(
    files: Mapping[str, FileDigest], extremes: Mapping[str, Extreme], slopes: Sequence[float]
) -> list[Record]:
    """Damage-equivalent ranges of each channel over all histories, at 1 Hz."""
    seconds = sum(one.seconds for one in files.values())
    rows: list[Record] = []
    for name, one in extremes.items():
        if one.kind == "speed":
            continue
        unit, size = _SHOWN[one.unit]
        damage = np.sum([file.channels[name].damage for file in files.values()], axis=0)
        row: Record = {"channel": name, "unit": unit}
        for k, slope in enumerate(slopes):
            row[f"equivalent range, m = {slope:g}"] = (
                equivalent_range(float(damage[k]), seconds, slope) / size
            )
        rows.append(row)
    return rows


def spectrum_of(files: Mapping[str, FileDigest], name: str) -> Classes:
    """Seconds of a channel at its levels, over all histories."""
    return added([one.channels[name].levels for one in files.values()])


def spectrum_rows(files: Mapping[str, FileDigest], extremes: Mapping[str, Extreme]) -> list[Record]:
    """Duration spectra of torques and mesh forces: seconds at each level."""
    rows: list[Record] = []
    for name, one in extremes.items():
        if one.kind not in _SPECTRA:
            continue
        unit, size = _SHOWN[one.unit]
        found = spectrum_of(files, name)
        edges = found.edges() / size
        rows += [
            {
                "channel": name,
                "unit": unit,
                "from": float(edges[k]),
                "to": float(edges[k + 1]),
                "time [s]": float(amount),
            }
            for k, amount in enumerate(found.amount)
            if amount > 0.0
        ]
    return rows


def digest_rows(files: Mapping[str, FileDigest], extremes: Mapping[str, Extreme]) -> list[Record]:
    """A row for each history: its length, and extremes of torques."""
    torques = [name for name, one in extremes.items() if one.kind == "torque"]
    rows: list[Record] = []
    for file, one in files.items():
        row: Record = {"file": file, "length [s]": one.seconds}
        for name in torques:
            of, rated = one.channels[name], extremes[name].rated
            row[f"{name}, largest over rated"] = of.most / rated
            row[f"{name}, least over rated"] = of.least / rated
        if np.isfinite(one.against_file):
            row["torque against the file, RMS over rated"] = one.against_file
            row["speed against the file, largest over rated"] = one.speed_against_file
            row["generator"] = "torque of the file" if one.own_generator else "line of slip"
        rows.append(row)
    return rows


def instant_rows(found: ByInstant) -> list[Record]:
    """Peak of a stop by the instant of its brake."""
    return [
        {"brake later by [s]": late, f"largest {found.channel} after it, over rated": peak}
        for late, peak in zip(found.delays, found.peaks, strict=True)
    ]


def alternating_rows(run: LevelRun) -> list[Record]:
    """Forces of bearings and meshes under an offset: steady, once and twice a turn.

    Its band is how far both halves of that time differ: what swings otherwise is in neither.

    Of planets that travel there are none: weights swing them once a turn of their carrier, whose
    mean over so short a time is not that of a turn.

    Parameters
    ----------
    run : LevelRun
        The event; its second half is taken.
    """
    late = run.samples.times >= 0.5 * run.samples.times[-1]
    angle = run.angle[late]
    waves = np.column_stack(
        [np.ones_like(angle), *(f(k * angle) for k in (1, 2) for f in (np.cos, np.sin))]
    )
    rows: list[Record] = []
    for name, one in run.extremes.items():
        if one.kind not in ("bearing", "mesh") or (run.planets_travel and of_planet(name)):
            continue
        values = run.samples.of(name)[late]
        mean, once, twice = _waves_in(waves, values)
        halves = [
            _waves_in(waves[half], values[half])
            for half in np.array_split(np.arange(len(values)), 2)
        ]
        apart = max(abs(a - b) for a, b in zip(*halves, strict=True))
        rows.append(
            {
                "force": name,
                "aligned [kN]": one.rated / 1e3,
                "mean [kN]": mean / 1e3,
                "change of the mean [kN]": (mean - one.rated) / 1e3,
                "once a turn [kN]": once / 1e3,
                "twice a turn [kN]": twice / 1e3,
                "± of these [kN]": apart / 1e3,
                "largest [kN]": float(values.max()) / 1e3,
            }
        )

    def moved(row: Record) -> float:
        keys = ("change of the mean [kN]", "once a turn [kN]", "twice a turn [kN]")
        return max(abs(float(row[key])) for key in keys)

    largest = max(map(moved, rows), default=0.0)
    return [row for row in rows if moved(row) >= SMALL * largest]


def _waves_in(waves: Floats, values: Floats) -> tuple[float, float, float]:
    """Mean of values (n,), and amplitudes once and twice a turn by their waves (n, 5)."""
    found = np.linalg.lstsq(waves, values, rcond=None)[0]
    return float(found[0]), float(np.hypot(*found[1:3])), float(np.hypot(*found[3:5]))
