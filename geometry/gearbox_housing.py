"""A section of a gearbox housing: a ring with two torque arms that end in the eyes of bushings."""

from __future__ import annotations

import math
from typing import Self

import gmsh
from pydantic import Field, model_validator

from fe_drivetrain.common.errors import InputError

from .body import BodySizes, annulus, cylinder_faces, name_and_size, plane_faces
from .fits import refuse_millimetres
from .part import LENGTH_TOLERANCE, Part, dimension


class GearboxHousing(Part):
    """A ring about the x axis, and a box on either side of it along y, with an eye at its end.

    The ring is that part of the housing which the torque comes in by: where the ring gear, or the
    carrier's bearings, sit. Its middle is the origin. The eyes' axes lie along x; elastic bushings
    are pressed into them. The body is its own mirror image about the plane y = 0.

    The defaults are those of a plausible section for 2 MW. No drawing of such a housing was
    available to take them from: all are assumptions, each with its reason.
    """

    inner_diameter: float = dimension(
        1.6,
        of="bore of the ring",
        gt=0,
        source="assumed: seat of a ring gear of about 1.5 m pitch diameter, as 2 MW at 3 stages",
    )
    outer_diameter: float = dimension(
        1.84, of="outside of the ring", gt=0, source="assumed: wall of 120 mm, a casting's ring"
    )
    length: float = dimension(
        0.5,
        of="ring along x",
        gt=0,
        source="assumed: face width of the ring gear with its flanges",
    )
    arm_span: float = dimension(
        2.5,
        of="distance of the eyes' axes along y",
        gt=0,
        source="assumed: eyes 330 mm outside of the ring, which leaves room for the bushings",
    )
    arm_width: float = dimension(
        0.3, of="arms along x", gt=0, source="assumed: length of the bushings"
    )
    arm_height: float = dimension(
        0.4, of="arms along z", gt=0, source="assumed: little less than the eyes"
    )
    arm_x: float = dimension(
        0.0, of="middle of the arms along x", source="assumed: in the middle of the ring"
    )
    arm_z: float = dimension(
        0.0, of="height of the arms' middle over the axis", source="assumed: at the axis"
    )
    eye_diameter: float = dimension(
        0.45, of="outside of the eyes", gt=0, source="assumed: wall of 95 mm round the bushing"
    )
    eye_bore_diameter: float = dimension(
        0.26, of="bore of the eyes", gt=0, source="assumed: outside of an elastic bushing"
    )
    material: str = Field(default="ductile_iron", description="name of the material")

    @model_validator(mode="after")
    def _holds_together(self) -> Self:
        refuse_millimetres("gearbox housing", self.length, self.arm_span)
        inner = self.inner_diameter
        limits = [
            ("inner_diameter", inner, "outer_diameter", self.outer_diameter),
            ("eye_bore_diameter", self.eye_bore_diameter, "eye_diameter", self.eye_diameter),
            ("arm_height", self.arm_height, "eye_diameter", self.eye_diameter),
            (
                "arm_width",
                self.arm_width,
                "what the ring's length leaves about arm_x",
                self.length - 2 * abs(self.arm_x) + 2 * LENGTH_TOLERANCE,
            ),
            (
                "arm_height",
                self.arm_height,
                "what the ring's bore leaves about arm_z",
                inner - 2 * abs(self.arm_z),
            ),
            (
                "outer_diameter",
                self.outer_diameter,
                "arm_span less eye_diameter, so that the eyes stand clear of the ring",
                self.arm_span - self.eye_diameter,
            ),
        ]
        for name, value, limit_name, limit in limits:
            if value >= limit - LENGTH_TOLERANCE:
                raise InputError(
                    f"GearboxHousing: {name} is {value:g} m but must be less than {limit_name}, "
                    f"{limit:g} m: change one of them"
                )
        return self

    @property
    def arm_root(self) -> float:
        """y where the middle line of the arm at +y leaves the ring, m."""
        return math.sqrt((self.outer_diameter / 2) ** 2 - self.arm_z**2)

    @property
    def eye(self) -> tuple[float, float, float]:
        """Middle of the eye at +y, m."""
        return self.arm_x, self.arm_span / 2, self.arm_z

    @property
    def eye_beyond_arm(self) -> float:
        """Section of an eye, less what an arm without bore has of it up to the axis, m^2."""
        radius, half = self.eye_diameter / 2, self.arm_height / 2
        arm = 2 * _under_arc(radius, 0.0, half)[0]
        return math.pi * (radius**2 - (self.eye_bore_diameter / 2) ** 2) - arm

    def volume_and_centre(self) -> tuple[float, tuple[float, float, float]]:
        """Volume, m^3, and centre of gravity, m, exact."""
        outer = self.outer_diameter / 2
        ring = math.pi * (outer**2 - (self.inner_diameter / 2) ** 2) * self.length
        # an arm from the ring's outside to the eye's axis
        low, high = self.arm_z - self.arm_height / 2, self.arm_z + self.arm_height / 2
        area, moment = _under_arc(outer, low, high)
        arm = self.arm_height * self.arm_span / 2 - area
        arm_moment = self.arm_z * self.arm_height * self.arm_span / 2 - moment
        eye = self.eye_beyond_arm
        arms = 2 * self.arm_width * (arm + eye)
        volume = ring + arms
        z = 2 * self.arm_width * (arm_moment + eye * self.arm_z) / volume
        return volume, (arms * self.arm_x / volume, 0.0, z)

    def build_half(self, sizes: BodySizes) -> None:
        """Build the half y > 0 in the open gmsh model, ready to be meshed.

        Its faces are "housing.ring", the bore; "housing.eye", the bore of the eye; "housing.cut",
        where the other half goes on.
        """
        occ = gmsh.model.occ
        front = -self.length / 2
        # from the lower end of the plane y = 0 over +y to the upper one
        ring = annulus(
            front, self.length, self.inner_diameter / 2, self.outer_diameter / 2, math.pi, math.pi
        )
        x, y, z = self.eye
        low = x - self.arm_width / 2
        box = occ.addBox(low, 0.0, z - self.arm_height / 2, self.arm_width, y, self.arm_height)
        eye = occ.addCylinder(low, y, z, self.arm_width, 0, 0, self.eye_diameter / 2)
        block, _ = occ.fuse([(3, ring)], [(3, box), (3, eye)])
        bores = [
            (3, occ.addCylinder(front, 0, 0, self.length, 0, 0, self.inner_diameter / 2)),
            (3, occ.addCylinder(low, y, z, self.arm_width, 0, 0, self.eye_bore_diameter / 2)),
        ]
        ((_, volume),), _ = occ.cut(block, bores)
        occ.synchronize()
        faces = {tag for _, tag in gmsh.model.getBoundary([(3, volume)], oriented=False)}
        named = {
            "ring": cylinder_faces(faces, self.inner_diameter / 2),
            "eye": cylinder_faces(faces, self.eye_bore_diameter / 2, y, z),
            "cut": plane_faces(faces, (0.0, 1.0, 0.0)),
        }
        name_and_size("housing", int(volume), named, sizes, 2)


def _under_arc(radius: float, low: float, high: float) -> tuple[float, float]:
    """Integrals of sqrt(radius^2 - z^2), and of z times it, from low to high, m^2 and m^3."""

    def area(z: float) -> float:
        return (z * math.sqrt(radius**2 - z**2) + radius**2 * math.asin(z / radius)) / 2

    def moment(z: float) -> float:
        return -math.pow(radius**2 - z**2, 1.5) / 3

    return area(high) - area(low), moment(high) - moment(low)
