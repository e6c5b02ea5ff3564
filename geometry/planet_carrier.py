"""A planet carrier: two cheeks joined by webs, pins for the planets, and a hub."""

from __future__ import annotations

import math
from typing import Literal, Self

import gmsh
from pydantic import Field, model_validator

from fe_drivetrain.common.errors import InputError

from .body import (
    BodySizes,
    annulus,
    cylinder_faces,
    half_plane_faces,
    name_and_size,
    plane_faces,
)
from .fits import refuse_millimetres
from .part import LENGTH_TOLERANCE, Part, dimension

_TABLES = (
    "Nejad, Guo, Gao and Moan 2016, 5 MW reference gearbox, first stage, as tabled in the public "
    "repository gfsReboucas/Drivetrain"
)


class PlanetCarrier(Part):
    """Cheeks, webs, pins and hub in one piece, about the x axis.

    The hub begins with its flange face at x = 0; then come the front cheek, the gap that the
    planets run in, and the rear cheek. The first pin stands at the top, at +z. With one wall, the
    pins stand on the front cheek alone, and there are neither webs nor a rear cheek.

    Pins, fits and bearings are one solid: pressed pins are a little softer.

    The defaults are the first stage of the 5 MW reference gearbox where that is published, and
    assumptions else, each with its reason.
    """

    planets: int = Field(default=3, ge=2, le=12, description="number of planets")
    walls: Literal[1, 2] = Field(
        default=2, description="2: pins between two cheeks; 1: pins on the front cheek alone"
    )
    pin_circle_diameter: float = dimension(
        1.726, of="circle of the pins' axes", gt=0, source=f"centre distance 863 mm: {_TABLES}"
    )
    pin_diameter: float = dimension(
        0.4, of="pins", gt=0, source=f"bore of the planet bearings PL-A, PL-B: {_TABLES}"
    )
    gap: float = dimension(
        0.56,
        of="between the cheeks; with one wall, what the pins stand out",
        gt=0,
        source=f"two planet bearings of 272 mm and 16 mm of play: {_TABLES}",
    )
    cheek_thickness: float = dimension(
        0.18, of="each cheek along x", gt=0, source="assumed: 0.45 of the pin's diameter"
    )
    cheek_diameter: float = dimension(
        2.3,
        of="outside of the cheeks",
        gt=0,
        source="assumed: 87 mm of wall outside of the pins",
    )
    sun_bore_diameter: float = dimension(
        1.02,
        of="bore of the rear cheek",
        gt=0,
        source="assumed: tip diameter of the sun, about 979 mm, and play",
    )
    web_inner_diameter: float = dimension(
        1.44, of="inside of the webs", gt=0, source="assumed: clear of sun and planets"
    )
    web_outer_diameter: float = dimension(
        2.24, of="outside of the webs", gt=0, source="assumed: clear of the ring gear's tips"
    )
    web_angle: float = dimension(
        45.0,
        of="angle that each web takes about the axis",
        unit="deg",
        gt=0,
        source="assumed: planets of about 905 mm tip diameter leave 56 degrees between them",
    )
    hub_diameter: float = dimension(
        1.0, of="outside of the hub", gt=0, source=f"bore of the carrier bearing PLC-B: {_TABLES}"
    )
    hub_bore_diameter: float = dimension(
        0.6, of="bore of hub and front cheek", gt=0, source="assumed: 200 mm of wall"
    )
    hub_length: float = dimension(
        0.3, of="hub along x", gt=0, source="assumed: its bearing, 128 mm, and the flange"
    )
    material: str = Field(default="ductile_iron", description="name of the material")

    @model_validator(mode="after")
    def _holds_together(self) -> Self:
        refuse_millimetres("planet carrier", self.length, self.cheek_diameter)
        circle, pin = self.pin_circle_diameter, self.pin_diameter
        inner_rim = max(self.hub_bore_diameter, self.sun_bore_diameter if self.walls == 2 else 0.0)
        limits = [
            ("hub_bore_diameter", self.hub_bore_diameter, "hub_diameter", self.hub_diameter),
            ("hub_diameter", self.hub_diameter, "cheek_diameter", self.cheek_diameter),
            (
                "pin_circle_diameter plus pin_diameter",
                circle + pin,
                "cheek_diameter",
                self.cheek_diameter,
            ),
            (
                "bores of the cheeks",
                inner_rim,
                "pin_circle_diameter less pin_diameter",
                circle - pin,
            ),
            (
                "pin_diameter",
                pin,
                "the distance of two pins",
                circle * math.sin(math.pi / self.planets),
            ),
        ]
        if self.walls == 2:
            limits += [
                ("web_inner_diameter", self.web_inner_diameter, "web_outer_diameter",
                 self.web_outer_diameter),
                ("web_outer_diameter", self.web_outer_diameter, "cheek_diameter",
                 self.cheek_diameter),
                ("sun_bore_diameter", self.sun_bore_diameter, "web_inner_diameter",
                 self.web_inner_diameter),
            ]  # fmt: skip
        for name, value, limit_name, limit in limits:
            if value >= limit - LENGTH_TOLERANCE:
                raise InputError(
                    f"PlanetCarrier: {name} is {value:g} m but must be less than {limit_name}, "
                    f"{limit:g} m: change one of them"
                )
        if self.walls == 2:
            self._check_webs()
        return self

    def _check_webs(self) -> None:
        pitch = 360.0 / self.planets
        # from a pin's axis to the nearer side of a web, a plane that holds the axis of the carrier
        away = math.radians(max(0.0, (pitch - self.web_angle) / 2))
        clear = self.pin_circle_diameter / 2 * math.sin(min(away, math.pi / 2))
        if self.web_angle >= pitch or clear <= self.pin_diameter / 2 + LENGTH_TOLERANCE:
            room = pitch - 2 * math.degrees(math.asin(self.pin_diameter / self.pin_circle_diameter))
            raise InputError(
                f"PlanetCarrier: web_angle is {self.web_angle:g} degrees but must be less than "
                f"{room:.4g}, which {self.planets} pins of {self.pin_diameter:g} m leave: make "
                "the webs or the pins smaller"
            )

    @property
    def length(self) -> float:
        """Length from the flange face to the end of the rear cheek, or of the pins, m."""
        return self.hub_length + self.walls * self.cheek_thickness + self.gap

    @property
    def middle(self) -> float:
        """x of the middle of the gap, where the planets are, m."""
        return self.hub_length + self.cheek_thickness + self.gap / 2

    def pin_centres(self) -> list[tuple[float, float, float]]:
        """Middle of each pin, m."""
        radius = self.pin_circle_diameter / 2
        turns = [2 * math.pi * k / self.planets for k in range(self.planets)]
        return [(self.middle, -radius * math.sin(a), radius * math.cos(a)) for a in turns]

    def volume_and_centre(self) -> tuple[float, tuple[float, float, float]]:
        """Volume, m^3, and centre of gravity, m, exact."""

        def annulus(outer: float, inner: float) -> float:
            return math.pi / 4 * (outer**2 - inner**2)

        webs = 0.0
        if self.walls == 2:
            full = annulus(self.web_outer_diameter, self.web_inner_diameter)
            webs = self.planets * self.web_angle / 360.0 * full
        sections = [
            (self.hub_length, annulus(self.hub_diameter, self.hub_bore_diameter)),
            (self.cheek_thickness, annulus(self.cheek_diameter, self.hub_bore_diameter)),
            (self.gap, self.planets * annulus(self.pin_diameter, 0.0) + webs),
        ]
        if self.walls == 2:
            rear = annulus(self.cheek_diameter, self.sun_bore_diameter)
            sections.append((self.cheek_thickness, rear))
        volume = moment = x = 0.0
        for length, area in sections:
            volume += length * area
            moment += length * area * (x + length / 2)
            x += length
        return volume, (moment / volume, 0.0, 0.0)

    def build_sector(self, sizes: BodySizes) -> None:
        """Build the sector of the first pin in the open gmsh model, ready to be meshed.

        It goes half way to the neighbours on either side, and its mesh fits to itself, turned to
        the next pin. Its faces are "carrier.hub", the flange; "carrier.pin", between
        the cheeks; "carrier.first" and "carrier.last", where the neighbours go on.
        """
        occ = gmsh.model.occ
        pitch = 2 * math.pi / self.planets
        front = self.hub_length
        gap = front + self.cheek_thickness
        rear = gap + self.gap
        bore = self.hub_bore_diameter / 2

        def sector(start: float, length: float, inner: float, outer: float) -> int:
            return annulus(start, length, inner, outer, -pitch / 2, pitch)

        outer = self.cheek_diameter / 2
        solids = [
            sector(0.0, front, bore, self.hub_diameter / 2),
            sector(front, self.cheek_thickness, bore, outer),
        ]
        end = rear
        if self.walls == 2:
            end = rear + self.cheek_thickness
            solids.append(sector(rear, self.cheek_thickness, self.sun_bore_diameter / 2, outer))
            half = math.radians(self.web_angle) / 2
            inside, outside = self.web_inner_diameter / 2, self.web_outer_diameter / 2
            solids += [
                annulus(gap, self.gap, inside, outside, start, half)
                for start in (-pitch / 2, pitch / 2 - half)
            ]
        centre, radius = self.pin_circle_diameter / 2, self.pin_diameter / 2
        solids.append(occ.addCylinder(front, 0, centre, end - front, 0, 0, radius))
        fused, _ = occ.fuse([(3, solids[0])], [(3, tag) for tag in solids[1:]])
        ((_, volume),) = fused
        occ.synchronize()
        faces = {tag for _, tag in gmsh.model.getBoundary([(3, volume)], oriented=False)}
        first, last = (half_plane_faces(faces, angle) for angle in (-pitch / 2, pitch / 2))
        named = {
            "hub": plane_faces(faces, (1.0, 0.0, 0.0)),
            "pin": cylinder_faces(faces, radius, 0.0, centre),
            "first": first,
            "last": last,
        }
        name_and_size("carrier", int(volume), named, sizes, self.planets)
        cos, sin = math.cos(pitch), math.sin(pitch)
        turn = [1, 0, 0, 0, 0, cos, -sin, 0, 0, sin, cos, 0, 0, 0, 0, 1]
        pairs = _matched(sorted(first), sorted(last), cos, sin)
        gmsh.model.mesh.setPeriodic(2, [b for _, b in pairs], [a for a, _ in pairs], turn)


def _matched(first: list[int], last: list[int], cos: float, sin: float) -> list[tuple[int, int]]:
    """Pairs of faces that a turn about x takes into each other."""

    def centre(tag: int) -> tuple[float, float, float]:
        x, y, z = gmsh.model.occ.getCenterOfMass(2, tag)
        return x, y, z

    pairs = []
    for a in first:
        x, y, z = centre(a)
        turned = (x, cos * y - sin * z, sin * y + cos * z)
        pairs.append((a, min(last, key=lambda b: math.dist(centre(b), turned))))
    return pairs
