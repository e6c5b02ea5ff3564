"""Lagrange elements of any order on the unit square and triangle: shapes and quadrature."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import legendre

from fe_drivetrain.common.arrays import Floats


@dataclass(frozen=True)
class Element:
    """A Lagrange element on the unit square or the unit triangle.

    Attributes
    ----------
    corners : int
        Number of corners, 4 or 3.
    order : int
        Order of its polynomials: in each direction of a square, complete of a triangle.
    places : Floats
        Reference places (m, 2) of its nodes, corners first, anticlockwise.
    values, gradients : Floats
        Shape functions (q, m) and their gradients (q, 2, m) at the quadrature points.
    points, weights : Floats
        Quadrature points (q, 2) and weights (q,).
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


@cache
def lagrange_element(corners: int, order: int, places: bytes = b"") -> Element:
    """Element of an order, with the quadrature of its stiffness.

    Parameters
    ----------
    corners : int
        Number of corners, 4 or 3.
    order : int
        Order of its polynomials.
    places : bytes
        Places of a triangle's nodes on the unit triangle, (m, 2) doubles in the order that the
        mesher has; a square's are those of Gauss and Lobatto.

    Returns
    -------
    element : Element
        Element with `order` + 2 points of Gauss in each direction; of a triangle those of a square
        with one side drawn together.
    """
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
    inverse = _to_nodes(corners, order, nodes.tobytes())
    values, ds, dt = _polynomials(corners, order, at)
    return values @ inverse, np.stack([ds @ inverse, dt @ inverse], axis=1)


@cache
def _to_nodes(corners: int, order: int, nodes: bytes) -> Floats:
    """Polynomials' coefficients (m, m) of the shape functions of nodes, given as bytes."""
    return np.asarray(
        np.linalg.inv(_polynomials(corners, order, np.frombuffer(nodes).reshape(-1, 2))[0])
    )


@cache
def _derivative(order: int) -> Floats:
    """(order + 1, order + 1) a row the derivative of a Legendre polynomial, as such."""
    return np.array(
        [np.append(legendre.legder(row), 0.0)[: order + 1] for row in np.eye(order + 1)]
    )


def _polynomials(corners: int, order: int, at: Floats) -> tuple[Floats, Floats, Floats]:
    s, t = 2.0 * at.T - 1.0
    derivative = _derivative(order)
    P, Q = legendre.legvander(s, order), legendre.legvander(t, order)
    dP, dQ = 2.0 * P @ derivative.T, 2.0 * Q @ derivative.T
    i, j = (a.ravel() for a in np.indices((order + 1, order + 1)))
    if corners == 3:
        i, j = i[i + j <= order], j[i + j <= order]
    return P[:, i] * Q[:, j], dP[:, i] * Q[:, j], P[:, i] * dQ[:, j]
