"""Charts of lines, bars and colours, as Plotly's JSON."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats, rounded
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.report.chart_parts import ChartParts, add_parts, draw_events
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.results import Chart


def trace(name: str, x: ArrayLike, y: ArrayLike, points: bool = False, **more: Any) -> Any:
    """A line, or points; numbers rounded to what a chart can show."""
    return {
        "type": "scatter",
        "mode": "markers" if points else "lines",
        "name": name,
        "x": rounded(x),
        "y": rounded(y),
        **more,
    }


def marked(name: str, x: ArrayLike, y: ArrayLike) -> Any:
    """A line with its points marked."""
    return trace(name, x, y, mode="lines+markers")


def error_bars(axis: str, least: ArrayLike, at: ArrayLike, most: ArrayLike) -> dict[str, Any]:
    """What `trace` takes to show how far each point may lie to either side.

    Parameters
    ----------
    axis : str
        Along which the points spread: "x" or "y".
    least, at, most : array_like
        (n,) ends of the spread, and where the points are.
    """
    low, middle, high = (np.ravel(np.asarray(v, dtype=float)) for v in (least, at, most))
    spread = {
        "type": "data",
        "symmetric": False,
        "array": rounded(np.maximum(high - middle, 0.0)),
        "arrayminus": rounded(np.maximum(middle - low, 0.0)),
        "thickness": 1.5,
        "width": 4,
    }
    return {f"error_{axis}": spread}


def crosses(name: str, x: ArrayLike, y: ArrayLike | None = None) -> Any:
    """Points without an answer, at 1 where there is not even a wrong one."""
    at = np.asarray(x, dtype=float)
    shown = np.ones(len(at)) if y is None else np.nan_to_num(np.asarray(y, dtype=float), nan=1.0)
    return trace(name, at, shown, True, marker={"symbol": "x", "size": 11, "color": "#c62828"})


def chart(
    caption: str,
    traces: Sequence[Any],
    x: str,
    y: str,
    logarithmic: Iterable[str] = (),
    safe: tuple[float | None, float | None] | None = None,
    **parts: Unpack[ChartParts],
) -> Chart:
    """A chart of traces.

    Parameters
    ----------
    caption : str
        What it shows.
    traces : Sequence[Any]
        From `trace`.
    x, y : str
        Titles of the axes, with units.
    logarithmic : Iterable[str]
        "x", "y" or both.
    safe : tuple[float or None, float or None] or None
        Range of x that is shaded as safe; None for an end without a bound.
    **parts : object
        Events, differences below, and ranges of the axes; see `ChartParts`.
    """
    axes: dict[str, Any] = {
        "xaxis": {"title": {"text": x}},
        "yaxis": {"title": {"text": y}},
    }
    for axis in logarithmic:
        axes[f"{axis}axis"]["type"] = "log"
        # plain powers of ten, not 2 and 5 between them
        axes[f"{axis}axis"]["exponentformat"] = "power"
    if safe is not None:
        axes["shapes"] = [_shaded(traces, safe)]
    figure = {"data": list(traces), "layout": axes}
    add_parts(figure, parts)
    return Chart(caption=caption, figure=figure)


def instead_of_chart(caption: str, traces: Sequence[Any], x: str, y: str) -> str:
    """What a chart of one point at most says in words; empty where there is more to draw."""
    points = [p for t in traces for p in zip(t.get("x", ()), t.get("y", ()), strict=False)]
    if any(len(t.get("z", ())) for t in traces) or len(points) > 1:
        return ""
    if not points:
        return f"{caption}: there is nothing to show in this run."
    at, value = (formatted(v, 4) for v in points[0])
    return f"{caption}: {y} {value} at {x} {at}, the only point of this run."


def mark_events(item: Chart, events: Mapping[str, float]) -> Chart:
    """A chart with a named vertical line at each event.

    Parameters
    ----------
    item : Chart
        To which they are added.
    events : dict of str to float
        What happens, and where on the horizontal axis.
    """
    figure = {**item.figure, "layout": dict(item.figure["layout"])}
    draw_events(figure, events)
    return item.model_copy(update={"figure": figure})


def density_chart(
    caption: str, right: ArrayLike, up: ArrayLike, unit: str, bins: int = 60
) -> Chart:
    """How often a vector points where, as seen along the axis: a cloud of points would hide it.

    Parameters
    ----------
    caption : str
        What it shows.
    right, up : array_like
        (n,) components, in ``unit``.
    unit : str
        Their unit.
    bins : int
        Cells along each axis.
    """
    x, y = np.ravel(np.asarray(right, dtype=float)), np.ravel(np.asarray(up, dtype=float))
    # a square about the cloud: one that is far from zero would be a speck in the whole plane
    centre = [0.5 * (float(v.min()) + float(v.max())) for v in (x, y)]
    reach = 0.51 * max(float(np.ptp(x)), float(np.ptp(y)))
    reach = reach or 0.01 * max(float(np.abs(x).max()), float(np.abs(y).max()), 1e-300)
    edges = [np.linspace(c - reach, c + reach, bins + 1) for c in centre]
    column, line = (
        np.searchsorted(e, v, side="right") - 1 for e, v in zip(edges, (x, y), strict=True)
    )
    counts = np.bincount(line * bins + column, minlength=bins * bins).reshape(bins, bins)
    shares = 100.0 * counts / x.size
    across, upwards = (rounded(0.5 * (e[1:] + e[:-1]), 4) for e in edges)
    return heat_map(
        caption,
        across,
        upwards,
        np.where(shares > 0.0, shares, np.nan),
        (f"right [{unit}]", f"up [{unit}]", "% of time"),
        xaxis={"constrain": "domain"},
        yaxis={"scaleanchor": "x"},
    )


def heat_map(
    caption: str,
    x: ArrayLike | Sequence[str],
    y: ArrayLike | Sequence[str],
    z: ArrayLike,
    titles: tuple[str, str, str],
    limits: tuple[float, float] | None = None,
    **layout: Any,
) -> Chart:
    """A chart of colours.

    Parameters
    ----------
    caption : str
        What it shows.
    x, y : array_like, or sequence of str
        Middles of the cells, or their names.
    z : array_like
        (len(y), len(x)) values; NaN stays empty.
    titles : tuple of str
        Of the axes x and y and of the colours, with units.
    limits : tuple of float, optional
        Values of the first and the last colour; the least and the largest where left out.
    **layout : object
        Of Plotly: of the axes ``xaxis`` and ``yaxis``, and of the whole.
    """
    right, up, colour = titles
    data: dict[str, Any] = {
        "type": "heatmap",
        "x": _places(x),
        "y": _places(y),
        "z": [
            [None if np.isnan(v) else float(f"{v:.4g}") for v in row]
            for row in np.asarray(z).tolist()
        ],
        "colorbar": {"title": {"text": colour, "side": "right"}, "thickness": 12},
    }
    if limits is not None:
        data["zmin"], data["zmax"] = limits
    axes: dict[str, Any] = {"xaxis": {"title": {"text": right}}, "yaxis": {"title": {"text": up}}}
    for axis, more in layout.items():
        axes[axis] = {**axes[axis], **more} if isinstance(more, dict) else more
    return Chart(caption=caption, figure={"data": [data], "layout": axes})


def stiffness_chart(name: str, points: Sequence[str], stiffness: Floats) -> Chart:
    """A stiffness and its couplings, of a unit diagonal.

    Parameters
    ----------
    name : str
        What it is of.
    points : sequence of str
        Names of the n points.
    stiffness : Floats
        (6 n, 6 n) motions to forces and moments; rows of a diagonal of zero stay empty.
    """
    diagonal = stiffness.diagonal()
    size = np.sqrt(np.where(diagonal > 0.0, diagonal, np.nan))
    labels = [f"{point} {motion}" for point in points for motion in MOTIONS]
    titles = ("motion", "force or moment", "of the diagonal [-]")
    caption = f"Stiffness of {name} and its couplings, of a unit diagonal"
    return heat_map(caption, labels, labels, stiffness / np.outer(size, size), titles, (-1.0, 1.0))


def bars(
    caption: str,
    groups: Mapping[str, Mapping[str, float]],
    x: str,
    least: float | None = None,
    stacked: bool = False,
    ends: Mapping[str, Mapping[str, tuple[float, float]]] | None = None,
) -> Chart:
    """Horizontal bars, labels down the side in their order; dots on a logarithmic axis.

    A bar says how much by its length from zero, which a logarithmic axis does not have.

    Parameters
    ----------
    caption : str
        What they show.
    groups : dict
        Name of each colour, and its values by label.
    x : str
        Title of the axis of values, with its unit.
    least : float or None
        The axis is logarithmic, and this stands for all that is smaller.
    stacked : bool
        Bars of one label stand on one another, not side by side.
    ends : dict or None
        Least and most of values, by colour and label: how far they spread.
    """
    data = [
        {
            **_marks(number, least is not None),
            "name": name,
            "y": list(values),
            "x": rounded([v if least is None else max(v, least) for v in values.values()]),
            **_spread(values, (ends or {}).get(name, {})),
        }
        for number, (name, values) in enumerate(groups.items())
    ]
    labels = {label for values in groups.values() for label in values}
    count = len(labels) if stacked else sum(len(values) for values in groups.values())
    figure = chart(caption, data, x, "", "" if least is None else "x")
    figure.figure["layout"] |= {
        "barmode": "stack" if stacked else "group",
        "height": 160 + (34 if stacked else 24) * max(count, 4),
        "yaxis": {"autorange": "reversed", "automargin": True, "type": "category"},
    }
    return figure


_SYMBOLS = ("circle", "diamond", "square", "cross", "triangle-up")


def _marks(number: int, dots: bool) -> dict[str, Any]:
    """What a trace of `bars` is drawn as: bars, or dots of a symbol of its own."""
    if not dots:
        return {"type": "bar", "orientation": "h"}
    symbol = _SYMBOLS[number % len(_SYMBOLS)]
    return {"type": "scatter", "mode": "markers", "marker": {"size": 10, "symbol": symbol}}


def _spread(values: Mapping[str, float], ends: Mapping[str, tuple[float, float]]) -> dict[str, Any]:
    """Error bars of horizontal bars; none where nothing is said to spread."""
    if not ends:
        return {}
    pairs = [ends.get(label, (value, value)) for label, value in values.items()]
    low, high = zip(*pairs, strict=True)
    return error_bars("x", low, list(values.values()), high)


def _places(values: ArrayLike | Sequence[str]) -> list[Any]:
    named = np.asarray(values).dtype.kind == "U"
    return list(np.asarray(values).tolist()) if named else rounded(np.asarray(values))


def _shaded(traces: Sequence[Any], safe: tuple[float | None, float | None]) -> dict[str, Any]:
    """A green band behind the curves, to the outermost points where it has no bound."""
    shown = [x for t in traces for x in t["x"]]
    low, high = safe
    return {
        "type": "rect",
        "xref": "x",
        "yref": "paper",
        "x0": min(shown) if low is None else low,
        "x1": max(shown) if high is None else high,
        "y0": 0,
        "y1": 1,
        "fillcolor": "#2e7d32",
        "opacity": 0.12,
        "line": {"width": 0},
        "layer": "below",
    }
