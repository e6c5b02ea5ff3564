"""Which nodes are connected by cells: the bodies of a mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Ints
from fe_drivetrain.common.compiled import njit


def connected_bodies(cells: Ints, n_nodes: int) -> Ints:
    """Which body each node belongs to: parts that share nodes are one.

    Parameters
    ----------
    cells : ndarray, (n_cells, k)
        Node numbers in VTK's order.
    n_nodes : int
        Number of nodes; one that no cell has is a body of its own.

    Returns
    -------
    ndarray, (n_nodes,)
        Numbers from 0, in the order of each body's first node.
    """
    first = np.arange(n_nodes, dtype=np.int32)
    _join(np.ascontiguousarray(cells, dtype=np.int32), first)
    body: Ints = np.cumsum(first == np.arange(n_nodes), dtype=np.int64)
    return body[first] - 1


@njit(cache=True, nogil=True)
def _join(cells: NDArray[np.int32], first: NDArray[np.int32]) -> None:
    """In ``first``, which begins with each node's own number, the first node of its body.

    Each node leads to one before it, and a cell has its nodes lead to the first of all that they
    lead to (union-find, Tarjan 1975, J. ACM 22, 215-225).
    """
    for c in range(len(cells)):
        one = cells[c, 0]
        while first[one] != one:
            first[one] = first[first[one]]
            one = first[one]
        for a in range(1, cells.shape[1]):
            other = cells[c, a]
            while first[other] != other:
                first[other] = first[first[other]]
                other = first[other]
            if other < one:
                one, other = other, one
            first[other] = one
            first[cells[c, a]] = one
    for i in range(len(first)):  # what a node leads to comes before it, and is done
        first[i] = first[first[i]]
