"""A scene without its weight, for loads that have it in them already."""

from __future__ import annotations

from fe_drivetrain.drivetrain_file.scene import Scene


def weightless(scene: Scene) -> Scene:
    """The scene without the weights that it states; those of its parts come with gravity."""
    change = {
        "gearbox": scene.gearbox.model_copy(update={"weight": 0.0}),
        "load_points": tuple(p.model_copy(update={"weight": 0.0}) for p in scene.load_points),
    }
    return scene.model_copy(update=change)
