"""Numbers in cells of tables: decimal points or commas, and what separates thousands.

Which of both it is, cells themselves say: 0,5 has a decimal comma, and 1.234,5 points between
thousands, too. 1,234 alone may be either, and is refused.
"""

from __future__ import annotations

import re

from fe_drivetrain.turbine_loads.hub_loads.channels import parse_number

_GROUPED = re.compile(r"[1-9]\d{0,2}(?:[.,]\d{3})+")
_WITH_EXPONENT = re.compile(r"[-+\d.,]+[eE][-+]?\d+")
_ONE_MARK = re.compile(r"[-+]?\d+[.,]\d+(?:[eE][-+]?\d+)?")
_SPACES = re.compile("(?<=\\d)['\u2019 \u00a0\u202f](?=\\d{3}(?:\\D|$))")


class AmbiguousError(ValueError):
    """A cell that may be two numbers."""


class NumberForm:
    """How cells of a table write numbers; learns from them first, then reads them."""

    def __init__(self) -> None:
        self._decimals: list[str] = []
        self._thousands: set[str] = set()
        self._commas = False

    @property
    def open(self) -> bool:
        """Whether cells with a comma that were learnt from may all be either of two numbers."""
        return self._commas and not self._decimals

    @property
    def decimal(self) -> str:
        """What stands before decimals."""
        return self._decimals[0] if self._decimals else "."

    def learn(self, text: str) -> None:
        """Take what a cell says of the form.

        Parameters
        ----------
        text : str
            The cell.
        """
        if "," not in text and "." not in text:
            return
        number = _SPACES.sub("", text.strip()).lstrip("+-")
        points, commas = number.count("."), number.count(",")
        self._commas |= commas > 0
        if points and commas:
            last = "." if number.rfind(".") > number.rfind(",") else ","
            self._decimals.append(last)
            self._thousands.add("," if last == "." else ".")
        elif points > 1 or commas > 1:
            self._thousands.add("." if points else ",")
            self._decimals.append("," if points else ".")
        elif _WITH_EXPONENT.fullmatch(number) or not _GROUPED.fullmatch(number):
            self._decimals.append("." if points else ",")
        del self._decimals[1:]

    def learn_of_other(self, text: str) -> None:
        """Take what a cell of another column says, if that is a number and no date or word.

        Parameters
        ----------
        text : str
            The cell.
        """
        if _ONE_MARK.fullmatch(text.strip()):
            self.learn(text)

    def __call__(self, text: str) -> float:
        """The number of a cell.

        Parameters
        ----------
        text : str
            The cell.

        Raises
        ------
        ValueError
            It holds none, or one of another form than others.
        AmbiguousError
            It may be two numbers.
        """
        number = _SPACES.sub("", text.strip())
        other = "," if self.decimal == "." else "."
        if other in number:
            whole = number.lstrip("+-").split(self.decimal)[0]
            if not _GROUPED.fullmatch(whole):
                raise ValueError(text)
            if other not in self._thousands:
                raise AmbiguousError(text)
            number = number.replace(other, "")
        if self.decimal == ",":
            number = number.replace(",", ".")
        return parse_number(number)
