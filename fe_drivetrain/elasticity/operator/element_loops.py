"""Compiled loops over elements: the sparsity of a stiffness, and its entries.

Compiled by numba at the first call (seconds), then kept in its cache on disk.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import numpy as np
from numba import get_num_threads
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.compiled import njit
from fe_drivetrain.elasticity.mesh.shapes import TETRAHEDRON_EDGES
from fe_drivetrain.elasticity.operator.kernels import Index, inverse_transposed
from fe_drivetrain.elasticity.operator.vectors import (
    LANES,
    block_of,
    fetch,
    identity,
    load,
    plus,
    store,
    times,
    transposed,
)

# Rows that a thread takes at once have a marker for each node.
_PIECES = 8

# A place in a cell and the cell are one number; no element has as many nodes. To divide by the
# number of nodes would take as long as all else.
_PLACES = 32

#: An edge node this close to the middle of its edge, per length of the edge, is on it.
_STRAIGHT = 2e-13


def is_straight(points: Floats, cells: Index | Ints) -> Bools:
    """Which ten-node tetrahedra have only straight edges, and so an affine map; (n_cells,)."""
    found = np.empty(len(cells), dtype=np.bool_)
    nodes = np.ascontiguousarray(cells, dtype=np.int32)
    _find_straight(points, nodes, TETRAHEDRON_EDGES, found)
    return found


@njit(cache=True)
def _find_straight(points: Floats, cells: Index, edges: NDArray[np.int64], found: Bools) -> None:
    for e in range(len(cells)):  # so little to do that threads would take longer to compile
        found[e] = True
        for edge in range(len(edges)):
            length = off = 0.0
            a, b = cells[e, edges[edge, 0]], cells[e, edges[edge, 1]]
            for i in range(3):
                one, other = points[a, i], points[b, i]
                length += (other - one) ** 2
                off += (points[cells[e, 4 + edge], i] - 0.5 * (one + other)) ** 2
            if off > _STRAIGHT**2 * length:
                found[e] = False


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
    seen, following = np.empty((2, _PIECES, n_nodes), np.int32)
    seen[:], following[:] = -1, 0
    in_pieces(_PIECES, _count_pairs, cells, start, where, seen, following)
    np.cumsum(following.sum(axis=0), out=indptr[1:])
    # in each row the columns of a piece come behind those of the pieces before it
    following[:] = indptr[:-1] + np.cumsum(following, axis=0, dtype=np.int32) - following
    indices, slots = np.empty(indptr[-1], np.int32), np.empty((n_cells, k, k), np.int32)
    seen[:] = -1
    in_pieces(_PIECES, _place_pairs, cells, start, where, seen, following, indices, slots)
    return indptr, indices, slots


def in_pieces(count: int, loop: Callable[..., None], *arrays: Any) -> None:
    """Call a loop that lets go of Python's lock for each piece of the rows, in as many threads.

    A loop that numba shares out among threads takes twice as long to compile.

    Parameters
    ----------
    count : int
        Pieces.
    loop : callable
        Takes the number of the piece, and the arrays.
    *arrays : Any
        Arrays of which each piece writes its own rows.
    """
    with ThreadPoolExecutor(get_num_threads()) as pool:
        for piece in [pool.submit(loop, piece, *arrays) for piece in range(count)]:
            piece.result()


@njit(cache=True)
def _find_cells(
    cells: Index, start: NDArray[np.int64], fill: NDArray[np.int64], where: NDArray[np.int64]
) -> None:
    """In ``where``, from its start, each node's places: a cell times `_PLACES`, and that in it."""
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
            where[fill[i]] = c * _PLACES + a
            fill[i] += 1


@njit(cache=True, nogil=True)
def _count_pairs(
    piece: int,
    cells: Index,
    start: NDArray[np.int64],
    where: NDArray[np.int64],
    seen: Index,
    counts: Index,
) -> None:
    """Number of nodes of a piece that share a cell with node i, in ``counts[piece, i]``."""
    k, n = cells.shape[1], len(start) - 1
    last, count = seen[piece], counts[piece]
    for j in range(piece * n // _PIECES, (piece + 1) * n // _PIECES):
        for w in range(start[j], start[j + 1]):
            c = np.uint64(where[w]) // np.uint64(_PLACES)
            for a in range(k):
                i = np.uint64(cells[c, np.uint64(a)])
                if last[i] != j:
                    last[i] = j
                    count[i] += 1


@njit(cache=True, nogil=True)
def _place_pairs(
    piece: int,
    cells: Index,
    start: NDArray[np.int64],
    where: NDArray[np.int64],
    seen: Index,
    following: Index,
    indices: Index,
    slots: Index,
) -> None:
    """Columns of the rows, and where each pair of a cell stands among them.

    Column by column, so that rows come to be sorted; ``following`` is where the next column of a
    piece stands in each row.
    """
    k, n = cells.shape[1], len(start) - 1
    last, end = seen[piece], following[piece]
    for j in range(piece * n // _PIECES, (piece + 1) * n // _PIECES):
        for w in range(start[j], start[j + 1]):
            c = np.uint64(where[w]) // np.uint64(_PLACES)
            b = np.uint64(where[w]) % np.uint64(_PLACES)
            for a in range(k):
                i = np.uint64(cells[c, np.uint64(a)])
                if last[i] != j:
                    last[i] = j
                    indices[np.uint64(end[i])] = j
                    end[i] += 1
                slots[c, np.uint64(a), b] = end[i] - 1


@njit(inline="always")
def _add_pair(
    S: Floats, b: int, width: int, lam: float, mu: float, data: Floats, ab: int, ba: int
) -> None:
    """Add lam H + mu H^T + mu tr(H) I at (a, b), and its transpose at (b, a).

    H is column b of a's three rows in S; indices cannot be negative.
    """
    wide, first, two, last = np.uint64(width), np.uint64(3 * b), np.uint64(2), np.uint64(LANES)
    t, back = np.uint64(9 * ab), np.uint64(9 * ba)
    H = block_of(load(S, first), load(S, wide + first), load(S, two * wide + first))
    corner = S[two * wide + first + two]
    trace = mu * (S[first] + S[wide + first + np.uint64(1)] + corner)
    block = plus(plus(times(lam, H), mu, transposed(H)), trace, identity())
    corner = (lam + mu) * corner + trace
    store(plus(block, 1.0, load(data, t)), data, t)
    data[t + last] += corner
    if ab != ba:
        store(plus(transposed(block), 1.0, load(data, back)), data, back)
        data[back + last] += corner


def add_elements(
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
        Numbers of the cells.
    gradients, weights : Floats
        (n_q, 3, k) reference gradients and (n_q,) weights of the rule.
    lam, mu : float
        Lame's constants [Pa].
    slots, data : Index, Floats
        Slots from `sparsity`, and the blocks to add to.
    """
    n_q, _, k = gradients.shape
    # rows are read eight numbers at once, beyond the last one, too
    width = 3 * k + LANES
    room = _Room(np.zeros(n_q * width), np.empty(n_q * 3 * k), np.empty(3 * width))
    rule = _Rule(gradients, weights)
    _add_elements(points, cells, chosen, rule, lam, mu, slots, room, data.reshape(-1))


class _Rule(NamedTuple):
    """Reference gradients (n_q, 3, k) and weights (n_q,) of a quadrature rule."""

    gradients: Floats
    weights: Floats


class _Room(NamedTuple):
    """Room for one element: gradients, those times their weight, integrals of their products."""

    gradients: Floats
    weighted: Floats
    products: Floats


@njit(cache=True, fastmath=True, nogil=True)
def _add_elements(
    points: Floats,
    cells: Index,
    chosen: NDArray[np.int64],
    rule: _Rule,
    lam: float,
    mu: float,
    slots: Index,
    room: _Room,
    data: Floats,
) -> None:
    gradients, weights = rule
    G, W, S = room
    k, n_q = cells.shape[1], len(weights)
    rows, width = 3 * k, 3 * k + LANES
    J, A = np.empty((3, 3)), np.empty((3, 3))
    for e in chosen:
        for a in range(k):  # blocks come while gradients are multiplied
            for b in range(k):
                fetch(data, 9 * slots[e, a, b])
                fetch(data, 9 * slots[e, a, b] + 8)
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
                    G[q * width + 3 * a + i] = g
                    W[q * rows + 3 * a + i] = size * g
        for a in range(k):
            for c in range(3 * a, rows, LANES):
                v = load(G, c)
                f, g, h = times(W[3 * a], v), times(W[3 * a + 1], v), times(W[3 * a + 2], v)
                for q in range(1, n_q):
                    v = load(G, q * width + c)
                    r = q * rows + 3 * a
                    f, g, h = plus(f, W[r], v), plus(g, W[r + 1], v), plus(h, W[r + 2], v)
                store(f, S, c)
                store(g, S, width + c)
                store(h, S, 2 * width + c)
            for b in range(a, k):
                _add_pair(S, b, width, lam, mu, data, slots[e, a, b], slots[e, b, a])
