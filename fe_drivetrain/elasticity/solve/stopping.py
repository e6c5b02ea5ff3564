"""Stopping of conjugate gradients, converged or hopeless: numpy alone, for all who iterate.

The residual says little about slender solids, whose stiffest and softest motions are ten decades
apart. What conjugate gradients add in step k to the squared energy norm is known exactly, Delta_k =
alpha_k (r_k, z_k), and the squared error is the sum of what is still to come. It is taken as
Delta_k times the maximum such ratio seen in the steps before (Meurant, Papez, Tichy 2021, Accurate
error estimation in CG, section 4).
"""

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

TOLERANCE = 1e-9
"""Energy error at which iterations stop, relative; squared, that of a load's own stiffness."""

LAST_DIGIT = 1e-32
"""Share of the squared residual in the preconditioner's norm below which a column is solved."""

_RECENT = 1e-2
_PATIENCE = 40

# What is foreseen was too little by up to 1.9 on shafts of 200 diameters.
_LONGER = 2.0


def tail_ratio(terms: NDArray[np.float64]) -> NDArray[np.float64]:
    """Largest ratio, seen so far, of what came after a step to what the step itself added.

    Parameters
    ----------
    terms : ndarray
        Terms (k, m) that each step of conjugate gradients added to the squared energy norm.

    Returns
    -------
    ndarray
        (m,) 1 or more.
    """
    return _ratio(terms, _tails(terms))


def _tails(terms: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k, m) sums of the terms from each step to the last."""
    return np.asarray(np.cumsum(terms[::-1], axis=0)[::-1])


def _ratio(terms: NDArray[np.float64], tails: NDArray[np.float64]) -> NDArray[np.float64]:
    # At the start convergence is another. A window of 1e-4 fell below half the truth on thin tubes.
    recent = tails <= _RECENT * tails[0]
    recent |= ~recent.any(axis=0)
    ratio = np.divide(tails, terms, out=np.ones_like(terms), where=recent & (terms > 0.0))
    return np.asarray(ratio.max(axis=0))


def energy_error(
    terms: NDArray[np.float64],
    started: NDArray[np.float64] | float = 0.0,
    least_ratio: float = 1.0,
) -> float:
    """Estimated relative energy error after the last step, of the worst column.

    Parameters
    ----------
    terms : ndarray
        Terms (k, m) that each step of conjugate gradients added to the squared energy norm.
    started : ndarray or float
        (m,) squared energy norm of where the iteration started, orthogonal in energy to all that it
        adds: a Galerkin solution, or zero.
    least_ratio : float
        The least to take for `tail_ratio`: what iterations from zero have shown before. The few
        steps from a good start show little of how the iteration converges.
    """
    last, tails = terms[-1], _tails(terms)
    total = tails[0] + started
    ratio = np.maximum(_ratio(terms, tails), least_ratio)
    squared = np.divide(ratio * last, total, out=np.zeros_like(last), where=total > 0.0)
    return float(np.sqrt(squared.max()))


def is_hopeless(
    errors: Sequence[float],
    tolerance: float,
    most: int,
    foreseen: Callable[[], float] = lambda: 0.0,
) -> bool:
    """Whether the rate of the latter half would take twice as long as there is.

    A few soft motions that the preconditioner hardly knows hold the error up, and then it falls as
    ever: where that many iterations were foreseen, nothing is said before twice as many.

    Parameters
    ----------
    errors : sequence of float
        Energy errors after each step so far.
    tolerance : float
        Tolerance to come to.
    most : int
        Maximum number of steps.
    foreseen : callable
        Function that returns the number of steps foreseen; called only where it decides.
    """
    k = len(errors)
    if k < _PATIENCE:
        return False
    decades = math.log10(errors[k // 2]) - math.log10(errors[-1])
    missing = math.log10(errors[-1]) - math.log10(tolerance)
    needed = missing / max(decades, 1e-3) * (k - k // 2)
    if k + needed <= 2 * most:
        return False
    expected = foreseen()
    return k >= _LONGER * expected or expected > most
