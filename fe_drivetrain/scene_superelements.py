"""Superelements of a scene: its free shaft, the drivetrain on its supports, its bearing units."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from importlib.metadata import version

import numpy as np

from fe_drivetrain.bearing_units import unit_stiffness
from fe_drivetrain.condensation import Condensed, keep_points
from fe_drivetrain.condensed_shafts import beam_shaft, meridian_shaft, solid_shaft
from fe_drivetrain.errors import InputError
from fe_drivetrain.levels import LevelModel
from fe_drivetrain.scene import Scene
from fe_drivetrain.superelement import Origin, Superelement


def shaft_superelement(scene: Scene, level: int, at: Sequence[str] | None = None) -> Superelement:
    """The free shaft of a scene, condensed.

    Parameters
    ----------
    scene
        The scene.
    level
        1 beam (without mass), 2 meridian, 3 solid with the rings of its bearings.
    at
        Points that are kept; all where not given.
    """
    condensers: dict[int, Callable[[Scene], Condensed]] = {
        1: beam_shaft,
        2: meridian_shaft,
        3: solid_shaft,
    }
    titles = {1: "Timoshenko beam", 2: "meridian in harmonics", 3: "solid shaft with rings"}
    if level not in condensers:
        raise InputError(f"level {level} has no free shaft: use one of 1, 2, 3")
    body = condensers[level](scene)
    body = body if at is None else keep_points(body, at)
    mesh = {
        1: "none",
        2: "quadrilaterals or triangles of high order in the meridian",
        3: f"curved tetrahedra of second order, {scene.mesh.shaft:g} m",
    }[level]
    return Superelement(
        "shaft",
        body.names,
        body.positions,
        body.stiffness,
        body.mass,
        origin=scene_origin(scene, f"{level} {titles[level]}", mesh),
    )


def supported_superelement(
    scene: Scene, model: LevelModel, at: Sequence[str], band: float | None = None
) -> Superelement:
    """The drivetrain on its supports, at points of a solved level of `fe_drivetrain.levels`.

    Raises
    ------
    InputError
        The level has no stiffness at a point, or the scene holds a motion there rigidly.
    """
    stiffness = model.stiffness(at)
    places = {unit.bearing.name: unit.bearing.x for unit in scene.bearing_units}
    places |= {"hub": scene.shaft.front, "gearbox": scene.shaft.rear}
    positions = np.array([[places[name], 0.0, 0.0] for name in at])
    origin = scene_origin(
        scene, f"{model.level} {model.title}", f"{model.cost.unknowns:,} unknowns"
    )
    return Superelement("drivetrain", tuple(at), positions, stiffness, None, True, band, origin)


def unit_superelement(scene: Scene, name: str) -> Superelement:
    """A bearing and its housing on the ground, at the bearing's centre: K_R of both planes, too."""
    x = scene.bearing_unit(name).bearing.x
    return Superelement(
        name.replace("-", "_"),
        (name,),
        np.array([[x, 0.0, 0.0]]),
        unit_stiffness(scene, name, coupling="rigid"),
        supported=True,
        origin=scene_origin(scene, "4 solid, face held in shape", f"{scene.mesh.housing:g} m"),
    )


def scene_hash(scene: Scene) -> str:
    """SHA-256 of all values of a scene, whatever its file looks like."""
    return hashlib.sha256(scene.model_dump_json().encode()).hexdigest()


def scene_origin(scene: Scene, level: str, mesh: str) -> Origin:
    """Where a superelement of a scene comes from: its level and mesh in words."""
    program = f"fe-drivetrain {version('fe-drivetrain')}"
    return Origin(scene.title, scene_hash(scene), level, mesh, program)
