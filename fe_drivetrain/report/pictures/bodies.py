"""Parts of a mesh on a sheet: whole, cut open, bent; what the process that draws is asked for."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.report.pictures.sheet import FAINT, INK, Sheet
from fe_drivetrain.report.pictures.surfaces import curved_surface, cut_open, part_solid, sharp_edges


def add_part(sheet: Sheet, facets: Ints, points: Floats, colour: str) -> None:
    """Draw a part, whole."""
    surface = curved_surface(facets, points)
    sheet.solid(surface, sharp_edges(surface), colour)


def add_open_part(sheet: Sheet, facets: Ints, cells: Ints, points: Floats, colour: str) -> None:
    """Draw a part, cut open by a quarter."""
    sheet.solid(*cut_open(curved_surface(facets, points), part_solid(cells, points)), colour)


def add_ghost(sheet: Sheet, facets: Ints, points: Floats) -> None:
    """A part as it is without loads."""
    ghost = curved_surface(facets, points)
    sheet.plotter.add_mesh(ghost, color="#9aa5b1", opacity=0.16)
    sheet.plotter.add_mesh(sharp_edges(ghost), color=FAINT, line_width=2.0)


def add_shape(
    sheet: Sheet, facets: Ints, moved: Floats, u: Floats, limits: tuple[float, float]
) -> None:
    """A part as it is bent."""
    shape = curved_surface(facets, moved, u)
    sheet.coloured(shape, limits)
    sheet.plotter.add_mesh(sharp_edges(shape), color=INK, line_width=2.0)


def add_shape_with_elements(
    sheet: Sheet, facets: Ints, moved: Floats, u: Floats, limits: tuple[float, float]
) -> None:
    """A mesh as it is bent, with its elements' edges, their middles included."""
    import pyvista

    sheet.coloured(curved_surface(facets, moved, u), limits)
    sides = np.concatenate([facets[:, [a, m, b]] for a, m, b in ((0, 3, 1), (1, 4, 2), (2, 5, 0))])
    lines = np.column_stack([np.full(len(sides), 3), sides])
    # nearer to the eye than the surface that they lie on
    nearer = moved - 2e-3 * sheet.view.reach * sheet.view.forward
    edges = pyvista.PolyData(nearer, lines=lines.ravel())
    sheet.plotter.add_mesh(edges, color=INK, line_width=1.0, opacity=0.35)


def add_triangles(sheet: Sheet, points: Floats, triangles: Ints, colour: str) -> None:
    """A surface (n, 3) of triangles (k, 3)."""
    import pyvista

    surface = pyvista.PolyData.from_regular_faces(np.array(points), triangles.tolist())
    sheet.solid(surface, sharp_edges(surface), colour)
