"""This project beside the tools that would otherwise be used: time, memory, accuracy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fe_drivetrain.cases.performance.problems import (
        Benchmark,
    )
    from fe_drivetrain.cases.performance.rounds import (
        Plan,
        Row,
    )
    from fe_drivetrain.cases.performance.tools.launch import (
        Outcome,
        Variant,
    )

SIZES = (10_000, 50_000, 110_000, 300_000, 1_000_000)
QUICK_SIZES = (10_000,)
WARM_UP = 4_000

JUDGED_FROM = 30_000
"""Unknowns from which on this project shall be the fastest."""

OURS = "this_project"

DEFAULT_TOOLS = (
    OURS,
    "scikit_fem.superlu",
    "scikit_fem.pyamg",
    "calculix",
    "ngsolve",
    "sfepy.pardiso",
    "felupe.pardiso",
    "felupe.pardiso_own",
    "dolfinx",
)
"""With the solvers that serve each tool best; the others by ``--set tools=[...]``."""

DEFAULTS: dict[str, Any] = {
    "tools": list(DEFAULT_TOOLS),
    "problems": ["shaft", "assembly"],
    "sizes": list(SIZES),
    "repetitions": 5,
    "budget": 6.0,
    "time_limit": 30.0,
    "memory_limit": 12.0,
    "threads": 2,
}

QUICK: dict[str, Any] = {
    "tools": [f"{OURS}.auto", "scikit_fem.superlu"],
    "problems": ["shaft"],
    "sizes": list(QUICK_SIZES),
    "repetitions": 1,
}

COLOURS = {
    OURS: "#1f2933",
    "scikit_fem": "#56b4e9",
    "calculix": "#d55e00",
    "ngsolve": "#009e73",
    "sfepy": "#cc79a7",
    "felupe": "#e69f00",
    "dolfinx": "#0072b2",
}
DASHES = ("solid", "dash", "dot", "dashdot")
SYMBOLS = ("circle", "square", "diamond", "x")


def run(run: Run) -> Any:
    """Run every tool on every mesh in turns, and compare what they took at equal error."""
    import tempfile
    from pathlib import Path

    from fe_drivetrain.cases.performance import (
        problems,
        rounds,
    )
    from fe_drivetrain.cases.performance.tools.launch import (
        parse,
    )
    from fe_drivetrain.cases.performance.tools.runner import (
        write_problem,
    )

    settings = settings_of(run)
    plan = plan_of(settings)
    variants = parse([OURS, *settings["tools"]]) if not _has_ours(settings) else None
    variants = variants or parse(settings["tools"])
    rows: dict[str, list[Row]] = {}
    benchmarks = {name: problems.BENCHMARKS[name]() for name in settings["problems"]}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        warm_up, problem_file = folder / "warm_up.npz", folder / "problem.npz"
        with run.step("tools: a first small run"):
            write_problem(problems.of_size(problems.hollow_shaft(), WARM_UP), warm_up)
            first = first_runs(variants, warm_up, plan, run.report)
        there = [(v, first[v][1]) for v in variants if first[v][0].status != "missing"]
        for key, benchmark in benchmarks.items():
            rows[key] = []
            for size in settings["sizes"]:
                with run.step("meshes"):
                    problem = problems.of_size(benchmark, size)
                    write_problem(problem, problem_file)
                unknowns = problem.n_unknowns
                del problem
                with run.step(f"{benchmark.title}: {unknowns:,} unknowns"):
                    rows[key] += rounds.run_rounds(
                        there, problem_file, warm_up, unknowns, plan, rows[key], run.report
                    )
    references = {
        key: {n: rounds.judge_errors(of_mesh(found, n)) for n in meshes_of(found)}
        for key, found in rows.items()
    }
    return results_of(run, settings, plan, benchmarks, rows, references, first)


def settings_of(run: Run) -> dict[str, Any]:
    """The user's settings on top of the defaults.

    Raises
    ------
    InputError
        A setting is unknown or out of its range.
    """
    from fe_drivetrain.cases.performance.problems import (
        BENCHMARKS,
    )
    from fe_drivetrain.cases.performance.tools.launch import (
        TOOLS,
        parse,
    )
    from fe_drivetrain.common import InputError

    quick = QUICK if run.quick else {}
    unknown = sorted(set(run.settings) - set(DEFAULTS))
    if unknown:
        raise InputError(f"setting {unknown[0]!r} is unknown: use one of {', '.join(DEFAULTS)}")
    settings = DEFAULTS | quick | dict(run.settings)
    for key in ("tools", "problems", "sizes"):
        value = settings[key]
        settings[key] = list(value) if isinstance(value, list | tuple) else [value]
        if not settings[key]:
            raise InputError(f"{key} is empty: name one at the least")
    try:
        parse(list(map(str, settings["tools"])))
    except KeyError as error:
        raise InputError(
            f"tools: {error.args[0]!r} is unknown: use some of {', '.join(TOOLS)}, all solvers of "
            "a tool, or one as in ngsolve.multigrid"
        ) from error
    for name in settings["problems"]:
        if name not in BENCHMARKS:
            raise InputError(f"problems: {name!r} is unknown: use some of {', '.join(BENCHMARKS)}")
    for size in settings["sizes"]:
        if isinstance(size, bool) or not isinstance(size, int) or not 1000 <= size <= 5_000_000:
            raise InputError(f"sizes: {size!r} must be a whole number from 1000 to 5000000")
    settings["sizes"] = sorted(set(settings["sizes"]))
    ranges = {
        "repetitions": (1, 100),
        "budget": (0.0, 3600.0),
        "time_limit": (1.0, 86400.0),
        "memory_limit": (0.5, 4096.0),
        "threads": (1, 256),
    }
    for key, (low, high) in ranges.items():
        value = settings[key]
        whole = key in ("repetitions", "threads")
        kind = int if whole else int | float
        if isinstance(value, bool) or not isinstance(value, kind) or not low <= value <= high:
            raise InputError(
                f"{key} = {value!r} must be a {'whole ' if whole else ''}number from {low:g} to "
                f"{high:g}"
            )
    return settings


def plan_of(settings: dict[str, Any]) -> Plan:
    """Repetitions and limits."""
    from fe_drivetrain.cases.performance.rounds import (
        Plan,
    )
    from fe_drivetrain.cases.performance.tools.launch import (
        Limits,
    )

    limits = Limits(
        float(settings["time_limit"]), settings["memory_limit"] * 2.0**30, settings["threads"]
    )
    return Plan(settings["repetitions"], float(settings["budget"]), limits)


def first_runs(
    variants: Sequence[Variant], warm_up: Any, plan: Plan, report: Any
) -> dict[Variant, tuple[Outcome, str]]:
    """Run every tool once on the small problem: which are there, and in which Python."""
    from fe_drivetrain.cases.performance.tools.launch import (
        interpreters,
        launch,
    )

    found = {}
    for variant in variants:
        report(f"{variant.name}: a first small run")
        for interpreter in interpreters():
            outcome = launch(variant, warm_up, warm_up, plan.limits, interpreter)
            if variant not in found or outcome.status != "missing":
                found[variant] = outcome, interpreter
            if outcome.status != "missing":
                break
    return found


def meshes_of(rows: Sequence[Row]) -> list[int]:
    """Numbers of unknowns, ascending."""
    return sorted({row.unknowns for row in rows})


def of_mesh(rows: Sequence[Row], unknowns: int) -> list[Row]:
    """The rows of one mesh."""
    return [row for row in rows if row.unknowns == unknowns]


def _has_ours(settings: dict[str, Any]) -> bool:
    return any(str(name).partition(".")[0] == OURS for name in settings["tools"])


def results_of(
    run: Run,
    settings: dict[str, Any],
    plan: Plan,
    benchmarks: dict[str, Benchmark],
    rows: dict[str, list[Row]],
    references: dict[str, dict[int, dict[str, float]]],
    first: dict[Variant, tuple[Outcome, str]],
) -> Any:
    """The page."""
    from fe_drivetrain.report import Section, Text

    verdicts = [
        verdict for key, b in benchmarks.items() for verdict in verdicts_of(b, rows[key], plan)
    ]
    comparison: list[Any] = []
    memory: list[Any] = []
    for key, benchmark in benchmarks.items():
        comparison += [ratio_table(benchmark, rows[key], plan), time_chart(benchmark, rows[key])]
        memory += [memory_table(benchmark, rows[key]), memory_chart(benchmark, rows[key])]
    missing = sorted({v.tool_name for v, (o, _) in first.items() if o.status == "missing"})
    sections = [
        Section(title="Time at equal error", items=comparison),
        Section(title="Memory", items=memory),
        *(
            Section(
                title=benchmark.title,
                items=[
                    mesh_table(benchmark, of_mesh(rows[key], n), n, references[key][n])
                    for n in meshes_of(rows[key])
                ],
            )
            for key, benchmark in benchmarks.items()
        ),
        Section(title="Tools", items=[tool_table(first, plan), *missing_tables(first)]),
        Section(title="How it was measured", items=[Text(text=text) for text in method(plan)]),
    ]
    return CASE.results(
        run,
        seed=None,
        summary=summary_of(benchmarks, rows, missing),
        verdicts=verdicts,
        sections=sections,
        figures={
            key: [
                {
                    "tool": str(r.variant),
                    "unknowns": r.unknowns,
                    "seconds": [f["seconds"] for f in r.found],
                    "bytes": [f["peak_bytes"] for f in r.found],
                    "stiffness": r.stiffness,
                    "error": r.error,
                    "trouble": r.trouble,
                }
                for r in found
            ]
            for key, found in rows.items()
        },
    )


def verdicts_of(benchmark: Benchmark, rows: Sequence[Row], plan: Plan) -> list[Any]:
    """Faster than any other, with less memory than any direct one; the same answer."""
    from fe_drivetrain.cases.performance import (
        rounds,
    )
    from fe_drivetrain.report import judge

    found = []
    for n in meshes_of(rows):
        here = of_mesh(rows, n)
        ours = rounds.of_tool(here, OURS, "auto")
        peers = [r for r in here if r.variant.tool != OURS]
        if ours is None or not peers:
            continue
        label = f"{benchmark.title}, {n:,} unknowns"
        direct = [r for r in here if r.variant.kind == "direct" and r.variant.rule == "common"]
        errors = [r.error for r in direct if r.error is not None]
        if len(errors) > 1:
            found.append(
                judge(
                    f"{label}: largest difference of a direct solver's stiffness from their median",
                    max(errors),
                    0.0,
                    tolerance=rounds.EQUAL,
                    relative=False,
                    source="the other tools, same mesh, same quadrature",
                    reason="the same equations: six digits are asked for, round-off is less",
                )
            )
        if n < JUDGED_FROM:
            continue
        found.append(_time_verdict(label, ours, here, plan))
        lean = rounds.leanest_direct_peer(here)
        if lean is not None and lean.bytes:
            found.append(
                judge(
                    f"{label}: peak memory of this project as a share of the leanest direct peer's "
                    f"({lean.variant.name})",
                    ours.bytes / lean.bytes if ours.bytes else float("nan"),
                    0.0,
                    tolerance=1.0,
                    relative=False,
                    source="measured in this run",
                    reason="less memory than any direct solver is the goal",
                )
            )
    exact = _exact_verdict(benchmark, rows)
    return [*found, *([exact] if exact else [])]


def _time_verdict(label: str, ours: Row, here: Sequence[Row], plan: Plan) -> Any:
    from fe_drivetrain.cases.performance import (
        rounds,
    )
    from fe_drivetrain.report import judge

    peer = rounds.fastest_peer(here)
    if peer is not None and peer.seconds:
        name, least = peer.variant.name, peer.seconds
    else:
        name, least = f"none is below {plan.limits.seconds:g} s", plan.limits.seconds
    share = ours.seconds / least if ours.seconds and ours.reaches else float("nan")
    return judge(
        f"{label}: time of this project as a share of the fastest peer's ({name})",
        share,
        0.0,
        tolerance=1.0,
        relative=False,
        source="medians of this run, at a stiffness within 1e-6",
        reason="faster than each of them is the goal",
    )


def _exact_verdict(benchmark: Benchmark, rows: Sequence[Row]) -> Any:
    from fe_drivetrain.cases.performance import (
        rounds,
    )
    from fe_drivetrain.report import judge

    done = [r for r in rows if r.variant.tool == OURS and r.variant.key == "auto" and r.found]
    if benchmark.exact is None or not done:
        return None
    finest = max(done, key=lambda r: r.unknowns)
    assert finest.stiffness is not None
    return judge(
        f"{benchmark.title}, {finest.unknowns:,} unknowns: {benchmark.quantity}",
        finest.stiffness,
        benchmark.exact,
        tolerance=1e-5 if finest.unknowns >= JUDGED_FROM else 1e-2,
        source="exact, G J / L",
        reason="what the shape of the curved elements leaves; the solver's share is "
        f"below {_small(rounds.EQUAL)}",
        unit=benchmark.unit,
    )


def summary_of(
    benchmarks: dict[str, Benchmark], rows: dict[str, list[Row]], missing: Sequence[str]
) -> list[str]:
    """The answer in a few sentences."""
    from fe_drivetrain.cases.performance import (
        rounds,
    )

    sentences = []
    for key, benchmark in benchmarks.items():
        parts = []
        for n in meshes_of(rows[key]):
            here = of_mesh(rows[key], n)
            ours, peer = rounds.of_tool(here, OURS, "auto"), rounds.fastest_peer(here)
            mine = "no answer" if ours is None or ours.seconds is None else f"{ours.seconds:.2g} s"
            other = "no other in time"
            if peer is not None and peer.seconds is not None:
                other = f"the fastest other {peer.seconds:.2g} s ({peer.variant.name})"
            parts.append(f"{n:,} unknowns {mine}, {other}")
        sentences.append(f"{benchmark.title}, this project: {'; '.join(parts)}.")
    if missing:
        sentences.append(f"Not installed here: {', '.join(missing)}.")
    return sentences


def ratio_table(benchmark: Benchmark, rows: Sequence[Row], plan: Plan) -> Any:
    """How many times this project's time each tool takes, where it reaches the same error."""
    from fe_drivetrain.cases.performance import (
        rounds,
    )
    from fe_drivetrain.report import Table

    meshes = meshes_of(rows)
    ours = {n: rounds.of_tool(of_mesh(rows, n), OURS, "auto") for n in meshes}
    table: list[list[Any]] = []
    for variant in dict.fromkeys(r.variant for r in rows):
        line: list[Any] = [variant.name]
        for n in meshes:
            row = rounds.of_tool(of_mesh(rows, n), variant.tool, variant.key)
            mine = ours[n]
            line.append(_ratio(row, mine.seconds if mine else None))
        table.append(line)
    return Table(
        caption=f"{benchmark.title}: time as a multiple of this project's (auto), for solvers that "
        f"leave less than {_small(rounds.EQUAL)} of the stiffness; > where a run was ended, or not "
        f"begun, because it would take over {plan.limits.seconds:g} s",
        columns=["tool and solver", *(f"{n:,} unknowns" for n in meshes)],
        rows=table,
    )


def _ratio(row: Row | None, ours: float | None) -> Any:
    if row is None or ours is None:
        return None
    if row.seconds is not None:
        if row.reaches:
            return float(f"{row.seconds / ours:.3g}")
        return f"error {_small(row.error)}" if row.error is not None else None
    if row.least_seconds is not None:
        return f"> {row.least_seconds / ours:.2g}"
    return row.trouble


def mesh_table(
    benchmark: Benchmark, rows: Sequence[Row], unknowns: int, references: dict[str, float]
) -> Any:
    """All that was measured on one mesh."""

    from fe_drivetrain.report import Table

    exact = benchmark.exact
    table: list[list[Any]] = []
    for row in rows:
        times = [f["seconds"] for f in row.found]
        spread = round(100 * (max(times) - min(times)) / max(times)) if len(times) > 1 else None
        line = [
            row.variant.name,
            _rounded(row.seconds),
            spread,
            len(times),
            None if row.loading is None else round(row.loading, 3),
            _rounded(row.step("assembly")),
            _rounded(row.step("solve")),
            row.found[0]["iterations"] if row.found else None,
            _rounded(row.error, 2),
        ]
        if exact is not None:
            off = None if row.stiffness is None else row.stiffness / exact - 1.0
            line.append(_rounded(off, 2))
        table.append([*line, "; ".join(_remarks(row)) or None])
    known = ", ".join(
        f"{value:.9g} {benchmark.unit} by the {_rule_in_words(rule)}"
        for rule, value in references.items()
    )
    columns = [
        "tool and solver",
        "time [s]",
        "spread [%]",
        "runs",
        "mesh in [s]",
        "assembly [s]",
        "solver [s]",
        "iterations",
        "error of the stiffness",
    ]
    if exact is not None:
        columns.append("from the exact one")
    return Table(
        caption=f"{unknowns:,} unknowns: medians, and how far the fastest run is below the slowest;"
        f" the solver's error, against {known or 'no reference'}",
        columns=[*columns, "remarks"],
        rows=table,
    )


def _remarks(row: Row) -> list[str]:
    """What else to know of a row."""
    from fe_drivetrain.cases.performance.rounds import (
        EQUAL,
    )

    remarks = [row.trouble] if row.trouble else []
    if row.variant.rule != "common":
        remarks.append(f"{row.variant.rule} of quadrature")
    if row.error is not None and not row.reaches:
        remarks.append(f"does not reach {_small(EQUAL)}")
    if row.found and row.variant.kind == "chosen":
        remarks.append(f"took {row.found[0]['notes']['method']}")
    return remarks


def _rule_in_words(rule: str) -> str:
    return "common quadrature" if rule == "common" else f"rule of {rule}"


def _rounded(value: float | None, digits: int = 3) -> float | None:
    return None if value is None else float(f"{value:.{digits}g}")


def _small(value: float) -> str:
    """A small number in words, as the page writes numbers."""
    from fe_drivetrain.report import formatted

    return formatted(float(value), 1)


def memory_table(benchmark: Benchmark, rows: Sequence[Row]) -> Any:
    """Peak memory of every tool by mesh."""
    from fe_drivetrain.cases.performance import (
        rounds,
    )
    from fe_drivetrain.report import Table

    meshes = meshes_of(rows)
    table: list[list[Any]] = []
    for variant in dict.fromkeys(r.variant for r in rows):
        line: list[Any] = [variant.name]
        for n in meshes:
            row = rounds.of_tool(of_mesh(rows, n), variant.tool, variant.key)
            line.append(None if row is None or row.bytes is None else round(row.bytes / 2**20))
        table.append(line)
    return Table(
        caption=f"{benchmark.title}: peak memory of the process [MiB], Python, libraries and mesh "
        "included; of CalculiX, ccx alone",
        columns=["tool and solver", *(f"{n:,} unknowns" for n in meshes)],
        rows=table,
    )


def time_chart(benchmark: Benchmark, rows: Sequence[Row]) -> Any:
    """Time against unknowns."""
    from fe_drivetrain.cases.performance.rounds import (
        EQUAL,
    )

    return _chart(
        f"{benchmark.title}: time from the mesh in memory to the stiffness; hollow markers leave "
        f"more than {_small(EQUAL)} of the stiffness",
        "time [s]",
        rows,
        lambda row: row.seconds,
    )


def memory_chart(benchmark: Benchmark, rows: Sequence[Row]) -> Any:
    """Peak memory against unknowns."""
    return _chart(
        f"{benchmark.title}: peak memory",
        "peak memory [MiB]",
        rows,
        lambda row: None if row.bytes is None else row.bytes / 2**20,
    )


def _chart(caption: str, axis: str, rows: Sequence[Row], value: Any) -> Any:
    from fe_drivetrain.report import Chart

    traces = []
    counts: dict[str, int] = {}
    for variant in dict.fromkeys(r.variant for r in rows):
        mine = [r for r in rows if r.variant == variant and value(r) is not None]
        if not mine:
            continue
        place = counts.get(variant.tool, 0)
        counts[variant.tool] = place + 1
        symbol = SYMBOLS[place % len(SYMBOLS)]
        ours = variant.tool == OURS
        traces.append(
            {
                "type": "scatter",
                "mode": "lines+markers",
                "name": variant.name,
                "x": [r.unknowns for r in mine],
                "y": [_rounded(value(r), 4) for r in mine],
                "line": {
                    "color": COLOURS[variant.tool],
                    "dash": DASHES[place % len(DASHES)],
                    "width": 3.5 if ours and place == 0 else 1.7,
                },
                "marker": {
                    "color": COLOURS[variant.tool],
                    "size": 9,
                    "symbol": [symbol if r.reaches else f"{symbol}-open" for r in mine],
                },
            }
        )
    return Chart(
        caption=caption,
        figure={
            "data": traces,
            "layout": {
                "height": 640,
                "xaxis": {"title": {"text": "unknowns"}, "type": "log", "dtick": "D2"},
                "yaxis": {"title": {"text": axis}, "type": "log", "dtick": "D2"},
            },
        },
    )


def tool_table(first: dict[Variant, tuple[Outcome, str]], plan: Plan) -> Any:
    """What is installed, and what it takes to start it."""
    from fe_drivetrain.report import Table

    table: list[list[Any]] = []
    for variant, (outcome, _) in first.items():
        if outcome.status == "missing":
            continue
        found = outcome.found
        notes = found.get("notes", {})
        processes = notes.get("processes")
        cores = notes.get("threads", plan.limits.threads)
        if processes:
            cores = f"{processes} process{'es' if processes > 1 else ''}"
        table.append(
            [
                variant.name,
                found.get("version", ""),
                str(cores),
                _rounded(found.get("import_seconds")),
                _rounded(found.get("warm_up_seconds")),
                round(found["baseline_bytes"] / 2**20) if found.get("baseline_bytes") else None,
                outcome.reason or None,
            ]
        )
    return Table(
        caption="What each tool takes before the clock starts; the first solve, of about "
        f"{WARM_UP:,} displacements, compiles and loads what is imported late",
        columns=[
            "tool and solver",
            "version",
            "threads",
            "import [s]",
            "first solve [s]",
            "memory after it [MiB]",
            "remarks",
        ],
        rows=table,
    )


def missing_tables(first: dict[Variant, tuple[Outcome, str]]) -> list[Any]:
    """How to install what is not there."""
    from fe_drivetrain.cases.performance.tools.launch import (
        how_to_install,
    )
    from fe_drivetrain.report import Table

    rows: list[list[Any]] = [
        [variant.name, outcome.reason, how_to_install(variant.tool)]
        for variant, (outcome, _) in first.items()
        if outcome.status == "missing"
    ]
    if not rows:
        return []
    return [
        Table(
            caption="Not installed here",
            columns=["tool and solver", "what is missing", "how to install it"],
            rows=rows,
        )
    ]


def method(plan: Plan) -> list[str]:
    """How it was measured."""
    limits = plan.limits
    return [
        "All tools get the same curved ten-node tetrahedra, materials and prescribed "
        "displacements: one face held, all nodes of another moved as a rigid body. The answer is "
        "the stiffness uᵀKu, twice the strain energy, at unit motion.",
        "The clock runs from the mesh in memory, in each tool's own form, to the stiffness: "
        "assembly, boundary conditions, solver, energy. Imports and taking the mesh in, shown "
        "beside it, are left out for all alike. CalculiX reads a deck instead; its clock starts "
        "when it says that its step begins, so reading is left out for it too.",
        f"Each run is a fresh process, which first solves a small problem. Tools take turns, so "
        f"that what else the machine does hits all alike. Up to {plan.repetitions} runs, fewer "
        f"where they would take over {plan.budget:g} s together; medians are shown. A run over "
        f"{limits.seconds:g} s or {limits.bytes / 2**30:g} GiB is ended, and larger meshes are not "
        "begun where a power law through the last two, at least linear, says that they would be.",
        f"Every tool is given {limits.threads} threads, dolfinx as many MPI processes of one "
        "thread each.",
        "With its displacements prescribed a solid's energy is least at the solution, so a "
        "solver's error adds to the stiffness. The reference of each mesh is the median of the "
        "direct solvers, or the least of all where none came to an end.",
        "Quadrature is part of the equations, so tools share a rule where they take one: eleven "
        "points of degree 4, scikit-fem's. CalculiX has four points and no choice; NGSolve and "
        "FElupe would take four by themselves, and are shown with both. The two rules differ by "
        "more than 1e-6 on coarse meshes, which is why errors are against the reference of the "
        "same rule.",
        "Iterative solvers stop at the loosest power of ten that leaves less than 1e-6 of the "
        "stiffness on every mesh here. That of CalculiX cannot be set in its deck: its own stop "
        "leaves what the tables show. With Newton's corrections is a way round: a step of large "
        "displacements at 1e-8 of the motion, whose every correction goes through the iterative "
        "solver again until the forces are balanced to 1e-7.",
        "SfePy has tetrahedra with straight edges only. It is given the curved nodes for its "
        "field and its mapping; the assembly stays its own.",
    ]


CASE = Case(
    name="performance/peers",
    title="Speed and memory beside other finite-element tools, at equal error",
    source="Measured here: the same meshes, boundary conditions and answers for every tool",
    run=run,
    alone=True,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
