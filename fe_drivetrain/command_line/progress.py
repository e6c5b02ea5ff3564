"""Progress of a command on standard error: each step as it begins, and the time that it took.

On a terminal, steps that run are live lines, one for each parallel process (lane); a step that has
ended stays above them as a line of its own. In a log file there is a line at the beginning and one
at the end of each step.
"""

from __future__ import annotations

import io
import re
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import IO, TYPE_CHECKING, cast

from fe_drivetrain.command_line.terminal import write

if TYPE_CHECKING:
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


class _Stream(io.TextIOBase):
    """Standard error as it is now, for rich; it is no error when its reader has gone away."""

    def __init__(self) -> None:
        self._stream = sys.stderr

    def write(self, text: str) -> int:
        write(self._stream, text)
        return len(text)

    def isatty(self) -> bool:
        return self._stream.isatty()

    def fileno(self) -> int:
        return self._stream.fileno()


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

    console = Console(file=cast(IO[str], _Stream()), highlight=False)
    display = Display(
        SpinnerColumn(),
        TextColumn("{task.description}", markup=False),
        TimeElapsedColumn(),
        console=console,
        transient=True,
        disable=not console.is_terminal,
    )
    lock = threading.Lock()  # parallel processes report from threads
    running: dict[int, _Step] = {}

    def show(line: str) -> None:
        console.print(line, markup=False, soft_wrap=True)

    def end(lane: int, outcome: str = "") -> None:
        if lane in running:
            step = running.pop(lane)
            display.remove_task(step.task)
            show(f"{step.name} ... {outcome or f'{time.perf_counter() - step.began:.1f} s'}")

    def report(step: str, lane: int = 0) -> None:
        found = _COUNT.match(step)
        name, counted = (found[1], int(found[2])) if found else (step, 0)
        now = time.perf_counter()
        with lock:
            if lane in running and running[lane].name == name:
                current = running[lane]
                text = current.progress(step, now)
                display.update(current.task, description=text)
                if not console.is_terminal and now - current.shown > _OFTEN:
                    show(text)
                    current.shown = now
                return
            end(lane)
            if name:
                if not console.is_terminal:
                    show(f"{name} ...")
                running[lane] = _Step(name, display.add_task(step, total=None), now, counted, now)

    with display:
        try:
            yield report
        except BaseException:
            for lane in list(running):
                end(lane, "not finished")
            raise
        for lane in list(running):
            end(lane)
