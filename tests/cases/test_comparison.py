"""A model of the load on the bearing is a matrix and a constant: the same as its own formula."""

from collections.abc import Callable

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.shafts.beam import closed_forms
from fe_drivetrain.shafts.beam.of_scene import main_bearing_beam
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.unit_loads import Response
from fe_drivetrain.studies import Assembly, LinearModel

Beam = closed_forms.MainBearingBeam


@pytest.fixture
def loads(rng: np.random.Generator) -> np.ndarray:
    """Three histories of hub loads."""
    size = np.array([2e5, 1e4, 4e5, 1e6, 7e5, 1e5])
    return size * rng.standard_normal((3, 50, 6))


@pytest.fixture(scope="module")
def solved(bonded_model: Model, bonded_response: Response) -> Assembly:
    return Assembly(bonded_model, bonded_response)


@pytest.mark.parametrize("model", [closed_forms.pinned_model, closed_forms.torsional_spring_model])
def test_a_beam_is_its_closed_form(
    model: Callable[[np.ndarray, Beam], np.ndarray], loads: np.ndarray
) -> None:
    beam = main_bearing_beam(coarse_scene("bonded"), 145e6, 392e6)
    expected = model(loads, beam)
    found = LinearModel.of_beam(model, beam)
    scale = np.abs(expected).max()
    np.testing.assert_allclose(found.reaction(loads), expected, rtol=0, atol=1e-12 * scale)
    np.testing.assert_allclose(
        found.radial(loads),
        np.hypot(expected[..., 1], expected[..., 2]),
        rtol=0,
        atol=1e-12 * scale,
    )


def test_a_solid_is_its_response(solved: Assembly, loads: np.ndarray) -> None:
    weight = solved.scene.gearbox.weight
    assert weight > 0
    for gravity in (0.0, GRAVITY):
        expected = solved.response.history(solved.bearing, loads, weight, gravity)
        np.testing.assert_allclose(
            LinearModel.of_fe(solved.scene, solved.response, gravity).reaction(loads),
            expected,
            rtol=0,
            atol=1e-12 * np.abs(expected).max(),
        )


def test_loads_taken_out_or_moved_ahead_are_loads_changed(
    solved: Assembly, loads: np.ndarray
) -> None:
    model = LinearModel.of_fe(solved.scene, solved.response)
    for component in (0, 3):
        less = loads.copy()
        less[..., component] = 0.0
        np.testing.assert_allclose(
            model.without(component).reaction(loads), model.reaction(less), rtol=1e-12, atol=1e-6
        )
    # A force in front of the hub is the same force at the hub and the moment of its arm,
    # which points upwind: r x F with r = (-arm, 0, 0).
    arm = 0.05
    moved = loads.copy()
    moved[..., 3:] += np.cross([-arm, 0.0, 0.0], loads[..., :3])
    np.testing.assert_allclose(
        model.ahead(arm).reaction(loads), model.reaction(moved), rtol=1e-12, atol=1e-6
    )
