"""Torque of a generator while the grid's voltage dips: by a table, as grid codes differ.

PROTEST 2010 finds that low voltage ride through is in today's load cases in name only (section
4.2): dips have many shapes. A `Dip` is a table of depth, duration and recovery; the drivetrain
answers through `driven_motions`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError


@dataclass(frozen=True)
class TorqueTable:
    """Share of a generator's torque by corners, of a dip of any shape, or of several.

    Attributes
    ----------
    times : tuple of float
        Times of the corners, in order; two at the same time are a jump [s].
    values : tuple of float
        Share of the torque before at each; the first and the last hold on outside.
    """

    times: tuple[float, ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        steps = np.diff(self.times)
        if (
            len(self.times) != len(self.values)
            or len(self.times) < 2
            or not np.isfinite([*self.times, *self.values]).all()
            or (steps < 0.0).any()
        ):
            raise InputError(
                f"a table of torque with {len(self.times)} times and {len(self.values)} shares: "
                "give as many of both, two or more, finite, times in order"
            )

    def shares(self, time: Floats) -> Floats:
        """Share of the torque, straight between the corners.

        Parameters
        ----------
        time : ndarray, (n,)
            [s].
        """
        return np.asarray(np.interp(np.asarray(time, np.float64), self.times, self.values))


@dataclass(frozen=True)
class Dip:
    """A dip of the generator's torque.

    Attributes
    ----------
    start : float
        When it begins [s].
    depth : float
        Share of the torque that is lost; above 1 it is reversed.
    duration : float
        From its begin to that of the recovery [s].
    fall, recovery : float
        Time to the bottom, and from it back to the full torque [s].
    """

    start: float
    depth: float
    duration: float
    fall: float = 0.005
    recovery: float = 0.1

    def __post_init__(self) -> None:
        times = (self.duration - self.fall, self.fall, self.recovery, self.depth)
        if min(times) < 0.0 or not np.isfinite([*times, self.start]).all():
            raise InputError(
                f"a dip of depth {self.depth:g} that falls in {self.fall:g} s, begins to recover "
                f"after {self.duration:g} s and recovers in {self.recovery:g} s: give values from "
                "0, "
                "and a duration of at least the fall"
            )

    def shares(self, time: Floats) -> Floats:
        """Share of its torque that the generator has, straight between the corners of the table.

        Parameters
        ----------
        time : ndarray, (n,)
            [s].
        """
        return self.table.shares(time)

    @property
    def table(self) -> TorqueTable:
        """The same by its corners."""
        ends = [self.start + t for t in (0.0, self.fall, self.duration)]
        low = 1.0 - self.depth
        return TorqueTable(
            (*ends, self.start + self.duration + self.recovery), (1.0, low, low, 1.0)
        )
