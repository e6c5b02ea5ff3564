"""Joints that take means over faces, apart from the bodies that they join.

A mean over a face is a row over all of its nodes, and a condition or a spring on it couples each of
them with each. Where a method is to see the bodies alone, these few rows are taken out again.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.elasticity.interfaces.constraints import (
    Constraint,
    Elimination,
    ReferencePoint,
    eliminate,
    held_dofs,
)

#: Springs this much softer than the stiffest of a joint carry nothing.
_NO_SPRING = 1e-14

_NONE = np.zeros(0, dtype=np.int64)


@dataclass(frozen=True)
class Sums:
    """Joints of a system that take sums over groups of nodes.

    Attributes
    ----------
    dofs : Ints
        Degrees of freedom (s,) that are such sums.
    shares : sparse.csr_array
        Sums (s, n) from the degrees of freedom of the bodies.
    rows : sparse.csr_array
        Rows (m, n): what conditions hold and springs stretch, from the degrees of freedom of the
        bodies.
    flexibility : Floats
        Flexibility (m,) of each row: zero of a condition.
    elimination : Elimination
        All constraints of the bodies alone.
    springs : sparse.csr_array
        Stiffness (n, n) that the springs add to that of the bodies before any constraint [N/m].
    """

    dofs: Ints
    shares: sparse.csr_array
    rows: sparse.csr_array
    flexibility: Floats
    elimination: Elimination
    springs: sparse.csr_array


def sums_of(elimination: Elimination, springs: Sequence[tuple[ReferencePoint, Floats]]) -> Sums:
    """The joints that take means over faces, of which there is one at least.

    Parameters
    ----------
    elimination : Elimination
        All constraints.
    springs : sequence of (ReferencePoint, ndarray (6, 6))
        Springs at points, or between faces [N/m, N, N m/rad].
    """
    joints = [c for c in elimination.constraints if c.is_mean]
    on_means = [(point, k) for point, k in springs if point.is_mean]
    n = len(elimination.free)
    dofs = np.concatenate([_NONE, *(c.sums for c in joints)])
    others = [c for c in elimination.constraints if not c.is_mean]
    others.append(held_dofs("sums", dofs, n))
    alone = eliminate(others, n)
    C = sparse.vstack([sparse.csr_array((0, n)), *(c.rows for c in joints)], format="csc")
    of_sums, of_bodies = C[:, dofs].tocsr(), (C @ alone.T).tocsr()
    # rows that define sums come one for each, the others say what these or the bodies do
    defines = np.concatenate([_NONE.astype(bool), *(_defining(c) for c in joints)])
    # each of them has one sum, which is solved for
    inverse = of_sums[defines].T.tocsr()
    inverse.data = -1.0 / inverse.data
    shares = inverse @ of_bodies[defines]
    rows = [of_bodies[~defines] + of_sums[~defines] @ shares]
    flexibility = [np.zeros(rows[0].shape[0])]
    added = sparse.csr_array((n, n))
    for point, k in on_means:
        stiffness, ways = np.linalg.eigh(k)
        carries = stiffness > _NO_SPRING * stiffness.max()
        motion = point.motion @ alone.T + point.motion.tocsc()[:, dofs] @ shares
        rows.append(sparse.csr_array(ways[:, carries].T) @ motion)
        flexibility.append(1.0 / stiffness[carries])
        added = added + point.motion.T @ sparse.csr_array(k) @ point.motion
    stacked = sparse.vstack(rows, format="csr")
    return Sums(dofs, shares.tocsr(), stacked, np.concatenate(flexibility), alone, added)


def _defining(constraint: Constraint) -> NDArray[np.bool_]:
    """Rows that say what a sum is: those in which it stands beside its nodes."""
    rows = constraint.rows
    is_sum = np.isin(rows.indices, constraint.sums).astype(float)
    number = np.repeat(np.arange(rows.shape[0]), np.diff(rows.indptr))
    sums = np.bincount(number, is_sum, rows.shape[0])
    return np.asarray((sums > 0) & (sums < np.diff(rows.indptr)))
