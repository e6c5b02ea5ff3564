"""The bearing seats of a scene as one superelement, as shaft-and-bearing programs import it."""

from __future__ import annotations

import operator
from dataclasses import replace
from functools import reduce

import numpy as np
from scipy.linalg import block_diag

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.export.from_scene import unit_superelement
from fe_drivetrain.export.superelement import Superelement
from fe_drivetrain.export.unit_statement import stated_bound, stated_rollers


def seats_superelement(scene: Scene) -> Superelement:
    """All bearings with their housings on the ground: one node a seat, in the order of the scene.

    Each housing rests on its own feet, so no stiffness is between them.

    Raises
    ------
    InputError
        The scene has no bearing.
    """
    names = [unit.bearing.name for unit in scene.bearing_units]
    units = [unit_superelement(scene, name) for name in names]
    if not units:
        raise InputError(f"scene {scene.title!r} has no bearing: there is no seat to export")
    levels = dict.fromkeys(unit.origin.level for unit in units)
    return replace(
        units[0],
        name="seats",
        points=tuple(unit.points[0] for unit in units),
        positions=np.vstack([unit.positions for unit in units]),
        stiffness=block_diag(*(unit.stiffness for unit in units)),
        band=reduce(operator.or_, (unit.band for unit in units if unit.band is not None)),
        origin=replace(units[0].origin, level="; ".join(levels)),
        bound=stated_bound(scene, names),
        rollers=stated_rollers(scene, names),
    )
