"""Parts of a machine: bodies, shafts and bearings, in their ranges."""

from math import pi
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.geometry.part import MINIMUM, Assumption, Part, dimension
from fe_drivetrain.shafts.beam.frame import CrossSection, round_section

STEEL = Material(youngs_modulus=2.06e11, poisson_ratio=0.3, density=7850.0)
"""Steel of shafts, where nothing else is given."""

#: What no machine's inertia [kg m^2], mass [kg], stiffness [N/m, N m/rad] or damping is beyond.
MAX_INERTIA, MAX_MASS, MAX_STIFFNESS, MAX_DAMPING = 1e10, 1e7, 1e20, 1e12
#: Minimum inertia [kg m^2]: where a table has none, a body may turn with so little.
MIN_INERTIA = 1e-9
#: What no shaft is longer than, no centre distance, face or diameter larger than [m].
LONGEST, MAX_GEAR = 100.0, 20.0

Teeth = Annotated[int, Field(ge=5, le=5000)]
Radius = Annotated[float, Field(ge=MINIMUM, le=MAX_GEAR)]
Stiffness = Annotated[float, Field(ge=0, le=MAX_STIFFNESS)]
Six = tuple[Stiffness, Stiffness, Stiffness, Stiffness, Stiffness, Stiffness]
"""Along and about three axes [N/m, N m/rad]."""


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


class ShaftData(Part):
    """A round shaft from one stage to the next; a solid one by its torsional stiffness, or by size.

    One given by its stiffness alone has no mass: the inertias of its table include it.
    """

    name: str = Field(description="name of the shaft")
    length: float = dimension(of="length", gt=0, le=LONGEST)
    outer: float | None = dimension(None, of="outer diameter", gt=0, le=MAX_GEAR)
    inner: float = dimension(0.0, of="inner diameter", ge=0, le=MAX_GEAR)
    torsion: float | None = dimension(
        None, of="torsional stiffness", unit="N m/rad", gt=0, le=MAX_STIFFNESS
    )
    bending: float | None = dimension(
        None,
        of="stiffness of the hinge at its middle in bending",
        unit="N m/rad",
        gt=0,
        le=MAX_STIFFNESS,
        source="assumed: that of the solid steel bar that has the torsional stiffness",
    )
    kind: Literal["shaft", "coupling", "rigid"] = Field(
        default="shaft",
        description="coupling: carries torque alone; rigid: makes its two ends one body",
    )

    @model_validator(mode="after")
    def _one_size(self) -> Self:
        if self.kind == "rigid":
            if (self.outer, self.torsion, self.bending) != (None, None, None) or self.inner:
                raise InputError(
                    f"shaft {self.name!r} is rigid, and has no diameter or stiffness: remove them"
                )
            return self
        if self.kind == "coupling" and self.bending is not None:
            raise InputError(
                f"shaft {self.name!r} is a coupling, which carries torque alone, and has a "
                f"stiffness in bending, {self.bending:g} N m/rad: remove it, or kind: coupling"
            )
        if self.outer is None and self.inner:
            raise InputError(
                f"shaft {self.name!r} is given by its torsional stiffness, so that its inner "
                f"diameter, {self.inner:g} m, has no meaning: remove it, or give the outer one"
            )
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

    def assumptions(self) -> list[Assumption]:
        """Say what is assumed; the bending of a shaft only where torsion alone is given."""
        return super().assumptions() if self.torsion and self.kind == "shaft" else []

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
    offset: float = dimension(
        0.0, of="x from the planet's centre", source="assumed: at the middle of the face"
    )
    stiffness: Six = Field(description="axial, radial, tangential, and about them, N/m, N m/rad")


class BearingData(Part):
    """A bearing of a shaft or of a carrier, in the housing."""

    name: str = Field(description="name of the bearing")
    holds: str = Field(description="name of the shaft, or of the body such as 'stage 1 carrier'")
    at: float = dimension(
        0.0,
        of="x from where the shaft begins, or from the body's centre",
        source="assumed: at the body's centre; of a shaft it must be given",
    )
    stiffness: Six = Field(description="along x, y, z and about them, N/m, N m/rad")
