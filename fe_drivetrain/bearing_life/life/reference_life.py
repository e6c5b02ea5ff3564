"""Basic reference rating life: from the laminae of rollers to a row, a ring and the whole bearing.

The equations are those of ISO/TS 16281, for rollers as Stirling (2023, section 5.3.1) prints them.
Their constants were not read in the standard; those for balls, too, are as public code has them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.answers import lamina_loads
from fe_drivetrain.bearing.geometry import BallRow, Bearing, RollerRow, pitch_ratio
from fe_drivetrain.bearing.rating import LAMBDA
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError, require_known
from fe_drivetrain.common.short_repr import short_repr

LINE = 4.5
"""Exponent of load to damage in line contact; 1 / LINE of a mean over a ring that stands."""

TURNING = 4.0
"""The exponent of the mean over a ring that turns against the load."""

SLOPE = 9.0 / 8.0
"""Weibull's slope of line contact: parts with lives L combine as L^-SLOPE."""

POINT_SLOPE = 10.0 / 9.0
"""The same of point contact."""

RATIO = 143.0 / 108.0
"""Exponent of (1 - gamma) / (1 + gamma) in the capacities of line contact."""

Turning = Literal["inner", "outer"]

RINGS: tuple[Turning, ...] = ("inner", "outer")


@dataclass(frozen=True)
class RowLoads:
    """What the laminae of a row carry on both races, as one load that does equal damage.

    Attributes
    ----------
    row : RollerRow
        The row.
    inner, outer : Floats
        (n, laminae) equivalent load of each lamina, over n cases [N].
    inner_capacity, outer_capacity : float
        Load that a lamina carries for a million revolutions on either race [N].
    edge : float
        Reduction for edge stress that was taken out of the capacities, lambda nu.
    """

    row: RollerRow
    inner: Floats
    outer: Floats
    inner_capacity: float
    outer_capacity: float
    edge: float

    __repr__ = short_repr

    @property
    def damage(self) -> Floats:
        """(n, laminae): (q_ei / q_ci)^4.5 + (q_ee / q_ce)^4.5."""
        inner: Floats = (self.inner / self.inner_capacity) ** LINE
        outer: Floats = (self.outer / self.outer_capacity) ** LINE
        return inner + outer


def stress_riser(laminae: int) -> Floats:
    """Edge stress of each lamina over that of an even load, as ISO/TS 16281 approximates it.

    Parameters
    ----------
    laminae : int
        Number of laminae of a roller.

    Returns
    -------
    factors : Floats
        (laminae,) f[k] = 1 - 0.01 / ln(1.985 |2k - n - 1| / (2n - 2)); 1 in the middle of an odd
        number, and for a single lamina.

    Raises
    ------
    InputError
        There is no lamina.

    Notes
    -----
    For rollers with the standard's reference profile, moderate loads and little misalignment.
    Straight rollers with these factors count the edges twice. Stirling (2023) proposes ones
    instead, for logarithmic profiles: then ``edge=1`` belongs to it, see `race_capacities`.
    """
    if laminae < 1:
        raise InputError(f"a roller has {laminae} laminae: give 1 or more, as 30")
    k = np.arange(1, laminae + 1)
    from_middle = np.abs(2.0 * k - laminae - 1.0) / max(2.0 * laminae - 2.0, 1.0)
    factors = np.ones(laminae)
    off = from_middle > 0.0
    factors[off] -= 0.01 / np.log(1.985 * from_middle[off])
    return factors


def race_capacities(
    row: RollerRow, capacity: float, rows: int = 1, edge: float = LAMBDA
) -> tuple[float, float]:
    """Load of a roller that the inner and the outer race carry for a million revolutions.

    Parameters
    ----------
    row : RollerRow
        One of the rows.
    capacity : float
        Basic dynamic radial load rating C of the whole bearing [N].
    rows : int
        Equal rows that C is for.
    edge : float
        Reduction for edge stress in C, lambda nu, to take out again because a stress riser puts it
        back. 0.83 in ISO/TS 16281; 1 where no stress riser is used, else the absence of edge stress
        counts twice and multiplies lives by 0.83^-4 = 2.107.

    Returns
    -------
    inner, outer : float
        Q_ci, Q_ce [N] (Stirling 2023, eqs 5.1 and 5.2).

    Raises
    ------
    InputError
        C or the reduction is not positive.
    """
    for name, value in (("dynamic load rating", capacity), ("reduction for edge stress", edge)):
        if not 0.0 < value < np.inf:
            raise InputError(f"{name} is {value:g}: give a positive number")
    gamma = abs(pitch_ratio(row))
    opening = (1.038 * ((1.0 - gamma) / (1.0 + gamma)) ** RATIO) ** LINE
    share = capacity / (edge * row.rollers * np.cos(row.angle) * rows ** (7.0 / 9.0))
    inner = share / 0.378 * (1.0 + opening) ** (1.0 / LINE)
    outer = share / 0.364 * (1.0 + 1.0 / opening) ** (1.0 / LINE)
    return float(inner), float(outer)


def row_loads(
    row: RollerRow,
    loads: ArrayLike,
    capacity: float,
    *,
    rows: int = 1,
    edge: float = LAMBDA,
    riser: ArrayLike | None = None,
    turning: Turning = "inner",
) -> RowLoads:
    """Equivalent loads of the laminae of a row.

    Parameters
    ----------
    row : RollerRow
        The row.
    loads : array_like
        (n, rollers, laminae) [N], from `fe_drivetrain.bearing.lamina_loads`.
    capacity : float
        C of the whole bearing [N].
    rows : int
        Equal rows that C is for.
    edge : float
        See `race_capacities`.
    riser : array_like, optional
        (laminae,) stress riser; that of ISO/TS 16281 if not given.
    turning : {"inner", "outer"}
        The ring that turns against the load: its mean over the rollers is of fourth powers, the
        other ring's of powers of 4.5 (Stirling 2023, eqs 5.6 and 5.7; the text there has them the
        other way round).

    Returns
    -------
    found : RowLoads
        Loads and capacities of the laminae.

    Raises
    ------
    InputError
        The ring that turns is neither, or shapes do not fit each other.
    """
    require_known("the ring that turns", turning, RINGS)
    q = np.asarray(loads, dtype=float)
    if q.ndim != 3 or q.shape[1] != row.rollers:
        raise InputError(
            f"lamina loads have the shape {q.shape}: give (cases, {row.rollers} rollers, laminae)"
        )
    laminae = q.shape[2]
    f = stress_riser(laminae) if riser is None else np.asarray(riser, dtype=float)
    if f.shape != (laminae,):
        raise InputError(
            f"stress riser has the shape {f.shape}: give one factor for each of {laminae} laminae"
        )
    exponents = (TURNING, LINE) if turning == "inner" else (LINE, TURNING)
    inner, outer = (np.mean((f * q) ** p, axis=1) ** (1.0 / p) for p in exponents)
    Q_ci, Q_ce = race_capacities(row, capacity, rows, edge)
    slice_share = laminae ** (-7.0 / 9.0)
    return RowLoads(row, inner, outer, Q_ci * slice_share, Q_ce * slice_share, edge)


def rows_of(
    bearing: Bearing,
    displacements: ArrayLike,
    capacity: float,
    *,
    edge: float = LAMBDA,
    riser: ArrayLike | None = None,
    turning: Turning = "inner",
) -> list[RowLoads]:
    """Equivalent loads of the laminae of all rows, at given displacements of the inner ring.

    Parameters
    ----------
    bearing : Bearing
        Bearing of equal rows of rollers with laminae.
    displacements : array_like
        (n, 5) [m, rad], from `fe_drivetrain.bearing.equilibrium`.
    capacity : float
        C of the whole bearing [N].
    edge : float
        See `race_capacities`.
    riser : array_like, optional
        (laminae,) stress riser; that of ISO/TS 16281 if not given.
    turning : {"inner", "outer"}
        The ring that turns against the load, see `row_loads`.

    Returns
    -------
    rows : list of RowLoads
        One for each row.

    Raises
    ------
    InputError
        The bearing has balls, or rollers without laminae.
    """
    found = []
    for row in bearing.rows:
        if not isinstance(row, RollerRow) or not row.laminae:
            raise InputError(
                f"life of {bearing.name} by laminae needs rollers with laminae in every row: give "
                "laminae=30, or `ball_life` the loads of balls"
            )
        loads = lamina_loads(row, displacements)
        found.append(
            row_loads(
                row,
                loads,
                capacity,
                rows=len(bearing.rows),
                edge=edge,
                riser=riser,
                turning=turning,
            )
        )
    return found


def lamina_life(rows: Sequence[RowLoads]) -> Floats:
    """Basic reference rating life L10r.

    Parameters
    ----------
    rows : sequence of RowLoads
        All rows of a bearing, or one of them.

    Returns
    -------
    life : Floats
        (n,) [million revolutions]: the sum of all damages of laminae to the power of -8/9
        (Stirling 2023, eqs 5.8 and 5.9); infinite without a load.
    """
    return _life(np.sum([row.damage.sum(axis=1) for row in rows], axis=0), SLOPE)


def ball_life(
    row: BallRow, loads: ArrayLike, capacity: float, *, rows: int = 1, turning: Turning = "inner"
) -> Floats:
    """Basic reference rating life of a row of balls.

    Parameters
    ----------
    row : BallRow
        The row.
    loads : array_like
        (n, balls) [N], from `fe_drivetrain.bearing.roller_loads`.
    capacity : float
        C of the whole bearing [N].
    rows : int
        Equal rows that C is for.
    turning : {"inner", "outer"}
        The ring that turns against the load.

    Returns
    -------
    life : Floats
        (n,) [million revolutions]; rows combine by `combined_life` with `POINT_SLOPE`.

    Raises
    ------
    InputError
        The ring that turns is neither.
    """
    require_known("the ring that turns", turning, RINGS)
    Q = np.asarray(loads, dtype=float)
    capacities = ball_capacities(row, capacity, rows)
    exponents = (3.0, 10.0 / 3.0) if turning == "inner" else (10.0 / 3.0, 3.0)
    damage = sum(
        (np.mean(Q**p, axis=1) ** (1.0 / p) / Q_c) ** (10.0 / 3.0)
        for p, Q_c in zip(exponents, capacities, strict=True)
    )
    return _life(np.asarray(damage), POINT_SLOPE)


def ball_capacities(row: BallRow, capacity: float, rows: int = 1) -> tuple[float, float]:
    """Load of a ball that the inner and the outer race carry for a million revolutions.

    Parameters
    ----------
    row : BallRow
        One of the rows.
    capacity : float
        C of the whole bearing [N].
    rows : int
        Equal rows that C is for.

    Returns
    -------
    inner, outer : float
        Q_ci, Q_ce [N], of ISO/TS 16281 as public code has it.
    """
    gamma, r_i, r_e = abs(pitch_ratio(row)), row.inner_groove, row.outer_groove
    grooves = r_i * (2.0 * r_e - row.diameter) / (r_e * (2.0 * r_i - row.diameter))
    opening = (1.044 * ((1.0 - gamma) / (1.0 + gamma)) ** 1.72 * grooves**0.41) ** (10.0 / 3.0)
    share = capacity / (row.balls * np.cos(row.angle) ** 0.7 * rows**0.7)
    inner = share / 0.407 * (1.0 + opening) ** 0.3
    outer = share / 0.389 * (1.0 + 1.0 / opening) ** 0.3
    return float(inner), float(outer)


def combined_life(lives: ArrayLike, slope: float = SLOPE) -> Floats:
    """Life of a bearing, or a set of them, of which all parts have to survive.

    Parameters
    ----------
    lives : array_like
        (..., parts) of rows, rings or bearings [any unit].
    slope : float
        Weibull's: 9/8 of line contact, 10/9 of point contact.

    Returns
    -------
    life : Floats
        (...) in the same unit: (sum of L^-slope)^(-1/slope).
    """
    with np.errstate(divide="ignore"):
        risk = np.sum(np.asarray(lives, dtype=float) ** -slope, axis=-1)
    return _life(risk, slope)


def basic_life(capacity: float, load: ArrayLike, exponent: float = 10.0 / 3.0) -> Floats:
    """L10 of ISO 281, for comparison.

    Parameters
    ----------
    capacity : float
        C [N].
    load : array_like
        Equivalent load P [N].
    exponent : float
        10/3 for rollers, 3 for balls.

    Returns
    -------
    life : Floats
        (C / P)^exponent [million revolutions].
    """
    with np.errstate(divide="ignore"):
        return np.asarray((capacity / np.asarray(load, dtype=float)) ** exponent)


def reference_load(capacity: float, life: ArrayLike, exponent: float = 10.0 / 3.0) -> Floats:
    """The load P_ref that has a reference life as its basic life: the inverse of `basic_life`.

    Parameters
    ----------
    capacity : float
        C [N].
    life : array_like
        L10r [million revolutions].
    exponent : float
        10/3 for rollers, 3 for balls.

    Returns
    -------
    load : Floats
        C / L10r^(1/exponent) [N].
    """
    return np.asarray(capacity * np.asarray(life, dtype=float) ** (-1.0 / exponent))


def _life(risk: Floats, slope: float) -> Floats:
    """risk^(-1/slope), infinite without a risk."""
    with np.errstate(divide="ignore"):
        return np.asarray(risk ** (-1.0 / slope))
