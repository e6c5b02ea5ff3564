"""A scene at its temperatures by the shaft alone: beam, meridian or solid on its bearings.

A shaft of one temperature expands freely to a larger one of the same shape, at every level; what
resists is where it is held. Parametric housings lift the bearing by their height over the base.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.drivetrain_file.joint_springs import joint_stiffness
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.solve.condensation import supported
from fe_drivetrain.geometry import Housing
from fe_drivetrain.shafts.fidelity.bearing_units import scene_supports
from fe_drivetrain.shafts.fidelity.shafts import condensed_shaft
from fe_drivetrain.shafts.response.thermal import ThermalState


def thermal_level(
    scene: Scene, level: int = 1, housings: Mapping[str, Floats] | None = None
) -> ThermalState:
    """Reactions and motions of a scene at its temperatures, with its shaft at a level.

    Parameters
    ----------
    scene : Scene
        The scene, which states temperatures.
    level : int
        1 beam, 2 meridian, 3 solid shaft.
    housings : Mapping, optional
        (6, 6) stiffness of bearing units, see
        `fe_drivetrain.shafts.fidelity.ladder.housing_springs`; rigid where not given.

    Raises
    ------
    InputError
        The supports leave the shaft free to move.
    """
    if housings is None:
        housings = {unit.bearing.name: joint_stiffness(unit) for unit in scene.bearing_units}
    body = condensed_shaft(scene, level)
    found = supported(body, scene_supports(scene, housings), scene.coupled_units)
    n = len(body.names)
    strain = scene.free_strain("shaft")
    free, ground = np.zeros(6 * n), np.zeros(6 * n)
    free[::6] = strain * (body.positions[:, 0] - body.positions[0, 0])
    for unit in scene.bearing_units:
        name = unit.bearing.name
        if isinstance(unit.housing, Housing):
            rise = scene.free_strain(f"{name}.housing") * unit.housing.centre_height
            ground[body.rows(name)][2] = rise
    # K (u - free) + K_s (u - ground) = 0, solved for u - ground
    F = body.stiffness @ (free - ground)
    u = found.motions[:, : 6 * n] @ F + ground
    reactions = {name: R[:, : 6 * n] @ F for name, R in found.reactions.items()}
    reactions.setdefault("gearbox", np.zeros(6))
    return ThermalState(
        reactions,
        {name: u[body.rows(name)] for name in body.names},
        {
            unit.bearing.name: 0.5 * strain * scene.seat_diameter(unit.bearing.name)
            for unit in scene.bearing_units
        },
    )
