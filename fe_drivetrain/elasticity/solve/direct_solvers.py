"""Sparse direct factors of symmetric positive definite matrices, behind one signature.

Each function factorises once and returns the solve for many right-hand sides, and the factor's
memory. The orderings are those that measured best for elasticity on three-dimensional meshes, see
``cases/performance/solvers.py``.
"""

import importlib.util
import os
import sys
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu
from threadpoolctl import threadpool_limits

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.compiled import njit
from fe_drivetrain.common.errors import SINGULAR, InputError
from fe_drivetrain.elasticity.operator.kernels import together

#: The package that each solver needs beside the project's own, fastest solver first.
PACKAGES = {"pardiso": "pypardiso", "cholmod": "sksparse", "superlu": "scipy"}

#: What a package that is there may lack.
_LIBRARIES = {
    "pardiso": "pip install mkl, or set PYPARDISO_MKL_RT to the path of mkl_rt",
    "cholmod": "apt-get install libsuitesparse-dev, then pip install --force-reinstall "
    "--no-binary scikit-sparse 'fe-drivetrain[cholmod]'",
}


@dataclass(frozen=True)
class Factor:
    """A factorised matrix.

    Attributes
    ----------
    apply : callable
        Solves for all columns of an (n, m) array.
    bytes : int
        Memory of the factor.
    """

    apply: Callable[[Floats], Floats]
    bytes: int


def is_installed(method: str) -> bool:
    """Whether a method is a direct solver that can be used here: it is there, and it loads."""
    return method in PACKAGES and _is_there(method) and not _fault(method)


def require(method: str) -> None:
    """Refuse a direct solver that cannot be used here.

    Parameters
    ----------
    method : str
        One of `PACKAGES`.

    Raises
    ------
    InputError
        Its package is not installed, or a library that it needs cannot be loaded.
    """
    others = "or choose 'multigrid' or 'superlu'"
    if not _is_there(method):
        raise InputError(
            f"solver {method!r} is not installed: pip install 'fe-drivetrain[{method}]', {others}"
        )
    if fault := _fault(method):
        raise InputError(
            f"solver {method!r} cannot be loaded ({fault}): {_LIBRARIES[method]}, {others}"
        )


def _is_there(method: str) -> bool:
    return importlib.util.find_spec(PACKAGES[method]) is not None


@cache
def _fault(method: str) -> str:
    """Reason why a package that is there cannot be loaded, which is tried once; else empty."""
    try:
        {"pardiso": _load_pardiso, "cholmod": _cholmod_functions}.get(method, tuple)()
    except Exception as error:  # another project's package and its libraries: it may be any
        first, _, _ = str(error).partition("\n")[0].partition(". ")
        return first.rstrip(".") or type(error).__name__
    return ""


def _load_pardiso() -> None:
    # read when it is loaded: its idle threads would spin for 200 ms, beside our loops
    os.environ.setdefault("KMP_BLOCKTIME", "1")
    # Unless the place is stated, it looks through all files of the environment, at each solver.
    place = "PYPARDISO_MKL_RT"
    for library in sorted(Path(sys.prefix).glob("lib/libmkl_rt.*"))[:1]:
        os.environ.setdefault(place, str(library))
    os.environ.setdefault(place, import_module("pypardiso").ps.libmkl._name)


def factorise(K: sparse.bsr_array, method: str) -> Factor:
    """Factorise a symmetric positive definite matrix.

    Parameters
    ----------
    K : sparse.bsr_array
        Stiffness (n, n).
    method : str
        ``superlu``, ``pardiso`` or ``cholmod``.

    Raises
    ------
    InputError
        The solver cannot be used here, the matrix is singular, or there is not enough memory.
    """
    require(method)
    try:
        return {"superlu": _superlu, "pardiso": _pardiso, "cholmod": _cholmod}[method](K)
    except MemoryError as error:
        raise InputError(
            f"{method} needs more memory than there is for {K.shape[0]} unknowns: "
            "use solver schwarz or a coarser mesh"
        ) from error


def _superlu(K: sparse.bsr_array) -> Factor:
    try:
        factor = splu(
            K.tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError as error:  # SuperLU: "Factor is exactly singular"
        raise InputError(SINGULAR) from error

    def apply(F: Floats) -> Floats:
        x = np.empty(F.shape, order="F")
        for some in together(F.shape[1]):
            x[:, some] = factor.solve(np.asfortranarray(F[:, some]))
        return x

    return Factor(apply, 12 * factor.nnz)  # a value and a row index each


def _pardiso(K: sparse.bsr_array) -> Factor:
    from pypardiso import PyPardisoSolver
    from pypardiso.pardiso_wrapper import PyPardisoError

    upper = sparse.csr_matrix(sparse.triu(K.tocsr(), format="csr"))
    upper.sort_indices()
    solver = PyPardisoSolver(mtype=2)  # real, symmetric, positive definite

    def apply(F: Floats) -> Floats:
        try:
            return np.asarray(solver.solve(upper, np.asfortranarray(F))).reshape(F.shape)
        except (PyPardisoError, ValueError) as error:
            raise InputError(SINGULAR) from error

    try:
        solver.factorize(upper)
    except (PyPardisoError, ValueError) as error:
        solver.free_memory(everything=True)
        raise InputError(SINGULAR) from error
    # MKL holds the factor outside of Python: it goes when the solve function goes.
    weakref.finalize(apply, solver.free_memory, everything=True)
    held = solver.get_iparm(16) + solver.get_iparm(17)  # KiB: permanent, and of the factor
    return Factor(apply, 1024 * int(held))


def _cholmod_functions() -> tuple[Callable[..., Any], type[Exception]]:
    from sksparse.cholmod import CholmodNotPositiveDefiniteError, cholesky

    return cholesky, CholmodNotPositiveDefiniteError


def _cholmod(K: sparse.bsr_array) -> Factor:
    cholesky, not_definite = _cholmod_functions()
    A = sparse.csc_matrix(K)
    try:
        # Its supernodes are small: OpenBLAS with two threads took up to thirty times as long.
        with threadpool_limits(1):
            factor = cholesky(A, ordering_method="metis", mode="supernodal")
    except not_definite as error:
        raise InputError(SINGULAR) from error
    # To ask it for L would copy it, which at a million unknowns is what no longer fits.
    return Factor(factor, 8 * entries_of_factor(A.indptr, A.indices, np.asarray(factor.P())))


@njit(cache=True)
def entries_of_factor(
    indptr: NDArray[np.int32], indices: NDArray[np.int32], order: NDArray[np.int32]
) -> int:
    """Entries of the Cholesky factor of a symmetric matrix in an order of elimination.

    Row after row: its columns are those on the paths from its entries up the elimination tree
    (Liu 1990, SIAM J. Matrix Anal. Appl. 11, 134-172).
    """
    n = len(order)
    place = np.empty(n, np.int64)
    for k in range(n):
        place[order[k]] = k
    parent, seen = np.full(n, -1), np.full(n, -1)
    count = n
    for k in range(n):
        seen[k] = k
        for p in range(indptr[order[k]], indptr[order[k] + 1]):
            j = place[indices[p]]
            if j > k:
                continue
            while seen[j] != k:
                if parent[j] < 0:
                    parent[j] = k
                seen[j] = k
                count += 1
                j = parent[j]
    return count
