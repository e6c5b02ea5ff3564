"""A shouldered shaft as a solid: the stress on its fillet."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import chebyshev

from fe_drivetrain.cases.references import fillet_factors
from fe_drivetrain.common import Floats
from fe_drivetrain.elasticity.mesh import Mesh, generate
from fe_drivetrain.elasticity.operator import Traction, nodal_stresses, tensor, traction_loads
from fe_drivetrain.elasticity.solve import solve_solid
from fe_drivetrain.geometry import LocalSizes, MeshSizes, Shaft
from fe_drivetrain.shafts.strength import LOADS

SIZES = MeshSizes(shaft=0.4, elements_per_turn=12)
"""Away from the fillet, in the thinner diameter."""
GROWTH = 0.5
"""Of the element size with the distance from the fillet."""


@dataclass(frozen=True)
class SolidFillet:
    """Stress on the nodes of a fillet.

    Attributes
    ----------
    unknowns : int
        Of the solid.
    angle : Floats
        (n,) on the arc, from its end on the thinner shaft [degrees].
    around : Floats
        (n,) from the side that bending pulls [rad].
    stress : dict[str, Floats]
        Along the arc in tension and bending, between arc and circumference in torsion (n,), over
        the nominal one.
    """

    unknowns: int
    angle: Floats
    around: Floats
    stress: dict[str, Floats]

    def profile(self, load: str) -> Floats:
        """(k, 2) angle and local factor; in bending of the nodes within 60 degrees of the top."""
        s = self.stress[load]
        keep = np.ones(len(s), dtype=bool)
        if load == "bending":
            cosine = np.cos(self.around)
            keep = np.abs(cosine) > 0.5
            s = np.where(keep, s / np.where(keep, cosine, 1.0), 0.0)
        found = np.column_stack([self.angle, s])[keep]
        return np.asarray(found[found[:, 0].argsort()])

    def factor(self, load: str, degree: int) -> float:
        """K_t: the peak of a polynomial along the arc."""
        weight = np.cos(self.around) if load == "bending" else np.ones_like(self.around)
        return fitted_peak(self.angle, self.stress[load], degree, weight)


def fitted_peak(angle: Floats, factor: Floats, degree: int, weight: Floats | None = None) -> float:
    """Largest value on the arc of the polynomial p with weight * p nearest to factor.

    Parameters
    ----------
    angle, factor : Floats
        (n,) places on the arc [degrees], and the local factors there.
    degree : int
        Of the polynomial.
    weight : Floats or None
        (n,) 1 where not given.
    """
    w = np.ones_like(angle) if weight is None else weight
    terms = chebyshev.chebvander(angle / 45.0 - 1.0, degree)
    coefficients = np.linalg.lstsq(terms * w[:, None], factor, rcond=None)[0]
    return float(chebyshev.chebval(np.linspace(-1.0, 1.0, 901), coefficients).max())


def solve(wide: float, radius: float, per_fillet: int) -> SolidFillet:
    """Mesh the shaft and load its ends with the exact stresses of tension, bending and torsion.

    Parameters
    ----------
    wide, radius : float
        D/d and r/d, of d = 1 m.
    per_fillet : int
        Elements along the fillet.
    """
    shaft = fillet_factors.shouldered(wide, radius)
    mesh = _fine_at_fillet(shaft, radius, per_fillet)
    points = mesh.points
    F = np.zeros((points.size, len(LOADS)))
    for face, diameter, sign in (("front", wide, -1.0), ("rear", 1.0, 1.0)):
        facets = mesh.faces[f"shaft.{face}"]
        for column, load in enumerate(LOADS):
            F[:, column] += traction_loads(points, facets, _traction(load, diameter, sign))
    # three nodes of the rear face hold the shaft as a whole, and carry nothing
    rear = mesh.face_nodes("shaft.rear")
    y, z = points[rear, 1], points[rear, 2]
    right, left, top = rear[y.argmax()], rear[y.argmin()], rear[z.argmax()]
    held = [(right, 0), (right, 1), (right, 2), (left, 0), (left, 2), (top, 0)]
    which = np.array([3 * node + axis for node, axis in held])
    found = solve_solid(
        points, mesh.cells, fillet_factors.STEEL.lame, [], F, (which, np.zeros(len(which)))
    )
    r = np.hypot(points[:, 1], points[:, 2])
    out = np.hypot(points[:, 0] - radius, r - 0.5 - radius)
    near = np.flatnonzero(np.abs(out - radius) < 1e-6)
    angle = np.arctan2(radius - points[near, 0], 0.5 + radius - r[near])
    outward = np.column_stack([0.0 * near, points[near, 1] / r[near], points[near, 2] / r[near]])
    along_x = np.array([1.0, 0.0, 0.0])
    arc = np.cos(angle)[:, None] * along_x - np.sin(angle)[:, None] * outward
    circle = np.cross(along_x, outward)
    stress = {}
    for column, load in enumerate(LOADS):
        s = tensor(
            nodal_stresses(points, mesh.cells, found.u[:, column], fillet_factors.STEEL.lame)[near]
        )
        across = circle if load == "torsion" else arc
        stress[load] = np.einsum("ni,nij,nj->n", arc, s, across)
    return SolidFillet(
        points.size, np.degrees(angle), np.arctan2(points[near, 1], points[near, 2]), stress
    )


def _fine_at_fillet(shaft: Shaft, radius: float, per_fillet: int) -> Mesh:
    """A mesh whose elements grow away from the fillet, whose place a coarse one gives."""
    coarse = _coarse(shaft)
    x, r = coarse.points[:, 0], np.hypot(coarse.points[:, 1], coarse.points[:, 2])
    away = np.abs(np.hypot(x - radius, r - 0.5 - radius) - radius)
    size = 0.5 * np.pi * radius / per_fillet + GROWTH * away
    corners = coarse.cells[:, :4]
    return generate(shaft, sizes=SIZES, local=LocalSizes(coarse.points[corners], size[corners]))


@cache
def _coarse(shaft: Shaft) -> Mesh:
    return generate(shaft, sizes=SIZES)


def _traction(load: str, diameter: float, sign: float) -> Traction:
    def traction(at: Floats, normal: Floats) -> Floats:
        height, r = at[:, 2], np.hypot(at[:, 1], at[:, 2])
        places = np.column_stack([at[:, 0], height if load == "bending" else r])
        along, _, around = fillet_factors.end_stress(load, places, diameter).T
        safe = np.where(r > 0, r, 1.0)
        circle = np.column_stack([0.0 * r, -at[:, 2] / safe, at[:, 1] / safe])
        axis = np.array([1.0, 0.0, 0.0])
        return np.asarray(sign * (along[:, None] * axis + around[:, None] * circle))

    return traction
