"""Tooth of an external spur gear in its transverse plane: involute, and the fillet its rack cuts.

The origin is the gear's centre, the y axis the tooth's centre line, points are on the right flank
(x > 0); the left one is its mirror image.
"""

from __future__ import annotations

from math import cos, pi, tan

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.functions import involute_of
from fe_drivetrain.gear.involute import Gear


def flank_points(gear: Gear, curvature: Floats) -> Floats:
    """Points of the involute by their radius of curvature.

    Parameters
    ----------
    gear : Gear
        External.
    curvature : (n,) array
        Radii of curvature [m], that of the form circle to that of the tip circle.

    Returns
    -------
    (n, 2) array
        Points [m].
    """
    rho = np.asarray(curvature, dtype=np.float64)
    radius = np.hypot(gear.base_radius, rho)
    angle = _half_angle(gear) - involute_of(np.arctan2(rho, gear.base_radius))
    return np.column_stack([radius * np.sin(angle), radius * np.cos(angle)])


def flank_normals(gear: Gear, curvature: Floats) -> Floats:
    """Directions in which a mate pushes on the involute: along the line of action, into the tooth.

    Parameters
    ----------
    gear : Gear
        External.
    curvature : (n,) array
        Radii of curvature [m].

    Returns
    -------
    (n, 2) array
        Unit vectors; their moment arm about the centre is the base radius.
    """
    rho = np.asarray(curvature, dtype=np.float64)
    points = flank_points(gear, rho)
    radius = np.hypot(gear.base_radius, rho)
    outward = points / radius[:, None]
    across = np.column_stack([-outward[:, 1], outward[:, 0]])
    both = across * gear.base_radius - outward * rho[:, None]
    return np.asarray(both / radius[:, None], dtype=np.float64)


def fillet_points(gear: Gear, count: int = 30) -> Floats:
    """Trochoid that the rounded tip of the rack cuts, from the root circle to the involute.

    Parameters
    ----------
    gear : Gear
        External spur gear.
    count : int
        Number of points, 2 or more.

    Returns
    -------
    (count, 2) array
        Points [m]: the first on the root circle, the last where the involute begins.

    Raises
    ------
    InputError
        If the gear is internal or helical, or the rack's tip wider than its tooth.
    """
    if gear.internal or gear.helix:
        raise InputError(
            f"a fillet of a gear of {gear.teeth} teeth, {np.degrees(gear.helix):g} degrees of "
            "helix: only external spur gears have one here; give the virtual spur gear of a "
            "helical one"
        )
    m, alpha, rack = gear.normal_module, gear.pressure_angle, gear.rack
    radius = rack.fillet * m
    depth = (gear.shift - rack.dedendum + rack.fillet) * m  # of the rounding's centre
    aside = 0.25 * pi * m + (rack.dedendum - rack.fillet) * m * tan(alpha) + radius / cos(alpha)
    if aside > 0.5 * pi * m * (1.0 + 1e-12):
        raise InputError(
            f"a rack with a fillet of {rack.fillet:g} modules at a dedendum of {rack.dedendum:g} "
            "has a tip wider than its tooth: give a smaller fillet"
        )
    # directions from the centre of the rounding, from its deepest point to the straight flank
    turn = np.linspace(-0.5 * pi, -pi + alpha, count)
    out = np.column_stack([np.cos(turn), np.sin(turn)])
    # the normal of the point of contact goes through the pitch point: the rack has moved by this
    moved = aside - depth * out[:, 0] / out[:, 1]
    contact = np.column_stack([aside - moved, np.full(count, depth)]) + radius * out
    angle = moved / gear.reference_radius  # the gear has turned with the rack
    c, s = np.cos(angle), np.sin(angle)
    x, y = contact[:, 0], contact[:, 1] + gear.reference_radius
    return np.column_stack([c * x + s * y, c * y - s * x])


def tooth_outline(gear: Gear, count: int = 30) -> Floats:
    """Right flank of a tooth from its root circle to its tip circle.

    Parameters
    ----------
    gear : Gear
        External spur gear.
    count : int
        Points on the fillet and again on the involute.

    Returns
    -------
    (2 count - 1, 2) array
        Points [m].
    """
    involute = flank_points(gear, np.linspace(gear.form_curvature, gear.tip_curvature, count))
    return np.concatenate([fillet_points(gear, count)[:-1], involute])


def _half_angle(gear: Gear) -> float:
    """Half of the angle that a tooth occupies on its base circle [rad]."""
    shifts = 2.0 * gear.shift * tan(gear.pressure_angle)
    return (0.5 * pi + shifts) / gear.teeth + float(involute_of(gear.transverse_angle))
