"""Load cycles of a history by rainflow counting, and the load that does the same damage.

Counting follows ASTM E1049-85 (2017), 5.4.4, as the package `rainflow` does it: no classes, no
hysteresis filter; what is left over at the end, the residue, counts as half cycles.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

SLOPES = (3.0, 4.0, 10.0)
"""Exponents of S-N curves where none is asked for: welded joints, forged steel, composites."""

FREQUENCY = 1.0
"""Of the equivalent load [Hz] where none is asked for."""

RULE = (
    "rainflow counting, ASTM E1049-85, without classes; half cycles of the residue count as halves"
)


@dataclass(frozen=True)
class Cycles:
    """Cycles of one history.

    Attributes
    ----------
    ranges : ndarray, (n,)
        Largest less smallest value of each, in the unit of the history.
    counts : ndarray, (n,)
        1 for a whole cycle, 0.5 for a half.
    """

    ranges: Floats
    counts: Floats


def reversals(signal: ArrayLike) -> Floats:
    """Values at which a history turns, with its first and its last.

    Parameters
    ----------
    signal : array_like, (n,)
        The history.

    Returns
    -------
    ndarray, (m,)
    """
    values = np.asarray(signal, dtype=float)
    steps = np.diff(values)
    values = values[np.concatenate([[True], steps != 0.0])]  # a plateau is one value
    turns = np.diff(values[:-1]) * np.diff(values[1:]) < 0.0 if len(values) > 2 else np.array([])
    kept = np.ones(len(values), dtype=bool)
    kept[1:-1] = turns.astype(bool)
    return np.asarray(values[kept])


def rainflow_cycles(signal: ArrayLike) -> Cycles:
    """Count the cycles of a history.

    Parameters
    ----------
    signal : array_like, (n,)
        The history; the time between its samples does not matter.

    Returns
    -------
    Cycles
        None of a history that is constant.

    Raises
    ------
    InputError
        A value is not finite.
    """
    from rainflow import extract_cycles

    if not np.isfinite(signal).all():
        raise InputError("a history to count cycles of holds a value that is not finite: remove it")
    points = reversals(signal)
    found = [(size, count) for size, _, count, _, _ in extract_cycles(points.tolist())]
    if len(points) == 2:  # for which the package yields nothing
        found = [(abs(float(points[1] - points[0])), 0.5)]
    table = np.array(found).reshape(-1, 2)
    return Cycles(table[:, 0], table[:, 1])


def damage_equivalent_load(
    cycles: Sequence[Cycles], seconds: float, slope: float, frequency: float = FREQUENCY
) -> float:
    """Range of the sine that does the same damage in the same time, by Miner's rule.

    ``(sum n r^m / (f T))^(1/m)``: cycles of range r count as r^m, whatever their mean.

    Parameters
    ----------
    cycles : sequence of Cycles
        Of one or more histories, which are added.
    seconds : float
        How long all of them last together [s].
    slope : float
        Exponent m of the S-N curve.
    frequency : float
        Of the sine [Hz].

    Returns
    -------
    float
        In the unit of the histories.

    Raises
    ------
    InputError
        The slope is not from 1 to 20, or time or frequency is not positive.
    """
    check_slope(slope)
    if not seconds > 0.0 or not frequency > 0.0:
        raise InputError(
            f"cycles over {seconds:g} s at a reference frequency of {frequency:g} Hz: both must be "
            "above 0"
        )
    ranges = np.concatenate([c.ranges for c in cycles])
    counts = np.concatenate([c.counts for c in cycles])
    largest = float(ranges.max(initial=0.0))
    if largest == 0.0:
        return 0.0
    # relative to the largest: a large range to a large power overflows
    damage = float(np.sum(counts * (ranges / largest) ** slope))
    return largest * float((damage / (frequency * seconds)) ** (1.0 / slope))


def check_slope(slope: float) -> None:
    """Refuse a slope of an S-N curve that is none.

    Parameters
    ----------
    slope : float
        The exponent.

    Raises
    ------
    InputError
        It is not from 1 to 20.
    """
    if not 1.0 <= slope <= 20.0:
        raise InputError(
            f"slope {slope:g} of an S-N curve must be from 1 to 20: 3 is usual for welded joints, "
            "10 for composites"
        )
