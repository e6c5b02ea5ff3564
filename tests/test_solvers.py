"""Direct solves of systems whose answer is known."""

import importlib.util

import numpy as np
import pytest
from scipy import sparse

from fe_drivetrain.errors import InputError
from fe_drivetrain.solvers import solve

METHODS = [
    "superlu",
    pytest.param(
        "pardiso",
        marks=pytest.mark.skipif(
            importlib.util.find_spec("pypardiso") is None, reason="pypardiso is not installed"
        ),
    ),
]


@pytest.fixture
def laplacian():
    """Five-point Laplacian of a 30 x 30 grid: symmetric positive definite."""
    one = sparse.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(30, 30))
    eye = sparse.eye_array(30)
    return (sparse.kron(one, eye) + sparse.kron(eye, one)).tocsr()


@pytest.mark.parametrize("method", METHODS)
def test_recovers_a_known_solution(laplacian, method, rng):
    x = rng.standard_normal((900, 3))
    solution = solve(laplacian, laplacian @ x, method)
    np.testing.assert_allclose(solution.x, x, rtol=1e-10)
    assert solution.method == method
    assert solution.residual < 1e-12


def test_residual_is_the_true_one(laplacian, rng):
    f = rng.standard_normal((900, 2))
    solution = solve(laplacian, f)
    true = np.linalg.norm(laplacian @ solution.x - f, axis=0) / np.linalg.norm(f, axis=0)
    assert solution.residual == pytest.approx(true.max())


def test_zero_load_is_no_division_by_zero(laplacian):
    assert solve(laplacian, np.zeros((900, 1))).residual == 0.0


@pytest.mark.parametrize("method", METHODS)
def test_singular_matrix_is_refused(method):
    K = sparse.csr_array(np.array([[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]]))
    with pytest.raises(InputError, match="singular"):
        solve(K, np.array([[1.0], [0.0], [0.0]]), method)


def test_missing_pardiso_says_how_to_install(laplacian, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert solve(laplacian, np.ones((900, 1))).method == "superlu"
    with pytest.raises(InputError, match=r"pip install 'fe-drivetrain\[pardiso\]'"):
        solve(laplacian, np.ones((900, 1)), "pardiso")
