"""Charts of the page of ``life``: load zones, maps of damage, pressure along rollers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.bearing.geometry import RollerRow, Row, angles
from fe_drivetrain.common.arrays import Floats, rounded
from fe_drivetrain.report.charts import chart, heat_map, trace
from fe_drivetrain.report.results import Chart
from fe_drivetrain.studies.life_sums import WindLoads
from fe_drivetrain.studies.rolling_bearings import row_names

SHOWN = 8
"""Winds of a polar picture, at most: the table has all."""


def load_zone(name: str, rows: Sequence[Row], mean: Floats, peak: Floats, seen: str) -> Chart:
    """Mean and largest load of the rollers' places.

    Parameters
    ----------
    name : str
        Name of the bearing.
    rows : sequence of Row
        Rows of the bearing.
    mean, peak : Floats
        (rows, elements) [N].
    seen : str
        How places are counted, as `OneBearing.seen`.

    Returns
    -------
    chart : Chart
        In polar coordinates: 0 degrees on the right, 90 on top of the chart.
    """
    data: list[Any] = []
    for r, (row, word) in enumerate(zip(rows, row_names(len(rows)), strict=True)):
        degrees = np.degrees(angles(row))
        closed = np.append(degrees, degrees[0] + 360.0)
        for values, kind, dash in ((mean[r], "mean", "solid"), (peak[r], "largest", "dot")):
            data.append(
                {
                    "type": "scatterpolar",
                    "mode": "lines",
                    "name": f"{word}, {kind}",
                    "theta": rounded(closed, 5),
                    "r": rounded(1e-3 * np.append(values, values[0]), 5),
                    "line": {"color": ("#0072b2", "#d55e00")[r % 2], "dash": dash},
                }
            )
    layout = {"polar": {"radialaxis": {"title": {"text": "kN"}, "angle": 45}}, "height": 520}
    return Chart(
        caption=f"{name}: load of the places of its rollers, {seen} [kN]",
        figure={"data": data, "layout": layout},
    )


def zones_by_wind(
    name: str, rows: Sequence[Row], by_wind: Sequence[WindLoads], what: str, seen: str
) -> Chart:
    """Load of the rollers' places at each wind, the rows side by side.

    Parameters
    ----------
    name : str
        Name of the bearing.
    rows : sequence of Row
        Rows of the bearing.
    by_wind : sequence of WindLoads
        The winds, of which `SHOWN` are drawn at most, the first and the last among them.
    what : {"mean", "largest"}
        Which load.
    seen : str
        How places are counted, as `OneBearing.seen`.

    Returns
    -------
    chart : Chart
        In polar coordinates.
    """
    count = min(len(by_wind), SHOWN)
    chosen = [by_wind[i] for i in np.linspace(0, len(by_wind) - 1, count).round().astype(int)]
    data: list[Any] = []
    layout: dict[str, Any] = {"height": 520}
    words = row_names(len(rows))
    for r, (row, word) in enumerate(zip(rows, words, strict=True)):
        degrees, polar = np.degrees(angles(row)), f"polar{r + 1 if r else ''}"
        for i, at in enumerate(chosen):
            values = 1e-3 * (at.mean if what == "mean" else at.peak)[r]
            hue = 240.0 * (1.0 - i / max(count - 1, 1))
            data.append(
                {
                    "type": "scatterpolar",
                    "mode": "lines",
                    "subplot": polar,
                    "name": f"{at.wind:g} m/s",
                    "legendgroup": f"{at.wind:g}",
                    "showlegend": r == 0,
                    "theta": rounded(np.append(degrees, degrees[0] + 360.0), 5),
                    "r": rounded(np.append(values, values[0]), 5),
                    "line": {"color": f"hsl({hue:.0f}, 75%, 42%)"},
                }
            )
        gap = 0.08 if len(rows) > 1 else 0.0
        domain = [r / len(rows) + gap * (r > 0), (r + 1) / len(rows) - gap * (r + 1 < len(rows))]
        axis = {"title": {"text": f"{word} [kN]"}, "angle": 45}
        layout[polar] = {"domain": {"x": domain}, "radialaxis": axis}
    sides = " left, ".join(words) + " right" if len(words) == 2 else words[0]
    caption = f"{name}: {what} load of the places of its rollers by wind, {sides}, {seen} [kN]"
    return Chart(caption=caption, figure={"data": data, "layout": layout})


def damage_map(
    caption: str,
    across: Floats,
    across_title: str,
    row: Row,
    values: Floats,
    planet: bool = False,
) -> Chart:
    """How damage is spread over places of rollers, and over wind or time.

    Parameters
    ----------
    caption : str
        What it shows.
    across : Floats
        (n,) wind [m/s] or time [s].
    across_title : str
        Its axis.
    row : Row
        Whose places they are.
    values : Floats
        (n, elements) damage, of which the map shows shares.
    planet : bool
        Whether it is a planet's bearing, whose places are counted on its pin.

    Returns
    -------
    chart : Chart
        In percent of all.
    """
    whole = values.sum()
    shares = 100.0 * values / whole if whole else values
    order = np.argsort(np.degrees(angles(row)) % 360.0)
    titles = across_title, f"place [deg], 90 {'along the tangent' if planet else 'on top'}", "%"
    places = np.degrees(angles(row))[order] % 360.0
    categories = {"type": "category"} if len(across) <= 12 and "wind" in across_title else {}
    shares, down = shares.T[order], {"dtick": 90}
    return heat_map(caption, across, places, shares, titles, xaxis=categories, yaxis=down)


def along_rollers(name: str, rows: Sequence[Row], worst: Floats) -> Chart:
    """Pressure along the roller that has the most of it.

    Parameters
    ----------
    name : str
        Of the bearing.
    rows : sequence of Row
        Rows of rollers.
    worst : Floats
        (rows, 2, laminae) on both races [Pa].

    Returns
    -------
    chart : Chart
        Against the place along the roller.
    """
    traces = []
    for r, (row, word) in enumerate(zip(rows, row_names(len(rows)), strict=True)):
        assert isinstance(row, RollerRow)
        for ring, (race, dash) in enumerate((("inner", "solid"), ("outer", "dot"))):
            traces.append(
                trace(
                    f"{word}, {race} race",
                    1e3 * row.places,
                    1e-6 * worst[r, ring],
                    line={"color": ("#0072b2", "#d55e00")[r % 2], "dash": dash},
                )
            )
    return chart(
        f"{name}: pressure along the roller with the largest pressure of all steps",
        traces,
        "place along the roller, downwind [mm]",
        "Hertz pressure [MPa]",
    )
