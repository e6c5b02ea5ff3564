"""Maps, lines of equal error over two parameters, and curves beside them, as Plotly's JSON."""

from __future__ import annotations

from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats, rounded
from fe_drivetrain.report.charts import trace

LEVELS = (1.0, 5.0, 10.0)
"""Errors [%] that maps show."""

_LINES = {1.0: "solid", 5.0: "dash", 10.0: "dot"}


def dashed(name: str, x: Floats, y: Floats, dash: str = "solid", colour: str = "black") -> Any:
    """A curve through points, which its dashes tell from others of its colour."""
    line = {"color": colour, "dash": dash}
    return trace(name, x, y, mode="lines+markers", line=line)


def map_traces(x: Floats, y: Floats, percent: Floats, falls_as: float = 1.0) -> list[Any]:
    """Lines of equal error over x (logarithmic) and y, and dots where it was computed.

    Parameters
    ----------
    x, y : ndarray
        (n,) and (m,), ascending.
    percent : ndarray
        (m, n) errors [%], with their sign.
    falls_as : float
        The power of x with which it falls: times x to this power it is interpolated by splines.

    Returns
    -------
    traces : list
        For a chart.
    """
    from scipy.interpolate import RectBivariateSpline

    fine_x, fine_y = np.geomspace(x[0], x[-1], 41), np.linspace(y[0], y[-1], 31)
    spline = RectBivariateSpline(
        y, np.log(x), percent * x**falls_as, kx=min(3, len(y) - 1), ky=min(3, len(x) - 1)
    )
    fine = np.abs(spline(fine_y, np.log(fine_x)) / fine_x**falls_as)
    lines = [
        {
            "type": "contour",
            "name": f"{level:g} %",
            "x": rounded(fine_x, 5),
            "y": rounded(fine_y, 5),
            "z": [rounded(row, 4) for row in fine],
            "autocontour": False,
            "contours": {
                "start": level,
                "end": level,
                "size": level,
                "coloring": "none",
                "showlabels": True,
                "labelfont": {"size": 15, "color": "black"},
                "labelformat": ".0f",
            },
            "line": {"color": "black", "width": 2, "dash": _LINES[level]},
            "showscale": False,
            "showlegend": True,
            "hovertemplate": "%{x:.3g}, %{y:.3g}: %{z:.3g} %<extra></extra>",
        }
        for level in LEVELS
    ]
    X, Y = np.meshgrid(x, y)
    dots = trace("computed", X.ravel(), Y.ravel(), True, marker={"size": 3, "color": "#777777"})
    return [*lines, dots]
