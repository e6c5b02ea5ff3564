"""Load histories of any length, made chunk by chunk, and the memory that comparing them takes.

Run as ``python -m fe_drivetrain.cases.stability.streamed_series SAMPLES streamed|whole``, it
compares one history in a process of its own and prints time, memory and statistics as JSON.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

import numpy as np

from fe_drivetrain.common import Floats, peak_memory, run_python, until_stopped
from fe_drivetrain.comparison import Comparison, compare, compare_streamed
from fe_drivetrain.comparison import statistics as by_definition

#: Samples of a chunk.
CHUNK = 1 << 18
MEAN, FACTOR, NOISE = 5.0, 1.02, 0.1


def chunks(samples: int) -> Iterator[tuple[Floats, Floats]]:
    """Reference and model (n, 1): r = 5 + u, m = 1.02 r + 0.1 v, u and v uniform from 0 to 1."""
    for number, start in enumerate(range(0, samples, CHUNK)):
        n = min(CHUNK, samples - start)
        # each chunk has its own numbers, the same whenever it is asked for
        rng = np.random.Generator(np.random.SFC64(number))
        r = MEAN + rng.random((n, 1))
        yield r, FACTOR * r + NOISE * rng.random((n, 1))


def expected() -> dict[str, float]:
    """The statistics of such a history of infinite length, by name; integrals over u and v."""
    r1, r2 = MEAN + 1 / 2, (MEAN + 1 / 2) ** 2 + 1 / 12
    # the difference is a r + b v, with mean square
    a, b = FACTOR - 1, NOISE
    d1 = a * r1 + b / 2
    d2 = a * a * r2 + a * b * r1 + b * b / 3
    inverse = float(np.log((MEAN + 1) / MEAN))
    model = FACTOR**2 / 12 + b * b / 12
    rm, m2 = FACTOR * r2 + b * r1 / 2, FACTOR**2 * r2 + FACTOR * b * r1 + b * b / 3
    slope = rm / m2
    return {
        "reference_rms": r2**0.5,
        "rmse": d2**0.5,
        "bias": d1,
        "relative_scatter": (d2 - d1**2) ** 0.5 / r2**0.5,
        "relative_error": d1 / r1,
        "mean_percentage_error": 100 * (a + b / 2 * inverse),
        "excluded_share": 0.0,
        "correlation": FACTOR / 12 / (model / 12) ** 0.5,
        "slope": slope,
        "cov": ((r2 - slope * rm) / (slope**2 * m2)) ** 0.5,
    }


def streamed(samples: int) -> Comparison:
    """Compared chunk by chunk."""
    return compare_streamed(lambda: chunks(samples), ["Fz"], ["N"])


def in_memory(samples: int) -> tuple[Floats, Floats]:
    """Reference and model (n,) of the whole history."""
    r, m = np.empty((2, samples))
    for k, (one, other) in enumerate(chunks(samples)):
        here = slice(k * CHUNK, k * CHUNK + len(one))
        r[here], m[here] = one[:, 0], other[:, 0]
    return r, m


def whole(samples: int) -> Comparison:
    """Compared in memory."""
    r, m = in_memory(samples)
    return compare(r[None, :, None], m[None, :, None], ["Fz"], ["N"])


def one_by_one(samples: int) -> dict[str, float]:
    """The statistics of the whole history by name, each by its own function of all samples.

    `compare` sums blocks as `compare_streamed` does: these are independent of both.
    """
    r, m = in_memory(samples)
    slope, cov = by_definition.model_uncertainty(r, m)
    found = {
        "reference_rms": np.sqrt((r**2).mean()),
        "rmse": by_definition.rmse(r, m),
        "bias": by_definition.bias(r, m),
        "relative_scatter": by_definition.relative_scatter(r, m),
        "relative_error": by_definition.relative_error(r, m),
        "mean_percentage_error": by_definition.mean_percentage_error(r, m),
        "excluded_share": by_definition.excluded_share(r),
        "correlation": by_definition.correlation(r, m),
        "slope": slope,
        "cov": cov,
    }
    return {name: float(value) for name, value in found.items()}


def statistics(found: Comparison) -> dict[str, float]:
    """The statistics of a comparison by name."""
    every = asdict(found)
    return {name: float(every[name][0, 0]) for name in expected()}


def in_own_process(samples: int, way: str) -> dict[str, Any]:
    """What `main` prints of so many samples, "streamed" or "whole"."""
    done = run_python("-m", __spec__.name, str(samples), way)
    done.check_returncode()
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def main() -> None:
    """Compare, and print time [s], memory before and at most [bytes], and statistics."""
    samples, way = int(sys.argv[1]), sys.argv[2]
    before = peak_memory()
    start = time.perf_counter()
    found = {"streamed": streamed, "whole": whole}[way](samples)
    took = {"seconds": time.perf_counter() - start, "before": before, "peak": peak_memory()}
    json.dump(took | {"statistics": statistics(found)}, sys.stdout)


if __name__ == "__main__":
    sys.exit(until_stopped(main))
