"""Stress concentration at the shoulder fillet of a round shaft: the published fits, and elasticity.

Everything is in units of the thinner diameter, d = 1 m, and of a nominal stress of 1 Pa.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.geometry import Shaft
from fe_drivetrain.shafts import strength
from fe_drivetrain.shafts.strength import PER_FILLET, Peak, Shoulder

STEEL = MATERIALS["steel"]

PETERSON = (
    "Pilkey and Pilkey 2008, Peterson's Stress Concentration Factors, 3rd ed., charts 3.4, "
    "3.10 and 3.12"
)
TIPTON = (
    "Tipton, Sorem and Rolovic 1996, J. Mech. Des. 118, 321-327, as in Pilkey and Pilkey 2008, "
    "chapter 3"
)

OF_A_FIT = 0.05
"""Relative; two published fits of Peterson's charts differ by as much."""

Formula = Callable[[str, float, float], float]
"""Of load, D/d and r/d."""

#: Coefficients of C1 to C4 by 1, sqrt(t/r), t/r, with the range of t/r that they are for.
FITS: dict[str, tuple[tuple[float, float, tuple[tuple[float, float, float], ...]], ...]] = {
    "tension": (
        (
            *(0.1, 2.0),
            (
                (0.926, 1.157, -0.099),
                (0.012, -3.036, 0.961),
                (-0.302, 3.977, -1.744),
                (0.365, -2.098, 0.878),
            ),
        ),
        (
            *(2.0, 20.0),
            (
                (1.200, 0.860, -0.022),
                (-1.805, -0.346, -0.038),
                (2.198, -0.486, 0.165),
                (-0.593, -0.028, -0.106),
            ),
        ),
    ),
    "bending": (
        (
            *(0.1, 2.0),
            (
                (0.947, 1.206, -0.131),
                (0.022, -3.405, 0.915),
                (0.869, 1.777, -0.555),
                (-0.810, 0.422, -0.260),
            ),
        ),
        (
            *(2.0, 20.0),
            (
                (1.232, 0.832, -0.008),
                (-3.813, 0.968, -0.260),
                (7.423, -4.868, 0.869),
                (-3.839, 3.070, -0.600),
            ),
        ),
    ),
    "torsion": (
        (
            *(0.25, 4.0),
            (
                (0.905, 0.783, -0.075),
                (-0.437, -1.969, 0.553),
                (1.557, 1.073, -0.578),
                (-1.061, 0.171, 0.086),
            ),
        ),
    ),
}


def peterson(load: str, wide: float, radius: float) -> float:
    """K_t of the charts' fits; NaN outside their range.

    Parameters
    ----------
    load : str
        One of `LOADS`.
    wide, radius : float
        D/d and r/d.
    """
    t = (wide - 1.0) / 2.0
    for low, high, rows in FITS[load]:
        if low <= t / radius <= high:
            terms = np.array([1.0, math.sqrt(t / radius), t / radius])
            powers = (2.0 * t / wide) ** np.arange(4)
            return float(np.array(rows) @ terms @ powers)
    return math.nan


def tipton(load: str, wide: float, radius: float) -> float:
    """K_t of formulae fitted to finite elements, of largest principal stress; tension, bending."""
    s = wide * wide
    if load == "tension":
        root = (3.43 - 3.41 * s - 0.0232 * s * s) / (1.0 - 8.85 * s - 0.078 * s * s)
        return float(0.493 + 0.48 * wide**-2.43 + radius**-0.48 * math.sqrt(root))
    if load == "bending":
        root = (-0.14 - 0.363 * s + 0.503 * s * s) / (1.0 - 2.39 * s + 3.368 * s * s)
        return float(0.632 + 0.377 * wide**-4.4 + radius**-0.5 * math.sqrt(root))
    return math.nan


def published_scatter(load: str, wide: float, radius: float) -> float:
    """Relative difference of the two published formulae, and what the better one allows itself."""
    return abs(peterson(load, wide, radius) / tipton(load, wide, radius) - 1.0) + OF_A_FIT


def of_a_fit(load: str, wide: float, radius: float) -> float:
    """What a formula through computed points may itself be wrong by, relative."""
    return OF_A_FIT


def shouldered(wide: float, radius: float) -> Shaft:
    """A solid shaft, D for x < 0 and d = 1 m behind, with a fillet."""
    return strength.shouldered(Shoulder(1.0, wide, radius))


def end_stress(load: str, places: Floats, diameter: float) -> Floats:
    """(k, 3) stress xx, xr, xt on a section of a diameter, for a nominal stress of 1 Pa in d.

    Saint-Venant's, exact far from the shoulder: uniform, linear in the height, or in the radius.
    """
    return strength.end_stress(load, places, diameter)


def peak(load: str, wide: float, radius: float, per_fillet: int, order: int = 5) -> Peak:
    """K_t by elements of the meridian, with exact stresses on both ends."""
    return strength.fillet_peak(load, Shoulder(1.0, wide, radius), per_fillet, STEEL, order)


@dataclass(frozen=True)
class Factor:
    """K_t of one geometry, on two meshes, beside what is published.

    Attributes
    ----------
    wide, radius : float
        D/d and r/d.
    peak : Peak
        Peak with the finer mesh.
    band : float
        Half width: what a third more elements along the fillet changed, which at fifth order is
        several times what is left.
    """

    wide: float
    radius: float
    peak: Peak
    band: float


def factor(load: str, wide: float, radius: float, per_fillet: int = PER_FILLET) -> Factor:
    """K_t with its band, from two meshes."""
    found = strength.fillet_factor(load, Shoulder(1.0, wide, radius), STEEL, per_fillet)
    return Factor(wide, radius, found.peak, found.band)
