"""The uniform solid shaft that a tabled stiffness and damping imply: Al-Hamadani 2018."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases.references import published_drivetrains
from fe_drivetrain.cases.references.shaft_theory import solid_diameter

SHEAR_MODULUS = 80e9
"""Of steel [Pa]; the thesis gives none."""

DAMPING_RATIO = 0.006
"""Section 4.1 of Al-Hamadani 2018."""


class Uniform(NamedTuple):
    """A solid shaft of one diameter.

    Attributes
    ----------
    polar : float
        J [m^4].
    diameter, length : float
        [m].
    """

    polar: float
    diameter: float
    length: float


def diameter(stiffness: float, length: float) -> float:
    """Diameter [m] of the solid shaft of that stiffness [N m/rad] and length [m], k = G J / L."""
    return solid_diameter(stiffness * length / SHEAR_MODULUS)


class OfStiffness(NamedTuple):
    """Solid shafts that all have the stiffness of a tabled one.

    Attributes
    ----------
    stiffness : float
        k [N m/rad].
    diameters : dict
        By length [m]: diameter [m].
    rated_stress : float
        Shear stress of the one of 1 m at rated torque [Pa].
    """

    stiffness: float
    diameters: dict[float, float]
    rated_stress: float


def of_stiffness(letter: str, lengths: Sequence[float]) -> dict[str, OfStiffness]:
    """Solid shafts as stiff as those of one of the thesis's drivetrains, by their names.

    Parameters
    ----------
    letter : str
        "A" to "D".
    lengths : sequence of float
        Lengths of the shafts, 1 m among them [m].
    """
    name, power, rpm = published_drivetrains.RATED[letter]
    table, torque = published_drivetrains.table(name), power / (rpm * 2 * np.pi / 60)
    shafts = {}
    for shaft, ratio in zip(table.shafts, table.speeds, strict=True):
        at = {L: diameter(shaft.stiffness, L) for L in lengths}
        stress = float(16 * torque / ratio / (np.pi * at[1.0] ** 3))
        shafts[shaft.name] = OfStiffness(shaft.stiffness, at, stress)
    return shafts


def implied(stiffness: float, damping: float) -> Uniform:
    """The shaft that a stiffness and a damper imply by Eq 4.5 and 4.4.

    Parameters
    ----------
    stiffness : float
        k [N m/rad].
    damping : float
        C [N m s/rad], which Eq 4.5 makes of J.

    Returns
    -------
    shaft : Uniform
        J = (C / 2 zeta)^2 / k, the solid circle of that J, and the length J G / k.
    """
    polar = (damping / (2 * DAMPING_RATIO)) ** 2 / stiffness
    return Uniform(polar, solid_diameter(polar), float(polar * SHEAR_MODULUS / stiffness))
