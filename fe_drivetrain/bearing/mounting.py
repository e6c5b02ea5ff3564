"""How a rolling bearing is mounted, as given: fits, clearance class, temperatures and preload."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    ValidationInfo,
    field_validator,
    model_validator,
)

from fe_drivetrain.bearing.tolerances import ClearanceClass, Limits, class_parts
from fe_drivetrain.common.strict_yaml import no_truth_value

Deviation = Annotated[float, Field(ge=-5e-3, le=5e-3)]
Class = Annotated[str, Field(min_length=2, max_length=3)]
Temperature = Annotated[float, Field(ge=-60, le=250)]

INITIAL = ("clearance_class", "internal_clearance", "mounted_clearance", "preload")
"""What the clearance may begin with: one of these."""


class _Keys(BaseModel):
    """A mapping of known keys, without truth values."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    _truth = field_validator("*", mode="before")(no_truth_value)


class Fit(_Keys):
    """Fits of both rings: ISO 286 classes, or deviations from the nominal diameters."""

    shaft: Class | tuple[Deviation, Deviation] | None = Field(
        default=None,
        description="tolerance class of the seat, as m6, or its least and most deviation [m]",
    )
    housing: Class | tuple[Deviation, Deviation] | None = Field(
        default=None,
        description="tolerance class of the bore, as H7, or its least and most deviation [m]",
    )
    bore: tuple[Deviation, Deviation] | None = Field(
        default=None,
        description="least and most deviation of the bearing's bore [m]; ISO 492 Normal otherwise",
    )
    outside: tuple[Deviation, Deviation] | None = Field(
        default=None,
        description="least and most deviation of its outside [m]; ISO 492 Normal otherwise",
    )
    smoothing: Literal["ground", "machined", "none"] = Field(
        default="ground",
        description="surface of the seats: what is left of an interference is d/(d+2) of it on "
        "ground ones, d/(d+3) on machined ones, d in mm",
    )
    outside_diameter: float | None = Field(
        default=None,
        gt=0,
        le=10,
        description="outside diameter D of the bearing [m]; left out, both rings have walls of "
        "the same thickness",
    )
    shaft_bore: float | None = Field(
        default=None, ge=0, le=10, description="bore of the shaft [m]; left out, the shaft's own"
    )
    housing_diameter: float | None = Field(
        default=None,
        gt=0,
        le=20,
        description="outside of a housing as a ring [m]; left out, the shell of a pillow block, or "
        "thick",
    )

    @field_validator("shaft", "housing", "bore", "outside")
    @classmethod
    def _known(cls, value: object, info: ValidationInfo) -> object:
        if isinstance(value, str):
            class_parts(value, "shaft" if info.field_name == "shaft" else "housing")
        if isinstance(value, tuple) and value[0] > value[1]:
            raise ValueError(f"{list(value)} must be the least and the most, in this order")
        return value


class Temperatures(_Keys):
    """Temperatures of operation [degC], each part of one."""

    mounting: Temperature = Field(default=20.0, description="when it was mounted [degC]")
    shaft: Temperature | None = Field(default=None, description="left out, as its ring [degC]")
    inner_ring: Temperature = Field(description="inner ring [degC]")
    rollers: Temperature | None = Field(
        default=None, description="left out, the mean of both rings [degC]"
    )
    outer_ring: Temperature = Field(description="outer ring [degC]")
    housing: Temperature | None = Field(default=None, description="left out, as its ring [degC]")


class Mounting(_Keys):
    """How a rolling bearing is mounted, from which its operating clearance follows."""

    clearance_class: ClearanceClass | None = Field(
        default=None, description="ISO 5753-1 class of radial internal clearance before mounting"
    )
    internal_clearance: tuple[float, float] | None = Field(
        default=None, description="least and most radial internal clearance before mounting [m]"
    )
    mounted_clearance: tuple[float, float] | None = Field(
        default=None, description="least and most radial clearance as measured when mounted [m]"
    )
    preload: tuple[float, float] | None = Field(
        default=None, description="least and most axial preload when mounted [N]"
    )
    fit: Fit | None = Field(default=None, description="fits of both rings")
    temperatures: Temperatures | None = Field(
        default=None, description="temperatures of operation; without them all is as mounted"
    )
    speed: float | None = Field(
        default=None,
        ge=0,
        le=1e5,
        description="speed of the inner ring [rad/s], of its hoop growth; 0 otherwise",
    )

    @model_validator(mode="after")
    def _one_beginning(self) -> Self:
        given = [name for name in INITIAL if getattr(self, name) is not None]
        if len(given) != 1:
            raise ValueError(
                f"mounting has {' and '.join(given) or 'no clearance'} but needs one of "
                f"{', '.join(INITIAL)}: the clearance begins with it"
            )
        for name in INITIAL[1:]:
            value = getattr(self, name)
            if value is not None and value[0] > value[1]:
                raise ValueError(f"{name} {list(value)} must be the least and the most")
        for name in INITIAL[1:3]:
            value = getattr(self, name)
            if value is not None and max(map(abs, value)) > 5e-3:
                raise ValueError(
                    f"{name} {list(value)} must be from -0.005 to 0.005 m: give it in m"
                )
        if self.preload is not None and not 0.0 <= self.preload[0] <= self.preload[1] <= 1e8:
            raise ValueError(f"preload {list(self.preload)} must be from 0 to 1e8 N")
        return self

    @property
    def is_mounted(self) -> bool:
        """Whether the clearance is that of the mounted bearing, its fits in it."""
        return self.mounted_clearance is not None or self.preload is not None

    @property
    def beginning(self) -> Limits | None:
        """Radial clearance that it begins with, where it is given in m."""
        given = self.internal_clearance or self.mounted_clearance
        return None if given is None else Limits(*given)
