"""A project file: what a team decided in each of the six steps, and which evidence it rests on.

The file is YAML; its schema is `project_schema`. A step that is left out was not taken.
"""

from __future__ import annotations

import json
from importlib.resources import files as package_files
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, field_validator, model_validator

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import parse_mapping, read_text, validated
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.strict_yaml import no_truth_value
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.procedure.channels import ChannelFile

PROJECT_SCHEMA_FILE = "project.schema.json"
"""Name under which the schema stands beside a project, and in the documentation."""

Share = Annotated[float, Field(gt=0.0, le=1.0)]
Number = Annotated[float, Field(allow_inf_nan=False)]
Name = Annotated[str, Field(min_length=1)]
Accepted = Literal["quick", "other version"]


class _Part(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class EvidenceLink(_Part):
    """A case whose results a decision rests on."""

    case: Annotated[str, Field(pattern=r"^[^/\s.][^/\s]*/[^/\s.][^/\s]*$")] = Field(
        description="GROUP/NAME below the folder of reports, as in procedure/gaps or advise/mine"
    )
    check: str = Field(default="", description="one of its checks, by name; empty: all of them")
    quantity: str = Field(
        default="", description="value among its answers or checks that answers the load"
    )
    unit: str = Field(default="", description="of quantity and limit, as the results have it")
    at_most: Number | None = Field(default=None, description="limit of the quantity, as a capacity")
    at_least: Number | None = Field(default=None, description="limit of the quantity, as a margin")
    limit_from: str = Field(default="", description="where the limit comes from")

    @model_validator(mode="after")
    def _limit_of_a_quantity(self) -> Self:
        bounded = self.at_most is not None or self.at_least is not None
        if (bounded or self.unit or self.limit_from) and not self.quantity:
            raise InputError(
                f"evidence {self.case} has a limit and no quantity: name the value of its results "
                "that is held against it under quantity"
            )
        if self.quantity and self.check:
            raise InputError(
                f"evidence {self.case} has a check and a quantity: link them one by one"
            )
        return self


class _Step(_Part):
    decision: Name = Field(description="what came of the step, or why it is taken again")
    evidence: tuple[EvidenceLink, ...] = Field(default=(), description="what that rests on")


class CriticalLoad(_Part):
    """A design load that is critical for this drivetrain."""

    load: Name = Field(description="name of a design load of the catalogue")
    variables: tuple[Name, ...] = Field(
        default=(), description="critical design variables; those of the catalogue where left out"
    )


class Gap(_Part):
    """A design load that no load case covers: what is run in its place, or why nothing is."""

    load: Name = Field(description="name of a design load that load cases do not cover")
    dismissed: str = Field(default="", description="why it does not matter for this drivetrain")
    evidence: tuple[EvidenceLink, ...] = Field(default=(), description="what was run in its place")


class FailureModes(_Step):
    """Step 1."""

    critical: tuple[CriticalLoad, ...] = Field(description="design loads that matter here")
    gaps: tuple[Gap, ...] = Field(
        default=(), description="each design load of the systems that load cases do not cover"
    )


class Need(_Part):
    """A quantity that the model must give, and how well."""

    quantity: Name = Field(description="as the ladder or the adviser calls it")
    tolerance: Share = Field(description="allowed error, 0.05 of 5 %")


class ModelChoice(_Step):
    """Step 2."""

    drivetrain: Name = Field(description="drivetrain file, or a drivetrain of the library")
    level: Name = Field(description="level of the ladder by its name or number")
    needs: tuple[Need, ...] = Field(description="quantities that decide the level")

    @field_validator("level", mode="before")
    @classmethod
    def _by_number(cls, value: Any) -> Any:
        return str(value) if isinstance(value, int) and not isinstance(value, bool) else value

    @model_validator(mode="before")
    @classmethod
    def _by_one_key(cls, data: Any) -> Any:
        for old in ("scene", "machine"):
            if isinstance(data, dict) and old in data:
                raise InputError(
                    f"model.{old} is {data[old]!r} but a project names its drivetrain, of whatever "
                    f"kind, by one key: write drivetrain in place of {old}"
                )
        return data


class CaseOfLoad(_Part):
    """A load case: its number means nothing without standard and edition."""

    standard: Name = Field(description="as in IEC 61400-1, or 'own' of a case of one's own")
    edition: Name = Field(description="edition or year")
    number: Name = Field(description="as in '1.2'")
    loads: tuple[Name, ...] = Field(description="critical design loads that it brings about")
    evidence: tuple[EvidenceLink, ...] = Field(default=(), description="where it was run")


class LoadCases(_Step):
    """Step 3."""

    cases: tuple[CaseOfLoad, ...] = Field(description="load cases that are run")


KnownBy = Literal[
    "weighing",
    "measurement",
    "drawing",
    "data sheet",
    "calculation",
    "standard",
    "publication",
    "assumption",
]


class InputValue(_Part):
    """An input of the model."""

    name: Name = Field(description="as in 'stiffness of shafts'")
    value: Number | None = Field(default=None, description="what the model has")
    unit: str = Field(default="", description="of the value, as in 'N m/rad'")
    band: Share | None = Field(
        default=None, description="half width of what it may be, as a share; left out: not known"
    )
    known_by: KnownBy | None = Field(
        default=None, description="how the value is known; an assumption does not count"
    )
    source: Name = Field(description="where the value comes from: document, page, date")
    measured_by: str = Field(default="", description="signal of the campaign that determines it")


class Waived(_Part):
    """An input of Table 4.7 that the project does without."""

    name: Name = Field(description="as Table 4.7 has it")
    reason: Name = Field(description="why the project does without it")


class Inputs(_Step):
    """Step 4."""

    values: tuple[InputValue, ...] = Field(description="inputs of the model")
    waived: tuple[Waived, ...] = Field(
        default=(), description="inputs of Table 4.7 that are not among the values, and why"
    )


class Signal(_Part):
    """What is recorded."""

    name: Name = Field(description="as in 'torque of the low-speed shaft'")
    interface: Name = Field(description="where: hub, gearbox entrance, ...")
    rate: Annotated[float, Field(gt=0.0)] = Field(description="sampling rate [Hz]")
    highest: Annotated[float, Field(gt=0.0)] = Field(description="highest frequency wanted [Hz]")
    accuracy: Share = Field(description="half width of its error, as a share of full scale")


class Capture(_Part):
    """How many windows of ten minutes each wind must have, and the files that count."""

    files: ChannelFile = Field(description="with a channel 'wind speed'")
    winds: tuple[float, float] = Field(description="lowest and highest mean wind [m/s]")
    target: Annotated[int, Field(ge=1)] = Field(description="windows for each 1 m/s")

    @field_validator("winds")
    @classmethod
    def _rising(cls, value: tuple[float, float]) -> tuple[float, float]:
        if not 0.0 < value[0] < value[1]:
            raise InputError(f"winds {list(value)} must rise, from above 0: give [lowest, highest]")
        return value


class Campaign(_Step):
    """Step 5."""

    signals: tuple[Signal, ...] = Field(description="what is recorded")
    capture: Capture | None = Field(default=None, description="capture matrix and its target")


Statistic = Literal["mean", "standard deviation", "least", "largest", "equivalent load"]


class Compared(_Part):
    """A statistic of one channel, measured against computed."""

    channel: Name = Field(description="of both files")
    statistic: Statistic = Field(description="what is compared")
    slope: Annotated[float, Field(ge=1.0, le=20.0)] = Field(
        default=4.0, description="of the equivalent load"
    )
    tolerance: Share = Field(description="allowed difference over the measured value")


class Identified(_Part):
    """Stiffness and damping of a shaft from its measured torque and the angles of its ends."""

    torque: Name = Field(description="channel of the torque")
    front: Name = Field(description="channel of the front end's angle")
    rear: Name = Field(description="channel of the rear end's angle")
    ratio: float = Field(default=1.0, description="speed of the rear end over that of the front")
    band: tuple[float, float] = Field(description="frequencies that are used [Hz]")
    stiffness: Annotated[float, Field(gt=0.0)] = Field(description="the model's [N m/rad]")
    damping: Annotated[float, Field(gt=0.0)] | None = Field(
        default=None, description="the model's [N m s/rad]"
    )
    tolerance: Share = Field(description="allowed difference over the identified value")
    turn: Annotated[float, Field(gt=0.0)] | None = Field(
        default=None,
        description="mean time of a turn of the rotor [s]: with it, what methods A to C give",
    )
    stop: Annotated[float, Field(ge=0.0)] | None = Field(
        default=None,
        description="when the torque was lost, from the first sample [s]: the damping is held "
        "against the decrement, too",
    )
    stiffness_of: str = Field(default="", description="input of step 4 that the stiffness is")
    damping_of: str = Field(default="", description="input of step 4 that the damping is")


class Comparison(_Step):
    """Step 6."""

    measured: ChannelFile = Field(description="measured channels, or virtual measurements")
    computed: ChannelFile | None = Field(default=None, description="channels of the model")
    quantities: tuple[Compared, ...] = Field(default=(), description="statistics compared")
    identified: tuple[Identified, ...] = Field(default=(), description="what signals determine")

    @model_validator(mode="after")
    def _has_both(self) -> Self:
        if self.quantities and self.computed is None:
            raise InputError("comparison has quantities and no computed channels: add computed")
        return self


class Signature(_Part):
    """Who stands for the project, and for what of it."""

    name: Name = Field(description="who signs")
    role: str = Field(default="", description="as in 'loads'")
    date: Name = Field(description="as in 2026-11-23")
    digest: Annotated[str, Field(pattern=r"^[0-9a-f]{16}$")] = Field(
        description="of what is signed: the report of a complete project states it"
    )


class Project(_Part):
    """The six steps of one drivetrain."""

    subject: Name = Field(description="as in 'drivetrain of turbine 12'")
    systems: Annotated[tuple[Name, ...], Field(min_length=1)] = Field(
        description="systems of the catalogue that are validated: gearbox, drivetrain, pitch, yaw"
    )
    reports: str = Field(
        default="reports", description="folder of results of cases, relative to this file"
    )
    catalogue: str = Field(
        default="", description="file of design loads; those of PROTEST 2010 where left out"
    )
    accept: tuple[Accepted, ...] = Field(
        default=(),
        description="evidence that counts although it is of a quick run, or of another version of "
        "the program; it is named in any case",
    )
    failure_modes: FailureModes | None = None
    model: ModelChoice | None = None
    load_cases: LoadCases | None = None
    inputs: Inputs | None = None
    campaign: Campaign | None = None
    comparison: Comparison | None = None
    signed: tuple[Signature, ...] = Field(default=(), description="signatures, when it is complete")

    __repr__ = short_repr
    __str__ = short_repr

    @field_validator("subject", mode="before")
    @classmethod
    def _no_truth(cls, value: Any) -> Any:
        return no_truth_value(value)

    @property
    def steps(self) -> tuple[_Step | None, ...]:
        """The six, None of one that was not begun."""
        return tuple(getattr(self, key) for key in SECTIONS)


SECTIONS = ("failure_modes", "model", "load_cases", "inputs", "campaign", "comparison")
"""Keys of the six steps, in the order of `STEPS`."""


def read_project(path: str | Path) -> Project:
    """Read a project file.

    Parameters
    ----------
    path : str or Path
        Plain YAML of at most 1 MB.

    Returns
    -------
    Project

    Raises
    ------
    InputError
        The file cannot be read, or is not a project.
    """
    return parse_project(read_text(path, "project"), str(path))


def parse_project(text: str, source: str = "project") -> Project:
    """A project from YAML text; see `read_project`.

    Parameters
    ----------
    text : str
        The file's.
    source : str
        Where it comes from, for messages.
    """
    return validated(Project, parse_mapping(text, source), source)


def starting_project(drivetrain: Drivetrain | None = None, file: str = "") -> str:
    """The project to start from, with what it leaves open, as YAML text.

    Parameters
    ----------
    drivetrain : Drivetrain, optional
        Your own, whose evidence is then that of commands; the 750 kW reference drivetrain, on cases
        of the suite, where left out.
    file : str
        Its file as the project names it, relative to the project's, or its name in the library.

    Raises
    ------
    InputError
        The drivetrain lacks what any model of all that turns needs; the message names its key.
    """
    if drivetrain is not None:
        from fe_drivetrain.procedure.own_project import own_project

        return own_project(drivetrain, file)
    return (
        package_files("fe_drivetrain.procedure").joinpath("project_750kw.yaml").read_text("utf-8")
    )


def project_schema() -> str:
    """The JSON schema (draft 2020-12) of project files, for editors; ends with a line break."""
    return json.dumps(Project.model_json_schema(), indent=1, ensure_ascii=False) + "\n"
