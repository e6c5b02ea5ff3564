"""A shaft that lies loose in its bearings: how it settles, and where statics has no answer."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import decades, fitted_exponent, last_within
from fe_drivetrain.dynamics import (
    Equations,
    State,
    equations_of_motion,
    integrate,
    spring_laws,
    steady,
    wind_up,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run

MASS, STIFFNESS, GRAVITY = 500.0, 2e9, 9.81  # kg, N/m of each bearing, m/s^2
SPAN, ARM = 1.0, 0.3  # m: between the bearings, and from the first to the centre of mass
INERTIA = 40.0  # kg m^2 across
CLEARANCE, DAMPING = 1e-4, 2e5  # m, radial; N s/m
GAP = "clearance [mm]"
SETTLED = "settled shaft: distance from equilibrium over the clearance"
ORDER = "height of a bounce: error over the step, exponent"
BOUNCES = (
    "Elastic bounce from the height of the clearance: error over the time step; shaded: height "
    "within 1 %"
)
STEP = "time step over the period of the shaft in contact"
#: Of the two bearings, [up, turning] about the centre of mass.
ROWS = np.array([[1.0, -ARM], [1.0, SPAN - ARM]])


@case(
    "Loose bearings: settling under gravity, and what statics finds of it",
    source="two bearings with clearance, a rigid shaft; equilibrium by hand",
)
def run(run: Run, page: Page) -> None:
    """Let a shaft fall into its bearings; then over the step, the clearance and the start."""
    with run.step("settling"):
        settling(page)
    with run.step("time step"):
        enough = steps(page, run.quick)
    with run.step("statics"):
        rows = statics(page)
    answer(page, enough, [row for row in rows if row["start"] == "in the middle" and row[GAP]])
    page.say(
        "A shaft that falls into its bearings comes to rest where equilibrium has it, whatever the "
        "step.",
        "Statics finds the same from a start in contact. From the middle of the clearance, where "
        "nothing touches, it has no answer: the program says that a part is loose.",
    )


def answer(page: Page, enough: float, loose: list[Record]) -> None:
    """State the longest step, over the period in contact, and what statics makes of no contact."""
    refused = sum(not row["found"] for row in loose)
    settled = page.judged(SETTLED).value
    page.answer(
        "How short must time steps be for a shaft that lies loose in its bearings?",
        "A loose shaft bounces to the right height within 1\u00a0% for time steps up to "
        f"{formatted(enough, 2)} of its natural period in contact.",
        [
            page.value(
                "longest time step over the natural period in contact", rounded([enough], 2)[0]
            ),
            page.judged(ORDER, "order of the error of the height in the time step"),
            page.value("distance from equilibrium at rest, over the clearance", settled),
            page.value(
                f"static runs from mid-clearance that are rejected, of {len(loose)}",
                refused,
                at_least=len(loose),
            ),
        ],
        hero=BOUNCES,
        cautions=[
            "Statics from mid-clearance has no solution, as nothing touches there: the program "
            + (
                "says that a part is loose."
                if refused == len(loose)
                else f"says so in {refused} of {len(loose)} cases only."
            ),
            "Bounces here are elastic, the worst case: damping in the bearings makes them decay.",
        ],
    )


def shaft(clearance: float, damping: float = DAMPING) -> Equations:
    """Up and turning, on two bearings with clearance."""
    springs = spring_laws(ROWS, STIFFNESS, damping, lower=-clearance, upper=clearance)
    return equations_of_motion([MASS, INERTIA], springs)


def at_rest_by_hand(clearance: float) -> Floats:
    """Reactions by the lever, and the place that has them."""
    share = np.array([(SPAN - ARM) / SPAN, ARM / SPAN])
    ends = -clearance - share * MASS * GRAVITY / STIFFNESS
    return np.asarray(np.linalg.solve(ROWS, ends))


def settling(page: Page) -> None:
    """From the middle of the clearance to rest."""
    equations = shaft(CLEARANCE)
    weight = np.array([-MASS * GRAVITY, 0.0])
    motion = integrate(equations, steady(weight), 0.1, 2e-6, every=50)
    exact = at_rest_by_hand(CLEARANCE)
    page.vanishes(
        SETTLED,
        float(np.abs(ROWS @ (motion.q[-1] - exact)).max() / CLEARANCE),
        within=1e-6,
        why="bounces decay with the dampers of the bearings in contact",
        source="equilibrium of two reactions by the lever",
    )
    page.vanishes(
        "energy that appears from nowhere, over the largest",
        motion.relative_imbalance,
        within=1e-3,
        why="the instant of contact falls between two steps",
        source="weight's work goes into the dampers",
    )
    page.section("Settling")
    page.chart(
        "Height of the two journals over the clearance",
        [
            trace(f"bearing {k + 1}", 1e3 * motion.times, motion.q @ ROWS[k] / CLEARANCE)
            for k in range(2)
        ],
        "time [ms]",
        "height over the clearance",
    )


def steps(page: Page, quick: bool) -> float:
    """Height of the first bounce over the step."""
    one = equations_of_motion([MASS], spring_laws([[1.0]], STIFFNESS, lower=-CLEARANCE, upper=1.0))
    period = 2.0 * np.pi * np.sqrt(MASS / STIFFNESS)
    rows: list[Record] = []
    for over in decades(-3, -0.5, 4 if quick else 10)[::-1]:
        dt = float(over) * period
        start = State(np.zeros(1), np.zeros(1), np.zeros(1))
        found = integrate(one, steady([-MASS * GRAVITY]), 0.012, dt, start=start)
        # without dampers it comes back to where it fell from
        after = found.q[found.q[:, 0].argmin() :, 0]
        rows.append(
            {
                STEP: float(over),
                "height of the bounce, error over the clearance": float(
                    abs(after.max()) / CLEARANCE
                ),
                "energy from nowhere": found.relative_imbalance,
                "converged": found.converged,
            }
        )
    return judge_bounces(page, rows)


def judge_bounces(page: Page, rows: list[Record]) -> float:
    """Check the order of the bounces' error, show it; return the longest step that is enough."""
    size = [row["height of the bounce, error over the clearance"] for row in rows]
    over_steps = [row[STEP] for row in rows]
    slope, spread = fitted_exponent(over_steps[::-1], size[::-1], (1e-6, 0.3))
    page.at_least(
        ORDER,
        slope,
        0.9,
        why="an instant of contact between two steps costs at least the first order",
        source="an elastic bounce comes back to its height",
        measure="order",
        band=spread,
    )
    page.holds(
        "Newton's method converges in every step of every length",
        all(row["converged"] for row in rows),
        why="the law has one slope on each side of a flank",
        source="piecewise linear",
    )
    enough = last_within(over_steps[::-1], size[::-1], 0.01) or over_steps[-1]
    page.limit(
        "impact of a journal in its bearing",
        STEP,
        high=enough,
        criterion="height of an elastic bounce within 1 % of the clearance",
        beyond="the instant of contact falls between steps: energy appears or is lost, which each "
        "run shows",
        program="integrates with the steps it is given and states the energy that appears",
        remedy="steps by a tolerance (`StepControl`), or shorter ones",
    )
    page.section("Time step")
    page.sweep(
        BOUNCES,
        rows,
        STEP,
        {
            "height of the bounce, error over the clearance": "height",
            "energy from nowhere": "energy",
        },
        log="xy",
        safe=(None, enough),
        axis="error",
    )
    return float(enough)


def statics(page: Page) -> list[Record]:
    """From starts in and out of contact, loaded and not; all of them."""
    weight = np.array([-MASS * GRAVITY, 0.0])
    rows: list[Record] = []
    errors = []
    for clearance in (0.0, 1e-6, 1e-4, 1e-2):
        equations = shaft(clearance)
        for name, guess in (("in contact", None), ("in the middle", np.zeros(2))):
            for loaded in (True, False):
                if clearance == 0.0 and not loaded:
                    continue
                row: Record = {
                    GAP: 1e3 * clearance,
                    "start": name,
                    "loaded": loaded,
                }
                try:
                    found = wind_up(
                        equations, weight if loaded else 1e-3 * weight[::-1], guess=guess
                    )
                    row["found"] = True
                    row["steps"] = found.iterations
                    if loaded:
                        away = ROWS @ (found.q - at_rest_by_hand(clearance))
                        errors.append(float(np.abs(away).max()) / (clearance or 1e-6))
                except InputError:
                    row["found"] = False
                    row["steps"] = None
                rows.append(row)
    page.vanishes(
        "statics where it has an answer: distance from equilibrium over the clearance",
        max(errors),
        within=1e-8,
        why="Newton's method stops at 1e-9 of the weight",
        source="equilibrium of two reactions by the lever",
    )
    page.section("Statics")
    page.table("What Newton's method finds", rows)
    page.text(
        "Without contact there is no stiffness, and a start in the middle of the clearance gives "
        "Newton's method no direction: the program refuses with the sentence that a part is loose. "
        "Settling in time, with dampers, always has an answer."
    )
    return rows
