"""What the study of loads needs of one file, in little memory whatever the file's length."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES, ONE_RPM
from fe_drivetrain.common.errors import InputError, require_known
from fe_drivetrain.common.provenance import program_hash
from fe_drivetrain.studies.history_options import HistoryOptions, require_between
from fe_drivetrain.studies.load_planes import PLANES, PlaneDigest, plane_digest
from fe_drivetrain.studies.unused import own_speeds
from fe_drivetrain.turbine_loads.histories.cycle_sums import CycleRule, CycleSums, count_cycles
from fe_drivetrain.turbine_loads.histories.cycles import RESIDUES, Cycles, Residue
from fe_drivetrain.turbine_loads.histories.damage import FREQUENCY, SLOPES, check_slope
from fe_drivetrain.turbine_loads.histories.faults import lone_samples, times_as_far
from fe_drivetrain.turbine_loads.histories.level_sums import (
    NO_TORQUE,
    LevelSums,
    TorqueSums,
    level_sums,
    torque_sums,
    turns_of,
)
from fe_drivetrain.turbine_loads.histories.spectrum_sums import (
    HistorySpectra,
    history_spectra,
    joined_spectra,
)
from fe_drivetrain.turbine_loads.histories.windows import Windows, window_statistics
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory
from fe_drivetrain.turbine_loads.hub_loads.recorded import Recorded
from fe_drivetrain.turbine_loads.hub_loads.sampling import Steps, evenly
from fe_drivetrain.turbine_loads.hub_loads.table_kinds import history_digest

LOADS = (*FORCES, "radial force", "bending moment")
"""Channels that are counted; the last two are sizes across the shaft."""

CHANNELS = (*LOADS, "rotor speed", "wind speed")
UNITS = (*3 * ("N",), *3 * ("N m",), "N", "N m", "rad/s", "m/s")
UNIT_OF = dict(zip(CHANNELS, UNITS, strict=True))

MOMENTS_BY_MEAN = ("Mx", "My")
"""Loads whose cycles are counted by range and mean."""

CAMPBELL = ("My", "Mx")
"""Loads of which the first that a file has is shown by rotor speed."""


@dataclass(frozen=True, kw_only=True)
class LoadOptions(HistoryOptions):
    """How histories are read and counted.

    Attributes
    ----------
    channels, rotor_speed_rpm, skip
        How files are read, see `HistoryOptions`.
    slopes : Sequence[float]
        Exponents of S-N curves.
    residue : str
        Rule for cycles that the end of a file leaves open: half, closed, or repeated.
    gate : float
        Cycles of a smaller range are left out, as a share of the largest one of the channel in
        its file.
    ultimate : Mapping[str, float]
        Loads that break the part, by channel [N, N m]: cycles of these are counted about zero mean,
        too, by Goodman's line.
    frequency : float
        Frequency of damage-equivalent loads [Hz]; what is kept of a file does not depend on it.
    also : Sequence[str]
        Further channels, as files call them, of which there are statistics and cycles, too.

    Raises
    ------
    InputError
        A slope is not from 1 to 20 or there is none, a residue or channel is unknown, or a number
        is out of its range.
    """

    slopes: Sequence[float] = SLOPES
    residue: Residue = "half"
    gate: float = 0.0
    ultimate: Mapping[str, float] = field(default_factory=dict)
    frequency: float = FREQUENCY
    also: Sequence[str] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.slopes:
            raise InputError("load histories: there is no slope of an S-N curve: give one or more")
        for slope in self.slopes:
            check_slope(slope)
        require_known("residue of cycles", self.residue, RESIDUES)
        for name, size in self.ultimate.items():
            require_known("channel with an ultimate load", name, LOADS)
            require_between(f"ultimate load of {name}", size, "N or N m", 0.0, np.inf)
        require_between("gate", self.gate, "of the largest range", 0.0, 1.0, with_low=True)
        require_between("frequency of equivalent loads", self.frequency, "Hz", 0.0, np.inf)
        if self.rotor_speed_rpm is not None:
            require_between("rotor speed", self.rotor_speed_rpm, "1/min", 0.0, np.inf)

    @property
    def rotor_speed(self) -> float | None:
        """Rotor speed of files that state none [rad/s]."""
        return None if self.rotor_speed_rpm is None else self.rotor_speed_rpm * ONE_RPM

    @property
    def cycle_rule(self) -> CycleRule:
        """How cycles are counted."""
        return CycleRule(
            tuple(self.slopes), self.residue, self.gate, self.ultimate, MOMENTS_BY_MEAN
        )

    @property
    def counted(self) -> str:
        """How cycles are counted, in words."""
        rule = Cycles(np.zeros(0), np.zeros(0), np.zeros(0), self.residue).rule
        if not self.gate:
            return rule
        return (
            f"{rule}; cycles of a range below {100 * self.gate:g} % of the largest of the channel "
            "in its file are left out"
        )

    def content(self, file: Path) -> dict[str, Any]:
        """All that the digest of a file depends on: what is in the file counts, not its name."""
        return {
            "code": program_hash(),
            "file": history_digest(file),
            "mapping": self.names.content(),
            "slopes": [float(m) for m in self.slopes],
            "ultimate": dict(self.ultimate),
            "also": list(self.also),
            **{name: getattr(self, name) for name in ("skip", "residue", "gate", "rotor_speed")},
        }


@dataclass(frozen=True)
class Span:
    """When a history is.

    Attributes
    ----------
    start, end : float
        Time of the first and the last sample [s].
    step : float
        Between two samples [s].
    samples : int
        How many.
    """

    start: float
    end: float
    step: float
    samples: int

    @property
    def seconds(self) -> float:
        """How long all samples last [s]."""
        return self.samples * self.step


@dataclass(frozen=True, eq=False)
class Digest:
    """The loads of one file: hub loads, a reaction to them, or another channel.

    Attributes
    ----------
    channels : str
        Which channels of the file they were read from.
    span : Span
        When.
    windows : Windows
        Statistics of `CHANNELS` in windows of ten minutes; NaN of what the file has not.
    lone : ndarray, (6, 3)
        Samples that stand alone, of each component: how many, time of the first [s], and how many
        times as far from its neighbours as usual the farthest is.
    cycles : CycleSums
        Cycles of `LOADS`; NaN of those that the file has not.
    levels : LevelSums
        Time and turns at each level of those of `LOADS` that the file has.
    torque : TorqueSums
        Sums of the torque; NaN where the file has none.
    spectra : HistorySpectra or None
        Spectra of `LOADS`, NaN of those that the file has not; None of a file shorter than half a
        segment.
    planes : Mapping[str, PlaneDigest]
        Force and moment across the shaft, where the file has both components.
    own_speeds : ndarray, (2,)
        Least and largest rotor speed that the file states [1/min]; NaN where it has none.
    steps : Steps
        Steps of time, and gaps.
    torque_of : str
        The shaft that Mx was recorded at, where that is not the rotor's; else empty.
    """

    channels: str
    span: Span
    windows: Windows
    lone: Floats
    cycles: CycleSums
    levels: LevelSums
    torque: TorqueSums
    spectra: HistorySpectra | None
    planes: Mapping[str, PlaneDigest]
    own_speeds: Floats
    steps: Steps
    torque_of: str

    @property
    def moment(self) -> str:
        """The first of `CAMPBELL` that it has; empty where it has none."""
        return next((name for name in CAMPBELL if name in self.cycles.ranges), "")

    def mean_of(self, channel: str) -> float:
        """Mean of one of `CHANNELS` over the file; NaN where it has none."""
        weights = self.windows.seconds
        means = self.windows.values[:, CHANNELS.index(channel), 1]
        return float(means @ weights) / float(weights.sum())


def digest(found: Recorded, options: LoadOptions) -> Digest:
    """Statistics, counts and distributions of one file.

    Parameters
    ----------
    found : Recorded
        The history.
    options : LoadOptions
        How it is counted.

    Raises
    ------
    InputError
        The mean of a cycle reaches an ultimate load.
    """
    history, sampling = found.history, found.history.sampling
    count, step, pieces = len(history), sampling.weights, sampling.pieces
    speed = found.rotor_speed
    if speed is None and options.rotor_speed is not None:
        speed = np.full(count, options.rotor_speed)
    loads = _all_loads(history.loads)
    unknown = np.full(count, np.nan)
    beside = [unknown if c is None else c for c in (speed, found.wind_speed)]
    known = [k for k, column in enumerate(loads.T) if not np.isnan(column).all()]
    channels = {LOADS[k]: loads[:, k] for k in known}
    turns = None if speed is None else turns_of(speed, step)
    weights = None if sampling.regular else step
    return Digest(
        channels=str(history.attributes.get("channels", "as in the file")),
        span=Span(float(history.time[0]), float(history.time[-1]), float(np.mean(step)), count),
        windows=window_statistics(history.time, np.column_stack([loads, *beside]), weights=weights),
        lone=_lone(history.time, history.loads, pieces),
        cycles=_of_all(count_cycles(channels, options.cycle_rule, pieces), known),
        levels=level_sums(channels, step, turns),
        torque=(
            torque_sums(channels["Mx"], step, turns, pieces) if "Mx" in channels else NO_TORQUE
        ),
        spectra=_spectra(history, channels, speed, known),
        planes={
            name: plane_digest(history.time, loads[:, y], loads[:, y + 1], step, speed, pieces)
            for name, y in PLANES
            if {y, y + 1} <= set(known)
        },
        own_speeds=own_speeds(found.rotor_speed),
        steps=sampling.steps,
        torque_of=history.torque_of,
    )


def _spectra(
    history: LoadHistory,
    channels: Mapping[str, Floats],
    speed: Floats | None,
    known: Sequence[int],
) -> HistorySpectra | None:
    """Spectra of all pieces, of samples at even times; NaN of loads that are not known."""
    shown = next((name for name in CAMPBELL if name in channels), next(iter(channels)))
    sampling = history.sampling
    mean = None
    if speed is not None and not sampling.regular:
        mean = float(np.average(np.abs(speed), weights=np.full(len(speed), sampling.weights)))
    parts = []
    for piece in sampling.pieces:
        time, step = history.time[piece], sampling.steps.usual
        if len(time) < 2:
            continue
        own = {name: values[piece] for name, values in channels.items()}
        turning = None if speed is None else speed[piece]
        if sampling.steps.even:
            step = float(time[-1] - time[0]) / (len(time) - 1)
        else:
            own = {name: evenly(time, values, step) for name, values in own.items()}
            turning = None if turning is None else evenly(time, turning, step)
        found = history_spectra(own, step, turning, shown, mean)
        if found is not None:
            parts.append((found, len(time) * step))
    whole = joined_spectra(parts)
    if whole is None:
        return None
    multiples = None if whole.multiples is None else _rows_of_all(whole.multiples, known)
    return replace(whole, density=_rows_of_all(whole.density, known), multiples=multiples)


def _of_all(found: CycleSums, known: Sequence[int]) -> CycleSums:
    """Cycles with rows of all `LOADS`, NaN of those that are not known."""
    return replace(
        found,
        damage=_rows_of_all(found.damage, known),
        halves=_rows_of_all(found.halves, known),
        about_zero=_rows_of_all(found.about_zero, known),
        largest=_rows_of_all(found.largest, known),
        number=_rows_of_all(found.number, known),
        left_out=_rows_of_all(found.left_out, known),
    )


def _rows_of_all(values: Floats, known: Sequence[int]) -> Floats:
    """Rows of all `LOADS`, of those that are known."""
    found = np.full((len(LOADS), *values.shape[1:]), np.nan)
    found[list(known)] = values
    return found


class OneShaft:
    """Refuses torques of different shafts among histories that are counted or compared together."""

    def __init__(self) -> None:
        self._first: tuple[str, str] | None = None

    def add(self, name: str, found: Digest) -> None:
        """Add the digest of a file of that name.

        Raises
        ------
        InputError
            Its torque is of another shaft than that of a file before it.
        """
        if "Mx" not in found.cycles.ranges:
            return
        self._first = self._first or (found.torque_of, name)
        if found.torque_of != self._first[0]:
            shafts = [of or "rotor" for of in (self._first[0], found.torque_of)]
            raise InputError(
                f"load histories: {self._first[1]} has the torque of the {shafts[0]} and {name} "
                f"that of the {shafts[1]}: give gearbox_ratio in a mapping, or read them apart"
            )


def _lone(time: Floats, loads: Floats, pieces: Sequence[slice]) -> Floats:
    """Samples of each component that stand alone: see `Digest`."""
    rows = []
    for column in loads.T:
        number, first, far = 0, np.nan, np.nan
        for piece in pieces:
            own = column[piece]
            places = lone_samples(own)
            if len(places):
                number += len(places)
                first = np.fmin(first, time[piece][places[0]])
                far = np.fmax(far, times_as_far(own, places).max())
        rows.append([number, first, far])
    return np.array(rows, dtype=float)


def _all_loads(loads: Floats) -> Floats:
    sizes = [np.hypot(loads[:, y], loads[:, y + 1]) for _, y in PLANES]
    return np.column_stack([loads, *sizes])
