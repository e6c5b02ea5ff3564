"""Section of the page of ``loads``: what the files mean over a lifetime at a site."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fe_drivetrain.commands.loads_digest import LOADS, UNITS, Digest, Options, classes_of
from fe_drivetrain.commands.loads_together import Together
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.histories.classes import Classes, added
from fe_drivetrain.histories.sites import (
    HOURS_A_YEAR,
    Site,
    Transient,
    lifetime_damage,
    midpoint_edges,
    rounded_wind,
    time_factors,
)
from fe_drivetrain.report.charts import trace
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record

CYCLES = 1e7
"""Number of cycles of the equivalent load of a lifetime."""


@dataclass(frozen=True)
class Event:
    """Starts or stops of a lifetime.

    Attributes
    ----------
    a_year : float
        How many a year.
    digests : sequence of Digest
        Of histories of one event each; every one stands for as many.
    files : sequence of Path
        Where they are from.
    """

    a_year: float
    digests: Sequence[Digest]
    files: Sequence[Path]

    @property
    def name(self) -> str:
        """Name of the first of its files, and how many more there are."""
        first = self.files[0].stem
        return first if len(self.files) == 1 else f"{first} and {len(self.files) - 1} more"

    @property
    def transient(self) -> Transient:
        """What it is, with the mean duration of its histories."""
        seconds = [float(d["time"][2] * d["time"][3]) for d in self.digests]
        return Transient(self.name, self.a_year, float(np.mean(seconds)))

    def damage(self) -> Floats:
        """(loads, slopes) of one event."""
        return np.asarray(np.mean([d["damage"] for d in self.digests], axis=0))


def mean_winds(found: Together) -> list[float]:
    """Mean wind speed of each file [m/s]; NaN where it has none."""
    winds = [row["mean wind speed [m/s]"] for row in found.files]
    return [np.nan if wind is None else float(wind) for wind in winds]


def lifetime(
    page: Page, found: Together, options: Options, site: Site, events: Sequence[Event] = ()
) -> dict[str, list[Record]]:
    """Add the section; hours and damage of each wind, as tables for files.

    Parameters
    ----------
    page : Page
        Takes the tables.
    found : Together
        All files, of two winds or more: see `require_winds`.
    options : Options
        How they were counted.
    site : Site
        Whose winds are weighted.
    events : sequence of Event
        Transients of the lifetime.
    """
    page.section("Lifetime at a site")
    bins = np.array([rounded_wind(speed) for speed in mean_winds(found)])
    speeds = np.unique(bins)
    edges = midpoint_edges(speeds)
    hours = site.hours(edges)
    seconds = np.array([row["step [s]"] * row["samples"] for row in found.files])
    damages = np.array(found.damages)
    at_wind = np.array([damages[bins == speed].sum(axis=0) for speed in speeds])
    lasting = np.array([seconds[bins == speed].sum() for speed in speeds])
    factors = time_factors(hours, lasting)
    sources = [*(f"{speed:g} m/s" for speed in speeds), *(event.name for event in events)]
    rows: list[Record] = []
    shares: list[Record] = []
    for c, (name, unit) in enumerate(zip(LOADS, UNITS, strict=False)):
        row: Record = {"channel": f"{name} [{'kN' if unit == 'N' else 'kN m'}]"}
        for k, slope in enumerate(options.slopes):
            of_events = [(e.transient, float(e.damage()[c, k])) for e in events]
            total = lifetime_damage(at_wind[:, c, k], factors, of_events, site.years)
            row[f"m = {slope:g}"] = (total / CYCLES) ** (1.0 / slope) / 1e3
            parts = [
                *(at_wind[:, c, k] * factors),
                *(e.a_year * site.years * d for e, d in of_events),
            ]
            if total:
                shares += [
                    {"channel": name, "slope": slope, "from": source, "share of damage [%]": share}
                    for source, share in zip(
                        sources, (100.0 * np.array(parts) / total).tolist(), strict=True
                    )
                ]
        rows.append(row)
    winds = f"{edges[0]:g} to {edges[-1]:g} m/s"
    page.table(
        f"Range of {CYCLES:.0e} cycles that do the damage of {site.years:g} years at a mean wind "
        f"of {site.mean_wind:g} m/s (Weibull, k = {site.shape:g}), {winds}"
        + ("" if events else "; starts and stops are not among these files (--transient)"),
        rows,
    )
    _most(page, shares)
    covered = 100.0 * hours.sum() / (HOURS_A_YEAR * site.years)
    page.text(
        f"The files stand for {hours.sum():,.0f} h, {winds}: {covered:.3g} % of the time; each "
        "mean wind speed reaches halfway to the next."
    )
    page.data("lifetime", rows)
    tables: dict[str, list[Record]] = {
        "site": [
            {
                "mean wind speed [m/s]": float(speed),
                "hours": float(hour),
                "files last [s]": float(last),
                "time factor": float(factor),
            }
            for speed, hour, last, factor in zip(speeds, hours, lasting, factors, strict=True)
        ],
        "lifetime_damage": shares,
    }
    if events:
        tables["transients"] = _transients(page, events, site.years)
    tables["lifetime_levels"] = _levels(
        page, found, site, dict(zip(speeds, factors, strict=True)), events
    )
    return tables


def _most(page: Page, shares: Sequence[Record]) -> None:
    """What does most damage."""
    rows: list[Record] = []
    for name in ("Mx", "radial force", "bending moment"):
        for slope in dict.fromkeys(row["slope"] for row in shares):
            own = [r for r in shares if r["channel"] == name and r["slope"] == slope]
            if own:
                rows.append(max(own, key=lambda r: float(r["share of damage [%]"])))
    page.table("Where most of the damage comes from; all of it is in lifetime_damage.csv", rows)


def _transients(page: Page, events: Sequence[Event], years: float) -> list[Record]:
    rows: list[Record] = [
        {
            "event": event.name,
            "a year": event.a_year,
            "lasts [s]": event.transient.seconds,
            "in the lifetime [h]": event.transient.hours(years),
        }
        for event in events
    ]
    page.table("Transients", rows)
    return rows


def _levels(
    page: Page,
    found: Together,
    site: Site,
    factors: dict[float, float],
    events: Sequence[Event],
) -> list[Record]:
    """Time and turns of the lifetime at each level of each load; the torque's is shown."""
    rows: list[Record] = []
    for kind, word, unit, size in (("seconds", "time", "h", 3600.0), ("turns", "turns", "-", 1.0)):
        for name, load in zip(LOADS, UNITS, strict=False):
            own = f"{word} at {name}"
            parts = [
                _scaled(found.at_wind[speed, own], factor / size)
                for speed, factor in factors.items()
                if (speed, own) in found.at_wind
            ]
            for event in events:
                each = event.a_year * site.years / len(event.digests) / size
                parts += [
                    _scaled(classes_of(d, own), each)
                    for d in event.digests
                    if f"{own}: amount" in d
                ]
            if not parts:
                continue
            total = added(parts)
            limits = total.edges()
            rows += [
                {
                    "channel": name,
                    "unit": load,
                    "of": f"{kind.replace('seconds', 'hours')} [{unit}]",
                    "from": float(limits[k]),
                    "to": float(limits[k + 1]),
                    "amount": float(total.amount[k]),
                }
                for k in np.flatnonzero(total.amount > 0.0).tolist()
            ]
            if name == "Mx":
                page.chart(
                    f"{word.capitalize()} of the lifetime at a torque or above it"
                    + (", transients included" if events else ""),
                    [trace(word, limits[:-1] / 1e3, total.at_least)],
                    "torque Mx [kN m]",
                    "time [h]" if word == "time" else "turns of the rotor",
                    "y",
                )
    return rows


def _scaled(classes: Classes, factor: float) -> Classes:
    return replace(classes, amount=factor * classes.amount)
