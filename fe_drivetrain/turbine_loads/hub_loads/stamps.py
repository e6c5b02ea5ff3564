"""Time columns of tables: numbers, or date-times as loggers write them."""

from __future__ import annotations

import re
from collections.abc import Callable
from datetime import datetime

from fe_drivetrain.turbine_loads.hub_loads.channels import parse_number

EXAMPLE = "2024-03-01T12:00:00.02"

_CLOCK = r"(\d{1,2}:\d{2}(?::\d{2}(?:[.,]\d+)?)?)"
_GERMAN = re.compile(rf"(\d{{1,2}})\.(\d{{1,2}})\.(\d{{4}}),?[ T]+{_CLOCK}")
_SLASHES = re.compile(rf"(\d{{4}})/(\d{{1,2}})/(\d{{1,2}})[ T]+{_CLOCK}")
_UNCLEAR = re.compile(rf"\d{{1,2}}/\d{{1,2}}/\d{{2,4}},?[ T]+{_CLOCK}.*")


class TimeColumn:
    """Reads the cells of a time column one after the other; the first one decides on their form.

    Parameters
    ----------
    number : callable
        Reads a cell that is a number.

    Attributes
    ----------
    first : datetime or None
        The first of date-times, from which seconds count; None of numbers.
    """

    def __init__(self, number: Callable[[str], float] = parse_number) -> None:
        self.first: datetime | None = None
        self._begun = False
        self._parse = number

    def __call__(self, text: str) -> float:
        """The number of a cell, or its seconds since the first date-time.

        Parameters
        ----------
        text : str
            A number, or a date-time like 2024-03-01T12:00:00.02, 2024/3/1 12:00:00 or
            1.3.2024 12:00:00,02, with an offset from UTC in all cells or in none, or a time of day.

        Raises
        ------
        ValueError
            It has another form, or not that of the first cell.
        """
        if self.first is None:
            try:
                return self._number(text)
            except ValueError:
                if self._begun or not is_stamp(text):
                    raise
        stamp = _date_time(text)
        self.first = self.first or stamp
        if (stamp.tzinfo is None) is not (self.first.tzinfo is None):
            raise ValueError(f"{text} and {self.first} do not both have an offset from UTC")
        return (stamp - self.first).total_seconds()

    def _number(self, text: str) -> float:
        number = self._parse(text)
        self._begun = True
        return number

    @property
    def words(self) -> str:
        """How times were read, for what is stated of a history; empty of numbers."""
        if self.first is None:
            return ""
        return f"time from date-times, 0 s at {self.first.isoformat()}"


def is_stamp(text: str) -> bool:
    """Whether a cell is a date-time or a time of day.

    Parameters
    ----------
    text : str
        The cell.
    """
    if not re.search(r"\d[-:./T]\d", text):
        return False
    try:
        _date_time(text)
    except ValueError:
        return False
    return True


def unclear_date(text: str) -> str:
    """Why it is not known which date a cell has; empty of any other cell.

    Parameters
    ----------
    text : str
        The cell.
    """
    if _UNCLEAR.fullmatch(text.strip()) is None:
        return ""
    return "may have the day or the month first: write the year first"


def _date_time(text: str) -> datetime:
    """The date-time of a cell; a time of day is one of 1 January 1900."""
    cell = text.strip()
    if re.fullmatch(_CLOCK, cell):
        return datetime.fromisoformat(f"1900-01-01T{cell.zfill(len(cell) + (cell[1] == ':'))}")
    for pattern, order in ((_GERMAN, (3, 2, 1)), (_SLASHES, (1, 2, 3))):
        match = pattern.fullmatch(cell)
        if match is not None:
            year, month, day = (int(match[k]) for k in order)
            clock = match[4].zfill(len(match[4]) + (match[4][1] == ":"))
            return datetime.fromisoformat(f"{year:04}-{month:02}-{day:02}T{clock}")
    return datetime.fromisoformat(cell)
