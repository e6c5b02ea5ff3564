"""Constraints eliminated in place, and what multigrid is told, against dense algebra."""

import numpy as np
import pytest

from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.elasticity.interfaces.constraints import eliminate
from fe_drivetrain.elasticity.mesh.bodies import connected_bodies
from fe_drivetrain.elasticity.solve.reduction import reduce, reduced_stiffness

FORMS = ("sliding", "averaged", "rigid")


@pytest.fixture(scope="module", params=[*FORMS, "bonded"])
def reduced(request, spherical_responses, bonded_model):
    model = bonded_model if request.param == "bonded" else spherical_responses[request.param][0]
    elimination = eliminate(model.constraints, model.n_dofs)
    K = model.stiffness
    return model, K, elimination, reduce(model.mesh.points, model.mesh.cells, K, elimination)


def test_equals_the_triple_product_on_what_is_left(reduced, rng):
    model, K, elimination, system = reduced
    T, free = elimination.T, elimination.free
    q = rng.standard_normal((len(free), 3)) * free[:, None]
    expected = T.T @ (K @ (T @ q))
    np.testing.assert_allclose(system.K @ q, expected, atol=1e-12 * np.abs(expected).max())
    assert system.n_free == free.sum() < model.n_dofs


def test_indices_are_those_that_loops_are_compiled_for(reduced):
    """Others compile every loop of the solvers once more, and fetch twice the indices."""
    _, K, elimination, system = reduced
    for reduced_matrix in (system.K, reduced_stiffness(K, elimination)):
        assert reduced_matrix.indices.dtype == reduced_matrix.indptr.dtype == np.int32


def test_eliminated_degrees_of_freedom_stand_alone(reduced):
    _, K, elimination, system = reduced
    gone = np.flatnonzero(~elimination.free)
    rows = system.K.tocsr()[gone]
    rows.eliminate_zeros()
    assert rows.nnz == len(gone)
    np.testing.assert_allclose(rows.data, K.diagonal().mean(), rtol=1e-12)
    before = K.copy()
    reduced_stiffness(K, elimination)
    assert abs(K - before).max() == 0.0


def test_a_system_in_place_of_its_stiffness_is_the_same(reduced):
    model, K, elimination, system = reduced
    mine = K.copy()
    again = reduce(model.mesh.points, model.mesh.cells, mine, elimination, overwrite=True)
    assert abs(again.K - system.K).max() == 0.0
    assert (again.prolongation is None) == (system.prolongation is None)
    means = any(constraint.is_mean for constraint in elimination.constraints)
    assert (abs(mine - K).max() == 0.0) == means  # whose joints are taken apart from K


def test_indices_are_what_loops_are_compiled_for_whatever_springs_leave(reduced):
    model, K, elimination, _ = reduced
    wide = K.copy()
    wide.indices, wide.indptr = wide.indices.astype(np.int64), wide.indptr.astype(np.int64)
    system = reduce(model.mesh.points, model.mesh.cells, wide, elimination)
    assert system.K.indices.dtype == system.K.indptr.dtype == np.int32
    assert abs(system.K - reduced_stiffness(K, elimination)).max() == 0.0


def test_prolonged_fields_fulfil_the_constraints(reduced, rng):
    _, _, elimination, system = reduced
    coarse = rng.standard_normal(system.prolongation.shape[1])
    u = elimination.T @ (system.prolongation @ coarse)
    for constraint in elimination.constraints:
        size = abs(constraint.rows).sum(axis=1).max() * np.abs(u).max()
        assert np.abs(constraint.rows @ u).max() < 1e-12 * size


def test_prolongation_is_linear_interpolation_away_from_constraints(reduced):
    """A linear field at the corners comes out linear on straight elements."""
    model, _, elimination, system = reduced
    points, cells = model.mesh.points, model.mesh.cells
    corner = np.unique(cells[:, :4])
    linear = points @ np.array([[1.0, 2.0, 3.0], [0.5, -1.0, 0.0], [0.0, 4.0, 1.0]])
    coarse = np.zeros(system.prolongation.shape[1])
    coarse[: 3 * len(corner)] = linear[corner].ravel()
    fine = (system.prolongation @ coarse)[: points.size].reshape(-1, 3)
    untouched = elimination.free[: points.size].reshape(-1, 3).all(axis=1)
    touched = ~untouched
    edges = np.array([(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)])
    ends, middle = cells[:, edges].reshape(-1, 2), cells[:, 4:].ravel()
    straight = np.abs(points[ends].mean(axis=1) - points[middle]).max(axis=1) < 1e-12
    chosen = straight & untouched[middle] & ~touched[ends].any(axis=1)
    assert chosen.sum() > 1000
    np.testing.assert_allclose(fine[middle[chosen]], linear[middle[chosen]], atol=1e-12)


def test_near_nullspace_of_free_bodies_costs_no_energy(bonded_model):
    """Without supports and springs the rigid motions are exactly the null space."""
    model = bonded_model
    K = sum(model.part_stiffness.values())
    system = reduce(model.mesh.points, model.mesh.cells, K, eliminate([], model.n_dofs))
    motions = system.prolongation @ system.near_nullspace
    expected = rigid_motions(model.mesh.points, model.mesh.points.mean(axis=0))
    edge = np.abs(motions - expected).max(axis=1)
    corner = np.unique(model.mesh.cells[:, :4])
    assert edge.reshape(-1, 3)[corner].max() < 1e-12
    # Curved edges are as far from the linear elements' as their middles are off: the sagitta of an
    # eighth of the largest circle, times a unit rotation.
    radius = np.hypot(*(model.mesh.points[model.mesh.face_nodes("main_bearing.outer")].T[1:])).max()
    assert edge.max() < 1.01 * radius * (1 - np.cos(np.pi / 8))


def test_bodies_are_parts_that_share_nodes(spherical_mesh, bonded_model):
    assert connected_bodies(spherical_mesh.cells, len(spherical_mesh.points)).max() == 1
    mesh = bonded_model.mesh
    assert connected_bodies(mesh.cells, len(mesh.points)).max() == 0


def test_bodies_are_numbered_by_their_first_node():
    """Node 0 in the middle of an edge of the second cell, node 7 in no cell."""
    cells = np.array([[1, 2, 3, 4, 5, 6, 8, 9, 10, 11], [12, 13, 14, 15, 0, 16, 17, 18, 19, 20]])
    body = connected_bodies(cells, 21)
    assert set(body[cells[1]]) == {0}
    assert set(body[cells[0]]) == {1}
    assert body[7] == 2
