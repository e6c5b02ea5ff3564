"""Which nodes are connected by cells: the bodies of a mesh."""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from fe_drivetrain.common.arrays import Ints
from fe_drivetrain.elasticity.mesh.shapes import element_kind


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
    corners = cells[:, : element_kind(cells.shape[1]).n_corners]
    first = np.repeat(corners[:, 0], corners.shape[1] - 1)
    shape = (n_nodes, n_nodes)
    graph = sparse.coo_array((np.ones(first.size), (first, corners[:, 1:].ravel())), shape=shape)
    body = connected_components(graph, directed=False)[1]
    middles = cells[:, corners.shape[1] :]
    body[middles] = body[corners[:, :1]]
    _, earliest, number = np.unique(body, return_index=True, return_inverse=True)
    return np.asarray(np.argsort(np.argsort(earliest))[number], dtype=np.int64)
