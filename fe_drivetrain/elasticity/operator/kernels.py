"""Compiled loops over node blocks: what NumPy cannot say without large copies.

Matrices are block CSR with 3x3 blocks, one block row a node (``indptr``, ``indices``, ``data`` as
in ``scipy.sparse.bsr_array``), in double or single precision. Right-hand sides are the columns of
C-ordered (n, m) arrays, and every loop takes all of them in one pass over the matrix. Compiled by
numba at the first call (seconds), then kept in its cache on disk. With the import, memory of freed
arrays stays for the next ones, see `keep_freed_memory`.
"""

from typing import Any

import numpy as np
from numba import prange
from numpy.typing import NDArray
from scipy import sparse

from fe_drivetrain.common.arrays import Bools, Floats
from fe_drivetrain.common.compiled import njit
from fe_drivetrain.common.memory import keep_freed_memory
from fe_drivetrain.elasticity.operator.vectors import (
    LANES,
    fetch,
    less_block,
    load,
    plus,
    plus_each,
    row_sums,
    store,
    thrice,
    times,
    zeros,
)

Index = NDArray[np.int32]

# Nodes that a thread takes at once have one place for what their neighbours do.
_PIECES = 32

#: How far ahead of what it takes a loop asks memory for the blocks that come [bytes]. Without it,
#: matrices larger than caches take twice as long; from 2 to 8 KiB on it makes no difference.
AHEAD = 4096

# Bytes that come at once.
_LINE = 64

# Columns whose parts of a row stay in a cache.
_COLUMNS = 16

keep_freed_memory()


# stated: what is not, a loop takes from whichever other one has it compiled first
@njit(cache=True, error_model="numpy", fastmath=True)
def inverse_transposed(J: Floats, A: Floats) -> float:
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
def invert(blocks: Floats, out: Floats) -> None:
    """Put the inverses of symmetric (n, 3, 3) blocks into ``out``."""
    for i in range(len(blocks)):
        inverse_transposed(blocks[i], out[i])


def rounded(blocks: Floats, out: Floats) -> None:
    """Put the entries of blocks into ``out``, which may be of single precision, on all cores."""
    _round(blocks.reshape(-1), out.reshape(-1))


@njit(cache=True, parallel=True)
def _round(numbers: Floats, out: Floats) -> None:
    for i in prange(len(numbers)):
        out[i] = numbers[i]


@njit(inline="always")
def _node_residual(
    i: int,
    first_column: int,
    indptr: Index,
    indices: Index,
    data: Floats,
    start: Any,
    x: Floats,
    b: Floats,
    columns: int,
) -> tuple[Any, Any, Any]:
    """``B - K X`` of node i in each direction, of eight columns, all arrays flat.

    Its blocks are in ``data`` from ``start`` on. Indices that cannot be negative: half the time of
    the same loop without `vectors`.
    """
    m, three, nine = np.uint64(columns), np.uint64(3), np.uint64(9)
    q = start
    t = three * np.uint64(i) * m + np.uint64(first_column)
    f, g, h = load(b, t), load(b, t + m), load(b, t + m + m)
    for p in range(np.uint64(indptr[i]), np.uint64(indptr[i + 1])):
        s = three * np.uint64(indices[p]) * m + np.uint64(first_column)
        f, g, h = less_block(f, g, h, data, q, x, s, m)
        q += nine
    return f, g, h


def in_lanes(X: Floats) -> Floats:
    """(n, m) in rows, with columns of zeros up to whole vectors."""
    n, m = X.shape
    wide = np.zeros((n, m + -m % LANES))
    wide[:, :m] = X
    return wide


def together(count: int) -> list[slice]:
    """Which of many right-hand sides go through loops together: hundreds do not stay in a cache.

    Not in equal shares: vectors that are not full cost as much, and 21 columns are three of 16 and
    5, but four of 11 and 10.
    """
    return [slice(first, first + _COLUMNS) for first in range(0, count, _COLUMNS)]


def pattern_of(A: sparse.bsr_array | sparse.csr_array) -> tuple[Index, Index]:
    """``indptr`` and ``indices`` of a matrix, in the integers that loops are compiled for."""
    # springs leave 64-bit indices in a sum, with which every loop would be compiled once more
    return A.indptr.astype(np.int32, copy=False), A.indices.astype(np.int32, copy=False)


def product(K: sparse.bsr_array, X: Floats) -> Floats:
    """``K X`` (n, m), on all cores: SciPy's product takes one."""
    indptr, indices = pattern_of(K)
    X = np.ascontiguousarray(X, dtype=np.float64)
    out = np.empty_like(X)
    residual(indptr, indices, K.data, X, np.zeros_like(X), out)
    return np.negative(out, out=out)


def residual(
    indptr: Index, indices: Index, data: Floats, X: Floats, B: Floats, out: Floats
) -> None:
    """``out = B - K X``; fastest for one column, and for multiples of eight."""
    m = X.shape[1]
    if m > 1 and m % LANES:
        wide = np.empty((len(X), m + -m % LANES))
        residual(indptr, indices, data, in_lanes(X), in_lanes(B), wide)
        out[:] = wide[:, :m]
        return
    assert out.flags.c_contiguous  # else what is flat would be a copy
    flat, x, b, y = (array.reshape(-1) for array in (data, X, B, out))
    if m == 1:
        _residual_of_one(indptr, indices, flat, x, b, y)
    elif data.dtype == np.float64:
        _residual_of_many(indptr, indices, flat, x, b, y, m)
    else:
        _residual_of_many_rounded(indptr, indices, flat, x, b, y, m)


@njit(cache=True, parallel=True)
def _residual_of_many(
    indptr: Index, indices: Index, data: Floats, x: Floats, b: Floats, out: Floats, columns: int
) -> None:
    for i in prange(len(indptr) - 1):
        start, end = np.uint64(9) * np.uint64(indptr[i]), np.uint64(9) * np.uint64(indptr[i + 1])
        for k in range(start, end, np.uint64(_LINE // data.itemsize)):
            fetch(data, k + np.uint64(AHEAD // data.itemsize))
        for k in range(0, columns, LANES):
            f, g, h = _node_residual(i, k, indptr, indices, data, start, x, b, columns)
            t = 3 * i * columns + k
            store(f, out, t)
            store(g, out, t + columns)
            store(h, out, t + 2 * columns)


@njit(cache=True)
def _most(indptr: Index, first: int, end: int) -> int:
    """Maximum number of blocks of a node, from first to end."""
    most = 0
    for i in range(first, end):
        most = max(most, indptr[i + 1] - indptr[i])
    return most


@njit(inline="always")
def _own(i: int, indptr: Index, data: Floats, own: Floats) -> None:
    """The blocks of node i in double precision.

    Converted one by one for each column's sums they would take twice the time of all else.
    """
    first, count = np.uint64(9 * indptr[i]), np.uint64(9 * (indptr[i + 1] - indptr[i]))
    for k in range(np.uint64(0), count, np.uint64(_LINE // data.itemsize)):
        fetch(data, first + k + np.uint64(AHEAD // data.itemsize))
    for k in range(count):
        own[k] = data[first + k]


@njit(cache=True, parallel=True)
def _residual_of_many_rounded(
    indptr: Index, indices: Index, data: Floats, x: Floats, b: Floats, out: Floats, columns: int
) -> None:
    n = len(indptr) - 1
    for piece in prange(_PIECES):
        low, high = piece * n // _PIECES, (piece + 1) * n // _PIECES
        own = np.empty(9 * _most(indptr, low, high))
        for i in range(low, high):
            _own(i, indptr, data, own)
            for k in range(0, columns, LANES):
                f, g, h = _node_residual(i, k, indptr, indices, own, np.uint64(0), x, b, columns)
                t = 3 * i * columns + k
                store(f, out, t)
                store(g, out, t + columns)
                store(h, out, t + 2 * columns)


@njit(inline="always")
def _node_product(
    i: int, indptr: Index, indices: Index, data: Floats, x: Floats
) -> tuple[float, float, float]:
    """``K x`` of node i for one column: eight of a block's nine entries at once.

    Two alternating sums, so that one need not wait for the other.
    """
    two, three, eight, nine = np.uint64(2), np.uint64(3), np.uint64(8), np.uint64(9)
    most, ahead = np.uint64(len(x)), np.uint64(AHEAD // data.itemsize)
    this, that, last = zeros(), zeros(), 0.0
    f = g = h = 0.0
    for p in range(np.uint64(indptr[i]), np.uint64(indptr[i + 1])):
        c, q = three * np.uint64(indices[p]), nine * p
        fetch(data, q + ahead)
        if c + eight <= most:
            this, that = that, plus_each(this, load(data, q), thrice(load(x, c)))
            last += data[q + eight] * x[c + two]
        else:  # beyond the last nodes there is nothing to load
            for k in range(three):
                f += data[q + k] * x[c + k]
                g += data[q + three + k] * x[c + k]
                h += data[q + three + three + k] * x[c + k]
    one, other = row_sums(this), row_sums(that)
    return f + (one[0] + other[0]), g + (one[1] + other[1]), h + (one[2] + other[2]) + last


@njit(cache=True, parallel=True, fastmath={"contract"})
def _residual_of_one(
    indptr: Index, indices: Index, data: Floats, x: Floats, b: Floats, out: Floats
) -> None:
    for i in prange(len(indptr) - 1):
        f, g, h = _node_product(i, indptr, indices, data, x)
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

    Without momentum D need not have numbers.

    Parameters
    ----------
    inverse : Floats
        (n_nodes, 3, 3) inverses of the diagonal blocks.
    """
    m = X.shape[1]
    if m > 1 and m % LANES:
        wide = in_lanes(D)
        moved = np.empty_like(wide)
        given = in_lanes(X), in_lanes(B)
        chebyshev_step(indptr, indices, data, inverse, *given, wide, moved, momentum, step)
        D[:], out[:] = wide[:, :m], moved[:, :m]
        return
    assert D.flags.c_contiguous
    assert out.flags.c_contiguous
    data, x, b, d, y = (array.reshape(-1) for array in (data, X, B, D, out))
    if m > 1:
        _step_of_many(indptr, indices, data, inverse, x, b, d, y, momentum, step)
    else:
        _step_of_one(indptr, indices, data, inverse, x, b, d, y, momentum, step)


@njit(cache=True, parallel=True)
def _step_of_many(
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
    n = len(indptr) - 1
    columns = len(x) // (3 * n)
    for piece in prange(_PIECES):
        low, high = piece * n // _PIECES, (piece + 1) * n // _PIECES
        own = np.empty(9 * _most(indptr, low, high))
        for i in range(low, high):
            _own(i, indptr, data, own)
            for k in range(0, columns, LANES):
                f, g, h = _node_residual(i, k, indptr, indices, own, np.uint64(0), x, b, columns)
                for r in range(3):
                    t = (3 * i + r) * columns + k
                    change = times(step * inverse[i, r, 0], f)
                    if momentum != 0.0:
                        change = plus(change, momentum, load(d, t))
                    change = plus(change, step * inverse[i, r, 1], g)
                    change = plus(change, step * inverse[i, r, 2], h)
                    store(change, d, t)
                    store(plus(load(x, t), 1.0, change), out, t)


@njit(cache=True, parallel=True, fastmath=True)
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
        f, g, h = _node_product(i, indptr, indices, data, x)
        f, g, h = b[3 * i] - f, b[3 * i + 1] - g, b[3 * i + 2] - h
        for r in range(3):
            row = 3 * i + r
            change = inverse[i, r, 0] * f + inverse[i, r, 1] * g + inverse[i, r, 2] * h
            change *= step
            if momentum != 0.0:
                change += momentum * d[row]
            d[row] = change
            out[row] = x[row] + change


def add_product(A: sparse.csr_array, X: Floats, out: Floats) -> None:
    """``out += A X``, of a matrix in rows with 32-bit indices; fastest as `residual`."""
    m = X.shape[1]
    if m > 1 and m % LANES:
        wide = in_lanes(out)
        add_product(A, in_lanes(X), wide)
        out[:] = wide[:, :m]
        return
    assert out.flags.c_contiguous
    flat = A.indptr, A.indices, A.data, X.reshape(-1), out.reshape(-1)
    if m == 1:
        _add_product_of_one(*flat)
    else:
        _add_product_of_many(*flat, m)


@njit(cache=True, parallel=True, fastmath={"contract"})
def _add_product_of_one(
    indptr: Index, indices: Index, data: Floats, x: Floats, out: Floats
) -> None:
    for i in prange(len(indptr) - 1):
        f = 0.0
        for p in range(np.uint64(indptr[i]), np.uint64(indptr[i + 1])):
            f += data[p] * x[np.uint64(indices[p])]
        out[i] += f


@njit(cache=True, parallel=True)
def _add_product_of_many(
    indptr: Index, indices: Index, data: Floats, x: Floats, out: Floats, columns: int
) -> None:
    m = np.uint64(columns)
    for i in prange(len(indptr) - 1):
        for k in range(0, columns, LANES):
            f = load(out, i * columns + k)
            for p in range(np.uint64(indptr[i]), np.uint64(indptr[i + 1])):
                f = plus(f, data[p], load(x, np.uint64(indices[p]) * m + np.uint64(k)))
            store(f, out, i * columns + k)


def kept_blocks(indptr: Index, indices: Index, data: Floats, kept: Bools, out: Floats) -> None:
    """Blocks with rows and columns of degrees of freedom zeroed where (n_nodes, 3) ``kept`` is.

    The pattern is symmetric. Where ``out`` is ``data``, little is read and written.
    """
    if out is not data:
        np.copyto(out, data)
    some = ~(kept[:, 0] & kept[:, 1] & kept[:, 2])  # of so short rows NumPy's all is slow
    beside = some.copy()
    beside[indices[_entries(indptr, np.flatnonzero(some))]] = True
    rows = np.flatnonzero(beside)
    entries = _entries(indptr, rows)
    rows = np.repeat(rows, indptr[rows + 1] - indptr[rows])
    touched = some[rows] | some[indices[entries]]
    entries, rows = entries[touched], rows[touched]
    out[entries] *= kept[rows, :, None] & kept[indices[entries], None, :]


def _entries(indptr: Index, rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """Places of all blocks of some rows."""
    counts = indptr[rows + 1] - indptr[rows]
    before = np.cumsum(counts) - counts
    return np.repeat(indptr[rows] - before, counts) + np.arange(counts.sum())


@njit(cache=True, parallel=True, fastmath=True)
def times_blocks(blocks: Floats, X: Floats, factor: float, out: Floats) -> None:
    """``out = factor blocks X``, the (n_nodes, 3, 3) blocks on the diagonal."""
    for i in prange(len(blocks)):
        for k in range(X.shape[1]):
            u, v, w = X[3 * i, k], X[3 * i + 1, k], X[3 * i + 2, k]
            for r in range(3):
                value = blocks[i, r, 0] * u + blocks[i, r, 1] * v + blocks[i, r, 2] * w
                out[3 * i + r, k] = factor * value


def dots(A: Floats, B: Floats) -> Floats:
    """Products of the columns of A and B (m,), each added in an order that no thread changes."""
    sums = np.zeros((_PIECES, A.shape[1]))
    _add_dots(A, B, sums)
    return np.asarray(sums.sum(axis=0))


@njit(cache=True, parallel=True, fastmath=True)
def _add_dots(A: Floats, B: Floats, sums: Floats) -> None:
    n, m = A.shape
    for piece in prange(_PIECES):
        low, high = piece * n // _PIECES, (piece + 1) * n // _PIECES
        a, b = A[low:high], B[low:high]
        if m == 1:  # in a register, not in memory: a tenth of the time
            one, other, total = a.reshape(-1), b.reshape(-1), 0.0
            for i in range(len(one)):
                total += one[i] * other[i]
            sums[piece, 0] = total
        else:
            for i in range(len(a)):
                for k in range(m):
                    sums[piece, k] += a[i, k] * b[i, k]


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
