"""A mesh file of another program as plain arrays, judged before anything is made of it.

Decks of Abaqus and CalculiX (.inp) are read by `abaqus_deck`, .vtu by meshio, all else by gmsh.
This runs in a process of its own, see `reading`.
"""

from __future__ import annotations

import contextlib
import io
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.foreign.overlaps import refuse_overlaps
from fe_drivetrain.foreign.raw_mesh import RawMesh

MAX_NODES = 3_000_000
_FARTHEST = 1e9  # any coordinate, in the file's unit
# as TETRAHEDRON_EDGES of `elasticity.mesh.shapes`, which would bring scikit-fem into this short
# process
_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
_SOLIDS = ("tetra", "tetra10")
_TRIANGLES = ("triangle", "triangle6")
_LINES = ("vertex", "line", "line3")


def read(path: str) -> dict[str, Any]:
    """Nodes, tetrahedra of ten nodes, and labelled sets of tetrahedra, triangles and nodes.

    Tetrahedra of four nodes get straight edges. Returns "points" (n, 3), "cells" (ne, 10), "beside"
    (what is left out, in words), and for each label "solid LABEL" (cells), "face LABEL" (k, 3)
    corners, "nodes LABEL", or "empty LABEL" of a set without members.
    """
    name, mesh = Path(path).name, _opened(path)
    points = _positions(name, mesh)
    solids = _solid_blocks(name, mesh)
    blocks = [np.asarray(nodes, dtype=np.int64) for _, nodes in mesh.blocks]
    _refuse_unknown_nodes(name, points, blocks)
    if len({mesh.blocks[k][0] for k in solids}) > 1:
        raise InputError(f"{name} has tetrahedra of 4 and of 10 nodes: mesh all of it with 10")
    _refuse_lost_nodes(name, points, np.unique(np.concatenate([blocks[k].ravel() for k in solids])))
    cells = np.concatenate([blocks[k] for k in solids])
    refuse_overlaps(name, points, cells)
    found = _labelled(mesh, solids, blocks)
    linear = cells.shape[1] == 4
    if linear:
        points, cells = _with_middles(points, cells)
    beside = ", ".join(f"{count} of {kind}" for kind, count in sorted(mesh.left_out.items()))
    return {
        "points": points,
        "cells": cells,
        "linear": np.array(linear),
        "beside": np.array(beside),
        **found,
    }


def _labelled(mesh: RawMesh, solids: list[int], blocks: list[Any]) -> dict[str, Any]:
    """Sets by what they are of and their labels, see `read`."""
    first = dict(zip(solids, np.cumsum([0, *(len(blocks[k]) for k in solids)]), strict=False))
    found: dict[str, Any] = {}
    faces = {label: [corners] for label, corners in mesh.faces.items()}
    for label, members in mesh.cell_sets.items():
        in_solids = [first[k] + members[k] for k in solids if k in members]
        flat = [blocks[k][members[k]][:, :3] for k in members if mesh.blocks[k][0] in _TRIANGLES]
        if any(len(m) for m in in_solids):
            found[f"solid {label}"] = np.concatenate(in_solids)
        faces.setdefault(label, []).extend(m for m in flat if len(m))
    found |= {f"face {label}": np.concatenate(parts) for label, parts in faces.items() if parts}
    for label, nodes in mesh.node_sets.items():
        if len(nodes):
            found[f"nodes {label}"] = np.asarray(nodes, dtype=np.int64).ravel()
    there = {key.partition(" ")[2] for key in found}
    for label in (*mesh.cell_sets, *mesh.node_sets):
        if label not in there:
            found[f"empty {label}"] = np.zeros(0, dtype=np.int64)
    return found


def _opened(path: str) -> RawMesh:
    """The mesh as the reader of its kind has it."""
    suffix = Path(path).suffix.lower()
    if suffix == ".inp":
        from fe_drivetrain.foreign.abaqus_deck import read_deck

        return read_deck(path)
    if suffix == ".vtu":
        return _by_meshio(path)
    from fe_drivetrain.foreign.gmsh_mesh import read_by_gmsh

    return read_by_gmsh(path)


def _by_meshio(path: str) -> RawMesh:
    """The mesh of a .vtu file."""
    import meshio

    said, name = io.StringIO(), Path(path).name
    try:
        with (
            warnings.catch_warnings(),
            contextlib.redirect_stdout(said),
            contextlib.redirect_stderr(io.StringIO()),
        ):
            warnings.simplefilter("ignore")
            mesh = meshio.read(path, file_format="vtu")
    except MemoryError:
        raise
    except (Exception, SystemExit) as error:
        # meshio prints what is wrong, and then ends the program
        words = said.getvalue() if isinstance(error, SystemExit) else str(error)
        reason = " ".join(words.split())[:200].rstrip(".") or type(error).__name__
        raise InputError(
            f"{name} cannot be read as a mesh ({reason}): write it again, whole"
        ) from None
    blocks = [(block.type, block.data) for block in mesh.cells]
    nodes = {label: np.asarray(some).ravel() for label, some in (mesh.point_sets or {}).items()}
    return RawMesh(mesh.points, blocks, _sets(mesh), nodes)


def _positions(name: str, mesh: RawMesh) -> Any:
    """Positions (n, 3) of the nodes."""
    points = np.asarray(mesh.points, dtype=float)
    if not len(points):
        raise InputError(f"{name} holds no nodes: write it again, whole, as the mesh of a solid")
    if points.ndim != 2 or points.shape[1] != 3 or not 4 <= len(points) <= MAX_NODES:
        raise InputError(
            f"{name} has nodes of shape {points.shape} but must have x, y and z of at most "
            f"{MAX_NODES} nodes"
        )
    return points


def _solid_blocks(name: str, mesh: RawMesh) -> list[int]:
    """Numbers of the blocks of tetrahedra, beside which there are faces and edges alone."""
    others = {kind for kind, _ in mesh.blocks if kind not in (*_SOLIDS, *_LINES, *_TRIANGLES)}
    solids = [k for k, (kind, nodes) in enumerate(mesh.blocks) if kind in _SOLIDS and len(nodes)]
    if others or not solids:
        raise InputError(
            f"{name} has elements of kind {', '.join(sorted(others)) or 'none'} but must have "
            "tetrahedra of 4 or 10 nodes alone (faces and edges of them beside): mesh the part so"
        )
    return solids


def _refuse_unknown_nodes(name: str, points: Any, blocks: list[Any]) -> None:
    """Refuse elements with numbers of nodes that there are not."""
    for block in blocks:
        if block.size and (block.min() < 0 or block.max() >= len(points)):
            raise InputError(
                f"{name} has an element with node number {block.max()}, but there are "
                f"{len(points)} nodes: write it again, whole"
            )


def _refuse_lost_nodes(name: str, points: Any, used: Any) -> None:
    """Refuse nodes of elements that have no position, or one far away."""
    lost = used[~np.isfinite(points[used]).all(axis=1)]
    if len(lost):
        raise InputError(
            f"{name}: {len(lost)} nodes have no finite position, the first node {lost[0]}: write "
            "the mesh again"
        )
    far = used[np.abs(points[used]).max(axis=1) > _FARTHEST]
    if len(far):
        raise InputError(
            f"{name}: node {far[0]} is at ({', '.join(f'{x:.3g}' for x in points[far[0]])}), but "
            f"coordinates must be at most {_FARTHEST:g}: write the mesh again"
        )


def _sets(mesh: Any) -> dict[str, dict[int, Any]]:
    """Members of each labelled set of meshio by block: its sets, and whole numbers of cells."""
    found: dict[str, dict[int, Any]] = {}
    for label, members in (mesh.cell_sets or {}).items():
        for k, some in enumerate(members):
            if some is not None and len(some):
                found.setdefault(label, {})[k] = np.asarray(some, dtype=np.int64)
    for label, values in (mesh.cell_data or {}).items():
        for k, value in enumerate(values):
            value = np.asarray(value)
            if value.ndim == 1 and value.dtype.kind in "iu" and len(np.unique(value)) <= 1000:
                for number in np.unique(value):
                    some = np.flatnonzero(value == number)
                    found.setdefault(f"{label} {number}", {})[k] = some
    return found


def _with_middles(points: Any, cells: Any) -> tuple[Any, Any]:
    """Ten-node tetrahedra with straight edges."""
    ends = np.sort(cells[:, np.array(_EDGES)].reshape(-1, 2), axis=1)
    edges, which = np.unique(ends, axis=0, return_inverse=True)
    middles = points[edges].mean(axis=1)
    mids = len(points) + which.reshape(len(cells), 6)
    return np.vstack([points, middles]), np.hstack([cells, mids])
