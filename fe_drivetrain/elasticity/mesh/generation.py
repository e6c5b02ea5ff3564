"""Meshes of parts by gmsh: generated, curved, relaxed where elements fold over, and renumbered."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import gmsh
import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import reverse_cuthill_mckee

from fe_drivetrain.common.arrays import Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.measures import inverted_cells, scaled_jacobians
from fe_drivetrain.elasticity.mesh.mesh import FACETS, Mesh, part_of
from fe_drivetrain.elasticity.mesh.shapes import TETRAHEDRON_EDGES
from fe_drivetrain.geometry import (
    NO_BANDS,
    Band,
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
from fe_drivetrain.geometry.session import numbered_nodes

GMSH_TO_VTK = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]
"""Columns of gmsh's ten-node tetrahedron in the order of VTK, meshio and scikit-fem."""

DEFAULT_SIZES = MeshSizes()

ATTEMPTS = 4

REFINEMENT = 1.3
"""Refinement factor for a kind of part whose elements fold over, before it is meshed again."""


def generate(
    shaft: Shaft | None,
    bearings: Sequence[Bearing] = (),
    housings: Mapping[str, Housing] | None = None,
    sizes: MeshSizes = DEFAULT_SIZES,
    bonded: frozenset[str] = frozenset(),
    local: LocalSizes | None = None,
    bands: Mapping[str, Band] = NO_BANDS,
) -> Mesh:
    """Build the parts and mesh them.

    Where curved elements fold over (a rim or a lip much thinner than the mesh size, say), the
    parts concerned are meshed again, finer than asked for, a few times.

    Parameters
    ----------
    shaft, bearings, housings, sizes, bonded, bands : see `fe_drivetrain.geometry.build`
        Parts and sizes, as `fe_drivetrain.geometry.build` takes them.
    local : LocalSizes or None
        Smaller sizes where they are wanted.

    Returns
    -------
    Mesh
        Mesh in which every element is valid everywhere inside.

    Raises
    ------
    InputError
        The parts do not fit together, or an element stays inverted.
    """
    housings = {} if housings is None else housings
    joints = [f"{b.name}.housing" for b in bearings if b.name in set(housings) - bonded]
    for _ in range(ATTEMPTS):
        with gmsh_session():
            build(shaft, bearings, housings, sizes, bonded, bands)
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
    straight edge, again and again, until it is sound; the shape changes there by a fraction of
    an edge's sagitta. Nodes of seats, joints and bases stay exactly where they are; the ends and
    the bore of the shaft may change like any other surface.

    Parameters
    ----------
    mesh : Mesh
        The mesh as it was curved.
    floor : float
        Cells of a smaller scaled Jacobian are relaxed.
    passes : int
        Maximum number of passes; each halves the curvature that is left.
    """
    points, moves = mesh.points.copy(), np.ones(len(mesh.points), dtype=bool)
    for name in set(mesh.faces) - {"shaft.front", "shaft.rear", "shaft.bore"}:
        moves[mesh.face_nodes(name)] = False
    for _ in range(passes):
        flat = mesh.cells[scaled_jacobians(points, mesh.cells) < floor]
        if len(flat) == 0:
            break
        mids, first = np.unique(flat[:, 4:], return_index=True)
        ends = flat[:, TETRAHEDRON_EDGES].reshape(-1, 2)[first]
        free = moves[mids]
        straight = points[ends[free]].mean(axis=1)
        points[mids[free]] = (points[mids[free]] + straight) / 2
    return replace(mesh, points=points)


def read_gmsh(split: Sequence[str]) -> Mesh:
    """Read the mesh of the open gmsh model, doubling the bore nodes of the housings in `split`."""
    points, number = numbered_nodes()
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
    corners = TETRAHEDRON_EDGES
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
