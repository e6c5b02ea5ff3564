"""Stops by a signal, however deep libraries hide them: found in one place, for all programs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextvars import ContextVar

STOPPED, TERMINATED = 130, 143
"""Exit statuses: stopped by Ctrl-C, stopped by SIGTERM."""


EARLIER = "results of an earlier run are unchanged"
NOTHING = "no results are written"

_replaces: ContextVar[bool] = ContextVar("_replaces", default=False)


def replacing(earlier: bool) -> None:
    """Note whether a run that begins has results of an earlier one to replace.

    Parameters
    ----------
    earlier : bool
        Whether there are any.
    """
    _replaces.set(earlier)


def left_by_stop() -> str:
    """What a stop leaves of results, as the end of a sentence."""
    return EARLIER if _replaces.get() else NOTHING


def causes(error: BaseException | None) -> Iterator[BaseException]:
    """An error, and all that led to it, each once.

    Parameters
    ----------
    error : BaseException or None
        Its causes, and what was being handled when it was raised, are looked through.
    """
    seen: set[int] = set()
    waiting = [error]
    while waiting:
        found = waiting.pop()
        if found is not None and id(found) not in seen:
            seen.add(id(found))
            yield found
            waiting += [found.__context__, found.__cause__]


def stop_status(error: BaseException | None) -> int | None:
    """The exit status of a program that a signal stopped; None of any other error.

    Python makes a `SystemError` of Ctrl-C in compiled code, numba of that another, and either may
    be raised while the first is handled.
    """
    for found in causes(error):
        if isinstance(found, KeyboardInterrupt):
            return STOPPED
        if isinstance(found, SystemExit) and found.code == TERMINATED:
            return TERMINATED
    return None


def until_stopped(work: Callable[[], int | None]) -> int:
    """The exit status of a program that others start: that of its work, or `STOPPED`.

    Parameters
    ----------
    work : callable
        Returns the exit status; None is 0.
    """
    try:
        return work() or 0
    except BaseException as error:
        status = stop_status(error)
        if status is None:
            raise
        return status
