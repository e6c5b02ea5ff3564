"""A housing from a STEP or mesh file as a mesh in its place, with its seat and held faces named."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.facets import facet_points
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.foreign.from_file import (
    PlacedPart,
    body_of_mesh,
    kept_part,
    mesh_facts,
    meshed_step,
    named_arrays,
    pick_data,
    step_facts,
)
from fe_drivetrain.foreign.holes import washers
from fe_drivetrain.geometry import Bearing, ForeignHousing, MeshSizes
from fe_drivetrain.geometry.foreign_housing import SEAT_TOLERANCE

_STEP_UNIT = 1e-3  # what gmsh reads STEP in [m]
_COVERED = 0.98  # share of a bearing's outer face that facets of a seat must have


def placed_housing(
    housing: ForeignHousing, bearing: Bearing, sizes: MeshSizes, cache: Cache | None = None
) -> PlacedPart:
    """Read a housing's file, mesh it where it is no mesh, and put it round its bearing.

    Parameters
    ----------
    housing : ForeignHousing
        The housing.
    bearing : Bearing
        Bearing of the housing.
    sizes : MeshSizes
        Element sizes of the scene; "housing" and "elements_per_turn" are used for a STEP file.
    cache : Cache or None
        Cache that the mesh may come from; the user's if not given.

    Returns
    -------
    PlacedPart
        Part in the scene's frame, in m: "NAME.housing", with the faces "bore" under the bearing,
        "seat" all over the seat, "base" where it is held, "head 1", "foot 1" ... at both ends of
        bolts as beams, and "joint 1", "joint 2", both sides of a bolted joint where it is open.

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
    part = f"{bearing.name}.housing"
    content = {
        "bearing": bearing.model_dump(mode="json", exclude={"material", "bore_diameter"}),
        "sizes": sizes.model_dump(mode="json") if housing.step else None,
    }
    return kept_part(
        housing,
        part,
        content,
        lambda: _of_step(housing, bearing, sizes) if housing.step else _of_mesh(housing, bearing),
        cache,
    )


def _of_step(
    housing: ForeignHousing, bearing: Bearing, sizes: MeshSizes
) -> dict[str, NDArray[Any]]:
    scale, turned = housing.scale / 1e-3 * _STEP_UNIT, housing.rotation
    centre = np.array([bearing.x, 0.0, 0.0])
    moved = housing.translate
    request = {
        "part": housing.part,
        "smallest_detail": housing.smallest_detail,
        "seat": pick_data(housing.seat),
        "held": [pick_data(pick) for pick in housing.held],
        "bolts": housing.bolts.model_dump(mode="json") if housing.bolts else None,
        "bolted": housing.bolted.model_dump(mode="json") if housing.bolted else None,
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

    def shift(survey: Mapping[str, Any]) -> Floats:
        middle = np.array(survey["seat"]["centre"])
        return centre - scale * (turned @ middle) if moved is None else np.array(moved)

    mesh, survey = meshed_step("mesh step", housing, request, shift)
    facts = step_facts(survey, scale) | {"bolt holes": len(survey["seat"]["holes"])}
    return named_arrays(survey["name"], mesh, facts)


def _of_mesh(housing: ForeignHousing, bearing: Bearing) -> dict[str, NDArray[Any]]:
    body, surface = body_of_mesh(housing)
    name, points, cells = surface.name, body.points, body.cells
    scale, turned = housing.scale, housing.rotation
    seat = surface.picked(housing.seat, "seat")
    held = surface.picked_all(housing.held, "held face")
    if len(np.intersect1d(seat, held)):
        raise InputError(f"{name}: a face of the seat is held, too: hold another face")
    n_holes, heads = 0, dict[str, Ints]()
    if housing.bolts is not None:
        held, heads, n_holes = washers(surface, held, housing.bolts, housing.unit or "")
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
        {"body.bore": facets[under], "body.seat": facets[seat]}
        | ({"body.base": facets[held]} if len(held) else {})
        | {f"body.{key}": facets[some] for key, some in heads.items()},
        {},
    )
    return named_arrays(name, mesh, mesh_facts(mesh) | {"bolt holes": n_holes})


def _area(points: Floats, facets: Ints) -> float:
    return float(facet_points(points, facets).areas.sum())


def _outer_area(bearing: Bearing) -> float:
    """Area of a bearing's outer face: 2 pi r h holds of a cylinder, and of a zone of a sphere."""
    return math.pi * bearing.raceway_diameter * bearing.width


def _middle_of_seat(points: Floats, bearing: Bearing, turned: Floats, scale: float) -> Floats:
    """Middle of a seat of a mesh, in the file's frame and unit, from its nodes' extents."""
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
