"""From initial to operating clearance of a rolling bearing: fits, smoothing, temperatures, speed.

Rings and seats are thick cylinders (`fe_drivetrain.bearing.press_fits`), their raceways at the
middle of the rolling elements, flanges left out. Each part has one temperature. Elastic deflection
under load is none of the clearance: rollers in equilibrium have it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from itertools import product
from math import cos, hypot, sin, tan
from typing import TYPE_CHECKING

from fe_drivetrain.bearing.mounting import Mounting, Temperatures
from fe_drivetrain.bearing.press_fits import Ring, RingMaterial, fit_pressure
from fe_drivetrain.bearing.tolerances import (
    Limits,
    bore_limits,
    housing_limits,
    outside_limits,
    shaft_limits,
)
from fe_drivetrain.common.short_repr import short_repr

if TYPE_CHECKING:
    pass

RING_STEEL = RingMaterial(208e9, 0.3, 7850.0, 12.5e-6)
"""Bearing steel: 12.5e-6 1/K is what makers' catalogues take for its expansion."""

LEFT_OF_INTERFERENCE = {"ground": 2e-3, "machined": 3e-3, "none": 0.0}
"""c of the share d / (d + c) of an interference that smooth seats leave [m] (NSK, Rolling Bearings,
CAT. E1102m, Eq 9.4 and 9.5)."""


@dataclass(frozen=True)
class Seats:
    """Diameters and materials about a bearing.

    Attributes
    ----------
    bore, outside : float
        Bore and outside diameter of the bearing [m].
    inner_raceway, outer_raceway : float
        Diameters of the raceways [m].
    element_diameter : float
        Diameter of a rolling element [m].
    contact_angle : float
        Contact angle [rad], not negative.
    spread : float
        Distance of two rows along the axis [m]; positive where heat of the inner ring tightens by
        it (X arrangement), negative in an O arrangement; 0 of one row, and of rows that share a
        sphere.
    shaft, housing : Ring
        Hollow or solid shaft, and the housing.
    rings : RingMaterial
        Material of rings and rolling elements.
    """

    bore: float
    outside: float
    inner_raceway: float
    outer_raceway: float
    element_diameter: float
    contact_angle: float
    spread: float
    shaft: Ring
    housing: Ring
    rings: RingMaterial = RING_STEEL

    @property
    def inner_ring(self) -> Ring:
        """Inner ring, from bore to raceway."""
        return Ring(0.5 * self.bore, 0.5 * self.inner_raceway, self.rings)

    @property
    def outer_ring(self) -> Ring:
        """Outer ring, from raceway to outside."""
        return Ring(0.5 * self.outer_raceway, 0.5 * self.outside, self.rings)


@dataclass(frozen=True)
class FitState:
    """One choice of all that has a tolerance.

    Attributes
    ----------
    initial : float
        Radial clearance that it begins with [m].
    shaft, bore, housing, outside : float
        Deviations from the nominal diameters [m].
    """

    initial: float
    shaft: float = 0.0
    bore: float = 0.0
    housing: float = 0.0
    outside: float = 0.0


@dataclass(frozen=True)
class Band:
    """A quantity where the clearance is least, with all tolerances at their middle, and most.

    Attributes
    ----------
    least, mean, most : float
        Values.
    """

    least: float
    mean: float
    most: float


@dataclass(frozen=True)
class OperatingClearance:
    """Radial clearance of a bearing in operation, and what makes it.

    Attributes
    ----------
    radial : Band
        Radial clearance [m], of the diameter; negative is a preload.
    probable : Limits
        Its range with the tolerances' ranges added as squares [m]: some nine tenths of bearings
        whose deviations are spread evenly are in it.
    parts : Mapping[str, Band]
        Contributions [m], in the order in which they come: each column adds up to `radial`.
    pressures : Mapping[str, Band]
        Pressure in the fits of "inner ring" and "outer ring" [Pa].
    hoop_stress : Band
        Hoop stress in the bore of the inner ring by its fit [Pa].
    normal : float
        Clearance along the contact normal for one of radial clearance.
    assumed : tuple of str
        What was not stated.
    left_out : float
        Growth of the shaft less that of the housing over the distance to the other bearing of a
        pair, in X or O arrangement, which is none of the clearance [m/m]; 0 of other bearings.
    """

    radial: Band
    probable: Limits
    parts: Mapping[str, Band]
    pressures: Mapping[str, Band]
    hoop_stress: Band
    normal: float
    assumed: tuple[str, ...] = ()
    left_out: float = 0.0

    __repr__ = short_repr

    @property
    def along_normal(self) -> Band:
        """Clearance along the contact normal, as catalogue entries have it [m]."""
        n = self.normal
        return Band(n * self.radial.least, n * self.radial.mean, n * self.radial.most)

    @property
    def loose(self) -> tuple[str, ...]:
        """Rings that may have no pressure on their seats."""
        return tuple(name for name, one in self.pressures.items() if min(one.least, one.most) <= 0)


@dataclass(frozen=True)
class Warm:
    """Temperatures above that of mounting [K], and a speed.

    Attributes
    ----------
    shaft, inner_ring, rollers, outer_ring, housing : float
        Differences of temperature [K].
    speed : float
        Speed of the inner ring [rad/s].
    """

    shaft: float = 0.0
    inner_ring: float = 0.0
    rollers: float = 0.0
    outer_ring: float = 0.0
    housing: float = 0.0
    speed: float = 0.0


def warm_of(given: Temperatures | None, speed: float = 0.0) -> Warm:
    """Temperatures of operation above that of mounting.

    Parameters
    ----------
    given : Temperatures or None
        As stated; None is as mounted.
    speed : float
        Speed of the inner ring [rad/s].
    """
    if given is None:
        return Warm(speed=speed)
    inner, outer, cold = given.inner_ring, given.outer_ring, given.mounting
    return Warm(
        shaft=(inner if given.shaft is None else given.shaft) - cold,
        inner_ring=inner - cold,
        rollers=(0.5 * (inner + outer) if given.rollers is None else given.rollers) - cold,
        outer_ring=outer - cold,
        housing=(outer if given.housing is None else given.housing) - cold,
        speed=speed,
    )


def fitted_clearance(
    seats: Seats, state: FitState, warm: Warm, kept: tuple[float, float] = (1.0, 1.0)
) -> tuple[float, tuple[float, float]]:
    """Radial clearance, and pressures in both fits, of one choice of all deviations.

    Parameters
    ----------
    seats : Seats
        Diameters and materials.
    state : FitState
        Deviations, and the clearance before mounting.
    warm : Warm
        Temperatures, and the speed.
    kept : tuple of float
        Share of the interference of inner and outer ring that smoothing leaves.

    Returns
    -------
    clearance : float
        Radial clearance [m].
    pressures : tuple of float
        Pressure between shaft and inner ring, and between outer ring and housing [Pa].
    """
    inner, outer, shaft, housing = seats.inner_ring, seats.outer_ring, seats.shaft, seats.housing
    alpha, w = seats.rings.expansion, warm.speed
    tight = _smoothed(state.shaft - state.bore, kept[0])
    tight += seats.bore * (shaft.material.expansion * warm.shaft - alpha * warm.inner_ring)
    tight += 2.0 * (shaft.turning_growth(shaft.outer, w) - inner.turning_growth(inner.inner, w))
    on_shaft = fit_pressure(shaft, inner, tight)
    grown = alpha * warm.inner_ring * seats.inner_raceway
    grown += 2.0 * (inner.outer_growth(on_shaft) + inner.turning_growth(inner.outer, w))
    tight = _smoothed(state.outside - state.housing, kept[1])
    tight += seats.outside * (alpha * warm.outer_ring - housing.material.expansion * warm.housing)
    in_housing = fit_pressure(outer, housing, tight)
    widened = alpha * warm.outer_ring * seats.outer_raceway - 2.0 * outer.bore_shrink(in_housing)
    tilt = seats.contact_angle
    thicker = 2.0 * alpha * warm.rollers * seats.element_diameter / cos(tilt)
    # each contact moves along the axis, too: half a rolling element off its row's middle
    half, off = 0.5 * seats.spread, 0.5 * seats.element_diameter * sin(tilt)
    along = alpha * (warm.inner_ring * (half - off) - warm.outer_ring * (half + off))
    found = state.initial + widened - grown - thicker - 2.0 * along * tan(tilt)
    return found, (on_shaft, in_housing)


def operating_clearance(
    mounting: Mounting, seats: Seats, initial: Limits, assumed: tuple[str, ...] = ()
) -> OperatingClearance:
    """Operating clearance of a bearing, with the band that its tolerances make.

    Parameters
    ----------
    mounting : Mounting
        Fits, temperatures and speed.
    seats : Seats
        Diameters and materials.
    initial : Limits
        Radial clearance that it begins with [m]: before mounting, or of the mounted bearing where
        `Mounting.is_mounted`.
    assumed : tuple of str
        What was not stated.

    Raises
    ------
    InputError
        A tolerance class has no value for the diameter.
    """
    ranges = {"initial": initial} | _deviations(mounting, seats)
    middle = FitState(**{name: one.mean for name, one in ranges.items()})
    warm, kept = warm_of(mounting.temperatures, mounting.speed or 0.0), _kept(mounting, seats)

    def final(state: FitState) -> float:
        found = fitted_clearance(seats, state, warm, kept)[0]
        if mounting.is_mounted:
            found += state.initial - fitted_clearance(seats, state, Warm(), kept)[0]
        return found

    corners = sorted(_corners(ranges), key=final)
    states = [corners[0], middle, corners[-1]]
    shares = [
        0.5 * (final(replace(middle, **{n: low})) - final(replace(middle, **{n: high})))
        for n, (low, high) in ranges.items()
    ]
    radial, half = Band(*map(final, states)), hypot(*shares)
    probable = Limits(max(radial.mean - half, radial.least), min(radial.mean + half, radial.most))
    pressures = [fitted_clearance(seats, one, warm, kept)[1] for one in states]
    hoop = [seats.inner_ring.hoop_stress(one[0]) for one in pressures]
    both = {
        name: Band(*(one[k] for one in pressures))
        for k, name in enumerate(("inner ring", "outer ring"))
        if mounting.fit is not None
    }
    return OperatingClearance(
        radial,
        probable,
        _parts(mounting, seats, states, warm, kept),
        both,
        Band(*hoop),
        0.5 * cos(seats.contact_angle),
        assumed,
    )


def _corners(ranges: Mapping[str, Limits]) -> list[FitState]:
    """All choices of tight or loose seats, and of less or more clearance to begin with.

    A clearance grows or falls with each of these alone, so that it is least and most at two of
    them; of a bearing that is adjusted when mounted the tightest seat need not be the least.
    """
    tight = {"initial": "low", "shaft": "high", "bore": "low", "housing": "low", "outside": "high"}
    groups = ("initial",), ("shaft", "bore"), ("housing", "outside")
    found = []
    for at_limits in product((True, False), repeat=len(groups)):
        chosen = {}
        for names, is_tight in zip(groups, at_limits, strict=True):
            for name in names:
                if name in ranges:
                    one = ranges[name]
                    chosen[name] = one.low if (tight[name] == "low") == is_tight else one.high
        found.append(FitState(**chosen))
    return found


def _parts(
    mounting: Mounting,
    seats: Seats,
    states: list[FitState],
    warm: Warm,
    kept: tuple[float, float],
) -> dict[str, Band]:
    """Contributions, each with those before it already there."""
    stages: list[tuple[str, Callable[[FitState], float]]] = []
    no_fit = [FitState(one.initial) for one in states]

    def add(name: str, with_fit: tuple[bool, bool], at: Warm, left: tuple[float, float]) -> None:
        def value(state: FitState) -> float:
            bare = FitState(state.initial)
            if with_fit[0]:
                bare = replace(bare, shaft=state.shaft, bore=state.bore)
            if with_fit[1]:
                bare = replace(bare, housing=state.housing, outside=state.outside)
            return fitted_clearance(seats, bare, at, left)[0]

        stages.append((name, value))

    if mounting.fit is not None:
        add("fit of the inner ring", (True, False), Warm(), (1.0, 1.0))
        add("fit of the outer ring", (True, True), Warm(), (1.0, 1.0))
        add("smoothing of the seats", (True, True), Warm(), kept)
    add("temperatures", (True, True), replace(warm, speed=0.0), kept)
    add("speed", (True, True), warm, kept)
    begins = "mounted" if mounting.is_mounted else "before mounting"
    found = {begins: Band(*(one.initial for one in no_fit))}
    before = [one.initial for one in states]
    for name, value in stages:
        now = [value(one) for one in states]
        # what is measured when mounted has the fits in it
        if not (mounting.is_mounted and name not in ("temperatures", "speed")):
            found[name] = Band(*(a - b for a, b in zip(now, before, strict=True)))
        before = now
    return found


def _smoothed(interference: float, kept: float) -> float:
    return kept * interference if interference > 0.0 else interference


def _kept(mounting: Mounting, seats: Seats) -> tuple[float, float]:
    if mounting.fit is None:
        return 1.0, 1.0
    c = LEFT_OF_INTERFERENCE[mounting.fit.smoothing]
    return seats.bore / (seats.bore + c), seats.outside / (seats.outside + c)


def _deviations(mounting: Mounting, seats: Seats) -> dict[str, Limits]:
    """Ranges of all deviations; none of a ring without a stated fit."""
    fit = mounting.fit
    found: dict[str, Limits] = {}
    if fit is None:
        return found
    if fit.shaft is not None:
        own = fit.shaft
        found["shaft"] = shaft_limits(own, seats.bore) if isinstance(own, str) else Limits(*own)
        found["bore"] = bore_limits(seats.bore) if fit.bore is None else Limits(*fit.bore)
    if fit.housing is not None:
        own = fit.housing
        found["housing"] = (
            housing_limits(own, seats.outside) if isinstance(own, str) else Limits(*own)
        )
        found["outside"] = (
            outside_limits(seats.outside) if fit.outside is None else Limits(*fit.outside)
        )
    return found
