"""Compiled loops over the graph of a matrix: its nodes, and which of them its blocks connect.

Compiled by numba at the first call (seconds), then kept in its cache on disk.
"""

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.compiled import njit
from fe_drivetrain.elasticity.operator.element_loops import in_pieces
from fe_drivetrain.elasticity.operator.kernels import Index

# Rows that a thread takes at once, and so few that they take less time than threads to start.
_PIECES, _FEW = 8, 20_000


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


def places(
    indptr: Index, indices: Index, rows: NDArray[np.int64], columns: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Places of the blocks of some rows and columns in ``data``; -1 where there are none."""
    # NumPy makes the array out here: in a compiled loop that takes longer to compile
    found = np.full(len(rows), -1, np.int64)
    _find_places(indptr, indices, rows, columns, found)
    return found


@njit(cache=True)
def _find_places(
    indptr: Index,
    indices: Index,
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    found: NDArray[np.int64],
) -> None:
    for k in range(len(rows)):
        for p in range(indptr[rows[k]], indptr[rows[k] + 1]):
            if indices[p] == columns[k]:
                found[k] = p
                break


def diagonal(indptr: Index, indices: Index, data: Floats) -> Floats:
    """Diagonal blocks (n, 3, 3); zero where there are none."""
    blocks = np.zeros((len(indptr) - 1, 3, 3))
    flat = indptr, indices, data.reshape(-1), blocks.reshape(-1)
    if len(blocks) < _FEW:
        for piece in range(_PIECES):
            _copy_diagonal(piece, *flat)
    else:
        in_pieces(_PIECES, _copy_diagonal, *flat)
    return blocks


@njit(cache=True, nogil=True)
def _copy_diagonal(piece: int, indptr: Index, indices: Index, data: Floats, blocks: Floats) -> None:
    n = len(indptr) - 1
    for i in range(piece * n // _PIECES, (piece + 1) * n // _PIECES):
        for p in range(indptr[i], indptr[i + 1]):
            if indices[p] == i:
                for k in range(9):
                    blocks[9 * i + k] = data[9 * p + k]
                break
