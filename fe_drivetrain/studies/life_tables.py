"""Tables of lives: by bearing, file, wind, row and ring, place of the rollers, and lamina."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from fe_drivetrain.bearing.geometry import RollerRow, Row, angles
from fe_drivetrain.bearing_life.life.reference_life import RINGS, reference_load
from fe_drivetrain.bearing_life.life.roller_damage import KINDS
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.clearance_tables import clearance_parts
from fe_drivetrain.studies.gearbox_bearings import MachineBearings
from fe_drivetrain.studies.life_sums import BearingLife
from fe_drivetrain.studies.rolling_bearings import row_names
from fe_drivetrain.turbine_loads.histories.sites import HOURS_A_YEAR
from fe_drivetrain.turbine_loads.hub_loads.recorded import short_name

NOT_RATED = "not rated: no catalogue entry"
"""What stands in place of the entry of a bearing that has none."""

ENOUGH = 0.05
"""Difference of the equivalent load up to which a cheaper level is enough: 16 % of a life."""


def life_rows(lives: Sequence[BearingLife]) -> list[Record]:
    """Ratings and lives of each bearing."""
    rows: list[Record] = []
    for life in lives:
        rated, years = life.bearing.rated, life.years
        million = life.million_revolutions
        row: Record = {"bearing": life.name, "entry": life.bearing.entry_name}
        row["mean speed [1/min]"] = life.speed
        for name, value in zip(("C", "C0", "Cu"), rated.three, strict=True):
            row[f"{name} [kN]"] = value / 1e3
        for name, kind in (("P_ref", "L10r"), ("P of L10", "L10")):
            load = reference_load(rated.dynamic, million[kind], rated.exponent)
            row[f"{name} [kN]"] = 1e-3 * float(load)
        row |= {f"{kind} [Mrev]": million[kind] for kind in KINDS}
        row |= {f"{kind} [years]": years[kind] for kind in KINDS}
        rows.append(row)
    return rows


def limit_rows(lives: Sequence[BearingLife]) -> list[Record]:
    """Static safety of each bearing, and time beyond the limits of the methods."""
    rows: list[Record] = []
    for life in lives:
        of, rated = life.limits, life.bearing.rated
        share = 100.0 / sum(one.damage.seconds for one in life.files)
        rows.append(
            {
                "bearing": life.name,
                "min S0": of.static_safety,
                "max pressure [MPa]": 1e-6 * of.max_pressure,
                "max roller load [kN]": 1e-3 * of.max_roller_load,
                "max P0 / C0": of.max_static / rated.static,
                "max P / C": of.max_load / rated.dynamic,
                "max P / C of the rollers": of.max_reference / rated.dynamic,
                "load above C/2 [% of time]": share * of.heavy,
                "S0 below 1 [% of time]": share * of.weak,
                "kappa below 0.1 [% of time]": share * of.thin,
                "kappa above 4 [% of time]": share * of.thick,
                "above the limiting speed [% of time]": share * of.fast,
                "standing [% of time]": share * of.standing,
                "reversals": of.reversals,
            }
        )
    return rows


def assumption_rows(lives: Sequence[BearingLife]) -> list[Record]:
    """What was not stated of each bearing, and L10mr with another value of it."""
    rows: list[Record] = []
    for life in lives:
        years = life.years["L10mr"]
        rows += [
            {
                "bearing": life.name,
                "not stated, and taken": one.assumed,
                "instead": one.instead,
                "L10mr then [years]": one.years,
                "over that here [-]": one.years / years if np.isfinite(years) else None,
            }
            for one in life.assumptions
        ]
    return rows


def inside_rows(lives: Sequence[BearingLife]) -> list[Record]:
    """What follows for bearings by their catalogue's page from the insides that fit it."""
    rows: list[Record] = []
    for life in lives:
        band = life.inside
        if band is None:
            continue
        words = f"of {band.insides} insides"
        of = life.limits.max_pressure
        taken, *ends = band.stiffness
        values: list[tuple[str, float | None, tuple[float, float]]] = [
            *((f"{kind} [years]", life.years[kind], band.years[kind]) for kind in band.years),
            ("max pressure [MPa]", 1e-6 * of, (1e-6 * band.pressure[0], 1e-6 * band.pressure[1])),
            ("radial stiffness [MN/mm]", 1e-9 * taken, (1e-9 * ends[0], 1e-9 * ends[1])),
            ("C of ISO 281 over that printed [-]", None, band.rated),
            ("Cu of ISO 281 over that printed [-]", None, band.limited),
        ]
        rows += [
            {
                "bearing": life.name,
                "quantity": name,
                "inside taken": value,
                f"least {words}": low,
                f"largest {words}": high,
            }
            for name, value, (low, high) in values
            if not np.isnan(low)
        ]
    return rows


def clearance_rows(lives: Sequence[BearingLife]) -> list[Record]:
    """Clearance of each bearing as it is taken and others, with L10mr."""
    rows: list[Record] = []
    for life in lives:
        one = life.bearing
        taken = "mean" if one.clearance is not None else "as taken"
        years = life.years["L10mr"]
        found = [(taken, one.entry.clearance, years)]
        found += [(_which(a.instead), a.clearance or 0.0, a.years) for a in life.clearances]
        for name, value, then in sorted(found, key=lambda row: row[1]):
            rows.append(
                {
                    "bearing": life.name,
                    "clearance": name,
                    "along the contact normal [µm]": 1e6 * value,
                    "radial [µm]": 1e6 * value / one.normal,
                    "L10mr then [years]": then,
                    "over that here [-]": then / years if np.isfinite(years) else None,
                }
            )
    return rows


def _which(name: str) -> str:
    return name if name in ("least", "most", "zero") else "another"


def contribution_rows(lives: Sequence[BearingLife]) -> list[Record]:
    """Contributions to the radial clearance of bearings whose mounting is stated."""
    return [
        row
        for life in lives
        if life.bearing.clearance is not None
        for row in clearance_parts(life.name, life.bearing.clearance)
    ]


def file_rows(lives: Sequence[BearingLife]) -> list[Record]:
    """Lives and limits of each bearing under each file alone."""
    rows: list[Record] = []
    for life in lives:
        files = [one.file for one in life.files]
        for one in life.files:
            of = one.damage.limits
            row: Record = {
                "bearing": life.name,
                "file": short_name(one.file, files),
                "mean wind [m/s]": one.wind,
                "mean speed [1/min]": one.speed,
                "time [s]": one.damage.seconds,
                "turns": one.damage.turns,
            }
            row |= {f"{kind} [years]": v for kind, v in one.damage.lives("years").items()}
            row |= {
                "max P [kN]": 1e-3 * of.max_load,
                "max P0 [kN]": 1e-3 * of.max_static,
                "max roller load [kN]": 1e-3 * of.max_roller_load,
                "max pressure [MPa]": 1e-6 * of.max_pressure,
                "min S0": of.static_safety,
                "standing [s]": of.standing,
            }
            rows.append(row)
    return rows


def wind_rows(life: BearingLife) -> list[Record]:
    """Life and share of damage by wind; none where no site weights them."""
    if life.site is None:
        return []
    shares = {kind: life.site.of_winds(kind) for kind in KINDS}
    rows: list[Record] = []
    for i, (wind, share, damage) in enumerate(
        zip(life.site.speeds, life.site.shares, life.site.at_winds, strict=True)
    ):
        row: Record = {"bearing": life.name, "wind [m/s]": float(wind)}
        row["share of time [%]"] = 100.0 * float(share)
        row |= {f"{kind} [years]": v for kind, v in damage.lives("years").items()}
        row |= {f"share of {kind}'s damage [%]": 100.0 * float(shares[kind][i]) for kind in KINDS}
        rows.append(row)
    return rows


def ring_rows(life: BearingLife) -> list[Record]:
    """Share of each row and ring in the damage, and its life if it were alone."""
    damage = life.damage
    both = [damage.of_rows(modified) for modified in (False, True)]
    rows: list[Record] = []
    for r, word in enumerate(row_names(len(life.rows))):
        for ring, race in enumerate(RINGS):
            row: Record = {"bearing": life.name, "row": word, "ring": race}
            for kind, values, alone in zip(("L10r", "L10mr"), both, damage.alone, strict=True):
                whole = values.sum()
                row[f"share of {kind}'s damage [%]"] = (
                    100.0 * float(values[r, ring] / whole) if whole else 0.0
                )
                used = alone[r, ring]
                time = damage.seconds / 3600.0 / HOURS_A_YEAR
                row[f"{kind} of this ring alone [years]"] = time / float(used) if used else np.inf
            rows.append(row)
    return rows


def place_rows(life: BearingLife) -> list[Record]:
    """Loads and damage of each place of the rolling elements."""
    rows: list[Record] = []
    for r, (row, word) in enumerate(zip(life.rows, row_names(len(life.rows)), strict=True)):
        basic, modified = (life.damage.of_positions(r, m) for m in (False, True))
        at = np.degrees(angles(row)) % 360.0
        rows += [
            {
                "bearing": life.name,
                "row": word,
                "place [deg]": float(at[j]),
                "mean load [kN]": 1e-3 * float(life.mean_load[r, j]),
                "max load [kN]": 1e-3 * float(life.peak_load[r, j]),
                **{
                    f"{ring} ring, damage by {kind}": float(values[i, j])
                    for kind, values in (("L10r", basic), ("L10mr", modified))
                    for i, ring in enumerate(RINGS)
                },
            }
            for j in range(basic.shape[1])
        ]
    return rows


def roller_rows(life: BearingLife) -> list[Record]:
    """Mean and largest load of each place of the rolling elements by wind."""
    rows: list[Record] = []
    for at in life.by_wind:
        for r, (row, word) in enumerate(zip(life.rows, row_names(len(life.rows)), strict=True)):
            places = np.degrees(angles(row)) % 360.0
            rows += [
                {
                    "bearing": life.name,
                    "wind [m/s]": at.wind,
                    "row": word,
                    "element": j + 1,
                    "place [deg]": float(places[j]),
                    "mean load [kN]": 1e-3 * float(at.mean[r, j]),
                    "max load [kN]": 1e-3 * float(at.peak[r, j]),
                }
                for j in range(len(places))
            ]
    return rows


def lamina_rows(life: BearingLife) -> list[Record]:
    """Damage of each lamina of rollers; none of balls."""
    if not has_rollers(life):
        return []
    rows: list[Record] = []
    for r, word in enumerate(row_names(len(life.rows))):
        for modified, kind in ((False, "L10r"), (True, "L10mr")):
            values = life.damage.of_laminae(r, modified)
            rows += [
                {
                    "bearing": life.name,
                    "row": word,
                    "kind": kind,
                    "lamina": k + 1,
                    **{f"{ring} ring, damage": float(values[i, k]) for i, ring in enumerate(RINGS)},
                }
                for k in range(values.shape[1])
            ]
    return rows


def has_rollers(life: BearingLife) -> bool:
    """Whether all rows of the bearing have rollers."""
    return all(isinstance(row, RollerRow) for row in life.rows)


class SiteMap(NamedTuple):
    """Damage of a row over wind and place of its rolling elements at a site.

    Attributes
    ----------
    row_name : str
        What the row is called.
    row : Row
        The row.
    speeds : ndarray, (winds,)
        Winds [m/s].
    values : ndarray, (winds, elements)
        Damage by L10r of both rings over time [1/s].
    """

    row_name: str
    row: Row
    speeds: Floats
    values: Floats


def site_maps(life: BearingLife) -> Iterator[SiteMap]:
    """Damage over wind and place of rolling elements, row by row; none without a site.

    Yields
    ------
    SiteMap
        That of a row.
    """
    if life.site is None:
        return
    for r, (row, word) in enumerate(zip(life.rows, row_names(len(life.rows)), strict=True)):
        values = np.stack(
            [
                one.of_positions(r).sum(axis=0) * share / one.seconds
                for one, share in zip(life.site.at_winds, life.site.shares, strict=True)
            ]
        )
        yield SiteMap(word, row, life.site.speeds, values)


def unrated_rows(lives: Sequence[BearingLife], machine: MachineBearings) -> list[Record]:
    """Bearings without a catalogue entry, with the columns of those that are rated."""
    if not machine.unrated:
        return []
    columns = dict.fromkeys(life_rows(lives[:1])[0])
    of = lives[0]
    rotor = of.speed / of.bearing.path.speed_ratio
    return [
        {
            **columns,
            "bearing": one.name,
            "entry": NOT_RATED,
            "mean speed [1/min]": rotor * one.speed_ratio,
        }
        for one in machine.unrated
    ]


def level_rows(lives: Sequence[BearingLife]) -> list[Record]:
    """Constant load of the same L10 by each level of the drivetrain's statics."""
    rows: list[Record] = []
    for life in lives:
        if not life.levels:
            continue
        of = life.bearing.rated
        load = float(reference_load(of.dynamic, life.million_revolutions["L10"], of.exponent))
        row: Record = {"bearing": life.name}
        row |= {f"P, {name} [kN]": 1e-3 * load * ratio for name, ratio in life.levels.items()}
        cheapest, *_, finest = life.levels.values()
        row["difference [%]"] = 100.0 * (cheapest / finest - 1.0)
        row["enough"] = enough(life)
        rows.append(row)
    return rows


def enough(life: BearingLife) -> str:
    """The cheapest level from which on a bearing's load is that of the finest within `ENOUGH`."""
    names, ratios = list(life.levels), list(life.levels.values())
    found = names[-1]
    for name, ratio in zip(reversed(names), reversed(ratios), strict=True):
        if abs(ratio / ratios[-1] - 1.0) > ENOUGH:
            break
        found = name
    return found


def result_tables(lives: Sequence[BearingLife], machine: MachineBearings) -> dict[str, Any]:
    """Tables of the page, by name."""
    rows = [*life_rows(lives), *unrated_rows(lives, machine)]
    tables: dict[str, Any] = {"lives": rows, "limits": limit_rows(lives)}
    if levels := level_rows(lives):
        tables["levels"] = levels
    if assumed := assumption_rows(lives):
        tables["assumed"] = assumed
    if insides := inside_rows(lives):
        tables["insides"] = insides
    tables["clearances"] = clearance_rows(lives)
    if parts := contribution_rows(lives):
        tables["clearance_parts"] = parts
    tables["load_zones"] = [
        {"bearing": life.name, "mean load [N]": life.mean_load, "max load [N]": life.peak_load}
        for life in lives
    ]
    tables["rings"] = [row for life in lives for row in ring_rows(life)]
    if any(life.site is not None for life in lives):
        tables["winds_and_places"] = [
            {"bearing": life.name, "row": one.row_name, "wind [m/s]": one.speeds}
            | {"damage by L10r [1/s]": one.values}
            for life in lives
            for one in site_maps(life)
        ]
    tables["pressures"] = [
        {"bearing": life.name, "pressure along rollers [Pa]": life.pressures}
        for life in lives
        if has_rollers(life)
    ]
    return tables


def long_tables(lives: Sequence[BearingLife]) -> dict[str, list[Record]]:
    """Tables that are too long for a page, by name."""
    return {
        "files": file_rows(lives),
        "winds": [row for life in lives for row in wind_rows(life)],
        "places": [row for life in lives for row in place_rows(life)],
        "rollers": [row for life in lives for row in roller_rows(life)],
        "laminae": [row for life in lives for row in lamina_rows(life)],
    }
