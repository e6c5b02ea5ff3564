"""A body's mesh from that of a part of it, turned or mirrored: symmetric to the last digit."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import gmsh
import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.generation import (
    ATTEMPTS,
    REFINEMENT,
    read_gmsh,
    relax_flat_cells,
)
from fe_drivetrain.elasticity.mesh.measures import inverted_cells
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.geometry import BodySizes, gmsh_session

#: Nodes of a mirrored element in an order that keeps its volume, and its facets' normals, positive.
_MIRRORED_CELL = [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]
_MIRRORED_FACET = [0, 2, 1, 5, 4, 3]

_SAME_PLACE = 1e-7
"""Nodes of neighbours closer than this share of the body's size are one; gmsh copies a periodic
mesh to 1e-12."""


def meshed(build: Callable[[BodySizes], None], sizes: BodySizes) -> tuple[Mesh, BodySizes]:
    """Mesh what a function builds in an open gmsh model, in curved ten-node tetrahedra.

    Where elements fold over, it is meshed again, finer than asked for, a few times.

    Returns
    -------
    The mesh, and the sizes that it was generated with.

    Raises
    ------
    InputError
        It cannot be built, or elements fold over at every mesh size tried.
    """
    for _ in range(ATTEMPTS):
        with gmsh_session():
            build(sizes)
            gmsh.model.mesh.generate(3)
            gmsh.model.mesh.setOrder(2)
            mesh = relax_flat_cells(read_gmsh([]))
        folded = inverted_cells(mesh)
        if len(folded) == 0:
            return mesh, sizes
        sizes = sizes.scaled(1.0 / REFINEMENT)
    x, y, z = mesh.points[mesh.cells[folded[0], :4]].mean(axis=0)
    raise InputError(
        f"body {mesh.part_names[0]!r}: {len(folded)} of its curved elements fold over, the first "
        f"near ({x:.3g}, {y:.3g}, {z:.3g}) m: reduce its mesh size, or raise elements_per_turn"
    )


def mirror(axis: int) -> Floats:
    """(3, 3) the reflection that turns the sign of a coordinate."""
    Q = np.eye(3)
    Q[axis, axis] = -1.0
    return Q


def turns(count: int) -> list[Floats]:
    """(3, 3) turns about x by all multiples of a full turn over ``count``."""
    found = []
    for angle in 2 * np.pi * np.arange(count) / count:
        c, s = np.cos(angle), np.sin(angle)
        found.append(np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]))
    return found


def repeated(
    mesh: Mesh,
    copies: Sequence[Floats],
    cuts: Sequence[str],
    own: Mapping[str, Sequence[str]],
) -> Mesh:
    """Build the body that copies of a mesh make where they meet.

    Parameters
    ----------
    mesh : Mesh
        Mesh of one part of the body.
    copies : Sequence[Floats]
        Orthogonal matrices (3, 3), the first the identity.
    cuts : Sequence[str]
        Names of the faces where copies meet; they are no faces of the body.
    own : Mapping[str, Sequence[str]]
        Names that a face has in each copy, one a copy, by its name in the mesh; all other faces
        are one in all copies.

    Raises
    ------
    InputError
        The copies do not meet node by node.
    """
    n = len(mesh.points)
    points = np.concatenate([mesh.points @ Q.T for Q in copies])
    # nodes inside the copies differ: only those of the cuts can be one
    at_cut = np.unique(np.concatenate([mesh.face_nodes(name) for name in cuts]))
    nodes = (at_cut + n * np.arange(len(copies))[:, None]).ravel()
    size = float(np.ptp(points, axis=0).max())
    first = _first_at_the_same_place(points[nodes], _SAME_PLACE * size)
    number = np.arange(len(points))
    number[nodes] = nodes[first]
    if (np.bincount(first, minlength=len(nodes))[first] < 2).any():
        raise InputError(
            f"body {mesh.part_names[0]!r}: the meshes of its sectors do not meet: change its mesh "
            "size a little"
        )
    kept, number = np.unique(number, return_inverse=True)
    cells: list[Ints] = []
    faces: dict[str, Ints] = {}
    for k, Q in enumerate(copies):
        flipped = np.linalg.det(Q) < 0
        new = number[k * n : (k + 1) * n]
        cells.append(new[mesh.cells[:, _MIRRORED_CELL] if flipped else mesh.cells])
        for name, facets in mesh.faces.items():
            if name in cuts:
                continue
            found = new[facets[:, _MIRRORED_FACET] if flipped else facets]
            whole = own[name][k] if name in own else name
            faces[whole] = np.concatenate([faces[whole], found]) if whole in faces else found
    return Mesh(
        points[kept],
        np.concatenate(cells),
        np.tile(mesh.part, len(copies)),
        mesh.part_names,
        faces,
        {},
    )


def _first_at_the_same_place(points: Floats, tolerance: float) -> Ints:
    """(n,) for each point the first that is no farther away than a tolerance."""
    from scipy.spatial import cKDTree

    pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    first = np.arange(len(points))
    np.minimum.at(first, pairs[:, 1], pairs[:, 0])
    return first
