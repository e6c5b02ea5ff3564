"""A housing from a STEP or mesh file as a mesh in its place, with its seat and held faces named."""

from __future__ import annotations

import hashlib
import json
import math
import warnings
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.cache import Cache, user_cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.made_by import machine, source_hash
from fe_drivetrain.foreign.picking import Surface
from fe_drivetrain.foreign.reading import read_in_process
from fe_drivetrain.geometry import Bearing, ForeignHousing, MeshSizes, Pick
from fe_drivetrain.geometry.foreign_housing import SEAT_TOLERANCE
from fe_drivetrain.mesh.checks import refuse_unsound
from fe_drivetrain.mesh.facets import facet_points
from fe_drivetrain.mesh.generation import ATTEMPTS, GMSH_TO_VTK, REFINEMENT, relax_flat_cells
from fe_drivetrain.mesh.linear import renumbered
from fe_drivetrain.mesh.measures import inverted_cells, volume
from fe_drivetrain.mesh.mesh import Mesh, boundary

_STEP_UNIT = 1e-3  # what gmsh reads STEP in [m]
_VOLUME = 0.02  # a mesh that differs more from its solid has lost a part of it
_COVERED = 0.98  # share of a bearing's outer face that facets of a seat must have


class PlacedHousing(NamedTuple):
    """A housing from a file, meshed and in its place.

    Attributes
    ----------
    mesh : Mesh
        One part, "NAME.housing", with the faces "bore" under the bearing, "seat" all over the
        seat, "base" where it is held, and "head 1", "foot 1" ... at both ends of bolts as beams.
    facts : Mapping[str, Any]
        What was found in the file: volumes before and after healing [m^3], solids, faces removed.
    """

    mesh: Mesh
    facts: Mapping[str, Any]


@lru_cache(maxsize=256)
def _digest(path: str, modified: int, size: int) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def file_digest(path: str) -> str:
    """SHA-256 of a file; "" where there is none.

    Parameters
    ----------
    path : str
        The file.
    """
    try:
        found = Path(path).stat()
        return _digest(str(path), found.st_mtime_ns, found.st_size)
    except OSError:
        return ""


def placed_housing(
    housing: ForeignHousing, bearing: Bearing, sizes: MeshSizes, cache: Cache | None = None
) -> PlacedHousing:
    """Read a housing's file, mesh it where it is no mesh, and put it round its bearing.

    Parameters
    ----------
    housing : ForeignHousing
        The housing.
    bearing : Bearing
        Its bearing.
    sizes : MeshSizes
        Of the scene; "housing" and "elements_per_turn" are used of a STEP file.
    cache : Cache or None
        Where the mesh may come from; the user's if not given.

    Returns
    -------
    PlacedHousing
        In the scene's frame, in m.

    Raises
    ------
    InputError
        The file cannot be read or meshed, a face is not found, or the seat is not the bearing's.

    Warns
    -----
    UserWarning
        Healing has removed small details.
    """
    housing.check_bearing(bearing)
    used = user_cache() if cache is None else cache
    shape = housing.model_dump(mode="json", exclude={"material", "step", "mesh"})
    content = {
        "file": file_digest(housing.file),
        "housing": shape,
        "bearing": bearing.model_dump(mode="json", exclude={"material", "bore_diameter"}),
        "sizes": sizes.model_dump(mode="json") if housing.step else None,
        "made by": _made_by(),
    }
    arrays = used.load("meshes", content) if content["file"] else None
    if arrays is None:
        arrays = _of_step(housing, bearing, sizes) if housing.step else _of_mesh(housing, bearing)
        arrays = {name: np.ascontiguousarray(array) for name, array in arrays.items()}
        used.keep("meshes", content, arrays)
    facts = json.loads(str(arrays["facts"].ravel()[0]))
    if facts["faces removed"] or facts["edges removed"]:
        warnings.warn(
            f"{Path(housing.file).name}: healing has removed {facts['faces removed']} faces and "
            f"{facts['edges removed']} edges, and changed the volume from "
            f"{facts['volume before healing [m^3]']:.9g} to "
            f"{facts['volume after healing [m^3]']:.9g} m^3",
            stacklevel=2,
        )
    part = f"{bearing.name}.housing"
    faces = {
        f"{part}.{key.removeprefix('face ')}": value
        for key, value in arrays.items()
        if key.startswith("face ")
    }
    cells = arrays["cells"]
    mesh = Mesh(arrays["points"], cells, np.zeros(len(cells), dtype=np.int64), (part,), faces, {})
    return PlacedHousing(mesh, facts)


def _made_by() -> dict[str, str]:
    import gmsh
    import meshio

    code = source_hash({"fe_drivetrain.geometry": None, "fe_drivetrain.foreign": None})
    versions = {"gmsh": gmsh.__version__, "meshio": meshio.__version__, "numpy": np.__version__}
    return versions | {"machine": machine(), "code": code}


def pick_data(pick: Pick) -> dict[str, Any]:
    """A pick as plain data, without what is not given."""
    return pick.model_dump(mode="json", exclude_none=True)


def _of_step(
    housing: ForeignHousing, bearing: Bearing, sizes: MeshSizes
) -> dict[str, NDArray[Any]]:
    scale, turned = housing.scale / 1e-3 * _STEP_UNIT, housing.rotation
    centre = np.array([bearing.x, 0.0, 0.0])
    moved = housing.translate
    request = {
        "smallest_detail": housing.smallest_detail,
        "seat": pick_data(housing.seat),
        "held": [pick_data(pick) for pick in housing.held],
        "bolts": housing.bolts.model_dump(mode="json") if housing.bolts else None,
        "kind": "Sphere" if bearing.kind == "spherical" else "Cylinder",
        "radius": bearing.raceway_diameter / 2 / scale,
        "tolerance": SEAT_TOLERANCE,
        "along": turned.T[:, 0].tolist(),
        "low": -bearing.width / 2 / scale,
        "high": bearing.width / 2 / scale,
        "centre": None if moved is None else (turned.T @ (centre - moved) / scale).tolist(),
        "size": sizes.housing / scale,
        "per_turn": sizes.elements_per_turn,
        "optimise": False,
    }
    for _ in range(ATTEMPTS):
        found = read_in_process("mesh step", housing.file, request)
        mesh, survey = _placed_mesh(found, housing, centre, scale)
        if len(inverted_cells(mesh)) == 0:
            break
        if request["optimise"]:  # in vain: finer, as `fe_drivetrain.mesh.generation.generate`
            request["size"] /= REFINEMENT
            request["per_turn"] = math.ceil(request["per_turn"] * REFINEMENT)
        request["optimise"] = True
    before, after = (survey[key]["volume"] * scale**3 for key in ("before", "after"))
    meshed = volume(mesh)
    if abs(meshed / after - 1) > _VOLUME:
        raise InputError(
            f"{survey['name']}: its mesh has {meshed:.6g} m^3, but the solid {after:.6g} m^3: "
            "repair its faces in the CAD program, or choose smaller elements"
        )
    facts = {
        "volume before healing [m^3]": before,
        "volume after healing [m^3]": after,
        "solids": survey["after"]["solids"],
        "faces removed": survey["before"]["faces"] - survey["after"]["faces"],
        "edges removed": survey["before"]["edges"] - survey["after"]["edges"],
        "bolt holes": len(survey["seat"]["holes"]),
    }
    return _arrays(survey["name"], mesh, facts)


def _placed_mesh(
    found: Mapping[str, NDArray[Any]], housing: ForeignHousing, centre: Floats, scale: float
) -> tuple[Mesh, dict[str, Any]]:
    """The mesh of a STEP file's solid in its place, and what is known of the solid."""
    survey: dict[str, Any] = json.loads(str(found["survey"]))
    turned, moved = housing.rotation, housing.translate
    seat = survey["seat"]
    middle = np.array(seat["centre"])
    shift = centre - scale * (turned @ middle) if moved is None else np.array(moved)

    def placed(points: Floats) -> Floats:
        return np.asarray(scale * (points @ turned.T) + shift, dtype=np.float64)

    cells = found["cells"][:, GMSH_TO_VTK]
    renewed = renumbered(placed(found["points"]), cells)
    numbers = renewed.number
    part = "body"
    mesh = Mesh(
        renewed.points,
        renewed.cells,
        np.zeros(len(cells), dtype=np.int64),
        (part,),
        {key: numbers[value] for key, value in found.items() if key.startswith("body.")},
        {},
    )
    return relax_flat_cells(_turned_outward(mesh)), survey


def _of_mesh(housing: ForeignHousing, bearing: Bearing) -> dict[str, NDArray[Any]]:
    name = Path(housing.file).name
    found = read_in_process("read mesh", housing.file, {})
    cells = found["cells"]
    solids = sorted(k.removeprefix("solid ") for k in found if k.startswith("solid "))
    if housing.part is not None:
        if housing.part not in solids:
            raise InputError(
                f"{name}: there is no solid {housing.part!r}: use one of "
                f"{', '.join(solids[:30]) or 'none'}, or leave part out"
            )
        cells = cells[np.sort(found[f"solid {housing.part}"])]
    scale, turned = housing.scale, housing.rotation
    renewed = renumbered(found["points"], cells)
    points, cells = renewed.points, renewed.cells
    corners = points[cells[:, :4]]
    signed = np.linalg.det(corners[:, 1:] - corners[:, :1])
    wrong = np.flatnonzero(signed <= 0)
    if len(wrong):
        at = corners[wrong[0]].mean(axis=0)
        raise InputError(
            f"{name}: {len(wrong)} of its {len(cells)} elements are inside out or flat, the first "
            f"near ({at[0]:.4g}, {at[1]:.4g}, {at[2]:.4g}) {housing.unit}: correct the order of "
            "their nodes, or mesh the part again"
        )
    body = Mesh(points, cells, np.zeros(len(cells), dtype=np.int64), ("body",), {}, {})
    numbered = {
        key: renewed.number[value]
        for key, value in found.items()
        if key.startswith(("face ", "nodes "))
    }
    surface = Surface(name, points, boundary(body), numbered)
    seat = surface.picked(housing.seat, "seat")
    held = np.unique(np.concatenate([surface.picked(p, "held face") for p in housing.held]))
    if len(np.intersect1d(seat, held)):
        raise InputError(f"{name}: a face of the seat is held, too: hold another face")
    n_holes = 0
    if housing.bolts is not None:
        if housing.bolts.hold == "beams":
            raise InputError(
                f"{name}: bolts as beams need the holes of a STEP file: hold 'washers', or give "
                "the part as STEP"
            )
        held, n_holes = _under_washers(surface, held, housing)
    nodes = np.unique(surface.facets[seat])
    middle = _middle_of_seat(points[nodes], bearing, turned, scale)
    centre = np.array([bearing.x, 0.0, 0.0])
    shift = (
        centre - scale * (turned @ middle)
        if housing.translate is None
        else np.array(housing.translate)
    )
    placed = np.asarray(scale * (points @ turned.T) + shift)
    _check_placed_seat(name, placed[nodes], bearing)
    facets = surface.facets
    x = placed[facets[seat][:, :3], 0]
    low, high = bearing.span
    under = seat[(x.mean(axis=1) > low) & (x.mean(axis=1) < high)]
    covered = _area(placed, facets[under]) if len(under) else 0.0
    whole = _outer_area(bearing)
    if covered < _COVERED * whole:
        raise InputError(
            f"{name}: the facets of its seat cover {100 * covered / whole:.3g} % of the bearing's "
            "outer face, but must cover all of it: move the part, pick all of the seat, or make "
            "the bearing narrower"
        )
    mesh = Mesh(
        placed,
        cells,
        body.part,
        ("body",),
        {"body.bore": facets[under], "body.seat": facets[seat], "body.base": facets[held]},
        {},
    )
    facts = {
        "volume before healing [m^3]": volume(mesh),
        "volume after healing [m^3]": volume(mesh),
        "solids": 1,
        "faces removed": 0,
        "edges removed": 0,
        "bolt holes": n_holes,
    }
    return _arrays(name, mesh, facts)


def _arrays(name: str, mesh: Mesh, facts: Mapping[str, Any]) -> dict[str, NDArray[Any]]:
    try:
        refuse_unsound(mesh)
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


def _area(points: Floats, facets: Ints) -> float:
    return float(facet_points(points, facets).areas.sum())


def _outer_area(bearing: Bearing) -> float:
    """Of a bearing's outer face: 2 pi r h holds of a cylinder, and of a zone of a sphere."""
    return math.pi * bearing.raceway_diameter * bearing.width


def _middle_of_seat(points: Floats, bearing: Bearing, turned: Floats, scale: float) -> Floats:
    """Of a seat of a mesh, in the file's frame and unit, from its nodes' extents."""
    own = points @ turned.T
    middle = (own.min(axis=0) + own.max(axis=0)) / 2
    # fitted to all nodes: on circles or spheres, |p|^2 = 2 p.c + k
    axes = [1, 2] if bearing.kind == "ring" else [0, 1, 2]
    around = own[:, axes] - middle[axes]
    A = np.column_stack([2 * around, np.ones(len(own))])
    fitted = np.linalg.lstsq(A, (around**2).sum(axis=1), rcond=None)[0]
    middle[axes] += fitted[:-1]
    return np.asarray(turned.T @ middle, dtype=np.float64)


def _check_placed_seat(name: str, points: Floats, bearing: Bearing) -> None:
    """Refuse a seat whose nodes are not on the bearing's raceway."""
    away = points - [bearing.x, 0.0, 0.0]
    if bearing.kind == "ring":
        away = away[:, 1:]
    radius = bearing.raceway_diameter / 2
    found = np.linalg.norm(away, axis=1)
    if np.abs(found - radius).max() > 20 * SEAT_TOLERANCE * radius:
        shape = "sphere" if bearing.kind == "spherical" else "cylinder about the x axis"
        raise InputError(
            f"{name}: nodes of its seat are {found.min():.6g} to {found.max():.6g} m from the "
            f"bearing's centre, but must be on its raceway, a {shape} of radius {radius:.6g} m: "
            "correct unit, 'rotate', 'translate' or the pick of the seat"
        )


def _under_washers(surface: Surface, held: Ints, housing: ForeignHousing) -> tuple[Ints, int]:
    """The held facets whose middle is under a washer, and the number of holes."""
    bolts = housing.bolts
    assert bolts is not None
    holes = surface.circles(held, bolts.hole_radius)
    if not len(holes):
        raise InputError(
            f"{surface.name}: the held faces have no round hole of radius {bolts.hole_radius:g} "
            f"{housing.unit}: check hole_radius, or hold the face that the bolts go through"
        )
    away = np.linalg.norm(surface.middles[held][:, None] - holes, axis=2).min(axis=1)
    under = held[away < bolts.washer_diameter / 2]
    ring = math.pi * (bolts.washer_diameter**2 / 4 - bolts.hole_radius**2) * len(holes)
    found = _area(surface.points, surface.facets[under]) if len(under) else 0.0
    if abs(found / ring - 1) > 0.2:
        raise InputError(
            f"{surface.name}: facets under the washers have {found:.4g}, but the washers "
            f"{ring:.4g} {housing.unit}^2: mesh the washers' outlines on the foot, or give the "
            "part as STEP"
        )
    return under, len(holes)
