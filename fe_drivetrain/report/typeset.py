"""Plain text as a page prints it: superscripts, powers of ten, minus signs."""

from __future__ import annotations

import re

MINUS = "\u2212"
THIN_SPACE = "\u202f"
"""The narrow no-break one: a number never breaks over two lines."""

_SUPERSCRIPTS = str.maketrans("-0123456789.", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹\u00b7")
# 1e-8, 3.4e+08; not x1e5 of a name, #009e73 of a colour, nor key=4e5 of a command
_SCIENTIFIC = re.compile(r"(?<![\w.=#])(-?\d+(?:\.\d+)?)e([+-]?\d+)\b")
_FACTOR = re.compile(r"(?<=\d\))e([+-]?\d+)\b")
_POWER = re.compile(r"\^(-?\d+(?:\.\d+)?)(?![\d/])")
_NEGATIVE = re.compile(r"(?<![\w.=\"'\])-])-(?=\d)")


def superscript(power: int | str) -> str:
    """A power in superscripts."""
    return str(power).translate(_SUPERSCRIPTS)


def typeset(text: str) -> str:
    """Text with m^2 as m², 1e-8 as 10⁻⁸, 3.4e+08 as 3.4 × 10⁸, and minus signs before numbers.

    A number and its % stay on one line. What is to be typed again, as ``--set key=-4e5``, is
    left alone.
    """
    text = _SCIENTIFIC.sub(_power_of_ten, text)
    text = _FACTOR.sub(lambda found: f"\u00a0×\u00a010{superscript(int(found[1]))}", text)
    text = re.sub(r"(?<=\d) ?%", "\u00a0%", text)
    text = _POWER.sub(lambda found: superscript(found[1]), text)
    return _NEGATIVE.sub(MINUS, text)


def _power_of_ten(found: re.Match[str]) -> str:
    if found[2].startswith("+") and int(found[2]) < 6:  # as "{:.1g}" writes 200
        return f"{float(found[0]):,.0f}"
    power = f"10{superscript(int(found[2]))}"
    return power if float(found[1]) == 1.0 else f"{found[1]}\u00a0×\u00a0{power}"
