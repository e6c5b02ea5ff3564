"""The stiffness of a coarser level, P^T K P, in one pass over the blocks of K.

A general product of block matrices first makes K P, which is nearly as large as K, and takes each
block of P as a full one. Between quadratic and linear elements on the same corners nearly all are
a number times the identity, and two or fewer a node. Here each row of P^T K is summed up by itself,
in a cache, before it is multiplied with P; and only what is right of the diagonal, the product
being symmetric.
"""

from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.compiled import njit
from fe_drivetrain.elasticity.operator.element_loops import in_pieces
from fe_drivetrain.elasticity.operator.kernels import AHEAD, Index, pattern_of
from fe_drivetrain.elasticity.operator.vectors import (
    LANES,
    fetch,
    load,
    plus,
    plus_product,
    store,
    times,
    transposed,
)

# Rows that a thread takes at once have a marker for each node.
_PIECES = 16

# Numbers from one block of a row in a cache to the next: whole lines.
_ROOM = 16


def coarse_product(
    K: sparse.bsr_array,
    prolongation: sparse.csr_array,
    restriction: sparse.csr_array | None = None,
) -> sparse.bsr_array:
    """P^T K P in 3x3 blocks, with sorted indices.

    Parameters
    ----------
    K : sparse.bsr_array
        Stiffness (n, n) in 3x3 blocks, symmetric.
    prolongation : sparse.csr_array
        (n, n_coarse), both multiples of three.
    restriction : sparse.csr_array or None
        Its transpose, where that is known already.

    Returns
    -------
    coarse
        (n_coarse, n_coarse) in 3x3 blocks, symmetric to the last digit.
    """
    n_fine, n = K.shape[0] // 3, prolongation.shape[1] // 3
    with ThreadPoolExecutor(1) as pool:
        beside = pool.submit(_transfer, prolongation.T if restriction is None else restriction)
        forwards = _transfer(prolongation)
        back = beside.result()
    last = np.full(n_fine, -1, dtype=np.int32)
    some = np.flatnonzero(np.diff(forwards.indptr))
    last[some] = np.maximum.reduceat(forwards.indices, forwards.indptr[some])
    pieces = np.linspace(0, n, _PIECES + 1).astype(np.int64)
    # NumPy makes the arrays out here: in a compiled loop that takes longer to compile
    markers = _Markers(
        np.empty((_PIECES, n_fine), np.int32), np.empty((_PIECES, n), np.int32), last
    )
    most = _most_columns(back, K)
    row = _Row(np.empty((_PIECES, most), np.int32), np.empty((_PIECES, most * _ROOM + LANES)))
    counts = np.zeros(n, dtype=np.int32)
    # room for as many as a row of K P would have if it met each coarse node once: memory that is
    # not written to costs nothing
    each = len(K.indices) * len(forwards.indices) // max(1, n_fine**2) + 1
    parts: list[tuple[Index, Floats]] = [(counts, last)] * _PIECES

    def fill(piece: int) -> None:
        room = each * int(pieces[piece + 1] - pieces[piece])
        end = -1
        while end < 0:
            found = np.empty(room, np.int32), np.empty(9 * room)
            markers.fine[piece], markers.coarse[piece] = -1, -1
            stiffness = _Rows(K.indptr, K.indices, K.data.reshape(-1))
            end = _fill(piece, back, stiffness, forwards, pieces, markers, row, counts, *found)
            room *= 2
        parts[piece] = found[0][:end], found[1][: 9 * end]

    in_pieces(_PIECES, fill)
    indptr = np.append(np.int32(0), np.cumsum(counts, dtype=np.int32))
    indices, data = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
    return _mirrored(_Rows(indptr, indices, data.reshape(-1, 3, 3)))


def _most_columns(back: "_Transfer", K: sparse.bsr_array) -> int:
    """Bound of the columns of a row of P^T K."""
    met = np.cumsum(np.append(0, np.diff(K.indptr)[back.indices]))
    most = int(np.diff(met[back.indptr]).max(initial=0))
    return min(most, len(K.indptr) - 1)


class _Rows(NamedTuple):
    """A block matrix, its blocks flat."""

    indptr: Index
    indices: Index
    data: Floats


class _Markers(NamedTuple):
    """What each piece has met of fine and coarse nodes, and the last coarse node of fine ones."""

    fine: Index
    coarse: Index
    last: Index


class _Row(NamedTuple):
    """For each piece a row of P^T K: its columns, and its blocks."""

    columns: Index
    blocks: Floats


class _Transfer(NamedTuple):
    """A block matrix, and which factor times the identity each block is: NaN of the others."""

    indptr: Index
    indices: Index
    data: Floats
    factors: Floats


def _transfer(given: sparse.sparray) -> _Transfer:
    P = given.tobsr((3, 3))
    first, *others, last = P.data.reshape(-1, 9).T
    plain = (first == others[3]) & (first == last)
    for place in (0, 1, 2, 4, 5, 6):
        plain &= others[place] == 0.0
    return _Transfer(*pattern_of(P), P.data.ravel(), np.where(plain, first, np.nan))


def _mirrored(right: "_Rows") -> sparse.bsr_array:
    """The symmetric matrix of which these are the blocks from the diagonal on; sorted."""
    indptr, indices, data = right
    n = len(indptr) - 1
    row = np.repeat(np.arange(n), np.diff(indptr))
    diagonal = indices == row
    data[diagonal] = 0.5 * (data[diagonal] + data[diagonal].swapaxes(1, 2))
    whole = np.zeros(n + 1, dtype=np.int32)
    np.cumsum(np.diff(indptr) + np.bincount(indices[~diagonal], minlength=n), out=whole[1:])
    columns, source = np.empty((2, whole[-1]), dtype=np.int32)
    _place(indptr, indices, whole, whole[:-1].copy(), columns, source)
    blocks = np.empty((whole[-1], 3, 3))
    pieces = np.linspace(0, n, _PIECES + 1).astype(np.int64)
    in_pieces(_PIECES, _mirror, pieces, whole, columns, source, data.ravel(), blocks.ravel())
    return sparse.bsr_array((blocks, columns, whole), shape=(3 * n, 3 * n))


@njit(cache=True, nogil=True)
def _fill(
    piece: int,
    R: _Transfer,
    K: _Rows,
    P: _Transfer,
    pieces: NDArray[np.int64],
    markers: _Markers,
    row: _Row,
    counts: Index,
    indices: Index,
    data: Floats,
) -> int:
    """Sum the blocks of each coarse row of R K P from the diagonal on, in the order met.

    Returns
    -------
    int
        How many blocks there are, in ``counts`` those of each row; -1 where there is no room.
    """
    Rptr, Rind, left, to = R
    Kptr, Kind, values = K
    Pptr, Pind, right, of = P
    met, place, last = markers.fine[piece], markers.coarse[piece], markers.last
    columns, W = row.columns[piece], row.blocks[piece]
    base = count = 0  # fine nodes of rows before, and of this one
    end = 0
    for a in range(pieces[piece], pieces[piece + 1]):
        base, count = base + count, 0
        for s in range(Rptr[a], Rptr[a + 1]):
            i, factor = Rind[s], to[s]
            for p in range(Kptr[i], Kptr[i + 1]):
                j = Kind[p]
                fetch(values, 9 * p + AHEAD // values.itemsize)
                if last[j] < a:
                    continue
                if met[j] < base:
                    met[j] = base + count
                    columns[count] = j
                    _put(W, np.uint64(_ROOM * count), 0.0, values, np.uint64(9 * p))
                    count += 1
                w = np.uint64(_ROOM * (met[j] - base))
                if factor == factor:
                    _add(W, w, factor, values, np.uint64(9 * p))
                else:
                    _add_product(W, w, left, np.uint64(9 * s), values, np.uint64(9 * p))
        first = end
        for c in range(count):
            for q in range(Pptr[columns[c]], Pptr[columns[c] + 1]):
                b, factor = Pind[q], of[q]
                if b < a:
                    continue
                is_new = place[b] < first
                if is_new:
                    if end == len(indices):
                        return -1
                    place[b] = end
                    indices[end] = b
                    end += 1
                t = np.uint64(9) * np.uint64(place[b])
                if factor == factor and is_new:
                    _put(data, t, factor, W, np.uint64(_ROOM * c))
                elif factor == factor:
                    _add(data, t, factor, W, np.uint64(_ROOM * c))
                else:
                    if is_new:
                        _put(data, t, 0.0, W, np.uint64(_ROOM * c))
                    _add_product(data, t, W, np.uint64(_ROOM * c), right, np.uint64(9 * q))
        counts[a] = end - first
    return end


@njit(inline="always")
def _put(data: Floats, t: np.uint64, factor: float, K: Floats, p: np.uint64) -> None:
    """Put a factor times a block; at indices that cannot be negative."""
    store(times(factor, load(K, p)), data, t)
    data[t + np.uint64(LANES)] = factor * K[p + np.uint64(LANES)]


@njit(inline="always")
def _add(data: Floats, t: np.uint64, factor: float, K: Floats, p: np.uint64) -> None:
    """Add a factor times a block; at indices that cannot be negative."""
    store(plus(load(data, t), factor, load(K, p)), data, t)
    data[t + np.uint64(LANES)] += factor * K[p + np.uint64(LANES)]


@njit(inline="always")
def _add_product(
    data: Floats, t: np.uint64, one: Floats, s: np.uint64, other: Floats, p: np.uint64
) -> None:
    """Add the product of two blocks; at indices that cannot be negative."""
    rest, last = np.uint64(1), np.uint64(LANES)
    a, b = load(one, s), load(other, p)
    found = plus_product(load(data, t), a, load(one, s + rest), b, load(other, p + rest))
    store(found, data, t)
    for i in (np.uint64(2), np.uint64(1), np.uint64(0)):
        data[t + last] += one[s + last - i] * other[p + last - np.uint64(3) * i]


@njit(cache=True)
def _place(
    indptr: Index, indices: Index, whole: Index, end: Index, columns: Index, source: Index
) -> None:
    """Columns of whole rows, and where the block of each is, from what is right of the diagonal.

    Left of it and on it row by row, then from these what is right of it: so rows are sorted.
    """
    n = len(indptr) - 1
    for a in range(n):
        for t in range(indptr[a], indptr[a + 1]):
            p = end[indices[t]]
            columns[p], source[p] = a, t
            end[indices[t]] += 1
    for b in range(n):
        for p in range(whole[b], end[b]):
            a = columns[p]
            if a >= b:
                break
            columns[end[a]], source[end[a]] = b, source[p]
            end[a] += 1


@njit(cache=True, nogil=True)
def _mirror(
    piece: int,
    pieces: NDArray[np.int64],
    whole: Index,
    columns: Index,
    source: Index,
    data: Floats,
    blocks: Floats,
) -> None:
    """Put each block, or its transpose left of the diagonal, into its place."""
    last = np.uint64(LANES)
    for a in range(pieces[piece], pieces[piece + 1]):
        for p in range(whole[a], whole[a + 1]):
            t, to = np.uint64(9 * np.int64(source[p])), np.uint64(9 * np.int64(p))
            block = load(data, t)
            if columns[p] < a:
                store(transposed(block), blocks, to)
            else:
                store(block, blocks, to)
            blocks[to + last] = data[t + last]
