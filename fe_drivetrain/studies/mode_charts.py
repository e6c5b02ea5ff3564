"""Charts of a drivetrain's modes: Campbell diagram, and frequencies by kind."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.common.components import RPM
from fe_drivetrain.procedure import Excitation, Meeting
from fe_drivetrain.report.charts import chart, crosses, trace
from fe_drivetrain.report.results import Chart
from fe_drivetrain.studies.mode_record import TORSIONAL, Modes

CAMPBELL = (
    "Campbell diagram: natural frequencies over the speed of the rotor, excitations, and where "
    "they meet in operation (shaded)"
)
FREQUENCIES = "Natural frequencies at rest, by the direction in which most moves"
_POINTS = 25  # of a straight line on a logarithmic axis
_ROOM = 0.07  # that a name needs, over the height of the chart
_GREY = "#767676"

#: How excitations go together in the legend, and their colours.
_FAMILIES = {
    "rotor": "#d55e00",
    "planets passing": "#cc79a7",
    "shafts": "#e69f00",
    "meshes": "#56b4e9",
    "fixed": "#882255",
}


def family(excitation: Excitation) -> str:
    """Kind of an excitation, as the legend has it."""
    name = excitation.name
    if excitation.fixed:
        return "fixed"
    if excitation.at == ("rotor",):
        return "rotor"
    if name.endswith("planets passing"):
        return "planets passing"
    return "meshes" if " mesh " in name else "shafts"


def campbell_chart(modes: Modes) -> Chart:
    """Campbell diagram of the modes that an excitation of operation can reach.

    Parameters
    ----------
    modes : Modes
        With frequencies over the speed, and speeds of operation.
    """
    if modes.campbell is None or modes.speeds is None:
        raise ValueError("these modes have no speeds: draw their frequencies")
    last = float(modes.campbell.speeds[-1])
    first = float(modes.frequencies[0])
    # once a turn at the largest speed is in it
    lowest = min(0.6 * first, 0.4 * modes.speeds[1] / np.pi)
    highest = max([one.frequency(last) for one in modes.excitations], default=0.0)
    shown = first if modes.torsional is None else float(modes.frequencies[modes.torsional])
    highest = max(highest, 1.5 * shown)
    traces = _excitations(modes.excitations, last, lowest, highest)
    traces += _curves(modes, highest)
    traces += _crossings(modes)
    low, high = (speed * RPM for speed in modes.speeds)
    found = chart(
        CAMPBELL,
        traces,
        "speed of the rotor [rpm]",
        "frequency [Hz]",
        ("y",),
        (low, high),
        x_range=(0.6 * low, last * RPM),
        y_range=(lowest, 1.3 * highest),
    )
    found.figure["layout"]["height"] = 560
    return found


def frequency_chart(modes: Modes) -> Chart:
    """Frequencies of the first modes over their number, by kind."""
    shown = min(40, len(modes.frequencies))
    traces = []
    for kind in dict.fromkeys(modes.kinds[:shown]):
        of = [k for k in range(shown) if modes.kinds[k] == kind]
        points = trace(kind, [k + 1 for k in of], modes.frequencies[of], True)
        traces.append(points | {"marker": {"size": 9}, "text": [modes.words[k] for k in of]})
    return chart(FREQUENCIES, traces, "number of the mode", "frequency [Hz]", ("y",))


def _excitations(
    every: Iterable[Excitation], last: float, lowest: float, highest: float
) -> list[Any]:
    """A trace for each family, whose lines have gaps between them, and names at their ends."""
    lines: dict[str, dict[str, list[Any]]] = {}
    ends: list[tuple[float, str]] = []
    for one in every:
        top = one.frequency(last)
        if top <= lowest:
            continue
        first = 0.0 if one.fixed else 0.8 * last * lowest / top
        speeds = np.linspace(first, last, _POINTS)
        line = lines.setdefault(family(one), {"x": [], "y": [], "text": []})
        line["x"] += [*rounded(speeds * RPM), None]
        line["y"] += [*rounded([one.frequency(speed) for speed in speeds]), None]
        line["text"] += [one.name] * (_POINTS + 1)
        if one.at == ("rotor",) or one.name.endswith((" 1x", "passing")):
            ends.append((top, one.name))
    found = [
        {
            **trace(name, [], []),
            **lines[name],
            "line": {"color": colour, "width": 1.2},
            "hoverinfo": "text+x+y",
        }
        for name, colour in _FAMILIES.items()
        if name in lines
    ]
    return [*found, _names(ends, last, (highest / lowest) ** _ROOM)]


def _names(ends: Iterable[tuple[float, str]], last: float, apart: float) -> dict[str, Any]:
    """Names at the ends of lines, of as many as have room; the first that come are kept."""
    shown: list[tuple[float, str]] = []
    for top, name in ends:
        if all(max(top / other, other / top) > apart for other, _ in shown):
            shown.append((top, name))
    return {
        **trace("", [last * RPM] * len(shown), [top for top, _ in shown], mode="text"),
        "text": [name for _, name in shown],
        "textposition": "bottom left",
        "textfont": {"size": 11},
        "showlegend": False,
        "hoverinfo": "skip",
    }


def _curves(modes: Modes, highest: float) -> list[Any]:
    """Frequencies over the speed: torsional modes, and all others."""
    diagram = modes.campbell
    if diagram is None:
        return []
    speeds = rounded(diagram.speeds * RPM)
    found = []
    for name, torsional in (("torsional modes", True), ("other modes", False)):
        line: dict[str, list[Any]] = {"x": [], "y": [], "text": []}
        for k, kind in enumerate(modes.kinds):
            if (kind == TORSIONAL) is torsional and modes.frequencies[k] <= highest:
                own = diagram.frequencies[:, k]
                line["x"] += [*speeds, None]
                line["y"] += [*(None if np.isnan(f) else rounded([f])[0] for f in own), None]
                line["text"] += [f"mode {k + 1}: {modes.words[k]}"] * (len(speeds) + 1)
        look = {"color": "#0072b2", "width": 2.2} if torsional else {"color": _GREY, "width": 1}
        if line["x"]:
            found.append({**trace(name, [], []), **line, "line": look, "hoverinfo": "text+x+y"})
    return found


def _crossings(modes: Modes) -> list[Any]:
    """Where excitations meet modes: those that can be excited, and the rest."""
    rest = [one for one in modes.meetings if one.margin == 0.0 and one.verdict == "not excited"]
    small = _points("crossing, not excited", rest)
    small["marker"] = {"symbol": "circle-open", "size": 6, "color": _GREY}
    met = _points("crossing, excited", modes.resonances)
    # the more of the mode's energy is where the excitation acts, the larger
    met["marker"] |= {"size": rounded([6 + 10 * one.share for one in modes.resonances])}
    return [one for one in (small, met) if one["x"]]


def _points(name: str, meetings: list[Meeting]) -> dict[str, Any]:
    """Points of meetings at a speed, with what meets in their labels."""
    at = [one for one in meetings if np.isfinite(one.crossing)]
    words = [f"{m.excitation}, mode {m.mode}, {100 * m.share:.0f} % of its energy" for m in at]
    points = crosses(name, [m.crossing * RPM for m in at], [m.frequency for m in at])
    return {**points, "text": words, "hoverinfo": "text+x+y"}
