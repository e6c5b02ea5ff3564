"""Rainflow cycles of several channels in sums that add up over histories.

Damage is a sum of n r^m over exact ranges, so that it does not depend on classes; classes hold the
number of cycles for charts and tables.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.turbine_loads.histories.classes import Classes, added_by_name, in_classes
from fe_drivetrain.turbine_loads.histories.cycles import Residue, gated, joined, rainflow_cycles
from fe_drivetrain.turbine_loads.histories.damage import FREQUENCY, SLOPES, goodman

_MEANS = 24  # classes of range, and of mean, of cycles by both, at least


@dataclass(frozen=True)
class CycleRule:
    """How cycles are counted.

    Attributes
    ----------
    slopes : tuple of float
        Exponents of S-N curves.
    residue : str
        Rule for cycles that the end of a history leaves open.
    gate : float
        Cycles of a smaller range are left out, as a share of the largest one of the channel in
        its history.
    ultimate : Mapping[str, float]
        Loads that break the part, by channel, in its unit: cycles of these are counted about zero
        mean, too, by Goodman's line.
    by_mean : tuple of str
        Channels whose cycles are counted by range and mean, too.
    """

    slopes: tuple[float, ...] = SLOPES
    residue: Residue = "half"
    gate: float = 0.0
    ultimate: Mapping[str, float] = field(default_factory=dict)
    by_mean: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class CycleSums:
    """Cycles of c channels, for s slopes of S-N curves.

    Attributes
    ----------
    damage : ndarray, (c, s)
        Sums of n r^m.
    halves : ndarray, (c, s)
        The part of half cycles in them.
    about_zero : ndarray, (c, s)
        The same of cycles about zero mean by Goodman's line; NaN where no ultimate load is given.
    largest, number, left_out : ndarray, (c,)
        Largest range, number of cycles, and of those below the gate.
    ranges : Mapping[str, Classes]
        Number of cycles by range, of each channel.
    ranges_and_means : Mapping[str, Classes]
        Number of cycles by range and mean, of the channels that were asked for.
    """

    damage: Floats
    halves: Floats
    about_zero: Floats
    largest: Floats
    number: Floats
    left_out: Floats
    ranges: Mapping[str, Classes]
    ranges_and_means: Mapping[str, Classes]

    def __add__(self, other: CycleSums) -> CycleSums:
        """Both together, of the same channels and slopes."""
        return CycleSums(
            self.damage + other.damage,
            self.halves + other.halves,
            self.about_zero + other.about_zero,
            np.maximum(self.largest, other.largest),
            self.number + other.number,
            self.left_out + other.left_out,
            added_by_name(self.ranges, other.ranges),
            added_by_name(self.ranges_and_means, other.ranges_and_means),
        )

    def of(self, names: Collection[str]) -> CycleSums:
        """The same, with classes of the named channels alone."""
        both = self.ranges_and_means
        return replace(
            self,
            ranges={name: one for name, one in self.ranges.items() if name in names},
            ranges_and_means={name: one for name, one in both.items() if name in names},
        )


def count_cycles(
    channels: Mapping[str, Floats], rule: CycleRule, pieces: Sequence[slice] = (slice(None),)
) -> CycleSums:
    """Count the cycles of each channel of a history.

    Parameters
    ----------
    channels : Mapping[str, ndarray]
        Samples (n,) by name.
    rule : CycleRule
        How they are counted.
    pieces : sequence of slice
        Samples between gaps: no cycle leads over a gap.

    Raises
    ------
    InputError
        The mean of a cycle reaches the ultimate load.
    """
    damage = np.zeros((len(channels), len(rule.slopes)))
    halves, about_zero = np.zeros_like(damage), np.full_like(damage, np.nan)
    numbers = np.zeros((len(channels), 3))
    ranges, both = {}, {}
    for c, (name, samples) in enumerate(channels.items()):
        cycles = joined(
            [rainflow_cycles(samples[one], rule.residue) for one in pieces], rule.residue
        )
        widest = float(cycles.ranges.max(initial=0.0))
        if rule.gate:
            cycles = gated(cycles, rule.gate * widest)
        half = cycles.counts < 1.0
        damage[c] = _sums(cycles.counts, cycles.ranges, rule.slopes)
        halves[c] = _sums(cycles.counts[half], cycles.ranges[half], rule.slopes)
        numbers[c] = widest, cycles.counts.sum(), cycles.left_out
        if name in rule.ultimate:
            same = goodman(cycles, rule.ultimate[name])
            about_zero[c] = _sums(same.counts, same.ranges, rule.slopes)
        ranges[name] = in_classes(cycles.ranges, weights=cycles.counts)
        if name in rule.by_mean:
            both[name] = in_classes(
                cycles.ranges, cycles.means, weights=cycles.counts, least=_MEANS
            )
    largest, number, left_out = numbers.T
    return CycleSums(damage, halves, about_zero, largest, number, left_out, ranges, both)


def equivalent_loads(
    damage: Floats, seconds: float, slopes: Floats, frequency: float = FREQUENCY
) -> Floats:
    """Damage-equivalent loads of sums of n r^m.

    Parameters
    ----------
    damage : ndarray, (c, s)
        Sums of n r^m.
    seconds : float
        How long the histories last [s].
    slopes : ndarray, (s,)
        Exponents m.
    frequency : float
        Frequency of the sine that does the same damage [Hz].

    Returns
    -------
    ndarray, (c, s)
        Ranges of that sine, in the unit of each channel.
    """
    return np.asarray((damage / (frequency * seconds)) ** (1.0 / slopes))


def _sums(counts: Floats, ranges: Floats, slopes: Sequence[float]) -> list[float]:
    return [float(counts @ ranges**m) for m in slopes]
