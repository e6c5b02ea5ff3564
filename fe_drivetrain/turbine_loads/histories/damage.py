"""Damage of counted cycles by Miner's rule, and the load of one range that does the same.

A damage-equivalent load is a range. Rolling bearings and gear flanks are not loaded in cycles of
force: their lives follow the load and the turns at it (`levels`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.histories.cycles import Cycles

SLOPES = (3.0, 4.0, 10.0)
"""Exponents of S-N curves where none is asked for: welded joints, forged steel, composites."""

FREQUENCY = 1.0
"""Of the equivalent load [Hz] where none is asked for."""


@dataclass(frozen=True)
class SNCurve:
    """Cycles that a part endures against load, straight in logarithms, with one knee.

    Attributes
    ----------
    load : float
        At the knee, as range or amplitude: in the unit of the cycles that it is used on.
    cycles : float
        Endured at the knee.
    slope : float
        Exponent above the knee.
    slope_below : float or None
        Exponent below; the same where None (Miner's elementary rule); infinite for an endurance
        limit; 2 k - 1 after Haibach.
    """

    load: float
    cycles: float
    slope: float
    slope_below: float | None = None

    def endured(self, loads: Floats) -> Floats:
        """Cycles until failure at each load: (n,)."""
        below = self.slope if self.slope_below is None else self.slope_below
        ratio = np.asarray(loads, dtype=float) / self.load
        with np.errstate(divide="ignore", over="ignore"):
            power = ratio ** -np.where(ratio >= 1.0, self.slope, below)
            return np.asarray(self.cycles * power)


def miner_damage(loads: Floats, counts: Floats, curve: SNCurve) -> float:
    """Sum of cycles over endured cycles (Miner 1945); 1 is failure.

    Parameters
    ----------
    loads : ndarray, (n,)
        Range or amplitude of each, as the curve has it.
    counts : ndarray, (n,)
        Cycles at each.
    curve : SNCurve
        What is endured.
    """
    return float(np.sum(np.asarray(counts) / curve.endured(loads)))


def damage_equivalent_load(
    cycles: Sequence[Cycles], seconds: float, slope: float, frequency: float = FREQUENCY
) -> float:
    """Range of the sine that does the same damage in the same time, by Miner's rule.

    ``(sum n r^m / (f T))^(1/m)``: cycles of range r count as r^m, whatever their mean (`goodman`
    takes the mean into account).

    Parameters
    ----------
    cycles : sequence of Cycles
        Cycles of one or more histories, which are added.
    seconds : float
        How long all of them last together [s].
    slope : float
        Exponent m of the S-N curve.
    frequency : float
        Frequency of the sine [Hz].

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
    ranges = np.concatenate([np.zeros(0), *(c.ranges for c in cycles)])
    counts = np.concatenate([np.zeros(0), *(c.counts for c in cycles)])
    largest = float(ranges.max(initial=0.0))
    if largest == 0.0:
        return 0.0
    # relative to the largest: a large range to a large power overflows
    damage = float(np.sum(counts * (ranges / largest) ** slope))
    return largest * float((damage / (frequency * seconds)) ** (1.0 / slope))


def goodman(cycles: Cycles, ultimate: float, mean: float = 0.0) -> Cycles:
    """Cycles of equal damage about one mean, by Goodman's straight line (1899).

    ``r (U - |mean|) / (U - |m|)`` of a cycle of range r about m, U the ultimate load, as the
    postprocessor MLife has it (Hayman 2012).

    Parameters
    ----------
    cycles : Cycles
        About any means.
    ultimate : float
        Load that breaks the part at once, in the unit of the history.
    mean : float
        About which the others are to be.

    Raises
    ------
    InputError
        A mean reaches the ultimate load.
    """
    largest = max(float(np.abs(cycles.means).max(initial=0.0)), abs(mean))
    if not largest < ultimate:
        raise InputError(
            f"cycles about a mean of up to {largest:g} reach the ultimate load {ultimate:g}, at "
            "which Goodman's line ends: give the load that breaks the part, in the same unit"
        )
    factor = (ultimate - abs(mean)) / (ultimate - np.abs(cycles.means))
    return replace(cycles, ranges=cycles.ranges * factor, means=np.full_like(cycles.means, mean))


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
