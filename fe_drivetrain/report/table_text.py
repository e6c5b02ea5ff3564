"""Cells of a table as a page prints them: no digit beyond the band that stands beside a value."""

from __future__ import annotations

import re
from collections.abc import Sequence

from fe_drivetrain.plots.style import is_number
from fe_drivetrain.report.number_text import formatted, value_text
from fe_drivetrain.report.results import Cell, Table

_UNIT = re.compile(r"\s*\[([^\]]*)\]\s*$")
_BAND = re.compile(r"±|\bband\b")
_BAND_DIGITS = 2
_PERCENT = 0.01


def numeric_columns(table: Table) -> set[int]:
    """Which columns hold numbers, and perhaps gaps, but nothing else.

    Parameters
    ----------
    table : Table
        Table of a page.

    Returns
    -------
    set of int
        Their numbers, from 0.
    """
    columns = list(zip(*table.rows, strict=False))
    return {
        number
        for number, cells in enumerate(columns)
        if any(map(is_number, cells)) and all(c is None or is_number(c) for c in cells)
    }


def band_columns(table: Table) -> dict[int, int]:
    """Which column has the band of which: a heading with "±" is that of a band.

    A band belongs to the column of the same name; or else to the nearest one of numbers on its
    left that has its unit, or, where its unit is percent, to the nearest that has another unit, of
    which it is a share.

    Parameters
    ----------
    table : Table
        Table of a page.

    Returns
    -------
    dict
        Number of the column of the values, and that of their band.
    """
    numeric = sorted(numeric_columns(table))
    headings = [_split(heading) for heading in table.columns]
    values = [n for n in numeric if "±" not in table.columns[n]]
    found: dict[int, int] = {}
    for band in numeric:
        if band in values:
            continue
        free = [n for n in values if n not in found]
        same = [n for n in free if headings[n] == headings[band]]
        left = [n for n in reversed(free) if n < band and _bounds(headings[band], headings[n])]
        if same or left:
            found[(same or left)[0]] = band
    return found


def _bounds(band: tuple[str, str], value: tuple[str, str]) -> bool:
    """Whether a band may be of a value, by name and unit of both."""
    if band[1] != "%":
        return band[1] == value[1]
    # one in percent that has no name of its own may be one of an error in percent
    return value[1] != "s" and (value[1] != "%" or not band[0])


def _split(heading: str) -> tuple[str, str]:
    """Name, without words for a band, and unit of a heading."""
    unit = _UNIT.search(heading)
    name = heading[: unit.start()] if unit else heading
    return " ".join(_BAND.sub(" ", name).split()), unit.group(1) if unit else ""


def cell_texts(table: Table) -> list[list[str]]:
    """Every cell as a page prints it.

    Parameters
    ----------
    table : Table
        Table of a page.

    Returns
    -------
    list of list of str
        By row and column. A value with a band in its row is rounded to it, a band to two digits,
        any other number to four.
    """
    bands = band_columns(table)
    units = [_split(heading)[1] for heading in table.columns]
    return [[_text(row, number, bands, units) for number in range(len(row))] for row in table.rows]


def _text(row: Sequence[Cell], number: int, bands: dict[int, int], units: Sequence[str]) -> str:
    value = row[number]
    unit = units[number] if units[number] in ("%", "-") else None  # any power of ten
    if not isinstance(value, float):
        return formatted(value, unit=unit)
    if number in bands.values():
        return formatted(value, _BAND_DIGITS, unit)
    band = row[bands[number]] if number in bands else None
    if band is None or isinstance(band, str) or not band:
        return formatted(value, unit=unit)
    share = abs(value) * _PERCENT if units[bands[number]] == "%" != units[number] else 1.0
    return value_text(value, "", abs(band) * share, with_band=False)
