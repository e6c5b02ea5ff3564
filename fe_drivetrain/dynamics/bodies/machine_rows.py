"""Rows of a machine: stages and shafts from the rotor to the generator, each right for itself.

Whether they fit each other is the gate's (`machine_gate`). The axis of the first shaft is x; each
stage stands where its driving shaft ends, and a parallel one moves the axis of what follows by its
centre distance.
"""

from math import cos, radians
from typing import Annotated, Any, Literal, Self

from pydantic import Discriminator, Field, Tag, field_validator, model_validator

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.machine_parts import (
    MAX_DAMPING,
    MAX_GEAR,
    MAX_STIFFNESS,
    BearingData,
    GeneratorBody,
    PinData,
    Radius,
    RotorBody,
    ShaftData,
    Six,
    Teeth,
)
from fe_drivetrain.dynamics.bodies.planetary import base_helix, check_assembly, working_angle
from fe_drivetrain.dynamics.bodies.springs import Mesh
from fe_drivetrain.geometry.part import (
    Assumption,
    Part,
    assumed_in,
    dimension,
    in_its_field,
    kind_of,
    rows_of,
)

#: What the full data of gears take where a table is silent, of stages with profile shifts.
OF_TEETH = ("dedendum", "fillets", "tips", "faces", "blank")


def _of_each(of: str, source: str) -> Any:
    """Declare numbers of all gears of a stage, as many as teeth; none where nothing is given."""
    return Field(default=None, description=of, json_schema_extra={"unit": "", "source": source})


class GearData(Part):
    """Fields that both kinds of stages have in common."""

    name: str = Field(default="", description="any")
    teeth: tuple[Teeth, ...] | None = Field(default=None, description="as the kind of stage says")
    module: float | None = dimension(None, of="normal module", gt=0, le=0.2)
    helix: float = dimension(
        0.0,
        of="helix angle at the reference circle; without a module, at the base circle",
        unit="deg",
        ge=0,
        le=45,
    )
    pressure_angle: float = dimension(
        20.0,
        of="normal pressure angle; without a module, the working transverse one",
        unit="deg",
        ge=10,
        le=35,
        source="assumed: 20 degrees, ISO 53",
    )
    shifts: tuple[Annotated[float, Field(gt=-3, lt=3)], ...] | None = Field(
        default=None, description="profile shifts in modules, as teeth; of a ring as ISO 21771"
    )
    tips: tuple[Radius, ...] | None = _of_each(
        "tip diameters, as teeth, m", "assumed: an addendum of a module"
    )
    faces: tuple[Radius, ...] | None = _of_each(
        "face widths, as teeth, m", "assumed: each as wide as the face in contact"
    )
    dedendum: float = dimension(
        1.25,
        of="dedendum of the rack, in modules",
        unit="-",
        gt=0,
        le=3,
        source="assumed: 1.25 modules, ISO 53",
    )
    fillets: tuple[Annotated[float, Field(ge=0, le=1)], ...] | None = _of_each(
        "tip radii of the racks, in modules, as teeth", "assumed: 0.38 modules, ISO 53"
    )
    blank: float = dimension(
        1.0,
        of="factor C_R of the gear blanks, ISO 6336-1",
        unit="-",
        gt=0,
        le=1,
        source="assumed: solid gears",
    )
    hand: Literal[-1, 0, 1] = Field(
        default=0, description="1 right, -1 left, of a stage with a helix; 0 spur"
    )
    centre_distance: float = dimension(of="centre distance", gt=0, le=MAX_GEAR)
    face_width: float = dimension(of="face width in contact", gt=0, le=MAX_GEAR)
    mesh_damping: float = dimension(
        0.0,
        of="damping of each mesh",
        unit="N s/m",
        ge=0,
        le=MAX_DAMPING,
        source="assumed: meshes without damping",
    )
    slices: int = Field(
        default=1,
        ge=1,
        le=99,
        description="slices of each mesh over the face width",
        json_schema_extra={
            "unit": "-",
            "source": "assumed: each mesh in one point, without stiffness against tilt",
        },
    )
    stiffness_of: Literal["line", "axis"] = Field(
        description="line: meshes in N/m along the line of action; axis: in N m/rad about the "
        "planet's, or the gear's, axis",
    )

    @model_validator(mode="after")
    def _helix_has_a_hand(self) -> Self:
        if self.helix > 0 and self.hand == 0:
            raise InputError(
                f"helix is {self.helix:g} deg but the hand of its teeth is not given: give hand, "
                "1 right or -1 left (of a sun, or of a driving gear), or remove the helix"
            )
        if self.hand != 0 and self.helix == 0:
            raise InputError(
                f"hand is {self.hand} but helix is 0 deg: give the helix angle, or remove the hand"
            )
        return self

    def assumptions(self) -> list[Assumption]:
        """Say what is assumed; facts about teeth only where profile shifts are given."""
        silent = () if self.shifts is not None else OF_TEETH
        return [row for row in super().assumptions() if row.name not in silent]

    def check_gears(self, teeth: tuple[int, ...] | None) -> None:
        """Refuse data of another number of gears than there are, and faces below the contact.

        Raises
        ------
        InputError
            They are not as many as the teeth, or a face is narrower than the contact, or there is
            a module without teeth, or profile shifts without a module.
        """
        if self.module is not None and teeth is None:
            raise InputError(
                f"a module of {self.module:g} m needs the teeth: give them in place of radii, or "
                "remove the module"
            )
        if self.shifts is not None and self.module is None:
            raise InputError("profile shifts need a module: give it, or remove the shifts")
        for name in ("shifts", "tips", "faces", "fillets"):
            given = getattr(self, name)
            if given is not None and len(given) != len(teeth or ()):
                raise InputError(
                    f"{name} of a stage are {list(given)} but must be as many as its "
                    f"{len(teeth or ())} teeth: give one for each gear"
                )
        if self.faces is not None and min(self.faces) < self.face_width:
            raise InputError(
                f"faces of a stage are {list(self.faces)} m but must be at least the face width in "
                f"contact, {self.face_width:g} m: correct one of them"
            )

    def mesh(self, teeth: int) -> Mesh:
        """Working angles of a mesh: of the sum of teeth if external, their difference if internal.

        Without a module, the pressure angle given is the working transverse one.
        """
        helix, normal = radians(self.helix), radians(self.pressure_angle)
        if self.module is None:
            return Mesh(normal, helix, self.face_width)
        angle = working_angle(self.module, teeth, self.centre_distance, normal, helix)
        return Mesh(angle, base_helix(helix, normal), self.face_width)


class PlanetaryData(GearData):
    """A planetary stage: teeth of ring, planet and sun, or the radii of sun and planet."""

    kind: Literal["planetary"] = Field(default="planetary", description="the word planetary")
    radii: tuple[Radius, Radius] | None = Field(
        default=None, description="working pitch radii of sun and planet, m"
    )
    planets: int = Field(ge=1, le=50, description="number of planets")
    carrier: RotorBody = Field(description="carrier, planets left out")
    planet: RotorBody = Field(description="one planet")
    sun: RotorBody = Field(description="sun")
    ring: RotorBody | None = Field(default=None, description="ring, where it is not held")
    ring_support: Six | None = Field(default=None, description="support of a ring that is not held")
    cutter: int | None = Field(
        default=None,
        ge=5,
        le=5000,
        description="teeth of the pinion cutter of the ring, for its roots",
    )
    sun_planet: float = dimension(
        of="mesh stiffness, N/m or", unit="N m/rad", gt=0, le=MAX_STIFFNESS
    )
    ring_planet: float = dimension(
        of="mesh stiffness, N/m or", unit="N m/rad", gt=0, le=MAX_STIFFNESS
    )
    pins: tuple[PinData, ...] = Field(default=(), description="bearings of each planet")

    _bodies = field_validator("carrier", "planet", "sun", "ring", mode="wrap")(in_its_field)
    _pins = field_validator("pins", mode="before")(rows_of("pin", PinData))

    @model_validator(mode="after")
    def _teeth_or_radii(self) -> Self:
        if (self.teeth is None) == (self.radii is None):
            raise InputError("a planetary stage needs teeth or radii, and not both: give one")
        if self.teeth is not None:
            if len(self.teeth) != 3 or min(self.teeth) < 1:
                raise InputError(
                    f"a planetary stage needs the teeth of ring, planet and sun, not "
                    f"{list(self.teeth)}: give three numbers above 0"
                )
            ring, planet, sun = self.teeth
            if not ring > max(planet, sun):
                raise InputError(
                    f"a planetary stage has the teeth of ring, planet and sun {list(self.teeth)} "
                    "but the ring must have the most: give them in this order"
                )
            check_assembly(self.name or "planetary stage", sun, ring, self.planets)
        if (self.ring is None) != (self.ring_support is None):
            raise InputError(
                "a ring that is not held needs both its inertias, ring, and its ring_support: give "
                "both, or none where the housing holds it"
            )
        self.check_gears(self.teeth)
        return self

    @property
    def sun_radius(self) -> float:
        """Working pitch radius of the sun [m]."""
        if self.teeth is not None:
            return self.centre_distance * self.teeth[2] / (self.teeth[2] + self.teeth[1])
        return self.radii[0] if self.radii else 0.0

    @property
    def meshes(self) -> tuple[Mesh, Mesh]:
        """Meshes of sun and planet, and of planet and ring."""
        ring, planet, sun = self.teeth if self.teeth is not None else (0, 0, 0)
        return self.mesh(sun + planet), self.mesh(ring - planet)

    def along_line(self, stiffness: float) -> float:
        """A mesh's stiffness along its line of action [N/m]."""
        if self.stiffness_of == "line":
            return stiffness
        mesh = self.meshes[0]
        base = (self.centre_distance - self.sun_radius) * cos(mesh.pressure_angle)
        return stiffness / (base * cos(mesh.base_helix)) ** 2

    @property
    def speed_ratio(self) -> float:
        """Speed of the sun over that of the carrier."""
        if self.teeth is not None:
            return 1 + self.teeth[0] / self.teeth[2]
        # of the centre distance, as the modes, so that both are of one geometry
        return 2 * self.centre_distance / self.sun_radius


class ParallelData(GearData):
    """A gear that drives a pinion: their teeth, or their radii."""

    kind: Literal["parallel"] = Field(default="parallel", description="the word parallel")
    radii: tuple[Radius, Radius] | None = Field(
        default=None, description="working pitch radii of gear and pinion, m"
    )
    angle: float = dimension(
        0.0, of="where the pinion is, from y to z", unit="deg", ge=-360, le=360
    )
    gear: RotorBody = Field(description="gear")
    pinion: RotorBody = Field(description="pinion")
    stiffness: float = dimension(
        of="mesh stiffness, N/m or", unit="N m/rad", gt=0, le=MAX_STIFFNESS
    )

    _bodies = field_validator("gear", "pinion", mode="wrap")(in_its_field)

    @model_validator(mode="after")
    def _teeth_or_radii(self) -> Self:
        if (self.teeth is None) == (self.radii is None):
            raise InputError("a parallel stage needs teeth or radii, and not both: give one")
        if self.teeth is not None and (len(self.teeth) != 2 or min(self.teeth) < 1):
            raise InputError(
                f"a parallel stage needs the teeth of gear and pinion, not {list(self.teeth)}: "
                "give two numbers above 0"
            )
        self.check_gears(self.teeth)
        return self

    @property
    def gear_radius(self) -> float:
        """Working pitch radius of the gear [m]."""
        if self.teeth is not None:
            return self.centre_distance * self.teeth[0] / sum(self.teeth)
        return self.radii[0] if self.radii else 0.0

    @property
    def meshing(self) -> Mesh:
        """Working angles."""
        return self.mesh(sum(self.teeth) if self.teeth is not None else 0)

    @property
    def along_line(self) -> float:
        """The mesh's stiffness along its line of action [N/m]."""
        if self.stiffness_of == "line":
            return self.stiffness
        mesh = self.meshing
        base = self.gear_radius * cos(mesh.pressure_angle)
        return self.stiffness / (base * cos(mesh.base_helix)) ** 2

    @property
    def speed_ratio(self) -> float:
        """Speed of the pinion over that of the gear, both counted positive."""
        if self.teeth is not None:
            return self.teeth[0] / self.teeth[1]
        return self.gear_radius / (self.centre_distance - self.gear_radius)


StageData = Annotated[
    Annotated[PlanetaryData, Tag("planetary")] | Annotated[ParallelData, Tag("parallel")],
    Discriminator(kind_of),
]
"""A stage of either kind: rows of a file have become stages before this type is used."""
_KINDS: dict[str, type[Part]] = {"planetary": PlanetaryData, "parallel": ParallelData}


class MachineTable(Part):
    """A drivetrain in three dimensions, from the rotor to the generator, row by row.

    Users build a `Machine`, whose rows fit each other.
    """

    title: str = Field(description="what it is")
    sources: tuple[str, ...] = Field(default=(), description="where the numbers come from")
    assumed: tuple[str, ...] = Field(default=(), description="what no source gives, and why so")
    rotor: RotorBody = Field(description="rotor, at the origin")
    shafts: tuple[ShaftData, ...] = Field(min_length=1, description="shafts from the rotor on")
    stages: tuple[StageData, ...] = Field(default=(), description="gear stages from the rotor on")
    generator: GeneratorBody = Field(description="the generator")
    bearings: tuple[BearingData, ...] = Field(default=(), description="bearings in the housing")

    __repr__ = short_repr
    __str__ = short_repr

    _ends = field_validator("rotor", "generator", mode="wrap")(in_its_field)
    _shafts = field_validator("shafts", mode="before")(rows_of("shaft", ShaftData))
    _stages = field_validator("stages", mode="before")(rows_of("stage", _KINDS))
    _bearings = field_validator("bearings", mode="before")(rows_of("bearing", BearingData))

    @model_validator(mode="after")
    def _one_shaft_more(self) -> Self:
        if len(self.shafts) != len(self.stages) + 1:
            raise InputError(
                f"machine {self.title!r} has {len(self.shafts)} shafts and {len(self.stages)} "
                "stages but must have one shaft more than stages: add or remove some"
            )
        return self

    @property
    def speeds(self) -> tuple[float, ...]:
        """Speed of each shaft over the rotor's; a parallel stage changes the sense."""
        found = [1.0]
        for stage in self.stages:
            sense = 1.0 if isinstance(stage, PlanetaryData) else -1.0
            found.append(found[-1] * sense * stage.speed_ratio)
        return tuple(found)

    @property
    def meshing(self) -> tuple[tuple[str, tuple[int, int]], ...]:
        """Kind of each stage, and the teeth of ring and sun, or of gear and pinion.

        Raises
        ------
        InputError
            A stage is given by radii, without teeth.
        """
        found = []
        for number, stage in enumerate(self.stages, start=1):
            if stage.teeth is None:
                raise InputError(f"stage {number} is given without teeth: give them")
            found.append((stage.kind, (stage.teeth[0], stage.teeth[-1])))
        return tuple(found)

    @property
    def axes(self) -> tuple[tuple[float, float, float], ...]:
        """Positions where each shaft begins [m]."""
        x = y = z = 0.0
        found = [(x, y, z)]
        for shaft, stage in zip(self.shafts, self.stages, strict=False):
            x += shaft.length
            if isinstance(stage, ParallelData):
                y += stage.centre_distance * cos(radians(stage.angle))
                z += stage.centre_distance * cos(radians(stage.angle - 90))
            found.append((x, y, z))
        return tuple(found)

    def assumptions(self) -> list[Assumption]:
        """Assumptions of all rows: what the table does not give."""
        named: list[tuple[str, Part]] = [("rotor", self.rotor)]
        named += [(f"shaft {shaft.name}", shaft) for shaft in self.shafts]
        for number, stage in enumerate(self.stages, start=1):
            named.append((f"stage {number}", stage))
            parts = ("carrier", "planet", "sun", "ring", "gear", "pinion")
            bodies = [(part, getattr(stage, part, None)) for part in parts]
            named += [(f"stage {number} {part}", body) for part, body in bodies if body is not None]
            pins = stage.pins if isinstance(stage, PlanetaryData) else ()
            named += [(f"stage {number} pin {pin.name}".strip(), pin) for pin in pins]
        named.append(("generator", self.generator))
        named += [(bearing.name, bearing) for bearing in self.bearings]
        return assumed_in(named)
