"""Bands hold what much finer models say: shafts of random shape, and units on every joint."""

from dataclasses import replace

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.common.scaling import largest_difference
from fe_drivetrain.fidelity.bearing_units import banded_unit, unit_stiffness
from fe_drivetrain.fidelity.shaft_bands import banded_meridian, banded_solid
from fe_drivetrain.fidelity.shafts import meridian_shaft, shaft_solid
from fe_drivetrain.mesh.measures import mean_size, volume
from fe_drivetrain.scene.scene import Scene
from fe_drivetrain.solve.condensation import followed
from fe_drivetrain.validation.random_shafts import random_scene

pytestmark = pytest.mark.usefixtures("kept_between_runs")


@pytest.mark.parametrize("seed", [1, 2, 5])
def test_the_meridians_band_holds_what_higher_orders_on_finer_meshes_say(seed: int) -> None:
    """Seeds 1 (sharp) and 5 (fillets): the last change of order alone is less than the error."""
    scene = random_scene(seed)
    body, band = banded_meridian(scene)
    widest = max(piece.outer_diameter for piece in scene.shaft.pieces)
    filleted = any(piece.fillet > 0 for piece in scene.shaft.pieces)
    # order 6 or a fifth layer at the corners changes these errors by 1 % at most
    finer = meridian_shaft(scene, widest / 2, 5 if filleted else 8, layers=4)
    error = largest_difference(body.stiffness, finer.stiffness)
    assert error < band < 5 * error


def small() -> Scene:
    """A short stepped shaft whose solid has some thousand elements."""
    scene = coarse_scene("bonded")
    return scene.model_copy(update={"mesh": scene.mesh.model_copy(update={"shaft": 0.2})})


def test_the_solids_band_holds_the_meridian() -> None:
    """The same body without its ring's housing, in two discretisations that share nothing."""
    scene = random_scene(2)
    body, band = banded_solid(scene)
    error = largest_difference(body.stiffness, meridian_shaft(scene).stiffness)
    assert error < band < 5 * error


def test_points_that_are_left_out_follow_without_load() -> None:
    body = shaft_solid(small()).body
    motions = followed(body, ["hub", "gearbox"])
    forces = body.stiffness @ motions
    scale = np.abs(forces).max()
    assert np.abs(forces[body.rows("main_bearing")]).max() < 1e-9 * scale


def test_the_mean_size_is_that_of_cubes_of_the_same_volume() -> None:
    mesh = shaft_solid(small()).mesh
    assert len(mesh.cells) * mean_size(mesh) ** 3 == pytest.approx(volume(mesh), rel=1e-12)
    half = replace(mesh, points=0.5 * mesh.points)
    assert mean_size(half) == pytest.approx(0.5 * mean_size(mesh), rel=1e-12)


@pytest.mark.parametrize("joint", ["spring", "averaged", "rigid"])
def test_a_unit_has_a_band_that_holds_a_finer_mesh_whatever_its_joint(joint: str) -> None:
    """Joints that say how the face moves leave no range of couplings: the mesh is what is left."""
    changes: dict[str, object] = {"bearing_units.main_bearing.interface": joint}
    if joint == "spring":
        changes["bearing_units.main_bearing.stiffness"] = ["rigid"] * 6
    kind = "bonded" if joint == "spring" else "spherical"
    scene = coarse_scene(kind, **changes)
    stiffness, band = banded_unit(scene, "main_bearing")
    finer = scene.model_copy(update={"mesh": scene.mesh.scaled(0.5, 20)})
    error = largest_difference(stiffness, unit_stiffness(finer, "main_bearing", "rigid"))
    assert 0 < error < band < 10 * error
