"""Where a force or moment points, looking downwind.

The convention is that of Stirling 2023: 0 deg right, 90 up, 180 left, 270 down; a force is shown by
its direction, a moment by its axis. In the shaft frame y points left for whoever looks downwind.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats


def direction(y: ArrayLike, z: ArrayLike) -> Floats:
    """Angle of a load, looking downwind: 0 right, pi/2 up, from 0 to 2 pi [rad]: (n,).

    Parameters
    ----------
    y, z : array_like, (n,)
        Components of a force, or of a moment, in the shaft frame.
    """
    angle = np.arctan2(np.asarray(z, dtype=float), -np.asarray(y, dtype=float))
    return np.asarray(angle % (2.0 * np.pi))
