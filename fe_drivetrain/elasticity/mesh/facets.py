"""Facets of the elements: which of a cell's nodes they have, and how they are integrated."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from skfem import ElementQuad1, ElementQuad2, ElementQuadS2, ElementTriP1, ElementTriP2
from skfem.quadrature import get_quadrature

from fe_drivetrain.common.arrays import Floats, Ints, chunks
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.mapping import jacobian
from fe_drivetrain.elasticity.mesh.numbering import check_nodes
from fe_drivetrain.elasticity.mesh.shapes import (
    HEXAHEDRON_EDGES,
    HEXAHEDRON_FACES,
    Nodal,
    element_kind,
)

MEANS = 4
"""Degree of the quadrature for means over a face, which need less than loads do."""

_TETRAHEDRON = np.array(
    [[0, 2, 1, 6, 5, 4], [0, 1, 3, 4, 8, 7], [0, 3, 2, 7, 9, 6], [1, 2, 3, 5, 9, 8]]
)
_ELEMENTS = {
    3: (ElementTriP1, 2),
    6: (ElementTriP2, 6),
    4: (ElementQuad1, 3),
    8: (ElementQuadS2, 7),
    9: (ElementQuad2, 7),
}
# VTK's quadrilateral on the unit square: corners, middles of sides, centre.
_SQUARE = np.array(
    [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5), (0.5, 0.5)]
)


@dataclass(frozen=True)
class FacetKind(Nodal):
    """A facet, known by its number of nodes.

    Attributes
    ----------
    degree : int
        Degree of a quadrature that is exact to round-off for smooth loads on curved facets.
    """

    degree: int


@cache
def facet_kind(n_nodes: int) -> FacetKind:
    """Facet with that number of nodes: triangles with 3 and 6, quadrilaterals with 4, 8 and 9.

    Raises
    ------
    InputError
        There is none.
    """
    if n_nodes not in _ELEMENTS:
        raise InputError(
            f"no facet has {n_nodes} nodes: use triangles of 3 or 6, or quadrilaterals of 4, 8 or "
            "9 nodes"
        )
    make, degree = _ELEMENTS[n_nodes]
    element = make()
    if n_nodes in (3, 6):
        return FacetKind(element, np.arange(n_nodes), degree)
    distance = np.abs(_SQUARE[:n_nodes, None] - element.doflocs[None]).max(axis=2)
    return FacetKind(element, distance.argmin(axis=1), degree)


@cache
def local_facets(n_nodes: int) -> Ints:
    """Local nodes (n_facets, k) of a cell's facets, by its number of nodes, turned outward."""
    if element_kind(n_nodes).n_corners == 4:
        return _TETRAHEDRON[:, : 3 if n_nodes == 4 else 6]
    middle = {frozenset(edge): 8 + k for k, edge in enumerate(HEXAHEDRON_EDGES)}
    rows = []
    for number, corners in enumerate(HEXAHEDRON_FACES):
        sides = zip(corners, (*corners[1:], corners[0]), strict=True)
        rows.append([*corners, *(middle[frozenset(side)] for side in sides), 20 + number])
    return np.array(rows)[:, : {8: 4, 20: 8, 27: 9}[n_nodes]]


def outside(cells: Ints) -> Ints:
    """(nf, m) facets, turned outward, that belong to one of the cells (ne, k) only."""
    local = local_facets(cells.shape[1])
    facets = cells[:, local].reshape(-1, local.shape[1])
    corners = 3 if local.shape[1] in (3, 6) else 4
    key = np.sort(facets[:, :corners], axis=1)
    _, first, count = np.unique(key, axis=0, return_index=True, return_counts=True)
    found: Ints = facets[np.sort(first[count == 1])]
    return found


@dataclass(frozen=True)
class FacetPoints:
    """Quadrature points on facets.

    Attributes
    ----------
    values : Floats
        (n_q, k) shape functions.
    positions : Floats
        (n_facets, n_q, 3) [m].
    normals : Floats
        (n_facets, n_q, 3) unit normals, outward.
    areas : Floats
        Weight (n_facets, n_q) of each point [m^2].
    """

    values: Floats
    positions: Floats
    normals: Floats
    areas: Floats


def facet_points(points: Floats, facets: Ints, degree: int | None = None) -> FacetPoints:
    """Quadrature points, normals and weights of curved facets.

    Parameters
    ----------
    points : Floats
        Node coordinates (n, 3) [m].
    facets : Ints
        Node numbers (n_facets, k) in VTK's order, turned outward.
    degree : int or None
        Degree of the quadrature; that of the kind where not given.
    """
    check_nodes(facets, len(points), "facet")
    kind = facet_kind(facets.shape[1])
    X, W = get_quadrature(kind.element.refdom, kind.degree if degree is None else degree)
    values, gradients = kind.shape(X)
    nodes = points[facets]
    tangents = np.einsum("qkn,fni->fqki", gradients, nodes)
    vectors = np.cross(tangents[:, :, 0], tangents[:, :, 1])
    lengths = np.linalg.norm(vectors, axis=2)
    return FacetPoints(
        values,
        np.einsum("qn,fni->fqi", values, nodes),
        vectors / lengths[:, :, None],
        lengths * W,
    )


def face_weights(points: Floats, facets: Ints, n_nodes: int, degree: int | None = None) -> Floats:
    """Integrals of the shape functions over facets; (n_nodes,) [m^2].

    Parameters
    ----------
    points, facets, degree : Floats, Ints, int or None
        Arguments of `facet_points`.
    n_nodes : int
        Length of the result.
    """
    at = facet_points(points, facets, degree)
    weights = np.zeros(n_nodes)
    np.add.at(weights, facets, at.areas @ at.values)
    return weights


def volume_weights(points: Floats, cells: Ints, n_nodes: int) -> Floats:
    """Integrals of the shape functions over elements of any kind; (n_nodes,) [m^3].

    Parameters
    ----------
    points : Floats
        Node coordinates (n, 3) [m].
    cells : Ints
        (n_cells, k) node numbers in VTK's order.
    n_nodes : int
        Length of the result.
    """
    check_nodes(cells, len(points))
    kind = element_kind(cells.shape[1])
    X, W = get_quadrature(kind.element.refdom, kind.degree)
    values, gradients = kind.shape(X)
    weights = np.zeros(n_nodes)
    for chunk in chunks(len(cells)):
        determinant = jacobian(points, cells[chunk], gradients)[1]
        np.add.at(weights, cells[chunk], (np.abs(determinant) * W) @ values)
    return weights
