"""Figures of what the program computes: loads over time, reactions, stiffness, levels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats, rounded
from fe_drivetrain.common.components import FORCES, MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.plots.style import LEGEND, PALETTE, styled

MINIMUM = 1e-8
"""Relative errors that are smaller are drawn here: a logarithmic axis has no zero."""

_NOTHING = 1e-9  # share of the diagonal: round-off, of what symmetry makes zero
_CHOSEN = {
    "mode": "markers+text",
    "text": ["chosen"],
    "textposition": "bottom center",
    "cliponaxis": False,
}
_READABLE = 6  # rows of a matrix whose cells have room for a number


def figure(traces: Sequence[Mapping[str, Any]], layout: Mapping[str, Any]) -> Any:
    """Make a Plotly figure in the style of the pages.

    Parameters
    ----------
    traces : sequence of mapping
        Traces in Plotly's form, "name", "x" and "y" in the first place.
    layout : mapping
        Layout in Plotly's form.

    Returns
    -------
    plotly.graph_objects.Figure
        Figure: ``show()`` draws it, ``write_html`` and ``write_image`` save it.
    """
    from plotly.graph_objects import Figure  # takes longer than most scripts that draw nothing

    return Figure(styled(traces, layout))


def load_lines(time: Floats, loads: Floats, title: str = "") -> Any:
    """Forces and moments at a point over time, those at the hub as well as reactions.

    Parameters
    ----------
    time : Floats
        Time (n,) [s].
    loads : Floats
        Loads (n, 6) Fx, Fy, Fz [N], Mx, My, Mz [N m].
    title : str
        Title: what the loads are.

    Returns
    -------
    plotly.graph_objects.Figure
        Forces [kN] above moments [kN m].

    Raises
    ------
    InputError
        The shapes do not belong together.
    """
    time, loads = np.asarray(time, dtype=np.float64), np.asarray(loads, dtype=np.float64)
    if time.ndim != 1 or loads.shape != (time.size, 6):
        raise InputError(
            f"time has shape {time.shape} and loads {loads.shape}: give (n,) and (n, 6) in the "
            f"order {', '.join(FORCES)}"
        )
    traces = [
        {"name": name, "x": time.tolist(), "y": (values / 1e3).tolist(), **_panel(number)}
        for number, (name, values) in enumerate(zip(FORCES, loads.T, strict=True))
    ]
    below = {"anchor": "y2", "matches": "x", "title": {"text": "time [s]"}}
    above = {"anchor": "y", "showticklabels": False}
    return figure(traces, _two_panels(title, above, below))


def load_bars(loads: Mapping[str, Floats], title: str = "") -> Any:
    """Forces and moments at several places beside each other.

    Parameters
    ----------
    loads : mapping
        Loads (6,) Fx, Fy, Fz [N], Mx, My, Mz [N m] by the name of the place.
    title : str
        Title: what the loads are.

    Returns
    -------
    plotly.graph_objects.Figure
        Forces [kN] above moments [kN m], a colour for each place.
    """
    traces = []
    for place, (name, values) in enumerate(loads.items()):
        colour = PALETTE[place % len(PALETTE)]
        for start in (0, 3):
            traces.append(
                {
                    "type": "bar",
                    "name": name,
                    "x": list(FORCES[start : start + 3]),
                    "y": (np.asarray(values, dtype=np.float64)[start : start + 3] / 1e3).tolist(),
                    "legendgroup": name,
                    "showlegend": start == 0,
                    "marker": {"color": colour},
                    **_panel(start),
                }
            )
    return figure(traces, _two_panels(title, {"anchor": "y"}, {"anchor": "y2"}))


def stiffness_map(points: Sequence[str], stiffness: Floats, title: str = "") -> Any:
    """A stiffness matrix: how strongly its degrees of freedom are coupled, and its values.

    Parameters
    ----------
    points : sequence of str
        Names of n points.
    stiffness : Floats
        Stiffness (6 n, 6 n): forces and moments of each point to its motions [N/m, N, N m/rad].
    title : str
        Title: what the stiffness is of.

    Returns
    -------
    plotly.graph_objects.Figure
        The colour is |K_ij| / sqrt(K_ii K_jj), at most 1 of a positive matrix; the value is in
        the cell, or under the pointer where there are many.

    Raises
    ------
    InputError
        The shape does not fit the number of points.
    """
    K, n = np.asarray(stiffness, dtype=np.float64), len(points)
    if K.shape != (6 * n, 6 * n):
        raise InputError(
            f"the stiffness has shape {K.shape} for {n} points: give {6 * n} rows and columns"
        )
    before = [f"{point} " if n > 1 else "" for point in points]
    share = _coupling(K)
    block = np.kron([[0, 1], [1, 2]], np.ones((3, 3), dtype=int))
    units = np.array(["N/m", "N", "N m/rad"])[np.tile(block, (n, n))]
    trace: dict[str, Any] = {
        "type": "heatmap",
        "x": [f"{point}{motion}" for point in before for motion in MOTIONS],
        "y": [f"{point}{force}" for point in before for force in FORCES],
        "z": share.tolist(),
        "zmin": 0.0,
        "zmax": 1.0,
        "text": _written(K, share),
        "customdata": units.tolist(),
        "hovertemplate": "%{y} to %{x}: %{text} %{customdata}<extra></extra>",
        "colorbar": {"title": {"text": "coupling", "side": "right"}, "thickness": 12},
    }
    if 6 * n <= _READABLE:
        trace["texttemplate"] = "%{text}"
    return figure([trace], {**_titled(title), **_MATRIX_LAYOUT})


_MATRIX_LAYOUT = {
    "xaxis": {"title": {"text": "motion"}, "constrain": "domain"},
    "yaxis": {
        "title": {"text": "force"},
        "autorange": "reversed",
        "scaleanchor": "x",
        "constrain": "domain",
    },
    "height": 560,
}


def _coupling(stiffness: Floats) -> Floats:
    """Each entry over the root of the product of its two diagonal entries."""
    roots = np.sqrt(np.clip(stiffness.diagonal(), 0.0, None))
    sizes = np.outer(roots, roots)
    share = np.zeros_like(stiffness)
    np.divide(np.abs(stiffness), sizes, out=share, where=sizes > 0)
    return share


def _written(stiffness: Floats, coupling: Floats) -> list[list[str]]:
    """Entries as text, round-off as zero."""
    return [
        ["0" if share < _NOTHING else f"{value:.3g}" for value, share in zip(*row, strict=True)]
        for row in zip(stiffness, coupling, strict=True)
    ]


def error_range(errors: Sequence[float], tolerance: float, band: float = 0.0) -> list[float]:
    """Ends of a logarithmic axis of errors in percent: all points, and bars but for those to zero.

    Parameters
    ----------
    errors : sequence of float
        Relative errors; what is not known is left out.
    tolerance : float
        Allowed relative error.
    band : float
        Half width of the largest uncertainty of an error, relative as that.

    Returns
    -------
    list of float
        Powers of ten of both ends.
    """
    known = [max(error, MINIMUM) for error in errors if np.isfinite(error)]
    high = max([*known, tolerance]) + (band if np.isfinite(band) else 0.0)
    ends = 100.0 * np.array([0.3 * min([*known, tolerance]), 2.0 * high])
    return [float(power) for power in np.log10(ends)]


def error_traces(
    names: Sequence[str],
    seconds: Sequence[float],
    errors: Sequence[float],
    tolerance: float,
    chosen: int | None = None,
    bands: Sequence[float] | None = None,
) -> list[dict[str, Any]]:
    """Traces of `error_against_time`, for a figure of one's own; the arguments are its.

    Returns
    -------
    list of dict
        A point for each model whose error is known, and the tolerance as a line.
    """
    known = [k for k, error in enumerate(errors) if np.isfinite(error)]
    traces: list[dict[str, Any]] = [
        {
            "type": "scatter",
            "mode": "markers",
            "name": names[k],
            "x": rounded([seconds[k]]),
            "y": rounded([100.0 * max(errors[k], MINIMUM)]),
            "marker": {"size": 14 if k == chosen else 9},
            **(_CHOSEN if k == chosen else {}),
            **({} if bands is None else _bars(errors[k], bands[k])),
        }
        for k in known
    ]
    reach = [seconds[k] for k in known] or [1.0]
    limit = {
        "x": rounded([min(reach), max(reach)]),
        "y": [100.0 * tolerance] * 2,
        "line": {"dash": "dash"},
    }
    return [*traces, {"type": "scatter", "mode": "lines", "name": "tolerance", **limit}]


def error_against_time(
    names: Sequence[str],
    seconds: Sequence[float],
    errors: Sequence[float],
    tolerance: float,
    chosen: int | None = None,
    title: str = "",
    bands: Sequence[float] | None = None,
) -> Any:
    """Plot the error of models against their time, the error relative to the best of them.

    Parameters
    ----------
    names : sequence of str
        Names of the models.
    seconds : sequence of float
        Wall time of each [s].
    errors : sequence of float
        Relative errors; a model whose error is not known is left out, and less than `MINIMUM` drawn
        there.
    tolerance : float
        Allowed relative error.
    chosen : int, optional
        Index of the model that is good enough, drawn larger, with that word.
    title : str
        Title: the quantity that the error is of.
    bands : sequence of float, optional
        Half width of the uncertainty of each error, relative as that; drawn as bars.

    Returns
    -------
    plotly.graph_objects.Figure
        Figure with both axes logarithmic, the tolerance as a line.
    """
    traces = error_traces(names, seconds, errors, tolerance, chosen, bands)
    axes = {
        "xaxis": {"title": {"text": "time [s]"}, "type": "log"},
        "yaxis": {"title": {"text": "error [%]"}, "type": "log"},
    }
    return figure(traces, {**_titled(title), **axes})


def _bars(error: float, band: float) -> dict[str, Any]:
    """The band of an error; a logarithmic axis has no zero, so down to the least that is drawn."""
    if not np.isfinite(band) or band <= 0.0:
        return {}
    at = max(error, MINIMUM)
    ends = {"array": [100.0 * band], "arrayminus": [100.0 * min(band, at - MINIMUM)]}
    return {"error_y": {"type": "data", "symmetric": False, **ends, "thickness": 1.5}}


def _titled(title: str) -> dict[str, Any]:
    """A title on top, the legend between it and the plot."""
    if not title:
        return {}
    place = {"x": 0, "xref": "paper", "y": 1, "yref": "container", "yanchor": "top"}
    return {
        "title": {"text": title, "pad": {"t": 12}, **place},
        "legend": LEGEND,
        "margin": {"t": 90},
    }


def _panel(component: int) -> dict[str, str]:
    """Forces above, moments below."""
    return {} if component < 3 else {"xaxis": "x2", "yaxis": "y2"}


def _two_panels(title: str, above: Mapping[str, Any], below: Mapping[str, Any]) -> dict[str, Any]:
    return {
        **_titled(title),
        "height": 560,
        "xaxis": dict(above),
        "xaxis2": dict(below),
        "yaxis": {"title": {"text": "force [kN]"}, "domain": [0.55, 1.0]},
        "yaxis2": {"title": {"text": "moment [kN m]"}, "domain": [0.0, 0.45]},
    }
