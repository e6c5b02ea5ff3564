"""What rounding does to a slender or thin solid before any solver sees it."""

from dataclasses import dataclass

import numpy as np
from numba import njit, prange
from numpy.typing import NDArray
from scipy import sparse

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.operator.kernels import AHEAD
from fe_drivetrain.operator.vectors import fetch

# An entry is a sum over a handful of elements and the points of their quadrature.
_EPS = 4.0 * float(np.finfo(float).eps)


@dataclass(frozen=True)
class Judged:
    """What one pass over the stiffness says of solutions.

    Attributes
    ----------
    residual : float
        |f - K x| over |f|, of the worst column; |K x| where f is zero.
    round_off : float
        As of `round_off`.
    """

    residual: float
    round_off: float


def judged(K: sparse.bsr_array, x: Floats, F: Floats) -> Judged:
    """Residual and round-off of solutions.

    Parameters
    ----------
    K : sparse.bsr_array
        (n, n) symmetric positive definite, 3x3 blocks.
    x, F : Floats
        (n, m) solutions and right-hand sides.
    """
    # made out here: NumPy's functions in a compiled loop would take a second to compile
    sums = np.zeros((3, len(K.indptr) - 1, x.shape[1]))
    x, F = np.ascontiguousarray(x), np.ascontiguousarray(F)
    if x.shape[1] == 1:
        flat = K.data.reshape(-1), x.reshape(-1), F.reshape(-1)
        _add_sums_of_one(K.indptr, K.indices, *flat, *sums[:, :, 0])
    else:
        _add_sums_of_many(K.indptr, K.indices, K.data, x, F, *sums)
    sizes, energies, squares = sums.sum(axis=1)
    size = np.linalg.norm(F, axis=0)
    size[size == 0.0] = 1.0
    return Judged(float((np.sqrt(squares) / size).max()), worst(sizes, energies))


def round_off(K: sparse.bsr_array, x: Floats) -> float:
    """Relative change of the energy of solutions that the rounding of K's entries makes at worst.

    An entry is known to a few units in its last digit, eps |K_ij| with eps = 4 2^-52. To first
    order that changes the compliance f.x of the solution of K x = f by x.dK x, so relatively by

        eps |x|.|K||x| / x.K x

    (the condition number of Skeel 1979, J. ACM 26, 494-526, weighted with the load). The bending of
    a slender solid is a small difference of large forces between its nodes: the ratio grows as the
    fourth power of its length over its elements. Rounding is rarely that unlucky.

    Parameters
    ----------
    K : sparse.bsr_array
        (n, n) symmetric positive definite, 3x3 blocks.
    x : Floats
        (n, m) solutions.

    Returns
    -------
    relative
        Of the worst column; those that are zero do not count.
    """
    return judged(K, x, np.zeros_like(x)).round_off


def worst(size: Floats, energy: Floats) -> float:
    """The same of |x|.|K||x| and x.K x (m,) of each column."""
    there = size > 0.0
    if not there.any():
        return 0.0
    # Where rounding leaves no positive energy, it may have done anything.
    return float(_EPS * np.max(size[there] / np.maximum(energy[there], _EPS * size[there])))


@njit(cache=True, parallel=True)
def _add_sums_of_one(
    indptr: NDArray[np.int32],
    indices: NDArray[np.int32],
    data: Floats,
    x: Floats,
    b: Floats,
    size: Floats,
    energy: Floats,
    square: Floats,
) -> None:
    """As `_add_sums_of_many` for one column, all arrays flat."""
    three, ahead = np.uint64(3), np.uint64(AHEAD // data.itemsize)
    for i in prange(len(indptr) - 1):
        for r in range(3):
            force = largest = 0.0
            for p in range(np.uint64(indptr[i]), np.uint64(indptr[i + 1])):
                q = np.uint64(9) * p + three * np.uint64(r)
                fetch(data, q + ahead)
                c = three * np.uint64(indices[p])
                for s in range(three):
                    term = data[q + s] * x[c + s]
                    force += term
                    largest += abs(term)
            u = x[3 * i + r]
            size[i] += abs(u) * largest
            energy[i] += u * force
            square[i] += (b[3 * i + r] - force) ** 2


@njit(cache=True, parallel=True)
def _add_sums_of_many(
    indptr: NDArray[np.int32],
    indices: NDArray[np.int32],
    data: Floats,
    X: Floats,
    F: Floats,
    size: Floats,
    energy: Floats,
    square: Floats,
) -> None:
    """Add |x_i K_ij x_j|, x_i K_ij x_j and (f_i - K_ij x_j)^2 of each block row, by column."""
    m = X.shape[1]
    for i in prange(len(indptr) - 1):
        force, largest = np.empty((3, m)), np.empty((3, m))
        for r in range(3):
            for k in range(m):
                force[r, k] = largest[r, k] = 0.0
        for p in range(indptr[i], indptr[i + 1]):
            c = 3 * indices[p]
            for r in range(3):
                for s in range(3):
                    entry = data[p, r, s]
                    for k in range(m):
                        term = entry * X[c + s, k]
                        force[r, k] += term
                        largest[r, k] += abs(term)
        for r in range(3):
            for k in range(m):
                x = X[3 * i + r, k]
                size[i, k] += abs(x) * largest[r, k]
                energy[i, k] += x * force[r, k]
                square[i, k] += (F[3 * i + r, k] - force[r, k]) ** 2
