"""A chart as a page draws it: Plotly's JSON in one style for all."""

from __future__ import annotations

import json
import math
from typing import Any

from markupsafe import Markup

from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.typeset import typeset

# Okabe and Ito 2008, "Color Universal Design", without the yellow, which is too faint on white
_PALETTE = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#1f2933"]
# line styles of the traces that come after as many as there are colours
_DASHES = ("solid", "dash", "dot", "dashdot")
_AXIS = {
    "exponentformat": "SI",
    "showline": True,
    "linecolor": "#52606d",
    "ticks": "outside",
    "tickcolor": "#52606d",
    "gridcolor": "#e4e7eb",
    "zerolinecolor": "#9aa5b1",
    "automargin": True,
    "title": {"standoff": 10},
}
_CHART_TEMPLATE: dict[str, Any] = {
    "layout": {
        "colorway": _PALETTE,
        "font": {"family": "system-ui, 'Segoe UI', Arial, sans-serif", "size": 14},
        "paper_bgcolor": "white",
        "plot_bgcolor": "white",
        "margin": {"l": 60, "r": 44, "t": 30, "b": 50},
        # beside the plot, not over the last names of the legend
        "modebar": {"orientation": "v"},
        "legend": {"orientation": "h", "y": 1.02, "yanchor": "bottom", "x": 0, "xanchor": "left"},
        "hovermode": "closest",
        "hoverlabel": {"align": "left"},
        "colorscale": {"sequential": "Viridis", "sequentialminus": "Viridis"},
        "xaxis": _AXIS,
        "yaxis": _AXIS,
    },
    "data": {"heatmap": [{"colorscale": "Viridis"}], "contour": [{"colorscale": "Viridis"}]},
}


def chart_height(item: Chart) -> int:
    """Pixels, so that the page does not jump when the chart appears."""
    height = item.figure.get("layout", {}).get("height")
    return int(height) if is_number(height) and 100 <= height <= 4000 else 460


def figure_as_json(item: Chart) -> Markup:
    """The figure in the page's look, as JSON that can stand inside a script element."""
    figure = dict(item.figure)
    layout = {**figure.get("layout", {}), "template": _CHART_TEMPLATE, "autosize": True}
    for size in ("width", "height"):
        layout.pop(size, None)
    if layout.get("title"):
        # a title takes the legend's place above the plot
        look = {k: v for k, v in _CHART_TEMPLATE["layout"].items() if k != "legend"}
        layout["template"] = {**_CHART_TEMPLATE, "layout": look}
    # WebGL is missing on many a remote desktop, and a browser allows a page only a few contexts
    traces = [
        {**trace, "type": "scatter"} if trace.get("type") == "scattergl" else trace
        for trace in figure.get("data", [])
    ]
    for axis in ("x", "y"):
        own = layout.get(f"{axis}axis", {})
        if own.get("type") == "log":
            layout[f"{axis}axis"] = {**_log_ticks(axis, traces), **own}
    content = {"data": _distinguished(traces), "layout": layout}
    text = json.dumps(_finite(content), ensure_ascii=True, allow_nan=False)
    for character in "<>&":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return Markup(text)


def _log_ticks(axis: str, traces: list[dict[str, Any]]) -> dict[str, Any]:
    """Labels of a logarithmic axis that do not run into each other: decades, or 1, 2 and 5."""
    values = [v for trace in traces for v in trace.get(axis, []) if is_number(v) and v > 0]
    decades = math.log10(max(values) / min(values)) if values else 0.0
    if decades > 12:
        return {}
    return {"dtick": 1 if decades >= 2 else "D2" if decades >= 1 else "D1"}


def _distinguished(traces: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The same traces, those in line for a colour a second time drawn in another style."""
    found = []
    place = 0
    for trace in traces:
        own = trace.get("line", {})
        if "color" in own or "color" in trace.get("marker", {}):
            found.append(trace)
            continue
        style = _DASHES[place // len(_PALETTE) % len(_DASHES)]
        place += 1
        dashed = style != "solid" and trace.get("type", "scatter") == "scatter"
        found.append({**trace, "line": {"dash": style, **own}} if dashed else trace)
    return found


def _finite(value: Any) -> Any:
    """The same data, its texts typeset, with null for what JSON has no number for."""
    if isinstance(value, dict):
        return {key: _finite(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(inner) for inner in value]
    if isinstance(value, str):
        return typeset(value)
    return None if isinstance(value, float) and not math.isfinite(value) else value


def is_number(value: object) -> bool:
    """Whether a value is a number, which a truth value is not."""
    return isinstance(value, int | float) and not isinstance(value, bool)
