"""How far each phase of a solve is from the time in which memory moves its bytes."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from statistics import median
from typing import TypeVar

import numpy as np
from numba import get_num_threads

from fe_drivetrain.cases import case
from fe_drivetrain.cases.performance.peer_settings import problems_of, sizes_of
from fe_drivetrain.cases.performance.peers import BENCHMARKS, Problem, assembled, problems
from fe_drivetrain.elasticity.interfaces import eliminate, fixed
from fe_drivetrain.elasticity.operator import Pattern, kernels, sparsity
from fe_drivetrain.elasticity.solve import System, multigrid, reduce
from fe_drivetrain.report import error_bars, trace
from fe_drivetrain.report.suite import Page, Record, Run, grouped

PROBLEMS, QUICK_PROBLEMS = ["shaft", "assembly"], ["shaft"]
SIZES, QUICK_SIZES = [50_000, 110_000, 300_000, 1_000_000], [10_000]
REPEATS, QUICK_REPEATS = 5, 2

#: Values of each of the arrays that bandwidth is measured with: far more than caches hold.
STREAM, QUICK_STREAM = 20_000_000, 2_000_000

OVER_FLOOR = "Time of each phase over its floor; bars: least and most of all runs"
SPREAD = "least [s]", "median [s]", "most [s]"

#: From here on matrices are larger than caches.
BEYOND_CACHES = 100_000

#: Bytes of a 3x3 block in double and in single precision, each with its column.
DOUBLE, SINGLE = 9 * 8 + 4, 9 * 4 + 4

#: Goals: iterations over their floor; set-up, and assembly, over iterations.
GOALS = (
    ("iterations over their floor", 2.0),
    ("set-up over iterations", 0.5),
    ("assembly over iterations", 0.25),
)

PHASES = ("pattern", "elements", "reduction", "set-up", "iterations")

_Made = TypeVar("_Made")


@dataclass(frozen=True)
class Solved:
    """One solve: wall times and bytes of each phase, its iterations, passes in each of them."""

    seconds: dict[str, float]
    bytes: dict[str, float]
    iterations: int
    passes: int


@case(
    "Distance from the limit: time of each phase beside that in which memory moves its bytes",
    source="Measured here: bandwidth and phases in one run",
    settings={
        "problems": "[shaft, assembly] (quick [shaft])",
        "sizes": "[50000, 110000, 300000, 1000000] (quick [10000])",
        "repeats": "5 (quick 2; from 1)",
    },
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Count what each phase reads and writes, and time it beside a plain loop over memory."""
    page.seed = None
    names = problems_of(run.settings.get("problems", QUICK_PROBLEMS if run.quick else PROBLEMS))
    sizes = sizes_of(run.settings.get("sizes", QUICK_SIZES if run.quick else SIZES))
    repeats = run.count("repeats", QUICK_REPEATS if run.quick else REPEATS)
    with run.step("bandwidth"):
        rates = bandwidths(QUICK_STREAM if run.quick else STREAM, repeats)
    rate = max(rates)
    rows: list[Record] = []
    goals: list[Record] = []
    for name in names:
        for size in sizes:
            with run.step(f"{name}, {size:,} unknowns"):
                problem = problems.of_size(BENCHMARKS[name](), size)
                found = [timed(problem) for _ in range(1 + repeats)][1:]  # the first compiles
            rows += rows_of(name, problem, found, rate)
            goals += goals_of(rows[-len(PHASES) :])
    check(page, rows)
    answer(page, goals, rates)
    page.section("Goals")
    page.table("Goals: ratios of median times, and of the iterations to the floor", goals)
    page.section("Phases")
    page.table("Median times of each phase, what it moves at least, and its floor", rows)
    traces = [
        trace(
            f"{name}, {phase}" if len(names) > 1 else phase,
            [row["unknowns"] for row in of],
            [row["over its floor"] for row in of],
            mode="lines+markers",
            **error_bars("y", *([row[k] / row["floor [s]"] for row in of] for k in SPREAD)),
        )
        for name, mine in grouped(rows, "problem")
        for phase, of in grouped(mine, "phase")
    ]
    page.chart(OVER_FLOOR, traces, "unknowns", "time over floor", "xy")
    page.section("What is counted")
    for text in method(found[0]):
        page.text(text)
    page.data("bandwidths", rates)
    page.data("phases", rows)
    page.data("iterations", found[0].iterations)


def timed(problem: Problem) -> Solved:
    """One solve of a problem by multigrid, phase by phase."""
    points, cells, n = problem.points, problem.cells, problem.points.size
    seconds: dict[str, float] = {}

    def clocked(phase: str, work: Callable[[], _Made]) -> _Made:
        start = time.perf_counter()
        made = work()
        seconds[phase] = time.perf_counter() - start
        return made

    pattern = clocked("pattern", lambda: sparsity(cells, len(points)))
    K = clocked("elements", lambda: assembled(problem, pattern))
    held, values = problem.prescribed()
    given = np.zeros((len(points), 3))
    given[held] = values
    elimination = eliminate([fixed("prescribed", held, n)], n)
    F = np.where(elimination.free[:, None], -(K @ given.reshape(-1, 1)), 0.0)
    system = clocked("reduction", lambda: reduce(points, cells, K, elimination))
    hierarchy = clocked("set-up", lambda: multigrid.build(system))
    found = clocked(
        "iterations",
        lambda: multigrid.conjugate_gradients(system.K, F, hierarchy.precondition, 1e-6),
    )
    assert isinstance(hierarchy, multigrid.Hierarchy)
    moved = {
        "pattern": pattern_bytes(pattern),
        "elements": element_bytes(problem, pattern),
        "reduction": 2.0 * DOUBLE * len(K.indices),
        "set-up": set_up_bytes(hierarchy),
        "iterations": found.iterations * iteration_bytes(system, hierarchy),
    }
    # the product of conjugate gradients, a residual, and the smoother before and behind it
    return Solved(seconds, moved, found.iterations, 1 + 2 * hierarchy.levels[0].degree)


def pattern_bytes(pattern: Pattern) -> float:
    """Cells read twice, the pattern and each element's places in it written once."""
    n_cells, nodes, _ = pattern.slots.shape
    return float(2 * 8 * n_cells * nodes + pattern.indices.nbytes + pattern.slots.nbytes)


def element_bytes(problem: Problem, pattern: Pattern) -> float:
    """Cells, places and points read once, blocks cleared once and added to once."""
    blocks = 3.0 * 9 * 8 * len(pattern.indices)  # written, then read and written
    read = problem.cells.nbytes + pattern.slots.nbytes + problem.points.nbytes
    return blocks + float(read)


def level_bytes(level: multigrid.Level) -> float:
    """One pass over the stiffness of a level."""
    return float((SINGLE if level.K.data.dtype == np.float32 else DOUBLE) * len(level.K.indices))


def set_up_bytes(hierarchy: multigrid.Hierarchy) -> float:
    """Bytes of each level: one copy, the passes of Lanczos, one product for the next level."""
    total = 0.0
    for number, level in enumerate(hierarchy.levels):
        blocks = len(level.K.indices)
        copied = float(DOUBLE * blocks + level.K.data.nbytes)
        following = hierarchy.levels[number + 1].K if number + 1 < len(hierarchy.levels) else None
        written = DOUBLE * len(following.indices) if following is not None else 0.0
        total += copied + multigrid.LANCZOS_STEPS * level_bytes(level) + DOUBLE * blocks + written
    return total


def iteration_bytes(system: System, hierarchy: multigrid.Hierarchy) -> float:
    """The product of conjugate gradients, and of each level what a cycle reads.

    A smoother of degree d before, which begins at zero, reads the stiffness d - 1 times, the
    residual once, the smoother behind d times; a correction goes down and up once.
    """
    n = system.K.shape[0]
    total: float = DOUBLE * len(system.K.indices) + 8.0 * n * VECTORS
    for level in hierarchy.levels:
        between = float(level.prolongation.nnz + level.restriction.nnz)
        vectors = 8.0 * level.inverse.shape[0] * 3 * VECTORS_OF_LEVEL
        total += 2 * level.degree * level_bytes(level) + 12.0 * between + vectors
    return total


#: Vectors that an iteration reads or writes: in the product, in two sums, in two updates.
VECTORS = 2 + 4 + 6 + 3
#: And a level in a cycle: first step, residual, restriction, correction, last step with its blocks.
VECTORS_OF_LEVEL = 3 + 3 + 3 + 1 + 3 + 6 + 2 * 3


def bandwidths(n: int, repeats: int) -> list[float]:
    """Bytes a second of a compiled loop over six arrays, each of which is far from any cache."""
    X, R, P, Q = (np.ones((n // 4, 1)) for _ in range(4))
    alpha = np.zeros(1)
    kernels.advance(X, R, P, Q, alpha)
    found = []
    for _ in range(repeats):
        start = time.perf_counter()
        kernels.advance(X, R, P, Q, alpha)
        found.append(6 * X.nbytes / (time.perf_counter() - start))
    return found


def rows_of(name: str, problem: Problem, found: list[Solved], rate: float) -> list[Record]:
    """A row for each phase."""
    rows: list[Record] = []
    for phase in PHASES:
        times = [one.seconds[phase] for one in found]
        floor = found[0].bytes[phase] / rate
        rows.append(
            {
                "problem": name,
                "unknowns": problem.n_unknowns,
                "phase": phase,
                "least [s]": min(times),
                "median [s]": median(times),
                "most [s]": max(times),
                "bytes [MB]": found[0].bytes[phase] / 1e6,
                "floor [s]": floor,
                "over its floor": median(times) / floor,
            }
        )
    return rows


def goals_of(rows: list[Record]) -> list[Record]:
    """What was asked of each phase of a solve, and what it takes."""
    took = {row["phase"]: row["median [s]"] for row in rows}
    over = {row["phase"]: row["over its floor"] for row in rows}
    assembly = took["pattern"] + took["elements"] + took["reduction"]
    ratios = (
        over["iterations"],
        took["set-up"] / took["iterations"],
        assembly / took["iterations"],
    )
    return [
        {
            "problem": rows[0]["problem"],
            "unknowns": rows[0]["unknowns"],
            "goal": what,
            "measured": ratio,
            "at most": most,
            "reached": "yes" if ratio <= most else "no",
        }
        for (what, most), ratio in zip(GOALS, ratios, strict=True)
    ]


def check(page: Page, rows: list[Record]) -> None:
    """No phase can take less than its floor where nothing of it fits into a cache."""
    large = [row for row in rows if row["unknowns"] > BEYOND_CACHES]
    if large:
        least = min(large, key=lambda row: row["least [s]"] / row["floor [s]"])
        page.at_least(
            f"shortest time over floor beyond {BEYOND_CACHES:,} unknowns ({least['phase']})",
            least["least [s]"] / least["floor [s]"],
            1.0,
            why="matrices larger than caches pass through memory, and nothing moves faster than "
            "the fastest of the loops over plain arrays: less would mean bytes counted twice",
            source="bandwidth measured in the same run",
        )
    page.holds(
        "every phase of every size moved bytes and took time",
        all(row["bytes [MB]"] > 0.0 and row["least [s]"] > 0.0 for row in rows),
        why="a phase that is not counted would have a floor of zero",
        source="this run",
    )


def answer(page: Page, goals: list[Record], rates: list[float]) -> None:
    """State how far the iterations of the largest size are from their floor."""
    first = goals[0]["problem"]
    mine = [row for row in goals if row["problem"] == first][-len(GOALS) :]
    reached = sum(row["reached"] == "yes" for row in goals)
    over = float(mine[0]["measured"])
    page.answer(
        "How far is a solve from the time in which memory moves its bytes?",
        f"{BENCHMARKS[str(first)]().title}, {mine[0]['unknowns']:,} unknowns: iterations take "
        f"{over:.2g} times what memory needs for their bytes; {reached} of {len(goals)} goals are "
        "reached.",
        [
            *(
                page.value(
                    str(row["goal"]),
                    float(row["measured"]),
                    beside=float(row["at most"]),
                    by="goal",
                )
                for row in mine
            ),
            page.value(
                "bandwidth of memory [GB/s]",
                median(rates) / 1e9,
                0.5 * (max(rates) - min(rates)) / 1e9,
            ),
        ],
        hero=OVER_FLOOR,
        cautions=["Small problems fit into caches, and may be faster than their floor."],
    )


def method(solved: Solved) -> list[str]:
    """What is counted, in words."""
    threads = get_num_threads()
    return [
        "The floor of a phase is what it has to read and write once caches hold nothing of the "
        "matrices, over the fastest of the loops over plain arrays, of "
        f"{threads} thread{'s' * (threads > 1)}. Passes of the algorithm count as often as it "
        f"makes them: {multigrid.LANCZOS_STEPS} steps of Lanczos on each level, {solved.passes} "
        "passes over the finest stiffness an iteration, that of conjugate gradients in double "
        "precision.",
        "What stays in caches anyway, as the neighbours' displacements in a product, is not "
        "counted, nor that each material of an assembly is put into a matrix of its own first. "
        "Small problems fit into caches altogether, and may be faster than their floor.",
    ]
