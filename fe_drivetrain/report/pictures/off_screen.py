"""Drawing without a screen, in the process that draws.

VTK is imported here when the first picture is drawn, and nowhere else: it takes a second, and it
ends its whole process where there is no OpenGL at all (`drawing_process`).
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def off_screen_plotter(size: tuple[int, int]) -> Iterator[Any]:
    """A pyvista.Plotter without a screen, of a size in pixels, on white."""
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
