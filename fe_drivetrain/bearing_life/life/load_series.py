"""Life under loads that change: Miner's sum over steps, histories and winds.

Lives at single winds become the life at a site by
`fe_drivetrain.turbine_loads.histories.site_life`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.histories.sites import HOURS_A_YEAR


def years(life: ArrayLike, speed_rpm: ArrayLike) -> Floats:
    """Time that a life in revolutions lasts.

    Parameters
    ----------
    life : array_like
        [million revolutions].
    speed_rpm : array_like
        [1/min], at each step; its sign does not matter.

    Returns
    -------
    years : Floats
        Infinite at standstill, which the method says nothing of.
    """
    hours = 60.0 * np.abs(np.asarray(speed_rpm, dtype=float))
    with np.errstate(divide="ignore"):
        return np.asarray(1e6 * np.asarray(life, dtype=float) / (hours * HOURS_A_YEAR))


def equivalent_life(lives: ArrayLike, durations: ArrayLike | None = None, axis: int = -1) -> Floats:
    """Life under steps that come again and again: 1 / sum(phi / L), by Miner's rule.

    Parameters
    ----------
    lives : array_like
        Life of each step alone [any unit], in time where durations are times, in revolutions where
        they are turns; infinite where there is no damage, 0 where the first is fatal.
    durations : array_like, optional
        Durations of the steps, of a shape that broadcasts to that of lives; equal if not given.
        Shares phi sum to one.
    axis : int
        Along which the steps are.

    Returns
    -------
    life : Floats
        In the unit of lives, without that axis (Stirling 2023, eqs 5.16 to 5.21).

    Raises
    ------
    InputError
        A life is negative, a duration is not positive, or there is no step.
    """
    L = np.asarray(lives, dtype=float)
    weights = np.broadcast_to(1.0 if durations is None else np.asarray(durations, float), L.shape)
    if not L.shape[axis] or not (L >= 0.0).all() or not (weights > 0.0).all():
        raise InputError("steps of a life need lives of 0 or more and durations above 0")
    with np.errstate(divide="ignore"):
        rate = np.sum(weights / L, axis=axis)
        return np.asarray(np.sum(weights, axis=axis) / rate)


def miner_load(loads: ArrayLike, turns: ArrayLike, exponent: float = 10.0 / 3.0) -> float:
    """The constant load that does the damage of a series, for ISO 281.

    Parameters
    ----------
    loads : array_like
        (n,) equivalent loads P of the steps [N].
    turns : array_like
        (n,) revolutions, or shares of them.
    exponent : float
        10/3 for rollers, 3 for balls.

    Returns
    -------
    load : float
        [N].
    """
    P, n = np.asarray(loads, dtype=float), np.asarray(turns, dtype=float)
    return float((np.sum(n * P**exponent) / np.sum(n)) ** (1.0 / exponent))
