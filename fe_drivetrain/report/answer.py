"""The answer of a case in a sentence: value with its band, and what it was compared with."""

from __future__ import annotations

import math
from collections.abc import Callable

from fe_drivetrain.common.typeset import superscript
from fe_drivetrain.report.number_text import (
    error_text,
    expected_text,
    formatted,
    power_of_ten,
    tolerance_text,
    with_unit,
)
from fe_drivetrain.report.results import Figure, Results, Verdict

_DIGITS = 3  # of a value without a band
_MAX_DIGITS = 7  # of a value with one


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


def value_with_band(found: Figure | Verdict) -> str:
    """The computed value with its unit: three digits, or with a band those that it leaves certain.

    Parameters
    ----------
    found : Figure or Verdict
        The value; its band is shown with two digits, in percent where it lies beyond the digits
        that are shown.

    Returns
    -------
    str
    """
    if isinstance(found, Verdict) and found.check == "holds":
        return "yes" if found.computed == 1.0 else "no"
    unit, value, band = found.unit, found.computed, found.band
    if not band or not math.isfinite(value) or not math.isfinite(band):
        return with_unit(formatted(value, _DIGITS, unit), unit)
    power = power_of_ten(value or band, unit)
    value, band = value / 10.0**power, band / 10.0**power
    # the last digit of the value is the last of the band's two
    place = math.floor(math.log10(band)) - 1
    if place > 0:
        value, band = round(value, -place), round(band, -place)
    certain = math.floor(math.log10(abs(value) or band)) - place + 1
    if value and certain > _MAX_DIGITS:
        percent = formatted(100.0 * band / abs(value), 2, "%")
        whole = with_unit(formatted(found.computed, _MAX_DIGITS, unit), unit)
        return f"{whole} ± {percent}\u00a0%"
    digits = max(certain, _DIGITS)
    text = f"{formatted(value, digits, unit)} ± {formatted(band, 2, unit)}"
    if power:
        text = f"({text})\u00a0×\u00a010{superscript(power)}"
    return with_unit(text, unit)


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
