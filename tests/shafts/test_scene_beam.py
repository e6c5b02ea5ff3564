"""The beam that stands for a scene."""

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene
from fe_drivetrain.shafts.beam import shaft
from fe_drivetrain.shafts.beam.closed_forms import pinned_model, torsional_spring_model
from fe_drivetrain.shafts.beam.of_scene import beam_of_scene, main_bearing_beam

PINNED = (np.inf, np.inf, np.inf, 0.0, 0.0, 0.0)


def test_parameters_are_the_scenes():
    beam = main_bearing_beam(library_scene("main_bearing_bonded"), tilt=145e6, yaw=392e6)
    assert (beam.overhang, beam.radial_stiffness, beam.axial_stiffness) == (2.145, 8e7, 4e6)
    assert beam.span == pytest.approx(2.615)
    assert beam.bending_stiffness == pytest.approx(200e9 * np.pi / 64 * 0.4**4)


def test_pinned_beam_of_the_scene_is_eq_3_1():
    scene = library_scene("main_bearing_spherical")
    response = shaft.unit_load_response(
        beam_of_scene(scene, {"main_bearing": PINNED}), [scene.shaft.front]
    )
    exact = pinned_model(np.eye(6), main_bearing_beam(scene)).T
    matrix = response.reaction_matrix("main_bearing")[:, 0, :]
    np.testing.assert_allclose(matrix[1:3], exact[1:3], atol=1e-10)


def test_spring_beam_of_the_scene_is_eq_3_19():
    scene = library_scene("main_bearing_bonded")
    spring = (np.inf, np.inf, np.inf, 0.0, 145e6, 392e6)
    response = shaft.unit_load_response(
        beam_of_scene(scene, {"main_bearing": spring}, shear=False), [scene.shaft.front]
    )
    parameters = main_bearing_beam(scene, 145e6, 392e6)
    weight = torsional_spring_model(np.zeros((1, 6)), parameters)
    exact = (torsional_spring_model(np.eye(6), parameters) - weight).T
    matrix = response.reaction_matrix("main_bearing")[:, 0, :]
    bending = np.ix_([1, 2, 4, 5], [1, 2, 4, 5])
    np.testing.assert_allclose(matrix[bending], exact[bending], atol=1e-10)


def test_a_ring_stiffens_the_beam():
    scene = library_scene("main_bearing_spherical")
    motion = [
        shaft.solve(
            beam_of_scene(scene, {"main_bearing": PINNED}, rings=rings),
            scene.shaft.front,
            np.eye(6)[2],
            at=scene.shaft.front,
        ).displacements[2]
        for rings in (False, True)
    ]
    assert 0.85 * motion[0] < motion[1] < motion[0]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {
                "shaft.sections": [
                    {"length": 1.5, "outer_diameter": 0.4},
                    {"length": 0.7, "outer_diameter": 0.5},
                ]
            },
            "several diameters",
        ),
        ({"gearbox.stiffness": [0, 1e7, 2e7, "rigid", 0, 0]}, "different gearbox stiffness"),
    ],
)
def test_closed_form_says_what_it_cannot_stand_for(changes, message):
    with pytest.raises(InputError, match=message):
        main_bearing_beam(change_scene(coarse_scene("spherical"), changes))
