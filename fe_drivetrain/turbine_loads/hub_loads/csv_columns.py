"""Columns of a table by their titles, in the memory of those that are wanted."""

from __future__ import annotations

import csv
import re
from collections.abc import Collection
from pathlib import Path

import numpy as np

from fe_drivetrain.common.csv_cells import cell_as_given
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.channels import Channel, not_utf8
from fe_drivetrain.turbine_loads.hub_loads.csv_table import is_of_point
from fe_drivetrain.turbine_loads.hub_loads.stamps import TimeColumn


def csv_channels(
    file: Path,
    wanted: Collection[str],
    units: Collection[str] = (),
    points: bool = False,
    times: Collection[str] = (),
) -> dict[str, Channel]:
    """Columns of a table that have a unit, by their names in lower case.

    Parameters
    ----------
    file : Path
        A table with a header like ``time [s],thrust [kN]``; lines with # before it are left out.
    wanted : collection of str
        Names in lower case; other columns have no values, so that a large table is read in the
        memory of what is used.
    units : collection of str
        Names of columns whose unit is known though their title has none.
    points : bool
        Whether columns like ``brake.Fz [kN]``, of loads at load points, are wanted, too.
    times : collection of str
        Names in lower case of columns that may be date-times, without a unit.

    Raises
    ------
    InputError
        A cell of a wanted column is not a number.
    """
    before, titles = table_header(file)
    found: dict[str, Channel] = {}
    places: dict[str, int] = {}
    stamps: dict[str, TimeColumn] = {}
    bare = {name.lower() for name in units}.union(times)
    for place, title in enumerate(titles):
        match = re.fullmatch(r"\s*(.+?)\s*[\[(]\s*(.*?)\s*[\])]\s*", title)
        if match is None and title.strip().lower() in bare:
            match = re.fullmatch(r"\s*(.+?)()\s*", title)
        if match is not None and match[1].lower() not in found:
            found[match[1].lower()] = Channel(match[1], match[2], np.zeros(0))
            if match[1].lower() in wanted or (points and is_of_point(match[1])):
                places[match[1].lower()] = place
                if match[1].lower() in times:
                    stamps[match[1].lower()] = TimeColumn()
    if not places:
        return found
    try:
        values = np.loadtxt(
            file,
            delimiter=",",
            skiprows=before,
            usecols=list(places.values()),
            converters={places[name]: read for name, read in stamps.items()} or None,
            ndmin=2,
            encoding="utf-8-sig",
        )
    except UnicodeDecodeError as error:
        raise not_utf8("table", file) from error
    except ValueError as error:
        raise InputError(
            f"table '{file}': {error}, counted below the header: correct the cell, or remove "
            "the line"
        ) from error
    for name, column in zip(places, values.T, strict=True):
        note = stamps[name].words if name in stamps else ""
        found[name] = Channel(found[name].name, "s" if note else found[name].unit, column, note)
    return found


def table_header(file: Path) -> tuple[int, list[str]]:
    """The line of a table's header, from 1, and its titles.

    Parameters
    ----------
    file : Path
        The table.

    Raises
    ------
    InputError
        It is not text.
    """
    before, titles = 0, ""
    try:
        with file.open(encoding="utf-8-sig") as stream:
            for before, line in enumerate(stream, 1):  # noqa: B007
                if line.strip() and not line.startswith("#"):
                    titles = line
                    break
    except UnicodeDecodeError as error:
        raise not_utf8("table", file) from error
    return before, [cell_as_given(title.strip()) for title in next(csv.reader([titles]), [])]
