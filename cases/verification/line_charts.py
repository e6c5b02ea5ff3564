"""Charts of lines, as Plotly's JSON."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.results import Chart


def trace(name: str, x: ArrayLike, y: ArrayLike, points: bool = False, **more: Any) -> Any:
    """A line, or points; numbers rounded to what a chart can show."""
    return {
        "type": "scatter",
        "mode": "markers" if points else "lines",
        "name": name,
        "x": _rounded(x),
        "y": _rounded(y),
        **more,
    }


def chart(
    caption: str, traces: Sequence[Any], x: str, y: str, logarithmic: Iterable[str] = ()
) -> Chart:
    """A chart of traces.

    Parameters
    ----------
    caption
        What it shows.
    traces
        From `trace`.
    x, y
        Titles of the axes, with units.
    logarithmic
        "x", "y" or both.
    """
    axes: dict[str, dict[str, Any]] = {
        "xaxis": {"title": {"text": x}},
        "yaxis": {"title": {"text": y}},
    }
    for axis in logarithmic:
        axes[f"{axis}axis"]["type"] = "log"
        # plain powers of ten, not 2 and 5 between them
        axes[f"{axis}axis"]["exponentformat"] = "power"
    return Chart(caption=caption, figure={"data": list(traces), "layout": axes})


def _rounded(values: ArrayLike) -> list[float]:
    return [float(f"{v:.6g}") for v in np.ravel(np.asarray(values, dtype=float))]
