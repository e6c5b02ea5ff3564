"""Rollers on races that give way: where Newton's method needs damping, how many shapes it takes."""

from functools import lru_cache

import numpy as np

from fe_drivetrain.bearing import (
    Bearing,
    Races,
    catalogue_bearing,
    contact_compliance,
    equilibrium,
    equilibrium_on_races,
)
from fe_drivetrain.bearing.races import SOFTEST_LEFT_OUT
from fe_drivetrain.bearing_life.rings import races_of_revolution
from fe_drivetrain.cases import case
from fe_drivetrain.cases.stability.random_loads import random_loads
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.revolution import dofs, meridian
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.report import rolling_elements
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run

#: Bore and width of a ring of iron about bearing S, clamped at its rear end [m].
BORE, WIDTH = 0.424, 0.3
WALLS = (0.005, 0.01, 0.02, 0.05, 0.1, 0.3)
CLEARANCES = (-2e-5, 0.0, 2e-4)

FACTORS = (1.0, 1e-3, 1e-6)

#: Softness of the shapes that are left out, over that of a contact.
SHARES = (1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01)
HARMONICS = (2, 4, 6, 9, 12, 18, 27, 36)
ALL = 144
SHARE = "softness left out over that of a contact"
ERROR = "error, 95th percentile [%]"
FAILS = "plain Newton fails [%]"
LEFT_OUT = f"Error of the peak roller over the {SHARE}; shaded: within 1 %"

#: What a choice of shapes or harmonics may change of peak rollers.
ENOUGH = 0.01


@lru_cache(maxsize=64)
def ring(wall: float, harmonics: int = 36) -> Floats:
    """Compliance of a ring of so thick a wall."""
    section = Section(length=WIDTH, outer_diameter=2 * (BORE + wall), inner_diameter=2 * BORE)
    shaft = Shaft(front=-WIDTH / 2, sections=(section,))
    mesh = meridian(shaft, max(wall, 0.03), order=5, layers=0)
    end = np.flatnonzero(np.abs(mesh.nodes[:, 0] - WIDTH / 2) < 1e-9)
    held = np.concatenate([dofs(end, c) for c in range(3)])
    iron = MATERIALS["ductile_iron"]
    found = races_of_revolution(bearing(), mesh, iron, BORE, held=held, harmonics=harmonics)
    return found.compliance


def bearing(clearance: float = 0.0) -> Bearing:
    """Bearing S, straight rollers in closed form."""
    return catalogue_bearing("bearing_s_o20", laminae=0, clearance=clearance)


@case(
    "Flexible rings: where Newton's method needs damping, how many shapes and harmonics it takes",
    source="damped Newton's method on a convex energy (Boyd, Vandenberghe 2004, ch. 9)",
)
def run(run: Run, page: Page) -> None:
    """Sweep the wall of the ring with clearance and preload, then shapes and harmonics."""
    n = 20 if run.quick else 300
    walls = WALLS[1::3] if run.quick else WALLS
    with run.step("thin walls"):
        rows = [
            damping(wall, gap, factor, n)
            for wall in walls
            for gap in CLEARANCES
            for factor in FACTORS
        ]
    with run.step("shapes"):
        shapes = [few(wall, count, n) for wall in walls for count in SHARES]
    with run.step("harmonics"):
        harmonics = [low(wall, count, n) for wall in walls for count in HARMONICS]
    page.vanishes(
        "cases of damped Newton that have not converged",
        float(sum(row["not converged"] for row in rows)),
        within=0.0,
        why="any start leads to the minimum of a convex function",
        source="convex energy",
    )
    share = min(_kept(shapes, SHARE, wall, 1.0) for wall in walls)
    waves = max(-_kept(harmonics, "harmonics", wall, -1.0) for wall in walls)
    page.limit(
        "the softest shapes of the races in place of all",
        SHARE,
        high=share,
        criterion=f"peak rollers of random loads within {100 * ENOUGH:.0f} %, whatever the wall",
        beyond="rollers feel the mean of races that give way between them",
        program="leaves out shapes below a twentieth",
        remedy="nothing to do, or `shapes=` for more",
    )
    answer(page, rows, share, waves)
    show(page, rows, shapes, harmonics, share, waves)
    page.image("The rollers of bearing S", run.sketch(*rolling_elements(bearing())))


def answer(page: Page, rows: list[Record], share: float, waves: float) -> None:
    """State the shapes and harmonics that peak rollers need, and whether all cases converge."""
    lost = sum(row["not converged"] for row in rows)
    worst = max(rows, key=lambda row: row[FAILS])
    page.answer(
        "How finely must a flexible bearing ring be modelled for the loads of its rollers?",
        f"Ring harmonics up to {waves:.0f} and ring shapes with at least {share:g} times a roller "
        f"contact's compliance give the peak roller load within {100 * ENOUGH:.0f}\u00a0%.",
        [
            page.value(
                "compliance over a roller contact's up to which shapes may be left out",
                share,
                at_least=SOFTEST_LEFT_OUT,
                by="program",
            ),
            page.value("ring harmonics needed, worst wall thickness", waves),
            page.value(
                "load cases that Newton's method with damping does not solve", lost, at_most=0.0
            ),
            page.value("loads that fail without damping, at worst [%]", worst[FAILS]),
            page.value(
                "most steps of Newton's method with damping",
                max(row["steps, worst"] for row in rows),
            ),
        ],
        hero=LEFT_OUT,
        cautions=[
            (
                "Newton's method with damping always converges"
                if lost == 0
                else f"Newton's method with damping fails in {lost} cases"
            )
            + f"; without it, {worst[FAILS]:.0f}\u00a0% of loads fail at "
            f"{formatted(worst['load over nominal'], 2, '')} of nominal load, a clearance of "
            f"{worst['clearance [µm]']:.0f}\u00a0µm and a wall of {worst['wall [mm]']:.0f}\u00a0mm."
        ],
    )


def show(
    page: Page,
    rows: list[Record],
    shapes: list[Record],
    harmonics: list[Record],
    share: float,
    waves: float,
) -> None:
    """Show random loads, walls, shapes and harmonics, with the ranges in which peaks are kept."""
    page.section("Wall and clearance")
    page.table("Random loads", rows)
    page.sweep(
        "Random loads of nominal size: peak roller over that of rigid rings",
        [row for row in rows if row["load over nominal"] == 1.0],
        "wall [mm]",
        "peak over that of rigid rings, median [-]",
        by="clearance [µm]",
        log="x",
        table=False,
    )
    page.section("Shapes and harmonics")
    page.sweep(LEFT_OUT, shapes, SHARE, ERROR, by="wall [mm]", log="xy", safe=(None, share))
    caption = "Error of the peak roller over the number of harmonics; shaded: within 1 %"
    page.sweep(caption, harmonics, "harmonics", ERROR, by="wall [mm]", log="xy", safe=(waves, None))


def damping(wall: float, clearance: float, factor: float, n: int) -> Record:
    """Random loads of one size on a ring, by plain and by damped Newton."""
    races, loads = Races(bearing(clearance), ring(wall)), factor * random_loads(n)
    plain = equilibrium_on_races(races, loads, warm=False, damped=False)
    damped = equilibrium_on_races(races, loads, warm=False)
    rigid = equilibrium(races.bearing, loads).rollers.max(axis=1)
    return {
        "wall [mm]": 1e3 * wall,
        "clearance [µm]": 1e6 * clearance,
        "load over nominal": factor,
        FAILS: 100.0 * float(1.0 - plain.converged.mean()),
        "not converged": int((~damped.converged).sum()),
        "steps, worst": int(damped.iterations.max()),
        "shapes": damped.shapes.shape[1],
        "peak over that of rigid rings, median [-]": float(
            np.median(damped.rollers.max(axis=1) / rigid)
        ),
    }


def few(wall: float, share: float, n: int) -> Record:
    """The same with shapes of the races that are softer than a share of a contact."""
    _, softness = Races(bearing(), ring(wall)).shapes(ALL)
    count = int((softness > share * contact_compliance(bearing())).sum())
    record: Record = {"wall [mm]": 1e3 * wall, SHARE: share, "shapes": count}
    return record | _error(wall, ring(wall), count, n)


def low(wall: float, count: int, n: int) -> Record:
    """The same with harmonics up to an order."""
    return {"wall [mm]": 1e3 * wall, "harmonics": count} | _error(wall, ring(wall, count), ALL, n)


@lru_cache(maxsize=16)
def _whole(wall: float, n: int) -> Floats:
    races = Races(bearing(), ring(wall))
    found = equilibrium_on_races(races, random_loads(n), shapes=ALL)
    return np.asarray(found.rollers.max(axis=1))


def _error(wall: float, compliance: Floats, count: int, n: int) -> Record:
    races = Races(bearing(), compliance)
    peak = equilibrium_on_races(races, random_loads(n), shapes=count).rollers.max(axis=1)
    errors = np.abs(peak / _whole(wall, n) - 1.0)
    # all shapes of the highest harmonics are the reference itself
    return {ERROR: 100.0 * float(np.quantile(errors, 0.95)) or None}


def _kept(rows: list[Record], key: str, wall: float, sign: float) -> float:
    """The largest (sign 1) or least (-1) value, times the sign, up to which errors are small."""
    of = [row for row in rows if row["wall [mm]"] == 1e3 * wall]
    bad = [sign * row[key] for row in of if (row[ERROR] or 0.0) > 100 * ENOUGH]
    return float(max(sign * row[key] for row in of if sign * row[key] < min(bad, default=np.inf)))
