"""Secant stiffness over load cases: exact where a spring is a spring, named where it is not."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import stiffness_transport
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.shafts.beam import shaft
from fe_drivetrain.shafts.beam.of_scene import beam_of_scene
from fe_drivetrain.shafts.response.secant_stiffness import (
    elastic_centre,
    fitted_spring,
    moved,
    parts_of,
    secant,
    statement,
)

DIAGONAL = np.array([2e9, 3e9, 5e9, 4e8, 6e8, 9e8])


def spring(coupling):
    """A 6x6 spring whose thrust tilts, as a share of the root of both diagonals."""
    K = np.diag(DIAGONAL)
    K[0, 4] = K[4, 0] = coupling * np.sqrt(K[0, 0] * K[4, 4])
    return K


def some(seed, m, size=(1e-4, 1e-4, 1e-4, 1e-3, 1e-3, 1e-3)):
    return np.random.default_rng(seed).normal(size=(m, 6)) * size


def on_a_beam(K):
    """Loads and motions of the bearing of a shaft on that spring, under random hub loads."""
    scene = library_scene("main_bearing_bonded")
    beam = beam_of_scene(scene, {"main_bearing": K})
    unit = shaft.unit_load_response(beam, [scene.shaft.front, scene.shaft.rear], at=0.0)
    loads = np.zeros((50, 2, 6))
    loads[:, 0] = some(1, 50, (3e5, 1e4, 4e5, 1e6, 1e6, 1e6))
    loads[:, 1, 2] = -scene.gearbox.weight
    found = unit.solution(loads)
    return found.reaction("main_bearing"), found.displacements


@pytest.mark.parametrize("component", [3, 4, 5])
def test_a_diagonal_spring_on_a_beam_has_one_secant(component):
    """The statics of the shaft mix everything, but the spring stays one number."""
    loads, motions = on_a_beam(np.diag(DIAGONAL))
    found = secant(loads, motions, component)
    assert found.stiffness == pytest.approx(DIAGONAL[component], rel=1e-9)
    assert found.scatter < 1e-9
    kept = found.secants[np.isfinite(found.secants)]
    np.testing.assert_allclose(kept, DIAGONAL[component], rtol=1e-7)
    assert "right form" in statement(found, parts_of(loads, motions, np.diag(DIAGONAL), component))


def test_a_coupled_spring_is_fitted_back_and_its_coupling_named():
    K = spring(0.4)
    loads, motions = on_a_beam(K)
    fit = fitted_spring(loads, motions)
    size = np.sqrt(np.outer(DIAGONAL, DIAGONAL))
    np.testing.assert_allclose(fit.matrix / size, K / size, atol=1e-6)
    assert fit.motions == 6
    assert fit.unexplained.max() < 1e-9
    assert fit.asymmetry < 1e-6
    found, parts = secant(loads, motions, 4), parts_of(loads, motions, fit.matrix, 4)
    assert found.scatter > 0.01
    assert parts.breaker == 0
    assert parts.shares[0] == pytest.approx(1.0, abs=1e-6)
    assert "My also follows Fx (thrust leans the housing over its base)" in statement(found, parts)
    # the other axis is not coupled
    assert secant(loads, motions, 5).scatter < 1e-9


def test_the_stiffness_is_the_mean_of_secants_weighted_by_squared_rotation():
    motions = some(2, 40)
    loads = motions @ spring(0.3)
    found = secant(loads, motions, 4)
    k, weight = loads[:, 4] / motions[:, 4], motions[:, 4] ** 2
    mean = np.average(k, weights=weight)
    assert found.stiffness == pytest.approx(mean, rel=1e-12)
    spread = np.sqrt(np.average((k - mean) ** 2, weights=weight))
    assert found.scatter == pytest.approx(spread / mean, rel=1e-12)


def test_the_secant_does_not_depend_on_the_size_of_a_load():
    motions = some(3, 30)
    loads = motions @ spring(0.3)
    once, tenfold = secant(loads, motions, 4), secant(10 * loads, 10 * motions, 4)
    assert tenfold.stiffness == pytest.approx(once.stiffness, rel=1e-13)
    assert tenfold.scatter == pytest.approx(once.scatter, rel=1e-13)


def test_cases_that_hardly_turn_the_bearing_have_no_secant():
    motions = some(4, 30)
    motions[7, 4] = 0.0
    found = secant(motions @ spring(0.3), motions, 4)
    assert np.isnan(found.secants[7])
    assert np.isfinite(found.stiffness)


def test_a_bearing_that_never_turns_is_refused():
    with pytest.raises(InputError, match="no load case turns the bearing"):
        secant(np.ones((3, 6)), np.zeros((3, 6)), 4)


def test_shares_of_several_couplings_sum_to_one():
    rng = np.random.default_rng(5)
    K = rng.normal(size=(6, 6))
    K = K @ K.T + 6 * np.eye(6)
    motions = rng.normal(size=(60, 6))
    loads = motions @ K + 0.1 * rng.normal(size=(60, 6))
    for component in (3, 4, 5):
        parts = parts_of(loads, motions, K, component)
        assert parts.shares.sum() == pytest.approx(1.0, rel=1e-12)
        # its own rotation scatters nothing
        assert parts.shares[component] == pytest.approx(0.0, abs=1e-12)


def test_the_arms_are_what_a_load_adds_at_equal_rotation():
    """Load the spring by each force alone, with the moment that holds the rotation at zero."""
    rng = np.random.default_rng(13)
    K = rng.normal(size=(6, 6))
    K = K @ K.T + 6 * np.eye(6)
    motions = rng.normal(size=(30, 6))
    arms = parts_of(motions @ K, motions, K, 4).arms
    others = [0, 1, 2, 3, 5]
    for j in others:
        held = np.zeros(6)
        load = np.eye(6)[j]
        held[others] = np.linalg.solve(K[np.ix_(others, others)], load[others])
        assert (K @ held)[4] == pytest.approx(arms[j], rel=1e-10)


def test_the_arm_of_thrust_is_the_elastic_centre():
    motions = some(14, 20)
    K = spring(-0.4)
    assert parts_of(motions @ K, motions, K, 4).arms[0] == pytest.approx(elastic_centre(K))


def test_a_spherical_joint_has_no_couplings_of_moments():
    with pytest.raises(InputError, match="holds all six motions"):
        parts_of(np.ones((3, 6)), np.ones((3, 6)), np.diag([1.0, 1, 1, 0, 0, 0]), 4)


def test_a_coupling_in_proportion_to_the_rotation_breaks_nothing():
    """Where ux is tied to theta, the secant is another number, but one."""
    motions = some(6, 20)
    motions[:, 0] = 0.2 * motions[:, 4]
    K = spring(0.4)
    found = secant(motions @ K, motions, 4)
    assert found.scatter < 1e-13
    assert found.stiffness == pytest.approx(K[4, 4] + 0.2 * K[4, 0], rel=1e-12)


def test_what_no_motion_explains_is_said_so():
    motions = some(7, 50)
    K = np.diag(DIAGONAL)
    loads = motions @ K
    loads[:, 4] += 0.2 * np.random.default_rng(8).normal(size=50) * loads[:, 4].std()
    text = statement(secant(loads, motions, 4), parts_of(loads, motions, K, 4))
    assert "no load on the bearing explains" in text


def test_fewer_than_six_motions_are_counted():
    motions = some(9, 30)
    motions[:, 1] = 0.0
    motions[:, 5] = 2.0 * motions[:, 4]
    fit = fitted_spring(motions @ spring(0.3), motions)
    assert fit.motions == 4
    assert fit.unexplained.max() < 1e-12


def test_at_the_elastic_centre_thrust_does_not_tilt():
    K = spring(-0.4)
    z = elastic_centre(K)
    assert z < 0.0
    motions = some(10, 40)
    loads = motions @ K
    assert secant(loads, motions, 4).scatter > 0.01
    assert secant(*moved(loads, motions, np.array([0.0, 0.0, z])), 4).scatter < 1e-12
    # and the spring that stands there is diagonal in that plane
    there = stiffness_transport(K, np.array([0.0, 0.0, -z]))
    assert abs(there[0, 4]) < 1e-6 * np.sqrt(there[0, 0] * there[4, 4])
    np.testing.assert_allclose(stiffness_transport(there, np.array([0.0, 0.0, z])), K, atol=1e-3)


def test_work_is_the_same_at_another_point():
    motions = some(11, 12)
    loads = some(12, 12, (1e5,) * 6)
    there = moved(loads, motions, np.array([0.3, -0.2, 0.5]))
    np.testing.assert_allclose((there[0] * there[1]).sum(1), (loads * motions).sum(1), rtol=1e-10)


def test_cases_count_by_their_time_and_not_by_how_finely_they_are_sampled():
    """Half the samples twice, at half their weight each, are the same history."""
    K = spring(0.4)
    loads, motions = on_a_beam(K)
    loads = loads + 1e3 * some(7, 50, np.ones(6))  # what no spring explains
    again = np.r_[np.arange(50), np.arange(20)]
    weights = np.r_[np.full(20, 0.5), np.ones(30), np.full(20, 0.5)] / 50
    once, twice = (
        (secant(R, u, 4, w), fitted_spring(R, u, w), parts_of(R, u, K, 4, w))
        for R, u, w in ((loads, motions, None), (loads[again], motions[again], weights))
    )
    assert twice[0].stiffness == pytest.approx(once[0].stiffness, rel=1e-12)
    assert twice[0].scatter == pytest.approx(once[0].scatter, rel=1e-9)
    np.testing.assert_array_equal(twice[0].secants[:50], once[0].secants)
    np.testing.assert_allclose(twice[1].matrix, once[1].matrix, rtol=1e-6, atol=1e2)
    np.testing.assert_allclose(twice[1].unexplained, once[1].unexplained, rtol=1e-9)
    np.testing.assert_allclose(twice[2].shares, once[2].shares, atol=1e-9)
    np.testing.assert_allclose(twice[2].sizes, once[2].sizes, rtol=1e-9)
    # without weights, they would not be
    assert secant(loads[again], motions[again], 4).stiffness != pytest.approx(
        once[0].stiffness, rel=1e-6
    )
