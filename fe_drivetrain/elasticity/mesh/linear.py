"""Meshes of one element converted to meshes of a cheaper one: straight edges, or corners alone."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.elasticity.mesh.shapes import element_kind


class Renumbered(NamedTuple):
    """A mesh that has only the nodes that its cells use.

    Attributes
    ----------
    points : Floats
        Nodes (n, 3), m.
    cells : Ints
        Node ids (ne, nodes of a cell).
    number : Ints
        (n_before,) new id of each node of the mesh before, -1 for those left out.
    """

    points: Floats
    cells: Ints
    number: Ints

    def nodes(self, before: Ints) -> Ints:
        """New ids of those of the given nodes that are still there, in their order."""
        new = self.number[before]
        return np.asarray(new[new >= 0])


def straightened(points: Floats, cells: Ints) -> Floats:
    """The points with all nodes but the corners where straight edges and plain faces have them.

    Parameters
    ----------
    points : Floats
        Nodes (n, 3), m.
    cells : Ints
        Node ids (ne, k) in VTK's order.

    Returns
    -------
    (n, 3) positions, m: corners where they were, mid-side nodes in the middle of their edges.

    Raises
    ------
    InputError
        No element has k nodes.
    """
    kind = element_kind(cells.shape[1])
    weights = kind.corner_weights()[kind.n_corners :]
    corners = points[cells[:, : kind.n_corners]]
    moved = points.copy()
    moved[cells[:, kind.n_corners :]] = np.einsum("mc,eci->emi", weights, corners)
    return moved


def first_order(points: Floats, cells: Ints) -> Renumbered:
    """The corners of the cells as linear elements, renumbered without gaps.

    Parameters
    ----------
    points : Floats
        Nodes (n, 3), m.
    cells : Ints
        Node ids (ne, k) in VTK's order.

    Raises
    ------
    InputError
        No element has k nodes.
    """
    return renumbered(points, cells[:, : element_kind(cells.shape[1]).n_corners])


def renumbered(points: Floats, cells: Ints) -> Renumbered:
    """The mesh without the nodes that no cell uses, the others in their order."""
    used = np.unique(cells)
    number = np.full(len(points), -1)
    number[used] = np.arange(len(used))
    return Renumbered(points[used], number[cells], number)
