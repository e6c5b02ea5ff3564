"""Sections of the page of ``life`` about one bearing: winds, places of its rollers, laminae."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fe_drivetrain.bearing.geometry import angles
from fe_drivetrain.commands.life_bearings import OneBearing, rollers_in_words
from fe_drivetrain.commands.life_charts import along_rollers, damage_map, load_zone, row_names
from fe_drivetrain.commands.life_digest import LifeDigest, worse
from fe_drivetrain.life.at_site import SiteLife
from fe_drivetrain.life.limits import Limits
from fe_drivetrain.life.reference_life import RINGS
from fe_drivetrain.life.roller_damage import KINDS, Damage
from fe_drivetrain.report.charts import bars
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record


@dataclass(frozen=True, eq=False)
class BearingLife:
    """What a bearing's section shows.

    Attributes
    ----------
    one : OneBearing
        The bearing.
    digests : list of LifeDigest
        Of each file.
    damage : Damage
        Of all files, or of a year at the site.
    site : SiteLife or None
        Where a site is asked for.
    """

    one: OneBearing
    digests: list[LifeDigest]
    damage: Damage
    site: SiteLife | None

    @property
    def years(self) -> Mapping[str, float]:
        """By each kind of life."""
        return self.damage.lives("years") if self.site is None else self.site.years

    @property
    def limits(self) -> Limits:
        """Limits of the methods in the files as they are, not weighted by a site."""
        total = self.digests[0].damage
        for found in self.digests[1:]:
            total = total + found.damage
        return total.limits


def winds(page: Page, life: BearingLife) -> list[Record]:
    """Life and share of damage by wind; nothing where no site weights them.

    Parameters
    ----------
    page : Page
        Takes them.
    life : BearingLife
        The bearing.

    Returns
    -------
    rows : list of dict
        For a file.
    """
    name = life.one.name
    if life.site is None:
        return []
    shares = {kind: life.site.of_winds(kind) for kind in KINDS}
    rows: list[Record] = []
    for i, (wind, share, damage) in enumerate(
        zip(life.site.speeds, life.site.shares, life.site.at_winds, strict=True)
    ):
        row: Record = {"bearing": name, "wind [m/s]": float(wind)}
        row["share of time [%]"] = 100.0 * float(share)
        row |= {f"{kind} [years]": v for kind, v in damage.lives("years").items()}
        row |= {f"share of {kind}'s damage [%]": 100.0 * float(shares[kind][i]) for kind in KINDS}
        rows.append(row)
    if not all(np.isfinite(row["L10r [years]"]) for row in rows):
        page.table(
            f"{name}: life at each wind, and its share of the damage", rows, list(rows[0])[1:]
        )
        return rows
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
    return rows


def places(page: Page, life: BearingLife, files: Sequence[Path]) -> list[Record]:
    """Load zone, rows and rings, and maps of damage over places.

    Parameters
    ----------
    page : Page
        Takes them.
    life : BearingLife
        The bearing.
    files : sequence of Path
        The histories, for their names.

    Returns
    -------
    rows : list of dict
        For a file.
    """
    one, name = life.one, life.one.name
    rows_of_bearing, words = one.rated.bearing.rows, row_names(len(one.rated.bearing.rows))
    seconds = np.array([found.damage.seconds for found in life.digests])
    mean = np.tensordot(seconds / seconds.sum(), [d.mean_load for d in life.digests], axes=1)
    peak = np.max([d.peak_load for d in life.digests], axis=0)
    page.add(load_zone(name, rows_of_bearing, mean, peak))
    page.data(f"{name}: load zone [N]", {"mean": mean, "largest": peak})
    both = [life.damage.of_rows(modified) for modified in (False, True)]
    parts: list[Record] = []
    for r, word in enumerate(words):
        for ring, race in enumerate(RINGS):
            row: Record = {"row": word, "ring": race}
            for kind, values, alone in zip(("L10r", "L10mr"), both, life.damage.alone, strict=True):
                whole = values.sum()
                row[f"share of {kind}'s damage [%]"] = (
                    100.0 * float(values[r, ring] / whole) if whole else 0.0
                )
                used = alone[r, ring]
                time = life.damage.seconds / 3600.0 / 8760.0
                row[f"{kind} of this ring alone [years]"] = time / float(used) if used else np.inf
            parts.append(row)
    page.table(f"{name}: rows and rings", parts)
    page.data(f"{name}: rows and rings", parts)
    _maps(page, life, files)
    table: list[Record] = []
    for r, word in enumerate(words):
        basic, modified = (life.damage.of_positions(r, m) for m in (False, True))
        at = np.degrees(angles(rows_of_bearing[r])) % 360.0
        for j in range(basic.shape[1]):
            table.append(
                {
                    "bearing": name,
                    "row": word,
                    "place [deg]": float(at[j]),
                    "mean load [kN]": 1e-3 * float(mean[r, j]),
                    "largest load [kN]": 1e-3 * float(peak[r, j]),
                    **{
                        f"{ring} ring, damage by {kind}": float(values[i, j])
                        for kind, values in (("L10r", basic), ("L10mr", modified))
                        for i, ring in enumerate(RINGS)
                    },
                }
            )
    return table


def _maps(page: Page, life: BearingLife, files: Sequence[Path]) -> None:
    name, rows = life.one.name, life.one.rated.bearing.rows
    totals = [found.damage.totals["L10r"] / found.damage.seconds for found in life.digests]
    worst = int(np.argmax(totals))
    for r, (row, word) in enumerate(zip(rows, row_names(len(rows)), strict=True)):
        if life.site is not None:
            speeds, shares = life.site.speeds, life.site.shares
            values = np.stack(
                [
                    one.of_positions(r).sum(axis=0) * share / one.seconds
                    for one, share in zip(life.site.at_winds, shares, strict=True)
                ]
            )
            caption = f"{name}, {word}: damage by L10r at the site over wind and place of rollers"
            page.add(damage_map(caption, speeds, "wind [m/s]", row, values))
            page.data(caption, {"wind [m/s]": speeds, "damage [1/s]": values})
        one = life.digests[worst]
        caption = f"{name}, {word}: damage by L10r over time in {files[worst].name}"
        page.add(damage_map(caption, one.times, "time [s]", row, one.over_time[:, r]))
    page.text(
        "Both rings together. On the ring that stands damage is where it is shown; on the one that "
        "turns every point takes its share of all of it, and the map says where the load comes "
        "from. Shares are of the row's own damage."
    )


def laminae(page: Page, life: BearingLife) -> list[Record]:
    """Pressure along rollers, and damage of laminae.

    Parameters
    ----------
    page : Page
        Takes them.
    life : BearingLife
        The bearing.

    Returns
    -------
    rows : list of dict
        For a file.
    """
    one, rows = life.one, life.one.rated.bearing.rows
    worst = life.digests[0].worst
    for found in life.digests[1:]:
        worst = worse(worst, found.worst)
    chart = along_rollers(one.name, rows, worst)
    if chart is None:
        return []
    page.add(chart)
    page.data(f"{one.name}: pressure along rollers [Pa]", worst)
    page.text(
        f"Ends of rollers: {rollers_in_words(one, 'none').split(',')[0]}; the pressure is that of "
        "each lamina by itself, without the stress riser."
    )
    table: list[Record] = []
    for r, word in enumerate(row_names(len(rows))):
        for modified, kind in ((False, "L10r"), (True, "L10mr")):
            values = life.damage.of_laminae(r, modified)
            for k in range(values.shape[1]):
                table.append(
                    {
                        "bearing": one.name,
                        "row": word,
                        "kind": kind,
                        "lamina": k + 1,
                        **{
                            f"{ring} ring, damage": float(values[i, k])
                            for i, ring in enumerate(RINGS)
                        },
                    }
                )
    return table
