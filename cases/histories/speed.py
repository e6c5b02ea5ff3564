"""Samples per second of each step that histories go through, against other packages."""

import shutil
import tempfile
import time
import tracemalloc
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.histories.speed_beside import PEERS, PLAIN, counters, counting, reading
from fe_drivetrain.common import Floats, timed_runs
from fe_drivetrain.common.cache import switched_off
from fe_drivetrain.report.suite import Page, Record, Run, goal
from fe_drivetrain.studies import LoadOptions, loads
from fe_drivetrain.studies.load_digest import digest
from fe_drivetrain.turbine_loads.histories import (
    even_levels,
    rainflow_cycles,
    spectrum,
    streamed_cycles,
    time_at_level,
    window_statistics,
)
from fe_drivetrain.turbine_loads.hub_loads import LoadHistory, Recorded, find_loops, write_hub_loads

STEP = 0.05
SIZES = (12_000, 120_000, 1_200_000)
STREAMED = 20_000_000
GOAL = 1e6  # samples per second, counted
PIECE = 1 << 20
FILE = 120_000  # samples of a history that goes through the whole of 'loads'


@case(
    "Speed of statistics, counting, spectra and loops, in samples per second",
    source="measured on this machine; rainflow 3, rfcnt 0.6, pylife 2, QATS 5, weio 2 and "
    "openfast_io 4 where they are installed",
    settings={
        "samples": "20000000 (quick 1000000; from 524288)",
        "repeats": "5 (quick 1; from 1)",
    },
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Stream a long history and many files; time each step on coloured noise with 3P."""
    repeats = run.count("repeats", 1 if run.quick else 5)
    samples = run.count("samples", 1_000_000 if run.quick else STREAMED, least=PIECE // 2)
    stream(run, page, samples, repeats)
    sizes = SIZES[: 1 if run.quick else 3]
    rows: list[Record] = []
    for size in sizes:
        load, other = noise(size, 1), noise(size, 2)
        at = np.arange(size, dtype=np.float64) * STEP
        tasks = steps(at, load, other) | counters(load)
        for name, task in tasks.items():
            if size > SIZES[1] and name in ("load loops", *PLAIN):
                continue
            with run.step(name):
                _, times = timed_runs(task, max(repeats, 3), time.process_time)
            rows.append(
                {
                    "step": name,
                    "samples": size,
                    **times.columns("", "ms"),
                    "samples per second": size / max(times.median, 1e-6),
                }
            )
    page.section("Speed of each step")
    page.sweep(
        SPEEDS,
        rows,
        "samples",
        "samples per second",
        by="step",
        log="xy",
    )
    size = sizes[min(1, len(sizes) - 1)]
    counting(run, page, noise(size, 1), repeats)
    reading(run, page, sizes[0], repeats)
    cores(run, page, repeats)
    many_files(run, page)
    last, first = (
        {str(row["step"]): float(row["samples per second"]) for row in rows if row["samples"] == n}
        for n in (sizes[-1], sizes[0])
    )
    answer(page, first, last["rainflow"])
    for name, words in PEERS.items():
        if name in first:
            page.text(
                f"{name}: {first[name] / first['rainflow']:.2g} times the speed of the count here, "
                f"at {sizes[0]:,} samples; {words}."
            )
    page.section("Goal")
    page.table(
        "So that a thousand files of ten minutes at 20 Hz with eight channels take two minutes at "
        "most",
        [goal("rainflow counting, samples per second", last["rainflow"], least=GOAL)],
    )


SPEEDS = "Samples of one channel per second of processor time, at the median of all runs"


def answer(page: Page, first: Mapping[str, float], counted: float) -> None:
    """State how fast cycles are counted, beside the fastest package that counts them."""
    peers = {name: first["rainflow"] / first[name] for name in PEERS if name in first}
    beside = "no other package is installed to compare with"
    if peers:
        name, ratio = min(peers.items(), key=lambda peer: peer[1])
        slower = f"{1 / ratio:.2g} times slower than"
        faster = f"{ratio:.2g} times as fast as" if ratio >= 1.0 else slower
        beside = f"{faster} the fastest other package ({name.partition(',')[0]})"
    page.answer(
        "How fast are load cycles counted, and how much memory do long histories take?",
        f"Cycles are counted at {counted / 1e6:.2g}\u00a0million samples a second, {beside}.",
        [
            page.value(
                "rainflow counting [million samples/s]",
                counted / 1e6,
                at_least=GOAL / 1e6,
                by="goal",
            ),
            *(page.value(f"speed over that of {name}", ratio) for name, ratio in peers.items()),
            page.value(
                "time to find load loops of ten minutes at 20 Hz [ms]",
                1e3 * SIZES[0] / first["load loops"],
            ),
            page.judged("streamed: most memory", "memory of a history that is streamed"),
        ][:6],
        hero=SPEEDS,
        cautions=[
            "The packages differ in what they count: classes decide which cycles close, or open "
            "ends are left out."
        ],
    )


def steps(at: Floats, load: Floats, other: Floats) -> dict[str, Callable[[], Any]]:
    """What `loads` does with each channel, or each pair of them."""
    levels = even_levels(load.min(), load.max())
    return {
        "statistics of windows": lambda: window_statistics(at, load[:, None]),
        "time at level": lambda: time_at_level(load, STEP, levels),
        "spectrum": lambda: spectrum(load, STEP),
        "rainflow": lambda: rainflow_cycles(load),
        "load loops": lambda: find_loops(at, load, other),
    }


def noise(size: int, seed: int) -> Floats:
    """A load with a slow part and 3P, as hub moments have."""
    generator = np.random.default_rng(seed)
    slow = np.convolve(generator.standard_normal(size), np.ones(20) / 20.0, "same")
    return np.asarray(5.0 + slow + 0.5 * np.sin(2 * np.pi * 0.6 * STEP * np.arange(size) + seed))


@dataclass
class Pieces:
    """Noise in pieces, as a history that would not fit into memory, and its extremes.

    Attributes
    ----------
    run : Run
        Is told how far it is.
    samples : int
        Number of samples.
    low, high : float
        Extremes of all that was made.
    """

    run: Run
    samples: int
    low: float = np.inf
    high: float = -np.inf

    def each(self) -> Iterator[Floats]:
        """Every piece, the same each time."""
        generator = np.random.default_rng(3)
        piece = generator.standard_normal(PIECE)
        for start in range(0, self.samples, PIECE):
            part = piece[: self.samples - start] + generator.standard_normal()
            self.low, self.high = (
                min(self.low, float(part.min())),
                max(self.high, float(part.max())),
            )
            if start // PIECE % 16 == 0:
                done, of = start // 1_000_000, self.samples // 1_000_000
                self.run.report(f"streamed ({done:,} of {of:,} million)")
            yield part


def stream(run: Run, page: Page, samples: int, repeats: int) -> None:
    """Count a history that would not fit into memory; what that takes."""
    rainflow_cycles(noise(1000, 0))  # compiled code is loaded
    made = Pieces(run, samples)

    def counted() -> tuple[float, float, float]:
        damage, cycles, largest = 0.0, 0.0, 0.0
        for block in streamed_cycles(made.each()):
            damage += float(block.counts @ block.ranges**4)
            cycles += float(block.counts.sum())
            largest = max(largest, float(block.ranges.max()))
        return damage, cycles, largest

    with run.step("streamed"):
        _, worked = timed_runs(counted, repeats, time.process_time)
    tracemalloc.start()
    with run.step("streamed, memory watched"):
        damage, cycles, largest = counted()
    peak = tracemalloc.get_traced_memory()[1] / 1e6
    tracemalloc.stop()
    page.section("A history beyond memory")
    row: Record = {
        "samples": samples,
        "of 8 bytes [MB]": 8e-6 * samples,
        "cycles": cycles,
        "sum of n r^4 [-]": damage,
        **worked.columns("of processor"),
        "most memory [MB]": peak,
    }
    page.table(f"One channel, counted in pieces of {PIECE:,}; --set samples=1e9 for more", [row])
    page.data("streamed", row)
    page.text(
        f"{samples:,} samples in pieces take {worked.median:.3g} s of processor time "
        f"and {peak:.3g} MB, made noise included."
    )
    page.equals(
        "streamed: largest range less the range of all samples",
        largest,
        made.high - made.low,
        within=0.0,
        why="the largest and the least value make one cycle or half of one, whatever lies between",
        source="ASTM E1049-85, 5.4.4",
        measure="identity",
    )
    page.at_most(
        "streamed: most memory [MB]",
        peak,
        200.0,
        why="a piece of 8 MB, its copies and differences, and a block of cycles",
        source="bounded, whatever the length",
        measure=None,
    )


def cores(run: Run, page: Page, repeats: int) -> None:
    """The whole of `loads` on one core and two, by threads and by processes."""
    files = 2 if run.quick else 8
    size = FILE // 20 if run.quick else FILE
    rows: list[Record] = []
    whole(0, size)  # compiled code is loaded
    with run.step("one core"):
        _, alone = timed_runs(lambda: [whole(k, size) for k in range(files)], repeats)
    with run.step("two threads"), ThreadPoolExecutor(2) as pool:
        _, threads = timed_runs(
            lambda: list(pool.map(lambda k: whole(k, size), range(files))), repeats
        )
    with run.step("two processes"), run.side_by_side(2) as jobs:
        for job in [jobs.start(in_process, 0, size) for _ in range(2)]:
            job.result()  # both have started
        _, processes = timed_runs(
            lambda: [j.result() for j in [jobs.start(in_process, k, size) for k in range(files)]],
            repeats,
        )
    for name, took in (
        ("one core", alone),
        ("two threads", threads),
        ("two processes", processes),
    ):
        rows.append(
            {
                "on": name,
                **took.columns(),
                "samples of six loads per second": files * size / took.median,
                "over one core": alone.median / took.median,
            }
        )
    page.section("One core and two")
    page.table(
        f"All that 'loads' does with a history, {files} histories of {size:,} samples: statistics, "
        "cycles of eight channels, spectra, levels, loops",
        rows,
    )
    page.data("cores", rows)
    page.text(
        "Files are counted in processes: compiled loops leave the lock of the interpreter, but "
        "much of the rest holds it."
    )


def many_files(run: Run, page: Page) -> None:
    """Peak memory of `loads` over few files and over many, each in a process of its own."""
    size, few, many = (FILE // 20, 4, 8) if run.quick else (FILE // 10, 4, 40)
    with tempfile.TemporaryDirectory() as folder, run.step("few files and many"):
        file = Path(folder, "made.csv")
        write_hub_loads(made_history(0, size), file)
        with run.side_by_side(2) as jobs:
            started = [jobs.start(peak_over_files, file, count) for count in (few, many)]
            peaks = [job.result() for job in started]
    samples = 8.0 * 7 * size  # time and six loads
    growth = (peaks[1] - peaks[0]) / (many - few)
    rows: list[Record] = [
        {"files": count, "samples of all [MB]": 1e-6 * count * samples, "peak [MB]": 1e-6 * peak}
        for count, peak in zip((few, many), peaks, strict=True)
    ]
    page.section("Few files and many")
    page.table(
        f"Peak memory of 'loads' over files of {size:,} samples, in one process; what modules and "
        "compiled loops take is not counted",
        rows,
    )
    page.data("many_files", rows)
    page.text(
        f"'loads' takes {1e-6 * peaks[0]:.3g} MB for {few} files and {1e-6 * peaks[1]:.3g} MB for "
        f"{many}, whose samples take {1e-6 * many * samples:.3g} MB."
    )
    page.at_most(
        f"loads: growth of peak memory from {few} files to {many}, per file, over its samples",
        growth / samples,
        0.1,
        why="a file at a time is in memory; of each its windows, damage and load loops stay",
        source="time and six loads of 8 bytes a sample",
        measure=None,
    )


def peak_over_files(_run: Run, file: Path, count: int) -> int:
    """Peak memory of `loads` over so many copies of a file [bytes]."""
    copies = [file.with_name(f"{count}_{k}.csv") for k in range(count)]
    for copy in copies:
        shutil.copyfile(file, copy)
    with switched_off():
        loads(copies[:1])  # modules and compiled loops are loaded
        tracemalloc.start()
        loads(copies)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
    return peak


def made_history(seed: int, size: int) -> LoadHistory:
    """A history of noise in all six loads."""
    loads = np.column_stack([1e3 * noise(size, 10 * seed + c) for c in range(6)])
    return LoadHistory("made", STEP * np.arange(size, dtype=np.float64), loads)


def whole(seed: int, size: int) -> int:
    """The digest of a made history; how many of its samples were counted."""
    found = Recorded(made_history(seed, size), np.full(size, 1.2))
    return digest(found, LoadOptions()).span.samples


def in_process(_report: object, seed: int, size: int) -> int:
    """The same as a job."""
    return whole(seed, size)
