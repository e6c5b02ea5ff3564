"""The bearing: one body on the shaft seat, with a spherical or a cylindrical outer face."""

from __future__ import annotations

import math
import re
from typing import Literal, Self

from pydantic import Field, model_validator

from fe_drivetrain.common.errors import InputError

from .part import LENGTH_TOLERANCE, Part, dimension
from .shaft import Segment, revolve, split

RESERVED = ("shaft", "hub", "gearbox")
"""Names that something else in a scene has."""


class Bearing(Part):
    """Inner ring and rollers as one solid body, up to the raceway of the outer ring.

    The outer ring belongs to the housing, so that the raceway is the face between the two.
    """

    name: str = Field(default="main_bearing", description="name: letters, digits, '_' and '-'")
    x: float = dimension(0.0, of="x of the centre")
    width: float = dimension(
        0.2,
        of="width along x",
        gt=0,
        source="assumed: ISO 15 dimension series 31, bore 400 mm: 400 x 650 x 200 mm (23180)",
    )
    kind: Literal["spherical", "ring"] = Field(
        default="spherical",
        description="'spherical' for a convex spherical outer face, 'ring' for a cylindrical one",
    )
    raceway_diameter: float = dimension(
        0.6,
        of="diameter of the outer face: of the sphere, or of the cylinder of a ring",
        gt=0,
        source="assumed: D = 650 mm less twice 25 mm of outer ring at mid width",
    )
    bore_diameter: float | None = dimension(
        None,
        of="bore; left out, the diameter of the shaft at the seat",
        gt=0,
        source="assumed: equal to the shaft, that is, no interference (Stirling 2023, Table 3.1)",
    )
    material: str = Field(default="steel", description="name of the material")

    @model_validator(mode="after")
    def _can_be_built(self) -> Self:
        if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_-]*", self.name) or self.name in RESERVED:
            raise InputError(
                f"Bearing: name is {self.name!r} but must be letters, digits, '_' and '-', begin "
                f"with a letter and not be one of {', '.join(RESERVED)}: rename the bearing"
            )
        if self.kind == "spherical" and self.width >= self.raceway_diameter:
            raise InputError(
                f"bearing {self.name!r}: width is {self.width:g} m but must be less than the "
                f"diameter of its sphere, {self.raceway_diameter:g} m: make the bearing narrower "
                "or the sphere larger"
            )
        if self.bore_diameter is not None:
            self.check_bore(self.bore_diameter)
        return self

    @property
    def span(self) -> tuple[float, float]:
        """x of the two side faces, m."""
        return self.x - self.width / 2, self.x + self.width / 2

    @property
    def edge_radius(self) -> float:
        """Radius of the outer face at the side faces, m."""
        if self.kind == "ring":
            return self.raceway_diameter / 2
        return math.sqrt(self.raceway_diameter**2 - self.width**2) / 2

    def check_bore(self, bore_diameter: float) -> None:
        """Refuse a bore that leaves no ring at the side faces.

        Raises
        ------
        InputError
        """
        if bore_diameter / 2 >= self.edge_radius - LENGTH_TOLERANCE:
            raise InputError(
                f"bearing {self.name!r}: its bore is {bore_diameter:g} m but must be less than "
                f"{2 * self.edge_radius:g} m, the diameter of its outer face at its side faces: "
                "enlarge raceway_diameter or make the bearing narrower"
            )

    def build(self, bore_diameter: float) -> int:
        """Add the solid to the open gmsh model and return the tag of the volume."""
        self.check_bore(bore_diameter)
        return revolve(self.faces(bore_diameter))

    def faces(self, bore_diameter: float) -> list[Segment]:
        """The closed meridian, a segment for each face of the solid."""
        low, high = self.span
        bore, edge = bore_diameter / 2, self.edge_radius
        centre = (self.x, 0.0) if self.kind == "spherical" else None
        return [
            Segment((low, bore), (low, edge)),
            Segment((low, edge), (high, edge), centre),
            Segment((high, edge), (high, bore)),
            Segment((high, bore), (low, bore)),
        ]

    def bore_tool(self, reach: float) -> int:
        """Add the solid that cuts the matching bore out of a housing.

        Its face is split at the side faces of the bearing, so that the zone under the bearing is
        a face of its own on the housing as well.

        Parameters
        ----------
        reach : float
            Distance from the centre along x that the tool has to pass, m (cylindrical bores).
        """
        radius, edge, (low, high) = self.raceway_diameter / 2, self.edge_radius, self.span
        if self.kind == "spherical":
            centre = (self.x, 0.0)
            front, rear = (self.x - radius, 0.0), (self.x + radius, 0.0)
            face = [
                Segment(front, (low, edge), centre),
                Segment((low, edge), (high, edge), centre),
                Segment((high, edge), rear, centre),
            ]
        else:
            front, rear = (self.x - reach, 0.0), (self.x + reach, 0.0)
            wall = Segment((front[0], radius), (rear[0], radius))
            face = [
                Segment(front, wall.start),
                *split(wall, (low, high)),
                Segment(wall.end, rear),
            ]
        return revolve([*face, Segment(rear, front)])
