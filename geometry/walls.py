"""Walls of the parts, and the maximum element sizes that they allow."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from fe_drivetrain.common.errors import InputError

from .bearing import Bearing
from .element_sizes import SIZE_PER_WALL, MeshSizes, size_name
from .fits import check_parts
from .housing import Housing
from .shaft import Shaft


class Wall(NamedTuple):
    """The thinnest wall of a part [m]."""

    part: str
    thickness: float
    what: str = "thinnest wall"

    @property
    def largest(self) -> float:
        """Maximum element size that it allows [m]."""
        return SIZE_PER_WALL * self.thickness


def thinnest_walls(
    shaft: Shaft | None,
    bearings: Sequence[Bearing],
    housings: Mapping[str, Housing],
    bores: Mapping[str, float],
) -> Iterator[Wall]:
    """The thinnest wall of each part; `bores` are the bearings' bore diameters [m]."""
    if shaft is not None:
        wall = min(min(p.outer_diameter, p.end_diameter) - p.inner_diameter for p in shaft.pieces)
        yield Wall("shaft", wall / 2)
    for bearing in bearings:
        yield Wall(bearing.name, bearing.edge_radius - bores[bearing.name] / 2)
        if bearing.name in housings:
            housing = housings[bearing.name]
            floor = housing.centre_height - bearing.raceway_diameter / 2
            part, thickness = f"{bearing.name}.housing", min(housing.wall, floor)
            if housing.foot_thickness < thickness:
                yield Wall(part, housing.foot_thickness, "foot")
            else:
                yield Wall(part, thickness)


def check_sizes(
    shaft: Shaft | None,
    bearings: Sequence[Bearing],
    housings: Mapping[str, Housing],
    bores: Mapping[str, float],
    sizes: MeshSizes,
) -> None:
    """Refuse elements so large that no sound element can fill the wall.

    Raises
    ------
    InputError
    """
    for wall in thinnest_walls(shaft, bearings, housings, bores):
        kind = size_name(wall.part)
        size = getattr(sizes, kind)
        if wall.part == "shaft" and shaft is not None:
            widest = max(max(p.outer_diameter, p.end_diameter) for p in shaft.pieces)
            size = min(size, math.pi * widest / sizes.elements_per_turn)
        if size > wall.largest:
            raise InputError(
                f"part {wall.part!r}: mesh size {kind!r} is {size:g} m but must be at most "
                f"{wall.largest:.3g} m, {SIZE_PER_WALL:g} times its {wall.what} of "
                f"{wall.thickness:.3g} m: reduce the size or thicken the wall (lengths are in "
                "metres)"
            )


def within_walls(
    sizes: MeshSizes, shaft: Shaft, bearings: Sequence[Bearing], housings: Mapping[str, Housing]
) -> MeshSizes:
    """Mesh sizes, those reduced that are larger than a wall of the parts allows.

    Parameters
    ----------
    sizes : MeshSizes
        Sizes to start from.
    shaft, bearings, housings : Shaft, Sequence[Bearing], Mapping[str, Housing]
        The parts; they fit together.
    """
    bores = check_parts(shaft, bearings, housings)
    largest: dict[str, float] = {}
    for wall in thinnest_walls(shaft, bearings, housings, bores):
        kind = size_name(wall.part)
        largest[kind] = min(largest.get(kind, getattr(sizes, kind)), wall.largest)
    return sizes.model_copy(update=largest)
