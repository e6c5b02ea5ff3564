"""K_R and the condensed stiffness of a bearing unit."""

import dataclasses

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.shafts.response.bearing_stiffness import (
    HORIZONTAL,
    PLANES,
    VERTICAL,
    bearing_unit_stiffness,
    tilt_stiffness,
    without_gearbox,
)
from fe_drivetrain.shafts.response.model import build_model
from fe_drivetrain.shafts.response.unit_loads import unit_load_response

pytestmark = pytest.mark.filterwarnings("ignore:tilt stiffness of:UserWarning")


@pytest.fixture(scope="module")
def free(bonded_model):
    model = build_model(without_gearbox(bonded_model.scene), bonded_model.mesh)
    return model, unit_load_response(model)


def test_gearbox_must_be_off(bonded_model, bonded_response):
    with pytest.raises(InputError, match="without gearbox stiffness"):
        tilt_stiffness(bonded_model, bonded_response, "main_bearing", VERTICAL)


def test_a_bonded_unit_that_shares_its_load_is_refused(bonded_response):
    with pytest.raises(InputError, match="'gearbox' carries a part"):
        bearing_unit_stiffness(bonded_response, "main_bearing")


def test_two_bearings_have_no_tilt_stiffness(bonded_model, bonded_response):
    scene = bonded_model.scene
    unit = scene.bearing_units[0]
    other = unit.model_copy(
        update={"bearing": unit.bearing.model_copy(update={"name": "second", "x": 0.7})}
    )
    two = without_gearbox(scene).model_copy(update={"bearing_units": (unit, other)})
    model = dataclasses.replace(bonded_model, scene=two)
    with pytest.raises(InputError, match="one bearing, not 2"):
        tilt_stiffness(model, bonded_response, "main_bearing", VERTICAL)


def test_estimators_agree_in_size_and_order(free):
    """The yaw plane is stiffer (the foot is long across); all three estimators say so."""
    by_plane = {p.name: tilt_stiffness(*free, "main_bearing", p) for p in PLANES}
    for estimator, vertical in by_plane["vertical"].items():
        assert 0 < vertical < by_plane["horizontal"][estimator]
        assert vertical == pytest.approx(by_plane["vertical"]["averaged seat"], rel=0.6)
    # The housing's own points leave out the give of the ring, in either plane.
    for values in by_plane.values():
        assert 1.0 < values["four nodes"] / values["averaged seat"] < 3.0


def test_energy_estimator_scales_with_the_housing_modulus(bonded_model):
    """All materials twice as stiff: K_R doubles, by every estimator."""
    twice = {
        "materials": {
            "steel2": {"youngs_modulus": 400e9, "poisson_ratio": 0.3, "density": 7850},
            "iron2": {"youngs_modulus": 338e9, "poisson_ratio": 0.275, "density": 7100},
        },
        "shaft.material": "steel2",
        "bearing_units.0.bearing.material": "steel2",
        "bearing_units.0.housing.material": "iron2",
    }
    from fe_drivetrain.drivetrain_file.reading import change_scene

    found = []
    for changes in ({}, twice):
        scene = without_gearbox(change_scene(bonded_model.scene, changes))
        model = build_model(scene, bonded_model.mesh)
        found.append(tilt_stiffness(model, unit_load_response(model), "main_bearing", HORIZONTAL))
    for estimator in found[0]:
        assert found[1][estimator] == pytest.approx(2 * found[0][estimator], rel=1e-8)


def test_bearing_unit_matrix_is_symmetric_and_definite(free):
    K = bearing_unit_stiffness(free[1], "main_bearing")
    np.testing.assert_allclose(K, K.T)
    d = np.sqrt(K.diagonal())
    assert np.linalg.eigvalsh(K / np.outer(d, d)).min() > 0
    # Symmetry of the housing: vertical and horizontal planes do not mix.
    scaled = np.abs(K / np.outer(d, d))
    assert scaled[np.ix_([0, 2, 4], [1, 3, 5])].max() < 0.02


def test_bearing_unit_matrix_predicts_the_hub_motion_of_another_load(free):
    """The matrix comes from the rear of the shaft; it must give K_R of the averaged seat nearly."""
    K = bearing_unit_stiffness(free[1], "main_bearing")
    C = np.linalg.inv(K)
    for plane in PLANES:
        seat = tilt_stiffness(*free, "main_bearing", plane)["averaged seat"]
        assert 1.0 / C[plane.moment, plane.moment] == pytest.approx(seat, rel=0.1)


def test_spherical_unit_has_no_rotational_stiffness(spherical_responses):
    K = bearing_unit_stiffness(spherical_responses["sliding"][1], "main_bearing")
    assert np.abs(K[3:]).max() == 0.0
    assert np.linalg.eigvalsh(K[:3, :3]).min() > 0


@pytest.mark.parametrize("form", ["sliding", "averaged", "rigid"])
def test_spherical_unit_gives_the_seat_its_motion(spherical_responses, form):
    """Energy against motion: a pure force at the centre moves the seat by what the energy says."""
    response = spherical_responses[form][1]
    K = bearing_unit_stiffness(response, "main_bearing")[:3, :3]
    arm = response.positions["hub"] - response.positions["main_bearing"]
    load = np.vstack([np.eye(3), -np.cross(arm, np.eye(3)).T])
    reaction = response.reactions["main_bearing"][:, :6] @ load
    np.testing.assert_allclose(reaction[1:3, 1:], np.eye(3)[1:3, 1:], atol=1e-8)
    seat = (response.motions["main_bearing.seat"][:3, :6] @ load).diagonal()
    np.testing.assert_allclose(1.0 / seat, K.diagonal(), rtol=0.35)


def test_rigid_joint_is_the_stiffest(spherical_responses):
    """Along x and z the rigid form bounds the other two from above."""
    K = {
        form: bearing_unit_stiffness(response, "main_bearing").diagonal()
        for form, (_, response) in spherical_responses.items()
    }
    for axis in (0, 2):
        assert K["rigid"][axis] > K["sliding"][axis]
        assert K["rigid"][axis] > K["averaged"][axis]


def test_four_nodes_that_mislead_are_warned_of(free):
    """On the housing's outside they miss the give of ring and shell, in either plane."""
    for plane in PLANES:
        with pytest.warns(UserWarning, match=f"{plane.name} plane: four nodes .* above"):
            found = tilt_stiffness(*free, "main_bearing", plane)
        assert found["four nodes"] > 1.05 * found["averaged seat"]


def test_four_nodes_that_agree_are_not_warned_of(free, recwarn):
    """A response in which the line between the nodes turns as the seat does."""
    model, response = free
    turned = response.displacements.copy()
    upper, lower = (model.mesh.named_points[f"main_bearing.housing.{p}"] for p in VERTICAL.nodes)
    arm = np.linalg.norm(model.mesh.points[upper] - model.mesh.points[lower])
    seat = response.motions["main_bearing.seat"][VERTICAL.moment]
    turned[upper, 0] = turned[lower, 0] + arm * seat
    turned_response = dataclasses.replace(response, displacements=turned)
    found = tilt_stiffness(model, turned_response, "main_bearing", VERTICAL)
    assert found["four nodes"] == pytest.approx(found["averaged seat"])
    assert not recwarn.list
