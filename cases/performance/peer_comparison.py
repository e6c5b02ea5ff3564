"""This project beside the tools that would otherwise be used: time, memory, accuracy."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from statistics import median
from typing import Any

from fe_drivetrain.cases import case
from fe_drivetrain.cases.performance.peer_answer import answer, time_caption
from fe_drivetrain.cases.performance.peer_goals import (
    goals,
    meshes_of,
    of_mesh,
    own,
    show_goals,
    significant,
)
from fe_drivetrain.cases.performance.peer_method import method, of_motions
from fe_drivetrain.cases.performance.peer_settings import OURS, plan_of, settings_of
from fe_drivetrain.cases.performance.peers import (
    BENCHMARKS,
    EQUAL,
    Benchmark,
    Outcome,
    Plan,
    Row,
    Variant,
    how_to_install,
    launch,
    parse,
    problems,
    rounds,
    write_problem,
)
from fe_drivetrain.common import Progress, interpreters, scratch_folder
from fe_drivetrain.comparison import growth_exponent
from fe_drivetrain.report import Cell, error_bars, formatted, trace
from fe_drivetrain.report.suite import Page, Record, Run

#: Unknowns of the first solve: enough that ``auto`` takes the solver that large problems take.
WARM_UP = 10_000

FINE = 30_000
"""Unknowns from which on circles are round to 1e-5, and times grow as a power of their number."""

COLOURS = {
    OURS: "#1f2933",
    "scikit_fem": "#56b4e9",
    "calculix": "#d55e00",
    "ngsolve": "#009e73",
    "sfepy": "#cc79a7",
    "felupe": "#e69f00",
    "dolfinx": "#0072b2",
    "mfem": "#8b5e3c",
    "kratos": "#7a3e9d",
    "fedoo": "#a0a000",
    "torch_fem": "#ee5533",
}
DASHES = ("solid", "dash", "dot", "dashdot", "longdash")
SYMBOLS = ("circle", "square", "diamond", "x", "triangle-up")


@case(
    "Speed and memory beside other finite-element tools, at equal error",
    source="Measured here: the same meshes, boundary conditions and answers for every tool",
    name="peers",
    alone="full",
    settings={
        "tools": "[this_project, scikit_fem.superlu, scikit_fem.pyamg, scikit_fem.mumps, "
        "scikit_fem.cholmod, calculix, ngsolve, sfepy.pardiso, felupe.pardiso, "
        "felupe.pardiso_own, dolfinx, mfem, kratos, fedoo, torch_fem] "
        "(quick [this_project.auto, scikit_fem.superlu])",
        "problems": "[shaft, assembly] (quick [shaft])",
        "sizes": "[10000, 50000, 110000, 300000, 1000000] (quick [10000])",
        "repetitions": "5 (quick 1; from 1 to 100)",
        "time_limit": "30 (from 1 to 86400)",
        "memory_limit": "12 (from 0.5 to 4096)",
        "threads": "2 (from 1 to 256)",
        "right_hand_sides": "1 (from 1 to 10)",
    },
)
def run(run: Run, page: Page) -> None:
    """Run every tool on every mesh in turns, and compare what they took at equal error."""
    page.seed = None
    settings = settings_of(run)
    plan = plan_of(settings)
    has_ours = any(str(name).partition(".")[0] == OURS for name in settings["tools"])
    variants = parse([*([] if has_ours else [OURS]), *settings["tools"]])
    benchmarks = [BENCHMARKS[name]() for name in settings["problems"]]
    with scratch_folder() as folder:
        warm_up = folder / "warm_up.npz"
        with run.step("tools: a first small run"):
            shaft = problems.of_size(problems.hollow_shaft(), WARM_UP, settings["right_hand_sides"])
            write_problem(shaft, warm_up)
            first = first_runs(variants, warm_up, plan, run.report)
        there = [(v, first[v][1]) for v in variants if first[v][0].status != "missing"]
        found = [on_meshes(run, b, there, warm_up, settings, plan) for b in benchmarks]
    references = [
        {n: rounds.judge_errors(of_mesh(rows, n)) for n in meshes_of(rows)} for rows in found
    ]
    for benchmark, rows in zip(benchmarks, found, strict=True):
        check(page, benchmark, rows)
        page.say(in_a_sentence(benchmark, rows))
    missing = sorted({v.tool_name for v, (o, _) in first.items() if o.status == "missing"})
    if missing:
        page.say(f"Not installed here: {', '.join(missing)}.")

    motions = settings["right_hand_sides"]
    compared = [
        row
        for benchmark, rows in zip(benchmarks, found, strict=True)
        for row in goals(benchmark, rows, motions)
    ]
    answer(page, benchmarks, found, compared)
    if compared:
        show_goals(page, compared, motions)
    page.section("Time at equal error")
    for benchmark, rows in zip(benchmarks, found, strict=True):
        show_time(page, benchmark, rows, plan)
    page.section("Memory")
    for benchmark, rows in zip(benchmarks, found, strict=True):
        show_memory(page, benchmark, rows)
    for benchmark, rows, known in zip(benchmarks, found, references, strict=True):
        page.section(benchmark.title)
        for n in meshes_of(rows):
            show_mesh(page, benchmark, of_mesh(rows, n), n, known[n])
    page.section("Tools")
    show_tools(page, first, plan)
    page.section("How it was measured")
    for text in [*method(plan), *of_motions(motions)]:
        page.text(text)
    for key, rows in zip(settings["problems"], found, strict=True):
        keep(page, key, rows)


def on_meshes(
    run: Run,
    benchmark: Benchmark,
    there: Sequence[tuple[Variant, str]],
    warm_up: Path,
    settings: dict[str, Any],
    plan: Plan,
) -> list[Row]:
    """Run the installed tools on every mesh of a benchmark."""
    rows: list[Row] = []
    problem_file = warm_up.with_name("problem.npz")
    for size in settings["sizes"]:
        with run.step("meshes"):
            problem = problems.of_size(benchmark, size, settings["right_hand_sides"])
            write_problem(problem, problem_file)
        unknowns = problem.n_unknowns
        del problem
        with run.step(f"{benchmark.title}: {unknowns:,} unknowns"):
            rows += rounds.run_rounds(
                there, problem_file, warm_up, unknowns, plan, rows, run.report
            )
    return rows


def keep(page: Page, key: str, rows: Sequence[Row]) -> None:
    """Keep the numbers of one benchmark for other programs."""
    page.data(
        key,
        [
            {
                "tool": str(r.variant),
                "unknowns": r.unknowns,
                "seconds": [f["seconds"] for f in r.found],
                "bytes": [f["peak_bytes"] for f in r.found],
                "stiffness": r.stiffness,
                "error": r.error,
                "trouble": r.trouble,
            }
            for r in rows
        ],
    )


def first_runs(
    variants: Sequence[Variant], warm_up: Path, plan: Plan, report: Progress
) -> dict[Variant, tuple[Outcome, str]]:
    """Run every tool once on the small problem: which are there, and in which Python."""
    found = {}
    for variant in variants:
        report(f"{variant.name}: a first small run")
        reasons: list[str] = []
        for interpreter in interpreters():
            outcome = launch(variant, warm_up, warm_up, plan.limits, interpreter)
            found[variant] = outcome, interpreter
            if outcome.status != "missing":
                break
            reasons.append(outcome.reason)
        else:
            # what this Python lacks says more than what the system's lacks, or the other way round
            every = "; ".join(dict.fromkeys(reasons))
            found[variant] = replace(outcome, reason=every), interpreter
    return found


def check(page: Page, benchmark: Benchmark, rows: Sequence[Row]) -> None:
    """The same answer from every direct solver, and the exact one where it is known."""
    for n in meshes_of(rows):
        here = of_mesh(rows, n)
        direct = [r for r in here if r.variant.kind == "direct" and r.variant.rule == "common"]
        errors = [r.error for r in direct if r.error is not None]
        peers = any(r.variant.tool != OURS for r in here)
        if len(errors) > 1 and peers and own(here):
            page.vanishes(
                f"{benchmark.title}, {n:,} unknowns: largest difference of a direct solver's "
                "stiffness from their median",
                max(errors),
                within=EQUAL,
                why="the same equations: six digits are asked for, round-off is less",
                source="the other tools, same mesh, same quadrature",
            )
    ours = [own(of_mesh(rows, n)) for n in meshes_of(rows)]
    done = [r for r in ours if r is not None and r.found]
    if ours and ours[0] is not None:
        page.holds(
            f"{benchmark.title}: this project answers on the coarsest mesh",
            ours[0] in done,
            why="without an answer of its own nothing else is compared",
            source="the limits of time and memory of this run",
        )
    if benchmark.exact is None or not done:
        return
    finest = max(done, key=lambda r: r.unknowns)
    assert finest.stiffness is not None
    fine = finest.unknowns >= FINE
    page.equals(
        f"{benchmark.title}, {finest.unknowns:,} unknowns: {benchmark.quantity}",
        finest.stiffness,
        benchmark.exact,
        within=1e-5 if fine else 1e-2,
        why="what the shape of the curved elements leaves, which falls with the fourth power of "
        "the angle of an element, a quarter of a radian at most on such a mesh; the solver's share "
        f"is below {small(EQUAL)}"
        if fine
        else "a parabola through three points of an arc of angle a leaves a^4 / 500 of its radius, "
        "and the stiffness goes with the fourth power of that: 1e-2 of six elements a turn, the "
        "fewest of any mesh",
        source="exact, G J / L",
        unit=benchmark.unit,
    )


def in_a_sentence(benchmark: Benchmark, rows: Sequence[Row]) -> str:
    """What this project and the fastest other took on every mesh, and how that grows."""
    parts, alone = [], all(row.variant.tool == OURS for row in rows)
    for n in meshes_of(rows):
        here = of_mesh(rows, n)
        ours, peer = own(here), rounds.fastest_peer(here)
        mine = "no answer" if ours is None or ours.seconds is None else f"{ours.seconds:.2g} s"
        other = "" if alone else ", no other in time"
        if peer is not None and peer.seconds is not None:
            other = f", the fastest other {peer.seconds:.2g} s ({peer.variant.name})"
        parts.append(f"{n:,} unknowns {mine}{other}")
    return f"{benchmark.title}, this project: {'; '.join(parts)}.{growth(rows)}"


def growth(rows: Sequence[Row]) -> str:
    """Exponents of this project's time and memory, from `FINE` on, and the most of it."""
    done = [
        (row.unknowns, row.seconds, row.bytes)
        for row in (own(of_mesh(rows, n)) for n in meshes_of(rows) if n >= FINE)
        if row is not None and row.seconds and row.bytes
    ]
    if len(done) < 2:
        return ""
    n, seconds, held = zip(*done, strict=True)
    return (
        f" From {min(n):,} to {max(n):,} unknowns time grows with the power "
        f"{growth_exponent(n, seconds):.2f} of their number and memory with "
        f"{growth_exponent(n, held):.2f}, up to {max(held) / 2**30:.2g} GiB."
    )


def by_mesh(
    page: Page, caption: str, rows: Sequence[Row], cell: Callable[[Row, int], Cell]
) -> None:
    """A table with a row for each tool and a column for each mesh."""
    meshes = meshes_of(rows)
    table: list[list[Cell]] = []
    for variant in dict.fromkeys(r.variant for r in rows):
        mine = {r.unknowns: r for r in rows if r.variant == variant}
        table.append([variant.name, *(cell(mine[n], n) if n in mine else None for n in meshes)])
    page.table(caption, table, ["tool and solver", *(f"{n:,} unknowns" for n in meshes)])


def show_time(page: Page, benchmark: Benchmark, rows: Sequence[Row], plan: Plan) -> None:
    """How many times this project's time each tool takes, where it reaches the same error."""
    ours = {n: own(of_mesh(rows, n)) for n in meshes_of(rows)}

    def ratio(row: Row, unknowns: int) -> Cell:
        mine = ours[unknowns]
        if mine is None or mine.seconds is None:
            return None
        if row.seconds is not None:
            if row.reaches:
                return float(f"{row.seconds / mine.seconds:.3g}")
            return f"error {small(row.error)}" if row.error is not None else None
        if row.min_seconds is not None:
            return f"> {row.min_seconds / mine.seconds:.2g}"
        return row.trouble

    by_mesh(
        page,
        f"{benchmark.title}: time as a multiple of this project's (auto), for solvers that leave "
        f"less than {small(EQUAL)} of the stiffness; > where a run was ended, or not begun, "
        f"because it would take over {plan.limits.seconds:g} s",
        rows,
        ratio,
    )
    show_chart(
        page,
        time_caption(benchmark),
        "time [s]",
        rows,
        lambda row: [f["seconds"] for f in row.found],
    )


def show_memory(page: Page, benchmark: Benchmark, rows: Sequence[Row]) -> None:
    """Peak memory of every tool by mesh."""
    by_mesh(
        page,
        f"{benchmark.title}: peak memory of the process [MiB], Python, libraries and mesh "
        "included; of CalculiX, ccx alone",
        rows,
        lambda row, _: None if row.bytes is None else round(row.bytes / 2**20),
    )
    show_chart(
        page,
        f"{benchmark.title}: peak memory",
        "peak memory [MiB]",
        rows,
        lambda row: [f["peak_bytes"] / 2**20 for f in row.found],
    )


def show_chart(
    page: Page,
    caption: str,
    axis: str,
    rows: Sequence[Row],
    values_of: Callable[[Row], list[float]],
) -> None:
    """A quantity of all runs against unknowns: a colour for each tool, a dash for each solver."""
    traces = []
    counts: dict[str, int] = {}
    for variant in dict.fromkeys(r.variant for r in rows):
        mine = [r for r in rows if r.variant == variant]
        shown = [(r, v) for r in mine if (v := values_of(r))]
        if not shown:
            continue
        place = counts.get(variant.tool, 0)
        counts[variant.tool] = place + 1
        symbol = SYMBOLS[place % len(SYMBOLS)]
        colour = COLOURS[variant.tool]
        traces.append(
            trace(
                variant.name,
                [r.unknowns for r, _ in shown],
                [median(v) for _, v in shown],
                mode="lines+markers",
                **error_bars("y", *([of(v) for _, v in shown] for of in (min, median, max))),
                line={
                    "color": colour,
                    "dash": DASHES[place % len(DASHES)],
                    "width": 3.5 if variant.tool == OURS and place == 0 else 1.7,
                },
                marker={
                    "color": colour,
                    "size": 9,
                    "symbol": [symbol if r.reaches else f"{symbol}-open" for r, _ in shown],
                },
            )
        )
    page.chart(caption, traces, "unknowns", axis, "xy")


def show_mesh(
    page: Page,
    benchmark: Benchmark,
    rows: Sequence[Row],
    unknowns: int,
    references: dict[str, float],
) -> None:
    """All that was measured on one mesh."""
    exact = benchmark.exact
    table = []
    for row in rows:
        times = [f["seconds"] for f in row.found]
        line = {
            "tool and solver": row.variant.name,
            "least [s]": significant(min(times, default=None)),
            "median [s]": significant(row.seconds),
            "most [s]": significant(max(times, default=None)),
            "runs": len(times),
            "mesh in [s]": None if row.loading is None else round(row.loading, 3),
            "assembly [s]": significant(row.step("assembly")),
            "solver [s]": significant(row.step("solve")),
            "iterations": row.found[0]["iterations"] if row.found else None,
            "error of the stiffness": significant(row.error, 2),
        }
        if exact is not None:
            error = None if row.stiffness is None else row.stiffness / exact - 1.0
            line["from the exact one"] = significant(error, 2)
        table.append({**line, "remarks": "; ".join(remarks(row)) or None})
    known = ", ".join(
        f"{value:.9g} {benchmark.unit} by the "
        f"{'common quadrature' if rule == 'common' else f'rule of {rule}'}"
        for rule, value in references.items()
    )
    page.table(
        f"{unknowns:,} unknowns: time from the mesh in memory to the stiffness, of all runs; "
        f"medians of its steps; the solver's error, against {known or 'no reference'}",
        table,
    )


def remarks(row: Row) -> list[str]:
    """What else to know of a row."""
    found = [row.trouble] if row.trouble else []
    if row.variant.rule != "common":
        found.append(f"{row.variant.rule} of quadrature")
    if row.error is not None and not row.reaches:
        found.append(f"does not reach {small(EQUAL)}")
    if row.found and row.variant.kind == "chosen":
        found.append(f"took {row.found[0]['notes']['method']}")
    return found


def small(value: float) -> str:
    """A small number in words, as the page writes numbers."""
    return formatted(float(value), 1)


def show_tools(page: Page, first: dict[Variant, tuple[Outcome, str]], plan: Plan) -> None:
    """What is installed, and what it takes to start it; how to install what is not."""
    table: list[Record] = []
    missing: list[Record] = []
    for variant, (outcome, _) in first.items():
        if outcome.status == "missing":
            missing.append(
                {
                    "tool and solver": variant.name,
                    "what is missing": outcome.reason,
                    "how to install it": how_to_install(variant.tool),
                }
            )
            continue
        found = outcome.found
        notes = found.get("notes", {})
        processes = notes.get("processes")
        cores = notes.get("threads", plan.limits.threads)
        if processes:
            cores = f"{processes} process{'es' if processes > 1 else ''}"
        baseline = found.get("baseline_bytes")
        table.append(
            {
                "tool and solver": variant.name,
                "version": found.get("version", ""),
                "threads": str(cores),
                "import [s]": significant(found.get("import_seconds")),
                "first solve [s]": significant(found.get("warm_up_seconds")),
                "memory after it [MiB]": round(baseline / 2**20) if baseline else None,
                "remarks": outcome.reason or None,
            }
        )
    page.table(
        "What each tool takes before the clock starts; the first solve, of about "
        f"{WARM_UP:,} displacements, compiles and loads what is imported late",
        table,
        list(table[0]) if table else ["tool and solver"],
    )
    if missing:
        page.table("Not installed here", missing)
