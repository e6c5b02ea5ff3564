"""JSON with a schema: all that turns of a drivetrain as matrices, and its one torsional spring."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from fe_drivetrain.export.formats.superelement_json import Number, Rows
from fe_drivetrain.export.turning import EQUATION, FRAME, UNITS, Turning


class TurningFile(BaseModel):
    """The content: what it is of, names of the degrees of freedom, matrices."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    kind: Literal["turning"] = "turning"
    schema_version: Literal[1] = 1
    program: str
    drivetrain: str = Field(description="title")
    drivetrain_hash: str = Field(description="of all its values, as results state it")
    options: dict[str, str]
    frame: str = FRAME
    units: str = UNITS
    equation: str = EQUATION
    not_in_the_model: str
    degrees_of_freedom: list[str] = Field(description="body and motion, in the order of the rows")
    mass: Rows
    stiffness: Rows
    damping: Rows
    gyroscopic: Rows = Field(description="for a rotor's speed of 1 rad/s")
    one_spring: dict[str, Number] = Field(
        description="spring and damper of aeroelastic programs, on the rotor's side, and what its "
        "frequencies are beside those of the whole"
    )


def write(path: Path, turning: Turning) -> None:
    """Write all matrices; numbers keep every digit."""
    content = TurningFile(
        program=turning.program,
        drivetrain=turning.title,
        drivetrain_hash=turning.hash,
        options=turning.options,
        not_in_the_model=turning.not_here,
        degrees_of_freedom=list(turning.names),
        **{name: matrix.tolist() for name, matrix in turning.matrices.items()},
        one_spring=turning.spring_record(),
    )
    path.write_text(content.model_dump_json(indent=1), encoding="utf-8")
