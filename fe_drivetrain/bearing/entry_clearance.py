"""Operating clearance of a bearing of a catalogue: its diameters, and what it begins with."""

from __future__ import annotations

from dataclasses import replace
from math import cos, inf, radians, sin, tan
from typing import TYPE_CHECKING

from fe_drivetrain.bearing.geometry import MAX_CLEARANCE
from fe_drivetrain.bearing.mounting import INITIAL, Mounting
from fe_drivetrain.bearing.operating_clearance import (
    RING_STEEL,
    OperatingClearance,
    Seats,
    operating_clearance,
    warm_of,
)
from fe_drivetrain.bearing.press_fits import Ring, RingMaterial
from fe_drivetrain.bearing.tolerances import Limits, class_clearance
from fe_drivetrain.common.errors import InputError

if TYPE_CHECKING:
    from fe_drivetrain.bearing.catalogue import Entry


def entry_seats(
    entry: Entry,
    mounting: Mounting,
    shaft: RingMaterial,
    housing: RingMaterial,
    rings: RingMaterial = RING_STEEL,
) -> tuple[Seats, tuple[str, ...]]:
    """Diameters about a catalogued bearing, and what of them nobody stated.

    Parameters
    ----------
    entry : Entry
        The bearing of a catalogue.
    mounting : Mounting
        With the diameters that `Fit` states.
    shaft, housing : RingMaterial
        Materials of the seats.
    rings : RingMaterial
        Material of rings and rolling elements.

    Returns
    -------
    seats : Seats
        The diameters.
    assumed : tuple of str
        Sentences, one for each diameter that was not stated.

    Raises
    ------
    InputError
        The entry has no bore, diameters leave no ring, or D is another than that of its page.
    """
    if entry.bore is None:
        raise InputError(
            f"bearing {entry.title!r} has a mounting but no bore in its catalogue entry: add it"
        )
    assumed = []
    fit = mounting.fit
    tilt = radians(abs(entry.contact_angle or 0.0))
    across = entry.element_diameter * cos(tilt)
    inner, outer = entry.pitch_diameter - across, entry.pitch_diameter + across
    outside = None if fit is None else fit.outside_diameter
    if entry.page is not None:
        printed = entry.page.sizes.outside
        if outside is not None and abs(outside / printed - 1.0) > 1e-3:
            raise InputError(
                f"mounting: fit.outside_diameter is {outside:g} m, but D of the page of "
                f"{entry.title!r} is {printed:g} m: leave it out"
            )
        outside = printed
    if outside is None:
        outside = outer + (inner - entry.bore)
        assumed.append(
            f"outside diameter {1e3 * outside:.4g} mm: walls of both rings of the same thickness"
        )
    hollow = None if fit is None else fit.shaft_bore
    if hollow is None:
        hollow = 0.0
        assumed.append("a solid shaft")
    around = None if fit is None else fit.housing_diameter
    if around is None:
        around = inf
        assumed.append("a thick housing")
    spread = 0.0
    if entry.kind == "double_row_tapered" and entry.spread is not None:
        spread = entry.spread if entry.arrangement == "X" else -entry.spread
    elif entry.kind == "spherical_roller":
        spread = entry.pitch_diameter * tan(tilt)
    return Seats(
        entry.bore,
        outside,
        inner,
        outer,
        entry.element_diameter,
        tilt,
        spread,
        Ring(0.5 * hollow, 0.5 * entry.bore, shaft),
        Ring(0.5 * outside, 0.5 * around, housing),
        rings,
    ), tuple(assumed)


def entry_clearance(
    entry: Entry,
    mounting: Mounting,
    shaft: RingMaterial = RING_STEEL,
    housing: RingMaterial = RING_STEEL,
    rings: RingMaterial = RING_STEEL,
) -> OperatingClearance:
    """Operating clearance of a catalogued bearing; see `operating_clearance`.

    Parameters
    ----------
    entry : Entry
        The bearing of a catalogue.
    mounting : Mounting
        How it is mounted.
    shaft, housing : RingMaterial
        Materials of the seats.
    rings : RingMaterial
        Material of rings and rolling elements.

    Raises
    ------
    InputError
        There is no clearance class for it, it has no contact angle for a preload, or diameters are
        missing.
    """
    seats, assumed = entry_seats(entry, mounting, shaft, housing, rings)
    if mounting.clearance_class is not None:
        angular = entry.kind == "ball" and entry.contact_angle
        kind = "angular contact ball" if angular else entry.kind
        initial = class_clearance(kind, mounting.clearance_class, seats.bore)
    elif mounting.preload is not None:
        low, high = (_approach(entry, force) for force in mounting.preload)
        initial = Limits(-high, -low)
    else:
        assert mounting.beginning is not None
        initial = mounting.beginning
    found = operating_clearance(mounting, seats, initial, assumed)
    found = replace(found, normal=normal_of(entry))
    if entry.kind == "single_row_tapered" or (entry.kind == "ball" and entry.contact_angle):
        warm = warm_of(mounting.temperatures)
        growth = shaft.expansion * warm.shaft - housing.expansion * warm.housing
        found = replace(found, left_out=growth)
    _check_room(entry, mounting, found)
    return found


_KEYS = {
    "fit of the inner ring": "mounting.fit.shaft",
    "fit of the outer ring": "mounting.fit.housing",
    "smoothing of the seats": "mounting.fit.smoothing",
    "temperatures": "mounting.temperatures",
    "speed": "mounting.speed",
}
"""What a contribution to the clearance comes from; the first from what it begins with."""


def _check_room(entry: Entry, mounting: Mounting, found: OperatingClearance) -> None:
    """Refuse a clearance in operation with which no rolling bearing runs.

    Raises
    ------
    InputError
        It is beyond a share of the rolling elements; what makes most of it is named.
    """
    most = MAX_CLEARANCE * entry.element_diameter / found.normal
    radial = found.radial
    worst = max((radial.mean, radial.least, radial.most), key=abs)
    if abs(worst) <= most:
        return
    end = ("mean", "least", "most")[(radial.mean, radial.least, radial.most).index(worst)]
    sign = 1.0 if worst > 0.0 else -1.0
    size, name = max((sign * getattr(part, end), key) for key, part in found.parts.items())
    begins = next(f"mounting.{one}" for one in INITIAL if getattr(mounting, one) is not None)
    key = _KEYS.get(name, begins)
    raise InputError(
        f"radial clearance in operation is {1e3 * worst:.4g} mm but must be from "
        f"{-1e3 * most:.4g} to {1e3 * most:.4g} mm, {100.0 * MAX_CLEARANCE:g} % of its rolling "
        f"elements along the contact: {key} makes {1e3 * sign * size:+.4g} mm of it; correct "
        "that"
    )


def normal_of(entry: Entry) -> float:
    """Clearance as a catalogue entry has it for one of radial clearance.

    Parameters
    ----------
    entry : Entry
        Of rollers half of the radial clearance times the cosine of their contact angle; of balls
        half of it, whatever their angle.
    """
    angle = 0.0 if entry.kind == "ball" else radians(abs(entry.contact_angle or 0.0))
    return 0.5 * cos(angle)


def _approach(entry: Entry, force: float) -> float:
    """Radial clearance that an axial preload takes from a row, as a positive number [m]."""
    tilt = radians(abs(entry.contact_angle or 0.0))
    if tilt == 0.0:
        raise InputError(
            f"bearing {entry.title!r} has no contact angle, so that no axial preload presses its "
            "rolling elements: give mounted_clearance"
        )
    law = entry.bearing(entry.title).rows[0].law
    each = force / (entry.elements * sin(tilt))
    return 2.0 * float((each / law.stiffness) ** (1.0 / law.exponent)) / cos(tilt)
