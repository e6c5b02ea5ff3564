"""Compiled loops over elements: the sparsity of a stiffness, and its entries.

Compiled by numba at the first call (seconds), then kept in its cache on disk.
"""

import numpy as np
from numba import njit, prange
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.operator.kernels import Index, inverse_transposed

# Rows that a thread takes at once have a marker for each node.
_PIECES = 8


def sparsity(cells: Index, n_nodes: int) -> tuple[Index, Index, Index]:
    """Which nodes share a cell.

    Returns
    -------
    indptr, indices, slots
        Rows of the pattern, sorted; and (n_cells, k, k) where in ``indices`` the pair of local
        nodes (a, b) of each cell stands.
    """
    # NumPy makes the arrays out here: in a compiled loop that takes a second to compile
    n_cells, k = cells.shape
    start, fill = np.zeros(n_nodes + 1, np.int64), np.empty(n_nodes, np.int64)
    where, indptr = np.empty(n_cells * k, np.int64), np.zeros(n_nodes + 1, np.int32)
    _find_cells(cells, start, fill, where)
    markers = np.full((_PIECES, n_nodes), -1, np.int32)
    _count_pairs(cells, start, where, markers, indptr)
    np.cumsum(indptr, out=indptr)
    indices, slots = np.empty(indptr[-1], np.int32), np.empty((n_cells, k, k), np.int32)
    markers[:] = -1
    _place_pairs(cells, start, where, markers, indptr, indices, slots)
    return indptr, indices, slots


@njit(cache=True)
def _find_cells(
    cells: Index, start: NDArray[np.int64], fill: NDArray[np.int64], where: NDArray[np.int64]
) -> None:
    """In ``where``, from its start, each node's places in ``cells``, flat."""
    n_cells, k = cells.shape
    for c in range(n_cells):
        for a in range(k):
            start[cells[c, a] + 1] += 1
    for i in range(len(fill)):
        start[i + 1] += start[i]
        fill[i] = start[i]
    for c in range(n_cells):
        for a in range(k):
            i = cells[c, a]
            where[fill[i]] = c * k + a
            fill[i] += 1


@njit(cache=True, parallel=True)
def _count_pairs(
    cells: Index, start: NDArray[np.int64], where: NDArray[np.int64], markers: Index, counts: Index
) -> None:
    """Number of nodes that share a cell with node i, in ``counts[i + 1]``."""
    k, n = cells.shape[1], len(start) - 1
    for piece in prange(_PIECES):
        seen = markers[piece]
        for i in range(piece * n // _PIECES, (piece + 1) * n // _PIECES):
            count = 0
            for w in range(start[i], start[i + 1]):
                c = where[w] // k
                for b in range(k):
                    j = cells[c, b]
                    if seen[j] != i:
                        seen[j] = i
                        count += 1
            counts[i + 1] = count


@njit(cache=True, parallel=True)
def _place_pairs(
    cells: Index,
    start: NDArray[np.int64],
    where: NDArray[np.int64],
    markers: Index,
    indptr: Index,
    indices: Index,
    slots: Index,
) -> None:
    """Columns of the rows, and where each pair of a cell stands among them."""
    k, n = cells.shape[1], len(start) - 1
    for piece in prange(_PIECES):
        # where a node stands in the row; before this row's first place it stood in another one
        place = markers[piece]
        for i in range(piece * n // _PIECES, (piece + 1) * n // _PIECES):
            first = end = indptr[i]
            for w in range(start[i], start[i + 1]):
                c = where[w] // k
                for b in range(k):
                    j = cells[c, b]
                    if place[j] < first:
                        place[j] = first
                        indices[end] = j
                        end += 1
            # By insertion: rows are short, and NumPy's sort would take a second to compile.
            for p in range(first, end):
                j, q = indices[p], p
                while q > first and indices[q - 1] > j:
                    indices[q] = indices[q - 1]
                    q -= 1
                indices[q] = j
            for p in range(first, end):
                place[indices[p]] = p
            for w in range(start[i], start[i + 1]):
                c = where[w] // k
                a = where[w] - c * k
                for b in range(k):
                    slots[c, a, b] = place[cells[c, b]]


@njit(cache=True)
def _add_pair(H: Floats, lam: float, mu: float, data: Floats, ab: int, ba: int) -> None:
    """Add lam H + mu H^T + mu tr(H) I at (a, b), and its transpose at (b, a)."""
    trace = mu * (H[0, 0] + H[1, 1] + H[2, 2])
    for i in range(3):
        for j in range(3):
            value = lam * H[i, j] + mu * H[j, i]
            if i == j:
                value += trace
            data[ab, i, j] += value
            if ab != ba:
                data[ba, j, i] += value


@njit(cache=True, fastmath=True, nogil=True)
def add_affine(
    points: Floats,
    cells: Index,
    chosen: NDArray[np.int64],
    reference: Floats,
    lam: float,
    mu: float,
    slots: Index,
    data: Floats,
) -> None:
    """Add the stiffness of tetrahedra with straight edges: one reference tensor for all.

    Parameters
    ----------
    chosen : NDArray[np.int64]
        Which cells.
    reference : Floats
        (k, k, 3, 3) integrals of dN_a/dxi_p dN_b/dxi_q over the reference element.
    lam, mu : float
        Lame's constants [Pa].
    slots, data : Index, Floats
        From `sparsity`, and the blocks to add to.
    """
    k = cells.shape[1]
    J, A, M, H = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for e in chosen:
        for i in range(3):
            origin = points[cells[e, 0], i]
            for p in range(3):
                J[i, p] = points[cells[e, p + 1], i] - origin
        size = abs(inverse_transposed(J, A))
        for a in range(k):
            for b in range(a, k):
                R = reference[a, b]
                for i in range(3):
                    for q in range(3):
                        M[i, q] = size * (A[i, 0] * R[0, q] + A[i, 1] * R[1, q] + A[i, 2] * R[2, q])
                for i in range(3):
                    for j in range(3):
                        H[i, j] = M[i, 0] * A[j, 0] + M[i, 1] * A[j, 1] + M[i, 2] * A[j, 2]
                _add_pair(H, lam, mu, data, slots[e, a, b], slots[e, b, a])


@njit(cache=True, fastmath=True, nogil=True)
def add_curved(
    points: Floats,
    cells: Index,
    chosen: NDArray[np.int64],
    gradients: Floats,
    weights: Floats,
    lam: float,
    mu: float,
    slots: Index,
    data: Floats,
) -> None:
    """Add the stiffness of isoparametric elements of any kind, by quadrature.

    Parameters
    ----------
    chosen : NDArray[np.int64]
        Which cells.
    gradients, weights : Floats
        (n_q, 3, k) reference gradients and (n_q,) weights of the rule.
    lam, mu : float
        Lame's constants [Pa].
    slots, data : Index, Floats
        From `sparsity`, and the blocks to add to.
    """
    k, n_q = cells.shape[1], len(weights)
    J, A, H = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    G, WG = np.empty((k, 3, n_q)), np.empty((k, 3, n_q))
    for e in chosen:
        for q in range(n_q):
            J[:] = 0.0
            for a in range(k):
                for i in range(3):
                    x = points[cells[e, a], i]
                    for p in range(3):
                        J[i, p] += x * gradients[q, p, a]
            size = abs(inverse_transposed(J, A)) * weights[q]
            for a in range(k):
                for i in range(3):
                    g = 0.0
                    for p in range(3):
                        g += A[i, p] * gradients[q, p, a]
                    G[a, i, q] = g
                    WG[a, i, q] = size * g
        for a in range(k):
            for b in range(a, k):
                for i in range(3):
                    for j in range(3):
                        h = 0.0
                        for q in range(n_q):
                            h += WG[a, i, q] * G[b, j, q]
                        H[i, j] = h
                _add_pair(H, lam, mu, data, slots[e, a, b], slots[e, b, a])
