"""Time and turns of the rotor at each level of several loads, and a torque's sums over both."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats
from fe_drivetrain.turbine_loads.histories.classes import Classes, added_by_name, in_classes
from fe_drivetrain.turbine_loads.histories.levels import torque_reversals

POWER = 10.0 / 3.0
"""Exponent of the life of roller bearings (ISO 281)."""

_BAND = 0.01  # of the largest torque of a history: below it a torque has no sign
_UNIT = 1e6  # torque is summed in MN m, so that its powers stay moderate


@dataclass(frozen=True, eq=False)
class LevelSums:
    """Load duration and load revolution distributions of several loads.

    Attributes
    ----------
    seconds : Mapping[str, Classes]
        Time at each level [s], by load.
    turns : Mapping[str, Classes]
        Turns of the rotor at each level, by load; empty where no rotor speed is known.
    """

    seconds: Mapping[str, Classes]
    turns: Mapping[str, Classes]

    def __add__(self, other: LevelSums) -> LevelSums:
        """Both together."""
        return LevelSums(
            added_by_name(self.seconds, other.seconds), added_by_name(self.turns, other.turns)
        )

    def of(self, names: Collection[str]) -> LevelSums:
        """Those of the named loads alone."""
        return LevelSums(
            {name: one for name, one in self.seconds.items() if name in names},
            {name: one for name, one in self.turns.items() if name in names},
        )


@dataclass(frozen=True, eq=False)
class TorqueSums:
    """Reversals of a torque, and its powers summed over time and turns.

    Attributes
    ----------
    reversals : float
        Changes of its sign beyond 1 % of the largest torque of a history.
    negative_seconds : float
        Time with a negative torque [s].
    over_time, over_turns : float
        Sums of |torque|^(10/3) over time [(MN m)^(10/3) s] and over turns [(MN m)^(10/3)]; NaN
        where no rotor speed is known.
    turns : float
        Turns of the rotor; NaN where no rotor speed is known.
    """

    reversals: float
    negative_seconds: float
    over_time: float
    over_turns: float
    turns: float

    def __add__(self, other: TorqueSums) -> TorqueSums:
        """Both together."""
        return TorqueSums(
            self.reversals + other.reversals,
            self.negative_seconds + other.negative_seconds,
            self.over_time + other.over_time,
            self.over_turns + other.over_turns,
            self.turns + other.turns,
        )

    def equivalent_over_time(self, seconds: float) -> float:
        """Constant torque of the same effect on roller bearings in the same time [N m]."""
        return _UNIT * float((self.over_time / seconds) ** (1.0 / POWER))

    @property
    def equivalent_over_turns(self) -> float | None:
        """Constant torque of the same effect in as many turns [N m]; None where none is known."""
        if not self.turns > 0.0:
            return None
        return _UNIT * float((self.over_turns / self.turns) ** (1.0 / POWER))


NO_TORQUE = TorqueSums(np.nan, np.nan, np.nan, np.nan, np.nan)
"""Sums where no torque is known."""


def turns_of(rotor_speed: Floats, step: float | Floats) -> Floats:
    """Turns of the rotor in each sample: (n,) of speeds (n,) [rad/s] and a step or steps [s]."""
    return np.asarray(np.abs(rotor_speed) * step / (2.0 * np.pi))


def level_sums(
    channels: Mapping[str, Floats], step: float | Floats, turns: Floats | None
) -> LevelSums:
    """Put the samples of each load into classes of level.

    Parameters
    ----------
    channels : Mapping[str, ndarray]
        Samples (n,) by name.
    step : float or ndarray, (n,)
        Time that each sample stands for [s].
    turns : ndarray, (n,) or None
        Turns of the rotor in each sample, see `turns_of`.
    """
    named = next(iter(channels.values()))
    seconds = np.full(len(named), step)
    return LevelSums(
        {name: in_classes(samples, weights=seconds) for name, samples in channels.items()},
        {}
        if turns is None
        else {name: in_classes(samples, weights=turns) for name, samples in channels.items()},
    )


def torque_sums(
    torque: Floats,
    step: float | Floats,
    turns: Floats | None,
    pieces: Sequence[slice] = (slice(None),),
) -> TorqueSums:
    """Reversals of a torque, and its powers summed over time and turns.

    Parameters
    ----------
    torque : ndarray, (n,)
        The torque [N m].
    step : float or ndarray, (n,)
        Time that each sample stands for [s].
    turns : ndarray, (n,) or None
        Turns of the rotor in each sample, see `turns_of`.
    pieces : sequence of slice
        Samples between gaps: no reversal is counted over a gap.
    """
    band, each = _BAND * float(np.abs(torque).max()), np.full(len(torque), step)
    back = [torque_reversals(torque[one], 1.0, band) for one in pieces]
    negative = torque < 0.0
    powers = np.abs(torque / _UNIT) ** POWER
    return TorqueSums(
        float(sum(one.count for one in back)),
        _sum_of(step, negative),
        float(each @ powers),
        np.nan if turns is None else float(turns @ powers),
        np.nan if turns is None else float(turns.sum()),
    )


def _sum_of(step: float | Floats, chosen: Bools) -> float:
    """Time of the chosen samples [s]."""
    if isinstance(step, np.ndarray):
        return float(step[chosen].sum())
    return float(np.count_nonzero(chosen)) * step
