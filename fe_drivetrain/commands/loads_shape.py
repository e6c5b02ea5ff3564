"""Sections of the page of ``loads``: planes of force and moment, spectra, load loops."""

from __future__ import annotations

from typing import Any

import numpy as np

from fe_drivetrain.commands.loads_digest import (
    CHANNELS,
    HIGHEST,
    LOADS,
    SECTORS,
    SPEED_STEP,
    UNITS,
)
from fe_drivetrain.commands.loads_together import Together
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.histories.spectra import MULTIPLES, NEAR, SEGMENT, WINDOW
from fe_drivetrain.hub_loads.loops import LONGEST, ROUNDNESS, SHARE
from fe_drivetrain.report.charts import heat_map, rounded, trace
from fe_drivetrain.report.results import Chart
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record

_SEEN = {
    "force": "it points from the origin ({}); right is 0 deg, up is 90 deg",
    "moment": "its axis points from the origin ({}); right, 0 deg, is an overhung weight, "
    "left, 180 deg, a rotor that the wind overturns",
}


def shape(page: Page, found: Together) -> dict[str, list[Record]]:
    """Add the sections; the tables that go to files, by name."""
    _planes(page, found)
    return {**_spectra(page, found), **_loops(page, found)}


def _planes(page: Page, found: Together) -> None:
    page.section("Direction of force and moment")
    for name, unit in (("force", "kN"), ("moment", "kN m")):
        plane = found.classes[f"plane of {name}"]
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
    for name in found.directions:
        page.add(_rose(name, found.directions[name]))


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


def _spectra(page: Page, found: Together) -> dict[str, list[Record]]:
    page.section("Spectra")
    if not found.spectra:
        page.text(f"No file lasts half of a segment of {SEGMENT:g} s, so there is no spectrum.")
        return {}
    lines = min(found.spectra)  # that all files have
    total = sum(s[:, :lines] for s, _ in found.spectra.values())
    density = np.asarray(total) / sum(seconds for _, seconds in found.spectra.values())
    frequency = np.arange(lines) / SEGMENT
    if len(found.spectra) > 1:
        page.text(
            f"Files are sampled at several rates; spectra end at {frequency[-1]:g} Hz, which the "
            "slowest has."
        )
    hertz = _turning(found)
    for chosen, unit in ((("Fx", "Fy", "Fz"), "kN"), (("Mx", "My", "Mz"), "kN m")):
        traces = [
            trace(name, frequency[1:], density[LOADS.index(name), 1:] / 1e6) for name in chosen
        ]
        if hertz is not None:
            low, high = min(min(t["y"]) for t in traces), max(max(t["y"]) for t in traces)
            traces += [
                trace(
                    f"{n}P",
                    [n * hertz] * 2,
                    [max(low, 1e-9 * high), high],
                    line={"dash": "dot", "width": 1, "color": "#9aa5b1"},
                    showlegend=False,
                    mode="lines+text",
                    text=["", f"{n}P"],
                    textposition="top center",
                    hovertext=f"{n}P at {n * hertz:.3g} Hz",
                )
                for n in MULTIPLES
                if n * hertz <= frequency[-1]
            ]
        page.chart(
            f"Power spectral density, mean of all files; {WINDOW}, {SEGMENT:g} s. Dotted: "
            f"{', '.join(f'{n}P' for n in MULTIPLES)} of the mean rotor speed",
            traces,
            "frequency [Hz]",
            f"density [({unit})²/Hz]",
            "xy",
        )
    _multiples(page, found)
    _campbell(page, found)
    rows = [
        {
            "frequency [Hz]": float(f),
            **{
                f"{name} [({unit})^2/Hz]": float(density[c, k])
                for c, (name, unit) in enumerate(zip(LOADS, UNITS, strict=False))
            },
        }
        for k, f in enumerate(frequency)
    ]
    return {"spectra": rows}


def _turning(found: Together) -> float | None:
    """Mean frequency of the rotor [Hz]."""
    speed = found.overall()[CHANNELS.index("rotor speed"), 1]
    return None if np.isnan(speed) else abs(float(speed)) / (2.0 * np.pi)


def _multiples(page: Page, found: Together) -> None:
    table = found.median_multiples()
    if table is None:
        page.text(
            "No file has a rotor speed, so that multiples of it have no names: give --rotor-speed "
            "in rpm, or --channel 'rotor speed=NAME'."
        )
        return
    page.table(
        f"Amplitude at multiples of each file's mean rotor speed, median of files: of the sine "
        f"with the power within {100 * NEAR:g} % of the frequency, turbulence there included",
        [
            {
                "channel": f"{name} [{'kN' if unit == 'N' else 'kN m'}]",
                **{
                    f"{n}P": None if np.isnan(v) else v / 1e3
                    for n, v in zip(MULTIPLES, row.tolist(), strict=True)
                },
            }
            for name, unit, row in zip(LOADS, UNITS, table, strict=False)
        ],
    )
    for name, appears, step in found.aliased[:3]:
        lost = [n for n, at in zip(MULTIPLES, appears, strict=True) if at < _speed(found, name) * n]
        shown = ", ".join(
            f"{n}P appears at {at:.3g} Hz"
            for n, at in zip(MULTIPLES, appears, strict=True)
            if n in lost
        )
        page.note(
            f"{name} is sampled every {step:g} s, too slowly for its multiples of rotor speed: "
            f"{shown}. What stands there in its spectra is not there in the load; sample faster."
        )


def _speed(found: Together, name: str) -> float:
    """Mean frequency of the rotor in a file [Hz], less a little for round-off."""
    row = next(row for row in found.files if row["file"] == name)
    return float(row["mean rotor speed [rad/s]"]) / (2.0 * np.pi) * (1.0 - 1e-6)


def _campbell(page: Page, found: Together) -> None:
    if len(found.campbell) < 2:
        return
    places = sorted(found.campbell)
    numbers = np.arange(places[0], places[-1] + 1)
    lines = found.campbell_lines.astype(float)
    density = np.full((len(numbers), len(lines)), np.nan)
    for place, (total, number) in found.campbell.items():
        density[place - places[0]] = total[: len(lines)] / number / 1e6
    speed = SPEED_STEP * (numbers + 0.5)
    kept = (lines > 0.0) & (lines <= min(HIGHEST, 4.0))
    chart = heat_map(
        f"Campbell diagram of My: spectra of segments of {SEGMENT:g} s by their mean rotor speed; "
        f"dotted {', '.join(f'{n}P' for n in MULTIPLES)}",
        speed.astype(np.float64),
        lines[kept],
        np.log10(density[:, kept].T),
        ("rotor speed [rad/s]", "frequency [Hz]", "log10 of (kN m)²/Hz"),
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
    page.add(chart)


def _loops(page: Page, found: Together) -> dict[str, list[Record]]:
    page.section("Load loops")
    rows: list[Record] = []
    every: list[Record] = []
    for name in found.loops:
        number, seconds, whole, over = found.loops[name].tolist()
        parts = found.each_loop[name]
        durations, swept, ranges = np.concatenate([p.reshape(3, -1) for p in parts], axis=1)
        rows.append(
            {
                "plane": name,
                "loops": int(number),
                "share of time [%]": 100.0 * seconds / whole,
                "loops over blade passages (3P)": None if np.isnan(over) else over / whole,
                "median duration [s]": _median(durations),
                "median angle [deg]": _median(swept),
                "largest angle [deg]": float(swept.max()) if number else None,
                "median range [kN, kN\u00a0m]": _median(ranges / 1e3),
                "largest range [kN, kN\u00a0m]": float(ranges.max()) / 1e3 if number else None,
            }
        )
        for file, part in zip(found.names, parts, strict=True):
            for duration, angle, size in part.reshape(3, -1).T.tolist():
                every.append(
                    {
                        "file": file,
                        "plane": name,
                        "duration [s]": duration,
                        "swept angle [deg]": angle,
                        "range of magnitude [N, N m]": size,
                    }
                )
    page.table("Loops of force and of moment at the hub, across the shaft", rows)
    page.text(
        f"A loop is a part of the path that closes within {LONGEST:g} s, leads away from where it "
        f"closes by {100 * SHARE:g} % of the mean magnitude or more, and has an area of "
        f"{ROUNDNESS:g} times that distance squared or more; the definition is this program's own."
    )
    page.data("loops", rows)
    return {"loops": every}


def _median(values: Floats) -> float | None:
    return float(np.median(values)) if len(values) else None
