"""Whether this machine can draw without a screen, and what it draws with.

VTK is imported when the first picture is drawn. A machine may be unable to draw: then
`NoPictureError` is raised, and a case says so on its page in the picture's place instead of
failing.
"""

from __future__ import annotations

import functools
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


class NoPictureError(Exception):
    """This machine cannot draw; the message says why."""


@functools.cache
def _refusal(interpreter: str) -> str:
    """Why this machine cannot draw; empty where it can.

    VTK ends the whole process where there is no OpenGL at all, so another process tries first.
    """
    trial = (
        "import vtkmodules.vtkRenderingOpenGL2\n"
        "from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow\n"
        "window = vtkRenderWindow()\n"
        "window.SetOffScreenRendering(1)\n"
        "window.AddRenderer(vtkRenderer())\n"
        "window.Render()\n"
    )
    try:
        tried = subprocess.run(
            [interpreter, "-P", "-c", trial],
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"a trial of off-screen rendering did not end well ({error})"
    if tried.returncode == 0:
        return ""
    missing = [line for line in tried.stderr.splitlines() if line.startswith("ImportError: ")]
    if missing:
        return f"VTK cannot be loaded ({missing[-1].removeprefix('ImportError: ')})"
    return "there is no OpenGL for off-screen rendering: install Mesa's libEGL or libOSMesa"


def can_draw() -> bool:
    """Whether this machine can draw pictures."""
    return not _refusal(sys.executable)


@contextmanager
def off_screen_plotter(size: tuple[int, int]) -> Iterator[Any]:
    """A pyvista.Plotter without a screen, of a size in pixels, on white.

    Raises
    ------
    NoPictureError
        This machine cannot draw.
    """
    if reason := _refusal(sys.executable):
        raise NoPictureError(reason)
    import pyvista
    from vtkmodules.vtkCommonCore import vtkLogger

    # VTK warns on the terminal about every missing display before it finds one that works
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    plotter: Any = pyvista.Plotter(off_screen=True, window_size=list(size))
    try:
        plotter.set_background("white")
        plotter.enable_anti_aliasing("ssaa")
        yield plotter
    finally:
        plotter.close()
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_WARNING)
