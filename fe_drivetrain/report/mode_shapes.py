"""Mode shapes that swing on a page."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats, rounded
from fe_drivetrain.report.chart_style import SWING
from fe_drivetrain.report.charts import chart, trace
from fe_drivetrain.report.results import Chart

_STILL = "#767676"


def shape_chart(
    caption: str,
    names: Sequence[str],
    shapes: Floats,
    words: Sequence[str],
    axis: str,
    swinging: int = 0,
) -> Chart:
    """Motions of bodies in a row, a curve for each mode, of which one swings on the page.

    Parameters
    ----------
    caption : str
        What they are of.
    names : sequence of str
        Names of the n bodies, in their order.
    shapes : ndarray, (n, m)
        Motion of each body in each mode, of any size.
    words : sequence of str
        Name of each of the m modes, as with its frequency.
    axis : str
        Title of the axis of motions.
    swinging : int
        Number of the mode that swings: its curve at rest and swung to the other side is drawn, too.

    Returns
    -------
    Chart
        Still where a program draws it that lets nothing swing.
    """
    at, text = np.arange(len(names)), list(names)
    curves: list[Any] = [
        trace(word, at, shape, mode="lines+markers", text=text)
        for word, shape in zip(words, shapes.T, strict=True)
    ]
    out = shapes[:, swinging]
    curves[swinging]["line"] = {"width": 3}
    line = {"color": _STILL, "width": 1.2, "dash": "dot"}
    other = f"{words[swinging]}, to the other side"
    curves.append(trace(other, at, -out, line=line, hoverinfo="skip"))
    drawn = chart(caption, curves, "", axis)
    named = {"tickmode": "array", "tickvals": at.tolist(), "ticktext": text, "tickangle": -30}
    drawn.figure["layout"]["xaxis"] |= {**named, "automargin": True}
    still = [0.0] * len(at)
    drawn.figure[SWING] = {
        "trace": swinging,
        "x": rounded(at),
        "y": still,
        "dx": still,
        "dy": rounded(out),
    }
    return drawn
