"""Linear elastic, isotropic materials."""

from collections.abc import Mapping
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, field_validator

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.strict_yaml import no_truth_value, shown

MAX_POISSON_RATIO = 0.499999
"""Nearer to 1/2 lambda swamps mu, and stiffnesses lose digits without a word
(``cases/stability/volumetric_locking.py``); and here already they are those of 1/2."""


MIN_DENSITY = 50.0
"""Of anything that carries a load [kg/m^3]; lower ones are in t/m^3 or g/cm^3."""


class Material(BaseModel):
    """A linear elastic, isotropic material."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    _truth = field_validator("*", mode="before")(no_truth_value)

    youngs_modulus: Annotated[
        float, Field(ge=1e6, le=1e13, description="modulus E [Pa], as in 2.1e11 for steel")
    ]
    poisson_ratio: Annotated[
        float, Field(gt=-1, le=MAX_POISSON_RATIO, description="Poisson's ratio nu [-]")
    ]
    density: Annotated[float, Field(ge=0, le=1e5, description="density rho [kg/m^3]")]
    thermal_expansion: Annotated[
        float | None,
        Field(
            gt=0, le=1e-3, description="coefficient of thermal expansion [1/K], for temperatures"
        ),
    ] = None

    @field_validator("density")
    @classmethod
    def _in_si_units(cls, density: float) -> float:
        if 0 < density < MIN_DENSITY:
            raise ValueError(
                f"must be 0 (no mass), or from {MIN_DENSITY:g} to 1e5 kg/m^3: "
                f"{1000 * density:g} if it is in t/m^3 or g/cm^3"
            )
        return density

    def expansion(self, of: str) -> float:
        """Coefficient of thermal expansion [1/K].

        Parameters
        ----------
        of : str
            What is made of it, for the message.

        Raises
        ------
        InputError
            It has none.
        """
        if self.thermal_expansion is None:
            raise InputError(
                f"{of} has a temperature, but its material no thermal_expansion: add it to the "
                "material, in 1/K, as 12e-6 for steel"
            )
        return self.thermal_expansion

    @property
    def shear_modulus(self) -> float:
        """G = E / (2 (1 + nu)) [Pa]."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))

    @property
    def lame(self) -> tuple[float, float]:
        """Lame's constants (lambda, mu) [Pa]."""
        nu = self.poisson_ratio
        return (
            self.youngs_modulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            self.shear_modulus,
        )


#: The materials that a scene can name without defining them. Ductile iron: EN-GJS-400-15,
#: EN 1563:2018, Annex (informative) on physical properties. Thermal expansion of steel: EN
#: 1993-1-1, 3.2.6; of both from memory.
MATERIALS: dict[str, Material] = {
    "steel": Material(
        youngs_modulus=200e9, poisson_ratio=0.3, density=7850.0, thermal_expansion=12e-6
    ),
    "ductile_iron": Material(
        youngs_modulus=169e9, poisson_ratio=0.275, density=7100.0, thermal_expansion=12.5e-6
    ),
}


def known_materials(defined: Mapping[str, Material]) -> dict[str, Material]:
    """Materials by name: those of the program, and those that a scene defines, which go first."""
    return {**MATERIALS, **defined}


def check_material(name: str, defined: Mapping[str, Material], of: str = "") -> None:
    """Refuse a material that neither the program nor a scene has.

    Parameters
    ----------
    name : str
        Name of the material.
    defined : mapping
        Those that the scene defines.
    of : str
        The part, where there are several, as in " of shaft".

    Raises
    ------
    ValueError
    """
    known = known_materials(defined)
    if name not in known:
        raise ValueError(
            f"material {shown(name)}{of} is unknown: use one of {', '.join(known)}, or define it "
            "under 'materials'"
        )
