"""Stress concentration and fatigue notch factors of shafts by the formulas of DIN 743-2.

For sources see `fe_drivetrain.shafts.strength.din743`. Stress concentration factors are those of
solid shafts.
"""

from __future__ import annotations

import math

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.shafts.strength.din743 import LARGEST, MM, MPA, NotchEffect

# A, B, C, z of tension, bending, torsion (DIN 743-2, table 2)
_SHOULDER = ((0.62, 3.5, 0.0, 0.0), (0.62, 5.8, 0.2, 3.0), (3.4, 19.0, 1.0, 2.0))
_GROOVE = ((0.22, 1.37, 0.0, 0.0), (0.2, 2.75, 0.0, 0.0), (0.7, 10.3, 0.0, 0.0))

LEAST_RADIUS = 0.03
"""Radius over the depth of a notch, down to which the formulas were made."""

MEASURED_AT = 0.04
"""Diameter of the specimens of hubs and keys [m]."""


def turned_factors(kind: str, diameter: float, depth: float, radius: float) -> Floats:
    """Stress concentration factors of a shoulder or a round groove (DIN 743-2, table 2).

    Parameters
    ----------
    kind : str
        "shoulder" or "groove".
    diameter : float
        Diameter at the notch, that of the nominal stress [m].
    depth : float
        t: half of what the diameters differ by [m].
    radius : float
        Radius of the notch [m].

    Returns
    -------
    ndarray, (3,)
        Factors of tension, bending, torsion.
    """
    d, t, r = diameter, depth, radius
    wide = d + 2.0 * t
    found = []
    for A, B, C, z in _SHOULDER if kind == "shoulder" else _GROOVE:
        grown = 2.0 * B * r / d * (1.0 + 2.0 * r / d) ** 2
        found.append(1.0 + 1.0 / math.sqrt(A * r / t + grown + C * (r / t) ** z * d / wide))
    return np.array(found)


def turned_gradients(kind: str, diameter: float, depth: float, radius: float) -> Floats:
    """Relative stress gradients G' at a shoulder or a round groove (DIN 743-2, table 3) [1/m].

    Parameters
    ----------
    kind, diameter, depth, radius : str, float, float, float
        See `turned_factors`.
    """
    deep = diameter / (diameter + 2.0 * depth) <= 0.67
    phi = 0.0 if deep else 1.0 / (4.0 * math.sqrt(depth / radius) + 2.0)
    normal, shear = (2.3, 1.15) if kind == "shoulder" else (2.0, 1.0)
    return np.array([normal * (1.0 + phi), normal * (1.0 + phi), shear]) / radius


def support_factors(gradients: Floats, yielding: float, hard_surface: bool = False) -> Floats:
    """Support factors n of stress gradients (DIN 743-2, Eq 7).

    Parameters
    ----------
    gradients : ndarray
        Relative stress gradients [1/m].
    yielding : float
        Yield strength of the section [Pa].
    hard_surface : bool
        Whether the surface is hardened.
    """
    power = 0.7 if hard_surface else 0.33 + yielding / MPA / 712.0
    return np.asarray(1.0 + np.sqrt(np.asarray(gradients) * MM) * 10.0**-power)


def by_support(alpha: Floats, gradients: Floats, yielding: float, hard: bool) -> Floats:
    """(3,) fatigue notch factors alpha / n, at least 1, of stress concentration factors."""
    return np.maximum(alpha / support_factors(gradients, yielding, hard), 1.0)


def hole_effect(diameter: float, radius: float, yielding: float, hard: bool) -> NotchEffect:
    """A hole across the shaft, over stresses of the section with it (DIN 743-2, 5.2.3).

    Parameters
    ----------
    diameter, radius : float
        Diameter of the shaft, and radius of the hole [m].
    yielding, hard : float, bool
        See `support_factors`.
    """
    share, d, r = 2.0 * radius / diameter, diameter, radius
    root = math.sqrt(share)
    alpha = np.array([3.0 - share, 3.0 + 1.4 * share - 2.8 * root, 2.023 - 1.125 * root])
    gradients = np.array([2.3 / r, 2.3 / r + 2.0 / d, 1.15 / r + 2.0 / d])
    return NotchEffect(alpha, by_support(alpha, gradients, yielding, hard), turned=False)


def moduli(diameter: float, bore: float = 0.0, hole: float = 0.0) -> Floats:
    """(3,) area [m^2] and section moduli of bending and torsion [m^3] of a round section.

    Parameters
    ----------
    diameter, bore : float
        Outer and inner diameter [m].
    hole : float
        Radius of a hole across the axis, which is taken off [m].
    """
    d, b, r = diameter, bore, hole
    ring = math.pi * (d**4 - b**4) / (32.0 * d)
    # a strip of width 2 r in the wall, over the outer radius; without a bore r d^2 / 3
    strip = r * (d**3 - b**3) / (3.0 * d)
    lost = np.array([2.0 * r * (d - b), strip, strip])
    whole = np.array([math.pi * (d**2 - b**2) / 4.0, ring, 2.0 * ring])
    return np.asarray(whole - lost)


def measured_effect(kind: str, diameter: float, tensile: float) -> NotchEffect:
    """A hub on a press fit, or keyways, by factors that were measured (DIN 743-2, table 1).

    Parameters
    ----------
    kind : str
        "press fit", "keyway" or "two keyways".
    diameter : float
        Diameter of the shaft [m].
    tensile : float
        Tensile strength of the section [Pa].
    """
    strength = tensile / (1000.0 * MPA)
    if kind == "press fit":
        normal = 2.7 * strength**0.43
        beta = np.array([normal, normal, 0.65 * normal])
    else:
        normal = 3.0 * strength**0.38
        beta = np.array([normal, normal, 0.56 * normal + 0.1])
        beta *= 1.15 if kind == "two keyways" else 1.0
    found = [b * _size(MEASURED_AT, b) / _size(diameter, b) for b in beta.tolist()]
    return NotchEffect(np.ones(3), np.array(found), turned=kind == "press fit", rough=False)


def _size(diameter: float, beta: float) -> float:
    """Size factor K_3 of measured notch factors (DIN 743-2, Eq 17); constant from 150 mm."""
    d = min(max(min(diameter, LARGEST) / MM, 7.5), 150.0)
    return 1.0 - 0.2 * math.log10(beta) * math.log10(d / 7.5) / math.log10(20.0)
