"""Mesh files that gmsh reads: its own of all versions, I-DEAS (.unv), MED, and surfaces in STL.

This runs in a process of its own, see `reading`.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import gmsh
import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import scratch_folder
from fe_drivetrain.foreign.raw_mesh import RawMesh
from fe_drivetrain.foreign.step_heal import reason
from fe_drivetrain.geometry.session import gmsh_session

#: Kinds of elements by gmsh's number; what is not here is called as gmsh calls it.
_KINDS = {2: "triangle", 9: "triangle6", 4: "tetra", 11: "tetra10"}
_EDGES = {1, 8, 15, 26, 27, 28}  # lines and points
_TO_VTK = {"tetra10": [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]}
_SURFACES = (".stl",)
_STARTS = (b"$MeshFormat", b"$NOD", b"$Comments", b"$PhysicalNames")  # of .msh, all versions


def read_by_gmsh(path: str) -> RawMesh:
    """Read a mesh file by gmsh; a closed surface is filled with tetrahedra.

    Parameters
    ----------
    path : str
        File whose ending says what it is.

    Raises
    ------
    InputError
        gmsh cannot read it, or a surface encloses nothing.
    """
    _refuse_scripts(path)
    with gmsh_session(), scratch_folder() as folder:
        gmsh.model.remove()
        gmsh.logger.start()
        before = len(gmsh.logger.get())  # of earlier sessions
        # by a name of its own: gmsh runs FILE.opt as a script where it stands beside a file
        link = folder / f"mesh{Path(path).suffix.lower()}"
        link.symlink_to(Path(path).resolve())
        try:
            gmsh.open(str(link))
            said = [line for line in gmsh.logger.get()[before:] if line.startswith("Error")]
            if said:
                raise _unread(path, said[0].partition(":")[2].strip())
            if Path(path).suffix.lower() in _SURFACES:
                _fill(path)
            return _found()
        except UnicodeDecodeError:  # of a message that quotes the file
            raise _unread(path, "its text is not UTF-8") from None
        except Exception as error:
            if type(error) is not Exception:  # gmsh reports its own failures as bare ones
                raise
            raise _unread(path, reason(error)) from None


def _refuse_scripts(path: str) -> None:
    """Refuse a .msh file that is none: gmsh would run it as a script, with commands of a shell."""
    with Path(path).open("rb") as file:
        start = file.read(200).lstrip()
    if Path(path).suffix.lower() == ".msh" and not start.startswith(_STARTS):
        raise InputError(
            f"{Path(path).name} is no mesh of gmsh: it must begin with $MeshFormat, not with "
            f"{start[:20].decode('ascii', 'replace')!r}: write it again, whole"
        )


def _unread(path: str, why: str) -> InputError:
    why = re.sub(r"'?\S*/mesh(\.\w+)'?", r"mesh\1", " ".join(why.split())).rstrip(".")
    return InputError(
        f"{Path(path).name} cannot be read as a mesh (gmsh: {why[:200]}): write it again, whole"
    )


def _fill(path: str) -> None:
    """Mesh the inside of a closed surface; its triangles stay."""
    gmsh.model.mesh.removeDuplicateNodes()
    gmsh.model.mesh.createTopology()
    surfaces = [tag for _, tag in gmsh.model.getEntities(2)]
    name = Path(path).name
    open_edges = _open_edges()
    if not surfaces:
        raise InputError(f"{name} holds no triangles: write it again, whole")
    if open_edges:
        raise InputError(
            f"{name} is a surface of which {open_edges} edges belong to one triangle alone or to "
            "more than two: close it in the CAD program, or write the solid as STEP"
        )
    loop = gmsh.model.geo.addSurfaceLoop(surfaces)
    gmsh.model.geo.addVolume([loop])
    gmsh.model.geo.synchronize()
    try:
        gmsh.model.mesh.generate(3)
    except Exception as error:
        if type(error) is not Exception:
            raise
        raise InputError(
            f"{name} is a surface whose inside cannot be meshed ({reason(error)}): repair it, or "
            "write the solid as STEP"
        ) from None


def _open_edges() -> int:
    """How many edges do not have two triangles."""
    nodes = gmsh.model.mesh.getElementsByType(2)[1].astype(np.int64).reshape(-1, 3)
    edges = np.sort(nodes[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, count = np.unique(edges, axis=0, return_counts=True)
    return int((count != 2).sum())


def _found() -> RawMesh:
    """What the open model has of nodes and elements, and its physical groups as sets."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    order = np.argsort(tags)
    known = np.asarray(tags, np.int64)[order]
    points = np.asarray(coordinates, float).reshape(-1, 3)[order]
    found = RawMesh(points, [])
    for dim, entity in gmsh.model.getEntities():
        if "Ghost" in gmsh.model.getType(dim, entity):  # elements of other partitions
            continue
        groups = gmsh.model.getPhysicalGroupsForEntity(dim, entity)
        types, _, nodes = gmsh.model.mesh.getElements(dim, entity)
        for number, some in zip(types, nodes, strict=True):
            name, _, _, width, _, _ = gmsh.model.mesh.getElementProperties(number)
            if number in _EDGES:
                continue
            kind = _KINDS.get(int(number), name)
            rows = _rows(np.asarray(some, np.int64).reshape(-1, width), known)
            if len(groups) > 1:  # version 2 has an element once for each of its groups
                rows = _once(rows)
            block = len(found.blocks)
            found.blocks.append((kind, rows[:, _TO_VTK.get(kind, slice(None))]))
            for group in groups:
                found.cell_sets.setdefault(_label(dim, group), {})[block] = np.arange(len(rows))
    return found


def _label(dim: int, group: int) -> str:
    """Name of a physical group; its number where it has none, or none in UTF-8."""
    try:
        return gmsh.model.getPhysicalName(dim, group).strip() or str(group)
    except UnicodeDecodeError:
        return str(group)


def _rows(nodes: Any, known: Any) -> Any:
    """Rows of nodes by their tags; one more than there are, where there is none."""
    at = np.minimum(np.searchsorted(known, nodes), max(len(known) - 1, 0))
    return np.where(known[at] == nodes, at, len(known)) if len(known) else nodes


def _once(rows: Any) -> Any:
    """Elements without those that have the nodes of another, in the order of the file."""
    _, first = np.unique(rows, axis=0, return_index=True)
    return rows[np.sort(first)]
