"""The shaft: sections along x, built as one solid of revolution of its meridian profile."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from itertools import pairwise
from typing import Any, NamedTuple, Self

import gmsh
from pydantic import Field, field_validator, model_validator

from fe_drivetrain.common.errors import InputError

from .part import LENGTH_TOLERANCE, Part, bare_sentence, dimension

FINEST = 1e-5
"""Details of a meridian shorter than this (m) are refused: less than the tolerance of any turned
part, and too near to that of the CAD kernel, which fails at 1e-7."""


MAIN_SHAFT = "main shaft"
"""Name of a drivetrain's main shaft, where its file gives no other."""

_NAMED = 3  # cylindrical lengths that a message names, those nearest to a bearing


class Segment(NamedTuple):
    """One piece of a meridian, in (x, radius); an arc where `centre` is given."""

    start: tuple[float, float]
    end: tuple[float, float]
    centre: tuple[float, float] | None = None


class Section(Part):
    """One length of shaft of constant diameter, or tapered."""

    length: float = dimension(of="length along x", gt=0)
    outer_diameter: float = dimension(of="outer diameter at the front", gt=0)
    inner_diameter: float = dimension(0.0, of="bore diameter, 0 where solid", ge=0)
    outer_diameter_end: float | None = dimension(
        None, of="outer diameter at the rear where the section is tapered", gt=0
    )
    fillet: float = dimension(
        0.0,
        of="radius of the concave fillet at the foot of the step to the next section",
        ge=0,
    )

    @model_validator(mode="after")
    def _has_a_wall(self) -> Self:
        thinnest = min(self.outer_diameter, self.end_diameter)
        if self.inner_diameter >= thinnest - LENGTH_TOLERANCE:
            raise InputError(
                f"Section: inner_diameter is {self.inner_diameter:g} m but must be less than the "
                f"outer diameter, {thinnest:g} m: make the bore smaller or the section thicker"
            )
        return self

    @property
    def end_diameter(self) -> float:
        """Outer diameter at the rear end, m."""
        return self.outer_diameter if self.outer_diameter_end is None else self.outer_diameter_end


class Flange(Part):
    """A disc at the front of the shaft, before its first section."""

    outer_diameter: float = dimension(of="outer diameter", gt=0)
    thickness: float = dimension(of="thickness along x", gt=0)
    fillet: float = dimension(
        0.0, of="radius of the concave fillet at the foot of the flange", ge=0
    )


class Shaft(Part):
    """A shaft along x: an optional front flange, then the sections from front to rear."""

    name: str = Field(default=MAIN_SHAFT, description="name among the shafts of a drivetrain")
    front: float = dimension(of="x of the front face")
    sections: tuple[Section, ...] = Field(
        min_length=1, description="sections from front to rear, at least one"
    )
    flange: Flange | None = Field(
        default=None, description="front flange, before the first section"
    )
    material: str = Field(default="steel", description="name of the material")

    @field_validator("sections", mode="before")
    @classmethod
    def _numbered(cls, value: Any) -> Any:
        """Say which section is wrong, counting from one at the front."""
        if not isinstance(value, list | tuple):
            return value
        sections = []
        for number, item in enumerate(value, start=1):
            try:
                sections.append(Section.model_validate(item) if isinstance(item, Mapping) else item)
            except InputError as error:
                raise InputError(f"shaft section {number}: {bare_sentence(error)}") from None
        return sections

    @model_validator(mode="after")
    def _hangs_together(self) -> Self:
        for (one, two), x in zip(pairwise(self.pieces), self.stations[1:], strict=False):
            bore = max(one.inner_diameter, two.inner_diameter)
            outer = min(one.end_diameter, two.outer_diameter)
            if bore >= outer - LENGTH_TOLERANCE:
                raise InputError(
                    f"shaft step at x = {x:g} m: the bore is {bore:g} m but must be less than the "
                    f"outer diameter, {outer:g} m, of the section beside it, or the two fall "
                    "apart: make the bore smaller or the section thicker"
                )
        self.outer_profile()
        return self

    @property
    def length(self) -> float:
        """Length from the front face (of the flange, if any) to the rear face, m."""
        return math.fsum(piece.length for piece in self.pieces)

    @property
    def rear(self) -> float:
        """x of the rear face, m."""
        return self.front + self.length

    @property
    def pieces(self) -> tuple[Section, ...]:
        """The flange, if any, as a section of its own, then the sections."""
        if self.flange is None:
            return self.sections
        disc = Section(
            length=self.flange.thickness,
            outer_diameter=self.flange.outer_diameter,
            inner_diameter=self.sections[0].inner_diameter,
            fillet=self.flange.fillet,
        )
        return (disc, *self.sections)

    @property
    def stations(self) -> tuple[float, ...]:
        """x of every end of a piece, from front to rear, m."""
        xs = [self.front]
        for piece in self.pieces:
            xs.append(xs[-1] + piece.length)
        return tuple(xs)

    def outer_profile(self) -> tuple[Segment, ...]:
        """Outline of the outer surface from front to rear, fillets included.

        Raises
        ------
        InputError
            A fillet without a step, larger than its step, or longer than its section.
        """
        pieces, xs = self.pieces, self.stations
        path: list[tuple[tuple[float, float], tuple[float, float] | None]] = [
            ((xs[0], pieces[0].outer_diameter / 2), None)
        ]
        # room taken by a fillet at either end of each piece
        taken = [[0.0, 0.0] for _ in pieces]
        for i, (piece, x) in enumerate(zip(pieces, xs[1:], strict=True)):
            before = piece.end_diameter / 2
            if i + 1 == len(pieces):
                if piece.fillet > 0:
                    raise InputError(
                        f"shaft section at x = {xs[i]:g} m: fillet is {piece.fillet:g} m but must "
                        "be 0 on the last section, which has no step behind it: remove it"
                    )
                path.append(((x, before), None))
                break
            after = pieces[i + 1].outer_diameter / 2
            step = abs(after - before)
            if piece.fillet == 0:
                path.append(((x, before), None))
                if step > LENGTH_TOLERANCE:
                    path.append(((x, after), None))
                continue
            low, thin = (i, piece) if before < after else (i + 1, pieces[i + 1])
            rise = (thin.end_diameter - thin.outer_diameter) / 2
            away = -1.0 if low == i else 1.0
            slant = math.hypot(thin.length, rise)
            u = (away * thin.length / slant, away * rise / slant)
            half = math.acos(u[1]) / 2
            reach = piece.fillet / math.tan(half)
            if reach > step + LENGTH_TOLERANCE:
                raise InputError(
                    f"shaft step at x = {x:g} m: fillet is {piece.fillet:g} m but must be at most "
                    f"{step * math.tan(half):g} m, what the step of {step:g} m in radius allows: "
                    "reduce the fillet"
                )
            taken[low][1 if low == i else 0] = reach * abs(u[0])
            if sum(taken[low]) > thin.length + LENGTH_TOLERANCE:
                raise InputError(
                    f"shaft step at x = {x:g} m: fillet is {piece.fillet:g} m but needs "
                    f"{sum(taken[low]):g} m of a section {thin.length:g} m long (with the fillet "
                    "at its other end): reduce the fillet or lengthen the section"
                )
            foot = (x, min(before, after))
            on_thin = (foot[0] + reach * u[0], foot[1] + reach * u[1])
            on_step = (foot[0], foot[1] + reach)
            towards = (u[0], u[1] + 1.0)
            scale = piece.fillet / math.sin(half) / math.hypot(*towards)
            centre = (foot[0] + scale * towards[0], foot[1] + scale * towards[1])
            if low == i:
                path += [(on_thin, None), (on_step, centre), ((x, after), None)]
            else:
                path += [((x, before), None), (on_step, None), (on_thin, centre)]
        segments = []
        for (start, _), (end, centre_of_arc) in pairwise(path):
            if math.dist(start, end) > LENGTH_TOLERANCE:
                segments.append(Segment(start, end, centre_of_arc))
        return tuple(segments)

    def outer_radius(self, x: float) -> float:
        """Maximum outer radius at x, m (fillets left out: they only add material)."""
        radii = []
        for piece, x0, x1 in zip(self.pieces, self.stations, self.stations[1:], strict=False):
            if x0 - LENGTH_TOLERANCE <= x <= x1 + LENGTH_TOLERANCE:
                share = min(max((x - x0) / piece.length, 0.0), 1.0)
                radii.append((piece.outer_diameter * (1 - share) + piece.end_diameter * share) / 2)
        return max(radii, default=0.0)

    def seat_diameter(self, x: float, width: float, name: str, what: str = "bearing") -> float:
        """Diameter of the shaft under a bearing, or where a load enters.

        Parameters
        ----------
        x, width : float
            Centre and width of the seat, m.
        name : str
            Name of the bearing, for the message.
        what : str
            Name of the seat, where it is no bearing.

        Returns
        -------
        float
            Diameter, m.

        Raises
        ------
        InputError
            The seat does not lie on one cylindrical length of the shaft.
        """
        low, high = x - width / 2, x + width / 2
        free = [
            segment
            for segment in self.outer_profile()
            if segment.centre is None and segment.start[1] == segment.end[1]
        ]
        for segment in free:
            if (
                segment.start[0] <= low + LENGTH_TOLERANCE
                and high <= segment.end[0] + LENGTH_TOLERANCE
            ):
                return 2 * segment.start[1]
        nearest = sorted(free, key=lambda s: max(s.start[0] - x, x - s.end[0]))[:_NAMED]
        nearest.sort(key=lambda s: s.start[0])
        allowed = _ranges((s.start[0], s.end[0]) for s in nearest)
        raise InputError(
            f"{what} {name!r}: its seat on the shaft is x = {low:g} to {high:g} m but must lie on "
            f"one cylindrical length clear of steps, tapers and fillets ({allowed} m): move the "
            f"{what}, make it narrower, or lengthen that section"
        )

    def inner_radius(self, x: float) -> float:
        """Minimum radius of the bore at x, m; 0 where the shaft is solid."""
        return min(
            (
                piece.inner_diameter / 2
                for piece, x0, x1 in zip(
                    self.pieces, self.stations, self.stations[1:], strict=False
                )
                if x0 - LENGTH_TOLERANCE <= x <= x1 + LENGTH_TOLERANCE
            ),
            default=0.0,
        )

    def bore_diameter(self, x: float, width: float, name: str) -> float:
        """Diameter of the shaft's bore round a bearing that is inside of it.

        Parameters
        ----------
        x, width : float
            Centre and width of the bearing, m.
        name : str
            Name of the bearing, for the message.

        Returns
        -------
        float
            Diameter, m.

        Raises
        ------
        InputError
            The bearing does not lie within one cylindrical length of the bore.
        """
        low, high = x - width / 2, x + width / 2
        lengths: list[tuple[float, float, float]] = []
        for piece, x0, x1 in zip(self.pieces, self.stations, self.stations[1:], strict=False):
            bore = piece.inner_diameter
            if lengths and abs(lengths[-1][2] - bore) < LENGTH_TOLERANCE:
                lengths[-1] = (lengths[-1][0], x1, bore)
            else:
                lengths.append((x0, x1, bore))
        for x0, x1, bore in lengths:
            if bore > 0 and x0 - LENGTH_TOLERANCE <= low and high <= x1 + LENGTH_TOLERANCE:
                return bore
        allowed = _ranges((x0, x1) for x0, x1, bore in lengths if bore > 0)
        raise InputError(
            f"bearing {name!r}: its seat in the shaft's bore is x = {low:g} to {high:g} m but must "
            f"lie on one cylindrical length of the bore ({allowed} m): move the bearing, make it "
            "narrower, or bore the shaft there"
        )

    def cut(self, stations: Iterable[float]) -> Shaft:
        """The same shaft, the flange a section, and sections divided at each x inside them, m."""
        places = sorted(set(stations))
        sections: list[Section] = []
        for piece, low, high in zip(self.pieces, self.stations, self.stations[1:], strict=False):
            inside = [x for x in places if low + LENGTH_TOLERANCE < x < high - LENGTH_TOLERANCE]
            slope = (piece.end_diameter - piece.outer_diameter) / piece.length
            for start, end in pairwise([low, *inside, high]):
                change = {
                    "length": end - start,
                    "outer_diameter": piece.outer_diameter + slope * (start - low),
                    "outer_diameter_end": piece.outer_diameter + slope * (end - low),
                    "fillet": piece.fillet if end == high else 0.0,
                }
                sections.append(piece.model_copy(update=change))
        return self.model_copy(update={"sections": tuple(sections), "flange": None})

    def build(
        self,
        seats: Iterable[tuple[float, float]] = (),
        bore_seats: Iterable[tuple[float, float]] = (),
    ) -> int:
        """Add the solid to the open gmsh model.

        Parameters
        ----------
        seats : Iterable[tuple[float, float]]
            Intervals (low, high) of x, m, each to become a cylindrical face of its own.
        bore_seats : Iterable[tuple[float, float]]
            The same of the bore.

        Returns
        -------
        int
            Tag of the volume.
        """
        return revolve(self.faces(seats, bore_seats))

    def faces(
        self,
        seats: Iterable[tuple[float, float]] = (),
        bore_seats: Iterable[tuple[float, float]] = (),
    ) -> list[Segment]:
        """Closed meridian, a segment for each face of the solid; arguments of `build`."""
        cuts = sorted({x for seat in seats for x in seat})
        bore_cuts = sorted({x for seat in bore_seats for x in seat})
        outline = [piece for segment in self.outer_profile() for piece in split(segment, cuts)]
        inner: list[tuple[float, float]] = []
        for piece, x0, x1 in zip(self.pieces, self.stations, self.stations[1:], strict=False):
            inside = [x for x in bore_cuts if x0 + LENGTH_TOLERANCE < x < x1 - LENGTH_TOLERANCE]
            inner += [(x, piece.inner_diameter / 2) for x in (x0, *inside, x1)]
        corners = [outline[-1].end, *reversed(inner), outline[0].start]
        for start, end in pairwise(corners):
            if math.dist(start, end) > LENGTH_TOLERANCE:
                outline.append(Segment(start, end))
        return outline


def _ranges(lengths: Iterable[tuple[float, float]]) -> str:
    """Ranges of x in words, without the round-off of sums of lengths."""
    rounded = [[round(x, 9) + 0.0 for x in ends] for ends in lengths]
    return ", ".join(f"{low:g} to {high:g}" for low, high in rounded) or "none"


def split(segment: Segment, cuts: Iterable[float]) -> list[Segment]:
    """Cut a straight segment at each x inside it (`cuts` ascending, segment running along +x)."""
    if segment.centre is not None or segment.start[0] == segment.end[0]:
        return [segment]
    pieces = []
    (x0, r0), (x1, r1) = start, end = segment.start, segment.end
    for x in cuts:
        if start[0] + LENGTH_TOLERANCE < x < end[0] - LENGTH_TOLERANCE:
            share = (x - x0) / (x1 - x0)
            pieces.append(Segment(start, (x, r0 + share * (r1 - r0))))
            start = pieces[-1].end
    return [*pieces, Segment(start, end)]


def refuse_fine_details(outline: Iterable[Segment]) -> None:
    """Refuse a meridian with a segment shorter than `FINEST`, or a bore narrower.

    Raises
    ------
    InputError
    """
    for segment in outline:
        (x0, r0), (x1, r1) = segment.start, segment.end
        size, what = math.dist(segment.start, segment.end), "length"
        if 0 < r0 < size or 0 < r1 < size:
            size, what = min(r for r in (r0, r1) if r > 0), "radius"
        if size < FINEST - LENGTH_TOLERANCE:
            raise InputError(
                f"a detail at x = {x0:.7g} to {x1:.7g} m, radius {r0:.7g} to {r1:.7g} m (a step, "
                f"a bore, a fillet or what it leaves, or a rim beside a seat) has a {what} of "
                f"{size:.2g} m but must have at least {FINEST:g} m, or none: enlarge it or leave "
                "it out"
            )


def revolve(outline: Iterable[Segment]) -> int:
    """Turn a closed meridian round the x axis into a solid of the open gmsh model.

    Parameters
    ----------
    outline : Iterable[Segment]
        Segments that follow one another and close, radii >= 0.

    Returns
    -------
    int
        Tag of the volume.

    Raises
    ------
    InputError
        A detail is finer than `FINEST`.
    """
    outline = list(outline)
    refuse_fine_details(outline)
    occ = gmsh.model.occ
    tags: dict[tuple[float, float], int] = {}

    def point(at: tuple[float, float]) -> int:
        key = (round(at[0], 10), round(at[1], 10))
        if key not in tags:
            tags[key] = occ.addPoint(at[0], 0.0, at[1])
        return tags[key]

    curves = []
    for segment in outline:
        start, end = point(segment.start), point(segment.end)
        if segment.centre is None:
            curves.append(occ.addLine(start, end))
        else:
            centre = occ.addPoint(segment.centre[0], 0.0, segment.centre[1])
            curves.append(occ.addCircleArc(start, centre, end))
            occ.remove([(0, centre)])
    face = occ.addPlaneSurface([occ.addCurveLoop(curves)])
    swept = occ.revolve([(2, face)], 0, 0, 0, 1, 0, 0, 2 * math.pi)
    (solid,) = (tag for dim, tag in swept if dim == 3)
    occ.remove([(2, face)], recursive=True)
    return int(solid)
