"""Text output of OpenFAST and FAST (.out), of which only the channels that are wanted are parsed.

Channels stand under a line of names that begins with Time, and one of units in parentheses; what
precedes them differs between versions and modules.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Callable, Iterator, Sequence
from itertools import islice, pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.strict_yaml import shown

_MOST_HEADER = 60  # lines before the samples
_USUAL_NAMES = 6  # line of the names, from 0, in files of OpenFAST itself
_FORTRAN = re.compile(rb"([-+]?(?:\d+\.?\d*|\.\d+))(?:[dD]|(?=[-+]))([-+]?\d{1,3})")
_STARS = re.compile(r"[-+.\d]*\*+")


class MoreRunsError(ValueError):
    """A file has more than one run."""


class _Header(NamedTuple):
    """Names, units without parentheses, and how many lines go before the samples."""

    names: list[str]
    units: list[str]
    lines: int


def text_columns(
    file: Path, chosen_of: Callable[[list[str]], list[int]]
) -> tuple[list[str], list[str], Floats]:
    """Names, units and values (samples, chosen) of a .out, time first.

    Parameters
    ----------
    file : Path
        The file.
    chosen_of : callable
        Places of the channels that have values, of the names of all.

    Raises
    ------
    InputError
        A line has another number of values than there are channels, or a cell that is read is no
        number.
    MoreRunsError
        Time begins again.
    """
    with file.open("rb") as stream:
        header = _header(list(islice(stream, _MOST_HEADER)))
    chosen = chosen_of(header.names)
    if not chosen:
        return header.names, header.units, np.zeros((0, 0))
    values = array("d")
    with file.open("rb") as stream:
        lines = enumerate(islice(stream, header.lines, None), start=header.lines + 1)
        for number, line, cells in _samples(file, lines, header):
            try:
                if b"_" in line:
                    raise ValueError
                values.extend([float(cells[k]) for k in chosen])
            except ValueError:
                values.extend([_number(file, number, header, k, cells[k]) for k in chosen])
    if not values:
        raise InputError(f"hub loads '{file}': it has no samples; run OpenFAST again")
    table = np.frombuffer(values).reshape(-1, len(chosen))
    return header.names, header.units, table


def decoded(text: bytes) -> str:
    """Text of a header, whatever its code.

    Parameters
    ----------
    text : bytes
        As UTF-8, or else Latin-1.
    """
    try:
        return text.decode()
    except UnicodeDecodeError:
        return text.decode("latin-1")


def _header(lines: Sequence[bytes]) -> _Header:
    """The header of a file, of its first lines."""
    texts = [decoded(line).split() for line in lines]
    places = [
        k
        for k, (names, units) in enumerate(pairwise(texts))
        if names and names[0].lower().lstrip("-_") == "time" and _are_units(units)
    ]
    place = places[0] if places else _USUAL_NAMES
    if len(texts) < place + 2:
        raise ValueError(f"it has {len(texts)} lines and no samples")
    names, units = texts[place], texts[place + 1]
    if len(names) != len(units):
        raise ValueError(f"it has {len(names)} names of channels and {len(units)} units")
    return _Header(names, [unit.strip("()") for unit in units], place + 2)


def _are_units(cells: Sequence[str]) -> bool:
    return bool(cells) and cells[0].startswith("(")


def _samples(
    file: Path, lines: Iterator[tuple[int, bytes]], header: _Header
) -> Iterator[tuple[int, bytes, list[bytes]]]:
    """Number, text and cells of lines of samples; a header that is repeated in a run is skipped."""
    first, count, last = header.names[0].encode(), len(header.names), b"-inf"
    again = 0  # line of a repeated header, whose units and first sample follow
    for number, line in lines:
        cells = line.split()
        if not cells:
            continue
        if again and number == again + 1:
            continue
        if len(cells) != count and cells[0] != first:
            ahead = _header_ahead(lines, first)
            if ahead is None:
                raise _ragged(file, number, cells, count)
            number, cells = ahead
        if cells[0] == first:
            again = number
            if [decoded(cell) for cell in cells] != header.names:
                raise MoreRunsError(
                    f"line {number} has other names of channels than line {header.lines - 1}, "
                    "where a second run begins: give each run a file of its own"
                )
            continue
        if again and not _is_later(cells[0], last):
            raise MoreRunsError(
                f"line {again} has the names of channels again, where a second run begins: give "
                "each run a file of its own"
            )
        again, last = 0, cells[0]
        yield number, line, cells


def _header_ahead(
    lines: Iterator[tuple[int, bytes]], first: bytes
) -> tuple[int, list[bytes]] | None:
    """Number and cells of the next line that begins as that of the names; None where none is."""
    ahead = ((number, line.split()) for number, line in islice(lines, _MOST_HEADER))
    return next(((number, cells) for number, cells in ahead if cells[:1] == [first]), None)


def _is_later(time: bytes, last: bytes) -> bool:
    try:
        return float(time) > float(last)
    except ValueError:
        return False


_WIDER = (
    "widen OutFmt of the .fst file, as in ES16.7E3, or write the binary file (OutFileFmt 2), and "
    "run OpenFAST again"
)


def _ragged(file: Path, line: int, cells: Sequence[bytes], count: int) -> InputError:
    """The sentence about a line of which it is not known which value is of which channel."""
    what = f"hub loads '{file}': line {line} has {len(cells)} values for {count} channels"
    grown = [cell for cell in cells if re.search(rb"[.eE].*\d[-+]?\d*\..*\d", cell)]
    if len(cells) < count and grown:
        return InputError(f"{what}, as {shown(decoded(grown[0]))} has grown together; {_WIDER}")
    return InputError(f"{what}; run OpenFAST again")


def _number(file: Path, line: int, header: _Header, place: int, cell: bytes) -> float:
    """A number of a sample; refused with its line and channel."""
    try:
        return fortran_number(cell)
    except ValueError:
        text = decoded(cell)
    what = f"line {line}, channel {header.names[place]}: {shown(text)}"
    if _STARS.fullmatch(text):
        raise InputError(f"hub loads '{file}': {what} is a number that had no room; {_WIDER}")
    raise InputError(f"hub loads '{file}': {what} is not a number; run OpenFAST again")


def fortran_number(cell: bytes) -> float:
    """A number as Fortran prints it, where three digits of an exponent leave no room for its E.

    Parameters
    ----------
    cell : bytes
        As 1.5E-02, 1.5D-02 or 1.5-102.

    Raises
    ------
    ValueError
        It is none.
    """
    try:
        if b"_" in cell:  # Python takes 1_0 for ten
            raise ValueError(cell)
        return float(cell)
    except ValueError:
        match = _FORTRAN.fullmatch(cell)
        if match is None:
            raise
    return float(match[1] + b"e" + match[2])
