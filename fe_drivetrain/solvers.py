"""One factorisation, many right-hand sides, and what they cost.

Symmetric positive definite systems only: interfaces are eliminated before, and mechanisms refused.
"""

import importlib.util
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from fe_drivetrain.elasticity import Floats
from fe_drivetrain.errors import InputError

Method = Literal["auto", "superlu", "pardiso"]

_SINGULAR = "the stiffness matrix is singular: the scene is not held everywhere"


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
    with _factor(K, method) as apply:
        x = apply(F)
        # One step of refinement: slender solids are ill-conditioned and lose digits in the factor.
        x = x + apply(F - K @ x)
    if not np.isfinite(x).all():
        raise InputError(_SINGULAR)
    size = np.linalg.norm(F, axis=0)
    size[size == 0.0] = 1.0
    residual = float((np.linalg.norm(K @ x - F, axis=0) / size).max())
    return Solution(x, residual, method, time.perf_counter() - start)


@contextmanager
def _factor(K: sparse.csr_array, method: str) -> Iterator[Callable[[Floats], Floats]]:
    """A function that solves with the factor of K; the factor's memory is freed afterwards."""
    if method == "superlu":
        try:
            factor = splu(
                K.tocsc(),
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )
        except RuntimeError as error:  # SuperLU: "Factor is exactly singular"
            raise InputError(_SINGULAR) from error
        yield factor.solve
        return

    from pypardiso import PyPardisoSolver
    from pypardiso.pardiso_wrapper import PyPardisoError

    upper = sparse.csr_matrix(sparse.triu(K, format="csr"))
    upper.sort_indices()
    solver = PyPardisoSolver(mtype=2)  # real, symmetric, positive definite
    try:
        solver.factorize(upper)
        yield lambda F: np.asarray(solver.solve(upper, np.asfortranarray(F))).reshape(F.shape)
    except (PyPardisoError, ValueError) as error:
        raise InputError(_SINGULAR) from error
    finally:
        solver.free_memory(everything=True)
