"""Stress at the fillet of a shaft's step by elasticity: the meridian in Fourier harmonics.

A step stands in a long shaft, whose ends carry the exact stresses of tension, bending and torsion,
so that nothing is held rigidly. Its sections may be bored, by different diameters.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.materials import MATERIALS, Material
from fe_drivetrain.elasticity.revolution.harmonics import (
    Traction,
    along_sides,
    dofs,
    harmonic_response,
    stress_at,
    stresses,
    surface_loads,
)
from fe_drivetrain.elasticity.revolution.meridian_mesh import Meridian, Where, meridian
from fe_drivetrain.geometry import Section, Shaft

LOADS = ("tension", "bending", "torsion")

#: Length of shaft on either side of the step, in the larger diameter: what the step adds to the
#: exact end stresses has died down to 1e-4 or less there (the slowest of the axisymmetric end
#: effects decays as exp(-2.72 x / R), from the first root of g^2 (J0^2 + J1^2) = 2 (1 - nu) J1^2).
REACH = 2.0

PER_FILLET = 8
"""Elements along the fillet."""

SIZE = 0.35
"""Largest element, in the thinner diameter."""

_DEEP = 0.02
"""How deep below the surface the gradient is read, over the radius."""


@dataclass(frozen=True)
class Shoulder:
    """A step between two cylinders.

    Attributes
    ----------
    diameter, wide : float
        Diameters d and D [m].
    radius : float
        Radius of the fillet, at most half of what they differ by [m].
    bore, wide_bore : float
        Diameters of the bore of the thinner and of the wider cylinder [m].
    """

    diameter: float
    wide: float
    radius: float
    bore: float = 0.0
    wide_bore: float = 0.0

    @property
    def depth(self) -> float:
        """Height t of the step [m]."""
        return (self.wide - self.diameter) / 2.0

    @property
    def in_diameters(self) -> Shoulder:
        """The same for a thinner diameter of 1 m."""
        d = self.diameter
        return Shoulder(1.0, self.wide / d, self.radius / d, self.bore / d, self.wide_bore / d)


def shouldered(shoulder: Shoulder) -> Shaft:
    """A long shaft, wide for x < 0 and thin behind, with the fillet between.

    Parameters
    ----------
    shoulder : Shoulder
        The step.
    """
    length = REACH * shoulder.wide
    return Shaft(
        front=-length,
        sections=(
            Section(
                length=length,
                outer_diameter=shoulder.wide,
                inner_diameter=shoulder.wide_bore,
                fillet=shoulder.radius,
            ),
            Section(length=length, outer_diameter=shoulder.diameter, inner_diameter=shoulder.bore),
        ),
    )


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
    gradient : float
        Relative slope of the stress into the shaft at the peak [1/m]; NaN where not asked for.
    """

    factor: float
    angle: float
    profile: Floats
    gradient: float = math.nan

    __repr__ = short_repr


@dataclass(frozen=True)
class FilletFactor:
    """K_t of a fillet on two meshes.

    Attributes
    ----------
    peak : Peak
        Peak with the finer mesh.
    band : float
        Half width: what a third more elements along the fillet changed, which at fifth order is
        several times what is left.
    """

    peak: Peak
    band: float


def fillet_factor(
    load: str,
    shoulder: Shoulder,
    material: Material = MATERIALS["steel"],
    per_fillet: int = PER_FILLET,
) -> FilletFactor:
    """K_t of a fillet with its band, from two meshes.

    Parameters
    ----------
    load : str
        One of `LOADS`.
    shoulder : Shoulder
        The step.
    material : Material
        Whose Poisson ratio counts.
    per_fillet : int
        Elements along the fillet of the finer mesh, from 3 on.

    Raises
    ------
    InputError
        The fillet does not fit the step, or cannot be meshed.
    """
    rough, fine = (
        fillet_peak(load, shoulder, n, material) for n in (3 * per_fillet // 4, per_fillet)
    )
    return FilletFactor(fine, abs(fine.factor - rough.factor))


def fillet_peak(
    load: str,
    shoulder: Shoulder,
    per_fillet: int = PER_FILLET,
    material: Material = MATERIALS["steel"],
    order: int = 5,
) -> Peak:
    """K_t of a fillet by elements of the meridian.

    Parameters
    ----------
    load : str
        One of `LOADS`.
    shoulder : Shoulder
        The step.
    per_fillet : int
        Elements along the fillet.
    material : Material
        Whose Poisson ratio counts.
    order : int
        Order of the elements.

    Raises
    ------
    InputError
        The fillet does not fit the step, or cannot be meshed.
    """
    if load not in LOADS:
        raise InputError(f"load {load!r} of a fillet: choose one of {', '.join(LOADS)}")
    scaled = shoulder.in_diameters
    shaft = shouldered(scaled)
    mesh = meridian(shaft, SIZE, order=order, layers=0, per_fillet=per_fillet)
    n = 1 if load == "bending" else 0
    F = np.zeros(3 * len(mesh.nodes))
    ends = ((shaft.front, scaled.wide, scaled.wide_bore), (shaft.rear, 1.0, scaled.bore))
    for x, outer, inner in ends:
        F += surface_loads(mesh, n, mesh.sides(_at(x)), _traction(load, scaled, outer, inner))
    rear = mesh.where(lambda x, r: x > shaft.rear - 1e-9)
    outer_node = rear[mesh.nodes[rear, 1].argmax()]
    held = np.array([dofs(outer_node, 0), dofs(outer_node, 2 if n == 0 else 1)])
    u = harmonic_response(mesh, material, n, F, (held, np.zeros(2))).u[..., 0]
    found = _along_fillet(load, mesh, material, n, u, scaled.radius)
    return replace(found, gradient=found.gradient / shoulder.diameter)


def end_stress(
    load: str, places: Floats, diameter: float, bore: float = 0.0, nominal_bore: float = 0.0
) -> Floats:
    """(k, 3) stress xx, xr, xt on a section, for a nominal stress of 1 Pa in a diameter of 1 m.

    Saint-Venant's, exact far from the step: uniform, linear in the height, or in the radius.

    Parameters
    ----------
    load : str
        One of `LOADS`.
    places : ndarray, (k, 2)
        x, and the radius or the height [m].
    diameter, bore : float
        Diameters of the section [m].
    nominal_bore : float
        Bore of the section whose nominal stress is 1 [m].
    """
    r = places[:, 1]
    zero = np.zeros_like(r)
    if load == "tension":
        share = (1.0 - nominal_bore**2) / (diameter**2 - bore**2)
        return np.column_stack([zero + share, zero, zero])
    share = (1.0 - nominal_bore**4) / (diameter**4 - bore**4)
    linear = 2.0 * r * share
    return np.column_stack([linear, zero, zero] if load == "bending" else [zero, zero, linear])


def _at(x: float) -> Where:
    return lambda along, radius: np.abs(along - x) < 1e-9


def _traction(load: str, shoulder: Shoulder, diameter: float, bore: float) -> Traction:
    return lambda at, normal: end_stress(load, at, diameter, bore, shoulder.bore) * normal[:, :1]


def _along_fillet(
    load: str, mesh: Meridian, material: Material, n: int, u: Floats, radius: float
) -> Peak:
    centre = np.array([radius, 0.5 + radius])
    near = 1e-3 * radius  # between the nodes of low orders a side is beside the arc
    arc = mesh.sides(lambda x, r: np.abs(np.hypot(x - centre[0], r - centre[1]) - radius) < near)
    along = np.linspace(0.0, 1.0, 33)
    rows = []
    for side in np.unique(arc[:, 1]):
        cells = arc[arc[:, 1] == side, 0]
        at = along_sides(mesh, int(side), cells, along)[1]
        s = stresses(mesh, material, n, u, mesh.element.side_places(int(side), along), cells)
        angle = np.degrees(np.arctan2(centre[0] - at[..., 0], centre[1] - at[..., 1]))
        rows.append(np.column_stack([angle.ravel(), local_factor(load, s).ravel()]))
    profile = np.vstack(rows)
    profile = profile[profile[:, 0].argsort()]
    top = profile[:, 1].argmax()
    angle, factor = float(profile[top, 0]), float(profile[top, 1])
    deep = _DEEP * radius
    inward = np.array([-math.sin(math.radians(angle)), -math.cos(math.radians(angle))])
    below = centre + np.outer(radius + np.array([deep, 2.0 * deep]), inward)
    s1, s2 = local_factor(load, stress_at(mesh, material, n, u, below)).tolist()
    slope = (4.0 * s1 - 3.0 * factor - s2) / (2.0 * deep)  # one-sided, of second order
    return Peak(factor, angle, profile, -slope / factor)


def local_factor(load: str, s: Floats) -> Floats:
    """(...) largest principal stress of (..., 6) where the cosine is 1; in torsion shear stress."""
    xx, rr, tt, xr, xt, rt = np.moveaxis(s, -1, 0)
    if load == "torsion":
        return np.asarray(np.hypot(xt, rt))
    in_plane = (xx + rr) / 2.0 + np.hypot((xx - rr) / 2.0, xr)
    return np.asarray(np.maximum(in_plane, tt))
