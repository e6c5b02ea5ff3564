"""What turns beside the main shaft: bodies, shafts and bearings, in their ranges."""

from math import fsum, isclose
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import AfterValidator, Field, field_validator, model_validator

from fe_drivetrain.bearing.catalogue_page import EntryOrPage
from fe_drivetrain.bearing.mounting import Mounting
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import min_eigenvalue, symmetry_error
from fe_drivetrain.drivetrain_file.couplings import SplineData
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.geometry.part import (
    MINIMUM,
    Assumption,
    Part,
    dimension,
    in_its_field,
    rows_of,
)
from fe_drivetrain.geometry.shaft import Section

STEEL = Material(youngs_modulus=2.06e11, poisson_ratio=0.3, density=7850.0)
"""Steel of shafts, where nothing else is given."""

#: What no machine's inertia [kg m^2], mass [kg], stiffness [N/m, N m/rad] or damping is beyond. A
#: stiffness of 1e16 is rigid beside any other, and leaves 1e-8 of the forces to round-off; of 1e20
#: statics take the other springs for none.
MAX_INERTIA, MAX_MASS, MAX_STIFFNESS, MAX_DAMPING = 1e10, 1e7, 1e16, 1e12
#: Minimum inertia [kg m^2]: where a table has none, a body may turn with so little.
MIN_INERTIA = 1e-9
#: What no shaft is longer than, no centre distance, face or diameter larger than [m].
LONGEST, MAX_GEAR = 100.0, 20.0

Teeth = Annotated[int, Field(ge=5, le=5000)]
Radius = Annotated[float, Field(ge=MINIMUM, le=MAX_GEAR)]
Stiffness = Annotated[float, Field(ge=0, le=MAX_STIFFNESS)]
Speed = Annotated[float, Field(gt=0, le=100)]
Six = tuple[Stiffness, Stiffness, Stiffness, Stiffness, Stiffness, Stiffness]
"""Along and about three axes [N/m, N m/rad]."""
Held = Annotated[float, Field(gt=0, le=MAX_STIFFNESS)]
AllHeld = tuple[Held, Held, Held, Held, Held, Held]
"""Along and about three axes, none of them free [N/m, N m/rad]."""
Number = Annotated[float, Field(ge=-MAX_STIFFNESS, le=MAX_STIFFNESS)]
Row = tuple[Number, Number, Number, Number, Number, Number]
#: Difference of a matrix from a symmetric one, and its least eigenvalue, that are round-off.
ROUND_OFF = 1e-6


def _elastic(value: Six | tuple[Row, ...]) -> Six | tuple[Row, ...]:
    """Refuse a matrix that is not symmetric, or drives a motion."""
    if isinstance(value[0], tuple):
        K = np.array(value)
        if symmetry_error(K) > ROUND_OFF:
            raise InputError("stiffness must be six numbers, or six symmetric rows of six")
        if min_eigenvalue(K) < -ROUND_OFF:
            raise InputError(
                "stiffness must be positive semidefinite, but it drives a motion: check its signs"
            )
    return value


SixOrMatrix = Annotated[Six | tuple[Row, Row, Row, Row, Row, Row], AfterValidator(_elastic)]
"""Six stiffnesses, or six rows of a matrix with couplings [N/m, N, N m/rad]."""


class RotorBody(Part):
    """A body that is symmetric about its axis along x."""

    inertia: float = dimension(of="polar inertia", unit="kg m^2", ge=MIN_INERTIA, le=MAX_INERTIA)
    mass: float | None = dimension(
        None,
        of="mass",
        unit="kg",
        ge=0,
        le=MAX_MASS,
        source="assumed: of a disc of the polar inertia, 2 J / r^2",
    )
    transverse: float | None = dimension(
        None,
        of="inertia across",
        unit="kg m^2",
        ge=0,
        le=MAX_INERTIA,
        source="assumed: of a disc, J / 2, and m b^2 / 12 of a gear as wide as its face",
    )

    @model_validator(mode="after")
    def _can_be(self) -> Self:
        if self.transverse is not None and 2 * self.transverse < self.inertia * (1 - 1e-6):
            raise InputError(
                f"inertia across is {self.transverse:g} kg m^2 but must be at least half of that "
                f"about the axis, {self.inertia:g} kg m^2, as that of any body: correct one of them"
            )
        return self

    @property
    def apart(self) -> tuple[float, float]:
        """Mass and transverse inertia of a body without width: no mass where none is given."""
        across = self.inertia / 2 if self.transverse is None else self.transverse
        return self.mass or 0.0, across

    def inertias(self, radius: float, width: float) -> tuple[float, float]:
        """Mass and transverse inertia; where not given, of a disc: m = 2 J / r^2.

        Parameters
        ----------
        radius, width : float
            Radius and width of the disc [m].
        """
        mass = 2 * self.inertia / radius**2 if self.mass is None else self.mass
        across = self.inertia / 2 + mass * width**2 / 12
        return mass, across if self.transverse is None else self.transverse


class CarrierBody(RotorBody):
    """A planet carrier, planets left out."""

    component: str | None = Field(
        default=None,
        min_length=1,
        max_length=1000,
        description="planet carrier that gives: a component's file, or one of the library",
    )


class GeneratorBody(RotorBody):
    """The generator's rotor, and what holds its speed; without a mass, it turns and no more."""

    mass: float | None = dimension(
        None,
        of="mass",
        unit="kg",
        ge=0,
        le=MAX_MASS,
        source="assumed: stands on its foundation, and turns alone",
    )
    stiffness: float = dimension(
        0.0,
        of="electrical stiffness",
        unit="N m/rad",
        ge=0,
        le=MAX_STIFFNESS,
        source="assumed: off the grid, or of variable speed: nothing holds its angle",
    )
    damping: float = dimension(
        0.0,
        of="electrical damping",
        unit="N m s/rad",
        ge=0,
        le=MAX_DAMPING,
        source="assumed: without damping",
    )
    slip: float | None = dimension(
        None,
        of="slip of its torque over its speed at rated torque, as a share",
        unit="-",
        gt=0,
        le=0.2,
        source="assumed: 1 % where a generator's line is needed",
    )
    rated_torque: float | None = dimension(
        None,
        of="rated torque at the generator; of rated power and speed where left out",
        unit="N m",
        gt=0,
        le=1e9,
    )


class ShaftRow(Part):
    """A round shaft of a file, from one stage to the next: by its sections, size or stiffness.

    One given by its stiffness alone has no mass: the inertias of its bodies include it.
    """

    name: str = Field(description="name of the shaft")
    length: float | None = dimension(
        None, of="length; that of its sections where they are given", gt=0, le=LONGEST
    )
    sections: tuple[Section, ...] | None = Field(
        default=None, description="sections from front to rear, as those of the main shaft"
    )
    material: Material = Field(default=STEEL, description="material where it has a size")
    outer: float | None = dimension(None, of="outer diameter", gt=0, le=MAX_GEAR)
    inner: float = dimension(0.0, of="inner diameter", ge=0, le=MAX_GEAR)
    torsion: float | None = dimension(
        None, of="torsional stiffness", unit="N m/rad", gt=0, le=MAX_STIFFNESS
    )
    damping: float = dimension(
        0.0,
        of="torsional damping",
        unit="N m s/rad",
        ge=0,
        le=MAX_DAMPING,
        source="assumed: without damping",
    )
    bending: float | None = dimension(
        None,
        of="stiffness in bending (E I over the length of a uniform one)",
        unit="N m/rad",
        gt=0,
        le=MAX_STIFFNESS,
        source="assumed: that of the solid steel bar that has the torsional stiffness",
    )
    kind: Literal["shaft", "coupling", "rigid"] = Field(
        default="shaft",
        description="coupling: carries torque alone; rigid: makes its two ends one body",
    )
    spline: SplineData | None = Field(
        default=None, description="spline between two parts of the shaft, as behind a sun"
    )

    _sections = field_validator("sections", mode="before")(rows_of("section", Section))
    _spline = field_validator("spline", mode="wrap")(in_its_field)

    @model_validator(mode="after")
    def _one_size(self) -> Self:
        name = f"shaft {self.name!r}"
        self._check_spline(name)
        if self.kind == "rigid":
            sized = (self.outer, self.torsion, self.bending, self.sections)
            if any(value is not None for value in sized) or self.inner:
                raise InputError(f"{name} is rigid, and has no size or stiffness: remove them")
            return self
        if self.kind == "coupling" and self.bending is not None:
            raise InputError(
                f"{name} is a coupling, which carries torque alone, and has a stiffness in "
                f"bending, {self.bending:g} N m/rad: remove it, or kind: coupling"
            )
        if self.outer is None and self.inner:
            raise InputError(
                f"{name} has an inner diameter, {self.inner:g} m, and no outer one: give it, or "
                "remove the inner one"
            )
        given = [v is not None for v in (self.outer, self.torsion, self.sections)]
        if sum(given) != 1:
            raise InputError(
                f"{name} needs one of outer diameter, torsional stiffness and sections, not "
                f"{'several' if sum(given) else 'none'} of them: give one"
            )
        if self.outer is not None and self.inner >= self.outer:
            raise InputError(
                f"{name}: inner diameter {self.inner:g} m must be below the outer one, "
                f"{self.outer:g} m: lower it"
            )
        self._check_sections(name)
        return self

    def _check_spline(self, name: str) -> None:
        if self.spline is None:
            return
        if self.kind == "coupling":
            raise InputError(
                f"{name} is a coupling, which carries torque alone, and has a spline: remove it, "
                "or kind: coupling"
            )
        length = self.own_length
        if length is not None and self.spline.at > length:
            raise InputError(
                f"{name} has its spline at {self.spline.at:g} m but is {length:g} m long: lower "
                "spline.at"
            )
        if length is not None and self.spline.length > length:
            raise InputError(
                f"{name} has a spline that is {self.spline.length:g} m long but is {length:g} m "
                "long itself: lower spline.length"
            )

    def _check_sections(self, name: str) -> None:
        if self.sections is None:
            return
        if not self.sections:
            raise InputError(f"{name} has an empty list of sections: give at least one")
        whole = fsum(section.length for section in self.sections)
        if self.length is not None and not isclose(self.length, whole, rel_tol=1e-6):
            raise InputError(
                f"{name} is {self.length:g} m long but its sections are {whole:g} m in sum: "
                "correct one of them, or leave the length out"
            )

    @property
    def own_length(self) -> float | None:
        """Length, of its sections where it is not given [m]."""
        if self.sections is None:
            return self.length
        return fsum(section.length for section in self.sections)

    def assumptions(self) -> list[Assumption]:
        """Say what is assumed; the bending of a shaft only where torsion alone is given."""
        of_torsion = {"bending"} if not (self.torsion and self.kind == "shaft") else set()
        rigid = {"damping"} if self.kind == "rigid" else set()
        return [row for row in super().assumptions() if row.name not in of_torsion | rigid]

    @property
    def has_mass(self) -> bool:
        """Whether its mass counts beside the inertias of its bodies."""
        return self.outer is not None or self.sections is not None


class ShaftData(ShaftRow):
    """A shaft of a machine, whose length is known."""

    length: float = dimension(of="length", gt=0, le=LONGEST)


def _catalogue() -> Any:
    return Field(
        default=None,
        description="its rolling bearing, for lives: name in a bearing catalogue, or a page of one",
    )


def _clearance() -> Any:
    return dimension(
        None,
        of="clearance along the contact normal of its rollers, in place of the catalogue's",
        ge=-1e-3,
        le=1e-2,
    )


def _mounting() -> Any:
    return Field(
        default=None,
        description="clearance before mounting, fits and temperatures, in place of a clearance",
    )


def diagonal(stiffness: Six | tuple[Row, ...]) -> tuple[float, ...]:
    """The six stiffnesses, or the diagonal of a matrix."""
    if isinstance(stiffness[0], tuple):
        return tuple(float(row[k]) for k, row in enumerate(stiffness) if isinstance(row, tuple))
    return tuple(float(k) for k in stiffness if not isinstance(k, tuple))


class _Rolling(Part):
    """A bearing whose rollers may be those of a catalogue."""

    name: str
    catalogue: EntryOrPage | None = _catalogue()
    clearance: float | None = _clearance()
    mounting: Mounting | None = _mounting()

    @model_validator(mode="after")
    def _one_clearance(self) -> Self:
        if self.clearance is not None and self.mounting is not None:
            raise InputError(
                f"bearing {self.name!r} has a clearance and a mounting, from which another "
                "follows: leave one out"
            )
        return self


class PinData(_Rolling):
    """A bearing of each planet on its pin."""

    name: str = Field(default="", description="such as upwind")
    offset: float = dimension(
        0.0, of="x from the planet's centre", source="assumed: at the middle of the face"
    )
    stiffness: SixOrMatrix = Field(
        description="axial, radial, tangential, and about them, N/m, N m/rad; or six rows"
    )


class BearingData(_Rolling):
    """A bearing of a shaft or of a carrier, in the housing."""

    name: str = Field(description="name of the bearing")
    holds: str = Field(description="name of the shaft, or of the body such as 'stage 1 carrier'")
    at: float = dimension(
        0.0,
        of="x from where the shaft begins, or from the body's centre",
        source="assumed: at the body's centre; of a shaft it must be given",
    )
    stiffness: SixOrMatrix = Field(
        description="along x, y, z and about them, N/m, N m/rad; or six rows of a matrix"
    )


class Seal(Part):
    """A seal that rubs on a shaft of the gearbox, for losses; labyrinths do not rub."""

    name: str = Field(description="name of the seal")
    shaft: str = Field(description="name of the shaft on which it rubs")
    diameter: float = dimension(of="diameter on which it rubs", gt=0, le=MAX_GEAR)


class Brake(Part):
    """A disc brake."""

    shaft: str = Field(description="name of the shaft of its disc")
    torque: float = dimension(of="torque at full size, on its shaft", unit="N m", gt=0, le=1e9)
    rise: float = dimension(
        0.0,
        of="time that the torque takes to grow",
        unit="s",
        ge=0,
        le=60,
        source="assumed: full torque at once",
    )


Torque = Annotated[float, Field(gt=0, le=1e10)]


class Limits(Part):
    """What a drivetrain must not be loaded beyond."""

    peak_torque: dict[str, Torque] = Field(
        description="largest torque of shafts by their names, at the shaft, N m: at which a torque "
        "limiter slips, or which the gearbox is designed for"
    )


class DampingRatios(Part):
    """Damping of all shafts and of all meshes, over critical damping of each by itself."""

    shafts: float = dimension(0.0, of="damping ratio of shafts", unit="-", ge=0, le=1)
    meshes: float = dimension(0.0, of="damping ratio of meshes", unit="-", ge=0, le=1)


class Operation(Part):
    """Operating range of a drivetrain."""

    rated_power: float | None = dimension(None, of="rated power", unit="W", gt=0, le=1e9)
    rotor_speed: tuple[Speed, Speed] | None = Field(
        default=None, description="least and rated speed of the rotor, rad/s"
    )
    temperature: float | None = dimension(
        None, of="temperature of the oil", unit="degC", ge=-60, le=200
    )
    lubricant: str | None = Field(
        default=None, pattern=r"^VG \d+$", description="viscosity grade, as in VG 320"
    )

    @model_validator(mode="after")
    def _from_least_to_rated(self) -> Self:
        if self.rotor_speed is not None and not self.rotor_speed[0] <= self.rotor_speed[1]:
            raise InputError(
                f"operation: rotor_speed is {list(self.rotor_speed)} rad/s but must be the least "
                "and the rated speed in this order: swap or correct them"
            )
        return self

    @property
    def rated_torque(self) -> float | None:
        """Torque of the rotor at rated power and speed, without losses [N m]."""
        if self.rated_power is None or self.rotor_speed is None:
            return None
        return self.rated_power / self.rotor_speed[1]
