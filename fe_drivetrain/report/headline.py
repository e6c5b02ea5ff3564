"""The value of a case that answers, as a sentence, and as one of its checks or values."""

from __future__ import annotations

from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import (
    error_text,
    expected_text,
    tolerance_text,
    value_with_band,
    with_unit,
)
from fe_drivetrain.report.results import Figure, Results, Verdict


def values_found(results: Results) -> list[Figure | Verdict]:
    """All values of results in the order of their page: key figures, other values, checks.

    Parameters
    ----------
    results : Results
        What a case or command found.

    Returns
    -------
    list of Figure or Verdict
        A key figure that is a check or value of the results is that one, and stands once. Of a file
        of an older program the first number stands first.
    """
    every: list[Figure | Verdict] = [*results.answers, *results.verdicts]
    first: list[Figure | Verdict] = []
    if results.answer is not None:
        first = [_record_of(figure, every) for figure in results.answer.figures]
    else:
        numbers = (one for one in every if isinstance(one, Figure) or one.check != "holds")
        first = list(numbers)[:1]
    return [*first, *(one for one in every if not any(one is other for other in first))]


def _record_of(figure: KeyFigure, every: list[Figure | Verdict]) -> Figure | Verdict:
    """The check or value that a key figure is, in its own unit, or a value of its own."""
    same = [one for one in every if figure.quantity and one.quantity == figure.quantity]
    same = [one for one in same if one.unit == figure.unit] or same
    if same:
        return same[0]
    return Figure(quantity=figure.name, unit=figure.unit, computed=figure.value, band=figure.band)


def headline(results: Results) -> Figure | Verdict | None:
    """The value that answers what was asked: the first of all; None of a case without any.

    Parameters
    ----------
    results : Results
        What the case found.

    Returns
    -------
    found : Figure, Verdict or None
    """
    return next(iter(values_found(results)), None)


def answer_sentence(verdict: Figure | Verdict) -> str:
    """What was found and what was expected, as a sentence without the verdict.

    Parameters
    ----------
    verdict : Figure or Verdict
        What answers.

    Returns
    -------
    str
    """
    quantity, first = verdict.quantity, verdict.quantity.partition(" ")[0].rstrip(":,")
    if "_" not in first and "." not in first:  # of an identifier every letter counts
        quantity = quantity[:1].upper() + quantity[1:]
    found = f"{quantity}: {value_with_band(verdict)}"
    if isinstance(verdict, Figure) or verdict.check == "holds":
        return f"{found}."
    if verdict.check == "vanishes":
        return f"{found}; expected 0 within {tolerance_text(verdict)}."
    expected = with_unit(expected_text(verdict), verdict.unit)
    if verdict.check != "equals":
        return f"{found}; expected {expected}."
    allowed = f"error {error_text(verdict)}, tolerance {tolerance_text(verdict)}"
    return f"{found}; expected {expected} ({allowed})."
