"""Damage of a rolling bearing by ISO 281: equivalent loads need no equilibrium of rollers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.limits import check_speed
from fe_drivetrain.bearing_life.life.modified_life import life_factor
from fe_drivetrain.bearing_life.life.rated import RatedBearing
from fe_drivetrain.common.arrays import Bools, Floats
from fe_drivetrain.common.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class StandardDamage:
    """Damage by ISO 281, whose equivalent loads need no rollers.

    Attributes
    ----------
    turns : float
        Turns of the ring, without those below the speed of standing.
    standing : float
        Time below that speed [s].
    of_standard : Floats
        (2,) damage by L10 and by L10m.
    """

    turns: float
    standing: float
    of_standard: Floats

    __repr__ = short_repr

    def __add__(self, other: StandardDamage) -> StandardDamage:
        """Damage of both."""
        return StandardDamage(
            self.turns + other.turns,
            self.standing + other.standing,
            self.of_standard + other.of_standard,
        )


def standard_damage(
    rated: RatedBearing,
    loads: ArrayLike,
    speed_rpm: ArrayLike,
    seconds: ArrayLike,
    rules: LifeRules,
) -> StandardDamage:
    """Damage by L10 and L10m alone, of any number of steps.

    Parameters
    ----------
    rated : RatedBearing
        The bearing.
    loads : array_like, (n, 5)
        Loads that rolling elements carry [N, N m].
    speed_rpm, seconds : array_like, (n,)
        Speed of one ring against the other [1/min], and how long each step lasts [s].
    rules : LifeRules
        Choices.

    Raises
    ------
    InputError
        No such bearing turns as fast, see `check_speed`.
    """
    P, lasting = rated.equivalent_load(loads), np.asarray(seconds, dtype=float)
    speed = np.asarray(speed_rpm, dtype=float)
    spent = spent_by(rated, P, speed, lasting, rules, np.ones(len(P), dtype=bool))
    stands = np.abs(speed) < rules.standing_rpm
    return StandardDamage(float(spent.turns.sum()), float(lasting[stands].sum()), spent.standard)


@dataclass(frozen=True, eq=False)
class Spent:
    """Turns (n,) of steps, viscosity ratio, a_ISO of loads (n, m), damage (2,) by ISO 281."""

    turns: Floats
    kappa: Floats
    factor: Callable[[Floats], Floats]
    standard: Floats


def spent_by(
    rated: RatedBearing,
    P: Floats,
    speed_rpm: Floats,
    seconds: Floats,
    rules: LifeRules,
    counted: Bools,
) -> Spent:
    """What steps with equivalent loads (n,) spend of a life by ISO 281."""
    check_speed(rated, speed_rpm)
    speed = np.abs(speed_rpm)
    runs = (speed >= rules.standing_rpm) & counted
    turns = np.where(runs, speed * seconds / 60.0, 0.0)
    kappa, factor = _lubrication(rated, rules, np.maximum(speed, max(rules.standing_rpm, 1e-3)))
    used = 1e-6 * turns * (P / rated.dynamic) ** rated.exponent
    a_whole = factor(P[:, None] * (1 if not rules.limit_per_row else 1.0 / len(rated.bearing.rows)))
    standard = np.array([used.sum(), (used / a_whole[:, 0]).sum() / rules.reliability])
    return Spent(turns, kappa, factor, standard)


def _lubrication(
    rated: RatedBearing, rules: LifeRules, speed: Floats
) -> tuple[Floats, Callable[[Floats], Floats]]:
    """Viscosity ratio of each step, and a_ISO of loads (n, m) of rows."""
    if rules.lubricant is None:
        return np.full(len(speed), np.nan), np.ones_like
    kappa = rules.lubricant.kappa(speed, rated.pitch_diameter)
    e_C = rules.lubricant.contamination(kappa, rated.pitch_diameter)
    rows = len(rated.bearing.rows) if rules.limit_per_row else 1
    contact: Literal["line", "point"] = "point" if rated.balls else "line"

    def factor(P: Floats) -> Floats:
        with np.errstate(divide="ignore"):
            ratio = (e_C * rated.fatigue / rows)[:, None] / P
        return life_factor(ratio, kappa[:, None], contact)

    return kappa, factor
