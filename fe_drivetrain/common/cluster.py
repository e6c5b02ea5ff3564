"""Jobs on an existing cluster of Dask: what `Processes` is on this machine.

Dask's scheduler gives a job of a worker that has died to another worker; each result comes back
once. A worker does one job at a time, on one thread, as a local process beside others does, and
only with the same program and the same kernels of linear algebra: figures are the same to the last
digit wherever a job is done.
"""

from __future__ import annotations

import logging
import os
import pickle
import socket
import sys
import time
import uuid
from collections.abc import Callable, Collection, Iterator
from concurrent.futures import CancelledError, Future, as_completed
from contextlib import chdir, closing, contextmanager, nullcontext, suppress
from dataclasses import dataclass
from functools import cache as once
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, TypeVar

from fe_drivetrain.common.cache import CACHE_VARIABLE, user_cache
from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.provenance import machine, program_hash
from fe_drivetrain.common.threads import (
    CORES_VARIABLE,
    held_to_one_thread,
    hold_threads,
    thread_limits,
)

if TYPE_CHECKING:
    from distributed import Client

_T = TypeVar("_T")

_OFTEN = 0.5  # seconds between the steps that one job sends
_SHOWN = 16  # workers whose steps are shown
_CONNECT = 10.0  # seconds


@dataclass(frozen=True)
class Maker:
    """What decides a job's figures to the last digit.

    Attributes
    ----------
    program : str
        Hash of the sources.
    kernels : tuple of str
        System, processor, and the kernels that each BLAS chose for it.
    """

    program: str
    kernels: tuple[str, ...]


@once
def this_maker() -> Maker:
    """That of this process."""
    import scipy.linalg  # noqa: F401 - loads its BLAS
    from threadpoolctl import threadpool_info  # type: ignore[import-untyped]

    chosen = {str(found["architecture"]) for found in threadpool_info() if "architecture" in found}
    return Maker(program_hash(), (machine(), *sorted(chosen)))


@contextmanager
def connected(address: str) -> Iterator[Client]:
    """A connection to a scheduler, this process being held to one thread, as workers are.

    Parameters
    ----------
    address : str
        As the scheduler prints it, "tcp://127.0.0.1:8786".

    Raises
    ------
    MissingToolError
        Dask's distributed is not installed.
    InputError
        There is no scheduler at the address.
    """
    before = {name: os.environ.get(name) for name in (CORES_VARIABLE, *thread_limits(1))}
    try:
        os.environ[CORES_VARIABLE] = "1"
        hold_threads()
        with closing(_client(address)) as client, held_to_one_thread():
            yield client
    finally:
        os.environ |= {name: value for name, value in before.items() if value is not None}
        for name in (name for name, value in before.items() if value is None):
            os.environ.pop(name, None)


def _client(address: str) -> Client:
    """A client of the scheduler there, or an error as of `connected`."""
    try:
        from distributed import Client
    except ImportError as error:
        raise MissingToolError(
            "--scheduler needs Dask: install it with pip install 'fe-drivetrain[cluster]'"
        ) from error
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # what goes wrong is raised
    try:
        _await_listener(address)
        return Client(address, timeout=_CONNECT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(
            f"--scheduler {address}: no scheduler answers within {_CONNECT:g} s: start one with "
            "'dask scheduler' and give the address that it prints, as tcp://127.0.0.1:8786"
        ) from error


def _await_listener(address: str) -> None:
    """Wait until somebody listens at an address, at most as long as a client would.

    A client that finds nobody is left half made. The collector of garbage closes it some time
    later, and waits for ever where that is while the next one starts, which holds the same lock.
    """
    from distributed.comm import get_address_host_port

    place = get_address_host_port(address)
    end = time.monotonic() + _CONNECT
    while True:
        try:
            socket.create_connection(place, _CONNECT).close()
            return
        except OSError:
            if time.monotonic() > end:
                raise
        time.sleep(0.1)


class Cluster:
    """Workers of a cluster that do jobs side by side; see `Processes`, whose methods it has.

    Parameters
    ----------
    client : Client
        The connection.
    report : Progress
        Shows the steps of the first workers; it is called from another thread.
    each_for_itself : bool
        What one job raises is raised by its result alone. Otherwise it ends all others.

    Attributes
    ----------
    count : int
        How many workers there are; more may come, and some may go.
    """

    def __init__(
        self, client: Client, report: Progress = silent, each_for_itself: bool = False
    ) -> None:
        self.count = max(1, len(client.scheduler_info(n_workers=-1)["workers"]))
        self._client = client
        self._report = report
        self._each_for_itself = each_for_itself
        self._pending: set[Future[Any]] = set()
        self._lanes: dict[str, int] = {}
        self._topic = f"fe-drivetrain-{uuid.uuid4()}"

    def __enter__(self) -> Cluster:
        self._executor = self._client.get_executor(pure=False)
        self._client.subscribe_topic(self._topic, self._show)
        folder = user_cache().folder
        kept = "off" if folder is None else str(folder.absolute())
        self._job = partial(_do, this_maker(), self._topic, kept, str(Path.cwd()))
        return self

    def start(self, function: Callable[..., _T], *arguments: Any) -> Future[_T]:
        """Hand in ``function(report, *arguments)``; see `Processes.start`."""
        if function.__module__ == "__main__":
            raise ValueError(f"{function.__qualname__} must stand in a module, not in a script")
        found: Future[_T] = Future()
        self._pending.add(found)
        job = self._executor.submit(self._job, function, arguments)
        job.add_done_callback(partial(self._pass_on, found))
        return found

    def finished(self, jobs: Collection[Future[_T]]) -> Iterator[Future[_T]]:
        """Jobs in the order in which they are done."""
        for job in as_completed(jobs):
            if not self._each_for_itself:
                job.result()
            yield job

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            for job in list(self._pending) if error is None else ():
                with suppress(*((Exception,) if self._each_for_itself else ())):
                    job.result()
        finally:
            self._client.unsubscribe_topic(self._topic)
            self._executor.shutdown(wait=False)  # cancels what has not been done

    def _pass_on(self, found: Future[Any], job: Future[Any]) -> None:
        """What became of a job, in words that a user can act on."""
        from distributed import KilledWorker

        try:
            found.set_result(job.result())
        except KilledWorker as error:
            found.set_exception(
                InputError(
                    f"a job ended {error.allowed_failures + 1} workers, one "
                    "after the other, most likely because memory ran out: give workers more "
                    "(--memory-limit), or coarsen the mesh"
                )
            )
        except CancelledError:
            found.set_exception(
                InputError(
                    "the scheduler gave up a job, or has ended: start it and its workers, and run "
                    "again; what was done is kept"
                )
            )
        except BaseException as error:
            found.set_exception(error)
        if self._each_for_itself or found.exception() is None:
            self._pending.discard(found)

    def _show(self, event: tuple[float, Any]) -> None:
        worker, step = event[1]
        lane = self._lanes.setdefault(worker, len(self._lanes) + 1)
        if lane <= _SHOWN:
            self._report(step, lane)


# --- on the worker -------------------------------------------------------------------------------


def _do(
    needed: Maker,
    topic: str,
    cache: str,
    folder: str,
    function: Callable[..., _T],
    arguments: tuple[Any, ...],
) -> _T:
    """Do a job on a worker, and raise only what can be sent."""
    from distributed import get_worker

    worker = get_worker()
    if worker.state.nthreads != 1:
        raise InputError(
            f"worker {worker.address} does {worker.state.nthreads} jobs at once in one process: "
            "start it with --nthreads 1, and as many workers as there are cores with --nworkers"
        )
    os.environ |= {CORES_VARIABLE: "1", CACHE_VARIABLE: cache}
    hold_threads()
    found = this_maker()
    if found.program != needed.program:
        raise InputError(
            f"worker {worker.address} has another fe-drivetrain than this machine: install the "
            "same one there, and start the worker again"
        )
    if found.kernels != needed.kernels:
        raise InputError(
            f"worker {worker.address} calculates with {', '.join(found.kernels)}, this machine "
            f"with {', '.join(needed.kernels)}, so that last digits would differ: set "
            "OPENBLAS_CORETYPE to the older of the two on both"
        )
    last = 0.0

    def report(step: str, lane: int = 0) -> None:
        nonlocal last
        now = time.monotonic()
        if not step or now - last > _OFTEN:
            worker.log_event(topic, (worker.address, step))
            last = now

    try:
        # files are named as the user names them, from where the command was started
        with held_to_one_thread(), chdir(folder) if Path(folder).is_dir() else nullcontext():
            return function(report, *arguments)
    except FileNotFoundError as error:
        raise InputError(
            f"worker {worker.address} does not find {error.filename}: start the command in a "
            "folder that all workers share, and have the files there"
        ) from error
    except BaseException as error:
        try:
            pickle.loads(pickle.dumps(error))
        except Exception:
            raise RuntimeError(str(error)) from error
        if isinstance(error, Exception):
            raise
        raise RuntimeError(f"{type(error).__name__}: {error}") from error  # not the worker's end
    finally:
        report("")
        sys.stdout.flush()
