"""Number of elements of a scene's parts, from their dimensions: no CAD model is needed.

What `fe_drivetrain.geometry.element_sizes` foresees on the faces of the CAD model, in closed form.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from .bearing import Bearing
from .element_sizes import (
    MeshSizes,
    curved_limit,
    elements_beside,
    elements_within,
    narrow_limit,
    refuse_fine_edges,
    refuse_too_many,
)
from .fits import Band
from .housing import Housing
from .shaft import Segment, Shaft, refuse_fine_details

_ARC = 32  # chords of an arc: areas and volumes within 1e-4


def check_counts(
    shaft: Shaft | None,
    bearings: Sequence[Bearing],
    housings: Mapping[str, Housing],
    bores: Mapping[str, float],
    sizes: MeshSizes,
    bands: Mapping[str, Band],
) -> None:
    """Refuse details that are too fine for CAD, and mesh sizes and details of too many elements.

    Parameters
    ----------
    shaft, bearings, housings, sizes, bands : Shaft or None, Sequence, Mapping, MeshSizes, Mapping
        Parts and sizes, as `fe_drivetrain.geometry.build` takes them.
    bores : Mapping[str, float]
        Bore diameters of the bearings by name, m.

    Raises
    ------
    InputError
    """
    if shaft is not None:
        outside = [band[:2] for band in bands.values() if not band.inside]
        inside = [band[:2] for band in bands.values() if band.inside]
        outline = shaft.faces([*(b.span for b in bearings), *outside], inside)
        refuse_fine_details(outline)
        _check_part("shaft", outline, sizes.shaft, sizes.elements_per_turn)
    for bearing in bearings:
        outline = bearing.faces(bores[bearing.name])
        refuse_fine_details(outline)
        _check_part(bearing.name, outline, sizes.bearing, sizes.elements_per_turn)
        edges = 2 * math.pi * sum(segment.start[1] for segment in outline)
        refuse_fine_edges(edges, sizes.bearing_edge)
        if bearing.name in housings:
            _check_housing(bearing, housings[bearing.name], sizes)


class _Face(NamedTuple):
    """Face of revolution: its area, m^2, and the maximum element size that it allows, m."""

    x: tuple[float, float]
    radii: tuple[float, float]
    area: float
    limit: float


def _check_part(name: str, outline: Sequence[Segment], size: float, per_turn: int) -> None:
    """Refuse a body of revolution whose elements are too many."""
    elements = elements_within(name, abs(sum(map(_volume_under, outline))), size)
    for face in _faces(outline, per_turn):
        if face.limit >= size:
            continue
        (x0, x1), (r0, r1) = face.x, face.radii
        length = max(2 * math.pi * r1, math.hypot(x1 - x0, r1 - r0))
        elements += elements_beside(face.area, length, face.limit)
        refuse_too_many(name, face.x, (-r1, r1), face.limit, elements)


def _check_housing(bearing: Bearing, housing: Housing, sizes: MeshSizes) -> None:
    """Refuse a housing whose elements are too many."""
    name, size = f"{bearing.name}.housing", sizes.housing
    elements = elements_within(name, housing.volume(bearing), size)
    for face in housing.curved_faces(bearing):
        limit = curved_limit(1 / face.radius, False, sizes.elements_per_turn)
        if face.width < math.inf:
            limit = min(limit, narrow_limit(face.width, face.y[1]))
        if limit < size:
            elements += elements_beside(face.area, face.length, limit)
            refuse_too_many(name, face.x, face.y, limit, elements)


def _faces(outline: Sequence[Segment], per_turn: int) -> Iterator[_Face]:
    for segment in outline:
        points = _points(segment)
        radii = [r for _, r in points]
        if max(radii) <= 0:
            continue
        (xa, ra), (xb, rb) = segment.start, segment.end
        slant = math.hypot(xb - xa, rb - ra)
        if segment.centre is not None:
            curvature = 1 / math.dist(segment.start, segment.centre)
        else:
            curvature = abs(xb - xa) / slant / ((ra + rb) / 2)
        # an arc about the axis is a sphere's; one beside it a fillet's
        fillet = segment.centre is not None and segment.centre[1] > 0
        low, high = min(radii), max(radii)
        width = math.hypot(xb - xa, high - low)
        limit = min(curved_limit(curvature, fillet, per_turn), narrow_limit(width, high))
        area = sum(
            math.pi * (r + s) * math.hypot(y - x, s - r) for (x, r), (y, s) in pairwise(points)
        )
        yield _Face((min(xa, xb), max(xa, xb)), (low, high), area, limit)


def _volume_under(segment: Segment) -> float:
    """Volume between a piece of a meridian and the axis, with the sign of its way along x."""
    points = _points(segment)
    return sum(
        math.pi * (y - x) * (r * r + r * s + s * s) / 3 for (x, r), (y, s) in pairwise(points)
    )


def _points(segment: Segment) -> list[tuple[float, float]]:
    """Points along a piece of a meridian, x and radius, m."""
    if segment.centre is None:
        return [segment.start, segment.end]
    (cx, cr), radius = segment.centre, math.dist(segment.start, segment.centre)
    first = math.atan2(segment.start[1] - cr, segment.start[0] - cx)
    turn = math.atan2(segment.end[1] - cr, segment.end[0] - cx) - first
    turn = math.remainder(turn, 2 * math.pi)
    angles = [first + turn * k / _ARC for k in range(_ARC + 1)]
    return [(cx + radius * math.cos(a), cr + radius * math.sin(a)) for a in angles]
