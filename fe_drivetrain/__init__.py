"""fe-drivetrain: finite-element validation suite for wind-turbine drivetrains."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fe_drivetrain.beams import MainBearingBeam, pinned_model, torsional_spring_model
    from fe_drivetrain.errors import InputError
    from fe_drivetrain.hub_loads import LoadHistory, read_hub_loads
    from fe_drivetrain.materials import Material
    from fe_drivetrain.mesh import Mesh
    from fe_drivetrain.model import Model, build_model, mesh_scene
    from fe_drivetrain.response import Response, unit_load_response
    from fe_drivetrain.scene import Scene, change_scene, library_scene, read_scene
    from fe_drivetrain.scene_beam import beam_of_scene
    from fe_drivetrain.stiffness import bearing_unit_stiffness, tilt_stiffness, without_gearbox
    from fe_drivetrain.surrogate import hub_load_set

# Imported when first used: the command line must not wait for gmsh and scipy to say --help.
_HOME = {
    "InputError": "errors",
    "LoadHistory": "hub_loads",
    "MainBearingBeam": "beams",
    "Material": "materials",
    "Mesh": "mesh",
    "Model": "model",
    "Response": "response",
    "Scene": "scene",
    "beam_of_scene": "scene_beam",
    "bearing_unit_stiffness": "stiffness",
    "build_model": "model",
    "change_scene": "scene",
    "hub_load_set": "surrogate",
    "library_scene": "scene",
    "mesh_scene": "model",
    "pinned_model": "beams",
    "read_hub_loads": "hub_loads",
    "read_scene": "scene",
    "tilt_stiffness": "stiffness",
    "torsional_spring_model": "beams",
    "unit_load_response": "response",
    "without_gearbox": "stiffness",
}

__all__ = [
    "InputError",
    "LoadHistory",
    "MainBearingBeam",
    "Material",
    "Mesh",
    "Model",
    "Response",
    "Scene",
    "beam_of_scene",
    "bearing_unit_stiffness",
    "build_model",
    "change_scene",
    "hub_load_set",
    "library_scene",
    "mesh_scene",
    "pinned_model",
    "read_hub_loads",
    "read_scene",
    "tilt_stiffness",
    "torsional_spring_model",
    "unit_load_response",
    "without_gearbox",
]


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"fe_drivetrain.{_HOME[name]}"), name)
    raise AttributeError(f"module 'fe_drivetrain' has no attribute {name!r}")
