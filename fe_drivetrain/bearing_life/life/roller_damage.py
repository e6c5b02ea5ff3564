"""Damage of a rolling bearing by load steps: how much of its life, and where.

Each step takes a share of the life that the bearing would have under it alone (Miner's rule on the
life of the whole bearing: Stirling 2023, eqs 5.16 to 5.21), weighted by the turns that it lasts.
Within a step the risks of all laminae of all rows and rings add up (ISO/TS 16281); each lamina
takes its part of the step's damage, and each roller position its part of the lamina's. So all parts
sum to the damage of the bearing.

Steps come in chunks and only sums are kept: memory does not grow with the length of a history.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.geometry import BallRow
from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.limits import Limits, limits_of
from fe_drivetrain.bearing_life.life.modified_life import MIX
from fe_drivetrain.bearing_life.life.rated import RatedBearing
from fe_drivetrain.bearing_life.life.reference_life import (
    LINE,
    POINT_SLOPE,
    SLOPE,
    TURNING,
    ball_capacities,
    race_capacities,
    stress_riser,
)
from fe_drivetrain.bearing_life.life.standard_damage import spent_by
from fe_drivetrain.bearing_life.life.steps import Steps
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError, require_known
from fe_drivetrain.common.short_repr import short_repr

KINDS = ("L10", "L10m", "L10r", "L10mr")
"""Basic and modified life of ISO 281; basic and modified reference life of ISO/TS 16281."""


@dataclass(frozen=True, eq=False)
class Damage:
    """Damage that steps have done: 1 is the end of the life with a reliability of 90 %.

    Attributes
    ----------
    seconds, turns : float
        How long all steps lasted [s], those at standstill with them; and turns of the ring [-].
    basic, modified : tuple of Floats
        For each row (2 rings, elements, laminae): parts of the damage by L10r, and by L10mr, of
        the inner and the outer ring; of a ring that stands at the place of each element, of one
        that turns by where it takes the load.
    of_standard, of_bearing : Floats
        (2,) damage by L10 and by L10m; by L10r and by L10mr, from the lives of steps.
    alone : Floats
        (2, rows, 2) basic and modified damage of each row's inner and outer ring if it were alone:
        more than its part, since risks add up by Weibull's slope.
    limits : Limits
        What the method does not hold for.
    """

    seconds: float
    turns: float
    basic: tuple[Floats, ...]
    modified: tuple[Floats, ...]
    of_standard: Floats
    of_bearing: Floats
    alone: Floats
    limits: Limits

    __repr__ = short_repr

    def __add__(self, other: Damage) -> Damage:
        """Damage of both."""
        return Damage(
            self.seconds + other.seconds,
            self.turns + other.turns,
            tuple(a + b for a, b in zip(self.basic, other.basic, strict=True)),
            tuple(a + b for a, b in zip(self.modified, other.modified, strict=True)),
            self.of_standard + other.of_standard,
            self.of_bearing + other.of_bearing,
            self.alone + other.alone,
            self.limits + other.limits,
        )

    def times(self, factor: float) -> Damage:
        """The same steps so many times; limits stay those of the steps themselves.

        Parameters
        ----------
        factor : float
            0 or more.

        Returns
        -------
        damage : Damage
            Times and damage multiplied.
        """
        return Damage(
            factor * self.seconds,
            factor * self.turns,
            tuple(factor * a for a in self.basic),
            tuple(factor * a for a in self.modified),
            factor * self.of_standard,
            factor * self.of_bearing,
            factor * self.alone,
            self.limits,
        )

    @property
    def totals(self) -> dict[str, float]:
        """Damage by each of `KINDS`."""
        return {
            "L10": float(self.of_standard[0]),
            "L10m": float(self.of_standard[1]),
            "L10r": float(self.of_bearing[0]),
            "L10mr": float(self.of_bearing[1]),
        }

    def lives(self, unit: Literal["Mrev", "hours", "years"] = "hours") -> dict[str, float]:
        """Life if these steps came again and again, by each of `KINDS`; infinite without damage.

        Parameters
        ----------
        unit : {"Mrev", "hours", "years"}
            Million revolutions, or time with standstill.

        Returns
        -------
        lives : dict
            In that unit.

        Raises
        ------
        InputError
            There is no such unit.
        """
        amounts = {
            "Mrev": 1e-6 * self.turns,
            "hours": self.seconds / 3600.0,
            "years": self.seconds / 3600.0 / 8760.0,
        }
        require_known("unit of a life", unit, amounts)
        amount = amounts[unit]
        return {kind: amount / d if d else np.inf for kind, d in self.totals.items()}

    def of_rows(self, modified: bool = False) -> Floats:
        """Parts of rows and rings, (rows, 2), summing to the damage by L10r or L10mr."""
        return np.array([part.sum(axis=(1, 2)) for part in self._parts(modified)])

    def of_positions(self, row: int, modified: bool = False) -> Floats:
        """Parts of the places of a row's elements, (2, elements), inner and outer ring."""
        return np.asarray(self._parts(modified)[row].sum(axis=2))

    def of_laminae(self, row: int, modified: bool = False) -> Floats:
        """Parts of a row's laminae, (2, laminae), inner and outer ring."""
        return np.asarray(self._parts(modified)[row].sum(axis=1))

    def _parts(self, modified: bool) -> tuple[Floats, ...]:
        return self.modified if modified else self.basic


def step_risks(rated: RatedBearing, laminae: Sequence[Floats], rules: LifeRules) -> list[Floats]:
    """Risk of each lamina for a million turns under each step.

    Parameters
    ----------
    rated : RatedBearing
        The bearing.
    laminae : sequence of Floats
        For each row (n, elements, laminae) [N].
    rules : LifeRules
        Choices.

    Returns
    -------
    risks : list of Floats
        For each row (2, n, laminae), of inner and outer ring: 1 / L^e with Weibull's slope e, 9/8
        of rollers and 10/9 of balls. The sum of all, to the power of -1/e, is L10r
        [million revolutions].
    """
    return [_row_risks(rated, r, q, rules)[0] for r, q in enumerate(laminae)]


def step_lives(rated: RatedBearing, laminae: Sequence[Floats], rules: LifeRules) -> Floats:
    """L10r of each step, (n,) [million revolutions]; see `step_risks`."""
    total = np.sum([risk.sum(axis=(0, 2)) for risk in step_risks(rated, laminae, rules)], axis=0)
    with np.errstate(divide="ignore"):
        return np.asarray(total ** (-1.0 / _slope(rated)))


def damage_of_steps(steps: Steps, rated: RatedBearing, rules: LifeRules) -> Damage:
    """Damage of a chunk of steps.

    Parameters
    ----------
    steps : Steps
        Some hundred to a few thousand.
    rated : RatedBearing
        The bearing.
    rules : LifeRules
        Choices.

    Returns
    -------
    damage : Damage
        Damage of these steps; several chunks' add up. Steps without equilibrium do no damage and
        are counted in `Limits.lost`.

    Raises
    ------
    InputError
        No such bearing turns as fast, see `check_speed`.
    """
    slope = _slope(rated)
    P = rated.equivalent_load(steps.loads)
    spent = spent_by(rated, P, steps.speed_rpm, steps.seconds, rules, steps.converged)
    turns, kappa, factor = spent.turns, spent.kappa, spent.factor
    found = [_row_risks(rated, r, q, rules) for r, q in enumerate(steps.laminae)]
    a_iso = [factor(row.P) for _, row in found]
    basic_risks = [risk for risk, _ in found]
    modified_risks = [risk * a[None] ** -slope for risk, a in zip(basic_risks, a_iso, strict=True)]
    parts, alone, of_bearing = [], [], []
    for risks, a_1 in ((basic_risks, 1.0), (modified_risks, rules.reliability)):
        total = np.sum([risk.sum(axis=(0, 2)) for risk in risks], axis=0)
        million = 1e-6 * turns / a_1
        of_bearing.append(float(million @ total ** (1.0 / slope)))
        rate = np.zeros_like(total)
        loaded = total > 0.0
        rate[loaded] = million[loaded] * total[loaded] ** (1.0 / slope - 1.0)
        parts.append(
            tuple(
                np.stack([_by_place(rate, risk[i], row, i) for i in (0, 1)])
                for risk, (_, row) in zip(risks, found, strict=True)
            )
        )
        alone.append(
            [[million @ risk[i].sum(axis=1) ** (1 / slope) for i in (0, 1)] for risk in risks]
        )
    risk = np.sum([risk.sum(axis=(0, 2)) for risk in basic_risks], axis=0)
    limits = limits_of(steps, rated, rules.standing_rpm, kappa, P, risk)
    return Damage(
        float(steps.seconds.sum()),
        float(turns.sum()),
        parts[0],
        parts[1],
        spent.standard,
        np.array(of_bearing),
        np.array(alone),
        limits,
    )


def damage_of_history(chunks: Iterable[Steps], rated: RatedBearing, rules: LifeRules) -> Damage:
    """Damage of chunks of steps, one after the other.

    Parameters
    ----------
    chunks : iterable of Steps
        As they come; none is kept.
    rated : RatedBearing
        The bearing.
    rules : LifeRules
        Choices.

    Returns
    -------
    damage : Damage
        The sum.

    Raises
    ------
    InputError
        There is no step.
    """
    total: Damage | None = None
    for steps in chunks:
        one = damage_of_steps(steps, rated, rules)
        total = one if total is None else total + one
    if total is None:
        raise InputError(f"life of {rated.bearing.name}: there is no load step")
    return total


@dataclass(frozen=True, eq=False)
class _Row:
    """Equivalent loads of a row, and how its places share a risk.

    Attributes
    ----------
    P : Floats
        (n, laminae) [N].
    powers : tuple of Floats
        For both rings (n, elements, laminae), in proportion to which places share.
    over_sums : tuple of Floats
        For both rings (n, laminae) one over the sums of these; 0 without a load.
    """

    P: Floats
    powers: tuple[Floats, Floats]
    over_sums: tuple[Floats, Floats]


def _slope(rated: RatedBearing) -> float:
    return POINT_SLOPE if rated.balls else SLOPE


def _row_risks(
    rated: RatedBearing, r: int, laminae: ArrayLike, rules: LifeRules
) -> tuple[Floats, _Row]:
    row, rows = rated.bearing.rows[r], len(rated.bearing.rows)
    q = np.asarray(laminae, dtype=float)
    count = q.shape[2]
    if isinstance(row, BallRow):
        turning, standing, power = 3.0, 10.0 / 3.0, 10.0 / 3.0
        inner, outer = ball_capacities(row, rated.dynamic, rows)
    else:
        turning, standing, power = TURNING, LINE, LINE
        if rules.riser == "standard":
            q = q * stress_riser(count)
        inner, outer = race_capacities(row, rated.dynamic, rows, rules.reduction)
        inner, outer = (c * count ** (-7.0 / 9.0) for c in (inner, outer))
    # powers of q where the ring turns, and where it stands
    moving: Floats = np.power(q, 3.0) if isinstance(row, BallRow) else np.square(np.square(q))
    still: Floats = moving * (np.cbrt(q) if isinstance(row, BallRow) else np.sqrt(q))
    by_ring = (moving, still) if rules.turning == "inner" else (still, moving)
    exponents = (turning, standing) if rules.turning == "inner" else (standing, turning)
    loads, risks, over_sums = [], [], []
    for powers, p, capacity in zip(by_ring, exponents, (inner, outer), strict=True):
        mean = powers.mean(axis=1)
        load = mean ** (1.0 / p)
        loads.append(load)
        risks.append((load / capacity) ** power)
        whole = powers.shape[1] * mean
        over_sums.append(np.divide(1.0, whole, out=np.zeros_like(whole), where=whole > 0.0))
    risk = np.stack(risks)
    if isinstance(row, BallRow):
        # one load of the whole row: what has its life by the basic rating
        row_capacity = rated.dynamic / rows**0.7
        P = row_capacity * risk.sum(axis=0) ** (1.0 / (3.0 * POINT_SLOPE))
    else:
        weight = (1.038 * inner / outer) ** LINE
        mixed = (loads[0] ** LINE + weight * loads[1] ** LINE) / (1.0 + weight)
        scale = MIX * rules.reduction * q.shape[1] * np.cos(row.angle) * count
        P = scale * mixed ** (1.0 / LINE)
    return risk, _Row(P, by_ring, (over_sums[0], over_sums[1]))


def _by_place(rate: Floats, risk: Floats, row: _Row, ring: int) -> Floats:
    """(elements, laminae): sum over steps of a rate (n,) times risks (n, laminae), by place."""
    weights = rate[:, None] * risk * row.over_sums[ring]
    return np.asarray(np.einsum("nk,njk->jk", weights, row.powers[ring]))
