"""How far a limited process is, told to the one that has started it, see `reading`."""

from __future__ import annotations

from pathlib import Path

_told: list[Path] = []


def tell_to(file: Path) -> None:
    """Have steps written to a file, which the other process reads."""
    _told[:] = [file]


def tell(step: str) -> None:
    """Say which step begins, in a line; nobody is told in a process that nobody watches.

    Parameters
    ----------
    step : str
        What is done to how much, as in "healing 1,018 faces".
    """
    for file in _told:
        with file.open("a", encoding="utf-8") as lines:
            lines.write(f"{' '.join(step.split())}\n")
