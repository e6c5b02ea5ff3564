"""Cells and facets name nodes that there are: checked before any array is indexed with them."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common.arrays import Ints
from fe_drivetrain.common.errors import InputError


def check_nodes(cells: Ints, n_nodes: int, what: str = "cell") -> None:
    """Refuse cells or facets that name nodes that there are not.

    Parameters
    ----------
    cells : Ints
        (n_cells, k) node numbers.
    n_nodes : int
        Number of nodes.
    what : str
        "cell" or "facet".

    Raises
    ------
    InputError
        The numbers are not whole, not in rows, or not from 0 to n_nodes - 1; the first such cell
        and its node are named.
    """
    if cells.ndim != 2 or not np.issubdtype(cells.dtype, np.integer):
        raise InputError(
            f"{what}s are an array of shape {cells.shape} and type {cells.dtype} but must be whole "
            f"numbers of nodes, one row a {what}: convert them with astype(int)"
        )
    if cells.size and not (cells.min() >= 0 and cells.max() < n_nodes):
        row, column = np.argwhere((cells < 0) | (cells >= n_nodes))[0]
        raise InputError(
            f"{what} {row} has node {cells[row, column]} but nodes are numbered 0 to "
            f"{n_nodes - 1}: correct the {what}s, or give all points"
        )
