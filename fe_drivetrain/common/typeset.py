"""Plain text as a page prints it: superscripts, powers of ten, minus signs."""

from __future__ import annotations

import math
import re
from functools import lru_cache

MINUS = "\u2212"
THIN_SPACE = "\u202f"
"""The narrow no-break one: a number never breaks over two lines."""

_SUPERSCRIPTS = str.maketrans("-+0123456789./hkmnpT", "⁻⁺⁰¹²³⁴⁵⁶⁷⁸⁹\u00b7ᐟʰᵏᵐⁿᵖᵀ")
# 1e-8, 3.4e+08; not x1e5 of a name, #009e73 of a colour, nor key=4e5 of a command
_SCIENTIFIC = re.compile(r"(?<![\w.=#])(-?\d+(?:\.\d+)?)e([+-]?\d+)\b")
_FACTOR = re.compile(r"(?<=\d\))e([+-]?\d+)\b")
# m^2, x^-1.5, h^p, cells^-1/2 (but of l^3/3EI the power is 3), e^(n + 1)
_POWER = re.compile(
    r"\^(?:(-?\d+/\d+)(?![\w.])|(-?\d+(?:\.\d+)?)(?!\d)|([hkmnpT])\b|\(([-+\d./hkmnpT ]+)\))"
)
_MICROMETRES = re.compile(r"(\d[ \u00a0]?|\[)um\b")
_NEGATIVE = re.compile(r"(?<![\w.=\"'\])-])-(?=\d)")


def superscript(power: int | str) -> str:
    """A power in superscripts."""
    return str(power).replace(" ", "").translate(_SUPERSCRIPTS)


@lru_cache(maxsize=65536)
def typeset(text: str) -> str:
    """Text with m^2 as m², h^p as hᵖ, 1e-8 as 10⁻⁸, 3.4e+08 as 3.4 × 10⁸, um as µm, minus signs.

    A number and its % stay on one line. What is to be typed again, as ``--set key=-4e5``, is
    left alone. What was set before is known: pages that list cases are written again and again.
    """
    text = _SCIENTIFIC.sub(_power_of_ten, text)
    text = _FACTOR.sub(lambda found: f"\u00a0×\u00a010{superscript(int(found[1]))}", text)
    text = re.sub(r"(?<=\d) ?%", "\u00a0%", text)
    text = _MICROMETRES.sub(r"\1µm", text)
    text = _POWER.sub(lambda found: superscript(found[found.lastindex or 0]), text)
    return _NEGATIVE.sub(MINUS, text)


def _power_of_ten(found: re.Match[str]) -> str:
    if found[2].startswith("+") and int(found[2]) < 6:  # as "{:.1g}" writes 200
        return f"{float(found[0]):,.0f}"
    power = f"10{superscript(int(found[2]))}"
    return power if float(found[1]) == 1.0 else f"{found[1]}\u00a0×\u00a0{power}"


def with_prefix(value: float, unit: str) -> str:
    """A positive number in its unit with an SI prefix: 80e6 N/m is "80 MN/m"."""
    power = min(max(math.floor(math.log10(value) / 3), 0), 4)
    return f"{value / 1e3**power:.4g} {('', 'k', 'M', 'G', 'T')[power]}{unit}"
