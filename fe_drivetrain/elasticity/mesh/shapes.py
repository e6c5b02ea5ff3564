"""Element kinds: nodes, shape functions and quadrature of tetrahedra and hexahedra."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from skfem import (
    ElementHex1,
    ElementHex2,
    ElementHexS2,
    ElementTetP1,
    ElementTetP2,
)
from skfem.element import Element
from skfem.quadrature import get_quadrature

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError

#: Corners of a tetrahedron's edges, whose middles are local nodes 4 to 9 in VTK's order.
TETRAHEDRON_EDGES = np.array([(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)])

# VTK's hexahedron on the unit cube: corners, then mid-sides of the edges, faces (the mean of these
# four corners) and the centre.
_HEX_CORNERS = np.array(
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
)
HEXAHEDRON_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
HEXAHEDRON_EDGES += [(0, 4), (1, 5), (2, 6), (3, 7)]
HEXAHEDRON_FACES = [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2)]
HEXAHEDRON_FACES += [(0, 3, 2, 1), (4, 5, 6, 7)]
_HEX_MEANS = [*HEXAHEDRON_EDGES, *HEXAHEDRON_FACES, tuple(range(8))]


@dataclass(frozen=True)
class Nodal:
    """A scalar Lagrange element of scikit-fem, with its nodes in VTK's order.

    Attributes
    ----------
    element : Element
        scikit-fem's.
    order : Ints
        scikit-fem's number of each of VTK's nodes.
    """

    element: Element
    order: Ints

    @property
    def places(self) -> Floats:
        """(n_nodes, dim) reference coordinates of the nodes."""
        return np.asarray(self.element.doflocs[self.order], dtype=float)

    def shape(self, at: Floats) -> tuple[Floats, Floats]:
        """Shape functions (n_q, n_nodes) and their reference gradients (n_q, dim, n_nodes).

        Parameters
        ----------
        at : Floats
            (dim, n_q) reference coordinates.
        """
        values, gradients = shape_functions(self.element, at)
        return values[:, self.order], gradients[:, :, self.order]


@dataclass(frozen=True)
class ElementKind(Nodal):
    """An element of a solid, known by its number of nodes.

    Attributes
    ----------
    name : str
        Name, as meshio and VTK have it.
    corner : Element
        Linear element on the same corners.
    degree : int
        Degree of the quadrature when the element is curved: two Gauss points a direction for
        linear, three for quadratic hexahedra; for tetrahedra what scikit-fem takes.
    """

    name: str
    corner: Element
    degree: int

    @property
    def n_corners(self) -> int:
        """4 or 8."""
        return int(self.corner.doflocs.shape[0])

    def corner_weights(self) -> Floats:
        """(n_nodes, n_corners): the linear shape functions at the nodes."""
        return element_kind(self.n_corners).shape(self.places.T)[0]

    def table(self, degree: int) -> tuple[Floats, Floats]:
        """Reference gradients (n_q, 3, n_nodes), nodes in VTK's order, and weights (n_q,)."""
        X, W = get_quadrature(self.element.refdom, degree)
        return np.ascontiguousarray(self.shape(X)[1]), W


ELEMENT_NAMES: Mapping[int, str] = {
    4: "tetrahedra of 4 nodes",
    10: "tetrahedra of 10 nodes",
    8: "hexahedra of 8 nodes",
    20: "hexahedra of 20 nodes",
    27: "hexahedra of 27 nodes",
}
"""Elements in words, by the number of their nodes."""


@cache
def element_kind(n_nodes: int) -> ElementKind:
    """Element with that number of nodes: tetrahedra with 4 and 10, hexahedra with 8, 20 and 27.

    Raises
    ------
    InputError
        There is none.
    """
    if n_nodes in (4, 10):
        element = ElementTetP1() if n_nodes == 4 else ElementTetP2()
        name = "tetra" if n_nodes == 4 else "tetra10"
        return ElementKind(element, np.arange(n_nodes), name, ElementTetP1(), 2 * (n_nodes > 4) + 2)
    elements = {8: ElementHex1, 20: ElementHexS2, 27: ElementHex2}
    if n_nodes not in elements:
        raise InputError(
            f"no element has {n_nodes} nodes: use tetrahedra of 4 or 10, or hexahedra of 8, 20 or "
            "27 nodes"
        )
    element = elements[n_nodes]()
    means = np.array([_HEX_CORNERS[list(corners)].mean(axis=0) for corners in _HEX_MEANS])
    positions = np.vstack([_HEX_CORNERS, means])[:n_nodes]
    distance = np.abs(positions[:, None] - element.doflocs[None]).max(axis=2)
    name = "hexahedron" if n_nodes == 8 else f"hexahedron{n_nodes}"
    degree = 3 if n_nodes == 8 else 4
    return ElementKind(element, distance.argmin(axis=1), name, ElementHex1(), degree)


def shape_functions(element: Element, points: Floats) -> tuple[Floats, Floats]:
    """Values and reference gradients of an element's shape functions.

    Parameters
    ----------
    element : Element
        A scalar Lagrange element of scikit-fem.
    points : Floats
        (dim, n_q) reference coordinates.

    Returns
    -------
    values, gradients
        (n_q, n_nodes) and (n_q, dim, n_nodes).
    """
    tables = [element.lbasis(points, node) for node in range(element.doflocs.shape[0])]
    values = np.stack([np.broadcast_to(value, points.shape[1]) for value, _ in tables], axis=-1)
    gradients = np.stack([gradient for _, gradient in tables], axis=-1).transpose(1, 0, 2)
    return values, gradients
