"""Sections of the page of ``loads``: planes of force and moment, spectra, load loops."""

from __future__ import annotations

from typing import Any

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats, rounded
from fe_drivetrain.report.charts import heat_map, trace
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.studies.load_digest import LOADS, UNIT_OF, UNITS
from fe_drivetrain.studies.load_histories import LoadsResult
from fe_drivetrain.studies.load_planes import SECTORS
from fe_drivetrain.studies.load_records import multiple_columns
from fe_drivetrain.studies.load_totals import LoadTotals
from fe_drivetrain.studies.shown_units import shown_unit
from fe_drivetrain.turbine_loads.histories.spectra import (
    FEWEST,
    MULTIPLES,
    NEAR,
    SEGMENT,
    WINDOW,
    Campbell,
)
from fe_drivetrain.turbine_loads.histories.spectrum_sums import HIGHEST
from fe_drivetrain.turbine_loads.hub_loads.loops import LONGEST, ROUNDNESS, SHARE

_SEEN = {
    "force": "it points from the origin ({}); right is 0 deg, up is 90 deg",
    "moment": "its axis points from the origin ({}); right, 0 deg, is an overhung weight, "
    "left, 180 deg, a rotor that the wind overturns",
}


def shape(page: Page, result: LoadsResult) -> None:
    """Add the sections.

    Parameters
    ----------
    page : Page
        Takes tables and charts.
    result : LoadsResult
        What was found.
    """
    if result.hub.planes:
        _planes(page, result.hub)
    _spectra(page, result.hub)
    if result.hub.planes:
        _loops(page, result)


def _planes(page: Page, found: LoadTotals) -> None:
    page.section("Direction of force and moment")
    for name, unit in (("force", "kN"), ("moment", "kN m")):
        if name not in found.planes:
            continue
        plane = found.planes[name].positions
        with np.errstate(divide="ignore"):
            share = np.log10(100.0 * plane.amount / plane.amount.sum())
        share[np.isinf(share)] = np.nan
        across, above = plane.edges(0) / 1e3, plane.edges(1) / 1e3
        near = all(2 * e[0] - e[-1] <= 0.0 <= 2 * e[-1] - e[0] for e in (across, above))
        where = "the cross" if near else "beyond the picture"
        chart = heat_map(
            f"Share of time of each {name} across the shaft, looking downwind: "
            + _SEEN[name].format(where),
            plane.middles(0) / 1e3,
            plane.middles(1) / 1e3,
            share.T,
            (f"right [{unit}]", f"up [{unit}]", "log10 of % of the time"),
            xaxis={"constrain": "domain"},
            yaxis={"scaleanchor": "x"},
            height=560,
        )
        if near:
            cross = {"symbol": "cross-thin-open", "color": "#1f2933", "size": 12}
            origin = trace("origin", [0.0], [0.0], points=True, marker=cross, showlegend=False)
            chart.figure["data"] += [*_rings(across, above), origin]
        page.add(chart)
    for name, of_plane in found.planes.items():
        page.add(_rose(name, of_plane.directions))


def _rings(across: Floats, above: Floats) -> list[Any]:
    """Circles of equal size about the origin."""
    reach = max(float(np.abs(edges).max()) for edges in (across, above))
    power = 10.0 ** np.floor(np.log10(reach / 2.0))
    step = power * max(k for k in (1.0, 2.0, 5.0) if k * power <= reach / 2.0)
    angle = np.linspace(0.0, 2.0 * np.pi, 73)
    rings = []
    for size in np.arange(step, reach, step).tolist():
        x, y = size * np.cos(angle), size * np.sin(angle)
        seen = (x >= across[0]) & (x <= across[-1]) & (y >= above[0]) & (y <= above[-1])
        rings.append(
            trace(
                f"{size:g}",
                np.where(seen, x, np.nan),
                np.where(seen, y, np.nan),
                line={"dash": "dot", "width": 1, "color": "#9aa5b1"},
                showlegend=False,
                hoverinfo="name",
            )
        )
    return rings


def _rose(name: str, seconds: Floats) -> Chart:
    """Share of time by direction, as a polar chart."""
    width = 360.0 / SECTORS
    data = {
        "type": "barpolar",
        "theta": [width * k for k in range(SECTORS)],
        "width": [width] * SECTORS,
        "r": rounded(100.0 * seconds / seconds.sum()),
    }
    layout = {
        "polar": {
            "angularaxis": {"tickmode": "array", "tickvals": [0, 90, 180, 270], "ticksuffix": "°"},
            "radialaxis": {"title": {"text": "% of time"}, "angle": 45, "tickangle": 45},
        },
        "height": 380,
    }
    return Chart(
        caption=f"Direction of the {name} across the shaft, looking downwind: share of time in "
        f"sectors of {width:g} deg; 0 deg is right, 90 deg up"
        + ("; the axis of the moment" if name == "moment" else ""),
        figure={"data": [data], "layout": layout},
    )


def _spectra(page: Page, found: LoadTotals) -> None:
    page.section("Spectra")
    frequency, density = found.spectra.frequency, found.spectra.density
    if not len(frequency):
        page.text(
            f"No file lasts half of a segment of {SEGMENT:g} s, with {FEWEST} samples or more in "
            "one, so there is no spectrum."
        )
        return
    if found.spectra.rates > 1:
        page.text(
            f"Files are sampled at several rates; spectra end at {frequency[-1]:g} Hz, which the "
            "slowest has."
        )
    for chosen in found.by_kind:
        unit = shown_unit(UNIT_OF[chosen[0]])
        traces = [
            trace(name, frequency[1:], density[LOADS.index(name), 1:] / 1e6) for name in chosen
        ]
        if found.rotor_frequency is not None:
            low, high = min(min(t["y"]) for t in traces), max(max(t["y"]) for t in traces)
            within = max(low, 1e-9 * high), high
            traces += _multiple_lines(found.rotor_frequency, float(frequency[-1]), within)
        page.chart(
            f"Power spectral density, mean of all files; {WINDOW}, {SEGMENT:g} s. Dotted: "
            f"{', '.join(f'{n}P' for n in MULTIPLES)} of the mean rotor speed",
            traces,
            "frequency [Hz]",
            f"density [({unit})²/Hz]",
            "xy",
        )
    _multiples(page, found)
    if found.spectra.by_speed is not None:
        page.add(_campbell(found.spectra.by_speed, found.spectra.load))


def _multiple_lines(hertz: float, last: float, within: tuple[float, float]) -> list[Any]:
    """Dotted lines at multiples of the rotor's frequency, up to the last one that is shown."""
    return [
        trace(
            f"{n}P",
            [n * hertz] * 2,
            list(within),
            line={"dash": "dot", "width": 1, "color": "#9aa5b1"},
            showlegend=False,
            mode="lines+text",
            text=["", f"{n}P"],
            textposition="top center",
            hovertext=f"{n}P at {n * hertz:.3g} Hz",
        )
        for n in MULTIPLES
        if n * hertz <= last
    ]


def _multiples(page: Page, found: LoadTotals) -> None:
    amplitudes = found.spectra.multiples
    if amplitudes is None:
        page.text(
            "No file has a rotor speed, so that multiples of it have no names: give "
            f"{argument('LoadOptions.rotor_speed_rpm')}, or the channel, as in "
            "`ChannelMap(channels={'rotor speed': 'RotSpeed'})`."
        )
        return
    page.table(
        f"Amplitude at multiples of each file's mean rotor speed, median of files: of the sine "
        f"with the power within {100 * NEAR:g} % of the frequency, turbulence there included",
        [
            {"channel": f"{name} [{shown_unit(unit)}]", **multiple_columns(row / 1e3)}
            for name, unit, row in zip(LOADS, UNITS, amplitudes, strict=False)
            if name in found.loads
        ],
    )


def _campbell(found: Campbell, load: str) -> Chart:
    unit = shown_unit(UNIT_OF[load])
    lines, density = found.frequency, found.density / 1e6
    speed = 0.5 * (found.speed[1:] + found.speed[:-1])
    kept = (lines > 0.0) & (lines <= min(HIGHEST, 4.0))
    chart = heat_map(
        f"Campbell diagram of {load}: spectra of segments of {SEGMENT:g} s by their mean rotor "
        f"speed; dotted {', '.join(f'{n}P' for n in MULTIPLES)}",
        speed,
        lines[kept],
        np.log10(density[:, kept].T),
        ("rotor speed [rad/s]", "frequency [Hz]", f"log10 of ({unit})²/Hz"),
        height=560,
        yaxis={"range": [0.0, float(lines[kept][-1])]},
    )
    chart.figure["data"] += [
        trace(
            f"{n}P",
            speed,
            n * speed / (2.0 * np.pi),
            line={"dash": "dot", "color": "white"},
            showlegend=False,
            mode="lines+text",
            text=[*[""] * (len(speed) - 1), f"{n}P"],
            textposition="top left",
            textfont={"color": "white"},
        )
        for n in MULTIPLES
    ]
    return chart


def _loops(page: Page, result: LoadsResult) -> None:
    page.section("Load loops")
    page.table("Loops of force and of moment at the hub, across the shaft", result.tables["loops"])
    page.text(
        f"A loop is a part of the path that closes within {LONGEST:g} s, leads away from where it "
        f"closes by {100 * SHARE:g} % of the mean magnitude or more, and has an area of "
        f"{ROUNDNESS:g} times that distance squared or more; the definition is this program's own."
    )
