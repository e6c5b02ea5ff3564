"""JSON with a schema: everything that a superelement is."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeVar

import numpy as np
from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    ValidationError,
    model_validator,
)

from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import fault_sentence, unreadable
from fe_drivetrain.common.regular_files import text_of
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.export.superelement import FRAME, UNITS, Origin, Superelement

Number = Annotated[float, Field(strict=True)]
"""No word, and neither true nor false; that all numbers are finite is said of the whole file."""


def _equally_long(rows: list[list[float]]) -> list[list[float]]:
    for k, row in enumerate(rows):
        if len(row) != len(rows[0]):
            raise ValueError(
                f"row {k + 1} has {len(row)} values but must have {len(rows[0])}, as row 1 has: "
                "write it whole"
            )
    return rows


Rows = Annotated[list[list[Number]], AfterValidator(_equally_long)]
"""A matrix: rows of equal length."""

_SINGULAR = 1e13  # condition of a stiffness with a unit diagonal

_Content = TypeVar("_Content", bound=BaseModel)


class _File(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class OriginFile(_File):
    """Where the matrices come from."""

    scene: str
    scene_hash: str = Field(description="of all values of the scene, as results state it")
    level: str
    mesh: str
    program: str


class BandFile(_File):
    """Half widths of the bands of a stiffness, relative, by kind of motion."""

    axial: Number = Field(description="along x")
    torsion: Number = Field(description="about x")
    bending: Number = Field(description="along and about y and z")


def _form_of_band(stated: Any) -> str:
    return "[by kind]" if isinstance(stated, dict | BandFile) else "float"


# messages leave these marks out of keys, see `reading.fault_sentence`
Band = Annotated[
    Annotated[Number, Tag("float")] | Annotated[BandFile, Tag("[by kind]")],
    Discriminator(_form_of_band),
]
"""By kind of motion, or of earlier files one number for all."""


class SuperelementFile(_File):
    """The content of a superelement's JSON file."""

    kind: Literal["superelement"] = "superelement"
    schema_version: Literal[1, 2, 3] = 3
    name: str
    bound: str = Field(
        default="",
        description="which bound of its bearing units the stiffness is; empty without such units, "
        "as in versions 1 and 2",
    )
    rollers: str = Field(default="", description="whether rollers of bearing units give in it")
    band: Band | None = Field(
        description="uncertainty of the stiffness, of an entry relative to the roots of the "
        "diagonal entries of its row and column; version 1 has one number for all"
    )
    origin: OriginFile
    frame: str = FRAME
    units: str = UNITS
    degrees_of_freedom: tuple[str, ...] = Field(
        default=MOTIONS, description="order of each point's six"
    )
    points: list[str]
    positions: list[tuple[Number, Number, Number]] = Field(description="[m]")
    supported: bool = Field(
        description="whether the supports are in the stiffness; else it is free"
    )
    stiffness: Rows
    compliance: Rows | None = Field(
        default=None, description="motions for unit forces; null where something is free to move"
    )
    mass: Rows | None
    checks: dict[str, float] = Field(description="of the stiffness, with a unit diagonal")

    @model_validator(mode="after")
    def _as_all_are(self) -> Self:
        """Refuse what this form states and does not leave open: nothing here is converted."""
        for key, stated, has in (
            ("frame", self.frame, FRAME),
            ("units", self.units, UNITS),
            ("degrees_of_freedom", self.degrees_of_freedom, MOTIONS),
        ):
            if stated != has:
                raise ValueError(
                    f"{key} is {shown(stated)} but must be {shown(has)}: convert positions and "
                    "matrices, and state this, or leave the key out"
                )
        return self


def content_of(element: Superelement) -> SuperelementFile:
    """A superelement as the content of its file."""
    return SuperelementFile(
        name=element.name,
        points=list(element.points),
        positions=[(float(x), float(y), float(z)) for x, y, z in element.positions],
        supported=element.supported,
        stiffness=element.stiffness.tolist(),
        compliance=_compliance(element),
        mass=None if element.mass is None else element.mass.tolist(),
        band=None if element.band is None else BandFile(**vars(element.band)),
        checks=element.checks(),
        origin=OriginFile(**vars(element.origin)),
        bound=element.bound,
        rollers=element.rollers,
    )


def element_of(content: SuperelementFile) -> Superelement:
    """The superelement in such a content.

    Raises
    ------
    InputError
        Its values are those of no superelement.
    """
    return Superelement(
        content.name,
        tuple(content.points),
        np.array(content.positions),
        np.array(content.stiffness),
        None if content.mass is None else np.array(content.mass),
        content.supported,
        _band(content.band),
        Origin(**content.origin.model_dump()),
        content.bound,
        content.rollers,
    )


def _band(stated: float | BandFile | None) -> StiffnessBands | None:
    if isinstance(stated, BandFile):
        return StiffnessBands(**stated.model_dump())
    return None if stated is None else StiffnessBands.uniform(stated)


def write(path: Path, element: Superelement) -> None:
    """Write one superelement; numbers keep every digit."""
    path.write_text(content_of(element).model_dump_json(indent=1), encoding="utf-8")


def read(path: Path) -> Superelement:
    """Read one superelement.

    Raises
    ------
    InputError
        The file is no JSON, or not of this schema.
    """
    content = read_content(path, SuperelementFile, "superelement in JSON")
    try:
        return element_of(content)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def read_content(path: Path, kind: type[_Content], what: str) -> _Content:
    """Read and validate a JSON file of one kind.

    Raises
    ------
    InputError
        The file cannot be read, is no JSON, or not of that kind; the message says what is wrong in
        it first.
    """
    try:
        text = text_of(path)
    except (OSError, ValueError) as error:
        raise unreadable(path, what, error) from error
    try:
        return kind.model_validate_json(text)
    except ValidationError as error:
        first = error.errors(include_input=False)[0]
        is_json = first["type"] != "json_invalid"
        fault = fault_sentence(error, kind) if is_json else f"{first['msg']}: write it again, whole"
        raise InputError(f"{path} is no {what}: {fault}") from error


def _compliance(element: Superelement) -> list[list[float]] | None:
    if (
        not element.supported
        or np.linalg.cond(scaled_to_unit_diagonal(element.stiffness)) > _SINGULAR
    ):
        return None
    inverse = np.linalg.inv(element.stiffness)
    return (0.5 * (inverse + inverse.T)).tolist()  # type: ignore[no-any-return]
