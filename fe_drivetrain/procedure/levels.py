"""Interface loads and displacements from a level of the ladder: shafts of beams or elements.

A level is solved for unit loads, so that a history is one product. It is quasi-static: the rotor's
inertia is in the loads at the hub, and that of the shaft is left out.
"""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.procedure.interface_loads import GROUND, Body, Interface, LoadTable
from fe_drivetrain.shafts.fidelity.ladder import LevelModel
from fe_drivetrain.shafts.fidelity.shafts import reference_points
from fe_drivetrain.shafts.response.entering import Loads, entering


def level_loads(scene: Scene, model: LevelModel, time: Floats, hub: Loads) -> LoadTable:
    """Loads and motions at hub, bearings and gearbox entrance, of the loads at the hub alone.

    Parameters
    ----------
    scene : Scene
        On a rotating shaft.
    model : LevelModel
        A level of it, from 1 on.
    time : ndarray, (n,)
        Times of uniform step [s].
    hub : LoadHistory, PointLoads or array_like
        (n, 6) of the rotor on the shaft, as `shafts.response.entering` takes them [N, N m]; those
        at load points are left out.

    Returns
    -------
    LoadTable
        Without weights. Accelerations are second differences of the displacements.

    Raises
    ------
    InputError
        The level has no displacements, or `shafts.response.entering` refuses the loads.
    """
    if not model.points:
        raise InputError(
            f"level {model.level} ({model.title}) has no displacements: take level 1 or a finer one"
        )
    driven = entering(scene, hub).values[:, :6]
    names, positions = reference_points(scene)
    at = dict(zip(names, positions, strict=True))
    columns = slice(6 * model.points.index("hub"), 6 * model.points.index("hub") + 6)
    step = float(time[1] - time[0])
    found = []
    for name in ("hub", *model.reaction_matrices):
        motion = acceleration = None
        if name in model.points:
            first = 6 * model.points.index(name)
            motion = np.asarray(driven @ model.compliance[first : first + 6, columns].T)
            rate = np.gradient(motion, step, axis=0)
            acceleration = np.asarray(np.gradient(rate, step, axis=0))
        if name == "hub":
            loads, of, on = driven, GROUND, "shaft"
        else:
            loads = np.asarray(driven @ model.reaction_matrices[name][:, :6].T)
            of, on = "shaft", GROUND
        called = "gearbox entrance" if name == "gearbox" else name.replace("_", " ")
        found.append(Interface(called, of, on, at[name], loads, motion, acceleration))
    return LoadTable(
        np.asarray(time, dtype=np.float64),
        tuple(found),
        (Body("shaft", at["hub"], np.zeros(6)),),
    )
