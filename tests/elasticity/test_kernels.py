"""Loops over node blocks give what dense matrices give, in both precisions, for any columns."""

import numpy as np
import pytest
from scipy import sparse

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.elasticity.operator import kernels
from fe_drivetrain.elasticity.solve.reduction import in_blocks

NODES = 70


@pytest.fixture(scope="module")
def matrix() -> sparse.bsr_array:
    """Blocks that are not symmetric, rows of 1 to 30 blocks, and a node without any."""
    rng = np.random.default_rng(3)
    there = rng.random((NODES, NODES)) < np.linspace(0.02, 0.4, NODES)[:, None]
    np.fill_diagonal(there, True)
    there[7] = False
    indptr = np.concatenate([[0], np.cumsum(there.sum(axis=1))]).astype(np.int32)
    indices = np.nonzero(there)[1].astype(np.int32)
    data = rng.standard_normal((len(indices), 3, 3))
    return sparse.bsr_array((data, indices, indptr), shape=(3 * NODES, 3 * NODES))


def rounded(matrix: sparse.bsr_array, kind: type) -> sparse.bsr_array:
    """The same with entries that a kind of number holds."""
    data = matrix.data.astype(kind).astype(float)
    return sparse.bsr_array((data, matrix.indices, matrix.indptr), shape=matrix.shape)


def blocks(matrix: sparse.bsr_array, kind: type) -> Floats:
    out = np.empty(matrix.data.shape, kind)
    kernels.rounded(matrix.data, out)
    return out


def vectors(columns: int, count: int) -> list[Floats]:
    rng = np.random.default_rng(columns)
    return [rng.standard_normal((3 * NODES, columns)) for _ in range(count)]


@pytest.mark.parametrize("columns", [1, 2, 4, 7])
@pytest.mark.parametrize("kind", [np.float64, np.float32])
def test_a_residual_is_what_it_says(matrix, columns, kind) -> None:
    X, B = vectors(columns, 2)
    data = blocks(matrix, kind)
    out = np.full_like(B, np.nan)
    kernels.residual(matrix.indptr, matrix.indices, data, X, B, out)
    np.testing.assert_allclose(out, B - rounded(matrix, kind).toarray() @ X, atol=1e-12)


@pytest.mark.parametrize("columns", [1, 5])
@pytest.mark.parametrize("kind", [np.float64, np.float32])
def test_a_step_of_the_smoother_is_what_it_says(matrix, columns, kind) -> None:
    X, B, D = vectors(columns, 3)
    inverse = np.random.default_rng(1).standard_normal((NODES, 3, 3))
    before, out = D.copy(), np.full_like(X, np.nan)
    data = blocks(matrix, kind)
    kernels.chebyshev_step(matrix.indptr, matrix.indices, data, inverse, X, B, D, out, 0.3, 0.7)
    left = B - rounded(matrix, kind).toarray() @ X
    change = 0.3 * before + 0.7 * np.einsum(
        "nij,njm->nim", inverse, left.reshape(NODES, 3, -1)
    ).reshape(B.shape)
    np.testing.assert_allclose(D, change, atol=1e-12)
    np.testing.assert_allclose(out, X + change, atol=1e-12)


@pytest.mark.parametrize("columns", [1, 5])
def test_a_first_step_needs_no_change_before_it(matrix, columns) -> None:
    X, B = vectors(columns, 2)
    inverse, data = np.ones((NODES, 3, 3)), blocks(matrix, np.float64)
    found = []
    for D in (np.zeros_like(X), np.full_like(X, np.nan)):
        out = np.empty_like(X)
        kernels.chebyshev_step(matrix.indptr, matrix.indices, data, inverse, X, B, D, out, 0.0, 0.7)
        found.append(out)
    assert (found[0] == found[1]).all()


@pytest.mark.parametrize("columns", [1, 6])
def test_products_of_columns_are_what_they_say(columns) -> None:
    A, B = vectors(columns, 2)
    np.testing.assert_allclose(kernels.dots(A, B), (A * B).sum(axis=0), rtol=1e-12)


@pytest.mark.parametrize("columns", [1, 3])
def test_products_add_to_what_is_there(matrix, columns) -> None:
    X, Y = vectors(columns, 2)
    A = matrix.tocsr()[:90]
    A = sparse.csr_array((A.data, A.indices.astype(np.int32), A.indptr.astype(np.int32)), A.shape)
    out = Y[:90].copy()
    kernels.add_product(A, X, out)
    np.testing.assert_allclose(out, Y[:90] + A.toarray() @ X, atol=1e-12)


@pytest.mark.parametrize("integers", [np.int32, np.int64])
@pytest.mark.parametrize("order", ["C", "F"])
def test_a_product_takes_any_indices_and_any_order(matrix, integers, order) -> None:
    (X,) = vectors(4, 1)
    pattern = matrix.indices.astype(integers), matrix.indptr.astype(integers)
    K = sparse.bsr_array((matrix.data, *pattern), shape=matrix.shape)
    found = kernels.product(K, np.asarray(X, order=order))
    np.testing.assert_allclose(found, matrix.toarray() @ X, atol=1e-12)


def test_rows_and_columns_that_are_not_kept_are_zero(matrix) -> None:
    kept = np.random.default_rng(2).random((NODES, 3)) < 0.7
    kept[::3] = True
    matrix = in_blocks(matrix + matrix.T)  # others have no symmetric pattern
    out = np.full_like(matrix.data, np.nan)
    kernels.kept_blocks(matrix.indptr, matrix.indices, matrix.data, kept, out)
    found = sparse.bsr_array((out, matrix.indices, matrix.indptr), shape=matrix.shape)
    mask = kept.ravel()
    assert (found.toarray() == mask[:, None] * matrix.toarray() * mask).all()
