"""A shaft with fixed-interface modes as JSON: a flexible body as multibody programs reduce it."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.export.craig_bampton import CraigBampton
from fe_drivetrain.export.formats.superelement_json import (
    Number,
    Rows,
    SuperelementFile,
    content_of,
    element_of,
    read_content,
)


class CraigBamptonFile(BaseModel):
    """The content: points as a superelement (Guyan), and modes that have unit mass."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    kind: Literal["Craig-Bampton"] = "Craig-Bampton"
    schema_version: Literal[1] = 1
    points: SuperelementFile
    omega: list[Number] = Field(description="circular frequencies, all points held [rad/s]")
    coupling: Rows = Field(
        description="mass between degrees of freedom of points (rows) and modes (columns); none "
        "in stiffness"
    )


def write_craig_bampton(path: str | Path, body: CraigBampton) -> None:
    """Write a body and its modes; the file appears whole or not at all."""
    content = CraigBamptonFile(
        points=content_of(body.superelement),
        omega=body.omega.tolist(),
        coupling=body.coupling.tolist(),
    )
    with atomic_path(Path(path)) as unfinished:
        unfinished.write_text(content.model_dump_json(indent=1), encoding="utf-8")


def read_craig_bampton(path: str | Path) -> CraigBampton:
    """Read a body and its modes back.

    Raises
    ------
    InputError
        The file is not of this schema, or its shapes do not fit together.
    """
    content = read_content(Path(path), CraigBamptonFile, "Craig-Bampton body in JSON")
    points = element_of(content.points)
    coupling = np.reshape(content.coupling, (len(content.coupling), -1))
    if points.mass is None or coupling.shape != (len(points.stiffness), len(content.omega)):
        raise InputError(
            f"{path}: coupling has the shape {coupling.shape} but must have a row for each of "
            f"{len(points.stiffness)} degrees of freedom and a column for each of "
            f"{len(content.omega)} modes, and points need a mass"
        )
    return CraigBampton(
        points.points,
        points.positions,
        points.stiffness,
        points.mass,
        np.array(content.omega),
        coupling,
        points.origin,
    )
