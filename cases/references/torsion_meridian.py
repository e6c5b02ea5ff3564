"""Torsion of a shaft of any outline between two bounds, from its meridian alone (Michell 1899).

Twisted by its rigid end faces, a body of revolution moves by u_t = r psi(x, r) and nothing else.
The angle psi that makes the energy least bounds the stiffness from above, the torsion function
phi that makes the complementary energy least bounds it from below:

    2 pi G min integral r^3 |grad psi|^2 dx dr  >=  k  >=  2 pi G / min integral r^-3 |grad phi|^2,

psi = 0 and 1 on the end faces; phi = 0 on the axis or the bore and 1 on the outer surface. A solid
shaft takes phi = r^4 chi, which leaves nothing singular on the axis.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from skfem import Basis, BilinearForm, ElementTriP4, MeshQuad, condense, solve

from fe_drivetrain.cases.references.shaft_theory import polar_moment
from fe_drivetrain.common import Floats
from fe_drivetrain.elasticity.mesh import shaft_quadrilaterals
from fe_drivetrain.geometry import LENGTH_TOLERANCE, Section, Shaft


@dataclass(frozen=True)
class Bounds:
    """The torsional stiffness lies between these [N m/rad]."""

    lower: float
    upper: float

    @property
    def middle(self) -> float:
        """[N m/rad]."""
        return 0.5 * (self.lower + self.upper)

    @property
    def half_width(self) -> float:
        """[N m/rad]."""
        return 0.5 * (self.upper - self.lower)


def torsion_bounds(shaft: Shaft, shear_modulus: float, size: float, halvings: int = 0) -> Bounds:
    """Bounds of the stiffness between rigid end faces.

    Parameters
    ----------
    shaft : Shaft
        Without fillets; solid, or of one bore all along.
    shear_modulus : float
        G [Pa].
    size : float
        Element size [m], fourth order.
    halvings : int
        Local refinements at the corners of the outline.

    Returns
    -------
    Bounds
        Rigorous but for the lower one where the outer surface is not a cylinder: there the values
        on it are interpolated with fourth order.
    """
    mesh = _triangles(shaft, size, halvings)
    basis = Basis(mesh, ElementTriP4(), intorder=12)
    x, r = basis.doflocs
    front, rear = (np.abs(x - end) < LENGTH_TOLERANCE for end in (shaft.front, shaft.rear))

    def angle(u: Any, v: Any, w: Any) -> Any:
        return w.x[1] ** 3 * (u.grad[0] * v.grad[0] + u.grad[1] * v.grad[1])

    most = _least(basis, angle, rear.astype(float), front | rear)

    ends = mesh.p[:, mesh.facets]
    outside = np.zeros(mesh.facets.shape[1], dtype=bool)
    outside[mesh.boundary_facets()] = True
    bore = shaft.pieces[0].inner_diameter / 2
    for axis, value in ((0, shaft.front), (0, shaft.rear), (1, bore)):
        outside &= np.abs(ends[axis] - value).max(axis=0) > LENGTH_TOLERANCE
    surface = np.zeros(basis.N, dtype=bool)
    surface[basis.get_dofs(np.flatnonzero(outside)).all()] = True
    if bore > 0:

        def function(u: Any, v: Any, w: Any) -> Any:
            return (u.grad[0] * v.grad[0] + u.grad[1] * v.grad[1]) / w.x[1] ** 3

        inside = np.abs(r - bore) < LENGTH_TOLERANCE
        least = _least(basis, function, surface.astype(float), surface | inside)
    else:

        def function(u: Any, v: Any, w: Any) -> Any:
            r = w.x[1]
            both = (4 * u + r * u.grad[1]) * (4 * v + r * v.grad[1])
            return r**5 * u.grad[0] * v.grad[0] + r**3 * both

        values = np.where(surface, np.where(r > 0, r, 1.0) ** -4.0, 0.0)
        least = _least(basis, function, values, surface)
    scale = 2 * np.pi * shear_modulus
    return Bounds(scale / least, scale * most)


def series_stiffness(shaft: Shaft, shear_modulus: float) -> float:
    """1 over the integral of dx / GJ [N m/rad], of cylinders and of solid cones.

    Sections that stay plane are one of the displacements over which the energy is least, so it is
    no smaller than the exact stiffness, nor than the upper of `torsion_bounds`.
    """
    return 1.0 / sum(_compliance(piece, shear_modulus) for piece in shaft.pieces)


def added_length(shaft: Shaft, shear_modulus: float, stiffness: float) -> float:
    """Length of the last part that twists as much as steps add to the series, over its diameter.

    Parameters
    ----------
    shaft : Shaft
        Parts of uniform diameter.
    shear_modulus : float
        G [Pa].
    stiffness : float
        Stiffness of the shaft, steps and all [N m/rad].
    """
    last, G = shaft.pieces[-1], shear_modulus
    polar = polar_moment(last.outer_diameter, last.inner_diameter)
    return (1 / stiffness - 1 / series_stiffness(shaft, G)) * G * polar / last.outer_diameter


def _compliance(piece: Section, shear_modulus: float) -> float:
    start, end = piece.outer_diameter / 2, piece.end_diameter / 2
    if start == end:
        polar = polar_moment(piece.outer_diameter, piece.inner_diameter)
        return piece.length / (shear_modulus * polar)
    grows = (end - start) / piece.length
    integral = (start**-3 - end**-3) / (3 * grows)
    return integral / (shear_modulus * np.pi / 2)


def _least(basis: Any, form: Callable[..., Any], values: Floats, held: Any) -> float:
    """The least energy with these values at the held degrees of freedom."""
    K = BilinearForm(form).assemble(basis)
    u = solve(*condense(K, x=values, D=np.flatnonzero(held)))
    return float(u @ (K @ u))


def _triangles(shaft: Shaft, size: float, halvings: int) -> Any:
    nodes, quads = shaft_quadrilaterals(shaft, size)
    corners, local = np.unique(quads[:, ::2, ::2], return_inverse=True)
    local = local.reshape(-1, 4)[:, [0, 2, 3, 1]]
    mesh = MeshQuad(nodes[corners].T.copy(), local.T.copy()).to_meshtri()
    outline = [
        (x, diameter / 2)
        for piece, ends in zip(shaft.pieces, pairwise(shaft.stations), strict=True)
        for x, diameter in zip(ends, (piece.outer_diameter, piece.end_diameter), strict=True)
    ]
    for _ in range(halvings):
        at = np.array(outline)[:, :, None]
        nearest = np.unique(np.abs(mesh.p - at).max(axis=1).argmin(axis=1))
        mesh = mesh.refined(np.flatnonzero(np.isin(mesh.t, nearest).any(axis=0)))
    return mesh
