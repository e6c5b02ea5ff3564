"""Disc brakes: dry friction of full size while the disc turns, and up to that while it stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.equations import Loads, varying


@dataclass(frozen=True)
class Brake:
    """A disc brake.

    Attributes
    ----------
    row : Floats
        Row (n,) from the velocities to the speed of the disc.
    torque : float
        Friction torque, at full size [N m].
    start, rise : float
        Time at which it is applied, and time that its torque takes to grow to full size, evenly
        [s].
    """

    __repr__ = short_repr

    row: Floats
    torque: float
    start: float
    rise: float = 0.0

    def size(self, t: float) -> float:
        """Maximum torque at a time [N m]."""
        return float(self.sizes(t))

    def sizes(self, times: ArrayLike) -> Floats:
        """Maximum torques at times [N m]."""
        since = np.asarray(times, dtype=np.float64) - self.start
        grown = np.minimum(since / self.rise, 1.0) if self.rise > 0.0 else 1.0
        return np.asarray(self.torque * np.where(since < 0.0, 0.0, grown))

    def friction(self, side: float, begin: float, end: float) -> Loads:
        """Friction of a disc that turns to one side (1 or -1), from a time to another [s]."""
        full = self.start + self.rise
        times = np.unique([begin, *([full] if begin < full < end else []), end])
        return varying(self.row, times, -side * self.sizes(times))
