"""Bearings by a catalogue's page: whether published insides lie within the bands."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from fe_drivetrain.bearing import (
    Bearing,
    CataloguePage,
    Entry,
    FittedRollers,
    RollerRow,
    changed_entry,
    equilibrium,
    fitted_entry,
    fitted_rollers,
    pressures,
    roller_loads,
)
from fe_drivetrain.bearing_life.life import ball_life, lamina_life, rows_of
from fe_drivetrain.cases import case
from fe_drivetrain.cases.bearing.published_insides import (
    PUBLISHED,
    RACEWAYS,
    UNUSUAL,
    UNUSUAL_FILL,
    Published,
    raceway_pages,
)
from fe_drivetrain.common import Floats, InputError, timed_runs
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite import Page, Record, Run

QUANTITIES = ("L10r [Mrev]", "radial stiffness [MN/mm]", "max pressure [MPa]")
CROWNS = {"single_row_tapered": 4.5e-4, "cylindrical": 3.5e-4}
MEMBERS = 64
SHARE = 0.1  # radial load over C
COVERED = "published insides whose life, stiffness and pressure are within the band"
GEOMETRY = "published numbers, diameters, lengths and pitch circles within the ensemble"
HERO = "Published insides over the middle of their bands, and the bands"
ERROR = "width of the band over that of 256 insides, error [%]"
SECONDS = "processor time [s]"


@dataclass(frozen=True)
class Banded:
    """A quantity of a bearing by its published inside, and over the insides that fit its page."""

    bearing: str
    quantity: str
    true: float
    low: float
    high: float

    @property
    def within(self) -> bool:
        """Whether the published inside is in the band."""
        return self.low <= self.true <= self.high


@case(
    "Bearings by a catalogue's page: coverage of published insides",
    source="MASTA; raceways that SKF prints; insides of bearings in public data sets of faults",
)
def run(run: Run, page: Page) -> None:
    """Fit insides to pages, and hold published ones against them."""
    count = 32 if run.quick else MEMBERS
    with run.step("insides"):
        fits = [fitted_rollers(one.page, count) for one in PUBLISHED]
    with run.step("bands"):
        banded = [row for one, fit in zip(PUBLISHED, fits, strict=True) for row in bands(one, fit)]
        alone = half_width(member_answers(fits[0], 1.0)[:, 0])
    with run.step("raceways"):
        printed = raceways(page, count)
    coverage(page, banded, geometry(PUBLISHED, fits))
    with run.step("members"):
        members(page, PUBLISHED[0], run.quick)
    not_counted(page)
    answer(page, banded, printed, alone)


def half_width(values: Floats) -> float:
    """Half of the distance of the ends over their middle."""
    low, high = float(values.min()), float(values.max())
    return (high - low) / (high + low)


def answer(page: Page, banded: Sequence[Banded], printed: int, alone: float) -> None:
    """State how many published insides the band holds."""
    held = sum(one.within for one in banded)
    widths = {
        quantity: max(
            half_width(np.array([one.low, one.high])) for one in banded if one.quantity == quantity
        )
        for quantity in QUANTITIES
    }
    life = widths[QUANTITIES[0]]
    page.answer(
        "How well do life and stiffness of a bearing follow from its catalogue page alone?",
        f"The catalogue page alone gives the reference life L10r within ±{percent_text(life)} and "
        f"the stiffness within ±{percent_text(widths[QUANTITIES[1]])}; {held} of {len(banded)} "
        "published values lie in these bands.",
        [
            page.judged(COVERED, "published values within their bands"),
            page.value("largest uncertainty ± of L10r [%]", 100.0 * life),
            page.value("uncertainty ± of L10r, roller profile known [%]", 100.0 * alone),
            page.value("largest uncertainty ± of stiffness [%]", 100.0 * widths[QUANTITIES[1]]),
            page.value("largest uncertainty ± of pressure [%]", 100.0 * widths[QUANTITIES[2]]),
            page.value(
                "printed raceway diameters within the bands", printed, at_least=2 * len(RACEWAYS)
            ),
        ],
        hero=HERO,
        cautions=[
            "The length of the rollers is published for one bearing only; for the others it "
            "follows from C0 by ISO 76, as it does for the assumed samples.",
            "The ranges of the assumed dimensions were chosen with these bearings known: values of "
            "other bearings may lie outside of the bands more often.",
            "No catalogue page prints the profile of the rollers, assumed here as half to twice "
            "that of the standard: this causes most of the uncertainty of L10r.",
        ],
    )


def true_bearing(one: Published) -> Bearing:
    """A bearing with its published inside, and the profile of the standard."""
    taken = fitted_entry(one.page)
    changes: dict[str, float | int] = {
        "elements": one.elements,
        "element_diameter": one.diameter,
        "pitch_diameter": one.pitch,
    }
    if one.length:
        changes["element_length"] = one.length
    if one.angle:
        changes["contact_angle"] = one.angle
    return profiled(changed_entry(taken, one.name, **changes), 1.0).bearing(one.name)


def profiled(entry: Entry, factor: float) -> Entry:
    """Rollers with so many times the standard's profile."""
    crown = CROWNS.get(entry.kind, 0.0)
    return changed_entry(entry, entry.title, crown=factor * crown) if crown else entry


def answers(bearing: Bearing, page: CataloguePage) -> Floats:
    """(3,) `QUANTITIES` of a bearing under a radial load of a tenth of C.

    Bearings that carry axial load in one direction alone have as much of it as presses half of
    their rollers, F_r tan(alpha) 1.26, in their pressure centre.
    """
    radial = SHARE * page.C
    load = np.array([0.0, 0.0, -radial, 0.0, 0.0])
    if page.of_kind == "single_row_tapered":
        assert page.angle is not None
        load[0] = 1.26 * np.tan(np.radians(page.angle)) * radial
        row = bearing.rows[0]  # with its pressure centre where the load is
        bearing = Bearing(
            bearing.name, (replace(row, place=row.radius * float(np.tan(row.angle))),)
        )
    found = equilibrium(bearing, load)
    assert found.converged.all()
    if isinstance(bearing.rows[0], RollerRow):
        life = float(lamina_life(rows_of(bearing, found.displacements, page.C))[0])
    else:
        loads = roller_loads(bearing, found.displacements)
        life = float(ball_life(bearing.rows[0], loads, page.C)[0])
    pressed = max(
        float(np.max(p)) for pair in pressures(bearing, found.displacements) for p in pair
    )
    stiffness = radial / float(np.hypot(*found.displacements[0, 1:3]))
    return np.array([life, 1e-9 * stiffness, 1e-6 * pressed])


def member_answers(fit: FittedRollers, profile: float | None = None) -> Floats:
    """(insides, 3) `QUANTITIES` of all insides, each with its profile or all with one."""
    found = []
    for k in range(len(fit)):
        crown = float(fit.crown[k]) if profile is None else profile
        entry = profiled(fitted_entry(fit.page, k, fit), crown)
        found.append(answers(entry.bearing(fit.page.designation), fit.page))
    return np.array(found)


def bands(one: Published, fit: FittedRollers) -> list[Banded]:
    """What follows from the published inside, and the ends of what follows from all."""
    true, found = answers(true_bearing(one), one.page), member_answers(fit)
    return [
        Banded(
            one.name, quantity, float(true[i]), float(found[:, i].min()), float(found[:, i].max())
        )
        for i, quantity in enumerate(QUANTITIES)
    ]


def geometry(published: Sequence[Published], fits: Sequence[FittedRollers]) -> list[Record]:
    """Published insides beside the ends of the ensemble."""
    rows: list[Record] = []
    for one, fit in zip(published, fits, strict=True):
        for name, true in one.fields.items():
            values = getattr(fit, name)
            scale = 1.0 if name == "elements" else 1e3
            low, high = scale * float(values.min()), scale * float(values.max())
            rows.append(
                {
                    "bearing": one.name,
                    "of the inside": name if name == "elements" else f"{name} [mm]",
                    "published": scale * true,
                    "least": low,
                    "middle": scale * float(values[fit.middle]),
                    "largest": high,
                    "within": low <= scale * true <= high,
                    "source": one.source,
                }
            )
    return rows


def raceways(page: Page, count: int) -> int:
    """Hold raceways that a catalogue prints against insides that were fitted without them."""
    rows: list[Record] = []
    for of, diameter, pitch in raceway_pages():
        fit = fitted_rollers(of, count)
        for name, true in (("diameter", diameter), ("pitch", pitch)):
            values = getattr(fit, name)
            page.between(
                f"{of.designation}: {name} by both raceways [mm]",
                1e3 * true,
                1e3 * float(values.min()),
                1e3 * float(values.max()),
                why="the ensemble has to hold what the catalogue prints of the inside",
                source=of.source,
            )
            rows.append(
                {
                    "bearing": of.designation,
                    "of the inside": f"{name} [mm]",
                    "by both raceways": 1e3 * true,
                    "least": 1e3 * float(values.min()),
                    "middle": 1e3 * float(values[fit.middle]),
                    "largest": 1e3 * float(values.max()),
                }
            )
    page.section("Cylindrical bearings whose raceways are printed")
    page.table("Rollers by both raceways, and insides that were fitted without these", rows)
    return sum(row["least"] <= row["by both raceways"] <= row["largest"] for row in rows)


def coverage(page: Page, banded: Sequence[Banded], inside: Sequence[Record]) -> None:
    """Count published values that lie within their bands, and show all of them."""
    page.at_least(
        COVERED,
        float(sum(one.within for one in banded)),
        0.9 * len(banded),
        why="a band is to hold what it is of; a tenth may be beyond its ends",
        source="insides of the table",
    )
    page.at_least(
        GEOMETRY,
        float(sum(bool(row["within"]) for row in inside)),
        0.9 * len(inside),
        why="as above",
        source="insides of the table",
    )
    rows: list[Record] = [
        {
            "bearing": one.bearing,
            "quantity": one.quantity,
            "published inside": one.true,
            "least": one.low,
            "largest": one.high,
            "over the middle": one.true / (0.5 * (one.low + one.high)),
            "half width": (one.high - one.low) / (one.high + one.low),
            "within": one.within,
        }
        for one in banded
    ]
    page.section("Coverage")
    groups = {
        quantity: {
            f"bearing {row['bearing']}": float(row["over the middle"])
            for row in rows
            if row["quantity"] == quantity
        }
        for quantity in QUANTITIES
    }
    chart = bars(HERO, groups, "over the middle of the band [-]", least=0.5)
    for trace, quantity in zip(chart.figure["data"], groups, strict=True):
        widths = [row["half width"] for row in rows if row["quantity"] == quantity]
        trace["error_x"] = {"type": "data", "array": widths, "thickness": 1.2}
    page.add(chart)
    page.table("Under a radial load of C / 10, by the published inside and over all that fit", rows)
    page.table("Published insides, and the ends of all that fit the page", list(inside))


def members(page: Page, one: Published, quick: bool) -> None:
    """Error of the band, and time, over the number of insides."""
    counts = (4, 8, 16, 32) if quick else (4, 8, 16, 32, 64, 128, 256)
    whole = member_answers(fitted_rollers(one.page, counts[-1]))
    full = whole.max(axis=0) - whole.min(axis=0)
    rows: list[Record] = []
    for count in counts:
        found, times = timed_runs(
            partial(refitted, one.page, count), 2 if quick else 5, time.process_time
        )
        width = found.max(axis=0) - found.min(axis=0)
        rows.append(
            {
                "insides": count,
                ERROR: 100.0 * float(np.max(1.0 - width / full)),
                SECONDS: times.least,
            }
        )
    page.section("How many insides are enough")
    page.sweep(
        "Error of the band over processor time, by the number of insides",
        rows[:-1],
        SECONDS,
        ERROR,
        log="xy",
        points=True,
        chosen=counts.index(32) if counts[-1] > 32 else 2,
    )


def refitted(page: CataloguePage, count: int) -> Floats:
    """`member_answers` of insides that are fitted again."""
    fitted_rollers.cache_clear()
    return member_answers(fitted_rollers(page, count))


def not_counted(page: Page) -> None:
    """Say what was left out, and why."""
    page.section("Not counted")
    try:
        fit = fitted_rollers(CataloguePage.read(UNUSUAL, "N305"))
        words = f"{int(fit.elements.min())} to {int(fit.elements.max())} rollers fit its ratings"
    except InputError as error:
        words = str(error)
    page.text(
        "The roller bearing named N305 in minzhun/ISO16281's tests has six rollers, which would "
        f"fill {percent_text(UNUSUAL_FILL)} of its pitch circle: {words}. Its number is that of a "
        "test, not of a bearing. The rollers of bearing S and of the 750 kW gearbox here are "
        "assumed, and are no evidence."
    )
