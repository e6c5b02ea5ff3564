"""The stiffness of a coarser level, P^T K P, in one pass over the blocks of K.

A general product of block matrices first makes K P, which is nearly as large as K, and takes each
block of P as a full one. Between quadratic and linear elements on the same corners nearly all are
a number times the identity, and two or fewer a node.
"""

import numpy as np
from numba import njit, prange
from numpy.typing import NDArray
from scipy import sparse

from fe_drivetrain.common.arrays import Floats
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
    forwards, back = _Blocks(P), _Blocks(P.T)
    pieces = np.linspace(0, n // 3, _PIECES + 1).astype(np.int64)
    indptr = np.zeros(n // 3 + 1, dtype=np.int32)
    patterns = back.indptr, back.indices, K.indptr, K.indices, forwards.indptr, forwards.indices
    # NumPy makes the array out here: in a compiled loop that takes longer to compile
    markers = np.full((_PIECES, n // 3), -1, dtype=np.int64)
    _count(*patterns, pieces, markers, indptr[1:])
    np.cumsum(indptr, out=indptr)
    markers[:] = -1
    indices, data = np.empty(indptr[-1], dtype=np.int32), np.zeros((indptr[-1], 3, 3))
    values = back.data, back.factors, K.data.ravel(), forwards.data, forwards.factors
    _fill(*patterns, pieces, markers, *values, indptr, indices, data.ravel())
    coarse = sparse.bsr_array((data, indices, indptr), shape=(n, n))
    coarse.has_sorted_indices = False
    coarse.sort_indices()
    return coarse


class _Blocks:
    """A block matrix, and which factor times the identity each block is: NaN of the others."""

    def __init__(self, P: sparse.bsr_array) -> None:
        self.indptr, self.indices = pattern_of(P)
        self.data = P.data
        first, *others, last = P.data.reshape(-1, 9).T
        plain = (first == others[3]) & (first == last)
        for place in (0, 1, 2, 4, 5, 6):
            plain &= others[place] == 0.0
        self.factors = np.where(plain, first, np.nan)


@njit(cache=True, parallel=True)
def _count(
    Rptr: Index,
    Rind: Index,
    Kptr: Index,
    Kind: Index,
    Pptr: Index,
    Pind: Index,
    pieces: NDArray[np.int64],
    markers: NDArray[np.int64],
    counts: Index,
) -> None:
    """Number of blocks in each coarse row."""
    for piece in prange(len(pieces) - 1):
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


@njit(cache=True, parallel=True)
def _fill(
    Rptr: Index,
    Rind: Index,
    Kptr: Index,
    Kind: Index,
    Pptr: Index,
    Pind: Index,
    pieces: NDArray[np.int64],
    markers: NDArray[np.int64],
    R: Floats,
    to: Floats,
    K: Floats,
    P: Floats,
    of: Floats,
    indptr: Index,
    indices: Index,
    data: Floats,
) -> None:
    """Sum the blocks of each coarse row, in the order in which they are met."""
    for piece in prange(len(pieces) - 1):
        place = markers[piece]
        for a in range(pieces[piece], pieces[piece + 1]):
            first = end = np.int64(indptr[a])
            for s in range(Rptr[a], Rptr[a + 1]):
                i, weight = Rind[s], to[s]
                for p in range(Kptr[i], Kptr[i + 1]):
                    j = Kind[p]
                    fetch(K, 9 * p + AHEAD // K.itemsize)
                    for q in range(Pptr[j], Pptr[j + 1]):
                        b = Pind[q]
                        t = place[b]
                        if t < first:
                            t = place[b] = end
                            indices[end] = b
                            end += 1
                        factor = weight * of[q]
                        if factor == factor:
                            _add(data, np.uint64(9 * t), factor, K, np.uint64(9 * p))
                        else:
                            _add_between(data, 9 * t, R[s], K, 9 * p, P[q])


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
