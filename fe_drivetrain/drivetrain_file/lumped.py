"""A drivetrain whose main shaft is only known by its diameter or torsional stiffness."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import field_validator, model_validator

from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.scene import Spread, check_spreads
from fe_drivetrain.drivetrain_file.turning_gate import check_turning
from fe_drivetrain.drivetrain_file.turning_parts import ShaftRow
from fe_drivetrain.geometry.part import in_its_field
from fe_drivetrain.geometry.shaft import MAIN_SHAFT


class LumpedDrivetrain(Drivetrain):
    """A drivetrain whose main shaft is one diameter or one torsional stiffness.

    It has modes, gears and transients; what needs a main shaft with sections needs a `Scene`.
    """

    shaft: ShaftRow
    uncertainty: Mapping[str, Spread] = {}

    @field_validator("shaft", mode="wrap")
    @classmethod
    def _named(cls, value: Any, handler: Any, info: Any) -> Any:
        if isinstance(value, dict):
            value = {"name": MAIN_SHAFT, **value}
        return in_its_field(value, handler, info)

    @model_validator(mode="after")
    def _sound(self) -> LumpedDrivetrain:
        check_spreads(self, self.uncertainty)
        check_turning(self, self.shaft)
        return self

    def __repr__(self) -> str:
        """One line: the title, and the stages."""
        return f"<LumpedDrivetrain {self.title!r}: {len(self.gearbox.stages)} stages>"

    __str__ = __repr__
