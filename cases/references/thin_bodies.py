"""Tubes and slender shafts that are hard to iterate on, and their exact compliances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from skfem.quadrature import get_quadrature

from fe_drivetrain.cases.references.solver_trials import factored, fastest
from fe_drivetrain.common import Bools, Floats, Ints
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.interfaces import eliminate, fixed, rigid_face, rigid_point
from fe_drivetrain.elasticity.mesh import (
    Hexahedra,
    element_kind,
    facet_points,
    jacobian,
    local_facets,
    shaft_hexahedra,
)
from fe_drivetrain.elasticity.operator import assemble
from fe_drivetrain.elasticity.revolution import dofs, harmonic_response, meridian, surface_loads
from fe_drivetrain.elasticity.solve import System, reduce
from fe_drivetrain.geometry import Section, Shaft

STEEL = MATERIALS["steel"]

#: Elements of a short shaft, and diameters beyond which an element is long.
SHORT, LONG = 4, 10.0


@dataclass(frozen=True)
class Problem:
    """A body with its loads.

    Attributes
    ----------
    mesh : Hexahedra
        Mesh of the body.
    shaft : Shaft
        Its geometry.
    system : System
        Constraints eliminated.
    F : (n, m) array
        Loads [N, N m, or N per Pa].
    """

    mesh: Hexahedra
    shaft: Shaft
    system: System
    F: Floats


def uniform(diameter: float, wall: float, length: float) -> Shaft:
    """A tube along x from 0.

    Parameters
    ----------
    diameter, wall, length : float
        Outer diameter, thickness of the wall, and length [m].
    """
    bore = diameter - 2.0 * wall
    return Shaft(
        front=0.0,
        sections=(Section(length=length, outer_diameter=diameter, inner_diameter=bore),),
    )


def cantilever(
    shaft: Shaft, size: float, turn: int, rigid: bool = True, refinement: int = 1
) -> Problem:
    """A shaft held at its rear end; torsion, and bending or an oval pressure.

    Parameters
    ----------
    shaft : Shaft
        One section.
    size : float
        Length of elements of 27 nodes [m].
    turn : int
        How many elements go round.
    rigid : bool
        A rigid front end with a moment about x and one about y; else a free end, twisted by
        tractions, and a pressure of 1 Pa times cos 2t on the outer surface.
    refinement : int
        Each element is cut into so many in every direction.
    """
    mesh = shaft_hexahedra(shaft, size, 27, elements_per_turn=turn, refinement=refinement)
    n = mesh.points.size
    total = n + 6 if rigid else n
    F = np.zeros((total, 2))
    constraints = [fixed("rear", mesh.rear, total)]
    if rigid:
        front = rigid_point("front", np.array([shaft.front, 0.0, 0.0]), n, total)
        constraints.append(rigid_face("front", mesh.front, mesh.points, front))
        F[[n + 3, n + 4], [0, 1]] = 1.0
    else:
        F[:, 0] = _twist(mesh)
        F[:, 1] = _oval(mesh, shaft)
    K = assemble(mesh.points, mesh.cells, STEEL.lame, total)
    elimination = eliminate(constraints, total)
    system = reduce(mesh.points, mesh.cells, K, elimination)
    return Problem(mesh, shaft, system, np.asarray(elimination.T.T @ F))


def torsional_compliance(problem: Problem) -> float:
    """L / (G J) of the meshed cross-section, Saint-Venant 1855 [rad/(N m)].

    The motion u = theta x e_x cross r is among the displacements of the elements, so that this is
    the exact answer on any mesh: whatever differs from it is the solver's error.
    """
    mesh, kind = problem.mesh, element_kind(problem.mesh.cells.shape[1])
    gradients, weights = kind.table(kind.degree)
    values = kind.shape(get_quadrature(kind.element.refdom, kind.degree)[0])[0]
    total = 0.0
    for start in range(0, len(mesh.cells), 512):
        some = mesh.cells[start : start + 512]
        volumes = np.abs(jacobian(mesh.points, some, gradients)[1]) * weights
        at = np.einsum("qn,eni->eqi", values, mesh.points[some])
        total += float((volumes * (at[..., 1] ** 2 + at[..., 2] ** 2)).sum())
    length = problem.shaft.length
    return length / (STEEL.shear_modulus * total / length)


def bending_compliance(diameter: float, wall: float, size: float, turn: int, count: int) -> float:
    """Turn of the front under a moment of 1 N m, of a shaft of equal elements along it.

    The moment is the same everywhere, so that each element along the shaft adds the same turn, a s,
    to that of the held end's neighbourhood, b(s). Both are found on short shafts, whose solutions
    have ten digits: a where s is the diameter, and b(s), which is in proportion to s where elements
    are long, at no more than `LONG` diameters. `SHORT` elements on, the two ends still feel each
    other to about 1e-6 of the turn: that is how exact it is.

    Parameters
    ----------
    diameter, wall : float
        Diameter and wall of the tube [m].
    size : float
        Length s of an element [m].
    turn, count : int
        Elements round, and along the shaft.

    Returns
    -------
    compliance : float
        [rad/(N m)].
    """

    def turned(s: float, n: int) -> float:
        shaft = uniform(diameter, wall, n * s)
        problem = cantilever(shaft, s * (1.0 + 1e-9), turn)
        return float(factored(problem.system, problem.F, fastest()).refined[1])

    a = (turned(diameter, 2 * SHORT) - turned(diameter, SHORT)) / (SHORT * diameter)
    s = min(size, LONG * diameter)
    b = turned(s, SHORT) - SHORT * s * a
    return float(count * size * a + b * size / s)


def oval_work(shaft: Shaft, elements: int = 8) -> float:
    """Work of the oval pressure of `cantilever`, from the meridian in the harmonic cos 2t.

    Parameters
    ----------
    shaft : Shaft
        One section.
    elements : int
        Number of elements of order 8 along the meridian.

    Returns
    -------
    work : float
        Twice the energy, at a pressure of 1 Pa [J].
    """
    radius = shaft.sections[0].outer_diameter / 2.0
    mesh = meridian(shaft, shaft.length / elements, order=8, layers=4)
    x = mesh.nodes[:, 0]
    sides = mesh.sides(lambda x, r: np.abs(r - radius) < 1e-9 * radius)
    loads = surface_loads(
        mesh, 2, sides, lambda at, normals: np.tile([0.0, 1.0, 0.0], (len(at), 1))
    )
    rear = np.flatnonzero(np.abs(x - shaft.rear) < 1e-9)
    which = np.concatenate([dofs(rear, k) for k in range(3)])
    found = harmonic_response(mesh, STEEL, 2, loads, (which, np.zeros(len(which))))
    return float(2.0 * found.energy[0])


def _facets(mesh: Hexahedra, chosen: Bools) -> Ints:
    """Facets whose nodes are all chosen."""
    facets = mesh.cells[:, local_facets(27)].reshape(-1, 9)
    return np.asarray(facets[chosen[facets].all(axis=1)])


def _twist(mesh: Hexahedra) -> Floats:
    """Tractions of pure torsion on the front end, of moment 1 N m."""
    front = np.zeros(len(mesh.points), dtype=bool)
    front[mesh.front] = True
    facets = _facets(mesh, front)
    at = facet_points(mesh.points, facets)
    moved = np.zeros_like(at.positions)
    moved[..., 1], moved[..., 2] = -at.positions[..., 2], at.positions[..., 1]
    F = np.zeros((len(mesh.points), 3))
    np.add.at(F, facets, np.einsum("qn,fq,fqi->fni", at.values, at.areas, moved))
    moment = (at.areas * (moved**2).sum(axis=-1)).sum()
    return np.asarray((F / moment).ravel())


def _oval(mesh: Hexahedra, shaft: Shaft) -> Floats:
    """A pressure of cos 2t outward on the outer surface [Pa]."""
    radius = shaft.sections[0].outer_diameter / 2.0
    outer = np.abs(np.hypot(mesh.points[:, 1], mesh.points[:, 2]) - radius) < 1e-9 * radius
    facets = _facets(mesh, outer)
    at = facet_points(mesh.points, facets)
    angle = np.arctan2(at.positions[..., 2], at.positions[..., 1])
    pressure = np.cos(2.0 * angle)[..., None] * at.normals
    F = np.zeros((len(mesh.points), 3))
    np.add.at(F, facets, np.einsum("qn,fq,fqi->fni", at.values, at.areas, pressure))
    return F.ravel()
