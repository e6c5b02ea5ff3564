"""Measures of a mesh: Jacobians, proof that elements are valid, quality, volume and area."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from skfem.quadrature import get_quadrature

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.elasticity.mesh.facets import facet_points
from fe_drivetrain.elasticity.mesh.mapping import jacobian
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.elasticity.mesh.shapes import TETRAHEDRON_EDGES, element_kind

_AREA_DEGREE = 8
_MOMENT_DEGREE = 6  # the volume element of a curved cell is cubic, squares of positions quartic


def lattice(order: int) -> Ints:
    """Multi-indices of a tetrahedral lattice, (n, 4), each row summing to `order`."""
    rows = [
        (order - i - j - k, i, j, k)
        for i in range(order + 1)
        for j in range(order + 1 - i)
        for k in range(order + 1 - i - j)
    ]
    return np.array(rows)


CUBIC = lattice(3) / 3
"""The 20 points that determine the Jacobian of a quadratic tetrahedron, a cubic polynomial."""

_FACTORIALS = np.array([1, 1, 2, 6])
_CHOOSE = 6 / _FACTORIALS[lattice(3)].prod(axis=1)

TO_BERNSTEIN = np.linalg.inv(_CHOOSE * (CUBIC[:, None, :] ** lattice(3)[None]).prod(axis=2))
"""Values at `CUBIC` times the transpose of this: the Bernstein coefficients."""

# the ten nodes of a tetrahedron, and the eight that halve its edges: one at each corner, and the
# octahedron between them cut in four along the diagonal from edge 01 to edge 23
_TEN = np.concatenate(
    [np.eye(4), [(np.eye(4)[i] + np.eye(4)[j]) / 2 for i, j in combinations(range(4), 2)]]
)

EIGHTHS = _TEN[
    [
        [0, 4, 5, 6],
        [1, 4, 7, 8],
        [2, 5, 7, 9],
        [3, 6, 8, 9],
        [4, 9, 5, 6],
        [4, 9, 6, 8],
        [4, 9, 8, 7],
        [4, 9, 7, 5],
    ]
]
"""Corners of the eight tetrahedra that halve the edges of one, (8, 4, 4), barycentric."""

_BLOCK = 4096  # cells


def jacobians(points: Floats, cells: Ints, at: Floats = CUBIC) -> Floats:
    """Determinant of the Jacobian of each cell.

    Parameters
    ----------
    points : Floats
        Nodes (n, 3), m.
    cells : Ints
        Node ids (ne, 10).
    at : Floats
        Barycentric coordinates (q, 4).

    Returns
    -------
    (ne, q) determinants, m3; six times the volume for an element with straight edges.
    """
    gradients = element_kind(10).shape(at[:, 1:].T)[1].transpose(2, 1, 0).reshape(10, -1)
    blocks = []
    # in blocks, so that the Jacobians of a large mesh never stand in memory all at once
    for start in range(0, len(cells), _BLOCK):
        nodes = points[cells[start : start + _BLOCK]].transpose(0, 2, 1)
        # one product for all, far faster than many small ones: rows x, y, z, three derivatives each
        rows = (nodes.reshape(-1, 10) @ gradients).reshape(len(nodes), 3, 3, len(at))
        x, y, z = rows.transpose(1, 2, 0, 3)
        blocks.append(
            x[0] * (y[1] * z[2] - y[2] * z[1])
            + x[1] * (y[2] * z[0] - y[0] * z[2])
            + x[2] * (y[0] * z[1] - y[1] * z[0])
        )
    return np.concatenate(blocks) if blocks else np.empty((0, len(at)))


def inverted_cells(mesh: Mesh, depth: int = 3) -> Ints:
    """Cells whose Jacobian cannot be shown to be positive everywhere inside.

    The Jacobian of a quadratic tetrahedron is a cubic polynomial, which its Bernstein
    coefficients bound from below (Johnen, Remacle and Geuzaine 2013, section 3): positive
    coefficients prove the element valid everywhere, not only at sampled points. Where the bound
    does not decide, the element is split in eight and each piece judged again.

    Parameters
    ----------
    depth : int
        Maximum number of times that an undecided element is split.

    Returns
    -------
    Indices of the cells, ascending.
    """
    # of an element straight to round-off, the Jacobian at its centre is that everywhere
    nodes = mesh.points[mesh.cells]
    first, second = TETRAHEDRON_EDGES.T
    sagitta = nodes[:, 4:] - (nodes[:, first] + nodes[:, second]) / 2
    round_off = 1e-14 * np.abs(mesh.points).max(initial=0.0)
    curved = np.abs(sagitta).reshape(-1, 18).max(axis=1, initial=0.0) > round_off
    straight = np.flatnonzero(~curved)
    centre = jacobians(mesh.points, mesh.cells[straight], np.full((1, 4), 0.25))[:, 0]
    curved_cells = np.flatnonzero(curved)
    values = jacobians(mesh.points, mesh.cells[curved_cells])
    negative = values.min(axis=1, initial=np.inf) <= 0
    undecided = ((values @ TO_BERNSTEIN.T).min(axis=1, initial=np.inf) <= 0) & ~negative
    invalid = [*straight[centre <= 0], *curved_cells[negative]]
    for cell in curved_cells[undecided]:
        pieces = EIGHTHS
        for level in range(depth):
            at = np.einsum("qc,pcb->pqb", CUBIC, pieces)
            inside = jacobians(mesh.points, mesh.cells[[cell]], at.reshape(-1, 4))
            inside = inside.reshape(len(pieces), -1)
            open_ = (inside @ TO_BERNSTEIN.T).min(axis=1) <= 0
            if not open_.any():
                break
            if inside.min() <= 0 or level == depth - 1:
                invalid.append(cell)
                break
            pieces = np.einsum("skc,pcb->pskb", EIGHTHS, pieces[open_]).reshape(-1, 4, 4)
    return np.array(sorted(invalid), dtype=np.int64)


@dataclass(frozen=True)
class MeshQuality:
    """Shape quality of a mesh.

    Attributes
    ----------
    minimum_scaled_jacobian : float
        Minimum ratio of the Jacobian in a curved element to that of the straight-sided element
        with the same corners: 1 where every edge is straight, 0 or less where an element folds
        over (gmsh's minSJ). Sampled at the 20 points of the cubic lattice.
    minimum_scaled_jacobian_of : dict[str, float]
        Minimum of each part by its name.
    elements, nodes : int
        Numbers of elements and nodes.
    inverted : int
        Number of elements not proved valid everywhere inside (`inverted_cells`).
    """

    minimum_scaled_jacobian: float
    minimum_scaled_jacobian_of: dict[str, float]
    elements: int
    nodes: int
    inverted: int


def scaled_jacobians(points: Floats, cells: Ints) -> Floats:
    """Minimum ratio of each cell's Jacobian to that of its straight-sided twin, (ne,).

    Negative also where the corners alone make an inverted tetrahedron.
    """
    corners = points[cells[:, :4]]
    straight = np.linalg.det(corners[:, 1:] - corners[:, :1])
    least = jacobians(points, cells).min(axis=1)
    flat = np.full_like(least, -np.inf)
    ratio = np.divide(least, np.abs(straight), out=flat, where=straight != 0)
    return np.asarray(np.where(straight > 0, ratio, -np.abs(ratio)))


def quality(mesh: Mesh) -> MeshQuality:
    """Measure the shape of the elements."""
    scaled = scaled_jacobians(mesh.points, mesh.cells)
    return MeshQuality(
        minimum_scaled_jacobian=float(scaled.min()),
        minimum_scaled_jacobian_of={
            name: float(scaled[mesh.part_cells(name)].min()) for name in mesh.part_names
        },
        elements=len(mesh.cells),
        nodes=len(mesh.points),
        inverted=len(inverted_cells(mesh)),
    )


def mean_size(mesh: Mesh) -> float:
    """Cube root of the mean volume of the cells [m]: the size that a series of meshes really has.

    Sizes that are asked for rule where nothing asks for smaller ones: curved and narrow faces do.
    """
    return float((volume(mesh) / len(mesh.cells)) ** (1.0 / 3.0))


def volume(mesh: Mesh, part: str | None = None) -> float:
    """Volume of the mesh or of one part, curved elements and all.

    Exact for the meshed shape: the Jacobian is a cubic polynomial, whose mean over the element is
    the mean of its Bernstein coefficients.

    Returns
    -------
    Volume, m3.
    """
    cells = mesh.cells if part is None else mesh.cells[mesh.part_cells(part)]
    weights = TO_BERNSTEIN.mean(axis=0) / 6
    return float((jacobians(mesh.points, cells) @ weights).sum())


def mass_moments(points: Floats, cells: Ints) -> tuple[float, Floats, Floats]:
    """Volume, centre, and inertia about it of a solid of density one.

    Parameters
    ----------
    points : Floats
        Nodes (n, 3) [m].
    cells : Ints
        Node numbers (ne, k) in VTK's order.

    Returns
    -------
    tuple
        Volume [m^3], centre (3,) [m], and inertia (3, 3) [m^5].
    """
    kind = element_kind(cells.shape[1])
    X, W = get_quadrature(kind.element.refdom, _MOMENT_DEGREE)
    values, gradients = kind.shape(X)
    weights = np.abs(jacobian(points, cells, gradients)[1]) * W
    at = np.einsum("qk,eki->eqi", values, points[cells])
    total = float(weights.sum())
    centre = np.einsum("eq,eqi->i", weights, at) / total
    away = at - centre
    second = np.einsum("eq,eqi,eqj->ij", weights, away, away)
    inertia = np.trace(second) * np.eye(3) - second
    return total, np.asarray(centre), np.asarray(inertia, dtype=np.float64)


def area(mesh: Mesh, face: str) -> float:
    """Area of a named face, m2, over its curved facets."""
    mesh.face_nodes(face)
    return float(facet_points(mesh.points, mesh.faces[face], _AREA_DEGREE).areas.sum())


def area_vectors(points: Floats, facets: Ints) -> Floats:
    """Integral of the normal over each curved facet, (nf, 3), m2; zero in sum when closed."""
    at = facet_points(points, facets, _AREA_DEGREE)
    return np.asarray(np.einsum("fqi,fq->fi", at.normals, at.areas))


def enclosed_volume(points: Floats, facets: Ints) -> float:
    """Volume within a closed surface of curved facets that are turned outward, m3."""
    at = facet_points(points, facets)
    return float(np.einsum("fqi,fqi,fq->", at.positions, at.normals, at.areas)) / 3
