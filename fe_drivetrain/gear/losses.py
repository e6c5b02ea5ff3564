"""Power that teeth lose by sliding, as ISO/TR 14179-2 has it, and shaft seals.

P_loss = mu_m H_V P: a mean friction coefficient (Schlenk) times the loss factor of the teeth
(Ohlendorf). The report itself was not read: both formulas are as a public program quotes them, and
the loss factor is integrated along the path of contact. Oil that is churned
is left out: no public formula was found that could be verified.
"""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.gear.involute import Pair

BOUNDARY = 0.12
"""Friction coefficient of steel without an oil film, which the mean one of teeth does not exceed:
that of rolling bearings in boundary lubrication, assumed of teeth. Schlenk's grows without end as
teeth come to stand."""

LEAST_LOAD = 150e3
"""Load per face width [N/m] below which the friction coefficient no longer falls; from memory of
ISO/TR 14179-2, not verified."""

FASTEST = 50.0
"""Speed at the pitch circle [m/s] up to which the friction coefficient falls; from memory of the
same, not verified."""

OVER_RA = 6.0
"""Mean peak-to-valley height Rz over the arithmetic mean roughness Ra: usual of ground flanks."""


def tooth_loss_factor(pair: Pair, even: bool = False) -> float:
    """Tooth loss factor H_V: power lost over that transmitted and the friction coefficient.

    Parameters
    ----------
    pair : Pair
        Gears in mesh.
    even : bool
        Whether the load is even along the path of contact, as about that of helical teeth; False
        is an equal share of each pair in contact, as of spur teeth.

    Returns
    -------
    factor : float
        The load's share times the sliding, integrated along the path of contact, which for spur
        teeth of contact ratios from 1 to 2 is Ohlendorf's pi (1 / z1 + 1 / z2) / cos(beta_b)
        (1 - eps_alpha + eps_1^2 + eps_2^2); where the path does not reach the pitch point, as that
        of some internal pairs, this closed form fails.
    """
    first, path = pair.first, pair.path
    pitch = first.base_pitch
    turns = range(int((path.end - path.start) / pitch) + 1)
    steps = [path.start + k * pitch for k in turns] + [path.end - k * pitch for k in turns]
    places = np.unique(steps)
    middles = 0.5 * (places[:-1] + places[1:])
    before = np.floor((middles - path.start) / pitch)
    pairs = 1.0 + before + np.floor((path.end - middles) / pitch)
    shares = np.full_like(middles, 1.0 / pair.transverse_ratio) if even else 1.0 / pairs
    away = places - path.pitch
    slid = np.diff(0.5 * away * np.abs(away))
    turning = abs(1.0 + first.teeth / pair.second.teeth)
    loss = turning / (pitch * first.base_radius * cos(first.base_helix)) * (shares @ slid)
    return float(loss)


def mean_friction(
    pair: Pair,
    torque: ArrayLike,
    speed: ArrayLike,
    viscosity: float,
    roughness: float,
    lubricant_factor: float = 1.0,
) -> Floats:
    """Mean friction coefficient of a mesh (Schlenk).

    Parameters
    ----------
    pair : Pair
        Gears in mesh.
    torque, speed : array_like
        Torque on the first gear in this mesh [N m], and its speed, of planets in the frame of the
        carrier [rad/s]; their signs do not matter.
    viscosity : float
        Dynamic viscosity of the oil in operation [Pa s].
    roughness : float
        Arithmetic mean roughness Ra of both flanks [m].
    lubricant_factor : float
        X_L: 1 of mineral oils.

    Returns
    -------
    coefficient : Floats
        0.048 (F_bt / b / (v_sum rho))^0.2 eta^-0.05 Ra^0.25 X_L with N/mm, m/s, mm, mPa s and um,
        at the pitch point; `BOUNDARY` at most, where teeth are too slow for a film.
    """
    force = np.abs(np.asarray(torque, dtype=float)) / pair.first.base_radius
    load = np.maximum(force / pair.face_width, LEAST_LOAD) / 1e3
    summed, curvature = _at_pitch_point(pair, speed)
    with np.errstate(divide="ignore"):
        by_load = (load / (summed * 1e3 * curvature)) ** 0.2
    by_oil = (1e3 * viscosity) ** -0.05 * (1e6 * roughness) ** 0.25 * lubricant_factor
    return np.asarray(np.minimum(0.048 * by_load * by_oil, BOUNDARY))


def film_friction(
    pair: Pair,
    torque: ArrayLike,
    speed: ArrayLike,
    viscosity: float,
    roughness: float,
    pressure_coefficient: float,
    lubricant_factor: float = 1.0,
) -> Floats:
    """Mean friction coefficient of a mesh by a film parameter (Fernandes et al. 2015).

    Parameters
    ----------
    pair : Pair
        Gears in mesh.
    torque, speed : array_like
        As those of `mean_friction`.
    viscosity : float
        Dynamic viscosity of the oil in operation [Pa s].
    roughness : float
        Arithmetic mean roughness Ra of both flanks [m].
    pressure_coefficient : float
        Pressure coefficient of the viscosity [1/Pa].
    lubricant_factor : float
        X_L: 1 of mineral oils.

    Returns
    -------
    coefficient : Floats
        0.014 S_p^-0.25 S_g^0.25 X_L with S_p = v_sum eta alpha^0.5 / F_bn^0.5 and S_g = Ra over the
        root of face width and curvature, as the public program of its author (GEARpie) has it;
        `BOUNDARY` at most.
    """
    helix = cos(pair.first.base_helix)
    force = np.abs(np.asarray(torque, dtype=float)) / pair.first.base_radius / helix
    summed, curvature = _at_pitch_point(pair, speed)
    force = np.maximum(force, LEAST_LOAD * pair.face_width)
    film = summed * viscosity * np.sqrt(pressure_coefficient / force)
    rough = roughness / np.sqrt(pair.face_width * curvature)
    with np.errstate(divide="ignore"):
        found = 0.014 * lubricant_factor * (rough / film) ** 0.25
    return np.asarray(np.minimum(found, BOUNDARY))


def _at_pitch_point(pair: Pair, speed: ArrayLike) -> tuple[Floats, float]:
    """Sum of both flanks' speeds [m/s], and radius of their relative curvature [m]."""
    turning = np.abs(np.asarray(speed, dtype=float)) * pair.working_radii[0]
    one, two = (float(r) for r in pair.curvatures(pair.path.pitch))
    curvature = abs(one * two / (one + two)) / cos(pair.first.base_helix)
    return 2.0 * np.minimum(turning, FASTEST) * sin(pair.working_angle), curvature


def shaft_seal_moment(diameter: float) -> float:
    """Moment of one seal that rubs on a shaft (ISO/TR 14179-2, as a public program quotes it).

    Parameters
    ----------
    diameter : float
        Diameter of the shaft [m].

    Returns
    -------
    moment : float
        [N m]: the power of 7.69e-6 d^2 n W, with d in mm and n in 1/min, over the speed.
    """
    return 7.69e-6 * (1e3 * diameter) ** 2 * 30.0 / pi
