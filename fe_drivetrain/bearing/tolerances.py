"""Tolerances of seats (ISO 286) and of rolling bearings (ISO 492), and clearances (ISO 5753-1).

The numbers stand in ``tolerances.yaml``, with what each was held against; the standards themselves
were not read. Letters a to d, j and s to zc are not there: give deviations.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from functools import cache
from importlib.resources import files as package_files
from typing import Any, Literal, NamedTuple, get_args

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import parse_mapping

ClearanceClass = Literal["C2", "CN", "C3", "C4"]
"""Classes of radial internal clearance, from small to large."""

MICRON = 1e-6


class Limits(NamedTuple):
    """The least and the most that a tolerance allows [m].

    Attributes
    ----------
    low, high : float
        Lower and upper limit [m].
    """

    low: float
    high: float

    @property
    def mean(self) -> float:
        """Middle of the tolerance [m]."""
        return 0.5 * (self.low + self.high)

    @property
    def width(self) -> float:
        """Width of the tolerance [m]."""
        return self.high - self.low


def shaft_limits(tolerance: str, diameter: float) -> Limits:
    """Limit deviations of a shaft of a tolerance class (ISO 286-1:1988, tables 1 and 2).

    Parameters
    ----------
    tolerance : str
        Class of letters e, f, g, h, js, k, m, n, p or r and a grade from 4 to 9, as ``"m6"``.
    diameter : float
        Nominal diameter [m].

    Raises
    ------
    InputError
        There is no such class here, or not for this diameter.
    """
    letter, grade = class_parts(tolerance, "shaft")
    at, width = _step(diameter, tolerance), _width(tolerance, grade, diameter)
    data = _data("iso_286")
    if letter == "h":
        low = -width
    elif letter == "js":
        low = -0.5 * width
    elif letter in data["below"]:
        low = -data["below"][letter][at] - width
    elif letter == "r":
        low = float(_at(data["r"], "r", diameter, f"tolerance class {tolerance!r}"))
    else:
        low = 0.0 if letter == "k" and grade > 7 else data["above"][letter][at]
    return Limits(MICRON * low, MICRON * (low + width))


def housing_limits(tolerance: str, diameter: float) -> Limits:
    """Limit deviations of a housing bore of a tolerance class (ISO 286-1:1988, tables 1 and 3).

    Holes mirror the deviation of the shaft of their letter; K, M and N up to grade 8, and P and R
    up to grade 7, are larger than that by the difference of their grade and the finer one, from 3
    to 500 mm.

    Parameters
    ----------
    tolerance : str
        Class of letters E, F, G, H, JS, K, M, N, P or R and a grade from 5 to 9, as ``"H7"``.
    diameter : float
        Nominal diameter [m].

    Raises
    ------
    InputError
        There is no such class here, or not for this diameter.
    """
    letter, grade = class_parts(tolerance, "housing")
    width = _width(tolerance, grade, diameter)
    small = letter.lower()
    if small in ("e", "f", "g", "h", "js"):
        shaft = shaft_limits(f"{small}{grade}", diameter)
        return Limits(-shaft.high, -shaft.low)
    finest = 8 if small in "kmn" else 7
    if grade > finest and (small != "n" or diameter > 0.5):
        raise InputError(
            f"tolerance class {tolerance!r} of a housing is not computed here: give one up to "
            f"grade {finest}, or deviations"
        )
    if small == "n" and grade > finest:
        return Limits(-MICRON * width, 0.0)
    high = -shaft_limits(f"{small}{min(grade, 7)}", diameter).low / MICRON
    if 0.003 < diameter <= 0.5:
        high += width - _width(tolerance, grade - 1, diameter)
    if small == "m" and grade == 6 and 0.25 < diameter <= 0.315:
        high = -9.0  # the one exception of the standard
    return Limits(MICRON * (high - width), MICRON * high)


def bore_limits(diameter: float) -> Limits:
    """Limit deviations of the bore of a bearing's inner ring, class Normal (ISO 492)."""
    t = _at(_data("iso_492")["bore"], "t", diameter, "bore of a bearing")
    return Limits(-MICRON * t, 0.0)


def outside_limits(diameter: float) -> Limits:
    """Limit deviations of the outside diameter of a bearing, class Normal (ISO 492)."""
    t = _at(_data("iso_492")["outside"], "t", diameter, "outside diameter of a bearing")
    return Limits(-MICRON * t, 0.0)


def class_clearance(kind: str, name: ClearanceClass, bore: float) -> Limits:
    """Radial internal clearance of a bearing before it is mounted (ISO 5753-1).

    Parameters
    ----------
    kind : str
        ``"ball"`` (deep groove), ``"cylindrical"`` or ``"spherical_roller"``, with cylindrical
        bore.
    name : {"C2", "CN", "C3", "C4"}
        Class.
    bore : float
        Bore of the bearing [m].

    Raises
    ------
    InputError
        There is no table for this kind, class or bore.
    """
    tables = _data("iso_5753")
    if kind not in tables or name not in get_args(ClearanceClass):
        raise InputError(
            f"clearance class {name!r} of a bearing of kind {kind!r}: there are tables of "
            f"{', '.join(get_args(ClearanceClass))} for {', '.join(tables)}: give "
            "internal_clearance in m"
        )
    table = tables[kind]
    pair = _at(table, name, bore, f"clearance class {name} of a bearing of kind {kind}")
    return Limits(*(MICRON * one for one in pair))


def class_parts(tolerance: str, of: Literal["shaft", "housing"]) -> tuple[str, int]:
    """Letter and grade of a tolerance class.

    Parameters
    ----------
    tolerance : str
        Class, as ``"m6"``.
    of : {"shaft", "housing"}
        What it is of.

    Raises
    ------
    InputError
        There is no such class here.
    """
    letters = "e|f|g|h|js|k|m|n|p|r"
    grades = "[4-9]"
    if of == "housing":
        letters, grades = letters.upper(), "[5-9]"
    found = re.fullmatch(f"({letters})({grades})", tolerance)
    if found is None:
        raise InputError(
            f"tolerance class {tolerance!r} of a {of} is none of {letters.replace('|', ', ')} with "
            f"a grade {grades[1]} to {grades[3]}: give one, as "
            f"{'m6' if of == 'shaft' else 'H7'}, or two deviations in m"
        )
    return found[1], int(found[2])


def _width(tolerance: str, grade: int, diameter: float) -> float:
    """Standard tolerance of a grade [um]."""
    return float(_data("iso_286")["grades"][f"it{grade}"][_step(diameter, tolerance)])


def _step(diameter: float, tolerance: str) -> int:
    return _place(_data("iso_286")["steps"], diameter, f"tolerance class {tolerance!r}")


def _at(table: dict[str, Any], key: str, diameter: float, what: str) -> Any:
    """The value of a table at a diameter [m]."""
    place = _place(table["steps"][: len(table[key])], diameter, what)
    return table[key][place]


def _place(steps: list[float], diameter: float, what: str) -> int:
    mm = round(1e3 * diameter, 6)
    if not 0.0 < mm <= steps[-1]:
        raise InputError(
            f"{what} at a diameter of {mm:g} mm: its table reaches up to {steps[-1]:g} mm: give "
            "deviations, or a clearance, in m"
        )
    return bisect_left(steps, mm)


@cache
def _data(name: str) -> Any:
    text = package_files("fe_drivetrain.bearing").joinpath("tolerances.yaml").read_text("utf-8")
    return parse_mapping(text, "tolerances.yaml")[name]
