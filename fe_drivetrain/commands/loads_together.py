"""Digests of many files added up, one after the other, so that memory does not grow with them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from fe_drivetrain.commands.loads_digest import CHANNELS, LOADS, Digest, classes_of
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.histories.classes import Classes, added
from fe_drivetrain.histories.sites import rounded_wind
from fe_drivetrain.histories.windows import COLUMNS
from fe_drivetrain.suite.records import Record


@dataclass
class Together:
    """What all files read so far have together, and a few rows of each.

    Attributes
    ----------
    names : list of str
        Of the files.
    seconds : float
        How long all last [s].
    samples : int
        Of all.
    damage : ndarray or None
        (loads, slopes) sums of n r^m.
    about_zero : ndarray
        (loads, slopes) the same of cycles about zero mean by Goodman's line; NaN where no ultimate
        load is given.
    halves : ndarray
        (loads, slopes) the part of half cycles in the sums.
    lone : list of tuple
        File, channel, number of lone samples, time of the first [s], and how many times as far from
        its neighbours as usual the farthest is.
    constant : dict
        Channels that do not move, and in how many files.
    cycles : ndarray or None
        (loads, 3) largest range, number of cycles, and how many were left out.
    torque : ndarray
        Reversals, negative seconds, and sums for equivalent torques, over time and turns.
    classes : dict
        Distributions by name.
    at_wind : dict
        Distributions of time and turns over levels, by rounded mean wind speed and name.
    directions : dict
        Plane: seconds in each sector.
    read : dict
        Which channels were read, and in how many files.
    windows : list of Record
        Each window of each file, its statistics (channels, 4) under "values".
    vertical : dict
        Mean and standard deviation of Fz of each file [N].
    files : list of Record
        One for each.
    damages : list of ndarray
        (loads, slopes) of each file.
    spectra : dict
        Step of sampling: sum of seconds times density, and of seconds.
    campbell : dict
        Bin of speed: sum of densities and number of segments.
    loops : dict
        Plane: (3,) number, seconds on them, and time with a known rotor speed over blade passing.
    each_loop : dict
        Plane: the durations, swept angles and ranges of all.
    """

    names: list[str] = field(default_factory=list)
    seconds: float = 0.0
    samples: int = 0
    damage: Floats | None = None
    about_zero: Floats = field(default_factory=lambda: np.zeros((1, 1)))
    halves: Floats = field(default_factory=lambda: np.zeros((1, 1)))
    lone: list[tuple[str, str, int, float, float]] = field(default_factory=list)
    constant: dict[str, int] = field(default_factory=dict)
    cycles: Floats | None = None
    torque: Floats = field(default_factory=lambda: np.zeros(5))
    classes: dict[str, Classes] = field(default_factory=dict)
    at_wind: dict[tuple[float, str], Classes] = field(default_factory=dict)
    directions: dict[str, Floats] = field(default_factory=dict)
    read: dict[str, int] = field(default_factory=dict)
    vertical: dict[str, tuple[float, float]] = field(default_factory=dict)
    windows: list[Record] = field(default_factory=list)
    own_speeds: list[Floats] = field(default_factory=list)
    files: list[Record] = field(default_factory=list)
    damages: list[Floats] = field(default_factory=list)
    spectra: dict[int, tuple[Floats, float]] = field(default_factory=dict)
    campbell: dict[int, tuple[Floats, float]] = field(default_factory=dict)
    campbell_lines: Floats = field(default_factory=lambda: np.zeros(0))
    loops: dict[str, Floats] = field(default_factory=dict)
    each_loop: dict[str, list[Floats]] = field(default_factory=dict)
    multiples: list[Floats] = field(default_factory=list)
    aliased: list[tuple[str, Floats, float]] = field(default_factory=list)

    def add(self, name: str, found: Digest) -> None:
        """Add the digest of a file of that name."""
        start, end, step, count = found["time"].tolist()
        seconds = count * step
        self.names.append(name)
        self.own_speeds.append(found["own speeds"])
        self.seconds += seconds
        self.samples += int(count)
        damage, cycles = found["damage"], found["cycles"]
        self.damages.append(damage)
        self.damage = damage if self.damage is None else self.damage + damage
        self.about_zero = self.about_zero + found["damage about zero"]
        self.halves = self.halves + found["damage of halves"]
        for c, (number, first, far) in enumerate(found["lone samples"].tolist()):
            if number:
                self.lone.append((name, LOADS[c], int(number), first, far))
            if not found["cycles"][c, 0]:
                self.constant[LOADS[c]] = self.constant.get(LOADS[c], 0) + 1
        channels = str(found["read"])
        self.read[channels] = self.read.get(channels, 0) + 1
        if self.cycles is None:
            self.cycles = cycles.copy()
        else:
            self.cycles = np.column_stack(
                [np.maximum(self.cycles[:, 0], cycles[:, 0]), self.cycles[:, 1:] + cycles[:, 1:]]
            )
        self.torque = self.torque + found["torque"]
        means = found["window values"][:, :, 1].T @ found["window seconds"] / seconds
        wind = float(means[CHANNELS.index("wind speed")])
        self._add_classes(found, wind)
        self._add_windows(name, found)
        z = found["window values"][:, LOADS.index("Fz")]
        share, mean = found["window seconds"] / seconds, float(means[LOADS.index("Fz")])
        self.vertical[name] = mean, float(np.sqrt(share @ (z[:, 3] ** 2 + (z[:, 1] - mean) ** 2)))
        self.files.append(
            {
                "file": name,
                "from [s]": start,
                "to [s]": end,
                "step [s]": step,
                "samples": int(count),
                "mean wind speed [m/s]": _known(means[CHANNELS.index("wind speed")]),
                "mean rotor speed [rad/s]": _known(means[CHANNELS.index("rotor speed")]),
            }
        )
        self._add_spectra(name, found, seconds, step)
        for plane in ("force", "moment"):
            sectors = found[f"directions of {plane}"]
            self.directions[plane] = self.directions.get(plane, np.zeros(len(sectors))) + sectors
            row = found[f"loops of {plane}"]
            known = np.array([row[0], row[1], seconds, row[2] * seconds])
            self.loops[plane] = self.loops.get(plane, np.zeros(4)) + known
            self.each_loop.setdefault(plane, []).append(found[f"each loop of {plane}"])

    def _add_classes(self, found: Digest, wind: float) -> None:
        for key in found:
            if not key.endswith(": amount"):
                continue
            own = key.removesuffix(": amount")
            one = classes_of(found, own)
            before = self.classes.get(own)
            self.classes[own] = one if before is None else added([before, one])
            if own.startswith(("time at ", "turns at ")) and not np.isnan(wind):
                place = rounded_wind(wind), own
                others = self.at_wind.get(place)
                self.at_wind[place] = one if others is None else added([others, one])

    def _add_windows(self, name: str, found: Digest) -> None:
        rows = zip(
            found["window start"], found["window seconds"], found["window values"], strict=True
        )
        for start, seconds, values in rows:
            self.windows.append(
                {"file": name, "start [s]": start, "seconds": seconds, "values": values}
            )

    def _add_spectra(self, name: str, found: Digest, seconds: float, step: float) -> None:
        if "spectra" in found:
            one = found["spectra"]
            total, time = self.spectra.get(one.shape[1], (np.zeros_like(one), 0.0))
            self.spectra[one.shape[1]] = (total + seconds * one, time + seconds)
        if "multiples" in found:
            self.multiples.append(found["multiples"])
            if np.isnan(found["multiples"]).any():
                self.aliased.append((name, found["appears at"], step))
        for k, place in enumerate(found.get("campbell bins", np.zeros(0)).astype(int).tolist()):
            lines = found["campbell lines"]
            if not len(self.campbell_lines) or len(lines) < len(self.campbell_lines):
                self.campbell_lines = lines
            kept = len(self.campbell_lines)
            number = float(found["campbell segments"][k])
            density = number * found["campbell density"][k]
            total, before = self.campbell.get(place, (np.zeros(kept), 0.0))
            self.campbell[place] = (total[:kept] + density[:kept], before + number)

    @property
    def values(self) -> Floats:
        """(w, channels, 4) of all windows."""
        return np.array([row["values"] for row in self.windows])

    @property
    def weights(self) -> Floats:
        """(w,) seconds of all windows."""
        return np.array([row["seconds"] for row in self.windows], dtype=float)

    def overall(self, chosen: Floats | None = None) -> Floats:
        """(channels, 4) least, mean, largest, standard deviation over windows together."""
        values, weights = self.values, self.weights
        if chosen is not None:
            values, weights = values[chosen.astype(bool)], weights[chosen.astype(bool)]
        share = weights / weights.sum()
        mean = np.einsum("w,wc->c", share, values[:, :, 1])
        within = np.einsum("w,wc->c", share, values[:, :, 3] ** 2)
        between = np.einsum("w,wc->c", share, (values[:, :, 1] - mean) ** 2)
        return np.column_stack(
            [values[:, :, 0].min(0), mean, values[:, :, 2].max(0), np.sqrt(within + between)]
        )

    def median_multiples(self) -> Floats | None:
        """(loads, multiples) median amplitude over files; None where no speed is known."""
        if not self.multiples:
            return None
        with np.errstate(all="ignore"):
            table = np.array(self.multiples)
            known = ~np.isnan(table).all(axis=0)
            result = np.full(table.shape[1:], np.nan)
            result[known] = np.nanmedian(table[:, known], axis=0)
        return result


def windows_table(found: Together, units: Mapping[str, str]) -> list[Record]:
    """Rows of the file of windows: one for each channel of each window."""
    rows: list[Record] = []
    for window in found.windows:
        for name, values in zip(CHANNELS, np.asarray(window["values"]), strict=True):
            if np.isnan(values).any():
                continue
            rows.append(
                {
                    "file": window["file"],
                    "start [s]": float(window["start [s]"]),
                    "seconds": float(window["seconds"]),
                    "channel": name,
                    "unit": units[name],
                    **dict(zip(COLUMNS, values.tolist(), strict=True)),
                }
            )
    return rows


def _known(value: float) -> float | None:
    return None if np.isnan(value) else float(value)
