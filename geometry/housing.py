"""The housing: a pillow block round a bearing."""

from __future__ import annotations

import math
from itertools import product
from typing import Literal, NamedTuple, Self

import gmsh
from pydantic import Field, model_validator

from fe_drivetrain.common.errors import InputError

from .bearing import Bearing
from .part import LENGTH_TOLERANCE, Part, dimension, slip_of_units
from .shaft import Shaft

THICKEST = 10.0
"""Thickest wall of a housing, in diameters of its raceway: real ones have 0.1 to 0.3, and one in
millimetres has a hundred."""


_BOLTS = ("bolt_diameter", "bolt_spacing_x", "bolt_spacing_y", "washer_diameter")


def _default(name: str) -> float:
    return float(Housing.model_fields[name].default)


class CurvedFace(NamedTuple):
    """A cylinder or a zone of a sphere: radius and length, m, area, m^2, and where it is, m.

    Its width along the meridian, m, counts where it goes all round the shaft's axis.
    """

    radius: float
    length: float
    area: float
    x: tuple[float, float]
    y: tuple[float, float]
    width: float = math.inf


class HousingSolid(NamedTuple):
    """Tags in the open gmsh model of what a housing consists of."""

    volume: int
    washers: tuple[int, ...]
    points: dict[str, int]


class Housing(Part):
    """A pillow block: a half-round shell over the bore, a pedestal under it, and a foot.

    It is centred on its bearing in x and y; the base is the underside of the foot, at
    z = -centre_height. The body includes the outer ring of the bearing, so that the raceway is
    the bore. It is solid: no split line, cap bolts, seals or cavities.

    The defaults are those of a plausible block for a spherical roller bearing of 400 mm bore and
    650 mm outside diameter D. No catalogue of such housings was available to take them from: all
    are assumptions, in round numbers, each with its reason.
    """

    centre_height: float = dimension(
        0.42,
        of="height of the shaft axis over the base",
        gt=0,
        source="assumed: about 0.65 D, which leaves 95 mm of iron under the outer ring",
    )
    width: float = dimension(
        0.30,
        of="width of the shell and pedestal along x",
        gt=0,
        source="assumed: bearing width 200 mm plus 50 mm a side for the walls that carry the seals",
    )
    wall: float = dimension(
        0.11,
        of="thickness of the shell outside the raceway, outer ring included",
        gt=0,
        source="assumed: 25 mm of outer ring (from D to the raceway) plus 85 mm of casting",
    )
    foot_length: float = dimension(
        1.25,
        of="length of the foot along y",
        gt=0,
        source="assumed: the body (820 mm) plus 215 mm a side for the bolts",
    )
    foot_width: float = dimension(
        0.36,
        of="width of the foot along x",
        gt=0,
        source="assumed: the body plus 30 mm a side, room for two bolts abreast",
    )
    foot_thickness: float = dimension(
        0.10, of="thickness of the foot", gt=0, source="assumed: about 2 bolt diameters"
    )
    pedestal_width: float = dimension(
        0.82,
        of="width of the pedestal along y, where it meets the foot",
        gt=0,
        source="assumed: raceway diameter plus two walls, so that the flanks are upright",
    )
    bore_diameter: float | None = dimension(
        None,
        of="diameter of the bore; left out, the raceway_diameter of the bearing",
        gt=0,
        source="assumed: equal to the raceway, that is, no clearance (Stirling 2023, chapter 3)",
    )
    base: Literal["fixed", "bolted"] = Field(
        default="fixed",
        description="'fixed': the whole underside; 'bolted': four washer footprints",
    )
    bolt_diameter: float = dimension(
        0.052,
        of="diameter of the bolt holes (base 'bolted' only)",
        gt=0,
        source="assumed: clearance hole of an M48 bolt, ISO 273 medium series",
    )
    bolt_spacing_y: float = dimension(
        1.06,
        of="distance of the bolts along y (base 'bolted' only)",
        gt=0,
        source="assumed: bolts in the middle of the free ends of the foot",
    )
    bolt_spacing_x: float = dimension(
        0.20,
        of="distance of the bolts along x (base 'bolted' only)",
        gt=0,
        source="assumed: washers clear of each other and of the edges of the foot",
    )
    washer_diameter: float = dimension(
        0.092,
        of="diameter of the washer footprints (base 'bolted' only)",
        gt=0,
        source="assumed: outer diameter of an M48 washer, ISO 7089",
    )
    material: str = Field(default="ductile_iron", description="name of the material")

    @model_validator(mode="after")
    def _holds_together(self) -> Self:
        limits = [
            ("foot_thickness", self.foot_thickness, "centre_height", self.centre_height),
            ("pedestal_width", self.pedestal_width, "foot_length", self.foot_length),
        ]
        given = [name for name in _BOLTS if getattr(self, name) != _default(name)]
        if self.base == "bolted" or given:
            washer = self.washer_diameter
            bolted = [
                ("bolt_diameter", self.bolt_diameter, "washer_diameter", washer),
                ("washer_diameter", washer, "bolt_spacing_x", self.bolt_spacing_x),
                (
                    "bolt_spacing_x",
                    self.bolt_spacing_x,
                    "foot_width less washer_diameter",
                    self.foot_width - washer,
                ),
                (
                    "bolt_spacing_y",
                    self.bolt_spacing_y,
                    "foot_length less washer_diameter",
                    self.foot_length - washer,
                ),
                (
                    "pedestal_width",
                    self.pedestal_width,
                    "bolt_spacing_y less washer_diameter",
                    self.bolt_spacing_y - washer,
                ),
            ]
            # what is given must fit, used or not; the defaults need not where nothing uses them
            limits += [one for one in bolted if self.base == "bolted" or one[0] in given]
        for name, value, limit_name, limit in limits:
            if value >= limit - LENGTH_TOLERANCE:
                raise InputError(
                    f"Housing: {name} is {value:g} m but must be less than {limit_name}, "
                    f"{limit:g} m{slip_of_units(value, limit)}: change one of them"
                )
        return self

    def outer_radius(self, bearing: Bearing) -> float:
        """Radius of the half-round outside of the shell, m."""
        return bearing.raceway_diameter / 2 + self.wall

    def check_fits(self, bearing: Bearing, shaft: Shaft | None) -> None:
        """Refuse a housing that does not go round its bearing or its shaft.

        Raises
        ------
        InputError
            The bore does not match the bearing, breaks out of the block, or leaves no room for
            the shaft, or the wall is in millimetres.
        """
        name = f"{bearing.name}.housing"
        raceway, radius = bearing.raceway_diameter, bearing.raceway_diameter / 2
        if self.bore_diameter is not None and abs(self.bore_diameter - raceway) > LENGTH_TOLERANCE:
            fault = "do not touch" if self.bore_diameter > raceway else "overlap"
            raise InputError(
                f"parts {bearing.name!r} and {name!r} {fault}: bore_diameter is "
                f"{self.bore_diameter:g} m but must equal the bearing's raceway_diameter, "
                f"{raceway:g} m: leave bore_diameter out or make the two equal"
            )
        if self.wall > THICKEST * raceway:
            raise InputError(
                f"{name}: wall is {self.wall:g} m but must be at most {THICKEST * raceway:g} m, "
                f"{THICKEST:g} diameters of the raceway: lengths are in metres, "
                f"{self.wall / 1000:g} m if this was in millimetres"
            )
        if self.centre_height <= radius + LENGTH_TOLERANCE:
            raise InputError(
                f"{name}: centre_height is {self.centre_height:g} m but must be greater than the "
                f"radius of the bore, {radius:g} m, or the bore breaks through the base: raise "
                "the centre"
            )
        outer, drop = self.outer_radius(bearing), self.centre_height - self.foot_thickness
        lean = self.pedestal_width / 2 - outer
        # where a flank, from (outer, 0) down to the foot, is nearest to the centre
        along = min(max(-lean * outer / (lean**2 + drop**2), 0.0), 1.0)
        if math.hypot(outer + along * lean, along * drop) <= radius + LENGTH_TOLERANCE:
            raise InputError(
                f"{name}: pedestal_width is {self.pedestal_width:g} m but must be greater, or the "
                f"bore of {raceway:g} m breaks through its flanks: {2 * outer:g} m gives upright "
                "flanks"
            )
        if bearing.kind == "spherical" and self.width >= raceway - LENGTH_TOLERANCE:
            raise InputError(
                f"{name}: width is {self.width:g} m but must be less than the diameter of its "
                f"spherical bore, {raceway:g} m, or the bore has no opening: make the housing "
                "narrower"
            )
        if shaft is not None:
            self.check_clear(bearing, shaft)

    def check_clear(self, bearing: Bearing, shaft: Shaft, what: str = "shaft") -> None:
        """Refuse a housing that touches a body of revolution in its bore or over its foot.

        Parameters
        ----------
        bearing, shaft : Bearing, Shaft
            The bearing in its bore, and the body.
        what : str
            Name of the body.

        Raises
        ------
        InputError
        """
        drop = self.centre_height - self.foot_thickness
        for width, depth in ((self.width, 0.0), (self.foot_width, drop)):
            low, high = bearing.x - width / 2, bearing.x + width / 2
            corners = [p for s in shaft.outer_profile() for p in (s.start, s.end)]
            corners += [(x, shaft.outer_radius(x)) for x in (low, high)]
            for x, radius in corners:
                if not low - LENGTH_TOLERANCE <= x <= high + LENGTH_TOLERANCE:
                    continue
                opening = bearing.raceway_diameter / 2
                if bearing.kind == "spherical":
                    opening = math.sqrt(opening**2 - min(abs(x - bearing.x), opening) ** 2)
                if max(opening, depth) > radius + LENGTH_TOLERANCE:
                    continue
                part = f"{bearing.name}.housing"
                if depth > opening:
                    raise InputError(
                        f"{part}: its foot of width {width:g} m has room for a radius of "
                        f"{depth:g} m at x = {x:g} m, but the {what} has {radius:g} m there and "
                        "must be smaller: make the foot narrower or raise the centre"
                    )
                raise InputError(
                    f"{part}: its opening at x = {x:g} m is {2 * opening:g} m in "
                    f"diameter but must be greater than the {what}, {2 * radius:g} m there: "
                    "make the housing narrower or the raceway larger"
                )

    def volume(self, bearing: Bearing) -> float:
        """Volume round a bearing, m^3; what a bore takes of the foot is left in."""
        outer, radius = self.outer_radius(bearing), bearing.raceway_diameter / 2
        drop = self.centre_height - self.foot_thickness
        bore = math.pi * radius**2 * self.width
        if bearing.kind == "spherical":
            bore -= math.pi * self.width**3 / 12
        section = math.pi * outer**2 / 2 + (outer + self.pedestal_width / 2) * drop
        foot = self.foot_length * self.foot_width * self.foot_thickness
        return section * self.width - bore + foot

    def curved_faces(self, bearing: Bearing) -> list[CurvedFace]:
        """Bore, as the sides of the bearing divide it, outside of the shell, and bolt holes."""
        outer, half = self.outer_radius(bearing), self.width / 2
        turn = math.pi * outer
        x = (bearing.x - half, bearing.x + half)
        found = [CurvedFace(outer, turn, turn * self.width, x, (-outer, outer))]
        radius, inner = bearing.raceway_diameter / 2, min(bearing.width / 2, half)
        for low, high in ((-half, -inner), (-inner, inner), (inner, half)):
            if high - low < LENGTH_TOLERANCE:
                continue
            r0, r1 = radius, radius
            if bearing.kind == "spherical":
                r0, r1 = (math.sqrt(max(radius**2 - t * t, 0.0)) for t in (low, high))
            widest, ends = max(r0, r1), (bearing.x + low, bearing.x + high)
            rim = math.hypot(high - low, r1 - r0)
            area = 2 * math.pi * radius * (high - low)
            turn = max(2 * math.pi * widest, rim)
            found.append(CurvedFace(radius, turn, area, ends, (-widest, widest), rim))
        hole, deep = self.bolt_diameter / 2, self.foot_thickness
        length, area = math.hypot(2 * math.sqrt(2) * hole, deep), 2 * math.pi * hole * deep
        for x_at, y_at in self._bolts(bearing):
            around = (x_at - hole, x_at + hole), (y_at - hole, y_at + hole)
            found.append(CurvedFace(hole, length, area, *around))
        return found

    def _bolts(self, bearing: Bearing) -> list[tuple[float, float]]:
        """x and y of the bolts' axes, m; none where the whole base is fixed."""
        if self.base == "fixed":
            return []
        return [
            (bearing.x + sign_x * self.bolt_spacing_x / 2, sign_y * self.bolt_spacing_y / 2)
            for sign_x, sign_y in product((-1, 1), (-1, 1))
        ]

    def named_places(self, bearing: Bearing) -> dict[str, tuple[float, float, float]]:
        """Places of its named points [m].

        Parameters
        ----------
        bearing : Bearing
            The bearing that it holds.
        """
        x, outer = bearing.x, self.outer_radius(bearing)
        return {
            "top": (x, 0.0, outer),
            "side_left": (x, outer, 0.0),
            "side_right": (x, -outer, 0.0),
            "bedplate": (x, 0.0, -self.centre_height),
        }

    def build(self, bearing: Bearing) -> HousingSolid:
        """Add the housing of a bearing, its washer footprints and its named points to gmsh."""
        occ = gmsh.model.occ
        x, outer = bearing.x, self.outer_radius(bearing)
        block, _ = occ.fuse([(3, self._body(x, outer))], [(3, self._foot(x))])
        tools = [(3, bearing.bore_tool(max(self.width, self.foot_width)))]
        washers: list[int] = []
        bolt, washer = self.bolt_diameter / 2, self.washer_diameter / 2
        for place in self._bolts(bearing):
            at = (*place, -self.centre_height)
            tools.append((3, occ.addCylinder(*at, 0, 0, self.foot_thickness, bolt)))
            ring, _ = occ.cut(
                [(2, occ.addDisk(*at, washer, washer))], [(2, occ.addDisk(*at, bolt, bolt))]
            )
            washers += [tag for _, tag in ring]
        ((_, volume),), _ = occ.cut(block, tools)
        named = self.named_places(bearing)
        points = {name: occ.addPoint(*place) for name, place in named.items()}
        return HousingSolid(int(volume), tuple(washers), points)

    def _body(self, x: float, outer: float) -> int:
        """Shell and pedestal in one, the bore not yet cut: half a round over a trapezium."""
        occ = gmsh.model.occ
        front, top_of_foot = x - self.width / 2, self.foot_thickness - self.centre_height
        half = self.pedestal_width / 2
        centre, right, top, left, left_foot, right_foot = (
            occ.addPoint(front, y, z)
            for y, z in (
                (0, 0),
                (-outer, 0),
                (0, outer),
                (outer, 0),
                (half, top_of_foot),
                (-half, top_of_foot),
            )
        )
        outline = [
            occ.addCircleArc(right, centre, top),
            occ.addCircleArc(top, centre, left),
            occ.addLine(left, left_foot),
            occ.addLine(left_foot, right_foot),
            occ.addLine(right_foot, right),
        ]
        face = occ.addPlaneSurface([occ.addCurveLoop(outline)])
        swept = occ.extrude([(2, face)], self.width, 0, 0)
        occ.remove([(0, centre)])
        (body,) = (tag for dim, tag in swept if dim == 3)
        return int(body)

    def _foot(self, x: float) -> int:
        return int(
            gmsh.model.occ.addBox(
                x - self.foot_width / 2,
                -self.foot_length / 2,
                -self.centre_height,
                self.foot_width,
                self.foot_length,
                self.foot_thickness,
            )
        )
