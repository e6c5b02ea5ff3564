"""A part from a file: its mesh by the file's content, of STEP solids or of a mesh of others."""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache, user_cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.provenance import file_digest
from fe_drivetrain.elasticity.mesh.checks import refuse_unsound
from fe_drivetrain.elasticity.mesh.generation import (
    ATTEMPTS,
    GMSH_TO_VTK,
    REFINEMENT,
    relax_flat_cells,
)
from fe_drivetrain.elasticity.mesh.linear import renumbered
from fe_drivetrain.elasticity.mesh.measures import inverted_cells, volume
from fe_drivetrain.elasticity.mesh.mesh import Mesh, boundary
from fe_drivetrain.foreign.bolted import MAX_BETWEEN_RIMS, SIDES, joined_between_rims, opened
from fe_drivetrain.foreign.known_healing import read_step, reader_versions
from fe_drivetrain.foreign.picking import Surface
from fe_drivetrain.foreign.reading import read_in_process
from fe_drivetrain.foreign.unfolding import unfolded
from fe_drivetrain.geometry import ForeignFile, Pick

_VOLUME = 0.02  # a mesh that differs more from its solid has lost a part of it


class PlacedPart(NamedTuple):
    """A part from a file, meshed and in its place.

    Attributes
    ----------
    mesh : Mesh
        Mesh of this one part, with its named faces.
    facts : Mapping[str, Any]
        Facts found in the file: volumes before and after healing [m^3], solids, faces removed.
    """

    mesh: Mesh
    facts: Mapping[str, Any]


def kept_part(
    source: ForeignFile,
    part: str,
    content: Mapping[str, Any],
    make: Callable[[], dict[str, NDArray[Any]]],
    cache: Cache | None,
) -> PlacedPart:
    """A part from a file as it was meshed before, or is now; removed details are warned of.

    Parameters
    ----------
    source : ForeignFile
        The part.
    part : str
        Name of the part in the mesh.
    content : Mapping[str, Any]
        Values that its mesh depends on beside the file.
    make : callable
        Function that makes the arrays, see `named_arrays`.
    cache : Cache or None
        Cache that the mesh may come from; the user's if not given.

    Returns
    -------
    PlacedPart
        Part in the frame of its arrays.
    """
    used = user_cache() if cache is None else cache
    whole = {
        **content,
        "file": file_digest(source.file),
        "housing": source.model_dump(mode="json", exclude={"material", "step", "mesh"}),
        "made by": reader_versions(),
    }
    arrays = used.load("meshes", whole) if whole["file"] else None
    if arrays is None:
        arrays = {name: np.ascontiguousarray(array) for name, array in make().items()}
        used.keep("meshes", whole, arrays)
    facts: dict[str, Any] = json.loads(str(arrays["facts"].ravel()[0]))
    if facts["faces removed"] or facts["edges removed"]:
        warnings.warn(
            f"{Path(source.file).name}: healing has removed {facts['faces removed']} faces and "
            f"{facts['edges removed']} edges, and changed the volume from "
            f"{facts['volume before healing [m^3]']:.9g} to "
            f"{facts['volume after healing [m^3]']:.9g} m^3",
            stacklevel=3,
        )
    if (share := facts.get("joined between rims", 0.0)) > MAX_BETWEEN_RIMS:
        warnings.warn(
            f"{Path(source.file).name}: {100 * share:.2g} % of the joint beside its bolts stays "
            "joined, where elements reach from one bolt's pressed face to the next: choose smaller "
            "elements for the housing, or more of them on a turn",
            stacklevel=3,
        )
    faces = {
        f"{part}.{key.removeprefix('face ')}": value
        for key, value in arrays.items()
        if key.startswith("face ")
    }
    cells = arrays["cells"]
    mesh = Mesh(arrays["points"], cells, np.zeros(len(cells), dtype=np.int64), (part,), faces, {})
    return PlacedPart(mesh, facts)


def pick_data(pick: Pick) -> dict[str, Any]:
    """A pick as plain data, without what is not given."""
    return pick.model_dump(mode="json", exclude_none=True)


def meshed_step(
    action: str,
    source: ForeignFile,
    request: dict[str, Any],
    shift: Callable[[Mapping[str, Any]], Floats],
) -> tuple[Mesh, dict[str, Any]]:
    """Mesh the solids of a STEP file, finer where elements fold over, and put them in their place.

    Parameters
    ----------
    action : str
        Action of the process that meshes them, see `read_in_process`.
    source : ForeignFile
        File of the part.
    request : dict
        Values that the action needs; "size" and "per_turn" are those of the first attempt.
    shift : callable
        Function from the survey of the solids to the distance that they are moved by [m].

    Returns
    -------
    Mesh
        Mesh of one part, "body", and its faces.
    dict
        Survey of the solids.
    """
    for _ in range(ATTEMPTS):
        found = read_step(action, source.file, request)
        survey: dict[str, Any] = json.loads(str(found["survey"]))
        mesh = _placed_mesh(found, source, shift(survey), survey)
        folded = inverted_cells(mesh)
        if len(folded):
            mesh = unfolded(mesh)
            folded = inverted_cells(mesh)
        if len(folded) == 0:
            break
        if request[
            "optimise"
        ]:  # in vain: finer, as `fe_drivetrain.elasticity.mesh.generation.generate`
            request["size"] /= REFINEMENT
            request["per_turn"] = math.ceil(request["per_turn"] * REFINEMENT)
        request["optimise"] = True
    solid, meshed = survey["after"]["volume"] * source.scale**3, volume(mesh)
    if survey["splines"]:  # of which OpenCASCADE's integrals are inexact, by the same of both
        for when in ("before", "after"):
            survey[when]["volume"] *= meshed / solid
    if abs(meshed / solid - 1) > _VOLUME:
        raise InputError(
            f"{survey['name']}: its mesh has {meshed:.6g} m^3, but the solid {solid:.6g} m^3: "
            "repair its faces in the CAD program, or choose smaller elements"
        )
    return mesh, survey


def step_facts(survey: Mapping[str, Any], scale: float) -> dict[str, Any]:
    """Facts found in a STEP file.

    Parameters
    ----------
    survey : Mapping
        Survey from `fe_drivetrain.foreign.step_solid.opened`.
    scale : float
        Length of the file's unit [m].
    """
    before, after = survey["before"], survey["after"]
    return {
        "volume before healing [m^3]": before["volume"] * scale**3,
        "volume after healing [m^3]": after["volume"] * scale**3,
        "solids": after["solids"],
        "faces removed": before["faces"] - after["faces"],
        "edges removed": before["edges"] - after["edges"],
        "healing": survey["healing"],
        "joined between rims": survey.get("joined between rims", 0.0),
    }


def _placed_mesh(
    found: Mapping[str, NDArray[Any]], source: ForeignFile, shift: Floats, survey: dict[str, Any]
) -> Mesh:
    """The mesh of a STEP file's solids in its place; of a bolted joint the survey says more."""
    cells = found["cells"][:, GMSH_TO_VTK]
    placed = source.scale * (found["points"] @ source.rotation.T) + shift
    renewed = renumbered(placed, cells)
    numbers = renewed.number
    faces = {key: numbers[value] for key, value in found.items() if key.startswith("body.")}
    pressed, open_ = (faces.pop(f"body.{key}", None) for key in ("pressed", "open"))
    part = np.zeros(len(cells), dtype=np.int64)
    mesh = Mesh(renewed.points, renewed.cells, part, ("body",), faces, {})
    if pressed is not None and open_ is not None:
        survey["joined between rims"] = joined_between_rims(mesh, open_, pressed)
        mesh = opened(mesh, open_, pressed)
    return relax_flat_cells(_turned_outward(mesh))


def body_of_mesh(source: ForeignFile) -> tuple[Mesh, Surface]:
    """Read a mesh file's solid, as the file has it, and its outside to pick faces from.

    Parameters
    ----------
    source : ForeignFile
        The part.

    Returns
    -------
    Mesh
        One part, "body", without faces, in the file's frame and unit.
    Surface
        Outside of the mesh.

    Raises
    ------
    InputError
        The file cannot be read, has no such solid, or elements inside out.
    """
    name = Path(source.file).name
    found = read_in_process("read mesh", source.file, {})
    cells = found["cells"]
    solids = sorted(k.removeprefix("solid ") for k in found if k.startswith("solid "))
    if source.part is not None:
        if source.part not in solids:
            raise InputError(
                f"{name}: there is no solid {source.part!r}: use one of "
                f"{', '.join(solids[:30]) or 'none'}, or leave part out"
            )
        cells = cells[np.sort(found[f"solid {source.part}"])]
    renewed = renumbered(found["points"], cells)
    points, cells = renewed.points, renewed.cells
    corners = points[cells[:, :4]]
    signed = np.linalg.det(corners[:, 1:] - corners[:, :1])
    wrong = np.flatnonzero(signed <= 0)
    if len(wrong):
        at = corners[wrong[0]].mean(axis=0)
        raise InputError(
            f"{name}: {len(wrong)} of its {len(cells)} elements are inside out or flat, the first "
            f"near ({at[0]:.4g}, {at[1]:.4g}, {at[2]:.4g}) {source.unit}: correct the order of "
            "their nodes, or mesh the part again"
        )
    body = Mesh(points, cells, np.zeros(len(cells), dtype=np.int64), ("body",), {}, {})
    numbered = {
        key: renewed.number[value]
        for key, value in found.items()
        if key.startswith(("face ", "nodes ", "empty "))
    }
    return body, Surface(name, points, boundary(body), numbered)


def mesh_facts(mesh: Mesh) -> dict[str, Any]:
    """Facts of a part from a mesh file, in the form of those from STEP.

    Parameters
    ----------
    mesh : Mesh
        Mesh in its place.
    """
    size = volume(mesh)
    return {
        "volume before healing [m^3]": size,
        "volume after healing [m^3]": size,
        "solids": 1,
        "faces removed": 0,
        "edges removed": 0,
        "healing": "",
    }


def named_arrays(name: str, mesh: Mesh, facts: Mapping[str, Any]) -> dict[str, NDArray[Any]]:
    """A mesh without faults and its facts, as arrays to be kept.

    Parameters
    ----------
    name : str
        Name of the file, for messages.
    mesh : Mesh
        Mesh of one part, "body".
    facts : Mapping[str, Any]
        Facts as plain data.

    Raises
    ------
    InputError
        The mesh has a fault.
    """
    try:
        refuse_unsound(mesh, joints=[(f"body.{SIDES[0]}", f"body.{SIDES[1]}")])
    except InputError as error:
        raise InputError(f"{name}: {error}") from None
    return {
        "points": mesh.points,
        "cells": mesh.cells,
        "facts": np.array(json.dumps(facts)),
        **{f"face {key.removeprefix('body.')}": face for key, face in mesh.faces.items()},
    }


def _turned_outward(mesh: Mesh) -> Mesh:
    """The mesh with its faces as facets of its cells, turned outward."""
    outside = boundary(mesh)
    corners = np.sort(outside[:, :3], axis=1)
    n = len(mesh.points)
    keys = (corners[:, 0] * n + corners[:, 1]) * n + corners[:, 2]
    order = np.argsort(keys)
    faces = {}
    for name, face in mesh.faces.items():
        mine = np.sort(face[:, :3], axis=1)
        wanted = (mine[:, 0] * n + mine[:, 1]) * n + mine[:, 2]
        at = np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)
        if (keys[order][at] != wanted).any():
            raise RuntimeError(f"face {name} has a triangle that is not on the outside")
        faces[name] = outside[order[at]]
    return replace(mesh, faces=faces)
