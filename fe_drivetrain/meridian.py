"""Meshes of a shaft's meridian: elements of any order in the half plane of x and radius.

Without fillets quadrilaterals, each split again and again towards the sharp corners of the outline,
where stress is singular; with fillets curved triangles, isoparametric, all nodes of a fillet on its
arc.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from fe_drivetrain.elasticity import Floats, Ints
from fe_drivetrain.errors import InputError
from fe_drivetrain.geometry import Shaft
from fe_drivetrain.geometry.meridian import HIGHEST_ORDER, meridian_triangles, outline
from fe_drivetrain.hexahedra import SAME_LENGTH, shaft_quadrilaterals

Where = Callable[[Floats, Floats], NDArray[np.bool_]]
"""Of x and radius [m], any shape: whether a place is meant."""

HIGHEST_QUADRILATERAL = 12

Place = tuple[float, float]


@dataclass(frozen=True)
class Element:
    """A Lagrange element on the unit square or the unit triangle.

    Attributes
    ----------
    corners
        4 or 3.
    order
        Of its polynomials: in each direction of a square, complete of a triangle.
    places
        (m, 2) reference places of its nodes, corners first, anticlockwise.
    values, gradients
        (q, m) and (q, 2, m) shape functions at the quadrature points.
    points, weights
        (q, 2) and (q,) quadrature.
    """

    corners: int
    order: int
    places: Floats
    values: Floats
    gradients: Floats
    points: Floats
    weights: Floats

    def at(self, places: Floats) -> tuple[Floats, Floats]:
        """Shape functions (q, m) and their gradients (q, 2, m) at reference places (q, 2)."""
        return _shapes(self.corners, self.order, self.places, places)

    def side_places(self, side: int, along: Floats) -> Floats:
        """(q, 2) reference places on a side, from its first corner (0) to its second (1)."""
        a, b = self.places[side], self.places[(side + 1) % self.corners]
        return np.asarray(a + np.asarray(along)[:, None] * (b - a))


@dataclass(frozen=True)
class Meridian:
    """A mesh of the half plane of x and radius.

    Attributes
    ----------
    nodes
        (n, 2) x and radius [m].
    cells
        (ne, m) node ids, in the order of the element's places.
    element
        The element.
    """

    nodes: Floats
    cells: Ints
    element: Element

    def where(self, here: Where) -> Ints:
        """Nodes at the places meant, ascending."""
        return np.flatnonzero(here(*self.nodes.T))

    @property
    def boundary(self) -> Ints:
        """(k, 2) cell and side of every side that belongs to one cell only."""
        k = self.element.corners
        ends = np.stack([self.cells[:, :k], np.roll(self.cells[:, :k], -1, axis=1)], axis=-1)
        pairs = np.sort(ends.reshape(-1, 2), axis=1)
        _, first, count = np.unique(pairs, axis=0, return_index=True, return_counts=True)
        return np.column_stack(np.divmod(np.sort(first[count == 1]), k))

    def sides(self, here: Where) -> Ints:
        """(k, 2) cell and side of the boundary's sides whose both ends and middle are meant."""
        sides = self.boundary
        inside = np.ones(len(sides), dtype=bool)
        for side in range(self.element.corners):
            of = sides[:, 1] == side
            values, _ = self.element.at(self.element.side_places(side, np.array([0.0, 0.5, 1.0])))
            at = np.einsum("qm,emi->eqi", values, self.nodes[self.cells[sides[of, 0]]])
            inside[of] = here(at[..., 0], at[..., 1]).all(axis=1)
        return np.asarray(sides[inside])


def meridian(
    shaft: Shaft,
    size: float | None = None,
    *,
    order: int | None = None,
    layers: int = 4,
    per_fillet: int = 6,
    corners: Sequence[Place] = (),
) -> Meridian:
    """Mesh the meridian of a shaft.

    Parameters
    ----------
    shaft
        Any: solid or bored, stepped, tapered, with a flange or fillets or without.
    size
        Largest edge length [m]; a third of the largest diameter where not given.
    order
        Of the elements: 2 to 12 of quadrilaterals, 2 to 6 of triangles; 6 where not given, and 4
        where the shaft has fillets.
    layers
        Of ever smaller elements, each at 0.15 of the one before, at every re-entrant corner of the
        outline and at the corners of its ends.
    per_fillet
        Elements along each fillet.
    corners
        x and radius [m] of more places on the outline, at corners of the sections, towards which
        elements are graded: ends of a seat. On a shaft with fillets they are not.

    Raises
    ------
    InputError
        A setting is out of its range.
    """
    widest = max(max(p.outer_diameter, p.end_diameter) for p in shaft.pieces)
    size = widest / 3 if size is None else size
    filleted = any(piece.fillet > 0 for piece in shaft.pieces)
    highest = HIGHEST_ORDER if filleted else HIGHEST_QUADRILATERAL
    order = (4 if filleted else 6) if order is None else order
    for name, value, right, allowed in (
        ("size", size, 0 < size < math.inf, "greater than 0"),
        ("order", order, 2 <= order <= highest, f"between 2 and {highest}"),
        ("layers", layers, 0 <= layers <= 40, "between 0 and 40"),
    ):
        if not right:
            raise InputError(f"meridian: {name} is {value:g} but must be {allowed}: change it")
    if filleted:
        thinnest = min(
            (min(p.outer_diameter, p.end_diameter) - p.inner_diameter) / 2 for p in shaft.pieces
        )
        corner = min(size, thinnest / 2) * RATIO ** min(layers, 4)
        nodes, cells, places = meridian_triangles(shaft, size, order, per_fillet, corner)
        return _checked(Meridian(_on_axis(nodes), cells, _element(3, order, places.tobytes())))
    nodes, quads = shaft_quadrilaterals(shaft, size)
    ends = quads[:, ::2, ::2]
    cells = ends[:, [0, 1, 1, 0], [0, 0, 1, 1]]
    used, local = np.unique(cells, return_inverse=True)
    nodes, cells = nodes[used], local.reshape(-1, 4)
    if layers:
        sharp = [(x, r) for x, r in _sharp_corners(shaft).tolist()]
        more = [c for c in corners if all(math.dist(c, s) > SAME_LENGTH for s in sharp)]
        nodes, cells = _graded(nodes, cells, np.array(sharp + more), layers)
    return _raised(_on_axis(nodes), cells, order)


RATIO = 0.15
"""Of an element at a sharp corner to the one that it was split from."""


def _sharp_corners(shaft: Shaft) -> Floats:
    """(k, 2) corners where stress is singular: re-entrant ones, and those of the rigid ends."""
    at = np.array([segment.start for segment in outline(shaft)])
    before, after = at - np.roll(at, 1, axis=0), np.roll(at, -1, axis=0) - at
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    bend = cross / (np.hypot(*before.T) * np.hypot(*after.T))
    end = np.abs(at[:, :1] - [shaft.front, shaft.rear]).min(axis=1) < SAME_LENGTH
    return np.asarray(at[(at[:, 1] > SAME_LENGTH) & ((bend < -1e-6) | (end & (bend > 1e-6)))])


def _graded(nodes: Floats, cells: Ints, corners: Floats, layers: int) -> tuple[Floats, Ints]:
    """Split the quadrilaterals at each corner into a small one there and two around it.

    Every quadrilateral at a corner is split at the same share of its two edges there, and on no
    other edge, so that neighbours still match.
    """
    at: list[Place] = [(x, r) for x, r in nodes.tolist()]
    quads: list[tuple[int, ...]] = [tuple(cell) for cell in cells.tolist()]
    for corner in corners:
        centre = int(np.hypot(*(nodes - corner).T).argmin())
        fan = [q for q in quads if centre in q]
        quads = [q for q in quads if centre not in q]
        for _ in range(layers):
            on_edge: dict[int, int] = {}
            inner: list[tuple[int, ...]] = []
            for quad in fan:
                k = quad.index(centre)
                _, b, c, d = quad[k:] + quad[:k]
                small = []
                for end in (b, d):
                    if end not in on_edge:
                        on_edge[end] = len(at)
                        at.append(_between(at[centre], at[end]))
                    small.append(on_edge[end])
                middle = len(at)
                at.append(_inside(*(at[i] for i in (centre, b, c, d))))
                inner.append((centre, small[0], middle, small[1]))
                quads += [(small[0], b, c, middle), (middle, c, d, small[1])]
            fan = inner
        quads += fan
    return np.array(at), np.array(quads, dtype=np.int64)


def _between(a: Place, b: Place) -> Place:
    return a[0] + RATIO * (b[0] - a[0]), a[1] + RATIO * (b[1] - a[1])


def _inside(a: Place, b: Place, c: Place, d: Place) -> Place:
    """The bilinear place of a quadrilateral at the same share of both edges from its first."""
    s = RATIO
    weights = ((1 - s) ** 2, s * (1 - s), s * s, s * (1 - s))
    x, r = (sum(w * at[i] for w, at in zip(weights, (a, b, c, d), strict=True)) for i in (0, 1))
    return x, r


def _on_axis(nodes: Floats) -> Floats:
    nodes = nodes.copy()
    nodes[np.abs(nodes[:, 1]) < SAME_LENGTH, 1] = 0.0
    return nodes


def _raised(nodes: Floats, quads: Ints, order: int) -> Meridian:
    """Nodes of higher order on straight-sided quadrilaterals, numbered alike by neighbours."""
    element = _element(4, order)
    inner = order - 1
    ends = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    ordered = np.sort(ends, axis=1)
    _, edge = np.unique(ordered[:, 0] * len(nodes) + ordered[:, 1], return_inverse=True)
    along = np.arange(inner)
    on_edge = len(nodes) + edge.reshape(-1, 1) * inner + along
    backwards = ends[:, 0] > ends[:, 1]
    on_edge[backwards] = on_edge[backwards, ::-1]
    first = len(nodes) + (edge.max() + 1) * inner
    inside = first + np.arange(len(quads) * inner**2).reshape(len(quads), -1)
    cells = np.hstack([quads, on_edge.reshape(len(quads), -1), inside])
    s, t = element.places.T
    bilinear = np.column_stack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])
    places = np.empty((first + inside.size, 2))
    places[cells] = np.einsum("mk,eki->emi", bilinear, nodes[quads])
    places[: len(nodes)] = nodes
    return _checked(Meridian(places, cells, element))


def _checked(mesh: Meridian) -> Meridian:
    """The mesh, none of whose elements is inside out."""
    gradients = mesh.element.gradients
    J = gradients.reshape(-1, gradients.shape[2]) @ mesh.nodes[mesh.cells]
    (xs, rs), (xt, rt) = np.moveaxis(J.reshape(len(mesh.cells), -1, 2, 2), (2, 3), (0, 1))
    if (xs * rt <= rs * xt).any():
        raise InputError(
            "meridian: an element folds over: give a smaller size, or more elements per fillet"
        )
    return mesh


@cache
def _element(corners: int, order: int, places: bytes = b"") -> Element:
    """The element; of a triangle the places of its nodes, as the mesher has them."""
    nodes = np.frombuffer(places).reshape(-1, 2).copy() if places else _square(order)
    u, w = legendre.leggauss(order + 2)
    u, w = (u + 1.0) / 2.0, w / 2.0
    s, t = (a.ravel() for a in np.meshgrid(u, u, indexing="ij"))
    weights = np.outer(w, w).ravel()
    if corners == 3:  # the square with one side drawn together
        s, weights = s * (1.0 - t), weights * (1.0 - t)
    points = np.column_stack([s, t])
    values, gradients = _shapes(corners, order, nodes, points)
    return Element(corners, order, nodes, values, gradients, points, weights)


def _square(order: int) -> Floats:
    """Gauss-Lobatto places on the unit square: corners, sides anticlockwise, inside."""
    roots = legendre.Legendre.basis(order).deriv().roots()
    u = (np.sort(roots.real) + 1.0) / 2.0
    zero, one = np.zeros_like(u), np.ones_like(u)
    sides = [(u, zero), (one, u), (u[::-1], one), (zero, u[::-1])]
    corners = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    inside = np.array([(s, t) for s in u for t in u]).reshape(-1, 2)
    return np.vstack([corners, *(np.column_stack(side) for side in sides), inside])


def _shapes(corners: int, order: int, nodes: Floats, at: Floats) -> tuple[Floats, Floats]:
    """Shape functions (q, m) of the nodes and gradients (q, 2, m): products of Legendre's."""
    inverse = np.linalg.inv(_polynomials(corners, order, nodes)[0])
    values, ds, dt = _polynomials(corners, order, at)
    return values @ inverse, np.stack([ds @ inverse, dt @ inverse], axis=1)


def _polynomials(corners: int, order: int, at: Floats) -> tuple[Floats, Floats, Floats]:
    s, t = 2.0 * at.T - 1.0
    derivative = np.array(
        [np.append(legendre.legder(row), 0.0)[: order + 1] for row in np.eye(order + 1)]
    )
    P, Q = legendre.legvander(s, order), legendre.legvander(t, order)
    dP, dQ = 2.0 * P @ derivative.T, 2.0 * Q @ derivative.T
    i, j = (a.ravel() for a in np.indices((order + 1, order + 1)))
    if corners == 3:
        i, j = i[i + j <= order], j[i + j <= order]
    return P[:, i] * Q[:, j], dP[:, i] * Q[:, j], P[:, i] * dQ[:, j]
