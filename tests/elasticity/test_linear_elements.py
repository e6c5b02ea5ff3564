"""The way from linear elements to quadratic ones is that of sparse matrices, entry by entry."""

import numpy as np
import pytest
from scipy import sparse

from fe_drivetrain.elasticity.interfaces.constraints import eliminate, fixed, held_dofs
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.mesh.shapes import element_kind
from fe_drivetrain.elasticity.solve.linear_elements import from_linear


def plain(cells, n_nodes, T, free):
    """Weights of corners in all directions, then constraints, by products of sparse matrices."""
    kind = element_kind(cells.shape[1])
    corner = np.unique(cells[:, : kind.n_corners])
    weights = np.zeros((n_nodes, len(corner)))
    for cell in cells:
        weights[cell[:, None], np.searchsorted(corner, cell[: kind.n_corners])] = (
            kind.corner_weights()
        )
    n = len(free)
    others = np.eye(n - 3 * n_nodes)
    spread = sparse.block_diag([np.kron(weights, np.eye(3)), others], format="csr")
    columns = np.append((3 * corner[:, None] + np.arange(3)).ravel(), np.arange(3 * n_nodes, n))
    # of a matrix of constraints, columns of those that are gone are empty, and its rows lead on
    rows = (spread @ T[columns][:, columns]).toarray() * free[:, None]
    rows[columns, np.arange(len(columns))] = 1.0
    return rows, columns


@pytest.mark.parametrize("k", [10, 20, 27])
@pytest.mark.parametrize("points", [0, 2])
def test_supports_leave_weights_of_corners_between_what_is_free(k, points) -> None:
    """All of a face is held, and one direction of some nodes, corners and others."""
    block = brick((2, 3, 2), k, lambda p: p)
    n_nodes = len(block.points)
    n = 3 * n_nodes + 6 * points
    some = np.arange(1, 3 * n_nodes, 7)
    wall = block.face_nodes("x0")
    held = [fixed("wall", wall, n), held_dofs("some", some[~np.isin(some // 3, wall)], n)]
    elimination = eliminate(held, n)
    found, columns = from_linear(block.cells, n_nodes, elimination.T, elimination.free)
    rows, wanted = plain(block.cells, n_nodes, elimination.T, elimination.free)
    assert (columns == wanted).all()
    assert (found.toarray() == rows).all()
    assert found.indices.dtype == found.indptr.dtype == np.int32
    assert found.nnz == np.count_nonzero(rows)


def test_corners_that_follow_others_lead_to_them(spherical_responses) -> None:
    model = spherical_responses["rigid"][0]
    elimination = eliminate(model.constraints, model.n_dofs)
    cells, n_nodes = model.mesh.cells, len(model.mesh.points)
    assert elimination.T.nnz > np.count_nonzero(elimination.free)
    found, columns = from_linear(cells, n_nodes, elimination.T, elimination.free)
    corner = np.unique(cells[:, :4])
    assert (columns[: 3 * len(corner)] == (3 * corner[:, None] + np.arange(3)).ravel()).all()
    rng = np.random.default_rng(0)
    x = rng.standard_normal(len(columns)) * elimination.free[columns]
    moved = np.zeros(len(elimination.free))
    moved[columns] = elimination.T[columns][:, columns] @ x
    middles = np.setdiff1d(np.arange(n_nodes), corner)[::50]
    for node in middles:
        cell, place = np.argwhere(cells == node)[0]
        own = cells[cell, :4]
        expected = element_kind(10).corner_weights()[place] @ moved.reshape(-1, 3)[own]
        free = elimination.free[3 * node : 3 * node + 3]
        got = (found @ x)[3 * node : 3 * node + 3]
        np.testing.assert_allclose(got, expected * free, atol=1e-12)
    assert found.indices.dtype == np.int32
