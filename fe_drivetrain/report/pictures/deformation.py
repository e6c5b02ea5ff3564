"""Pictures of deformed shapes, exaggerated and coloured by displacement."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.elasticity.mesh.mesh import Mesh, boundary
from fe_drivetrain.report.pictures.bodies import add_ghost, add_shape, add_shape_with_elements
from fe_drivetrain.report.pictures.drawing_process import Picture, drawn
from fe_drivetrain.report.pictures.sheet import Plan, Sheet
from fe_drivetrain.report.pictures.view import ALONG_THE_SHAFT, SIZE, STRIP, View

if TYPE_CHECKING:
    from fe_drivetrain.shafts.response.model import Model
    from fe_drivetrain.shafts.response.unit_loads import Response

_EXAGGERATION = 0.08  # largest displacement as drawn, of the length of what is drawn
_VISIBLE = 4.0  # a movement as drawn that the eye can tell, pixels

_DEFORMED = "#2a788e"  # the middle of the scale of colours
_GHOST = "#d9dde1"

_TOWARDS_A_COMPONENT = (1.0, -0.75, -0.5)
"""From upstream, the side of +y, and above."""


def picture_of_deformation(
    model: Model, response: Response, load_factors: npt.ArrayLike, path: Path, title: str = ""
) -> tuple[float, Picture]:
    """Draw the deformed shape, exaggerated and coloured by displacement, over the undeformed one.

    It is drawn beside what follows: `Picture.wait` returns when the file is there.

    Parameters
    ----------
    model, response : Model, Response
        A model and its response to the unit loads.
    load_factors : array_like
        (10,) multiples of the loads of `fe_drivetrain.shafts.response.model.LOADS`.
    path : Path
        PNG to write, of `view.SIZE`.
    title : str
        What the load is, in a few words: written into the picture.

    Returns
    -------
    factor : float
        How many times larger the displacements are drawn than they are, for the caption. The
        largest is then about 8 % of the length of the shaft. 1 where nothing moves.
    picture : Picture
        The picture in the making.

    Raises
    ------
    NoPictureError
        This machine cannot draw.
    ValueError
        A displacement is not finite.
    """
    mesh = model.mesh
    u = response.displacements @ np.asarray(load_factors, dtype=float)
    size = _lengths(u)
    largest = float(size.max())
    factor = exaggeration(largest, model.scene.shaft.length)
    moved = mesh.points + factor * u
    seen = np.concatenate([mesh.points, moved])
    view = View.fitting(seen, ALONG_THE_SHAFT, top=90, bottom=STRIP + 50)
    plan = Plan(view)
    for part in mesh.part_names:
        facets, nodes = boundary(mesh, part), mesh.part_nodes(part)
        if factor * size[nodes].max() * view.scale > _VISIBLE:
            plan.add(add_ghost, facets, mesh.points)
        plan.add(add_shape, facets, moved, u, (0.0, 1e3 * largest or 1.0))
    plan.add(Sheet.text, (40, SIZE[1] - 40), title, size=24, centred=False)
    plan.add(Sheet.triad)
    plan.add(Sheet.scale_bar)
    if largest > 0:
        _note_beside(plan, moved[np.argmax(size)], f"largest: {1e3 * largest:.4g} mm", seen)
    shape_rows: list[tuple[str, str | None]] = [
        ("Shape", "head"),
        (f"deformed, displacements times {factor:g}", _DEFORMED),
        ("undeformed, where it differs", _GHOST),
    ]
    plan.add(Sheet.column, 1110, shape_rows)
    return factor, drawn(plan, path)


def picture_of_displacements(mesh: Mesh, u: Floats, path: Path) -> tuple[float, Picture]:
    """Draw a mesh, deformed, exaggerated and coloured by displacement, with its elements' edges.

    It is drawn beside what follows: `Picture.wait` returns when the file is there.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    u : Floats
        (n, 3) displacements of its nodes [m].
    path : Path
        PNG to write, of `view.SIZE`.

    Returns
    -------
    factor : float
        How many times larger the displacements are drawn than they are; the largest is then about
        8 % of the longest side of the box round the mesh. 1 where nothing moves.
    picture : Picture
        The picture in the making.

    Raises
    ------
    NoPictureError
        This machine cannot draw.
    ValueError
        A displacement is not finite.
    """
    size = _lengths(u)
    factor = exaggeration(float(size.max()), float(np.ptp(mesh.points, axis=0).max()))
    facets, moved = boundary(mesh), mesh.points + factor * u
    view = View.fitting(moved, _TOWARDS_A_COMPONENT, top=40, bottom=180)
    smallest, largest = 1e3 * size[facets].min(), 1e3 * size[facets].max()
    limits = (smallest, largest) if largest > smallest else (0.0, largest or 1.0)
    plan = Plan(view)
    plan.add(add_shape_with_elements, facets, moved, u, limits)
    plan.add(Sheet.triad)
    return factor, drawn(plan, path)


def exaggeration(largest: float, length: float) -> float:
    """The factor to draw displacements with: one significant digit, or 1 where nothing moves.

    Parameters
    ----------
    largest : float
        Largest displacement [m].
    length : float
        Length of what is drawn [m].
    """
    return float(f"{_EXAGGERATION * length / largest:.0e}") if largest > 0 else 1.0


def _lengths(u: Floats) -> Floats:
    size: Floats = np.linalg.norm(u, axis=1)
    if not np.isfinite(size).all():
        raise ValueError("a displacement is not finite: check the load factors")
    return size


def _note_beside(plan: Plan, point: Floats, text: str, points: Floats) -> None:
    """Label a point [m] clear of all the points: above them, or below where that is nearer."""
    foot, flat = plan.view.project(point), plan.view.project(points)
    near = flat[np.abs(flat[:, 0] - foot[0]) < 150, 1] - foot[1]
    up, down = near.max() + 40, near.min() - 40
    across = math.copysign(70, SIZE[0] / 2 - foot[0])
    plan.add(Sheet.note, point, text, (across, up if up < -down else down))
