"""The process that draws: it imports VTK beside other work, and draws all pictures of a program.

It starts with the first picture, or earlier (`drawing_ready`), and is given plans of plain data, so
that neither it imports a solver nor its parent VTK. A machine may be unable to draw: then
`NoPictureError` is raised, and a case says so on its page in the picture's place instead of
failing. VTK ends the whole process where there is no OpenGL at all; so the first picture of the
process is a trial.
"""

from __future__ import annotations

import atexit
import multiprocessing
import os
import pickle
from collections.abc import Iterator
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fe_drivetrain.common.files import lasting_scratch_folder, scratch_folder
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.threads import cores, thread_limits
from fe_drivetrain.common.worker import Worker
from fe_drivetrain.report.pictures.sheet import Plan, Sheet, drawing
from fe_drivetrain.report.pictures.view import ALONG_THE_SHAFT, View

_PATIENCE = 60.0  # until the trial has ended [s]


class NoPictureError(Exception):
    """This machine cannot draw; the message says why."""


@dataclass(frozen=True, eq=False)
class Picture:
    """A picture that is being drawn.

    Attributes
    ----------
    ready : Future
        Done when the file is written.
    """

    ready: Future[None]

    def wait(self) -> None:
        """Return when the picture is there.

        Raises
        ------
        Exception
            What went wrong in drawing.
        """
        self.ready.result()


class _Process:
    """The process, which begins with a trial."""

    def __init__(self) -> None:
        folder, self._end_folder = lasting_scratch_folder()
        self._worker = Worker(1, {**os.environ, **thread_limits(cores())}, folder / "printed")
        self._trial: Future[None] = self._worker.submit(pickle.dumps((_try, ())))
        self._refusal: str | None = None
        atexit.register(self.end)

    def refusal(self) -> str:
        """Why this machine cannot draw; empty where it can."""
        if self._refusal is None:
            try:
                self._trial.result(_PATIENCE)
                self._refusal = ""
            except ImportError as error:
                self._refusal = f"VTK cannot be loaded ({error})"
            except BrokenProcessPool:
                self._refusal = (
                    "there is no OpenGL for off-screen rendering: install Mesa's libEGL or "
                    "libOSMesa"
                )
            except Exception as error:
                self._refusal = f"a trial of off-screen rendering did not end well ({error!r})"
        return self._refusal

    def draw(self, plan: Plan, path: Path) -> Picture:
        """Begin to draw."""
        return Picture(self._worker.submit(pickle.dumps((_draw, (plan, path.absolute())))))

    def end(self) -> None:
        """End the process at once."""
        atexit.unregister(self.end)
        self._worker.kill()
        self._end_folder()


_process: _Process | None = None


def _running() -> _Process:
    global _process
    if multiprocessing.current_process().daemon:
        raise NoPictureError("a process of a cluster's worker may start none that draws")
    if _process is None:
        _process = _Process()
    return _process


@contextmanager
def drawing_ready() -> Iterator[None]:
    """Have the process that draws start now, beside all that is done in here, and end with it."""
    global _process
    before = _process
    with suppress(NoPictureError):
        _running()
    try:
        yield
    finally:
        if before is None and _process is not None:
            _process.end()
            _process = None


def _refusal() -> str:
    """Why this machine cannot draw; empty where it can."""
    try:
        return _running().refusal()
    except NoPictureError as error:
        return str(error)


def can_draw() -> bool:
    """Whether this machine can draw pictures."""
    return not _refusal()


def drawn(plan: Plan, path: Path) -> Picture:
    """Begin to draw a picture; `Picture.wait` returns when it is there.

    Parameters
    ----------
    plan : Plan
        What it shows.
    path : Path
        PNG to write, of `view.SIZE`.

    Raises
    ------
    NoPictureError
        This machine cannot draw.
    """
    if reason := _refusal():
        raise NoPictureError(reason)
    return _running().draw(plan, path)


# --- in the process that draws -------------------------------------------------------------------


def _try(report: Progress) -> None:
    """Draw something of each kind: what is loaded and compiled for the first is there for all."""
    del report
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0]])
    plan = Plan(View.fitting(corners, ALONG_THE_SHAFT, top=60))
    plan.add(Sheet.area, plan.view.project(corners), "#888888")
    plan.add(Sheet.triad)
    with scratch_folder() as folder:
        _draw_here(plan, folder / "trial.png")


def _draw(report: Progress, plan: Plan, path: Path) -> None:
    del report
    _draw_here(plan, path)


def _draw_here(plan: Plan, path: Path) -> None:
    with drawing(path, plan.view) as sheet:
        for draw, arguments, options in plan.steps:
            draw(sheet, *arguments, **options)
