"""Load steps a second of a bearing in five degrees of freedom, by level of detail."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from fe_drivetrain.bearing import (
    Bearing,
    Equilibrium,
    Races,
    RacesEquilibrium,
    catalogue_bearing,
    equilibrium,
    equilibrium_on_races,
    reduced_table,
    roller_loads,
)
from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.housed_bearing import housed_races
from fe_drivetrain.common import Floats, cores, timed_runs
from fe_drivetrain.report import bars, mark_events
from fe_drivetrain.report.suite import Page, Record, Run

#: Steps of 144 ten-minute histories at 20 Hz, and the goal for them on two cores [s].
STEPS, GOAL = 1_728_000, 60.0

#: The same with flexible rings.
FLEXIBLE_GOAL = 600.0
#: Of their housing's mesh, which the speed does not depend on; and steps at a time, for memory.
HOUSING, QUICK_HOUSING = (2.5, 12), (3.6, 8)
AT_ONCE = 50_000
#: Steps that are solved several times where the whole history takes minutes.
FEW, FEW_FLEXIBLE = 50_000, 200_000

WHOLE = "1.728 million steps [s]"
BY_LEVEL = "Time of 1.728 million load steps by level of detail; bars: least and most of all runs"
STEP = 0.05  # s
QUICK_STEPS = 1000
TABLE_ERROR = 0.05


def history(steps: int) -> Floats:
    """Loads at a main bearing with a turbine's frequencies, of no turbine: (steps, 5) [N, N m]."""
    rng = np.random.default_rng(0)
    t = STEP * np.arange(steps)
    means = np.array([2.5e5, 0.0, -4e5, 1e5, 0.0])
    spreads = np.array([4e4, 8e4, 1e5, 4e5, 4e5])
    highest = np.array([0.3, 1.3, 1.3, 1.3, 1.3])  # Hz, 3P and 6P of some 13/min
    loads = np.tile(means, (steps, 1))
    for j in range(5):
        f = highest[j] * rng.uniform(0.02, 1.0, 20)
        for frequency, phase in zip(f, rng.uniform(0.0, 2.0 * np.pi, 20), strict=True):
            loads[:, j] += spreads[j] * np.cos(2.0 * np.pi * frequency * t + phase) / np.sqrt(10.0)
    return loads


@case(
    "Bearing equilibrium in five degrees of freedom and on flexible rings: load steps a second",
    source="bearing S, 72 rollers of 30 laminae, measured in one run",
    settings={"repeats": "5 (quick 1; from 1)"},
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """A long load history by laminae, in closed form, and from a table of reduced loads."""
    loads = history(QUICK_STEPS if run.quick else STEPS)
    few = loads[:FEW]
    repeats = run.count("repeats", 1 if run.quick else 5)
    laminae, closed = (catalogue_bearing("bearing_s", laminae=n) for n in (30, 0))
    with run.step("compile, and table"):
        equilibrium(laminae, few[:2])
        equilibrium(closed, few[:2])
        races = housed_races(QUICK_HOUSING if run.quick else HOUSING)
        equilibrium_on_races(races, few[:2])
        size = (7, 5, 12) if run.quick else (25, 13, 36)
        table, made = timed_runs(lambda: reduced_table(closed, size), repeats)
    levels = Levels(run, repeats)
    level = levels.timed

    whole = level("30 laminae, from the step before", loads, lambda: equilibrium(laminae, loads))
    cold = level("30 laminae, each alone", few, lambda: equilibrium(laminae, few, warm=False))
    exact = level("straight rollers in closed form", few, lambda: equilibrium(closed, few))
    with run.step("flexible rings, the whole history"):
        lost = on_housing(races, loads)[1]
    some = loads[:FEW_FLEXIBLE]
    flexible, _ = level(
        "flexible rings, straight rollers in closed form",
        some,
        lambda: on_housing(races, some),
    )
    _, peaks = level("table of reduced loads", few, lambda: table(few))
    true = by_row(closed, roller_loads(closed, exact.displacements))
    error = np.abs(peaks - true).max(axis=1) / true.max(axis=1)
    check(page, (whole, cold, exact), lost, None if run.quick else error)
    answer(page, levels.rows, made.median, 100.0 * float(np.median(error)))
    starts = {"step before": whole, "each alone": cold, "step before, flexible rings": flexible}
    show(page, levels.rows, repeats, starts)


def answer(page: Page, rows: list[Record], made: float, error: float) -> None:
    """State how long the steps of 144 histories take, beside the goal."""
    *_, flexible, table = rows
    seconds, on_rings = (float(row[WHOLE]) for row in (rows[0], flexible))
    reached = "within" if seconds <= GOAL else "beyond"
    page.answer(
        "How fast is a main bearing's equilibrium computed for long load histories?",
        "1.728\u00a0million load steps of a bearing with 72 rollers take "
        f"{seconds:.0f}\u00a0s, {reached} the goal of {GOAL:.0f}\u00a0s; with flexible rings they "
        f"take {on_rings:.0f}\u00a0s.",
        [
            page.value(
                "1.728 million steps, 30 slices a roller [s]", seconds, beside=GOAL, by="goal"
            ),
            page.value("the same on flexible rings [s]", on_rings, beside=FLEXIBLE_GOAL, by="goal"),
            page.value("steps a second, 30 slices a roller", float(rows[0]["steps a second"])),
            page.value(
                "steps a second by a table of reduced loads", float(table["steps a second"])
            ),
            page.value("median error of that table, most loaded roller [%]", error),
            page.value("time to make the table [s]", made),
        ],
        hero=BY_LEVEL,
        cautions=[
            f"Measured on {cores()} cores that had other work, too; goals are for two.",
            "The load history is a sum of cosines, not that of a turbine.",
        ],
    )


class Levels:
    """Times of several levels, one row each.

    Parameters
    ----------
    run : Run
        Whose clock is used.
    repeats : int
        Runs of each level.
    """

    def __init__(self, run: Run, repeats: int) -> None:
        self.run, self.repeats = run, repeats
        self.rows: list[Record] = []

    def timed(self, name: str, steps: Floats, solve: Callable[[], Any]) -> Any:
        """Solve load steps, and keep how many are solved in a second; return the solution."""
        with self.run.step(name):
            found, times = timed_runs(solve, self.repeats)
        self.rows.append(
            {
                "level": name,
                "load steps": len(steps),
                **times.columns(),
                "steps a second": len(steps) / times.median,
                WHOLE: STEPS * times.median / len(steps),
            }
        )
        return found


def check(page: Page, found: Sequence[Equilibrium], lost: int, error: Floats | None) -> None:
    """Check that all steps converge, to the same from either start, and the error of the table."""
    whole, cold, _ = found
    page.vanishes(
        "load steps that have not converged to 1e-8",
        float(lost + sum((~one.converged).sum() for one in found)),
        within=0.0,
        why="any start leads to the minimum of a convex function",
        source="convex energy",
    )
    page.vanishes(
        "started from the step before, against each alone: difference of displacements",
        float(
            np.abs(whole.displacements[: len(cold.displacements)] - cold.displacements).max()
            / np.abs(cold.displacements).max()
        ),
        within=1e-6,
        why="both are within the solver's residual of the same minimum",
        source="convex energy",
    )
    if error is not None:
        page.at_most(
            "table of reduced loads: error of the peak roller, 99th percentile",
            float(np.quantile(error, 0.99)),
            TABLE_ERROR,
            why="linear between nodes 10 deg apart, and the ripple of 36 rollers",
            source="equilibrium of each step",
        )


def show(
    page: Page, rows: list[Record], repeats: int, starts: dict[str, Equilibrium | RacesEquilibrium]
) -> None:
    """Show the wall time of each level, and the work of a load step."""
    page.section("Levels")
    seconds = {str(row["level"]): float(row[WHOLE]) for row in rows}
    scales = {str(row["level"]): float(row[WHOLE]) / float(row["median [s]"]) for row in rows}
    ends = {
        str(row["level"]): (
            scales[str(row["level"])] * float(row["least [s]"]),
            scales[str(row["level"])] * float(row["most [s]"]),
        )
        for row in rows
    }
    times = bars(
        BY_LEVEL,
        {"median": seconds},
        "time [s]",
        0.1 * min(seconds.values()),
        ends={"median": ends},
    )
    page.add(mark_events(times, {"goal": GOAL, "goal on flexible rings": FLEXIBLE_GOAL}))
    page.table(
        f"Wall time of the load steps, runs of each level: {repeats}; steps a second of the median",
        rows,
    )
    page.table(
        "Work of one load step",
        [
            {
                "start": name,
                "Newton steps, mean": float(found.iterations.mean()),
                "worst": int(found.iterations.max()),
                "evaluations of all rollers, mean": float(found.evaluations.mean()),
            }
            for name, found in starts.items()
        ],
    )
    page.text(
        "The load history is made of cosines below 1.3 Hz; steps are 0.05 s. A step starts from "
        "the one before it, whose forces and tangent are known; rollers that lift off cost "
        "nothing; ten places stand for the laminae of a roller that is loaded along all of its "
        "length (Gauss's rule of their sum, to 1e-13); powers come from a table. Roller loads "
        "scale with the loads where there is no clearance, so that a table over three ratios "
        "serves all loads."
    )


def on_housing(races: Races, loads: Floats) -> tuple[RacesEquilibrium, int]:
    """The first steps on a flexible housing, and how many of all have not converged."""
    first, lost = None, 0
    for k in range(0, len(loads), AT_ONCE):
        found = equilibrium_on_races(races, loads[k : k + AT_ONCE])
        first, lost = first or found, lost + int((~found.converged).sum())
    assert first is not None
    return first, lost


def by_row(bearing: Bearing, loads: Floats) -> Floats:
    """(n, rows) peak of each row."""
    parts = np.split(loads, np.cumsum(bearing.counts)[:-1], axis=1)
    return np.column_stack([part.max(axis=1) for part in parts])
