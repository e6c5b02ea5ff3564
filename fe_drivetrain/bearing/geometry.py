"""Geometry of rolling bearings: rows of rollers or balls between rigid rings.

Frame: x downwind along the shaft, z up, y = z cross x, origin at the bearing's centre. The angle of
a rolling element is 0 on the right, looking downwind, 90 degrees on top (Stirling 2023, section
3.5): e_r = (0, -cos psi, sin psi). A contact angle is positive where the row carries an inner ring
that is pushed downwind: the inner ring pushes a rolling element along (sin(alpha), cos(alpha) e_r).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, degrees, isfinite, pi, sin, tan

import numpy as np

from fe_drivetrain.bearing.contact import (
    ContactLaw,
    lamina_places,
    log_profile,
)
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

MAX_CLEARANCE = 0.01
"""Clearance or preload over the diameter of rolling elements from which no bearing is left."""

LAMINAE = 30
"""Laminae of a roller where nothing else is given, the minimum of ISO/TS 16281."""


@dataclass(frozen=True)
class RollerRow:
    """A row of rollers.

    Attributes
    ----------
    rollers : int
        Number of rollers.
    place : float
        Axial place x of the rollers' middles [m].
    radius : float
        Distance of the rollers' middles from the axis: half the pitch diameter [m].
    angle : float
        Contact angle [rad]; the sign says which push of the inner ring the row carries.
    diameter, length : float
        Diameter of a roller in its middle, and effective length [m].
    law : ContactLaw
        Contact law of one roller.
    clearance : float
        Clearance along the contact normal, both contacts together [m]; negative is a preload.
    laminae : int
        Number of slices of a roller; 0 is the closed form along a straight roller.
    crown : float
        Factor of the logarithmic profile of one contact [m], both being crowned; 0 is straight.
    aligning : bool
        Whether the rollers carry no moment, as on a race that is a sphere about the bearing's
        centre, or in a toroidal bearing.
    phase : float
        Angle of the first roller [rad].
    """

    rollers: int
    place: float
    radius: float
    angle: float
    diameter: float
    length: float
    law: ContactLaw
    clearance: float = 0.0
    laminae: int = LAMINAE
    crown: float = 0.0
    aligning: bool = False
    phase: float = 0.0

    def __post_init__(self) -> None:
        _check_row(self, "roller", self.rollers)
        if not (isfinite(self.length) and self.length > 0.0):
            raise InputError(f"roller length is {self.length:g} m: it must be positive")
        if not 0 <= self.laminae <= 1000:
            raise InputError(
                f"a roller has {self.laminae} laminae: give 1 to 1000, or 0 for the closed form"
            )
        if not (isfinite(self.crown) and 0.0 <= self.crown <= 0.01 * self.diameter):
            raise InputError(
                f"crown of {1e6 * self.crown:g} µm on rollers of {1e3 * self.diameter:g} mm: give "
                "0 to 1 % of their diameter (0.00035 to 0.00045 of it in ISO/TS 16281)"
            )
        if self.crown and not self.laminae:
            raise InputError("a crowned roller has no closed form: give laminae, 30 or more")
        if self.aligning and abs(self.arm) > 1e-9 * self.radius:
            raise InputError(
                f"the contact normals of an aligning row pass {1e3 * self.arm:.3g} mm from the "
                "bearing's centre: place it at radius times tan(angle), "
                f"{1e3 * self.radius * tan(self.angle):.6g} mm"
            )

    @property
    def arm(self) -> float:
        """Approach at a roller's middle over the tilt about its tangent [m]."""
        return self.place * cos(self.angle) - self.radius * sin(self.angle)

    @property
    def places(self) -> Floats:
        """Laminae along a roller, from its middle, growing with x [m]."""
        return lamina_places(self.length, max(self.laminae, 1))

    @property
    def free(self) -> Floats:
        """Approach at which each lamina begins to carry, without the clearance [m]."""
        if not self.crown:
            return np.zeros(max(self.laminae, 1))
        return 2.0 * log_profile(self.places, self.length, self.crown)


@dataclass(frozen=True)
class BallRow:
    """A row of balls in grooves, whose contact angle follows the load.

    Attributes
    ----------
    balls : int
        Number of balls.
    place, radius : float
        Axial place x and radius of the balls' centres [m].
    angle : float
        Contact angle of the unloaded bearing without clearance [rad]: 0 is a deep groove.
    diameter : float
        Diameter of a ball [m].
    inner_groove, outer_groove : float
        Radii of the grooves [m].
    law : ContactLaw
        Contact law of one ball.
    clearance : float
        Clearance along the contact normal [m]: half of the radial internal clearance of a deep
        groove; negative is a preload.
    phase : float
        Angle of the first ball [rad].
    """

    balls: int
    place: float
    radius: float
    angle: float
    diameter: float
    inner_groove: float
    outer_groove: float
    law: ContactLaw
    clearance: float = 0.0
    phase: float = 0.0

    def __post_init__(self) -> None:
        _check_row(self, "ball", self.balls)
        for name in ("inner_groove", "outer_groove"):
            radius = getattr(self, name)
            if not 0.5 * self.diameter < radius < self.diameter:
                raise InputError(
                    f"{name.replace('_', ' ')} has a radius of {1e3 * radius:g} mm: it must be "
                    f"more than the balls' {500.0 * self.diameter:g} mm, and less than twice it"
                )
        if not self.clearance < 0.5 * self.groove_distance:
            raise InputError(
                f"clearance of {1e6 * self.clearance:g} µm: it must be less than half the distance "
                f"of the groove centres, {5e5 * self.groove_distance:g} µm"
            )

    @property
    def groove_distance(self) -> float:
        """Distance of the groove centres where the ball just touches both [m]."""
        return self.inner_groove + self.outer_groove - self.diameter

    @property
    def groove_centre(self) -> tuple[float, float]:
        """x and radius of the inner groove's centre [m] (ISO/TS 16281: R_i)."""
        free = self.inner_groove - 0.5 * self.diameter
        across = cos(self.angle) * (1.0 - max(self.clearance, 0.0) / self.groove_distance)
        return self.place + free * sin(self.angle), self.radius + free * across


Row = RollerRow | BallRow


@dataclass(frozen=True)
class Bearing:
    """Rows between two rigid rings; the outer one is fixed.

    Attributes
    ----------
    name : str
        Name for messages and reports.
    rows : tuple
        Rows, each a `RollerRow` or a `BallRow`, upwind first.
    """

    name: str
    rows: tuple[Row, ...]

    def __post_init__(self) -> None:
        if not self.rows:
            raise InputError(f"bearing {self.name!r} has no rows: give at least one")

    @property
    def counts(self) -> tuple[int, ...]:
        """Rolling elements of each row."""
        return tuple(count(row) for row in self.rows)

    @property
    def arm(self) -> float:
        """Length that makes moments of forces: the maximum pitch radius [m]."""
        return max(row.radius for row in self.rows)

    def with_rows(self, **changes: float | int | ContactLaw) -> Bearing:
        """Bearing with the same change to every row, as ``with_rows(laminae=60)``."""
        return replace(self, rows=tuple(replace(row, **changes) for row in self.rows))  # type: ignore[arg-type]


def count(row: Row) -> int:
    """Rolling elements of a row."""
    return row.rollers if isinstance(row, RollerRow) else row.balls


def angles(row: Row) -> Floats:
    """Angles of the rolling elements [rad], from the right and upward, looking downwind."""
    n = count(row)
    return row.phase + 2.0 * np.pi * np.arange(n) / n


def pitch_ratio(row: Row) -> float:
    """gamma = D cos(alpha) / D_pw [-]; the cage turns (1 - gamma) / 2 times with the inner ring."""
    return row.diameter * cos(row.angle) / (2.0 * row.radius)


def max_clearance(row: Row) -> float:
    """A clearance [m] that any row of these sizes can have, next to the largest one."""
    allowed = MAX_CLEARANCE * row.diameter
    return allowed if isinstance(row, RollerRow) else min(allowed, 0.45 * row.groove_distance)


def check_sizes(diameter: float, radius: float) -> None:
    for what, value in (("diameter of the rolling elements", diameter), ("pitch radius", radius)):
        if not (isfinite(value) and value > 0.0):
            raise InputError(f"{what} is {value:g} m: it must be positive and finite")
    if not diameter < radius:
        raise InputError(
            f"rolling elements of {1e3 * diameter:g} mm on a pitch radius of {1e3 * radius:g} mm "
            "leave no inner ring: check diameter and pitch diameter"
        )


def _check_row(row: Row, what: str, n: int) -> None:
    """Sizes that no bearing has."""
    check_sizes(row.diameter, row.radius)
    if n < 3:
        raise InputError(f"a row has {n} {what}s: give 3 or more")
    apart = 2.0 * row.radius * sin(pi / n)
    if row.diameter > apart:
        raise InputError(
            f"{n} {what}s of {1e3 * row.diameter:g} mm overlap: on a pitch diameter of "
            f"{2e3 * row.radius:g} mm they are {1e3 * apart:.4g} mm apart; give "
            "fewer or thinner ones"
        )
    if not (isfinite(row.angle) and abs(row.angle) < 0.5 * pi - 1e-6):
        raise InputError(
            f"contact angle of a row is {degrees(row.angle):g} deg: it must be between -90 and "
            "90 deg"
        )
    if not (isfinite(row.place) and isfinite(row.phase)):
        raise InputError("place and first angle of a row must be finite numbers [m, rad]")
    if not (isfinite(row.clearance) and abs(row.clearance) <= MAX_CLEARANCE * row.diameter):
        raise InputError(
            f"clearance of {1e6 * row.clearance:g} µm along the contact of {what}s of "
            f"{1e3 * row.diameter:g} mm: beyond 1 % of their diameter there is no bearing left; "
            "give a smaller clearance, or preload where it is negative"
        )
