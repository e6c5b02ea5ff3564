"""The uniform solid shaft that a tabled stiffness and damping imply: Al-Hamadani 2018."""

from __future__ import annotations

from typing import NamedTuple

from fe_drivetrain.validation.shaft_theory import solid_diameter

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
