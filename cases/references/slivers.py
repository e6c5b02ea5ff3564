"""A bar with a layer of slivers: tetrahedra of four corners nearly in one plane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import gmsh
import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, splu

from fe_drivetrain.cases.references.exact_blocks import LENGTH, SIDE, E
from fe_drivetrain.cases.references.one_norm import one_norm_estimate
from fe_drivetrain.common import Floats, InputError, Ints
from fe_drivetrain.elasticity.interfaces import Constraint, eliminate, held_nodes
from fe_drivetrain.elasticity.mesh import Mesh, boundary
from fe_drivetrain.elasticity.mesh.shapes import TETRAHEDRON_EDGES
from fe_drivetrain.elasticity.operator import assemble, traction_loads
from fe_drivetrain.elasticity.solve import System, reduce, solve
from fe_drivetrain.geometry.session import gmsh_session, numbered_nodes

LAME = (0.0, E / 2.0)
FORCE = 1e6  # [N]

_REFERENCE_HEIGHT = 0.1
_CORNERS = np.array([(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)])
_FIVE = {
    # corners of a cube numbered as above; the inner tetrahedron, then one at each other corner
    0: [(0, 3, 5, 6), (1, 0, 3, 5), (2, 0, 3, 6), (4, 0, 5, 6), (7, 3, 5, 6)],
    1: [(1, 2, 4, 7), (0, 1, 2, 4), (3, 1, 2, 7), (5, 1, 4, 7), (6, 2, 4, 7)],
}


def bar(height: float, across: int, nodes: int = 10) -> Mesh:
    """A bar, x from 0 to `LENGTH`, with one sliver in each square of a lattice plane in its middle.

    Cubes of five tetrahedra have the diagonals of their faces between corners of even parity on one
    side of the plane, and of odd parity on the other. Even corners of the plane are moved to one
    side, odd ones to the other, and the four of a square make a sliver.

    Parameters
    ----------
    height : float
        Height of the slivers over the size of a cube; below 0 they are inside out.
    across : int
        Cubes across, an even number; twice as many to a length.
    nodes : int
        Number of nodes of an element, 10 or 4.
    """
    along = 2 * across
    n = (along, across, across)
    index = np.stack(np.meshgrid(*[np.arange(k + 1) for k in n], indexing="ij"), axis=-1)
    number = np.arange(index[..., 0].size).reshape(index.shape[:3])
    lattice = index.reshape(-1, 3)
    middle = along // 2
    size = np.array([LENGTH / along, SIDE / across, SIDE / across])

    def placed(relative: float) -> Floats:
        points = lattice * size - np.array([0.0, SIDE / 2, SIDE / 2])
        odd = lattice.sum(axis=1) % 2
        in_plane = lattice[:, 0] == middle
        points[in_plane, 0] += relative * size[0] * (odd[in_plane] - 0.5)
        return np.asarray(points)

    cells = []
    for i, j, k in np.ndindex(*n):
        cube = number[tuple((np.array([i, j, k]) + _CORNERS).T)]
        cells += [cube[list(c)] for c in _FIVE[(i + j + k + (i >= middle)) % 2]]
    for j, k in np.ndindex(*n[1:]):
        cells.append(number[middle, j : j + 2, k : k + 2].ravel())
    corners = np.array(cells)
    at = placed(_REFERENCE_HEIGHT)[corners]
    turned = np.linalg.det(at[:, 1:] - at[:, :1]) < 0
    corners[turned, 2:] = corners[turned][:, [3, 2]]
    return as_mesh(placed(height), corners, nodes)


def as_mesh(points: Floats, corners: Ints, nodes: int) -> Mesh:
    """Tetrahedra of four nodes as they are, or with nodes in the middle of their straight edges."""
    cells = corners
    if nodes == 10:
        ends = np.sort(corners[:, TETRAHEDRON_EDGES].reshape(-1, 2), axis=1)
        edges, which = np.unique(ends, axis=0, return_inverse=True)
        cells = np.hstack([corners, len(points) + which.reshape(-1, 6)])
        points = np.vstack([points, points[edges].mean(axis=1)])
    part = np.zeros(len(cells), dtype=np.int64)
    return Mesh(points, cells, part, ("bar",), {}, {})


def optimised(mesh: Mesh, nodes: int = 10) -> Mesh:
    """The mesh with its slivers taken out by gmsh, which swaps edges and faces."""
    with gmsh_session("slivers"):
        model = gmsh.model
        corners = mesh.cells[:, :4]
        used, local = np.unique(corners, return_inverse=True)
        local = local.reshape(corners.shape)
        _classified(mesh.points[used], local)
        model.mesh.optimize("", True)
        points, number = numbered_nodes()
        cells = model.mesh.getElementsByType(4)[1].reshape(-1, 4)
    return as_mesh(points, number[cells], nodes)


def _classified(points: Floats, cells: Ints) -> None:
    """Put tetrahedra into gmsh as a discrete volume inside its discrete surface."""
    tags = np.arange(1, len(points) + 1)
    facets = cells[:, [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)]].reshape(-1, 3)
    _, first, count = np.unique(
        np.sort(facets, axis=1), axis=0, return_index=True, return_counts=True
    )
    outside = facets[first[count == 1]]
    mesh = gmsh.model.mesh
    gmsh.model.addDiscreteEntity(2, 1)
    gmsh.model.addDiscreteEntity(3, 1, [1])
    on = np.unique(outside)
    mesh.addNodes(2, 1, tags[on], points[on].ravel())
    inside = np.setdiff1d(np.arange(len(points)), on)
    mesh.addNodes(3, 1, tags[inside], points[inside].ravel())
    mesh.addElementsByType(1, 2, [], tags[outside].ravel())
    mesh.addElementsByType(1, 4, [], tags[cells].ravel())


@dataclass(frozen=True)
class Bent:
    """The bar bent by couples at its ends, and by a shear force.

    Attributes
    ----------
    bending, shear : float
        Errors of the stiffness, relative to the exact one; NaN where nothing came out. Elements of
        ten nodes with straight edges hold the first solution: what is left is the solver's error.
    iterations : int
        Number of iterations of the solver, 0 of a direct one.
    solver : str
        Which gave the answer, or why there is none.
    condition : float
        Estimated condition number in the 1-norm, the diagonal scaled to one.
    """

    bending: float
    shear: float
    iterations: int
    solver: str
    condition: float


def bent(mesh: Mesh, method: str, condition: bool = False) -> Bent:
    """Solve a bar without lateral contraction, held at three corners that carry nothing.

    Couples M: sigma_xx = M z / I and U = M^2 L / 2EI. Shear: `exact_blocks.cantilever`.

    Parameters
    ----------
    mesh : Mesh
        Mesh of the bar.
    method : str
        Method of `solvers.solve`.
    condition : bool
        Whether to estimate the condition number.
    """
    inertia, area = SIDE**4 / 12.0, SIDE**2
    exact = FORCE**2 * np.array(
        [LENGTH**3 / (E * inertia), LENGTH**3 / (3 * E * inertia) + 2.4 * LENGTH / (E * area)]
    )
    number = np.nan
    try:
        system, right = loaded(mesh)
        number = _condition(system) if condition else np.nan
        found = solve(system, right, method)
    except (InputError, ValueError, RuntimeError) as error:
        return Bent(np.nan, np.nan, 0, f"{type(error).__name__}: {error}", number)
    # stiffness as load squared over twice the energy
    bending, by_shear = exact / np.einsum("nm,nm->m", right, found.x) - 1.0
    return Bent(
        float(bending),
        float(by_shear),
        found.diagnostics.iterations,
        found.diagnostics.method,
        number,
    )


def loaded(mesh: Mesh) -> tuple[System, Floats]:
    """The bar's system, and its loads (n, 2): couples at its ends, and a shear force."""
    points = mesh.points
    inertia, c = SIDE**4 / 12.0, SIDE / 2.0

    def couples(positions: Floats, normals: Floats) -> Floats:
        out = np.zeros_like(positions)
        out[:, 0] = LENGTH * FORCE * positions[:, 2] / inertia
        return np.asarray(out * normals[:, [0]])

    def shear(positions: Floats, normals: Floats) -> Floats:
        x, _, z = positions.T
        out = np.zeros_like(positions)
        out[:, 0] = -FORCE * (LENGTH - x) * z / inertia
        out[:, 2] = FORCE * (c**2 - z**2) / (2.0 * inertia)
        return np.asarray(out * normals[:, [0]])

    n = points.size
    F = np.zeros((n, 2))
    for x in (0.0, LENGTH):
        facets = _end_facets(mesh, x)
        for column, load in enumerate((couples, shear)):
            F[:, column] += traction_loads(points, facets, load)
    held = [
        held_nodes(f"corner {k}", np.array([_nearest(points, at)]), axes, n)
        for k, (at, axes) in enumerate(
            (((0, -c, -c), (0, 1, 2)), ((LENGTH, -c, -c), (1, 2)), ((0, c, -c), (2,)))
        )
    ]
    system, T = _system(mesh, held)
    return system, np.asarray(T.T @ F)


def _end_facets(mesh: Mesh, x: float) -> Ints:
    if mesh.cells.shape[1] == 10:
        facets = boundary(mesh)
    else:
        every = mesh.cells[:, [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)]].reshape(-1, 3)
        _, first, count = np.unique(
            np.sort(every, axis=1), axis=0, return_index=True, return_counts=True
        )
        facets = every[first[count == 1]]
    there = np.abs(mesh.points[facets[:, :3], 0] - x).max(axis=1) < 1e-9
    return np.asarray(facets[there])


def _nearest(points: Floats, at: Sequence[float]) -> int:
    return int(np.linalg.norm(points - np.array(at), axis=1).argmin())


def _system(mesh: Mesh, held: list[Constraint]) -> tuple[System, sparse.csr_array]:
    n = mesh.points.size
    K = assemble(mesh.points, mesh.cells, LAME, n)
    elimination = eliminate(held, n)
    return reduce(mesh.points, mesh.cells, K, elimination), elimination.T


def _condition(system: System) -> float:
    K = system.K.tocsc()
    scale = sparse.diags_array(1.0 / np.sqrt(np.abs(K.diagonal())))
    scaled = (scale @ K @ scale).tocsc()
    try:
        factor = splu(scaled)
    except RuntimeError:
        return float("inf")
    inverse = LinearOperator(scaled.shape, matvec=factor.solve, rmatvec=factor.solve)
    return one_norm_estimate(scaled) * one_norm_estimate(inverse)
