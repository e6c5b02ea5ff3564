"""Charts of the page of ``life``: load zones, maps of damage, pressure along rollers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.bearing.geometry import RollerRow, Row, angles
from fe_drivetrain.common.arrays import Floats, rounded
from fe_drivetrain.report.charts import chart, heat_map, trace
from fe_drivetrain.report.results import Chart
from fe_drivetrain.studies.life_sums import row_names


def load_zone(name: str, rows: Sequence[Row], mean: Floats, peak: Floats, seen: str) -> Chart:
    """Mean and largest load of the rollers' places.

    Parameters
    ----------
    name : str
        Of the bearing.
    rows : sequence of Row
        Of the bearing.
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
