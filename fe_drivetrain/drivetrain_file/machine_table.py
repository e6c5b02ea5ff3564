"""Rows of a machine: stages and shafts from the rotor to the generator, complete.

Whether they fit each other is the gate's (`machine_gate`). The axis of the first shaft is x; each
stage stands where its driving shaft ends, and a parallel one moves the axis of what follows by its
centre distance.
"""

from math import cos, radians
from typing import Self

from pydantic import Field, field_validator, model_validator

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.gear_stages import (
    KINDS,
    ParallelData,
    PlanetaryData,
    StageData,
)
from fe_drivetrain.drivetrain_file.turning_parts import (
    BearingData,
    GeneratorBody,
    RotorBody,
    ShaftData,
)
from fe_drivetrain.geometry.part import Assumption, Part, assumed_in, in_its_field, rows_of


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
    not_given: tuple[str, ...] = Field(
        default=(), description="keys that are missing, so that its bodies only turn"
    )

    __repr__ = short_repr
    __str__ = short_repr

    _ends = field_validator("rotor", "generator", mode="wrap")(in_its_field)
    _shafts = field_validator("shafts", mode="before")(rows_of("shaft", ShaftData))
    _stages = field_validator("stages", mode="before")(rows_of("stage", KINDS))
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
        splines = [(f"shaft {shaft.name} spline", shaft.spline) for shaft in self.shafts]
        named += [(name, spline) for name, spline in splines if spline is not None]
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
