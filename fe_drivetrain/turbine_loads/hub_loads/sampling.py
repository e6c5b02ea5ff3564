"""How the samples of a history follow each other: even or uneven steps, and gaps."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr

STEP_TOLERANCE = 0.25
"""Largest departure of one time step from the median step, as a fraction of it.  Time columns are
often printed with three decimals (a step of 0.00625 s shows as 0.006 and 0.007, 17 % apart); one
missing sample is a departure of 100 %."""

GAP = 5.0
"""Steps longer than this many median steps are gaps: what happened there is not known."""


@dataclass(frozen=True, eq=False)
class Steps:
    """Steps of time between the samples of a history, and gaps.

    Attributes
    ----------
    usual : float
        Median step [s].
    least, most : float
        Shortest and longest step that is no gap [s].
    gaps : ndarray, (g, 2)
        Time of the last sample before each gap, and how long it is [s].
    """

    usual: float
    least: float
    most: float
    gaps: Floats

    __repr__ = short_repr

    @property
    def even(self) -> bool:
        """Whether all that are no gaps are equal within `STEP_TOLERANCE`."""
        return max(self.most - self.usual, self.usual - self.least) <= STEP_TOLERANCE * self.usual


@dataclass(frozen=True, eq=False)
class Sampling:
    """How n samples follow each other.

    Attributes
    ----------
    steps : Steps
        Steps and gaps.
    pieces : tuple of slice
        Samples between gaps; one piece where there is none.
    weights : float or ndarray, (n,)
        Time that each sample stands for [s]: half of the steps before and after it, at an end of a
        piece that of its one step. The mean step where samples are even and without a gap.
    """

    steps: Steps
    pieces: tuple[slice, ...]
    weights: float | Floats

    __repr__ = short_repr

    @property
    def regular(self) -> bool:
        """Whether samples are even and without a gap."""
        return self.steps.even and len(self.pieces) == 1


def sampling_of(time: Floats) -> Sampling:
    """Steps and gaps of times.

    Parameters
    ----------
    time : ndarray, (n,)
        Rising, two samples or more [s].
    """
    steps = np.diff(time)
    usual = float(np.median(steps))
    far = np.flatnonzero(steps > GAP * usual)
    ends = [0, *(far + 1).tolist(), len(time)]
    pieces = tuple(slice(a, b) for a, b in pairwise(ends))
    near = np.delete(steps, far)
    gaps = np.column_stack([time[far], steps[far]])
    found = Steps(usual, float(near.min()), float(near.max()), gaps)
    if found.even and not len(far):
        return Sampling(found, pieces, float(time[-1] - time[0]) / len(steps))
    weights = np.concatenate([_weights(time[piece], usual) for piece in pieces])
    return Sampling(found, pieces, weights)


def _weights(time: Floats, usual: float) -> Floats:
    """Time that each sample of a piece stands for."""
    if len(time) < 2:
        return np.full(len(time), usual)
    steps = np.diff(time)
    before, after = np.concatenate([steps[:1], steps]), np.concatenate([steps, steps[-1:]])
    return np.asarray(0.5 * (before + after))


def evenly(time: Floats, values: Floats, step: float) -> Floats:
    """Values at even times, each on the straight line between its neighbours.

    Parameters
    ----------
    time : ndarray, (n,)
        Rising [s].
    values : ndarray, (n,)
        At these times.
    step : float
        Between two even times [s].
    """
    return np.asarray(np.interp(np.arange(time[0], time[-1] + 0.5 * step, step), time, values))
