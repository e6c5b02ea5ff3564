"""Time columns of tables: numbers, or date-times of ISO 8601 as loggers write them."""

from __future__ import annotations

from datetime import datetime

from fe_drivetrain.turbine_loads.hub_loads.channels import parse_number

EXAMPLE = "2024-03-01T12:00:00.02"


class TimeColumn:
    """Reads the cells of a time column one after the other; the first one decides on their form.

    Attributes
    ----------
    first : datetime or None
        The first of date-times, from which seconds count; None of numbers.
    """

    def __init__(self) -> None:
        self.first: datetime | None = None
        self._begun = False

    def __call__(self, text: str) -> float:
        """The number of a cell, or its seconds since the first date-time.

        Parameters
        ----------
        text : str
            A number, or a date-time like 2024-03-01T12:00:00.02, with an offset from UTC in all
            cells or in none.

        Raises
        ------
        ValueError
            It has another form, or not that of the first cell.
        """
        if self.first is None:
            try:
                return self._number(text)
            except ValueError:
                if self._begun:
                    raise
        stamp = datetime.fromisoformat(text.strip())
        self.first = self.first or stamp
        if (stamp.tzinfo is None) is not (self.first.tzinfo is None):
            raise ValueError(f"{text} and {self.first} do not both have an offset from UTC")
        return (stamp - self.first).total_seconds()

    def _number(self, text: str) -> float:
        number = parse_number(text)
        self._begun = True
        return number

    @property
    def words(self) -> str:
        """How times were read, for what is stated of a history; empty of numbers."""
        if self.first is None:
            return ""
        return f"time from date-times, 0 s at {self.first.isoformat()}"
