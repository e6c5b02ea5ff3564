"""The answer of the comparison with other tools: the ratio against the fastest of them."""

from collections.abc import Sequence
from typing import Any

from fe_drivetrain.cases.performance.peer_goals import FASTER, meshes_of, of_mesh, own
from fe_drivetrain.cases.performance.peers import EQUAL, Benchmark, Row
from fe_drivetrain.report import formatted
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record

RATIO = "its time over ours"


def time_caption(benchmark: Benchmark) -> str:
    """Caption of the chart of times of a benchmark."""
    return (
        f"{benchmark.title}: time from the mesh in memory to the stiffness; bars: all runs; hollow "
        f"markers leave more than {formatted(float(EQUAL), 1)} of the stiffness"
    )


def answer(
    page: Page,
    benchmarks: Sequence[Benchmark],
    found: Sequence[list[Row]],
    compared: Sequence[Record],
) -> None:
    """State how many times as fast as the fastest other tool this project is, and where not."""
    known = [row for row in compared if row[RATIO] is not None]
    figures = [] if not known else ratios(page, known)
    for benchmark, rows in list(zip(benchmarks, found, strict=True))[:2]:
        figures += at_largest(page, benchmark, rows)
    page.answer(
        "How fast is this project beside other finite-element tools, at equal error?",
        verdict(known) or alone(benchmarks[0], found[0]),
        figures[:6],
        # a chart of one point becomes a sentence
        hero=time_caption(benchmarks[0]) if sum(bool(row.found) for row in found[0]) > 1 else "",
        cautions=[
            "Each tool is used as its documentation shows, with the same threads; others can be "
            "tuned further.",
            "Times are without meshing, imports and compiling.",
        ],
    )


def verdict(known: Sequence[Record]) -> str:
    """The least and the largest ratio, and the tool that is nearest or wins; empty without any."""
    if not known:
        return ""
    least = min(known, key=lambda row: float(row[RATIO]))
    every = [float(row[RATIO]) for row in known]
    low, high = value_text(min(every)), value_text(max(every))
    times = f"{low} times" if low == high else f"{low} to {high} times"
    name, unknowns = short(str(least["fastest other"])), f"{int(least['unknowns']):,}"
    nearest = "no other answers in time" if name.startswith("none") else f"{name} comes nearest,"
    if float(least[RATIO]) < 1.0:
        ours = sum(float(row[RATIO]) >= 1.0 for row in known)
        return (
            f"At equal error this project is fastest on {ours} of {len(known)} meshes; {name} wins "
            f"at {unknowns} unknowns, by {1 / float(least[RATIO]):.2g} times."
        )
    return (
        f"At equal error this project is {times} as fast as the fastest other tool; {nearest} at "
        f"{unknowns} unknowns."
    )


def short(name: str) -> str:
    """A tool without its solver."""
    return name.partition(":")[0]


def alone(benchmark: Benchmark, rows: Sequence[Row]) -> str:
    """What this project took where no other tool was compared."""
    for n in reversed(meshes_of(rows)):
        ours = own(of_mesh(rows, n))
        if ours is not None and ours.seconds is not None:
            return (
                f"{benchmark.title}: {n:,} unknowns take {value_text(ours.seconds, 's')} here; no "
                "other tool was compared at equal error."
            )
    return f"{benchmark.title}: none of {len(rows)} runs came to an end."


def ratios(page: Page, known: Sequence[Record]) -> list[KeyFigure]:
    """The least ratio of all meshes, and of memory that of the largest mesh."""
    least = min(known, key=lambda row: float(row[RATIO]))
    largest = max(known, key=lambda row: int(row["unknowns"]))
    goal = float(least["goal, at least"])
    figures = [
        page.value(
            f"time of {short(least['fastest other'])} over ours, {least['unknowns']:,} unknowns",
            float(least[RATIO]),
            beside=goal,
            by="goal",
        ),
        page.value(
            f"meshes on which ours is at least {FASTER:g} times as fast as every other",
            sum(row["reached"] == "yes" for row in known),
            beside=len(known),
            by="all",
        ),
    ]
    memory: Any = largest["its peak memory over ours"]
    if memory is not None:
        name = f"memory of {short(largest['leanest direct other'])} over ours"
        figures.append(page.value(name, float(memory)))
    return figures


def at_largest(page: Page, benchmark: Benchmark, rows: Sequence[Row]) -> list[KeyFigure]:
    """Time and memory of this project on the largest mesh that it solved."""
    done = [
        row
        for row in (own(of_mesh(rows, n)) for n in meshes_of(rows))
        if row is not None and row.found
    ]
    if not done:
        return []
    last = done[-1]
    what = f"{benchmark.title}, {last.unknowns:,} unknowns"
    return [
        page.value(f"{what}: time [s]", last.seconds or 0.0),
        page.value(f"{what}: peak memory [GiB]", (last.bytes or 0) / 2**30),
    ]
