"""The answer of a case in a sentence: value with its band, and what it was compared with."""

from __future__ import annotations

import math

from fe_drivetrain.report.number_text import (
    error_text,
    expected_text,
    formatted,
    tolerance_text,
    with_unit,
)
from fe_drivetrain.report.results import Results, Verdict

_DIGITS = 3  # of a value without a band
_MOST_DIGITS = 7  # of a value with one


def headline(results: Results) -> Verdict | None:
    """The check that answers what was asked: the one that the case names, or its first.

    Parameters
    ----------
    results : Results
        Of the case.

    Returns
    -------
    verdict : Verdict or None
        None of a case without checks.
    """
    named = (v for v in results.verdicts if v.quantity == results.headline)
    numbers = (v for v in results.verdicts if v.check != "holds")
    return next(named, next(numbers, next(iter(results.verdicts), None)))


def value_with_band(verdict: Verdict) -> str:
    """The computed value with its unit: three digits, or with a band those that it leaves certain.

    Parameters
    ----------
    verdict : Verdict
        The check; its band is shown with two digits.

    Returns
    -------
    str
    """
    if verdict.check == "holds":
        return "yes" if verdict.computed == 1.0 else "no"
    unit, value, band = verdict.unit, verdict.computed, verdict.band
    if not band or not math.isfinite(value) or not math.isfinite(band):
        return with_unit(formatted(value, _DIGITS, unit), unit)
    # the last digit of the value is the last of the band's two
    certain = math.floor(math.log10(abs(value) or band)) - math.floor(math.log10(band)) + 2
    digits = min(max(certain, _DIGITS), _MOST_DIGITS)
    return with_unit(f"{formatted(value, digits, unit)} ± {formatted(band, 2, unit)}", unit)


def answer_sentence(verdict: Verdict) -> str:
    """What was found and what was expected, as a sentence without the verdict.

    Parameters
    ----------
    verdict : Verdict
        Of the check that answers.

    Returns
    -------
    str
    """
    quantity = verdict.quantity[:1].upper() + verdict.quantity[1:]
    found = f"{quantity}: {value_with_band(verdict)}"
    if verdict.check == "holds":
        return f"{found}."
    if verdict.check == "vanishes":
        return f"{found}; expected 0 within {tolerance_text(verdict)}."
    expected = with_unit(expected_text(verdict), verdict.unit)
    if verdict.check != "equals":
        return f"{found}; expected {expected}."
    allowed = f"error {error_text(verdict)}, tolerance {tolerance_text(verdict)}"
    return f"{found}; expected {expected} ({allowed})."
