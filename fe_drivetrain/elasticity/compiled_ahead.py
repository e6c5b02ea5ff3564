"""Compiling beside other work: what a first run will need, before it needs it.

A process calls the loops with next to nothing, which compiles them, while the program reads, meshes
and assembles. Each loop is compiled once, by either of the two (`fe_drivetrain.common.compiled`).
"""

from __future__ import annotations

import multiprocessing
import os
import pickle
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal

import numpy as np

from fe_drivetrain.common.files import scratch_folder
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.threads import cores, thread_limits
from fe_drivetrain.common.worker import Worker

Loops = Literal["solver", "meridian", "bearing"]
"""Loops of the multigrid solver of solids; of a shaft's elimination in its meridian; of the
equilibrium of rolling bearings."""

_LAST = {
    "solver": "operator/kernels.py:_add_product_of_one",
    "meridian": "revolution/frontal.py:_solve",
    "bearing": "../bearing/kernels.py:elements_of",
}
"""Module and function of the loop that `rehearse` compiles last."""


@contextmanager
def compiled_ahead(*loops: Loops) -> Iterator[None]:
    """Have a process compile loops that were not compiled yet, beside all that is done in here.

    There is none on one core, nor where all are compiled already. What it has not come to at the
    end it leaves.

    Parameters
    ----------
    *loops : str
        Which of `Loops`, in the order in which they will be needed.
    """
    wanted = [one for one in loops if not is_compiled(one)]
    alone = cores() == 1 or multiprocessing.parent_process() is not None
    if not wanted or alone or os.name != "posix" or not sys.executable:
        yield
        return
    with scratch_folder() as folder:
        worker = Worker(1, {**os.environ, **thread_limits(1)}, folder / "printed")
        worker.submit(pickle.dumps((_compile, (wanted,))))
        try:
            yield
        finally:
            worker.kill()


def is_compiled(loops: Loops) -> bool:
    """Whether numba has kept the last of some loops since its file was changed.

    True, too, where this cannot be known, for numba keeps them in a place of its own.

    Parameters
    ----------
    loops : str
        Which of `Loops`.
    """
    file, name = _LAST[loops].split(":")
    module = Path(__file__).parent / file
    given = os.environ.get("NUMBA_CACHE_DIR", "")
    beside = module.parent / "__pycache__"
    if not given and not os.access(beside if beside.is_dir() else module.parent, os.W_OK):
        return True
    kept = f"{module.stem}.{name}-*.nbi"
    found = Path(given).glob(f"*/{kept}") if given else beside.glob(kept)
    return any(one.stat().st_mtime >= module.stat().st_mtime for one in found)


def _compile(report: Progress, loops: Sequence[Loops]) -> None:
    del report
    for one in loops:
        rehearse(one)


def rehearse(loops: Loops) -> None:
    """Call loops with next to nothing, as real work does: what was not compiled is compiled.

    Parameters
    ----------
    loops : str
        Which of `Loops`.
    """
    {"solver": _solver, "meridian": _meridian, "bearing": _bearing}[loops]()


def _solver() -> None:
    """Loops of `solve.multigrid`, those first that take longest to compile."""
    from scipy import sparse

    from fe_drivetrain.elasticity.operator import kernels
    from fe_drivetrain.elasticity.operator.vectors import LANES

    n = 2
    eye = np.tile(np.eye(3), (n, 1, 1))
    rounded: Any = eye.astype(np.float32)
    pattern = np.arange(n + 1, dtype=np.int32), np.arange(n, dtype=np.int32)
    for columns in (LANES, 1):
        X, B, D = (np.ones((3 * n, columns)) for _ in range(3))
        out = np.empty_like(X)
        kernels.chebyshev_step(*pattern, rounded, eye, X, B, D, out, 0.5, 0.5)
        kernels.residual(*pattern, rounded, X, B, out)
        kernels.residual(*pattern, eye, X, B, out)
        if columns > 1:
            factors = kernels.dots(X, B)
            kernels.advance(X, B, D, out, factors)
            kernels.redirect(X, B, factors)
            kernels.times_blocks(eye, X, 1.0, out)
            kernels.rounded(eye, rounded)
            kernels.invert(eye, np.empty_like(eye))
            _transfers()
        kernels.add_product(sparse.csr_array(np.eye(3 * n)), X, out)


def _transfers() -> None:
    """Loops of `solve.reduction`, and of the first aggregates, of one element."""
    from scipy import sparse

    from fe_drivetrain.elasticity.mesh.bodies import connected_bodies
    from fe_drivetrain.elasticity.operator import graph
    from fe_drivetrain.elasticity.solve.aggregates import smoothed
    from fe_drivetrain.elasticity.solve.linear_elements import from_linear

    k = 10
    cells, every = np.arange(k)[None], np.ones(3 * k, dtype=bool)
    connected_bodies(cells, k)
    from_linear(cells, k, sparse.eye_array(3 * k, format="csr"), every)
    node = np.eye(3)[None]
    one = np.arange(2, dtype=np.int32), np.zeros(1, dtype=np.int32)
    graph.diagonal(*one, node)
    K = sparse.bsr_array((node, one[1], one[0]), shape=(3, 3))
    tentative = sparse.bsr_array((np.ones((1, 3, 6)), one[1], one[0]), shape=(3, 6))
    smoothed(K, tentative, node, 0.0)


def _meridian() -> None:
    """Loops of `revolution.frontal`, of one element of one degree of freedom."""
    from fe_drivetrain.elasticity.revolution.frontal import factored

    one, first = np.ones((1, 1)), np.zeros((1, 1), dtype=np.int64)
    law = np.ones((1, 1, 1, 1))
    factored(np.ones((1, 1, 1)), law, first, one, np.zeros(1, dtype=np.int64)).solve(one)


def _bearing() -> None:
    """Loops of `fe_drivetrain.bearing`, of one load on one bearing."""
    from fe_drivetrain.bearing.catalogue import read_bearing_catalogue
    from fe_drivetrain.bearing.contact_forces import forces, roller_loads
    from fe_drivetrain.bearing.rolling import equilibrium

    entry = next(one for one in read_bearing_catalogue().values() if one.kind == "spherical_roller")
    bearing = entry.bearing("bearing")
    found = equilibrium(bearing, [0.0, 0.0, 1e4, 0.0, 0.0])
    forces(bearing, found.displacements)
    roller_loads(bearing, found.displacements)
