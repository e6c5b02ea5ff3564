"""Starts a tool in a process of its own, on a leash of time, memory and threads."""

from __future__ import annotations

import importlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from fe_drivetrain.cases.performance.peers import runner
from fe_drivetrain.common.files import scratch_folder

TOOLS = (
    "this_project",
    "scikit_fem",
    "calculix",
    "ngsolve",
    "sfepy",
    "felupe",
    "dolfinx",
    "mfem",
    "kratos",
    "fedoo",
    "torch_fem",
)
"""Modules of this folder, each a tool."""

Status = Literal["done", "missing", "over time", "over memory", "failed"]

_THREADS = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "NUMBA_NUM_THREADS",
    "NUMEXPR_NUM_THREADS",
)
_POLL = 0.2
_SETTLE = 120.0
"""Seconds that imports, warm-up and taking the mesh in may take, beside the time limit."""


@dataclass(frozen=True)
class Variant:
    """A tool with one of its solvers.

    Attributes
    ----------
    tool : str
        Module of this folder.
    key : str
        Name of the solver in it.
    """

    tool: str
    key: str

    @property
    def _words(self) -> tuple[str, str, str]:
        words: tuple[str, str, str] = _module(self.tool).VARIANTS[self.key]
        return words

    @property
    def tool_name(self) -> str:
        """Name that its makers use."""
        return str(_module(self.tool).NAME)

    @property
    def name(self) -> str:
        """Tool and solver in words."""
        return f"{self.tool_name}: {self._words[0]}"

    @property
    def kind(self) -> str:
        """direct, iterative, or chosen by the tool."""
        return self._words[1]

    @property
    def rule(self) -> str:
        """The quadrature: the common one, or the tool's own."""
        return self._words[2]

    def __str__(self) -> str:
        return f"{self.tool}.{self.key}"


@dataclass(frozen=True)
class Limits:
    """What a process may use: seconds of solving, bytes, threads."""

    seconds: float
    bytes: float
    threads: int


@dataclass(frozen=True)
class Outcome:
    """How a process ended.

    Attributes
    ----------
    status : Status
        What happened.
    found : dict[str, Any]
        Of `runner.measure`, where it is done.
    reason : str
        In words, where it is not.
    elapsed : float
        Wall time of the whole process [s].
    """

    status: Status
    found: dict[str, Any] = field(default_factory=dict)
    reason: str = ""
    elapsed: float = 0.0


def variants_of(tool: str) -> list[Variant]:
    """All solvers of a tool."""
    return [Variant(tool, key) for key in _module(tool).VARIANTS]


def how_to_install(tool: str) -> str:
    """A command."""
    return str(_module(tool).INSTALL)


def launch(
    variant: Variant, problem: Path, warm_up: Path, limits: Limits, interpreter: str
) -> Outcome:
    """Run a tool once on a problem.

    Parameters
    ----------
    variant : Variant
        The tool and its solver.
    problem, warm_up : Path
        .npz files of `runner.write_problem`.
    limits : Limits
        Over them the process is ended.
    interpreter : str
        The Python that has the tool.
    """
    if os.name != "posix":
        return Outcome("missing", reason="this system has no sessions of processes: use Linux")
    words = [str(word) for word in getattr(_module(variant.tool), "LAUNCH", ())]
    before = [word.format(threads=limits.threads) for word in words]
    with scratch_folder() as folder:
        arguments = [variant.tool, variant.key, problem.resolve(), warm_up.resolve()]
        command = [*before, interpreter, runner.__file__, *map(str, arguments)]
        command += [str(folder / "result.json"), repr(limits.seconds)]
        start = time.perf_counter()
        with (folder / "log").open("w") as log:
            try:
                process = subprocess.Popen(
                    command,
                    cwd=folder,
                    stdin=subprocess.DEVNULL,
                    stdout=log,
                    stderr=log,
                    env=_environment(limits.threads, len(before) > 0, interpreter)
                    # what a process that is ended leaves behind goes with the folder
                    | {
                        "TMPDIR": str(folder),
                        "OMPI_MCA_btl_vader_backing_directory": str(folder),
                    },
                    start_new_session=True,
                )
            except FileNotFoundError as error:
                if error.filename != command[0]:
                    raise
                return Outcome("missing", reason=f"there is no program {error.filename}")
            try:
                ended = _wait(process, limits)
            finally:
                _end(process)
        elapsed = time.perf_counter() - start
        if ended is not None:
            return Outcome(ended, elapsed=elapsed)
        try:
            found = json.loads((folder / "result.json").read_text("utf-8"))
        except (OSError, ValueError):
            found = {}
        return _outcome(process.returncode, found, folder / "log", elapsed)


def _outcome(status: int, found: dict[str, Any], log: Path, elapsed: float) -> Outcome:
    """What a process that ended by itself has to say."""
    # a shell or mpiexec adds 128 to the number of the signal
    if status in (-signal.SIGALRM, 128 + signal.SIGALRM):
        return Outcome("over time", elapsed=elapsed)
    if "missing" in found:
        return Outcome("missing", reason=found["missing"], elapsed=elapsed)
    if "failed" in found:
        memory = "MemoryError" in found["failed"] or "bad_alloc" in found["failed"]
        return Outcome(
            "over memory" if memory else "failed", reason=found["failed"], elapsed=elapsed
        )
    if status != 0 or not found:
        lines = log.read_text("utf-8", errors="replace").strip().splitlines()
        said = lines[-1][:200] if lines else "without a word"
        no_module = "No module named" in said
        return Outcome(
            "missing" if no_module else "failed",
            reason=said if no_module else f"ended with status {status}: {said}",
            elapsed=elapsed,
        )
    return Outcome("done", found, elapsed=elapsed)


def _wait(process: subprocess.Popen[bytes], limits: Limits) -> Status | None:
    """Wait for the end of a process, or the limit that it went over."""
    latest = time.monotonic() + limits.seconds + _SETTLE
    while True:
        try:
            process.wait(_POLL)
            return None
        except subprocess.TimeoutExpired:
            pass
        if time.monotonic() > latest:
            return "over time"
        if sum(map(_resident, _session(process.pid))) > limits.bytes:
            return "over memory"


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a process, if it has not ended by itself, and whatever it left behind."""
    with suppress(OSError):
        os.killpg(process.pid, signal.SIGKILL)
    for pid in _session(process.pid):
        with suppress(OSError):
            os.kill(pid, signal.SIGKILL)
    process.wait()


def _session(leader: int) -> list[int]:
    """Processes that one which leads a session has started, and it; none without /proc."""
    found = []
    for entry in Path("/proc").glob("[0-9]*/stat"):
        try:
            # the name in brackets may hold anything
            after = entry.read_text("ascii", errors="replace").rpartition(")")[2].split()
        except OSError:
            continue
        if int(after[3]) == leader:
            found.append(int(entry.parent.name))
    return found


def _resident(pid: int) -> int:
    """Resident memory of a process [bytes]."""
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text("ascii").split()[1])
    except (OSError, IndexError):
        return 0
    return pages * os.sysconf("SC_PAGE_SIZE")


def _environment(threads: int, processes: bool, interpreter: str) -> dict[str, str]:
    """The environment with the number of threads; one a process where there are several."""
    values = dict(os.environ)
    values.update(dict.fromkeys(_THREADS, "1" if processes else str(threads)))
    if interpreter != sys.executable:
        values.pop("PYTHONPATH", None)  # of this Python
    if processes and hasattr(os, "geteuid") and os.geteuid() == 0:
        # Open MPI asks for both before it works for root, as in a container
        values |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    return values


def _module(tool: str) -> Any:
    return importlib.import_module(f"{__package__}.{tool}")


def parse(names: Sequence[str]) -> list[Variant]:
    """Variants of names such as "ngsolve" (all its solvers) or "ngsolve.multigrid".

    Raises
    ------
    KeyError
        There is none of that name.
    """
    found: list[Variant] = []
    for name in names:
        tool, _, key = name.partition(".")
        if tool not in TOOLS:
            raise KeyError(name)
        chosen = [v for v in variants_of(tool) if key in ("", v.key)]
        if not chosen:
            raise KeyError(name)
        found += [v for v in chosen if v not in found]
    return found
