"""Whether parts fit together, decided on their dimensions: no CAD model and no mesh is needed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import combinations, permutations
from typing import NamedTuple

from fe_drivetrain.common.errors import InputError

from .bearing import Bearing
from .housing import Housing
from .part import LENGTH_TOLERANCE
from .shaft import Shaft

WIDEST, LONGEST = 50.0, 1000.0
"""A part wider or longer than this (m) is in millimetres: the widest rotors of turbines have 12 m.
"""


def check_parts(
    shaft: Shaft | None,
    bearings: Sequence[Bearing],
    housings: Mapping[str, Housing],
    bonded: frozenset[str] = frozenset(),
) -> dict[str, float]:
    """Refuse parts that do not fit together.

    Parameters
    ----------
    shaft, bearings, housings, bonded : Shaft or None, Sequence[Bearing], Mapping, frozenset
        Parts, as `fe_drivetrain.geometry.build` takes them.

    Returns
    -------
    dict
        Diameter of the bore of each bearing by its name, m.

    Raises
    ------
    InputError
        A part lies outside of another, overlaps it, has no room, or is in millimetres.
    """
    _check_names(shaft, bearings, housings, bonded)
    _check_units(shaft, bearings, housings)
    bores = {b.name: _bore(shaft, b) for b in bearings}
    for bearing in bearings:
        bearing.check_bore(bores[bearing.name])
        if bearing.name in housings:
            housings[bearing.name].check_fits(bearing, shaft)
    _check_apart(bearings, housings)
    return bores


class Band(NamedTuple):
    """A part of the shaft's outer face where loads enter, or of its bore: x of both ends, m."""

    low: float
    high: float
    inside: bool = False


def check_bands(shaft: Shaft, bands: Mapping[str, Band], bearings: Sequence[Bearing]) -> None:
    """Refuse bands on the shaft, where loads enter, that lie off it or on something else.

    Parameters
    ----------
    shaft : Shaft
        The shaft.
    bands : Mapping[str, Band]
        Bands by name.
    bearings : Sequence[Bearing]
        The bearings on the shaft.

    Raises
    ------
    InputError
        A band does not lie on one cylindrical length, or touches a bearing or another band.
    """
    spans = [(f"bearing {b.name!r}", b.span) for b in bearings]
    for name, (low, high, inside) in bands.items():
        if inside:
            shaft.bore_diameter((low + high) / 2, high - low, name)
        else:
            shaft.seat_diameter((low + high) / 2, high - low, name, "load point")
            spans.append((f"load point {name!r}", (low, high)))
    for (one, first), (two, second) in combinations(spans, 2):
        if _gap(first, second) <= LENGTH_TOLERANCE and "load point" in two:
            raise InputError(
                f"{two} is on the shaft at x = {second[0]:g} to {second[1]:g} m and touches "
                f"{one} at x = {first[0]:g} to {first[1]:g} m, but must be apart: move it or make "
                "it narrower"
            )


def _check_names(
    shaft: Shaft | None,
    bearings: Sequence[Bearing],
    housings: Mapping[str, Housing],
    bonded: frozenset[str],
) -> None:
    names = [b.name for b in bearings]
    known = ", ".join(names) or "none"
    if shaft is None and not names:
        raise InputError("assembly: it has no shaft and no bearing: give at least one part")
    for first, second in combinations(names, 2):
        if first == second:
            raise InputError(f"bearing {first!r} is given twice: give each bearing its own name")
    for name in housings:
        if name not in names:
            raise InputError(f"housing {name!r} has no bearing of that name: use one of {known}")
    for name in sorted(bonded):
        if name not in housings:
            raise InputError(
                f"bonded bearing {name!r} has no bearing and housing of that name: use one of "
                f"{', '.join(housings) or 'none'}"
            )


def _check_units(
    shaft: Shaft | None, bearings: Sequence[Bearing], housings: Mapping[str, Housing]
) -> None:
    """Refuse parts of a size that only millimetres taken for metres explain."""
    for part, long, wide in _extents(shaft, bearings, housings):
        refuse_millimetres(part, long, wide)


def _extents(
    shaft: Shaft | None, bearings: Sequence[Bearing], housings: Mapping[str, Housing]
) -> list[tuple[str, float, float]]:
    """Parts, and their extents along x and across, m."""
    extents = [(f"bearing {b.name!r}", b.width, b.raceway_diameter) for b in bearings]
    extents += [
        (f"housing of {name!r}", max(h.width, h.foot_width), max(h.foot_length, h.centre_height))
        for name, h in housings.items()
    ]
    if shaft is not None:
        wide = max(max(p.outer_diameter, p.end_diameter) for p in shaft.pieces)
        extents.append(("shaft", shaft.length, wide))
    return extents


def refuse_oversize(
    shaft: Shaft, bearings: Sequence[Bearing], housings: Mapping[str, Housing]
) -> None:
    """Refuse parts of a scene that are longer than a nacelle.

    Parts on their own may be longer, see `refuse_millimetres`.

    Parameters
    ----------
    shaft, bearings, housings : Shaft, Sequence[Bearing], Mapping[str, Housing]
        The parts.

    Raises
    ------
    InputError
    """
    for part, long, wide in _extents(shaft, bearings, housings):
        refuse_millimetres(part, long, wide, WIDEST)


def refuse_millimetres(part: str, long: float, wide: float, longest: float = LONGEST) -> None:
    """Refuse a part of implausible size.

    Parameters
    ----------
    part : str
        Name of the part, for the message.
    long, wide : float
        Extents of the part along x and across, m.
    longest : float
        Maximum length along x, m.

    Raises
    ------
    InputError
    """
    if long > longest or wide > WIDEST:
        raise InputError(
            f"{part} is {long:g} m long and {wide:g} m wide, but must be at most {longest:g} m "
            f"long and {WIDEST:g} m wide: lengths are in metres, {long / 1000:g} and "
            f"{wide / 1000:g} m if these were millimetres"
        )


def _bore(shaft: Shaft | None, bearing: Bearing) -> float:
    """Diameter of the bore of a bearing, m."""
    if shaft is None:
        if bearing.bore_diameter is None:
            raise InputError(
                f"bearing {bearing.name!r} has no bore_diameter and there is no shaft to take it "
                "from: give bore_diameter in m"
            )
        return bearing.bore_diameter
    seat = shaft.seat_diameter(bearing.x, bearing.width, bearing.name)
    bore = bearing.bore_diameter
    if bore is not None and abs(bore - seat) > LENGTH_TOLERANCE:
        raise InputError(
            f"parts 'shaft' and {bearing.name!r} do not fit: bore_diameter is {bore:g} m but the "
            f"shaft is {seat:g} m there: leave bore_diameter out or make the two equal"
        )
    return seat


def _check_apart(bearings: Sequence[Bearing], housings: Mapping[str, Housing]) -> None:
    """Refuse bearing units that overlap or touch."""
    for one, two in combinations(bearings, 2):
        gap = _gap(one.span, two.span)
        if gap <= LENGTH_TOLERANCE:
            _refuse_contact(one.name, two.name, gap)
    for one, two in permutations(bearings, 2):
        if two.name in housings:
            _check_beside(one, two, housings[two.name])
    for one, two in combinations([b for b in bearings if b.name in housings], 2):
        first, second = housings[one.name], housings[two.name]
        if _inside(first, one, two) or _inside(second, two, one):
            continue
        gap = min(
            max(_gap(a[0], b[0]), _gap(a[1], b[1]))
            for a in _boxes(first, one)
            for b in _boxes(second, two)
        )
        if gap <= LENGTH_TOLERANCE:
            _refuse_contact(f"{one.name}.housing", f"{two.name}.housing", gap)


_Interval = tuple[float, float]


def _boxes(housing: Housing, bearing: Bearing) -> list[tuple[_Interval, _Interval]]:
    """Intervals of x and z of shell with pedestal, and of the foot."""
    low = -housing.centre_height
    middle = low + housing.foot_thickness
    return [
        ((bearing.x - width / 2, bearing.x + width / 2), heights)
        for width, heights in (
            (housing.width, (middle, housing.outer_radius(bearing))),
            (housing.foot_width, (low, middle)),
        )
    ]


def _inside(housing: Housing, bearing: Bearing, other: Bearing) -> bool:
    """Whether a housing is wholly within the bore of another bearing's."""
    corner = math.hypot(housing.foot_length / 2, housing.centre_height)
    return max(corner, housing.outer_radius(bearing)) < other.raceway_diameter / 2


def _check_beside(bearing: Bearing, other: Bearing, housing: Housing) -> None:
    """Refuse a bearing that cuts into the housing of another."""
    for width, depth in (
        (housing.width, 0.0),
        (housing.foot_width, housing.centre_height - housing.foot_thickness),
    ):
        low = max(bearing.span[0], other.x - width / 2)
        high = min(bearing.span[1], other.x + width / 2)
        if low > high + LENGTH_TOLERANCE:
            continue
        # the difference of the squares is linear or concave in x, but for a sphere in a cylinder
        places = [low, high, min(max(bearing.x, low), max(low, high))]
        gap = min(max(_room(other, x), depth) - _room(bearing, x) for x in places)
        if gap <= LENGTH_TOLERANCE:
            _refuse_contact(bearing.name, f"{other.name}.housing", gap)


def _room(bearing: Bearing, x: float) -> float:
    """Radius at x of a bearing's outer face, or of the bore of its housing, m."""
    radius = bearing.raceway_diameter / 2
    if bearing.kind == "ring":
        return radius
    return math.sqrt(max(radius**2 - (x - bearing.x) ** 2, 0.0))


def _gap(one: _Interval, two: _Interval) -> float:
    """Distance of two intervals, negative where they overlap."""
    return max(one[0], two[0]) - min(one[1], two[1])


def _refuse_contact(first: str, second: str, gap: float) -> None:
    if gap < -LENGTH_TOLERANCE:
        raise InputError(
            f"parts {first!r} and {second!r} overlap, but must not: move them apart or make one "
            "smaller"
        )
    raise InputError(
        f"parts {first!r} and {second!r} touch, but must be apart: move one of them or make it "
        "smaller"
    )
