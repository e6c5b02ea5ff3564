"""One event of a drivetrain at one level: integrated, read, and with the band of its step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from time import perf_counter
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.comparison.in_time import InTime, converge_in_time, peak_between
from fe_drivetrain.drivetrain_file.turning_parts import DampingRatios
from fe_drivetrain.dynamics.bodies.advice import Rung
from fe_drivetrain.dynamics.bodies.damping_ratios import ASSUMED_RATIOS
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.dynamics.time.integration import transient
from fe_drivetrain.dynamics.time.machine_channels import Channels, Kind, machine_channels
from fe_drivetrain.dynamics.time.running import Running, running
from fe_drivetrain.procedure.drivetrain_events import SLIP, Planned
from fe_drivetrain.procedure.drivetrain_operation import EnergyAccount, Operation
from fe_drivetrain.procedure.travelling_planets import with_turning
from fe_drivetrain.studies.part_loads import NO_PARTS, CountedParts, PartDigest, PartReader
from fe_drivetrain.turbine_loads.histories.levels import torque_reversals

REVERSAL = 0.01
"""Share of a channel's rated value within which it has no sign."""

SMALL = 1e-3
"""Share of the largest force of a kind below which a channel is left out."""


@dataclass(frozen=True)
class Rated:
    """What a drivetrain runs at before anything happens, and how it is damped.

    Attributes
    ----------
    torque, rotor_speed : float
        Torque on the rotor that the generator holds, and its speed [N m, rad/s].
    slip : float
        Slip of the generator at that torque.
    damping : DampingRatios
        Damping ratios of what the drivetrain gives no damper for.
    backlash : float
        Backlash of all meshes along their lines of action [m].
    """

    torque: float
    rotor_speed: float
    slip: float = SLIP
    damping: DampingRatios = ASSUMED_RATIOS
    backlash: float = 0.0

    def plain(self) -> dict[str, Any]:
        """All of it as plain data."""
        own = {name: getattr(self, name) for name in ("torque", "rotor_speed", "slip", "backlash")}
        return {**own, "damping": self.damping.model_dump()}

    def running(
        self, machine: Machine, rung: Rung, teeth: bool = False, hub_loads: bool = False
    ) -> Running:
        """A machine that turns steadily at a level; see `running`."""
        return running(
            machine,
            rung.level,
            self.torque,
            self.rotor_speed,
            self.damping,
            backlash=self.backlash,
            teeth=teeth,
            hub_loads=hub_loads,
            flexible=rung.flexible,
            rollers=rung.rollers,
        )


@dataclass(frozen=True)
class Extreme:
    """Extremes of a channel.

    Attributes
    ----------
    kind : str
        "torque", "mesh", "bearing" or "speed".
    unit : str
        Its unit.
    rated : float
        Value in steady turning at rated torque.
    most, most_at : float
        Largest value, and when [s].
    least, least_at : float
        Least value, and when [s].
    reversals : int
        How often its sign changed, beyond a band about zero.
    most_band, least_band : float or None
        What the step leaves uncertain of either; None where that was not found.
    file : str
        History with the largest value; empty of an event.
    """

    kind: Kind
    unit: str
    rated: float
    most: float
    most_at: float
    least: float
    least_at: float
    reversals: int
    most_band: float | None = None
    least_band: float | None = None
    file: str = ""

    @property
    def largest(self) -> float:
        """The larger of both, without its sign."""
        return max(abs(self.most), abs(self.least))

    @property
    def over_rated(self) -> float:
        """Largest value over the rated one; NaN where that is as good as zero."""
        return self.most / self.rated if abs(self.rated) > 1e-6 * self.largest else np.nan

    @property
    def least_over_rated(self) -> float:
        """Least value over the rated one; NaN where that is as good as zero."""
        return self.least / self.rated if abs(self.rated) > 1e-6 * self.largest else np.nan


NEARLY_EQUAL = 0.95
"""Largest torque over rated, as a share of any shaft's, from which on shafts count as equal."""


def telling_torque(extremes: Mapping[str, Extreme]) -> str:
    """Torque that tells what happens: of the shafts that are loaded most over rated, the last.

    The last shaft alone does not: a brake before it loads all the gears and not that shaft.

    Parameters
    ----------
    extremes : Mapping[str, Extreme]
        Extremes by channel.

    Returns
    -------
    str
        Name of the channel; empty where there is none.
    """
    sizes = {
        name: one.largest / abs(one.rated)
        for name, one in extremes.items()
        if one.kind == "torque" and np.isfinite(one.over_rated)
    }
    most = max(sizes.values(), default=0.0)
    return next((name for name in reversed(sizes) if sizes[name] >= NEARLY_EQUAL * most), "")


@dataclass(frozen=True)
class Samples:
    """What a drivetrain did over time.

    Attributes
    ----------
    times : Floats
        Times (k,) [s].
    values : Floats
        Values (k, c) of the channels.
    names : tuple of str
        Names (c,) of the channels.
    units : tuple of str
        Units (c,).
    """

    __repr__ = short_repr

    times: Floats
    values: Floats
    names: tuple[str, ...]
    units: tuple[str, ...]

    def of(self, name: str) -> Floats:
        """(k,) values of a channel; ValueError where there is none of that name."""
        return np.asarray(self.values[:, self.names.index(name)])

    def course(self, name: str, count: int, begin: float = -np.inf) -> tuple[Floats, Floats]:
        """Times and values of a channel for a chart: of each short span its least and its largest.

        Parameters
        ----------
        name : str
            The channel.
        count : int
            At most about so many samples.
        begin : float
            Time from which on [s].
        """
        kept = np.flatnonzero(self.times >= begin)
        times, values = self.times[kept], self.of(name)[kept]
        spans = max(1, count // 2)
        if len(times) <= 2 * spans:
            return times, values
        edges = np.linspace(0, len(times), spans + 1).astype(int)
        of_spans = [
            edge + np.array([np.argmin(values[edge:end]), np.argmax(values[edge:end])])
            for edge, end in pairwise(edges.tolist())
        ]
        which = np.unique(np.concatenate(of_spans))
        return times[which], values[which]


@dataclass(frozen=True)
class LevelRun:
    """One event at one level.

    Attributes
    ----------
    rung : Rung
        What may move, and what gives.
    degrees : int
        Number of degrees of freedom.
    seconds : float
        Wall time to build and to integrate it [s].
    step : float
        Step [s].
    samples : Samples
        What it did.
    extremes : Mapping[str, Extreme]
        Extremes by channel.
    marks : Mapping[str, float]
        What happened when [s].
    imbalance : float
        Energy that appears from nowhere, over the largest.
    converged : bool
        Whether Newton's method converged in every step.
    angle : Floats
        Angle (k,) of the generator [rad].
    planets_travel : bool
        Whether planets are where their carrier is; else they stand at one azimuth.
    parts : PartDigest or None
        What it did to gears and bearings, where that was counted.
    coarser : PartDigest or None
        The same with twice the step, where that was run.
    """

    __repr__ = short_repr

    rung: Rung
    degrees: int
    seconds: float
    step: float
    samples: Samples
    extremes: Mapping[str, Extreme]
    marks: Mapping[str, float]
    imbalance: float
    converged: bool
    angle: Floats = field(repr=False)
    planets_travel: bool = False
    parts: PartDigest | None = field(default=None, repr=False)
    coarser: PartDigest | None = field(default=None, repr=False)

    @property
    def level(self) -> Level:
        """What may move."""
        return self.rung.level

    @property
    def word(self) -> str:
        """The word that asks for its level; the level's name of a condensed one."""
        level = self.level
        return level.name.lower() if self.rung.name == level.value else self.rung.name


class Prepared:
    """A drivetrain at a level, ready to run with any step.

    Parameters
    ----------
    machine : Machine
        Table of the machine.
    rung : Rung
        What may move, and what gives.
    rated : Rated
        Torque, speed and damping.
    teeth : bool
        Whether the stiffness of meshes varies as teeth pass.
    hub_loads : bool
        Whether loads of a history act at the hub, see `running`.
    parts : CountedParts
        Bearings whose damage is counted beside that of the gears.
    """

    def __init__(
        self,
        machine: Machine,
        rung: Rung,
        rated: Rated,
        teeth: bool = False,
        hub_loads: bool = False,
        parts: CountedParts = NO_PARTS,
    ) -> None:
        begin = perf_counter()
        self.rated, self.rung = rated, rung
        self.of = rated.running(machine, rung, teeth, hub_loads)
        self.channels = machine_channels(self.of)
        self.reader = PartReader(self.of, self.channels, parts)
        self.seconds = perf_counter() - begin

    def event(self, planned: Planned, step: float, counts: bool = True) -> LevelRun:
        """One event with a step.

        Parameters
        ----------
        planned : Planned
            Its phases.
        step : float
            Step [s].
        counts : bool
            Whether damage of gears and bearings is counted.
        """
        begin = perf_counter()
        motion = transient(planned.phases, step, planned.start)
        travels = planned.reference is not None
        if planned.reference is not None:
            motion = with_turning(self.of, motion, planned.reference)
        marks = dict(planned.marks)
        stands = [t for t, what in motion.braking.events if what == "sticks"]
        if stands:
            marks["disc stands"] = stands[0]
        values = self.channels.of(motion)
        counter = self.reader.counter()
        if counts:
            counter.add(motion, values)
        run = self._run(
            begin,
            step,
            (motion.times, values),
            marks,
            motion.relative_imbalance,
            motion.converged,
            np.asarray(motion.q @ self.of.turning.to_generator),
        )
        run = replace(run, planets_travel=travels)
        return replace(run, parts=counter.digest()) if counts else run

    def window(self, moving: Operation, step: float, window: float) -> LevelRun:
        """The beginning of a history.

        Parameters
        ----------
        moving : Operation
            The drivetrain, driven by the history.
        step, window : float
            Step, and how much of the history [s].
        """
        begin, account, counter = perf_counter(), EnergyAccount(), self.reader.counter()
        parts: list[tuple[Floats, Floats]] = []
        converged = True
        for part in moving.pieces(step, moving.start.time + window):
            account.add(part)
            converged = converged and part.converged
            first, values = 1 if parts else 0, self.channels.of(part)
            counter.add(part, values)
            parts.append((part.times[first:], values[first:]))
        found = np.concatenate([t for t, _ in parts]), np.concatenate([v for _, v in parts])
        nowhere = account.relative_imbalance
        run = self._run(begin, step, found, {}, nowhere, converged, np.zeros(len(found[0])))
        return replace(run, parts=counter.digest())

    def _run(
        self,
        begin: float,
        step: float,
        found: tuple[Floats, Floats],
        marks: Mapping[str, float],
        imbalance: float,
        converged: bool,
        angle: Floats,
    ) -> LevelRun:
        channels = self.channels
        units = tuple(channels.unit(k) for k in range(len(channels.names)))
        samples = Samples(*found, channels.names, units)
        return LevelRun(
            self.rung,
            len(self.of.system.names),
            self.seconds + perf_counter() - begin,
            step,
            samples,
            extremes_of(samples, channels),
            marks,
            imbalance,
            converged,
            angle,
        )


def extremes_of(samples: Samples, channels: Channels) -> dict[str, Extreme]:
    """Extremes of all channels that carry something.

    Parameters
    ----------
    samples : Samples
        Values over time.
    channels : Channels
        What they are of.
    """
    sizes = np.abs(samples.values).max(axis=0)
    largest = {
        kind: max(s for s, k in zip(sizes, channels.kinds, strict=True) if k == kind)
        for kind in set(channels.kinds)
    }
    found: dict[str, Extreme] = {}
    for k, (name, kind) in enumerate(zip(channels.names, channels.kinds, strict=True)):
        values = samples.values[:, k]
        if sizes[k] < SMALL * largest[kind]:
            continue
        rated = float(channels.rated[k])
        back = torque_reversals(values, 1.0, REVERSAL * max(abs(rated), SMALL * largest[kind]))
        found[name] = Extreme(
            kind,
            channels.unit(k),
            rated,
            peak_between(values),
            float(samples.times[values.argmax()]),
            -peak_between(-values),
            float(samples.times[values.argmin()]),
            back.count,
        )
    return found


def with_bands(run: LevelRun, again: Callable[[float], LevelRun]) -> LevelRun:
    """A run with what its step leaves uncertain, by twice and four times its step.

    Parameters
    ----------
    run : LevelRun
        The run with the shortest step.
    again : callable
        Makes the same run with another step [s].
    """

    longer: dict[float, LevelRun] = {}

    def once(step: float, _: int) -> InTime:
        one = run
        if step > 1.5 * run.step:
            one = longer[step] = again(step)
        values = {}
        for name in run.extremes:
            at = one.samples.of(name)
            values[f"{name} most"] = peak_between(at)
            values[f"{name} least"] = -peak_between(-at)
        return InTime(values, one.imbalance, one.converged)

    series = converge_in_time(once, run.step)
    extremes = {
        name: replace(
            one,
            most_band=series.step_band(f"{name} most"),
            least_band=series.step_band(f"{name} least"),
        )
        for name, one in run.extremes.items()
    }
    return replace(run, extremes=extremes, coarser=longer[min(longer)].parts)
