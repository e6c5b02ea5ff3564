"""Columns of a table by their titles, in the memory of those that are wanted."""

from __future__ import annotations

import re
from collections.abc import Collection
from pathlib import Path

import numpy as np

from fe_drivetrain.turbine_loads.hub_loads.channels import Channel
from fe_drivetrain.turbine_loads.hub_loads.csv_table import is_of_point
from fe_drivetrain.turbine_loads.hub_loads.table_kinds import history_table


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
        A table with a header like ``time [s],thrust [kN]``, of any kind: see `history_table`.
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
    table = history_table(file, "table")
    found: dict[str, Channel] = {}
    places: dict[str, int] = {}
    bare = {name.lower() for name in units}.union(times)
    for place, title in enumerate(table.titles):
        match = re.fullmatch(r"\s*(.+?)\s*[\[(]\s*(.*?)\s*[\])]\s*", title)
        if match is None and title.strip().lower() in bare:
            match = re.fullmatch(r"\s*(.+?)()\s*", title)
        if match is not None and match[1].lower() not in found:
            found[match[1].lower()] = Channel(match[1], match[2], np.zeros(0))
            if match[1].lower() in wanted or (points and is_of_point(match[1])):
                places[match[1].lower()] = place
    if not places:
        return found
    clocks = [place for name, place in places.items() if name in times]
    columns = table.columns(list(places.values()), clocks)
    for name, place in places.items():
        note = columns.words if place in clocks else ""
        unit = "s" if note else found[name].unit
        found[name] = Channel(found[name].name, unit, columns.values[place], note, columns.rows)
    return found
