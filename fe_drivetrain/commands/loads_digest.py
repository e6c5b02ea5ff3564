"""What the page of ``loads`` needs of one file, in little memory whatever the file's length."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.made_by import file_digest, program_hash
from fe_drivetrain.histories.classes import Classes, in_classes
from fe_drivetrain.histories.cycles import Residue, gated, rainflow_cycles
from fe_drivetrain.histories.damage import FREQUENCY, goodman
from fe_drivetrain.histories.faults import lone_samples, times_as_far
from fe_drivetrain.histories.levels import torque_reversals
from fe_drivetrain.histories.polar import direction
from fe_drivetrain.histories.spectra import (
    MULTIPLES,
    SEGMENT,
    Campbell,
    campbell,
    multiples,
    spectrum,
)
from fe_drivetrain.histories.windows import window_statistics
from fe_drivetrain.hub_loads.channel_map import ChannelMap
from fe_drivetrain.hub_loads.loops import find_loops, loop_statistics, time_on_loops
from fe_drivetrain.hub_loads.recorded import OWN_NAMES, Recorded
from fe_drivetrain.studies.unused import own_speeds

LOADS = (*FORCES, "radial force", "bending moment")
"""Channels that are counted; the last two are sizes across the shaft."""

CHANNELS = (*LOADS, "rotor speed", "wind speed")
UNITS = (*3 * ("N",), *3 * ("N m",), "N", "N m", "rad/s", "m/s")

HIGHEST = 10.0
"""Highest frequency of spectra on the page [Hz]."""

SPEED_STEP = 0.05
"""Width of the classes of rotor speed in the Campbell diagram [rad/s]."""

PLANES = (("force", 1), ("moment", 4))
"""Names, and where the component along y stands among the six."""

SECTORS = 36
"""Number of directions across the shaft; the first is about 0 deg, which is right."""

POWER = 10.0 / 3.0
"""Exponent of the life of roller bearings (ISO 281)."""


@dataclass(frozen=True)
class Options:
    """How histories are counted.

    Attributes
    ----------
    columns : Mapping[str, str]
        What a channel is, and how files call it, before what the mapping says.
    skip : float
        Left out at the beginning of each file [s].
    slopes : Sequence[float]
        Of S-N curves.
    residue : str
        Rule for cycles that the end of a file leaves open.
    gate : float
        Cycles of a smaller range are left out, as a share of the largest one of the channel in
        its file.
    rotor_speed : float or None
        [rad/s], for files that have none.
    ultimate : Mapping[str, float]
        Loads that break the part, by channel [N, N m]: cycles of these are counted about zero mean,
        too, by Goodman's line.
    frequency : float
        Of damage-equivalent loads [Hz]; what is kept of a file does not depend on it.
    mapping : ChannelMap
        How files call their channels, and their frame and origin.
    also : Sequence[str]
        Further channels, as files call them, of which there are statistics and cycles, too.
    """

    columns: Mapping[str, str]
    skip: float
    slopes: Sequence[float]
    residue: Residue
    gate: float
    rotor_speed: float | None
    ultimate: Mapping[str, float] = field(default_factory=dict)
    frequency: float = FREQUENCY
    mapping: ChannelMap = OWN_NAMES
    also: Sequence[str] = ()

    @property
    def names(self) -> ChannelMap:
        """The mapping, with the columns."""
        return self.mapping.with_columns(self.columns)

    def content(self, file: Path) -> dict[str, Any]:
        """All that the digest of a file depends on: what is in the file counts, not its name."""
        return {
            "code": program_hash(),
            "file": file_digest(str(file)),
            "mapping": self.names.content(),
            "slopes": [float(m) for m in self.slopes],
            "ultimate": dict(self.ultimate),
            "also": list(self.also),
            **{name: getattr(self, name) for name in ("skip", "residue", "gate", "rotor_speed")},
        }


Digest = dict[str, NDArray[Any]]
"""Arrays by name, as `digest` makes them; classes of NAME stand under three names, and which
channels were read is text."""


_NONE = (np.nan, np.nan)  # time and distance of the lone samples of a channel that has none


def digest(found: Recorded, options: Options) -> Digest:
    """Statistics, counts and distributions of one file.

    Parameters
    ----------
    found : Recorded
        The history.
    options : Options
        How it is counted.

    Returns
    -------
    dict
        Arrays that add up over files, beside those that are the file's own.
    """
    history = found.history
    step, count = history.step, len(history)
    speed = speed_of_file = found.rotor_speed
    if speed is None and options.rotor_speed is not None:
        speed = np.full(count, options.rotor_speed)
    loads = _all_loads(history.loads)
    nothing = np.full(count, np.nan)
    beside = [nothing if c is None else c for c in (speed, found.wind_speed)]
    windows = window_statistics(history.time, np.column_stack([loads, *beside]))
    result: Digest = {
        "read": np.array(str(history.attributes.get("channels", "as in the file"))),
        "time": np.array([history.time[0], history.time[-1], step, count], dtype=float),
        "window start": windows.start,
        "window seconds": windows.seconds,
        "window values": windows.values,
        "own speeds": own_speeds(speed_of_file),
    }
    seconds = np.full(count, step)
    turns = None if speed is None else np.abs(speed) * step / (2.0 * np.pi)
    _count_cycles(result, loads, options)
    alone = [lone_samples(column) for column in history.loads.T]
    result["lone samples"] = np.array(
        [
            [len(k), history.time[k[0]], times_as_far(column, k).max()] if len(k) else [0, *_NONE]
            for k, column in zip(alone, history.loads.T, strict=True)
        ]
    )
    _spectra(result, loads, speed, step)
    for c, name in enumerate(LOADS):
        _put(result, f"time at {name}", in_classes(loads[:, c], weights=seconds))
        if turns is not None:
            _put(result, f"turns at {name}", in_classes(loads[:, c], weights=turns))
    torque = loads[:, 3]
    back = torque_reversals(torque, step, band=0.01 * float(np.abs(torque).max()))
    result["torque"] = np.array(
        [
            back.count,
            back.seconds,
            seconds @ np.abs(torque / 1e6) ** POWER,
            np.nan if turns is None else turns @ np.abs(torque / 1e6) ** POWER,
            np.nan if turns is None else turns.sum(),
        ]
    )
    for name, y in PLANES:
        pair = loads[:, y], loads[:, y + 1]
        _put(result, f"plane of {name}", in_classes(-pair[0], pair[1], weights=seconds))
        sector = (direction(*pair) * (SECTORS / (2.0 * np.pi)) + 0.5).astype(int) % SECTORS
        result[f"directions of {name}"] = step * np.bincount(sector, minlength=SECTORS)
        loops = find_loops(history.time, *pair)
        passing = None if speed is None else 3.0 * float(np.abs(speed).mean()) / (2.0 * np.pi)
        numbers = loop_statistics(loops, count * step, passing or None)
        result[f"loops of {name}"] = np.array(
            [len(loops), time_on_loops(loops), numbers.get("rate over 3P", np.nan)]
        )
        result[f"each loop of {name}"] = np.stack(
            [loops.duration, np.degrees(loops.swept), loops.highest - loops.lowest]
        )
    return result


def classes_of(found: Digest, name: str) -> Classes:
    """Classes that a digest has under a name."""
    return Classes(
        tuple(int(p) for p in found[f"{name}: powers"]),
        tuple(int(f) for f in found[f"{name}: first"]),
        found[f"{name}: amount"],
    )


def _put(result: Digest, name: str, found: Classes) -> None:
    result[f"{name}: powers"] = np.array(found.powers, dtype=float)
    result[f"{name}: first"] = np.array(found.first, dtype=float)
    result[f"{name}: amount"] = found.amount


def _all_loads(loads: Floats) -> Floats:
    sizes = [np.hypot(loads[:, y], loads[:, y + 1]) for _, y in PLANES]
    return np.column_stack([loads, *sizes])


def _count_cycles(result: Digest, loads: Floats, options: Options) -> None:
    """Sums of n r^m for each slope, exact; cycles in classes of range, and of range and mean."""
    sums = np.zeros((len(LOADS), len(options.slopes)))
    about_zero = np.full_like(sums, np.nan)
    halves = np.zeros_like(sums)
    numbers = np.zeros((len(LOADS), 3))
    for c, name in enumerate(LOADS):
        cycles = rainflow_cycles(loads[:, c], options.residue)
        largest = float(cycles.ranges.max(initial=0.0))
        if options.gate:
            cycles = gated(cycles, options.gate * largest)
        sums[c] = [float(cycles.counts @ cycles.ranges**m) for m in options.slopes]
        half = cycles.counts < 1.0
        halves[c] = [float(cycles.counts[half] @ cycles.ranges[half] ** m) for m in options.slopes]
        numbers[c] = largest, cycles.counts.sum(), cycles.left_out
        if name in options.ultimate:
            same = goodman(cycles, options.ultimate[name])
            about_zero[c] = [float(same.counts @ same.ranges**m) for m in options.slopes]
        _put(result, f"ranges of {name}", in_classes(cycles.ranges, weights=cycles.counts))
        if name in ("Mx", "My"):
            both = in_classes(cycles.ranges, cycles.means, weights=cycles.counts, least=24)
            _put(result, f"ranges and means of {name}", both)
    result["damage"], result["cycles"] = sums, numbers
    result["damage about zero"], result["damage of halves"] = about_zero, halves


def _spectra(result: Digest, loads: Floats, speed: Floats | None, step: float) -> None:
    """Spectra at lines that all files share, and amplitudes at multiples of the rotor's speed."""
    if len(loads) * step < 0.5 * SEGMENT:
        return  # lines would be wider apart than 1P and 3P may be
    lines = np.arange(0.0, min(HIGHEST, 0.5 / step), 1.0 / SEGMENT)
    spectra = [spectrum(column, step) for column in loads.T]
    result["spectra"] = np.array([np.interp(lines, s.frequency, s.density) for s in spectra])
    if speed is None:
        return
    turning = float(np.abs(speed).mean())
    if turning > 0.0:
        rows = [multiples(s, turning, MULTIPLES) for s in spectra]
        result["multiples"] = np.array(
            [[np.nan if m.amplitude is None else m.amplitude for m in row] for row in rows]
        )
        result["appears at"] = np.array([m.appears_at for m in rows[0]])
    edges = SPEED_STEP * np.arange(np.ceil(np.abs(speed).max() / SPEED_STEP) + 1)
    try:
        over_speed: Campbell = campbell([(loads[:, 4], np.abs(speed), step)], edges)
    except InputError:
        return  # shorter than a segment
    filled = over_speed.segments > 0.0
    kept = over_speed.frequency < HIGHEST
    result["campbell bins"] = np.flatnonzero(filled).astype(float)
    result["campbell segments"] = over_speed.segments[filled]
    result["campbell density"] = over_speed.density[filled][:, kept]
    result["campbell lines"] = over_speed.frequency[kept]
