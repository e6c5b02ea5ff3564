"""How far key figures are from what they are compared with, and by how much they may be."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.charts import chart, trace
from fe_drivetrain.report.results import Chart


class Difference(NamedTuple):
    """How far a value is from its reference; all of a chart in one unit.

    Attributes
    ----------
    name : str
        Name of the value, with that of the reference.
    error : float
        Value less reference.
    band : float
        Half width of the numerical uncertainty of the value.
    allowed : float
        Largest difference that is allowed, or 0.
    """

    name: str
    error: float
    band: float = 0.0
    allowed: float = 0.0

    @property
    def share(self) -> float:
        """Size of the error over what is allowed, which is not 0."""
        return abs(self.error) / self.allowed


def error_chart(caption: str, figures: Sequence[KeyFigure]) -> Chart:
    """Difference of each value from its reference, with its band, over the range that is allowed.

    Parameters
    ----------
    caption : str
        What it shows.
    figures : sequence of KeyFigure
        Those with a reference other than 0 are shown: bound "equals" or "beside".

    Returns
    -------
    Chart
        A line for each value, from above; the axis is in percent of the reference.

    Raises
    ------
    ValueError
        None of them has such a reference.
    """
    shown = [
        _relative(one, one.limit)
        for one in figures
        if one.bound in ("equals", "beside") and one.limit and math.isfinite(one.value)
    ]
    if not shown:
        raise ValueError(f"{caption}: no value has a reference other than 0 to be compared with")
    return difference_chart(caption, shown, "difference from the reference [%]")


def _relative(figure: KeyFigure, reference: float) -> Difference:
    """Difference of a key figure from its reference, in percent of that."""
    size = abs(reference) / 100.0
    return Difference(
        f"{figure.name} ({figure.by})" if figure.by else figure.name,
        (figure.value - reference) / size,
        (figure.band or 0.0) / size,
        figure.allowed / size,
    )


def difference_chart(caption: str, shown: Sequence[Difference], axis: str) -> Chart:
    """Differences with their bands, over the ranges that are allowed.

    Parameters
    ----------
    caption : str
        What it shows.
    shown : sequence of Difference
        A line for each, from above.
    axis : str
        Title of the axis, with the unit of the differences.

    Returns
    -------
    Chart
    """
    names = [one.name for one in shown]
    traces: list[Any] = []
    if any(one.allowed for one in shown):
        traces.append(
            {
                "type": "bar",
                "orientation": "h",
                "name": "allowed",
                "y": names,
                "x": rounded([2.0 * one.allowed for one in shown]),
                "base": rounded([-one.allowed for one in shown]),
                "marker": {"color": "#c9dcc9"},
                "hoverinfo": "skip",
            }
        )
    errors = [one.error for one in shown]
    points = trace("computed", errors, [0.0] * len(errors), True, marker={"size": 10})
    points |= {"y": names}
    if any(one.band for one in shown):
        points["name"] = "computed, with band"
        bands = rounded([one.band for one in shown])
        points["error_x"] = {"type": "data", "array": bands, "thickness": 2, "width": 5}
    traces.append(points)
    found = chart(caption, traces, axis, "")
    found.figure["layout"] |= {
        "height": 150 + 34 * max(len(shown), 3),
        "yaxis": {"autorange": "reversed", "automargin": True, "type": "category"},
        "bargap": 0.55,
    }
    return found
