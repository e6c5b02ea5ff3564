"""The mesh: curved ten-node tetrahedra with named volumes, faces and points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from skfem import MeshTet2

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.elasticity.mesh.facets import local_facets, outside

FACETS = local_facets(10)
"""Local nodes of the four facets of a tetrahedron, turned outward: corners, then mid-sides."""


@dataclass(frozen=True)
class Mesh:
    """A mesh of curved second-order tetrahedra.

    Attributes
    ----------
    points : Floats
        Positions (n, 3) of the nodes, m.
    cells : Ints
        Node ids (ne, 10) in VTK's order, which is scikit-fem's too.
    part : Ints
        Index (ne,) into `part_names`.
    part_names : tuple[str, ...]
        Names of the parts.
    faces : dict[str, Ints]
        Node ids (nf, 6) of the six-node triangles of each named face, normal outward from the part
        whose name the face's name begins with.
    named_points : dict[str, int]
        Node id of each named point.
    kept : bool
        Whether it was taken from the cache instead of generated.
    """

    points: Floats
    cells: Ints
    part: Ints
    part_names: tuple[str, ...]
    faces: dict[str, Ints]
    named_points: dict[str, int]
    kept: bool = False

    __repr__ = short_repr

    def part_cells(self, name: str) -> Ints:
        """Indices of the cells of a part, ascending."""
        if name not in self.part_names:
            raise InputError(
                f"no part {name!r} in the mesh: use one of {', '.join(self.part_names)}"
            )
        return np.flatnonzero(self.part == self.part_names.index(name))

    def part_nodes(self, name: str) -> Ints:
        """Ids of the nodes of a part, ascending."""
        return np.unique(self.cells[self.part_cells(name)])

    def face_nodes(self, name: str) -> Ints:
        """Ids of the nodes of a named face, ascending."""
        if name not in self.faces:
            raise InputError(f"no face {name!r} in the mesh: use one of {', '.join(self.faces)}")
        return np.unique(self.faces[name])

    def as_skfem(self, part: str | None = None) -> MeshTet2:
        """The mesh, or one part of it, as scikit-fem's curved tetrahedra.

        scikit-fem renumbers the nodes: find them again by position, or through its own facets.
        """
        cells = self.cells if part is None else self.cells[self.part_cells(part)]
        nodes, local = np.unique(cells, return_inverse=True)
        return MeshTet2(self.points[nodes].T.copy(), local.reshape(cells.shape).T.copy())


def part_of(face: str, part_names: Sequence[str]) -> str:
    """Name of the part that a face's name begins with: the longest that fits."""
    return max((p for p in part_names if face.startswith(f"{p}.")), key=len)


def boundary(mesh: Mesh, part: str | None = None) -> Ints:
    """Facets (nf, 6), turned outward, that belong to one cell only of the mesh or of a part."""
    cells = mesh.cells if part is None else mesh.cells[mesh.part_cells(part)]
    return outside(cells)
