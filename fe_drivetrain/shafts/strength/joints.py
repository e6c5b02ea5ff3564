"""Joints of a shaft that hold by friction: a bolted flange, and a hub on a press fit.

A flange is a ring of bolts whose forces are linear across it, as statics and plane faces give; a
press fit is two cylinders of Lame's (1852) under the pressure that closes their misfit, as in DIN
7190. What bending does to a press fit, and bolts that bend, are left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class JointSafety:
    """Safety of a joint over load steps.

    Attributes
    ----------
    slip : ndarray, (n,)
        What friction holds over what acts on it; infinite where nothing does.
    opening : ndarray, (n,)
        Preload over the pull on the most loaded bolt; infinite where none is pulled, and of press
        fits.
    """

    slip: Floats
    opening: Floats

    __repr__ = short_repr


def flange_safety(
    forces: Floats, count: int, circle: float, preload: float, friction: float
) -> JointSafety:
    """Safety of a bolted flange against slip and separation.

    Friction acts at the bolt circle, of the clamping force that the axial force leaves: a bending
    moment takes from one side what it adds to the other. The pull on the most loaded bolt of a ring
    is ``N / n + 4 M / (n D)``, all of which relieves the faces: bolts that are softer than these
    take a small part of it, which is left out on the safe side.

    Parameters
    ----------
    forces : ndarray, (n, 6)
        Forces of the hub on the shaft [N, N m].
    count : int
        Number of bolts.
    circle : float
        Diameter of the bolt circle [m].
    preload : float
        Preload of each bolt [N].
    friction : float
        Friction of the faces.
    """
    pull = -forces[:, 0]
    clamped = np.maximum(count * preload - pull, 0.0)
    across = np.hypot(forces[:, 1], forces[:, 2])
    moment = np.hypot(forces[:, 4], forces[:, 5])
    acting = 2.0 * np.abs(forces[:, 3]) / circle + across  # the worst bolt has both in line
    bolt = pull / count + 4.0 * moment / (count * circle)
    with np.errstate(divide="ignore", invalid="ignore"):
        slip = np.where(acting > 0.0, friction * clamped / acting, np.inf)
        opening = np.where(bolt > 0.0, preload / bolt, np.inf)
    return JointSafety(np.asarray(slip), np.asarray(opening))


def press_pressure(
    diameter: float,
    bore: float,
    hub: float,
    interference: float,
    elastic: tuple[float, float],
) -> float:
    """Pressure of a press fit of one material [Pa]; Lame's cylinders, free along the axis.

    Parameters
    ----------
    diameter : float
        Diameter of the seat [m].
    bore : float
        Bore of the shaft; 0 where it is solid [m].
    hub : float
        Outer diameter of the hub [m].
    interference : float
        By how much the shaft's diameter exceeds the hub's bore, free [m].
    elastic : tuple of float
        Modulus [Pa] and Poisson's ratio.

    Raises
    ------
    InputError
        The hub is not wider than the seat, or the bore not narrower.
    """
    if not bore < diameter < hub:
        raise InputError(
            f"press fit: bore {bore:g} m, seat {diameter:g} m and hub {hub:g} m must each be less "
            "than the next: correct them"
        )
    E, nu = elastic
    inside, outside = (bore / diameter) ** 2, (diameter / hub) ** 2
    yields = (1.0 + outside) / (1.0 - outside) + nu + (1.0 + inside) / (1.0 - inside) - nu
    return interference * E / (diameter * yields)


def press_safety(
    forces: Floats, diameter: float, length: float, pressure: float, friction: float
) -> JointSafety:
    """Safety of a press fit against slip under torque and axial force together.

    Parameters
    ----------
    forces : ndarray, (n, 6)
        That the fit transmits [N, N m].
    diameter, length : float
        Size of the seat [m].
    pressure : float
        Pressure of the fit [Pa].
    friction : float
        Friction of its faces.
    """
    holds = friction * pressure * np.pi * diameter * length
    acting = np.hypot(2.0 * forces[:, 3] / diameter, forces[:, 0])
    with np.errstate(divide="ignore"):
        slip = np.where(acting > 0.0, holds / np.where(acting > 0.0, acting, 1.0), np.inf)
    return JointSafety(np.asarray(slip), np.full(len(forces), np.inf))
