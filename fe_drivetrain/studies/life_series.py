"""Loads of raceways, and of chosen rollers, over time: what ``life`` gives beside its sums."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fe_drivetrain.bearing.geometry import Row, angles
from fe_drivetrain.bearing_life.life.steps import Steps
from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.studies.rolling_bearings import OneBearing, row_names


@dataclass(frozen=True, eq=False)
class LoadSeries:
    """Loads within a bearing over time, in one file.

    Attributes
    ----------
    bearing : str
        Name of the bearing.
    file : Path
        File with the hub loads.
    columns : tuple of str
        What each column is, with its unit: speed, and of each row the load of its raceway, which
        is the sum over its rolling elements, that of the most loaded element, and those of the
        chosen ones with their places.
    time : ndarray, (n,)
        Time in the file [s].
    values : ndarray, (n, columns)
        The values.
    """

    bearing: str
    file: Path
    columns: tuple[str, ...]
    time: Floats
    values: Floats

    __repr__ = short_repr


def has_series(one: OneBearing) -> bool:
    """Whether loads of a bearing follow the time: those of planets also go with the carrier."""
    return one.path.repeats == 1


def require_rollers(bearings: Sequence[OneBearing], rollers: Sequence[int]) -> None:
    """Refuse places that no bearing has.

    Parameters
    ----------
    bearings : sequence of OneBearing
        The bearings.
    rollers : sequence of int
        Numbers of rolling elements, from 1.

    Raises
    ------
    InputError
        A place is in no row, or all bearings are those of planets.
    """
    name = argument("LifeOptions.series")
    followed = [one for one in bearings if has_series(one)]
    if not followed:
        raise InputError(
            f"{name}: loads of {', '.join(one.name for one in bearings)} go with the planets' "
            "carrier and not with time alone: name another bearing, or leave it out"
        )
    most = {one.name: max(one.rated.bearing.counts) for one in followed}
    for roller in rollers:
        if not 1 <= roller <= max(most.values()):
            rows = ", ".join(f"1 to {count} in {bearing}" for bearing, count in most.items())
            raise InputError(
                f"{name}: there is no rolling element {roller}: they are numbered {rows}"
            )


def series_columns(one: OneBearing, rollers: Sequence[int]) -> tuple[str, ...]:
    """What the columns of `series_values` are.

    Parameters
    ----------
    one : OneBearing
        The bearing.
    rollers : sequence of int
        Numbers of rolling elements, from 1; a row that has no such element has no such column.
    """
    columns = ["speed [1/min]"]
    for word, row, own in _rows(one, rollers):
        columns += [f"{word}, raceway [kN]", f"{word}, peak element [kN]"]
        places = np.degrees(angles(row)) % 360.0
        columns += [f"{word}, element {k} at {places[k - 1]:.4g} deg [kN]" for k in own]
    return tuple(columns)


def series_values(one: OneBearing, rollers: Sequence[int], steps: Steps) -> Floats:
    """Columns of `series_columns` in some load steps.

    Parameters
    ----------
    one : OneBearing
        The bearing.
    rollers : sequence of int
        Numbers of rolling elements, from 1.
    steps : Steps
        Its load steps.

    Returns
    -------
    values : ndarray, (n, columns)
        Speed [1/min] and loads [kN].
    """
    columns = [steps.speed_rpm]
    for q, (_, _, own) in zip(steps.laminae, _rows(one, rollers), strict=True):
        loads = 1e-3 * q.sum(axis=2)
        columns += [loads.sum(axis=1), loads.max(axis=1), *(loads[:, k - 1] for k in own)]
    return np.column_stack(columns)


def _rows(one: OneBearing, rollers: Sequence[int]) -> Iterator[tuple[str, Row, list[int]]]:
    """Name of each row, the row, and which of the elements it has."""
    bearing = one.rated.bearing
    for word, row, count in zip(
        row_names(len(bearing.rows)), bearing.rows, bearing.counts, strict=True
    ):
        yield word, row, [k for k in rollers if k <= count]
