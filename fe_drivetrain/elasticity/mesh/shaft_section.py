"""Section of a shaft in structured quadrilaterals: what `hexahedra` turns about the axis."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.geometry import LENGTH_TOLERANCE, Shaft

CORE = 0.5
"""Radius inside which a solid length has its core, as a share of its minimum radius."""


@dataclass(frozen=True)
class Grading:
    """Ever thinner layers of elements where stress is singular.

    The element beside such an edge is split that many times, each time at `ratio` of what is
    left next to the edge.

    Attributes
    ----------
    steps : int
        Layers at the re-entrant edges of steps in the outer diameter and the bore.
    ends : int
        Layers at the edges of the two end faces, singular where an end is held or rigid.
    ratio : float
        Ratio of thicknesses, between 0 and 1.
    """

    steps: int = 0
    ends: int = 0
    ratio: float = 0.3


UNGRADED = Grading()


def shaft_quadrilaterals(
    shaft: Shaft, size: float, *, refinement: int = 1, grading: Grading = UNGRADED
) -> tuple[Floats, Ints]:
    """Meridian that `shaft_hexahedra` turns, down to the axis where the shaft is solid.

    Parameters
    ----------
    shaft, size, refinement, grading : Shaft, float, int, Grading
        Arguments of `shaft_hexahedra`.

    Returns
    -------
    nodes, quads
        Places (n, 2) x and radius, m; node ids (nq, 3, 3), along x, then along the radius: corners
        at even places, middles at odd ones.

    Raises
    ------
    InputError
        The shaft has a fillet, or a setting is out of its range.
    """
    check_division(shaft, size, 27, 4, refinement, grading)
    section = section_of(pieces_of(shaft, 0.0), size, refinement, grading, [])
    return section.nodes, section.quads


def check_division(
    shaft: Shaft, size: float, nodes: int, turn: int, refinement: int, grading: Grading
) -> None:
    """Refuse a shaft that has no such mesh, and settings out of their range.

    Raises
    ------
    InputError
        The shaft has a fillet, or a setting is out of its range.
    """
    for piece, x in zip(shaft.pieces, shaft.stations[1:], strict=False):
        if piece.fillet > 0:
            raise InputError(
                f"shaft step at x = {x:g} m: fillet is {piece.fillet:g} m but must be 0 for "
                "hexahedra: set it to 0, or mesh the shaft with tetrahedra (mesh.generate)"
            )
    solid = any(piece.inner_diameter == 0 for piece in shaft.pieces)
    if turn < 4 or (solid and turn % 4):
        allowed = "a multiple of 4 for a shaft with a solid length" if solid else "4 or more"
        raise InputError(f"elements_per_turn is {turn} but must be {allowed}: try 12")
    ranges = (
        ("size", size, 0 < size < math.inf, "greater than 0", "give an edge length in m"),
        ("nodes", nodes, nodes in (8, 20, 27), "8, 20 or 27", "use 27 where in doubt"),
        ("refinement", refinement, refinement >= 1, "1 or more", "1 leaves the mesh as it is"),
        ("grading.ratio", grading.ratio, 0 < grading.ratio < 1, "between 0 and 1", "try 0.3"),
        ("grading.steps", grading.steps, grading.steps >= 0, "0 or more", "0 grades nothing"),
        ("grading.ends", grading.ends, grading.ends >= 0, "0 or more", "0 grades nothing"),
    )
    for name, value, right, allowed, fix in ranges:
        if not right:
            raise InputError(f"hexahedra: {name} is {value:g} but must be {allowed}: {fix}")


@dataclass(frozen=True)
class Piece:
    """A length of the section: straight below (a bore, or the core), straight above."""

    x0: float
    x1: float
    inner: float
    outer: tuple[float, float]
    solid: bool

    @property
    def radii(self) -> tuple[float, float, float]:
        """Radius of the bore or core, and of the surface at the front and the rear [m]."""
        return (self.inner, *self.outer)

    def radius(self, share: float, end: int) -> float:
        """Radius at a share of the wall, at the front (0) or the rear (1)."""
        return self.inner + share * (self.outer[end] - self.inner)

    def share(self, radius: float, end: int) -> float:
        """Inverse of `radius`."""
        return (radius - self.inner) / (self.outer[end] - self.inner)


def pieces_of(shaft: Shaft, core: float) -> list[Piece]:
    """The lengths of a shaft from front to rear; solid ones begin at their core's radius [m]."""
    return [
        Piece(
            x0,
            x1,
            piece.inner_diameter / 2 or core,
            (piece.outer_diameter / 2, piece.end_diameter / 2),
            piece.inner_diameter == 0,
        )
        for piece, (x0, x1) in zip(shaft.pieces, pairwise(shaft.stations), strict=True)
    ]


def _lines(pieces: list[Piece]) -> list[list[float]]:
    """Shares of the wall at which each piece is divided, so that neighbours match at each step.

    The outer surface and the bore of a piece go on as a line inside its neighbour, along the
    same share of the wall, and from there into the next.
    """
    shares: list[list[float]] = [[0.0, 1.0] for _ in pieces]
    changed = True
    while changed:
        changed = False
        for a, b in pairwise(range(len(pieces))):
            for one, end, other, beginning in ((a, 1, b, 0), (b, 0, a, 1)):
                for share in list(shares[one]):
                    radius = pieces[one].radius(share, end)
                    wall = pieces[other].inner, pieces[other].outer[beginning]
                    there = [pieces[other].radius(s, beginning) for s in shares[other]]
                    inside = wall[0] - LENGTH_TOLERANCE < radius < wall[1] + LENGTH_TOLERANCE
                    if inside and min(abs(radius - r) for r in there) > LENGTH_TOLERANCE:
                        shares[other].append(pieces[other].share(radius, beginning))
                        changed = True
    return [sorted(s) for s in shares]


def _strips(pieces: list[Piece], shares: list[list[float]]) -> list[list[int]]:
    """Number of the strip that each interval between lines belongs to, through all pieces."""
    numbers: list[list[int]] = []
    count = 0
    for p, piece in enumerate(pieces):
        row = []
        for low, high in pairwise(shares[p]):
            found = count
            if p:
                before, middle = pieces[p - 1], piece.radius((low + high) / 2, 0)
                edges = [before.radius(s, 1) for s in shares[p - 1]]
                k = int(np.searchsorted(edges, middle)) - 1
                if 0 <= k < len(edges) - 1:
                    found = numbers[-1][k]
            row.append(found)
            count = max(count, found + 1)
        numbers.append(row)
    return numbers


def _divided(n: int, low: int, high: int, ratio: float, refinement: int) -> Floats:
    """A lattice of half edges on [0, 1]: n elements, the first and last split towards the end.

    Returns
    -------
    (2 m + 1,) ascending: vertices at the even places, middles at the odd ones.
    """
    if low and high:
        n = max(n, 2)
    vertices = np.linspace(0.0, 1.0, n + 1)
    beside = vertices[1] * ratio ** np.arange(low, 0, -1)
    above = 1.0 - vertices[1] * ratio ** np.arange(1, high + 1)
    vertices = np.concatenate([[0.0], beside, vertices[1:-1], above, [1.0]])
    halves = np.arange(2 * refinement) / (2 * refinement)
    inner = vertices[:-1, None] + np.diff(vertices)[:, None] * halves
    return np.append(inner.ravel(), 1.0)


@dataclass(frozen=True)
class ShaftSection:
    """Nine-node quadrilaterals in the half plane of x and radius.

    Attributes
    ----------
    nodes : Floats
        Nodes (n, 2), x and radius, m.
    quads : Ints
        Node ids (nq, 3, 3): along x, then along the radius.
    core_edges : Ints
        Node ids (nc, 3), along x, of the edges on the core of solid lengths.
    """

    nodes: Floats
    quads: Ints
    core_edges: Ints


def section_of(
    pieces: list[Piece],
    size: float,
    refinement: int,
    grading: Grading,
    seats: Iterable[tuple[float, float]],
) -> ShaftSection:
    """Quadrilaterals of a section, along each piece and across each strip of walls.

    Parameters
    ----------
    pieces : list[Piece]
        Pieces from `pieces_of`.
    size, refinement, grading : float, int, Grading
        Arguments of `shaft_quadrilaterals`.
    seats : Iterable[tuple[float, float]]
        Ranges (low, high) of x at which elements shall end [m].
    """
    shares = _lines(pieces)
    strips = _strips(pieces, shares)
    lattices = _radial_lattices(pieces, shares, strips, size, refinement, grading)
    cuts = sorted({x for seat in seats for x in seat})
    steps = _step_stations(pieces)
    nodes, columns, quads, edges = [], [], [], []
    first_column = first_node = 0
    for p, piece in enumerate(pieces):
        x = _along(piece, cuts, steps, (pieces[0].x0, pieces[-1].x1), size, refinement, grading)
        walls = [
            low + (high - low) * lattices[strip]
            for (low, high), strip in zip(pairwise(shares[p]), strips[p], strict=True)
        ]
        wall = np.concatenate([walls[0], *(w[1:] for w in walls[1:])])
        along = (x - piece.x0) / (piece.x1 - piece.x0)
        outer = piece.outer[0] + (piece.outer[1] - piece.outer[0]) * along
        radius = piece.inner + (outer - piece.inner)[:, None] * wall
        place = first_node + np.arange(radius.size).reshape(radius.shape)
        nodes.append(np.column_stack([np.repeat(x, len(wall)), radius.ravel()]))
        columns.append(np.repeat(first_column + np.arange(len(x)), len(wall)))
        windows = np.lib.stride_tricks.sliding_window_view(place, (3, 3))[::2, ::2]
        quads.append(windows.reshape(-1, 3, 3))
        if piece.solid:
            edges.append(np.lib.stride_tricks.sliding_window_view(place[:, 0], 3)[::2])
        first_column += len(x) - 1
        first_node += radius.size
    merged, number = _merged(np.concatenate(nodes), np.concatenate(columns))
    core_edges = np.concatenate(edges) if edges else np.empty((0, 3), dtype=np.int64)
    return ShaftSection(merged, number[np.concatenate(quads)], number[core_edges])


def _merged(nodes: Floats, columns: Ints) -> tuple[Floats, Ints]:
    """Nodes of one column and one radius merged; positions, and each old node's new id."""
    order = np.lexsort((nodes[:, 1], columns))
    apart = (np.diff(columns[order]) > 0) | (np.diff(nodes[order, 1]) > LENGTH_TOLERANCE)
    rank = np.concatenate([[0], np.cumsum(apart)])
    number = np.empty(len(nodes), dtype=np.int64)
    number[order] = rank
    return nodes[order][np.concatenate([[True], apart])], number


def _step_stations(pieces: list[Piece]) -> dict[float, list[float]]:
    """Radii of the re-entrant edges by the x of their step."""
    found: dict[float, list[float]] = {}
    for one, two in pairwise(pieces):
        if abs(one.outer[1] - two.outer[0]) > LENGTH_TOLERANCE:
            found.setdefault(one.x1, []).append(min(one.outer[1], two.outer[0]))
        # the core of a solid length is no edge, but the end of its neighbour's bore is
        bores = [0.0 if piece.solid else piece.inner for piece in (one, two)]
        if abs(bores[0] - bores[1]) > LENGTH_TOLERANCE:
            found.setdefault(one.x1, []).append(max(bores))
    return found


def _radial_lattices(
    pieces: list[Piece],
    shares: list[list[float]],
    strips: list[list[int]],
    size: float,
    refinement: int,
    grading: Grading,
) -> dict[int, Floats]:
    """Lattice of half edges across each strip: as many elements as its thickest place needs."""
    steps = _step_stations(pieces)
    counts: dict[int, int] = {}
    layers: dict[int, list[int]] = {}
    for p, piece in enumerate(pieces):
        for (low, high), strip in zip(pairwise(shares[p]), strips[p], strict=True):
            thickness = max(piece.radius(high, e) - piece.radius(low, e) for e in (0, 1))
            counts[strip] = max(counts.get(strip, 1), _count(thickness, size))
            sides = layers.setdefault(strip, [0, 0])
            for end, side in product((0, 1), (0, 1)):
                radius = piece.radius((low, high)[side], end)
                corners = steps.get((piece.x0, piece.x1)[end], [])
                if any(abs(radius - r) < LENGTH_TOLERANCE for r in corners):
                    sides[side] = max(sides[side], grading.steps)
                is_end = (p, end) in ((0, 0), (len(pieces) - 1, 1))
                is_surface = (low, high)[side] == side and not (side == 0 and piece.solid)
                if is_end and is_surface:
                    sides[side] = max(sides[side], grading.ends)
    return {
        strip: _divided(n, layers[strip][0], layers[strip][1], grading.ratio, refinement)
        for strip, n in counts.items()
    }


def _along(
    piece: Piece,
    cuts: list[float],
    steps: Mapping[float, list[float]],
    ends: tuple[float, float],
    size: float,
    refinement: int,
    grading: Grading,
) -> Floats:
    """Lattice of half edges along a piece, m, with a vertex at each cut inside it."""
    inside = [c for c in cuts if piece.x0 + LENGTH_TOLERANCE < c < piece.x1 - LENGTH_TOLERANCE]
    lattice = [np.array([piece.x0])]
    for a, b in pairwise([piece.x0, *inside, piece.x1]):
        low, high = (
            grading.steps if x in steps else grading.ends if x in ends else 0 for x in (a, b)
        )
        t = _divided(_count(b - a, size), low, high, grading.ratio, refinement)
        lattice.append((a + (b - a) * t)[1:])
    return np.concatenate(lattice)


def _count(length: float, size: float) -> int:
    return max(1, math.ceil(length / size - 1e-6))
