"""What a designation says: kind of bearing, bore, outside diameter and width.

Series and bores are read by the rule that all makers share (ISO 15, ISO 355, and DIN 623-1 for the
words); dimensions stand in ``dimension_series.yaml`` with their sources.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from importlib.resources import files as package_files
from typing import Literal, NamedTuple

import yaml

from fe_drivetrain.common.errors import InputError

Kind = Literal[
    "double_row_tapered",
    "single_row_tapered",
    "spherical_roller",
    "cylindrical",
    "toroidal",
    "ball",
]

_BORES = {"00": 10, "01": 12, "02": 15, "03": 17}
_EXAMPLES = "as in '240/600', 'NU 2220', '32222', '6309' or 'C 3060'"

# Series by kind: the column of their widths, by the digits of the designation.
_SPHERICAL = {
    **{code: code[1:] for code in ("222", "223", "230", "231", "232", "238", "239", "240", "241")},
    "213": "03",
    "248": "48",
    "249": "49",
}
_CYLINDRICAL = {
    **{code: code for code in ("10", "18", "20", "22", "23", "29", "30", "39", "49")},
    **{"2": "02", "3": "03", "4": "04", "19": "19"},
}
_TOROIDAL = {code: code for code in ("22", "23", "30", "31", "32", "39", "40", "41", "49")}
_TAPERED = {
    "302": "tapered 2",
    "322": "tapered 2",
    "332": "tapered 2",
    "303": "tapered 3",
    "313": "tapered 3",
    "323": "tapered 3",
    "320": "tapered 0",
    "330": "tapered 0",
    "331": "tapered 1",
    "329": "tapered 9",
}
_GROOVE = {"618": "18", "619": "19", "60": "10", "160": "00", "62": "02", "63": "03", "64": "04"}
_ANGULAR = {"718": "18", "719": "19", "70": "10", "72": "02", "73": "03"}
_ANGULAR_DEGREES = {"C": 15.0, "AC": 25.0, "A": 30.0, "B": 40.0}

_CYLINDRICAL_WORDS = ("NUP", "NNU", "NN", "NCF", "NJG", "NU", "NJ", "NF", "N", "SL", "SL18")
_FULL_COMPLEMENT = ("NCF", "NJG", "SL", "SL18")
_TWO_ROWS = ("NN", "NNU")


class Sizes(NamedTuple):
    """Boundary dimensions [m]: bore, outside diameter, width (of tapered bearings T)."""

    bore: float
    outside: float
    width: float


@dataclass(frozen=True)
class Designation:
    """A designation that was read.

    Attributes
    ----------
    text : str
        As it was given.
    kind : Kind
        Kind of bearing.
    series : str
        Its series, as in "240".
    bore : float
        Bore [m].
    dimension_series : str
        Name of the column of widths, as in "40"; of tapered bearings the series itself.
    full_complement : bool
        Whether it has no cage.
    rows : int
        Rows of rolling elements.
    contact_angle_deg : float or None
        Angle of ball bearings with angular contact, where the suffix states it; 0 of deep grooves
        [deg].
    """

    text: str
    kind: Kind
    series: str
    bore: float
    dimension_series: str
    full_complement: bool = False
    rows: int = 1
    contact_angle_deg: float | None = None

    @property
    def sizes(self) -> Sizes | None:
        """Boundary dimensions [m]; None where the table does not have this size."""
        found = _widths(self.dimension_series).get(round(1e3 * self.bore))
        return None if found is None else Sizes(self.bore, found[0] / 1000.0, found[1] / 1000.0)


def read_designation(text: str) -> Designation:
    """Kind, series and bore of a bearing by its designation.

    Parameters
    ----------
    text : str
        As a catalogue prints it, with or without spaces and suffixes: "240/600 ECA/W33",
        "NU 2220 ECP", "32222 J2", "6309", "C 3060 M", "NCF 1892 V", "7220 B".

    Returns
    -------
    found : Designation
        Kind, series and bore; sizes where the tables have them.

    Raises
    ------
    InputError
        It is no designation of a kind that is known here.
    """
    plain = " ".join(text.upper().split())
    match = re.match(r"^(SL18|SL|N[A-Z]{0,2}|C)? ?(\d+)(?:/(\d{2,4})(?!\d))?", plain)
    if match is None:
        raise _unknown(text)
    word, digits, slash = match.group(1) or "", match.group(2), match.group(3)
    suffix = plain[match.end() :].strip()
    for kind, words, series in _KINDS:
        if word not in words:
            continue
        for code in sorted(series, key=len, reverse=True):
            bore = _bore(digits[len(code) :], slash) if digits.startswith(code) else None
            if bore is not None:
                return Designation(
                    text,
                    kind,
                    f"{word} {code}".strip(),
                    bore,
                    code if kind == "single_row_tapered" else series[code],
                    word in _FULL_COMPLEMENT or (kind == "toroidal" and suffix.startswith("V")),
                    2 if kind == "spherical_roller" or word in _TWO_ROWS else 1,
                    _angle(series, suffix),
                )
    raise _unknown(text)


_KINDS: tuple[tuple[Kind, tuple[str, ...], dict[str, str]], ...] = (
    ("spherical_roller", ("",), _SPHERICAL),
    ("single_row_tapered", ("",), _TAPERED),
    ("ball", ("",), _GROOVE),
    ("ball", ("",), _ANGULAR),
    ("toroidal", ("C",), _TOROIDAL),
    ("cylindrical", _CYLINDRICAL_WORDS, _CYLINDRICAL),
)


def _angle(series: dict[str, str], suffix: str) -> float | None:
    """Contact angle that a ball bearing's designation states [deg]."""
    if series is _GROOVE:
        return 0.0
    if series is _ANGULAR:
        letters = re.match(r"[A-Z]*", suffix)
        word = letters.group(0) if letters else ""
        for known in ("AC", "B", "C", "A"):
            if word.startswith(known):
                return _ANGULAR_DEGREES[known]
    return None


def _bore(code: str, slash: str | None) -> float | None:
    """Bore [m] from what follows the series: two digits, or millimetres after a slash."""
    if slash is not None:
        return int(slash) / 1000.0 if not code else None
    if len(code) != 2:
        return None
    millimetres = _BORES.get(code, 5 * int(code))
    return millimetres / 1000.0 if millimetres >= 10 else None


def _unknown(text: str) -> InputError:
    return InputError(
        f"designation {text!r} is none that can be read: write one of spherical, toroidal, "
        f"cylindrical, tapered or ball bearings, {_EXAMPLES}, or give kind, d, D and B instead"
    )


@cache
def _widths(series: str) -> dict[int, tuple[float, float]]:
    """Outside diameter and width [mm] by bore [mm] of a dimension series."""
    text = (
        package_files("fe_drivetrain.bearing").joinpath("dimension_series.yaml").read_text("utf-8")
    )
    tables = yaml.safe_load(text)
    table = tables[_TAPERED.get(series, series[-1])]
    column = [str(name) for name in table["columns"]].index(series)
    found = {}
    for line in table["rows"].splitlines():
        cells = line.split()
        if cells[column] != "-":
            found[int(cells[0])] = (float(cells[1]), float(cells[column]))
    return found
