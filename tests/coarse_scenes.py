"""Coarse scenes of tests, as other processes import them, too."""

from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene
from fe_drivetrain.drivetrain_file.scene import Scene

#: A short, coarse main bearing: thesis proportions, a tenth of the unknowns.
COARSE = {
    "mesh.shaft": 0.3,
    "mesh.bearing": 0.14,
    "mesh.housing": 0.18,
    "mesh.bearing_edge": 0.14,
    "mesh.elements_per_turn": 8,
    "shaft.front": -1.0,
    "shaft.sections.0.length": 2.2,
}

#: Finer than `COARSE`: coarser meshes for a series can be made of it.
FINER = {
    "mesh.bearing": 0.1,
    "mesh.housing": 0.1,
    "mesh.bearing_edge": 0.1,
    "mesh.elements_per_turn": 12,
}


def coarse_scene(kind: str, **changes: object) -> Scene:
    """The library's main bearing, made small."""
    return change_scene(library_scene(f"main_bearing_{kind}"), COARSE | changes)
