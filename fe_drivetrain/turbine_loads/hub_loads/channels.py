"""Columns of a file with hub loads: numbers, units and conversion to SI."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import why_unreadable
from fe_drivetrain.common.regular_files import require_regular

_MAX_BYTES = 8_000_000_000  # of one file of loads or wind, which memory holds whole


@dataclass(frozen=True, eq=False)
class Channel:
    """One column of a file: its name there, its unit there, its samples (n,) as written.

    A note says how they were read where they are not numbers there; rows are the line of each
    sample in a table.
    """

    name: str
    unit: str
    values: Floats
    note: str = ""
    rows: Sequence[int] | None = None

    @property
    def invalid(self) -> bool:
        """Whether OpenFAST did not compute it: it writes INVALID for its unit, and zeros."""
        return self.unit.upper() == "INVALID"


def parse_number(text: str) -> float:
    """The number that a cell holds; ValueError where it holds none.

    Python takes 1_0 for ten, and digits of any script: in a table these are slips.
    """
    if "_" in text or not text.isascii():
        raise ValueError(text)
    return float(text)


TIME_UNITS = {"s": 1.0, "sec": 1.0, "ms": 1e-3}
ANGLE_UNITS = {"deg": np.pi / 180.0, "rad": 1.0}
FORCE_UNITS = {"N": 1.0, "kN": 1e3, "MN": 1e6}
MOMENT_UNITS = {"Nm": 1.0, "kNm": 1e3, "MNm": 1e6}
LENGTH_UNITS = {"m": 1.0, "mm": 1e-3}
ACCELERATION_UNITS = {"m/s^2": 1.0, "g": GRAVITY, "mg": 1e-3 * GRAVITY}
TURN_UNITS = {"rad/s^2": 1.0, "deg/s^2": np.pi / 180.0}

_SPELLINGS = {
    **dict.fromkeys(("sec", "second", "seconds", "Sekunden", "Sek"), "s"),
    **dict.fromkeys(("m/sec", "mps", "ms^1", "ms1"), "m/s"),
    **dict.fromkeys(("rad/sec", "rads^1", "rads1"), "rad/s"),
    "deg/sec": "deg/s",
    **dict.fromkeys(("m/s2", "m/s\u00b2", "m/sec^2", "m/sec2", "ms^2", "ms2"), "m/s^2"),
    **dict.fromkeys(("rad/s2", "rad/s\u00b2", "rad/sec^2", "rads^2", "rads2"), "rad/s^2"),
    **dict.fromkeys(("deg/s2", "deg/s\u00b2", "deg/sec^2", "degs^2", "degs2"), "deg/s^2"),
    **dict.fromkeys(("RPM", "1/min", "U/min", "rev/min", "r/min", "min^1", "min1", "Upm"), "rpm"),
    **dict.fromkeys(("degrees", "degree", "Grad", "\u00b0"), "deg"),
    **dict.fromkeys(("radians", "radian"), "rad"),
}
"""Other ways to write a unit, as `_plain` has them."""


def in_si(
    source: str, channel: Channel, units: Mapping[str, float], kind: str = "hub loads"
) -> Floats:
    """Samples of a channel in SI units.

    Parameters
    ----------
    source : str
        The file, for messages.
    channel : Channel
        The column.
    units : mapping
        Size of each unit that it may have, in SI: `TIME_UNITS` and so on.
    kind : str
        What the file is, for messages.

    Returns
    -------
    ndarray, (n,)

    Raises
    ------
    InputError
        The unit is another.
    """
    unit = _plain(channel.unit)
    unit = unit if unit in units else _SPELLINGS.get(unit, unit)
    if unit not in units:
        raise InputError(
            f"{kind} '{source}': channel {channel.name} has the unit '{channel.unit}', not one "
            f"of {', '.join(units)}; correct the unit or the channel"
        )
    with np.errstate(over="ignore"):  # an infinity is refused with its place
        return np.asarray(channel.values * units[unit])


def without_unit(title: str) -> str:
    """The name of a column, of its title like "brake.Fz [kN]"."""
    return re.split(r"[\[(]", title, maxsplit=1)[0].strip()


def is_load_unit(title: str) -> bool:
    """Whether the title of a column ends with a unit of force or moment."""
    unit = re.search(r"[\[(]\s*(.*?)\s*[\])]\s*$", title)
    return unit is not None and _plain(unit[1]) in FORCE_UNITS | MOMENT_UNITS


def is_unit(text: str) -> bool:
    """Whether a word is a unit of time, angle, speed, force or moment."""
    known = {*TIME_UNITS, *ANGLE_UNITS, *FORCE_UNITS, *MOMENT_UNITS, *_SPELLINGS.values()}
    unit = _plain(text)
    return _SPELLINGS.get(unit, unit) in known


def _plain(unit: str) -> str:
    # "N m", "N-m", "N.m", "N*m" and "N·m" are one unit; upper and lower case are not (mN, MN).
    return re.sub(r"[\s·⋅*.\-]", "", unit)


def not_utf8(kind: str, file: Path) -> InputError:
    """The sentence about a table that is not text."""
    return InputError(f"{kind} '{file}': it is no text: save it as CSV in UTF-8")


def existing_file(path: str | os.PathLike[str], kind: str = "hub loads") -> Path:
    """The path of a regular file that may be read, and that memory can hold; else `InputError`."""
    file = Path(path)
    try:
        require_regular(file, _MAX_BYTES)
        if not os.access(file, os.R_OK):
            raise PermissionError
    except (OSError, ValueError) as error:
        raise InputError(f"{kind} '{file}': {why_unreadable(error)}") from error
    return file
