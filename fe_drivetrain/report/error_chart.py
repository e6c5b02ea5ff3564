"""How far key figures are from what they are compared with, and by how much they may be."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.charts import chart, trace
from fe_drivetrain.report.results import Chart


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
        one
        for one in figures
        if one.bound in ("equals", "beside") and one.limit and math.isfinite(one.value)
    ]
    if not shown:
        raise ValueError(f"{caption}: no value has a reference other than 0 to be compared with")
    names = [f"{one.name} ({one.by})" if one.by else one.name for one in shown]
    sizes = [abs(one.limit or 1.0) / 100.0 for one in shown]
    errors = [(f.value - (f.limit or 0.0)) / size for f, size in zip(shown, sizes, strict=True)]
    bands = [(f.band or 0.0) / size for f, size in zip(shown, sizes, strict=True)]
    allowed = [f.allowed / size for f, size in zip(shown, sizes, strict=True)]
    traces: list[Any] = []
    if any(allowed):
        traces.append(
            {
                "type": "bar",
                "orientation": "h",
                "name": "allowed",
                "y": names,
                "x": rounded([2.0 * one for one in allowed]),
                "base": rounded([-one for one in allowed]),
                "marker": {"color": "#c9dcc9"},
                "hoverinfo": "skip",
            }
        )
    points = trace("computed", errors, [0.0] * len(errors), True, marker={"size": 10})
    points |= {"y": names}
    if any(bands):
        points["name"] = "computed, with band"
        points["error_x"] = {"type": "data", "array": rounded(bands), "thickness": 2, "width": 5}
    traces.append(points)
    found = chart(caption, traces, "difference from the reference [%]", "")
    found.figure["layout"] |= {
        "height": 150 + 34 * max(len(shown), 3),
        "yaxis": {"autorange": "reversed", "automargin": True, "type": "category"},
        "bargap": 0.55,
    }
    return found
