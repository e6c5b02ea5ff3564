"""One process for jobs, a fresh interpreter: how it starts, reports its steps, dies and is ended.

It is a `concurrent.futures.ProcessPoolExecutor` of one worker, so that a worker that dies takes no
other with it. It leads a session of its own, which the terminal's Ctrl-C does not reach, and ends
itself and all that it has started when the process that started it is gone.
"""

import multiprocessing
import os
import pickle
import signal
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection
from multiprocessing.resource_tracker import ensure_running
from pathlib import Path
from types import ModuleType
from typing import Any

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.memory import collect_lasting_seldom
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.remarks import show_remarks_if_asked
from fe_drivetrain.common.threads import CORES_VARIABLE

_SPAWN = multiprocessing.get_context("spawn")
_STARTING = threading.Lock()
_QUIET_TRACKER = "ignore::UserWarning:multiprocessing.resource_tracker"
_LAST_LINES = 5
_HELD_BACK = {number for number in signal.Signals if number.name in ("SIGINT", "SIGPIPE")}


class Worker:
    """One process at a time: where it has died, the next job starts another.

    Parameters
    ----------
    lane : int
        Where its steps are shown.
    environment : dict
        Its environment variables.
    output : Path
        The file for what it prints.
    """

    def __init__(self, lane: int, environment: dict[str, str], output: Path) -> None:
        self.lane = lane
        self._environment = environment
        self._output = output
        self._executor: ProcessPoolExecutor | None = None

    def submit(self, job: bytes) -> Future[Any]:
        """Hand in a pickled function with its arguments; the process starts where there is none."""
        if self._executor is not None:
            return self._executor.submit(_do, job)
        self._steps, steps = _SPAWN.Pipe(duplex=False)
        setup = self._environment, str(self._output), steps
        with _inherited():
            executor = ProcessPoolExecutor(1, _SPAWN, _begin, setup)
            future = executor.submit(_do, job)
        (self._process,) = executor._processes.values()  # no public way before Python 3.14
        self._executor = executor
        steps.close()
        return future

    def pass_steps_on(self, report: Progress) -> None:
        """Report the steps of a job until it ends, or its process dies."""
        with suppress(EOFError):
            while (step := self._steps.recv()) is not None:
                report(step, self.lane)

    def kill(self) -> None:
        """End the process now, and what it has started."""
        if self._executor is not None:
            assert self._process.pid is not None
            with suppress(OSError):  # it leads no group yet, or all of its group have ended
                os.killpg(self._process.pid, signal.SIGKILL)
            self._process.kill()
            self._executor.shutdown()
            self._executor = None

    def why_it_died(self) -> Exception:
        """What to raise for a process that has ended before its job was done."""
        status = self._process.exitcode
        if status == -signal.SIGKILL:
            return InputError(
                "a process was killed by the system, most likely because memory ran out: set "
                f"{CORES_VARIABLE}=1 to have one at a time, or coarsen the mesh"
            )
        last = "\n".join(self.printed().splitlines()[-_LAST_LINES:])
        return RuntimeError(f"a process ended with status {status} before its job was done: {last}")

    def printed(self) -> str:
        """What its processes have printed."""
        return self._output.read_text(errors="replace") if self._output.exists() else ""


@contextmanager
def _inherited() -> Iterator[None]:
    """Prepare what a process that starts in here inherits, before it can prepare anything itself.

    A module in the user's current folder hides none of ours, the user's script is not run again,
    and Ctrl-C does not reach it. Threads of the executor inherit, too: writing to a process that
    has died must not end this one, even where a library has changed what SIGPIPE does. What a
    process that is killed leaves behind is freed by multiprocessing's own, which need not say so.
    """
    with _STARTING:
        main, before = sys.modules["__main__"], os.environ.get("PYTHONSAFEPATH")
        options = sys.warnoptions
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, ())
        sys.modules["__main__"] = ModuleType("__main__")
        os.environ["PYTHONSAFEPATH"] = "1"
        try:
            sys.warnoptions = [*options, _QUIET_TRACKER]
            ensure_running()  # multiprocessing's own process, at whose start SIGINT is let in again
            signal.pthread_sigmask(signal.SIG_BLOCK, _HELD_BACK)
            yield
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
            sys.modules["__main__"], sys.warnoptions = main, options
            del os.environ["PYTHONSAFEPATH"]
            if before is not None:
                os.environ["PYTHONSAFEPATH"] = before


# --- in the process ------------------------------------------------------------------------------

_steps: Connection
_sending = threading.Lock()


def _begin(environment: dict[str, str], output: str, steps: Connection) -> None:
    """Set the process up before it imports anything else."""
    global _steps
    _steps = steps
    os.environ.clear()
    os.environ.update(environment)
    os.setsid()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _HELD_BACK)
    file = os.open(output, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(file, 1)
    os.dup2(file, 2)
    sys.stdout = sys.stderr  # which does not wait with what it has
    collect_lasting_seldom()
    show_remarks_if_asked()
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    assert parent is not None
    parent.join()
    os.killpg(0, signal.SIGKILL)


def _send(step: str | None, lane: int = 0) -> None:
    """Send a step, or that the job has ended, to the other side."""
    with _sending:
        _steps.send(step)


def _do(job: bytes) -> Any:
    """Do a job, and raise only what can be sent."""
    try:
        function, arguments = pickle.loads(job)
        return function(_send, *arguments)
    except BaseException as error:
        try:
            pickle.loads(pickle.dumps(error))
        except Exception:
            raise RuntimeError(str(error)) from error
        raise
    finally:
        _send(None)
