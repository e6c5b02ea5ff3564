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
from fe_drivetrain.elasticity.revolution import (
    Meridian,
    Traction,
    Where,
    along_sides,
    dofs,
    harmonic_response,
    meridian,
    stresses,
    surface_loads,
)
from fe_drivetrain.geometry import Section, Shaft

STEEL = MATERIALS["steel"]

LOADS = ("tension", "bending", "torsion")

#: Length of shaft on either side of the shoulder, in the larger diameter: what the shoulder adds to
#: the exact end stresses has died down to 1e-4 or less there (the slowest of the axisymmetric end
#: effects decays as exp(-2.72 x / R), from the first root of g^2 (J0^2 + J1^2) = 2 (1 - nu) J1^2).
REACH = 2.0

PETERSON = (
    "Pilkey and Pilkey 2008, Peterson's Stress Concentration Factors, 3rd ed., charts 3.4, "
    "3.10 and 3.12"
)
TIPTON = (
    "Tipton, Sorem and Rolovic 1996, J. Mech. Des. 118, 321-327, as in Pilkey and Pilkey 2008, "
    "chapter 3"
)

PER_FILLET = 8
"""Elements along the fillet."""

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
    length = REACH * wide
    return Shaft(
        front=-length,
        sections=(
            Section(length=length, outer_diameter=wide, fillet=radius),
            Section(length=length, outer_diameter=1.0),
        ),
    )


def end_stress(load: str, places: Floats, diameter: float) -> Floats:
    """(k, 3) stress xx, xr, xt on a section of a diameter, for a nominal stress of 1 Pa in d.

    Saint-Venant's, exact far from the shoulder: uniform, linear in the height, or in the radius.
    """
    r = places[:, 1]
    zero = np.zeros_like(r)
    if load == "tension":
        return np.column_stack([zero + 1.0 / diameter**2, zero, zero])
    linear = 2.0 * r / diameter**4
    return np.column_stack([linear, zero, zero] if load == "bending" else [zero, zero, linear])


@dataclass(frozen=True)
class Peak:
    """The largest stress of a fillet.

    Attributes
    ----------
    factor : float
        K_t: of largest principal, in torsion of shear stress, over the nominal one in d.
    angle : float
        Where it is on the arc, from the end on the thinner shaft [degrees].
    profile : Floats
        (k, 2) angle and local factor along the arc.
    """

    factor: float
    angle: float
    profile: Floats


def peak(load: str, wide: float, radius: float, per_fillet: int, order: int = 5) -> Peak:
    """K_t by elements of the meridian, with exact stresses on both ends."""
    shaft = shouldered(wide, radius)
    mesh = meridian(shaft, 0.35, order=order, layers=0, per_fillet=per_fillet)
    n = 1 if load == "bending" else 0
    F = np.zeros(3 * len(mesh.nodes))
    for x, diameter in ((shaft.front, wide), (shaft.rear, 1.0)):
        F += surface_loads(mesh, n, mesh.sides(_at(x)), _traction(load, diameter))
    rear = mesh.where(lambda x, r: x > shaft.rear - 1e-9)
    outer = rear[mesh.nodes[rear, 1].argmax()]
    held = np.array([dofs(outer, 0), dofs(outer, 2 if n == 0 else 1)])
    u = harmonic_response(mesh, STEEL, n, F, (held, np.zeros(2))).u[..., 0]
    return _along_fillet(load, mesh, n, u, radius)


def _at(x: float) -> Where:
    return lambda along, radius: np.abs(along - x) < 1e-9


def _traction(load: str, diameter: float) -> Traction:
    return lambda at, normal: end_stress(load, at, diameter) * normal[:, :1]


def _along_fillet(load: str, mesh: Meridian, n: int, u: Floats, radius: float) -> Peak:
    centre = np.array([radius, 0.5 + radius])
    near = 1e-6 * radius
    arc = mesh.sides(lambda x, r: np.abs(np.hypot(x - centre[0], r - centre[1]) - radius) < near)
    along = np.linspace(0.0, 1.0, 33)
    rows = []
    for side in np.unique(arc[:, 1]):
        cells = arc[arc[:, 1] == side, 0]
        at = along_sides(mesh, int(side), cells, along)[1]
        s = stresses(mesh, STEEL, n, u, mesh.element.side_places(int(side), along), cells)
        angle = np.degrees(np.arctan2(centre[0] - at[..., 0], centre[1] - at[..., 1]))
        rows.append(np.column_stack([angle.ravel(), local_factor(load, s).ravel()]))
    profile = np.vstack(rows)
    profile = profile[profile[:, 0].argsort()]
    top = profile[:, 1].argmax()
    return Peak(float(profile[top, 1]), float(profile[top, 0]), profile)


def local_factor(load: str, s: Floats) -> Floats:
    """(...) largest principal stress of (..., 6) where the cosine is 1; in torsion shear stress."""
    xx, rr, tt, xr, xt, rt = np.moveaxis(s, -1, 0)
    if load == "torsion":
        return np.asarray(np.hypot(xt, rt))
    in_plane = (xx + rr) / 2.0 + np.hypot((xx - rr) / 2.0, xr)
    return np.asarray(np.maximum(in_plane, tt))


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
    rough, fine = (peak(load, wide, radius, n) for n in (3 * per_fillet // 4, per_fillet))
    return Factor(wide, radius, fine, abs(fine.factor - rough.factor))
