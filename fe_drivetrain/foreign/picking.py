"""Faces of a mesh from a file: by label, plane, cylinder, sphere, or a point on a smooth face."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.shared_facets import are_among
from fe_drivetrain.geometry import Pick

_ON_PLANE = 1e-5  # of the solid's size
_ON_CURVE = 2e-3  # of a radius: nodes of a face that is meant
_SMOOTH = np.cos(np.radians(25.0))  # between facets of one face


class Surface:
    """The outside of a mesh: its facets, and what a pick of faces finds among them.

    Parameters
    ----------
    name : str
        Name of the file, for messages.
    points : Floats
        Nodes (n, 3), in the file's unit.
    facets : Ints
        Facets (k, 6) of the outside, turned outward.
    sets : Mapping[str, NDArray]
        Sets of the file: "face LABEL" (m, 3) corners, "nodes LABEL", and "empty LABEL" of those
        without members.
    """

    def __init__(
        self, name: str, points: Floats, facets: Ints, sets: Mapping[str, NDArray[np.int64]]
    ) -> None:
        self.name, self.points, self.facets, self.sets = name, points, facets, sets
        corners = points[facets[:, :3]]
        vectors = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        lengths = np.maximum(np.linalg.norm(vectors, axis=1), np.finfo(float).tiny)
        self.normals = vectors / lengths[:, None]
        self.middles = corners.mean(axis=1)
        self.size = float(np.linalg.norm(np.ptp(points[np.unique(facets[:, :3])], axis=0)))

    def picked(self, pick: Pick, what: str) -> Ints:
        """Numbers of the facets of a pick.

        Raises
        ------
        InputError
            There are none, or a mesh has nothing of that kind.
        """
        if pick.colour is not None:
            raise InputError(
                f"{self.name}: the {what} is picked by a colour, which a mesh does not have: pick "
                "it by a label, a plane, a cylinder or a point"
            )
        if pick.label is not None:
            found = self._labelled(pick.label, what)
        elif pick.radius is not None:
            found = self._round(pick, what)
        elif pick.normal is not None:
            assert pick.point is not None
            normal = np.array(pick.normal) / np.linalg.norm(pick.normal)
            away = (self.points[self.facets[:, :3]] - np.array(pick.point)) @ normal
            found = np.abs(away).max(axis=1) < _ON_PLANE * self.size
        else:
            assert pick.point is not None
            found = self._smooth(np.array(pick.point))
        if not found.any() and pick.label is not None:
            raise InputError(
                f"{self.name}: the set {pick.label!r} for the {what} holds no whole face of the "
                f"outside: use one of {self.labels()}, or pick by a plane, a cylinder or a point"
            )
        if not found.any():
            raise InputError(
                f"{self.name}: there is no face for the {what} with {pick.words()}: correct it "
                f"(labels of faces: {self.labels()})"
            )
        return np.flatnonzero(found)

    def picked_all(self, picks: Sequence[Pick], what: str) -> Ints:
        """Numbers of the facets of all picks, ascending; see `picked`."""
        found = [np.zeros(0, dtype=np.int64), *(self.picked(pick, what) for pick in picks)]
        return np.asarray(np.unique(np.concatenate(found)), dtype=np.int64)

    def labels(self) -> str:
        """Labels of faces, in words."""
        found = [k.partition(" ")[2] for k in self.sets if k.startswith(("face ", "nodes "))]
        return ", ".join(dict.fromkeys(found[:30])) or "none"

    def _labelled(self, label: str, what: str) -> Bools:
        if (corners := self.sets.get(f"face {label}")) is not None:
            return are_among(self.facets, corners, len(self.points))
        if (nodes := self.sets.get(f"nodes {label}")) is not None:
            return np.asarray(np.isin(self.facets[:, :3], nodes).all(axis=1), dtype=np.bool_)
        if f"empty {label}" in self.sets:
            raise InputError(
                f"{self.name}: the set {label!r} for the {what} is empty: give it members, use one "
                f"of {self.labels()}, or pick by a plane, a cylinder or a point"
            )
        raise InputError(
            f"{self.name}: there is no face {label!r} for the {what}: use one of {self.labels()}, "
            "or pick by a plane, a cylinder or a point"
        )

    def _round(self, pick: Pick, what: str) -> Bools:
        radius = pick.radius
        assert radius is not None
        centre = pick.centre or pick.point
        if centre is None or (pick.centre is None and pick.axis is None):
            raise InputError(
                f"{self.name}: the {what} is picked by {pick.words()}, but of a mesh a cylinder is "
                "found by radius, axis and a point on the axis, a sphere by radius and centre: "
                "give these"
            )
        corners = self.points[self.facets[:, :3]]
        away = corners - np.array(centre)
        out = self.middles - np.array(centre)
        if pick.centre is None:
            assert pick.axis is not None
            axis = np.array(pick.axis) / np.linalg.norm(pick.axis)
            away = away - (away @ axis)[..., None] * axis
            out = out - (out @ axis)[:, None] * axis
        off = np.abs(np.linalg.norm(away, axis=2) - radius).max(axis=1)
        lengths = np.maximum(np.linalg.norm(out, axis=1), np.finfo(float).tiny)
        inward = np.einsum("fi,fi->f", self.normals, out) / lengths
        return np.asarray((off < _ON_CURVE * radius) & (inward < -0.7), dtype=np.bool_)

    def _smooth(self, point: Floats) -> Bools:
        """The face about the facet nearest to a point: over edges that are smooth."""
        start = int(np.argmin(np.linalg.norm(self.middles - point, axis=1)))
        near = np.linalg.norm(self.points[self.facets[:, :3]] - point, axis=2).min(axis=1)
        if min(near[start], np.linalg.norm(self.middles[start] - point)) > 0.1 * self.size:
            return np.zeros(len(self.facets), dtype=np.bool_)
        k, n = len(self.facets), len(self.points)
        ends = np.sort(self.facets[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        keys = ends[:, 0] * n + ends[:, 1]
        order = np.argsort(keys, kind="stable")
        same = np.flatnonzero(keys[order][1:] == keys[order][:-1])
        one, two = order[same] // 3, order[same + 1] // 3
        smooth = np.einsum("fi,fi->f", self.normals[one], self.normals[two]) > _SMOOTH
        one, two = one[smooth], two[smooth]
        graph = sparse.coo_array((np.ones(len(one)), (one, two)), shape=(k, k))
        face = connected_components(graph, directed=False)[1]
        return np.asarray(face == face[start], dtype=np.bool_)
