"""What a study of transients needs of one history: extremes, cycles, time at level, streamed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import user_cache
from fe_drivetrain.common.jobs import mapped
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.provenance import program_hash
from fe_drivetrain.dynamics.bodies.advice import Rung
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.dynamics.time.machine_channels import Channels
from fe_drivetrain.dynamics.time.running import Running
from fe_drivetrain.procedure.drivetrain_operation import (
    EnergyAccount,
    Operation,
    operation,
    shaken,
)
from fe_drivetrain.report.seal import drivetrain_hash
from fe_drivetrain.studies.part_loads import NO_PARTS, CountedParts, PartDigest
from fe_drivetrain.studies.transient_histories import OperationOptions
from fe_drivetrain.studies.transient_runs import REVERSAL, SMALL, Prepared, Rated, Samples
from fe_drivetrain.turbine_loads.histories.classes import Classes
from fe_drivetrain.turbine_loads.histories.damage import FREQUENCY
from fe_drivetrain.turbine_loads.histories.farm import Counting, Piece, piece
from fe_drivetrain.turbine_loads.hub_loads.base_history import BaseFacts, BaseHistory
from fe_drivetrain.turbine_loads.hub_loads.drive_history import DriveHistory
from fe_drivetrain.turbine_loads.hub_loads.table_kinds import history_digest

CLASSES = 128
"""Classes of cycles and levels up to the rated value of a channel, at least."""

KEPT = 20_000
"""Samples of a history that are kept for a chart, at most."""

_MANY = 4  # files for which it pays to start processes


@dataclass(frozen=True, eq=False)
class ChannelDigest:
    """One channel over one history.

    Attributes
    ----------
    most, most_at, least, least_at : float
        Extremes, and when [s].
    mean : float
        Mean over time.
    reversals : float
        Changes of its sign.
    damage : tuple of float
        Sums of n r^m over its cycles, of each slope.
    cycles : Classes
        Cycles by range.
    levels : Classes
        Seconds by level.
    """

    most: float
    most_at: float
    least: float
    least_at: float
    mean: float
    reversals: float
    damage: tuple[float, ...]
    cycles: Classes
    levels: Classes


@dataclass(frozen=True, eq=False)
class FileDigest:
    """What a drivetrain did over one history.

    Attributes
    ----------
    seconds : float
        Length of the history [s].
    channels : Mapping[str, ChannelDigest]
        Each channel.
    imbalance : float
        Energy that appears from nowhere, over the largest.
    against_file : float
        Deviation (RMS) of the first shaft's torque from that of the file, over rated torque; NaN of
        a base.
    speed_against_file : float
        Largest deviation of the rotor's speed from that of the file, over rated speed; NaN where
        the file has none.
    own_generator : float
        1 where the generator had the torque of the file; 0 where it had a line of slip.
    absent : str
        Loads that the file does not have.
    parts : PartDigest or None
        What it did to gears and bearings.
    wind : float
        Mean wind speed [m/s]; NaN where the file has none.
    base : BaseFacts or None
        How the base moved; None where hub loads drove it.
    not_converged : float
        Steps in which Newton's method did not converge.
    """

    seconds: float
    channels: Mapping[str, ChannelDigest]
    imbalance: float
    against_file: float
    speed_against_file: float
    own_generator: float
    absent: str = ""
    parts: PartDigest | None = None
    wind: float = np.nan
    base: BaseFacts | None = None
    not_converged: float = 0.0

    def equivalent(self, name: str, k: int, slope: float) -> float:
        """Damage-equivalent range of a channel at the reference frequency, of slope number k."""
        return equivalent_range(self.channels[name].damage[k], self.seconds, slope)


def equivalent_range(damage: float, seconds: float, slope: float) -> float:
    """Range of a sine of the reference frequency with the same damage in that time."""
    return float((damage / (FREQUENCY * seconds)) ** (1.0 / slope))


@dataclass
class _Sums:
    """A channel as it is counted piece by piece."""

    counting: Counting
    band: float
    piece: Piece | None = None
    most: float = -np.inf
    most_at: float = 0.0
    least: float = np.inf
    least_at: float = 0.0
    total: float = 0.0
    count: int = 0
    sign: float = 0.0
    reversals: int = 0

    def add(self, times: Floats, values: Floats) -> None:
        """Add samples that follow those before."""
        high, low = int(values.argmax()), int(values.argmin())
        if values[high] > self.most:
            self.most, self.most_at = float(values[high]), float(times[high])
        if values[low] < self.least:
            self.least, self.least_at = float(values[low]), float(times[low])
        self.total += float(values.sum())
        self.count += len(values)
        signs = np.sign(values[np.abs(values) > self.band])
        if len(signs):
            before = self.sign or signs[0]
            self.reversals += int(np.count_nonzero(np.diff(signs, prepend=before)))
            self.sign = float(signs[-1])
        counted = piece(values, self.counting)
        self.piece = counted if self.piece is None else self.piece + counted

    def digest(self, step: float) -> ChannelDigest:
        """All of it."""
        assert self.piece is not None
        whole = self.piece.whole()
        levels = whole.levels
        return ChannelDigest(
            self.most,
            self.most_at,
            self.least,
            self.least_at,
            self.total / self.count,
            float(self.reversals),
            tuple(float(one) for one in whole.damage),
            whole.cycles,
            Classes(levels.powers, levels.first, levels.amount * step),
        )


@dataclass
class _Against:
    """Deviations of torque and speed from those of the file; none of a base."""

    history: DriveHistory | None
    squares: float = 0.0
    count: int = 0
    speed: float = field(default=np.nan)

    def add(self, times: Floats, torque: Floats, speed: Floats) -> None:
        """Add samples."""
        if self.history is None:
            return
        known = np.interp(times, self.history.time, self.history.torque)
        self.squares += float(((torque - known) ** 2).sum())
        self.count += len(times)
        if self.history.rotor_speed is not None:
            apart = np.abs(speed - np.interp(times, self.history.time, self.history.rotor_speed))
            self.speed = max(0.0 if np.isnan(self.speed) else self.speed, float(apart.max()))

    @property
    def torque(self) -> float:
        """Deviation (RMS) of the torque; NaN of a base [N m]."""
        if self.history is None:
            return np.nan
        return float(np.sqrt(self.squares / max(self.count, 1)))


def moving_under(of: Running, history: DriveHistory | BaseHistory, slip: float) -> Operation:
    """A machine that its history drives, or whose base it moves.

    Parameters
    ----------
    of : Running
        The machine at a level.
    history : DriveHistory or BaseHistory
        The history.
    slip : float
        Slip of the generator at rated torque.
    """
    if isinstance(history, BaseHistory):
        return shaken(of, history, slip)
    return operation(of, history, slip)


def driven(
    prepared: Prepared,
    history: DriveHistory | BaseHistory,
    asked: OperationOptions,
    moving: Operation | None = None,
) -> tuple[FileDigest, Samples]:
    """What a drivetrain does over a history: the digest, and samples for a chart.

    Parameters
    ----------
    prepared : Prepared
        The drivetrain at a level.
    history : DriveHistory or BaseHistory
        What drives it, or moves its base.
    asked : OperationOptions
        Step, slopes, and until when.
    moving : Operation, optional
        The machine under the history, where it is known; that of `moving_under` else.
    """
    channels, rated = prepared.channels, prepared.rated
    moving = moving or moving_under(prepared.of, history, rated.slip)
    sums = _sums(channels, tuple(asked.slopes))
    hub = history if isinstance(history, DriveHistory) else None
    account, against, counter = EnergyAccount(), _Against(hub), prepared.reader.counter(hub)
    first = next((k for k, kind in enumerate(channels.kinds) if kind == "torque"), None)
    rotor = channels.names.index("speed of rotor")
    until = None if asked.until is None else float(history.time[0]) + asked.until
    end = moving.end if until is None else min(until, moving.end)
    every = max(1, round((end - float(history.time[0])) / asked.step) // KEPT)
    shown: list[tuple[Floats, Floats]] = []
    seen = not_converged = 0
    for part in moving.pieces(asked.step, until):
        account.add(part)
        not_converged += part.not_converged
        begin, values = 1 if seen else 0, channels.of(part)
        counter.add(part, values)
        times, values = part.times[begin:], values[begin:]
        for one, column in zip(sums, values.T, strict=True):
            one.add(times, column)
        if first is not None:
            against.add(times, values[:, first], values[:, rotor])
        kept = slice(-seen % every, None, every)  # evenly over the ends of pieces
        # a view would keep all of the piece
        shown.append((times[kept].copy(), values[kept].copy()))
        seen += len(times)
    digest = FileDigest(
        end - float(history.time[0]),
        {name: one.digest(asked.step) for name, one in zip(channels.names, sums, strict=True)},
        account.relative_imbalance,
        against.torque / rated.torque,
        against.speed / rated.rotor_speed,
        float(hub is not None and hub.generator_torque is not None),
        "" if hub is None else ", ".join(hub.absent),
        counter.digest(),
        np.nan if hub is None else hub.wind,
        history.facts if isinstance(history, BaseHistory) else None,
        float(not_converged),
    )
    units = tuple(channels.unit(k) for k in range(len(channels.names)))
    times = np.concatenate([t for t, _ in shown])
    return digest, Samples(times, np.concatenate([v for _, v in shown]), channels.names, units)


def _sums(channels: Channels, slopes: tuple[float, ...]) -> list[_Sums]:
    """Counters of all channels, with classes by their rated values."""
    rated = np.abs(channels.rated)
    found = []
    for k, kind in enumerate(channels.kinds):
        largest = max(rated[j] for j, other in enumerate(channels.kinds) if other == kind)
        scale = max(float(rated[k]), SMALL * float(largest))
        power = int(np.floor(np.log2(scale / CLASSES)))
        found.append(_Sums(Counting(power, slopes), REVERSAL * scale))
    return found


def kept_digest(
    _report: Progress,
    file: Path,
    machine: Machine,
    rung: Rung,
    rated: Rated,
    asked: OperationOptions,
    resume: bool,
    parts: CountedParts = NO_PARTS,
) -> FileDigest:
    """The digest of a file, or that of an earlier run where it is kept and asked for.

    Parameters
    ----------
    _report : callable
        Report of a job in a process; what takes this long shows no steps.
    file : Path
        The file with the history.
    machine : Machine
        Table of the machine.
    rung : Rung
        What may move, and what gives.
    rated : Rated
        Rated torque, speed and damping.
    asked : OperationOptions
        How histories are read and counted.
    resume : bool
        Take what is kept.
    parts : CountedParts
        Bearings whose damage is counted.

    Raises
    ------
    InputError
        The file cannot be read.
    """
    cache, content = user_cache(), _content(file, machine, rung, rated, asked, parts)
    if resume:
        kept = cache.load_record("load-digests", content, FileDigest)
        if kept is not None:
            return kept
    history = asked.read(file)
    whole = isinstance(history, DriveHistory) and history.has_all
    prepared = Prepared(machine, rung, rated, hub_loads=whole, parts=parts)
    found, _ = driven(prepared, history, asked)
    cache.keep_record("load-digests", content, found)
    return found


def _content(
    file: Path,
    machine: Machine,
    rung: Rung,
    rated: Rated,
    asked: OperationOptions,
    parts: CountedParts,
) -> dict[str, Any]:
    """All that the digest of a file depends on: what is in the file counts, not its name."""
    return {
        "of": "a drivetrain in time",
        "code": program_hash(),
        "file": history_digest(file),
        "drivetrain": drivetrain_hash(machine),
        "level": rung.level.value,
        "gives": _plain(rung.flexible),
        "rollers": rung.rollers,
        "rated": rated.plain(),
        "mapping": asked.names.content(),
        "skip": asked.skip,
        "slopes": [float(slope) for slope in asked.slopes],
        "step": asked.step,
        "until": asked.until,
        "base": _plain(asked.base),
        "parts": parts.content,
    }


def _plain(value: Any) -> Any:
    """Records and arrays as plain data."""
    if is_dataclass(value):
        return {one.name: _plain(getattr(value, one.name)) for one in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): _plain(of) for key, of in value.items()}
    if isinstance(value, (frozenset, set)):
        return sorted(value)
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    return value.tolist() if isinstance(value, np.ndarray) else value


def digests(
    files: Sequence[Path],
    machine: Machine,
    rung: Rung,
    rated: Rated,
    asked: OperationOptions,
    resume: bool,
    report: Progress,
    parts: CountedParts = NO_PARTS,
) -> Iterator[FileDigest]:
    """Digests file by file, several at a time where there are cores; each kept once it is done.

    Parameters
    ----------
    files : sequence of Path
        Histories.
    machine : Machine
        Table of the machine.
    rung : Rung
        What may move, and what gives.
    rated : Rated
        Rated torque, speed and damping.
    asked : OperationOptions
        How histories are read and counted.
    resume : bool
        Take digests that an earlier run kept.
    report : Progress
        Called with the number of each file.
    parts : CountedParts
        Bearings whose damage is counted.
    """
    items = ((file, machine, rung, rated, asked, resume, parts) for file in files)
    made = mapped(kept_digest, items, len(files) if len(files) >= _MANY else 1, report)
    for number in range(1, len(files) + 1):
        report(f"files ({number} of {len(files)})")
        yield next(made)
