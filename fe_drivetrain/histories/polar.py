"""Where a force or moment points, looking downwind, as the share of time at each place.

The convention is that of Stirling 2023: 0 deg right, 90 up, 180 left, 270 down; a force is shown by
its direction, a moment by its axis. In the shaft frame y points left for whoever looks downwind.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats


@dataclass(frozen=True, eq=False)
class Density:
    """Share of time per area of the plane that is seen looking downwind.

    Attributes
    ----------
    right, up : ndarray, (k + 1,)
        Limits of the cells, in the unit of the load.
    share : ndarray, (k, k)
        Of the time, in each cell; rows go up. All add up to 1.
    """

    right: Floats
    up: Floats
    share: Floats


def direction(y: ArrayLike, z: ArrayLike) -> Floats:
    """Angle of a load, looking downwind: 0 right, pi/2 up, from 0 to 2 pi [rad]: (n,).

    Parameters
    ----------
    y, z : array_like, (n,)
        Components of a force, or of a moment, in the shaft frame.
    """
    angle = np.arctan2(np.asarray(z, dtype=float), -np.asarray(y, dtype=float))
    return np.asarray(angle % (2.0 * np.pi))


def polar_density(
    y: ArrayLike,
    z: ArrayLike,
    cells: int = 60,
    weights: ArrayLike | None = None,
    reach: float | None = None,
) -> Density:
    """Share of time at each place of the plane, about the origin.

    Parameters
    ----------
    y, z : array_like, (n,)
        Components in the shaft frame.
    cells : int
        Along each side of a square about the origin that holds every sample.
    weights : array_like, (n,), optional
        Time of each sample; equal where left out.
    reach : float, optional
        Half the side of the square; as far as the samples go where left out.
    """
    right, up = -np.asarray(y, dtype=float), np.asarray(z, dtype=float)
    far = reach or float(max(np.abs(right).max(), np.abs(up).max())) or 1.0
    edges = np.linspace(-far, far, cells + 1)
    time = np.ones_like(up) if weights is None else np.asarray(weights, dtype=float)
    limits: list[Floats] = [edges, edges]
    share, _, _ = np.histogram2d(up, right, bins=limits, weights=time)
    return Density(edges, edges, np.asarray(share / share.sum()))
