"""Structured hexahedra of a shaft: its meridian in quadrilaterals, turned about the x axis.

Every node lies where the true cylinder or cone has it: the outer surface, the bore, and the
surfaces of revolution between them. A solid length has a core of square cross-section instead of
elements that would be pointed at the axis.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.elasticity.mesh.linear import renumbered
from fe_drivetrain.elasticity.mesh.shaft_section import (
    CORE,
    UNGRADED,
    Grading,
    ShaftSection,
    check_division,
    pieces_of,
    section_of,
)
from fe_drivetrain.geometry import LENGTH_TOLERANCE, Shaft

Nodes = Literal[8, 20, 27]

SQUARE = 0.6
"""Half the diagonal of the square in the core, as a share of the core's radius."""

VTK_LATTICE = np.array(
    [
        *((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)),
        *((1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)),
        *((0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)),
        *((0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1), (1, 1, 0), (1, 1, 2), (1, 1, 1)),
    ]
)
"""Places of the 27 nodes, in VTK's order, on the lattice of half edges of a hexahedron.

Corners, middles of edges, of faces, of the body: the first 8 and 20 are the elements of so many
nodes.
"""


@dataclass(frozen=True)
class Hexahedra:
    """Hexahedra of a shaft.

    Attributes
    ----------
    points : Floats
        Nodes (n, 3), m.
    cells : Ints
        Node ids (ne, 8), (ne, 20) or (ne, 27) in VTK's order.
    front, rear : Ints
        Ids of the nodes of the two end faces, ascending.
    seats : dict[str, Ints]
        Ids of the nodes of each bearing seat by its name, ascending.
    """

    points: Floats
    cells: Ints
    front: Ints
    rear: Ints
    seats: dict[str, Ints]

    __repr__ = short_repr


def shaft_hexahedra(
    shaft: Shaft,
    size: float,
    nodes: Nodes = 27,
    *,
    elements_per_turn: int = 12,
    refinement: int = 1,
    grading: Grading = UNGRADED,
    seats: Mapping[str, tuple[float, float]] | None = None,
) -> Hexahedra:
    """Mesh a shaft with structured hexahedra, curved where they have nodes to be curved with.

    Parameters
    ----------
    shaft : Shaft
        Shaft without fillets; bored or solid, stepped, tapered, with a flange or without.
    size : float
        Maximum length of an element along x and along the radius, m.
    nodes : Nodes
        Number of nodes of each element: 8, 20 or 27.
    elements_per_turn : int
        Number of elements round the axis, a multiple of 4 where a length of the shaft is solid.
    refinement : int
        Number of parts that every element of the mesh for 1 is cut into along each of its three
        directions.
    grading : Grading
        Grading: thinner layers at edges where stress is singular.
    seats : Mapping[str, tuple[float, float]] or None
        Ranges (low, high) of x of bearing seats by name, m; each gets its own nodes.

    Returns
    -------
    Hexahedra

    Raises
    ------
    InputError
        The shaft has a fillet, or a setting is out of its range.
    """
    check_division(shaft, size, nodes, elements_per_turn, refinement, grading)
    seats = {} if seats is None else dict(seats)
    seat_radii = {
        name: shaft.seat_diameter((low + high) / 2, high - low, name) / 2
        for name, (low, high) in seats.items()
    }
    core = CORE * min(r for piece in pieces_of(shaft, 0.0) for r in piece.radii if r > 0)
    section = section_of(pieces_of(shaft, core), size, refinement, grading, seats.values())
    turn = 2 * elements_per_turn * refinement
    points, cells = _turned(section, turn)
    if any(piece.inner_diameter == 0 for piece in shaft.pieces):
        points, cells = _with_core(points, cells, section, core, turn, refinement)
    mesh = renumbered(points, cells[:, :nodes])
    x, r = mesh.points[:, 0], np.hypot(mesh.points[:, 1], mesh.points[:, 2])
    return Hexahedra(
        mesh.points,
        mesh.cells,
        np.flatnonzero(np.abs(x - shaft.front) < LENGTH_TOLERANCE),
        np.flatnonzero(np.abs(x - shaft.rear) < LENGTH_TOLERANCE),
        {
            name: np.flatnonzero(
                (np.abs(r - seat_radii[name]) < LENGTH_TOLERANCE)
                & (x > low - LENGTH_TOLERANCE)
                & (x < high + LENGTH_TOLERANCE)
            )
            for name, (low, high) in seats.items()
        },
    )


def _turned(section: ShaftSection, turn: int) -> tuple[Floats, Ints]:
    """The quadrilaterals turned about the x axis, in steps of half an element.

    Returns
    -------
    points, cells
        (n * turn, 3), node k of ring m at m * turn + k; and (nq * turn / 2, 27).
    """
    angle = 2 * np.pi * np.arange(turn) / turn
    x, r = section.nodes.T[:, :, None]
    points = np.stack(np.broadcast_arrays(x, r * np.cos(angle), r * np.sin(angle)), axis=-1)
    around = (np.arange(0, turn, 2)[:, None] + np.arange(3)) % turn
    lattice = section.quads[:, None, :, :, None] * turn + around[None, :, None, None, :]
    return points.reshape(-1, 3), _in_vtk_order(lattice.reshape(-1, 3, 3, 3))


def _with_core(
    points: Floats, cells: Ints, section: ShaftSection, core: float, turn: int, refinement: int
) -> tuple[Floats, Ints]:
    """Fill solid lengths inside the core's radius.

    The cross-section is a square, standing on a corner, with rings of elements between it and
    the circle; the outermost ring of nodes is there already.
    """
    side = turn // 4
    angle = 2 * np.pi * np.arange(turn) / turn
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    along = (np.arange(turn) % side)[:, None] / side
    corners = circle[::side]
    square = np.repeat(corners, side, axis=0) * (1 - along)
    square += np.repeat(np.roll(corners, -1, axis=0), side, axis=0) * along
    # rings from the square to the circle, then what lies inside the square
    n_rings = 2 * refinement
    share = (np.arange(n_rings + 1) / n_rings)[:, None, None]
    rings = (1 - share) * SQUARE * square + share * circle
    a, b = np.meshgrid(*[np.arange(side + 1)] * 2, indexing="ij")
    u, v = a[..., None] / side, b[..., None] / side
    c = SQUARE * corners
    inside = (1 - u) * (1 - v) * c[0] + u * (1 - v) * c[1] + u * v * c[2] + (1 - u) * v * c[3]

    ring_id = np.arange((n_rings + 1) * turn).reshape(n_rings + 1, turn)
    grid = np.empty((side + 1, side + 1), dtype=np.int64)
    k = np.arange(side)
    grid[:-1, 0], grid[-1, :-1] = ring_id[0, k], ring_id[0, side + k]
    grid[side - k, -1], grid[0, side - k] = ring_id[0, 2 * side + k], ring_id[0, 3 * side + k]
    grid[1:-1, 1:-1] = ring_id.size + np.arange((side - 1) ** 2).reshape(side - 1, side - 1)
    disc = np.concatenate([rings.reshape(-1, 2), inside[1:-1, 1:-1].reshape(-1, 2)]) * core

    window = np.lib.stride_tricks.sliding_window_view
    closed = np.concatenate([ring_id, ring_id[:, :1]], axis=1)
    quads = np.concatenate(
        [window(table, (3, 3))[::2, ::2].reshape(-1, 3, 3) for table in (closed, grid)]
    )
    stations, edges = np.unique(section.core_edges, return_inverse=True)
    number = len(points) + np.arange(len(stations) * len(disc)).reshape(len(stations), -1)
    number[:, ring_id[-1]] = stations[:, None] * turn + np.arange(turn)
    x = section.nodes[stations, 0]
    more = np.concatenate(
        [
            np.broadcast_to(x[:, None, None], (len(x), len(disc), 1)),
            np.broadcast_to(disc, (len(x), *disc.shape)),
        ],
        axis=2,
    )
    lattice = number[edges.reshape(-1, 3)[:, None, :, None, None], quads[None, :, None, :, :]]
    return (
        np.concatenate([points, more.reshape(-1, 3)]),
        np.concatenate([cells, _in_vtk_order(lattice.reshape(-1, 3, 3, 3))]),
    )


def _in_vtk_order(lattice: Ints) -> Ints:
    """(ne, 27) node ids from (ne, 3, 3, 3) ones along a right-handed triple of directions."""
    a, b, c = VTK_LATTICE.T
    return np.ascontiguousarray(lattice[:, a, b, c])
