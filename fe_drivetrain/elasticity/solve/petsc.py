"""Systems in parts: MPI processes that have rows of the matrix each, preconditioned by PETSc.

Nodes are dealt out by recursive bisection of their coordinates, interfaces with the nodes that they
couple, so that each process has one compact part. Of an `ElementSystem` each process makes its rows
itself, of elements; of a `System` they come from the matrix. GAMG, algebraic multigrid by smoothed
aggregation of the rigid motions, or MUMPS, a direct factor, then precondition conjugate gradients,
which stop by the same estimate of the energy error as those of `multigrid`. Any Python of this
machine that has petsc4py runs the processes; ``FE_DRIVETRAIN_MPI`` says how they are started.
"""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import time
import weakref
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import cache as once
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import SINGULAR, InputError
from fe_drivetrain.common.files import lasting_scratch_folder
from fe_drivetrain.common.interpreter import interpreters
from fe_drivetrain.common.threads import cores, thread_limits
from fe_drivetrain.elasticity.solve.element_system import ElementSystem
from fe_drivetrain.elasticity.solve.multigrid import Iteration
from fe_drivetrain.elasticity.solve.rank_files import blockwise, hand_over
from fe_drivetrain.elasticity.solve.reduction import System
from fe_drivetrain.elasticity.solve.rounding import worst

METHODS = ("petsc", "petsc-mumps")

Facts = dict[str, Any]
"""Messages of processes about their work; see `Ranks`."""

MAXIMUM = 400
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


@dataclass(frozen=True)
class Checked(Iteration):
    """Result of the processes, and its residual, for they alone have the matrix.

    Attributes
    ----------
    residual : float
        Maximum |K x - f| / |f| over the columns.
    round_off : float
        Relative change of the energy by rounding, see `rounding.round_off`.
    """

    residual: float
    round_off: float


class Ranks:
    """Processes that have a system in parts, until this is no longer used.

    Parameters
    ----------
    system : ElementSystem or System
        System that they solve: an `ElementSystem`, of which each assembles its rows, or a `System`.
    method : str
        ``petsc`` (GAMG) or ``petsc-mumps``.

    Attributes
    ----------
    bytes : int
        Memory that setting up took of all processes together.
    facts : dict
        Facts that the first process answered then: number of processes; of each process the bytes
        that its part took and its peak memory in all, its entries and its elements; seconds and
        bytes of handing over, by this process; seconds of reading or assembling, and of setting up.

    Raises
    ------
    InputError
        There is no PETSc, or it cannot set up: the system is singular, or memory has run out.
    """

    def __init__(self, system: ElementSystem | System, method: str) -> None:
        python = interpreter()
        if python is None:
            raise InputError(
                f"solver {method!r} needs PETSc and MPI: {INSTALL}, or choose 'multigrid'"
            )
        launch = _launch()
        named = os.environ.get(FOLDER_VARIABLE)
        self._folder, end = lasting_scratch_folder(Path(named) if named else None)
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
        weakref.finalize(self, _end, self._process, end)
        count = self._answer()["ranks"]
        start = time.perf_counter()
        self._order = hand_over(self._folder, system, method, count)
        seconds = time.perf_counter() - start
        size = sum(file.stat().st_size for file in self._folder.rglob("*.np[yz]"))
        self._say({})
        handed = {"ranks": count, "hand_over_seconds": seconds, "hand_over_bytes": size}
        self.facts: Facts = self._answer() | handed
        self.bytes = sum(self.facts["bytes"])
        self._number = 0

    def solve(self, F: Floats, tolerance: float) -> Checked:
        """Solve for all columns, in turn.

        Parameters
        ----------
        F : Floats
            Right-hand sides (n, m).
        tolerance : float
            Energy error at which conjugate gradients stop.
        """
        self._number += 1
        np.save(self._folder / f"f-{self._number}.npy", blockwise(F, self._order))
        self._say({"number": self._number, "tolerance": tolerance, "most": MAXIMUM})
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
        return Checked(
            blockwise(x, back),
            found["iterations"],
            found["energy_error"],
            found["residual"],
            worst(np.array(found["sizes"]), np.array(found["energies"])),
        )

    def _say(self, request: dict[str, Any]) -> None:
        assert self._process.stdin is not None
        with suppress(BrokenPipeError):  # what became of them is in their answer
            self._process.stdin.write(json.dumps(request) + "\n")
            self._process.stdin.flush()

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


def _launch() -> list[str]:
    named = os.environ.get(MPI_VARIABLE, "").strip()
    return shlex.split(named) if named else ["mpiexec", "-n", str(cores())]


def _environment() -> dict[str, str]:
    """Each process has one thread; Open MPI is to accept more of them than cores."""
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


def _end(process: subprocess.Popen[str], remove: Callable[[], None]) -> None:
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
    remove()
