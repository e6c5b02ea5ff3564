"""Torques of pitch and yaw drives: load, bearing friction, inertia on both sides of the gear.

One sign convention throughout: the drive turns a part against a load that resists,

    M_ring = M_load + sign(w) M_friction + J_part a = i M_drive - i^2 J_drive a,

as PROTEST 2010 has it for yaw (Eq 6.1) and for a pitch motor (Fig. 5-6). For pitch Eq 5.1 prints
``M_load - sign(w) M_friction + J_part a = i M_drive + i^2 J_drive a``, in which friction gives
power and the inertia of the whole is ``J_part - i^2 J_drive``: negative of usual drives. With the
sign of ``J_part a`` reversed it is the same drive, pushed by the blade, with loads and torques
reversed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

#: Of the moment and of the radial force, by what rolls (Rothe Erde, friction of slewing bearings).
_SHARES = {"ball": (4.4, 2.2), "roller": (4.1, 2.05)}
_RADIAL = 1.73

Rolling = Literal["ball", "roller"]


@dataclass(frozen=True)
class SlewingDrive:
    """A drive that turns a blade or a nacelle by a gear.

    Attributes
    ----------
    part, drive : float
        Inertia of what is turned about its axis, and of the motor about its own [kg m^2]; with
        several drives, of all of them.
    ratio : float
        Turns of the motor for one of the part.

    Raises
    ------
    InputError
        One of them is not above zero.
    """

    part: float
    drive: float
    ratio: float

    def __post_init__(self) -> None:
        if min(self.part, self.drive, self.ratio) <= 0.0:
            raise InputError(
                f"a drive with inertias {self.part:g} and {self.drive:g} kg m^2 and ratio "
                f"{self.ratio:g}: all must be above 0"
            )

    @property
    def inertia(self) -> float:
        """Inertia of part and drive together, seen from the part [kg m^2]."""
        return self.part + self.ratio**2 * self.drive

    @property
    def printed_inertia(self) -> float:
        """The same by Eq 5.1 as printed, of the blade and drive as seen by the drive [kg m^2]."""
        return self.part - self.ratio**2 * self.drive


def friction_torque(
    moment: Floats | float,
    axial: Floats | float,
    radial: Floats | float,
    diameter: float,
    coefficient: float = 0.006,
    rolling: Rolling = "ball",
    constant: float = 0.0,
    viscous: Floats | float = 0.0,
) -> Floats:
    """Friction of a slewing bearing under load (Rothe Erde; PROTEST 2010, Fig. 5-6).

    ``mu / 2 (4.4 M + F_a D + 2.2 F_r D 1.73)`` of balls, 4.1 and 2.05 of rollers, to about a
    quarter. PROTEST prints ``2.2 F_r + D 1.73``, whose units do not agree.

    Parameters
    ----------
    moment, axial, radial : ndarray or float
        Tilting moment [N m] and forces [N]; their signs do not matter.
    diameter : float
        Diameter of the raceway [m].
    coefficient : float
        Coefficient of friction, mu.
    rolling : str
        "ball" or "roller".
    constant : float
        Friction without a load, of seals and preload [N m]; the measurements of PROTEST ask for it.
    viscous : ndarray or float
        What the size of the speed adds [N m]; the same.

    Returns
    -------
    ndarray
        [N m], of the size that resists a motion.

    Raises
    ------
    InputError
        Diameter or coefficient are below zero.
    """
    if diameter <= 0.0 or coefficient < 0.0:
        raise InputError(
            f"a bearing of diameter {diameter:g} m with friction of {coefficient:g}: the diameter "
            "must be above 0, friction at least 0"
        )
    of_moment, of_radial = _SHARES[rolling]
    return np.asarray(
        constant
        + viscous
        + 0.5
        * coefficient
        * (
            of_moment * np.abs(moment)
            + np.abs(axial) * diameter
            + of_radial * np.abs(radial) * diameter * _RADIAL
        )
    )


def ring_torque(
    drive: SlewingDrive, load: Floats, friction: Floats, speed: Floats, acceleration: Floats
) -> Floats:
    """Torque that the pinion gives to the ring while it turns (PROTEST 2010, Eq 6.1) [N m].

    Parameters
    ----------
    drive : SlewingDrive
        Inertias and ratio.
    load : ndarray, (n,)
        Torque about the axis that resists a positive speed [N m].
    friction : ndarray, (n,)
        Friction of the bearing, of a size from zero [N m]; it counts while there is a speed.
    speed, acceleration : ndarray, (n,)
        Speed and acceleration of the part [rad/s], [rad/s^2].
    """
    return np.asarray(load + np.sign(speed) * friction + drive.part * acceleration)


def drive_torque(
    drive: SlewingDrive, load: Floats, friction: Floats, speed: Floats, acceleration: Floats
) -> Floats:
    """Torque of the motor (PROTEST 2010, Eq 6.1), its own inertia included [N m].

    Parameters
    ----------
    drive : SlewingDrive
        Inertias and ratio.
    load, friction, speed, acceleration : ndarray, (n,)
        The same as for `ring_torque`.
    """
    ring = ring_torque(drive, load, friction, speed, acceleration)
    return np.asarray((ring + drive.ratio**2 * drive.drive * acceleration) / drive.ratio)


def printed_drive_torque(
    drive: SlewingDrive, load: Floats, friction: Floats, speed: Floats, acceleration: Floats
) -> Floats:
    """Torque of the motor by Eq 5.1 of PROTEST 2010 with its printed signs [N m].

    Parameters
    ----------
    drive : SlewingDrive
        Inertias and ratio.
    load, friction, speed, acceleration : ndarray, (n,)
        The same as for `ring_torque`.
    """
    ring = load - np.sign(speed) * friction + drive.part * acceleration
    return np.asarray((ring - drive.ratio**2 * drive.drive * acceleration) / drive.ratio)


def holding_torque(load: Floats, friction: Floats) -> Floats:
    """Torque that a brake must hold at the ring while the part stands [N m].

    Friction holds as much of the load as it can.

    Parameters
    ----------
    load, friction : ndarray, (n,)
        The same as for `ring_torque`.
    """
    return np.asarray(np.sign(load) * np.maximum(np.abs(load) - friction, 0.0))


def gyroscopic_torque(inertia: float, spin: Floats, turning: Floats) -> Floats:
    """Torque of a spinning rotor on the frame that turns it, H x turning.

    Of a yawing nacelle it stands across both axes: it bends the tower top, and has no component
    about the yaw axis, however the shaft is tilted. PROTEST 2010 asks for one "around tower axis".

    Parameters
    ----------
    inertia : float
        About the axis of spin [kg m^2].
    spin, turning : ndarray, (3,)
        Angular velocity of the rotor against the frame, and of the frame [rad/s].

    Returns
    -------
    ndarray, (3,)
        [N m].
    """
    return np.asarray(np.cross(inertia * np.asarray(spin), turning), dtype=np.float64)


def shear_between(top: Floats | float, bottom: Floats | float, distance: float) -> Floats:
    """Shear force from bending moments at two heights of a tower [N].

    It is the force half-way between them under any even load: with q along the tower it is that at
    the upper height plus ``q L / 2``.

    Parameters
    ----------
    top, bottom : ndarray or float
        Bending moments [N m].
    distance : float
        Between the two heights [m].

    Raises
    ------
    InputError
        The distance is not above zero.
    """
    if distance <= 0.0:
        raise InputError(f"bending bridges {distance:g} m apart: give a distance above 0")
    return np.asarray((np.asarray(bottom) - np.asarray(top)) / distance)
