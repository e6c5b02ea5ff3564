"""Runs one tool on one problem in a process of its own, and writes down what it took.

A script, started by its path, so that any interpreter can run it that has numpy and the tool::

    python runner.py TOOL VARIANT PROBLEM.npz WARM_UP.npz RESULT.json TIME_LIMIT

TOOL is a module of this folder. It has

``version()``
    imports the tool and returns its version; an ImportError says that it is not installed,
``load(problem)``
    takes the mesh in, in the tool's own form: what a user has after reading a mesh file,
``solve(state, variant, clock)``
    goes from there to the stiffnesses, a list, of each motion of the face; without ``TOGETHER``
    there is one motion, and several are solved one after the other, each from the beginning,
``rank()``, ``total(number)``
    where several processes work together: the number of this one, after all have come there; the
    sum over all of them.

The clock runs over ``solve`` alone. Before it, the same variant solves the small warm-up problem,
so that lazy imports and compiled code read from disk burden no tool.
"""

from __future__ import annotations

import importlib.util
import json
import os
import signal
import sys
import time
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MISSING = 3
"""Exit status where the tool is not installed."""


@dataclass(frozen=True)
class Problem:
    """One face held, another moved; the stiffness of each motion is u^T K u.

    Attributes
    ----------
    points : Floats
        (n, 3) nodes [m].
    cells : Ints
        (ne, 10) nodes of the curved tetrahedra, in VTK's order.
    material : Ints
        (ne,) index into the two below.
    youngs_modulus, poisson_ratio : Floats
        (m,) [Pa], [-].
    fixed, moved : Ints
        (nf, 6) nodes of the triangles of the two faces.
    motions : Floats
        (k, 3, 4) of the moved face: u = A r + t, of the matrix A [-] and the translation t [m]
        beside it.
    rule_points, rule_weights : Floats
        (q, 3) and (q,) quadrature in the reference tetrahedron, for all tools that take one.
    """

    points: Floats
    cells: Ints
    material: Ints
    youngs_modulus: Floats
    poisson_ratio: Floats
    fixed: Ints
    moved: Ints
    motions: Floats
    rule_points: Floats
    rule_weights: Floats

    @property
    def n_unknowns(self) -> int:
        """Displacements that are not prescribed."""
        return 3 * (len(self.points) - len(self.prescribed()[0]))

    def prescribed(self, motion: int = 0) -> tuple[Ints, Floats]:
        """Nodes whose displacement is given, (k,), and that displacement, (k, 3) [m]."""
        fixed, moved = np.unique(self.fixed), np.unique(self.moved)
        values = moved_by(self.motions[motion], self.points[moved])
        return np.concatenate([fixed, moved]), np.concatenate([np.zeros((len(fixed), 3)), values])

    def one_by_one(self) -> list[Problem]:
        """The same with one motion each."""
        return [replace(self, motions=motion[None]) for motion in self.motions]

    def lame(self) -> tuple[Floats, Floats]:
        """Lame's constants (lambda, mu) of each material [Pa]."""
        e, nu = self.youngs_modulus, self.poisson_ratio
        return e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))


def moved_by(motion: Floats, points: Floats) -> Floats:
    """Displacements (n, 3) of points (n, 3) by a motion (3, 4) of `Problem.motions`."""
    return points @ motion[:, :3].T + motion[:, 3]


def read_problem(path: str | os.PathLike[str]) -> Problem:
    """A problem from its .npz file."""
    with np.load(path) as data:
        return Problem(**{name: np.ascontiguousarray(data[name]) for name in data.files})


def write_problem(problem: Problem, path: str | os.PathLike[str]) -> None:
    """A problem as an .npz file."""
    np.savez(path, **vars(problem))


@dataclass
class Clock:
    """What a solve took.

    Attributes
    ----------
    steps : dict[str, float]
        Wall time of each step [s].
    iterations : int or None
        Of an iterative solver.
    elsewhere : int or None
        Peak memory of the processes that did the work, where this one did not [bytes].
    uncounted : float
        Time inside ``solve`` that is no part of the way from mesh to stiffness [s].
    notes : dict[str, Any]
        What the page should say about the run.
    """

    steps: dict[str, float] = field(default_factory=dict)
    iterations: int | None = None
    elsewhere: int | None = None
    uncounted: float = 0.0
    notes: dict[str, Any] = field(default_factory=dict)

    @contextmanager
    def step(self, name: str) -> Iterator[None]:
        """Add the wall time of a block to a step."""
        start = time.perf_counter()
        yield
        self.steps[name] = self.steps.get(name, 0.0) + time.perf_counter() - start


def peak_memory() -> int:
    """Largest resident memory of this process so far [bytes]."""
    # Linux hands ru_maxrss on from the process that started this one; VmHWM is this one's own.
    try:
        for line in Path("/proc/self/status").read_text("ascii").splitlines():
            if line.startswith("VmHWM:"):
                return 1024 * int(line.split()[1])
    except OSError:
        pass
    import resource

    unit = 1 if sys.platform == "darwin" else 1024
    return unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def load_tool(name: str) -> ModuleType:
    """The module of a tool, by its path, so that it never hides the library of the same name."""
    path = Path(__file__).with_name(f"{name}.py")
    spec = importlib.util.spec_from_file_location(f"peer_{name}", path)
    if spec is None or spec.loader is None:
        raise ImportError(f"no tool {name!r} in {path.parent}")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def measure(
    tool: ModuleType, variant: str, problem: Problem, warm_up: Problem, time_limit: float
) -> dict[str, Any]:
    """Warm up, then solve once against the clock; see `Clock` for what is found.

    A solve over the time limit ends the whole process by SIGALRM, inside a library too.
    """
    start = time.perf_counter()
    version = tool.version()
    imported = time.perf_counter()
    tool.solve(tool.load(_parts(tool, warm_up)[0]), variant, Clock())
    warm = time.perf_counter()
    baseline = peak_memory()
    clock = Clock()
    rank = _rank_of(tool)
    stiffness: list[float] = []
    loading = total = 0.0
    for part in _parts(tool, problem):
        start_loading = time.perf_counter()
        state = tool.load(part)
        loading += time.perf_counter() - start_loading
        if time_limit > 0:
            signal.setitimer(signal.ITIMER_REAL, time_limit - total)
        begin = time.perf_counter()
        stiffness += map(float, tool.solve(state, variant, clock))
        total += time.perf_counter() - begin - clock.uncounted
        loading, clock.uncounted = loading + clock.uncounted, 0.0
        signal.setitimer(signal.ITIMER_REAL, 0)
    peak = peak_memory() if clock.elsewhere is None else clock.elsewhere
    if hasattr(tool, "total"):
        peak, baseline = tool.total(peak), tool.total(baseline)
    return {
        "rank": rank,
        "version": version,
        "stiffness": stiffness,
        "seconds": total,
        "steps": clock.steps,
        "iterations": clock.iterations,
        "import_seconds": imported - start,
        "warm_up_seconds": warm - imported,
        "load_seconds": loading,
        "peak_bytes": peak,
        "baseline_bytes": baseline if clock.elsewhere is None else None,
        "notes": clock.notes,
    }


def _parts(tool: ModuleType, problem: Problem) -> list[Problem]:
    """What a tool solves at a time."""
    return [problem] if hasattr(tool, "TOGETHER") else problem.one_by_one()


def _rank_of(tool: ModuleType) -> int:
    return int(tool.rank()) if hasattr(tool, "rank") else 0


def main(arguments: list[str]) -> int:
    """Entry point; see the module's docstring."""
    name, variant, problem, warm_up, result, time_limit = arguments
    # started by path, Python looks here first, where ngsolve.py is not NGSolve
    here = str(Path(__file__).parent)
    sys.path[:] = [entry for entry in sys.path if os.path.abspath(entry or ".") != here]
    try:
        tool = load_tool(name)
        found = measure(
            tool, variant, read_problem(problem), read_problem(warm_up), float(time_limit)
        )
    except ImportError as error:
        found, status = {"missing": str(error)}, MISSING
    except Exception as error:  # whatever a foreign library raises is what the page has to say
        traceback.print_exc()
        reason = " ".join(str(error).split())[:300]
        found, status = {"failed": f"{type(error).__name__}: {reason}"}, 1
    else:
        status = 0
    if found.get("rank", 0) == 0:
        Path(result).write_text(json.dumps(found), "utf-8")
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
