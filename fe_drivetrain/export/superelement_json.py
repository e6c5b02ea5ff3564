"""JSON with a schema: everything that a superelement is."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from fe_drivetrain.errors import InputError
from fe_drivetrain.superelement import FRAME, FREEDOMS, UNITS, Origin, Superelement


class _File(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class OriginFile(_File):
    """Where the matrices come from."""

    scene: str
    scene_hash: str = Field(description="SHA-256 of the scene's values")
    level: str
    mesh: str
    program: str


class SuperelementFile(_File):
    """The content of a superelement's JSON file."""

    kind: Literal["superelement"] = "superelement"
    schema_version: Literal[1] = 1
    name: str
    frame: str = FRAME
    units: str = UNITS
    freedoms: tuple[str, ...] = Field(default=FREEDOMS, description="order of each point's six")
    points: list[str]
    positions: list[tuple[float, float, float]] = Field(description="[m]")
    supported: bool = Field(
        description="whether the supports are in the stiffness; else it is free"
    )
    stiffness: list[list[float]]
    mass: list[list[float]] | None
    band: float | None = Field(description="uncertainty of the stiffness, relative")
    checks: dict[str, float] = Field(description="of the stiffness, with a unit diagonal")
    origin: OriginFile


def write(path: Path, element: Superelement) -> None:
    """Write one superelement; numbers keep every digit."""
    content = SuperelementFile(
        name=element.name,
        points=list(element.points),
        positions=[(float(x), float(y), float(z)) for x, y, z in element.positions],
        supported=element.supported,
        stiffness=element.stiffness.tolist(),
        mass=None if element.mass is None else element.mass.tolist(),
        band=element.band,
        checks=element.checks(),
        origin=OriginFile(**vars(element.origin)),
    )
    path.write_text(content.model_dump_json(indent=1), encoding="utf-8")


def read(path: Path) -> Superelement:
    """Read one superelement.

    Raises
    ------
    InputError
        The file is no JSON, or not of this schema.
    """
    try:
        found = SuperelementFile.model_validate_json(path.read_text(encoding="utf-8"))
    except (ValidationError, UnicodeDecodeError) as error:
        reason = (
            f"{'.'.join(map(str, error.errors()[0]['loc'])) or 'the file'}: "
            f"{error.errors()[0]['msg']}"
            if isinstance(error, ValidationError)
            else "it is not text"
        )
        raise InputError(f"{path} is no superelement in JSON: {reason}") from error
    return Superelement(
        found.name,
        tuple(found.points),
        np.array(found.positions),
        np.array(found.stiffness),
        None if found.mass is None else np.array(found.mass),
        found.supported,
        found.band,
        Origin(**found.origin.model_dump()),
    )
