"""A drivetrain's file beyond its main shaft: rotor, gearbox, brake, generator, operation.

`Drivetrain` is what all files have in common; `Scene` has a main shaft with its sections on bearing
units, `LumpedDrivetrain` one that is only known by its size or torsional stiffness.
"""

from __future__ import annotations

from pydantic import Field, field_validator

from fe_drivetrain.drivetrain_file.bearing_unit import Keys
from fe_drivetrain.drivetrain_file.gear_stages import FILE_KINDS, FileStage
from fe_drivetrain.drivetrain_file.turning_parts import (
    BearingData,
    Brake,
    DampingRatios,
    GeneratorBody,
    Limits,
    Operation,
    RotorBody,
    Seal,
    ShaftRow,
)
from fe_drivetrain.drivetrain_file.whirl_data import WhirlData
from fe_drivetrain.geometry.part import in_its_field, rows_of


class Gears(Keys):
    """What is inside a gearbox: stages, the shafts behind the main shaft, and their bearings."""

    stages: tuple[FileStage, ...] = Field(default=(), description="gear stages from the rotor on")
    shafts: tuple[ShaftRow, ...] = Field(
        default=(), description="shafts behind the main shaft, one after each stage"
    )
    bearings: tuple[BearingData, ...] = Field(
        default=(), description="bearings in the housing: of shafts, carriers, suns and gears"
    )
    seals: tuple[Seal, ...] = Field(
        default=(), description="seals that rub on shafts, which the losses count"
    )

    _stages = field_validator("stages", mode="before")(rows_of("stage", FILE_KINDS))
    _shafts = field_validator("shafts", mode="before")(rows_of("shaft", ShaftRow))
    _bearings = field_validator("bearings", mode="before")(rows_of("bearing", BearingData))
    _seals = field_validator("seals", mode="before")(rows_of("seal", Seal))


class Drivetrain(Keys):
    """What all drivetrains have in common: all that turns, from the rotor to the generator.

    What is not stated is not modelled, and a study that needs it says which key is missing.
    """

    title: str = Field(description="what it is, and whose numbers")
    sources: tuple[str, ...] = Field(default=(), description="where the numbers come from")
    assumed: tuple[str, ...] = Field(default=(), description="what no source gives, and why so")
    rotor: RotorBody | None = Field(default=None, description="rotor, at the shaft's front face")
    gearbox: Gears = Gears()
    brake: Brake | None = Field(default=None, description="disc brake")
    generator: GeneratorBody | None = Field(default=None, description="generator's rotor")
    operation: Operation | None = Field(default=None, description="operating range")
    damping: DampingRatios | None = Field(default=None, description="damping of shafts and meshes")
    limits: Limits | None = Field(default=None, description="limits of torques")
    whirl: WhirlData | None = Field(
        default=None, description="unbalance and damping of shafts, bearings over the speed"
    )

    @property
    def states_gears(self) -> bool:
        """Whether something that turns is stated beside the main shaft and the rotor."""
        gears = self.gearbox
        return bool(gears.stages or gears.shafts or self.brake or self.generator)

    def peak_torque(self, shaft: str) -> float | None:
        """Limit of the torque of a shaft, by its name [N m]; None where the file states none."""
        return None if self.limits is None else self.limits.peak_torque.get(shaft)

    _bodies = field_validator(
        "rotor", "generator", "brake", "operation", "damping", "limits", "whirl", mode="wrap"
    )(in_its_field)
