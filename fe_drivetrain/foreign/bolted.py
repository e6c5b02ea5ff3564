"""Joints that bolts hold together: solids are joined in annuli round the holes, else open.

The annulus is what the bolts' preload keeps pressed; it is linear, so that it neither opens nor
grows. Elsewhere the two sides have nodes of their own and move freely on one another.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from fe_drivetrain.common.arrays import Bools, Ints
from fe_drivetrain.elasticity.mesh.facets import facet_points
from fe_drivetrain.elasticity.mesh.mesh import FACETS, Mesh
from fe_drivetrain.elasticity.mesh.shared_facets import facet_keys

MAX_BETWEEN_RIMS = 0.1
"""Share of the open facets that may stay joined without a warning."""

SIDES = ("joint 1", "joint 2")
"""Names of both sides of an open joint."""


def opened(mesh: Mesh, open_: Ints, pressed: Ints) -> Mesh:
    """Divide a mesh in the open facets of its joint.

    Parameters
    ----------
    mesh : Mesh
        Mesh of solids that share nodes where they touch; one part, "body".
    open_, pressed : Ints
        Facets (nf, 6) between solids that shall be open, and those that stay joined.

    Returns
    -------
    Mesh
        Mesh in which nodes of open facets stand twice, once for each side, but for those that the
        pressed ones have, too; a facet with such corners alone stays joined. "body.joint 1" and
        "body.joint 2" are the two sides.
    """
    n, cells = len(mesh.points), mesh.cells
    # a facet between rims alone would be divided in its middle nodes, not at its corners
    rims = np.isin(open_[:, :3], pressed).all(axis=1)
    open_, pressed = open_[~rims], np.concatenate([pressed, open_[rims]])
    keys = facet_keys(cells[:, FACETS[:, :3]].reshape(-1, 3), n)
    open_keys = facet_keys(open_[:, :3], n)
    between = np.isin(keys, np.concatenate([open_keys, facet_keys(pressed[:, :3], n)]))
    solid = _solids(keys, ~between, len(cells))
    split = np.zeros(n, dtype=np.bool_)
    split[open_] = True
    split[pressed] = False
    # each solid but a node's first gets a node of its own there
    at = split[cells]
    count = int(solid.max()) + 1
    owner = np.broadcast_to(solid[:, None], cells.shape)[at]
    pairs, inverse = np.unique(cells[at] * count + owner, return_inverse=True)
    nodes = pairs // count
    again = np.zeros(len(pairs), dtype=np.bool_)
    again[1:] = nodes[1:] == nodes[:-1]
    number = np.where(again, n - 1 + np.cumsum(again), nodes)
    apart = cells.copy()
    apart[at] = number[inverse.ravel()]
    facets = apart[:, FACETS].reshape(-1, FACETS.shape[1])
    order = np.lexsort((np.repeat(solid, 4), keys))

    def of_cells(face: Ints) -> Ints:
        wanted = facet_keys(face[:, :3], n)
        return np.asarray(facets[order[np.searchsorted(keys[order], wanted)]], dtype=np.int64)

    faces = {name: of_cells(face) for name, face in mesh.faces.items()}
    first = np.searchsorted(keys[order], open_keys)
    for side, name in enumerate(SIDES):
        faces[f"body.{name}"] = facets[order[first + side]]
    points = np.vstack([mesh.points, mesh.points[nodes[again]]])
    return replace(mesh, points=points, cells=apart, faces=faces)


def joined_between_rims(mesh: Mesh, open_: Ints, pressed: Ints) -> float:
    """Share of the open facets' area that stays joined in `opened`: those between rims alone.

    Parameters
    ----------
    mesh : Mesh
        Mesh as `opened` takes it.
    open_, pressed : Ints
        Facets (nf, 6), see `opened`.
    """
    areas = facet_points(mesh.points, open_).areas.sum(axis=1)
    rims = np.isin(open_[:, :3], pressed).all(axis=1)
    return float(areas[rims].sum() / areas.sum())


def _solids(keys: Ints, joined: Bools, n_cells: int) -> Ints:
    """(n_cells,) number of the solid of each cell: those that share a joined facet are one."""
    facets = np.flatnonzero(joined)
    facets = facets[np.argsort(keys[facets], kind="stable")]
    same = np.flatnonzero(keys[facets][1:] == keys[facets][:-1])
    one, two = facets[same] // 4, facets[same + 1] // 4
    graph = sparse.coo_array((np.ones(len(one)), (one, two)), shape=(n_cells, n_cells))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)
