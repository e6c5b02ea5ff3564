"""The bearing of a planet: its outer ring turns, its inner ring stands under a load that stands."""

import numpy as np

from fe_drivetrain.bearing import Bearing, catalogue_bearing, equilibrium, pressures
from fe_drivetrain.bearing_life.life import (
    LifeRules,
    damage_of_steps,
    rated_bearing,
    rigid_rings,
    steps_of,
)
from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import as_printed
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run, column

#: Diametral clearance [um], largest roller [kN] and pressure [MPa] of a planet bearing at 178 kN.
PLANET = (
    (0.0, "45.4", "1411"),
    (50.0, "51.1", "1496"),
    (100.0, "55.6", "1561"),
    (150.0, "59.1", "1609"),
    (200.0, "62.5", "1655"),
)
#: Load on the inner ring [N, N m].
LOAD = [0.0, 0.0, -178e3, 0.0, 0.0]


def check_pressures(page: Page, clearance: float, peak: str, pressure: str) -> None:
    """Largest roller and pressure of straight rollers against stated ones."""
    straight = catalogue_bearing("planet_nj2232", laminae=0)
    gap = 0.5e-6 * clearance  # along the contact, of a diametral clearance
    found = equilibrium(straight.with_rows(clearance=gap), LOAD)
    largest = pressures(straight.with_rows(clearance=gap, laminae=1), found.displacements)
    for name, own, value in (
        ("largest roller [kN]", found.rollers.max() / 1e3, peak),
        ("pressure on the inner race [MPa]", largest[0][0].max() / 1e6, pressure),
    ):
        page.equals(
            f"planet bearing, 178 kN, clearance {clearance:g} um: {name}",
            float(own),
            **as_printed(value),
            source="an independent computation for the same straight rollers",
            basis="second-hand",
        )


def lives_of(bearing: Bearing, clearance: float) -> Record:
    """Lives with either ring turning, and the inner ring's share of damage."""
    rated, gap = rated_bearing(bearing), 0.5e-6 * clearance
    steps = next(steps_of(rigid_rings(bearing.with_rows(clearance=gap)), LOAD, 30.0, 1.0))
    row: Record = {"clearance [um]": clearance, "L10 [Mrev]": 0.0}
    for turning in ("outer", "inner"):
        damage = damage_of_steps(steps, rated, LifeRules(turning=turning))
        parts = damage.of_rows()[0]
        row["L10 [Mrev]"] = damage.lives("Mrev")["L10"]
        row[f"L10r, {turning} ring turns [Mrev]"] = damage.lives("Mrev")["L10r"]
        row[f"inner ring's share, {turning} ring turns [%]"] = 100 * parts[0] / parts.sum()
    return row


HERO = "Life of the planet bearing over its clearance"


def answer(page: Page, lives: Floats) -> None:
    """State what the standing inner ring and the clearance cost; lives (ring, clearance)."""
    stands, clear = lives[0, 0] / lives[1, 0], lives[0, -1] / lives[0, 0]
    largest = PLANET[-1][0]
    page.answer(
        "How long does a planet bearing last whose outer ring turns, and what does clearance cost?",
        f"The planet bearing lasts {value_text(lives[0, 0], 'Mrev')} without clearance; a "
        f"clearance of {largest:g}\u00a0µm leaves {100 * clear:.0f}\u00a0% of that, and the "
        f"stationary inner ring costs {100 * (1 - stands):.0f}\u00a0%.",
        [
            page.value("life without clearance [Mrev]", lives[0, 0]),
            page.value(f"life with {largest:g} µm of clearance [Mrev]", lives[0, -1]),
            page.value("life if the inner ring turned [Mrev]", lives[1, 0]),
            *(
                page.judged(
                    f"planet bearing, 178 kN, clearance {gap:g} um: {quantity}",
                    f"{name}, {gap:g} µm",
                    "stated",
                    printed,
                )
                for gap, of, pressure in (PLANET[0], PLANET[-1])
                for quantity, name, printed in (
                    ("largest roller", "peak roller load", of),
                    ("pressure on the inner race", "contact pressure", pressure),
                )
                if gap or quantity != "largest roller"
            ),
        ],
        hero=HERO,
        cautions=[
            "Number and size of the rollers are assumed; they fill the outer dimensions of NJ 2232."
        ],
    )


@case(
    "Life of a planet's cylindrical bearing: which ring turns, and what clearance costs",
    source="Al-Hamadani 2018, chapter 7: size and load of a 2 MW planet; rollers are assumed",
)
def run(run: Run, page: Page) -> None:
    """Loads and pressures against stated ones; lives with either ring turning."""
    for clearance, peak, pressure in PLANET:
        check_pressures(page, clearance, peak, pressure)
    profiled = catalogue_bearing("planet_nj2232", crown=0.00035)
    rows = [lives_of(profiled, clearance) for clearance, *_ in PLANET]
    page.table(
        "Cylindrical bearing of the outline NJ 2232 (its rollers are assumed) under 178 kN; "
        "profiled rollers, lives in turns of one ring against the other",
        rows,
    )
    page.data("planet bearing", rows)
    page.text(
        "In a planet the outer ring turns and the load stands on the inner ring: the exponents of "
        "both rings change places (turning='outer'), nothing else does. L10 of ISO 281 knows "
        "neither that nor the clearance."
    )
    lives = [column(rows, f"L10r, {ring} ring turns [Mrev]") for ring in ("outer", "inner")]
    page.holds(
        "the bearing lives shorter where its inner ring stands under the load",
        bool((np.array(lives[0]) < np.array(lives[1])).all()),
        why="the inner race is the more strained one, and its loaded place has all of it",
        source="ISO/TS 16281: exponent 4.5 instead of 4 of the ring that stands",
    )
    page.holds(
        "a larger clearance makes the life shorter",
        bool((np.diff(lives[0]) < 0.0).all()),
        why="fewer rollers carry the same load",
        source="the largest rollers and pressures above",
    )
    answer(page, np.array(lives))
    keys = {f"L10r, {ring} ring turns [Mrev]": f"{ring} ring turns" for ring in ("outer", "inner")}
    page.section("Life over the clearance")
    page.sweep(HERO, rows, "clearance [um]", keys, axis="reference life L10r [Mrev]", table=False)
    page.assume("elements", 16, "-", "fills the outline NJ 2232")
    page.assume("element diameter", 0.04, "m", "fills the outline NJ 2232")
    page.assume("element length", 0.05, "m", "fits the width of 80 mm")
