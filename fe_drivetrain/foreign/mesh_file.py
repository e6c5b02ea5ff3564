"""A mesh file of another program (.msh, .vtu, .inp) as plain arrays, read by meshio.

This runs in a process of its own, see `reading`.
"""

from __future__ import annotations

import contextlib
import io
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.errors import InputError

MAX_NODES = 3_000_000
_FARTHEST = 1e9  # any coordinate, in the file's unit
_FORMATS = {".msh": "gmsh", ".vtu": "vtu", ".inp": "abaqus"}
# as TETRAHEDRON_EDGES of `elasticity.mesh.shapes`, which would bring scikit-fem into this short
# process
_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
_TRIANGLES = ("triangle", "triangle6")


def read(path: str) -> dict[str, Any]:
    """Nodes, tetrahedra of ten nodes, and labelled sets of tetrahedra, triangles and nodes.

    Tetrahedra of four nodes get straight edges. Returns "points" (n, 3), "cells" (ne, 10), and for
    each label "solid LABEL" (cells), "face LABEL" (k, 3) corners, or "nodes LABEL".
    """
    name, mesh = Path(path).name, _opened(path)
    points = _positions(name, mesh)
    solids = _solid_blocks(name, mesh)
    blocks = [np.asarray(block.data, dtype=np.int64) for block in mesh.cells]
    _refuse_unknown_nodes(name, points, blocks)
    kinds = {mesh.cells[k].type for k in solids}
    if len(kinds) > 1:
        raise InputError(f"{name} has tetrahedra of 4 and of 10 nodes: mesh all of it with 10")
    _refuse_lost_nodes(name, points, np.unique(np.concatenate([blocks[k].ravel() for k in solids])))
    first = np.cumsum([0, *(len(blocks[k]) for k in solids)])
    cells = np.concatenate([blocks[k] for k in solids])
    _refuse_doubles(name, points, cells)
    linear = cells.shape[1] == 4
    found: dict[str, Any] = {}
    for label, members in _sets(mesh).items():
        in_solids = [first[i] + members[k] for i, k in enumerate(solids) if k in members]
        flat = [blocks[k][members[k]][:, :3] for k in members if mesh.cells[k].type in _TRIANGLES]
        if any(len(m) for m in in_solids):
            found[f"solid {label}"] = np.concatenate(in_solids)
        if any(len(m) for m in flat):
            found[f"face {label}"] = np.concatenate(flat)
    for label, nodes in (mesh.point_sets or {}).items():
        found[f"nodes {label}"] = np.asarray(nodes, dtype=np.int64).ravel()
    if linear:
        points, cells = _with_middles(points, cells)
    return {"points": points, "cells": cells, "linear": np.array(linear), **found}


def _opened(path: str) -> Any:
    """The mesh as meshio has it."""
    import meshio

    file = Path(path)
    name, suffix = file.name, file.suffix.lower()
    if suffix == ".inp" and re.search(rb"(?im)^\*include\b", file.read_bytes()):
        raise InputError(f"{name} includes other files: write the mesh into one file")
    try:
        with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
            warnings.simplefilter("ignore")
            return meshio.read(path, file_format=_FORMATS[suffix])
    except MemoryError:
        raise
    except (Exception, SystemExit) as error:
        said = "" if isinstance(error, SystemExit) else " ".join(str(error).split())
        reason = said[:150].rstrip(".") or "it is damaged, or no such file"
        raise InputError(
            f"{name} cannot be read as a mesh ({reason}): write it again, whole, as "
            f"{_FORMATS[suffix]}"
        ) from None


def _positions(name: str, mesh: Any) -> Any:
    """Positions (n, 3) of the nodes."""
    points = np.asarray(mesh.points, dtype=float)
    if points.ndim != 2 or points.shape[1] != 3 or not 4 <= len(points) <= MAX_NODES:
        raise InputError(
            f"{name} has nodes of shape {points.shape} but must have x, y and z of at most "
            f"{MAX_NODES} nodes"
        )
    return points


def _solid_blocks(name: str, mesh: Any) -> list[int]:
    """Numbers of the blocks of tetrahedra, beside which there are faces and edges alone."""
    others = {
        block.type
        for block in mesh.cells
        if block.type not in ("tetra", "tetra10", "vertex", "line", "line3", *_TRIANGLES)
    }
    solids = [k for k, block in enumerate(mesh.cells) if block.type in ("tetra", "tetra10")]
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


def _refuse_doubles(name: str, points: Any, cells: Any) -> None:
    """Refuse elements that stand on the corners of others."""
    corners = np.sort(cells[:, :4], axis=1)
    _, at, count = np.unique(corners, axis=0, return_index=True, return_counts=True)
    if (count > 1).any():
        first = int(at[count > 1].min())
        x, y, z = points[cells[first, :4]].mean(axis=0)
        raise InputError(
            f"{name}: {int((count - 1).sum())} of its {len(cells)} elements stand where another "
            f"does, the first near ({x:.4g}, {y:.4g}, {z:.4g}): leave out the doubles"
        )


def _sets(mesh: Any) -> dict[str, dict[int, Any]]:
    """Members of each labelled set by block: physical groups of gmsh, sets of others."""
    found: dict[str, dict[int, Any]] = {}
    names = {
        (int(dim), int(tag)): str(label) for label, (tag, dim) in (mesh.field_data or {}).items()
    }
    tags = (mesh.cell_data or {}).get("gmsh:physical", [])
    for k, values in enumerate(tags):
        dim = 3 if mesh.cells[k].type.startswith("tetra") else 2
        for tag in np.unique(values):
            label = names.get((dim, int(tag)), str(int(tag)))
            found.setdefault(label, {})[k] = np.flatnonzero(np.asarray(values) == tag)
    for label, members in (mesh.cell_sets or {}).items():
        if label.startswith("gmsh:"):
            continue
        for k, some in enumerate(members):
            if some is not None and len(some):
                found.setdefault(label, {})[k] = np.asarray(some, dtype=np.int64)
    for label, values in (mesh.cell_data or {}).items():
        if label in ("gmsh:physical", "gmsh:geometrical"):
            continue
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
