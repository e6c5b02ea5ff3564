"""Stiffness out, for other models; JSON with its frame, reference point and units."""

from collections.abc import Mapping
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.common.scaling import min_eigenvalue
from fe_drivetrain.export.formats.superelement_json import Rows, read_content
from fe_drivetrain.export.superelement import FRAME


class StiffnessMatrix(BaseModel):
    """A 6x6 stiffness at a reference point, in SI units."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    name: str
    reference_point: tuple[float, float, float] = Field(description="[m], in the frame")
    degrees_of_freedom: tuple[str, ...] = MOTIONS
    units: Literal["N/m, N, N m/rad"] = "N/m, N, N m/rad"
    matrix: Rows
    description: str

    @model_validator(mode="after")
    def _symmetric_and_stable(self) -> "StiffnessMatrix":
        k = np.array(self.matrix)
        if k.shape != (6, 6) or not np.isfinite(k).all():
            raise ValueError(f"stiffness {self.name!r} must be 6x6 and finite")
        size = np.abs(k).max()
        if np.abs(k - k.T).max() > 1e-9 * size:
            raise ValueError(f"stiffness {self.name!r} is not symmetric")
        # Translations and rotations differ in unit: judge definiteness with a unit diagonal.
        if min_eigenvalue(k) < -1e-9:
            raise ValueError(f"stiffness {self.name!r} is not positive semidefinite")
        return self


class StiffnessFile(BaseModel):
    """The content of a stiffness.json."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    schema_version: Literal[1] = 1
    scene: str
    frame: str = FRAME
    matrices: list[StiffnessMatrix]
    tilt_stiffness: dict[str, dict[str, float]] = Field(
        default={}, description="K_R [N m/rad] by plane and estimator"
    )
    unknowns: int = Field(description="of the finite-element model it was condensed from")


def stiffness_matrix(
    name: str, matrix: Floats, reference_point: Floats, description: str
) -> StiffnessMatrix:
    """A checked `StiffnessMatrix` from arrays."""
    x, y, z = (float(v) for v in reference_point)
    return StiffnessMatrix(
        name=name,
        reference_point=(x, y, z),
        matrix=np.asarray(matrix).tolist(),
        description=description,
    )


def write_stiffness_json(
    path: str | Path,
    scene: str,
    matrices: list[StiffnessMatrix],
    unknowns: int,
    tilt_stiffness: Mapping[str, Mapping[str, float]] | None = None,
) -> None:
    """Write a stiffness.json."""
    content = StiffnessFile(
        scene=scene,
        matrices=matrices,
        tilt_stiffness={plane: dict(k) for plane, k in (tilt_stiffness or {}).items()},
        unknowns=unknowns,
    )
    with atomic_path(Path(path)) as unfinished:
        unfinished.write_text(content.model_dump_json(indent=1), encoding="utf-8")


def read_stiffness_json(path: str | Path) -> StiffnessFile:
    """Read and validate a stiffness.json."""
    return read_content(Path(path), StiffnessFile, "stiffness.json")
