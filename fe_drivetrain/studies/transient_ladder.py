"""Levels of a drivetrain in time against the finest: error, time, the cheapest that is enough."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.comparison.pareto import cheapest_within
from fe_drivetrain.dynamics.bodies.condensed_rungs import SOFT_SEATS, STIFF_SEATS
from fe_drivetrain.dynamics.time.machine_channels import Kind
from fe_drivetrain.studies.transient_runs import LevelRun

QUANTITIES: dict[Kind, str] = {
    "torque": "torques of shafts",
    "mesh": "forces of meshes",
    "bearing": "forces of bearings",
}
"""Kinds of channels that a level may be asked for, in words."""

COUNTED = 0.01
"""Share of the largest force of a kind from which a channel counts in the error of a level."""


@dataclass(frozen=True)
class LevelError:
    """Error of a level for one kind of channels.

    Attributes
    ----------
    kind : str
        "torque", "mesh" or "bearing".
    error : float
        Largest difference of an extreme from that of the finest level, over the largest value of
        the channel there; infinite where the level has no such channel.
    worst : str
        Channel with that difference.
    """

    kind: Kind
    error: float
    worst: str


def level_error(run: LevelRun, finest: LevelRun, kind: Kind) -> LevelError:
    """Error of a level against the finest one.

    Parameters
    ----------
    run, finest : LevelRun
        The same event at both.
    kind : str
        Which channels.
    """
    there = {name: one for name, one in finest.extremes.items() if one.kind == kind}
    largest = max((one.largest for one in there.values()), default=0.0)
    found = LevelError(kind, 0.0 if there else np.inf, "")
    for name, one in there.items():
        if one.largest < COUNTED * largest:
            continue
        own = run.extremes.get(name)
        if own is None:
            return LevelError(kind, np.inf, name)
        apart = max(abs(own.most - one.most), abs(own.least - one.least)) / one.largest
        if apart > found.error:
            found = LevelError(kind, apart, name)
    return found


def bounds_of(runs: Sequence[LevelRun]) -> tuple[LevelRun, LevelRun] | None:
    """Runs at the lower and the upper bound of the main bearings' housings; None without both."""
    known = {run.rung.name: run for run in runs}
    if SOFT_SEATS not in known or STIFF_SEATS not in known:
        return None
    return known[SOFT_SEATS], known[STIFF_SEATS]


def finest_band(runs: Sequence[LevelRun], kind: Kind) -> float:
    """What the step, and both bounds of housings, leave uncertain of the finest level.

    As `level_error` measures it.

    Parameters
    ----------
    runs : sequence of LevelRun
        The same event at each level, the finest last.
    kind : str
        Which channels.
    """
    finest, bounds = runs[-1], bounds_of(runs)
    between = 0.0 if bounds is None else level_error(*bounds, kind).error
    shares = [
        max(one.most_band or 0.0, one.least_band or 0.0) / one.largest
        for one in finest.extremes.values()
        if one.kind == kind and one.largest > 0.0
    ]
    return max(shares, default=0.0) + between


def cheapest_level(runs: Sequence[LevelRun], kind: Kind, tolerance: float) -> int:
    """Number of the quickest level within a tolerance of the finest; the finest where none is.

    Parameters
    ----------
    runs : sequence of LevelRun
        The same event at each level, the finest last.
    kind : str
        Which channels.
    tolerance : float
        Allowed error.
    """
    errors = [level_error(run, runs[-1], kind).error for run in runs]
    # with what a level neglects, not with how long a busy machine took
    found = cheapest_within([run.degrees for run in runs], errors, tolerance)
    return len(runs) - 1 if found is None else found
