"""Folded elements unfolded: nodes follow the curved outside of a part as those of an elastic solid.

Curving the edges of a coarse mesh to its surface folds elements whose other nodes stay where they
were. Here these follow.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.elasticity.mesh.measures import area_vectors, scaled_jacobians
from fe_drivetrain.elasticity.mesh.mesh import Mesh, boundary
from fe_drivetrain.elasticity.mesh.shapes import TETRAHEDRON_EDGES
from fe_drivetrain.elasticity.mesh.shared_facets import are_among
from fe_drivetrain.elasticity.operator.elasticity import assemble

_LAYERS = 2  # of elements round those that are folded, which deform, too
_STIFFER = 10.0
_ROUNDS = 6
_LAME = (9.0, 1.0)  # nearly incompressible: volumes, and with them Jacobians, change least
_FLAT = 1e-6  # how far nodes of a plane facet may be from its plane, relative to its size


def unfolded(mesh: Mesh, floor: float = 0.1) -> Mesh:
    """Move nodes near folded elements until these are sound, while the outside keeps its shape.

    Round such elements the mesh with straight edges is taken for an elastic solid, whose outside
    is moved to where it is curved. Nodes inside follow; nodes of plane faces slide in them, those
    of rims stay. Elements that are still too flat are made stiffer, again and again. An element
    with two facets on one smooth face stays folded, since all its edges are tangent to the face at
    a corner: there nodes have to move along the face, which a mesh does not know.

    Parameters
    ----------
    mesh : Mesh
        Mesh as it was curved.
    floor : float
        Scaled Jacobian below which cells shall be unfolded.

    Returns
    -------
    Mesh
        Mesh with the same cells.

    Notes
    -----
    Curving by elasticity as Persson and Peraire 2009, Curved mesh generation and mesh refinement
    using Lagrangian solid mechanics, AIAA 2009-949; stiffening after Stein, Tezduyar and Benney
    2003, Mesh moving techniques for fluid-structure interactions with large displacements,
    J. Appl. Mech. 70, 58-63.
    """
    near = scaled_jacobians(mesh.points, mesh.cells) < floor
    if not near.any():
        return mesh
    for _ in range(_LAYERS):
        near = np.asarray(np.isin(mesh.cells, mesh.cells[near]).any(axis=1))
    nodes, local = np.unique(mesh.cells[near], return_inverse=True)
    cells = local.reshape(-1, mesh.cells.shape[1])
    curved = mesh.points[nodes]
    straight = curved.copy()
    straight[cells[:, 4:]] = curved[cells[:, TETRAHEDRON_EDGES]].mean(axis=2)

    free = _free(mesh)[nodes]
    free[np.isin(nodes, mesh.cells[~near])] = 0.0
    P, held = _blocks(free), np.eye(3) - free
    given = np.einsum("nij,nj->ni", held, curved - straight).ravel()
    K = assemble(straight, cells, _LAME, given.size)
    rest = float(K.diagonal().mean()) * _blocks(held)

    least, best = _missing(curved, cells, floor), curved
    for _ in range(_ROUNDS):
        factor = splu(
            (P @ K @ P + rest).tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        now = straight + (given - factor.solve(P @ (K @ given))).reshape(-1, 3)
        missing = _missing(now, cells, floor)
        if missing.sum() >= least.sum():
            break
        least, best = missing, now
        low = missing > 0.0
        if not low.any():
            break
        K = K + (_STIFFER - 1) * assemble(straight, cells[low], _LAME, given.size)
    points = mesh.points.copy()
    points[nodes] = best
    return replace(mesh, points=points)


def _missing(points: Floats, cells: Ints, floor: float) -> Floats:
    """Difference of each cell's scaled Jacobian to the floor, where it is below."""
    return np.asarray(np.maximum(floor - scaled_jacobians(points, cells), 0.0))


def _blocks(blocks: Floats) -> sparse.bsr_array:
    """A matrix with these blocks (n, 3, 3) on its diagonal."""
    n = len(blocks)
    return sparse.bsr_array((blocks, np.arange(n), np.arange(n + 1)))


def _free(mesh: Mesh) -> Floats:
    """Projections (n, 3, 3) of each node's motion on what leaves the outside as it is.

    All of it inside, in plane faces their plane, and nothing on curved ones, edges, and rims of
    named faces.
    """
    facets = boundary(mesh)
    vectors = area_vectors(mesh.points, facets)
    areas = np.linalg.norm(vectors, axis=1)
    normals = vectors / areas[:, None]
    away = mesh.points[facets] - mesh.points[facets[:, :1]]
    off = np.abs(np.einsum("fki,fi->fk", away, normals)).max(axis=1)
    plane = off < _FLAT * np.sqrt(areas)

    nodes, owner = facets.ravel(), np.repeat(np.arange(len(facets)), facets.shape[1])
    first = np.zeros(len(mesh.points), dtype=np.int64)
    first[nodes] = owner
    one = first[nodes]
    slides = plane[owner] & (np.einsum("mi,mi->m", normals[owner], normals[one]) > 1 - 1e-9)
    for face in mesh.faces.values():
        within = are_among(facets, face, len(mesh.points))
        slides &= within[owner] == within[one]

    result = np.broadcast_to(np.eye(3), (len(mesh.points), 3, 3)).copy()
    result[nodes] -= np.einsum("mi,mj->mij", normals[one], normals[one])
    result[nodes[~slides]] = 0.0
    return result
