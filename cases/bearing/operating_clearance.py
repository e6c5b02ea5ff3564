"""Operating clearance: from a given one to rings in solids, and against what makers print."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import hypot

from fe_drivetrain.bearing import catalogue_entry
from fe_drivetrain.bearing.entry_clearance import entry_seats
from fe_drivetrain.bearing.mounting import Fit, Mounting, Temperatures
from fe_drivetrain.bearing.operating_clearance import (
    FitState,
    OperatingClearance,
    Seats,
    Warm,
    fitted_clearance,
    operating_clearance,
    warm_of,
)
from fe_drivetrain.bearing.press_fits import RingMaterial
from fe_drivetrain.bearing.tolerances import (
    Limits,
    bore_limits,
    class_clearance,
    housing_limits,
    outside_limits,
    shaft_limits,
)
from fe_drivetrain.cases import case
from fe_drivetrain.cases.bearing.fitted_rings import raceway_growth
from fe_drivetrain.report.number_text import certain_value, value_text
from fe_drivetrain.report.suite import Page, Record, Run

STEEL = RingMaterial(206e9, 0.3, 7850.0, 12.5e-6)
ENTRY, WIDTH = "cylindrical_nu2220", 0.046  # m
FITS = Fit(shaft="n6", housing="H7", outside_diameter=0.18, shaft_bore=0.03, housing_diameter=0.24)
HOT = Temperatures(shaft=60, inner_ring=65, outer_ring=50, housing=40)
SPEED = 190.0  # rad/s, of a high-speed shaft

ERROR, TIME = "error of the clearance [µm]", "processor time [ms]"
CHART = "Operating clearance: error against time"
RINGS = "thick cylinders, with temperatures and speed"
WIDE, SHAFT = "rings in solids, the shaft as wide", "rings in solids on a longer shaft"

#: Shaft, diameter [m], theoretical and probable interference [um] with a bearing of class Normal.
SHAFTS = [
    ("n6", 0.07, (20, 54), (24, 50)),
    ("n6", 0.1, (23, 65), (29, 59)),
    ("p6", 0.11, (37, 79), (43, 73)),
    ("r6", 0.09, (51, 93), (57, 87)),
    ("r7", 0.09, (51, 106), (58, 99)),
    ("n6", 0.15, (27, 77), (34, 70)),
    ("p7", 0.19, (50, 126), (60, 116)),
    ("r6", 0.24, (84, 143), (92, 135)),
]
HOUSINGS = [
    ("N6", 0.045, (1, 28), (4, 25)),
    ("N7", 0.1, (-5, 45), (0, 40)),
    ("P7", 0.13, (10, 68), (17, 61)),
    ("P6", 0.2, (11, 70), (19, 62)),
    ("N7", 0.2, (-16, 60), (-6, 50)),
]
TABLES = "tables 'Shaft' and 'Housing tolerances and resultant fits' of a bearing maker, as "
TABLES += "germany-bearing.com s66 and s74 print them"


@dataclass(frozen=True)
class Rung:
    """A model of the clearance, and how long it takes.

    Attributes
    ----------
    name : str
        What it is.
    clearance : float
        Radial clearance in operation with all tolerances at their middle [m].
    seconds : float
        Processor time [s].
    """

    name: str
    clearance: float
    seconds: float


def seats() -> Seats:
    """Diameters of the bearing on its hollow shaft, in its housing."""
    mounting = Mounting(clearance_class="C3", fit=FITS)
    return entry_seats(catalogue_entry(ENTRY), mounting, STEEL, STEEL, STEEL)[0]


def found_by(mounting: Mounting) -> OperatingClearance:
    """Clearance with a mounting."""
    at = seats()
    return operating_clearance(mounting, at, class_clearance("cylindrical", "C3", at.bore))


def by_solids(n: int, longer: int) -> float:
    """Mean clearance with the inner ring in solids; the outer one is loose, and grows freely."""
    at, mounting = seats(), Mounting(clearance_class="C3", fit=FITS, temperatures=HOT, speed=SPEED)
    d, D = at.bore, at.outside
    state = FitState(
        class_clearance("cylindrical", "C3", d).mean,
        shaft_limits("n6", d).mean,
        bore_limits(d).mean,
        housing_limits("H7", D).mean,
        outside_limits(D).mean,
    )
    warm, kept = warm_of(HOT, SPEED), (d / (d + 2e-3), D / (D + 2e-3))
    free = replace(at, shaft=replace(at.shaft, outer=0.5 * d))
    tight = kept[0] * (state.shaft - state.bore)
    loose = replace(state, shaft=-1e-3, bore=0.0)
    # a shaft that does not touch leaves the ring to its own growth, which solids replace
    alone, (on_shaft, _) = fitted_clearance(free, loose, warm, kept)
    assert on_shaft == 0.0
    ring = at.inner_ring
    own = STEEL.expansion * warm.inner_ring * at.inner_raceway
    own += 2.0 * ring.turning_growth(ring.outer, SPEED)
    assert mounting.fit is not None
    return alone + own - raceway_growth(at, tight, warm, WIDTH, n, longer)


def timed(name: str, compute: Callable[[], float], repeats: int) -> Rung:
    """A rung with its processor time, the mean of several runs."""
    begin = time.process_time()
    for _ in range(repeats):
        value = compute()
    return Rung(name, value, (time.process_time() - begin) / repeats)


def ladder(quick: bool) -> list[Rung]:
    """From a given clearance to rings in solids, cheap to expensive; the last is the reference."""
    given = Mounting(clearance_class="C3")
    fits = given.model_copy(update={"fit": FITS})
    hot = fits.model_copy(update={"temperatures": HOT, "speed": SPEED})
    many = 20 if quick else 200
    rungs = [
        timed("given clearance", lambda: found_by(given).radial.mean, many),
        timed("thick cylinders, fits alone", lambda: found_by(fits).radial.mean, many),
        timed(RINGS, lambda: found_by(hot).radial.mean, many),
    ]
    meshes = ((1, 1), (1, 3)) if quick else ((1, 1), (2, 1), (1, 4), (2, 4), (3, 4))
    for n, longer in meshes:
        name = f"{WIDE if longer == 1 else SHAFT}, {n} through the ring"
        rungs.append(timed(name, lambda n=n, longer=longer: by_solids(n, longer), 1))  # type: ignore[misc]
    return rungs


def printed_fits(page: Page) -> float:
    """Hold interferences against printed ones; the largest difference of probable ones [µm]."""
    found = [
        *(_row(n, d, shaft_limits(n, d), bore_limits(d), t, p) for n, d, t, p in SHAFTS),
        *(_row(n, d, outside_limits(d), housing_limits(n, d), t, p) for n, d, t, p in HOUSINGS),
    ]
    page.vanishes(
        "interference of fits with tolerances at their limits, largest difference [µm]",
        max(limits for _, limits, _ in found),
        within=1e-9,
        why="sums of whole micrometres",
        source=TABLES,
    )
    worst = max(probable for _, _, probable in found)
    page.at_most(
        "probable interference of fits, largest difference [µm]",
        worst,
        1.0,
        why="printed ones are rounded to whole micrometres, at both ends",
        source=TABLES,
    )
    page.section("Fits, against a maker's tables")
    rows = [row for row, _, _ in found]
    page.table("Interference, with tolerances at their limits and as squares", rows)
    return worst


def _row(
    name: str,
    d: float,
    inside: Limits,
    hole: Limits,
    theoretical: tuple[int, int],
    probable: tuple[int, int],
) -> tuple[Record, float, float]:
    """A fit beside a printed one, and by how much its limits and its probable range differ [µm]."""
    low, high = 1e6 * (inside.low - hole.high), 1e6 * (inside.high - hole.low)
    half, mean = 0.5e6 * hypot(inside.width, hole.width), 0.5 * (low + high)
    row: Record = {
        "class": name,
        "diameter [mm]": 1e3 * d,
        "interference [µm]": f"{low:.0f} to {high:.0f}",
        "printed": f"{theoretical[0]} to {theoretical[1]}",
        "probable [µm]": f"{mean - half:.1f} to {mean + half:.1f}",
        "probable, printed": f"{probable[0]} to {probable[1]}",
    }
    limits = max(abs(low - theoretical[0]), abs(high - theoretical[1]))
    return row, limits, max(abs(mean - half - probable[0]), abs(mean + half - probable[1]))


def catalogue_formulas(page: Page) -> None:
    """What catalogues print of fits and temperatures, by the thick cylinders."""
    at = seats()
    d, F = at.bore, at.inner_raceway
    solid = replace(at, shaft=replace(at.shaft, inner=0.0))
    share = -fitted_clearance(solid, FitState(0.0, shaft=50e-6), Warm())[0] / 50e-6
    page.equals(
        "share of an interference that reaches the raceway, solid shaft of the same material",
        share,
        d / F,
        within=1e-12,
        why="round-off: both are Lame's cylinders",
        source="d / F, as catalogues print it",
        basis="second-hand",
    )
    page.between(
        "that share, in the range that a maker prints for bearings",
        share,
        0.7,
        0.9,
        why="as printed: 'approximately 70 to 90 % of the interference'",
        source="nodeshk.com, 'Bearing internal clearance'",
    )
    warm = Warm(inner_ring=10.0, rollers=10.0)
    page.equals(
        "clearance that inner ring and rollers take, 10 K warmer than the outer ring [µm]",
        -1e6 * fitted_clearance(at, FitState(0.0, shaft=-1e-3, housing=1e-3), warm)[0],
        1e6 * 12.5e-6 * 10.0 * at.outer_raceway,
        within=1e-12,
        why="round-off: raceway and two rollers are as wide as the outer raceway",
        source="12.5e-6 1/K times the difference times the outer raceway, IKO Eq 29, NTN Eq 8.3",
    )


def answer(page: Page, rungs: list[Rung], band: OperatingClearance, worst: float) -> None:
    """State what thick cylinders are worth, and what they leave out."""
    of, exact = {one.name: one for one in rungs}, rungs[-1].clearance
    error, given = (1e6 * abs(of[name].clearance - exact) for name in (RINGS, "given clearance"))
    rings, radial = page.value("error of thick-cylinder formulas [µm]", error), band.radial
    page.answer(
        "Which formula gives the operating clearance of a bearing, and how accurately?",
        f"Formulas of thick cylinders give the operating clearance within {certain_value(rings)} "
        "of finite elements; the clearance before mounting errs by "
        f"{value_text(given, 'µm')}.",
        [
            rings,
            page.value("error of the clearance before mounting [µm]", given),
            page.value("time of thick-cylinder formulas [µs]", 1e6 * of[RINGS].seconds),
            page.value("operating clearance with mean tolerances [µm]", 1e6 * radial.mean),
            page.value("its whole range by tolerances [µm]", 1e6 * (radial.most - radial.least)),
            page.value(
                "largest difference of probable interference from a maker's table [µm]",
                worst,
                at_most=1.0,
            ),
        ],
        hero=CHART,
        cautions=[
            "Tolerances of the parts move the clearance far more than thick-cylinder formulas err.",
            "No model here has flanges of rings, seats out of round or temperatures that vary "
            "within a part.",
        ],
    )


@case(
    "Operating clearance: fits, temperatures and speed, against rings in solids and makers' tables",
    source="Lame 1852; ISO 286, ISO 492 and ISO 5753-1 as makers of bearings print them",
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Climb the ladder of one bearing; hold fits and formulas against what is printed."""
    with run.step("ladder"):
        rungs = ladder(run.quick)
    exact = rungs[-1].clearance
    rows: list[Record] = [
        {
            "model": one.name,
            "clearance [µm]": 1e6 * one.clearance,
            ERROR: 1e6 * abs(one.clearance - exact),
            TIME: 1e3 * one.seconds,
        }
        for one in rungs[:-1]
    ]
    band = found_by(Mounting(clearance_class="C3", fit=FITS, temperatures=HOT, speed=SPEED))
    wide = next(one for one in reversed(rungs) if one.name.startswith(WIDE))
    page.equals(
        "operating clearance by thick cylinders, against rings in solids as wide [µm]",
        1e6 * band.radial.mean,
        1e6 * wide.clearance,
        within=0.05,
        relative=False,
        why="the same plane problem: (h/r)^4 of quadratic elements is below 1e-3 of 30 µm",
        source="hexahedra of 27 nodes",
        basis="self-consistency",
    )
    page.at_most(
        "error of thick cylinders over the band of tolerances",
        abs(band.radial.mean - exact) / (band.radial.most - band.radial.least),
        0.1,
        why="a model is enough where tolerances leave ten times more open",
        source="rings in solids on a longer shaft",
    )
    worst = printed_fits(page)
    catalogue_formulas(page)
    answer(page, rungs, band, worst)
    page.section("Ladder")
    page.sweep(CHART, rows, TIME, ERROR, by="model", log="xy", points=True, chosen_curve=RINGS)
    page.text(
        f"Errors are against {rungs[-1].name}: a shaft that goes on beyond the ring is stiffer at "
        "its ends, so that a little more of the interference reaches the raceway."
    )
