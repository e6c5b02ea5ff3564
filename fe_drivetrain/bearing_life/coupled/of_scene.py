"""The shaft of a scene at any level, for rolling bearings in place of the joints of the scene."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from fe_drivetrain.bearing_life.coupled.body import LinearBody, in_housings, linear_body
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.joint_springs import as_numbers, joint_stiffness
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.fidelity.shafts import condensed_shaft


def scene_body(
    scene: Scene, level: int, housings: Mapping[str, Floats] | None = None
) -> LinearBody:
    """A scene's shaft on its gearbox, its bearings taken out to be replaced by rolling ones.

    Parameters
    ----------
    scene : Scene
        The scene. Of the joints of its bearings only one thing is used: a ring whose joint is free
        along x slides in its housing.
    level : int
        Model of the shaft: 1 beam, 2 meridian, 3 solid. With the housings solved as solids the last
        is the assembly of level 4, but for what the faces at the rollers do to each other's shape.
    housings : Mapping, optional
        Stiffness (6, 6) of housings by bearing [N/m, N, N m/rad], from `fidelity.unit_stiffness`
        with the bearing bonded; rigid where not given.

    Returns
    -------
    body : LinearBody
        Body: the shaft, its weight, and the gearbox's springs; with the scene's load points.

    Raises
    ------
    InputError
        The scene has a nose.
    """
    if scene.nose is not None:
        raise InputError(
            f"scene {scene.title!r} has a nose, which a shaft on rolling bearings does not: give a "
            "scene with bearing units alone"
        )
    names = [unit.bearing.name for unit in scene.bearing_units]
    gearbox = as_numbers(scene.gearbox.stiffness)
    supports = {"gearbox": gearbox} if gearbox.any() else {}
    body = linear_body(condensed_shaft(scene, level), names, supports, list(scene.bands))
    return replace(
        in_housings(body, housings or {}), entrance=scene.entrance, sliding=sliding_rings(scene)
    )


def sliding_rings(scene: Scene) -> tuple[str, ...]:
    """Bearings of a scene whose joint is free along x: their outer rings slide in the housing.

    Parameters
    ----------
    scene : Scene
        The scene.
    """
    units = scene.bearing_units
    return tuple(unit.bearing.name for unit in units if not joint_stiffness(unit)[0].any())
