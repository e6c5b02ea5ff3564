"""Sections of the page of ``life`` about one bearing: winds, places of its rollers, laminae."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.bearing_life.life.roller_damage import KINDS
from fe_drivetrain.pages.life_charts import along_rollers, damage_map, load_zone, zones_by_wind
from fe_drivetrain.report.charts import bars
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.life_sums import BearingLife
from fe_drivetrain.studies.life_tables import has_rollers, site_maps, wind_rows
from fe_drivetrain.studies.rolling_bearings import rollers_in_words, row_names


def winds(page: Page, life: BearingLife) -> None:
    """Life and share of damage by wind; nothing where no site weights them.

    Parameters
    ----------
    page : Page
        Takes them.
    life : BearingLife
        The bearing.
    """
    rows, name = wind_rows(life), life.name
    if life.site is None:
        return
    if not all(np.isfinite(row["L10r [years]"]) for row in rows):
        page.table(
            f"{name}: life at each wind, and its share of the damage", rows, list(rows[0])[1:]
        )
        return
    page.sweep(
        f"{name}: life if each wind blew for ever",
        rows,
        "wind [m/s]",
        {f"{kind} [years]": kind for kind in KINDS},
        log="y",
        table=list(rows[0])[1:7],
        axis="life [years]",
    )
    page.add(
        bars(
            f"{name}: share of each wind in the damage at the site",
            {
                kind: {
                    f"{row['wind [m/s]']:g} m/s": row[f"share of {kind}'s damage [%]"]
                    for row in rows
                }
                for kind in ("L10r", "L10mr")
            },
            "share of the damage [%]",
        )
    )
    covered = 100.0 * life.site.covered
    page.text(
        f"The winds of these files stand for {covered:.3g} % of the time at the site; the rest "
        "does no damage here."
        + (
            " Few winds stand for wide bins: give more for a life to be trusted."
            if len(rows) < 6
            else ""
        )
    )


def places(page: Page, life: BearingLife, rings: Sequence[Record]) -> None:
    """Load zone, rows and rings, and maps of damage over places.

    Parameters
    ----------
    page : Page
        Takes them.
    life : BearingLife
        The bearing.
    rings : sequence of dict
        Share of each row and ring in the damage, and its life if it were alone.
    """
    seen, planet = life.bearing.seen, bool(life.bearing.planets)
    page.add(load_zone(life.name, life.rows, life.mean_load, life.peak_load, seen))
    if len(life.by_wind) > 1:
        for kind in ("mean", "largest"):
            page.add(zones_by_wind(life.name, life.rows, life.by_wind, kind, seen))
    page.table(f"{life.name}: rows and rings", rings, list(rings[0])[1:])
    what = "damage by L10r at the site over wind and place of rollers"
    maps = [
        damage_map(
            f"{life.name}, {one.row_name}: {what}",
            one.speeds,
            "wind [m/s]",
            one.row,
            one.values,
            planet,
        )
        for one in site_maps(life)
    ]
    for r, (row, word) in enumerate(zip(life.rows, row_names(len(life.rows)), strict=True)):
        if maps:
            page.add(maps[r])
        worst = life.worst
        caption = f"{life.name}, {word}: damage by L10r over time in {worst.file.name}"
        page.add(damage_map(caption, worst.times, "time [s]", row, worst.values[:, r], planet))
    page.text(
        "Both rings together. On the ring that stands damage is where it is shown; on the one that "
        "turns every point takes its share of all of it, and the map says where the load comes "
        "from. Shares are of the row's own damage."
    )


def laminae(page: Page, life: BearingLife) -> None:
    """Pressure along rollers; nothing of balls.

    Parameters
    ----------
    page : Page
        Takes it.
    life : BearingLife
        The bearing.
    """
    if not has_rollers(life):
        return
    page.add(along_rollers(life.name, life.rows, life.pressures))
    page.text(
        f"Ends of rollers: {rollers_in_words(life.bearing, 'none').split(',')[0]}; the pressure is "
        "that of each lamina by itself, without the stress riser."
    )
