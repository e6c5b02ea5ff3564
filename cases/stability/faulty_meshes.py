"""Sound meshes with one fault put in at a known place."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases.references import slivers
from fe_drivetrain.cases.references.exact_blocks import LENGTH, SIDE
from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.elasticity.mesh import FACETS, Block, Mesh, brick, generate, joined
from fe_drivetrain.elasticity.mesh.shapes import TETRAHEDRON_EDGES
from fe_drivetrain.geometry import Bearing, Housing, MeshSizes, Section, Shaft

SIZES = MeshSizes(shaft=0.3, bearing=0.12, housing=0.2, bearing_edge=0.12, elements_per_turn=8)


@dataclass(frozen=True)
class Faulty:
    """A mesh with a fault.

    Attributes
    ----------
    label : str
        What was done.
    kind : str
        Of `checks.Fault` that must be found.
    mesh : Mesh
        With the fault.
    place : Floats
        (3,) where it is, m.
    reach : float
        How far from there the report may point, m.
    part : str
        In which it is.
    """

    label: str
    kind: str
    mesh: Mesh
    place: Floats
    reach: float
    part: str = "shaft"


def sound() -> Mesh:
    """A shaft in a bearing in a housing, joined by a joint whose two sides have their own nodes."""
    bearing = Bearing()
    shaft = Shaft(
        front=-0.4, sections=(Section(length=0.8, outer_diameter=0.4, inner_diameter=0.15),)
    )
    return generate(shaft, [bearing], {bearing.name: Housing()}, SIZES)


NEEDED = (
    "shaft.front",
    "shaft.rear",
    "shaft.seat.main_bearing",
    "main_bearing.outer",
    "main_bearing.housing.bore",
    "main_bearing.housing.base",
)


class Chosen(NamedTuple):
    """An element, its middle [m] and its extent [m]."""

    cell: int
    place: Floats
    size: float


def faulty(mesh: Mesh, seed: int = 0) -> Iterator[Faulty]:
    """Every fault, one after the other, in elements of the shaft chosen at random."""
    rng = np.random.default_rng(seed)
    inner = _inner_cells(mesh, "shaft")

    def choose() -> Chosen:
        cell = int(rng.choice(inner))
        corners = mesh.points[mesh.cells[cell, :4]]
        return Chosen(cell, corners.mean(axis=0), float(np.ptp(corners, axis=0).max()))

    yield from _bad_shapes(mesh, choose)
    yield from _bad_joints(mesh, choose)
    yield from _bad_records(mesh, choose)


def _bad_shapes(mesh: Mesh, choose: Callable[[], Chosen]) -> Iterator[Faulty]:
    """Elements turned inside out or flat."""
    points, cells = mesh.points, mesh.cells
    cell, place, size = choose()
    other = cells.copy()
    other[cell, [0, 1]] = other[cell, [1, 0]]
    other[cell, [5, 6, 7, 8]] = other[cell, [6, 5, 8, 7]]
    yield Faulty("two corners exchanged", "inverted", replace(mesh, cells=other), place, size)

    cell, place, size = choose()
    moved = points.copy()
    a, b, middle = cells[cell, 0], cells[cell, 1], cells[cell, 4]
    moved[middle] += 1.2 * (points[cells[cell, 3]] - (points[a] + points[b]) / 2)
    yield Faulty("mid-side node moved", "inverted", replace(mesh, points=moved), place, 2 * size)

    cell, place, size = choose()
    moved = points.copy()
    base = points[cells[cell, :3]]
    normal = np.cross(base[1] - base[0], base[2] - base[0])
    normal /= np.linalg.norm(normal)
    top = cells[cell, 3]
    height = float((points[top] - base[0]) @ normal)
    moved[top] -= (height - 1e-8 * math.copysign(size, height)) * normal
    for (i, j), middle in zip(TETRAHEDRON_EDGES, cells[cell, 4:], strict=True):
        moved[middle] = (moved[cells[cell, i]] + moved[cells[cell, j]]) / 2
    flat = replace(mesh, points=moved)
    yield Faulty("corner moved into the opposite facet", "flat", flat, place, 2 * size)


def _bad_joints(mesh: Mesh, choose: Callable[[], Chosen]) -> Iterator[Faulty]:
    """Elements that are doubled, torn off, halved or left out."""
    points, cells = mesh.points, mesh.cells
    cell, place, size = choose()
    twice = replace(
        mesh, cells=np.vstack([cells, cells[cell]]), part=np.append(mesh.part, mesh.part[cell])
    )
    yield Faulty("element that stands there twice", "overlap", twice, place, size)

    cell = choose().cell
    node = int(cells[cell, 0])
    torn = _split(mesh, np.array([cell]), np.array([node]))
    yield Faulty("one node of one element doubled", "crack", torn, points[node], 1e-9)

    seat = mesh.face_nodes("shaft.seat.main_bearing")
    at = points[mesh.faces["shaft.seat.main_bearing"]].reshape(-1, 3)
    torn, extent = _split(mesh, mesh.part_cells("main_bearing"), seat), float(np.ptp(at, 0).max())
    yield Faulty("bearing not joined to its seat", "crack", torn, at.mean(axis=0), extent)

    cell, place, size = choose()
    halved = _halved(mesh, cell)
    yield Faulty("edge halved in one element only", "hanging node", halved, place, size)

    yield Faulty("slice of the shaft left out", "pieces", *_without_slice(mesh))


def _bad_records(mesh: Mesh, choose: Callable[[], Chosen]) -> Iterator[Faulty]:
    """Positions, names and units that are wrong."""
    points, cells, base = mesh.points, mesh.cells, mesh.faces["main_bearing.housing.base"]
    at = np.array([0.1, 0.2, 0.3])
    more = replace(mesh, points=np.vstack([points, at]))
    yield Faulty("node that nothing uses", "unused node", more, at, 1e-9, "of no part")

    cell, place, size = choose()
    lost = points.copy()
    lost[cells[cell, 2]] = np.nan
    unplaced = replace(mesh, points=lost)
    yield Faulty("position that is no number", "no position", unplaced, place, size)

    names = {n: f for n, f in mesh.faces.items() if n != "shaft.seat.main_bearing"}
    fewer, middle = replace(mesh, faces=names), points[mesh.part_nodes("shaft")].mean(axis=0)
    yield Faulty("seat without its name", "missing face", fewer, middle, 0.1)

    wrong = replace(mesh, faces=mesh.faces | {"shaft.front": base})
    at = points[base[0, :3]].mean(axis=0)
    yield Faulty("front named on the base of the housing", "wrong face", wrong, at, 1e-9)

    large = replace(mesh, points=1000 * points)
    yield Faulty("millimetres for metres", "scale", large, np.zeros(3), 400.0)


def _inner_cells(mesh: Mesh, part: str) -> Ints:
    """Cells of a part that have no facet on any surface, and only straight edges."""
    keys, count = np.unique(
        np.sort(mesh.cells[:, FACETS[:, :3]].reshape(-1, 3), axis=1),
        axis=0,
        return_inverse=True,
        return_counts=True,
    )[1:]
    inside = (count[keys.reshape(-1, 4)] == 2).all(axis=1)
    a, b = TETRAHEDRON_EDGES.T
    ends = mesh.points[mesh.cells]
    straight = np.abs(ends[:, 4:] - (ends[:, a] + ends[:, b]) / 2).max(axis=(1, 2)) < 1e-12
    surface = np.zeros(len(mesh.points), dtype=bool)
    surface[np.concatenate([f.ravel() for f in mesh.faces.values()])] = True
    clear = ~surface[mesh.cells].any(axis=1)
    found = np.flatnonzero(inside & straight & clear)
    return found[np.isin(found, mesh.part_cells(part))]


def _split(mesh: Mesh, own: Ints, nodes: Ints) -> Mesh:
    """Give some cells nodes of their own in place of these."""
    twin = np.arange(len(mesh.points))
    twin[nodes] = len(mesh.points) + np.arange(len(nodes))
    cells = mesh.cells.copy()
    cells[own] = twin[cells[own]]
    faces = dict(mesh.faces)
    bearing = "main_bearing.bore"
    if bearing in faces and len(own) > 1:
        faces[bearing] = twin[faces[bearing]]
    return replace(
        mesh, points=np.vstack([mesh.points, mesh.points[nodes]]), cells=cells, faces=faces
    )


def _halved(mesh: Mesh, cell: int) -> Mesh:
    """One straight cell cut in two at the middle of its first edge, its neighbours left alone."""
    corners = mesh.cells[cell, :4]
    middle = int(mesh.cells[cell, 4])
    points, rows = mesh.points, []
    for old in (1, 0):
        new = corners.copy()
        new[old] = middle
        mids = []
        for i, j in TETRAHEDRON_EDGES:
            mids.append(len(points))
            points = np.vstack([points, (points[new[i]] + points[new[j]]) / 2])
        rows.append(np.concatenate([new, mids]))
    # what is not on the cut edge keeps the nodes that the neighbours have
    for row in rows:
        for k, (i, j) in enumerate(TETRAHEDRON_EDGES):
            for m, (a, b) in enumerate(TETRAHEDRON_EDGES):
                if {row[i], row[j]} == {corners[a], corners[b]}:
                    row[4 + k] = mesh.cells[cell, 4 + m]
    # of the two new edges in the cut one node each
    first, second = rows
    pairs = {
        frozenset((int(first[i]), int(first[j]))): int(first[4 + k])
        for k, (i, j) in enumerate(TETRAHEDRON_EDGES)
    }
    for k, (i, j) in enumerate(TETRAHEDRON_EDGES):
        common = frozenset((int(second[i]), int(second[j])))
        second[4 + k] = pairs.get(common, int(second[4 + k]))
    cells = np.vstack([np.delete(mesh.cells, cell, axis=0), rows])
    part = np.append(np.delete(mesh.part, cell), [mesh.part[cell]] * 2)
    used = np.unique(cells)
    number = np.full(len(points), -1)
    number[used] = np.arange(len(used))
    faces = {n: number[f] for n, f in mesh.faces.items()}
    return Mesh(points[used], number[cells], part, mesh.part_names, faces, {})


def _without_slice(mesh: Mesh) -> tuple[Mesh, Floats, float]:
    """The shaft without the cells between its seat and its rear face; place and reach."""
    centre = mesh.points[mesh.cells[:, :4]].mean(axis=1)
    shaft = mesh.part == mesh.part_names.index("shaft")
    # cells that the plane x = 0.25 m cuts
    x = mesh.points[mesh.cells[:, :4], 0]
    gone = shaft & (x.min(axis=1) < 0.25) & (x.max(axis=1) > 0.25)
    cells, part = mesh.cells[~gone], mesh.part[~gone]
    used = np.unique(cells)
    number = np.full(len(mesh.points), -1)
    number[used] = np.arange(len(used))
    faces = {n: number[f[(number[f] >= 0).all(axis=1)]] for n, f in mesh.faces.items()}
    left = shaft & ~gone & (centre[:, 0] > 0.25)
    place = centre[left].mean(axis=0)
    made = Mesh(mesh.points[used], number[cells], part, mesh.part_names, faces, {})
    return made, place, 0.1


def cracked_bar(depth: float, across: int) -> Mesh:
    """The bar of `slivers`, without slivers, torn from its top down to a depth in its middle.

    Parameters
    ----------
    depth : float
        Of the crack over the height of the bar, rounded to whole rows of cubes.
    across : int
        Rows of cubes.
    """
    return _torn(_plain_bar(across), round(depth * across) / across)


def _plain_bar(across: int) -> Mesh:
    def placed(unit: Floats) -> Floats:
        return np.column_stack([LENGTH * unit[:, 0], SIDE * (unit[:, 1:] - 0.5)])

    block = brick((2 * across, 2, across), 4, placed)
    return slivers.as_mesh(block.points, block.cells, 10)


def _torn(mesh: Mesh, depth: float) -> Mesh:
    x, z = mesh.points[:, 0], mesh.points[:, 2]
    tip = SIDE / 2 - depth * SIDE
    # all nodes above the tip; where the crack goes through, those at the bottom as well
    above = z > tip + 1e-9 if depth < 1 else np.full(len(z), True)
    nodes = np.flatnonzero((np.abs(x - LENGTH / 2) < 1e-9) & above)
    behind = np.flatnonzero(mesh.points[mesh.cells[:, :4], 0].mean(axis=1) > LENGTH / 2)
    return _split(mesh, behind, nodes)


def crack_loss(depth: float) -> float:
    """Loss of bending stiffness of the bar by a crack, relative; plane, without contraction.

    The crack turns the halves by 4 sigma / E S(a), sigma = 6 M / t W^2, S(a) = (a / (1 - a))^2
    (5.93 - 19.69 a + 37.14 a^2 - 35.84 a^3 + 13.12 a^4), within 1 % (Tada, Paris and Irwin, The
    Stress Analysis of Cracks Handbook, section 2.13; recalled, not re-read).
    """
    if depth >= 1:
        return 1.0
    series = np.polyval([13.12, -35.84, 37.14, -19.69, 5.93], depth)
    turn = 4 * 6 / SIDE**3 * (depth / (1 - depth)) ** 2 * series
    return float(turn / (turn + LENGTH * 12 / SIDE**4))


def merged(mesh: Mesh) -> Mesh:
    """The mesh with nodes at the same place made one."""
    whole = joined(Block(mesh.points, mesh.cells, {}))
    return replace(mesh, points=whole.points, cells=whole.cells, faces={})
