"""The stiffness of a coarser level, P^T K P, in one pass over the blocks of K.

A general product of block matrices first makes K P, which is nearly as large as K, and takes each
block of P as a full one. Between quadratic and linear elements on the same corners nearly all are
a number times the identity, and two or fewer a node.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.compiled import njit
from fe_drivetrain.elasticity.operator.element_loops import in_pieces
from fe_drivetrain.elasticity.operator.kernels import AHEAD, Index, pattern_of
from fe_drivetrain.elasticity.operator.vectors import LANES, fetch, load, plus, store

# Rows that a thread takes at once have a marker for each coarse node.
_PIECES = 16


def coarse_product(K: sparse.bsr_array, prolongation: sparse.csr_array) -> sparse.bsr_array:
    """P^T K P in 3x3 blocks, with sorted indices.

    Parameters
    ----------
    K : sparse.bsr_array
        Stiffness (n, n) in 3x3 blocks.
    prolongation : sparse.csr_array
        (n, n_coarse), both multiples of three.

    Returns
    -------
    coarse
        (n_coarse, n_coarse) in 3x3 blocks.
    """
    n = prolongation.shape[1]
    P = prolongation.tobsr((3, 3))
    forwards, back = _transfer(P), _transfer(P.T)
    pieces = np.linspace(0, n // 3, _PIECES + 1).astype(np.int64)
    indptr = np.zeros(n // 3 + 1, dtype=np.int32)
    patterns = back.pattern, _Pattern(K.indptr, K.indices), forwards.pattern
    # NumPy makes the array out here: in a compiled loop that takes longer to compile
    markers = np.full((_PIECES, n // 3), -1, dtype=np.int64)
    in_pieces(_PIECES, _count, *patterns, pieces, markers, indptr[1:])
    np.cumsum(indptr, out=indptr)
    markers[:] = -1
    indices, data = np.empty(indptr[-1], dtype=np.int32), np.zeros((indptr[-1], 3, 3))
    in_pieces(
        *(_PIECES, _fill),
        *(back, _Rows(K.indptr, K.indices, K.data.ravel()), forwards),
        *(pieces, markers, _Rows(indptr, indices, data.ravel())),
    )
    coarse = sparse.bsr_array((data, indices, indptr), shape=(n, n))
    coarse.has_sorted_indices = False
    coarse.sort_indices()
    return coarse


class _Pattern(NamedTuple):
    """Where the blocks of a matrix are."""

    indptr: Index
    indices: Index


class _Rows(NamedTuple):
    """A block matrix, its blocks flat."""

    indptr: Index
    indices: Index
    data: Floats


class _Transfer(NamedTuple):
    """A block matrix, and which factor times the identity each block is: NaN of the others."""

    indptr: Index
    indices: Index
    data: Floats
    factors: Floats

    @property
    def pattern(self) -> _Pattern:
        """Where the blocks are."""
        return _Pattern(self.indptr, self.indices)


def _transfer(P: sparse.bsr_array) -> _Transfer:
    first, *others, last = P.data.reshape(-1, 9).T
    plain = (first == others[3]) & (first == last)
    for place in (0, 1, 2, 4, 5, 6):
        plain &= others[place] == 0.0
    return _Transfer(*pattern_of(P), P.data, np.where(plain, first, np.nan))


@njit(cache=True, nogil=True)
def _count(
    piece: int,
    R: _Pattern,
    K: _Pattern,
    P: _Pattern,
    pieces: NDArray[np.int64],
    markers: NDArray[np.int64],
    counts: Index,
) -> None:
    """Number of blocks in each coarse row of R K P."""
    (Rptr, Rind), (Kptr, Kind), (Pptr, Pind) = R, K, P
    seen = markers[piece]
    for a in range(pieces[piece], pieces[piece + 1]):
        count = 0
        for s in range(Rptr[a], Rptr[a + 1]):
            i = Rind[s]
            for p in range(Kptr[i], Kptr[i + 1]):
                j = Kind[p]
                for q in range(Pptr[j], Pptr[j + 1]):
                    if seen[Pind[q]] != a:
                        seen[Pind[q]] = a
                        count += 1
        counts[a] = count


@njit(cache=True, nogil=True)
def _fill(
    piece: int,
    R: _Transfer,
    K: _Rows,
    P: _Transfer,
    pieces: NDArray[np.int64],
    markers: NDArray[np.int64],
    coarse: _Rows,
) -> None:
    """Sum the blocks of each coarse row of R K P, in the order in which they are met."""
    Rptr, Rind, left, to = R
    Kptr, Kind, values = K
    Pptr, Pind, right, of = P
    indptr, indices, data = coarse
    place = markers[piece]
    for a in range(pieces[piece], pieces[piece + 1]):
        first = end = np.int64(indptr[a])
        for s in range(Rptr[a], Rptr[a + 1]):
            i, weight = Rind[s], to[s]
            for p in range(Kptr[i], Kptr[i + 1]):
                j = Kind[p]
                fetch(values, 9 * p + AHEAD // values.itemsize)
                for q in range(Pptr[j], Pptr[j + 1]):
                    b = Pind[q]
                    t = place[b]
                    if t < first:
                        t = place[b] = end
                        indices[end] = b
                        end += 1
                    factor = weight * of[q]
                    if factor == factor:
                        _add(data, np.uint64(9 * t), factor, values, np.uint64(9 * p))
                    else:
                        _add_between(data, 9 * t, left[s], values, 9 * p, right[q])


@njit(inline="always")
def _add(data: Floats, t: np.uint64, factor: float, K: Floats, p: np.uint64) -> None:
    """Add a factor times a block; at indices that cannot be negative."""
    store(plus(load(data, t), factor, load(K, p)), data, t)
    data[t + np.uint64(LANES)] += factor * K[p + np.uint64(LANES)]


@njit(cache=True)
def _add_between(data: Floats, t: int, left: Floats, K: Floats, p: int, right: Floats) -> None:
    """Add left K right."""
    for r in range(3):
        for c in range(3):
            for i in range(3):
                for j in range(3):
                    data[t + 3 * r + c] += left[r, i] * K[p + 3 * i + j] * right[j, c]
