"""A scene that can move is refused before the solve, and the motion has a name."""

import numpy as np
import pytest
from conftest import coarse_scene

from fe_drivetrain.errors import InputError
from fe_drivetrain.mechanisms import bodies, find_mechanisms
from fe_drivetrain.model import build_model
from fe_drivetrain.scene import change_scene


def test_bodies_are_parts_that_share_nodes(spherical_mesh, bonded_model):
    assert sorted(bodies(spherical_mesh)[1]) == [
        ("main_bearing.housing",),
        ("shaft", "main_bearing"),
    ]
    assert len(bodies(bonded_model.mesh)[1]) == 1


@pytest.mark.parametrize("form", ["sliding", "averaged", "rigid"])
def test_spherical_shaft_without_torque_reaction_twists(spherical_mesh, form):
    scene = change_scene(
        coarse_scene("spherical"),
        {"bearing_units.0.interface": form, "gearbox.stiffness": [4e6, 8e7, 8e7, 0, 0, 0]},
    )
    with pytest.raises(InputError) as caught:
        build_model(scene, spherical_mesh)
    message = str(caught.value)
    assert "shaft and main_bearing can turn freely about x" in message
    assert message.count("freely") == 1


def test_spherical_shaft_without_gearbox_turns_about_all_axes(spherical_mesh):
    scene = change_scene(coarse_scene("spherical"), {"gearbox.stiffness": [0] * 6})
    with pytest.raises(InputError) as caught:
        build_model(scene, spherical_mesh)
    for axis in "xyz":
        assert f"turn freely about {axis} through (0, 0, 0) m" in str(caught.value)


def test_one_radial_spring_leaves_one_tilt_free(spherical_mesh):
    """A spring along z at the gearbox stops tilt about y; yaw about z stays free."""
    scene = change_scene(
        coarse_scene("spherical"), {"gearbox.stiffness": [0, 0, 1.0, "rigid", 0, 0]}
    )
    with pytest.raises(InputError, match="turn freely about z") as caught:
        build_model(scene, spherical_mesh)
    assert "about y" not in str(caught.value)


def test_free_body_has_six_motions_with_names(bonded_model):
    found = find_mechanisms(bonded_model.mesh, [], [])
    assert len(found) == 6
    assert sum("turn freely" in text for text in found) == 3
    assert sum("move freely along" in text for text in found) == 3


def test_held_scene_has_none(bonded_model):
    assert find_mechanisms(bonded_model.mesh, bonded_model.constraints, ()) == []


def test_a_spring_of_any_size_holds(spherical_mesh):
    """Whether something is held is a question of geometry, not of stiffness."""
    for k in (1e-6, 1e15):
        scene = change_scene(coarse_scene("spherical"), {"gearbox.stiffness": [0, k, k, k, 0, 0]})
        model = build_model(scene, spherical_mesh)
        assert find_mechanisms(model.mesh, model.constraints, model.springs) == []
    assert np.isfinite(model.stiffness.data).all()
