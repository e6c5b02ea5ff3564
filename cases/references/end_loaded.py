"""Solid shafts whose end faces carry tractions, or are displaced: motions, stresses, errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.references.solid_shafts import Solid, pinned_like, prescribed_on, resultant
from fe_drivetrain.common import Floats, Ints, rigid_motions
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import averaged_point
from fe_drivetrain.elasticity.mesh import face_weights
from fe_drivetrain.elasticity.operator import nodal_stresses, traction_loads
from fe_drivetrain.elasticity.solve import Static, solve_solid


@dataclass(frozen=True)
class EndLoaded:
    """A solution.

    Attributes
    ----------
    mesh : Solid
        The shaft.
    material : Material
        Material of the shaft.
    static : Static
        What the solver found.
    """

    mesh: Solid
    material: Material
    static: Static

    @property
    def u(self) -> Floats:
        """(n, 3) displacements of the nodes [m]."""
        return np.asarray(self.static.u[:, 0].reshape(-1, 3))

    @property
    def stress(self) -> Floats:
        """(n, 6) recovered stresses xx, yy, zz, xy, yz, zx of the nodes [Pa]."""
        points, cells = self.mesh.points, self.mesh.cells
        return nodal_stresses(points, cells, self.static.u[:, 0], self.material.lame)

    def error(self, exact: Floats) -> float:
        """Largest difference from exact displacements (n, 3), over the largest of them."""
        return float(np.abs(self.u - exact).max() / np.abs(exact).max())

    def means(self, x: float) -> tuple[Floats, float]:
        """Mean displacement (3,) [m] of a section, and du_z/dx of its least-squares plane [rad]."""
        points, u = self.mesh.points, self.u
        weights = face_weights(points, self.mesh.section_facets(x), len(points))
        z = points[:, 2]
        slope = -(weights @ (z * u[:, 0])) / (weights @ z**2)
        return np.asarray(weights @ u / weights.sum()), float(slope)


def section_area(mesh: Solid, x: float) -> float:
    """Area of the meshed section [m^2]."""
    return float(face_weights(mesh.points, mesh.section_facets(x), len(mesh.points)).sum())


def skin_nodes(mesh: Solid, x: float) -> Ints:
    """Nodes of a section on the outer surface."""
    nodes = mesh.section_nodes(x)
    r = np.hypot(mesh.points[nodes, 1], mesh.points[nodes, 2])
    return np.asarray(nodes[r > r.max() * (1 - 1e-9)])


def end_forces(mesh: Solid, traction: Callable[[Floats, Floats], Floats]) -> tuple[Floats, Floats]:
    """Nodal forces (3 n,) of tractions on the front face, and on the rear face.

    Parameters
    ----------
    mesh : Solid
        The shaft.
    traction : callable
        Function of positions and outward normals (k, 3): tractions (k, 3) [Pa].
    """
    front, rear = (
        traction_loads(mesh.points, mesh.section_facets(x), traction)
        for x in (mesh.front, mesh.rear)
    )
    return front, rear


def balanced(mesh: Solid, F: Floats) -> Floats:
    """Forces in equilibrium, by uniform and linear tractions on the front face.

    Tractions of the exact section on the meshed one are out of balance by as little as the
    section's error, which would load what holds the shaft.
    """
    weights = face_weights(mesh.points, mesh.section_facets(mesh.front), len(mesh.points))
    nodes = np.flatnonzero(weights != 0.0)
    root = np.array([mesh.front, 0.0, 0.0])
    point = averaged_point("front", nodes, weights[nodes], mesh.points, root, mesh.points.size)
    return np.asarray(F - point.motion.T @ resultant(mesh.points, F, mesh.front))


def solve_loaded(mesh: Solid, material: Material, F: Floats, like: Floats) -> EndLoaded:
    """Solve under forces (3 n,) in equilibrium, three nodes held where a field (n, 3) has them."""
    return _solved(mesh, material, F, pinned_like(mesh, like))


def solve_displaced(mesh: Solid, material: Material, field: Floats) -> EndLoaded:
    """Solve with both end faces displaced as a field (n, 3) has them [m]."""
    ends = np.concatenate([mesh.section_nodes(x) for x in (mesh.front, mesh.rear)])
    return _solved(mesh, material, np.zeros(mesh.n_unknowns), prescribed_on(mesh, ends, field))


def between_rigid_ends(mesh: Solid, material: Material, components: list[int]) -> Floats:
    """Stiffness of a rigid rear face, the front face held.

    Parameters
    ----------
    mesh : Solid
        The shaft.
    material : Material
        Material of the shaft.
    components : list of int
        Motions of the rear face's centre: 0-2 along x, y, z, 3-5 about them; the others are held.

    Returns
    -------
    K : ndarray
        (c, c) forces and moments per motion [N/m, N, N m/rad].
    """
    rear = mesh.section_nodes(mesh.rear)
    held = np.concatenate([mesh.section_nodes(mesh.front), rear])
    motions = np.zeros((3 * held.size, len(components)))
    here = rigid_motions(mesh.points[rear], np.array([mesh.rear, 0.0, 0.0]))[:, components]
    motions[-3 * len(rear) :] = here
    columns = (3 * held[:, None] + np.arange(3)).ravel()
    F = np.zeros(mesh.n_unknowns)
    found = solve_solid(mesh.points, mesh.cells, material.lame, [], F, (columns, motions))
    return np.asarray(here.T @ found.reactions["prescribed"][columns[-3 * len(rear) :]])


def _solved(mesh: Solid, material: Material, F: Floats, held: tuple[Ints, Floats]) -> EndLoaded:
    found = solve_solid(mesh.points, mesh.cells, material.lame, [], F, held)
    return EndLoaded(mesh, material, found)
