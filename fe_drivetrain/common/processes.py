"""Independent jobs in processes side by side, which together take no more threads than cores.

A job is a function of a module that can be imported, called with a function that reports steps and
with arguments that can be pickled. On one core, or for one job, there are no processes at all.
"""

from __future__ import annotations

import multiprocessing
import os
import pickle
import queue
import sys
import threading
from collections.abc import Callable, Collection, Iterator
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import AbstractContextManager, ExitStack, nullcontext, suppress
from functools import partial
from types import TracebackType
from typing import Any, TypeVar

from fe_drivetrain.common.files import scratch_folder
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.threads import cores, held_to_one_thread, thread_limits
from fe_drivetrain.common.worker import Worker

_T = TypeVar("_T")


class Processes:
    """Processes that do jobs side by side, for as long as a ``with`` block lasts.

    Whatever ends the block early, Ctrl-C included, ends them all at once; at its normal end they
    finish what they were given.

    Parameters
    ----------
    jobs : int
        How many jobs may run at once; the cores may allow fewer.
    report : Progress
        Shows the steps of all processes; it is called from several threads.
    always : bool
        Take a process even for one job or on one core, so that the job starts afresh.
    each_for_itself : bool
        What one job raises, or the death of its process, is raised by its result alone. Otherwise
        it ends all others at once, and their results raise it, too.

    Attributes
    ----------
    count : int
        How many there are at most; 0 where jobs are done in this process.
    """

    def __init__(
        self,
        jobs: int,
        report: Progress = silent,
        always: bool = False,
        each_for_itself: bool = False,
    ) -> None:
        available = cores()
        self.count = max(1, min(jobs, available))
        # A process that is itself one of several has its share of the cores already.
        is_beside_others = multiprocessing.parent_process() is not None
        can_start = bool(sys.executable) and os.name == "posix"
        if (self.count == 1 and not always) or is_beside_others or not can_start:
            self.count = 0
        self._environment = {**os.environ, **thread_limits(available // max(1, self.count))}
        self._report = report
        self._each_for_itself = each_for_itself
        self._futures: set[Future[Any]] = set()  # those that failed, or are not done
        self._workers: list[Worker] = []
        self._idle: queue.LifoQueue[Worker] = queue.LifoQueue()
        self._lock = threading.Lock()  # of what starts or ends a process
        self._cause: BaseException | None = None  # why all have ended
        self._stack = ExitStack()

    def __enter__(self) -> Processes:
        if self.count:
            self._threads = ThreadPoolExecutor(self.count, "job")
            folder = self._stack.enter_context(scratch_folder())
            self._stack.enter_context(held_to_one_thread())
            for lane in range(1, self.count + 1):
                self._workers.append(Worker(lane, self._environment, folder / str(lane)))
            for worker in reversed(self._workers):
                self._idle.put(worker)
        return self

    def start(self, function: Callable[..., _T], *arguments: Any) -> Future[_T]:
        """Hand in ``function(report, *arguments)``.

        Where there are no processes, it is done when its result is asked for, or at the end.

        Parameters
        ----------
        function : callable
            Function of a module that can be imported.
        *arguments : Any
            Anything that can be pickled.

        Returns
        -------
        job : Future
            Its result raises what the function raised; its traceback says where.

        Raises
        ------
        ValueError
            The function is of a script, from which another process cannot import it.
        """
        future: Future[_T]
        if not self.count:
            future = _Postponed(partial(function, self._report, *arguments))
        elif function.__module__ == "__main__":
            raise ValueError(f"{function.__qualname__} must stand in a module, not in a script")
        else:
            future = self._threads.submit(self._do, function, arguments)
        self._futures.add(future)
        future.add_done_callback(self._forget)
        return future

    def finished(self, jobs: Collection[Future[_T]]) -> Iterator[Future[_T]]:
        """Jobs in the order in which they are done."""
        for job in as_completed(jobs) if self.count else jobs:
            with self._without_failures():
                job.result()
            yield job

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            for future in list(self._futures) if error is None else ():
                with self._without_failures():
                    future.result()
        finally:
            if self.count:
                self.end(error or CancelledError())
                self._threads.shutdown(cancel_futures=True)
                printed = "".join(worker.printed() for worker in self._workers)
                self._stack.close()
                sys.stderr.write(printed)  # warnings, say, as this process would have printed them

    def _forget(self, future: Future[Any]) -> None:
        """Keep no result that the caller may have done with."""
        if not future.cancelled() and future.exception() is None:
            self._futures.discard(future)

    def _without_failures(self) -> AbstractContextManager[None]:
        return suppress(Exception) if self._each_for_itself else nullcontext()

    def _do(self, function: Callable[..., _T], arguments: tuple[Any, ...]) -> _T:
        """Have an idle process do a job."""
        worker = self._idle.get()
        error: BaseException
        try:
            job = pickle.dumps((function, arguments), pickle.HIGHEST_PROTOCOL)
            with self._lock:
                if self._cause is not None:
                    raise self._cause
                future = worker.submit(job)
            worker.pass_steps_on(self._report)
            result: _T = future.result()
            return result
        except BrokenProcessPool:
            with self._lock:
                worker.kill()
                error = worker.why_it_died()
        except BaseException as raised:
            error = raised
        finally:
            if self._cause is None:
                self._report("", worker.lane)
            self._idle.put(worker)
        if not self._each_for_itself:
            self.end(error)
        raise self._cause or error

    def end(self, cause: BaseException) -> None:
        """End all processes at once; what was handed in and is not done raises the cause."""
        with self._lock:
            self._cause = self._cause or cause
            for worker in self._workers:
                worker.kill()


class _Postponed(Future[_T]):
    """A job that this process does itself when its result is asked for."""

    def __init__(self, work: Callable[[], _T]) -> None:
        super().__init__()
        self._work = work

    def result(self, timeout: float | None = None) -> _T:
        if not self.done():
            try:
                self.set_result(self._work())
            except BaseException as error:
                self.set_exception(error)
        return super().result(timeout)
