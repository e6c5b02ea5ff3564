"""A clock for the steps of a piece of work."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import ParamSpec, TypeVar

from fe_drivetrain.common.progress import DETAILS, Progress, silent

_P = ParamSpec("_P")
_T = TypeVar("_T")


@dataclass
class Step:
    """A step as it runs; its time is kept under the name that it has at its end."""

    name: str


class Clock:
    """Steps of a piece of work: each is reported as it begins, and its wall time kept.

    Attributes
    ----------
    report : callable
        Called with the name of each step as it begins.
    times : dict
        Wall time of each finished step [s].
    """

    report: Progress
    times: dict[str, float]

    @contextmanager
    def step(self, name: str) -> Iterator[Step]:
        """Show a step while it runs, and add its wall time to `times`."""
        self.report(name)
        step = Step(name)
        start = time.perf_counter()
        before = DETAILS.set(lambda detail: self.report(f"{name}: {detail}"))
        try:
            yield step
        finally:
            DETAILS.reset(before)
        self.add_time(step.name, time.perf_counter() - start)

    def timed(
        self, name: str, function: Callable[_P, _T], *args: _P.args, **kwargs: _P.kwargs
    ) -> _T:
        """What the function returns, called as a step of that name."""
        with self.step(name):
            return function(*args, **kwargs)

    def clocked(
        self, name: str, function: Callable[_P, _T], *args: _P.args, **kwargs: _P.kwargs
    ) -> _T:
        """The same as `timed`, not shown: part of a step that counts, as "shafts (3 of 200)"."""
        start = time.perf_counter()
        found = function(*args, **kwargs)
        self.add_time(name, time.perf_counter() - start)
        return found

    def add_time(self, name: str, seconds: float) -> None:
        """Add to the wall time of a step."""
        self.times[name] = self.times.get(name, 0.0) + seconds

    def add_times(self, times: Mapping[str, float]) -> None:
        """Add the wall times of steps that another clock has measured."""
        for name, seconds in times.items():
            self.add_time(name, seconds)


@dataclass
class Steps(Clock):
    """A clock by itself, for work that has no run of a case around it."""

    report: Progress = silent
    times: dict[str, float] = field(default_factory=dict)
