"""Sums of floating-point numbers without rounding, so that their order does not matter."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import ArrayLike

_MINIMUM = -1074  # the power of two of the smallest number
_HALF = 26  # bits of the lower part of a significand
_AT_ONCE = 1 << 24  # parts of 27 bits of so many numbers have a sum below 2**53


@dataclass(frozen=True)
class ExactSum:
    """A sum, which others can be added to.

    Attributes
    ----------
    units : int
        In units of the smallest number that a double can hold, 2^-1074.
    """

    units: int = 0

    def __add__(self, other: ExactSum) -> ExactSum:
        """Both together."""
        return ExactSum(self.units + other.units)

    def __float__(self) -> float:
        """The nearest double."""
        return float(Fraction(self.units, 1 << -_MINIMUM))


def exact_sum(values: ArrayLike) -> ExactSum:
    """The sum of finite values.

    Each is a whole number of up to 53 bits times a power of two; numbers of one power are added as
    whole numbers, and the sums of all powers as Python's, which have no end.

    Parameters
    ----------
    values : array_like
        Values of any shape.

    Raises
    ------
    ValueError
        One is not finite.
    """
    flat = np.asarray(values, dtype=np.float64).ravel()
    if not np.isfinite(flat).all():
        raise ValueError("a value to be summed is not finite")
    units = 0
    for start in range(0, len(flat), _AT_ONCE):
        fraction, power = np.frexp(flat[start : start + _AT_ONCE])
        whole = np.ldexp(fraction, 53)
        upper = np.floor(np.ldexp(whole, -_HALF))
        lower = whole - np.ldexp(upper, _HALF)
        first = int(power.min()) if len(power) else 0
        places = power - first
        for part, shift in ((upper, _HALF), (lower, 0)):
            for place, total in enumerate(np.bincount(places, part)):
                bits = first + place - 53 + shift - _MINIMUM
                number = int(total)
                # what a shift to the right takes away is zero: no value has bits below the lowest
                units += number << bits if bits >= 0 else number >> -bits
    return ExactSum(units)
