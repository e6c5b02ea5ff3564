"""Independent jobs in processes side by side, and never more threads than cores.

Each process is a fresh interpreter, on every system alike: it takes jobs from its standard input
and answers on its standard output, both pickled. Its numerical libraries are told their share of
the cores before they are imported. The terminal's Ctrl-C does not reach it: whoever started it ends
it, and it ends by itself when that one is gone.

A job is a function of a module that can be imported, called with a function that reports steps and
with arguments that can be pickled. On one core, or for one job, there are no processes at all.
"""

from __future__ import annotations

import json
import os
import pickle
import queue
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import traceback
from collections.abc import Callable, Collection, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import ExitStack, contextmanager, nullcontext, suppress
from types import TracebackType
from typing import IO, Any, Generic, NoReturn, Protocol, TypeVar

from fe_drivetrain.common.errors import InputError

CORES_VARIABLE = "FE_DRIVETRAIN_CORES"
"""Environment variable: the most cores to use; with 1 there is one process with one thread."""

_IN_WORKER = "FE_DRIVETRAIN_WORKER"  # set in processes of this module, which start no others
_THREADS = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "BLIS_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
    "NUMEXPR_NUM_THREADS",
    "NUMBA_NUM_THREADS",
    "VTK_SMP_MAX_THREADS",
    "LP_NUM_THREADS",  # Mesa's software renderer, which draws the pictures
)
_POLL = 0.2  # seconds; Windows lets nothing interrupt a wait without end
_LAST_LINES = 5
_HEADER = struct.Struct("<Q")

_T = TypeVar("_T")


class Report(Protocol):
    """Told of each step as it begins."""

    def __call__(self, step: str, lane: int = 0) -> None:
        """Show a step of this process (lane 0) or of one beside it; an empty one ends the last."""


def silent(step: str, lane: int = 0) -> None:
    """Show nothing."""


def cores() -> int:
    """Cores to share among processes: those the system gives this one, or as `CORES_VARIABLE` says.

    Raises
    ------
    InputError
        The variable holds no whole number from 1 on.
    """
    named = os.environ.get(CORES_VARIABLE, "").strip()
    if named:
        if not named.isdecimal() or int(named) < 1:
            raise InputError(
                f"{CORES_VARIABLE} is {named!r}: give a whole number of cores, from 1 on"
            )
        return int(named)
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class Job(Generic[_T]):
    """A job that was handed in."""

    def __init__(self, future: Future[_T], processes: Processes) -> None:
        self.future = future
        self._processes = processes

    def is_done(self) -> bool:
        """Whether there is a result, or a failure."""
        return self.future.done()

    def result(self) -> _T:
        """Its result, as soon as it is there.

        Raises
        ------
        Exception
            What this job raised, or before that what any other job raised: all are then ended.
        """
        self._processes.wait_for(self.future)
        return self.future.result()


class Processes:
    """Processes that do jobs side by side, for as long as a ``with`` block lasts.

    Whatever ends the block early, Ctrl-C included, ends them all at once; at its normal end they
    finish what they were given.

    Attributes
    ----------
    count
        How many there are at most; 0 where jobs are done in this process.
    """

    def __init__(
        self,
        jobs: int,
        report: Report = silent,
        always: bool = False,
        each_for_itself: bool = False,
    ) -> None:
        """State how many there may be; they start when jobs come.

        Parameters
        ----------
        jobs
            How many jobs may run at once; the cores may allow fewer.
        report
            Shows the steps of all processes; it is called from several threads.
        always
            Take a process even for one job or on one core, so that the job starts afresh.
        each_for_itself
            What one job raises, or the death of its process, is told by its result alone, and does
            not end the others.
        """
        self._each_for_itself = each_for_itself
        available = cores()
        self.count = max(1, min(jobs, available))
        # A process that is itself one of several has its share of the cores already.
        if (self.count == 1 and not always) or os.environ.get(_IN_WORKER) or not sys.executable:
            self.count = 0
        self._environment = _environment(max(1, available // max(1, self.count)))
        self._report = report
        self._lock = threading.Lock()
        self._ended = False
        self._of_thread = threading.local()
        self._workers: list[_Worker] = []
        self._futures: list[Future[Any]] = []
        self._stack = ExitStack()

    def __enter__(self) -> Processes:
        if self.count:
            self._threads = ThreadPoolExecutor(self.count, "job")
            self._said = self._stack.enter_context(tempfile.TemporaryFile())
            self._stack.enter_context(_held_to_one_thread())
        return self

    def start(self, function: Callable[..., _T], *arguments: Any) -> Job[_T]:
        """Hand in ``function(report, *arguments)``.

        Where there are no processes, it is done when its result is asked for, or at the end.
        """
        future: Future[_T]
        if not self.count:
            future = _Postponed(lambda: function(self._report, *arguments))
        elif function.__module__ == "__main__":
            raise ValueError(f"{function.__qualname__} must stand in a module, not in a script")
        else:
            future = self._threads.submit(self._do, function, arguments)
        self._futures.append(future)
        return Job(future, self)

    def finished(self, jobs: Collection[Job[_T]]) -> Iterator[Job[_T]]:
        """Jobs in the order in which they are done."""
        waiting = list(jobs)
        while waiting:
            done = [job for job in waiting if job.is_done()] or waiting[:1] * (not self.count)
            for job in done:
                if not self._each_for_itself or not self.count:
                    job.result()
                waiting.remove(job)
                yield job
            if not done:
                wait([job.future for job in waiting], _POLL, FIRST_COMPLETED)

    def wait_for(self, future: Future[Any]) -> None:
        """Wait for a job; raises what any job has raised by then."""
        if isinstance(future, _Postponed):
            future.do()
            return
        while True:
            unfinished = []
            for other in [future] if self._each_for_itself else self._futures:
                if other.done():
                    other.result()
                else:
                    unfinished.append(other)
            if future not in unfinished:
                return
            wait(unfinished, _POLL, FIRST_COMPLETED)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            if kind is None:
                for future in self._futures:
                    with suppress(Exception) if self._each_for_itself else nullcontext():
                        self.wait_for(future)
        finally:
            if self.count:
                self._end()

    def _end(self) -> None:
        """End all processes at once; those without a job have nothing to lose."""
        with self._lock:
            self._ended = True
        for worker in self._workers:
            worker.kill()
        self._threads.shutdown(cancel_futures=True)
        for worker in self._workers:
            worker.close()
        said = _text(self._said)
        self._stack.close()
        if said:  # warnings, say, as they would have come from this process
            sys.stderr.write(said)

    def _do(self, function: Callable[..., _T], arguments: tuple[Any, ...]) -> _T:
        """Have a job done by the process that belongs to this thread."""
        worker: _Worker | None = getattr(self._of_thread, "worker", None)
        if worker is None:
            with self._lock:  # so that none is started that `_end` does not know
                if self._ended:
                    raise _GoneError
                worker = _Worker(self._environment, len(self._workers) + 1, self._said)
                self._workers.append(worker)
            self._of_thread.worker = worker
        try:
            result: _T = worker.do(function, arguments, self._report)
            return result
        except _GoneError:
            if not self._ended:
                self._of_thread.worker = None  # the next job has a process of its own
                worker.explain(_text(self._said))
            raise
        finally:
            if not self._ended:
                self._report("", worker.lane)


class _GoneError(Exception):
    """The process has ended."""


class _Postponed(Future[_T]):
    """A job that this process does itself when its result is asked for."""

    def __init__(self, work: Callable[[], _T]) -> None:
        super().__init__()
        self._work = work

    def do(self) -> None:
        if not self.done():
            try:
                self.set_result(self._work())
            except BaseException as error:
                self.set_exception(error)
                raise


class _Worker:
    """One process, from the side of the one that started it."""

    def __init__(self, environment: dict[str, str], lane: int, said: IO[bytes]) -> None:
        # -P: a module in the user's current folder must not hide one of ours.
        program = (
            "import json, sys; sys.path[:] = json.loads(sys.argv[1]); "
            "from fe_drivetrain.common.processes import _serve; _serve()"
        )
        self.lane = lane
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-c", program, json.dumps([str(p) for p in sys.path])],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=said,
            env=environment,
            # apart from the terminal's Ctrl-C
            start_new_session=True,
            creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),
        )
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._jobs, self._answers = self._process.stdin, self._process.stdout

    def do(self, function: Callable[..., _T], arguments: tuple[Any, ...], report: Report) -> _T:
        """Have a job done, and pass on the steps that it reports."""
        job = pickle.dumps((function, arguments), pickle.HIGHEST_PROTOCOL)
        try:
            _send(self._jobs, job)
            kind, value = pickle.loads(_receive(self._answers))
            while kind == "step":
                report(value, self.lane)
                kind, value = pickle.loads(_receive(self._answers))
        except (EOFError, BrokenPipeError) as error:
            raise _GoneError from error
        if kind == "error":
            raise value
        result: _T = value
        return result

    def kill(self) -> None:
        """End it now, and what it has started."""
        with suppress(OSError):
            if hasattr(os, "killpg"):
                os.killpg(self._process.pid, signal.SIGKILL)
            else:
                self._process.kill()
        self._process.wait()

    def close(self) -> None:
        """Let go of its pipes, which nobody may be using."""
        for stream in (self._jobs, self._answers):
            with suppress(OSError):
                stream.close()

    def explain(self, said: str) -> NoReturn:
        """Raise why it ended before its job was done."""
        status = self._process.wait()
        if status == -getattr(signal, "SIGKILL", 0):
            raise InputError(
                "a process was killed by the system, most likely because memory ran out: set "
                f"{CORES_VARIABLE}=1 to have one at a time, or coarsen the mesh"
            )
        last = "\n".join(said.splitlines()[-_LAST_LINES:])
        raise RuntimeError(f"a process ended with status {status} before its job was done: {last}")


def hold_threads() -> None:
    """Where the user limits the cores, hold what this process imports from now on to as many."""
    if os.environ.get(CORES_VARIABLE):
        limits = _limits(cores())
        if "numba" in sys.modules:  # which fails when told otherwise once its threads run
            del limits["NUMBA_NUM_THREADS"]
        os.environ.update(limits)


def _limits(threads: int) -> dict[str, str]:
    """Variables that give numerical libraries so many threads, or fewer where the user said so."""
    limits = {}
    for name in _THREADS:
        given = os.environ.get(name, "")
        fewer = given.isdecimal() and 0 < int(given) < threads
        limits[name] = given if fewer else str(threads)
    return limits


def _environment(threads: int) -> dict[str, str]:
    """This process's environment for one of several others."""
    return {**os.environ, **_limits(threads), _IN_WORKER: "1"}


@contextmanager
def _held_to_one_thread() -> Iterator[None]:
    """Keep the numerical libraries of this process, which are loaded already, to one thread."""
    from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]

    numba = sys.modules.get("numba")
    before = numba.get_num_threads() if numba is not None else 0
    if numba is not None:
        numba.set_num_threads(1)
    try:
        with threadpool_limits(1):
            yield
    finally:
        if numba is not None:
            numba.set_num_threads(before)


def _text(file: IO[bytes]) -> str:
    file.seek(0)
    return file.read().decode(errors="replace")


def _send(stream: IO[bytes], message: bytes) -> None:
    stream.write(_HEADER.pack(len(message)))
    stream.write(message)
    stream.flush()


def _receive(stream: IO[bytes]) -> bytes:
    """The next message; EOFError where the other side is gone."""
    header = stream.read(_HEADER.size)
    if len(header) < _HEADER.size:
        raise EOFError
    (size,) = _HEADER.unpack(header)
    message = stream.read(size)
    if len(message) < size:
        raise EOFError
    return message


# --- in the process ------------------------------------------------------------------------------


def _serve() -> None:
    """Do jobs as they come, until whoever sends them is gone."""
    with suppress(ValueError):  # not in the main thread
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    jobs_in = os.fdopen(os.dup(0), "rb")
    answers = os.fdopen(os.dup(1), "wb")
    # Whatever prints must not write into the answers, nor read the jobs.
    os.dup2(2, 1)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    jobs: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_take, args=(jobs_in, jobs), daemon=True).start()
    lock = threading.Lock()

    def answer(kind: str, value: object) -> None:
        message = pickle.dumps((kind, value), pickle.HIGHEST_PROTOCOL)
        try:
            with lock:
                _send(answers, message)
        except OSError:
            os._exit(1)

    def report(step: str, lane: int = 0) -> None:
        answer("step", step)

    while True:
        try:
            function, arguments = pickle.loads(jobs.get())
            answer("result", function(report, *arguments))
        except BaseException as error:
            answer("error", _portable(error))


def _take(stream: IO[bytes], jobs: queue.SimpleQueue[bytes]) -> None:
    """Take jobs in; at the end of them nobody waits for an answer any more."""
    while True:
        try:
            jobs.put(_receive(stream))
        except (EOFError, OSError):
            os._exit(1)


def _portable(error: BaseException) -> BaseException:
    """The error as it can be sent, with the place where it was raised."""
    where = "".join(traceback.format_exception(error))
    error.__cause__ = error.__context__ = None
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        error = RuntimeError(str(error))
    error.add_note(f"In another process:\n{where}")
    return error
