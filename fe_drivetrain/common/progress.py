"""How far a piece of work is, reported to whatever shows it."""

from collections.abc import Callable
from contextvars import ContextVar
from typing import Protocol

OVERALL = -1
"""Lane of what counts the steps of all others, as in "cases (3 of 46)"."""


class Progress(Protocol):
    """Called with the name of each step as it begins."""

    def __call__(self, step: str, lane: int = 0) -> None:
        """Show a step of this process (lane 0), of one beside it, or `OVERALL`.

        An empty step ends the last one of its lane. Steps that count, "NAME (n of N)", are one.
        """


def silent(step: str, lane: int = 0) -> None:
    """Show nothing."""


def _no_details(detail: str) -> None:
    """Show nothing."""


DETAILS: ContextVar[Callable[[str], None]] = ContextVar("details", default=_no_details)
"""Shows how far the step is that runs now, for work that is many calls below it."""
