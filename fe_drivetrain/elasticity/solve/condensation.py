"""A body condensed to its reference points: free stiffness, and what its own weight puts on them.

The body is left free. Unit loads at each point are balanced at the first one, so any way of holding
the body without constraint gives the same flexibility F of the other points relative to the first,
and K = B F^-1 B^T with the rigid transport of forces in B (the natural mode method: Argyris 1964,
Recent Advances in Matrix Methods of Structural Analysis; Guyan 1965 where all of a face moves as
one). K then keeps its six rigid motions to round-off.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import min_eigenvalue, scaled_solve, scaled_to_unit_diagonal
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import point_motions, wrench_transport


@dataclass(frozen=True)
class Condensed:
    """A free body at its reference points.

    Attributes
    ----------
    names : tuple[str, ...]
        Names of the n points.
    positions : Floats
        Positions (n, 3) of the points [m].
    stiffness : Floats
        Stiffness (6 n, 6 n): ux, uy, uz, rx, ry, rz of each point to Fx to Mz there [N/m, N, N
        m/rad].
    gravity : Floats
        Forces and moments (6 n, 3) that do at the points what the body's mass does under a uniform
        acceleration of 1 m/s^2 along x, y, z.
    mass : Floats or None
        Mass (6 n, 6 n) of the motions that the points force on the body (Guyan 1965) [kg, kg m, kg
        m^2]; None of a beam.
    """

    names: tuple[str, ...]
    positions: Floats
    stiffness: Floats
    gravity: Floats
    mass: Floats | None = None

    __repr__ = short_repr

    def rows(self, name: str) -> slice:
        """The six rows of a point."""
        first = 6 * self.names.index(name)
        return slice(first, first + 6)

    @property
    def rigid_motions(self) -> Floats:
        """(6 n, 6) the motions that no force resists, about the first point."""
        return point_motions(self.positions, self.positions[0])


def condense(
    names: Sequence[str],
    positions: Floats,
    loads: Floats,
    mass: sparse.csr_array,
    rigid: Floats,
    solve: Callable[[Floats], Floats],
    kept: Sequence[int] = (0, 1, 2, 3, 4, 5),
) -> Condensed:
    """Condense a free body to reference points.

    Parameters
    ----------
    names, positions : Sequence[str], Floats
        Names and positions (n, 3) of the n points [m]; at least two.
    loads : Floats
        Nodal forces (n_dofs, k n) of a unit force or moment at each point; transposed, the points'
        motions. k components of each point are kept.
    mass : sparse.csr_array
        Mass matrix (n_dofs, n_dofs) of the body [kg].
    rigid : Floats
        Rigid motions (n_dofs, k) of the body about the first point.
    solve : callable
        Function from nodal forces (n_dofs, m) that are in balance to displacements; any rigid
        motion may be in these.
    kept : Sequence[int]
        Components, of the six of each point, that ``loads`` has; the others stay without stiffness.

    Raises
    ------
    InputError
        There is only one point, or two are one to the body.
    """
    n, k = len(names), len(kept)
    if n < 2:
        raise InputError(
            f"a free body at the point {names[0]!r} alone has no stiffness: give two or more"
        )
    chosen = np.ix_(kept, kept)
    carried = [wrench_transport(p - positions[0])[chosen] for p in positions[1:]]
    B = np.vstack([-np.hstack(carried), np.eye(k * (n - 1))])
    pairs = loads @ B
    gravity = np.zeros((len(loads), 3))
    for column, component in enumerate(kept):
        if component < 3:
            gravity[:, component] = mass @ rigid[:, column]
    weight = rigid.T @ gravity
    # held at the first point
    U = solve(np.hstack([pairs, gravity - loads[:, :k] @ weight]))
    strained, sagged = U[:, : pairs.shape[1]], U[:, pairs.shape[1] :]
    flexibility = pairs.T @ strained
    flexibility = 0.5 * (flexibility + flexibility.T)
    if np.linalg.cond(scaled_to_unit_diagonal(flexibility)) > 1e14:
        raise InputError(
            f"the points {', '.join(names)} cannot all be kept: two of them move as one; "
            "leave one out"
        )
    inverse = np.linalg.inv(flexibility)
    inverse = 0.5 * (inverse + inverse.T)
    on_points = B @ inverse @ (pairs.T @ sagged)
    on_points[:k] += weight
    # motions of the body for a unit motion of each point: strained, and turned back into place
    motions = strained @ inverse @ B.T
    motions -= rigid @ (loads[:, :k].T @ motions - np.eye(k, k * n))
    where = (6 * np.arange(n)[:, None] + np.asarray(kept)).ravel()

    def placed(reduced: Floats) -> Floats:
        full = np.zeros((6 * n, 6 * n))
        full[np.ix_(where, where)] = reduced
        return full

    full = np.zeros((6 * n, 3))
    full[where] = on_points
    moved = motions.T @ (mass @ motions)
    return Condensed(
        tuple(names),
        np.asarray(positions),
        placed(B @ inverse @ B.T),
        full,
        placed(0.5 * (moved + moved.T)),
    )


def followed(body: Condensed, at: Sequence[str]) -> Floats:
    """Motions of all points where some move and the others follow without load (Guyan 1965).

    Parameters
    ----------
    body : Condensed
        The body.
    at : Sequence[str]
        The k points that are moved.

    Returns
    -------
    Floats
        Motions (6 n, 6 k) of all n points for a unit motion of each of these.

    Raises
    ------
    InputError
        A point is unknown.
    """
    for name in at:
        if name not in body.names:
            raise InputError(
                f"point {name!r} is unknown: use one or more of {', '.join(body.names)}"
            )
    kept = np.concatenate([np.r_[body.rows(name)] for name in at])
    left = np.setdiff1d(np.arange(len(body.stiffness)), kept)
    follow = np.zeros((len(body.stiffness), len(kept)))
    follow[kept] = np.eye(len(kept))
    if len(left):
        K = body.stiffness
        follow[left] = -np.linalg.solve(K[np.ix_(left, left)], K[np.ix_(left, kept)])
    return follow


def keep_points(body: Condensed, at: Sequence[str]) -> Condensed:
    """The body at some of its points; the others follow without load, see `followed`.

    Raises
    ------
    InputError
        A point is unknown.
    """
    follow = followed(body, at)
    stiffness = follow.T @ body.stiffness @ follow
    mass = None if body.mass is None else follow.T @ body.mass @ follow
    return Condensed(
        tuple(at),
        body.positions[[body.names.index(name) for name in at]],
        0.5 * (stiffness + stiffness.T),
        follow.T @ body.gravity,
        None if mass is None else 0.5 * (mass + mass.T),
    )


def on_supports(
    points: Sequence[str],
    stiffness: Floats,
    supports: Mapping[str, Floats],
    together: Sequence[Sequence[str]] = (),
) -> tuple[Floats, Ints]:
    """Stiffness with that of the supports added, and which degrees of freedom they leave.

    Parameters
    ----------
    points : Sequence[str]
        Names of n points.
    stiffness : Floats
        (6 n + m, 6 n + m): six degrees of freedom of each point first, then m of anything.
    supports : Mapping[str, Floats]
        Stiffness (6, 6) of the support by point; inf on the diagonal holds that motion, and nothing
        else is in its row. Where k supports are coupled, (6, 6 k): the point's rows of their one
        stiffness.
    together : Sequence[Sequence[str]]
        Names of such points, in the order of their columns.

    Returns
    -------
    (k, k) stiffness of the degrees of freedom that are left, and their (k,) numbers.

    Raises
    ------
    InputError
        A support is at no point, or coupled to others that are not given.
    """
    K = np.array(stiffness)
    held = np.zeros(len(K), dtype=bool)
    for name, k in supports.items():
        if name not in points:
            raise InputError(
                f"support {name!r} is at none of the points {', '.join(points)}: keep its point"
            )
        rows = slice(6 * points.index(name), 6 * points.index(name) + 6)
        if k.shape == (6, 6):
            held[rows] = np.isinf(np.diag(k))
            K[rows, rows] += np.where(np.isinf(k), 0.0, k)
            continue
        group = next((g for g in together if name in g and 6 * len(g) == k.shape[1]), None)
        if group is None:
            raise InputError(
                f"support {name!r} is coupled with others, which is not possible here: use one of "
                "levels 1 to 4 of the scene"
            )
        for other, block in zip(group, np.split(k, len(group), axis=1), strict=True):
            first = 6 * points.index(other)
            K[rows, first : first + 6] += block
    left = np.flatnonzero(~held)
    return K[np.ix_(left, left)], left


@dataclass(frozen=True)
class Supported:
    """A condensed body on supports.

    Attributes
    ----------
    motions : Floats
        Motions (6 n, 6 n + 3) of all points, for unit forces and moments at all points and for 1
        m/s^2 along x, y, z.
    reactions : Mapping[str, Floats]
        Loads (6, 6 n + 3) of the body on each support, at its point.
    """

    motions: Floats
    reactions: Mapping[str, Floats]


def supported(
    body: Condensed, supports: Mapping[str, Floats], together: Sequence[Sequence[str]] = ()
) -> Supported:
    """Put a condensed body on springs and rigid supports, and load it.

    Parameters
    ----------
    body : Condensed
        The free body.
    supports : Mapping[str, Floats]
        Stiffness (6, 6) to ground of points by name; inf on the diagonal holds that motion rigidly,
        and nothing else stands in its row then. Coupled ones have the form of `on_supports`.
    together : Sequence[Sequence[str]]
        Names of coupled points, see `on_supports`.

    Raises
    ------
    InputError
        The supports leave a motion free.
    """
    n = len(body.names)
    F = np.hstack([np.eye(6 * n), body.gravity])
    K, free = on_supports(body.names, body.stiffness, supports, together)
    # translations and rotations have other units: judged with a unit diagonal
    if min_eigenvalue(K) < _FREE:
        raise InputError(
            f"the supports {', '.join(supports)} leave the body free to move: add a support, or "
            "stiffness to one"
        )
    U = np.zeros((6 * n, F.shape[1]))
    U[free] = scaled_solve(K, F[free])
    # what is rigidly held carries what the body and the loads leave there
    carried = F - body.stiffness @ U
    return Supported(U, {name: carried[body.rows(name)] for name in supports})


_FREE = 1e-13  # of a stiffness with a unit diagonal: below it no support holds a motion
