"""Load distribution of one row in closed form, after Sjovall (1933).

Many rolling elements, rigid rings, no tilt. epsilon is the loaded share of the diameter: 0.5 is
half of the circle, above 1 all carry.
"""

from __future__ import annotations

from math import acos, cos, pi, sin, tan

import numpy as np
from scipy.integrate import quad

from fe_drivetrain.bearing.geometry import Bearing, RollerRow, Row
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError


def sjovall(epsilon: float, exponent: float) -> tuple[float, float]:
    """The radial and the axial integral.

    Parameters
    ----------
    epsilon : float
        Loaded share of the diameter, positive.
    exponent : float
        Exponent of the contact law.

    Returns
    -------
    J_r, J_a : float
        1 / (2 pi) integral of (1 - (1 - cos psi) / (2 epsilon))^n, times cos psi or not, over the
        loaded angle.

    Raises
    ------
    InputError
        epsilon is not positive.
    """
    if not epsilon > 0.0:
        raise InputError(f"load zone epsilon is {epsilon:g}: it must be positive")
    limit = acos(1.0 - 2.0 * epsilon) if epsilon < 1.0 else pi

    def integral(radial: bool) -> float:
        def load(x: float) -> float:
            psi = limit * x * (1.5 - 0.5 * x * x)  # finer towards the rim, where the load ends
            share = max(1.0 - (1.0 - cos(psi)) / (2.0 * epsilon), 0.0)
            weight = cos(psi) if radial else 1.0
            return float(share**exponent) * weight * limit * 1.5 * (1.0 - x * x)

        return float(quad(load, 0.0, 1.0, epsabs=1e-13, epsrel=1e-12)[0]) / pi

    return integral(True), integral(False)


def superposed_peak(bearing: Bearing, load: Floats) -> Floats:
    """The peak roller of two equal rows, from closed forms of each load added up.

    Parameters
    ----------
    bearing : Bearing
        Two equal rows of rollers about the centre, without clearance.
    load : Floats
        Load (5,): Fx, Fy, Fz [N], My, Mz [N m].

    Returns
    -------
    peaks : Floats
        Peaks (2,) a row [N]: axial F / (Z sin), radial (F / 2) / (Z cos J_r), moment M / (2 Z arm
        J_r), J_r at epsilon 0.5; exact for one of the three alone, an estimate for more.

    Raises
    ------
    InputError
        Not two equal rows of rollers, opposed to each other.
    """
    rows = bearing.rows
    if not (
        len(rows) == 2
        and all(isinstance(row, RollerRow) for row in rows)
        and abs(rows[0].angle + rows[1].angle) < 1e-12
        and rows[0].angle != 0.0
    ):
        raise InputError(
            f"{bearing.name} is no pair of equal, opposed rows of rollers: use equilibrium instead"
        )
    Fx, Fy, Fz, My, Mz = (float(value) for value in load)
    radial, moment = float(np.hypot(Fy, Fz)), float(np.hypot(My, Mz))
    peaks = np.zeros(2)
    for i, row in enumerate(rows):
        assert isinstance(row, RollerRow)
        alpha, Z = row.angle, row.rollers
        J_r = sjovall(0.5, row.law.exponent)[0]
        axial = max(Fx * np.sign(alpha), 0.0) / (Z * abs(sin(alpha)))
        psi = np.linspace(0.0, 2.0 * pi, 361)
        across = np.zeros_like(psi)
        if radial:
            across += radial / 2.0 / (Z * cos(alpha) * J_r) * np.cos(psi - np.arctan2(Fz, -Fy))
        if moment:
            # approach = arm t, t = -(theta_y sin + theta_z cos)
            wave = -(My * np.sin(psi) + Mz * np.cos(psi)) / moment
            across += moment / (2.0 * Z * row.arm * J_r) * wave
        peaks[i] = axial + across.max()
    return peaks


def effective_centre(row: Row) -> float:
    """x at which the contact normals of a row meet the axis: its pressure centre [m]."""
    return row.place - row.radius * tan(row.angle)
