"""Counting and reading beside other packages: in turns, with the same measure of error for all."""

import importlib
import struct
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.histories import rainflow_cycles
from fe_drivetrain.turbine_loads.hub_loads import openfast_channels

PACKAGE, QATS = "rainflow, the package", "QATS"
CLASSES, WHOLE = "rfcnt, in 1000 classes", "pylife, whole cycles alone"
PEERS = {
    PACKAGE: "the same cycles, in plain Python",
    QATS: "the same cycles, in plain Python",
    CLASSES: "it decides by class which cycles close, so that it is no count after the standard",
    WHOLE: "what the end leaves open is no cycle of it but a list of values",
}
PLAIN = (PACKAGE, QATS)
"""Packages in plain Python, too slow for a million samples."""
MISSING = {
    PACKAGE: "pip install rainflow",
    QATS: "pip install qats, which brings Qt",
    CLASSES: "pip install rfcnt",
    WHOLE: "pip install pylife",
    "weio": "pip install weio",
    "openfast_io": "pip install openfast-io",
}
OURS = "this project"
EXPONENT = 4.0
CHANNELS = 60
RATIO = "its time over ours"


def package(name: str) -> Any:
    """A module, or None where it is not there."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


def counters(load: Floats) -> dict[str, Callable[[], Any]]:
    """How each package that is there counts."""
    found: dict[str, Callable[[], Any]] = {}
    width = float(np.ptp(load)) / 990.0
    own, rfcnt = package("rainflow"), package("rfcnt")
    qats, pylife = package("qats.fatigue.rainflow"), package("pylife.stress.rainflow")
    if own:
        found[PACKAGE] = lambda: list(own.extract_cycles(load))
    if qats:
        found[QATS] = lambda: qats.count_cycles(load, endpoints=True)
    if rfcnt:
        found[CLASSES] = lambda: rfcnt.rfc(
            load,
            class_width=width,
            class_count=1000,
            class_offset=float(load.min()) - 4.0 * width,
            hysteresis=0.0,
            residual_method=4,
            spread_damage=-1,
        )
    if pylife:
        found[WHOLE] = lambda: pylife.FourPointDetector(pylife.LoopValueRecorder()).process(load)
    return found


def summed(name: str, counted: Any) -> float:
    """The sum of n r^4 of a package's count, r being the range of a cycle."""
    if name == OURS:
        return float(counted.counts @ counted.ranges**EXPONENT)
    if name == PACKAGE:
        return float(sum(count * size**EXPONENT for size, _, count, *_ in counted))
    if name == QATS:
        return float(counted[:, 2] @ counted[:, 0] ** EXPONENT)
    if name == CLASSES:
        pairs = counted["rp"]
        return float(pairs[:, 0] ** EXPONENT @ pairs[:, 1])
    loops = counted.recorder
    ranges = np.abs(np.asarray(loops.values_to) - np.asarray(loops.values_from))
    return float((ranges**EXPONENT).sum())


def in_turns(
    tasks: Mapping[str, Callable[[], Any]], repeats: int
) -> tuple[dict[str, Any], dict[str, list[float]]]:
    """What each task made, and its processor seconds, one after the other in each round.

    A round before them, which is not counted, compiles and imports.
    """
    made = {name: task() for name, task in tasks.items()}
    seconds: dict[str, list[float]] = {name: [] for name in tasks}
    for number in range(repeats):
        for name in list(tasks)[:: -1 if number % 2 else 1]:
            start = time.process_time()
            made[name] = tasks[name]()
            seconds[name].append(max(time.process_time() - start, 1e-6))
    return made, seconds


def beside(name: str, seconds: Mapping[str, list[float]], what: str, error: float) -> Record:
    """A row of a package: least, median and most of the ratios of each round, and its error."""
    ratios = [theirs / ours for theirs, ours in zip(seconds[name], seconds[OURS], strict=True)]
    return {
        "package": name,
        f"{RATIO}, least": min(ratios),
        f"{RATIO}, median": median(ratios),
        f"{RATIO}, most": max(ratios),
        "runs": len(ratios),
        what: error,
    }


def counting(run: Run, page: Page, load: Floats, repeats: int) -> None:
    """Count the same history by every package, in turns."""
    tasks = {OURS: lambda: rainflow_cycles(load), **counters(load)}
    with run.step("counting beside other packages"):
        made, seconds = in_turns(tasks, repeats)
    sums = {name: summed(name, counted) for name, counted in made.items()}
    what = "sum of n r⁴ over ours, less 1"
    rows = [beside(name, seconds, what, sums[name] / sums[OURS] - 1.0) for name in made]
    page.section("Beside other packages")
    shown(page, f"Cycles of {len(load):,} samples, processor time", rows, PEERS)
    page.data("counting", rows)
    for name in PLAIN:
        if name in sums:
            page.vanishes(
                f"{name}: sum of n r^4 over ours, less 1",
                abs(sums[name] / sums[OURS] - 1.0),
                within=1e-12,
                why="the same cycles by the standard; only the order of adding differs",
                source="ASTM E1049-85, 5.4.4, as that package has it",
            )


def shown(page: Page, caption: str, rows: list[Record], every: Mapping[str, str]) -> None:
    """A table of the packages that are there, and how to install the others."""
    page.table(caption, rows)
    there = {row["package"] for row in rows}
    missing = [f"{name} ({MISSING[name]})" for name in every if name not in there]
    if missing:
        page.text(f"Not installed here: {'; '.join(missing)}.")
    for row in rows:
        ratio = float(row[f"{RATIO}, median"])
        if ratio < 1.0:
            page.text(f"{row['package']} is {1.0 / ratio:.2g} times as fast as this project.")


def reading(run: Run, page: Page, samples: int, repeats: int) -> None:
    """Read a binary file of OpenFAST by every package, in turns, all channels of it."""
    values = np.random.default_rng(7).integers(-32768, 32767, (samples, CHANNELS), dtype=np.int16)
    with TemporaryDirectory() as folder, run.step("reading beside other packages"):
        file = Path(folder, "made.outb")
        write_outb(file, values)
        made, seconds = in_turns(readers(file), repeats)
    expected = unpacked(values)
    what = "largest difference from what was written, over the largest value"
    size = float(np.abs(expected).max())
    errors = {
        name: float(np.abs(channels_of(name, found) - expected).max()) / size
        for name, found in made.items()
    }
    rows = [beside(name, seconds, what, errors[name]) for name in made]
    shown(
        page,
        f"{CHANNELS} channels of a binary file of OpenFAST, {samples:,} samples, processor time",
        rows,
        {"weio": "", "openfast_io": ""},
    )
    page.data("reading", rows)
    page.vanishes(
        "reading: largest difference from what was written, over the largest value",
        errors[OURS],
        within=1e-6,
        why="scales and offsets of the file have the digits of single precision",
        source="what was written",
    )


def scales() -> tuple[Floats, Floats]:
    """Scale and offset of each channel, in single precision as the file has them."""
    place = np.arange(CHANNELS)
    scale, offset = (100.0 / (1 + place)).astype("<f4"), (3.0 * place - 50.0).astype("<f4")
    return scale.astype(np.float64), offset.astype(np.float64)


def unpacked(values: Any) -> Floats:
    """Values of the channels."""
    scale, offset = scales()
    return np.asarray((values - offset) / scale)


def write_outb(file: Path, values: Any) -> None:
    """A file of packed channels at even steps, by the layout of ReadFASTbinary.m."""
    names = ["Time", *(f"Chan{k}" for k in range(CHANNELS))]
    scale, offset = scales()
    parts = [
        struct.pack("<hii", 2, CHANNELS, len(values)),
        struct.pack("<dd", 0.0, 0.05),
        *(numbers.astype("<f4").tobytes() for numbers in (scale, offset)),
        struct.pack("<i", 4),
        b"made",
        *(text.ljust(10).encode() for text in [*names, "(s)", *["(kN)"] * CHANNELS]),
        np.ascontiguousarray(values, dtype="<i2").tobytes(),
    ]
    file.write_bytes(b"".join(parts))


def readers(file: Path) -> dict[str, Callable[[], Any]]:
    """How each package that is there reads all channels, into what it gives its users."""
    found: dict[str, Callable[[], Any]] = {OURS: lambda: openfast_channels(file)}
    weio = package("weio.fast_output_file")
    openfast_io = package("openfast_io.FAST_output_reader")
    if weio:
        found["weio"] = lambda: weio.FASTOutputFile(str(file)).toDataFrame()
    if openfast_io:
        found["openfast_io"] = lambda: openfast_io.load_binary_output(str(file))
    return found


def channels_of(name: str, read: Any) -> Floats:
    """Values of what a package read, without time."""
    if name == OURS:
        return np.column_stack([read[f"chan{k}"].values for k in range(CHANNELS)])
    values = read.to_numpy() if name == "weio" else read[0]
    return np.asarray(values)[:, 1:]
