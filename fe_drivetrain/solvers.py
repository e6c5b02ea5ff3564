"""One factorisation, many right-hand sides, and what they cost.

Symmetric positive definite systems only: interfaces are eliminated before, and mechanisms refused.
"""

import importlib.util
import time
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from fe_drivetrain.elasticity import Floats
from fe_drivetrain.errors import InputError

Method = Literal["auto", "superlu", "pardiso"]


@dataclass(frozen=True)
class Solution:
    """Solutions of one system and their diagnostics.

    Attributes
    ----------
    x
        (n, n_rhs).
    residual
        Largest relative residual |K x - f| / |f| over the right-hand sides.
    method
        The solver that was used.
    seconds
        Wall time of factorisation and solve.
    """

    x: Floats
    residual: float
    method: str
    seconds: float


def solve(K: sparse.csr_array, F: Floats, method: Method = "auto") -> Solution:
    """Solve K x = F for all columns of F with one factorisation.

    Parameters
    ----------
    K
        (n, n) symmetric positive definite.
    F
        (n, n_rhs).
    method
        ``pardiso`` (optional package pypardiso), ``superlu`` (always there), or ``auto``: the
        first of these that is installed.

    Raises
    ------
    InputError
        The method is not installed, or the matrix is singular.
    """
    have_pardiso = importlib.util.find_spec("pypardiso") is not None
    if method == "auto":
        method = "pardiso" if have_pardiso else "superlu"
    if method == "pardiso" and not have_pardiso:
        raise InputError(
            "solver 'pardiso' is not installed: pip install 'fe-drivetrain[pardiso]', "
            "or choose 'superlu'"
        )
    start = time.perf_counter()
    apply = _pardiso(K) if method == "pardiso" else _superlu(K)
    x = apply(F)
    # One step of refinement: slender solids are ill-conditioned and lose digits in the factor.
    x = x + apply(F - K @ x)
    if not np.isfinite(x).all():
        raise InputError("the stiffness matrix is singular: the scene is not held everywhere")
    size = np.linalg.norm(F, axis=0)
    size[size == 0.0] = 1.0
    residual = float((np.linalg.norm(K @ x - F, axis=0) / size).max())
    return Solution(x, residual, method, time.perf_counter() - start)


def _superlu(K: sparse.csr_array):  # type: ignore[no-untyped-def]
    try:
        factor = splu(
            K.tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError as error:  # SuperLU: "Factor is exactly singular"
        raise InputError(
            "the stiffness matrix is singular: the scene is not held everywhere"
        ) from error
    return factor.solve


def _pardiso(K: sparse.csr_array):  # type: ignore[no-untyped-def]
    from pypardiso import PyPardisoSolver

    upper = sparse.csr_matrix(sparse.triu(K, format="csr"))
    upper.sort_indices()
    solver = PyPardisoSolver(mtype=2)  # real, symmetric, positive definite
    solver.factorize(upper)

    def apply(F: Floats) -> Floats:
        return np.asarray(solver.solve(upper, np.asfortranarray(F))).reshape(F.shape)

    return apply
