"""Gear stages of a drivetrain's file, each right for itself, and the same with all data completed.

A stage of a file may leave out what follows from the rest (`stage_completion`); one of a machine,
`PlanetaryData` or `ParallelData`, has all that a model in three dimensions needs. Whether stages
fit is the gate's (`machine_gate`).
"""

from math import cos, radians
from typing import Annotated, Literal, Self

from pydantic import (
    Discriminator,
    Field,
    Tag,
    field_validator,
    model_validator,
)

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file import stage_fields
from fe_drivetrain.drivetrain_file.gear_strength import GearStrength
from fe_drivetrain.drivetrain_file.stage_fields import (
    NAMED,
    Fillet,
    GearPinion,
    RingPlanetSun,
    Shift,
    SunPlanet,
)
from fe_drivetrain.drivetrain_file.turning_parts import (
    MAX_GEAR,
    MAX_STIFFNESS,
    AllHeld,
    CarrierBody,
    PinData,
    Radius,
    RotorBody,
    Six,
    Teeth,
)
from fe_drivetrain.gear.planets import check_assembly
from fe_drivetrain.gear.working_angles import Mesh, base_helix, working_angle
from fe_drivetrain.geometry.part import (
    Assumption,
    Part,
    dimension,
    in_its_field,
    kind_of,
    rows_of,
)

#: What the full data of gears take where a table is silent, of stages with profile shifts.
OF_TEETH = ("dedendum", "fillets", "tips", "faces", "blank")


class GearStage(Part):
    """Fields that both kinds of stages have in common."""

    name: str = Field(default="", description="any")
    teeth: tuple[Teeth, ...] | None = Field(default=None, description="teeth of each gear")
    ratio: float | None = dimension(
        None, of="speed ratio, in place of teeth, for torsion alone", unit="-", gt=1, le=1000
    )
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
    shifts: tuple[Shift, ...] | None = None
    tips: tuple[Radius, ...] | None = None
    faces: tuple[Radius, ...] | None = None
    dedendum: float = dimension(
        1.25,
        of="dedendum of the rack, in modules",
        unit="-",
        gt=0,
        le=3,
        source="assumed: 1.25 modules, ISO 53",
    )
    fillets: tuple[Fillet, ...] | None = None
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
    centre_distance: float | None = dimension(
        None, of="centre distance; follows from the teeth, module and shifts", gt=0, le=MAX_GEAR
    )
    face_width: float | None = dimension(None, of="face width in contact", gt=0, le=MAX_GEAR)
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
    strength: GearStrength | None = Field(
        default=None, description="steels, roughness and accuracy of the gears, for their ratings"
    )
    stiffness_of: Literal["line", "axis"] | None = Field(
        default=None,
        description="line: meshes in N/m and N s/m along the line of action; axis: in N m/rad and "
        "N m s/rad about the planet's, or the gear's, axis",
    )

    _strength = field_validator("strength", mode="wrap")(in_its_field)

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

    def check_gears(self) -> None:
        """Refuse a stage without a ratio or with two, and faces below the contact.

        Raises
        ------
        InputError
            More or fewer than one of teeth, radii and ratio are given, or a module without teeth,
            profile shifts without a module, a face narrower than the contact, or the strength of
            other gears.
        """
        kind = "planetary" if isinstance(self, PlanetaryStage) else "parallel"
        radii = getattr(self, "radii", None)
        given = [self.teeth is not None, radii is not None, self.ratio is not None]
        if sum(given) != 1:
            raise InputError(
                f"a {kind} stage needs one of teeth, radii and ratio, not "
                f"{'several' if sum(given) else 'none'} of them: give one"
            )
        if self.module is not None and self.teeth is None:
            raise InputError(
                f"a module of {self.module:g} m needs the teeth: give them in place of radii or "
                "ratio, or remove the module"
            )
        gears = ("ring", "planet", "sun") if kind == "planetary" else ("gear", "pinion")
        if self.strength is not None and set(self.strength.gears) != set(gears):
            raise InputError(
                f"strength has the gears {', '.join(self.strength.gears)} but a {kind} stage has "
                f"{', '.join(gears)}: name these"
            )
        if self.shifts is not None and self.module is None:
            raise InputError("profile shifts need a module: give it, or remove the shifts")
        if self.faces is not None and min(self.faces) < (self.face_width or 0.0):
            raise InputError(
                f"faces of a stage are {_of_gears(self.faces)} m but must be at least the face "
                f"width in contact, {self.face_width:g} m: correct one of them"
            )

    def check_stiffness(self, **meshes: tuple[float | None, float]) -> None:
        """Refuse mesh stiffnesses without a word on what they are of, and damping alone.

        Parameters
        ----------
        **meshes : tuple
            Stiffness and damping of each mesh, by the key of the stiffness.

        Raises
        ------
        InputError
            See above.
        """
        for key, (stiffness, damping) in meshes.items():
            if damping > 0 and stiffness is None:
                raise InputError(
                    f"damping of a mesh is {damping:g} but its stiffness is not given: give "
                    f"{key}, or remove the damping"
                )
        if any(mesh is not None for mesh, _ in meshes.values()) and self.stiffness_of is None:
            raise InputError(
                "a mesh stiffness needs stiffness_of: give line for N/m along the line of action, "
                "or axis for N m/rad about the planet's, or the gear's, axis"
            )


def _of_gears(values: tuple[float, ...]) -> str:
    """Values of gears by name, as a file has them."""
    named = zip(getattr(values, "_fields", ()), values, strict=False)
    return "{" + ", ".join(f"{name}: {value:g}" for name, value in named) + "}"


class PlanetaryStage(GearStage):
    """A planetary stage of a file: the carrier is driven, the sun drives the next shaft."""

    kind: Literal["planetary"] = Field(default="planetary", description="the word planetary")
    teeth: Annotated[RingPlanetSun[Teeth] | None, *NAMED] = Field(
        default=None, description="teeth of each gear"
    )
    radii: Annotated[SunPlanet[Radius] | None, *NAMED] = Field(
        default=None, description="working pitch radii, in place of teeth, m"
    )
    shifts: Annotated[RingPlanetSun[Shift] | None, *NAMED] = stage_fields.shifts()
    tips: Annotated[RingPlanetSun[Radius] | None, *NAMED] = stage_fields.tips()
    faces: Annotated[RingPlanetSun[Radius] | None, *NAMED] = stage_fields.faces()
    fillets: Annotated[RingPlanetSun[Fillet] | None, *NAMED] = stage_fields.fillets()
    planets: int = Field(ge=1, le=50, description="number of planets")
    carrier: CarrierBody | None = Field(default=None, description="carrier, planets left out")
    planet: RotorBody | None = Field(
        default=None, description="one planet; a disc of steel where left out"
    )
    sun: RotorBody | None = Field(default=None, description="sun; a disc of steel where left out")
    ring: RotorBody | None = Field(default=None, description="ring, where it is not held")
    ring_support: Six | None = Field(default=None, description="support of a ring that is not held")
    cutter: int | None = Field(
        default=None,
        ge=5,
        le=5000,
        description="teeth of the pinion cutter of the ring, for its roots",
    )
    sun_planet: float | None = dimension(
        None,
        of="mesh stiffness; by ISO 6336-1 where left out, N/m or",
        unit="N m/rad",
        gt=0,
        le=MAX_STIFFNESS,
    )
    ring_planet: float | None = dimension(
        None,
        of="mesh stiffness; by ISO 6336-1 where left out, N/m or",
        unit="N m/rad",
        gt=0,
        le=MAX_STIFFNESS,
    )
    sun_planet_damping: float = stage_fields.mesh_damping()
    ring_planet_damping: float = stage_fields.mesh_damping()
    pins: tuple[PinData, ...] = Field(default=(), description="bearings of each planet")
    bushing: AllHeld | None = Field(
        default=None,
        description="stiffness of each pin's seat in the carrier: axial, radial, tangential, and "
        "about them, N/m, N m/rad; rigid where left out",
    )

    _bodies = field_validator("carrier", "planet", "sun", "ring", mode="wrap")(in_its_field)
    _pins = field_validator("pins", mode="before")(rows_of("pin", PinData))

    @model_validator(mode="after")
    def _stands_for_itself(self) -> Self:
        self.check_gears()
        self.check_stiffness(
            sun_planet=(self.sun_planet, self.sun_planet_damping),
            ring_planet=(self.ring_planet, self.ring_planet_damping),
        )
        if self.teeth is not None:
            if not self.teeth.ring > max(self.teeth.planet, self.teeth.sun):
                raise InputError(
                    f"a planetary stage has teeth of {_of_gears(self.teeth)} but the ring must "
                    "have the most: correct them"
                )
            self._check_angles()
        if self.ratio is not None and self.ratio <= 2:
            raise InputError(
                f"ratio of a planetary stage is {self.ratio:g} but must be greater than 2, or no "
                "planet fits between sun and ring: raise it"
            )
        if (self.ring is None) != (self.ring_support is None):
            raise InputError(
                "a ring that is not held needs both its inertias, ring, and its ring_support: give "
                "both, or none where the housing holds it"
            )
        return self

    @property
    def has_size(self) -> bool:
        """Whether its planets have places, and do more than turn."""
        return self.module is not None or self.centre_distance is not None

    def _check_angles(self) -> None:
        if self.teeth is not None and self.has_size:
            name = self.name or "planetary stage"
            check_assembly(name, self.teeth.sun, self.teeth.ring, self.planets)

    def assumptions(self) -> list[Assumption]:
        """Say what is assumed, and that torsion ignores unequal angles of planets."""
        rows = super().assumptions()
        if self.teeth is not None and (self.teeth.ring + self.teeth.sun) % self.planets:
            why = (
                f"assumed: ring and sun, {self.teeth.ring} + {self.teeth.sun} teeth, are no "
                f"multiple of {self.planets} planets, which stand at unequal angles"
            )
            rows.append(Assumption("angles of planets", "unequal", "", why))
        return rows

    @property
    def speed_ratio(self) -> float:
        """Speed of the sun over that of the carrier."""
        if self.teeth is not None:
            return 1 + self.teeth.ring / self.teeth.sun
        if self.radii is not None:
            # of the centre distance, as the modes, so that both are of one geometry
            distance = self.centre_distance or sum(self.radii)
            return 2 * distance / self.radii.sun
        return self.ratio or 1.0


class PlanetaryData(PlanetaryStage):
    """A planetary stage with all that a model in three dimensions needs."""

    centre_distance: float = dimension(of="centre distance", gt=0, le=MAX_GEAR)
    face_width: float = dimension(of="face width in contact", gt=0, le=MAX_GEAR)
    stiffness_of: Literal["line", "axis"] = Field(description="line or axis")
    carrier: CarrierBody = Field(description="carrier, planets left out")
    planet: RotorBody = Field(description="one planet")
    sun: RotorBody = Field(description="sun")
    sun_planet: float = dimension(of="mesh stiffness", unit="N m/rad", gt=0, le=MAX_STIFFNESS)
    ring_planet: float = dimension(of="mesh stiffness", unit="N m/rad", gt=0, le=MAX_STIFFNESS)

    @property
    def sun_radius(self) -> float:
        """Working pitch radius of the sun [m]."""
        if self.teeth is not None:
            sun, planet = self.teeth.sun, self.teeth.planet
            return self.centre_distance * sun / (sun + planet)
        return self.radii.sun if self.radii else 0.0

    @property
    def meshes(self) -> tuple[Mesh, Mesh]:
        """Meshes of sun and planet, and of planet and ring."""
        ring, planet, sun = self.teeth if self.teeth is not None else (0, 0, 0)
        return mesh_of(self, sun + planet), mesh_of(self, ring - planet)

    def _check_angles(self) -> None:
        """Leave it to the gate, which knows whether sizes are nominal."""

    @property
    def arm(self) -> float:
        """Winding of a mesh along its line of action by a turn of the planet alone [m/rad]."""
        mesh = self.meshes[0]
        base = (self.centre_distance - self.sun_radius) * cos(mesh.pressure_angle)
        return base * cos(mesh.base_helix)

    def along_line(self, value: float) -> float:
        """A mesh's stiffness or damping along its line of action [N/m, N s/m]."""
        return value if self.stiffness_of == "line" else value / self.arm**2

    def about_axis(self, value: float) -> float:
        """A mesh's stiffness or damping about the planet's axis [N m/rad, N m s/rad]."""
        return value if self.stiffness_of == "axis" else value * self.arm**2


class ParallelStage(GearStage):
    """A parallel stage of a file: a gear that drives a pinion."""

    kind: Literal["parallel"] = Field(default="parallel", description="the word parallel")
    teeth: Annotated[GearPinion[Teeth] | None, *NAMED] = Field(
        default=None, description="teeth of each gear"
    )
    radii: Annotated[GearPinion[Radius] | None, *NAMED] = Field(
        default=None, description="working pitch radii, in place of teeth, m"
    )
    shifts: Annotated[GearPinion[Shift] | None, *NAMED] = stage_fields.shifts()
    tips: Annotated[GearPinion[Radius] | None, *NAMED] = stage_fields.tips()
    faces: Annotated[GearPinion[Radius] | None, *NAMED] = stage_fields.faces()
    fillets: Annotated[GearPinion[Fillet] | None, *NAMED] = stage_fields.fillets()
    angle: float = dimension(
        0.0, of="where the pinion is, from y to z", unit="deg", ge=-360, le=360
    )
    gear: RotorBody | None = Field(default=None, description="gear; a disc of steel where left out")
    pinion: RotorBody | None = Field(
        default=None, description="pinion; a disc of steel where left out"
    )
    stiffness: float | None = dimension(
        None,
        of="mesh stiffness; by ISO 6336-1 where left out, N/m or",
        unit="N m/rad",
        gt=0,
        le=MAX_STIFFNESS,
    )

    damping: float = stage_fields.mesh_damping()

    _bodies = field_validator("gear", "pinion", mode="wrap")(in_its_field)

    @model_validator(mode="after")
    def _stands_for_itself(self) -> Self:
        self.check_gears()
        self.check_stiffness(stiffness=(self.stiffness, self.damping))
        return self

    @property
    def speed_ratio(self) -> float:
        """Speed of the pinion over that of the gear, both counted positive."""
        if self.teeth is not None:
            return self.teeth.gear / self.teeth.pinion
        if self.radii is not None:
            distance = self.centre_distance or sum(self.radii)
            return self.radii.gear / (distance - self.radii.gear)
        return self.ratio or 1.0


class ParallelData(ParallelStage):
    """A parallel stage with all that a model in three dimensions needs."""

    centre_distance: float = dimension(of="centre distance", gt=0, le=MAX_GEAR)
    face_width: float = dimension(of="face width in contact", gt=0, le=MAX_GEAR)
    stiffness_of: Literal["line", "axis"] = Field(description="line or axis")
    gear: RotorBody = Field(description="gear")
    pinion: RotorBody = Field(description="pinion")
    stiffness: float = dimension(of="mesh stiffness", unit="N m/rad", gt=0, le=MAX_STIFFNESS)

    @property
    def gear_radius(self) -> float:
        """Working pitch radius of the gear [m]."""
        if self.teeth is not None:
            return self.centre_distance * self.teeth.gear / sum(self.teeth)
        return self.radii.gear if self.radii else 0.0

    @property
    def meshing(self) -> Mesh:
        """Working angles."""
        return mesh_of(self, sum(self.teeth) if self.teeth is not None else 0)

    @property
    def arm(self) -> float:
        """Winding of the mesh along its line of action by a turn of the gear alone [m/rad]."""
        mesh = self.meshing
        return self.gear_radius * cos(mesh.pressure_angle) * cos(mesh.base_helix)

    def along_line(self, value: float) -> float:
        """The mesh's stiffness or damping along its line of action [N/m, N s/m]."""
        return value if self.stiffness_of == "line" else value / self.arm**2

    def about_axis(self, value: float) -> float:
        """The mesh's stiffness or damping about the gear's axis [N m/rad, N m s/rad]."""
        return value if self.stiffness_of == "axis" else value * self.arm**2


def mesh_of(stage: PlanetaryData | ParallelData, teeth: int) -> Mesh:
    """Working angles of a mesh: of the sum of teeth if external, their difference if internal.

    Without a module, the pressure angle given is the working transverse one.
    """
    helix, normal = radians(stage.helix), radians(stage.pressure_angle)
    if stage.module is None:
        return Mesh(normal, helix, stage.face_width)
    angle = working_angle(stage.module, teeth, stage.centre_distance, normal, helix)
    return Mesh(angle, base_helix(helix, normal), stage.face_width)


FileStage = Annotated[
    Annotated[PlanetaryStage, Tag("planetary")] | Annotated[ParallelStage, Tag("parallel")],
    Discriminator(kind_of),
]
"""A stage of a file, of either kind: rows have become stages before this type is used."""
FILE_KINDS: dict[str, type[Part]] = {"planetary": PlanetaryStage, "parallel": ParallelStage}

StageData = Annotated[
    Annotated[PlanetaryData, Tag("planetary")] | Annotated[ParallelData, Tag("parallel")],
    Discriminator(kind_of),
]
"""A stage of a machine, of either kind."""
KINDS: dict[str, type[Part]] = {"planetary": PlanetaryData, "parallel": ParallelData}
