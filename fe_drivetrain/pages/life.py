"""The page of ``life``: lives of a scene's bearings, what takes them, and where methods end."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.bearing_life.life.roller_damage import KINDS
from fe_drivetrain.common.arguments import argument
from fe_drivetrain.pages.life_bearings import laminae, places, winds
from fe_drivetrain.pages.life_charts import load_zone
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.bearing_lives import LifeResult
from fe_drivetrain.studies.life_answer import hardest_loaded
from fe_drivetrain.studies.life_sums import BearingLife
from fe_drivetrain.studies.life_tables import ring_rows

#: Columns of the table of limits that are about static safety; the others are shares of the time.
_OF_SAFETY = 7


def show_life(run: Run, page: Page, result: LifeResult) -> None:
    """Show lives, what takes them, and where methods end.

    Parameters
    ----------
    run : Run
        Not used: the page has no pictures.
    page : Page
        Takes tables and charts.
    result : LifeResult
        What was found.
    """
    _lives(page, result)
    _events(page, result)
    _limits(page, result)
    _levels(page, result)
    _clearances(page, result)
    _assumed(page, result)
    for life in result.lives:
        each = f", of each of {life.bearing.planets} planets" if life.bearing.planets else ""
        page.section(f"Bearing {life.name}{each}: {life.bearing.entry.title}")
        winds(page, life)
        places(page, life, ring_rows(life))
        laminae(page, life)
    _hero(page, result)


def _hero(page: Page, result: LifeResult) -> None:
    """Show the load of the rollers first where lives are none to be drawn, or none to be used."""
    lives = result.lives
    weakest = hardest_loaded(lives)
    ends = any(np.isfinite(list(life.years.values())).any() for life in lives)
    if weakest.limits.static_safety < 1.0 or not ends:
        page.hero(
            load_zone(
                weakest.name,
                weakest.rows,
                weakest.mean_load,
                weakest.peak_load,
                weakest.bearing.seen,
            ).caption
        )


def _lives(page: Page, result: LifeResult) -> None:
    page.section("Lives")
    rows: list[Record] = result.tables["lives"]
    page.table("Ratings, and the constant load that has the same life", rows, list(rows[0])[:8])
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
    if any(np.isfinite(list(life.years.values())).any() for life in result.lives):
        page.add(result.chart())
    _seats(page, result.lives)
    _insides(page, result)


def _insides(page: Page, result: LifeResult) -> None:
    """Bands over the insides of bearings that are given by their catalogue's page."""
    if "insides" not in result.tables:
        return
    page.section("Bearings by their catalogue's page")
    page.table("Insides that fit the page", result.tables["insides"])
    page.text(
        "L10 and L10m follow from the page alone. Number, diameter, length, angle and profile of "
        "the rolling elements are not printed: geometries that fit C, C0, e and Y in the space "
        "between d, D and B stand for the one that is inside, and the columns have the least and "
        "the largest of all. Stiffness is radial, on rigid rings, at the load that does most "
        "damage. C over that printed says how the maker's rating differs from the standard's."
    )


def _events(page: Page, result: LifeResult) -> None:
    """Lives with events beside the histories."""
    if not result.events:
        return
    page.section("With events")
    page.table("Lives with events, and their damage of a year", result.tables["events"])
    page.text(
        "Each event is one of `transient`, from rated torque, with flexible shafts and default "
        "values: its forces bring rollers into equilibrium, and its damage is added as often as it "
        "comes. The page of `transient` shows it in time."
    )


def _seats(page: Page, lives: Sequence[BearingLife]) -> None:
    seats: list[Record] = [
        {
            "bearing": life.name,
            "entry": life.bearing.entry_name,
            "bore [mm]": None if life.bearing.entry.bore is None else 1e3 * life.bearing.entry.bore,
            "inside of its rolling elements [mm]": 1e3 * life.bearing.entry.inside,
            "shaft at its seat [mm]": None
            if life.bearing.seat is None
            else 1e3 * life.bearing.seat,
        }
        for life in lives
    ]
    page.table("Bearings on their seats", seats)
    sources: list[Record] = [
        {"bearing": life.name, "rating": name, "source": text}
        for life in lives
        for name, text in zip(("C", "C0", "Cu"), life.bearing.rated.sources, strict=True)
    ]
    page.table("Where ratings come from", sources)


def _limits(page: Page, result: LifeResult) -> None:
    page.section("Static safety, and limits of the methods")
    rows: list[Record] = result.tables["limits"]
    first, last = list(rows[0])[:_OF_SAFETY], list(rows[0])[_OF_SAFETY:]
    page.table("Static safety", rows, first)
    page.table(
        "Time beyond the limits of the methods, in the files as they are", rows, ["bearing", *last]
    )
    page.text(
        "S0 is the lesser of C0 / P0 of ISO 76, whose P0 knows no moment, and of that of the "
        "rollers: the load at which the most loaded contact has the pressure that C0 stands for "
        "(4,000 MPa on rollers, 4,200 MPa on balls), over what it carries, by the pressure squared "
        "in line contact and cubed in point contact. Above C/2 the load is beyond the range of ISO "
        "281: P, or the radial load that has the life of the rollers, C / L10r^(1/4), of balls "
        "C / L10r^(1/3), in which moments are. Below kappa = 0.1 a_ISO is "
        "its smallest value, 0.1; above 4 it stays that of 4. Below "
        f"{result.rules.standing_rpm:g} 1/min a bearing stands: marks of standstill and of "
        "oscillation are no fatigue of rolling contact, and no life is computed for them."
    )


def _levels(page: Page, result: LifeResult) -> None:
    """The load of each bearing by each level of the drivetrain's statics."""
    rows = result.tables.get("levels")
    if not rows:
        return
    page.section("Loads of gearbox bearings, level by level")
    page.table("Constant load that has the same L10, by the model of the drivetrain", rows)
    page.text(
        "Hub loads and weight become loads of bearings by linear statics, at rigid bodies with "
        "beams between them, and with shafts that bend between their bearings. A planet's bearing "
        "is loaded in the frame of its pin, and has the mean damage of the azimuths of its "
        "carrier. A cheaper level is enough where its load differs by 5 % at most, a life by 16 %."
    )


def _clearances(page: Page, result: LifeResult) -> None:
    """The clearance of each bearing, what makes it, and what it does to L10mr."""
    page.section("Clearance, and what it does to L10mr")
    page.table("Clearance as it is taken, and others", result.tables["clearances"])
    page.text(
        "Negative is a preload. The other lives are by a sample of a hundredth of the load steps "
        "of each file. Least and most are with all tolerances of a stated `mounting` at the limits "
        "that make it so; 'another' is a size to compare with."
    )
    if parts := result.tables.get("clearance_parts"):
        page.table("From initial to operating clearance, radial, of the diameter", parts)
        page.text(
            "Rings and seats are thick cylinders, raceways at the middle of the rolling elements, "
            "and each part has one temperature; each contribution is with those before it already "
            "there, so that columns add up. Deflection under load is not in it: the rollers' "
            "equilibrium has it."
        )


def _assumed(page: Page, result: LifeResult) -> None:
    """A table of what was not stated, and of what it does."""
    rows = result.tables.get("assumed")
    if not rows:
        return
    page.section("What was not stated, and what it does to L10mr")
    page.table("Other values of what is assumed, one at a time", rows)
    page.text(
        "By a sample of a hundredth of the load steps of each file, drawn by the damage that they "
        "do. The clearance is 1/4000 of the pitch diameter, rounded, along the contact normal, "
        "and the preload a tenth of it: a size to compare with, of no table. Give the clearance of "
        "the mounted bearing in its catalogue entry, and the others by their options. How rings, "
        "housing and the shaft's support give way is not varied here: see "
        f"{argument('LifeOptions.rings')} and {argument('LifeOptions.support')}."
    )
