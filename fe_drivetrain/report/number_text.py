"""Numbers and checks as an engineer reads them: digits, powers of ten, units, bands."""

from __future__ import annotations

import math

from fe_drivetrain.common.typeset import MINUS, THIN_SPACE, superscript
from fe_drivetrain.report.answer import Answer, KeyFigure, Status
from fe_drivetrain.report.results import Figure, Limit, Verdict

DIGITS = 4
"""Significant digits of a number without a band; results.json keeps all of them."""

_NOTHING = 0.1  # share of its band below which a value has no digit
_MAX_DIGITS = 6  # of a value whose band is told in percent
_FINE = 1e-5  # share of a value: a smaller band is told in percent
_PRINTED_DIGITS = 7  # of a number that somebody has given; what was computed has more
_NEGLIGIBLE = 1e-6  # a difference that is allowed, over the reference: nobody could see it
_ROUND_OFF = 1e-13  # of one that was converted to another unit
_MARKS = {"good": "✓", "watch": "!", "bad": "✗"}
_COMPARED_DIGITS = 6  # at most, of a value without a band beside a reference that has as many


def formatted(
    value: float | int | str | bool | None, digits: int = DIGITS, unit: str | None = None
) -> str:
    """A value as an engineer reads it.

    Numbers have at most `digits` significant digits and thin spaces between thousands; whole ones
    are given or counted, and have all of theirs. Very large and very small ones have a power of
    ten. It is a multiple of three, as units have prefixes,
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
    exact = not power and float(value).is_integer()
    shown = value if exact else float(f"{rounded}e{exponent - power}")
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


def value_text(
    value: float, unit: str = "", band: float | None = None, with_band: bool = True
) -> str:
    """A value with its unit, in the digits that its band leaves certain; for sentences, too.

    Parameters
    ----------
    value : float
        The value.
    unit : str
        Its unit, after a space that does not break; empty of a pure number.
    band : float or None
        Half width of its numerical uncertainty, in the unit: the value is rounded to the place of
        the second digit of the band, and to "~0" where it is at most a tenth of the band. Four
        digits without a band.
    with_band : bool
        Whether the band is shown, too.

    Returns
    -------
    str
        "145.2 ± 1.3 MN m/rad", or without the band "145.2 MN m/rad".
    """
    text = with_unit(_digits_of(value, unit, band, with_band), unit)
    if band and with_band and band < _FINE * abs(value):
        percent = formatted(100.0 * band / abs(value), 2, "%")
        return f"{text} ± {percent}\u00a0%"
    return text


def _digits_of(value: float, unit: str, band: float | None, with_band: bool) -> str:
    """The number of `value_text`, without its unit."""
    if not band or not math.isfinite(value) or not math.isfinite(band):
        return formatted(value, unit=unit)
    if abs(value) <= _NOTHING * band:
        around = f" ± {formatted(band, 2, unit)}" if with_band else ""
        return f"~0{around}"
    power = power_of_ten(value, unit)
    scaled, width = value / 10.0**power, band / 10.0**power
    # the last digit of the value is the last of the band's two
    place = int(f"{width:.1e}".partition("e")[2]) - 1
    if band < _FINE * abs(value):
        return formatted(value, _MAX_DIGITS, unit)  # the band is told in percent
    if place > 0:
        scaled, width = round(scaled, -place), round(width, -place)
    text = _to_place(scaled, place)
    if with_band:
        text = f"{text} ± {_to_place(width, place)}"
    if power:
        text = f"({text})" if with_band else text
        text = f"{text}\u00a0×\u00a010{superscript(power)}"
    return text


def _to_place(value: float, place: int) -> str:
    """A number to a power of ten, zeros kept: 1.30 of 1.3 and -2."""
    return f"{value:,.{max(-place, 0)}f}".replace(",", THIN_SPACE).replace("-", MINUS)


def value_with_band(found: Figure | Verdict | KeyFigure) -> str:
    """The computed value of a figure or check with its unit and band; of a statement yes or no.

    Parameters
    ----------
    found : Figure, Verdict or KeyFigure
        The value.

    Returns
    -------
    str
    """
    if isinstance(found, KeyFigure):
        if found.bound == "holds":
            return "yes" if found.value == 1.0 else "no"
        if not found.band and found.bound in ("equals", "beside") and found.limit is not None:
            digits = _digits_beside(found.printed or given_text(found.limit, found.unit))
            return with_unit(formatted(found.value, digits, found.unit), found.unit)
        return value_text(found.value, found.unit, found.band)
    if isinstance(found, Verdict) and found.check == "holds":
        return "yes" if found.computed == 1.0 else "no"
    return value_text(found.computed, found.unit, found.band)


def certain_value(figure: KeyFigure) -> str:
    """The value of a key figure with its unit, in the digits that its band leaves, without it.

    Parameters
    ----------
    figure : KeyFigure
        The value.

    Returns
    -------
    str
        For sentences: "145.2 MN m/rad".
    """
    return value_text(figure.value, figure.unit, figure.band, with_band=False)


def percent_text(share: float, digits: int = 2) -> str:
    """The size of a share or relative difference in percent, for sentences: "0.083 %".

    Parameters
    ----------
    share : float
        1 of the whole; its sign is not shown.
    digits : int
        Significant digits.

    Returns
    -------
    str
    """
    return with_unit(formatted(100.0 * abs(share), digits, "%"), "%")


def difference_text(figure: KeyFigure, digits: int = 2) -> str:
    """The size of the difference of a key figure from its reference, for sentences: "0.46 %".

    Parameters
    ----------
    figure : KeyFigure
        One with a reference other than 0.
    digits : int
        Significant digits.

    Returns
    -------
    str
        In percent of the reference.

    Raises
    ------
    ValueError
        There is no such reference.
    """
    if figure.bound not in ("equals", "beside") or not figure.limit:
        raise ValueError(f"{figure.name}: there is no reference to be compared with")
    return percent_text(figure.value / figure.limit - 1.0, digits)


def limit_text(figure: KeyFigure) -> str:
    """The limit of a key figure, with whose it is: "at most 4 000 MPa", "727.0 Hz (NAFEMS)".

    Parameters
    ----------
    figure : KeyFigure
        One whose `bound` may be empty.

    Returns
    -------
    str
        Empty where there is no limit.
    """
    if not figure.bound or figure.bound == "holds":
        return f"({figure.by})" if figure.by else ""
    low = figure.printed or given_text(figure.limit, figure.unit)
    if figure.bound == "between":
        low = f"{low} to {given_text(figure.upper, figure.unit)}"
    if figure.bound == "equals" and figure.allowed > _NEGLIGIBLE * abs(figure.limit or 0.0):
        low = f"{low} ± {formatted(figure.allowed, 2, figure.unit)}"
    words = {"at most": "at most ", "at least": "at least ", "equals": "expected "}
    by = f" ({figure.by})" if figure.by else ""
    return f"{words.get(figure.bound, '')}{with_unit(low, figure.unit)}{by}"


def standing_words(figure: KeyFigure) -> str:
    """How a key figure stands to its limit: on pages and in a terminal.

    Parameters
    ----------
    figure : KeyFigure
        The value.

    Returns
    -------
    str
        Empty where nothing is asked of it.
    """
    if figure.status == "none" or figure.bound in ("", "beside"):
        return ""
    if figure.bound == "holds":
        return "holds" if figure.status == "good" else "does not hold"
    if figure.bound == "equals":
        return "agrees" if figure.status == "good" else "differs"
    beyond = "below" if figure.bound == "at least" else "beyond"
    return {"good": "within", "watch": "near", "bad": beyond}[figure.status]


def standing_text(figure: KeyFigure) -> str:
    """What `standing_words` says, with a mark before it, so that no colour is needed to see it.

    Parameters
    ----------
    figure : KeyFigure
        The value.

    Returns
    -------
    str
        Empty where nothing is asked of it.
    """
    words = standing_words(figure)
    return f"{_MARKS[figure.status]} {words}" if words else ""


def standing_of_answer(answer: Answer) -> tuple[Status, str] | None:
    """How an answer as a whole stands, as status and in words.

    Parameters
    ----------
    answer : Answer
        With a status of its figures, or with a claim.

    Returns
    -------
    tuple or None
        None where nothing was asked of any figure.
    """
    if answer.claim:
        alone: Status = "good" if answer.claim == "holds" else "watch"
        status = alone if answer.status == "none" else answer.status
        return status, f"The source's statement {answer.claim}"
    words: dict[Status, str] = {
        "good": "within all limits",
        "watch": "near a limit",
        "bad": "beyond a limit",
    }
    if answer.status not in words:
        return None
    return answer.status, f"{_MARKS[answer.status]} {words[answer.status]}"


def given_text(value: float | int | str | bool | None, unit: str | None = None) -> str:
    """A number that somebody has given, with all its digits; a computed one has too many.

    Parameters
    ----------
    value : float, int, str, bool or None
        A reference, a limit, or an assumption.
    unit : str or None
        As in `formatted`.

    Returns
    -------
    str
        In four digits where it has more than a source prints.
    """
    few = isinstance(value, float) and math.isclose(
        float(f"{value:.{_PRINTED_DIGITS - 1}e}"), value, rel_tol=_ROUND_OFF
    )
    return formatted(value, _PRINTED_DIGITS if few else DIGITS, unit)


def computed_text(verdict: Verdict) -> str:
    """The computed value; of a statement, whether it holds."""
    if verdict.check == "holds":
        return "yes" if verdict.computed == 1.0 else "no"
    if verdict.band:
        return _digits_of(verdict.computed, verdict.unit, verdict.band, with_band=False)
    given = given_text(verdict.reference, verdict.unit) if verdict.check == "equals" else ""
    return formatted(verdict.computed, _digits_beside(given), verdict.unit)


def _digits_beside(reference: str) -> int:
    """Digits of a value without a band that stands beside a reference: as many as that has."""
    mantissa = reference.partition("\u00a0×")[0]
    digits = "".join(letter for letter in mantissa if letter.isdigit()).lstrip("0")
    return max(DIGITS, min(len(digits), _COMPARED_DIGITS))


def expected_text(verdict: Verdict, printed: str = "") -> str:
    """What a check asks for: a reference, zero, a bound, a range, or that a statement holds.

    Parameters
    ----------
    verdict : Verdict
        The check.
    printed : str
        The reference as its source prints it, where that is known.

    Returns
    -------
    str
    """
    reference = printed or given_text(verdict.reference, verdict.unit)
    if verdict.check == "at most":
        return f"≤\u00a0{reference}"
    if verdict.check == "at least":
        return f"≥\u00a0{reference}"
    if verdict.check == "between":
        return f"{reference} to {given_text(verdict.upper, verdict.unit)}"
    return {"vanishes": "0", "holds": "yes"}.get(verdict.check, reference)


def error_text(verdict: Verdict) -> str:
    """The error of a verdict: in percent of the reference, or in the unit; none of a bound.

    It has no digit beyond the band of the computed value.
    """
    if verdict.check not in ("equals", "vanishes"):
        return "–"
    error, unit, size = verdict.computed - verdict.reference, verdict.unit, 1.0
    if verdict.relative and verdict.reference != 0:
        unit, size = "%", 100.0 / abs(verdict.reference)
    if verdict.band and math.isfinite(error):
        number = _digits_of(error * size, unit, verdict.band * size, with_band=False)
        if not number.startswith("~") or verdict.passed:
            return with_unit(("+" if error > 0 and number[0] != "~" else "") + number, unit)
    return _signed(error * size, unit)


def band_text(verdict: Verdict) -> str:
    """The band of a computed value: in percent of it, or in the unit."""
    if verdict.band is None:
        return "–"
    if verdict.relative and verdict.computed != 0:
        return f"±{formatted(100 * verdict.band / abs(verdict.computed), 2, '%')}\u00a0%"
    return f"±{with_unit(formatted(verdict.band, 2, verdict.unit), verdict.unit)}"


def safe_range(limit: Limit) -> str:
    """The safe range of a limit, as a table shows it."""
    unit = None if limit.parameter.endswith("]") else ""
    low, high = (
        None if end is None else formatted(end, 3, unit) for end in (limit.low, limit.high)
    )
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
