"""Tables of text: cells between commas, semicolons or tabs, as programs and loggers write them."""

from __future__ import annotations

import codecs
import csv
import re
from array import array
from collections.abc import Collection, Iterator, Sequence
from itertools import islice
from pathlib import Path

import numpy as np

from fe_drivetrain.common.csv_cells import comment_as_given
from fe_drivetrain.turbine_loads.hub_loads.channels import not_utf8, parse_number
from fe_drivetrain.turbine_loads.hub_loads.history_table import CellTable, Columns

_SEPARATORS = (",", ";", "\t")
_SEP_LINE = re.compile(r'"?sep=([,;|\t]|\\t)"?[,;]*\s*', re.IGNORECASE)
_BLOCK = 1 << 20
_CONTROL = bytes(k for k in range(32) if chr(k) not in "\t\n\r\f") + b"\x7f"


class TextTable(CellTable):
    """A table of text (.csv, .tsv, .txt).

    Lines that begin with # are comments, of which those as "# key = value" become facts. A line
    "sep=;" at the beginning names what stands between cells; otherwise the header shows it.

    Parameters
    ----------
    file : Path
        The file.
    kind : str
        What it is, for messages.
    """

    def __init__(self, file: Path, kind: str) -> None:
        self.file, self.kind = file, kind
        self._encoding = _encoding(file, kind)
        self._separator, self._begin = self._layout()
        super().__init__(file, kind)

    def _layout(self) -> tuple[str, int]:
        """What stands between cells, and the line of the header."""
        given = ""
        with self.file.open(encoding=self._encoding) as stream:
            for number, line in enumerate(stream, start=1):
                text, named = line.strip(), _SEP_LINE.fullmatch(line)
                if named is not None and not given:
                    given = "\t" if named[1] == "\\t" else named[1]
                elif text and not line.startswith("#"):
                    return given or max(_SEPARATORS, key=text.count), number
        return ",", 1

    def cells(self) -> Iterator[tuple[int, list[str]]]:
        """Number of each line and its cells; those that are empty or comments are left out.

        Raises
        ------
        InputError
            Quotation marks do not match.
        """
        number = 0

        def lines() -> Iterator[str]:
            nonlocal number
            for number, line in self._lines():  # noqa: B007
                yield line

        try:
            for cells in csv.reader(lines(), delimiter=self._separator):
                yield number, cells
        except csv.Error as error:
            raise self.cannot(f"line {number}: {error}: correct the line") from error

    def _lines(self) -> Iterator[tuple[int, str]]:
        """Lines from the header on, but for comments, which become facts."""
        with self.file.open(encoding=self._encoding) as stream:
            for number, line in enumerate(stream, start=1):
                if line.startswith("#"):
                    key, equals, value = comment_as_given(line[1:]).partition("=")
                    if equals:
                        self.facts[key.strip()] = value.strip()
                elif number >= self._begin and not line.isspace():
                    yield number, line

    def columns(self, wanted: Sequence[int], times: Collection[int]) -> Columns:
        """Columns that are wanted.

        Parameters
        ----------
        wanted : sequence of int
            Their places.
        times : collection of int
            Places of those that may be date-times.

        Raises
        ------
        InputError
            A cell is no number.
        """
        first = next(islice(self._samples(), 1), None)
        if first is None:
            return Columns({place: np.zeros(0) for place in wanted}, [], "")
        try:
            for place in times:
                parse_number(first[1][place])
            return self._plain_columns(wanted)
        except (ValueError, IndexError):  # slower, and names the cell
            return super().columns(wanted, times)

    def _plain_columns(self, wanted: Sequence[int]) -> Columns:
        """Columns of a table whose cells are plain numbers; ValueError of any other."""
        rows = array("q")
        most, separator = len(self.titles) - 1, self._separator

        def lines() -> Iterator[str]:
            for number, line in self._lines():
                if number <= self.header:
                    continue
                if '"' in line or line.count(separator) > most:
                    raise ValueError(line)
                rows.append(number)
                yield line

        table = np.loadtxt(
            lines(), delimiter=separator, usecols=list(wanted), ndmin=2, comments=None
        )
        return Columns(dict(zip(wanted, table.T, strict=True)), rows, "")


def _encoding(file: Path, kind: str) -> str:
    """How letters of a file are written: UTF-8, UTF-16 with a mark, or Windows' code page 1252."""
    decoder = codecs.getincrementaldecoder("utf-8")()
    with file.open("rb") as stream:
        if stream.peek(2)[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE):
            return _checked(file, kind, "utf-16")
        try:
            while block := stream.read(_BLOCK):
                decoder.decode(block)
            decoder.decode(b"", final=True)
        except UnicodeDecodeError:
            return _checked(file, kind, "cp1252")
    return "utf-8-sig"


def _checked(file: Path, kind: str, encoding: str) -> str:
    """The encoding, where it makes text of a file."""
    decoder = codecs.getincrementaldecoder(encoding)()
    with file.open("rb") as stream:
        try:
            while block := stream.read(_BLOCK):
                decoder.decode(block)
                if encoding == "cp1252" and len(block.translate(None, _CONTROL)) < len(block):
                    raise not_utf8(kind, file)
            decoder.decode(b"", final=True)
        except UnicodeDecodeError as error:
            raise not_utf8(kind, file) from error
    return encoding
