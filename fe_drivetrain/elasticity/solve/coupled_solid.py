"""A meshed solid whose faces move reference points: assembled, coupled, and condensed to these.

Shafts, components and bearing units all come this way: the parts of a mesh and their materials, the
faces and how each holds its point, then either the free body condensed to the points
(`condensed_solid`) or the compliance of a held one there (`point_motions_of`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import linalg, sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import point_motions, rigid_motions
from fe_drivetrain.drivetrain_file.component import Attachment
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.elasticity.interfaces import constraints
from fe_drivetrain.elasticity.interfaces.constraints import Constraint, Elimination, ReferencePoint
from fe_drivetrain.elasticity.mesh.facets import MEANS, face_weights
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.elasticity.operator import kernels
from fe_drivetrain.elasticity.operator.elements import check_elements
from fe_drivetrain.elasticity.operator.incompressible import assemble_materials
from fe_drivetrain.elasticity.operator.mass import mass_matrix
from fe_drivetrain.elasticity.solve.condensation import Condensed, condense
from fe_drivetrain.elasticity.solve.reduction import reduce
from fe_drivetrain.elasticity.solve.solvers import Solver, factorise, solve

#: Relative error in the energy norm of displacements from which a compliance follows: that is then
#: right to its square, which is less than what the last digits of the stiffness leave open.
DISPLACEMENTS = 1e-5


@dataclass(frozen=True)
class CoupledSolid:
    """Parts of a mesh with reference points on their faces, not held yet.

    Attributes
    ----------
    mesh : Mesh
        The mesh; nodes of parts that are left out have no stiffness.
    cells : Ints
        Cells (n_cells, k) of the parts.
    stiffness : sparse.bsr_array
        Stiffness (n, n): three degrees of freedom a node first, then six of each point with a rigid
        face [N/m, N, N m/rad].
    attachments : tuple[Attachment, ...]
        Attachments of the faces.
    points : tuple[ReferencePoint, ...]
        Reference points of the faces, in the same order.
    rigid_faces : tuple[Constraint, ...]
        Constraints that make faces rigid (RBE2).
    """

    mesh: Mesh
    cells: Ints
    stiffness: sparse.bsr_array
    attachments: tuple[Attachment, ...]
    points: tuple[ReferencePoint, ...]
    rigid_faces: tuple[Constraint, ...]

    __repr__ = short_repr

    @property
    def n_dofs(self) -> int:
        """Number of degrees of freedom, of the nodes and of points with a rigid face."""
        return int(self.stiffness.shape[0])

    @property
    def loads(self) -> Floats:
        """(n, 6 p) nodal forces of a unit force or moment at each of the p points."""
        return np.hstack([point.motion.T.toarray() for point in self.points])


@dataclass(frozen=True)
class CondensedSolid:
    """A free solid condensed to its reference points, and what leads back to its nodes.

    Attributes
    ----------
    mesh : Mesh
        Mesh of the solid.
    body : Condensed
        Solid condensed to its points.
    unknowns : int
        Number of unknowns of the system.
    """

    mesh: Mesh
    body: Condensed
    unknowns: int
    _loads: Floats
    _rigid: Floats
    _elimination: Elimination
    _solver: Solver

    __repr__ = short_repr

    def displacements(self, motions: Floats) -> Floats:
        """Displacements of all nodes (n, 3) where the points move so, and nothing else loads it.

        Parameters
        ----------
        motions : Floats
            Motions (6 p,) of the p points [m, rad].
        """
        return self.fields(motions[:, None])[:, 0].reshape(-1, 3)

    def fields(self, motions: Floats) -> Floats:
        """Displacements of all nodes (3 n, m) for several motions (6 p, m), see `displacements`."""
        forces = self.body.stiffness @ motions
        T = self._elimination.T
        u = np.asarray(T @ self._solver.solve(T.T @ (self._loads @ forces)).x)
        u += self._rigid @ (motions[:6] - self._loads[:, :6].T @ u)
        return u[: self.mesh.points.size]


def assembled_parts(mesh: Mesh, materials: Mapping[str, Material]) -> sparse.bsr_array:
    """Stiffness of parts of a mesh, once for several ways to couple its faces.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    materials : mapping of str to Material
        Material of each part that is assembled, by its name in the mesh.

    Returns
    -------
    sparse.bsr_array
        Stiffness (3 n, 3 n) of the n nodes [N/m].

    Raises
    ------
    InputError
        A cell has a node that there is not, or is folded over.
    """
    chosen = [mesh.part_cells(part) for part in materials]
    cells = mesh.cells[np.concatenate(chosen)]
    check_elements(mesh.points, cells)
    owner = np.repeat(np.arange(len(chosen)), [len(some) for some in chosen])
    of_parts = [(owner == k, material.lame) for k, material in enumerate(materials.values())]
    return assemble_materials(mesh.points, cells, of_parts)


def coupled_solid(
    mesh: Mesh,
    materials: Mapping[str, Material],
    attachments: Sequence[Attachment],
    stiffness: sparse.bsr_array | None = None,
) -> CoupledSolid:
    """Assemble parts of a mesh and couple faces to reference points.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    materials : mapping of str to Material
        Material of each part that is assembled, by its name in the mesh.
    attachments : sequence of Attachment
        Reference points with their faces.
    stiffness : sparse.bsr_array or None
        Stiffness from `assembled_parts`, where that is there already.

    Raises
    ------
    InputError
        A cell has a node that there is not, or is folded over.
    """
    n = len(mesh.points)
    n_dofs = 3 * n + 6 * sum(a.coupling == "rigid" for a in attachments)
    points, rigid_faces, own = [], [], 3 * n
    for name, face, position, coupling in attachments:
        nodes = mesh.face_nodes(face)
        if coupling == "rigid":
            point = constraints.rigid_point(name, position, own, n_dofs)
            rigid_faces.append(constraints.rigid_face(name, nodes, mesh.points, point))
            own += 6
        else:
            weights = face_weights(mesh.points, mesh.faces[face], n, MEANS)[nodes]
            point = constraints.averaged_point(name, nodes, weights, mesh.points, position, n_dofs)
        points.append(point)
    K = assembled_parts(mesh, materials) if stiffness is None else stiffness
    # reference points have no stiffness of their own
    ends = np.append(K.indptr, np.full(n_dofs // 3 - n, K.indptr[-1], dtype=K.indptr.dtype))
    K = sparse.bsr_array((K.data, K.indices, ends), shape=(n_dofs, n_dofs))
    cells = np.concatenate([mesh.cells[mesh.part_cells(part)] for part in materials])
    return CoupledSolid(mesh, cells, K, tuple(attachments), tuple(points), tuple(rigid_faces))


def condensed_solid(
    mesh: Mesh,
    materials: Mapping[str, Material],
    attachments: Sequence[Attachment],
    method: str = "auto",
) -> CondensedSolid:
    """Solve a free solid for unit loads at its reference points, and condense it to these.

    Parameters
    ----------
    mesh : Mesh
        The mesh, all parts of it joined.
    materials : mapping of str to Material
        Material of every part, by its name in the mesh.
    attachments : sequence of Attachment
        Reference points with their faces; at least two.
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.factorise`.

    Raises
    ------
    InputError
        There is only one point, or two move as one; a cell is folded over.
    """
    solid = coupled_solid(mesh, materials, attachments)
    n, total = 3 * len(mesh.points), solid.n_dofs
    mass = sum(
        mass_matrix(mesh.points, mesh.cells[mesh.part_cells(part)], material.density, total)
        for part, material in materials.items()
    )
    rigidly = [mesh.face_nodes(a.face) for a in attachments if a.coupling == "rigid"]
    pinned = np.setdiff1d(np.unique(solid.cells), np.concatenate([[], *rigidly]))
    pins = _pins(mesh.points, pinned, total)
    elimination = constraints.eliminate([pins, *solid.rigid_faces], total)
    system = reduce(mesh.points, solid.cells, solid.stiffness, elimination)
    # of unit loads between the points, and three of gravity
    solver = factorise(system, method, 6 * len(solid.points) - 3)

    def solved(F: Floats) -> Floats:
        return np.asarray(elimination.T @ solver.solve(elimination.T.T @ F).x)

    positions = np.array([a.position for a in attachments])
    rigid = np.zeros((total, 6))
    rigid[:n] = rigid_motions(mesh.points, positions[0])
    own = [a.position for a in attachments if a.coupling == "rigid"]
    rigid[n:] = point_motions(np.reshape(own, (-1, 3)), positions[0])
    loads = solid.loads
    body = condense([a.name for a in attachments], positions, loads, mass, rigid, solved)
    return CondensedSolid(mesh, body, system.n_free, loads, rigid, elimination, solver)


def point_motions_of(
    solid: CoupledSolid,
    held: Sequence[Constraint],
    springs: Sequence[tuple[ReferencePoint, Floats]] = (),
    method: str = "auto",
) -> tuple[Floats, Floats]:
    """Displacements of a held solid for unit forces and moments at its points, and its compliance.

    The compliance is F^T U + U^T F - U^T K U, whose error is the work of the errors of two
    displacements on each other: of second order, and relative at most the square of theirs.

    Parameters
    ----------
    solid : CoupledSolid
        The solid.
    held : sequence of Constraint
        Constraints that hold it.
    springs : sequence of (ReferencePoint, ndarray (6, 6))
        Springs to ground at reference points [N/m, N, N m/rad].
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.solve`.

    Returns
    -------
    displacements : ndarray, (n, 6 p)
        Displacements of all n degrees of freedom, for the p points, to `DISPLACEMENTS` in the
        energy norm.
    compliance : ndarray, (6 p, 6 p)
        Motions of the points, to the square of that [m/N, 1/N, rad/(N m)].

    Raises
    ------
    InputError
        The solid is not held, or two constraints hold one degree of freedom.
    """
    K = solid.stiffness
    for at, k in springs:
        K = K + (at.motion.T @ sparse.csr_array(k) @ at.motion).tobsr((3, 3))
    elimination = constraints.eliminate([*held, *solid.rigid_faces], solid.n_dofs)
    system = reduce(solid.mesh.points, solid.cells, K, elimination, springs)
    F = solid.loads
    solution = solve(system, elimination.T.T @ F, method, DISPLACEMENTS)
    U = np.asarray(elimination.T @ solution.x)
    return U, compliance_of(K, F, U)


def compliance_of(K: sparse.bsr_array, F: Floats, U: Floats) -> Floats:
    """Compliance of solutions U of K U = F, all (n, m): F^T U + U^T F - U^T K U, (m, m).

    Its error is the work of the errors of two solutions on each other: of second order.
    """
    first = F.T @ U
    return np.asarray(first + first.T - U.T @ kernels.product(K, U))


def _pins(points: Floats, allowed: Ints, n_dofs: int) -> Constraint:
    """Six degrees of freedom of three nodes far apart: they hold a solid without straining it."""
    some = points[allowed]
    extent = np.ptp(some, axis=0)
    # the longest axis, and of a round body, whose two differ by the mesh alone, the first
    a = int(np.argmin(some[:, np.argmax(extent > 0.99 * extent.max())]))
    length = np.linalg.norm(some - some[a], axis=1)
    b = int(np.argmax(length))
    along = (some[b] - some[a]) / length[b]
    c = int(np.argmax(np.linalg.norm(np.cross(some - some[a], along), axis=1)))
    nodes = allowed[[a, b, c]]
    motions = rigid_motions(points[nodes], points[nodes].mean(axis=0))
    motions[:, 3:] /= length[b]
    best = linalg.qr(motions.T, mode="r", pivoting=True)[1][:6]
    return constraints.held_dofs("pins", constraints.dofs(nodes).ravel()[best], n_dofs)
