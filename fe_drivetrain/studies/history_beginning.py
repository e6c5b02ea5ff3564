"""Bearing forces over the beginning of one load history: what the levels differ by, to be seen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.fidelity.over_loads import Levels, reaction_history
from fe_drivetrain.studies.study_loads import EnteredLoads

ASSEMBLY = "assembly"
"""Name of the assembly of solids among the models."""

_SHOWN = 60.0  # seconds


@dataclass(frozen=True, eq=False)
class Beginning:
    """The first minute of a history, for a chart.

    Attributes
    ----------
    name : str
        Name of the history.
    time : ndarray, (n,)
        Times of its samples [s].
    radial_forces : mapping of str to mapping of str to ndarray, (n,)
        Force across the shaft by bearing and model: the assembly, and the beams [N].
    """

    name: str
    time: Floats
    radial_forces: Mapping[str, Mapping[str, Floats]]


def history_beginning(scene: Scene, levels: Levels, loads: EnteredLoads) -> Beginning:
    """The beginning of the middle history, with the radial force of each bearing.

    Parameters
    ----------
    scene : Scene
        The scene.
    levels : Levels
        Its models.
    loads : EnteredLoads
        Hub loads, each history with its own time.
    """
    middle = len(loads.each) // 2
    history = loads.given.histories[middle]
    shown = history.time - history.time[0] <= _SHOWN
    entered = loads.each[middle][shown]
    weight, gravity = scene.gearbox.weight, loads.given.gravity
    (*_, beams) = [models for level, models in levels.bounds.items() if level.startswith("1")]
    forces: dict[str, dict[str, Floats]] = {}
    for name in scene.bearing_names:
        of_models = forces.setdefault(name, {})
        for label in (ASSEMBLY, *beams):
            reaction = reaction_history(levels.models[label], name, entered, weight, gravity)
            of_models[label] = np.hypot(reaction[:, 1], reaction[:, 2])
    return Beginning(history.name, history.time[shown], forces)
