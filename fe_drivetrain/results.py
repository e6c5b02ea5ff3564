"""What a case found, as data: written to results.json, and the page is made from that alone."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

Cell = float | int | str | bool | None


class _Result(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Verdict(_Result):
    """One quantity judged against a reference, with the tolerance and its reason."""

    # a case that computes NaN has failed, and its page must be able to say so
    model_config = ConfigDict(ser_json_inf_nan="strings")

    quantity: str
    unit: str
    computed: float
    reference: float
    source: str = Field(description="where the reference comes from")
    tolerance: float = Field(description="allowed |computed - reference|, relative or in the unit")
    relative: bool = Field(description="whether tolerance is relative to the reference")
    reason: str = Field(description="why the tolerance is what it is")
    passed: bool


def judge(
    quantity: str,
    computed: float,
    reference: float,
    *,
    tolerance: float,
    reason: str,
    source: str,
    unit: str = "",
    relative: bool = True,
) -> Verdict:
    """Judge one quantity; a NaN never passes."""
    size = abs(reference) if relative else 1.0
    passed = bool(abs(computed - reference) <= tolerance * size)
    return Verdict(
        quantity=quantity,
        unit=unit,
        computed=float(computed),
        reference=float(reference),
        source=source,
        tolerance=tolerance,
        relative=relative,
        reason=reason,
        passed=passed,
    )


class Text(_Result):
    """A paragraph."""

    kind: Literal["text"] = "text"
    text: str


class Table(_Result):
    """Rows of cells; each column's heading carries its unit."""

    kind: Literal["table"] = "table"
    caption: str
    columns: list[str]
    rows: list[list[Cell]]


class Chart(_Result):
    """A Plotly figure."""

    kind: Literal["chart"] = "chart"
    caption: str
    figure: dict[str, Any] = Field(description="a Plotly figure as JSON")


class Image(_Result):
    """A PNG beside results.json."""

    kind: Literal["image"] = "image"
    caption: str
    file: str


class Section(_Result):
    """A heading and what stands under it."""

    title: str
    items: Sequence[Annotated[Text | Table | Chart | Image, Field(discriminator="kind")]]


class AssumptionRow(_Result):
    """A value that the sources do not give."""

    name: str
    value: Cell
    unit: str
    source: str = Field(description="where it comes from, or why it was assumed")


class Environment(_Result):
    """What a run depended on, so that it can be repeated."""

    date: str
    python: str
    platform: str
    versions: dict[str, str]
    settings: dict[str, Any]
    seed: int | None = None


class Results(_Result):
    """All that a case found."""

    schema_version: Literal[1] = 1
    case: str
    title: str
    source: str
    summary: list[str] = Field(description="the answer first, in a few sentences")
    verdicts: list[Verdict]
    sections: list[Section]
    assumptions: list[AssumptionRow] = []
    times: dict[str, float] = Field(default={}, description="wall time of each step [s]")
    figures: dict[str, Any] = Field(default={}, description="named numbers for other programs")
    environment: Environment

    @property
    def passed(self) -> bool:
        """Whether every verdict passed."""
        return all(verdict.passed for verdict in self.verdicts)


def read_results(path: str | Path) -> Results:
    """Read and validate a results.json."""
    return Results.model_validate_json(Path(path).read_text(encoding="utf-8"))
