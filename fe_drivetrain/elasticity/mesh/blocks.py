"""Structured blocks: a lattice on the unit cube, carried to its shape by a map.

For solids whose shape is a formula: bricks, sectors of rings, plates, curved bars. Mid-side nodes
are mapped as corners are, so that curved faces are met by quadratic elements.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.elasticity.mesh.facets import local_facets
from fe_drivetrain.elasticity.mesh.hexahedra import VTK_LATTICE
from fe_drivetrain.elasticity.mesh.linear import renumbered
from fe_drivetrain.elasticity.mesh.shapes import TETRAHEDRON_EDGES, element_kind

FACES = ("x0", "x1", "y0", "y1", "z0", "z1")

_ON_FACE = 1e-12  # of the unit cube
_SAME_PLACE = 1e-9  # of the block's extent


@dataclass(frozen=True)
class Block:
    """A structured mesh with the six faces of the cube that it came from.

    Attributes
    ----------
    points : Floats
        Nodes (n, 3) [m].
    cells : Ints
        (n_cells, k) node numbers in VTK's order.
    faces : dict[str, Ints]
        (n_facets, j) facets in VTK's order, turned outward, of ``x0``, ``x1``, ``y0``, ... as they
        were on the cube.
    """

    points: Floats
    cells: Ints
    faces: dict[str, Ints]

    __repr__ = short_repr

    def face_nodes(self, name: str) -> Ints:
        """Nodes of a face, ascending."""
        if name not in self.faces:
            raise InputError(f"no face {name!r} in the block: use one of {', '.join(self.faces)}")
        return np.unique(self.faces[name])


def brick(
    divisions: tuple[int, int, int],
    nodes: int = 27,
    shape: Callable[[Floats], Floats] | None = None,
    edges: Sequence[ArrayLike | None] = (None, None, None),
) -> Block:
    """Mesh the unit cube, and carry it to another shape.

    Parameters
    ----------
    divisions : tuple[int, int, int]
        Numbers of hexahedra along each direction.
    nodes : int
        Number of nodes of each element: hexahedra of 8, 20 or 27, or tetrahedra of 4 or 10, six in
        each hexahedron.
    shape : callable or None
        Function from places (n, 3) in the unit cube to positions (n, 3) [m], right-handed.
    edges : Sequence[ArrayLike or None]
        Places of the elements' boundaries for each direction, from 0 to 1, in place of divisions of
        equal length.

    Raises
    ------
    InputError
        No element has so many nodes, or the map turns elements inside out.
    """
    kind = element_kind(nodes)
    axes = []
    for n, given in zip(divisions, edges, strict=True):
        at = np.linspace(0.0, 1.0, n + 1) if given is None else np.asarray(given, dtype=float)
        half = np.empty(2 * len(at) - 1)
        half[::2], half[1::2] = at, 0.5 * (at[1:] + at[:-1])
        axes.append(half)
    unit = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    number = np.arange(unit[..., 0].size).reshape(unit.shape[:3])
    windows = np.lib.stride_tricks.sliding_window_view(number, (3, 3, 3))[::2, ::2, ::2]
    lattice = windows.reshape(-1, 3, 3, 3)
    if kind.n_corners == 8:
        cells = lattice[:, *VTK_LATTICE[:nodes].T]
    else:
        cells = np.concatenate([lattice[:, *corner.T] for corner in _tetrahedra(nodes)])
    mesh = renumbered(unit.reshape(-1, 3), np.ascontiguousarray(cells))
    facets = mesh.cells[:, local_facets(nodes)].reshape(-1, local_facets(nodes).shape[1])
    faces = {}
    for k, name in enumerate(FACES):
        there = np.abs(mesh.points[facets, k // 2] - k % 2).max(axis=1) < _ON_FACE
        faces[name] = facets[there]
    points = mesh.points if shape is None else np.asarray(shape(mesh.points), dtype=float)
    a, b, c, d = (points[mesh.cells[:, i]] for i in (0, 1, 3, 4 if kind.n_corners == 8 else 2))
    if kind.n_corners == 4:
        c, d = d, c
    if (np.einsum("ei,ei->e", b - a, np.cross(c - a, d - a)) <= 0.0).any():
        raise InputError(
            "the map of the block turns elements inside out: map the unit cube right-handed, and "
            "every point of it to a place of its own"
        )
    return Block(points, mesh.cells, faces)


def joined(block: Block) -> Block:
    """The block with nodes at the same position merged: rings that close, a cube's face on itself.

    Facets that have become inner ones still stand under the names that they had.
    """
    from scipy.spatial import cKDTree

    tolerance = _SAME_PLACE * float(np.ptp(block.points, axis=0).max())
    pairs = cKDTree(block.points).query_pairs(tolerance, output_type="ndarray")
    twin = np.arange(len(block.points))
    # ascending, so that of three nodes at one place all go to the first
    for low, high in pairs[np.lexsort((pairs[:, 0], pairs[:, 1]))]:
        twin[high] = twin[low]
    mesh = renumbered(block.points, twin[block.cells])
    faces = {name: mesh.number[twin[facets]] for name, facets in block.faces.items()}
    return Block(mesh.points, mesh.cells, faces)


def _tetrahedra(nodes: int) -> list[Ints]:
    """Lattice places (nodes, 3) of the six tetrahedra about a cube's long diagonal (Kuhn 1960)."""
    found = []
    for order in permutations(range(3)):
        corners = np.zeros((4, 3), dtype=np.int64)
        for step, axis in enumerate(order, start=1):
            corners[step:, axis] = 2
        if np.linalg.det(corners[1:] - corners[0]) < 0:
            corners[[2, 3]] = corners[[3, 2]]
        places = [*corners, *((corners[i] + corners[j]) // 2 for i, j in TETRAHEDRON_EDGES)]
        found.append(np.array(places[:nodes]))
    return found
