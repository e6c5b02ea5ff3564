"""For how long load steps are beyond the limits of rating lives, and their extremes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.answers import race_pressures
from fe_drivetrain.bearing.geometry import BallRow, Bearing, pitch_ratio
from fe_drivetrain.bearing_life.life.modified_life import BRANCHES, LAST_KAPPA
from fe_drivetrain.bearing_life.life.rated import RatedBearing
from fe_drivetrain.bearing_life.life.reference_life import LINE
from fe_drivetrain.bearing_life.life.roller_models import unbalanced
from fe_drivetrain.bearing_life.life.steps import Steps
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import ONE_RPM
from fe_drivetrain.common.errors import InputError

FASTEST = 3e6
"""Speed times pitch diameter [mm/min] beyond which no rolling bearing is known to run: those of
spindles and jet engines come to it (from memory, not verified)."""

BALL = 10.0 / 3.0
"""Exponent of load to damage in point contact."""

STEEL_DENSITY = 7850.0
"""Density of rolling elements [kg/m^3]."""


@dataclass(frozen=True, eq=False)
class Limits:
    """Seconds that the methods' limits were passed, and the extremes.

    Attributes
    ----------
    standing, thin, thick, heavy, weak, lost : float
        Time [s]: below the speed of standing; with kappa below 0.1, and above 4; with P, or the
        radial load that has the life of the rollers, above C/2; with a static safety below 1
        (`static_use`); without equilibrium.
    fast : float
        Time [s] above the limiting speed of the bearing, where its catalogue has one.
    reversals : float
        How often the direction of rotation changed, within each chunk of steps.
    max_load, max_static, max_roller_load : float
        Maximum of P, of P_0 and of the load of one rolling element [N].
    max_reference, max_pressure, max_use, max_speed_rpm : float
        Radial load that has the life of the rollers by their own exponent [N], C / L10r^(1/4), of
        balls C / L10r^(1/3); Hertz pressure of a lamina or a ball [Pa];
        one over the static safety [-]; speed [1/min].
    max_unbalanced : float
        Largest part of a load that the sum of its laminae leaves, over the load [-]; see
        `fe_drivetrain.bearing_life.life.roller_models.unbalanced`.
    """

    standing: float = 0.0
    thin: float = 0.0
    thick: float = 0.0
    heavy: float = 0.0
    weak: float = 0.0
    lost: float = 0.0
    fast: float = 0.0
    reversals: float = 0.0
    max_load: float = 0.0
    max_static: float = 0.0
    max_roller_load: float = 0.0
    max_reference: float = 0.0
    max_pressure: float = 0.0
    max_use: float = 0.0
    max_speed_rpm: float = 0.0
    max_unbalanced: float = 0.0

    def __add__(self, other: Limits) -> Limits:
        """Times add up, extremes stay."""
        values = {}
        for field in fields(self):
            mine, its = getattr(self, field.name), getattr(other, field.name)
            values[field.name] = max(mine, its) if field.name.startswith("max_") else mine + its
        return Limits(**values)

    @property
    def static_safety(self) -> float:
        """The least S_0 [-]; infinite without a load."""
        return 1.0 / self.max_use if self.max_use else np.inf


def limits_of(
    steps: Steps, rated: RatedBearing, standing_rpm: float, kappa: Floats, P: Floats, risk: Floats
) -> Limits:
    """Times beyond the limits, and extremes, of a chunk of steps.

    Parameters
    ----------
    steps : Steps
        Some hundred to a few thousand.
    rated : RatedBearing
        The bearing.
    standing_rpm : float
        Speed below which it stands [1/min].
    kappa : Floats
        (n,) viscosity ratio; not a number without a lubricant.
    P : Floats
        (n,) dynamic equivalent load of ISO 281 [N].
    risk : Floats
        (n,) of all laminae together, see `fe_drivetrain.bearing_life.life.step_risks`.

    Returns
    -------
    limits : Limits
        Limits of these steps.
    """
    time, speed = steps.seconds, np.abs(steps.speed_rpm)
    turns = speed >= standing_rpm
    runs = turns & steps.converged
    pressures = max_pressures(rated, steps.laminae)
    use = static_use(rated, steps.loads, pressures)
    of_rollers = rated.dynamic * risk ** (1.0 / (BALL if rated.balls else LINE))
    heavy = (0.5 * rated.dynamic < P) | (0.5 * rated.dynamic < of_rollers)
    limiting = np.inf if rated.limiting_speed_rpm is None else rated.limiting_speed_rpm
    return Limits(
        standing=float(time[~turns].sum()),
        thin=float(time[runs & (kappa < BRANCHES[0][0])].sum()),
        thick=float(time[runs & (kappa > LAST_KAPPA)].sum()),
        heavy=float(time[runs & heavy].sum()),
        weak=float(time[use > 1.0].sum()),
        lost=float(time[~steps.converged].sum()),
        fast=float(time[speed > limiting].sum()),
        reversals=float(np.count_nonzero(np.diff(np.sign(steps.speed_rpm[turns])))),
        max_load=float(P.max(initial=0.0)),
        max_static=float(rated.static_load(steps.loads).max(initial=0.0)),
        max_roller_load=max(float(q.sum(axis=2).max(initial=0.0)) for q in steps.laminae),
        max_reference=float(of_rollers.max(initial=0.0)),
        max_pressure=float(pressures.max(initial=0.0)),
        max_use=float(use.max(initial=0.0)),
        max_speed_rpm=float(speed.max(initial=0.0)),
        max_unbalanced=unbalanced(rated.bearing, steps),
    )


def max_pressures(rated: RatedBearing, laminae: Sequence[Floats]) -> Floats:
    """Largest Hertz pressure of each step, on either race of any row, (n,) [Pa].

    Parameters
    ----------
    rated : RatedBearing
        The bearing.
    laminae : sequence of Floats
        For each row (n, elements, laminae) [N].

    Returns
    -------
    pressures : Floats
        (n,) at the lamina, or the ball, that carries most.
    """
    found = [
        np.maximum(*race_pressures(row, q.max(axis=(1, 2)), q.shape[2]))
        for row, q in zip(rated.bearing.rows, laminae, strict=True)
    ]
    return np.asarray(np.max(found, axis=0))


def static_use(rated: RatedBearing, loads: ArrayLike, pressures: ArrayLike) -> Floats:
    """How much of its static rating a bearing uses: one over its static safety S_0.

    Parameters
    ----------
    rated : RatedBearing
        The bearing.
    loads : array_like
        (n, 5) on the bearing [N, N m].
    pressures : array_like
        (n,) largest of the rollers [Pa], see `max_pressures`.

    Returns
    -------
    use : Floats
        (n,) the larger of P_0 / C_0 of ISO 76, which knows no moment, and of the load of the most
        loaded contact over what brings it to the pressure that C_0 stands for: the ratio of the
        pressures squared in line contact, cubed in point contact.
    """
    of_rollers = (np.asarray(pressures, float) / rated.static_pressure) ** rated.pressure_exponent
    return np.asarray(np.maximum(rated.static_load(loads) / rated.static, of_rollers))


def check_speed(rated: RatedBearing, speed_rpm: ArrayLike) -> None:
    """Refuse speeds at which no such bearing runs.

    Parameters
    ----------
    rated : RatedBearing
        The bearing.
    speed_rpm : array_like
        Speed of the turning ring [1/min], of any sign.

    Raises
    ------
    InputError
        A speed times the pitch diameter is beyond `FASTEST`, or is no number.
    """
    fastest = float(np.max(np.abs(speed_rpm), initial=0.0))
    most = FASTEST / (1e3 * rated.pitch_diameter)
    if not fastest <= most:
        raise InputError(
            f"bearing {rated.bearing.name} turns at {fastest:.3g} 1/min: with a pitch diameter of "
            f"{1e3 * rated.pitch_diameter:.4g} mm none runs faster than {most:.3g} 1/min (speed "
            f"times diameter {FASTEST:.0e} mm/min); correct the rotor speed or its unit"
        )


def centrifugal_load(bearing: Bearing, speed_rpm: float) -> float:
    """Force that presses a rolling element on the outer race, whose ring stands.

    Parameters
    ----------
    bearing : Bearing
        Bearing of steel, its rollers taken as cylinders.
    speed_rpm : float
        Speed of the inner ring [1/min].

    Returns
    -------
    force : float
        m r omega_c^2 of the row that has most [N], the cage at (1 - gamma) / 2 of the speed.
    """
    found = []
    for row in bearing.rows:
        length = 2.0 / 3.0 * row.diameter if isinstance(row, BallRow) else row.length
        mass = STEEL_DENSITY * np.pi / 4.0 * row.diameter**2 * length
        cage = ONE_RPM * speed_rpm * 0.5 * (1.0 - pitch_ratio(row))
        found.append(float(mass * row.radius * cage**2))
    return max(found)
