"""Press fits at their limits: walls that vanish, seats that are loose, and the way between."""

from fractions import Fraction
from math import inf

import numpy as np

from fe_drivetrain.bearing.operating_clearance import FitState, Seats, Warm, fitted_clearance
from fe_drivetrain.bearing.press_fits import Ring, RingMaterial, fit_pressure
from fe_drivetrain.cases import case
from fe_drivetrain.comparison import last_within
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run

STEEL = RingMaterial(206e9, 0.3, 7850.0, 12e-6)
RADIUS = 0.27  # m, of the seat; no power of two, whose divisions have less round-off
ENOUGH = 1e-6

WALL, ERROR = "wall over radius", "error of the pressure"
TIGHT, PRESSURE = "interference of the diameters [µm]", "pressure [MPa]"
REDUCTION = "clearance taken [µm]"
THIN = "Round-off in the pressure of a fit by the wall of the ring; shaded: below 1e-6"
LOOSE = "From a loose seat to a tight one"


def exact_pressure(ring: Ring, interference: float) -> Fraction:
    """Pressure of a ring on a solid shaft of its material, in whole fractions: no round-off."""
    a, b = Fraction(ring.inner), Fraction(ring.outer)
    ratio = (a / b) ** 2
    # nu of ring and shaft cancel
    soft = (1 + ratio) / (1 - ratio) + 1
    return Fraction(interference) * Fraction(STEEL.youngs_modulus) / (2 * a * soft)


def thin_walls(page: Page, quick: bool) -> float:
    """Pressure over the wall of the ring; returns the thinnest that is computed well."""
    shaft = Ring(0.0, RADIUS, STEEL)
    rows: list[Record] = []
    walls = 10.0 ** np.arange(0, -13.5 if quick else -14.5, -1.0 if quick else -0.5)
    for wall in walls:
        ring = Ring(RADIUS, RADIUS * (1.0 + float(wall)), STEEL)
        found = fit_pressure(shaft, ring, 1e-4)
        exact = exact_pressure(ring, 1e-4)
        rows.append({WALL: float(wall), ERROR: float(abs(Fraction(found) / exact - 1))})
    errors = [float(row[ERROR]) for row in rows]  # type: ignore[arg-type]
    thinnest = last_within(list(walls), errors, ENOUGH)
    assert thinnest is not None
    page.at_most(
        "round-off in the pressure of rings with a wall of a thousandth of the radius and more",
        max(error for wall, error in zip(walls, errors, strict=True) if wall >= 1e-3),
        4.0 * 2.0**-52 * 1e3,
        why="1 - (a/b)^2 cancels: four roundings, each enlarged by radius over wall",
        source="the same formula in whole fractions",
        measure="identity",
    )
    page.limit(
        "press fit of a thin ring",
        WALL,
        low=float(thinnest),
        criterion="pressure within 1e-6 of the exact one",
        beyond="the difference of both radii loses its digits: 1e-16 over the wall",
        program="computes; no ring of a bearing is as thin",
        remedy="a hoop's formula, E t i / (2 r^2)",
    )
    page.section("Thin walls")
    page.sweep(THIN, rows, WALL, ERROR, log="xy", safe=(float(thinnest), None))
    return float(thinnest)


def loose_seats(page: Page, quick: bool) -> tuple[float, float]:
    """Pressure and clearance over the interference; returns the least pressure and the jump."""
    shaft, housing = Ring(0.05, 0.25, STEEL), Ring(0.36, inf, STEEL)
    at = Seats(0.5, 0.72, 0.56, 0.66, 0.05, 0.0, 0.0, shaft, housing, STEEL)
    rows: list[Record] = []
    taken, pressures = [], []
    sweep = np.linspace(-200e-6, 200e-6, 41 if quick else 401)
    for tight in sweep:
        clearance, both = fitted_clearance(
            at, FitState(0.0, float(tight), 0.0, -float(tight)), Warm()
        )
        taken.append(-clearance)
        pressures.append(min(both))
        rows.append(
            {
                TIGHT: 1e6 * float(tight),
                f"{PRESSURE}, inner ring": 1e-6 * both[0],
                f"{PRESSURE}, outer ring": 1e-6 * both[1],
                REDUCTION: -1e6 * clearance,
            }
        )
    page.at_least(
        "lowest pressure on a seat from 0.2 mm of gap on [Pa]",
        min(pressures),
        0.0,
        why="a loose ring is not pulled",
        source="contact",
    )
    gap = [value for tight, value in zip(sweep, taken, strict=True) if tight <= 0.0]
    page.vanishes(
        "clearance that loose rings take [m]",
        max(map(abs, gap)),
        within=0.0,
        why="nothing touches",
        source="contact",
    )
    step = float(np.abs(np.diff(taken)).max() / (sweep[1] - sweep[0]))
    page.at_most(
        "change of clearance over change of interference of both rings",
        step,
        2.0,
        why="a raceway moves by less than its seat: no jump where a ring becomes tight",
        source="Lame's cylinders",
    )
    page.section("Loose seats")
    page.sweep(
        LOOSE,
        rows,
        TIGHT,
        {f"{PRESSURE}, inner ring": "inner ring", f"{PRESSURE}, outer ring": "outer ring"},
        axis=PRESSURE,
    )
    page.sweep("Radial clearance that fits take", rows, TIGHT, REDUCTION)
    return min(pressures), step


@case(
    "Press fits at their limits: thin rings and loose seats",
    source="Lame's cylinders in whole fractions; contact",
)
def run(run: Run, page: Page) -> None:
    """Take the wall of a ring, and the interference of its seat, to nothing."""
    with run.step("thin walls"):
        thinnest = thin_walls(page, run.quick)
    with run.step("loose seats"):
        least, step = loose_seats(page, run.quick)
    page.answer(
        "For how thin a ring is the pressure of a press fit computed correctly?",
        f"The pressure is correct to six digits down to ring walls of {formatted(thinnest, 1, '')} "
        "of the radius, thinner than any bearing's; loose rings have none.",
        [
            page.value("thinnest wall over radius with pressure correct to six digits", thinnest),
            page.value("lowest pressure on a seat [Pa]", least, at_least=0.0),
            page.value("change of clearance over change of interference", step, at_most=2.0),
        ],
        hero=THIN,
        cautions=[],
    )
