"""Insides that fit a catalogue's page: an ensemble of geometries instead of one that is assumed.

A page prints what rings and rollers have to fulfil: C0 by their number, length, diameter and
angle (ISO 76), C by the same in other powers (ISO 281), e and Y by the angle, and d, D and B by the
space. What it leaves open is drawn evenly from boxes (`BOXES`), point by point along one lattice,
so that the first members are the same however many are asked for. A member fulfils C0 exactly, by
the length of its rollers or the diameter of its balls; C within `RATED`, since makers choose b_m
and improve on it; the space within its box.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from fe_drivetrain.bearing.catalogue_page import MEMBERS, CataloguePage
from fe_drivetrain.bearing.rating import ball_capacity_factors, capacity_factors
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr

TRIED = 20000
"""Points of the lattice that are tried, at most."""

RATED = (0.92, 1.25)
"""Printed C over that of ISO 281 with b_m of 1.1 (1.15 of spherical rollers, 1.3 of balls): 1.0
where a maker follows the standard, 1.13 to 1.16 of one maker's improved cylindrical rollers whose
raceways are printed, and some beyond for what rounding, effective lengths and other b_m do."""

B_M = MappingProxyType({"spherical_roller": 1.15, "ball": 1.3})
"""b_m of ISO 281 by kind; 1.1 of other rollers. 1.15 is from memory, not verified."""

E_DIGITS = 0.005
"""Half of the last digit of e."""

CROWN = (0.5, 2.0)
"""Profile of rollers over the standard's."""


class Box(NamedTuple):
    """Ranges of what a page leaves open, of one kind of bearing.

    Attributes
    ----------
    pitch : tuple of float
        Pitch diameter over the mean of d and D.
    height : tuple of float
        Diameter of the elements, across the contact, over half of D - d.
    fill : tuple of float
        Diameters of all elements over the pitch circle.
    length : tuple of float
        Effective length of a roller over the width.
    slender : tuple of float
        That length over its diameter.
    angle : tuple of float
        Contact angle [deg] where neither e nor Y state it.
    """

    pitch: tuple[float, float]
    height: tuple[float, float]
    fill: tuple[float, float]
    length: tuple[float, float] = (0.0, 1.0)
    slender: tuple[float, float] = (0.0, 9.0)
    angle: tuple[float, float] = (0.0, 0.0)


FULL_COMPLEMENT = (0.93, 0.995)
"""Fill of a bearing without a cage."""

ANGULAR_FILL = (0.60, 0.95)
"""Fill of angular contact ball bearings, whose outer ring has one shoulder."""

BOXES: Mapping[str, Box] = MappingProxyType(
    {
        "cylindrical": Box((0.99, 1.03), (0.44, 0.62), (0.70, 0.93), (0.40, 0.82), (0.8, 3.0)),
        "toroidal": Box((0.98, 1.03), (0.40, 0.60), (0.72, 0.97), (0.50, 0.92), (1.0, 4.0)),
        "spherical_roller": Box(
            (0.96, 1.03), (0.38, 0.62), (0.72, 0.96), (0.24, 0.44), (0.8, 2.5), (5.0, 16.0)
        ),
        "single_row_tapered": Box(
            (0.98, 1.08), (0.32, 0.56), (0.75, 0.97), (0.45, 0.88), (0.9, 3.2), (10.0, 30.0)
        ),
        "double_row_tapered": Box(
            (0.97, 1.06), (0.30, 0.55), (0.78, 0.97), (0.20, 0.42), (0.9, 3.2), (10.0, 40.0)
        ),
        "ball": Box((0.985, 1.025), (0.48, 0.70), (0.48, 0.68), angle=(15.0, 40.0)),
    }
)
"""Ranges by kind. They hold bearings whose inside is published, as in the case
`bearing/by_designation`, with room beyond them, and are no standard's."""

SPREAD = (0.45, 0.55)
"""Distance of the middles of two inner raceways over the width, of two tapered rows."""

F_0 = (11.0, 17.0)
"""f_0 of balls where the page does not print it: what catalogues have."""

F_0_DIGITS = 0.5
"""Half of the last digit of f_0."""

CONFORMITY = (0.515, 0.530)
"""Radius of a groove over the diameter of a ball: usual ones, from memory, with the 0.52 and 0.53
that ISO 281 rates."""


@dataclass(frozen=True, eq=False)
class FittedRollers:
    """Geometries that fit a page, the first being those that were found first.

    Attributes
    ----------
    page : CataloguePage
        The page.
    elements : Floats
        (n,) rolling elements of one row.
    diameter, length, pitch : Floats
        (n,) diameter and effective length of an element, and pitch diameter [m]; length is 0 of
        balls.
    angle_deg : Floats
        (n,) contact angle [deg].
    spread : Floats
        (n,) distance of two tapered rows [m]; 0 of others.
    crown : Floats
        (n,) profile of rollers over the standard's [-].
    conformity : Floats
        (n,) radius of grooves over the diameter of balls [-].
    rated, limited : Floats
        (n,) C and Cu of ISO 281 over those printed [-]; NaN where none is printed, and Cu of balls.
    tried : int
        Points of the lattice up to the last one that fits.
    middle : int
        The member that is nearest to the medians of all.
    """

    page: CataloguePage
    elements: Floats
    diameter: Floats
    length: Floats
    pitch: Floats
    angle_deg: Floats
    spread: Floats
    crown: Floats
    conformity: Floats
    rated: Floats
    limited: Floats
    tried: int
    middle: int

    __repr__ = short_repr

    def __len__(self) -> int:
        """Number of geometries."""
        return len(self.elements)

    def fields(self, k: int) -> dict[str, Any]:
        """What a member has, by the names of `fe_drivetrain.bearing.Entry`.

        Parameters
        ----------
        k : int
            Number of the member.
        """
        kind = self.page.of_kind
        found: dict[str, Any] = {
            "elements": int(self.elements[k]),
            "element_diameter": float(self.diameter[k]),
            "pitch_diameter": float(self.pitch[k]),
        }
        if kind != "ball":
            found["element_length"] = float(self.length[k])
        if kind not in ("cylindrical", "toroidal"):
            found["contact_angle"] = float(self.angle_deg[k])
        if kind == "double_row_tapered":
            found["spread"] = float(self.spread[k])
        return found


@lru_cache(maxsize=64)
def fitted_rollers(page: CataloguePage, count: int = MEMBERS) -> FittedRollers:
    """Geometries that fit a catalogue's page.

    Parameters
    ----------
    page : CataloguePage
        What the catalogue prints, and what is known of the inside.
    count : int
        How many, from 2 on.

    Returns
    -------
    found : FittedRollers
        As many, or all that fit among the first 20,000 points of the lattice.

    Raises
    ------
    InputError
        None fits: which condition excludes most of them, with the values that it would need.
    """
    if count < 2:
        raise InputError(f"{count} geometries of {page.designation}: give 2 or more")
    box = _box(page)
    points = lattice(TRIED, 7)
    drawn = _balls(page, box, points) if page.of_kind == "ball" else _rollers(page, box, points)
    fits = np.all(list(drawn.holds.values()), axis=0)
    if not fits.any():
        raise InputError(_why_none(page, drawn))
    chosen = np.flatnonzero(fits)[:count]
    taken = {name: np.asarray(values[chosen]) for name, values in drawn.values.items()}
    numbers = np.column_stack([taken[name] for name in ("elements", "diameter", "length", "pitch")])
    apart = numbers - np.median(numbers, axis=0)
    sizes = np.maximum(numbers.std(axis=0), 1e-12 + 1e-9 * np.abs(numbers).max(axis=0))
    middle = int(np.argmin(np.linalg.norm(apart / sizes, axis=1)))
    return FittedRollers(page, **taken, tried=int(chosen[-1]) + 1, middle=middle)


def lattice(count: int, dimensions: int) -> Floats:
    """Points that fill the unit cube evenly, each a step on from the one before.

    Parameters
    ----------
    count, dimensions : int
        Numbers of points and of axes.

    Returns
    -------
    points : Floats
        (count, dimensions) from 0 to 1: Kronecker's lattice with powers of the root of
        x^(dimensions + 1) = x + 1 (Roberts 2018).
    """
    root = 1.5
    for _ in range(60):
        root = (1.0 + root) ** (1.0 / (dimensions + 1.0))
    steps = root ** -np.arange(1.0, dimensions + 1.0)
    return np.asarray((0.5 + np.arange(1, count + 1)[:, None] * steps) % 1.0)


@dataclass(frozen=True, eq=False)
class _Drawn:
    """What the points of the lattice amount to, and which conditions each holds."""

    values: dict[str, Floats]
    holds: dict[str, np.ndarray[Any, np.dtype[np.bool_]]]
    reached: dict[str, Floats]


def _box(page: CataloguePage) -> Box:
    box, read = BOXES[page.of_kind], page.read_as
    if read is not None and read.full_complement:
        box = box._replace(fill=FULL_COMPLEMENT)
    if page.of_kind == "ball" and page.angle != 0.0:
        box = box._replace(fill=ANGULAR_FILL)
    if page.row_count == 2 and page.of_kind == "cylindrical":
        box = box._replace(length=(0.5 * box.length[0], 0.5 * box.length[1]))
    return box


def _between(ends: tuple[float, float], share: Floats) -> Floats:
    return np.asarray(ends[0] + (ends[1] - ends[0]) * share)


def _angles(page: CataloguePage, box: Box, share: Floats) -> Floats:
    """Contact angles [rad]: as stated, within the digits of e, or from the box."""
    if page.angle is None:
        return np.radians(_between(box.angle, share))
    if page.contact_angle is None and page.e is not None and page.of_kind != "ball":
        e = _between((page.e - E_DIGITS, page.e + E_DIGITS), share)
        return np.asarray(np.arctan(np.maximum(e, 1e-3) / 1.5))
    return np.full(len(share), np.radians(page.angle))


def _pitch_and_diameter(
    page: CataloguePage, box: Box, points: Floats, cosine: Floats
) -> tuple[Floats, Floats]:
    """Pitch diameters and diameters of the elements [m], with the raceways that are printed."""
    bore, outside, _ = page.sizes
    pitch = page.mean_diameter * _between(box.pitch, points[:, 0])
    diameter = 0.5 * (outside - bore) * _between(box.height, points[:, 1]) / cosine
    if page.element_diameter is not None:
        diameter = np.full(len(points), page.element_diameter)
    elif page.F is not None and page.E is not None:
        diameter = np.full(len(points), 0.5 * (page.E - page.F))
    if page.pitch_diameter is not None:
        pitch = np.full(len(points), page.pitch_diameter)
    elif page.F is not None:
        pitch = page.F + diameter
    elif page.E is not None:
        pitch = page.E - diameter
    return pitch, diameter


def _rollers(page: CataloguePage, box: Box, points: Floats) -> _Drawn:
    angle = _angles(page, box, points[:, 3])
    cosine, i = np.cos(angle), page.row_count
    pitch, diameter = _pitch_and_diameter(page, box, points, cosine)
    gamma = diameter * cosine / pitch
    number = np.rint(_between(box.fill, points[:, 2]) * np.pi * pitch / diameter)
    if page.elements is not None:
        number = np.full(len(points), float(page.elements))
    number = np.maximum(number, 3.0)
    area = 1e-6 * page.C0 / (44.0 * (1.0 - gamma) * i * number * cosine)
    length = area / diameter
    holds = {}
    if page.element_length is not None:
        static, length = length / page.element_length, np.full(len(points), page.element_length)
        holds["C0 [-], printed over that of ISO 76"] = _inside(static, (0.97, 1.03))
    C = _dynamic(page, gamma, number, diameter, length, cosine)
    Cu = _limit(page, pitch)
    spread = _spread(page, points[:, 5], diameter, angle)
    width = page.sizes.width
    reached = {
        "length of a roller over the width [-]": length / width,
        "length of a roller over its diameter [-]": length / diameter,
        "printed C over that of ISO 281 [-]": page.C / C,
        "diameters of rollers over the pitch circle [-]": number * diameter / (np.pi * pitch),
    }
    most = max(box.fill[1], 0.999) if page.elements is not None else box.fill[1] + 0.02
    limits = (box.length, box.slender, RATED, (0.0, most))
    for (name, values), ends in zip(reached.items(), limits, strict=True):
        holds[f"{name}, {ends[0]:g} to {ends[1]:.3g}"] = _inside(values, ends)
    holds["rollers beside each other"] = diameter < pitch * np.sin(np.pi / number)
    ones = np.ones(len(points))
    return _Drawn(
        {
            "elements": number,
            "diameter": diameter,
            "length": length,
            "pitch": pitch,
            "angle_deg": np.degrees(angle),
            "spread": spread,
            "crown": CROWN[0] * (CROWN[1] / CROWN[0]) ** points[:, 4],
            "conformity": 0.52 * ones,
            "rated": C / page.C,
            "limited": Cu / page.Cu if page.Cu is not None else np.nan * ones,
        },
        holds,
        reached,
    )


def _balls(page: CataloguePage, box: Box, points: Floats) -> _Drawn:
    angle = _angles(page, box, points[:, 3])
    cosine = np.cos(angle)
    bore, outside, _ = page.sizes
    pitch, given = _pitch_and_diameter(page, box, points, cosine)
    f_0 = _between(F_0, points[:, 1])
    if page.f0 is not None:
        f_0 = _between((page.f0 - F_0_DIGITS, page.f0 + F_0_DIGITS), points[:, 1])
    area = 1e-6 * page.C0 / (f_0 * cosine)  # Z D^2
    fill = _between(box.fill, points[:, 2])
    number = np.maximum(np.rint((fill * np.pi * pitch) ** 2 / area), 3.0)
    if page.elements is not None:
        number = np.full(len(points), float(page.elements))
    diameter = given if page.element_diameter is not None else np.sqrt(area / number)
    gamma = diameter * cosine / pitch
    factor = ball_capacity_factors(gamma)
    D = 1e3 * diameter
    grown = np.where(D <= 25.4, D**1.8, 3.647 * D**1.4)
    C = B_M["ball"] * factor * cosine**0.7 * number ** (2.0 / 3.0) * grown
    conformity = _between(CONFORMITY, points[:, 4])
    reached = {
        "diameter of a ball over half of D - d [-]": diameter * cosine / (0.5 * (outside - bore)),
        "printed C over that of ISO 281 [-]": page.C / C,
        "diameters of balls over the pitch circle [-]": number * diameter / (np.pi * pitch),
    }
    holds = {}
    limits = (box.height, RATED, (0.9 * box.fill[0], 1.03 * box.fill[1]))
    for (name, values), ends in zip(reached.items(), limits, strict=True):
        holds[f"{name}, {ends[0]:.3g} to {ends[1]:.3g}"] = _inside(values, ends)
    ones = np.ones(len(points))
    return _Drawn(
        {
            "elements": number,
            "diameter": diameter,
            "length": 0.0 * ones,
            "pitch": pitch,
            "angle_deg": np.degrees(angle),
            "spread": 0.0 * ones,
            "crown": ones,
            "conformity": conformity,
            "rated": C / page.C,
            "limited": np.nan * ones,
        },
        holds,
        reached,
    )


def _dynamic(
    page: CataloguePage,
    gamma: Floats,
    number: Floats,
    diameter: Floats,
    length: Floats,
    cosine: Floats,
) -> Floats:
    """C of ISO 281 of rollers [N]."""
    lengths = (page.row_count * 1e3 * length * cosine) ** (7.0 / 9.0)
    sizes = number**0.75 * (1e3 * diameter) ** (29.0 / 27.0)
    return np.asarray(B_M.get(page.of_kind, 1.1) * capacity_factors(gamma) * lengths * sizes)


def _limit(page: CataloguePage, pitch: Floats) -> Floats:
    """C_u of ISO 281 of rollers, from the printed C0 [N]."""
    return np.asarray(page.C0 / 8.2 * np.minimum(0.1 / pitch, 1.0) ** 0.3)


def _spread(page: CataloguePage, share: Floats, diameter: Floats, angle: Floats) -> Floats:
    """Distance of the middles of two rows of tapered rollers [m]."""
    if page.of_kind != "double_row_tapered":
        return np.zeros(len(share))
    lean = diameter * np.sin(angle)
    middles = page.sizes.width * _between(SPREAD, share)
    return np.asarray(np.maximum(middles + (lean if page.arrangement == "X" else -lean), 1e-4))


def _inside(values: Floats, ends: tuple[float, float]) -> np.ndarray[Any, np.dtype[np.bool_]]:
    return np.asarray((values >= ends[0]) & (values <= ends[1]))


def _why_none(page: CataloguePage, drawn: _Drawn) -> str:
    """Which condition leaves the fewest geometries, and what they would need."""
    shares = {name: float(np.mean(held)) for name, held in drawn.holds.items()}
    worst = min(shares, key=lambda name: shares[name])
    others = np.all([held for name, held in drawn.holds.items() if name != worst], axis=0)
    plain = next((name for name in drawn.reached if worst.startswith(name)), None)
    would = ""
    if plain is not None:
        values = drawn.reached[plain][others] if others.any() else drawn.reached[plain]
        would = f", but is {values.min():.3g} to {values.max():.3g} here"
    bore, outside, width = (f"{1e3 * value:g}" for value in page.sizes)
    return (
        f"no inside fits the page of {page.designation}, C {1e-3 * page.C:g} and C0 "
        f"{1e-3 * page.C0:g} kN in {bore} x {outside} x {width} mm: {worst} is needed{would}; "
        "check C, C0, d, D and B (T of tapered bearings), what is stated of the inside, and kind"
    )
