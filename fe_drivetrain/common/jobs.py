"""Where jobs are done, of all studies: in processes of this machine, or on a cluster."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator
from concurrent.futures import Future
from contextlib import AbstractContextManager, contextmanager
from itertools import islice
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from fe_drivetrain.common.processes import Processes
from fe_drivetrain.common.progress import Progress, silent

if TYPE_CHECKING:
    from distributed import Client

_T = TypeVar("_T")

AT_ONCE = 64
"""Jobs that `mapped` has handed in, or whose results wait, at least; two for each worker."""

_client: Client | None = None


class Pool(Protocol):
    """What does jobs, see `Processes`; ``count`` is 0 where this process does them itself."""

    count: int

    def start(self, function: Callable[..., _T], *arguments: Any) -> Future[_T]:
        """Hand in ``function(report, *arguments)``."""

    def finished(self, jobs: Collection[Future[_T]]) -> Iterator[Future[_T]]:
        """Jobs in the order in which they are done."""


@contextmanager
def scheduled_by(address: str | None) -> Iterator[None]:
    """Have all jobs in here done by the cluster of a scheduler; on this machine where None.

    Parameters
    ----------
    address : str or None
        "tcp://127.0.0.1:8786".

    Raises
    ------
    InputError
        There is no scheduler, or Dask is not installed.
    """
    global _client
    if address is None:
        yield
        return
    from fe_drivetrain.common.cluster import connected

    with connected(address) as _client:
        try:
            yield
        finally:
            _client = None


def on_cluster() -> bool:
    """Whether jobs are done by a cluster."""
    return _client is not None


def pool(
    local: int, report: Progress = silent, each_for_itself: bool = False
) -> AbstractContextManager[Pool]:
    """What does jobs for as long as a ``with`` block lasts.

    Parameters
    ----------
    local : int
        How many jobs may run at once on this machine; see `Processes`. Of a cluster all workers
        are used.
    report : Progress
        Shows the steps of all jobs; it is called from several threads.
    each_for_itself : bool
        Whether what one job raises ends it alone, see `Processes`.
    """
    if _client is None:
        return Processes(local, report, each_for_itself=each_for_itself)
    from fe_drivetrain.common.cluster import Cluster

    return Cluster(_client, report, each_for_itself)


def mapped(
    function: Callable[..., _T],
    items: Iterable[tuple[Any, ...]],
    local: int,
    report: Progress = silent,
) -> Iterator[_T]:
    """Results of ``function(report, *item)``, each once, in the order of the items.

    Parameters
    ----------
    function : callable
        Function of a module that can be imported; any, where this machine has one process for it.
    items : iterable of tuple
        As many as there may be: few of them, and of their results, are in memory at a time.
    local : int
        Number of processes of this machine, see `pool`.
    report : Progress
        Called with what is being done, see `pool`.
    """
    upcoming = iter(items)
    with pool(local, report) as workers:
        waiting: deque[Future[_T]] = deque()
        most = max(AT_ONCE, 2 * workers.count)
        while True:
            for item in islice(upcoming, most - len(waiting)):
                waiting.append(workers.start(function, *item))
            if not waiting:
                return
            yield waiting.popleft().result()
