"""Unit-load responses of the main bearing: statics, balance, reciprocity, invariance."""

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.shafts.beam.closed_forms import pinned_model
from fe_drivetrain.shafts.beam.of_scene import main_bearing_beam
from fe_drivetrain.shafts.response.model import LOADS, build_model
from fe_drivetrain.shafts.response.unit_loads import unit_load_response

FORMS = ("sliding", "averaged", "rigid")


@pytest.fixture
def responses(spherical_responses, bonded_model, bonded_response):
    return {**spherical_responses, "bonded": (bonded_model, bonded_response)}


def test_both_checks_hold_in_every_model(responses):
    for form, (_, response) in responses.items():
        assert response.equilibrium_error < 1e-8, form
        assert response.superposition_error < 1e-8, form


@pytest.mark.parametrize("form", FORMS)
def test_spherical_reactions_are_statics(spherical_responses, form):
    """A determinate shaft: radial reactions by Eq 3.1, no moment, whatever the joint's form."""
    model, response = spherical_responses[form]
    exact = pinned_model(np.eye(6), main_bearing_beam(model.scene)).T
    reaction = response.reactions["main_bearing"][:, :6]
    bending = [1, 2, 4, 5]
    np.testing.assert_allclose(
        reaction[1:3][:, bending], exact[1:3][:, bending], atol=1e-8 * np.abs(exact).max()
    )
    assert np.abs(reaction[3:, 3:]).max() < 1e-8


def test_bonded_bearing_carries_moment_and_torque(bonded_response):
    reaction = bonded_response.reactions["main_bearing"]
    assert reaction[4, LOADS.index("hub.My")] > 0.3
    assert reaction[3, LOADS.index("hub.Mx")] > 0.3
    assert reaction[4, LOADS.index("hub.Fz")] > 0.1


def test_interface_loads_equal_the_base_reaction(responses):
    """Seat, joint and base carry the same wrench where no load acts in between."""
    for form, (_, response) in responses.items():
        base = response.reactions["main_bearing"][:, :6]
        size = np.abs(base).max()
        for face in ("main_bearing.seat", "main_bearing.outer"):
            assert np.abs(response.reactions[face][:, :6] - base).max() < 1e-8 * size, (form, face)


def test_self_weight_reacts_as_weight(responses):
    """Gravity along z: bearing and gearbox together carry the weight of all parts."""
    for _, (model, response) in responses.items():
        total = sum(response.reactions[name][2, 8] for name in ("main_bearing", "gearbox"))
        mass = sum(m.sum() for m in model.part_mass.values())
        assert total == pytest.approx(mass, rel=1e-9)
        scene = model.scene
        shaft = 7850 * np.pi / 4 * 0.4**2 * scene.shaft.length
        assert model.part_mass["shaft"].sum() == pytest.approx(shaft, rel=2e-3)


def test_unit_load_matrix_is_reciprocal(responses):
    """Maxwell-Betti: work of load i in the motion of load j is symmetric."""
    for form, (model, response) in responses.items():
        n = len(model.mesh.points)
        F = model.unit_loads()[: 3 * n]
        work = F.T @ response.displacements.reshape(3 * n, -1)
        size = np.sqrt(np.outer(work.diagonal(), work.diagonal()))
        assert (np.abs(work - work.T) / size).max() < 1e-9, form


def test_energy_put_in_is_energy_stored(responses):
    for form, (model, response) in responses.items():
        n = len(model.mesh.points)
        work = model.unit_loads()[: 3 * n].T @ response.displacements.reshape(3 * n, -1)
        stored = sum(response.strain_energy.values())
        for point, k in model.springs:
            motion = response.motions[point.name]
            stored = stored + motion.T @ k @ motion
        np.testing.assert_allclose(stored.diagonal(), work.diagonal(), rtol=1e-8, err_msg=form)


def test_joint_forms_bound_each_other(spherical_responses):
    """Faces that are rigid about the centre also slide and keep equal means: more constraints
    are never softer."""
    compliance = {
        form: response.motions["hub"][2, 2] for form, (_, response) in spherical_responses.items()
    }
    assert compliance["rigid"] < compliance["sliding"]
    assert compliance["rigid"] < compliance["averaged"]


def test_all_reactions_stand_in_one_matrix(bonded_response):
    labels, matrix = bonded_response.reaction_matrix()
    assert matrix.shape == (len(labels), len(LOADS))
    row = labels.index("gearbox Fz")
    np.testing.assert_array_equal(matrix[row], bonded_response.reactions["gearbox"][2])


def test_history_is_the_sum_of_unit_responses(bonded_response, rng):
    hub = rng.standard_normal((5, 7, 6))
    history = bonded_response.history("main_bearing", hub, gearbox_weight=3.0, gravity=GRAVITY)
    R = bonded_response.reactions["main_bearing"]
    assert history.shape == (5, 7, 6)
    expected = R[:, :6] @ hub[2, 3] + 3.0 * R[:, 9] - GRAVITY * R[:, 8]
    np.testing.assert_allclose(history[2, 3], expected, rtol=1e-12)


def test_reactions_do_not_depend_on_where_the_scene_stands(bonded_response):
    """The same drivetrain, moved along x: the same reactions about the moved bearing."""
    moved = change_scene(
        coarse_scene("bonded"), {"shaft.front": 4.0, "bearing_units.0.bearing.x": 5.0}
    )
    from fe_drivetrain.shafts.response.model import mesh_scene

    response = unit_load_response(build_model(moved, mesh_scene(moved)))
    reference = bonded_response.reactions["main_bearing"]
    # Another mesh (gmsh rounds otherwise elsewhere): equal to discretisation, not to round-off.
    np.testing.assert_allclose(
        response.reactions["main_bearing"][:, :6],
        reference[:, :6],
        atol=0.01 * np.abs(reference[:, :6]).max(),
    )
    np.testing.assert_allclose(response.positions["main_bearing"], [5.0, 0.0, 0.0])


@pytest.mark.parametrize("coupling", ["averaged", "rigid"])
def test_rigid_couplings_stiffen_and_keep_statics(spherical_mesh, spherical_responses, coupling):
    scene = change_scene(
        coarse_scene("spherical"), {"hub.coupling": coupling, "gearbox.coupling": coupling}
    )
    response = unit_load_response(build_model(scene, spherical_mesh))
    reference = spherical_responses["sliding"][1]
    assert response.equilibrium_error < 1e-8
    np.testing.assert_allclose(
        response.reactions["main_bearing"][1:3, 1:3],
        reference.reactions["main_bearing"][1:3, 1:3],
        atol=1e-8,
    )
    softer, stiffer = (r.motions["hub"][2, 2] for r in (reference, response))
    assert stiffer <= softer * (1 + 1e-9)
    if coupling == "rigid":
        assert stiffer < softer


def test_rigid_gearbox_translations_react(spherical_mesh):
    """Rigid in place of springs: reactions are still statics, and the gearbox stands still."""
    scene = change_scene(
        coarse_scene("spherical"),
        {"gearbox.stiffness": [0, "rigid", "rigid", "rigid", 0, 0], "gearbox.coupling": "rigid"},
    )
    response = unit_load_response(build_model(scene, spherical_mesh))
    assert response.equilibrium_error < 1e-8
    assert np.abs(response.motions["gearbox"][[1, 2, 3]]).max() < 1e-15
    exact = pinned_model(np.eye(6), main_bearing_beam(scene)).T
    np.testing.assert_allclose(response.reactions["main_bearing"][2, :6], exact[2], atol=1e-8)
