"""Elements of a mesh file that stand in one another: doubles, faces of three, bodies that overlap.

This runs in a process of its own, see `reading`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fe_drivetrain.common.errors import InputError

_SIDES = np.array([[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]])
_DEPTH = 0.2  # of a boundary element's height: what facets of a fitted, curved joint may overlap
_WITHIN = 1e-6  # least barycentric coordinate of what is inside


def refuse_overlaps(name: str, points: Any, cells: Any) -> None:
    """Refuse elements that occupy the place of others.

    Two elements may share a face, from its two sides. Other overlaps begin at the outside: a place
    just below it that is in a second element is in two bodies, or where one body folds into itself.

    Parameters
    ----------
    name : str
        Name of the file, for messages.
    points : ndarray, (n, 3)
        Nodes.
    cells : ndarray, (ne, 4) or (ne, 10)
        Tetrahedra by rows of nodes, corners first.

    Raises
    ------
    InputError
        There are such elements; the message names how many, and where the first is.
    """
    corners = np.asarray(cells[:, :4])
    refuse_doubles(name, points, corners)
    owners, faces, outside = _faces(corners)
    _refuse_crowded(name, points, corners, owners, faces)
    owner, face = owners[outside], faces[outside]
    opposite = corners[owner].sum(axis=1) - corners[owner[:, None], face].sum(axis=1)
    triangles = corners[owner[:, None], face]
    middles = points[triangles].mean(axis=1)
    places = middles + _DEPTH * (points[opposite] - middles)
    found = _inside_of_another(points, corners, owner, places)
    if len(found):
        x, y, z = places[found[0]]
        raise InputError(
            f"{name}: elements overlap at {len(found)} of {len(places)} faces of the outside, the "
            f"first near ({x:.4g}, {y:.4g}, {z:.4g}): leave out what stands twice, or move the "
            "parts apart"
        )


def refuse_doubles(name: str, points: Any, corners: Any) -> None:
    """Refuse elements that stand on the corners of others."""
    _, at, count = np.unique(
        np.sort(corners, axis=1), axis=0, return_index=True, return_counts=True
    )
    if (count > 1).any():
        first = int(at[count > 1].min())
        x, y, z = points[corners[first]].mean(axis=0)
        raise InputError(
            f"{name}: {int((count - 1).sum())} of its {len(corners)} elements stand where another "
            f"does, the first near ({x:.4g}, {y:.4g}, {z:.4g}): leave out the doubles"
        )


def _faces(corners: Any) -> tuple[Any, Any, Any]:
    """Owner and local corners of each face of an element, and which are of no other one."""
    owners = np.repeat(np.arange(len(corners)), 4)
    faces = np.tile(_SIDES, (len(corners), 1))
    keys = np.sort(corners[owners[:, None], faces], axis=1)
    _, which, count = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    return owners, faces, np.flatnonzero(count[which.ravel()] == 1)


def _refuse_crowded(name: str, points: Any, corners: Any, owners: Any, faces: Any) -> None:
    """Refuse faces with two elements on one side."""
    own = corners[owners[:, None], faces]
    keys = np.sort(own, axis=1)
    a, b, c = (points[keys[:, k]] for k in range(3))
    across = np.cross(b - a, c - a)
    tip = points[corners[owners].sum(axis=1) - own.sum(axis=1)]
    side = np.einsum("fi,fi->f", across, tip - a) > 0
    _, first, count = np.unique(
        np.column_stack([keys, side]), axis=0, return_index=True, return_counts=True
    )
    if (count > 1).any():
        x, y, z = points[own[int(first[count > 1].min())]].mean(axis=0)
        raise InputError(
            f"{name}: elements overlap: {int((count > 1).sum())} faces have two of them on one "
            f"side, the first near ({x:.4g}, {y:.4g}, {z:.4g}): correct them, or mesh the part "
            "again"
        )


def _inside_of_another(points: Any, corners: Any, owner: Any, places: Any) -> Any:
    """Numbers of the places that are inside of an element other than their own, ascending."""
    from scipy.spatial import cKDTree

    at = points[corners]
    centres = at.mean(axis=1)
    radii = np.linalg.norm(at - centres[:, None], axis=2).max(axis=1)
    tree = cKDTree(places)
    some = np.flatnonzero(tree.query_ball_point(centres, radii, return_length=True))
    near = tree.query_ball_point(centres[some], radii[some])
    lengths = np.fromiter(map(len, near), dtype=np.int64)
    cell = np.repeat(some, lengths)
    place = np.fromiter((k for row in near for k in row), dtype=np.int64)
    other = owner[place] != cell
    cell, place = cell[other], place[other]
    within = np.zeros(len(cell), dtype=np.bool_)
    for part in range(0, len(cell), 1_000_000):
        rows = slice(part, part + 1_000_000)
        within[rows] = _barycentric(at[cell[rows]], places[place[rows]]).min(axis=1) > _WITHIN
    return np.unique(place[within])


def _barycentric(corners: Any, places: Any) -> Any:
    """Barycentric coordinates (k, 4) of places in elements (k, 4, 3); none are in flat ones."""
    edges = corners[:, 1:] - corners[:, :1]
    volume = np.einsum("ki,ki->k", edges[:, 0], np.cross(edges[:, 1], edges[:, 2]))
    arm = places - corners[:, 0]
    with np.errstate(all="ignore"):
        b = np.einsum("ki,ki->k", arm, np.cross(edges[:, 1], edges[:, 2])) / volume
        c = np.einsum("ki,ki->k", edges[:, 0], np.cross(arm, edges[:, 2])) / volume
        d = np.einsum("ki,ki->k", edges[:, 0], np.cross(edges[:, 1], arm)) / volume
    found = np.column_stack([1.0 - b - c - d, b, c, d])
    return np.where(np.isfinite(found), found, -1.0)
