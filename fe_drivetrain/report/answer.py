"""The answer to what was asked: one record, which page, terminal, JSON and index show."""

from __future__ import annotations

import math
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

Status = Literal["good", "watch", "bad", "none"]
"""How a value stands to its limit: within it; within it, but not with its band; beyond it; or there
is no limit."""

Bound = Literal["", "equals", "at most", "at least", "between", "holds", "beside"]
"""What a limit asks of a value; "beside" asks nothing: another's value, to compare with."""

Claim = Literal["", "holds", "holds in part", "does not hold"]
"""How what a source states stands after the work; empty where no statement was tested."""

MAX_WORDS = 25
"""Words of a verdict at most."""
MAX_CAUTIONS = 3
"""Cautions that are in view; the rest is folded."""

_WORST_FIRST: tuple[Status, ...] = ("bad", "watch", "good", "none")


class KeyFigure(BaseModel):
    """A value that answers, with its limit."""

    model_config = ConfigDict(frozen=True, extra="forbid", ser_json_inf_nan="strings")

    name: str = Field(description="what it is, in the words of the reader")
    value: float
    unit: str
    band: float | None = Field(
        default=None, ge=0, description="half width of its numerical uncertainty, in its unit"
    )
    bound: Bound = Field(default="", description="what the limit asks of the value")
    limit: float | None = Field(
        default=None, description="limit, reference, or lower end of 'between', in the unit"
    )
    upper: float | None = Field(default=None, description="upper end of 'between' alone")
    allowed: float = Field(
        default=0.0, description="difference from the limit that 'equals' allows, in the unit"
    )
    printed: str = Field(default="", description="the limit as its source prints it")
    by: str = Field(default="", description="whose limit it is, in a word or two")
    status: Status
    quantity: str = Field(
        default="", description="quantity of the check or figure that has this value, if one has"
    )


class Answer(BaseModel):
    """What was asked, and what came of it.

    The rules of length are those of whoever writes an answer: a record of the program's own is
    held to them by a test, and a long name of a user's bearing breaks nothing.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    question: str = Field(description="what was asked, in the words of the user")
    verdict: str = Field(
        description="one sentence: subject, number with unit, and what follows from it"
    )
    figures: list[KeyFigure] = Field(description="three to six values, that which answers first")
    hero: str = Field(
        default="", description="caption of the chart or picture that shows the verdict"
    )
    cautions: list[str] = Field(
        default=[], description="what limits the verdict, most severe first, in sentences"
    )
    claim: Claim = Field(default="", description="how a statement of the source stands")
    status: Status = Field(description="of the answer as a whole")


def status_of(
    value: float,
    bound: Bound,
    limit: float | None,
    upper: float | None = None,
    band: float | None = None,
    allowed: float = 0.0,
) -> Status:
    """How a value stands to its limit.

    Parameters
    ----------
    value : float
        The value; what is not a number is "bad" wherever something is asked of it.
    bound : Bound
        What the limit asks.
    limit, upper : float or None
        The limit, and the upper end of "between", in the unit of the value.
    band : float or None
        Half width of the numerical uncertainty of the value.
    allowed : float
        Difference that "equals" allows.

    Returns
    -------
    Status
    """
    if bound in ("", "beside") or limit is None:
        return "none"
    if bound in ("equals", "holds"):
        return "good" if abs(value - limit) <= allowed else "bad"
    low = -math.inf if bound == "at most" else limit
    high = limit if bound == "at most" else math.inf if upper is None else upper
    if not low <= value <= high:
        return "bad"
    return "good" if low <= value - (band or 0.0) and value + (band or 0.0) <= high else "watch"


def worst(figures: list[KeyFigure], claim: Claim) -> Status:
    """The status of an answer: that of its worst figure; a refuted claim is at least "watch".

    Parameters
    ----------
    figures : list of KeyFigure
        Those of the answer.
    claim : Claim
        How a statement of the source stands.

    Returns
    -------
    Status
    """
    found = {figure.status for figure in figures}
    if claim in ("does not hold", "holds in part"):
        found.add("watch")
    return next((status for status in _WORST_FIRST if status in found), "none")


def words(sentence: str) -> int:
    """Number of words of a sentence; a number and its unit, joined by a fixed space, are one."""
    return len(sentence.split(" "))
