"""How long, and over how many turns, a load is at which level; when it changes its sign.

Lives of gears and rolling bearings follow these distributions, not counted cycles (IEC 61400-4).
Every sample stands for one step of time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class Levels:
    """A distribution over levels of a load: load duration, or load revolutions.

    Attributes
    ----------
    edges : ndarray, (k + 1,)
        Limits of the levels, in the unit of the load.
    amount : ndarray, (k,)
        At each level: seconds, or turns.
    """

    edges: Floats
    amount: Floats

    __repr__ = short_repr

    @property
    def middles(self) -> Floats:
        """Middle of each level: (k,)."""
        return 0.5 * (self.edges[:-1] + self.edges[1:])

    @property
    def at_least(self) -> Floats:
        """(k,) at this level or above."""
        return np.asarray(np.cumsum(self.amount[::-1])[::-1])

    def __add__(self, other: Levels) -> Levels:
        """Both together, over the same levels."""
        if not np.array_equal(self.edges, other.edges):
            raise InputError(
                "two distributions over levels have different limits: give both the same"
            )
        return Levels(self.edges, self.amount + other.amount)


def even_levels(low: float, high: float, count: int = 50) -> Floats:
    """Limits of equal levels that hold all values from `low` to `high`."""
    if low == high:
        low, high = low - 0.5, high + 0.5
    return np.linspace(low, high, count + 1)


def time_at_level(signal: ArrayLike, step: float, edges: ArrayLike) -> Levels:
    """Seconds at each level: the load duration distribution of a load, or of any channel.

    Parameters
    ----------
    signal : array_like, (n,)
        The channel.
    step : float
        Between two samples [s].
    edges : array_like, (k + 1,)
        Limits of the levels, rising; they must hold every sample.

    Raises
    ------
    InputError
        A sample is at no level.
    """
    return _distribution(signal, np.full(np.shape(signal), step), edges)


def revolutions_at_level(
    signal: ArrayLike, speed: ArrayLike, step: float, edges: ArrayLike
) -> Levels:
    """Turns at each level: the load revolution distribution.

    Parameters
    ----------
    signal : array_like, (n,)
        The load.
    speed : array_like, (n,) or float
        Speed of the shaft [rad/s]; turns count in either direction.
    step : float
        Between two samples [s].
    edges : array_like, (k + 1,)
        Edges, see `time_at_level`.

    Raises
    ------
    InputError
        A sample is at no level.
    """
    turns = np.abs(np.asarray(speed, dtype=float)) * step / (2.0 * np.pi)
    return _distribution(signal, np.broadcast_to(turns, np.shape(signal)), edges)


def equivalent_level(signal: ArrayLike, exponent: float, turns: ArrayLike | None = None) -> float:
    """Constant load of the same effect: the mean of the p-th power, to the 1/p.

    ``(sum n |T|^p / sum n)^(1/p)``, of samples, without levels; p is 10/3 for roller bearings, 3
    for ball bearings (ISO 281), a gear's exponent by ISO 6336-6.

    Parameters
    ----------
    signal : array_like, (n,)
        The load.
    exponent : float
        The exponent p.
    turns : array_like, (n,), optional
        Weight of each sample; equal where left out.
    """
    values = np.abs(np.asarray(signal, dtype=float))
    weights = np.ones_like(values) if turns is None else np.abs(np.asarray(turns, dtype=float))
    largest, total = float(values.max(initial=0.0)), float(weights.sum())
    if largest == 0.0 or total == 0.0:
        return 0.0
    mean = float(weights @ (values / largest) ** exponent) / total
    return largest * float(mean ** (1.0 / exponent))


@dataclass(frozen=True)
class Reversals:
    """Changes of a load's sign.

    Attributes
    ----------
    count : int
        How often the load went from beyond the band on one side to beyond it on the other.
    seconds : float
        Time with a negative load [s].
    least : float
        Least value.
    band : float
        Within which a load has no sign.
    """

    count: int
    seconds: float
    least: float
    band: float


def torque_reversals(signal: ArrayLike, step: float, band: float = 0.0) -> Reversals:
    """How often a torque, or any load, changes its sign.

    Parameters
    ----------
    signal : array_like, (n,)
        The load.
    step : float
        Between two samples [s].
    band : float
        A load of at most this size has no sign, so that noise about zero does not count.
    """
    values = np.asarray(signal, dtype=float)
    signs = np.sign(values[np.abs(values) > band])
    return Reversals(
        int(np.count_nonzero(np.diff(signs))),
        float(np.count_nonzero(values < 0.0)) * step,
        float(values.min()),
        band,
    )


def _distribution(signal: ArrayLike, weights: Floats, edges: ArrayLike) -> Levels:
    values, limits = np.asarray(signal, dtype=float), np.asarray(edges, dtype=float)
    if values.size and not limits[0] <= values.min() <= values.max() <= limits[-1]:
        raise InputError(
            f"a load from {values.min():g} to {values.max():g} does not fit into levels from "
            f"{limits[0]:g} to {limits[-1]:g}: let them hold every sample"
        )
    amount, _ = np.histogram(values, limits, weights=weights)
    return Levels(limits, np.asarray(amount, dtype=float))
