"""Tables of drivetrains in three dimensions, as YAML: gears, shafts, bearings and their sources.

The axis of the first shaft is x; each stage stands where its driving shaft ends, and a parallel one
moves the axis of what follows by its centre distance.
"""

from collections.abc import Mapping
from importlib.resources import files
from math import cos, pi, radians
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Discriminator, Field, Tag, model_validator

from fe_drivetrain.beam.frame import CrossSection, round_section
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import parse_mapping, read_text, validated
from fe_drivetrain.dynamics.planetary import base_helix, check_assembly, working_angle
from fe_drivetrain.dynamics.springs import Mesh
from fe_drivetrain.geometry.part import Part, dimension
from fe_drivetrain.scene.materials import Material

STEEL = Material(youngs_modulus=2.06e11, poisson_ratio=0.3, density=7850.0)
"""Of shafts, where nothing else is given."""

Six = tuple[
    Annotated[float, Field(ge=0)],
    Annotated[float, Field(ge=0)],
    Annotated[float, Field(ge=0)],
    Annotated[float, Field(ge=0)],
    Annotated[float, Field(ge=0)],
    Annotated[float, Field(ge=0)],
]
"""Along and about three axes [N/m, N m/rad]."""


class RotorBody(Part):
    """A body that is symmetric about its axis along x."""

    inertia: float = dimension(of="polar inertia", unit="kg m^2", gt=0)
    mass: float | None = dimension(None, of="mass", unit="kg", ge=0)
    transverse: float | None = dimension(None, of="inertia across", unit="kg m^2", ge=0)

    def inertias(self, radius: float, width: float) -> tuple[float, float]:
        """Mass and transverse inertia; where not given, of a disc: m = 2 J / r^2.

        Parameters
        ----------
        radius, width : float
            Of the disc [m].
        """
        mass = 2 * self.inertia / radius**2 if self.mass is None else self.mass
        across = self.inertia / 2 + mass * width**2 / 12
        return mass, across if self.transverse is None else self.transverse


class GeneratorBody(RotorBody):
    """The generator's rotor, and what holds its speed."""

    stiffness: float = dimension(0.0, of="electrical stiffness", unit="N m/rad", ge=0)


class ShaftData(Part):
    """A round shaft from one stage to the next; a solid one by its torsional stiffness, or by size.

    One given by its stiffness alone has no mass: the inertias of its table include it.
    """

    name: str = Field(description="name of the shaft")
    length: float = dimension(of="length", gt=0)
    outer: float | None = dimension(None, of="outer diameter", gt=0)
    inner: float = dimension(0.0, of="inner diameter", ge=0)
    torsion: float | None = dimension(None, of="torsional stiffness", unit="N m/rad", gt=0)
    bending: float | None = dimension(
        None, of="stiffness of the hinge at its middle in bending", unit="N m/rad", gt=0
    )
    kind: Literal["shaft", "coupling", "rigid"] = Field(
        default="shaft",
        description="coupling: carries torque alone; rigid: makes its two ends one body",
    )

    @model_validator(mode="after")
    def _one_size(self) -> Self:
        if self.kind == "rigid":
            if self.outer is not None or self.torsion is not None:
                raise InputError(
                    f"shaft {self.name!r} is rigid, and has no diameter or stiffness: remove them"
                )
            return self
        if (self.outer is None) == (self.torsion is None):
            raise InputError(
                f"shaft {self.name!r} needs its outer diameter or its torsional stiffness, and not "
                "both: give one of them"
            )
        if self.outer is not None and self.inner >= self.outer:
            raise InputError(
                f"shaft {self.name!r}: inner diameter {self.inner:g} m must be below the "
                f"outer one, {self.outer:g} m: lower it"
            )
        return self

    @property
    def section(self) -> CrossSection:
        """Its cross-section; that of a solid steel bar where only the torsion is given."""
        if self.outer is not None:
            return round_section(self.outer, STEEL.poisson_ratio, self.inner)
        area = float(self.torsion or 0.0) * self.length / STEEL.shear_modulus
        return round_section((32 * area / pi) ** 0.25, STEEL.poisson_ratio)

    @property
    def has_mass(self) -> bool:
        """Whether its mass counts beside the inertias of the table."""
        return self.outer is not None


class PinData(Part):
    """A bearing of each planet on its pin."""

    name: str = Field(default="", description="such as upwind")
    offset: float = dimension(0.0, of="x from the planet's centre")
    stiffness: Six = Field(description="axial, radial, tangential, and about them, N/m, N m/rad")


class BearingData(Part):
    """A bearing of a shaft or of a carrier, in the housing."""

    name: str = Field(description="name of the bearing")
    holds: str = Field(description="name of the shaft, or of the body such as 'stage 1 carrier'")
    at: float = dimension(0.0, of="x from where the shaft begins, or from the body's centre")
    stiffness: Six = Field(description="along x, y, z and about them, N/m, N m/rad")


class _Gears(Part):
    name: str = Field(default="", description="any")
    teeth: tuple[int, ...] | None = Field(default=None, description="as the kind of stage says")
    module: float | None = dimension(None, of="normal module", gt=0)
    helix: float = dimension(0.0, of="helix angle at the reference circle", unit="deg", ge=0)
    pressure_angle: float = dimension(20.0, of="normal pressure angle", unit="deg", gt=0)
    shifts: tuple[float, ...] | None = Field(
        default=None, description="profile shifts in modules, as teeth; of a ring as ISO 21771"
    )
    tips: tuple[float, ...] | None = Field(
        default=None, description="tip diameters, as teeth, m; without, an addendum of a module"
    )
    faces: tuple[float, ...] | None = Field(
        default=None, description="face widths, as teeth, m; without, that in contact"
    )
    dedendum: float = dimension(1.25, of="dedendum of the rack, in modules", unit="-", gt=0)
    fillets: tuple[float, ...] | None = Field(
        default=None, description="tip radii of the racks, in modules, as teeth; without, 0.38"
    )
    blank: float = dimension(1.0, of="factor C_R of the gear blanks, ISO 6336-1", unit="-", gt=0)
    hand: Literal[-1, 0, 1] = Field(default=0, description="1 right, -1 left, 0 spur")
    centre_distance: float = dimension(of="centre distance", gt=0)
    face_width: float = dimension(of="face width in contact", gt=0)
    mesh_damping: float = dimension(0.0, of="damping of each mesh", unit="N s/m", ge=0)
    slices: int = Field(default=1, ge=1, le=99, description="of each mesh over the face width")
    stiffness_of: Literal["line", "axis"] = Field(
        default="line",
        description="line: meshes in N/m along the line of action; axis: in N m/rad about the "
        "planet's, or the gear's, axis",
    )

    def check_gears(self, teeth: tuple[int, ...] | None) -> None:
        """Refuse data of another number of gears than there are, and faces below the contact.

        Raises
        ------
        InputError
            They are not as many as the teeth, or a face is narrower than the contact.
        """
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


class PlanetaryData(_Gears):
    """A planetary stage: teeth of ring, planet and sun, or the radii of sun and planet."""

    kind: Literal["planetary"] = Field(default="planetary", description="the word planetary")
    radii: tuple[float, float] | None = Field(
        default=None, description="working pitch radii of sun and planet, m"
    )
    planets: int = Field(default=3, ge=1, description="number of planets")
    carrier: RotorBody = Field(description="carrier, planets left out")
    planet: RotorBody = Field(description="one planet")
    sun: RotorBody = Field(description="sun")
    ring: RotorBody | None = Field(default=None, description="ring, where it is not held")
    ring_support: Six | None = Field(default=None, description="of a ring that is not held")
    cutter: int | None = Field(
        default=None, ge=5, description="teeth of the pinion cutter of the ring, for its roots"
    )
    sun_planet: float = dimension(of="mesh stiffness, N/m or", unit="N m/rad", gt=0)
    ring_planet: float = dimension(of="mesh stiffness, N/m or", unit="N m/rad", gt=0)
    pins: tuple[PinData, ...] = Field(default=(), description="bearings of each planet")

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
            ring, _, sun = self.teeth
            check_assembly(self.name or "planetary stage", sun, ring, self.planets)
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
        """Of sun and planet, and of planet and ring."""
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
        """Of the sun to the carrier."""
        if self.teeth is not None:
            return 1 + self.teeth[0] / self.teeth[2]
        sun, planet = self.radii or (1.0, 0.0)
        return 1 + (sun + 2 * planet) / sun


class ParallelData(_Gears):
    """A gear that drives a pinion: their teeth, or their radii."""

    kind: Literal["parallel"] = Field(default="parallel", description="the word parallel")
    radii: tuple[float, float] | None = Field(
        default=None, description="working pitch radii of gear and pinion, m"
    )
    angle: float = dimension(0.0, of="where the pinion is, from y to z", unit="deg", ge=-360)
    gear: RotorBody = Field(description="gear")
    pinion: RotorBody = Field(description="pinion")
    stiffness: float = dimension(of="mesh stiffness, N/m or", unit="N m/rad", gt=0)

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
        """Of the pinion to the gear."""
        gear, pinion = self.teeth if self.teeth is not None else self.radii or (1, 1)
        return float(gear) / float(pinion)


def _kind_of(stage: Any) -> Any:
    return stage.get("kind") if isinstance(stage, Mapping) else getattr(stage, "kind", None)


StageData = Annotated[
    Annotated[PlanetaryData, Tag("planetary")] | Annotated[ParallelData, Tag("parallel")],
    Discriminator(_kind_of),
]
"""Of either kind."""


class Machine(Part):
    """A drivetrain in three dimensions, from the rotor to the generator."""

    title: str = Field(description="what it is")
    sources: tuple[str, ...] = Field(default=(), description="where the numbers come from")
    assumed: tuple[str, ...] = Field(default=(), description="what no source gives, and why so")
    rotor: RotorBody = Field(description="rotor, at the origin")
    shafts: tuple[ShaftData, ...] = Field(min_length=1, description="shafts from the rotor on")
    stages: tuple[StageData, ...] = Field(default=(), description="gear stages from the rotor on")
    generator: GeneratorBody = Field(description="the generator")
    bearings: tuple[BearingData, ...] = Field(default=(), description="bearings in the housing")

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
        """Of each shaft over the rotor's; a parallel stage changes the sense."""
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
        """Where each shaft begins [m]."""
        x = y = z = 0.0
        found = [(x, y, z)]
        for shaft, stage in zip(self.shafts, self.stages, strict=False):
            x += shaft.length
            if isinstance(stage, ParallelData):
                y += stage.centre_distance * cos(radians(stage.angle))
                z += stage.centre_distance * cos(radians(stage.angle - 90))
            found.append((x, y, z))
        return tuple(found)


MACHINES = ("nrel_5mw", "nrel_750kw", "synthetic_2mw", "park_2021")
"""Names of the tables that come with the package."""


def library_machine(name: str) -> Machine:
    """A table that comes with the package.

    Parameters
    ----------
    name : str
        One of `MACHINES`.

    Raises
    ------
    InputError
        There is none of that name.
    """
    if name not in MACHINES:
        raise InputError(f"no machine {name!r}: use one of {', '.join(MACHINES)}")
    text = (files("fe_drivetrain.dynamics") / f"{name}.yaml").read_text("utf-8")
    return parse_machine(text, name)


def named_machine(name: str) -> Machine:
    """The machine in a file or of the library.

    Parameters
    ----------
    name : str
        A file, or one of `MACHINES`.

    Raises
    ------
    InputError
        There is none of that name, or the file does not describe a machine.
    """
    if name not in MACHINES and (Path(name).suffix or Path(name).exists()):
        return read_machine(name)
    return library_machine(name)


def read_machine(path: str | Path) -> Machine:
    """Read a machine's table from a YAML file of at most 1 MB.

    Parameters
    ----------
    path : str or Path
        Plain YAML without anchors, aliases or tags.

    Raises
    ------
    InputError
        The file cannot be read, or does not describe a machine.
    """
    return parse_machine(read_text(path, "machine"), str(path))


def parse_machine(text: str, source: str = "machine") -> Machine:
    """A machine from YAML text; see `read_machine`."""
    return validated(Machine, parse_mapping(text, source), source)
