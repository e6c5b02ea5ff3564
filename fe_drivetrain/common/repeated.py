"""Work that is done again whenever something changes, but takes a small share of the time only."""

import threading
import time
from collections.abc import Callable

CHEAP = 0.05
"""Seconds of a processor: what takes no longer is done at once, each time."""

REST = 40.0
"""Of other work, it rests for so many times as long as it took."""


class Repeated:
    """Work that follows changes: at once where it is cheap, soon where it is not.

    Pages that list cases, written for each beginning and each end of a case, would take a time that
    grows with the square of how many there are.

    Parameters
    ----------
    work : callable
        Shows how things stand. It is called by one thread at a time.
    """

    def __init__(self, work: Callable[[], object]) -> None:
        self._work = work
        self._lock = threading.Lock()
        self._due = 0.0
        self._timer: threading.Timer | None = None

    def soon(self) -> None:
        """Do the work now, or when it has rested; changes until then share one turn."""
        with self._lock:
            if self._timer is not None:
                return
            wait = self._due - time.monotonic()
            if wait <= 0.0:
                self._do()
            else:
                self._timer = threading.Timer(wait, self._later)
                self._timer.daemon = True
                self._timer.start()

    def stop(self) -> None:
        """Do nothing more of what waits; what is being done comes to its end."""
        with self._lock:
            if self._timer is not None:
                self._timer.cancel()
                self._timer = None

    def _later(self) -> None:
        with self._lock:
            if self._timer is not None:  # else stopped while it waited for the lock
                self._timer = None
                self._do()

    def _do(self) -> None:
        start = time.thread_time()
        self._work()
        took = time.thread_time() - start
        if took > CHEAP:
            self._due = time.monotonic() + REST * took
