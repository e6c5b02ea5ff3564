"""The way from linear elements to the quadratic ones on the same corners, constraints fulfilled."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.compiled import njit
from fe_drivetrain.elasticity.mesh.shapes import element_kind
from fe_drivetrain.elasticity.operator.kernels import Index, pattern_of


def from_linear(
    cells: Ints, n_nodes: int, T: sparse.csr_array, free: Bools
) -> tuple[sparse.csr_array, Ints]:
    """Prolongation from corner nodes (and reference points) to all, constraints fulfilled.

    Parameters
    ----------
    cells : Ints
        Node numbers (n_cells, k) in VTK's order.
    n_nodes : int
        Number of nodes.
    T, free : sparse.csr_array, Bools
        Matrix (n, n) and flags (n,) of the elimination.

    Returns
    -------
    prolongation, columns
        (n, n_corner) with 32-bit indices, and which degrees of freedom its columns are.
    """
    n = len(free)
    nodes = np.ascontiguousarray(cells, dtype=np.int32)
    weights = np.ascontiguousarray(element_kind(cells.shape[1]).corner_weights())
    # NumPy makes the arrays out here: in a compiled loop that takes longer to compile
    place, is_corner = np.zeros(n_nodes, dtype=np.int64), np.zeros(n_nodes, dtype=np.bool_)
    _find_places(nodes, weights.shape[1], place, is_corner)
    corner, number = np.flatnonzero(is_corner), np.cumsum(is_corner, dtype=np.int32) - 1
    columns = np.append((3 * corner[:, None] + np.arange(3)).ravel(), np.arange(3 * n_nodes, n))
    follows = T.nnz > np.count_nonzero(free)  # some follow others
    kept = np.ones(n, dtype=np.bool_) if follows else free
    most = (
        3 * int(np.count_nonzero(weights, axis=1)[place % cells.shape[1]].sum()) + n - 3 * n_nodes
    )
    indptr, indices, data = np.zeros(n + 1, np.int32), np.empty(most, np.int32), np.empty(most)
    _fill(nodes, weights, place, number, kept, indptr, indices, data)
    entries = (data[: indptr[-1]], indices[: indptr[-1]], indptr)
    found = sparse.csr_array(entries, shape=(n, len(columns)))
    return (_following(found, columns, T, free) if follows else found), columns


def _following(
    spread: sparse.csr_array, columns: Ints, T: sparse.csr_array, free: Bools
) -> sparse.csr_array:
    """A prolongation without constraints with those that lead from some corners to others."""
    n, m = spread.shape
    keeps = sparse.csr_array((np.ones(m), (columns, np.arange(m))), shape=(n, m))
    found = (spread @ T[columns][:, columns] + keeps).tocsr()
    row, column = np.repeat(np.arange(n), np.diff(found.indptr)), columns[found.indices]
    found.data *= free[row] & free[column]
    found.data[row == column] = 1.0
    found.eliminate_zeros()
    indptr, indices = pattern_of(found)
    return sparse.csr_array((found.data, indices, indptr), shape=found.shape)


@njit(cache=True, nogil=True)
def _find_places(cells: Index, n_corners: int, place: NDArray[np.int64], is_corner: Bools) -> None:
    """A place of each node in ``cells``, flat: on nodes that cells share all agree."""
    n_cells, k = cells.shape
    for c in range(n_cells):
        for a in range(k):
            place[cells[c, a]] = c * k + a
        for a in range(n_corners):
            is_corner[cells[c, a]] = True


@njit(cache=True, nogil=True)
def _fill(
    cells: Index,
    weights: Floats,
    place: NDArray[np.int64],
    number: Index,
    kept: Bools,
    indptr: Index,
    indices: Index,
    data: Floats,
) -> None:
    """Rows of the prolongation: weights of corners between degrees of freedom that are kept.

    The corners themselves, and reference points, keep their place in any case.
    """
    k, n_corners = weights.shape
    end = 0
    for i in range(len(place)):
        c = place[i] // k
        a = place[i] - c * k
        for axis in range(3):
            for b in range(n_corners):
                corner = cells[c, b]
                itself = corner == i
                both = kept[3 * i + axis] and kept[3 * corner + axis]
                if weights[a, b] != 0.0 and (itself or both):
                    indices[end] = 3 * number[corner] + axis
                    data[end] = 1.0 if itself else weights[a, b]
                    end += 1
            indptr[3 * i + axis + 1] = end
    column = 3 * (number[len(place) - 1] + 1)
    for i in range(3 * len(place), len(kept)):
        indices[end], data[end] = column, 1.0
        column += 1
        end += 1
        indptr[i + 1] = end
