"""Elimination by fronts against dense algebra."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.revolution.element_order import JOIN, dissection
from fe_drivetrain.elasticity.revolution.frontal import condensed, element_matrices, factored


def grid(across, along):
    """Quadrilaterals of 4 nodes, their centres, and the number of nodes."""
    i, j = (a.ravel() for a in np.indices((along, across)))
    first = i * (across + 1) + j
    cells = np.column_stack([first, first + across + 1, first + across + 2, first + 1])
    return cells, np.column_stack([i + 0.5, 0.3 * (j + 0.5)]), (across + 1) * (along + 1)


@pytest.mark.parametrize(("across", "along"), [(1, 1), (1, 7), (3, 5), (6, 2)])
def test_every_element_is_taken_once_and_all_are_joined(across, along):
    cells, centres, _ = grid(across, along)
    order = dissection(centres)
    assert sorted(order[order != JOIN]) == list(range(len(cells)))
    held = np.cumsum(np.where(order == JOIN, -1, 1))
    assert held.min() >= 1
    assert held[-1] == 1


@pytest.mark.parametrize(("across", "along"), [(1, 1), (1, 7), (3, 5), (6, 2)])
def test_condensed_is_the_schur_complement(across, along):
    """Random laws and shares, nodes held at zero, nodes that follow one kept degree of freedom."""
    rng = np.random.default_rng(across + 10 * along)
    cells, centres, nodes = grid(across, along)
    k, s, m = 2, 3, 4
    grams = rng.standard_normal((len(cells), 5 * m, s * m))
    grams = np.einsum("eqi,eqj->eij", grams, grams)
    half = rng.standard_normal((6, k, s))
    law = np.einsum("aps,aqt->pqst", half, half)
    matrices = element_matrices(grams, law)
    direct = np.einsum("pqst,esitj->epiqj", law, grams.reshape(-1, s, m, s, m))
    np.testing.assert_allclose(matrices, direct.reshape(matrices.shape), rtol=1e-12)
    np.testing.assert_allclose(matrices, matrices.transpose(0, 2, 1), rtol=1e-12)

    kept = 3
    target = kept + np.arange(k * nodes).reshape(k, nodes)
    share = rng.uniform(0.5, 2.0, (k, nodes))
    target[0, : across + 1], target[1, :1], target[1, -2:] = 0, 1, 2
    target[0, -1] = -1
    ids, shares = (a[:, cells].transpose(1, 0, 2).reshape(len(cells), -1) for a in (target, share))
    found = condensed(grams, law, ids, shares, kept, dissection(centres))

    size = kept + k * nodes
    K = np.zeros((size + 1, size + 1))
    for rows, shared, matrix in zip(ids, shares, matrices, strict=True):
        np.add.at(K, (rows[:, None], rows), matrix * np.outer(shared, shared))
    K = K[:size, :size]
    used = np.flatnonzero(K.diagonal() > 0)
    K = K[np.ix_(used, used)]
    schur = K[:3, :3] - K[:3, 3:] @ np.linalg.solve(K[3:, 3:], K[3:, :3])
    scale = np.sqrt(K.diagonal()[:3])
    np.testing.assert_allclose(
        found / scale / scale[:, None], schur / scale / scale[:, None], atol=1e-9
    )
    np.testing.assert_array_equal(found, found.T)


@pytest.mark.parametrize(("across", "along"), [(1, 1), (1, 7), (3, 5), (6, 9)])
def test_a_factor_solves_the_assembled_system(across, along):
    """Random laws and shares, one dof held at zero, two that follow one, one of no element."""
    rng = np.random.default_rng(across + 10 * along)
    cells, centres, nodes = grid(across, along)
    k, s, m = 3, 3, 4
    grams = rng.standard_normal((len(cells), 5 * m, s * m))
    grams = np.einsum("eqi,eqj->eij", grams, grams)
    half = rng.standard_normal((9, k, s))
    law = np.einsum("aps,aqt->pqst", half, half)
    target = np.arange(k * nodes).reshape(k, nodes)
    share = rng.uniform(0.5, 2.0, (k, nodes))
    target[0, 0], target[1, -1] = -1, target[0, -1]
    ids, shares = (a[:, cells].transpose(1, 0, 2).reshape(len(cells), -1) for a in (target, share))
    K = np.zeros((k * nodes + 1, k * nodes + 1))
    for rows, shared, matrix in zip(ids, shares, element_matrices(grams, law), strict=True):
        np.add.at(K, (rows[:, None], rows), matrix * np.outer(shared, shared))
    K = K[:-1, :-1]
    loads = rng.standard_normal((len(K), 4))
    found = factored(grams, law, ids, shares, dissection(centres)).solve(loads)
    used = np.flatnonzero(K.diagonal() > 0)
    expected = np.zeros_like(loads)
    expected[used] = np.linalg.solve(K[np.ix_(used, used)], loads[used])
    assert len(used) == k * nodes - 2
    np.testing.assert_allclose(found, expected, atol=1e-8 * np.abs(expected).max())


def test_what_has_no_stiffness_is_refused():
    cells, centres, _ = grid(1, 3)
    grams = np.zeros((len(cells), 4, 4))
    grams[:2] = np.eye(4)
    ids = 1 + cells
    ids[0, 0] = 0
    with pytest.raises(InputError, match="can move without strain"):
        condensed(grams, np.ones((1, 1, 1, 1)), ids, np.ones(ids.shape), 1, dissection(centres))
