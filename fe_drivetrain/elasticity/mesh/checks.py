"""A mesh is sound before it is solved: each fault is found, and named with its place."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.measures import inverted_cells
from fe_drivetrain.elasticity.mesh.mesh import FACETS, Mesh, part_of
from fe_drivetrain.elasticity.mesh.shared_facets import SharedFacets
from fe_drivetrain.geometry import WIDEST, refuse_millimetres

FLATTEST = 1e-6
"""Height over longest edge of the flattest element that is solved: flatter ones make solvers fail,
see ``cases/stability/sliver_elements.py``."""

SAME_PLACE = 1e-7
"""Nodes closer than this, relative to the shortest edges there, are at the same place."""


Joints = Iterable[str | tuple[str, str]]

_SAMPLE = 1000  # elements that tell how long short edges are


@dataclass(frozen=True)
class Fault:
    """One kind of fault in one part of a mesh.

    Attributes
    ----------
    kind : str
        "no position", "unused node", "inverted", "flat", "crack", "hanging node", "overlap",
        "pieces", "missing face", "wrong face" or "scale".
    part : str
        Name of the part.
    count : int
        Number of elements, nodes or facets that have it.
    element : int
        The first element that has it, as `Mesh.cells` numbers them; -1 where it is none.
    place : tuple[float, float, float]
        Place of the fault, m; of an element its centre.
    sentence : str
        Sentence that says what is wrong, where, and how to fix it.
    """

    kind: str
    part: str
    count: int
    element: int
    place: tuple[float, float, float]
    sentence: str


def refuse_unsound(mesh: Mesh, faces: Iterable[str] = (), joints: Joints | None = None) -> None:
    """Refuse a mesh that has a fault; arguments of `find_faults`.

    Raises
    ------
    InputError
        The first fault, in one sentence, and how many kinds of faults there are beside it.
    """
    faults = find_faults(mesh, faces, joints)
    if faults:
        others = f" (and {len(faults) - 1} other kinds of faults)" if len(faults) > 1 else ""
        raise InputError(f"{faults[0].sentence}{others}")


def find_faults(mesh: Mesh, faces: Iterable[str] = (), joints: Joints | None = None) -> list[Fault]:
    """All that is wrong with a mesh.

    Parameters
    ----------
    mesh : Mesh
        Mesh of any kind.
    faces : Iterable[str]
        Names of the faces that loads, supports and interfaces need.
    joints : Joints or None
        Bearings whose outer face has nodes of its own at the places of its housing's, and pairs of
        faces that are tied; all bearings where not given.

    Returns
    -------
    Gravest first; empty of a sound mesh.
    """
    faults = _positions(mesh)
    if faults:
        return faults
    facets = SharedFacets.of(mesh)
    bearings = {n.removesuffix(".outer") for n in mesh.faces if n.endswith(".outer")}
    apart: Joints = bearings if joints is None else set(joints)
    return [
        *_scale(mesh),
        *_inverted(mesh),
        *_flat(mesh),
        *_neighbours(mesh, facets),
        *_cracks(mesh, apart),
        *_hanging(mesh, facets),
        *_pieces(mesh, facets),
        *_faces(mesh, facets, faces),
    ]


def flatness(points: Floats, cells: Ints) -> Floats:
    """Minimum height of each tetrahedron over its longest edge, of its corners alone, (ne,).

    0.816 of the regular one, 0 of a flat one; negative where it is turned inside out.
    """
    a, b, c, d = (points[cells[:, k]] for k in range(4))
    u, v, w = b - a, c - a, d - a
    normals = np.stack([_cross(u, v), _cross(v, w), _cross(w, u), _cross(v - u, w - u)])
    volume = np.einsum("ei,ei->e", normals[0], w)
    area = np.sqrt(np.einsum("fei,fei->fe", normals, normals).max(axis=0))
    edges = np.stack([u, v, w, v - u, w - v, u - w])
    longest = np.sqrt(np.einsum("kei,kei->ke", edges, edges).max(axis=0))
    result: Floats = volume / np.maximum(area * longest, np.finfo(float).tiny)
    return result


def _cross(a: Floats, b: Floats) -> Floats:
    (ax, ay, az), (bx, by, bz) = a.T, b.T  # numpy.cross takes three times as long
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=1)


def _place(point: Floats) -> str:
    return "({:.4g}, {:.4g}, {:.4g}) m".format(*point)


def _of_cells(mesh: Mesh, kind: str, cells: Ints, what: str, fix: str) -> list[Fault]:
    """A fault of elements, part by part."""
    faults = []
    for part, name in enumerate(mesh.part_names):
        here = cells[mesh.part[cells] == part]
        if len(here) == 0:
            continue
        centre = mesh.points[mesh.cells[here[0], :4]].mean(axis=0)
        sentence = (
            f"part {name!r}: {len(here)} of its {np.count_nonzero(mesh.part == part)} elements "
            f"{what}, the first, element {here[0]}, near {_place(centre)}: {fix}"
        )
        faults.append(Fault(kind, name, len(here), int(here[0]), _tuple(centre), sentence))
    return faults


def _of_nodes(mesh: Mesh, kind: str, nodes: Ints, what: str, fix: str) -> list[Fault]:
    """A fault of nodes, part by part; of nodes in no part, in none."""
    owner = np.full(len(mesh.points), -1)
    owner[mesh.cells] = mesh.part[:, None]
    faults = []
    for part in np.unique(owner[nodes]):
        here = nodes[owner[nodes] == part]
        element = -1
        name = "of no part"
        if part >= 0:
            element = int(np.flatnonzero((mesh.cells == here[0]).any(axis=1))[0])
            name = mesh.part_names[part]
        point = mesh.points[here[0]]
        if not np.isfinite(point).all():
            near = mesh.points[mesh.cells[element, :4]]
            point = near[np.isfinite(near).all(axis=1)].mean(axis=0)  # of its neighbours
        owner_name = f"part {name!r}" if part >= 0 else "the mesh"
        at = f", element {element}," if part >= 0 else ","
        sentence = (
            f"{owner_name}: {len(here)} of its nodes {what}, the first, node {here[0]}{at} at "
            f"{_place(point)}: {fix}"
        )
        faults.append(Fault(kind, name, len(here), element, _tuple(point), sentence))
    return faults


def _tuple(point: Floats) -> tuple[float, float, float]:
    x, y, z = (float(c) for c in point)
    return x, y, z


def _positions(mesh: Mesh) -> list[Fault]:
    n, cells = len(mesh.points), mesh.cells
    if len(cells) == 0:
        nowhere = (np.nan,) * 3
        return [Fault("no position", "", 0, -1, nowhere, "the mesh has no elements: mesh a part")]
    outside = np.flatnonzero(((cells < 0) | (cells >= n)).any(axis=1))
    if len(outside):
        name = mesh.part_names[mesh.part[outside[0]]]
        sentence = (
            f"part {name!r}: element {outside[0]} has a node that does not exist: its nodes must "
            f"be numbered 0 to {n - 1}"
        )
        nowhere = (np.nan,) * 3
        return [Fault("no position", name, len(outside), int(outside[0]), nowhere, sentence)]
    used = np.zeros(n, dtype=bool)
    used[cells] = True
    unused = np.flatnonzero(~used)
    faults = _of_nodes(
        mesh,
        "unused node",
        unused,
        "belong to no element and would make the stiffness singular",
        "leave them out, see fe_drivetrain.elasticity.mesh.linear.renumbered",
    )
    lost = np.flatnonzero(~np.isfinite(mesh.points).all(axis=1) & used)
    faults += _of_nodes(mesh, "no position", lost, "have no finite position", "give them one")
    return faults


def _scale(mesh: Mesh) -> list[Fault]:
    if float(np.ptp(mesh.points, axis=0).max()) <= WIDEST:
        return []
    for part, name in enumerate(mesh.part_names):
        nodes = mesh.cells[mesh.part == part, :4]
        points = mesh.points[nodes]
        low, high = points.min(axis=(0, 1)), points.max(axis=(0, 1))
        extent = high - low
        try:
            refuse_millimetres(f"part {name!r}", float(extent[0]), float(extent[1:].max()))
        except InputError as error:
            middle = _tuple((low + high) / 2)
            return [Fault("scale", name, len(nodes), -1, middle, str(error))]
    return []


def _inverted(mesh: Mesh) -> list[Fault]:
    return _of_cells(
        mesh,
        "inverted",
        inverted_cells(mesh),
        "are inverted or fold over, where the Jacobian must be above 0 all over an element",
        "make the mesh finer there, straighten its edges, or leave out the detail",
    )


def _flat(mesh: Mesh) -> list[Fault]:
    flat = np.abs(flatness(mesh.points, mesh.cells))
    return _of_cells(
        mesh,
        "flat",
        np.flatnonzero(flat < FLATTEST),
        f"are flatter than {FLATTEST:g} (minimum height over longest edge; the worst "
        f"{flat.min():.1g})",
        "let the mesher optimise them away, or make the mesh finer there",
    )


def _neighbours(mesh: Mesh, facets: SharedFacets) -> list[Fault]:
    """Facets of three cells; and neighbours whose common edge has two mid-side nodes."""
    faults = _of_cells(
        mesh,
        "overlap",
        np.unique(facets.more // 4),
        "share a facet with two others, but a facet has one element on either side",
        "remove the elements that stand there twice",
    )
    one, two = (
        np.sort(mesh.cells[(side // 4)[:, None], FACETS[side % 4, 3:]], axis=1)
        for side in (facets.first, facets.second)
    )
    torn = np.unique(facets.first[(one != two).any(axis=1)] // 4)
    return faults + _of_cells(
        mesh,
        "crack",
        torn,
        "have other mid-side nodes than their neighbours on the same edges, which tears the body",
        "give an edge one mid-side node",
    )


def coincident(mesh: Mesh) -> Ints:
    """Pairs (k, 2) of nodes at the same place.

    Nodes are sorted along a direction in which no two places of a lattice fall together, and
    compared with those next to them.
    """
    sample = mesh.cells[:: len(mesh.cells) // _SAMPLE + 1, :3]
    edge = np.linalg.norm(mesh.points[sample] - mesh.points[sample[:, [1, 2, 0]]], axis=2)
    tolerance = SAME_PLACE * float(np.quantile(edge, 0.01))
    along = mesh.points @ np.array([0.6180339887, 0.4656124873, 0.6335873107])
    order = np.argsort(along)
    sorted_along, points = along[order], mesh.points[order]
    found = []
    for step in range(1, len(order)):
        near = np.flatnonzero(sorted_along[step:] - sorted_along[:-step] < 2 * tolerance)
        if len(near) == 0:
            break
        close = np.linalg.norm(points[near + step] - points[near], axis=1) < tolerance
        found.append(np.column_stack([order[near], order[near + step]])[close])
    result: Ints = np.concatenate(found) if found else np.empty((0, 2), dtype=np.int64)
    return result


def _of_no_common_cell(mesh: Mesh, pairs: Ints) -> Ints:
    """The pairs without those of a flat element: near each other, and rightly apart."""
    n, marked = len(mesh.points), np.zeros(len(mesh.points), dtype=bool)
    marked[pairs] = True
    cells = mesh.cells[np.count_nonzero(marked[mesh.cells], axis=1) > 1]
    together = (cells[:, :, None] * n + cells[:, None, :]).ravel()
    return pairs[~np.isin(pairs[:, 0] * n + pairs[:, 1], together)]


def _cracks(mesh: Mesh, joints: Joints) -> list[Fault]:
    pairs = coincident(mesh)
    for joint in joints:
        sides = (f"{joint}.outer", f"{joint}.housing.bore") if isinstance(joint, str) else joint
        if len(pairs) == 0 or not all(side in mesh.faces for side in sides):
            continue
        inner, outer = (np.zeros(len(mesh.points), dtype=bool) for _ in sides)
        for mark, side in zip((inner, outer), sides, strict=True):
            mark[mesh.faces[side]] = True
        a, b = pairs.T
        meant = (inner[a] & outer[b]) | (inner[b] & outer[a])
        pairs = pairs[~meant]
    if len(pairs):
        pairs = np.sort(_of_no_common_cell(mesh, pairs), axis=1)
    return _of_nodes(
        mesh,
        "crack",
        np.unique(pairs[:, 0]),
        "stand where another node stands, with which they share no element: the body is cracked "
        "there, or two bodies that should be one touch without being joined",
        "merge them, or mesh the bodies together",
    )


def _hanging(mesh: Mesh, facets: SharedFacets) -> list[Fault]:
    n = len(mesh.points)
    corner, middle = np.zeros(n, dtype=bool), np.zeros(n, dtype=bool)
    corner[mesh.cells[:, :4]] = True
    middle[mesh.cells[:, 4:]] = True
    fix = "refine the neighbours too, or join the two sides by a tie "
    fix += "(fe_drivetrain.elasticity.interfaces)"
    faults = _of_nodes(
        mesh,
        "hanging node",
        np.flatnonzero(corner & middle),
        "are a corner of one element and in the middle of an edge of another",
        fix,
    )
    if faults:
        return faults
    # a closed surface has an even number of facets at each edge
    cell, side = np.divmod(facets.alone, 4)
    outside = mesh.cells[cell[:, None], FACETS[side, :3]]
    ends = outside[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    keys = ends.min(axis=1) * n + ends.max(axis=1)
    edges, count = np.unique(keys, return_counts=True)
    open_ = edges[count % 2 == 1]
    return _of_nodes(
        mesh,
        "hanging node",
        np.unique(open_ // n),
        "are on an edge where the surface of the mesh does not close: elements do not meet there",
        fix,
    )


def _pieces(mesh: Mesh, facets: SharedFacets) -> list[Fault]:
    """Parts whose cells do not hang together facet by facet."""
    ne = len(mesh.cells)
    one, two = facets.first // 4, facets.second // 4
    same = mesh.part[one] == mesh.part[two]
    graph = sparse.coo_array((np.ones(same.sum()), (one[same], two[same])), shape=(ne, ne))
    count, piece = connected_components(graph, directed=False)
    if count == len(np.unique(mesh.part)):
        return []
    faults = []
    for part, name in enumerate(mesh.part_names):
        cells = np.flatnonzero(mesh.part == part)
        if len(cells) == 0:
            continue
        pieces, sizes = np.unique(piece[cells], return_counts=True)
        if len(pieces) == 1:
            continue
        small = cells[piece[cells] == pieces[sizes.argmin()]]
        centre = mesh.points[mesh.cells[small, :4]].mean(axis=(0, 1))
        sentence = (
            f"part {name!r} falls into {len(pieces)} pieces that share no facet, the smallest of "
            f"{len(small)} elements, with element {small[0]}, round {_place(centre)}, but must be "
            "one piece: merge the nodes between them, or make them parts of their own"
        )
        faults.append(Fault("pieces", name, len(pieces), int(small[0]), _tuple(centre), sentence))
    return faults


def _faces(mesh: Mesh, facets: SharedFacets, needed: Iterable[str]) -> list[Fault]:
    faults = []
    for name in needed:
        if len(mesh.faces.get(name, ())) == 0:
            part = part_of(name, mesh.part_names) if _has_part(name, mesh) else ""
            cells = mesh.cells[mesh.part_cells(part)] if part else mesh.cells
            centre = mesh.points[cells[:, :4]].mean(axis=(0, 1))
            sentence = (
                f"face {name!r} of part {part!r} round {_place(centre)} is missing from the mesh "
                f"or empty: name it where the mesh is generated; there are {', '.join(mesh.faces)}"
            )
            faults.append(Fault("missing face", part, 1, -1, _tuple(centre), sentence))
    for name, triangles in mesh.faces.items():
        if not _has_part(name, mesh) or len(triangles) == 0:
            continue
        part = part_of(name, mesh.part_names)
        unknown = np.ones(len(triangles), dtype=np.bool_)
        for owner in _owners(name, part, mesh):
            unknown &= ~facets.found(triangles[:, :3], mesh.part, owner)
        strange = np.flatnonzero(unknown)
        if len(strange):
            centre = mesh.points[triangles[strange[0], :3]].mean(axis=0)
            sentence = (
                f"face {name!r}: {len(strange)} of its {len(triangles)} facets are no facets of "
                f"elements of part {part!r}, the first near {_place(centre)}: name facets of "
                "that part's elements"
            )
            faults.append(Fault("wrong face", part, len(strange), -1, _tuple(centre), sentence))
    return faults


def _owners(face: str, part: str, mesh: Mesh) -> list[int]:
    """Parts that a face's facets may be of: its own, and where a unit stands its further parts."""
    unit = f"{part.partition('.')[0]}."
    base = face == f"{unit}housing.base"
    names = enumerate(mesh.part_names)
    return [k for k, name in names if name == part or (base and name.startswith(unit))]


def _has_part(face: str, mesh: Mesh) -> bool:
    return any(face.startswith(f"{part}.") for part in mesh.part_names)
