"""What a chart may have beside its curves: events as lines, differences below, its own ranges."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, TypedDict

import numpy as np

from fe_drivetrain.common.arrays import rounded

_GREY = "#767676"  # seen on white and on black
_STRIP = 0.24  # share of the height that the strip of differences takes
_GAP = 0.08
_STRIP_HEIGHT = 90  # pixels that the chart grows for it
_PLAIN_HEIGHT = 460
_ROOM = 0.035  # share of the width that a name along a line takes


class ChartParts(TypedDict, total=False):
    """What a chart shows beside its curves.

    Attributes
    ----------
    events : dict
        Vertical lines: what happens, and its x.
    beside : str
        Name of the curve from which the differences of all others are shown in a strip below, where
        curves cover each other.
    x_range, y_range : tuple of float
        First and last value of an axis, in its unit, so that it shows what matters.
    """

    events: Mapping[str, float]
    beside: str
    x_range: tuple[float, float]
    y_range: tuple[float, float]


def add_parts(figure: dict[str, Any], parts: ChartParts) -> None:
    """Add parts to a figure of curves.

    Parameters
    ----------
    figure : dict
        Entries "data" and "layout" of Plotly, changed in place.
    parts : ChartParts
        What is added.

    Raises
    ------
    ValueError
        No curve has the name of the one that others stand beside.
    """
    layout = figure["layout"]
    for axis, ends in (("xaxis", parts.get("x_range")), ("yaxis", parts.get("y_range"))):
        if ends is not None:
            layout[axis]["range"] = [_on(layout[axis], end) for end in ends]
    if parts.get("events"):
        draw_events(figure, parts["events"])
    if parts.get("beside"):
        _add_strip(figure, parts["beside"])


def _on(axis: Mapping[str, Any], value: float) -> float:
    """A value as Plotly has it in ranges and labels of an axis."""
    return math.log10(value) if axis.get("type") == "log" else float(value)


def draw_events(figure: dict[str, Any], events: Mapping[str, float]) -> None:
    """Draw a dashed line for each event, its name along it, or above horizontal bars.

    Names of lines that are close to each other stand side by side before the first of them.

    Parameters
    ----------
    figure : dict
        Entries "data" and "layout" of Plotly; the layout takes the lines, and the lists that it had
        are not changed.
    events : dict of str to float
        What happens, and where on the horizontal axis.
    """
    layout = figure["layout"]
    # bars would be under a name that stands along the line
    along: dict[str, Any] = {
        "xanchor": "right",
        "yanchor": "top",
        "textangle": -90,
        "align": "right",
    }
    above: dict[str, Any] = {"xanchor": "center", "yanchor": "bottom"}
    line = {"color": _GREY, "width": 1.5, "dash": "dash"}
    layout["shapes"] = [
        *layout.get("shapes", ()),
        *(
            {"type": "line", "x0": x, "x1": x, "yref": "paper", "y0": 0, "y1": 1, "line": line}
            for x in map(float, events.values())
        ),
    ]
    layout["annotations"] = [
        *layout.get("annotations", ()),
        *(
            {
                "text": "<br>".join(names),
                "x": x,
                "yref": "paper",
                "y": 1,
                **(above if "barmode" in layout else along),
                "showarrow": False,
                "font": {"size": 12},
            }
            for x, names in _side_by_side(figure, events)
        ),
    ]


def _side_by_side(
    figure: Mapping[str, Any], events: Mapping[str, float]
) -> list[tuple[float, list[str]]]:
    """Where names of events stand on the axis, those together that have no room of their own."""
    axis = figure["layout"].get("xaxis", {})
    places = [(_on(axis, x), name) for name, x in events.items()]
    ends = axis.get("range") or [
        _on(axis, x)
        for one in figure["data"]
        for x in one.get("x", ())
        if isinstance(x, float | int) and (x > 0.0 or axis.get("type") != "log")
    ]
    room = _ROOM * (max(ends, default=0.0) - min(ends, default=0.0))
    found: list[tuple[float, list[str]]] = []
    last = -math.inf
    for x, name in sorted(places):
        if x - last < room:
            found[-1][1].append(name)
        else:
            found.append((x, [name]))
        last = x
    return found


def _add_strip(figure: dict[str, Any], reference: str) -> None:
    """Differences of all curves from one of them, on an axis of their own below."""
    data, layout = figure["data"], figure["layout"]
    found = next((one for one in data if one.get("name") == reference), None)
    if found is None:
        names = ", ".join(repr(one.get("name")) for one in data)
        raise ValueError(f"there is no curve {reference!r} among {names}")
    known = np.array([found["x"], found["y"]], dtype=float)
    known = known[:, np.argsort(known[0])]
    for one in [one for one in data if one is not found and "lines" in one.get("mode", "lines")]:
        x, y = np.array([one["x"], one["y"]], dtype=float)
        there = np.interp(x, known[0], known[1], left=np.nan, right=np.nan)
        strip = {"x": one["x"], "y": rounded(y - there), "yaxis": "y2", "showlegend": False}
        data.append({**one, **strip})
    title = layout["yaxis"]["title"]["text"]
    unit = title[title.rfind("[") :] if "[" in title else ""
    layout["yaxis"]["domain"] = [_STRIP + _GAP, 1.0]
    layout["yaxis2"] = {
        "domain": [0.0, _STRIP],
        "title": {"text": f"difference {unit}".strip()},
        "nticks": 4,
    }
    layout["xaxis"]["anchor"] = "y2"
    layout["height"] = layout.get("height", _PLAIN_HEIGHT) + _STRIP_HEIGHT
