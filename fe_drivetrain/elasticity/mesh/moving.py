"""A mesh moved to a neighbour's dimensions: the same elements on the surfaces of changed parts.

Surfaces move as dimensions do (`surface_shifts`), and what is inside follows by Laplace's equation
on the straight tetrahedra of the corners, which carries a linear motion exactly (Loehner and Yang
1996, Commun. Numer. Methods Eng. 12, 599-608). Nodes between corners stay in their middle, and
as far off it as the surface bends an edge. Elements, faces and sparsity stay what they were, so
that the errors of two designs are nearly the same, and their change is smooth.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.elasticity.mesh.generation import relax_flat_cells
from fe_drivetrain.elasticity.mesh.measures import inverted_cells
from fe_drivetrain.elasticity.mesh.mesh import Mesh, boundary
from fe_drivetrain.elasticity.mesh.shapes import TETRAHEDRON_EDGES
from fe_drivetrain.elasticity.mesh.surface_shifts import (
    Parts,
    Shifts,
    block_shifts,
    revolved_shifts,
    same_block,
    same_outline,
)

LEAST_SHAPE = 0.5
"""Share of its shape (`shapes_of`) that every element must keep where a mesh is moved."""

MOST_STRETCH = 1.15
"""Ratio, or its inverse, by which no edge of an element may become longer or shorter.

Sizes stay near those of a mesh of its own; and farther on, a hierarchy of the first mesh takes more
iterations than its set-up does (``cases/performance/many_designs.py``)."""

_SAME = 1e-9  # [m] two parts move a node that they share alike
_HIDDEN = 1e-12  # [m] shifts below that are round-off


@dataclass(frozen=True)
class Moved:
    """A moved mesh, or why there is none.

    Attributes
    ----------
    mesh : Mesh or None
        The mesh; the very one that it was moved from where nothing moves.
    reason : str
        Why the parts must be meshed again; empty where they need not.
    shape, stretch : float
        Least share of its shape that an element has kept, and largest ratio of edges.
    """

    mesh: Mesh | None
    reason: str = ""
    shape: float = 1.0
    stretch: float = 1.0


class MovableMesh:
    """A mesh with what moves it: which nodes lie on which surface, and factors of an equation.

    Parameters
    ----------
    mesh : Mesh
        The mesh of these parts, as `fe_drivetrain.elasticity.mesh.generation.generate` makes it.
    parts : Parts
        What it was generated from.
    """

    def __init__(self, mesh: Mesh, parts: Parts) -> None:
        self.mesh, self.parts = mesh, parts
        self._bores = parts.check()
        self._surface = {p: np.unique(boundary(mesh, p)) for p in mesh.part_names}
        self._corners, local = np.unique(mesh.cells[:, :4], return_inverse=True)
        self._tetrahedra = local.reshape(-1, 4)
        self._laplacian: sparse.csr_array | None = None
        self._factors: dict[bytes, Callable[[Floats], Floats]] = {}

    def moved(
        self,
        parts: Parts,
        least_shape: float = LEAST_SHAPE,
        most_stretch: float = MOST_STRETCH,
    ) -> Moved:
        """Move the mesh to other dimensions of its parts.

        Parameters
        ----------
        parts : Parts
            Those that are wanted, of the same names.
        least_shape : float
            Share of its shape that each element must keep, 0 to 1.
        most_stretch : float
            Ratio by which no edge may become longer or shorter.

        Returns
        -------
        Moved
            Without a mesh where other faces are there, or elements become too flat, too long or
            too short.

        Raises
        ------
        InputError
            The parts do not fit together.
        """
        bores = parts.check()
        found = self._shifts(parts, bores)
        if isinstance(found, str):
            return Moved(None, found)
        if np.abs(found.values).max() < _HIDDEN:
            return Moved(self.mesh)
        points = self._all_points(found)
        shape = shapes_of(points, self.mesh.cells) / shapes_of(self.mesh.points, self.mesh.cells)
        ratios = _edges(points, self.mesh.cells) / _edges(self.mesh.points, self.mesh.cells)
        kept, stretch = float(shape.min()), float(np.maximum(ratios, 1.0 / ratios).max())
        if kept < least_shape:
            reason = f"an element would keep {kept:.2g} of its shape, at least {least_shape:g}"
            return Moved(None, reason, kept, stretch)
        if stretch > most_stretch:
            reason = f"an edge would change by a factor of {stretch:.3g}, at most {most_stretch:g}"
            return Moved(None, reason, kept, stretch)
        mesh = relax_flat_cells(replace(self.mesh, points=points, kept=False))
        if len(inverted_cells(mesh)):
            return Moved(None, "a curved element would fold over", kept, stretch)
        return Moved(mesh, "", kept, stretch)

    def _shifts(self, parts: Parts, bores: Mapping[str, float]) -> Shifts | str:
        """What the surfaces of all parts decide on, or why they cannot."""
        mesh, before = self.mesh, self.parts
        if parts.sizes != before.sizes:
            return "other sizes of elements are asked for"
        if parts.bonded != before.bonded or list(parts.housings) != list(before.housings):
            return "other parts are joined"
        known = np.zeros(mesh.points.shape, dtype=np.bool_)
        values = np.zeros(mesh.points.shape)
        for part, nodes in self._surface.items():
            found = self._of_part(part, mesh.points[nodes], parts, bores)
            if isinstance(found, str):
                return found
            both = known[nodes] & found.known
            if np.abs(np.where(both, values[nodes] - found.values, 0.0)).max(initial=0.0) > _SAME:
                return f"{part} and its neighbour move what they share in two ways"
            values[nodes] = np.where(found.known, found.values, values[nodes])
            known[nodes] |= found.known
        for name, node in mesh.named_points.items():
            shift = _named_shift(name, mesh.points[node], before, parts)
            if shift is None:
                return f"nothing tells how {name} moves"
            known[node], values[node] = True, shift
        return Shifts(known, values)

    def _of_part(
        self, part: str, points: Floats, parts: Parts, bores: Mapping[str, float]
    ) -> Shifts | str:
        old, new = self.parts.meridian(part, self._bores), parts.meridian(part, bores)
        if old is not None and new is not None:
            if not same_outline(old, new, self.parts.seats(), parts.seats()):
                return f"{part} has another outline: steps, tapers or seats differ"
            return revolved_shifts(points, old, new)
        blocks = self.parts.block(part), parts.block(part)
        if blocks[0] is None or blocks[1] is None:
            return f"{part} is neither round nor a pillow block in both designs"
        if not same_block(blocks[0], blocks[1]):
            return f"{part} has other faces"
        return block_shifts(points, blocks[0], blocks[1])

    def _all_points(self, given: Shifts) -> Floats:
        """Places (n, 3) of all nodes, from what the surfaces decide on."""
        mesh, corners = self.mesh, self._corners
        shift = given.values.copy()
        for c in range(3):
            shift[corners, c] = self._extended(given.known[corners, c], shift[corners, c])
        points = mesh.points + shift
        middles, first = np.unique(mesh.cells[:, 4:], return_index=True)
        ends = mesh.cells[:, TETRAHEDRON_EDGES].reshape(-1, 2)[first]
        follows = ~given.known[middles]
        of_ends = 0.5 * (shift[ends[:, 0]] + shift[ends[:, 1]])
        points[middles] += np.where(follows, of_ends, 0.0)
        return points

    def _extended(self, known: Bools, shift: Floats) -> Floats:
        """One component of all corners, harmonic where it is not known."""
        if not shift.any():
            return shift
        L = self._laplace()
        key = known.tobytes()
        free = np.flatnonzero(~known)
        if key not in self._factors:
            inside = L[free][:, free].tocsc()
            self._factors[key] = splu(
                inside, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}
            ).solve
        found = shift.copy()
        found[free] = 0.0
        found[free] = self._factors[key](-(L @ found)[free])
        return found

    def _laplace(self) -> sparse.csr_array:
        """Stiffness of Laplace's equation on the straight tetrahedra of the corners."""
        if self._laplacian is None:
            points = self.mesh.points[self._corners][self._tetrahedra]
            J = points[:, 1:] - points[:, :1]
            rest = np.linalg.inv(J).transpose(0, 2, 1)  # gradients of the last three functions
            gradients = np.concatenate([-rest.sum(axis=1, keepdims=True), rest], axis=1)
            volume = np.abs(np.linalg.det(J)) / 6.0
            values = np.einsum("e,eai,ebi->eab", volume, gradients, gradients)
            rows = np.repeat(self._tetrahedra[:, :, None], 4, axis=2)
            n = len(self._corners)
            entries = (values.ravel(), (rows.ravel(), rows.transpose(0, 2, 1).ravel()))
            self._laplacian = sparse.csr_array(sparse.coo_array(entries, shape=(n, n)))
        return self._laplacian


def shapes_of(points: Floats, cells: Ints) -> Floats:
    """Mean ratio of each tetrahedron's corners, (ne,): 1 of the regular one, 0 of a flat one.

    Negative where it is turned inside out (Liu and Joe 1994, BIT 34, 268-287).

    Parameters
    ----------
    points : Floats
        Nodes (n, 3) [m].
    cells : Ints
        Node ids (ne, 4) or more, corners first.
    """
    a, b, c, d = (points[cells[:, k]] for k in range(4))
    volume = np.einsum("ei,ei->e", np.cross(b - a, c - a), d - a) / 6.0
    squares = (_edges(points, cells) ** 2).sum(axis=1)
    return np.asarray(12.0 * np.sign(volume) * np.cbrt(9.0 * volume**2) / squares)


def _edges(points: Floats, cells: Ints) -> Floats:
    """(ne, 6) lengths of the straight edges of tetrahedra [m]."""
    found = [
        np.linalg.norm(points[cells[:, i]] - points[cells[:, j]], axis=1)
        for i, j in combinations(range(4), 2)
    ]
    return np.stack(found, axis=1)


def _named_shift(name: str, point: Floats, before: Parts, after: Parts) -> Floats | None:
    """(3,) how far a named point of a pillow block moves [m]; None of any other."""
    owner, _, where = name.rpartition(".")
    found = []
    for parts in (before, after):
        block = parts.block(owner)
        if block is None:
            return None
        bearing, housing = block
        places = housing.named_places(bearing)
        if where not in places:
            return None
        found.append(np.array(places[where]))
    return np.asarray(found[1] - found[0])
