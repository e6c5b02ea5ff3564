"""The page of ``life``: lives of a scene's bearings, what takes them, and where methods end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import islice
from pathlib import Path

import numpy as np

from fe_drivetrain.commands.life_assumed import in_words, what_ifs
from fe_drivetrain.commands.life_bearings import Choices, OneBearing, rollers_in_words
from fe_drivetrain.commands.life_charts import row_names
from fe_drivetrain.commands.life_digest import (
    LifeDigest,
    Reading,
    kept_digest,
)
from fe_drivetrain.commands.life_limits import limits, overloaded
from fe_drivetrain.commands.life_sections import BearingLife, laminae, places, winds
from fe_drivetrain.commands.loads_tables import write_tables
from fe_drivetrain.common.jobs import mapped
from fe_drivetrain.histories.sites import Site, require_winds, rounded_wind
from fe_drivetrain.hub_loads.turbines import different_turbines
from fe_drivetrain.life.at_site import site_lives
from fe_drivetrain.life.reference_life import RINGS, reference_load
from fe_drivetrain.life.roller_damage import KINDS, LifeRules
from fe_drivetrain.procedure.failure_modes import TORQUE_AND_BENDING
from fe_drivetrain.report.answer import value_with_band
from fe_drivetrain.response.stated import HUB_LOADS
from fe_drivetrain.scene.scene import Scene
from fe_drivetrain.studies.unused import choices_not_used, speed_not_used
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record
from fe_drivetrain.suite.run import Run

_MANY = 8  # files, each of every bearing, for which it pays to start processes

UNVERIFIED = (
    "No constant here was read in ISO 281, ISO 76 or ISO/TS 16281. Those of capacities, reference "
    "lives, a_ISO, nu_1, and of X, Y and e of rollers agree with public code, reference lives of a "
    "ball bearing with MASTA; those of contamination are from memory, with two numbers of MASTA "
    "beside them."
)


def lived(
    run: Run,
    page: Page,
    scene: Scene,
    bearings: Sequence[OneBearing],
    files: Sequence[Path],
    rules: LifeRules,
    reading: Reading,
    site: Site | None,
    choices: Choices,
    resume: bool,
) -> None:
    """Compute damage file by file, and show the lives that follow.

    Parameters
    ----------
    run : Run
        Its folder takes the tables.
    page : Page
        Takes tables and charts.
    scene : Scene
        The shaft.
    bearings : sequence of OneBearing
        Whose lives they are.
    files : sequence of Path
        Histories of hub loads.
    rules : LifeRules
        Choices that change lives.
    reading : Reading
        How files are read.
    site : Site or None
        Whose winds are weighted.
    choices : Choices
        Of the model.
    resume : bool
        Take what an earlier run has done.

    Raises
    ------
    InputError
        A file cannot be read, or a site is asked for and files have no wind speed.
    """
    page.seed = None
    page.about(scene)
    found: list[BearingLife] = []
    with run.step("load steps"):
        items = [
            (file, one, rules, reading, scene, choices, resume)
            for one in bearings
            for file in files
        ]
        made = mapped(kept_digest, items, len(items) if len(items) >= _MANY else 1, run.report)
        for one in bearings:
            found.append(_of_bearing(one, list(islice(made, len(files))), files, site))
    _answer(page, found, rules, site)
    for one in bearings:
        if one.misfit is not None:
            page.note(one.misfit)
    of_first = zip(files, found[0].digests, strict=True)
    if unlike := different_turbines({file.stem: d.vertical for file, d in of_first}):
        page.note(unlike)
    if unused := speed_not_used(reading.rotor_speed, [d.own_speeds for d in found[0].digests]):
        page.note(unused)
    for unused in choices_not_used(scene, choices, bearings):
        page.note(unused)
    page.note(UNVERIFIED)
    _lives(page, found)
    limits(page, found, rules)
    _assumed(page, found, rules, choices, files, site)
    tables: dict[str, list[Record]] = {
        "lives": _life_rows(found),
        "files": _file_rows(found, files),
    }
    tables |= {"winds": [], "places": [], "laminae": []}
    for life in found:
        page.section(f"Bearing {life.one.name}: {life.one.entry.title}")
        tables["winds"] += winds(page, life)
        tables["places"] += places(page, life, files)
        tables["laminae"] += laminae(page, life)
    _assumptions(page, found, rules, reading, choices, files)
    _checks(page, found)
    facts = {
        "frame": f"{HUB_LOADS.frame}; places of rollers: 0 right, 90 deg on top",
        "units": "as in the heads of columns",
        "lives": "with 90 % reliability but for a_1 of modified ones",
    }
    write_tables(run.folder, tables, dict.fromkeys(tables, facts))
    page.section("Tables")
    names = ", ".join(f"{name}.csv" for name, rows in tables.items() if rows)
    page.text(f"Beside this page: {names}, and results.json with the numbers of all charts.")


def _of_bearing(
    one: OneBearing, digests: list[LifeDigest], files: Sequence[Path], site: Site | None
) -> BearingLife:
    if site is None:
        whole = digests[0].damage
        for found in digests[1:]:
            whole = whole + found.damage
        return BearingLife(one, digests, whole, None)
    require_winds(files, [found.wind for found in digests])
    life = site_lives([(rounded_wind(found.wind), found.damage) for found in digests], site)
    return BearingLife(one, digests, life.a_year, life)


def _years(value: float) -> str:
    if np.isinf(value):
        return "without end"
    return f"{value:,.0f} years" if value >= 1000.0 else f"{value:.3g} years"


def _answer(page: Page, found: Sequence[BearingLife], rules: LifeRules, site: Site | None) -> None:
    for life in found:
        at = "if these files followed each other for ever"
        if site is not None and life.site is not None:
            at = (
                f"at a mean wind of {site.mean_wind:g} m/s, where the winds of these files blow "
                f"{100 * life.site.covered:.3g} % of the time and the rest is taken to do no damage"
            )
        years, parts = life.years, life.damage.of_rows(rules.lubricant is not None)
        row, ring = np.unravel_index(int(np.argmax(parts)), parts.shape)
        whole = parts.sum()
        words = f"Bearing {life.one.name} lives {_years(years['L10mr'])} {at} (L10mr"
        band = _scatter(life)
        if np.isfinite(years["L10mr"]):
            which = f"L10mr of bearing {life.one.name} [years]"
            page.found(which, years["L10mr"], band, (TORQUE_AND_BENDING,))
        if band is not None:
            shown = value_with_band(page.answers[-1])
            words = f"Bearing {life.one.name} lives {shown} {at} (L10mr, ± two standard errors of "
            words += "files of the same wind"
        words += f"; L10r {_years(years['L10r'])}, L10 {_years(years['L10'])})"
        if whole:
            words += (
                f"; the {RINGS[ring]} ring of the {row_names(len(parts))[row]} takes "
                f"{100 * parts[row, ring] / whole:.0f} % of the damage"
            )
        if life.site is not None:
            shares = life.site.of_winds("L10mr")
            most = life.site.speeds[np.argmax(shares)]
            words += f", winds about {most:g} m/s {100 * shares.max():.0f} %"
            if whole:
                always = _years(years["L10mr"] * life.site.covered)
                words += f"; if these winds blew all the time it would live {always}"
        page.answer(words + overloaded(life) + ".")


def _scatter(life: BearingLife) -> float | None:
    """Two standard errors of L10mr over files of a wind [years]; None where one stands alone.

    Each wind's mean rate of damage has the standard error s / sqrt(n) of its n files; those of all
    winds, weighted by their time at the site, add up as squares.
    """
    site = life.site
    if site is None:
        return None
    rates: dict[float, list[float]] = {}
    for one in life.digests:
        rate = one.damage.totals["L10mr"] / one.damage.seconds
        rates.setdefault(rounded_wind(one.wind), []).append(rate)
    if min(map(len, rates.values())) < 2:
        return None
    each = [rates[float(speed)] for speed in site.speeds]
    mean = float(site.shares @ [np.mean(one) for one in each])
    errors = site.shares * [np.std(one, ddof=1) / np.sqrt(len(one)) for one in each]
    return 2.0 * float(np.linalg.norm(errors)) / mean * site.years["L10mr"] if mean else None


def _assumed(
    page: Page,
    found: Sequence[BearingLife],
    rules: LifeRules,
    choices: Choices,
    files: Sequence[Path],
    site: Site | None,
) -> None:
    """A caution for each bearing, and a table, of what was not stated and what it does."""
    rows: list[Record] = []
    for life in found:
        years, changed = life.years["L10mr"], []
        for i, one in enumerate(what_ifs(life.one, rules, choices)):
            digests = [_with_ratio(d, float(d.ratios[i])) for d in life.digests]
            other = _of_bearing(life.one, digests, files, site).years["L10mr"]
            if np.isfinite(years):
                changed.append((one, _years(float(f"{other:.2g}")), other / years))
            rows.append(
                {
                    "bearing": life.one.name,
                    "not stated, and taken": one.assumed,
                    "instead": one.instead,
                    "L10mr then [years]": other,
                    "over that here [-]": other / years if np.isfinite(years) else None,
                }
            )
        if sentence := in_words(life.one.name, _years(years), changed):
            page.note(sentence)
    if not rows:
        return
    page.section("What was not stated, and what it does to L10mr")
    page.table("Other values of what is assumed, one at a time", rows)
    page.data("assumed", rows)
    page.text(
        "By a sample of a hundredth of the load steps of each file, drawn by the damage that they "
        "do. The clearance is 1/4000 of the pitch diameter, rounded, along the contact normal, "
        "and the preload a tenth of it: a size to compare with, of no table. Give the clearance of "
        "the mounted bearing in its catalogue entry, and the others by their options. How rings, "
        "housing and the shaft's support give way is not varied here: see --rings and --support."
    )


def _with_ratio(found: LifeDigest, ratio: float) -> LifeDigest:
    """A digest whose damage by L10mr is so many times its own."""
    damage = found.damage
    return replace(found, damage=replace(damage, of_bearing=damage.of_bearing * [1.0, ratio]))


def _life_rows(found: Sequence[BearingLife]) -> list[Record]:
    rows: list[Record] = []
    for life in found:
        rated, years = life.one.rated, life.years
        million = life.damage.lives("Mrev")
        row: Record = {"bearing": life.one.name, "entry": life.one.entry_name}
        for name, value in zip(("C", "C0", "Cu"), rated.three, strict=True):
            row[f"{name} [kN]"] = value / 1e3
        row["P_ref [kN]"] = 1e-3 * float(
            reference_load(rated.dynamic, million["L10r"], rated.exponent)
        )
        row["P of L10 [kN]"] = 1e-3 * float(
            reference_load(rated.dynamic, million["L10"], rated.exponent)
        )
        row |= {f"{kind} [Mrev]": million[kind] for kind in KINDS}
        row |= {f"{kind} [years]": years[kind] for kind in KINDS}
        rows.append(row)
    return rows


def _file_rows(found: Sequence[BearingLife], files: Sequence[Path]) -> list[Record]:
    rows: list[Record] = []
    for life in found:
        for file, one in zip(files, life.digests, strict=True):
            of = one.damage.limits
            row: Record = {
                "bearing": life.one.name,
                "file": file.name,
                "mean wind [m/s]": one.wind,
                "mean speed [1/min]": one.speed,
                "time [s]": one.damage.seconds,
                "turns": one.damage.turns,
            }
            row |= {f"{kind} [years]": v for kind, v in one.damage.lives("years").items()}
            row |= {
                "largest P [kN]": 1e-3 * of.largest_load,
                "largest P0 [kN]": 1e-3 * of.largest_static,
                "largest roller load [kN]": 1e-3 * of.largest_roller,
                "largest pressure [MPa]": 1e-6 * of.largest_pressure,
                "least S0": of.static_safety,
                "standing [s]": of.standing,
            }
            rows.append(row)
    return rows


def _lives(page: Page, found: Sequence[BearingLife]) -> None:
    page.section("Lives")
    rows = _life_rows(found)
    page.table("Ratings, and the constant load that has the same life", rows, list(rows[0])[:7])
    page.table(
        "Lives in years, standstill of the files with them",
        rows,
        ["bearing", *(f"{kind} [years]" for kind in KINDS)],
    )
    page.table(
        "Lives in million revolutions", rows, ["bearing", *(f"{kind} [Mrev]" for kind in KINDS)]
    )
    page.text(
        "L10 and L10m are those of ISO 281, of radial and axial force alone: a moment, and how the "
        "load is spread over rollers, is not in them. L10r and L10mr are the reference lives of "
        "ISO/TS 16281, from the loads of all laminae; P_ref is the load that has L10r as its L10. "
        "The m stands for lubricant and contamination."
    )
    page.data("lives", rows)
    seats: list[Record] = [
        {
            "bearing": life.one.name,
            "entry": life.one.entry_name,
            "bore [mm]": None if life.one.entry.bore is None else 1e3 * life.one.entry.bore,
            "inside of its rolling elements [mm]": 1e3 * life.one.entry.inside,
            "shaft at its seat [mm]": 1e3 * life.one.seat,
        }
        for life in found
    ]
    page.table("Bearings on their seats", seats)
    sources: list[Record] = [
        {"bearing": life.one.name, "rating": name, "source": text}
        for life in found
        for name, text in zip(("C", "C0", "Cu"), life.one.rated.sources, strict=True)
    ]
    page.table("Where ratings come from", sources)


def _assumptions(
    page: Page,
    found: Sequence[BearingLife],
    rules: LifeRules,
    reading: Reading,
    choices: Choices,
    files: Sequence[Path],
) -> None:
    for life in found:
        one = life.one
        for field in one.entry.assumed:
            if field == "ratings":  # those that are given stand in a table with their source
                continue
            value = getattr(one.entry, field)
            unit = {"elements": "-", "contact_angle": "deg"}.get(field, "m")
            page.assume(
                f"{one.name}: {field.replace('_', ' ')}", value, unit, one.entry.sources[field]
            )
        if "clearance" not in one.entry.model_fields_set:
            page.assume(f"{one.name}: clearance", 0.0, "m", "not stated in its catalogue entry")
        words = rollers_in_words(one, rules.riser)
        page.assume(f"{one.name}: rolling elements", words, "", "--profile and --riser")
    oil = rules.lubricant
    if oil is not None:
        page.assume("temperature", oil.temperature, "degC", "--temperature")
        page.assume("viscosity there", oil.viscosity, "mm2/s", "--lubricant, by ASTM D341")
        page.assume("lubrication", oil.supply, "", "--supply")
        page.assume("cleanliness", oil.cleanliness, "", "--cleanliness")
    page.assume(
        "lambda nu taken out of C", rules.reduction, "-", "0.83 with a stress riser, else 1"
    )
    page.assume("a_1", rules.reliability, "-", "--reliability, as public code has it")
    share = "C_u over the number of rows" if rules.limit_per_row else "the whole C_u"
    page.assume("fatigue limit of a row", share, "", "loads P_ks are those of a row")
    page.assume("ring that turns against the load", rules.turning, "", "--turning")
    words = {
        "rollers": "bearings in equilibrium with the shaft, a beam",
        "pinned": "pinned bearings: no moment on them",
    }.get(choices.support, f"springs with K_R of {choices.support} N m/rad")
    page.assume("shaft", words, "", "--support")
    page.assume("rings", choices.rings, "", "--rings; housings are rigid but for 'housing'")
    page.assume("samples", f"one of {reading.every}", "", f"--every; {len(files)} files")


def _checks(page: Page, found: Sequence[BearingLife]) -> None:
    for life in found:
        for kind, modified in (("L10r", False), ("L10mr", True)):
            parts = sum(
                life.damage.of_positions(r, modified).sum()
                for r in range(len(life.one.rated.bearing.rows))
            )
            whole = float(life.damage.totals[kind])
            page.vanishes(
                f"{life.one.name}: damage of places by {kind}, less that of all, as a share",
                float(parts / whole - 1.0) if whole else 0.0,
                within=1e-9,
                why="each place takes its part: rounding of the sums",
                source="lives of the steps, by Miner's rule",
                basis="self-consistency",
            )
        page.vanishes(
            f"{life.one.name}: time without equilibrium [s]",
            life.limits.lost,
            within=0.0,
            why="steps without equilibrium do no damage, and the life would be too long",
            source="residual of 1e-8 of each step's load",
        )
