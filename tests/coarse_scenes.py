"""Coarse scenes of tests, as other processes import them, too."""

from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
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

MOUNT = (4.0e6, 8.0e7, 8.0e7, 8.0e7, 0.0, 4.0e6)
"""Mount of the gearbox of `coarse_drivetrain` [N/m, N m/rad]."""
LENGTHS = (0.5, 0.9, 0.8)
"""Lengths of the steps of its main shaft [m]."""


def coarse_scene(kind: str, **changes: object) -> Scene:
    """The library's main bearing, made small."""
    return change_scene(library_scene(f"main_bearing_{kind}"), COARSE | changes)


def coarse_drivetrain() -> Scene:
    """The coarse main bearing with a stepped shaft, and behind it gears of the library."""
    gears = read_drivetrain("synthetic_2mw")
    box = gears.gearbox.model_dump(exclude_unset=True)
    box["bearings"] = [b for b in box["bearings"] if b["holds"] != "LSS"]
    whole = gears.model_dump(exclude_unset=True)
    of_gears = {key: whole[key] for key in ("rotor", "generator")}
    of_gears |= {f"gearbox.{key}": value for key, value in box.items()}
    steps = [
        {"length": length, "outer_diameter": d}
        for length, d in zip(LENGTHS, (0.46, 0.4, 0.36), strict=True)
    ]
    own = {"gearbox.stiffness": MOUNT, "shaft.sections": steps}
    return coarse_scene("bonded", **of_gears, **own)
