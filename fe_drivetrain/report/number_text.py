"""Numbers and checks as an engineer reads them: digits, powers of ten, units, bands."""

from __future__ import annotations

import math

from fe_drivetrain.common.typeset import MINUS, THIN_SPACE, superscript
from fe_drivetrain.report.results import Limit, Verdict

DIGITS = 5
"""Significant digits of a number on the page; results.json keeps all of them."""


def formatted(
    value: float | int | str | bool | None, digits: int = DIGITS, unit: str | None = None
) -> str:
    """A value as an engineer reads it.

    Numbers have at most `digits` significant digits and thin spaces between thousands; very
    large and very small ones a power of ten. It is a multiple of three, as units have prefixes,
    but for percentages and pure numbers (`unit` "%", "" or "-").
    """
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, str):
        return value
    if not math.isfinite(value):
        return "not a number" if math.isnan(value) else f"{MINUS if value < 0 else ''}∞"
    if value == 0:
        return "0"
    if isinstance(value, int) and abs(value) < 10**9:
        return f"{value:,}".replace(",", THIN_SPACE).replace("-", MINUS)
    # rounded first: 999 999.9 has another exponent than it seems
    rounded, _, exponent_text = f"{value:.{digits - 1}e}".partition("e")
    exponent = int(exponent_text)
    power = _shown_power(exponent, unit)
    decimals = max(digits - 1 - exponent + power, 0)
    shown = float(rounded) * 10 ** (exponent - power) if power else value
    number = f"{shown:,.{decimals}f}"
    if decimals:
        number = number.rstrip("0").rstrip(".")
    number = number.replace(",", THIN_SPACE).replace("-", MINUS)
    return f"{number}\u00a0×\u00a010{superscript(power)}" if power else number


def power_of_ten(value: float, unit: str | None = None) -> int:
    """The power of ten that a number is written with; 0 of most.

    Parameters
    ----------
    value : float
        The number, other than 0.
    unit : str or None
        As in `formatted`.

    Returns
    -------
    int
    """
    return _shown_power(math.floor(math.log10(abs(value))), unit)


def _shown_power(exponent: int, unit: str | None) -> int:
    step = 1 if unit in ("%", "", "-") else 3
    return 0 if -3 <= exponent < 6 else step * (exponent // step)


def computed_text(verdict: Verdict) -> str:
    """The computed value; of a statement, whether it holds."""
    if verdict.check == "holds":
        return "yes" if verdict.computed == 1.0 else "no"
    return formatted(verdict.computed, unit=verdict.unit)


def expected_text(verdict: Verdict) -> str:
    """What a check asks for: a reference, zero, a bound, a range, or that a statement holds."""
    reference = formatted(verdict.reference, unit=verdict.unit)
    if verdict.check == "at most":
        return f"≤\u00a0{reference}"
    if verdict.check == "at least":
        return f"≥\u00a0{reference}"
    if verdict.check == "between":
        return f"{reference} to {formatted(verdict.upper, unit=verdict.unit)}"
    return {"vanishes": "0", "holds": "yes"}.get(verdict.check, reference)


def error_text(verdict: Verdict) -> str:
    """The error of a verdict: in percent of the reference, or in the unit; none of a bound."""
    if verdict.check not in ("equals", "vanishes"):
        return "–"
    error = verdict.computed - verdict.reference
    if verdict.relative and verdict.reference != 0:
        return _signed(100 * error / abs(verdict.reference), "%")
    return _signed(error, verdict.unit)


def band_text(verdict: Verdict) -> str:
    """The band of a computed value: in percent of it, or in the unit."""
    if verdict.band is None:
        return "–"
    if verdict.relative and verdict.computed != 0:
        return f"±{formatted(100 * verdict.band / abs(verdict.computed), 2, '%')}\u00a0%"
    return f"±{with_unit(formatted(verdict.band, 2, verdict.unit), verdict.unit)}"


def safe_range(limit: Limit) -> str:
    """The safe range of a limit, as a table shows it."""
    low, high = (None if end is None else formatted(end, 3) for end in (limit.low, limit.high))
    if low is None:
        return "the whole sweep" if high is None else f"up to {high}"
    return f"from {low}" if high is None else f"{low} to {high}"


def tolerance_text(verdict: Verdict) -> str:
    """The tolerance of a verdict, in percent or in the unit; none of a bound."""
    if verdict.check not in ("equals", "vanishes"):
        return "–" if verdict.check == "holds" else ""
    if verdict.relative:
        return f"±{formatted(100 * verdict.tolerance, 3, '%')}\u00a0%"
    return f"±{with_unit(formatted(verdict.tolerance, 3, verdict.unit), verdict.unit)}"


def _signed(value: float, unit: str) -> str:
    return with_unit(("+" if value > 0 else "") + formatted(value, 3, unit), unit)


def with_unit(number: str, unit: str) -> str:
    return f"{number}\u00a0{unit}" if unit not in ("", "-") else number
