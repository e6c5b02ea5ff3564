"""Amounts in classes that any number of histories can be added to, without their extremes.

Widths are powers of two, and limits whole multiples of them, so that classes of one history are
unions of those of another, and adding them is exact. A class is no wider than one 64th of the range
of the history that spreads widest, or two `MAXIMUM`-ths of the range of all.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr

MINIMUM = 64
"""Classes over the range of a history, at least."""

MAXIMUM = 1024
"""Classes of each quantity that a sum keeps, at most: histories may be far apart."""

_FINEST = -60  # the power of two of a history that is zero


@dataclass(frozen=True, eq=False)
class Classes:
    """Amounts over one quantity or more.

    Attributes
    ----------
    powers : tuple of int
        Powers of two: the widths of the classes of each quantity.
    first : tuple of int
        Lower limit of the first class of each, in widths.
    amount : ndarray
        In each class, an axis for each quantity.
    """

    powers: tuple[int, ...]
    first: tuple[int, ...]
    amount: Floats

    __repr__ = short_repr

    def edges(self, axis: int = 0) -> Floats:
        """Limits of the classes of one quantity."""
        numbers = self.first[axis] + np.arange(self.amount.shape[axis] + 1, dtype=float)
        return np.asarray(np.ldexp(numbers, self.powers[axis]))

    def middles(self, axis: int = 0) -> Floats:
        """Middles of the classes of one quantity."""
        edges = self.edges(axis)
        return 0.5 * (edges[:-1] + edges[1:])

    @property
    def at_least(self) -> Floats:
        """Amount at the lower limit of each class or above it, of one quantity."""
        return np.asarray(np.cumsum(self.amount[::-1])[::-1])


def in_classes(
    *columns: ArrayLike, weights: ArrayLike, least: int = MINIMUM, power: int | None = None
) -> Classes:
    """Put samples into classes.

    Parameters
    ----------
    *columns : array_like, (n,)
        Each quantity.
    weights : array_like, (n,)
        Amount of each sample.
    least : int
        Classes over the range of each quantity, at least.
    power : int, optional
        Power of two: the width of the classes, where it is not to follow from the range. They are
        twice as wide, and twice again, where there would be more than `MAXIMUM` of them.
    """
    powers, first, places, shape = [], [], [], []
    for column in columns:
        values = np.asarray(column, dtype=float)
        low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 0.0)
        span = (high - low) or max(abs(low), abs(high))
        if power is None:
            own = int(np.floor(np.log2(span / least))) if span else _FINEST
        else:
            own = _wide_enough(power, low, high)
        numbers = np.floor(np.ldexp(values, -own))
        start = int(np.floor(np.ldexp(low, -own)))
        powers.append(own)
        first.append(start)
        places.append((numbers - start).astype(int))
        shape.append(int(np.floor(np.ldexp(high, -own))) - start + 1)
    flat = np.ravel_multi_index(tuple(places), shape)
    counted = np.bincount(flat, np.asarray(weights, dtype=float), int(np.prod(shape)))
    amount: Floats = np.asarray(counted, dtype=np.float64)
    return Classes(tuple(powers), tuple(first), amount.reshape(shape))


def _wide_enough(power: int, low: float, high: float) -> int:
    """The power of two from `power` on of which no more than `MAXIMUM` classes have the range."""
    while np.floor(np.ldexp(high, -power)) - np.floor(np.ldexp(low, -power)) >= MAXIMUM:
        power += 1
    return power


def added(parts: Sequence[Classes]) -> Classes:
    """All together, in the classes of the widest.

    Parameters
    ----------
    parts : sequence of Classes
        Over the same quantities.
    """
    powers = tuple(max(p) for p in zip(*(part.powers for part in parts), strict=True))
    while True:
        coarse = [_coarser(part, powers) for part in parts]
        axes = range(len(powers))
        first = tuple(min(part.first[axis] for part in coarse) for axis in axes)
        last = [max(part.first[axis] + part.amount.shape[axis] for part in coarse) for axis in axes]
        too_many = [end - start > MAXIMUM for start, end in zip(first, last, strict=True)]
        if not any(too_many):
            break
        powers = tuple(power + many for power, many in zip(powers, too_many, strict=True))
    amount = np.zeros([end - start for start, end in zip(first, last, strict=True)])
    for part in coarse:
        place = tuple(
            slice(own - start, own - start + size)
            for own, start, size in zip(part.first, first, part.amount.shape, strict=True)
        )
        amount[place] += part.amount
    return Classes(powers, first, amount)


def added_by_name(one: Mapping[str, Classes], other: Mapping[str, Classes]) -> dict[str, Classes]:
    """Distributions of the same names together; those of one alone as they are.

    Parameters
    ----------
    one, other : Mapping[str, Classes]
        By name, over the same quantities.
    """
    result = dict(one)
    for name, classes in other.items():
        result[name] = added([result[name], classes]) if name in result else classes
    return result


def _coarser(part: Classes, powers: Sequence[int]) -> Classes:
    amount, first = part.amount, list(part.first)
    for axis, (power, own) in enumerate(zip(powers, part.powers, strict=True)):
        places = [(first[axis] + k) >> (power - own) for k in range(amount.shape[axis])]
        starts = [k for k, place in enumerate(places) if k == 0 or place != places[k - 1]]
        amount = np.add.reduceat(amount, starts, axis=axis)
        first[axis] = places[0]
    return Classes(tuple(powers), tuple(first), amount)
