"""A drivetrain from the side: its shaft, and its bearings with how they stand to limits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.answer import Status
from fe_drivetrain.report.charts import chart, trace
from fe_drivetrain.report.results import Chart

_COLOURS: Mapping[Status, str] = {
    "good": "#2e7d32",
    "watch": "#c77700",
    "bad": "#c62828",
    "none": "#4b6f96",
}
_STEEL = "#9aa7b5"


def drivetrain_sketch(
    caption: str,
    scene: Scene,
    words: Mapping[str, Sequence[str]],
    status: Mapping[str, Status],
) -> Chart:
    """Draw a scene from the side, to scale.

    Parameters
    ----------
    caption : str
        What it shows.
    scene : Scene
        The drivetrain.
    words : mapping of str to sequence of str
        Lines that stand at a bearing, by its name.
    status : mapping of str to Status
        How each bearing stands to its limits.

    Returns
    -------
    Chart
        Lengths in m; x downwind, z up.
    """
    x, r = _outline(scene)
    traces = [
        trace(
            "shaft",
            [*x, *reversed(x), x[0]],
            [*r, *(-v for v in reversed(r)), r[0]],
            fill="toself",
            fillcolor=_STEEL,
            line={"color": "#52606d", "width": 1.5},
            hoverinfo="skip",
        )
    ]
    shapes: list[dict[str, Any]] = []
    notes: list[dict[str, Any]] = []
    top = max(max(r), *(u.bearing.raceway_diameter / 2 for u in scene.bearing_units), 0.0)
    for number, unit in enumerate(scene.bearing_units):
        bearing = unit.bearing
        low, high = bearing.span
        seat, outer = scene.seat_diameter(bearing.name) / 2, bearing.raceway_diameter / 2
        colour = _COLOURS[status.get(bearing.name, "none")]
        for sign in (1, -1):
            shapes.append(_box(low, high, sign * seat, sign * outer, colour))
        lines = [f"<b>{bearing.name}</b>", *words.get(bearing.name, ())]
        notes.append(
            {
                "x": bearing.x,
                "y": outer,
                "ax": 0,
                "ay": -20 - 10 * len(lines) - (50 * (number % 2) if words else 0),
                "text": "<br>".join(lines),
                "arrowcolor": colour,
                "font": {"size": 14},
            }
        )
    notes += [
        _end(x[0], "hub", -50),
        _end(x[-1], "gearbox" if scene.gearbox.weight else "rear end", 55),
    ]
    found = chart(caption, traces, "x [m]", "z [m]")
    found.figure["layout"] |= {
        "shapes": shapes,
        "annotations": notes,
        "showlegend": False,
        "xaxis": {"title": {"text": "x [m]"}, "zeroline": False},
        "height": 430,
        "yaxis": {
            "title": {"text": "z [m]"},
            "scaleanchor": "x",
            "zeroline": False,
            "range": rounded([-1.4 * top, 3.2 * top]),
        },
    }
    return found


def _outline(scene: Scene) -> tuple[list[float], list[float]]:
    """Stations along the shaft and its outer radius there [m]."""
    x: list[float] = []
    r: list[float] = []
    at = scene.shaft.front
    for piece in scene.shaft.pieces:
        x += [at, at + piece.length]
        r += [piece.outer_diameter / 2, piece.end_diameter / 2]
        at += piece.length
    return x, r


def _box(x0: float, x1: float, y0: float, y1: float, colour: str) -> dict[str, Any]:
    return {
        "type": "rect",
        "x0": x0,
        "x1": x1,
        "y0": y0,
        "y1": y1,
        "fillcolor": colour,
        "opacity": 0.85,
        "line": {"color": colour, "width": 1},
    }


def _end(x: float, text: str, shift: int) -> dict[str, Any]:
    return {"x": x, "y": 0.0, "ax": shift, "ay": 0, "text": text, "font": {"size": 14}}
