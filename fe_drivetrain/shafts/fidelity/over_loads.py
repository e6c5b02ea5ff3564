"""A scene at every level over load histories: reactions by one matrix product, and their errors.

Reactions of all levels come from unit loads, so that a million load steps cost a product.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.mesh.measures import mean_size
from fe_drivetrain.shafts.fidelity.bearing_units import UnitBounds, unit_bounds
from fe_drivetrain.shafts.fidelity.ladder import (
    LevelModel,
    assembly_level,
    level_of_response,
    shaft_level,
)
from fe_drivetrain.shafts.fidelity.shaft_bands import APART, COARSER
from fe_drivetrain.shafts.fidelity.shafts import condensed_shaft, reference_points
from fe_drivetrain.shafts.response.entering import Loads, entering
from fe_drivetrain.shafts.response.model import mesh_scene
from fe_drivetrain.shafts.response.unit_loads import Response, driving

COARSER_ASSEMBLY = "assembly, coarser mesh"
"""Its name among the models."""

ROUND_OFF = 1e-6
"""Share of a reaction below which its force or moment is the noise of a mesh, and left out."""


@dataclass(frozen=True)
class Levels:
    """A scene solved at several levels.

    Attributes
    ----------
    units : Mapping[str, UnitBounds]
        Stiffness of each bearing unit by name, between two bounds.
    models : Mapping[str, LevelModel]
        By name, from cheap to expensive. The last one is the assembly that all are compared with.
    mesh_ratio : float
        Mean element size of the coarser assembly over that of the other; NaN where there is none.
    bounds : Mapping[str, Sequence[str]]
        Levels below the assembly from cheap to expensive, beginning with their numbers, each with
        the names of its models: two where bearing units are between two bounds.
    """

    units: Mapping[str, UnitBounds]
    models: Mapping[str, LevelModel]
    mesh_ratio: float
    bounds: Mapping[str, Sequence[str]]

    @property
    def coarser(self) -> LevelModel | None:
        """The assembly on a coarser mesh; None where it says nothing of the other's band."""
        return self.models[COARSER_ASSEMBLY] if self.mesh_ratio > APART else None

    def band(self, change: Floats) -> Floats:
        """Band of what the coarser mesh changes by so much: continued at first order.

        Stress is singular where parts meet, so that no better order is relied upon.
        """
        return np.asarray(np.abs(change) / (self.mesh_ratio - 1.0))

    @property
    def reference(self) -> LevelModel:
        """The assembly of solids."""
        return list(self.models.values())[-1]


def levels_of(scene: Scene, response: Response, report: Progress = silent) -> Levels:
    """Solve a scene at levels 1 and 2, between two bounds of its housings, beside the assembly.

    Parameters
    ----------
    scene : Scene
        Any scene, with any number of bearings and sections.
    response : Response
        Response of the assembly.
    report : callable
        Called with what is being done.

    Returns
    -------
    Levels
        With an assembly on a coarser mesh, where such a mesh can be made.

    Raises
    ------
    InputError
        A level refuses the scene.
    """
    models, names = dict[str, LevelModel](), dict[str, Sequence[str]]()
    if scene.bearing_units:
        names["1 beam, rigid housings"] = ["beam, rigid housings"]
        models["beam, rigid housings"] = shaft_level(scene, 1)
    report("levels 1 and 2 (1 of 4)")
    units = {
        unit.bearing.name: unit_bounds(scene, unit.bearing.name) for unit in scene.bearing_units
    }
    stiff = {name: found.stiff for name, found in units.items()}
    soft = {name: found.soft for name, found in units.items()}
    for level, word in ((1, "beam"), (2, "meridian")):
        report(f"levels 1 and 2 ({level + 1} of 4)")
        body = condensed_shaft(scene, level)
        if not scene.bearing_units:  # a nose alone: nothing stands between two bounds
            names[f"{level} {word}"] = [word]
            models[word] = shaft_level(scene, level, body=body)
            continue
        names[f"{level} {word}, housings as springs"] = [
            f"{word}, stiff housings",
            f"{word}, soft housings",
        ]
        for name, springs in (("stiff", stiff), ("soft", soft)):
            models[f"{word}, {name} housings"] = shaft_level(scene, level, springs, body)
    report("levels 1 and 2 (4 of 4)")
    ratio = float("nan")
    coarse = scene.model_copy(update={"mesh": scene.mesh.scaled(COARSER)})
    try:
        models[COARSER_ASSEMBLY] = assembly_level(coarse)
        ratio = mean_size(mesh_scene(coarse)) / mean_size(mesh_scene(scene))
    except InputError:  # too coarse for a wall
        pass
    found = response.diagnostics
    seconds = found.setup_seconds + found.solve_seconds
    models["assembly"] = level_of_response(scene, response, seconds)
    return Levels(units, models, ratio, names)


def reaction_history(
    model: LevelModel, name: str, hub_loads: Loads, gearbox_weight: float, gravity: float
) -> Floats:
    """One reaction over any number of load steps.

    Parameters
    ----------
    model : LevelModel
        The scene at a level.
    name : str
        Name of a bearing, or "gearbox".
    hub_loads : LoadHistory, PointLoads or array_like
        As `shafts.response.entering` takes them; an array is (..., 6) hub forces [N] and moments [N
        m] about the front face, or (..., 6 + 6 m) with those at the m load points.
    gearbox_weight : float
        Weight of the gearbox [N], along -z.
    gravity : float
        Acceleration along -z that gives all parts their weight [m/s^2]; 0 leaves it out.

    Returns
    -------
    ndarray, (..., 6)
        What the drivetrain puts on its support [N, N m].

    Raises
    ------
    InputError
        `shafts.response.entering` refuses the loads.
    """
    R = model.reaction_matrices[name]
    driven = entering(model, hub_loads).values
    result = driven @ driving(R, driven.shape[-1]).T
    result += gearbox_weight * R[:, 9] - gravity * R[:, 8]
    return np.asarray(result)


def relative_errors(
    reference: Floats, found: Floats, length: float, weights: Floats | None = None
) -> Floats:
    """Error of a reaction's force and of its moment, each as a vector.

    Parameters
    ----------
    reference, found : ndarray, (n, 6)
        Samples of a reaction [N, N m].
    length : float
        Length of the shaft [m], which makes forces comparable to moments.
    weights : ndarray, (n,), or None
        Weights of the samples, their sum 1; equal where not given.

    Returns
    -------
    ndarray, (2,)
        Root mean square of the difference over that of the reference; NaN where the reference is
        but noise, see `ROUND_OFF`.
    """
    w = np.full(len(reference), 1.0 / len(reference)) if weights is None else weights
    size, error = (
        np.array([np.sqrt(w @ (part**2).sum(axis=1)) for part in (v[:, :3], v[:, 3:])])
        for v in (reference, found - reference)
    )
    scale = np.array([1.0, length])
    real = size > ROUND_OFF * (size / scale).max() * scale
    return np.where(real, error / np.where(real, size, 1.0), np.nan)


def imbalance(scene: Scene, model: LevelModel) -> float:
    """Largest difference of reactions to unit loads at hub and load points from these, relative.

    Parameters
    ----------
    scene : Scene
        The scene.
    model : LevelModel
        The scene at a level.

    Returns
    -------
    float
        Moments are taken about the hub and divided by the length of the shaft.
    """
    names, positions = reference_points(scene)
    at = dict(zip(names, positions, strict=True))
    driven = ["hub", *scene.bands]
    total = sum(
        wrench_transport(at[name] - at["hub"]) @ driving(R, 6 * len(driven))
        for name, R in model.reaction_matrices.items()
    )
    applied = np.hstack([wrench_transport(at[name] - at["hub"]) for name in driven])
    length = np.array([1.0, 1.0, 1.0, *3 * (scene.shaft.length,)])
    error = (total - applied) / length[:, None] * np.tile(length, len(driven))
    return float(np.abs(error).max())
