"""What the joint of a bearing unit does between rigid faces, as a 6x6 spring."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.drivetrain_file.bearing_unit import SPHERICAL_JOINTS, BearingUnit, Rollers


def as_numbers(springs: Iterable[float | Literal["rigid"]]) -> Floats:
    """Springs as numbers, inf where they are "rigid"."""
    return np.array([np.inf if k == "rigid" else k for k in springs], dtype=float)


def joint_stiffness(unit: BearingUnit) -> Floats:
    """(6, 6) what the joint does between two rigid faces, about the bearing's centre.

    Where it holds rigidly there is inf on the diagonal, and nothing else in that row.
    """
    if unit.interface == "bonded":
        return np.diag(np.full(6, np.inf))
    if unit.interface in SPHERICAL_JOINTS:
        return np.diag(np.r_[[np.inf] * 3, [0.0] * 3])
    if unit.rollers is not None:
        lines = roller_lines(unit)
        return np.asarray(unit.rollers.stiffness * lines.T @ lines)
    return spring_matrix(unit)


def spring_matrix(unit: BearingUnit) -> Floats:
    """(6, 6) of a unit's ``stiffness``, with inf on the diagonal where that is "rigid"."""
    given = unit.stiffness or ()
    if any(isinstance(k, tuple) for k in given):
        return np.array(given, dtype=float)
    return np.diag(as_numbers(k for k in given if not isinstance(k, tuple)))


def free_to_turn(stiffness: Floats) -> Floats:
    """(6, 6) stiffness of a bearing on its housing whose shaft turns in it without a torque.

    The outer ring then turns about x as far as the forces ask it to: a housing on feet rolls under
    a force across, and leaving that out would hold the shaft too stiffly.

    Parameters
    ----------
    stiffness : Floats
        (6, 6) to ground with the turn about x resisted [N/m, N, N m/rad].
    """
    K = np.array(stiffness, dtype=float)
    if K[3, 3] > 0.0:
        K -= np.outer(K[:, 3], K[3]) / K[3, 3]
    K[3] = K[:, 3] = 0.0
    return K


def roller_lines(unit: BearingUnit) -> Floats:
    """(n, 6) lines of contact of all rollers: direction, and its moment about the centre."""
    places, ways = roller_contacts(unit)
    centre = np.array([unit.bearing.x, 0.0, 0.0])
    arms = np.cross(places - centre, ways)
    # lines through the centre miss it by round-off, which is no moment that the joint carries
    arms[np.abs(arms) < 1e-12 * unit.bearing.raceway_diameter] = 0.0
    return np.hstack([ways, arms])


def rollers_of(unit: BearingUnit) -> Rollers:
    """The rollers of a unit whose interface is "rollers"."""
    assert unit.rollers is not None  # as its interface needs
    return unit.rollers


def roller_contacts(unit: BearingUnit) -> tuple[Floats, Floats]:
    """(n, 3) places of all rollers, row by row from +y on towards z, and their lines of contact."""
    bearing, rollers = unit.bearing, rollers_of(unit)
    angle = 2.0 * np.pi * np.arange(rollers.count) / rollers.count
    places, ways = [], []
    for row in rollers.rows:
        radius, lean = bearing.raceway_diameter / 2, np.radians(row.contact_angle)
        if bearing.kind == "spherical":
            lean = np.arcsin(row.x / radius)
            radius *= np.cos(lean)
        round_ = np.column_stack([np.zeros_like(angle), np.cos(angle), np.sin(angle)])
        places.append(radius * round_ + [bearing.x + row.x, 0.0, 0.0])
        ways.append(np.cos(lean) * round_ + [np.sin(lean), 0.0, 0.0])
    return np.vstack(places), np.vstack(ways)
