"""Section of the page of ``loads``: what the files mean over a lifetime at a site."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.commands.loads_digest import LOADS, UNITS, Options
from fe_drivetrain.commands.loads_together import Together
from fe_drivetrain.histories.sites import Site, lifetime_damage, midpoint_edges, time_factors
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record

CYCLES = 1e7
"""Of the equivalent load of a lifetime."""

_BIN = 1.0  # m/s: files whose mean winds are nearer stand for one wind


def lifetime(page: Page, found: Together, options: Options, site: Site) -> dict[str, list[Record]]:
    """Add the section; hours and damage of each wind, as tables for files.

    Parameters
    ----------
    page : Page
        Takes the tables.
    found : Together
        All files.
    options : Options
        How they were counted.
    site : Site
        Whose winds are weighted.
    """
    page.section("Lifetime at a site")
    wind = np.array([row["mean wind speed [m/s]"] or np.nan for row in found.files], dtype=float)
    bins = _BIN * np.round(wind / _BIN)
    speeds = np.unique(bins[~np.isnan(bins)])
    if len(speeds) < 2:
        page.text(
            "A lifetime needs files of two mean wind speeds or more, with the wind speed in them."
        )
        return {}
    hours = site.hours(midpoint_edges(speeds))
    seconds = np.array([row["step [s]"] * row["samples"] for row in found.files])
    damages = np.array(found.damages)
    at_wind = np.array([damages[bins == speed].sum(axis=0) for speed in speeds])
    lasting = np.array([seconds[bins == speed].sum() for speed in speeds])
    factors = time_factors(hours, lasting)
    rows: list[Record] = []
    most: list[Record] = []
    for c, (name, unit) in enumerate(zip(LOADS, UNITS, strict=False)):
        row: Record = {"channel": f"{name} [{'kN' if unit == 'N' else 'kN m'}]"}
        for k, slope in enumerate(options.slopes):
            total = lifetime_damage(at_wind[:, c, k], factors)
            row[f"m = {slope:g}"] = (total / CYCLES) ** (1.0 / slope) / 1e3
            if name in ("radial force", "bending moment") and total:
                worst = at_wind[:, c, k] * factors / total
                place = int(np.argmax(worst))
                most.append(
                    {
                        "channel": name,
                        "slope": slope,
                        "wind of most damage [m/s]": float(speeds[place]),
                        "its share [%]": 100.0 * float(worst[place]),
                    }
                )
        rows.append(row)
    page.table(
        f"Range of {CYCLES:.0e} cycles that do the damage of {site.years:g} years at a mean wind "
        f"of {site.mean_wind:g} m/s (Weibull, k = {site.shape:g}); starts and stops are not among "
        "these files",
        rows,
    )
    page.table("Where the damage comes from", most)
    page.text(
        f"The files stand for {hours.sum():,.0f} h, {100 * hours.sum() / (8760 * site.years):.3g} "
        "% of the time; each mean wind speed reaches halfway to the next."
    )
    page.data("lifetime", rows)
    return {
        "site": [
            {
                "mean wind speed [m/s]": float(speed),
                "hours": float(hour),
                "files last [s]": float(last),
                "time factor": float(factor),
            }
            for speed, hour, last, factor in zip(speeds, hours, lasting, factors, strict=True)
        ]
    }
