"""What makes a solution, and what its mesh is, as plain data for the keys of caches."""

from __future__ import annotations

import hashlib
import json
from functools import cache as once
from typing import Any

from fe_drivetrain.common.provenance import arithmetic, source_hash, versions
from fe_drivetrain.elasticity.mesh.mesh import Mesh

_ROOMS = (
    "common",
    "geometry",
    "drivetrain_file",
    "elasticity.mesh",
    "elasticity.operator",
    "elasticity.interfaces",
    "foreign",
    "elasticity.solve",
    "shafts.response",
)
_PACKAGES = ("numpy", "scipy", "numba", "pyamg", "scikit-sparse", "pypardiso", "mkl", "gmsh")


def solved_by() -> dict[str, Any]:
    """The programs that make a solution, with all that decides on its last digits."""
    return _programs() | {"arithmetic": arithmetic()}


@once
def _programs() -> dict[str, Any]:
    return {
        "code": source_hash({f"fe_drivetrain.{room}": None for room in _ROOMS}),
        "packages": versions(_PACKAGES),
    }


def mesh_hash(mesh: Mesh) -> str:
    """SHA-256 of a mesh: nodes, cells, parts, faces and named points."""
    found = hashlib.sha256()
    names = [mesh.part_names, list(mesh.faces), mesh.named_points]
    found.update(json.dumps(names, ensure_ascii=True).encode())
    for array in (mesh.points, mesh.cells, mesh.part, *mesh.faces.values()):
        found.update(f"{array.dtype.str}{array.shape}".encode())
        found.update(array.tobytes())
    return found.hexdigest()
