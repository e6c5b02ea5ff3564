"""Superelements of a scene: its free shaft, the drivetrain on its supports, its bearing units."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.solve.condensation import Condensed, keep_points
from fe_drivetrain.export.superelement import Origin, Superelement, refuse_one_point
from fe_drivetrain.export.unit_statement import (
    stated_bound,
    stated_of_drivetrain,
    stated_rollers,
)
from fe_drivetrain.report.seal import drivetrain_hash
from fe_drivetrain.shafts.fidelity.bearing_units import banded_unit, unit_matrices
from fe_drivetrain.shafts.fidelity.ladder import LevelModel
from fe_drivetrain.shafts.fidelity.shaft_bands import banded_meridian, banded_solid, meridian_order
from fe_drivetrain.shafts.fidelity.shafts import beam_shaft, reference_points
from fe_drivetrain.shafts.fidelity.unit_faces import face_of

#: Sections of a beam up to which the meridian is solved for its band.
MAX_BANDED = 100


def shaft_superelement(scene: Scene, level: int, at: Sequence[str] | None = None) -> Superelement:
    """The free shaft of a scene, condensed.

    Its band is, of a beam, the difference to the meridian and the meridian's own; of the meridian
    and of a solid see `fe_drivetrain.shafts.fidelity.shaft_bands`. A beam of more than
    `MAX_BANDED` sections has none: its meridian is graded to each step and takes gigabytes.

    Parameters
    ----------
    scene : Scene
        The scene.
    level : int
        1 beam (without mass), 2 meridian, 3 solid with the rings of its bearings.
    at : Sequence[str] or None
        Points that are kept; all where not given.

    Raises
    ------
    InputError
        There is no such level or point, or one point alone.
    """
    refuse_one_point("shaft", at or (), reference_points(scene)[0], "drivetrain")
    if level == 1:
        band: StiffnessBands | None
        body = beam_shaft(scene)
        body = body if at is None else keep_points(body, at)
        band = _beam_band(scene, body, at)
        mesh = "none"
        if band is None:
            mesh += (
                "; the band is not known, for the meridian that it rests on is solved for at most "
                f"{MAX_BANDED} sections and there are {len(scene.shaft.pieces)}"
            )
        level_and_mesh = "1 Timoshenko beam", mesh
    elif level == 2:
        body, band = banded_meridian(scene, at)
        order = meridian_order(scene)
        level_and_mesh = "2 meridian in harmonics", f"elements of order {order} in the meridian"
    elif level == 3:
        body, band = banded_solid(scene, at)
        size = f"{scene.mesh.shaft:g} m"
        level_and_mesh = "3 solid shaft with rings", f"curved tetrahedra of second order, {size}"
    else:
        raise InputError(f"level {level} has no free shaft: use one of 1, 2, 3")
    return Superelement(
        "shaft",
        body.names,
        body.positions,
        body.stiffness,
        body.mass,
        band=band,
        origin=scene_origin(scene, *level_and_mesh),
    )


def _beam_band(scene: Scene, body: Condensed, at: Sequence[str] | None) -> StiffnessBands | None:
    """How far the beam is from its limit, relative; None where the meridian is too large."""
    if len(scene.shaft.pieces) > MAX_BANDED:
        return None
    meridian, band = banded_meridian(scene, at)
    return band + StiffnessBands.of_difference(meridian.stiffness, body.stiffness)


def supported_superelement(
    scene: Scene, model: LevelModel, at: Sequence[str], band: StiffnessBands | None = None
) -> Superelement:
    """The drivetrain on its supports, at points of a solved level of the ladder.

    Up to level 3, its bearing units are to be at their stiff bounds.

    Raises
    ------
    InputError
        The level has no stiffness at a point, or the scene holds a motion there rigidly.
    """
    stiffness = model.stiffness(at)
    names, places = reference_points(scene)
    positions = places[[names.index(name) for name in at]]
    origin = scene_origin(
        scene, f"{model.level} {model.title}", f"{model.cost.unknowns:,} unknowns"
    )
    bound, rollers = stated_of_drivetrain(scene, model.level)
    if bound and band is not None:
        bound += "; errors of the meshes are not in the band"
    return Superelement(
        "drivetrain",
        tuple(at),
        positions,
        stiffness,
        None,
        True,
        band,
        origin,
        bound,
        rollers,
    )


def unit_superelement(scene: Scene, name: str, mass: bool = False) -> Superelement:
    """A bearing and its housing on the ground, at the bearing's centre: K_R of both planes, too.

    The shaft is taken to keep its face in shape; the band reaches to a face that moves on average,
    and holds the error of the mesh: see `fe_drivetrain.shafts.fidelity.banded_unit`.

    Parameters
    ----------
    scene : Scene
        The scene.
    name : str
        Name of the bearing.
    mass : bool
        Whether it has its mass, see `fe_drivetrain.shafts.fidelity.unit_matrices`.

    Raises
    ------
    InputError
        Its mass is asked for, and its housing is a stiffness alone.
    """
    x = scene.bearing_unit(name).bearing.x
    stiffness, band = banded_unit(scene, name)
    return Superelement(
        name.replace("-", "_"),
        (name,),
        np.array([[x, 0.0, 0.0]]),
        stiffness,
        unit_matrices(scene, name).mass if mass else None,
        supported=True,
        band=band,
        origin=scene_origin(scene, _unit_level(scene, name), f"{scene.mesh.housing:g} m"),
        bound=stated_bound(scene, [name]),
        rollers=stated_rollers(scene, [name]),
    )


def _unit_level(scene: Scene, name: str) -> str:
    if scene.bearing_unit(name).condensed is not None:
        return "4 stiffness of the housing as given"
    _, way = face_of(scene, name, ring=True, coupling="rigid")
    return f"4 solid, face {'held in shape' if way == 'rigid' else 'moving on average'}"


def scene_origin(scene: Scene, level: str, mesh: str) -> Origin:
    """Where a superelement of a scene comes from: its level and mesh in words."""
    program = f"fe-drivetrain {version('fe-drivetrain')}"
    return Origin(scene.title, drivetrain_hash(scene), level, mesh, program)
