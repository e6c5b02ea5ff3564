"""Spatial algebra against vector products, work and stored energy."""

import numpy as np
import pytest

from fe_drivetrain.common.spatial import (
    along_x,
    point_motions,
    resultant,
    rigid_motions,
    stiffness_transport,
    wrench_transport,
)


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(1)


def test_transport_keeps_the_moment_about_any_point_and_the_work(rng):
    wrench, motion, arm = rng.normal(size=6), rng.normal(size=6), rng.normal(size=3)
    T = wrench_transport(arm)
    there = T @ wrench
    np.testing.assert_allclose(there[:3], wrench[:3], rtol=1e-15)
    np.testing.assert_allclose(there[3:], wrench[3:] + np.cross(arm, wrench[:3]), rtol=1e-14)
    far = T.T @ motion
    np.testing.assert_allclose(far[:3], motion[:3] + np.cross(motion[3:], arm), rtol=1e-14)
    np.testing.assert_array_equal(far[3:], motion[3:])
    assert wrench @ far == pytest.approx(there @ motion, rel=1e-14)


def test_transports_in_a_row_add_their_arms_and_the_way_back_is_the_inverse(rng):
    a, b = rng.normal(size=(2, 3))
    np.testing.assert_allclose(
        wrench_transport(a) @ wrench_transport(b), wrench_transport(a + b), atol=1e-15
    )
    np.testing.assert_array_equal(wrench_transport(a) @ wrench_transport(-a), np.eye(6))


def test_many_arms_at_once_are_each_as_alone(rng):
    arms = rng.normal(size=(2, 4, 3))
    T = wrench_transport(arms)
    for k in np.ndindex(2, 4):
        np.testing.assert_array_equal(T[k], wrench_transport(arms[k]))
    np.testing.assert_array_equal(along_x(arms[..., 0])[..., 1:], 0.0)
    np.testing.assert_array_equal(along_x(0.7), [0.7, 0.0, 0.0])


def test_a_spring_stores_the_same_energy_seen_from_another_point(rng):
    K, motion, arm = rng.normal(size=(6, 6)), rng.normal(size=6), rng.normal(size=3)
    K = K @ K.T
    own = wrench_transport(arm).T @ motion
    assert motion @ stiffness_transport(K, arm) @ motion == pytest.approx(own @ K @ own, rel=1e-13)


def test_rigid_motions_are_those_of_the_transport_and_turn_about_their_centre(rng):
    points, centre = rng.normal(size=(5, 3)), rng.normal(size=3)
    nodes, both = rigid_motions(points, centre), point_motions(points, centre)
    for k, point in enumerate(points):
        np.testing.assert_array_equal(both[6 * k : 6 * k + 6], wrench_transport(point - centre).T)
        np.testing.assert_array_equal(nodes[3 * k : 3 * k + 3], both[6 * k : 6 * k + 3])
        for axis in range(3):
            turned = np.cross(np.eye(3)[axis], point - centre)
            np.testing.assert_array_equal(nodes[3 * k : 3 * k + 3, 3 + axis], turned)
    np.testing.assert_array_equal(rigid_motions(centre[None], centre)[:, 3:], 0.0)
    np.testing.assert_array_equal(rigid_motions(points), rigid_motions(points, np.zeros(3)))


def test_a_resultant_is_the_sum_of_transported_forces(rng):
    points, forces, centre = rng.normal(size=(5, 3)), rng.normal(size=(5, 3, 2)), rng.normal(size=3)
    found = resultant(points, forces, centre)
    expected = rigid_motions(points, centre).T @ forces.reshape(15, 2)
    np.testing.assert_allclose(found, expected, rtol=1e-13, atol=1e-14)
