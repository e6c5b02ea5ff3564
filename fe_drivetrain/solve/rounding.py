"""What rounding does to a slender or thin solid before any solver sees it."""

import numpy as np
from numba import njit, prange
from numpy.typing import NDArray
from scipy import sparse

from fe_drivetrain.common.arrays import Floats

# An entry is a sum over a handful of elements and the points of their quadrature.
_EPS = 4.0 * float(np.finfo(float).eps)


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
    sizes, energies = _sums(K.indptr, K.indices, K.data, np.ascontiguousarray(x))
    return worst(sizes.sum(axis=0), energies.sum(axis=0))


def worst(size: Floats, energy: Floats) -> float:
    """The same of |x|.|K||x| and x.K x (m,) of each column."""
    there = size > 0.0
    if not there.any():
        return 0.0
    # Where rounding leaves no positive energy, it may have done anything.
    return float(_EPS * np.max(size[there] / np.maximum(energy[there], _EPS * size[there])))


@njit(cache=True, parallel=True)
def _sums(
    indptr: NDArray[np.int32], indices: NDArray[np.int32], data: Floats, X: Floats
) -> tuple[Floats, Floats]:
    """Sums over each block row of |x_i K_ij x_j| and of x_i K_ij x_j, for each column."""
    n, m = len(indptr) - 1, X.shape[1]
    size, energy = np.zeros((n, m)), np.zeros((n, m))
    for i in prange(n):
        for p in range(indptr[i], indptr[i + 1]):
            c = indices[p]
            for r in range(3):
                for s in range(3):
                    for k in range(m):
                        term = X[3 * i + r, k] * data[p, r, s] * X[3 * c + s, k]
                        energy[i, k] += term
                        size[i, k] += abs(term)
    return size, energy
