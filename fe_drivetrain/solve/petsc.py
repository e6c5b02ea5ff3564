"""Systems in parts: MPI processes that have rows of the matrix each, preconditioned by PETSc.

Nodes are dealt out by recursive bisection of their coordinates, interfaces with the nodes that they
couple, so that each process has one compact part. GAMG, algebraic multigrid by smoothed aggregation
of the rigid motions, or MUMPS, a direct factor, then precondition conjugate gradients, which stop
by the same estimate of the energy error as those of `multigrid`. Any Python of this machine that
has petsc4py runs the processes; ``FE_DRIVETRAIN_MPI`` says how they are started.
"""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import tempfile
import weakref
from contextlib import suppress
from functools import cache as once
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import SINGULAR, InputError
from fe_drivetrain.common.interpreter import interpreters
from fe_drivetrain.common.threads import cores, thread_limits
from fe_drivetrain.mesh.bodies import connected_bodies
from fe_drivetrain.solve.multigrid import Iteration
from fe_drivetrain.solve.reduction import Elements, Joints, System

METHODS = ("petsc", "petsc-mumps")

MOST = 400
"""Iterations: 30 to 50 of GAMG are usual, a rigid spherical joint took 94 and more."""

MPI_VARIABLE = "FE_DRIVETRAIN_MPI"
"""Environment variable: the command that starts the processes, "mpiexec -n CORES" where unset."""

FOLDER_VARIABLE = "FE_DRIVETRAIN_MPI_FOLDER"
"""Environment variable: a folder that all processes see; the system's for temporary files."""

_RANK = Path(__file__).with_name("petsc_ranks.py")
_NEEDS = "import mpi4py, petsc4py.PETSc, scipy"

INSTALL = "apt-get install python3-petsc4py python3-mpi4py python3-scipy openmpi-bin"


@once
def interpreter() -> str | None:
    """A Python that has petsc4py; None where there is none."""
    if shutil.which(_launch()[0]) is None:
        return None
    for python in interpreters():
        run = subprocess.run(
            [python, "-c", _NEEDS], env=_environment(), capture_output=True, check=False
        )
        if run.returncode == 0:
            return python
    return None


def parts(points: Floats, count: int) -> Ints:
    """Order of points in which ``count`` equal runs of them are compact parts.

    Parameters
    ----------
    points : Floats
        (n, 3) [m].
    count : int
        Of parts; the first ones have one point more where they are not equal.

    Returns
    -------
    Ints
        (n,) numbers of points.
    """
    each, more = divmod(len(points), count)
    sizes: Ints = np.where(np.arange(count) < more, each + 1, each)

    def halves(chosen: Ints, of: Ints) -> list[Ints]:
        if len(of) == 1:
            return [chosen]
        here = points[chosen]
        axis = int(np.argmax(np.ptp(here, axis=0))) if len(here) else 0
        order = chosen[np.argsort(here[:, axis], kind="stable")]
        middle = len(of) // 2
        left = int(of[:middle].sum())
        return halves(order[:left], of[:middle]) + halves(order[left:], of[middle:])

    return np.concatenate(halves(np.arange(len(points)), sizes))


class Ranks:
    """Processes that have a system in parts, until this is no longer used.

    Parameters
    ----------
    system : System
        What they solve.
    method : str
        ``petsc`` (GAMG) or ``petsc-mumps``.

    Attributes
    ----------
    bytes : int
        Memory that setting up took of all processes together.
    facts : dict
        What the first process answered then: number of processes, bytes and entries of each,
        seconds of reading and of setting up.

    Raises
    ------
    InputError
        There is no PETSc, or it cannot set up: the system is singular, or memory has run out.
    """

    def __init__(self, system: System, method: str) -> None:
        python = interpreter()
        if python is None:
            raise InputError(
                f"solver {method!r} needs PETSc and MPI: {INSTALL}, or choose 'multigrid'"
            )
        launch = _launch()
        self._folder = Path(tempfile.mkdtemp(dir=os.environ.get(FOLDER_VARIABLE)))
        blocks = system.K.shape[0] // 3
        self._order = _order(system, _count(launch))
        _write(self._folder, system, self._order, method)
        self._log = (self._folder / "log").open("w+")
        self._process = subprocess.Popen(
            [*launch, python, str(_RANK), str(self._folder)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._log,
            text=True,
            env=_environment() | {"TMPDIR": str(self._folder)},
            cwd=self._folder,
        )
        weakref.finalize(self, _end, self._process, self._folder)
        self.facts = self._answer()
        self.bytes = sum(self.facts["bytes"])
        self._blocks, self._number = blocks, 0

    def solve(self, F: Floats, tolerance: float) -> Iteration:
        """Solve for all columns, one after the other.

        Parameters
        ----------
        F : Floats
            (n, m).
        tolerance : float
            Energy error at which conjugate gradients stop.
        """
        self._number += 1
        np.save(self._folder / f"f-{self._number}.npy", _blockwise(F, self._order))
        request = {"number": self._number, "tolerance": tolerance, "most": MOST}
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(request) + "\n")
        self._process.stdin.flush()
        found = self._answer()
        self.facts = self.facts | found
        files = [
            self._folder / f"x-{self._number}-{rank}.npy" for rank in range(self.facts["ranks"])
        ]
        x = np.concatenate([np.load(file) for file in files])
        for file in (*files, self._folder / f"f-{self._number}.npy"):
            file.unlink()
        back = np.empty_like(self._order)
        back[self._order] = np.arange(len(back))
        return Iteration(_blockwise(x, back), found["iterations"], found["energy_error"])

    def _answer(self) -> dict[str, Any]:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            if line.startswith("@"):
                answer: dict[str, Any] = json.loads(line[1:])
                return answer
        self._process.wait()
        self._log.seek(0)
        last = [line for line in self._log.read().splitlines() if line.strip()]
        if any("zero pivot" in line.lower() or "not positive" in line for line in last):
            raise InputError(SINGULAR)
        raise InputError(
            f"PETSc ended with status {self._process.returncode}: "
            f"{next((line for line in last if 'rror' in line), 'without a word')}: use fewer "
            "processes, more memory, or solver multigrid"
        )


def _order(system: System, count: int) -> Ints:
    """Nodes in compact parts; reference points, which have no place, at the end."""
    blocks = system.K.shape[0] // 3
    if system.elements is None:
        return np.arange(blocks)
    points = system.elements.points
    return np.concatenate([parts(points, count), np.arange(len(points), blocks)])


def _write(folder: Path, system: System, order: Ints, method: str) -> None:
    """Files of which each process reads its part."""
    _write_matrix(folder, system.K, order)
    joints = system.joints() if method == "petsc" and system.joints is not None else None
    bodies = system if joints is None else joints.bodies
    motions = bodies.near_nullspace
    if bodies.prolongation is not None:
        motions = bodies.prolongation @ motions
    np.save(folder / "motions.npy", _blockwise(motions, order))
    apart = _apart(bodies.K, system.elements) if method == "petsc" else system.K
    if apart is not system.K:
        _write_matrix(folder / "bodies", apart, order)
    if joints is not None:
        _write_joints(folder / "bodies", joints, order)
    setup = {
        "blocks": len(order),
        "method": method,
        "apart": apart is not system.K,
        "joined": joints is not None,
    }
    (folder / "setup.json").write_text(json.dumps(setup))


def _apart(K: sparse.bsr_array, elements: Elements | None) -> sparse.bsr_array:
    """The stiffness without what couples bodies, for an aggregate must not be of two of them.

    What is left of a symmetric positive definite matrix is so, too. The few motions of bodies
    against each other that the coupling adds cost an iteration each.
    """
    if elements is None:
        return K
    body = np.full(K.shape[0] // 3, -1)
    body[: len(elements.points)] = connected_bodies(elements.cells, len(elements.points))
    a, b = body[np.repeat(np.arange(len(body)), np.diff(K.indptr))], body[K.indices]
    dropped = (a != b) & (a >= 0) & (b >= 0)
    if not dropped.any():
        return K
    data = np.where(dropped[:, None, None], 0.0, K.data)
    return sparse.bsr_array((data, K.indices, K.indptr), shape=K.shape)


def _write_matrix(folder: Path, K: sparse.bsr_array, order: Ints) -> None:
    folder.mkdir(exist_ok=True)
    blocks = len(order)
    number = np.arange(1, len(K.indices) + 1)
    places = sparse.csr_array((number, K.indices, K.indptr), shape=(blocks, blocks))
    places = places[order][:, order]
    places.sort_indices()
    np.save(folder / "indptr.npy", places.indptr.astype(np.int64))
    np.save(folder / "indices.npy", places.indices)
    np.save(folder / "data.npy", K.data[places.data - 1])


def _write_joints(folder: Path, joints: Joints, order: Ints) -> None:
    """Joints that take means over faces; see `multigrid.Joined`."""
    dofs = (3 * order[:, None] + np.arange(3)).ravel()
    place = np.empty_like(dofs)
    place[dofs] = np.arange(len(dofs))
    sums = joints.sums
    sparse.save_npz(folder / "rows.npz", sums.rows.tocsc()[:, dofs])
    sparse.save_npz(folder / "shares.npz", sums.shares.tocsc()[:, dofs])
    np.save(folder / "flexibility.npy", sums.flexibility)
    np.save(folder / "dofs.npy", place[sums.dofs])
    np.save(folder / "free.npy", joints.free[dofs])


def _blockwise(values: Floats, order: Ints) -> Floats:
    """(3 n, m) values in another order of nodes."""
    return np.ascontiguousarray(values.reshape(len(order), -1)[order]).reshape(values.shape)


def _launch() -> list[str]:
    named = os.environ.get(MPI_VARIABLE, "").strip()
    return shlex.split(named) if named else ["mpiexec", "-n", str(cores())]


def _count(launch: list[str]) -> int:
    """How many processes a command starts, for the parts; any number is right."""
    for word, number in pairwise(launch):
        if word in ("-n", "-np") and number.isdecimal():
            return max(1, int(number))
    return cores()


def _environment() -> dict[str, str]:
    """Each process has one thread; Open MPI is told that there may be more of them than cores."""
    values = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    values |= thread_limits(1)
    values |= {
        "OMPI_MCA_rmaps_base_oversubscribe": "1",
        "OMPI_MCA_hwloc_base_binding_policy": "none",
        "OMPI_MCA_mpi_yield_when_idle": "1",
    }
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        # Open MPI asks for both before it works for root, as in a container
        values |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    return values


def _end(process: subprocess.Popen[str], folder: Path) -> None:
    """Let the processes end; they do once nothing more can come."""
    for stream in (process.stdin, process.stdout):
        if stream is not None:
            with suppress(OSError):
                stream.close()
    try:
        process.wait(10.0)
    except subprocess.TimeoutExpired:
        process.terminate()
        process.wait()
    shutil.rmtree(folder, ignore_errors=True)
