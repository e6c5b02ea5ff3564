"""Meshes from the cache: the same parts and sizes are meshed once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache as once
from typing import Any

import gmsh
import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.cache import Cache, user_cache
from fe_drivetrain.common.provenance import machine, source_hash
from fe_drivetrain.elasticity.mesh.generation import generate
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.geometry import NO_BANDS, Band, Bearing, Housing, MeshSizes, Shaft

Arrays = dict[str, NDArray[Any]]

_MESHERS = {"facets.py", "generation.py", "measures.py", "mesh.py"}  # what decides on a mesh


def cached_mesh(
    shaft: Shaft | None,
    bearings: Sequence[Bearing],
    housings: Mapping[str, Housing],
    sizes: MeshSizes,
    bonded: frozenset[str],
    cache: Cache | None = None,
    bands: Mapping[str, Band] = NO_BANDS,
) -> Mesh:
    """Mesh of these parts, taken from the cache where it was generated before.

    Parameters
    ----------
    shaft, bearings, housings, sizes, bonded, bands : see `mesh.generation.generate`
        Arguments of `fe_drivetrain.elasticity.mesh.generation.generate`.
    cache : Cache or None
        Cache of meshes; the user's if not given.

    Returns
    -------
    Mesh
        Mesh, the same to the last bit, with the same layout in memory, whether kept or generated
        now; its ``kept`` says which.

    Raises
    ------
    InputError
        The parts do not fit together, or an element stays inverted.
    """
    used = user_cache() if cache is None else cache
    content = mesh_content(shaft, bearings, housings, sizes, bonded, bands)
    arrays = used.load("meshes", content)
    if arrays is not None:
        try:
            return replace(_from_arrays(arrays), kept=True)
        except (KeyError, IndexError, ValueError):
            pass  # not as it was written: generated again below
    arrays = _to_arrays(generate(shaft, bearings, housings, sizes, bonded, bands=bands))
    used.keep("meshes", content, arrays)
    return _from_arrays(arrays)


def mesh_content(
    shaft: Shaft | None,
    bearings: Sequence[Bearing],
    housings: Mapping[str, Housing],
    sizes: MeshSizes,
    bonded: frozenset[str],
    bands: Mapping[str, Band],
) -> dict[str, Any]:
    """All that a mesh depends on; the material is not among it."""
    return {
        "shaft": None if shaft is None else shaft.model_dump(mode="json", exclude={"material"}),
        "bearings": [b.model_dump(mode="json", exclude={"material"}) for b in bearings],
        "housings": {
            name: housing.model_dump(mode="json", exclude={"material"})
            for name, housing in housings.items()
        },
        "sizes": sizes.model_dump(mode="json"),
        "bonded": sorted(bonded),
        "bands": {name: list(span) for name, span in bands.items()},
        "made by": _made_by(),
    }


@once
def _made_by() -> dict[str, str]:
    """The programs that make a mesh: another version may make another mesh."""
    return {
        "gmsh": gmsh.__version__,
        "numpy": np.__version__,
        "machine": machine(),
        "code": source_hash(
            {"fe_drivetrain.geometry": None, "fe_drivetrain.elasticity.mesh": _MESHERS}
        ),
    }


def _to_arrays(mesh: Mesh) -> Arrays:
    """A mesh as plain arrays."""
    arrays = {
        "points": mesh.points,
        "cells": mesh.cells,
        "part": mesh.part,
        "part_names": np.array(mesh.part_names, dtype=np.str_),
        "face_names": np.array(list(mesh.faces), dtype=np.str_),
        "point_names": np.array(list(mesh.named_points), dtype=np.str_),
        "named_points": np.array(list(mesh.named_points.values()), dtype=np.int64),
    }
    arrays |= {f"face {k}": face for k, face in enumerate(mesh.faces.values())}
    # How arrays lie in memory can decide the last digits of what follows, so as a file keeps them.
    return {name: np.ascontiguousarray(array) for name, array in arrays.items()}


def _from_arrays(arrays: Arrays) -> Mesh:
    names = [str(name) for name in arrays["face_names"]]
    return Mesh(
        arrays["points"],
        arrays["cells"],
        arrays["part"],
        tuple(str(name) for name in arrays["part_names"]),
        {name: arrays[f"face {k}"] for k, name in enumerate(names)},
        {
            str(name): int(node)
            for name, node in zip(arrays["point_names"], arrays["named_points"], strict=True)
        },
    )
