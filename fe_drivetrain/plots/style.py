"""One style for all charts, on pages and from Python: Plotly's data and layout, in and out."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import Any

from fe_drivetrain.common.typeset import THIN_SPACE, typeset

PALETTE = (
    "#0072b2",
    "#d55e00",
    "#009e73",
    "#cc79a7",
    "#e69f00",
    "#56b4e9",
    "#1f2933",
    "#882255",
    "#999933",
    "#44aa99",
    "#332288",
    "#aa4499",
    "#7f5f00",
    "#767676",
)
"""Colours that colour-blind readers tell apart, as well as so many can be: those of Okabe and Ito
2008, "Color Universal Design", without the yellow, which is too faint on white, and then of Tol's
muted scheme (2021, "Colour Schemes", SRON/EPS/TN/09-002)."""

#: Colours of methods that stand in many charts, by the beginning of a trace's name.
_OF_METHODS = {
    "level 0": "#cc79a7",
    "level 1, Timoshenko beam, rigid": "#e69f00",
    "level 1": "#d55e00",
    "level 2": "#009e73",
    "level 3": "#56b4e9",
    "level 4": "#0072b2",
    "finite elements": "#0072b2",
    "FE": "#0072b2",
    "meridian": "#009e73",
    "pinned beam": "#e69f00",
    "torsional-spring": "#d55e00",
    "torsional springs": "#d55e00",
    "beam": "#d55e00",
    "tetrahedra of 4 nodes": "#cc79a7",
    "tetrahedra of 10 nodes": "#d55e00",
    "curved tetrahedra": "#d55e00",
    "hexahedra of 8 nodes": "#e69f00",
    "hexahedra of 20 nodes": "#56b4e9",
    "hexahedra of 27 nodes": "#0072b2",
    "sliding": "#0072b2",
    "averaged": "#d55e00",
    "rigid": "#009e73",
    "bonded": "#cc79a7",
    "superlu": "#0072b2",
    "multigrid": "#d55e00",
    "patches": "#009e73",
    "equal": "#767676",
    "tolerance": "#767676",
}
# line styles of the traces that come after as many as there are colours
_DASHES = ("solid", "dash", "dot", "dashdot")
_DECADES = 8  # with labels on a logarithmic axis, at most
_FULL, _FEW = 2.0, 0.7  # decades from which powers of ten, or 1, 2 and 5, are labels enough
_PLAIN = (1e-3, 1e6)  # numbers that are written without a power of ten, as in tables
_AXIS = {
    # no prefixes: 5 nano on an axis of kN is no unit
    "exponentformat": "power",
    "minexponent": 4,
    "hoverformat": ".4~g",
    "showline": True,
    "linecolor": "#52606d",
    "ticks": "outside",
    "tickcolor": "#52606d",
    "gridcolor": "#e4e7eb",
    "zerolinecolor": "#9aa5b1",
    "automargin": True,
    "title": {"standoff": 10},
}
LEGEND = {"orientation": "h", "y": 1.02, "yanchor": "bottom", "x": 0, "xanchor": "left"}
"""In a row above the plot, not beside it."""
_CHART_TEMPLATE: dict[str, Any] = {
    "layout": {
        "colorway": list(PALETTE),
        "font": {"family": "system-ui, 'Segoe UI', Arial, sans-serif", "size": 14},
        "paper_bgcolor": "white",
        "plot_bgcolor": "white",
        "margin": {"l": 60, "r": 44, "t": 30, "b": 50},
        # beside the plot, not over the last names of the legend
        "modebar": {"orientation": "v"},
        "legend": LEGEND,
        "hovermode": "closest",
        "separators": f".{THIN_SPACE}",
        "hoverlabel": {"align": "left"},
        "colorscale": {"sequential": "Viridis", "sequentialminus": "Viridis"},
        "xaxis": _AXIS,
        "yaxis": _AXIS,
    },
    "data": {"heatmap": [{"colorscale": "Viridis"}], "contour": [{"colorscale": "Viridis"}]},
}


def styled(traces: Sequence[Mapping[str, Any]], layout: Mapping[str, Any]) -> dict[str, Any]:
    """Put a figure into the project's look.

    Parameters
    ----------
    traces : sequence of mapping
        Traces in Plotly's form.
    layout : mapping
        Titles of axes and what else is the figure's own.

    Returns
    -------
    dict
        Entries "data" and "layout": each trace in a colour of its own, a known method in that
        method's; texts typeset, and null for what JSON has no number for.
    """
    layout = {**layout, "template": _CHART_TEMPLATE}
    if layout.get("title"):
        # a title takes the legend's place above the plot
        look = {k: v for k, v in _CHART_TEMPLATE["layout"].items() if k != "legend"}
        layout["template"] = {**_CHART_TEMPLATE, "layout": look}
    # WebGL is missing on many a remote desktop, and a browser allows a page only a few contexts
    plain = [
        {**trace, "type": "scatter"} if trace.get("type") == "scattergl" else dict(trace)
        for trace in traces
    ]
    for axis in ("x", "y"):
        own = layout.get(f"{axis}axis", {})
        if own.get("type") == "log":
            layout[f"{axis}axis"] = {**_log_ticks(axis, plain), **own}
    if any(trace.get("name") == "equal" for trace in plain):
        # the diagonal is one, and of a square, however little one of the two varies
        same = _range_of_both(plain, layout.get("xaxis", {}).get("type") == "log")
        layout["yaxis"] = {**same, "scaleanchor": "x", **layout.get("yaxis", {})}
        layout["xaxis"] = {**same, **layout.get("xaxis", {})}
    found: dict[str, Any] = _finite({"data": _coloured(plain), "layout": layout})
    return found


def _log_ticks(axis: str, traces: list[dict[str, Any]]) -> dict[str, Any]:
    """Labels of a logarithmic axis that do not run into each other: decades, or 1, 2 and 5.

    Between decades they are whole numbers: a 2 alone does not tell its power of ten.
    """
    values = [v for trace in traces for v in trace.get(axis, []) if is_number(v) and v > 0]
    low, high = (min(values), max(values)) if values else (1.0, 1.0)
    decades = math.log10(high / low)
    if decades >= _FULL:
        return {"dtick": math.ceil(decades / _DECADES)}
    leading = (1, 2, 5) if decades >= _FEW else range(1, 10)
    if low >= _PLAIN[0] and high < _PLAIN[1]:
        return {"dtick": "D2" if decades >= _FEW else "D1", "tickformat": ",~r"}
    powers = range(math.floor(math.log10(low)) - 1, math.ceil(math.log10(high)) + 1)
    shown = [(n, power) for power in powers for n in leading]
    return {
        "tickmode": "array",
        "tickvals": [float(f"{n}e{power}") for n, power in shown],
        "ticktext": [typeset(f"{n}e{power}") for n, power in shown],
    }


def _range_of_both(traces: list[dict[str, Any]], logarithmic: bool) -> dict[str, Any]:
    """One range for both axes, with a little room; of logarithms where these are the axes'."""
    values = [v for t in traces for axis in "xy" for v in t.get(axis, []) if is_number(v)]
    if logarithmic:
        values = [math.log10(v) for v in values if v > 0]
    values = [v for v in values if math.isfinite(v)]
    if not values:
        return {"constrain": "domain"}
    low, high = min(values), max(values)
    room = 0.05 * (high - low)
    return {"constrain": "domain", "range": [low - room, high + room]}


def _coloured(traces: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Traces, each in a colour of its own, those of a known method in that method's.

    Where there are more than colours, the lines of the others are drawn in another style.
    """
    taken = {colour for trace in traces if (colour := _own_colour(trace))}
    kinds = ("scatter", "scatterpolar", "bar")
    plain = [t for t in traces if not _own_colour(t) and t.get("type", "scatter") in kinds]
    chosen: dict[int, str] = {}
    for trace in plain:
        colour = _of_method(str(trace.get("name", "")))
        if colour and colour not in taken:
            chosen[id(trace)] = colour
            taken.add(colour)
    left = iter([colour for colour in PALETTE if colour not in taken])
    again = cycle([(colour, dash) for dash in _DASHES[1:] for colour in PALETTE])
    found = []
    looks_of: dict[object, dict[str, Any]] = {}
    for trace in traces:
        if not any(trace is other for other in plain):
            found.append(trace)
            continue
        if trace.get("showlegend") is False and trace.get("name") in looks_of:
            # the same curve in another panel
            found.append({**trace, **looks_of[trace.get("name")]})
            continue
        dash = None
        colour = chosen.get(id(trace)) or next(left, "")
        if not colour:
            colour, dash = next(again)
        looks = {"marker": {"color": colour, **trace.get("marker", {})}}
        if trace.get("type") != "bar":
            looks["line"] = {"color": colour, **({"dash": dash} if dash else {})}
            looks["line"] |= trace.get("line", {})
        looks_of[trace.get("name")] = looks
        found.append({**trace, **looks})
    return found


def _own_colour(trace: dict[str, Any]) -> Any:
    """The colour that a trace brings; true of colours of its points."""
    for part in ("line", "marker"):
        colour = trace.get(part, {}).get("color")
        if colour is not None:
            return colour if isinstance(colour, str) else True
    return None


def _of_method(name: str) -> str | None:
    """The colour of a method, by the longest beginning of the name that is known."""
    known = [start for start in _OF_METHODS if name.startswith(start)]
    return _OF_METHODS[max(known, key=len)] if known else None


def _finite(value: Any) -> Any:
    """Data with its texts typeset, and null for what JSON has no number for."""
    if isinstance(value, dict):
        return {key: _finite(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(inner) for inner in value]
    if isinstance(value, str):
        return typeset(value.replace("`", ""))  # a chart has no code in it
    return None if isinstance(value, float) and not math.isfinite(value) else value


def is_number(value: object) -> bool:
    """Whether a value is a number, which a truth value is not."""
    return isinstance(value, int | float) and not isinstance(value, bool)
