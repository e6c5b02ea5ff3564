"""What a main bearing carries where the shaft is determinate: by statics, and as it is solved."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Scene, change_scene, library_scene
from fe_drivetrain.shafts.beam import main_bearing_beam, pinned_model
from fe_drivetrain.shafts.response import LOADS, Model, cached_response

HUB = [LOADS.index(load) for load in LOADS if load.startswith("hub")]
JUDGED = [k for k, load in enumerate(LOADS) if load != "gravity.x"]
"""Gravity along x is no load of a drivetrain, and its lever arm is the mesh's asymmetry."""


def coarse_bearing(form: str, factor: float) -> Scene:
    """The library's main bearing on a mesh coarser by a factor.

    Parameters
    ----------
    form : str
        "bonded", or a form of the spherical joint: "sliding", "averaged", "rigid".
    factor : float
        Of the sizes of the elements.
    """
    scene = library_scene(f"main_bearing_{'bonded' if form == 'bonded' else 'spherical'}")
    scene = scene.model_copy(update={"mesh": scene.mesh.scaled(factor, 8)})
    return scene if form == "bonded" else change_scene(scene, {"bearing_units.0.interface": form})


@dataclass(frozen=True)
class Carried:
    """What the first bearing unit carries under the ten unit loads.

    Attributes
    ----------
    joint, base : Floats
        (6, 10) force and moment through the joint, about its centre, and of the housing's base on
        the bedplate, about the same point [N, N m].
    statics : Floats
        (2, 10) Fy and Fz by statics [N].
    radius : float
        Of the joint [m].
    """

    joint: Floats
    base: Floats
    statics: Floats
    radius: float

    @property
    def moments(self) -> Floats:
        """(10,) through the joint, about its centre [N m]."""
        return np.asarray(np.linalg.norm(self.joint[3:], axis=0))

    @property
    def max_moment(self) -> float:
        """Largest moment of the hub loads [N m]."""
        return float(self.moments[HUB].max())

    @property
    def distance(self) -> float:
        """Largest distance of the line of the force from the joint's centre [m]."""
        size = np.linalg.norm(self.joint[:3], axis=0)
        loaded = size > 1e-6
        return float((self.moments[loaded] / size[loaded]).max())

    @property
    def from_statics(self) -> float:
        """Largest difference of Fy and Fz, relative to the largest of a load, or to 1 N."""
        apart = np.abs(self.base[1:3] - self.statics)[:, JUDGED].max(axis=0)
        size = np.abs(self.statics)[:, JUDGED].max(axis=0)
        return float((apart / np.maximum(1.0, size)).max())

    @property
    def apart(self) -> float:
        """Largest difference of joint and base under hub loads, over the largest force."""
        apart = np.abs((self.base - self.joint)[:, HUB]).max()
        return float(apart / np.abs(self.joint[:, HUB]).max())


def carried(model: Model, solver: str) -> Carried:
    """Solve the ten unit loads of a scene with one bearing unit."""
    bearing = model.scene.bearing_units[0].bearing
    response = cached_response(model, solver)
    joint, base = (response.reactions[name] for name in (f"{bearing.name}.outer", bearing.name))
    return Carried(joint, base, bearing_statics(model), 0.5 * bearing.raceway_diameter)


def bearing_statics(model: Model) -> Floats:
    """(2, 10): Fy and Fz at the bearing by statics [N]; gravity along x is left out.

    Self-weight by the moments of shaft and bearing about the gearbox, and the housing's own weight.
    """
    exact = np.zeros((6, len(LOADS)))
    exact[:, :6] = pinned_model(np.eye(6), main_bearing_beam(model.scene)).T
    name = model.scene.bearing_units[0].bearing.name
    gearbox, bearing = (model.points[key].position[0] for key in ("gearbox", f"{name}.seat"))
    turning = model.part_mass["shaft"] + model.part_mass[name]
    lever = float(turning @ (gearbox - model.mesh.points[:, 0])) / (gearbox - bearing)
    for axis in (1, 2):
        exact[axis, 6 + axis] = lever + model.part_mass[f"{name}.housing"].sum()
    # the gearbox's weight stands on its own springs
    return exact[1:3]
