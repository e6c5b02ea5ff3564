"""Friction moment of roller bearings as a sum over rollers: rolling in an oil film, and sliding.

Each contact with its load in the equilibrium of the bearing on rigid rings resists rolling by the
film (Zhou and Hoeprich 1991, J. Tribology 113, 590, eq. 17) and by what steel does not give back
(Johnson, Contact Mechanics, section 9), and slides where surfaces that are curved along the roller,
or cross at the contact angle, cannot roll everywhere (Heathcote). Ribs, cage, seals, churned oil
and balls are not in it. Both formulas as a public program quotes them; the pressure coefficient of
viscosity as another one has it of Juenemann (2010).
"""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.answers import lamina_loads
from fe_drivetrain.bearing.contact import STEEL_E
from fe_drivetrain.bearing.friction import FrictionMoment
from fe_drivetrain.bearing.geometry import Bearing, RollerRow, pitch_ratio
from fe_drivetrain.bearing.rolling import equilibrium, free_motions
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

DENSITY = 870.0
"""Density of a gear oil in operation [kg/m^3]: usual of mineral oils, assumed."""

LOST = (0.005, 0.01, 0.05)
"""Share of the strain energy that hardened steel does not give back: least, taken, largest, of the
range that Schwarz et al. (2023) state, as a public program quotes it."""

LAMINAE = 30
"""Slices along a roller where its row has none."""


def roller_friction(
    bearing: Bearing,
    radial: ArrayLike,
    axial: ArrayLike,
    speed: ArrayLike,
    viscosity: float,
    sliding: ArrayLike,
) -> FrictionMoment:
    """Friction moment as the sum over all contacts of rollers.

    Parameters
    ----------
    bearing : Bearing
        Bearing with rows of rollers.
    radial, axial : array_like, (n,)
        Forces on its inner ring [N]; an axial one that its rollers do not carry is left out.
    speed : array_like, (n,)
        Speed of one ring against the other, whose sign does not matter [rad/s].
    viscosity : float
        Kinematic viscosity of the oil, or base oil, in operation [m^2/s].
    sliding : array_like, (n,)
        Friction coefficient of what slides.

    Returns
    -------
    moment : FrictionMoment
        Sliding and hysteresis as ``loaded``, the film as ``viscous``; least and largest with the
        range of what steel does not give back.

    Raises
    ------
    InputError
        It has balls, or its rollers lift off under these forces.
    """
    Fr, Fa, omega, mu = (
        np.asarray(one, dtype=float).ravel()
        for one in np.broadcast_arrays(radial, axial, np.abs(speed), sliding)
    )
    rows = [row for row in bearing.rows if isinstance(row, RollerRow)]
    if len(rows) < len(bearing.rows):
        raise InputError(
            f"friction of the rollers of bearing {bearing.name!r}: it has balls; use another model"
        )
    rows = [replace(row, laminae=row.laminae or LAMINAE) for row in rows]
    sliced = Bearing(bearing.name, tuple(rows))
    found = equilibrium(sliced, _carried(sliced, Fr, Fa))
    if not found.converged.all():
        raise InputError(
            f"friction of the rollers of bearing {bearing.name!r}: no equilibrium under "
            f"{1e-3 * Fr.max():.3g} kN radially and {1e-3 * Fa.max():.3g} kN axially"
        )
    film, lost, slid = np.zeros((3, len(Fr)))
    for row in rows:
        loads = lamina_loads(row, found.displacements)
        rolled = _rolling(row, loads.sum(axis=2), omega, viscosity)
        film, lost = film + rolled[0], lost + rolled[1]
        slid = slid + mu * _slid(row, loads)
    low, taken, high = (share * lost for share in LOST)
    base = film + slid
    return FrictionMoment(slid + taken, film, base + low, base + high)


def pressure_coefficient(viscosity: float) -> float:
    """Pressure coefficient of the viscosity of a mineral oil [1/Pa].

    Parameters
    ----------
    viscosity : float
        Kinematic viscosity in operation [m^2/s].
    """
    return float(1.29e-7 * viscosity**0.204)


def _carried(bearing: Bearing, Fr: Floats, Fa: Floats) -> Floats:
    """Loads (n, 5) less what acts on motions that no roller resists."""
    loads = np.zeros((len(Fr), 5))
    loads[:, 0], loads[:, 2] = Fa, -Fr
    motions, _ = free_motions(bearing)
    kept = motions @ np.linalg.pinv(motions)
    return np.asarray(loads @ kept)


def _rolling(row: RollerRow, Q: Floats, omega: Floats, viscosity: float) -> tuple[Floats, Floats]:
    """Moments (n,) of the bearing by the film, and by steel if it gave nothing back [N m].

    A moment M about a roller's axis at a contact takes M times the speed at which roller and race
    roll on each other; all speeds are multiples of the rings' relative speed.
    """
    gamma, D = pitch_ratio(row), row.diameter
    spin = row.radius / D * (1.0 - gamma**2)
    races = (row.radius / cos(row.angle) * np.array([1.0 - gamma, 1.0 + gamma])).tolist()
    curved = 1.0 / (2.0 / D + np.array([1.0 / races[0], -1.0 / races[1]]))
    rolled = np.array([spin + 0.5 * (1.0 + gamma), spin - 0.5 * (1.0 - gamma)])
    stiff, alpha = STEEL_E / (1.0 - 0.3**2), pressure_coefficient(viscosity)
    film, lost = np.zeros((2, len(Q)))
    for R, share in zip(curved, rolled, strict=True):
        U = DENSITY * viscosity * 0.5 * D * spin * omega / (stiff * R)
        W = Q / row.length / (stiff * R)
        moment = 58.4 * R**2 / alpha * row.length * (alpha * stiff * U[:, None]) ** 0.648
        film += share * (moment * W**0.246).sum(axis=1)
        half = np.sqrt(8.0 * Q / row.length * R / (pi * stiff))
        lost += share * (Q * 2.0 * half / (3.0 * pi)).sum(axis=1)
    return film, lost


def _slid(row: RollerRow, loads: Floats) -> Floats:
    """Moment (n,) of sliding along the rollers over its friction coefficient [N m].

    Along a spherical roller surfaces curve about the sphere of the outer race, and cross at the
    contact angle; grooves of a toroidal bearing are flatter, and what slides there is left out.
    Each contact rolls so that its slices push as much forwards as backwards.
    """
    if not row.aligning or row.angle == 0.0:
        return np.zeros(len(loads))
    gamma = pitch_ratio(row)
    spin = row.radius / row.diameter * (1.0 - gamma**2)
    x = row.places
    sunk = x**2 / (2.0 * (row.radius / cos(row.angle) + 0.5 * row.diameter))
    whole = np.zeros(len(loads))
    for against, way in ((0.5 * (1.0 + gamma), 1.0), (0.5 * (1.0 - gamma), -1.0)):
        slip = against * x * sin(row.angle) + sunk * (spin + way * against * cos(row.angle))
        order = np.argsort(slip)
        q, s = loads[..., order], slip[order]
        below = np.cumsum(q, axis=2)
        middle = (below < 0.5 * below[..., -1:]).sum(axis=2).clip(max=len(s) - 1)
        whole += (q * np.abs(s - s[middle][..., None])).sum(axis=(1, 2))
    return whole
