"""A component as a solid in curved tetrahedra, condensed to its reference points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import linalg

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.geometry import BodySizes
from fe_drivetrain.interfaces import constraints
from fe_drivetrain.mesh.facets import MEANS, face_weights
from fe_drivetrain.mesh.mesh import Mesh
from fe_drivetrain.mesh.symmetry import meshed, mirror, repeated, turns
from fe_drivetrain.operator.incompressible import assemble_unlocked
from fe_drivetrain.operator.mass import mass_matrix
from fe_drivetrain.scene.component import Component, HousingComponent, material_of
from fe_drivetrain.solve.condensation import Condensed, condense
from fe_drivetrain.solve.reduction import reduce
from fe_drivetrain.solve.solvers import Solver, factorise


def component_mesh(component: Component) -> tuple[Mesh, BodySizes]:
    """The mesh of a component, mirrored from one half or turned from one sector, and its sizes:
    finer than asked for where elements would have folded over.

    Raises
    ------
    InputError
        The body cannot be meshed with these sizes.
    """
    if isinstance(component, HousingComponent):
        half, sizes = meshed(component.gearbox_housing.build_half, component.mesh)
        eyes = {"housing.eye": ["housing.left", "housing.right"]}
        return repeated(half, [np.eye(3), mirror(1)], ["housing.cut"], eyes), sizes
    carrier = component.planet_carrier
    sector, sizes = meshed(carrier.build_sector, component.mesh)
    pins = {"carrier.pin": [f"carrier.{name}" for name in component.loaded]}
    cuts = ["carrier.first", "carrier.last"]
    return repeated(sector, turns(carrier.planets), cuts, pins), sizes


@dataclass(frozen=True)
class SolidComponent:
    """A component's solid, solved for unit loads.

    Attributes
    ----------
    mesh, sizes
        Its mesh, and the element sizes of that.
    body
        It, condensed to its points.
    unknowns
        Of the system.
    """

    mesh: Mesh
    sizes: BodySizes
    body: Condensed
    unknowns: int
    _loads: Floats
    _rigid: Floats
    _elimination: constraints.Elimination
    _solver: Solver

    def displacements(self, motions: Floats) -> Floats:
        """Displacements of all nodes (n, 3) where the points move so, and nothing else loads it.

        Parameters
        ----------
        motions
            (6 p,) of the p points [m, rad].
        """
        forces = self.body.stiffness @ motions
        T = self._elimination.T
        u = np.asarray(T @ self._solver.solve(T.T @ (self._loads @ forces[:, None])).x)[:, 0]
        u += self._rigid @ (motions[:6] - self._loads[:, :6].T @ u)
        return u[: self.mesh.points.size].reshape(-1, 3)


def solid_component(component: Component, method: str = "auto") -> SolidComponent:
    """Mesh a component, solve it free for unit loads at its points, and condense it to these.

    Parameters
    ----------
    component
        The component; its supports have no part in this.
    method
        Solver, see `fe_drivetrain.solve.solvers.factorise`.

    Raises
    ------
    InputError
        The body cannot be meshed.
    """
    mesh, sizes = component_mesh(component)
    n = len(mesh.points)
    attachments = component.attachments
    n_freedoms = 3 * n + 6 * sum(a.coupling == "rigid" for a in attachments)
    points, rigid_faces, own = [], [], 3 * n
    for name, face, position, coupling in attachments:
        nodes = mesh.face_nodes(face)
        if coupling == "rigid":
            point = constraints.rigid_point(name, position, own, n_freedoms)
            rigid_faces.append(constraints.rigid_face(name, nodes, mesh.points, point))
            own += 6
        else:
            weights = face_weights(mesh.points, mesh.faces[face], n, MEANS)[nodes]
            point = constraints.averaged_point(
                name, nodes, weights, mesh.points, position, n_freedoms
            )
        points.append(point)
    held = np.concatenate([mesh.face_nodes(a.face) for a in attachments if a.coupling == "rigid"]
                          or [np.zeros(0, dtype=int)])  # fmt: skip
    pins = _pins(mesh.points, np.setdiff1d(np.arange(n), held), n_freedoms)
    elimination = constraints.eliminate([pins, *rigid_faces], n_freedoms)
    material = material_of(component)
    K = assemble_unlocked(mesh.points, mesh.cells, material.lame, n_freedoms)
    mass = mass_matrix(mesh.points, mesh.cells, material.density, n_freedoms)
    system = reduce(mesh.points, mesh.cells, K, elimination)
    solver = factorise(system, method, 6 * len(points))

    def solved(F: Floats) -> Floats:
        return np.asarray(elimination.T @ solver.solve(elimination.T.T @ F).x)

    loads = np.hstack([point.motion.T.toarray() for point in points])
    first = attachments[0].position
    rigid = np.zeros((n_freedoms, 6))
    rigid[: 3 * n] = rigid_motions(mesh.points, first)
    own = 3 * n
    for a in attachments:
        if a.coupling == "rigid":
            rigid[own : own + 3] = rigid_motions(a.position[None], first)
            rigid[own + 3 : own + 6, 3:] = np.eye(3)
            own += 6
    names = [a.name for a in attachments]
    positions = np.array([a.position for a in attachments])
    body = condense(names, positions, loads, mass, rigid, solved)
    return SolidComponent(mesh, sizes, body, system.n_free, loads, rigid, elimination, solver)


def _pins(points: Floats, allowed: Ints, n_freedoms: int) -> constraints.Constraint:
    """Six freedoms of three nodes far apart: they hold a solid without straining it."""
    some = points[allowed]
    a = int(np.argmin(some[:, 1]))
    b = int(np.argmax(np.linalg.norm(some - some[a], axis=1)))
    along = (some[b] - some[a]) / np.linalg.norm(some[b] - some[a])
    c = int(np.argmax(np.linalg.norm(np.cross(some - some[a], along), axis=1)))
    nodes = allowed[[a, b, c]]
    motions = rigid_motions(points[nodes], points[nodes].mean(axis=0))
    motions[:, 3:] /= np.linalg.norm(some[b] - some[a])
    best = linalg.qr(motions.T, mode="r", pivoting=True)[1][:6]
    return constraints.held_freedoms("pins", constraints.freedoms(nodes).ravel()[best], n_freedoms)
