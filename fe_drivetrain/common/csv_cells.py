"""Tables as CSV whose text no spreadsheet takes for a formula.

A spreadsheet evaluates a cell that begins with one of ``= + - @``, a tab or a carriage return, and
names of files and channels may begin with anything. Such text has an apostrophe put before it, as
spreadsheets have text marked; numbers stay numbers.

Source: OWASP, CSV Injection.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, TextIO

_STARTS = ("=", "+", "-", "@", "\t", "\r", "\n", "\uff1d", "\uff0b", "\uff0d", "\uff20")
_MARK = "'"


class SafeWriter:
    """Writes rows of a table, each cell as `safe_cell` has it.

    Parameters
    ----------
    file : text file
        Opened with ``newline=""``.
    """

    def __init__(self, file: TextIO) -> None:
        self._file = file

    def writerow(self, row: Iterable[Any]) -> None:
        """Write one row."""
        self._file.write(f"{table_row(row)}\n")

    def writerows(self, rows: Iterable[Iterable[Any]]) -> None:
        """Write several rows."""
        for row in rows:
            self.writerow(row)

    def comments(self, facts: Iterable[str]) -> None:
        """Write lines that begin with "# ", one for each fact."""
        self._file.writelines(f"{comment_line(fact)}\n" for fact in facts)


def safe_cell(cell: Any) -> Any:
    """A cell that is shown and not evaluated.

    Parameters
    ----------
    cell : object
        Text that is no number has an apostrophe put before it where it begins as a formula does;
        all else is as it was.
    """
    if not isinstance(cell, str) or not cell.lstrip(" ").startswith(_STARTS) or _is_number(cell):
        return cell
    return f"{_MARK}{cell}"


def cell_as_given(cell: str) -> str:
    """The text that `safe_cell` was given."""
    is_marked = cell.startswith(_MARK) and safe_cell(cell[1:]) == cell
    return cell[1:] if is_marked else cell


def table_row(cells: Iterable[Any]) -> str:
    """One line of a table, as of the titles of its columns, without its end."""
    return ",".join("" if cell is None else _quoted(str(safe_cell(cell))) for cell in cells)


def comment_line(fact: str) -> str:
    """A statement as one line that begins with "# ", of which no cell begins as a formula does."""
    cells = " ".join(fact.split()).split(",")
    return "# " + ",".join([cells[0], *(safe_cell(cell) for cell in cells[1:])])


def comment_as_given(comment: str) -> str:
    """The statement that `comment_line` was given, from what follows its "#"."""
    cells = comment.split(",")
    return ",".join([cells[0], *(cell_as_given(cell) for cell in cells[1:])])


def _quoted(text: str) -> str:
    if any(character in text for character in ',"\r\n'):
        return '"' + text.replace('"', '""') + '"'
    return text


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
