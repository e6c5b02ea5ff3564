"""A housing whose shape comes from a file, a STEP solid or a mesh; its faces are picked."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Discriminator, Field, Tag, model_validator

from fe_drivetrain.common.errors import InputError

from .bearing import Bearing
from .bolt_preload import assembly_preload, coarse_thread, yield_strength
from .housing import Housing
from .part import MAXIMUM, Part

Vector = tuple[float, float, float]

UNITS = {"mm": 1e-3, "m": 1.0, "in": 0.0254}
"""Metres in what a file's lengths may be in."""

SOLID_ENDINGS = (".step", ".stp", ".igs", ".iges", ".brep")
MESH_ENDINGS = (".msh", ".vtu", ".inp", ".unv", ".med", ".stl")

MAX_PRELOAD = 1e9
"""Maximum preload of a bolt [N]."""


class Pick(Part):
    """Which faces of a file's solid are meant, in one of five ways, as the file has them.

    A label (a face's name in a STEP file, a physical group or a set of a mesh); a colour; a point
    on or nearest to the face; a plane by a point and its normal; a cylinder by radius, and where
    several have it by the direction of its axis and a point on that; a sphere by radius and centre.
    Points and radii are in the file's own frame and unit, as ``fe-drivetrain part`` prints them.
    """

    label: str | None = Field(default=None, min_length=1, max_length=200)
    colour: str | None = Field(default=None, pattern="^#[0-9a-fA-F]{6}$")
    point: Vector | None = None
    normal: Vector | None = None
    radius: float | None = Field(default=None, gt=0)
    axis: Vector | None = None
    centre: Vector | None = None

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        given = {key for key in type(self).model_fields if getattr(self, key) is not None}
        if given not in _WAYS:
            raise InputError(
                f"a pick of a face has the keys {', '.join(sorted(given)) or 'none'} but must have "
                "label; or colour; or point; or point and normal (a plane); or radius, with axis "
                "and point where needed (a cylinder); or radius and centre (a sphere): give one "
                "of these"
            )
        for key in ("axis", "normal"):
            way = getattr(self, key)
            if way is not None and not math.hypot(*way) > 0:
                raise InputError(f"a pick of a face has {key} [0, 0, 0]: give it a direction")
        return self

    def words(self) -> str:
        """The pick in words, for messages."""
        return " and ".join(
            f"{key} {list(value) if isinstance(value, tuple) else value}"
            for key in type(self).model_fields
            if (value := getattr(self, key)) is not None
        )


_WAYS: tuple[set[str], ...] = (
    {"label"},
    {"colour"},
    {"point"},
    {"point", "normal"},
    {"radius"},
    {"radius", "axis"},
    {"radius", "point"},
    {"radius", "axis", "point"},
    {"radius", "centre"},
)


class Bolts(Part):
    """Bolts through the foot, and how they hold it.

    With hold 'washers', the annulus round each hole on the held faces is fixed, as under bolts
    whose preload keeps the joint closed. With 'beams', each bolt alone carries, from the annulus
    round the hole's other end down to the held face, where the ground holds it: a joint that is
    open. With 'clamped', each bolt is such a beam, tightened, and the held faces press on the
    ground: where the preload leaves them pressed they stand on it, beside the bolts.
    """

    hole_radius: float = Field(gt=0, description="radius of the holes, in the file's unit")
    washer_diameter: float = Field(
        gt=0, description="outside diameter of the annulus, in that unit"
    )
    hold: Literal["washers", "beams", "clamped"] = "washers"
    diameter: float | None = Field(
        default=None,
        gt=0,
        description="diameter of the bolts, in the file's unit (hold 'beams' and 'clamped')",
    )
    clamp_length: float | None = Field(
        default=None,
        gt=0,
        description="length of the bolts from the head to where the ground holds them, in that "
        "unit; the hole's length where left out",
    )
    preload: float | None = Field(
        default=None, gt=0, le=MAX_PRELOAD, description="tension of each bolt, tightened [N]"
    )
    property_class: Literal["4.6", "5.6", "6.8", "8.8", "10.9", "12.9"] | None = Field(
        default=None, description="property class of the bolts, in place of their preload"
    )
    of_yield: float | None = Field(
        default=None,
        gt=0,
        le=1,
        description="share of yield that they are tightened to; 0.9 where left out",
    )
    thread_friction: float | None = Field(
        default=None, ge=0, le=1, description="coefficient in the thread; 0.12 where left out"
    )

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if self.washer_diameter <= 2 * self.hole_radius:
            raise InputError(
                f"bolts: washer_diameter is {self.washer_diameter:g} but must be greater than the "
                f"hole's diameter, {2 * self.hole_radius:g}: enlarge it"
            )
        if (self.diameter is None) != (self.hold == "washers"):
            given = "no diameter: add it" if self.diameter is None else "a diameter: leave it out"
            raise InputError(f"bolts: hold is {self.hold!r} and there is {given}")
        if self.diameter is not None and self.diameter > 2 * self.hole_radius:
            raise InputError(
                f"bolts: diameter is {self.diameter:g} but must be at most that of the hole, "
                f"{2 * self.hole_radius:g}: reduce it"
            )
        if self.hold == "washers" and self.clamp_length is not None:
            raise InputError("bolts: hold is 'washers' and there is a clamp_length: leave it out")
        pulls = [k for k in ("preload", "property_class") if getattr(self, k) is not None]
        if len(pulls) != (self.hold == "clamped"):
            raise InputError(
                f"bolts: hold is {self.hold!r} and there is {' and '.join(pulls) or 'no preload'}: "
                + (
                    "give preload [N] or property_class, one of the two"
                    if self.hold == "clamped"
                    else "make hold 'clamped', or leave it out"
                )
            )
        for key in ("of_yield", "thread_friction"):
            if getattr(self, key) is not None and self.property_class is None:
                raise InputError(f"bolts: {key} belongs to a property_class: add that")
        return self

    def tightened(self, scale: float) -> float:
        """Tension of each bolt after it is tightened.

        Parameters
        ----------
        scale : float
            Metres in the file's unit.

        Returns
        -------
        float
            Preload [N]; given, or that of its property class, see `assembly_preload`.

        Raises
        ------
        InputError
            Its diameter has no coarse metric thread.
        """
        if self.preload is not None:
            return self.preload
        assert self.diameter is not None
        assert self.property_class is not None
        return assembly_preload(
            coarse_thread(self.diameter * scale),
            yield_strength(self.property_class),
            0.9 if self.of_yield is None else self.of_yield,
            0.12 if self.thread_friction is None else self.thread_friction,
        )


class BoltedJoint(Part):
    """Bolts between two solids: they are joined in the annulus round each hole alone.

    That is where the bolts' preload keeps them pressed on one another; elsewhere the joint is
    open, and its sides move freely.
    """

    hole_radius: float = Field(gt=0, description="radius of the holes, in the file's unit")
    pressed_diameter: float = Field(
        gt=0, description="outside diameter of the annulus that stays pressed, in that unit"
    )

    @model_validator(mode="after")
    def _wider_than_the_hole(self) -> Self:
        if self.pressed_diameter <= 2 * self.hole_radius:
            raise InputError(
                f"bolted: pressed_diameter is {self.pressed_diameter:g} but must be greater than "
                f"the hole's diameter, {2 * self.hole_radius:g}: enlarge it"
            )
        return self


class ForeignFile(Part):
    """A part from a STEP file or a mesh file: which solid, of what material, and how it is turned.

    It is turned about the fixed axes x, y and z in this order, before it is moved.
    """

    step: str | None = Field(default=None, min_length=1, max_length=1000)
    mesh: str | None = Field(default=None, min_length=1, max_length=1000)
    unit: Literal["mm", "m", "in"] | None = Field(
        default=None, description="unit of the file's lengths; mm of a solid where left out"
    )
    part: str | None = Field(
        default=None, min_length=1, description="name of one solid, where a file has several"
    )
    material: str = Field(default="ductile_iron", description="name of the material")
    rotate: Vector = (0.0, 0.0, 0.0)
    smallest_detail: float = Field(
        default=0.0, ge=0, description="edges and faces below it are removed, in the file's unit"
    )

    @model_validator(mode="after")
    def _one_file(self) -> Self:
        if (self.step is None) == (self.mesh is None):
            raise InputError(
                f"{self.what()} has "
                + ("neither step nor mesh" if self.step is None else "both step and mesh")
                + " but must have one of the two: name one file"
            )
        allowed = MESH_ENDINGS if self.step is None else SOLID_ENDINGS
        if not self.file.lower().endswith(allowed):
            raise InputError(
                f"the file {self.file} of {self.what()} must end in {' or '.join(allowed)}: give "
                + (
                    "a mesh under 'mesh'"
                    if self.step is None
                    else "a STEP, IGES or BREP file under 'step'"
                )
            )
        if self.step is None and self.unit is None:
            raise InputError(
                f"the mesh {self.file} of {self.what()} has no unit: give unit: mm, m or "
                "in, the unit of its coordinates"
            )
        if self.step is None and self.smallest_detail > 0:
            raise InputError(
                f"the mesh {self.file} of {self.what()} has a smallest_detail of "
                f"{self.smallest_detail:g}, but nothing is removed from a mesh: leave it out"
            )
        for key in ("rotate", "translate"):
            value = getattr(self, key, None)
            if value is not None and max(map(abs, value)) > MAXIMUM:
                raise InputError(
                    f"{key} of {self.what()} is {list(value)}, but at most {MAXIMUM:g} each: "
                    "reduce it"
                )
        return self

    def what(self) -> str:
        """Name of the part, for messages."""
        return "a housing from a file"

    @property
    def file(self) -> str:
        """Path of its file."""
        return self.step or self.mesh or ""

    @property
    def scale(self) -> float:
        """Metres in the file's unit."""
        return UNITS[self.unit or "mm"]

    @property
    def rotation(self) -> NDArray[np.float64]:
        """(3, 3) from the file's directions to those of the scene."""
        from scipy.spatial.transform import Rotation  # slow to import

        turned = Rotation.from_euler("xyz", self.rotate, degrees=True).as_matrix()
        return np.asarray(turned, dtype=np.float64)


class ForeignHousing(ForeignFile):
    """A housing from a STEP file or a mesh file: material, placement, seat and held faces.

    Without `translate` it is moved so that the middle of its seat is the centre of its bearing. No
    face is held where it stands on further parts, see `FurtherPart`.
    """

    translate: Vector | None = None
    seat: Pick
    held: tuple[Pick, ...] = Field(default=(), max_length=100)
    bolts: Bolts | None = None
    bolted: BoltedJoint | None = Field(
        default=None, description="joint of several solids of one STEP file, round bolts alone"
    )

    @model_validator(mode="after")
    def _has_solids_to_join(self) -> Self:
        if self.bolted is not None and (self.step is None or self.part is not None):
            raise InputError(
                f"bolted is given to {self.what()} from {self.file}, but joins solids of one STEP "
                "file: "
                + ("leave out part" if self.part else "give the part as STEP, or leave it out")
            )
        return self

    @model_validator(mode="after")
    def _tightened(self) -> Self:
        if self.bolts is not None and self.bolts.hold == "clamped":
            self.bolts.tightened(self.scale)
        return self

    @property
    def held_by(self) -> str:
        """Phrase that says how it is held."""
        if self.bolts is None:
            return "held faces fixed"
        return {
            "washers": "fixed at the washers",
            "beams": "held by bolts as beams",
            "clamped": "clamped by preloaded bolts",
        }[self.bolts.hold]

    def check_bearing(self, bearing: Bearing) -> None:
        """Refuse a seat that cannot be that of the bearing, as far as it is known without the file.

        Raises
        ------
        InputError
        """
        radius = bearing.raceway_diameter / 2
        given = None if self.seat.radius is None else self.seat.radius * self.scale
        if given is not None and abs(given - radius) > SEAT_TOLERANCE * radius:
            raise InputError(
                f"{bearing.name}.housing: its seat has a radius of {given:g} m but must have "
                f"{radius:g} m, half the bearing's raceway_diameter: change one of them, or the "
                "unit of the file"
            )


class Tie(Part):
    """A face of a further part that is joined to what it lies on: the housing, or another part."""

    face: Pick
    to: str = Field(
        default="housing",
        min_length=1,
        max_length=100,
        description="'housing', the name of another part of the unit, or that of another bearing "
        "unit's housing, as in 'rear.housing'",
    )
    bolted: BoltedJoint | None = Field(
        default=None, description="joined round bolts alone; glued all over where left out"
    )


class FurtherPart(ForeignFile):
    """A part under or beside a housing, from a file: a bedplate, a torque arm, a rib.

    The origin of its file comes to the centre of the unit's bearing, and then is moved by
    `translate` [m].
    """

    name: str = Field(
        pattern=r"^[A-Za-z][A-Za-z0-9_-]*$",
        max_length=60,
        description="name: letters, digits, '_' and '-'",
    )
    translate: Vector = (0.0, 0.0, 0.0)
    tied: tuple[Tie, ...] = Field(min_length=1, max_length=100)
    held: tuple[Pick, ...] = Field(default=(), max_length=100)

    def what(self) -> str:
        """Name of the part, for messages."""
        return f"part {self.name!r}"


Row = tuple[float, float, float, float, float, float]


class CondensedHousing(Part):
    """A housing known as a stiffness alone: no solid, no mass, on the ground.

    Its six rows are forces and moments on the housing at the bearing's centre, of unit
    displacements and rotations of its bore there, in the scene's frame.
    """

    stiffness: tuple[Row, Row, Row, Row, Row, Row] = Field(
        description="six rows along and about x, y, z at the bearing's centre [N/m, N, N m/rad]"
    )
    source: str = Field(default="", max_length=1000, description="where it comes from, in words")

    @model_validator(mode="after")
    def _holds_every_motion(self) -> Self:
        K = self.matrix
        if K.diagonal().min() <= 0:
            raise InputError(
                f"a housing's stiffness has {K.diagonal().min():.3g} on its diagonal, but must "
                "hold every motion, with more than 0 there: check its rows"
            )
        roots = np.sqrt(np.maximum(K.diagonal(), np.finfo(float).tiny))
        scaled = K / np.outer(roots, roots)
        if np.abs(scaled - scaled.T).max() > _SYMMETRIC:
            raise InputError(
                "a housing's stiffness differs from its transpose by "
                f"{np.abs(scaled - scaled.T).max():.2g} of its diagonal, but must be symmetric: "
                "check its rows"
            )
        least = float(np.linalg.eigvalsh(0.5 * (scaled + scaled.T))[0])
        if least < _MINIMUM or K.diagonal().max() > _STIFFEST:
            raise InputError(
                f"a housing's stiffness has a minimum eigenvalue of {least:.2g} of its diagonal "
                f"and a maximum entry of {K.diagonal().max():.2g}, but must hold every motion (at "
                f"least {_MINIMUM:g}) with at most {_STIFFEST:g} [N/m, N m/rad]: check its units"
            )
        return self

    @property
    def matrix(self) -> NDArray[np.float64]:
        """(6, 6) stiffness at the bearing's centre [N/m, N, N m/rad]."""
        return np.array(self.stiffness, dtype=np.float64)


_SYMMETRIC, _MINIMUM, _STIFFEST = 1e-6, 1e-9, 1e16

SEAT_TOLERANCE = 1e-4
"""Allowed difference of a seat's radius from the bearing's raceway, over the radius."""


def _kind(value: Any) -> str:
    if isinstance(value, ForeignHousing):
        return "file"
    if isinstance(value, CondensedHousing) or (isinstance(value, dict) and "stiffness" in value):
        return "matrix"
    from_file = isinstance(value, dict) and ("step" in value or "mesh" in value)
    return "file" if from_file else "block"


AnyHousing = Annotated[
    Annotated[Housing, Tag("block")]
    | Annotated[ForeignHousing, Tag("file")]
    | Annotated[CondensedHousing, Tag("matrix")],
    Discriminator(_kind),
]
"""A parametric block, a housing from a file, or a stiffness alone."""
