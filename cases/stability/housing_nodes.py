"""Rotations of a housing from the displacements of four of its points, chosen at will."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Scene, change_scene, library_scene
from fe_drivetrain.elasticity.mesh import element_kind, shape_functions
from fe_drivetrain.shafts.response import (
    PLANES,
    Model,
    Plane,
    Response,
    bearing_unit_stiffness,
    build_model,
    cached_response,
    mesh_scene,
    tilt_stiffness,
    without_gearbox,
)

BEARING = "main_bearing"

#: The library's main bearing, made short and coarse, so that one solution is cheap.
SHORT = {
    "mesh.shaft": 0.3,
    "mesh.bearing": 0.1,
    "mesh.housing": 0.1,
    "mesh.bearing_edge": 0.1,
    "shaft.front": -1.0,
    "shaft.sections.0.length": 2.2,
}

_CANDIDATES = 16  # cells about a place, by their centres
_STEPS = 8


@dataclass(frozen=True)
class Tilted:
    """The main bearing without gearbox, and its response to unit loads.

    Attributes
    ----------
    model, response : Model, Response
        As a user gets them.
    by_plane : dict[str, dict[str, float]]
        K_R by plane and estimator of `bearing_stiffness.tilt_stiffness` [N m/rad].
    condensed : dict[str, float]
        K_R by plane from the motion of the unloaded shaft behind the bearing [N m/rad].
    """

    model: Model
    response: Response
    by_plane: dict[str, dict[str, float]]
    condensed: dict[str, float]


def tilted(factor: float) -> Tilted:
    """Solve the scene with its mesh sizes times a factor."""
    scene: Scene = change_scene(library_scene("main_bearing_bonded"), SHORT)
    scene = without_gearbox(scene.model_copy(update={"mesh": scene.mesh.scaled(factor)}))
    model = build_model(scene, mesh_scene(scene))
    response = cached_response(model)
    compliance = np.linalg.inv(bearing_unit_stiffness(response, BEARING))
    return Tilted(
        model,
        response,
        {plane.name: tilt_stiffness(model, response, BEARING, plane) for plane in PLANES},
        {plane.name: float(1.0 / compliance[plane.moment, plane.moment]) for plane in PLANES},
    )


def radii(found: Tilted) -> dict[str, float]:
    """Radii about the shaft [m]: the seat, the housing's bore, the outside of its shell."""
    scene = found.model.scene
    unit = scene.bearing_units[0]
    bore = unit.bearing.raceway_diameter / 2.0
    return {
        "seat": scene.shaft.sections[0].outer_diameter / 2.0,
        "bore": bore,
        "outside": bore + unit.block.wall,
    }


def four_places(radius: float, angle: float, x: float) -> Floats:
    """Four places (4, 3) on a circle about the shaft, a quarter turn apart.

    Parameters
    ----------
    radius, x : float
        Of the circle and along the shaft from the bearing's centre [m].
    angle : float
        Of the first place from the top [rad].
    """
    turns = angle + 0.5 * np.pi * np.arange(4)
    return np.column_stack([np.full(4, x), radius * np.sin(turns), radius * np.cos(turns)])


def four_node_rotation(displacements: Floats, radius: float, angle: float) -> Floats:
    """Rotations about y and z, (2, m) [rad] of four places from their displacements (4, m) along x.

    The two lines between opposite places give the slope of u_x along each, and u_x of a rotation
    is theta_y z - theta_z y.
    """
    first = (displacements[0] - displacements[2]) / (2.0 * radius)
    second = (displacements[1] - displacements[3]) / (2.0 * radius)
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * first - s * second, -(s * first + c * second)])


def along_x(found: Tilted) -> Callable[[Floats], Floats]:
    """What interpolates u_x (n, 10) of all unit loads at places (n, 3) of bearing and housing."""
    mesh = found.model.mesh
    parts = [mesh.part_cells(part) for part in (BEARING, f"{BEARING}.housing")]
    cells = mesh.cells[np.concatenate(parts)]
    tree = cKDTree(mesh.points[cells[:, :4]].mean(axis=1))
    u = found.response.displacements[:, 0]

    def at(places: Floats) -> Floats:
        near = tree.query(places, k=_CANDIDATES)[1]
        values = np.empty((len(places), cells.shape[1]))
        chosen = np.empty(len(places), dtype=np.int64)
        for row, (place, some) in enumerate(zip(places, near, strict=True)):
            which, values[row] = _within(mesh.points[cells[some]], place)
            chosen[row] = some[which]
        return np.asarray(np.einsum("nk,nkl->nl", values, u[cells[chosen]]))

    return at


def _within(nodes: Floats, place: Floats) -> tuple[int, Floats]:
    """Which cell (n, 10, 3) a place lies in, or least outside of, and its shape functions."""
    element = element_kind(10).element
    at = np.full((3, len(nodes)), 0.25)
    for _ in range(_STEPS):
        values, gradients = shape_functions(element, at)
        x = np.einsum("nk,nki->ni", values, nodes)
        J = np.einsum("njk,nki->nij", gradients, nodes)
        at = np.clip(at + np.linalg.solve(J, (place - x)[:, :, None])[:, :, 0].T, -2.0, 3.0)
    inside = np.minimum(at.min(axis=0), 1.0 - at.sum(axis=0))
    best = int(inside.argmax())
    return best, shape_functions(element, at[:, best : best + 1])[0][0]


def k_by_four_nodes(
    u_x: Callable[[Floats], Floats], radius: float, angle: float, x: float
) -> dict[str, float]:
    """K_R by plane [N m/rad] of unit hub moments, from four places on a circle about the shaft."""
    turned = four_node_rotation(u_x(four_places(radius, angle, x)), radius, angle)
    return {plane.name: float(1.0 / turned[row, plane.moment]) for row, plane in enumerate(PLANES)}


def thesis_rotation(found: Tilted, plane: Plane) -> Floats:
    """(10,) rotation of the line between the plane's two named nodes, of all unit loads [rad]."""
    mesh = found.model.mesh
    upper, lower = (mesh.named_points[f"{BEARING}.housing.{name}"] for name in plane.nodes)
    arm = float(np.linalg.norm(mesh.points[upper] - mesh.points[lower]))
    u = found.response.displacements[:, 0]
    return np.asarray((u[upper] - u[lower]) / arm)
