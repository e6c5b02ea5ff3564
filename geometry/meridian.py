"""The meridian of a shaft in curved triangles, fine at fillets, finer at sharp corners."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import gmsh
import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.errors import InputError

from .part import LENGTH_TOLERANCE
from .session import gmsh_session, integrate_sizes
from .shaft import Segment, Shaft

MAX_ORDER = 6
"""Maximum order of triangles: gmsh's nodes are equally spaced, too poor for higher orders."""

GROWTH = 0.5
"""Growth of the element size with the distance from a fillet or a corner, m per m."""


def meridian_triangles(
    shaft: Shaft,
    size: float,
    order: int,
    per_fillet: int,
    corner: float,
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]:
    """Mesh the half plane of x and radius.

    Parameters
    ----------
    shaft : Shaft
        Shaft of any kind.
    size : float
        Maximum edge length, m.
    order : int
        Order of the triangles, 1 to `MAX_ORDER`; all their nodes on a fillet lie on its arc.
    per_fillet : int
        Number of elements along each fillet.
    corner : float
        Edge length at every sharp corner of the outline, m.

    Returns
    -------
    nodes, cells, places
        Nodes (n, 2), x and radius, m; node ids (ne, k); places (k, 2) of an element's nodes in the
        unit triangle (0, 0), (1, 0), (0, 1), these corners first.

    Raises
    ------
    InputError
        A setting is out of its range, or gmsh can't mesh the outline.
    """
    ranges = (
        ("size", size, 0 < size < math.inf, "greater than 0"),
        ("order", order, 1 <= order <= MAX_ORDER, f"between 1 and {MAX_ORDER}"),
        ("per_fillet", per_fillet, per_fillet >= 1, "1 or more"),
        ("corner", corner, 0 < corner < math.inf, "greater than 0"),
    )
    for name, value, right, allowed in ranges:
        if not right:
            raise InputError(f"meridian: {name} is {value:g} but must be {allowed}: change it")
    path = outline(shaft)
    with gmsh_session("meridian"):
        _draw(path)
        gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 0)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        integrate_sizes()
        field = gmsh.model.mesh.field
        fields = []
        for formula in _sizes(path, per_fillet, corner):
            fields.append(field.add("MathEval"))
            field.setString(fields[-1], "F", formula)
        least = field.add("Min")
        field.setNumbers(least, "FieldsList", fields)
        field.setAsBackgroundMesh(least)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(order)
        return _read()


def outline(shaft: Shaft) -> list[Segment]:
    """The closed meridian, anticlockwise in the plane of x and radius, from the bore's front."""
    inner = [
        (x, piece.inner_diameter / 2)
        for piece, ends in zip(shaft.pieces, pairwise(shaft.stations), strict=True)
        for x in ends
    ]
    outer = [Segment(s.end, s.start, s.centre) for s in reversed(shaft.outer_profile())]
    straight = [*inner, outer[0].start]
    return [
        *(Segment(a, b) for a, b in pairwise(straight) if math.dist(a, b) > LENGTH_TOLERANCE),
        *outer,
        Segment(outer[-1].end, inner[0]),
    ]


def _draw(path: list[Segment]) -> None:
    geo = gmsh.model.geo
    points = [geo.addPoint(*segment.start, 0.0) for segment in path]
    curves = []
    for segment, start, end in zip(path, points, [*points[1:], points[0]], strict=True):
        if segment.centre is None:
            curves.append(geo.addLine(start, end))
        else:
            curves.append(geo.addCircleArc(start, geo.addPoint(*segment.centre, 0.0), end))
    geo.addPlaneSurface([geo.addCurveLoop(curves)])
    geo.synchronize()


def _sizes(path: list[Segment], per_fillet: int, corner: float) -> Iterator[str]:
    """Edge length as formulas of x and y (the radius), growing away from fillets and corners."""
    for before, segment in zip([path[-1], *path[:-1]], path, strict=True):
        if segment.centre is not None:
            radius = math.dist(segment.start, segment.centre)
            chord = math.dist(segment.start, segment.end)
            arc = 2 * radius * math.asin(min(chord / (2 * radius), 1.0))
            # from the whole circle: what is not fillet lies outside the shaft
            distance = f"abs({_from(segment.centre)} - {radius:.9f})"
            yield f"{arc / per_fillet:.9f} + {GROWTH} * {distance}"
        on_axis = segment.start[1] < LENGTH_TOLERANCE
        straight = segment.centre is None and before.centre is None
        if straight and not on_axis and not _aligned(before, segment):
            yield f"{corner:.9f} + {GROWTH} * {_from(segment.start)}"


def _aligned(one: Segment, two: Segment) -> bool:
    (ax, ay), (bx, by), (cx, cy) = one.start, one.end, two.end
    cross = (bx - ax) * (cy - by) - (by - ay) * (cx - bx)
    return abs(cross) < 1e-6 * math.dist(one.start, one.end) * math.dist(two.start, two.end)


def _from(place: tuple[float, float]) -> str:
    """Distance from a place; gmsh's formulas know no sign after another."""
    terms = (
        f"({variable} {'-' if at >= 0 else '+'} {abs(at):.9f})^2"
        for variable, at in zip("xy", place, strict=True)
    )
    return f"sqrt({' + '.join(terms)})"


def _read() -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]:
    mesh = gmsh.model.mesh
    (kind,), _, (ids,) = mesh.getElements(2)
    _, _, _, k, places, _ = mesh.getElementProperties(kind)
    tags, at, _ = mesh.getNodes()
    number = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    # the centres of arcs are points too, but no element has them
    used = np.unique(ids)
    number[used] = np.arange(len(used))
    nodes = np.empty((len(used), 2))
    known = number[tags] >= 0
    nodes[number[tags[known]]] = at.reshape(-1, 3)[known, :2]
    return nodes, number[ids].reshape(-1, k), np.asarray(places).reshape(k, -1)[:, :2]
