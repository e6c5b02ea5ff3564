"""Friction moment of rolling bearings with the factors f0 and f1, as ISO/TR 14179-1 has them.

M = M0 + M1: a moment that the lubricant makes, by f0 (nu n)^(2/3) d_m^3, and one that the load
makes, f1 P1 d_m, as Palmgren found them. ISO/TR 14179-1 was not read: factors and equivalent loads
are those of Juenemann (2010) as a public program (thermca) has them, which are linear in the load;
other tables have exponents of load and diameter for spherical rollers.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import radians, tan
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.catalogue import Entry
from fe_drivetrain.bearing.designations import Kind
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import RPM
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr

Supply = Literal["grease", "oil bath", "oil jet"]
"""How a lubricant comes to the rollers, as far as it counts for friction."""

F0_BATH = {
    "ball": 2.0,
    "cylindrical": 3.0,
    "full complement": 5.0,
    "single_row_tapered": 6.0,
    "double_row_tapered": 6.0,
    "spherical_roller": 6.0,
    "toroidal": 6.0,
}
"""f0 in an oil bath; a jet doubles it. Second-hand, see above; toroidal as spherical: assumed."""

F0_GREASE = F0_BATH | {"ball": 1.0, "cylindrical": 0.8}
"""f0 with grease that has run in. Second-hand."""

F1 = {
    "ball": 0.00022,
    "angular ball": 0.00046,
    "cylindrical": 0.0003,
    "full complement": 0.00055,
    "single_row_tapered": 0.0004,
    "double_row_tapered": 0.0004,
    "spherical_roller": 0.0006,
    "toroidal": 0.0003,
}
"""f1, of balls at a tenth of the rating. Second-hand; toroidal as cylindrical: assumed."""

F2 = 0.006
"""Moment of an axial force on ribs of cylindrical rollers over force and diameter (cage, oil); from
memory of a catalogue of 1989, not verified."""

SLOW = 2000.0
"""nu n [mm2/s 1/min] below which the lubricant's moment no longer falls."""

ROLLER_SHARE = 0.6
"""Diameter of a rolling element over half the difference of outside diameter and bore, where the
catalogue has no bore: assumed."""


@dataclass(frozen=True)
class FrictionBearing:
    """What models of friction need of a bearing.

    Attributes
    ----------
    name : str
        Name for messages.
    kind : str
        Kind of its catalogue entry.
    bore, outside : float
        Diameters of bore and of outer ring [m].
    contact_angle : float
        Contact angle [rad].
    series : str or None
        Series of a maker's catalogue, as "NU22", "NCF" of one without a cage, "240"; None where it
        is not known.
    seal_diameter : float or None
        Diameter on which both of its seals rub [m]; None of an open bearing.
    """

    name: str
    kind: Kind
    bore: float
    outside: float
    contact_angle: float = 0.0
    series: str | None = None
    seal_diameter: float | None = None

    def __post_init__(self) -> None:
        if not 0.0 < self.bore < self.outside < np.inf:
            raise InputError(
                f"friction of bearing {self.name!r}: bore {self.bore:g} m and outside diameter "
                f"{self.outside:g} m must be positive, the second one larger: correct one of them"
            )
        if not 0.0 <= self.contact_angle < 1.5:
            raise InputError(
                f"friction of bearing {self.name!r}: contact angle {self.contact_angle:g} rad must "
                "be from 0 to 1.5 rad: correct it"
            )
        if self.contact_angle == 0.0 and self.kind in ANGULAR:
            raise InputError(
                f"friction of bearing {self.name!r}: a bearing of kind {self.kind} has a contact "
                "angle above 0: give it"
            )

    @property
    def mean_diameter(self) -> float:
        """Mean of bore and outside diameter d_m [m]."""
        return 0.5 * (self.bore + self.outside)

    @property
    def full_complement(self) -> bool:
        """Whether its rollers stand without a cage."""
        return self.kind == "cylindrical" and self.series == "NCF"

    @property
    def factor_key(self) -> str:
        """Its key in the tables of factors."""
        return "full complement" if self.full_complement else self.kind

    @property
    def axial_ratio(self) -> float:
        """Factor e of ISO 281, 1.5 tan(alpha) [-]."""
        return 1.5 * tan(self.contact_angle)

    @property
    def axial_factor(self) -> float:
        """Factor Y of one row with line contact, 0.4 cot(alpha) [-]."""
        return 0.4 / tan(self.contact_angle)


ANGULAR = ("single_row_tapered", "double_row_tapered", "spherical_roller")
"""Kinds that carry axial force by their contact angle alone."""


def friction_bearing(name: str, entry: Entry) -> FrictionBearing:
    """What models of friction need of a catalogue entry.

    Parameters
    ----------
    name : str
        Name for messages.
    entry : Entry
        Entry of the bearing.

    Returns
    -------
    bearing : FrictionBearing
        Of an entry by its catalogue's page, bore and outside diameter are those of the page. Of
        others the mean diameter is the pitch diameter; without a bore, rings are as thick as
        rolling elements of `ROLLER_SHARE` leave them.
    """
    mean = entry.pitch_diameter
    across = entry.element_diameter / ROLLER_SHARE
    bore = mean - across if entry.bore is None else entry.bore
    angle = radians(entry.contact_angle or 0.0)
    outside = 2.0 * mean - bore
    if entry.page is not None:
        bore, outside, _ = entry.page.sizes
    series, seal = entry.series, entry.seal_diameter
    return FrictionBearing(name, entry.kind, bore, outside, angle, series, seal)


@dataclass(frozen=True)
class FrictionMoment:
    """Friction moment of a bearing by one model, as an array of operating points.

    Attributes
    ----------
    loaded : Floats
        Moment that the load makes: f1 P1 d_m, or sliding [N m].
    viscous : Floats
        Moment that the lubricant makes: M0, or rolling [N m].
    low, high : Floats
        Least and largest sum over the series of a catalogue that the bearing may be of; the sum
        itself where the series is known [N m].
    """

    loaded: Floats
    viscous: Floats
    low: Floats
    high: Floats

    __repr__ = short_repr

    @property
    def total(self) -> Floats:
        """Sum [N m]."""
        return self.loaded + self.viscous


def equivalent_friction_load(
    bearing: FrictionBearing, radial: ArrayLike, axial: ArrayLike
) -> Floats:
    """Load P1 that decides the friction moment of a bearing.

    Parameters
    ----------
    bearing : FrictionBearing
        The bearing.
    radial, axial : array_like
        Forces on it, without a sign [N].

    Returns
    -------
    load : Floats
        Load [N]: 3.3 Fa - 0.1 Fr of balls in deep grooves, Fa - 0.1 Fr of angular contact, 2 Y Fa
        of a tapered bearing and 1.21 Y Fa of two, the radial force at least; 1.6 Fa / e of
        spherical rollers where Fa / Fr exceeds e, Fr (1 + 0.6 (Fa / (e Fr))^3) up to there.
    """
    Fr, Fa = np.broadcast_arrays(np.abs(radial), np.abs(axial))
    if bearing.kind == "ball":
        own = Fa if bearing.contact_angle > 0.0 else 3.3 * Fa
        return np.asarray(np.maximum(own - 0.1 * Fr, Fr))
    if bearing.kind == "single_row_tapered":
        return np.asarray(np.maximum(2.0 * bearing.axial_factor * Fa, Fr))
    if bearing.kind == "double_row_tapered":
        return np.asarray(np.maximum(1.21 * bearing.axial_factor * Fa, Fr))
    if bearing.kind == "spherical_roller":
        e = bearing.axial_ratio
        share = np.minimum(Fa / np.maximum(e * Fr, np.finfo(float).tiny), 1.0)
        return np.where(Fa > e * Fr, 1.6 * Fa / e, Fr * (1.0 + 0.6 * share**3))
    return np.array(Fr, dtype=float)


def palmgren_friction(
    bearing: FrictionBearing,
    radial: ArrayLike,
    axial: ArrayLike,
    speed: ArrayLike,
    viscosity: float,
    supply: Supply = "oil jet",
) -> FrictionMoment:
    """Friction moment by f0 and f1 (ISO/TR 14179-1, Palmgren).

    Parameters
    ----------
    bearing : FrictionBearing
        The bearing.
    radial, axial : array_like
        Forces on it, without a sign [N].
    speed : array_like
        Speed of one ring against the other, whose sign does not matter [rad/s].
    viscosity : float
        Kinematic viscosity of the oil, or base oil, in operation [m^2/s].
    supply : {"grease", "oil bath", "oil jet"}
        How it comes to the rollers.

    Returns
    -------
    moment : FrictionMoment
        Against the motion, and at standstill what begins it.

    Notes
    -----
    M0 = 1e-7 f0 (nu n)^(2/3) d_m^3 [N mm] with nu in mm^2/s, n in 1/min and d_m in mm, for nu n of
    2000 at least: printed formulas have 160e-7 f0 d_m^3 below, 0.8 % more than the first one there.
    """
    n = np.abs(np.asarray(speed, dtype=float)) * RPM
    key, d = bearing.factor_key, bearing.mean_diameter
    f0 = F0_GREASE[key] if supply == "grease" else F0_BATH[key] * (1 + (supply == "oil jet"))
    stirred = np.maximum(1e6 * viscosity * n, SLOW) ** (2.0 / 3.0)
    viscous = 1e-7 * f0 * stirred * (1e3 * d) ** 3 / 1e3
    f1 = F1["angular ball" if bearing.kind == "ball" and bearing.contact_angle > 0.0 else key]
    loaded = f1 * d * equivalent_friction_load(bearing, radial, axial)
    if bearing.kind == "cylindrical":
        loaded = loaded + F2 * d * np.abs(axial)
    loaded, viscous = np.broadcast_arrays(loaded, viscous)
    total = loaded + viscous
    return FrictionMoment(loaded, viscous, total, total)


def axial_of_rows(bearing: FrictionBearing, radial: Floats, axial: Floats) -> Floats:
    """Axial forces (2, ...) of two tapered rows that share a radial force equally.

    Each has at least what its contact angle makes of its radial force, 0.5 Fr / Y; the first one
    takes the axial force of the bearing, too.

    Parameters
    ----------
    bearing : FrictionBearing
        Double-row tapered bearing.
    radial, axial : ndarray
        Forces on it, without a sign [N].
    """
    own = 0.25 * radial / bearing.axial_factor
    return np.stack([own + axial, own])
