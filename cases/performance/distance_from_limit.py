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
from fe_drivetrain.cases.performance.matrix_free_product import matrix_free
from fe_drivetrain.cases.performance.peer_settings import problems_of, sizes_of
from fe_drivetrain.cases.performance.peers import BENCHMARKS, Problem, assembled, problems
from fe_drivetrain.cases.performance.phase_bytes import (
    COARSE,
    EIGENVALUES,
    REST,
    STEPS,
    accessed_bytes,
    element_bytes,
    held_bytes,
    iteration_bytes,
    matrix_bytes,
    reduction_bytes,
    set_up_bytes,
)
from fe_drivetrain.common import timed_runs
from fe_drivetrain.elasticity.interfaces import eliminate, fixed
from fe_drivetrain.elasticity.operator import kernels, sparsity
from fe_drivetrain.elasticity.solve import multigrid, reduce
from fe_drivetrain.elasticity.solve.coarse_product import coarse_product
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

#: Unknowns of a body whose matrices stay in caches: what its phases take is not memory's.
CACHED, QUICK_CACHED = 27_000, 3_000

#: Goals: iterations over their floor; set-up, and assembly, over iterations.
GOALS = (
    ("iterations over their floor", 2.0),
    ("set-up over iterations", 0.5),
    ("assembly over iterations", 0.25),
)

PHASES = ("pattern", "elements", "reduction", "set-up", "iterations")

#: Digits that two sums of the same products in another order may differ by, relative to the most.
SAME = 1e-12

_Made = TypeVar("_Made")


@dataclass(frozen=True)
class Solved:
    """One solve: wall times and bytes of each phase, its iterations, passes in each of them.

    Bytes that are moved at least, and, of phases that go to and fro in memory, those of every
    access, as if no cache held anything.
    """

    seconds: dict[str, float]
    bytes: dict[str, float]
    accessed: dict[str, float]
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
    beside: list[Record] = []
    for name in names:
        with run.step(f"{name}, in caches"):
            small = problems.of_size(BENCHMARKS[name](), QUICK_CACHED if run.quick else CACHED)
            solved = [timed(small) for _ in range(1 + repeats)][1:]
            cached = of_one_unknown(solved, small.n_unknowns)
        for size in sizes:
            with run.step(f"{name}, {size:,} unknowns"):
                problem = problems.of_size(BENCHMARKS[name](), size)
                found = [timed(problem) for _ in range(1 + repeats)][1:]  # the first compiles
            rows += rows_of(name, problem, found, rate, cached)
            goals += goals_of(rows[-len(PHASES + STEPS) :])
            with run.step(f"{name}, {size:,} unknowns: products"):
                beside.append(products(name, problem, repeats))
    check(page, rows, beside)
    answer(page, goals, rates)
    page.section("Goals")
    page.table("Goals: ratios of median times, and of the iterations to the floor", goals)
    page.section("Phases")
    page.table("Median times of each phase, what it moves at least, and its floor", rows)
    for text in limits(rows, goals):
        page.text(text)
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
    page.section("Without the matrix")
    show_products(page, beside)
    page.section("What is counted")
    for text in method(found[0], cached_size=small.n_unknowns):
        page.text(text)
    page.data("bandwidths", rates)
    page.data("phases", rows)
    page.data("products", beside)
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
    system = clocked("reduction", lambda: reduce(points, cells, K, elimination, overwrite=True))
    hierarchy = clocked("set-up", lambda: multigrid.build(system))
    found = clocked(
        "iterations",
        lambda: multigrid.conjugate_gradients(system.K, F, hierarchy.precondition, 1e-6),
    )
    assert isinstance(hierarchy, multigrid.Hierarchy)
    assert system.prolongation is not None
    clocked(COARSE, lambda: coarse_product(system.K, system.prolongation))
    levels = hierarchy.levels
    clocked(EIGENVALUES, lambda: [multigrid.max_eigenvalue(of.K, of.inverse) for of in levels])
    seconds[REST] = seconds["set-up"] - seconds[COARSE] - seconds[EIGENVALUES]
    moved = {
        "pattern": problem.cells.nbytes
        + held_bytes(pattern.indptr, pattern.indices, pattern.slots),
        "elements": element_bytes(problem, pattern, system.K.data),
        "reduction": reduction_bytes(problem, system),
        **set_up_bytes(system, hierarchy),
        "iterations": found.iterations * iteration_bytes(system, hierarchy),
    }
    # the product of conjugate gradients, a residual, and the smoother before and behind it
    passes = 1 + 2 * hierarchy.levels[0].degree
    return Solved(seconds, moved, accessed_bytes(pattern, system), found.iterations, passes)


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


def of_one_unknown(found: list[Solved], unknowns: int) -> dict[str, float]:
    """Least time of each phase for one unknown [s], of iterations for one of them."""
    return {
        phase: min(one.seconds[phase] / passes_of(one, phase) for one in found) / unknowns
        for phase in (*PHASES, *STEPS)
    }


def passes_of(solved: Solved, phase: str) -> int:
    """How often a phase is done in one solve."""
    return solved.iterations if phase == "iterations" else 1


def rows_of(
    name: str, problem: Problem, found: list[Solved], rate: float, cached: dict[str, float]
) -> list[Record]:
    """A row for each phase."""
    rows: list[Record] = []
    for phase in (*PHASES, *STEPS):
        within = cached[phase] * problem.n_unknowns * passes_of(found[0], phase)
        times = [one.seconds[phase] for one in found]
        floor = found[0].bytes[phase] / rate
        accessed = found[0].accessed.get(phase)
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
                "every access [MB]": accessed / 1e6 if accessed else None,
                "over every access": median(times) * rate / accessed if accessed else None,
                "as in caches [s]": within if phase != REST else None,
                "over that in caches": median(times) / within if phase != REST else None,
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


def limits(rows: list[Record], goals: list[Record]) -> list[str]:
    """What keeps assembly and set-up of the largest size of each problem from their goals."""
    texts = []
    for name, mine in grouped(rows, "problem"):
        took = {row["phase"]: row for row in mine[-len(PHASES + STEPS) :]}
        n, iterations = took["set-up"]["unknowns"], took["iterations"]["median [s]"]
        missed = [
            row["goal"]
            for row in goals
            if (row["problem"], row["unknowns"], row["reached"]) == (name, n, "no")
        ]
        if "assembly over iterations" in missed:
            elements = took["elements"]
            accessed = elements["median [s]"] / elements["over every access"]
            texts.append(
                f"{name}, {n:,} unknowns: assembly misses its goal. Elements take "
                f"{elements['median [s]']:.2g} s. In a body that stays in caches, as many would "
                f"take {elements['as in caches [s]']:.2g} s, which is "
                f"{elements['as in caches [s]'] / iterations:.2g} of all iterations. No layout in "
                "memory makes this part shorter: it is arithmetic, and adding up in caches. To "
                f"move the bytes of all accesses takes {accessed:.2g} s."
            )
        if "set-up over iterations" in missed:
            eigenvalues, coarse = took[EIGENVALUES], took[COARSE]
            texts.append(
                f"{name}, {n:,} unknowns: set-up misses its goal. Its largest eigenvalues take "
                f"{eigenvalues['median [s]']:.2g} s, {eigenvalues['over its floor']:.2g} times "
                f"their floor, as {multigrid.LANCZOS_STEPS} passes over each level bound them "
                f"safely. The product for linear elements takes {coarse['median [s]']:.2g} s, "
                f"{coarse['over every access']:.2g} times what its accesses need, and all else "
                f"{took[REST]['median [s]']:.2g} s."
            )
    return texts


def products(name: str, problem: Problem, repeats: int) -> Record:
    """One product with the stiffness of all elements: of the matrix, and element by element."""
    K = assembled(problem, sparsity(problem.cells, len(problem.points)))
    lame = np.stack(problem.lame(), axis=1)[problem.material]
    free = matrix_free(problem.points, problem.cells, lame)
    x = np.random.default_rng(0).standard_normal((problem.points.size, 1))
    zero, out = np.zeros_like(x), np.empty_like(x)
    single = np.empty(K.data.shape, np.float32)
    kernels.rounded(K.data, single)
    apart = np.abs(free.product(x[:, 0]) - kernels.product(K, x)[:, 0]).max()
    _, double = timed_runs(
        lambda: kernels.residual(K.indptr, K.indices, K.data, x, zero, out), repeats
    )
    apart /= np.abs(out).max()
    _, rounded = timed_runs(
        lambda: kernels.residual(K.indptr, K.indices, single, x, zero, out), repeats
    )
    _, without = timed_runs(lambda: free.product(x[:, 0]), repeats)
    return {
        "problem": name,
        "unknowns": problem.n_unknowns,
        **double.columns("matrix", "ms"),
        **rounded.columns("single precision", "ms"),
        **without.columns("no matrix", "ms"),
        "over matrix": without.median / double.median,
        "over single precision": without.median / rounded.median,
        "matrix [MB]": matrix_bytes(K) / 1e6,
        "no matrix [MB]": free.bytes / 1e6,
        "difference": float(apart),
    }


def show_products(page: Page, beside: list[Record]) -> None:
    """State which product is the faster one, and what each reads."""
    page.table("One product with the stiffness of all elements, one column", beside)
    last = max(beside, key=lambda row: int(row["unknowns"]))
    wins = [row for row in beside if row["over matrix"] < 1.0]
    smooths = [row for row in beside if row["over single precision"] < 1.0]
    verdict = "" if smooths else "So the solver keeps its matrices, and this product is evidence."
    page.text(
        f"Element by element a product reads {last['matrix [MB]'] / last['no matrix [MB]']:.1f} "
        f"times fewer bytes at {last['unknowns']:,} unknowns, and is faster than the matrix in "
        f"double precision in {len(wins)} of {len(beside)} rows, than that in single precision, "
        f"which smoothers read, in {len(smooths)}. Its time goes into gathering, scattering and "
        "arithmetic, not into memory: curved elements have eleven points, each with a Jacobian of "
        "its own. Many columns share one pass over a matrix, but not the arithmetic. " + verdict
    )


def check(page: Page, rows: list[Record], beside: list[Record]) -> None:
    """No phase can take less than its floor where nothing of it fits into a cache."""
    page.vanishes(
        "largest difference of products without and with the matrix, relative",
        max(row["difference"] for row in beside),
        within=SAME,
        why="the same integrals by the same rule, added up in another order: round-off",
        source="the assembled stiffness",
    )
    judged = [row for row in rows if row["phase"] != REST]  # that is a difference of times
    large = [row for row in judged if row["unknowns"] > BEYOND_CACHES]
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
        all(row["bytes [MB]"] > 0.0 and row["least [s]"] > 0.0 for row in judged),
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
        "How far is a solve from the limit that memory bandwidth sets?",
        f"Iterations take {over:.2g} times as long as memory needs to move their bytes "
        f"({mine[0]['unknowns']:,} unknowns); {reached} of {len(goals)} goals "
        f"{'is' if reached == 1 else 'are'} reached.",
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
        cautions=[
            f"The problem: {BENCHMARKS[str(first)]().title.lower()}. The floor is the time in "
            "which memory moves the bytes; small problems fit into caches, and may be faster.",
        ],
    )


def method(solved: Solved, cached_size: int) -> list[str]:
    """What is counted, in words."""
    threads = get_num_threads()
    return [
        "The floor of a phase is what it has to read and write once caches hold nothing of the "
        "matrices, over the fastest of the loops over plain arrays, of "
        f"{threads} thread{'s' * (threads > 1)}: sizes of the arrays themselves. Assembly reads "
        "nodes, cells and places, and writes each block once. Reduction reads nodes, cells, the "
        "pattern and the diagonal, and writes the diagonal and the way from linear elements. "
        "Set-up reads the stiffness of each level for its smoother and for the next level, and, in "
        f"the smoother's precision, {multigrid.LANCZOS_STEPS} times for its largest eigenvalue. "
        f"Iterations have {solved.passes} passes over the finest stiffness each, that of conjugate "
        "gradients in double precision.",
        "Assembly stays above its floor because blocks of an element are far apart: each is read "
        "and written once for every element that has it, and the pattern looks each pair of an "
        "element's nodes up twice. Every access counts these as if no cache held anything. "
        "Reduction goes through the cells in one thread, once for bodies and once for corners, "
        "while another clears what supports hold; blocks of the diagonal are far apart. The "
        "product for linear elements adds each block of a row for each parent of its node.",
        "Two steps of set-up are timed once more by themselves; all else is set-up less these. "
        "What stays in caches anyway, as the neighbours' displacements in a product, is not "
        "counted. "
        "Small problems fit into caches altogether, and may be faster than their floor.",
        f"Times as in caches are the least of a body of {cached_size:,} unknowns, times the ratio "
        "of unknowns: what a phase would take if memory were as fast as caches. Steps of Python "
        "are in it, which weigh more in a small body.",
    ]
