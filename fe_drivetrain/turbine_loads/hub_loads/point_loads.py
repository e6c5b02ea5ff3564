"""Hub loads as an array that says which point of the shaft's axis its moments are about."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class PointLoads:
    """Loads of the rotor on the shaft with the point that they are about.

    Attributes
    ----------
    values : Floats
        (..., 6) Fx, Fy, Fz [N], Mx, My, Mz [N m] in the shaft frame that does not turn; with
        (..., 6 + 6 m) those at m load points, about these, with their weights.
    x : float
        Place of the point on the shaft's axis that the moments of the first six are about [m].

    Raises
    ------
    InputError
        The shape is another, or x is no number.
    """

    values: Floats
    x: float

    __repr__ = short_repr

    def __post_init__(self) -> None:
        values = np.asarray(self.values, dtype=np.float64)
        if values.ndim == 0 or not values.shape[-1] or values.shape[-1] % len(FORCES):
            raise InputError(
                f"hub loads have the shape {values.shape}: give (n, 6), the columns being "
                f"{', '.join(FORCES)}, and six more for each load point"
            )
        if not np.isfinite(self.x):
            raise InputError(f"hub loads about x = {self.x:g} m: give a finite number, in m")
        object.__setattr__(self, "values", values)

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, rows: Any) -> PointLoads:
        return replace(self, values=self.values[rows])

    def moved(self, x: float) -> PointLoads:
        """The same loads with moments about another point of the shaft's axis, at x [m]."""
        if x == self.x:
            return self
        return PointLoads(moved_moments(self.values, self.x - x), x)


def moved_moments(loads: Floats, distance: float) -> Floats:
    """Loads about a point of the shaft's axis, from those about one downwind of it.

    Parameters
    ----------
    loads : ndarray, (..., 6 or more)
        In the shaft frame; My and Mz of the first six columns change.
    distance : float
        From the point to the one that they are about, along the shaft downwind [m].
    """
    moved = loads.copy()
    moved[..., 4] -= distance * loads[..., 2]
    moved[..., 5] += distance * loads[..., 1]
    return moved
