"""A picture of a component, deformed and coloured by displacement."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.mesh.mesh import Mesh, boundary
from fe_drivetrain.report.pictures import SIZE, NoPictureError, can_draw, exaggeration

_FROM = (-1.0, 0.75, 0.5)
"""Where the eye is: upstream, on the side of +y, above."""


def picture_of_displacements(mesh: Mesh, u: Floats, path: Path) -> float:
    """Draw a mesh, deformed, exaggerated and coloured by displacement.

    Parameters
    ----------
    mesh
        The mesh.
    u
        (n, 3) displacements of its nodes [m].
    path
        PNG to write, of `pictures.SIZE`.

    Returns
    -------
    factor
        How many times larger the displacements are drawn than they are.

    Raises
    ------
    NoPictureError
        This machine cannot draw.
    """
    if not can_draw():
        raise NoPictureError("there is no OpenGL for off-screen rendering")
    import pyvista
    from vtkmodules.vtkCommonCore import vtkLogger

    # VTK warns on the terminal about every missing display before it finds one that works
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    size = np.linalg.norm(u, axis=1)
    length = float(np.ptp(mesh.points, axis=0).max())
    factor = exaggeration(float(size.max()), length)
    facets = boundary(mesh)
    cells = {pyvista.CellType.QUADRATIC_TRIANGLE: facets}
    grid = pyvista.UnstructuredGrid(cells, mesh.points + factor * u)
    grid["displacement [mm]"] = 1e3 * size
    # the elements' edges, their middles included
    sides = np.concatenate([facets[:, [a, m, b]] for a, m, b in ((0, 3, 1), (1, 4, 2), (2, 5, 0))])
    lines = np.column_stack([np.full(len(sides), 3), sides])
    # nearer to the eye than the surface that they lie on
    nearer = 2e-3 * length * np.array(_FROM) / np.linalg.norm(_FROM)
    plotter: Any = pyvista.Plotter(off_screen=True, window_size=list(SIZE))
    try:
        plotter.set_background("white")
        plotter.enable_anti_aliasing("ssaa")
        plotter.add_mesh(
            grid.extract_surface(nonlinear_subdivision=1, algorithm="dataset_surface"),
            scalars="displacement [mm]",
            cmap="viridis",
            ambient=0.35,
            diffuse=0.7,
            scalar_bar_args={
                "color": "#1f2933",
                "title_font_size": 26,
                "label_font_size": 22,
                "position_x": 0.3,
                "position_y": 0.02,
                "width": 0.4,
            },
        )
        plotter.add_mesh(
            pyvista.PolyData(np.asarray(grid.points) + nearer, lines=lines.ravel()),
            color="#1f2933",
            line_width=1.0,
            opacity=0.35,
        )
        plotter.enable_parallel_projection()
        plotter.view_vector(_FROM, viewup=(0.0, 0.0, 1.0))
        plotter.screenshot(path)
    finally:
        plotter.close()
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_WARNING)
    return factor
