"""The next coarser level by smoothed aggregation, of pyamg's steps.

Vanek, Mandel, Brezina 1996, Computing 56, 179-196. The prolongation is smoothed by a step of the
block Jacobi iteration, whose inverses and maximum eigenvalue the smoother of the level needs anyway
and pyamg would estimate again, from random numbers.
"""

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import njit
from fe_drivetrain.elasticity.operator.kernels import Index, pattern_of

#: Factor of the Jacobi step, over the maximum eigenvalue: best for eigenvalues above a third of it.
_DAMPING = 4.0 / 3.0


def coarsened(
    K: sparse.bsr_array,
    motions: Floats,
    connected: sparse.csr_array,
    smoother: str | None,
    inverse: Floats,
    largest: float,
) -> tuple[sparse.bsr_array, Floats]:
    """The prolongation from aggregates of nodes, and the rigid motions of these.

    Parameters
    ----------
    K : sparse.bsr_array
        Stiffness (n, n) in 3x3 blocks: one a node, or two an aggregate.
    motions : Floats
        Rigid motions (n, 6).
    connected : sparse.csr_array
        Nodes that may share an aggregate.
    smoother : str or None
        "jacobi", "energy" or None, of the tentative prolongation.
    inverse : Floats
        (n / 3, 3, 3) inverses of the diagonal blocks.
    largest : float
        Eigenvalue of them times K.

    Returns
    -------
    prolongation
        (n, 6 n_aggregates).
    motions
        (6 n_aggregates, 6).
    """
    from pyamg.aggregation.aggregate import standard_aggregation
    from pyamg.aggregation.smooth import energy_prolongation_smoother
    from pyamg.aggregation.tentative import fit_candidates

    tentative, coarse = fit_candidates(standard_aggregation(connected)[0], motions)
    if smoother is None:
        return tentative, coarse
    if smoother == "energy":
        wide = K.tobsr(2 * tentative.blocksize[:1])
        spread = energy_prolongation_smoother(wide, tentative, connected, coarse, None, (False, {}))
        return spread, coarse
    return smoothed(K.tobsr((3, 3)), tentative, inverse, _DAMPING / largest), coarse


def smoothed(
    K: sparse.bsr_array, tentative: sparse.bsr_array, inverse: Floats, factor: float
) -> sparse.bsr_array:
    """A tentative prolongation T less a factor times diag^-1 K T, in blocks of three rows.

    A node of T has a block in one aggregate or in none, so that K T need not be a general product.

    Parameters
    ----------
    K : sparse.bsr_array
        Stiffness (n, n) in 3x3 blocks.
    tentative : sparse.bsr_array
        T (n, 6 n_aggregates), in blocks of three or six rows.
    inverse : Floats
        (n / 3, 3, 3) inverses of the diagonal blocks.
    factor : float
        The factor.
    """
    indptr, indices = pattern_of(K)
    per_node, n = tentative.blocksize[0] // 3, len(indptr) - 1
    own = np.diff(tentative.indptr).astype(np.int32)
    own[own > 0] = tentative.indices + 1
    aggregate = np.repeat(own - 1, per_node)
    T = np.zeros((n, 3, 6))
    T[aggregate >= 0] = tentative.data.reshape(-1, 3, 6)
    # NumPy makes the arrays out here: in a compiled loop that takes longer to compile
    met = np.full(tentative.shape[1] // 6, -1, np.int32)
    room = len(indices) + n
    rows, columns, data = np.zeros(n + 1, np.int32), np.empty(room, np.int32), np.empty(18 * room)
    blocks = K.data.reshape(-1), inverse.reshape(-1), T.reshape(-1)
    _smooth(indptr, indices, *blocks, aggregate, -factor, met, rows, columns, data)
    some = data[: 18 * rows[-1]].reshape(-1, 3, 6), columns[: rows[-1]], rows
    return sparse.bsr_array(some, shape=(3 * n, tentative.shape[1]))


@njit(cache=True, nogil=True, fastmath={"contract"})
def _smooth(
    indptr: Index,
    indices: Index,
    K: Floats,
    inverse: Floats,
    T: Floats,
    aggregate: Index,
    factor: float,
    met: Index,
    rows: Index,
    columns: Index,
    data: Floats,
) -> None:
    """Put T + factor diag^-1 K T into rows of blocks, without those of zeros; all blocks flat.

    Blocks of zeros, as between nodes of which one is held, would connect aggregates.
    """
    end = 0
    for i in range(len(indptr) - 1):
        first = end
        for p in range(indptr[i], indptr[i + 1]):
            j = indices[p]
            g = aggregate[j]
            if g < 0:
                continue
            if met[g] < first:
                met[g], columns[end] = end, g
                for c in range(18 * end, 18 * end + 18):
                    data[c] = 0.0
                end += 1
            t = 18 * met[g]
            for c in range(6):
                x, y, z = T[18 * j + c], T[18 * j + 6 + c], T[18 * j + 12 + c]
                for r in range(3):
                    b = 9 * p + 3 * r
                    data[t + 6 * r + c] += K[b] * x + K[b + 1] * y + K[b + 2] * z
        for q in range(first, end):
            for c in range(18 * q, 18 * q + 6):
                x, y, z = data[c], data[c + 6], data[c + 12]
                for r in range(3):
                    b = 9 * i + 3 * r
                    sum_of = inverse[b] * x + inverse[b + 1] * y + inverse[b + 2] * z
                    data[c + 6 * r] = factor * sum_of
        if aggregate[i] >= 0:
            if met[aggregate[i]] < first:
                met[aggregate[i]], columns[end] = end, aggregate[i]
                for c in range(18 * end, 18 * end + 18):
                    data[c] = 0.0
                end += 1
            for c in range(18):
                data[18 * met[aggregate[i]] + c] += T[18 * i + c]
        last, end = end, first
        for q in range(first, last):
            met[columns[q]] = -1
            is_zero = True
            for c in range(18):
                data[18 * end + c] = data[18 * q + c]
                is_zero &= data[18 * q + c] == 0.0
            columns[end] = columns[q]
            end += not is_zero
        rows[i + 1] = end


def of_nodes(K: sparse.bsr_array, blocks: int) -> tuple[Index, Index, Ints]:
    """Pattern of a matrix whose nodes have some blocks of three each, all of one body."""
    n = (len(K.indptr) - 1) // blocks
    starts, ends = K.indptr[:-1:blocks], K.indptr[1::blocks]
    counts = (ends - starts) // blocks
    indptr = np.append(np.int32(0), np.cumsum(counts, dtype=np.int32))
    entries = np.repeat(starts - blocks * indptr[:-1], counts) + blocks * np.arange(indptr[-1])
    return indptr, K.indices[entries] // blocks, np.zeros(n, dtype=np.int64)


def within_bodies(indptr: Index, indices: Index, body: Ints) -> sparse.csr_matrix:
    """Connections of nodes, those across a joint left out."""
    n = len(body)
    row = np.repeat(np.arange(n), np.diff(indptr))
    a, b = body[row], body[indices]
    kept = (a == b) | (a < 0) | (b < 0)
    entries = (np.ones(int(kept.sum())), (row[kept], indices[kept]))
    connected = sparse.csr_matrix(entries, shape=(n, n))
    connected.indices, connected.indptr = (
        i.astype(np.int32, copy=False) for i in (connected.indices, connected.indptr)
    )
    return connected
