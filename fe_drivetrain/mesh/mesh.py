"""The mesh: curved ten-node tetrahedra with named volumes, faces and points."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path

import gmsh
import meshio
import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.csgraph import reverse_cuthill_mckee
from skfem import MeshTet2

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.geometry import (
    Bearing,
    Housing,
    LocalSizes,
    MeshSizes,
    Shaft,
    apply_local_sizes,
    build,
    gmsh_session,
    size_name,
)
from fe_drivetrain.mesh.facets import facet_points, local_facets

GMSH_TO_VTK = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]
"""Columns of gmsh's ten-node tetrahedron in the order of VTK, meshio and scikit-fem."""

DEFAULT_SIZES = MeshSizes()

ATTEMPTS = 4
_AREA_DEGREE = 8
REFINEMENT = 1.3
"""Where elements fold over, the mesh of that kind of part is refined so much, and tried again."""

EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
"""Corners of the edges whose mid-side nodes are local nodes 4 to 9."""

FACETS = local_facets(10)
"""Local nodes of the four facets of a tetrahedron, turned outward: corners, then mid-sides."""


@dataclass(frozen=True)
class Mesh:
    """A mesh of curved second-order tetrahedra.

    Attributes
    ----------
    points
        (n, 3) positions of the nodes, m.
    cells
        (ne, 10) node ids in VTK's order, which is scikit-fem's too.
    part
        (ne,) index into `part_names`.
    part_names
        Names of the parts.
    faces
        (nf, 6) node ids of the six-node triangles of each named face, normal outward from the
        part whose name the face's name begins with.
    named_points
        Node id of each named point.
    kept
        Whether it was taken from the cache instead of made.
    """

    points: Floats
    cells: Ints
    part: Ints
    part_names: tuple[str, ...]
    faces: dict[str, Ints]
    named_points: dict[str, int]
    kept: bool = False

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


def generate(
    shaft: Shaft | None,
    bearings: Sequence[Bearing] = (),
    housings: Mapping[str, Housing] | None = None,
    sizes: MeshSizes = DEFAULT_SIZES,
    bonded: frozenset[str] = frozenset(),
    local: LocalSizes | None = None,
) -> Mesh:
    """Build the parts and mesh them.

    Where curved elements fold over (a rim or a lip much thinner than the mesh size, say), the
    parts concerned are meshed again, finer than asked for, a few times.

    Parameters
    ----------
    shaft, bearings, housings, sizes, bonded
        As for `fe_drivetrain.geometry.build`.
    local
        Smaller sizes where they are wanted, see `fe_drivetrain.mesh.adaptivity`.

    Returns
    -------
    Mesh
        Every element valid everywhere inside.

    Raises
    ------
    InputError
        The parts do not fit together, or an element stays inverted.
    """
    housings = {} if housings is None else housings
    joints = [f"{b.name}.housing" for b in bearings if b.name in set(housings) - bonded]
    for _ in range(ATTEMPTS):
        with gmsh_session():
            build(shaft, bearings, housings, sizes, bonded)
            if local is not None:
                apply_local_sizes(local)
            gmsh.model.mesh.generate(3)
            gmsh.model.mesh.setOrder(2)
            mesh = relax_flat_cells(read_gmsh(joints))
        inverted = inverted_cells(mesh)
        if len(inverted) == 0:
            return mesh
        kinds = {size_name(mesh.part_names[part]) for part in mesh.part[inverted]}
        sizes = sizes.finer(kinds, REFINEMENT)
    raise InputError(_inversion(mesh, inverted))


def _inversion(mesh: Mesh, cells: Ints) -> str:
    """One sentence on the cells that fold over."""
    part = mesh.part_names[mesh.part[cells[0]]]
    x, y, z = mesh.points[mesh.cells[cells[0], :4]].mean(axis=0)
    return (
        f"part {part!r}: {len(cells)} of its curved elements fold over, the first, element "
        f"{cells[0]}, near ({x:.3g}, {y:.3g}, {z:.3g}) m, where the scaled Jacobian "
        f"must be greater than 0: reduce the mesh size {size_name(part)!r}, raise "
        "elements_per_turn, or leave out the detail there"
    )


def relax_flat_cells(mesh: Mesh, floor: float = 0.05, passes: int = 4) -> Mesh:
    """Take curvature back from the edges of cells that curving has flattened.

    Where a cell has two facets on one smooth surface, or lies across a sharp fillet, curving its
    edges to the surface can fold it. Its mid-side nodes are then drawn half way towards the
    straight edge, again and again, until it is sound; the shape gives way there by a fraction of
    an edge's sagitta. Nodes of seats, joints and bases stay exactly where they are; the ends and
    the bore of the shaft may give way like any other surface.

    Parameters
    ----------
    mesh
        The mesh as it was curved.
    floor
        Cells of a smaller scaled Jacobian are relaxed.
    passes
        How often at most; each halves what curvature is left.
    """
    points, moves = mesh.points.copy(), np.ones(len(mesh.points), dtype=bool)
    for name in set(mesh.faces) - {"shaft.front", "shaft.rear", "shaft.bore"}:
        moves[mesh.face_nodes(name)] = False
    for _ in range(passes):
        flat = mesh.cells[scaled_jacobians(points, mesh.cells) < floor]
        if len(flat) == 0:
            break
        mids, first = np.unique(flat[:, 4:], return_index=True)
        ends = flat[:, np.array(EDGES)].reshape(-1, 2)[first]
        free = moves[mids]
        straight = points[ends[free]].mean(axis=1)
        points[mids[free]] = (points[mids[free]] + straight) / 2
    return replace(mesh, points=points)


def read_gmsh(split: Sequence[str]) -> Mesh:
    """Read the mesh of the open gmsh model, doubling the bore nodes of the housings in `split`."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    points = np.asarray(coordinates).reshape(-1, 3)
    number = np.full(int(tags.max()) + 1, -1)
    number[tags] = np.arange(len(tags))
    names, blocks, triangles, named_points = [], [], {}, {}
    for dim, group in gmsh.model.getPhysicalGroups():
        name = gmsh.model.getPhysicalName(dim, group)
        if dim == 0:
            found, _ = gmsh.model.mesh.getNodesForPhysicalGroup(0, group)
            named_points[name] = int(found[0])
            continue
        kind, width = (9, 6) if dim == 2 else (11, 10)
        nodes = [
            gmsh.model.mesh.getElementsByType(kind, entity)[1].reshape(-1, width)
            for entity in gmsh.model.getEntitiesForPhysicalGroup(dim, group)
        ]
        if dim == 2:
            triangles[name] = number[np.concatenate(nodes)]
        else:
            names.append(name)
            blocks.append(number[np.concatenate(nodes)][:, GMSH_TO_VTK])
    part = np.repeat(np.arange(len(blocks)), [len(b) for b in blocks])
    cells = np.concatenate(blocks)
    for owner in split:
        joint = np.unique(triangles[f"{owner}.bore"])
        twin = np.arange(len(points))
        twin[joint] = len(points) + np.arange(len(joint))
        points = np.concatenate([points, points[joint]])
        rows = part == names.index(owner)
        cells[rows] = twin[cells[rows]]
        triangles[f"{owner}.bore"] = twin[triangles[f"{owner}.bore"]]
    used, new = _in_order(cells, len(points))
    cells = new[cells]
    # cells that follow one another share nodes
    order = np.lexsort((cells.min(axis=1), part))
    cells, part = cells[order], part[order]
    faces = {}
    for name, block in triangles.items():
        owner = part_of(name, names)
        faces[name] = _outward(new[block], cells[part == names.index(owner)])
    return Mesh(
        points[used],
        cells,
        part,
        tuple(names),
        faces,
        {name: int(new[number[tag]]) for name, tag in named_points.items()},
    )


def _in_order(cells: Ints, n_nodes: int) -> tuple[Ints, Ints]:
    """The nodes that cells use, neighbours near each other; and the new number of every node.

    gmsh puts mid-side nodes far from their corners, and parts in no order. Beyond the cache of a
    processor, the product of a matrix with vectors then takes three times as long.
    """
    corners = np.array(EDGES)
    ends = np.concatenate([cells[:, corners[:, k]].ravel() for k in (0, 1)])
    middles = np.tile(cells[:, 4:].ravel(), 2)
    graph = sparse.coo_matrix((np.ones(len(ends)), (ends, middles)), shape=(n_nodes, n_nodes))
    order = reverse_cuthill_mckee((graph + graph.T).tocsr(), symmetric_mode=True).astype(np.int64)
    used = order[np.isin(order, cells)]
    new = np.full(n_nodes, -1)
    new[used] = np.arange(len(used))
    return used, new


def _outward(triangles: Ints, cells: Ints) -> Ints:
    """The facets of the cells that are these triangles, turned outward from the cells."""
    facets = cells[:, FACETS].reshape(-1, 6)
    facets = facets[np.isin(facets[:, :3], triangles[:, :3]).all(axis=1)]
    corners = np.sort(np.concatenate([facets, triangles])[:, :3], axis=1)
    _, first, which = np.unique(corners, axis=0, return_index=True, return_inverse=True)
    found = first[which.reshape(-1)[len(facets) :]]
    if (found >= len(facets)).any():
        raise RuntimeError("a named face has a triangle that is no facet of its part")
    return facets[found]


def lattice(order: int) -> Ints:
    """Multi-indices of a tetrahedral lattice, (n, 4), each row summing to `order`."""
    rows = [
        (order - i - j - k, i, j, k)
        for i in range(order + 1)
        for j in range(order + 1 - i)
        for k in range(order + 1 - i - j)
    ]
    return np.array(rows)


def shape_gradients(points: Floats) -> Floats:
    """Gradients of the ten quadratic shape functions, in VTK's order.

    Parameters
    ----------
    points
        (q, 4) barycentric coordinates in the reference tetrahedron.

    Returns
    -------
    (q, 10, 3) derivatives with respect to the three reference coordinates.
    """
    g = np.array([[-1.0, -1, -1], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    corners = (4 * points - 1)[:, :, None] * g
    a, b = np.array(EDGES).T
    mids = 4 * (points[:, a, None] * g[b] + points[:, b, None] * g[a])
    return np.concatenate([corners, mids], axis=1)


CUBIC = lattice(3) / 3
"""The 20 points that determine the Jacobian of a quadratic tetrahedron, a cubic polynomial."""

_FACTORIALS = np.array([1, 1, 2, 6])
_CHOOSE = 6 / _FACTORIALS[lattice(3)].prod(axis=1)
TO_BERNSTEIN = np.linalg.inv(_CHOOSE * (CUBIC[:, None, :] ** lattice(3)[None]).prod(axis=2))
"""Values at `CUBIC` times the transpose of this: the Bernstein coefficients."""

# the ten nodes of a tetrahedron, and the eight that halve its edges: one at each corner, and the
# octahedron between them cut in four along the diagonal from edge 01 to edge 23
_TEN = np.concatenate(
    [np.eye(4), [(np.eye(4)[i] + np.eye(4)[j]) / 2 for i, j in combinations(range(4), 2)]]
)
EIGHTHS = _TEN[
    [
        [0, 4, 5, 6],
        [1, 4, 7, 8],
        [2, 5, 7, 9],
        [3, 6, 8, 9],
        [4, 9, 5, 6],
        [4, 9, 6, 8],
        [4, 9, 8, 7],
        [4, 9, 7, 5],
    ]
]
"""Corners of the eight tetrahedra that halve the edges of one, (8, 4, 4), barycentric."""


_BLOCK = 4096  # cells


def jacobians(points: Floats, cells: Ints, at: Floats = CUBIC) -> Floats:
    """Determinant of the Jacobian of each cell.

    Parameters
    ----------
    points
        (n, 3), m.
    cells
        (ne, 10) node ids.
    at
        (q, 4) barycentric coordinates.

    Returns
    -------
    (ne, q) determinants, m3; six times the volume for an element with straight edges.
    """
    gradients = shape_gradients(at).transpose(1, 2, 0).reshape(10, -1)
    blocks = []
    # in blocks, so that the Jacobians of a large mesh never stand in memory all at once
    for start in range(0, len(cells), _BLOCK):
        nodes = points[cells[start : start + _BLOCK]].transpose(0, 2, 1)
        # one product for all, far faster than many small ones: rows x, y, z, three derivatives each
        rows = (nodes.reshape(-1, 10) @ gradients).reshape(len(nodes), 3, 3, len(at))
        x, y, z = rows.transpose(1, 2, 0, 3)
        blocks.append(
            x[0] * (y[1] * z[2] - y[2] * z[1])
            + x[1] * (y[2] * z[0] - y[0] * z[2])
            + x[2] * (y[0] * z[1] - y[1] * z[0])
        )
    return np.concatenate(blocks) if blocks else np.empty((0, len(at)))


def inverted_cells(mesh: Mesh, depth: int = 3) -> Ints:
    """Cells whose Jacobian cannot be shown to be positive everywhere inside.

    The Jacobian of a quadratic tetrahedron is a cubic polynomial, which its Bernstein
    coefficients bound from below (Johnen, Remacle and Geuzaine 2013, section 3): positive
    coefficients prove the element valid everywhere, not only at sampled points. Where the bound
    does not decide, the element is split in eight and each piece judged again.

    Parameters
    ----------
    depth
        How often an undecided element is split.

    Returns
    -------
    Indices of the cells, ascending.
    """
    # of an element straight to round-off, the Jacobian at its centre is that everywhere
    nodes = mesh.points[mesh.cells]
    first, second = np.array(EDGES).T
    sagitta = nodes[:, 4:] - (nodes[:, first] + nodes[:, second]) / 2
    round_off = 1e-14 * np.abs(mesh.points).max(initial=0.0)
    curved = np.abs(sagitta).reshape(-1, 18).max(axis=1, initial=0.0) > round_off
    straight = np.flatnonzero(~curved)
    centre = jacobians(mesh.points, mesh.cells[straight], np.full((1, 4), 0.25))[:, 0]
    curved_cells = np.flatnonzero(curved)
    values = jacobians(mesh.points, mesh.cells[curved_cells])
    negative = values.min(axis=1, initial=np.inf) <= 0
    undecided = ((values @ TO_BERNSTEIN.T).min(axis=1, initial=np.inf) <= 0) & ~negative
    invalid = [*straight[centre <= 0], *curved_cells[negative]]
    for cell in curved_cells[undecided]:
        pieces = EIGHTHS
        for level in range(depth):
            at = np.einsum("qc,pcb->pqb", CUBIC, pieces)
            inside = jacobians(mesh.points, mesh.cells[[cell]], at.reshape(-1, 4))
            inside = inside.reshape(len(pieces), -1)
            open_ = (inside @ TO_BERNSTEIN.T).min(axis=1) <= 0
            if not open_.any():
                break
            if inside.min() <= 0 or level == depth - 1:
                invalid.append(cell)
                break
            pieces = np.einsum("skc,pcb->pskb", EIGHTHS, pieces[open_]).reshape(-1, 4, 4)
    return np.array(sorted(invalid), dtype=np.int64)


@dataclass(frozen=True)
class MeshQuality:
    """How well shaped a mesh is.

    Attributes
    ----------
    minimum_scaled_jacobian
        Least ratio of the Jacobian in a curved element to that of the straight-sided element
        with the same corners: 1 where every edge is straight, 0 or less where an element folds
        over (gmsh's minSJ). Sampled at the 20 points of the cubic lattice.
    minimum_scaled_jacobian_of
        The same, part by part.
    elements, nodes
        Their numbers.
    inverted
        Number of elements not proved valid everywhere inside (`inverted_cells`).
    """

    minimum_scaled_jacobian: float
    minimum_scaled_jacobian_of: dict[str, float]
    elements: int
    nodes: int
    inverted: int


def scaled_jacobians(points: Floats, cells: Ints) -> Floats:
    """Least ratio of each cell's Jacobian to that of its straight-sided twin, (ne,).

    Negative also where the corners alone make an inverted tetrahedron.
    """
    corners = points[cells[:, :4]]
    straight = np.linalg.det(corners[:, 1:] - corners[:, :1])
    least = jacobians(points, cells).min(axis=1)
    flat = np.full_like(least, -np.inf)
    ratio = np.divide(least, np.abs(straight), out=flat, where=straight != 0)
    return np.asarray(np.where(straight > 0, ratio, -np.abs(ratio)))


def quality(mesh: Mesh) -> MeshQuality:
    """Measure the shape of the elements."""
    scaled = scaled_jacobians(mesh.points, mesh.cells)
    return MeshQuality(
        minimum_scaled_jacobian=float(scaled.min()),
        minimum_scaled_jacobian_of={
            name: float(scaled[mesh.part_cells(name)].min()) for name in mesh.part_names
        },
        elements=len(mesh.cells),
        nodes=len(mesh.points),
        inverted=len(inverted_cells(mesh)),
    )


def volume(mesh: Mesh, part: str | None = None) -> float:
    """Volume of the mesh or of one part, curved elements and all.

    Exact for the meshed shape: the Jacobian is a cubic polynomial, whose mean over the element is
    the mean of its Bernstein coefficients.

    Returns
    -------
    Volume, m3.
    """
    cells = mesh.cells if part is None else mesh.cells[mesh.part_cells(part)]
    weights = TO_BERNSTEIN.mean(axis=0) / 6
    return float((jacobians(mesh.points, cells) @ weights).sum())


def area(mesh: Mesh, face: str) -> float:
    """Area of a named face, m2, over its curved facets."""
    mesh.face_nodes(face)
    return float(facet_points(mesh.points, mesh.faces[face], _AREA_DEGREE).areas.sum())


def area_vectors(points: Floats, facets: Ints) -> Floats:
    """Integral of the normal over each curved facet, (nf, 3), m2; zero in sum when closed."""
    at = facet_points(points, facets, _AREA_DEGREE)
    return np.asarray(np.einsum("fqi,fq->fi", at.normals, at.areas))


def boundary(mesh: Mesh, part: str | None = None) -> Ints:
    """Facets (nf, 6), turned outward, that belong to one cell only of the mesh or of a part."""
    cells = mesh.cells if part is None else mesh.cells[mesh.part_cells(part)]
    facets = cells[:, FACETS].reshape(-1, 6)
    _, first, count = np.unique(
        np.sort(facets[:, :3], axis=1), axis=0, return_index=True, return_counts=True
    )
    outside: Ints = facets[np.sort(first[count == 1])]
    return outside


def write(
    mesh: Mesh, path: str | os.PathLike[str], point_data: Mapping[str, npt.ArrayLike] | None = None
) -> None:
    """Write the mesh for ParaView (.vtu) or gmsh (.msh); the file appears whole or not at all.

    The .vtu holds the tetrahedra with their part as cell data; the .msh holds every part, face
    and point as a physical group of its name.

    Parameters
    ----------
    mesh
        The mesh.
    path
        File to write, ending in .vtu or .msh.
    point_data
        Values at the nodes, (n,) or (n, k), by name.

    Raises
    ------
    InputError
        The ending is another, the folder does not exist, or a value does not fit the nodes.
    """
    target = Path(path)
    if target.suffix not in (".vtu", ".msh"):
        raise InputError(f"mesh file {target} ends in {target.suffix!r}: use .vtu or .msh")
    if not target.parent.is_dir():
        raise InputError(f"mesh file {target}: there is no folder {target.parent}: create it first")
    data = {name: np.asarray(values) for name, values in (point_data or {}).items()}
    for name, values in data.items():
        if values.ndim not in (1, 2) or len(values) != len(mesh.points):
            raise InputError(
                f"point data {name!r} has shape {values.shape} but must have "
                f"{len(mesh.points)} rows, one a node: give (n,) or (n, k) values"
            )
    blocks: list[tuple[str, Ints]] = []
    tags: list[Ints] = []
    field_data: dict[str, Ints] = {}
    if target.suffix == ".msh":
        groups = [(0, "vertex", n, np.array([[node]])) for n, node in mesh.named_points.items()]
        groups += [(2, "triangle6", n, facets) for n, facets in mesh.faces.items()]
        groups += [(3, "tetra10", n, mesh.cells[mesh.part_cells(n)]) for n in mesh.part_names]
        for tag, (dim, kind, name, cells) in enumerate(groups, start=1):
            blocks.append((kind, cells))
            tags.append(np.full(len(cells), tag, dtype=np.int32))
            field_data[name] = np.array([tag, dim])
        cell_data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
        options = {"file_format": "gmsh22", "binary": True}
    else:
        blocks.append(("tetra10", mesh.cells))
        cell_data = {"part": [mesh.part.astype(np.int32)]}
        options = {"file_format": "vtu"}
    content = meshio.Mesh(
        mesh.points, blocks, point_data=data, cell_data=cell_data, field_data=field_data
    )
    with atomic_path(target) as unfinished:
        meshio.write(unfinished, content, **options)
