"""What a drivetrain does in time, as a result: extremes, levels, samples, histories."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from fe_drivetrain.dynamics.time.machine_channels import Kind, of_planet
from fe_drivetrain.report.charts import chart, trace
from fe_drivetrain.report.results import Chart
from fe_drivetrain.studies.part_damage import PartUse
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.transient_digest import FileDigest
from fe_drivetrain.studies.transient_instants import ByInstant
from fe_drivetrain.studies.transient_ladder import QUANTITIES, LevelError
from fe_drivetrain.studies.transient_runs import Extreme, LevelRun, Samples


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class TransientResult(Result):
    """What a drivetrain does in an event, or in operation.

    Attributes
    ----------
    event : str
        Name of the event.
    level : str
        Level of the model that extremes and samples are of: "torsional", "rigid", "flexible", or
        the name of a condensed one.
    runs : tuple of LevelRun
        The event at each level that was run, from the simplest to the finest; of operation the
        beginning of the first history. Not part of the JSON.
    errors : tuple of tuple of LevelError
        Error of each level against the finest, for torques, meshes and bearings.
    quantity : str
        For which of these the level is enough: "torque", "mesh" or "bearing".
    tolerance : float
        Allowed error of the level.
    extremes : Mapping[str, Extreme]
        Extremes of each channel, by its name: "torque of HSS", "force of stage 3 mesh", "force of
        HS-A", "speed of generator".
    marks : Mapping[str, float]
        What happened when [s].
    imbalance : float
        Energy that appears from nowhere, over the largest.
    samples : Samples
        Values over time; of operation those of the first history. Not part of the JSON.
    files : Mapping[str, FileDigest]
        What it did over each history, by its name; empty of an event.
    by_instant : ByInstant or None
        Peak of the torque that tells what a stop does, by the instant of its brake.
    parts : PartUse or None
        What it does to gears and bearings, of an event once, of operation in a year; None where
        that was not asked for.
    """

    STUDY: ClassVar[str] = "transient"
    SCHEMA_VERSION: ClassVar[int] = 1

    event: str
    level: str
    runs: tuple[LevelRun, ...] = field(repr=False)
    errors: tuple[tuple[LevelError, ...], ...]
    quantity: Kind
    tolerance: float
    extremes: Mapping[str, Extreme]
    marks: Mapping[str, float]
    imbalance: float
    samples: Samples = field(repr=False)
    files: Mapping[str, FileDigest]
    by_instant: ByInstant | None
    parts: PartUse | None = None

    @property
    def chosen(self) -> LevelRun:
        """The run at the level that is reported."""
        return next(run for run in self.runs if run.word == self.level)

    def frames(self) -> Mapping[str, Any]:
        """Tables that `to_frame` gives, by name: those of the page, and "samples" over time."""
        columns = {"time [s]": self.samples.times.tolist()}
        for k, (name, unit) in enumerate(zip(self.samples.names, self.samples.units, strict=True)):
            columns[f"{name} [{unit}]"] = self.samples.values[:, k].tolist()
        rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
        return {**self.all_tables(), "samples": rows}

    def chart(self) -> Chart:
        """Torque of the shafts over time; of a run-up the meshes, of an offset the bearings."""
        if self.event in ("offset", "base"):
            return self.bearing_changes()
        return self.over_time("mesh" if self.event == "run_up" else "torque")

    def bearing_changes(self, most: int = 6) -> Chart:
        """Forces of bearings against those of aligned, steady turning over time, the largest ones.

        Parameters
        ----------
        most : int
            Number of curves.
        """
        size = {
            name: max(one.most - one.rated, one.rated - one.least)
            for name, one in self.extremes.items()
            if one.kind == "bearing" and not (self.chosen.planets_travel and of_planet(name))
        }
        names = sorted(size, key=lambda name: -size[name])[:most]
        last, begin = float(self.samples.times[-1]), float(self.samples.times[0])
        few = f", the {most} largest of {len(size)}" if len(size) > most else ""
        planets = "; planets travel" if self.chosen.planets_travel else ""
        caption = f"Change of the forces of bearings{few}{planets}"
        if self.event == "offset":
            turn = 2.0 * np.pi / self.extremes["speed of generator"].rated
            begin, caption = (
                max(begin, last - 4.0 * turn),
                f"{caption}; last turns of the generator",
            )
        traces = []
        for name in sorted(names, key=list(self.extremes).index):
            times, values = self.samples.course(name, 4000, begin)
            traces.append(trace(name, times, (values - self.extremes[name].rated) / 1e3))
        return chart(caption, traces, "time [s]", "force less that at rated torque [kN]")

    def over_time(self, kind: Kind, most: int = 8) -> Chart:
        """Channels of a kind over their rated values against time, with what happened.

        Parameters
        ----------
        kind : str
            "torque", "mesh", "bearing" or "speed".
        most : int
            Number of curves, those with the largest values over rated ones.
        """
        of = {**QUANTITIES, "speed": "speeds"}[kind]
        relative = kind != "bearing"
        size = {
            name: one.largest / (abs(one.rated) if relative else 1.0)
            for name, one in self.extremes.items()
            if one.kind == kind and (not relative or np.isfinite(one.over_rated))
        }
        names = sorted(size, key=lambda name: -size[name])[:most]
        traces = []
        for name in sorted(names, key=list(self.extremes).index):
            times, values = self.samples.course(name, 2000)
            unit = self.extremes[name].rated if relative else 1e3
            traces.append(trace(name, times, values / unit))
        few = f", the {most} largest of {len(size)}" if len(size) > most else ""
        planets = "; planets travel" if self.chosen.planets_travel else ""
        over = " over their rated values" if relative else ""
        caption = f"{of[0].upper()}{of[1:]}{over}{few}{planets}"
        y = "over rated" if relative else "force [kN]"
        return chart(caption, traces, "time [s]", y, events=self._together())

    def _together(self) -> dict[str, float]:
        """What happened, by time; what happened as good as at once in one."""
        span = float(self.samples.times[-1] - self.samples.times[0])
        found: dict[str, float] = {}
        for name, at in sorted(self.marks.items(), key=lambda item: item[1]):
            last = next(reversed(found), "")
            if last and at - found[last] < 0.01 * span:
                found[f"{last}, {name}"] = found.pop(last)
            else:
                found[name] = at
        return found
