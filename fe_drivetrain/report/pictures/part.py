"""The picture of a part from a file, with names at the faces that a scene may pick."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.report.pictures.bodies import add_triangles
from fe_drivetrain.report.pictures.drawing_process import Picture, drawn
from fe_drivetrain.report.pictures.sheet import Plan, Sheet
from fe_drivetrain.report.pictures.view import View

Place = tuple[float, float, float]

_COLOUR = "#6ba292"
_MAXIMUM = 16  # names in a picture
_FROM = (0.6, 1.0, -0.55)
_AWAY = 130  # pixels from a place to its name


def picture_of_part(
    points: Floats, triangles: Ints, marks: Sequence[tuple[str, Place, Place, Place]], path: Path
) -> Picture:
    """Draw a surface, and names at places on it; `Picture.wait` returns when the file is there.

    Parameters
    ----------
    points : Floats
        (n, 3) nodes, in any unit.
    triangles : Ints
        (k, 3) of the surface.
    marks : sequence of (str, place, reach, normal)
        Names; their places; from the middle of a bore to an end of it, and the outward normal of a
        plane, else zeros. Those that are seen are drawn, the first at most.
    path : Path
        PNG to write.

    Raises
    ------
    NoPictureError
        This machine cannot draw.
    """
    view = View.fitting(points[np.unique(triangles)], _FROM, top=80, bottom=80)
    plan = Plan(view)
    plan.add(add_triangles, points, triangles, _COLOUR)
    middle = view.project(points.mean(axis=0))
    seen = [mark for mark in marks if np.dot(mark[3], view.forward) <= 0.0]
    for name, middle_of_it, reach, _ in seen[:_MAXIMUM]:
        towards = -np.sign(np.dot(reach, view.forward))
        place = np.array(middle_of_it) + towards * np.array(reach)
        away = view.project(place) - middle
        away = away / max(float(np.linalg.norm(away)), 1.0)
        plan.add(Sheet.note, place, name, (_AWAY * away[0], _AWAY * (away[1] or 1.0)))
    plan.add(Sheet.triad)
    return drawn(plan, path)
