"""Scenes of the rotor and multibody cases, with their bearing units on coarse meshes."""

from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Scene, library_scene
from fe_drivetrain.shafts.fidelity import housing_springs

#: Library scenes: full, and quick.
SCENES, QUICK_SCENES = ("main_bearing_bonded", "two_bearings"), ("two_bearings",)

#: Coarsening of the bearing units' meshes: both programs get the same matrices, whatever they are.
FACTOR = 4.0

#: Polynomial order of the meridian.
ORDER = 4


def scene_and_units(name: str) -> tuple[Scene, dict[str, Floats]]:
    """A library scene on a coarse mesh, and the (6, 6) stiffness of each of its bearing units."""
    scene = library_scene(name)
    sizes = scene.mesh.scaled(FACTOR, 8)
    scene = scene.model_copy(update={"mesh": sizes})
    return scene, housing_springs(scene)[0]
