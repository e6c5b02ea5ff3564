"""Progress of a command on standard error: each step as it begins, and the time that it took.

On a terminal, steps that run are live lines, one for each parallel process (lane); a step that has
ended stays above them as a line of its own. In a log file there is one line of each step, at its
beginning: what runs, or hangs, is the last one.
"""

from __future__ import annotations

import re
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import IO, TYPE_CHECKING, cast

from fe_drivetrain.command_line.terminal import Stream

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress as Display
    from rich.progress import TaskID

    from fe_drivetrain.common.progress import Progress


_COUNT = re.compile(r"^(.*) \((\d+) of (\d+)\)$")
_OFTEN = 30.0  # seconds between the lines of one step that counts, in a log file


@dataclass
class _Step:
    """A step that is shown; ``counted`` is what it had counted to when it began."""

    name: str
    task: TaskID
    began: float
    counted: int
    shown: float

    def progress(self, step: str, now: float) -> str:
        """The step with the time that is left, at the pace it had so far."""
        found = _COUNT.match(step)
        done = int(found[2]) - self.counted if found else 0
        if found is None or done <= 0:
            return step
        left = (now - self.began) / done * (int(found[3]) - int(found[2]))
        return f"{step}, about {_duration(left)} left" if left >= 1.0 else step


def _duration(seconds: float) -> str:
    """Seconds, minutes or hours, rounded."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"


@contextmanager
def show_steps() -> Iterator[Progress]:
    """Show steps, each from its report until the next one of its lane.

    Yields
    ------
    Progress
        Called with a step and its lane: 0 for this process, 1 and on for those in parallel to it.
        An empty step ends the last one. A step that counts, as in "loads (12 of 144)", is one step,
        which says how long the rest will take at its pace so far.
    """
    from rich.console import Console
    from rich.progress import Progress as Display
    from rich.progress import SpinnerColumn, TextColumn, TimeElapsedColumn

    console = Console(file=cast(IO[str], Stream(sys.stderr)), highlight=False)
    display = Display(
        SpinnerColumn(),
        TextColumn("{task.description}", markup=False),
        TimeElapsedColumn(),
        console=console,
        transient=True,
        disable=not console.is_terminal,
    )
    steps = _Lanes(console, display)
    with display:
        try:
            yield steps.report
        except BaseException:
            steps.end_all("not finished")
            raise
        steps.end_all()


class _Lanes:
    """The step that each lane is at, as lines of a terminal or a log file."""

    def __init__(self, console: Console, display: Display) -> None:
        self._console, self._display = console, display
        self._lock = threading.Lock()  # parallel processes report from threads
        self._running: dict[int, _Step] = {}

    def report(self, step: str, lane: int = 0) -> None:
        """Show that a lane is at a step, which ends the one before."""
        found = _COUNT.match(step)
        name, counted = (found[1], int(found[2])) if found else (step, 0)
        now = time.perf_counter()
        with self._lock:
            current = self._running.get(lane)
            if current is not None and current.name == name:
                self._go_on(current, step, now)
                return
            self._end(lane)
            if name:
                if not self._console.is_terminal:
                    self._show(f"{name} ...")
                task = self._display.add_task(step, total=None)
                self._running[lane] = _Step(name, task, now, counted, now)

    def end_all(self, outcome: str = "") -> None:
        """End the steps of all lanes."""
        for lane in list(self._running):
            self._end(lane, outcome)

    def _go_on(self, current: _Step, step: str, now: float) -> None:
        text = current.progress(step, now)
        self._display.update(current.task, description=text)
        if not self._console.is_terminal and now - current.shown > _OFTEN:
            self._show(text)
            current.shown = now

    def _end(self, lane: int, outcome: str = "") -> None:
        if lane in self._running:
            step = self._running.pop(lane)
            self._display.remove_task(step.task)
            if outcome or self._console.is_terminal:
                seconds = time.perf_counter() - step.began
                self._show(f"{step.name} ... {outcome or f'{seconds:.1f} s'}")

    def _show(self, line: str) -> None:
        self._console.print(line, markup=False, soft_wrap=True)
