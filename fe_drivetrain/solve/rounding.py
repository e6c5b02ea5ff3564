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
    # made out here: NumPy's functions in a compiled loop would take a second to compile
    sizes, energies = np.zeros((2, len(K.indptr) - 1, x.shape[1]))
    _add_sums(K.indptr, K.indices, K.data, np.ascontiguousarray(x), sizes, energies)
    there = sizes.sum(axis=0) > 0.0
    if not there.any():
        return 0.0
    size, energy = sizes.sum(axis=0)[there], energies.sum(axis=0)[there]
    # Where rounding leaves no positive energy, it may have done anything.
    return float(_EPS * np.max(size / np.maximum(energy, _EPS * size)))


@njit(cache=True, parallel=True)
def _add_sums(
    indptr: NDArray[np.int32],
    indices: NDArray[np.int32],
    data: Floats,
    X: Floats,
    size: Floats,
    energy: Floats,
) -> None:
    """Add over each block row |x_i K_ij x_j| and x_i K_ij x_j, of each column."""
    m = X.shape[1]
    for i in prange(len(indptr) - 1):
        for p in range(indptr[i], indptr[i + 1]):
            c = indices[p]
            for r in range(3):
                for s in range(3):
                    for k in range(m):
                        term = X[3 * i + r, k] * data[p, r, s] * X[3 * c + s, k]
                        energy[i, k] += term
                        size[i, k] += abs(term)
