"""Spatial algebra: rigid motions, and forces and moments moved from one point to another.

One convention for the whole library: a motion of a point is (ux, uy, uz, rx, ry, rz); forces and
moments at a point, together a wrench, are (Fx, Fy, Fz, Mx, My, Mz). With the arm ``r`` from point A
to point B of one rigid body, and ``T`` of `wrench_transport`,

- the wrench at A that equals a wrench at B is ``T(r) w``: ``F_A = F_B``, ``M_A = M_B + r x F_B``;
- the motion of B that belongs to a motion of A is ``T(r)^T q``: ``u_B = u_A + rot_A x r``;
- the stiffness at A of a spring at B is ``T(r) K T(r)^T``.

The transpose for motions follows from the work ``w^T q``, which is the same at both points
(Featherstone 2008, Rigid Body Dynamics Algorithms, chapter 2; rotations come first there).
"""

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats


def along_x(distance: ArrayLike) -> Floats:
    """The arms (..., 3) of distances (...) along the shaft's axis [m]."""
    arm = np.zeros((*np.shape(distance), 3))
    arm[..., 0] = distance
    return arm


def wrench_transport(arm: ArrayLike) -> Floats:
    """The matrix T that moves forces and moments to another point of the same rigid body.

    Parameters
    ----------
    arm : array_like, (..., 3)
        From the point that they are moved to, to the point where they act [m].

    Returns
    -------
    ndarray, (..., 6, 6)
        Takes forces and moments at a + arm to the same about a; its transpose takes a rigid motion
        of a to the motion of a + arm.
    """
    r = np.asarray(arm, dtype=float)
    T = np.zeros((*r.shape[:-1], 6, 6))
    T[...] = np.eye(6)
    T[..., 3:, :3] = _cross(r)
    return T


def stiffness_transport(stiffness: Floats, arm: ArrayLike) -> Floats:
    """A spring to ground as felt at another point that is rigidly connected to it.

    Parameters
    ----------
    stiffness : ndarray, (6, 6)
        At the spring's own point [N/m, N, N m/rad].
    arm : array_like, (3,)
        From the other point to the spring's own [m].

    Returns
    -------
    ndarray, (6, 6)
        At the other point [N/m, N, N m/rad].
    """
    T = wrench_transport(arm)
    return np.asarray(T @ stiffness @ T.T)


def point_motions(positions: Floats, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Floats:
    """The six rigid motions of points that move and turn.

    Parameters
    ----------
    positions : ndarray, (n, 3)
        Positions of the points [m].
    centre : array_like, (3,)
        Point about which the rotations turn [m].

    Returns
    -------
    ndarray, (6 n, 6)
        Translations [m] and rotations [rad] of each point, in unit translations along x, y, z [m]
        and unit rotations about x, y, z [rad]. Its transpose sums forces and moments at the points
        to their resultant about ``centre``.
    """
    return wrench_transport(positions - np.asarray(centre)).swapaxes(-1, -2).reshape(-1, 6)


def rigid_motions(points: Floats, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Floats:
    """The six rigid motions of nodes that only move, without rotations of their own.

    Parameters
    ----------
    points : ndarray, (n, 3)
        Node coordinates [m].
    centre : array_like, (3,)
        Point about which the rotations turn [m].

    Returns
    -------
    ndarray, (3 n, 6)
        Displacements of each node [m], in unit translations along x, y, z [m] and unit rotations
        about x, y, z [rad]. Its transpose sums nodal forces to their resultant about ``centre``.
    """
    motions = np.empty((len(points), 3, 6))
    motions[:, :, :3] = np.eye(3)
    motions[:, :, 3:] = _cross(np.asarray(centre) - points)
    return motions.reshape(-1, 6)


def resultant(points: Floats, forces: Floats, centre: ArrayLike) -> Floats:
    """Force and moment about a point of nodal forces.

    Parameters
    ----------
    points : ndarray, (n, 3)
        Where the forces act [m].
    forces : ndarray, (n, 3, n_loads)
        On each node [N].
    centre : array_like, (3,)
        The point that the moment is about [m].

    Returns
    -------
    ndarray, (6, n_loads)
        Forces and moments [N, N m].
    """
    moment = np.cross((points - np.asarray(centre))[:, :, None], forces, axis=1)
    return np.vstack([forces.sum(axis=0), moment.sum(axis=0)])


def _cross(r: Floats) -> Floats:
    """The matrices (..., 3, 3) of the products r x f with vectors r (..., 3)."""
    x, y, z = np.moveaxis(r, -1, 0)
    matrix = np.zeros((*r.shape, 3))
    matrix[..., 0, 1], matrix[..., 0, 2] = -z, y
    matrix[..., 1, 0], matrix[..., 1, 2] = z, -x
    matrix[..., 2, 0], matrix[..., 2, 1] = -y, x
    return matrix
