"""Which constants of the cost model the timings of a grid ask for, beside those in use."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from scipy.optimize import nnls

from fe_drivetrain.common import Floats
from fe_drivetrain.elasticity.solve import System, cost_model
from fe_drivetrain.report.suite import Record


class Timing(Protocol):
    """What is known of a solver on a system: seconds, bytes, iterations."""

    @property
    def setup(self) -> float:
        """Time of the set-up [s]."""

    @property
    def bytes(self) -> int:
        """Bytes of the factor or the hierarchy."""

    @property
    def iterations(self) -> int:
        """Iterations of multigrid; 0 for a direct solver."""

    def total(self, n_rhs: int) -> float:
        """Set-up and solution [s]."""


def rows_of(
    method: str, systems: Sequence[System], timings: Sequence[Timing], counts: Sequence[int]
) -> list[Record]:
    """Constants of one solver, as in use and as fitted, smallest relative errors first.

    Parameters
    ----------
    method : str
        "multigrid" or a direct solver.
    systems : sequence of System
        What was solved.
    timings : sequence of Timing
        What it took, for each system.
    counts : sequence of int
        Numbers of right-hand sides that were timed.

    Returns
    -------
    rows
        A constant each.
    """
    if method == "multigrid":
        used = cost_model.MULTIGRID._asdict()
        found = _multigrid(systems, timings, counts)
        found["bytes"] = _mean([t.bytes / s.K.nnz for s, t in zip(systems, timings, strict=True)])
    else:
        used = cost_model.DIRECT[method]._asdict()
        found = _direct(systems, timings, counts)
    return [
        {"solver": method, "constant": name.replace("_", " "), "in use": value, "fitted": fit}
        for (name, value), fit in zip(used.items(), (found[n] for n in used), strict=True)
    ]


def _multigrid(
    systems: Sequence[System], timings: Sequence[Timing], counts: Sequence[int]
) -> dict[str, float]:
    columns, seconds = [], []
    for system, timing in zip(systems, timings, strict=True):
        read = system.K.nnz * timing.iterations
        for n in counts:
            columns.append([1.0, system.K.nnz, read, read * n])
            seconds.append(timing.total(n))
    return dict(zip(("start", "per_entry", "once", "each"), _fitted(columns, seconds), strict=True))


def _direct(
    systems: Sequence[System], timings: Sequence[Timing], counts: Sequence[int]
) -> dict[str, float]:
    setups, solves, seconds, held = [], [], [], []
    for system, timing in zip(systems, timings, strict=True):
        n, w = system.K.shape[0], cost_model.width(system.K)
        setups.append([1.0, system.K.nnz, n * w**1.5])
        held.append(timing.bytes / (n * w**0.5))
        for count in counts:
            solves.append([timing.bytes, timing.bytes * count])
            seconds.append(timing.total(count) - timing.setup)
    first = _fitted(setups, [t.setup for t in timings])
    found = dict(zip(("start", "per_entry", "per_operation"), first, strict=True))
    found |= dict(zip(("solve", "each"), _fitted(solves, seconds), strict=True))
    return found | {"bytes": _mean(held)}


def _fitted(columns: Sequence[Sequence[float]], seconds: Sequence[float]) -> list[float]:
    """Constants that are not negative, of the least squared relative errors."""
    A, t = np.array(columns), np.array(seconds)
    scale = A.max(axis=0)
    found: Floats = nnls(A / scale / t[:, None], np.ones(len(t)))[0] / scale
    return [float(x) for x in found]


def _mean(values: Sequence[float]) -> float:
    """Geometric mean."""
    return float(np.exp(np.mean(np.log(values))))
