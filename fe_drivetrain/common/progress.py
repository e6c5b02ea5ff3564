"""How far a piece of work is, told to whoever shows it."""

from typing import Protocol


class Progress(Protocol):
    """Called with the name of each step as it begins."""

    def __call__(self, step: str, lane: int = 0) -> None:
        """Show a step of this process (lane 0) or of one beside it; an empty one ends the last."""


def silent(step: str, lane: int = 0) -> None:
    """Show nothing."""
