"""Element sizes that vary in space as prescribed, beside those of the parts."""

from __future__ import annotations

from typing import NamedTuple

import gmsh
import numpy as np
from numpy.typing import NDArray


class LocalSizes(NamedTuple):
    """Element sizes at the corners of tetrahedra, linear inside them.

    Attributes
    ----------
    corners : NDArray[np.float64]
        Corners (n, 4, 3) of each tetrahedron, m.
    sizes : NDArray[np.float64]
        Element size (n, 4) at each corner, m.
    """

    corners: NDArray[np.float64]
    sizes: NDArray[np.float64]


def apply_local_sizes(local: LocalSizes) -> None:
    """Let elements be no larger than these, in an open gmsh model that `build` has made.

    The sizes that `build` set stay in force as well: the smaller of the two counts. Outside the
    tetrahedra the nearest corner's size holds.
    """
    view = gmsh.view.add("element size")
    # gmsh's lists of scalar tetrahedra: all x, all y, all z, then the values of each
    rows = np.concatenate(
        [np.swapaxes(local.corners, 1, 2).reshape(-1, 12), local.sizes.reshape(-1, 4)], axis=1
    )
    gmsh.view.addListData(view, "SS", len(rows), rows.ravel())
    field = gmsh.model.mesh.field
    background = int(max(field.list()))  # the least of all of `build`, made last
    given = field.add("PostView")
    field.setNumber(given, "ViewTag", view)
    least = field.add("Min")
    field.setNumbers(least, "FieldsList", [background, given])
    field.setAsBackgroundMesh(least)
