"""Meshes as files for ParaView and gmsh."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import numpy.typing as npt

from fe_drivetrain.common.arrays import Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.elasticity.mesh.mesh import Mesh


def write(
    mesh: Mesh, path: str | os.PathLike[str], point_data: Mapping[str, npt.ArrayLike] | None = None
) -> None:
    """Write the mesh for ParaView (.vtu) or gmsh (.msh); the file appears whole or not at all.

    The .vtu holds the tetrahedra with their part as cell data; the .msh holds every part, face
    and point as a physical group of its name.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    path : str or path-like
        File to write, ending in .vtu or .msh.
    point_data : Mapping[str, npt.ArrayLike] or None
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
    import meshio  # with a command line of its own, which only what writes files waits for

    content = meshio.Mesh(
        mesh.points, blocks, point_data=data, cell_data=cell_data, field_data=field_data
    )
    with atomic_path(target) as unfinished:
        meshio.write(unfinished, content, **options)
