"""A wind farm's years of samples, counted in pieces on all workers and as one stream on one."""

import time
from collections.abc import Iterator
from functools import partial
from importlib.util import find_spec
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import (
    ExactSum,
    Floats,
    MissingToolError,
    Times,
    cores,
    exact_sum,
    peak_memory,
    pool,
    timed_runs,
)
from fe_drivetrain.report import bars, trace
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.histories import (
    Count,
    Counting,
    counted_histories,
    piece,
    streamed_cycles,
)

TURBINES = 4
#: Samples of all turbines, of a full and a quick run; of 20 turbines at 20 Hz in 8 years.
SAMPLES, QUICK, FARM = 1_000_000_000, 8_000_000, 1e11
PIECE = 1 << 20
COUNTING = Counting(-5, (4.0, 10.0))
STEP = 0.05  # s
BOTH = "Time to count all samples, in pieces and in one stream; bars: least and most of all runs"
PIECES, STREAM = "in pieces, with levels", "in one stream, cycles and sums alone"
#: Workers that all samples of a farm are extrapolated to.
MANY = (2, 16, 128, 1024)


def made(turbine: int, number: int, size: int) -> Floats:
    """Samples of a piece: noise with a slow part, and 3P; the same wherever they are made."""
    noise = np.random.default_rng(turbine).standard_normal(PIECE, dtype=np.float32)[:size]
    slow = np.random.default_rng([turbine, number]).standard_normal()
    at = STEP * np.arange(number * PIECE, number * PIECE + size)
    return np.asarray(noise + 5.0 + slow + 0.5 * np.sin(2 * np.pi * 0.6 * at), dtype=np.float64)


def sizes(samples: int) -> list[int]:
    """Sizes of the pieces of a turbine."""
    return [min(PIECE, samples - start) for start in range(0, samples, PIECE)]


@case(
    "A wind farm's years: cycles, damage and load duration counted in pieces",
    source="ASTM E1049-85 (2017), 5.4.4, over each whole history in one stream",
    settings={
        "samples": "1000000000 (quick 8000000; from 4)",
        "repeats": "5 (quick 1; from 1)",
    },
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Count made histories both ways, several times; nothing may differ."""
    samples = run.count("samples", QUICK if run.quick else SAMPLES, least=TURBINES)
    if find_spec("resource") is None:
        raise MissingToolError(
            "this system does not say what memory its processes have taken: run it on Linux"
        )
    each = samples // TURBINES
    piece(np.arange(4.0), COUNTING)  # compiled code is loaded
    with pool(cores()) as found_workers:
        workers = found_workers.count
    repeats = run.count("repeats", 1 if run.quick else 5)
    count = len(sizes(each))
    with run.step("in pieces"):
        own = time.process_time()
        found, times = timed_runs(partial(counted_in_pieces, run, each), repeats)
        apart, own = times.median, (time.process_time() - own) / repeats
    import resource  # which Windows does not have

    memory = {
        "of this process": (peak_memory() or np.nan) / 1e6,
        "of a local worker": resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e3,
    }
    with run.step("in one stream"):
        (cycles, damage), streamed = timed_runs(lambda: in_one_stream(each), repeats)
    check(page, found, cycles, damage, TURBINES * each)
    rate = TURBINES * each / apart
    answer(page, TURBINES * each, times, streamed, workers, memory)
    row: Record = {
        "samples": TURBINES * each,
        "pieces": TURBINES * count,
        "cycles": cycles,
        **times.columns("in pieces"),
        **streamed.columns("in one stream, no levels"),
        **{f"most memory {name} [MB]": value for name, value in memory.items()},
    }
    page.section("What it takes")
    page.table(
        f"Pieces of {PIECE:,} samples, runs of both: {repeats}; --scheduler takes the workers of a "
        "cluster",
        [row],
    )
    page.data("farm", row)
    if workers > 1 and not run.quick:
        show_farm(page, rate, own / (TURBINES * each), workers)
    show_counts(page, found)


def answer(
    page: Page,
    samples: int,
    pieces: Times,
    streamed: Times,
    workers: int,
    memory: dict[str, float],
) -> None:
    """State how long counting takes in pieces, and in one stream."""
    page.section("Pieces and one stream")
    page.add(
        bars(
            BOTH,
            {"median": {PIECES: pieces.median, STREAM: streamed.median}},
            "time [s]",
            ends={
                "median": {
                    PIECES: (pieces.least, pieces.most),
                    STREAM: (streamed.least, streamed.most),
                }
            },
        )
    )
    rate, ratio = samples / pieces.median, streamed.median / pieces.median
    quicker = (
        f"{ratio:.2g} times as fast as" if ratio >= 1.0 else f"{1 / ratio:.2g} times as long as"
    )
    on = "" if workers < 1 else f" on {workers} {'workers' if workers > 1 else 'worker'}"
    page.answer(
        "How fast are load cycles counted in years of a wind farm's load histories?",
        f"Counting {samples / 1e6:,.3g}\u00a0million samples takes {pieces.median:.3g}\u00a0s in "
        f"pieces{on}, {quicker} one stream; the cycles are exactly the same.",
        [
            page.value("samples a second, in pieces [million]", rate / 1e6),
            page.value(
                "time in pieces [s]", pieces.median, beside=streamed.median, by="one stream"
            ),
            *(
                [page.value("time of 10¹¹ samples here [h]", FARM / rate / 3600.0)]
                if samples > QUICK
                else []
            ),
            *(page.value(f"peak memory {name} [MB]", value) for name, value in memory.items()),
        ],
        hero=BOTH,
        cautions=[
            "Times in pieces include the start of processes and the count of levels; both include "
            "the making of the samples.",
            "Reading of files is not included.",
        ],
    )


def counted_in_pieces(run: Run, each: int) -> Any:
    """Count the histories of all turbines in pieces, `each` samples of every turbine."""
    pieces = (
        (f"turbine {turbine}", (turbine, number, size))
        for turbine in range(TURBINES)
        for number, size in enumerate(sizes(each))
    )
    made_in_pieces = counted_histories(made, pieces, COUNTING, local=cores(), report=run.report)
    found = next(made_in_pieces)[1]
    for number, (_, more) in enumerate(made_in_pieces, 2):
        run.report(f"turbines ({number} of {TURBINES})")
        found = found + more
    return found


def check(page: Page, found: Count, cycles: float, damage: list[ExactSum], samples: int) -> None:
    """Check that pieces and one stream count the same."""
    for m, mine, exact in zip(COUNTING.slopes, found.damage, damage, strict=True):
        page.equals(
            f"sum of n r^{m:g} in pieces [-]",
            float(mine),
            float(exact),
            within=0.0,
            why="the same cycles, and sums without rounding",
            source="three points of the standard over each whole history",
            measure="identity",
        )
    page.equals(
        "cycles in pieces [-]",
        float(found.cycles.amount.sum()),
        cycles,
        within=0.0,
        why="each is counted once, halves as halves",
        source="three points of the standard over each whole history",
        measure="identity",
    )
    page.equals(
        "samples at all levels [-]",
        float(found.levels.amount.sum()),
        float(samples),
        within=0.0,
        why="each is at one level",
        source="the samples that were made",
        measure="identity",
    )


def show_counts(page: Page, found: Count) -> None:
    """Show cycles and levels in classes."""
    page.section("What is counted")
    for name, classes in (("range of cycles", found.cycles), ("level", found.levels)):
        page.chart(
            f"{name.capitalize()} in classes",
            [trace(name, classes.middles(), classes.amount)],
            f"{name} [-]",
            "number",
        )


def show_farm(page: Page, rate: float, own: float, workers: int) -> None:
    """Show the time of a whole farm, by a model of its workers."""
    farm = predicted(rate / workers, own)
    page.table(f"{FARM:.0e} samples, by the model", farm)
    page.data("predicted", farm)
    page.text(
        "Model: the larger of what the workers count and what this process adds. Each of w "
        f"workers counts as many samples a second as the {workers} here did on average; this "
        "process takes up and adds the counts of runs of pieces, and used "
        f"{1e9 * own:.3g} ns of its processor for each sample. Reading of "
        "files is not in it."
    )


def in_one_stream(each: int) -> tuple[float, list[ExactSum]]:
    """Cycles of all turbines, and their sums of n r^m."""
    damage = [ExactSum() for _ in COUNTING.slopes]
    cycles = 0.0
    for turbine in range(TURBINES):
        for block in streamed_cycles(whole(turbine, each)):
            cycles += float(block.counts.sum())
            for k, m in enumerate(COUNTING.slopes):
                damage[k] = damage[k] + exact_sum(block.counts * block.ranges**m)
    return cycles, damage


def predicted(rate: float, own: float) -> list[Record]:
    """What all samples of a farm take on some numbers of workers.

    Parameters
    ----------
    rate : float
        Samples that a worker counts in a second.
    own : float
        Seconds that this process takes for each sample.
    """
    return [
        {
            "workers": count,
            "counting [h]": FARM / rate / count / 3600,
            "adding, by this process [h]": FARM * own / 3600,
            "together [h]": max(FARM / rate / count, FARM * own) / 3600,
        }
        for count in MANY
    ]


def whole(turbine: int, samples: int) -> Iterator[Floats]:
    """All pieces of a history."""
    for number, size in enumerate(sizes(samples)):
        yield made(turbine, number, size)
