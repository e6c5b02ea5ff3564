"""Effect of rounding on a slender or thin solid before any solver sees it."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.elasticity.operator.kernels import in_lanes, pattern_of, residual

# An entry is a sum over a handful of elements and the points of their quadrature.
_EPS = 4.0 * float(np.finfo(float).eps)

# Block rows at a time: two megabytes of magnitudes, which stay in a cache.
_ROWS = 1024


@dataclass(frozen=True)
class Judged:
    """Residual and round-off of solutions, judged by the stiffness.

    Attributes
    ----------
    residual : float
        Residual |f - K x| over |f|, of the worst column; |K x| where f is zero.
    round_off : float
        Relative change of the energy by rounding, see `round_off`.
    """

    residual: float
    round_off: float


def judged(K: sparse.bsr_array, x: Floats, F: Floats) -> Judged:
    """Residual and round-off of solutions.

    Parameters
    ----------
    K : sparse.bsr_array
        Stiffness (n, n), symmetric positive definite, 3x3 blocks.
    x, F : Floats
        Solutions and right-hand sides (n, m).
    """
    x, left = np.ascontiguousarray(x), np.empty(x.shape)
    residual(*pattern_of(K), K.data, x, np.ascontiguousarray(F), left)
    size = np.linalg.norm(F, axis=0)
    size[size == 0.0] = 1.0
    magnitude = np.abs(x)
    sums = (magnitude * _product_of_magnitudes(K, magnitude)).sum(axis=0)
    energies = (x * (F - left)).sum(axis=0)
    return Judged(float((np.linalg.norm(left, axis=0) / size).max()), worst(sums, energies))


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
        Stiffness (n, n), symmetric positive definite, 3x3 blocks.
    x : Floats
        Solutions (n, m).

    Returns
    -------
    relative
        Relative change in the worst column; those that are zero do not count.
    """
    return judged(K, x, np.zeros_like(x)).round_off


def worst(size: Floats, energy: Floats) -> float:
    """The same of |x|.|K||x| and x.K x (m,) of each column."""
    there = size > 0.0
    if not there.any():
        return 0.0
    # Where rounding leaves no positive energy, it may have done anything.
    return float(_EPS * np.max(size[there] / np.maximum(energy[there], _EPS * size[there])))


def _product_of_magnitudes(K: sparse.bsr_array, x: Floats) -> Floats:
    """``|K| x``, some rows at a time: no second matrix, and no other loop to compile."""
    indptr, indices = pattern_of(K)
    wide = in_lanes(x) if x.shape[1] > 1 else x
    out = np.empty_like(wide)
    for low in range(0, len(indptr) - 1, _ROWS):
        pointers = indptr[low : low + _ROWS + 1]
        blocks = slice(pointers[0], pointers[-1])
        own = out[3 * low : 3 * (low + _ROWS)]
        nothing, magnitudes = np.zeros_like(own), np.abs(K.data[blocks])
        residual(pointers - pointers[0], indices[blocks], magnitudes, wide, nothing, own)
    return -out[:, : x.shape[1]]
