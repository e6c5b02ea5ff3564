"""Elastic energy of a bearing with rigid rings, whose gradient and Hessian are its forces.

For each lamina K w delta_+^(n+1) / (n+1), its share w and its approach delta as in the compiled
loops; for a straight roller without laminae the integral of that along it; for a ball the same
power of the growth of the distance between the groove centres.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing import kernels
from fe_drivetrain.bearing.contact_forces import checked_motions, packed
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.common.arrays import Floats

_X, _W = np.polynomial.legendre.leggauss(10)


def energy_of(bearing: Bearing, displacements: ArrayLike) -> Floats:
    """Energy stored in all contacts, zero where none is loaded.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    displacements : array_like
        Displacements (n, 5) or (5,): u_x, u_y, u_z [m], theta_y, theta_z [rad].

    Returns
    -------
    energy : Floats
        Energy (n,) [J].
    """
    u = checked_motions(bearing, displacements)
    pack = packed(bearing)
    found = np.zeros(len(u))
    for r, d in enumerate(pack.data):
        of = slice(pack.first[r], pack.first[r + 1])
        co, si = pack.cosines[of], pack.sines[of]
        a = u[:, :1]
        w = si * u[:, 2:3] - co * u[:, 1:2]
        t = -(si * u[:, 3:4] + co * u[:, 4:5])
        n, K = d[kernels.EXPONENT], d[kernels.STIFF]
        if d[kernels.KIND] == kernels.BALLS:
            axial = d[kernels.AXIAL] + a - d[kernels.GROOVE] * t
            radial = d[kernels.RADIAL] + w + d[kernels.ARM] * t
            grown = np.hypot(axial, radial) - d[kernels.DISTANCE]
            each = np.maximum(grown, 0.0) ** (n + 1)
        else:
            b = a * d[kernels.SIN] + w * d[kernels.COS] + t * d[kernels.ARM] - d[kernels.GAP]
            c = t * d[kernels.LEAN]
            if d[kernels.KIND] == kernels.CLOSED:
                each = _along(b, c * d[kernels.LENGTH], n + 1)
            else:
                row = kernels.row_of(pack, r)
                near = b[..., None] + c[..., None] * row.xi - row.free
                each = np.maximum(near, 0.0) ** (n + 1) @ row.shares
        found += K / (n + 1) * each.sum(axis=1)
    return found


def _along(b: Floats, rise: Floats, p: float) -> Floats:
    """Mean of (b + rise x)_+^p over x from -1/2 to 1/2."""
    half = 0.5 * np.abs(rise)
    low, high = np.maximum(b - half, 0.0), np.maximum(b + half, 0.0)
    smooth = low > 0.2 * high
    steep = np.where(smooth, 1.0, 2.0 * half)
    rim = (high ** (p + 1) - low ** (p + 1)) / ((p + 1) * np.where(steep > 0.0, steep, 1.0))
    inside = np.maximum(b[..., None] + 0.5 * rise[..., None] * _X, 0.0) ** p @ (0.5 * _W)
    return np.asarray(np.where(smooth, inside, rim))
