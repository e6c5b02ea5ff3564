"""Compiled loops over elements and over node blocks: what NumPy cannot say without large copies.

Matrices are block CSR with 3x3 blocks, one block row a node (``indptr``, ``indices``, ``data`` as
in ``scipy.sparse.bsr_array``). Right-hand sides are the columns of C-ordered (n, m) arrays, and
every loop takes all of them in one pass over the matrix. Compiled by numba at the first call
(seconds), then kept in its cache on disk.
"""

import numpy as np
from numba import njit, prange
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Floats

Index = NDArray[np.int32]


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
    where, seen = np.empty(n_cells * k, np.int64), np.full(n_nodes, -1, np.int64)
    indptr = np.zeros(n_nodes + 1, np.int32)
    _count_pairs(cells, start, fill, where, seen, indptr)
    indices, slots = np.empty(indptr[-1], np.int32), np.empty((n_cells, k, k), np.int32)
    seen[:] = -1
    _place_pairs(cells, start, where, seen, np.empty(n_nodes, np.int32), indptr, indices, slots)
    return indptr, indices, slots


@njit(cache=True)
def _count_pairs(
    cells: Index,
    start: NDArray[np.int64],
    fill: NDArray[np.int64],
    where: NDArray[np.int64],
    seen: NDArray[np.int64],
    indptr: Index,
) -> None:
    """Ends of the rows; and in ``where``, from its start, each node's places in ``cells``, flat."""
    n_cells, k = cells.shape
    n_nodes = len(fill)
    for c in range(n_cells):
        for a in range(k):
            start[cells[c, a] + 1] += 1
    for i in range(n_nodes):
        start[i + 1] += start[i]
        fill[i] = start[i]
    for c in range(n_cells):
        for a in range(k):
            i = cells[c, a]
            where[fill[i]] = c * k + a
            fill[i] += 1

    for i in range(n_nodes):
        count = 0
        for w in range(start[i], start[i + 1]):
            for b in range(k):
                j = cells[where[w] // k, b]
                if seen[j] != i:
                    seen[j] = i
                    count += 1
        indptr[i + 1] = indptr[i] + count


@njit(cache=True)
def _place_pairs(
    cells: Index,
    start: NDArray[np.int64],
    where: NDArray[np.int64],
    seen: NDArray[np.int64],
    place: Index,
    indptr: Index,
    indices: Index,
    slots: Index,
) -> None:
    """Columns of the rows, and where each pair of a cell stands among them."""
    k = cells.shape[1]
    for i in range(len(place)):
        end = indptr[i]
        for w in range(start[i], start[i + 1]):
            for b in range(k):
                j = cells[where[w] // k, b]
                if seen[j] != i:
                    seen[j] = i
                    indices[end] = j
                    end += 1
        # By insertion: rows are short, and NumPy's sort would take a second to compile.
        for p in range(indptr[i] + 1, end):
            j, q = indices[p], p
            while q > indptr[i] and indices[q - 1] > j:
                indices[q] = indices[q - 1]
                q -= 1
            indices[q] = j
        for p in range(indptr[i], end):
            place[indices[p]] = p
        for w in range(start[i], start[i + 1]):
            c = where[w] // k
            a = where[w] - c * k
            for b in range(k):
                slots[c, a, b] = place[cells[c, b]]


@njit(cache=True, error_model="numpy")
def _inverse_transposed(J: Floats, A: Floats) -> float:
    """Put J^-T into A, of no numbers where there is none; the determinant of J."""
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        for p in range(3):
            q, r = (p + 1) % 3, (p + 2) % 3
            A[i, p] = J[j, q] * J[k, r] - J[j, r] * J[k, q]
    determinant = J[0, 0] * A[0, 0] + J[0, 1] * A[0, 1] + J[0, 2] * A[0, 2]
    for i in range(3):  # NumPy's quotient of arrays would take half a second to compile
        for p in range(3):
            A[i, p] /= determinant
    return float(determinant)


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
        size = abs(_inverse_transposed(J, A))
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
            size = abs(_inverse_transposed(J, A)) * weights[q]
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


@njit(cache=True)
def distances(indptr: Index, indices: Index, start: int) -> Index:
    """Steps from one node to each other one along the graph of a matrix; -1 where none lead."""
    n = len(indptr) - 1
    steps, queue = np.full(n, -1, np.int32), np.empty(n, np.int32)
    steps[start], queue[0] = 0, start
    first, last = 0, 1
    while first < last:
        i = queue[first]
        first += 1
        for p in range(indptr[i], indptr[i + 1]):
            j = indices[p]
            if steps[j] < 0:
                steps[j] = steps[i] + 1
                queue[last] = j
                last += 1
    return steps


@njit(cache=True)
def places(
    indptr: Index, indices: Index, rows: NDArray[np.int64], columns: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Where the blocks of some rows and columns stand in ``data``; -1 where there are none."""
    found = np.full(len(rows), -1, np.int64)
    for k in range(len(rows)):
        for p in range(indptr[rows[k]], indptr[rows[k] + 1]):
            if indices[p] == columns[k]:
                found[k] = p
    return found


@njit(cache=True)
def invert(blocks: Floats, out: Floats) -> None:
    """Put the inverses of symmetric (n, 3, 3) blocks into ``out``."""
    for i in range(len(blocks)):
        _inverse_transposed(blocks[i], out[i])


@njit(inline="always")
def _node_residual(
    i: int, indptr: Index, indices: Index, data: Floats, x: Floats, b: Floats, columns: int
) -> tuple[Floats, Floats, Floats]:
    """``B - K X`` (m,) of node i in each direction, all arrays flat.

    Copies of their own, so that no compiler fears a part of X. Three rows in one loop over columns
    and indices that cannot be negative: two thirds of the time of a loop for each row.
    """
    f, g, h = np.empty(columns), np.empty(columns), np.empty(columns)
    m, three, nine = np.uint64(columns), np.uint64(3), np.uint64(9)
    t = three * np.uint64(i) * m
    for k in range(m):
        f[k], g[k], h[k] = b[t + k], b[t + m + k], b[t + m + m + k]
    for p in range(np.uint64(indptr[i]), np.uint64(indptr[i + 1])):
        s, q = three * np.uint64(indices[p]) * m, nine * p
        f0, f1, f2 = data[q], data[q + np.uint64(1)], data[q + np.uint64(2)]
        q += three
        g0, g1, g2 = data[q], data[q + np.uint64(1)], data[q + np.uint64(2)]
        q += three
        h0, h1, h2 = data[q], data[q + np.uint64(1)], data[q + np.uint64(2)]
        for k in range(m):
            u, v, w = x[s + k], x[s + m + k], x[s + m + m + k]
            f[k] -= f0 * u + f1 * v + f2 * w
            g[k] -= g0 * u + g1 * v + g2 * w
            h[k] -= h0 * u + h1 * v + h2 * w
    return f, g, h


def residual(
    indptr: Index, indices: Index, data: Floats, X: Floats, B: Floats, out: Floats
) -> None:
    """``out = B - K X``."""
    flat, x, b = data.reshape(-1), X.reshape(-1), B.reshape(-1)
    if X.shape[1] == 1:
        _residual_of_one(indptr, indices, flat, x, b, out.reshape(-1))
    else:
        _residual_of_many(indptr, indices, flat, x, b, out)


@njit(cache=True, parallel=True, fastmath=True)
def _residual_of_many(
    indptr: Index, indices: Index, data: Floats, x: Floats, b: Floats, out: Floats
) -> None:
    m = out.shape[1]
    for i in prange(len(indptr) - 1):
        f, g, h = _node_residual(i, indptr, indices, data, x, b, m)
        for k in range(m):
            out[3 * i, k], out[3 * i + 1, k], out[3 * i + 2, k] = f[k], g[k], h[k]


@njit(inline="always")
def _node_force(
    i: int, indptr: Index, indices: Index, data: Floats, x: Floats
) -> tuple[float, float, float]:
    """``K x`` of node i for one column, all arrays flat.

    Three sums in registers, at indices that cannot be negative: twice as fast as the loop over
    columns. With additions reordered (`fastmath`) it would be slower than that.
    """
    f = g = h = 0.0
    one, two, three = np.uint64(1), np.uint64(2), np.uint64(3)
    for p in range(np.uint64(indptr[i]), np.uint64(indptr[i + 1])):
        c, q = three * np.uint64(indices[p]), np.uint64(9) * p
        u, v, w = x[c], x[c + one], x[c + two]
        f += data[q] * u + data[q + one] * v + data[q + two] * w
        q += three
        g += data[q] * u + data[q + one] * v + data[q + two] * w
        q += three
        h += data[q] * u + data[q + one] * v + data[q + two] * w
    return f, g, h


@njit(cache=True, parallel=True, fastmath={"contract"})
def _residual_of_one(
    indptr: Index, indices: Index, data: Floats, x: Floats, b: Floats, out: Floats
) -> None:
    for i in prange(len(indptr) - 1):
        f, g, h = _node_force(i, indptr, indices, data, x)
        out[3 * i] = b[3 * i] - f
        out[3 * i + 1] = b[3 * i + 1] - g
        out[3 * i + 2] = b[3 * i + 2] - h


def chebyshev_step(
    indptr: Index,
    indices: Index,
    data: Floats,
    inverse: Floats,
    X: Floats,
    B: Floats,
    D: Floats,
    out: Floats,
    momentum: float,
    step: float,
) -> None:
    """``D = momentum D + step diag^-1 (B - K X)``, then ``out = X + D``.

    Parameters
    ----------
    inverse : Floats
        (n_nodes, 3, 3) inverses of the diagonal blocks.
    """
    flat, x, b = data.reshape(-1), X.reshape(-1), B.reshape(-1)
    if X.shape[1] == 1:
        d, y = D.reshape(-1), out.reshape(-1)
        _step_of_one(indptr, indices, flat, inverse, x, b, d, y, momentum, step)
    else:
        _step_of_many(indptr, indices, flat, inverse, x, b, D, out, momentum, step)


@njit(cache=True, parallel=True, fastmath=True)
def _step_of_many(
    indptr: Index,
    indices: Index,
    data: Floats,
    inverse: Floats,
    x: Floats,
    b: Floats,
    D: Floats,
    out: Floats,
    momentum: float,
    step: float,
) -> None:
    m = D.shape[1]
    for i in prange(len(indptr) - 1):
        f, g, h = _node_residual(i, indptr, indices, data, x, b, m)
        for r in range(3):
            row = 3 * i + r
            u, v, w = inverse[i, r, 0], inverse[i, r, 1], inverse[i, r, 2]
            for k in range(m):
                d = momentum * D[row, k] + step * (u * f[k] + v * g[k] + w * h[k])
                D[row, k] = d
                out[row, k] = x[row * m + k] + d


@njit(cache=True, parallel=True, fastmath={"contract"})
def _step_of_one(
    indptr: Index,
    indices: Index,
    data: Floats,
    inverse: Floats,
    x: Floats,
    b: Floats,
    d: Floats,
    out: Floats,
    momentum: float,
    step: float,
) -> None:
    for i in prange(len(indptr) - 1):
        f, g, h = _node_force(i, indptr, indices, data, x)
        f, g, h = b[3 * i] - f, b[3 * i + 1] - g, b[3 * i + 2] - h
        for r in range(3):
            row = 3 * i + r
            change = inverse[i, r, 0] * f + inverse[i, r, 1] * g + inverse[i, r, 2] * h
            d[row] = momentum * d[row] + step * change
            out[row] = x[row] + d[row]


@njit(cache=True, parallel=True, fastmath=True)
def times_blocks(blocks: Floats, X: Floats, factor: float, out: Floats) -> None:
    """``out = factor blocks X``, the (n_nodes, 3, 3) blocks on the diagonal."""
    for i in prange(len(blocks)):
        for k in range(X.shape[1]):
            u, v, w = X[3 * i, k], X[3 * i + 1, k], X[3 * i + 2, k]
            for r in range(3):
                value = blocks[i, r, 0] * u + blocks[i, r, 1] * v + blocks[i, r, 2] * w
                out[3 * i + r, k] = factor * value


@njit(cache=True, parallel=True, fastmath=True)
def advance(X: Floats, R: Floats, P: Floats, Q: Floats, alpha: Floats) -> None:
    """``X += alpha P`` and ``R += alpha Q``, with one alpha a column."""
    for i in prange(X.shape[0]):
        for k in range(X.shape[1]):
            X[i, k] += alpha[k] * P[i, k]
            R[i, k] += alpha[k] * Q[i, k]


@njit(cache=True, parallel=True, fastmath=True)
def redirect(P: Floats, Z: Floats, beta: Floats) -> None:
    """``P = Z + beta P``, with one beta a column."""
    for i in prange(P.shape[0]):
        for k in range(P.shape[1]):
            P[i, k] = Z[i, k] + beta[k] * P[i, k]
