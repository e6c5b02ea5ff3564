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
def unit_solids(bearing: Bearing, housing: Housing, bore_diameter: float) -> tuple[Solid, Solid]:
    """The bearing, and its housing.

    Parameters
    ----------
    bearing, housing : Bearing, Housing
        The unit.
    bore_diameter : float
        Of the bearing [m].
    """
    occ = gmsh.model.occ
    with gmsh_session():
        tags = bearing.build(bore_diameter), housing.build(bearing).volume
        occ.synchronize()
        first, second = (
            Solid(occ.getMass(3, tag), (x, y, z), tuple(occ.getMatrixOfInertia(3, tag)))
            for tag, (x, y, z) in ((tag, occ.getCenterOfMass(3, tag)) for tag in tags)
        )
    return first, second
