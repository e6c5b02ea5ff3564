"""Time that kept results took when they were made, for work whose duration is a result, too."""

from __future__ import annotations

import time
from contextvars import ContextVar

_saved: ContextVar[float] = ContextVar("_saved", default=0.0)


def count_kept(seconds: float) -> None:
    """Count what a result took when it was made, now that it is read and not made.

    Parameters
    ----------
    seconds : float
        Wall time [s].
    """
    _saved.set(_saved.get() + seconds)


def kept_seconds() -> float:
    """What all results that were read so far took when they were made [s]."""
    return _saved.get()


def working_time() -> float:
    """A clock on which what is kept takes as long as when it was made [s]."""
    return time.perf_counter() + _saved.get()
