"""Two million unknowns in 8 GiB: time and memory of four bodies, and how both grow."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from statistics import median

from fe_drivetrain.cases import case
from fe_drivetrain.cases.performance.peer_settings import problems_of, sizes_of
from fe_drivetrain.cases.performance.peers import (
    BENCHMARKS,
    Benchmark,
    Limits,
    Plan,
    Row,
    Variant,
    problems,
    rounds,
    write_problem,
)
from fe_drivetrain.common import cores, scratch_folder
from fe_drivetrain.comparison import PowerLaw, power_law
from fe_drivetrain.report import error_bars, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run

BODIES, QUICK_BODIES = ["shaft", "assembly", "tube", "slender"], ["shaft"]
#: Unknowns, about: thin and slender bodies have no coarser meshes.
SIZES, QUICK_SIZES = [100_000, 300_000, 1_000_000, 2_000_000], [5_000, 10_000]
WARM_UP = 10_000
#: The goal: this many unknowns, but for what the sizes of meshes leave, in so much memory.
UNKNOWNS, NEAR, MEMORY = 2_000_000, 0.95, 8.0
GIB = 2**30
TIME_CHART = "Time from the mesh in memory to the stiffness, median; bars: all runs"
MEMORY_CHART = "Peak memory of the process, median; bars: all runs"
ENDS: tuple[Callable[[list[float]], float], ...] = (min, median, max)


@case(
    "Two million unknowns in 8 GiB: thin walls and slender shafts, too",
    source="Measured here, each run in a process of its own; exact, G J / L",
    settings={
        "problems": "[shaft, assembly, tube, slender] (quick [shaft])",
        "sizes": "[100000, 300000, 1000000, 2000000] (quick [5000, 10000])",
        "repetitions": "5 (quick 1; from 1)",
        "time_limit": "600 (from 1)",
        "memory_limit": "12 (from 1)",
    },
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Solve every body at every size by auto, in processes of their own."""
    page.seed = None
    bodies = problems_of(run.settings.get("problems", QUICK_BODIES if run.quick else BODIES))
    sizes = sizes_of(run.settings.get("sizes", QUICK_SIZES if run.quick else SIZES))
    repetitions = run.count("repetitions", 1 if run.quick else 5)
    limits = Limits(
        float(run.count("time_limit", 600)), float(run.count("memory_limit", 12)) * GIB, cores()
    )
    found: dict[str, list[Row]] = {}
    for name in bodies:
        benchmark = BENCHMARKS[name]()
        found[name] = measured(run, benchmark, sizes, Plan(repetitions, limits))
        check(page, benchmark, found[name])
    done = {name: [row for row in rows if row.found] for name, rows in found.items()}
    grown = {name: laws_of(rows) for name, rows in done.items() if rows}
    laws = {name: both for name, both in grown.items() if both is not None}
    goals = [goal(BENCHMARKS[name]().title, rows[-1]) for name, rows in done.items() if rows]
    details(page, done, laws)
    answer(page, {name: rows for name, rows in done.items() if rows}, laws)
    page.section("Goal")
    page.table(f"Goal: {UNKNOWNS:,} unknowns in {MEMORY:g} GiB", goals, list(HEAD_OF_GOALS))
    page.section("Growth")
    page.table(
        "Exponents of the number of unknowns, fitted to medians in logarithms, and between what "
        "they are found with a chance of 95 %, the sizes being all of the scatter. Of those sizes "
        "that were solved by the same solver as the largest",
        [exponents(BENCHMARKS[name]().title, *both) for name, both in laws.items()],
        ["body", "from unknowns", "to unknowns", "time", "between", "memory", "between "],
    )
    show(page, done)
    page.section("All runs")
    page.table(
        "Wall time from the mesh in memory to the stiffness, and peak memory of the process, "
        "Python, libraries and mesh included",
        [line(BENCHMARKS[name]().title, row) for name, rows in found.items() for row in rows],
    )
    page.text(
        "Each run is a process of its own, which first solves a small problem; meshes are made "
        "before. Ten-node tetrahedra, one face held and one moved, solver auto. Python and "
        "libraries weigh most in the memory of the smallest size, which lowers its exponent."
    )
    page.data("goals", goals)
    for name, rows in found.items():
        page.data(name, [line(name, row) for row in rows])


def measured(run: Run, benchmark: Benchmark, sizes: Sequence[int], plan: Plan) -> list[Row]:
    """A row for each size of a body."""
    rows: list[Row] = []
    ours = [(Variant("this_project", "auto"), sys.executable)]
    with scratch_folder() as name:
        warm_up, file = name / "warm_up.npz", name / "problem.npz"
        write_problem(problems.of_size(problems.hollow_shaft(), min(WARM_UP, *sizes)), warm_up)
        for size in sizes:
            with run.step(f"{benchmark.title}: mesh of {size:,} unknowns"):
                problem = problems.of_size(benchmark, size)
                write_problem(problem, file)
            unknowns = problem.n_unknowns
            del problem
            if any(row.unknowns == unknowns for row in rows):
                continue  # there is no coarser mesh
            with run.step(f"{benchmark.title}: {unknowns:,} unknowns"):
                rows += rounds.run_rounds(ours, file, warm_up, unknowns, plan, rows, run.report)
    return rows


def solver_of(row: Row) -> str:
    """By which the runs of a size were solved in the end."""
    return str(row.found[0]["notes"]["method"])


def laws_of(rows: Sequence[Row]) -> tuple[PowerLaw, PowerLaw] | None:
    """Time and memory over the number of unknowns, of the solver that the largest size has.

    Another solver on smaller sizes grows otherwise. None where there is but one size.
    """
    same = [row for row in rows if solver_of(row) == solver_of(rows[-1])]
    if len(same) < 2:
        return None
    unknowns = [row.unknowns for row in same]
    return (
        power_law(unknowns, [row.seconds or 0.0 for row in same]),
        power_law(unknowns, [row.bytes or 0 for row in same]),
    )


def check(page: Page, benchmark: Benchmark, rows: Sequence[Row]) -> None:
    """The exact stiffness on the finest mesh, where it is known."""
    done = [row for row in rows if row.found]
    if benchmark.exact is None or not done:
        return
    finest = done[-1]
    assert finest.stiffness is not None
    page.equals(
        f"{benchmark.title}, {finest.unknowns:,} unknowns: {benchmark.quantity}",
        finest.stiffness,
        benchmark.exact,
        within=1e-2,
        why="a parabola through three points of an arc of angle a leaves a^4 / 500 of its radius, "
        "and the stiffness goes with the fourth power of that: 1e-2 of six elements a turn, the "
        "fewest of any mesh",
        source="exact, G J / L",
        unit=benchmark.unit,
    )


HEAD_OF_GOALS = ("body", "unknowns", "peak memory, most [GiB]", "goal, at most [GiB]", "reached")


def goal(title: str, row: Row) -> Record:
    """Peak memory of the largest size that came to an end, beside the goal."""
    most = max(f["peak_bytes"] for f in row.found) / GIB
    reached = "yes" if most <= MEMORY else "no"
    if row.unknowns < NEAR * UNKNOWNS:
        reached = "not known: fewer unknowns"
    return dict(zip(HEAD_OF_GOALS, (title, row.unknowns, most, MEMORY, reached), strict=True))


def exponents(title: str, time: PowerLaw, memory: PowerLaw) -> Record:
    """Exponents of time and memory, with their bands."""
    return {
        "body": title,
        "from unknowns": int(time.x.min()),
        "to unknowns": int(time.x.max()),
        "time": time.exponent,
        "between": in_words(time.exponent_band()),
        "memory": memory.exponent,
        "between ": in_words(memory.exponent_band()),
    }


def in_words(band: tuple[float, float]) -> str:
    """Both ends, or that two sizes have none."""
    low, high = band
    return f"{low:.2f} and {high:.2f}" if high < float("inf") else "not known of two sizes"


def line(body: str, row: Row) -> Record:
    """What the runs of one size took."""
    seconds = [f["seconds"] for f in row.found]
    held = [f["peak_bytes"] / GIB for f in row.found]
    return {
        "body": body,
        "unknowns": row.unknowns,
        "solver": solver_of(row) if row.found else None,
        "runs": len(row.found),
        "least [s]": min(seconds, default=None),
        "median [s]": row.seconds,
        "most [s]": max(seconds, default=None),
        "iterations": row.found[0]["iterations"] if row.found else None,
        "peak memory, least [GiB]": min(held, default=None),
        "median [GiB]": median(held) if held else None,
        "most [GiB]": max(held, default=None),
        "remarks": row.trouble or None,
    }


def answer(
    page: Page, done: dict[str, list[Row]], laws: dict[str, tuple[PowerLaw, PowerLaw]]
) -> None:
    """State the most memory that the largest size takes, beside the goal."""
    question = "Do two million unknowns fit into 8 GiB, and how long do they take?"
    if not done:
        page.answer(question, "0 sizes came to an end within the limits of time and memory.", [])
        return
    most = {n: max(f["peak_bytes"] for f in rows[-1].found) / GIB for n, rows in done.items()}
    worst = max(most, key=lambda name: most[name])
    last = done[worst][-1]
    if last.unknowns < NEAR * UNKNOWNS:
        reached = f"{UNKNOWNS / 1e6:g}\u00a0million unknowns were not run"
    else:
        reached = (
            f"this is {'within' if most[worst] <= MEMORY else 'beyond'} the goal of "
            f"{MEMORY:g}\u00a0GiB"
        )
    title = BENCHMARKS[worst]().title
    exact = [check for check in page.checks if check.check == "equals"]
    page.answer(
        question,
        f"A model with {last.unknowns:,} unknowns ({title.lower()}) takes "
        f"{value_text(most[worst], 'GiB')} and {value_text(last.seconds or 0.0, 's')}; "
        f"{reached}.",
        [
            page.value("peak memory [GiB]", most[worst], beside=MEMORY, by="goal"),
            page.value(f"time, {title.lower()} [s]", last.seconds or 0.0),
            *(
                page.value(
                    f"exponent of growth of {what} with unknowns, {title.lower()}", law.exponent
                )
                for name, both in laws.items()
                if name == worst
                for what, law in zip(("time", "memory"), both, strict=True)
            ),
            *(
                page.judged(check.quantity, f"{check.quantity.rpartition(': ')[2]}", "G J / L")
                for check in exact[:1]
            ),
        ],
        hero=MEMORY_CHART,
        cautions=["Times are without meshing."],
    )


def details(
    page: Page, done: dict[str, list[Row]], laws: dict[str, tuple[PowerLaw, PowerLaw]]
) -> None:
    """State the largest size of each body, and how it grows, in a sentence."""
    for name, rows in done.items():
        if not rows:
            page.say(f"{BENCHMARKS[name]().title}: nothing came to an end.")
            continue
        last = rows[-1]
        grows = ""
        if name in laws:
            time, memory = laws[name]
            grows = (
                f"; time grows with the power {time.exponent:.2f} of the number of unknowns, "
                f"memory with {memory.exponent:.2f}"
            )
        page.say(
            f"{BENCHMARKS[name]().title}: {last.unknowns:,} unknowns take {last.seconds:.2g} s "
            f"and {(last.bytes or 0) / GIB:.2g} GiB by {solver_of(last)}{grows}."
        )


def of_runs(row: Row, key: str, scale: float) -> list[float]:
    """What each run of a size took."""
    return [float(found[key]) / scale for found in row.found]


def show(page: Page, done: dict[str, list[Row]]) -> None:
    """Time and memory over the number of unknowns."""
    for title, unit, key in (
        (TIME_CHART, "time [s]", "seconds"),
        (MEMORY_CHART, "peak memory [GiB]", "peak_bytes"),
    ):
        scale = GIB if key == "peak_bytes" else 1.0
        page.chart(
            title,
            [
                trace(
                    BENCHMARKS[name]().title,
                    [row.unknowns for row in rows],
                    [median(of_runs(row, key, scale)) for row in rows],
                    mode="lines+markers",
                    **error_bars(
                        "y",
                        *([of(of_runs(row, key, scale)) for row in rows] for of in ENDS),
                    ),
                )
                for name, rows in done.items()
            ],
            "unknowns",
            unit,
            "xy",
        )
