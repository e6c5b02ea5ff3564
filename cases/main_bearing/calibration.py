"""Dimensions that give wanted results: a surface through samples finds them, the model corrects it.

Stiffnesses are nearly products of powers of dimensions, so logs of results are taken as a low-order
polynomial of logs of dimensions. A finite-element result jumps a little from one mesh to the next,
by more than a small step of a dimension changes it: derivatives come from the surface, which
averages over many meshes, and the model itself only gives the error of the surface (output
space mapping: Bandler et al. 2004, IEEE Trans. Microwave Theory Tech. 52, 337-361).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares
from scipy.stats import qmc

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

#: Half the sum of squared relative errors, below which equations are solved.
_SOLVED = 1e-16

Evaluate = Callable[[Floats], Floats]
"""Results (k,) of dimensions (d,), all positive."""


@dataclass(frozen=True)
class Surface:
    """Logs of k results as a polynomial of logs of d dimensions.

    Attributes
    ----------
    centre : Floats
        (d,) dimensions about which the polynomial is written.
    powers : Floats
        (t, d) powers of the logs in each term.
    coefficients : Floats
        (t, k).
    errors : Floats
        (n, k) log of each sample's result less that of a surface fitted to the others.
    """

    centre: Floats
    powers: Floats
    coefficients: Floats
    errors: Floats

    def __call__(self, x: Floats) -> Floats:
        """Results (..., k) of dimensions (..., d)."""
        return np.asarray(np.exp(_terms(np.log(x / self.centre), self.powers) @ self.coefficients))

    def exponents(self, x: Floats) -> Floats:
        """(k, d) relative change of each result for that of each dimension, at dimensions (d,)."""
        z = np.log(x / self.centre)
        columns = []
        for j in range(len(z)):
            power = self.powers[:, j]
            lowered = self.powers.copy()
            lowered[:, j] = np.maximum(power - 1.0, 0.0)
            columns.append((power * _terms(z, lowered)) @ self.coefficients)
        return np.stack(columns, axis=-1)

    @property
    def scatter(self) -> Floats:
        """(k,) root mean square of the relative errors at samples that were left out."""
        return np.asarray(np.sqrt((self.errors**2).mean(axis=0)))


@dataclass(frozen=True)
class Calibrated:
    """Dimensions whose results were asked for.

    Attributes
    ----------
    x : Floats
        (d,) the dimensions.
    values : Floats
        (k,) what the model gives there.
    miss : float
        Largest relative distance of a value from what was wanted.
    evaluations : int
        Of the model.
    """

    x: Floats
    values: Floats
    miss: float
    evaluations: int


def hypercube(low: ArrayLike, high: ArrayLike, count: int, seed: int = 0) -> Floats:
    """Dimensions (count, d) between bounds (d,), a Latin hypercube in their logs."""
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    unit = qmc.LatinHypercube(d=len(low), seed=seed).random(count)
    return np.asarray(low * (high / low) ** unit)


def fitted(x: Floats, values: Floats, order: int = 2) -> Surface:
    """The surface through samples, by least squares.

    Parameters
    ----------
    x, values : Floats
        (n, d) dimensions and (n, k) results, all positive.
    order : int
        1: each result a product of powers. 2: powers that change with the dimensions.

    Raises
    ------
    InputError
        There are too few samples to leave one out.
    """
    n, d = x.shape
    powers = np.array(
        [
            np.bincount(chosen, minlength=d)
            for total in range(order + 1)
            for chosen in combinations_with_replacement(range(d), total)
        ],
        dtype=float,
    )
    if n <= len(powers):
        raise InputError(
            f"a surface of order {order} over {d} dimensions has {len(powers)} terms but there are "
            f"{n} samples: give at least {len(powers) + 1}, or a lower order"
        )
    centre = np.exp(np.log(x).mean(axis=0))
    terms = _terms(np.log(x / centre), powers)
    y = np.log(values)
    pseudo = np.linalg.pinv(terms)
    coefficients = pseudo @ y
    # what a sample itself does to the surface there (Allen 1974, Technometrics 16, 125-127)
    leverage = np.einsum("nt,tn->n", terms, pseudo)
    errors = (y - terms @ coefficients) / (1.0 - leverage)[:, None]
    return Surface(centre, powers, np.asarray(coefficients, dtype=float), np.asarray(errors, float))


def nearest(
    surface: Surface,
    start: Floats,
    free: Sequence[int],
    wanted: Floats,
    low: Floats,
    high: Floats,
) -> Floats:
    """Dimensions (d,) whose results are nearest to those wanted (k,), by least squares of logs.

    Parameters
    ----------
    surface : Surface
        Through samples.
    start : Floats
        (d,) within the bounds; what is not free stays there.
    free : Sequence[int]
        Which dimensions may change; where there are more of them than results, those that come
        out are near the start.
    low, high : Floats
        (d,) bounds.
    """
    index = np.array(free)

    def placed(logs: Floats) -> Floats:
        x = np.array(start, dtype=float)
        x[index] = np.exp(logs)
        return x

    # dogbox is quick where there is a solution; where there is none, it may stop short of the least
    bounds = np.log(low[index]), np.log(high[index])
    logs = np.clip(np.log(start[index]), *bounds)
    for method in ("dogbox", "trf"):
        found = least_squares(
            lambda logs: np.log(surface(placed(logs)) / wanted),
            logs,
            jac=lambda logs: surface.exponents(placed(logs))[:, index],
            bounds=bounds,
            method=method,
            xtol=1e-12,
            ftol=1e-14,
            gtol=1e-14,
        )
        logs = found.x
        if found.cost < _SOLVED:
            break
    return np.clip(placed(found.x), low, high)


def calibrated(
    evaluate: Evaluate,
    surface: Surface,
    start: Floats,
    free: Sequence[int],
    wanted: Floats,
    low: Floats,
    high: Floats,
    tolerance: float,
    most: int = 6,
    ratio: Floats | float = 1.0,
) -> Calibrated:
    """Dimensions (d,) for which the model itself gives what is wanted.

    Each round evaluates the error of the surface there with the model, and solves for results
    shifted by it.

    Parameters
    ----------
    evaluate : Evaluate
        The model, expensive.
    surface : Surface
        Its surface, or that of a coarser one.
    start, free, wanted, low, high : Floats, Sequence[int], Floats, Floats, Floats
        As for `nearest`.
    tolerance : float
        Relative, of every result.
    most : int
        Rounds; the best one is the answer.
    ratio : Floats or float
        (k,) of the surface over the model, as far as it is known beforehand.
    """
    x = nearest(surface, start, free, wanted * ratio, low, high)
    best: Calibrated | None = None
    for count in range(1, most + 1):
        values = evaluate(x)
        miss = float(np.abs(values / wanted - 1.0).max())
        if best is None or miss < best.miss:
            best = Calibrated(x, values, miss, count)
        if miss <= tolerance:
            break
        x = nearest(surface, x, free, wanted * surface(x) / values, low, high)
    assert best is not None
    return Calibrated(best.x, best.values, best.miss, count)


def _terms(z: Floats, powers: Floats) -> Floats:
    """(..., t) products of powers of logs (..., d)."""
    return np.asarray(np.prod(z[..., None, :] ** powers, axis=-1))
