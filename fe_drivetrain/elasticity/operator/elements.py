"""Elements are sound before they are integrated: their nodes exist, and none is folded over."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray
from skfem.quadrature import get_quadrature

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import njit
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.measures import CUBIC
from fe_drivetrain.elasticity.mesh.numbering import check_nodes
from fe_drivetrain.elasticity.mesh.shapes import TETRAHEDRON_EDGES, element_kind

# Negative determinant, over the maximum in the cell, up to which it is round-off.
_ROUND_OFF = 1e-12


def check_elements(points: Floats, cells: Ints) -> None:
    """Refuse elements that cannot be integrated.

    Parameters
    ----------
    points : Floats
        Node coordinates (n, 3) [m].
    cells : Ints
        (n_cells, k) node numbers in VTK's order.

    Raises
    ------
    InputError
        A node does not exist or has no position, or a cell is folded over, turned inside out or
        flat: its Jacobian is not positive at each of its nodes, of the points of its quadrature,
        and of tetrahedra of ten nodes of those that determine it.
    """
    check_nodes(cells, len(points))
    if not np.isfinite(points).all():
        node = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
        raise InputError(
            f"node {node} is at {_place(points[node])} but must have a position: correct its "
            "coordinates"
        )
    gradients, edges = _table(cells.shape[1])
    # made out here: NumPy's functions in a compiled loop would take a second to compile
    least, folded = np.empty(len(cells)), np.empty(len(cells), dtype=np.bool_)
    _find_folded(
        np.ascontiguousarray(points, dtype=float),
        np.ascontiguousarray(cells, dtype=np.int32),
        gradients,
        edges,
        np.empty((3, 3)),
        np.empty((cells.shape[1], 3)),
        folded,
        least,
    )
    if folded.any():
        cell = int(np.flatnonzero(folded)[0])
        count = int(np.count_nonzero(folded))
        others = f" (and {count - 1} more cells)" if count > 1 else ""
        raise InputError(
            f"cell {cell} near {_place(points[cells[cell]].mean(axis=0))} is folded over, flat or "
            f"turned inside out{others}: its Jacobian falls to {least[cell]:.2g} m^3 but must be "
            "greater than 0 everywhere: move its nodes, or number them in VTK's order"
        )


def _place(point: Floats) -> str:
    return f"({', '.join(f'{x:.3g}' for x in point)}) m"


@cache
def _table(n_nodes: int) -> tuple[Floats, NDArray[np.int64]]:
    """Gradients (n_q, 3, k) where the Jacobian is taken, and edges (6, 2) if they may be straight.

    An element of straight edges needs the first point alone.
    """
    kind = element_kind(n_nodes)
    if kind.n_corners == 4:
        at = CUBIC[:, 1:].T if n_nodes == 10 else np.full((3, 1), 0.25)
        edges = TETRAHEDRON_EDGES if n_nodes == 10 else np.zeros((0, 2))
    else:
        at = np.hstack([kind.places.T, get_quadrature(kind.element.refdom, kind.degree)[0]])
        edges = np.zeros((0, 2))
    return np.ascontiguousarray(kind.shape(at)[1]), np.ascontiguousarray(edges, dtype=np.int64)


@njit(cache=True)
def _find_folded(
    points: Floats,
    cells: NDArray[np.int32],
    gradients: Floats,
    edges: NDArray[np.int64],
    J: Floats,
    nodes: Floats,
    folded: NDArray[np.bool_],
    least: Floats,
) -> None:
    """Whether each cell folds over, and the minimum determinant of its Jacobian J (3, 3)."""
    n_cells, k = cells.shape
    for c in range(n_cells):
        for a in range(k):
            for i in range(3):
                nodes[a, i] = points[cells[c, a], i]
        n_points = len(gradients)
        if len(edges):
            sagitta = length = 0.0
            for e in range(len(edges)):
                for i in range(3):
                    a, b = nodes[edges[e, 0], i], nodes[edges[e, 1], i]
                    sagitta = max(sagitta, abs(nodes[4 + e, i] - 0.5 * (a + b)))
                    length = max(length, abs(a - b))
            if sagitta <= 1e-12 * length:
                n_points = 1
        low, high = np.inf, 0.0
        for q in range(n_points):
            for p in range(3):
                for i in range(3):
                    J[p, i] = 0.0
                for a in range(k):
                    g = gradients[q, p, a]
                    for i in range(3):
                        J[p, i] += g * nodes[a, i]
            det = (
                J[0, 0] * (J[1, 1] * J[2, 2] - J[1, 2] * J[2, 1])
                - J[0, 1] * (J[1, 0] * J[2, 2] - J[1, 2] * J[2, 0])
                + J[0, 2] * (J[1, 0] * J[2, 1] - J[1, 1] * J[2, 0])
            )
            low, high = min(low, det), max(high, abs(det))
        least[c] = low
        folded[c] = not (high > 0.0 and low > -_ROUND_OFF * high)
