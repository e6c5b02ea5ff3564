"""Elastic energy of a bearing with rigid rings, whose gradient and Hessian are its forces.

For each lamina K w delta_+^(n+1) / (n+1), its share w and its approach delta as in the compiled
loops; for a straight roller without laminae the integral of that along it; for a ball the same
power of the growth of the distance between the groove centres. Compiled, since a run in time has it
for each of its steps.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.contact_forces import checked_motions, packed
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing.kernels import (
    ARM,
    AXIAL,
    BALLS,
    CLOSED,
    COS,
    DISTANCE,
    EVEN,
    EXPONENT,
    GAP,
    GROOVE,
    KIND,
    LEAN,
    LENGTH,
    NODES,
    RADIAL,
    SIN,
    STIFF,
    Packed,
    PackedRow,
    power,
    row_of,
)
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.compiled import inner_loop, njit

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
    found = np.zeros(len(u))
    _energies(packed(bearing), np.ascontiguousarray(u), found)
    return found


@njit(cache=True, error_model="numpy")
def _energies(bearing: Packed, u: Floats, found: Floats) -> None:  # pragma: no cover - compiled
    for r in range(len(bearing.data)):
        d = bearing.data[r]
        row = row_of(bearing, r)
        by = d[STIFF] / (d[EXPONENT] + 1.0)
        half = 0.5 * d[LENGTH] * d[LEAN]
        for i in range(bearing.first[r], bearing.first[r + 1]):
            co, si = bearing.cosines[i], bearing.sines[i]
            for k in range(len(u)):
                a, w = u[k, 0], si * u[k, 2] - co * u[k, 1]
                t = -(si * u[k, 3] + co * u[k, 4])
                if d[KIND] == BALLS:
                    found[k] += by * _of_ball(d, a, w, t)
                    continue
                b = a * d[SIN] + w * d[COS] + t * d[ARM] - d[GAP]
                if b + abs(t) * half > 0.0:
                    found[k] += by * _of_roller(row, b, t * d[LEAN])


@inner_loop
def _of_ball(d: Floats, a: float, w: float, t: float) -> float:  # pragma: no cover - compiled
    """Power n + 1 of the growth of a ball's distance."""
    axial = d[AXIAL] + a - d[GROOVE] * t
    radial = d[RADIAL] + w + d[ARM] * t
    grown = np.sqrt(axial * axial + radial * radial) - d[DISTANCE]
    return float(grown ** (d[EXPONENT] + 1.0)) if grown > 0.0 else 0.0


@inner_loop
def _of_roller(row: PackedRow, b: float, c: float) -> float:  # pragma: no cover - compiled
    """Mean of the power n + 1 of the approach along a roller; its table is of n - 1."""
    d, total = row.data, 0.0
    if d[EVEN] == 1.0 and abs(c) * d[LENGTH] <= b:
        for k in range(NODES):
            z = b + c * row.nodes[k]
            total += row.node_shares[k] * z * z * power(z, row.table)
        return total
    if d[KIND] == CLOSED:
        return _along(b, c * d[LENGTH], d[EXPONENT] + 1.0)
    for k in range(len(row.xi)):
        z = b + c * row.xi[k] - row.free[k]
        if z > 0.0:
            total += row.shares[k] * z * z * power(z, row.table)
    return total


@inner_loop
def _along(b: float, rise: float, p: float) -> float:  # pragma: no cover - compiled
    """Mean of (b + rise x)_+^p over x from -1/2 to 1/2."""
    half = 0.5 * abs(rise)
    low, high = max(b - half, 0.0), max(b + half, 0.0)
    if low <= 0.2 * high:
        steep = 2.0 * half if half > 0.0 else 1.0
        return float((high ** (p + 1.0) - low ** (p + 1.0)) / ((p + 1.0) * steep))
    total = 0.0
    for k in range(len(_X)):
        total += 0.5 * _W[k] * (b + 0.5 * rise * _X[k]) ** p
    return float(total)
