"""A body condensed to the motions of two rigid ends, and the rank of the result."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.references.manufactured import LAME
from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.elasticity.interfaces import rigid_face, rigid_point
from fe_drivetrain.elasticity.solve import solve_solid

_NAMES = ("first end", "second end")


@dataclass(frozen=True)
class Condensed:
    """(12, 12) stiffness of the motions of two ends, found in two ways.

    Attributes
    ----------
    by_energy : Floats
        u_i . K u_j of the displacements under unit motions [N/m, N, N m/rad].
    by_reactions : Floats
        Force or moment that holds motion i (row) under unit motion j.
    """

    by_energy: Floats
    by_reactions: Floats


def condense(points: Floats, cells: Ints, ends: tuple[Ints, Ints], positions: Floats) -> Condensed:
    """Give each motion of two rigid ends once as a unit, all others held.

    Parameters
    ----------
    points, cells : Floats, Ints
        The body, of steel.
    ends : tuple[Ints, Ints]
        Nodes of the two faces.
    positions : Floats
        (2, 3) of their reference points [m].
    """
    n = 3 * len(points)
    total = n + 12
    constraints = []
    for k, (name, nodes) in enumerate(zip(_NAMES, ends, strict=True)):
        point = rigid_point(name, positions[k], n + 6 * k, total)
        constraints.append(rigid_face(name, nodes, points, point))
    motions = n + np.arange(12)
    static = solve_solid(
        points,
        cells,
        LAME,
        constraints,
        np.zeros((total, 12)),
        prescribed=(motions, np.eye(12)),
        method="superlu",
    )
    return Condensed(static.u.T @ (static.K @ static.u), static.reactions["prescribed"][motions])


def zeros_by_gap(values: Floats) -> tuple[int, float]:
    """How many eigenvalues lie below the widest gap, and how wide it is.

    Parameters
    ----------
    values : Floats
        Eigenvalues; zeros are negative or positive by round-off.

    Returns
    -------
    count, ratio
        How many are below, and the largest of them over the smallest above, by magnitude.
    """
    sizes = np.sort(np.abs(values))
    # Below round-off nothing can be distinguished, an exact zero included.
    sizes = np.maximum(sizes, np.finfo(float).eps * sizes[-1])
    ratios = sizes[:-1] / sizes[1:]
    k = int(ratios.argmin())
    return k + 1, float(ratios[k])
