"""Samples per second of each step that histories go through, against other packages."""

import importlib
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.histories import (
    even_levels,
    rainflow_cycles,
    spectrum,
    time_at_level,
    window_statistics,
)
from fe_drivetrain.hub_loads import find_loops
from fe_drivetrain.suite import Page, Record, Run

STEP = 0.05
SIZES = (12_000, 120_000, 1_200_000)


@case(
    "Speed of statistics, counting, spectra and loops, in samples per second",
    source="measured on this machine, one core; rainflow 3, rfcnt 0.6 where they are installed",
    alone=True,
)
def run(run: Run, page: Page) -> None:
    """Time each step on coloured noise with 3P, at several lengths."""
    sizes = SIZES[: 1 if run.quick else 3]
    rows: list[Record] = []
    for size in sizes:
        load, other = noise(size, 1), noise(size, 2)
        at = np.arange(size, dtype=np.float64) * STEP
        tasks = steps(at, load, other) | peers(load)
        for name, task in tasks.items():
            if name == "load loops" and size > SIZES[1]:
                continue
            with run.step(name):
                rows.append(
                    {"step": name, "samples": size, "samples per second": size / seconds(task)}
                )
    page.section("Speed")
    page.sweep(
        "Samples per second of one channel, one core",
        rows,
        "samples",
        "samples per second",
        by="step",
        log="xy",
    )
    last = {row["step"]: row["samples per second"] for row in rows if row["samples"] == sizes[0]}
    page.answer(
        f"Ten minutes at 20 Hz of one channel are counted in {1e3 * 12_000 / last['rainflow']:.0f} "
        f"ms, {last['rainflow']:,.0f} samples per second; loops take "
        f"{1e3 * 12_000 / last['load loops']:.0f} ms."
    )
    if "rfcnt, in 1000 classes" in last:
        page.text(
            f"rfcnt is {last['rfcnt, in 1000 classes'] / last['rainflow']:.0f} times as fast, in "
            "1000 classes: it decides by class which cycles close, so that it is no count after "
            "the standard. Steps run on one core; files may be counted side by side."
        )
    page.at_least(
        "rainflow counting, samples per second",
        last["rainflow"],
        12_000.0,
        why="ten minutes at 20 Hz take a second at most: a thousand files, six channels, two hours",
        source="what a user with a thousand files waits for",
        measure=None,
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


def peers(load: Floats) -> dict[str, Callable[[], Any]]:
    """Other packages that are there."""
    found: dict[str, Callable[[], Any]] = {}
    try:
        rfcnt = importlib.import_module("rfcnt")
    except ImportError:
        return found
    width = float(np.ptp(load)) / 990.0
    found["rfcnt, in 1000 classes"] = lambda: rfcnt.rfc(
        load,
        class_width=width,
        class_count=1000,
        class_offset=float(load.min()) - 4.0 * width,
        hysteresis=0.0,
        residual_method=4,
        spread_damage=-1,
    )
    return found


def seconds(task: Callable[[], Any]) -> float:
    """Shortest of three runs."""
    best = np.inf
    for _ in range(3):
        start = time.perf_counter()
        task()
        best = min(best, time.perf_counter() - start)
    return float(best)
