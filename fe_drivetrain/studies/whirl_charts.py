"""Charts of whirling shafts: Campbell diagram by sense, unbalance, error against time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.common.components import RPM
from fe_drivetrain.dynamics.whirl.modes import BACKWARD, FORWARD, STRAIGHT, WhirlChart, sense_word
from fe_drivetrain.report.charts import chart, crosses, marked, trace
from fe_drivetrain.report.results import Chart
from fe_drivetrain.studies.whirl_record import ShaftWhirl

CAMPBELL = (
    "Campbell diagram of {}: forward and backward whirl over the speed, critical speeds marked"
)
RESPONSE = "Whirl of {} by its unbalance: largest half axis of any node over the speed"
LADDER = "Error of the first critical speed against the processor time of each level"
FEW = 6
"""Modes that a Campbell diagram shows where they are not far above once a turn."""
COLOURS = {FORWARD: "#0072b2", BACKWARD: "#d55e00", STRAIGHT: "#767676"}


def whirl_campbell(shaft: ShaftWhirl) -> Chart:
    """Campbell diagram of a shaft, its operation shaded.

    Parameters
    ----------
    shaft : ShaftWhirl
        What was found of it.
    """
    met = [one.speed for one in shaft.criticals]
    return campbell_of(shaft.chart, met, CAMPBELL.format(shaft.name), shaft.range)


def campbell_of(
    found: WhirlChart,
    criticals: Sequence[float],
    caption: str,
    operation: tuple[float, float] | None = None,
) -> Chart:
    """Campbell diagram with a colour for each sense of whirl.

    Parameters
    ----------
    found : WhirlChart
        Modes over the speed.
    criticals : sequence of float
        Speeds of whirl once a turn [rad/s].
    caption : str
        What it shows.
    operation : tuple of float, optional
        Least and largest speed in operation [rad/s], shaded.
    """
    speeds = found.speeds * RPM
    lines: dict[str, dict[str, list[Any]]] = {word: {"x": [], "y": []} for word in COLOURS}
    for k in range(found.frequencies.shape[1]):
        own, senses = found.frequencies[:, k], found.senses[:, k]
        words = [sense_word(sense) for sense in senses]
        words[0] = words[1]  # at rest a round shaft has no sense
        start = 0
        for i in range(1, len(words) + 1):
            if i == len(words) or words[i] != words[start]:
                part = slice(start, min(i + 1, len(words)))
                line = lines[words[start]]
                line["x"] += [*rounded(speeds[part]), None]
                line["y"] += [*(None if np.isnan(f) else rounded([f])[0] for f in own[part]), None]
                start = i
    traces = [
        {**trace(word, [], []), **line, "line": {"color": COLOURS[word], "width": 2}}
        for word, line in lines.items()
        if line["x"]
    ]
    top = float(speeds[-1])
    once = {"dash": "dot", "color": "#333333", "width": 1.2}
    traces.append(trace("once a turn", [0.0, top], [0.0, top / 60.0], line=once))
    met = np.asarray(criticals, dtype=float) * RPM
    traces.append(crosses("critical speeds", met, met / 60.0))
    # once a turn, and the first modes as far as they are not far above it
    few = float(np.nanmax(found.frequencies[:, :FEW], initial=0.0))
    highest = 1.15 * max(top / 60.0, min(few, 4.0 * top / 60.0))
    drawn = chart(
        caption,
        traces,
        "speed of the shaft [rpm]",
        "frequency [Hz]",
        (),
        None if operation is None else (operation[0] * RPM, operation[1] * RPM),
        x_range=(0.0, top),
        y_range=(0.0, highest),
    )
    drawn.figure["layout"]["height"] = 520
    return drawn


def response_chart(shaft: ShaftWhirl) -> Chart:
    """Largest whirl of any node by unbalance over the speed.

    Parameters
    ----------
    shaft : ShaftWhirl
        What was found of it.
    """
    found = shaft.response
    largest = 1e6 * found.amplitudes[1:].max(axis=1)
    low, high = (speed * RPM for speed in shaft.range)
    return chart(
        RESPONSE.format(shaft.name),
        [trace("largest of all nodes", found.speeds[1:] * RPM, largest)],
        "speed of the shaft [rpm]",
        "half axis of the whirl [um]",
        ("y",),
        (low, high),
    )


def ladder_chart(shafts: Sequence[ShaftWhirl]) -> Chart | None:
    """Error of each level against its processor time; None where levels do not differ.

    Parameters
    ----------
    shafts : sequence of ShaftWhirl
        What was found of each.
    """
    curves = []
    for shaft in shafts:
        best = shaft.ladder[-1].speed
        points = [
            (rung.seconds, 100 * abs(rung.speed / best - 1))
            for rung in shaft.ladder[:-1]
            if rung.speed is not None and best
        ]
        shown = [(seconds, error) for seconds, error in points if error > 1e-9 and seconds > 0]
        if shown:
            curves.append(marked(shaft.name, *zip(*shown, strict=True)))
    if not curves:
        return None
    return chart(LADDER, curves, "processor time [s]", "error [%]", ("x", "y"))
