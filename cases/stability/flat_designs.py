"""Searches whose answer means little: flat masses, limits that hardly act, limits nearly equal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.least_shafts import bending_stiffness, least_bored_shaft
from fe_drivetrain.common import Floats
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import decades
from fe_drivetrain.comparison.constrained_minimum import (
    ACTIVE,
    Functions,
    constrained_minimum,
    distinct_minima,
    multiplier_ranges,
    slopes,
    starting_points,
)
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.studies.design_minima import FAR, KEPT, MARGIN, flat_minima, open_prices

OUTER = np.array([0.6, 0.5, 0.4])
LENGTHS = np.array([0.5, 0.9, 0.8])
LOW, HIGH = np.array([0.02, 0.02, 0.02]), np.array([0.47, 0.37, 0.37])
MODULUS, DENSITY = 2.1e11, 7850.0
OFF = 0.01
"""Share of a range by which a bore that is found may be off and still be of use."""

LENGTH, PLACE = "length of the section [m]", "error of its bore over the range"
WEIGHT, MASS, TOLD = "share of the mass", "error of the mass", "told that it is flat"
FLAT = "Error of the bore of an ever shorter section; shaded: below 1 % of the range"
BY, PRICE = "limit from where the ranges end, relative", "error of the price"
IDLE = "Price of a limit where ranges end just beyond or before it; shaded: below 1 %"
APART, SHARE = "limits apart, relative", "share of the price that the idle limit takes"
TOGETHER = "Prices of two limits that pull the same way"


@dataclass(frozen=True)
class Lightest:
    """A search for the lightest shaft, by the beam that level 1 is.

    Attributes
    ----------
    functions : callable
        As the program's search has them, limits kept by the margin.
    size : float
        Mass that values are relative to [kg].
    """

    functions: Functions
    size: float


def mass_of(lengths: Floats, bores: Floats) -> float:
    """Mass of the shaft [kg]."""
    return float(DENSITY * np.pi / 4.0 * np.sum(lengths * (OUTER**2 - bores**2)))


def lightest(lengths: Floats, limits: Sequence[float]) -> Lightest:
    """The search with limits of the stiffness against bending [N m/rad]."""
    size = mass_of(lengths, LOW)

    def functions(at: Floats) -> Floats:
        bores = LOW + at * (HIGH - LOW)
        stiffness = bending_stiffness(lengths, OUTER, bores, MODULUS)
        broken = [float(np.log(limit / stiffness)) + MARGIN for limit in limits]
        return np.array([mass_of(lengths, bores) / size, *broken])

    return Lightest(functions, size)


@case(
    "Designs that a search cannot tell apart: flat, idle and degenerate limits",
    source="closed form of a bored stepped shaft, Lagrange's condition",
)
def run(run: Run, page: Page) -> None:
    """Three sweeps towards where the least design is not one."""
    with run.step("a section that vanishes"):
        shortest = vanishing_section(page, 1.0 if run.quick else 3.0)
    with run.step("a limit that hardly acts"):
        idle = idle_limit(page, 1.0 if run.quick else 4.0)
    with run.step("two limits nearly equal"):
        # no point is as far as limits that count as met, where round-off decides
        apart = limits_together(page, 1.0 if run.quick else 3.0)
    share = rounded([shortest], 1)[0]
    page.answer(
        "When does a search for the lightest design leave its values open?",
        "The lightest mass is right, but the bore of a section with under "
        f"{formatted(100 * share, unit='%')}\u00a0% of the mass is arbitrary, like sensitivities "
        "to coinciding limits.",
        [
            page.value("smallest share of the mass for which the bore is found [%]", 100 * share),
            page.value(
                "relative distance from where a limit starts to act, for its sensitivity", idle
            ),
            page.value(
                "relative distance of two limits, for separate sensitivities",
                rounded([apart], 1)[0],
            ),
        ],
        hero=FLAT,
        cautions=[
            "The program warns of arbitrary values only if it searches from several starting "
            "points.",
            f"Limits are kept with a margin of {100 * MARGIN:g} %: one that is met by less than "
            "that shows a sensitivity although it does not act.",
        ],
    )


def shortened(length: float) -> Record:
    """The search with a last section of a length, against Lagrange's condition."""
    lengths = np.array([LENGTHS[0], LENGTHS[1], length])
    limit = bending_stiffness(lengths, OUTER, np.full(3, 0.2), MODULUS)
    exact = least_bored_shaft(list(lengths), list(OUTER), limit * (1.0 + MARGIN), MODULUS, DENSITY)
    of = lightest(lengths, [limit])
    found = [
        constrained_minimum(of.functions, start) for start in starting_points(np.full(3, 0.2), 4)
    ]
    kept = distinct_minima(found, KEPT, FAR)
    place = (exact.bores - LOW) / (HIGH - LOW)
    return {
        LENGTH: length,
        WEIGHT: mass_of(lengths * [0.0, 0.0, 1.0], exact.bores) / exact.mass,
        PLACE: max(abs(float(one.at[2] - place[2])) for one in found),
        MASS: max(abs(float(one.values[0]) * of.size / exact.mass - 1.0) for one in found),
        TOLD: "yes" if flat_minima(kept[0], kept[1:]) else "no",
    }


def vanishing_section(page: Page, each: float) -> float:
    """Search with an ever shorter section; the least share of mass whose bore is found."""
    rows = [shortened(float(length)) for length in decades(-9, -0.1, each)[::-1]]
    page.vanishes(
        "largest error of the least mass, however flat",
        max(float(row[MASS]) for row in rows),
        within=1e-6,
        why="where the search stops; an error of the place counts with its square",
        source="Lagrange's condition",
    )
    page.equals(
        "bores off by more than 1 % of their range that no caution names",
        float(sum(float(row[PLACE]) > OFF and row[TOLD] == "no" for row in rows)),
        0.0,
        within=0.0,
        why="counted: starts that end apart at one mass are told",
        source="Lagrange's condition",
    )
    good = [row for row in rows if float(row[PLACE]) <= OFF]
    least = min(float(row[WEIGHT]) for row in good)
    page.limit(
        "search for a design, what shall be least nearly flat",
        "share of what shall be least that a value has",
        low=least,
        criterion="each value within 1 % of its range of the least design's",
        beyond="the search stops where it happens to be; the least value itself is right",
        program="says that it is flat, and by how much values may differ",
        remedy="fix the value by other reasons, or leave it out",
    )
    page.section("Flat")
    shortest = min(float(row[LENGTH]) for row in good)
    page.sweep(FLAT, rows, LENGTH, PLACE, log="xy", safe=(shortest, None))
    page.table("Least designs with an ever shorter section", rows)
    return least


def capped_price(limit: float) -> float:
    """Relative growth of the least mass with the limit, bores within their ranges.

    Bores follow Lagrange's condition d / (D^4 - d^4) = c, up to the ends of their ranges.
    """
    if limit <= bending_stiffness(LENGTHS, OUTER, HIGH, MODULUS):
        return 0.0

    def bores(c: float) -> Floats:
        free = [brentq(lambda d, e=e: d - c * (e**4 - d**4), 0.0, e) for e in OUTER]
        return np.asarray(np.minimum(free, HIGH))

    def lack(log_c: float) -> float:
        return bending_stiffness(LENGTHS, OUTER, bores(np.exp(log_c)), MODULUS) / limit - 1.0

    c = float(np.exp(brentq(lack, np.log(1e-3), np.log(1e3), xtol=1e-14)))
    price = DENSITY * np.pi**2 * MODULUS / (512.0 * c**2 * limit**2)
    return price * limit / mass_of(LENGTHS, bores(c))


def idle_limit(page: Page, each: float) -> float:
    """A limit that is met just before and just behind the ends of ranges."""
    most = bending_stiffness(LENGTHS, OUTER, HIGH, MODULUS)
    full = capped_price(most * (1.0 + 1e-9))
    rows: list[Record] = []
    for by in decades(-8, -1, each):
        for way, word in ((-1.0, "the limit is idle by"), (1.0, "the limit acts by")):
            limit = most * (1.0 + way * float(by))
            of = lightest(LENGTHS, [limit])
            found = constrained_minimum(of.functions, np.full(3, 0.5))
            price = float(found.multipliers[0] / found.values[0])
            exact = capped_price(limit)
            rows.append({"": word, BY: float(by), PRICE: max(abs(price - exact) / full, 1e-9)})
    bad = [float(row[BY]) for row in rows if float(row[PRICE]) > OFF]
    far = [float(row[PRICE]) for row in rows if float(row[BY]) > 2.0 * (MARGIN + ACTIVE)]
    page.at_most(
        "error of the price of a limit that is farther than the margin from the ends of ranges",
        max(far),
        1e-3,
        why="gradients by differences, and the margin",
        source="Lagrange's condition with bores at the ends of their ranges",
    )
    page.limit(
        "price of a limit",
        "distance of the limit from where the ranges end, relative",
        low=max(bad),
        criterion="price within 1 %",
        beyond="the limit is idle, but within the margin that it is kept by",
        program="states the price as if it acted",
        remedy="tighten or relax the limit by more than the margin",
    )
    page.section("Limits that hardly act")
    page.sweep(IDLE, rows, BY, PRICE, by="", log="xy", safe=(max(bad), None))
    return max(bad)


def limits_together(page: Page, each: float) -> float:
    """Two limits that any design keeps or breaks together, one tighter by ever less."""
    stiffness = bending_stiffness(LENGTHS, OUTER, np.full(3, 0.2), MODULUS)
    rows: list[Record] = []
    for by in decades(-8.5, -1.5, each):
        of = lightest(LENGTHS, [stiffness, stiffness * (1.0 - float(by))])
        found = constrained_minimum(of.functions, np.full(3, 0.5))
        ranges = multiplier_ranges(slopes(of.functions, found.at), found, [0, 1], 2)
        rows.append(
            {
                APART: float(by),
                SHARE: float(found.multipliers[1] / found.multipliers.sum()),
                "sum of both over the exact price, less 1": float(
                    found.multipliers.sum() / _exact_multiplier(stiffness, of.size) - 1.0
                ),
                "told that they are open": "yes" if open_prices(ranges).any() else "no",
            }
        )
    told = [float(row[APART]) for row in rows if row["told that they are open"] == "yes"]
    page.vanishes(
        "largest error of the price of both together",
        max(abs(float(row["sum of both over the exact price, less 1"])) for row in rows),
        within=1e-3,
        why="gradients by differences",
        source="Lagrange's condition",
    )
    page.holds(
        "prices that are open are told, and only these",
        all((float(row[APART]) < ACTIVE) == (float(row[APART]) in told) for row in rows),
        why="limits that are nearer than what counts as met are both met",
        source="two limits that are the same function",
    )
    page.limit(
        "prices of limits that pull the same way",
        "distance of the limits, relative",
        low=max(told),
        criterion="each limit has a price of its own",
        beyond="both are met, and only what they cost together is known",
        program="names the limits, and says that their prices are open",
        remedy="leave out the one that follows from the other",
    )
    page.section("Limits nearly equal")
    page.table(TOGETHER, rows)
    return max(told)


def _exact_multiplier(stiffness: float, size: float) -> float:
    """Growth of the least mass over `size` with the logarithm of the stiffness."""
    kept = stiffness * (1.0 + MARGIN)
    exact = least_bored_shaft(list(LENGTHS), list(OUTER), kept, MODULUS, DENSITY)
    return exact.price * kept / size
