"""Draw the pictures of the gallery: ``python docs/stills.py``, when a scene of the library changed.

They stand in the repository, so that the site is built without drawing; a test compares the hashes
of the scenes that are in them.
"""

from __future__ import annotations

import hashlib
import json
import sys
import tempfile
from pathlib import Path

from fe_drivetrain.common import InputError
from fe_drivetrain.drivetrain_file import Component, Scene, library_component, read_drivetrain

FOLDER = Path(__file__).parent / "gallery"
HASHES = FOLDER / "scenes.json"
COMPONENTS = ("gearbox_housing", "planet_carrier")
SHOWN = (0, 0, 1600, 690)
"""Of a picture: without its legend, which nobody could read on a card."""
SIZE = (720, 310)


def library() -> dict[str, Scene | Component]:
    """All components of the library and all drivetrains with solid parts, by name, in order."""
    found: dict[str, Scene | Component] = {}
    files = (Path(__file__).parents[1] / "geometry" / "library").glob("*.yaml")
    for name in sorted(file.stem for file in files):
        if name in COMPONENTS:
            found[name] = library_component(name)
        elif isinstance(drivetrain := read_drivetrain(name), Scene):
            found[name] = drivetrain
    return found


def hash_of(scene: Scene | Component) -> str:
    """SHA-256 of all values that a picture shows."""
    turning = {"rotor", "generator", "brake", "operation", "damping", "sources", "assumed"}
    values = scene.model_dump_json(exclude=turning, exclude_unset=True)
    return hashlib.sha256(values.encode()).hexdigest()


def draw(name: str, scene: Scene | Component, file: Path) -> None:
    """Draw a scene with loads and supports, or a component as it gives way to a torque."""
    from PIL import Image

    with tempfile.TemporaryDirectory() as folder:
        large = Path(folder) / f"{name}.png"
        if isinstance(scene, Scene):
            draw_scene(scene, large)
        else:
            draw_component(scene, large)
        small = Image.open(large).crop(SHOWN).resize(SIZE, Image.Resampling.LANCZOS)
        small.save(file, quality=82, method=6)


def draw_scene(scene: Scene, file: Path) -> None:
    """As on a page, on the coarsest of some meshes that its walls allow."""
    from fe_drivetrain.report.pictures import picture_of_model
    from fe_drivetrain.shafts.response import build_model, mesh_scene

    for factor in (2.0, 1.5, 1.0):
        try:
            coarse = scene.model_copy(update={"mesh": scene.mesh.scaled(factor, 12)})
            picture_of_model(build_model(coarse, mesh_scene(coarse)), file).wait()
            return
        except InputError as refusal:  # too coarse for a wall
            reason = refusal
    raise reason


def draw_component(component: Component, file: Path) -> None:
    """Deformed, under a torque about x at the first of its points that is free."""
    from fe_drivetrain.elasticity.solve import supported
    from fe_drivetrain.report.pictures import picture_of_displacements
    from fe_drivetrain.shafts.fidelity import solid_component

    coarse = component.model_copy(update={"mesh": component.mesh.scaled(1.5)})
    solid = solid_component(coarse)
    free = next(n for n in solid.body.names if n not in component.supports)
    turn = 6 * solid.body.names.index(free) + 3
    motions = 1e6 * supported(solid.body, component.supports).motions[:, turn]
    _, drawn = picture_of_displacements(solid.mesh, solid.displacements(motions), file)
    drawn.wait()


def main(names: list[str]) -> None:
    """Draw those of the names, or those whose scene has changed."""
    scenes = library()
    hashes = json.loads(HASHES.read_text("utf-8")) if HASHES.is_file() else {}
    for name, scene in scenes.items():
        if name in names or (not names and hashes.get(name) != hash_of(scene)):
            print(name)
            draw(name, scene, FOLDER / f"{name}.webp")
            hashes[name] = hash_of(scene)
    kept = {name: hashes[name] for name in scenes if name in hashes}
    HASHES.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
