"""Which facets have the same corners: what two cells share, and what one has alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Bools, Ints
from fe_drivetrain.elasticity.mesh.mesh import FACETS, Mesh


def facet_keys(corners: Ints, n_nodes: int) -> Ints:
    """One number for each facet, (m, 3) or (m, 4) corners, whatever their order.

    For triangles the number is exact up to two million nodes; beyond, what 64 bits hold of it,
    which is wrong only where two differ by a multiple of 2^64. For quadrilaterals it is wrong where
    two share their lowest and highest corner and the sum of the others.
    """
    # column by column: NumPy takes ten times as long along so short an axis
    columns = list(corners.T)
    low, high, total = (each.reduce(columns) for each in (np.minimum, np.maximum, np.add))
    n = np.int64(n_nodes)
    with np.errstate(over="ignore"):
        result: Ints = (low * n + (total - low - high)) * n + high
    return result


def are_among(facets: Ints, others: Ints, n_nodes: int) -> Bools:
    """Which facets, by their corners, stand among others, (m, 3 or more) nodes each."""
    keys, among = (facet_keys(some[:, :3], n_nodes) for some in (facets, others))
    return np.asarray(np.isin(keys, among), dtype=np.bool_)


@dataclass(frozen=True)
class SharedFacets:
    """Facets of all cells, 4 a cell, and the pairs of them that have the same corners.

    Attributes
    ----------
    n_nodes : int
        Number of nodes of the mesh.
    keys : Ints
        Numbers (4 ne,), one for each triple of corners, ascending.
    order : Ints
        Facets (4 ne,) that they belong to.
    first, second : Ints
        Facets (k,) of the pairs.
    more : Ints
        Facets that a third cell has as well.
    alone : Ints
        Facets (m,) of one cell only.
    """

    n_nodes: int
    keys: Ints
    order: Ints
    first: Ints
    second: Ints
    more: Ints
    alone: Ints

    @staticmethod
    def of(mesh: Mesh) -> SharedFacets:
        """Facets of a mesh of tetrahedra."""
        keys = facet_keys(mesh.cells[:, FACETS[:, :3]].reshape(-1, 3), len(mesh.points))
        order = np.argsort(keys, kind="stable")
        keys = keys[order]
        same = np.zeros(len(keys) + 1, dtype=bool)
        same[1:-1] = keys[1:] == keys[:-1]
        starts, follows = ~same[:-1], same[1:]
        return SharedFacets(
            len(mesh.points),
            keys,
            order,
            order[:-1][same[1:-1]],
            order[1:][same[1:-1]],
            order[1:][same[1:-1] & same[:-2]],
            order[starts & ~follows],
        )

    def found(self, corners: Ints, part: Ints, wanted: int) -> Bools:
        """Which (m, 3) triples of corners are a facet of a cell of part number `wanted`."""
        keys = facet_keys(corners, self.n_nodes)
        at = np.searchsorted(self.keys, keys)
        result = np.zeros(len(keys), dtype=bool)
        for k in (at, at + 1):
            there = np.minimum(k, len(self.keys) - 1)
            result |= (self.keys[there] == keys) & (part[self.order[there] // 4] == wanted)
        return result
