"""Two meshes as one, of solids that do not touch."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fe_drivetrain.elasticity.mesh.mesh import Mesh


def renamed(mesh: Mesh, part: str, name: str) -> Mesh:
    """A mesh with another name for one of its parts, and for the faces and points of that.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    part, name : str
        Name of the part, and its new name.
    """

    def new(old: str) -> str:
        own = old == part or old.startswith(f"{part}.")
        return name + old.removeprefix(part) if own else old

    return replace(
        mesh,
        part_names=tuple(new(old) for old in mesh.part_names),
        faces={new(old): face for old, face in mesh.faces.items()},
        named_points={new(old): node for old, node in mesh.named_points.items()},
    )


def beside(first: Mesh, second: Mesh) -> Mesh:
    """Two meshes as one; they share no nodes, and no names.

    Parameters
    ----------
    first, second : Mesh
        The nodes, cells and parts of the first keep their numbers.
    """
    n = len(first.points)
    return Mesh(
        np.vstack([first.points, second.points]),
        np.vstack([first.cells, second.cells + n]),
        np.concatenate([first.part, second.part + len(first.part_names)]),
        (*first.part_names, *second.part_names),
        first.faces | {name: face + n for name, face in second.faces.items()},
        first.named_points | {name: node + n for name, node in second.named_points.items()},
        first.kept and second.kept,
    )
