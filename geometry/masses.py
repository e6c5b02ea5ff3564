"""Volume, centre and inertia of the solids of a bearing unit, exact, without a mesh."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import gmsh

from .bearing import Bearing
from .housing import Housing
from .session import gmsh_session


class Solid(NamedTuple):
    """Volume [m^3], centre of gravity [m], and inertia about it over the density [m^5], row by row,
    of a solid of one density.
    """

    volume: float
    centre: tuple[float, float, float]
    inertia: tuple[float, ...]


@lru_cache(maxsize=64)
def bearing_solid(bearing: Bearing, bore_diameter: float) -> Solid:
    """The bearing alone.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    bore_diameter : float
        Bore diameter of the bearing [m].
    """
    with gmsh_session():
        tag = bearing.build(bore_diameter)
        gmsh.model.occ.synchronize()
        return _solid(tag)


def _solid(tag: int) -> Solid:
    occ = gmsh.model.occ
    x, y, z = occ.getCenterOfMass(3, tag)
    return Solid(occ.getMass(3, tag), (x, y, z), tuple(occ.getMatrixOfInertia(3, tag)))


@lru_cache(maxsize=64)
def unit_solids(bearing: Bearing, housing: Housing, bore_diameter: float) -> tuple[Solid, Solid]:
    """The bearing, and its housing.

    Parameters
    ----------
    bearing, housing : Bearing, Housing
        The unit.
    bore_diameter : float
        Bore diameter of the bearing [m].
    """
    occ = gmsh.model.occ
    with gmsh_session():
        tags = bearing.build(bore_diameter), housing.build(bearing).volume
        occ.synchronize()
        first, second = map(_solid, tags)
    return first, second
