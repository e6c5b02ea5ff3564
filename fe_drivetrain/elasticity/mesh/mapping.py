"""Mapping from the reference element to its place: numpy alone, for processes with no more."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints


def jacobian(points: Floats, cells: Ints, gradients: Floats) -> tuple[Floats, Floats]:
    """Physical gradients of the shape functions and the determinant of the map.

    Parameters
    ----------
    points : Floats
        Node coordinates (n, 3) [m].
    cells : Ints
        (n_cells, n_nodes) node numbers.
    gradients : Floats
        (n_q, 3, n_nodes) reference gradients.

    Returns
    -------
    physical, determinant
        (n_cells, n_q, 3, n_nodes) [1/m] and (n_cells, n_q) [m^3].
    """
    J = np.einsum("qkn,eni->eqik", gradients, points[cells])
    # Cofactors by cross products: several times faster than numpy.linalg on many 3x3 matrices.
    a, b, c = J[..., 0], J[..., 1], J[..., 2]
    cofactors = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=-1)
    determinant = np.einsum("eqi,eqi->eq", a, cofactors[..., 0])
    physical = (cofactors / determinant[..., None, None]) @ gradients
    return physical, determinant
