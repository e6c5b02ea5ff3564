"""Records of a sweep: dicts with the same keys, units in the keys; columns, groups, mesh series."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.report.charts import trace
from fe_drivetrain.report.results import Cell
from fe_drivetrain.report.suite.targets import split_unit

Record = dict[str, Any]
"""One point of a sweep: its parameters and what was found there."""


def column(rows: Sequence[Record], name: str) -> list[Any]:
    """The values of one key, in the order of the rows."""
    return [row[name] for row in rows]


def grouped(rows: Sequence[Record], by: str) -> list[tuple[Any, list[Record]]]:
    """Rows of each value of a key, in the order in which the values come first."""
    groups: dict[Any, list[Record]] = {}
    for row in rows:
        groups.setdefault(row[by], []).append(row)
    return list(groups.items())


def group_name(by: str, value: Any) -> str:
    """The name of a group's curve: a number with the quantity and unit of its key."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return str(value)
    quantity, unit = split_unit(by)
    return f"{quantity} {value:g} {unit}".rstrip()


def counted(n: Any, what: str) -> str:
    """A number and what it counts: "4 elements round", "1 element round"."""
    return f"{n} {what.replace('elements', 'element', 1) if n == 1 else what}"


def goal(
    what: str, measured: float | None, *, most: float | None = None, least: float | None = None
) -> Record:
    """A row of a table of goals: of a project, as how fast it wants to be, and so no check.

    Parameters
    ----------
    what : str
        What was measured, with its unit.
    measured : float or None
        In that unit; what was not measured, None or NaN, is not reached.
    most, least : float, optional
        The goal: one of them, in that unit.
    """
    found = math.nan if measured is None else measured
    if most is not None and least is None:
        asked, reached = f"at most {most:.3g}", found <= most
    elif least is not None and most is None:
        asked, reached = f"at least {least:.3g}", found >= least
    else:
        raise TypeError(f"goal {what!r}: needs either most or least")
    return {
        "goal": what,
        "measured": None if math.isnan(found) else found,
        "asked for": asked,
        "reached": "yes" if reached else "no",
    }


class MeshSeries(NamedTuple):
    """What ever finer meshes gave.

    Attributes
    ----------
    rows : sequence of dict
        One for each mesh, coarse to fine.
    by : str
        Key of what grows as the mesh is refined: the number of elements or of unknowns.
    dimension : int
        Elements have the size of `by` to the power -1 / dimension: 1 where it counts elements along
        a line, 3 where it counts the unknowns of a solid.
    """

    rows: Sequence[Record]
    by: str
    dimension: int = 1

    @property
    def last(self) -> Record:
        """The record of the finest mesh."""
        return self.rows[-1]

    def change(self, key: str) -> float:
        """By how much a value of the finest mesh differs from that of the mesh before."""
        return float(abs(self.rows[-1][key] - self.rows[-2][key]))

    def band(self, key: str, order: float | None = None) -> float:
        """Numerical uncertainty of the finest mesh's value.

        Parameters
        ----------
        key : str
            Of the value in the rows.
        order : float, optional
            Expected order of convergence.

        Returns
        -------
        band : float
            Half width, in the unit of the value; see `fe_drivetrain.comparison.band_of`.
        """
        from fe_drivetrain.comparison.convergence import band_of

        sizes = [float(n) ** (-1.0 / self.dimension) for n in column(self.rows, self.by)]
        return band_of(sizes, column(self.rows, key), order)

    def order(self, key: str) -> float:
        """Order of convergence that the three finest meshes show; NaN where they show none.

        Parameters
        ----------
        key : str
            Of the value in the rows.
        """
        from fe_drivetrain.comparison.convergence import observed_order

        last = self.rows[-3:]
        sizes = [float(n) ** (-1.0 / self.dimension) for n in column(last, self.by)]
        return observed_order(sizes, column(last, key))


def curves(
    rows: Sequence[Record],
    x: str,
    keys: Mapping[str, str],
    by: str | None,
    mode: str,
    bands: Mapping[str, str] | None = None,
) -> list[Any]:
    """Traces of a sweep; see `fe_drivetrain.report.suite.Page.sweep`.

    Parameters
    ----------
    rows : sequence of dict
        The points.
    x : str
        Key of the horizontal axis.
    keys : mapping
        Key of each curve, and its name.
    by : str or None
        Key that tells the curves apart.
    mode : str
        Of the drawing, as Plotly has it.
    bands : mapping or None
        Key of a curve, and that of its band, which is drawn as error bars.

    Returns
    -------
    list
        For a chart.
    """
    traces = []
    for group, of in grouped(rows, by) if by else [("", rows)]:
        for key, name in keys.items():
            # a record without that value has no point
            at = [row for row in of if row[key] is not None]
            parts = (group_name(by, group) if by else "", name)
            title = ", ".join(part for part in parts if part) or key
            found = trace(title, column(at, x), column(at, key), mode=mode)
            if bands and key in bands:
                array = rounded([row[bands[key]] or 0.0 for row in at])
                found["error_y"] = {"type": "data", "array": array, "thickness": 1.5}
            traces.append(found)
    return traces


def ring(row: Record, x: str, keys: Iterable[str]) -> Any:
    """Circles round the points of a record that is chosen, with that word.

    Parameters
    ----------
    row : dict
        The record.
    x : str
        Key of the horizontal axis.
    keys : iterable of str
        Keys of the curves.

    Returns
    -------
    dict
        A trace.
    """
    values = [row[key] for key in keys if row[key] is not None]
    look = {"symbol": "circle-open", "size": 16, "color": "#1f2933", "line": {"width": 2}}
    return trace(
        "chosen",
        [row[x]] * len(values),
        values,
        True,
        marker=look,
        mode="markers+text",
        text=["chosen"] * len(values),
        textposition="top right",
        showlegend=False,
    )


def plain_cells(cells: Sequence[Any]) -> list[Cell]:
    """Cells of a table without NumPy's scalars."""
    return [cell.item() if hasattr(cell, "item") else cell for cell in cells]


def as_json(value: Any) -> Any:
    """The same data without NumPy's arrays and scalars."""
    if isinstance(value, Mapping):
        return {str(key): as_json(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [as_json(inner) for inner in value]
    return value.tolist() if hasattr(value, "tolist") else value


def strict_json(value: Any) -> Any:
    """The same as plain JSON data, NaN and infinity as strings.

    Parameters
    ----------
    value : object
        As `as_json` takes it.
    """
    if isinstance(value, float):
        return value if abs(value) < float("inf") else str(value)
    if isinstance(value, str | int) or value is None:
        return value
    plain = as_json(value)
    if isinstance(plain, dict):
        return {key: strict_json(inner) for key, inner in plain.items()}
    if isinstance(plain, list):
        return [strict_json(inner) for inner in plain]
    return str(value) if plain is value else strict_json(plain)
