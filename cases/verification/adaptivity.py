"""Meshes that are fine where the error is: mark by indicators, and mesh again with smaller sizes.

The shape is meshed again each time, so that curved surfaces stay as exact as the mesh is fine.
"""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.geometry import LocalSizes

#: Share of the estimated error in the marked cells (Doerfler 1996), and what their size becomes.
SHARE, FACTOR = 0.5, 0.5


def marked(indicators: Floats, share: float = SHARE) -> Ints:
    """The fewest cells that hold a share of the estimated error (Doerfler 1996, SIAM J. Numer.
    Anal. 33, 1106-1124).

    Parameters
    ----------
    indicators : Floats
        Energy (n,) of the error in each cell.
    share : float
        Share of their sum, above 0 and at most 1.

    Returns
    -------
    Indices, in descending order of the indicator.

    Raises
    ------
    InputError
        The share is not between 0 and 1.
    """
    if not 0.0 < share <= 1.0:
        raise InputError(f"share = {share:g} of the error to mark must be above 0 and at most 1")
    order = np.argsort(-indicators, kind="stable")
    held = np.cumsum(indicators[order])
    return np.asarray(order[: 1 + int(np.searchsorted(held, share * held[-1]))])


def cell_sizes(points: Floats, cells: Ints) -> Floats:
    """(n_cells,) edge length of the regular tetrahedron of each cell's volume, by corners [m]."""
    a, b, c, d = np.moveaxis(points[cells[:, :4]], 1, 0)
    six_volumes = np.abs(np.einsum("ei,ei->e", b - a, np.cross(c - a, d - a)))
    return np.asarray((np.sqrt(2.0) * six_volumes) ** (1.0 / 3.0))


def refined_sizes(mesh: Mesh, cells: Ints, factor: float = FACTOR) -> LocalSizes:
    """Element sizes for the next mesh: smaller in the marked cells, elsewhere as they are.

    Parameters
    ----------
    mesh : Mesh
        Mesh that was solved.
    cells : Ints
        Indices of the cells to refine.
    factor : float
        Factor on the size of marked cells; above 0 and below 1.

    Raises
    ------
    InputError
        The factor does not refine.
    """
    if not 0.0 < factor < 1.0:
        raise InputError(f"factor = {factor:g} on the size of marked cells must be in (0, 1)")
    sizes = cell_sizes(mesh.points, mesh.cells)
    corners = mesh.cells[:, :4]
    # a node takes the mean of its cells, but the minimum where one of them is marked
    number, total = np.zeros(len(mesh.points)), np.zeros(len(mesh.points))
    np.add.at(number, corners, 1.0)
    np.add.at(total, corners, sizes[:, None])
    at_nodes = total / np.maximum(number, 1.0)
    np.minimum.at(at_nodes, corners[cells], factor * sizes[cells][:, None])
    return LocalSizes(mesh.points[corners], at_nodes[corners])
