"""What each solver will take, in seconds and bytes, before it is set up.

Nested dissection of a solid whose cross-section has w nodes, n unknowns in all, fills a factor with
about n w^(1/2) entries at n w^(3/2) operations (George 1973 for squares and cubes; a slender solid
is a row of cubes). The width comes from the levels of one breadth-first search, so that slender
and chunky solids of one size are told apart. Constants: see ``cases/performance/solver_grid.py``.
"""

import os
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra

from fe_drivetrain import direct
from fe_drivetrain.reduction import System

_ITERATIONS = 20


@dataclass(frozen=True)
class Cost:
    """Predicted cost of one solver.

    Attributes
    ----------
    method
        Name of the solver.
    seconds
        Set-up and solve.
    bytes
        Of the factor or hierarchy.
    fits
        Whether there is the memory for it now.
    """

    method: str
    seconds: float
    bytes: float
    fits: bool

    def __str__(self) -> str:
        memory = f"{self.bytes / 2**30:.1f} GiB"
        return f"{self.method} about {self.seconds:.2g} s, {memory}" + (
            "" if self.fits else ", which is not there"
        )


def predict(system: System, n_rhs: int) -> list[Cost]:
    """Costs of every solver that is installed, cheapest first among those that fit in memory."""
    n, nnz = system.K.shape[0], system.K.nnz
    w = width(system.K)
    memory = available_memory()
    fill, work = n * w**0.5, n * w**1.5
    costs = []
    for method, (per_fill, per_work, held) in DIRECT.items():
        if direct.is_installed(method):
            seconds = per_work * work + per_fill * fill * (1.0 + SOLVES[method] * n_rhs)
            costs.append((method, seconds, held * fill))
    setup, once, each, held = MULTIGRID
    seconds = 0.03 + nnz * (setup + _ITERATIONS * (once + each * n_rhs))
    costs.append(("multigrid", seconds, held * nnz))
    found = [Cost(m, s, b, b < memory) for m, s, b in costs]
    return sorted(found, key=lambda cost: (not cost.fits, cost.seconds))


# seconds per entry of fill, per operation, bytes per entry; seconds of a solve per entry, relative
DIRECT = {
    "superlu": (1e-8, 1e-9, 12.0),
    "cholmod": (1e-8, 1e-10, 8.0),
    "pardiso": (1e-8, 5e-11, 8.0),
}
SOLVES = {"superlu": 0.1, "cholmod": 0.1, "pardiso": 0.1}
MULTIGRID = (1e-8, 1e-8, 1e-9, 4.0)


def width(K: sparse.bsr_array) -> float:
    """Mean number of nodes in a cross-section, of the levels of a breadth-first search."""
    n = len(K.indptr) - 1
    graph = sparse.csr_array((np.ones(len(K.indices)), K.indices, K.indptr), shape=(n, n))
    start = int(np.argmax(np.diff(K.indptr)))  # not one that stands alone
    level = dijkstra(graph, indices=start, unweighted=True)
    far = int(np.argmax(np.where(np.isfinite(level), level, -1.0)))
    level = dijkstra(graph, indices=far, unweighted=True)
    size = np.bincount(level[np.isfinite(level)].astype(np.int64)).astype(float)
    return float((size**2).sum() / size.sum())


def available_memory() -> float:
    """Bytes that can be had without swapping; infinite where the system does not say."""
    try:
        return float(os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (AttributeError, ValueError, OSError):
        return float("inf")
