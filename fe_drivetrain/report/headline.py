"""The value of a case that answers, as a sentence, and as one of its checks or values."""

from __future__ import annotations

from collections.abc import Callable

from fe_drivetrain.report.number_text import (
    error_text,
    expected_text,
    tolerance_text,
    value_with_band,
    with_unit,
)
from fe_drivetrain.report.results import Figure, Results, Verdict


def headline(results: Results) -> Figure | Verdict | None:
    """The value that answers what was asked.

    It is the first of the case's answers; or else the check that the case names, the first value
    with a band against an independent reference, the first without a band, the first number, or
    the first check of all.

    Parameters
    ----------
    results : Results
        Of the case.

    Returns
    -------
    found : Figure, Verdict or None
        None of a case without either.
    """
    if results.answer is not None and results.answer.figures:
        first = results.answer.figures[0]
        every: list[Figure | Verdict] = [*results.answers, *results.verdicts]
        same = (one for one in every if one.quantity == first.quantity and one.unit == first.unit)
        alone = Figure(quantity=first.name, unit=first.unit, computed=first.value, band=first.band)
        return next(same, alone)
    if results.answers:
        return results.answers[0]

    def is_value(verdict: Verdict) -> bool:
        is_equal = verdict.check == "equals" and verdict.reference != 0.0
        return is_equal and verdict.basis == "independent" and verdict.measure != "identity"

    ways: tuple[Callable[[Verdict], bool], ...] = (
        lambda verdict: verdict.quantity == results.headline,
        lambda verdict: is_value(verdict) and verdict.band is not None,
        is_value,
        lambda verdict: verdict.check != "holds",
        lambda verdict: True,
    )
    return next((v for is_answer in ways for v in results.verdicts if is_answer(v)), None)


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
