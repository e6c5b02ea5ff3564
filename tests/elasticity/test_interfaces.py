"""Constraints as linear algebra: what each lets move, and that elimination keeps all of them."""

import numpy as np
import pytest
from scipy import sparse

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.elasticity.interfaces import constraints

CENTRE = np.array([0.1, -0.2, 0.3])


@pytest.fixture
def sphere(rng):
    """Two coincident sets of 60 nodes on a zone of a sphere, and weights of one side."""
    angle = rng.uniform(0, 2 * np.pi, 60)
    x = rng.uniform(-0.2, 0.2, 60)
    radius = np.sqrt(0.25 - x**2)
    zone = CENTRE + np.column_stack([x, radius * np.cos(angle), radius * np.sin(angle)])
    return np.vstack([zone, zone]), np.arange(60), np.arange(60, 120), rng.uniform(1, 2, 60)


def forms(sphere):
    points, inner, outer, weights = sphere
    n = points.size + 3 * 8
    w = constraints.centred_weights(weights, points[inner], CENTRE)
    groups = np.tile(np.arange(60) % 8, 2)
    return {
        "sliding": constraints.sliding_sphere("joint", inner, outer, points, CENTRE, n),
        "averaged": constraints.averaged_sphere(
            "joint", inner, outer, w, w, groups, points.size, n
        ),
    }, n


@pytest.mark.parametrize("form", ["sliding", "averaged"])
def test_elimination_fulfils_every_row(sphere, form, rng):
    joints, n = forms(sphere)
    elimination = constraints.eliminate([joints[form]], n)
    T = elimination.T
    q = rng.standard_normal(T.shape[1])
    assert elimination.free.sum() == n - len(joints[form].pivots)
    assert not elimination.free[joints[form].pivots].any()
    assert np.abs(joints[form].rows @ (T @ q)).max() < 1e-12 * np.abs(q).max()


def test_averaged_form_equals_its_dense_definition(sphere, rng):
    """Grouping is a matter of sparsity only: the means of both faces are equal, nothing else."""
    points, inner, outer, weights = sphere
    joints, n = forms(sphere)
    T = constraints.eliminate([joints["averaged"]], n).T
    u = (T @ rng.standard_normal(T.shape[1]))[: points.size].reshape(-1, 3)
    w = constraints.centred_weights(weights, points[inner], CENTRE)
    np.testing.assert_allclose(w @ u[inner], w @ u[outer], atol=1e-11)
    dense = np.zeros((3, points.size))
    for axis in range(3):
        dense[axis, 3 * inner + axis] = w / w.sum()
        dense[axis, 3 * outer + axis] = -w / w.sum()
    # Same dimension of what is left free: three rows over the nodes.
    nodal = (T.toarray())[: points.size]
    assert np.linalg.matrix_rank(nodal) == points.size - 3
    assert np.abs(dense @ nodal).max() < 1e-12


@pytest.mark.parametrize("form", ["sliding", "averaged"])
def test_sphere_turns_freely_about_its_centre_and_carries_translation(sphere, form):
    """The inner side turned as a rigid body, the outer at rest: allowed; moved: not allowed."""
    points, inner, _, weights = sphere
    joints, n = forms(sphere)
    rigid = np.zeros((n, 6))
    rigid[constraints.dofs(inner).ravel()] = rigid_motions(points[inner], CENTRE)
    if form == "averaged":  # its group sums follow the nodes: take the last rows, of the means
        w = constraints.centred_weights(weights, points[inner], CENTRE)
        mean = np.einsum("n,nik->ik", w / w.sum(), rigid[: 3 * 60].reshape(60, 3, 6))
        assert np.abs(mean[:, 3:]).max() < 1e-14
        assert np.linalg.matrix_rank(mean[:, :3]) == 3
    else:
        error = joints[form].rows @ rigid
        assert np.abs(error[:, 3:]).max() < 1e-14
        assert np.linalg.matrix_rank(error[:, :3]) == 3


def test_centred_weights_put_the_centroid_to_the_centre(sphere):
    points, inner, _, weights = sphere
    w = constraints.centred_weights(weights, points[inner], CENTRE)
    np.testing.assert_allclose(w @ (points[inner] - CENTRE), 0.0, atol=1e-12)
    assert np.abs(w / weights - 1).max() < 0.5


def test_averaged_point_recovers_a_rigid_motion_and_balances_its_load(rng):
    """RBE3: a rigid motion of the face is the point's motion; forces add up to the point's load."""
    points = rng.standard_normal((40, 3))
    position = np.array([0.5, 2.0, -1.0])
    point = constraints.averaged_point(
        "p", np.arange(40), rng.uniform(1, 2, 40), points, position, 120
    )
    np.testing.assert_allclose(
        point.motion @ rigid_motions(points, position), np.eye(6), atol=1e-12
    )
    load = rng.standard_normal(6)
    forces = (point.motion.T @ load).reshape(-1, 3)
    np.testing.assert_allclose(forces.sum(axis=0), load[:3], atol=1e-12)
    moment = np.cross(points - position, forces).sum(axis=0)
    np.testing.assert_allclose(moment, load[3:], atol=1e-12)


def test_rigid_face_moves_with_its_point(rng):
    points = rng.standard_normal((20, 3))
    point = constraints.rigid_point("p", CENTRE, 60, 66)
    face = constraints.rigid_face("p", np.arange(20), points, point)
    elimination = constraints.eliminate([face], 66)
    assert np.flatnonzero(elimination.free).tolist() == [60, 61, 62, 63, 64, 65]
    T = elimination.T.toarray()
    assert np.abs(T[:, :60]).max() == 0.0
    np.testing.assert_allclose(T[:60, 60:], rigid_motions(points, CENTRE), atol=1e-13)


def test_held_point_of_a_face_does_not_turn(rng):
    points = rng.standard_normal((20, 3))
    point = constraints.averaged_point("p", np.arange(20), np.ones(20), points, CENTRE, 60)
    T = constraints.eliminate([constraints.held("p", point, [3, 5])], 60).T
    motion = point.motion @ T.toarray()
    assert np.abs(motion[[3, 5]]).max() < 1e-12
    assert np.linalg.matrix_rank(motion) == 4


def test_multipliers_are_the_constraint_forces(rng):
    """Two springs in series between walls: the wall forces are known."""
    n = 3 * 3
    stiffness = np.zeros((n, n))
    for a, b, k in ((0, 3, 2.0), (3, 6, 3.0)):
        stiffness[np.ix_([a, b], [a, b])] += k * np.array([[1, -1], [-1, 1]])
    walls = [
        constraints.fixed("left", np.array([0]), n),
        constraints.fixed("right", np.array([2]), n),
    ]
    elimination = constraints.eliminate(walls, n)
    load = np.zeros((n, 1))
    load[3] = 10.0
    u = np.zeros((n, 1))
    u[3] = 10.0 / 5.0
    forces = elimination.multipliers(stiffness @ u - load)
    assert forces["left"][0, 0] == pytest.approx(-4.0)
    assert forces["right"][0, 0] == pytest.approx(-6.0)


def test_two_owners_of_one_face_are_refused():
    first = constraints.fixed("base", np.array([0, 1]), 9)
    second = constraints.fixed("rear", np.array([1, 2]), 9)
    with pytest.raises(InputError, match="'rear' and 'base' constrain the same nodes"):
        constraints.eliminate([first, second], 9)


def test_no_constraint_leaves_everything_free():
    T = constraints.eliminate([], 6).T
    assert abs(T - sparse.eye_array(6)).max() == 0.0
