"""The rolling elements of a bearing where they stand, coloured by their load."""

from __future__ import annotations

from typing import Any

import numpy as np

from fe_drivetrain.bearing.geometry import Bearing, Row, angles, count
from fe_drivetrain.common.arrays import Floats, rounded
from fe_drivetrain.report.charts import chart, trace
from fe_drivetrain.report.results import Chart

_RADIUS = 150.0  # pixels of the outermost ring on the page, about
# named scales differ between programs
_COLOURS = [
    [0.0, "#ffffcc"],
    [0.25, "#fecc5c"],
    [0.5, "#fd8d3c"],
    [0.75, "#e31a1c"],
    [1.0, "#800026"],
]
_STEP = 0.26  # of the radius, between rings


def roller_chart(caption: str, bearing: Bearing, loads: Floats) -> Chart:
    """Each rolling element at its place round the bearing, coloured by its load.

    Parameters
    ----------
    caption : str
        What the loads are of.
    bearing : Bearing
        Its rows are drawn as rings, the most upwind one outermost.
    loads : Floats
        Loads (total,) of all elements, row by row [N]; those without a load are grey.

    Returns
    -------
    Chart
        Looking downwind, up is upwards.

    Raises
    ------
    ValueError
        There are not as many loads as elements.
    """
    if len(loads) != sum(bearing.counts):
        raise ValueError(f"{caption}: {len(loads)} loads of {sum(bearing.counts)} rolling elements")
    by_row = np.split(np.asarray(loads, dtype=float) / 1e3, np.cumsum(bearing.counts)[:-1])
    rows = sorted(zip(bearing.rows, by_row, strict=True), key=lambda one: one[0].place)
    traces: list[Any] = []
    for ring, (row, Q) in enumerate(rows):
        traces += _ring(f"row {ring + 1}", row, Q, 1.0 - _STEP * ring, max(map(np.max, by_row)))
    coloured = [one for one in traces if "colorscale" in one["marker"]]
    for one in coloured[:1]:
        one["marker"]["showscale"] = True
    words = ", rows from upwind, outermost, to downwind" if len(rows) > 1 else ""
    drawn = chart(caption, traces, f"looking downwind{words}", "up")
    hidden = ("showticklabels", "showgrid", "zeroline", "showline")
    bare = dict.fromkeys(hidden, False) | {"ticks": ""}
    drawn.figure["layout"]["xaxis"] |= {**bare, "constrain": "domain"}
    drawn.figure["layout"]["yaxis"] |= {**bare, "scaleanchor": "x"}
    return drawn


def _ring(name: str, row: Row, Q: Floats, radius: float, peak: float) -> list[Any]:
    """Elements of a row [kN] on a circle: those with a load, and those without."""
    psi = angles(row)
    look = {
        "size": min(22.0, 0.8 * 2.0 * np.pi * radius * _RADIUS / count(row)),
        "line": {"width": 1, "color": "#777777"},
    }
    colours = {
        "colorscale": _COLOURS,
        "cmin": 0.0,
        "cmax": float(f"{peak:.4g}"),
        "colorbar": {"title": {"text": "load [kN]", "side": "right"}, "thickness": 12},
    }
    found = []
    for of, colour in ((Q > 0.0, colours), (Q <= 0.0, {"color": "#d5d5d5"})):
        if of.any():
            own = {"color": rounded(Q[of])} if colour is colours else {}
            found.append(
                trace(
                    name,
                    radius * np.cos(psi[of]),
                    radius * np.sin(psi[of]),
                    points=True,
                    marker={**look, **colour, **own},
                    text=[f"{q:.4g} kN" for q in Q[of]],
                    hoverinfo="text",
                    showlegend=False,
                )
            )
    return found
