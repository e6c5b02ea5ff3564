"""What a case found, as data: written to results.json, and the page is made from that alone."""

import math
import statistics
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple, TypedDict, Unpack

from pydantic import BaseModel, ConfigDict, Field, model_validator

from fe_drivetrain.common.regular_files import content_of
from fe_drivetrain.report.answer import Answer

Cell = float | int | str | bool | None

Measure = Literal[
    "stiffness",
    "deflection",
    "rotation",
    "stress",
    "reaction",
    "frequency",
    "energy",
    "mass",
    "order",
    "identity",
]
"""What kind of quantity a verdict is about; "identity" must vanish or agree to round-off."""


class _Result(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


Check = Literal["equals", "vanishes", "at most", "at least", "between", "holds"]
"""What a verdict asks of the computed value; a NaN passes none of them."""

Basis = Literal["independent", "self-consistency", "second-hand"]
"""What a reference is worth: independent of the computed value; true by construction, so that only
a fault of the program could break it; or quoted from a source that was not read itself."""


class Verdict(_Result):
    """One quantity judged, with what is asked of it and why."""

    # a case that computes NaN has failed, and its page must be able to say so
    model_config = ConfigDict(ser_json_inf_nan="strings")

    quantity: str
    unit: str
    check: Check = "equals"
    computed: float
    reference: float = Field(
        description="the value to be met; the bound of 'at most' and 'at least'; the lower one of "
        "'between'; 0 where it vanishes, 1 where it holds"
    )
    upper: float | None = Field(default=None, description="upper bound, of 'between' alone")
    source: str = Field(description="where the reference comes from")
    tolerance: float = Field(description="allowed |computed - reference|, relative or in the unit")
    relative: bool = Field(description="whether tolerance is relative to the reference")
    reason: str = Field(description="why the tolerance or the bound is what it is")
    measure: Measure | None = Field(default=None, description="kind of quantity, for statistics")
    basis: Basis = "independent"
    band: float | None = Field(
        default=None,
        ge=0,
        description="half width of the numerical uncertainty of computed, in its unit; computed "
        "itself, or absent",
    )
    of: str = Field(
        default="",
        description="hash of the drivetrain, where results state one, or none",
    )
    passed: bool


def is_met(verdict: Verdict) -> bool:
    """Whether the computed value is what the check asks for."""
    computed, reference = verdict.computed, verdict.reference
    if verdict.check == "at most":
        return computed <= reference
    if verdict.check == "at least":
        return computed >= reference
    if verdict.check == "between":
        return verdict.upper is not None and reference <= computed <= verdict.upper
    size = abs(reference) if verdict.relative else 1.0
    return abs(computed - reference) <= verdict.tolerance * size


def share_of_tolerance(verdict: Verdict) -> float:
    """How much of what a check allows is used up: beyond 1 it fails.

    Parameters
    ----------
    verdict : Verdict
        The check. Of a bound it is the value over the bound, or the bound over the value; of a
        range the distance from its middle over half its width; of a statement 0 or infinity.

    Returns
    -------
    share : float
        From 0 on; infinite where the computed value is not a number.
    """
    computed, reference = verdict.computed, verdict.reference
    if verdict.check in ("equals", "vanishes"):
        allowed = verdict.tolerance * (abs(reference) if verdict.relative else 1.0)
        used = abs(computed - reference)
    elif verdict.check == "between" and verdict.upper is not None:
        used = abs(computed - 0.5 * (reference + verdict.upper))
        allowed = 0.5 * (verdict.upper - reference)
    elif verdict.check == "at most" and computed > 0.0 and reference > 0.0:
        used, allowed = computed, reference
    elif verdict.check == "at least" and computed > 0.0 and reference > 0.0:
        used, allowed = reference, computed
    else:
        return 0.0 if verdict.passed else math.inf
    share = used / allowed if allowed > 0.0 else (0.0 if verdict.passed else math.inf)
    return share if math.isfinite(share) else math.inf


def expectation(verdict: Verdict) -> str:
    """What a check asks of the computed value, in words and plain digits."""
    unit = f" {verdict.unit}" if verdict.unit not in ("", "-") else ""
    share = f"{100 * verdict.tolerance:.3g} %" if verdict.relative else ""
    allowed = share or f"{verdict.tolerance:.3g}{unit}"
    if verdict.check == "vanishes":
        return f"vanishes within {allowed}"
    if verdict.check == "holds":
        return "holds where it is 1"
    if verdict.check == "between":
        return f"between {verdict.reference:.5g} and {verdict.upper:.5g}{unit}"
    if verdict.check in ("at most", "at least"):
        return f"{verdict.check} {verdict.reference:.5g}{unit}"
    return f"reference {verdict.reference:.5g}{unit}, tolerance {allowed}"


class ValueFacts(TypedDict, total=False):
    """What is known of a computed value; see the fields of `Verdict`."""

    unit: str
    measure: Measure | None
    basis: Basis
    band: float | None


class JudgedFacts(ValueFacts, total=False):
    """How a value is judged, beside what is known of it; see the fields of `Verdict`."""

    check: Check
    upper: float | None
    relative: bool


def judge(
    quantity: str,
    computed: float,
    reference: float,
    *,
    tolerance: float,
    reason: str,
    source: str,
    of: str = "",
    **more: Unpack[JudgedFacts],
) -> Verdict:
    """Judge one quantity; a NaN never passes. For the arguments see `Verdict`."""
    upper, band = more.get("upper"), more.get("band")
    verdict = Verdict.model_validate(
        {
            "unit": "",
            "relative": True,
            **more,
            "quantity": quantity,
            "computed": float(computed),
            "reference": float(reference),
            "upper": None if upper is None else float(upper),
            "band": None if band is None else float(band),
            "tolerance": tolerance,
            "reason": reason,
            "source": source,
            "of": of,
            "passed": False,
        }
    )
    return verdict.model_copy(update={"passed": is_met(verdict)})


@dataclass(frozen=True)
class Statistic:
    """How far many verdicts of one measure are from their references, relative to these.

    Attributes
    ----------
    measure : str
        Which.
    count : int
        Number of verdicts.
    bias : float
        Mean of the signed errors.
    scatter : float
        Standard deviation of the signed errors; 0 of one verdict.
    largest : float
        Largest error, without its sign.
    """

    measure: str
    count: int
    bias: float
    scatter: float
    largest: float


def bias_and_scatter(verdicts: Iterable[Verdict]) -> list[Statistic]:
    """Statistics of each measure, over verdicts that are relative to a reference other than 0.

    References that are true by construction, or second-hand, say nothing of bias: they are left
    out.
    """
    errors: dict[str, list[float]] = {}
    for v in verdicts:
        if v.measure in (None, "identity") or v.basis != "independent" or v.check != "equals":
            continue
        if not v.relative or v.reference == 0.0:
            continue
        errors.setdefault(str(v.measure), []).append((v.computed - v.reference) / abs(v.reference))
    return [
        Statistic(
            measure,
            len(found),
            statistics.fmean(found),
            statistics.stdev(found) if len(found) > 1 else 0.0,
            max(map(abs, found)),
        )
        for measure, found in sorted(errors.items())
    ]


class Figure(_Result):
    """A value that answers what was asked, and is not judged."""

    model_config = ConfigDict(ser_json_inf_nan="strings")

    quantity: str
    unit: str
    computed: float
    band: float | None = Field(
        default=None, ge=0, description="half width of its numerical uncertainty, in its unit"
    )
    of: str = Field(
        default="",
        description="hash of the drivetrain, where results state one, or none",
    )
    loads: tuple[str, ...] = Field(
        default=(), description="design loads, as the catalogue calls them, that it is a value of"
    )


class DrivetrainRecord(_Result):
    """A drivetrain that results are of."""

    kind: str = Field(description="scene, machine, or drivetrain of a gear table")
    name: str = Field(default="", description="as the results call it; empty: they do not")
    title: str
    hash: str = Field(description="of all values that describe it")


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
    links: list[str] = Field(
        default=[],
        description="address, relative to the page, that the first cell of each row leads to; "
        "empty: none",
    )


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


class Solid(_Result):
    """A deformed model in three dimensions, of `report.solid_view`, beside results.json."""

    kind: Literal["solid"] = "solid"
    caption: str
    file: str
    still: str = Field(default="", description="a PNG in its place, on paper and without WebGL")


class Section(_Result):
    """A heading and what stands under it."""

    title: str
    items: Sequence[Annotated[Text | Table | Chart | Image | Solid, Field(discriminator="kind")]]


class AssumptionRow(_Result):
    """A value that the sources do not give."""

    name: str
    value: Cell
    unit: str
    source: str = Field(description="where it comes from, or why it was assumed")


class Limit(_Result):
    """How far a method can be trusted, found by driving one parameter into its failure."""

    method: str = Field(description="what fails: an element, a solver, a theory, a metric")
    parameter: str = Field(description="what was varied, with its unit")
    low: float | None = Field(default=None, description="least safe value; None: no bound found")
    high: float | None = Field(default=None, description="largest safe value; None: no bound found")
    criterion: str = Field(description="what counts as safe, such as an error below 1 %")
    beyond: str = Field(description="what happens outside of the safe range")
    program: str = Field(description="what the program does about it")
    remedy: str = Field(description="what holds there, shown on the same axis")


class Environment(_Result):
    """What a run depended on, so that it can be repeated."""

    date: str
    python: str
    platform: str
    versions: dict[str, str]
    settings: dict[str, Any]
    seed: int | None = None
    quick: bool = Field(default=False, description="whether the run was coarser and smaller")
    code: str = Field(default="", description="SHA-256 of the program's sources")
    commit: str = Field(default="", description="of the clone that it ran from, if from one")
    command: str = Field(default="", description="what to type to run it again")


class PageLink(_Result):
    """A page that belongs to this one."""

    title: str
    address: str = Field(description="relative to the page; empty: this page")


State = Literal["failed", "not run", "running", "planned", "skipped"]
"""Of a case without results of this run: it ended by an error, or its turn never came since the run
was stopped; it is at work; its turn comes; a program that it needs is not installed."""


class Problem(NamedTuple):
    """Why a case has no results, or none of this run."""

    message: str
    state: State = "failed"


class Results(_Result):
    """All that a case found."""

    schema_version: Literal[3] = 3
    case: str
    title: str
    source: str
    notes: list[str] = Field(
        default=[], description="what must be known before any figure, in sentences"
    )
    unsettled: list[str] = Field(
        default=[], description="answers that have not converged, in sentences"
    )
    answer: Answer | None = Field(default=None, description="the answer to what was asked")
    details: list[str] = Field(description="what explains the answer, in sentences")
    answers: list[Figure] = Field(default=[], description="values that were found, not judged")
    verdicts: list[Verdict]
    sections: list[Section]
    limits: list[Limit] = []
    assumptions: list[AssumptionRow] = []
    times: dict[str, float] = Field(default={}, description="wall time of each step [s]")
    figures: dict[str, Any] = Field(default={}, description="named numbers for other programs")
    scene: str = Field(default="", description="the scene as a file, of a case that has one")
    drivetrains: list[DrivetrainRecord] = Field(
        default=[], description="what the results are of, of a case or command that says so"
    )
    skipped: list[str] = Field(
        default=[], description="checks that were not made, and why, in sentences"
    )
    links: list[PageLink] = Field(
        default=[], description="pages that belong together, of a dossier: its menu"
    )
    environment: Environment
    digest: str = Field(default="", description="SHA-256 of all other values")

    @model_validator(mode="before")
    @classmethod
    def _of_older_programs(cls, given: Any) -> Any:
        """Results of schema 1 and 2, whose answer was sentences alone."""
        if not isinstance(given, dict) or given.get("schema_version") not in (1, 2):
            return given
        return {
            **{key: value for key, value in given.items() if key not in ("summary", "headline")},
            "schema_version": 3,
            "details": given.get("summary", []),
        }

    @property
    def passed(self) -> bool:
        """Whether every verdict passed."""
        return all(verdict.passed for verdict in self.verdicts)

    @property
    def settled(self) -> bool:
        """Whether every verdict passed, and every answer has converged."""
        return self.passed and not self.unsettled


def verdict_sentence(results: Results) -> str:
    """The verdict of results, with what takes its ground away before it.

    Parameters
    ----------
    results : Results
        What a case or command found.

    Returns
    -------
    str
        Empty where there is no answer. A verdict that begins with "Not", as "Not complete",
        takes its own ground away.
    """
    if results.answer is None:
        return ""
    if results.answer.verdict.startswith("Not "):
        return results.answer.verdict
    failed = sum(not verdict.passed for verdict in results.verdicts)
    number = len(results.verdicts)
    before = f"Not to be relied on, {failed} of {number} checks fail: " if failed else ""
    return f"{before}{results.answer.verdict}"


def cautions_of(results: Results) -> list[str]:
    """What limits the answer of results, most severe first: page, terminal and dossier show these.

    Parameters
    ----------
    results : Results
        What a case or command found.

    Returns
    -------
    list of str
        What has not converged, cautions of the answer, and notes.
    """
    said = results.answer.cautions if results.answer else []
    return [*results.unsettled, *said, *results.notes]


def results_below(folder: Path) -> dict[str, Path]:
    """Files of results below a folder, by "GROUP/NAME"; not those of runs that were killed."""
    files = sorted(folder.glob("*/*/results.json"))
    return {"/".join(f.parts[-3:-1]): f for f in files if not f.parent.name.startswith(".")}


def read_results(path: str | Path) -> Results:
    """Read and validate a results.json."""
    return Results.model_validate_json(content_of(path))
