"""Times of several runs: no figure from one, and no median without what lies about it."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from statistics import median
from typing import TypeVar

_T = TypeVar("_T")

RUNS = 5
"""Runs of a figure, at least."""


@dataclass(frozen=True)
class Times:
    """What each run took, in seconds."""

    seconds: tuple[float, ...]

    @property
    def least(self) -> float:
        """The quickest run [s]."""
        return min(self.seconds)

    @property
    def median(self) -> float:
        """The run in the middle, or the mean of two [s]."""
        return median(self.seconds)

    @property
    def most(self) -> float:
        """The slowest run [s]."""
        return max(self.seconds)

    def columns(self, what: str = "", unit: str = "s") -> dict[str, float]:
        """Least, median and most under the heads of a table.

        Parameters
        ----------
        what : str
            Named before the first of them.
        unit : str
            "s", "ms" or "µs".
        """
        factor = {"s": 1.0, "ms": 1e3, "µs": 1e6}[unit]
        begin = f"{what}, " if what else ""
        return {
            f"{begin}least [{unit}]": factor * self.least,
            f"{begin}median [{unit}]": factor * self.median,
            f"{begin}most [{unit}]": factor * self.most,
        }


def timed_runs(
    work: Callable[[], _T], repeats: int = RUNS, clock: Callable[[], float] = time.perf_counter
) -> tuple[_T, Times]:
    """Do something several times.

    Parameters
    ----------
    work : callable
        What is timed.
    repeats : int
        How often.
    clock : callable
        Gives seconds: of the wall, or ``time.process_time`` of this process.

    Returns
    -------
    made, times
        What the last run made, and what all took.
    """
    found = []
    for _ in range(max(repeats, 1)):
        start = clock()
        made = work()
        found.append(clock() - start)
    return made, Times(tuple(found))
