"""How far the surfaces of parts move from one set of dimensions to another, node by node.

A body of revolution is its meridian: a node keeps its angle, and its share along the segment of the
meridian that it lies on. A pillow block is its outline across the shaft and its lengths along it.
Nodes of plane faces slide in them: such a face decides on one component alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats
from fe_drivetrain.geometry import (
    NO_BANDS,
    Band,
    Bearing,
    Housing,
    MeshSizes,
    Segment,
    Shaft,
    check_bands,
    check_parts,
    check_sizes,
)

_ON = 1e-6  # [m] nodes nearer to a surface lie on it
_EQUAL = 1e-9  # [m]
_HOLES = ("bolt_diameter", "washer_diameter")


@dataclass(frozen=True)
class Parts:
    """What a mesh is generated from, see `fe_drivetrain.geometry.build`.

    Attributes
    ----------
    shaft, bearings, housings, sizes, bonded, bands : see `fe_drivetrain.geometry.build`
        Parts and sizes.
    """

    shaft: Shaft | None
    bearings: Sequence[Bearing]
    housings: Mapping[str, Housing]
    sizes: MeshSizes
    bonded: frozenset[str] = frozenset()
    bands: Mapping[str, Band] = field(default_factory=lambda: NO_BANDS)

    def check(self) -> dict[str, float]:
        """Bore of each bearing [m], of parts that fit together.

        Raises
        ------
        InputError
            As `fe_drivetrain.geometry.build` refuses them.
        """
        bores = check_parts(self.shaft, self.bearings, self.housings, self.bonded)
        if self.shaft is not None:
            check_bands(self.shaft, self.bands, self.bearings)
        check_sizes(self.shaft, self.bearings, self.housings, bores, self.sizes)
        return bores

    def meridian(self, part: str, bores: Mapping[str, float]) -> list[Segment] | None:
        """Closed meridian of a part; None of one that is no body of revolution."""
        if part == "shaft" and self.shaft is not None:
            outside = [band[:2] for band in self.bands.values() if not band.inside]
            inside = [band[:2] for band in self.bands.values() if band.inside]
            return self.shaft.faces([*(b.span for b in self.bearings), *outside], inside)
        for bearing in self.bearings:
            if bearing.name == part:
                return bearing.faces(bores[part])
        return None

    def seats(self) -> dict[str, tuple[float, float]]:
        """Spans along x that faces of the shaft are divided at, by name [m]."""
        spans = {f"seat {b.name}": b.span for b in self.bearings}
        return spans | {f"band {name}": band[:2] for name, band in self.bands.items()}

    def block(self, part: str) -> tuple[Bearing, Housing] | None:
        """The bearing and the pillow block of a part; None of any other."""
        for bearing in self.bearings:
            if part == f"{bearing.name}.housing" and bearing.name in self.housings:
                return bearing, self.housings[bearing.name]
        return None


@dataclass(frozen=True)
class Shifts:
    """What is known of how nodes move.

    Attributes
    ----------
    known : Bools
        (n, 3) which components are.
    values : Floats
        (n, 3) by how much [m]; 0 where not known.
    """

    known: Bools
    values: Floats


def revolved_shifts(points: Floats, before: Sequence[Segment], after: Sequence[Segment]) -> Shifts:
    """Shifts of nodes on the surface of a body of revolution about the x axis.

    Parameters
    ----------
    points : Floats
        (n, 3) on the surface [m].
    before, after : sequence of Segment
        The meridian now and then, segment by segment, see `same_outline`.
    """
    x, radius = points[:, 0], np.hypot(points[:, 1], points[:, 2])
    nearest = np.full(len(points), np.inf)
    along, outward = np.zeros(len(points)), np.zeros(len(points))
    for old, new in zip(before, after, strict=True):
        share = _share(old, x, radius)
        old_x, old_r = _place(old, share)
        new_x, new_r = _place(new, share)
        distance = np.hypot(x - old_x, radius - old_r)
        here = distance < nearest
        nearest[here] = distance[here]
        along[here], outward[here] = (new_x - old_x)[here], (new_r - old_r)[here]
    turned = np.divide(points[:, 1:].T, radius, out=np.zeros((2, len(x))), where=radius > 0.0)
    values = np.column_stack([along, outward * turned[0], outward * turned[1]])
    return Shifts(np.ones(points.shape, dtype=np.bool_), values)


def _share(segment: Segment, x: Floats, radius: Floats) -> Floats:
    """How far along a segment the places nearest to points are, 0 to 1."""
    (x0, r0), (x1, r1) = segment.start, segment.end
    if segment.centre is None:
        length = (x1 - x0) ** 2 + (r1 - r0) ** 2
        found = ((x - x0) * (x1 - x0) + (radius - r0) * (r1 - r0)) / length
    elif segment.centre[1] == 0.0:  # a zone of a sphere: as its housing, by x
        found = (x - x0) / (x1 - x0)
    else:
        start, sweep = _sweep(segment)
        angle = np.arctan2(radius - segment.centre[1], x - segment.centre[0])
        found = np.remainder(angle - start + math.pi, 2 * math.pi) - math.pi
        found = found / sweep
    return np.asarray(np.clip(found, 0.0, 1.0))


def _place(segment: Segment, share: Floats) -> tuple[Floats, Floats]:
    """x and radius at shares of a segment."""
    (x0, r0), (x1, r1) = segment.start, segment.end
    if segment.centre is None:
        return x0 + share * (x1 - x0), r0 + share * (r1 - r0)
    size = math.dist(segment.start, segment.centre)
    if segment.centre[1] == 0.0:
        x = x0 + share * (x1 - x0)
        return x, np.sqrt(size**2 - (x - segment.centre[0]) ** 2)
    start, sweep = _sweep(segment)
    angle = start + share * sweep
    return segment.centre[0] + size * np.cos(angle), segment.centre[1] + size * np.sin(angle)


def _sweep(segment: Segment) -> tuple[float, float]:
    """Angle at the start of an arc, and from there to its end, the short way."""
    assert segment.centre is not None
    cx, cr = segment.centre
    start, end = (math.atan2(r - cr, x - cx) for x, r in (segment.start, segment.end))
    return start, math.remainder(end - start, 2 * math.pi)


def same_outline(
    before: Sequence[Segment],
    after: Sequence[Segment],
    seats: Mapping[str, tuple[float, float]],
    new_seats: Mapping[str, tuple[float, float]],
) -> bool:
    """Whether two meridians have the same segments, kind by kind, under the same seats."""
    one, two = (
        [_kind(s, spans) for s in of] for of, spans in ((before, seats), (after, new_seats))
    )
    return one == two


def _kind(segment: Segment, seats: Mapping[str, tuple[float, float]]) -> tuple[str, ...]:
    low, high = sorted((segment.start[0], segment.end[0]))
    if segment.centre is not None:
        shape = "sphere" if segment.centre[1] == 0.0 else "fillet"
    elif high - low < _EQUAL:
        shape = "across"
    else:
        on_axis = max(segment.start[1], segment.end[1]) < _EQUAL
        shape = "axis" if on_axis else "along"
    under = [n for n, (a, b) in seats.items() if a - _ON < low < high < b + _ON]
    return (shape, *sorted(under))


class _Known:
    """Components of shifts, as faces decide on them."""

    def __init__(self, points: Floats) -> None:
        self.points = points
        self.known = np.zeros(points.shape, dtype=np.bool_)
        self.values = np.zeros(points.shape)

    def put(self, where: Bools, component: int, to: Floats) -> None:
        """Move nodes to a coordinate."""
        self.known[where, component] = True
        self.values[where, component] = (to - self.points[:, component])[where]


def block_shifts(
    points: Floats, before: tuple[Bearing, Housing], after: tuple[Bearing, Housing]
) -> Shifts:
    """Shifts of nodes on the surface of a pillow block.

    Parameters
    ----------
    points : Floats
        (n, 3) on the surface [m].
    before, after : tuple of Bearing and Housing
        The block round its bearing now and then, see `same_block`.
    """
    (bearing, old), (new_bearing, new) = before, after
    x, y, z = points[:, 0] - bearing.x, points[:, 1], points[:, 2]
    to_x = _along(x, before, after)
    drop, new_drop = (h.centre_height - h.foot_thickness for h in (old, new))
    on_foot, on_body = z < -drop + _ON, z > -drop - _ON
    found = _Known(points)
    ends = (np.abs(np.abs(x) - old.foot_width / 2) < _ON) & on_foot
    ends |= (np.abs(np.abs(x) - old.width / 2) < _ON) & on_body
    found.put(ends, 0, to_x + new_bearing.x)
    for height, new_height in ((old.centre_height, new.centre_height), (drop, new_drop)):
        found.put(np.abs(z + height) < _ON, 2, np.full(len(z), -new_height))
    sides = (np.abs(np.abs(y) - old.foot_length / 2) < _ON) & on_foot
    found.put(sides, 1, np.sign(y) * new.foot_length / 2)
    if old.base == "bolted":
        _bolted(found, x, before, after)
    outer, new_outer = old.outer_radius(bearing), new.outer_radius(new_bearing)
    radius = np.hypot(y, z)
    inside = _bore(bearing, x)
    scale = np.divide(1.0, radius, out=np.zeros_like(radius), where=radius > 0.0)
    for where, outward in (
        (np.abs(radius - inside) < _ON, _bore(new_bearing, to_x) - inside),
        ((np.abs(radius - outer) < _ON) & (z > -_ON), new_outer - outer),
    ):
        found.put(where, 0, to_x + new_bearing.x)
        found.put(where, 1, y * (1.0 + outward * scale))
        found.put(where, 2, z * (1.0 + outward * scale))
    depth = np.clip(-z / drop, 0.0, 1.0)
    flank = outer + (old.pedestal_width / 2 - outer) * depth
    new_flank = new_outer + (new.pedestal_width / 2 - new_outer) * depth
    leaning = (np.abs(np.abs(y) - flank) < _ON) & (z < _ON) & on_body
    found.put(leaning, 0, to_x + new_bearing.x)
    found.put(leaning, 1, y + np.sign(y) * (new_flank - flank))
    found.put(leaning, 2, -depth * new_drop)
    return Shifts(found.known, found.values)


def _bolted(
    found: _Known, x: Floats, before: tuple[Bearing, Housing], after: tuple[Bearing, Housing]
) -> None:
    """Move bolt holes and the faces under their washers along, round as they are."""
    (_, old), (new_bearing, new) = before, after
    y, z = found.points[:, 1], found.points[:, 2]
    at_x, at_y = (
        np.sign(c) * spacing / 2
        for c, spacing in ((x, old.bolt_spacing_x), (y, old.bolt_spacing_y))
    )
    away = np.hypot(x - at_x, y - at_y)
    hole = np.abs(away - old.bolt_diameter / 2) < _ON
    washer = (away < old.washer_diameter / 2 + _ON) & (np.abs(z + old.centre_height) < _ON)
    found.put(hole | washer, 0, x + np.sign(x) * new.bolt_spacing_x / 2 - at_x + new_bearing.x)
    found.put(hole | washer, 1, y + np.sign(y) * new.bolt_spacing_y / 2 - at_y)
    height = (z + old.centre_height) / old.foot_thickness
    found.put(hole, 2, height * new.foot_thickness - new.centre_height)


def _along(x: Floats, before: tuple[Bearing, Housing], after: tuple[Bearing, Housing]) -> Floats:
    """Places along the shaft from the centre of a block, linear between the ends of its faces."""
    old, new = (np.array(list(_halves(*of).values())) for of in (before, after))
    stations, first = np.unique(np.concatenate([-old, old]), return_index=True)
    return np.asarray(np.interp(x, stations, np.concatenate([-new, new])[first]))


def _halves(bearing: Bearing, housing: Housing) -> dict[str, float]:
    """Where faces of a block end along x, from its centre [m]."""
    return {
        "seat": min(bearing.width, housing.width) / 2,
        "body": housing.width / 2,
        "foot": housing.foot_width / 2,
    }


def _bore(bearing: Bearing, x: Floats) -> Floats:
    """Radius of the bore of a block at x from its centre [m]."""
    radius = bearing.raceway_diameter / 2
    if bearing.kind == "ring":
        return np.full(len(x), radius)
    return np.asarray(np.sqrt(np.maximum(radius**2 - x**2, 0.0)))


def same_block(before: tuple[Bearing, Housing], after: tuple[Bearing, Housing]) -> bool:
    """Whether two pillow blocks have the same faces, in the same order along the shaft."""
    (bearing, old), (new_bearing, new) = before, after
    halves = _halves(*before), _halves(*after)
    orders = [
        [np.sign(np.round((of[a] - of[b]) / _EQUAL)) for a, b in combinations(of, 2)]
        for of in halves
    ]
    same = bearing.kind == new_bearing.kind and old.base == new.base and orders[0] == orders[1]
    if old.base == "bolted":
        same &= all(getattr(old, size) == getattr(new, size) for size in _HOLES)
    # a bore that reaches the foot has an edge there, which belongs to two curved faces
    return same and all(
        b.raceway_diameter / 2 < h.centre_height - h.foot_thickness - _ON
        for b, h in (before, after)
    )
