"""Interfaces, supports and reference points as linear constraints, eliminated and never penalised.

A constraint is a row of C in C u = 0 over all degrees of freedom u: three displacements a node,
then six for each rigid reference point. ``eliminate`` turns all rows together into u = T q, where q
are the degrees of freedom that are left, so that stiffness contrast cannot spoil the conditioning.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy import linalg, sparse
from scipy.sparse.linalg import splu

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import rigid_motions

AXES = ("x", "y", "z")

_BLOCK = 256  # columns that are dense at a time while constraints are eliminated


@dataclass(frozen=True)
class Constraint:
    """Rows of C u = 0 that belong to one named interface or support.

    Attributes
    ----------
    name : str
        Name of the rows, for messages.
    rows : sparse.csr_array
        (m, n_dofs) coefficients.
    pivots : Ints
        Degree of freedom (m,) that each row is solved for.
    sums : Ints
        Degrees of freedom that the rows bring in: sums over groups of nodes.
    is_mean : bool
        Whether a row takes a mean over a face.
    """

    name: str
    rows: sparse.csr_array
    pivots: Ints
    sums: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    is_mean: bool = False

    __repr__ = short_repr


@dataclass(frozen=True)
class ReferencePoint:
    """A point that loads and springs act on, tied to a face.

    Attributes
    ----------
    name : str
        Name of the point: "hub", "gearbox", ...
    position : Floats
        Position (3,) [m].
    motion : sparse.csr_array
        (6, n_dofs): displacement [m] and rotation [rad] of the point from all degrees of freedom.
        Its transpose spreads a force and a moment at the point over the degrees of freedom.
    """

    name: str
    position: Floats
    motion: sparse.csr_array

    __repr__ = short_repr

    @property
    def is_mean(self) -> bool:
        """Whether it moves as a face does on average, and not by degrees of freedom of its own."""
        return bool(self.motion.nnz > self.motion.shape[0])


def dofs(nodes: Ints) -> Ints:
    """The (n, 3) displacement degrees of freedom of n nodes."""
    return np.asarray(3 * np.asarray(nodes)[:, None] + np.arange(3))


def fixed(name: str, nodes: Ints, n_dofs: int) -> Constraint:
    """All displacements of the nodes are zero."""
    return held_nodes(name, nodes, (0, 1, 2), n_dofs)


def held_dofs(name: str, columns: Ints, n_dofs: int) -> Constraint:
    """These degrees of freedom are zero."""
    held = np.asarray(columns)
    return Constraint(name, _rows(np.ones((held.size, 1)), held[:, None], n_dofs), held)


def held_nodes(name: str, nodes: Ints, axes: Sequence[int], n_dofs: int) -> Constraint:
    """Displacements of the nodes along these axes (0, 1, 2) are zero."""
    return held_dofs(name, dofs(nodes)[:, list(axes)].ravel(), n_dofs)


def sliding_sphere(
    name: str, inner: Ints, outer: Ints, points: Floats, centre: Floats, n_dofs: int
) -> Constraint:
    """Spherical joint, sliding form: equal normal displacement, free tangential displacement.

    Parameters
    ----------
    inner, outer : Ints
        Nodes (n,) of the convex and of the concave side, pairwise at the same place.
    points : Floats
        (n_nodes, 3) node coordinates [m].
    centre : Floats
        Centre (3,) of the sphere [m].
    """
    normal = points[outer] - centre
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    columns = np.hstack([dofs(outer), dofs(inner)])
    largest = np.argmax(np.abs(normal), axis=1)
    pivots = 3 * np.asarray(outer) + largest
    return Constraint(name, _rows(np.hstack([normal, -normal]), columns, n_dofs), pivots)


def averaged_sphere(
    name: str,
    inner: Ints,
    outer: Ints,
    inner_weights: Floats,
    outer_weights: Floats,
    groups: Ints,
    first_dof: int,
    n_dofs: int,
) -> Constraint:
    """Spherical joint, averaged form: the mean displacements of the two faces are equal.

    One row over all nodes would couple each with each and fill the matrix. So every group of nodes
    gets its own sum as a degree of freedom, and the sums of the groups are what must vanish: the
    same constraint, eliminated sparsely.

    Parameters
    ----------
    inner, outer : Ints
        Nodes (n,) of the convex and of the concave side.
    inner_weights, outer_weights : Floats
        Integrals of the shape functions over the face at those nodes [m^2].
    groups : Ints
        Group number (2 n,) from 0 on of each node, inner ones first.
    first_dof : int
        First of the 3 n_groups degrees of freedom that are the groups' sums.
    """
    nodes = np.concatenate([inner, outer])
    weights = np.concatenate(
        [inner_weights / inner_weights.sum(), -outer_weights / outer_weights.sum()]
    )
    # Vertex nodes of straight-sided faces carry no weight, and no part in the mean.
    kept = np.abs(weights) > 1e-12 * np.abs(weights).max()
    nodes, weights, groups = (
        nodes[kept],
        weights[kept],
        np.unique(groups[kept], return_inverse=True)[1],
    )
    n_groups = int(groups.max()) + 1
    scale = np.bincount(groups, np.abs(weights))
    pivot_nodes = np.empty(n_groups, dtype=np.int64)
    # In ascending order of weight the last, heaviest node of each group stays.
    order = np.argsort(np.abs(weights))
    pivot_nodes[groups[order]] = nodes[order]

    # One component: rows "sum of group / scale = s_group", then "sum of scale s_group = 0".
    member = sparse.csr_array(
        (weights / scale[groups], (groups, nodes)), shape=(n_groups + 1, n_dofs // 3 + 1)
    )
    rows, pivots = [], []
    for axis in range(3):
        entries = member.tocoo()
        sums = first_dof + 3 * np.arange(n_groups) + axis
        rows.append(
            sparse.csr_array(
                (
                    np.concatenate([entries.data, -np.ones(n_groups), scale]),
                    (
                        np.concatenate(
                            [entries.coords[0], np.arange(n_groups), np.full(n_groups, n_groups)]
                        ),
                        np.concatenate([3 * entries.coords[1] + axis, sums, sums]),
                    ),
                ),
                shape=(n_groups + 1, n_dofs),
            )
        )
        pivots += [*(3 * pivot_nodes + axis), int(sums[np.argmax(scale)])]
    sums = first_dof + np.arange(3 * n_groups)
    return Constraint(name, sparse.vstack(rows, format="csr"), np.array(pivots), sums, True)


def centred_weights(weights: Floats, points: Floats, centre: Floats) -> Floats:
    """Face weights, tilted slightly so that their centroid is the given centre.

    A face's nodes are not quite symmetric about the centre of its joint. With these weights the
    force of an averaged joint passes through the centre exactly, and carries no moment about it.

    Parameters
    ----------
    weights : Floats
        Integrals (n,) of the shape functions over the face [m^2].
    points : Floats
        Nodes (n, 3) [m].
    centre : Floats
        Centre (3,) [m].
    """
    r = points - centre
    tilt = np.linalg.solve(np.einsum("n,ni,nj->ij", weights, r, r), -(weights @ r))
    return np.asarray(weights * (1.0 + r @ tilt))


def shared_motion(
    name: str, position: Floats, motion: sparse.csr_array, groups: Sequence[Ints], first: int
) -> tuple[Constraint, ReferencePoint]:
    """A motion of many nodes as the sum of its groups' shares, each a degree of freedom of its own.

    A spring on the motion itself would couple each node with each; on the shares it does not.

    Parameters
    ----------
    name, position : str, Floats
        Name and position (3,) of the point that moves so [m].
    motion : sparse.csr_array
        Motion (6, n_dofs) from the nodes' displacements.
    groups : Sequence[Ints]
        Nodes of each group; together all that the motion has, none of them twice.
    first : int
        First of the 6 len(groups) degrees of freedom.
    """
    n_dofs = motion.shape[1]
    columns = motion.tocsc()
    rows, pivots = [], []
    for number, nodes in enumerate(groups):
        chosen = dofs(nodes).ravel()
        share = columns[:, chosen].toarray()
        order = linalg.qr(share, mode="r", pivoting=True)[1]
        pivots.append(chosen[order[:6]])
        own = first + 6 * number + np.arange(6)[:, None]
        wide = np.broadcast_to(chosen, (6, chosen.size))
        rows.append(_rows(np.hstack([share, -np.ones((6, 1))]), np.hstack([wide, own]), n_dofs))
    shares = first + np.arange(6)[:, None] + 6 * np.arange(len(groups))
    total = _rows(np.ones(shares.shape), shares, n_dofs)
    stacked = sparse.vstack(rows, format="csr")
    own_dofs = shares.ravel()
    constraint = Constraint(f"{name} shares", stacked, np.concatenate(pivots), own_dofs, True)
    return constraint, ReferencePoint(name, position, total)


def rigid_face(name: str, nodes: Ints, points: Floats, point: ReferencePoint) -> Constraint:
    """The nodes move with the reference point as one rigid body (RBE2)."""
    n_dofs = point.motion.shape[1]
    columns = dofs(nodes).ravel()
    own = _rows(np.ones((columns.size, 1)), columns[:, None], n_dofs)
    rigid = sparse.csr_array(rigid_motions(points[nodes], point.position))
    return Constraint(name, (own - rigid @ point.motion).tocsr(), columns)


def equal_translations(name: str, first: ReferencePoint, second: ReferencePoint) -> Constraint:
    """Two reference points move together and turn freely."""
    rows = (first.motion[:3] - second.motion[:3]).tocsr()
    return Constraint(name, rows, _pivots(rows), is_mean=first.is_mean or second.is_mean)


def held(name: str, point: ReferencePoint, components: Sequence[int]) -> Constraint:
    """Motions of a reference point (0-2 displacements, 3-5 rotations) that are zero."""
    rows = point.motion[list(components)].tocsr()
    return Constraint(name, rows, _pivots(rows), is_mean=point.is_mean)


def rigid_point(name: str, position: Floats, first_dof: int, n_dofs: int) -> ReferencePoint:
    """A reference point with six degrees of freedom of its own, from ``first_dof`` on."""
    columns = first_dof + np.arange(6)[:, None]
    return ReferencePoint(name, position, _rows(np.ones((6, 1)), columns, n_dofs))


def averaged_point(
    name: str, nodes: Ints, weights: Floats, points: Floats, position: Floats, n_dofs: int
) -> ReferencePoint:
    """A reference point that moves as the face does on average, without stiffening it (RBE3).

    The rotation is the weighted least-squares fit of a rigid motion to the face's displacements:
    omega = I^-1 sum w r x u with r from the face's centroid, as in the RBE3 of Nastran.

    Parameters
    ----------
    nodes : Ints
        Nodes (n,) of the face.
    weights : Floats
        Integrals (n,) of the shape functions over the face [m^2].
    points : Floats
        (n_nodes, 3) node coordinates [m].
    position : Floats
        Position (3,) of the point [m].
    """
    w = weights / weights.sum()
    motions = rigid_motions(points[nodes], position)
    weighted = motions * np.repeat(w, 3)[:, None]
    fit = np.linalg.solve(motions.T @ weighted, weighted.T)
    columns = np.broadcast_to(dofs(nodes).ravel(), fit.shape)
    return ReferencePoint(name, position, _rows(fit, columns, n_dofs))


@dataclass(frozen=True)
class Elimination:
    """All constraints solved for their pivots: u = T q fulfils them for any q.

    Attributes
    ----------
    T : sparse.csr_array
        (n_dofs, n_dofs); the columns of eliminated degrees of freedom are empty.
    free : NDArray[np.bool_]
        Flags (n_dofs,): degrees of freedom that are left.
    constraints : tuple[Constraint, ...]
        Constraints that were eliminated.
    """

    T: sparse.csr_array
    free: NDArray[np.bool_]
    constraints: tuple[Constraint, ...]

    __repr__ = short_repr

    def multipliers(self, residual: Floats) -> dict[str, Floats]:
        """Constraint forces by the name of the constraint.

        Parameters
        ----------
        residual : Floats
            (n_dofs, n_loads) K u - f of the unconstrained system, which the constraints carry.

        Returns
        -------
        multipliers
            (m, n_loads) for each constraint: lambda in K u - f = C^T lambda, one a row of C.
        """
        if not self.constraints:
            return {}
        C, pivots = _stack(self.constraints)
        values = splu(C[:, pivots].T.tocsc()).solve(np.asarray(residual[pivots]))
        sizes = np.cumsum([len(c.pivots) for c in self.constraints])[:-1]
        return dict(zip((c.name for c in self.constraints), np.split(values, sizes), strict=True))

    def particular(self, right: Mapping[str, Floats]) -> Floats:
        """One u with C u = g: what is added to T q where displacements are prescribed.

        Parameters
        ----------
        right : Mapping[str, Floats]
            (m, n_loads) g of each constraint that is not homogeneous, by its name.

        Returns
        -------
        u
            (n_dofs, n_loads), zero at the degrees of freedom that are left.
        """
        C, pivots = _stack(self.constraints)
        n_loads = max(values.shape[1] for values in right.values())
        g = [right.get(c.name, np.zeros((len(c.pivots), n_loads))) for c in self.constraints]
        u = np.zeros((C.shape[1], n_loads))
        u[pivots] = splu(C[:, pivots].tocsc()).solve(np.vstack(g))
        return u


def eliminate(constraints: Sequence[Constraint], n_dofs: int) -> Elimination:
    """Solve all constraints together for their pivots.

    Raises
    ------
    InputError
        Two constraints hold the same degree of freedom.
    """
    owner = np.full(n_dofs, -1)
    for number, constraint in enumerate(constraints):
        taken = owner[constraint.pivots]
        if (taken >= 0).any() or len(np.unique(constraint.pivots)) < len(constraint.pivots):
            other = constraints[int(taken.max())].name if (taken >= 0).any() else constraint.name
            raise InputError(
                f"{constraint.name!r} and {other!r} constrain the same nodes: "
                "give each interface and support a face of its own"
            )
        owner[constraint.pivots] = number
    left = owner < 0
    if all(map(_holds_pivots_alone, constraints)):
        free = np.flatnonzero(left)
        rows = np.append(0, np.cumsum(left))
        T = sparse.csr_array((np.ones(free.size), free, rows), shape=(n_dofs, n_dofs))
    else:
        T = _with_dependent(constraints, left)
    return Elimination(T, left, tuple(constraints))


def _with_dependent(constraints: Sequence[Constraint], left: Bools) -> sparse.csr_array:
    """All degrees of freedom from those that are left, where some depend on these."""
    n_dofs, free = len(left), np.flatnonzero(left)
    keep = _selection(free, n_dofs)
    C, pivots = _stack(constraints)
    right = -C[:, free]
    # Pivots may stand in other rows too, so the (small, sparse) pivot block is solved; only for the
    # columns that are not empty.
    columns = np.flatnonzero(np.diff(right.indptr))
    factor = splu(C[:, pivots])
    solved = [
        sparse.csc_array(factor.solve(right[:, some].toarray()))
        for some in np.array_split(columns, len(columns) // _BLOCK + 1)
    ]
    dependent = sparse.hstack(solved, format="csr") @ _selection(columns, free.size).T
    T = (keep + _selection(pivots, n_dofs) @ dependent).tocsr()
    return (T @ keep.T).tocsr()


def _holds_pivots_alone(constraint: Constraint) -> bool:
    """Whether each row is a number times its pivot, on which nothing else depends."""
    return np.array_equal(np.sort(constraint.rows.indices), np.sort(constraint.pivots))


def _stack(constraints: Sequence[Constraint]) -> tuple[sparse.csc_array, Ints]:
    C = sparse.vstack([constraint.rows for constraint in constraints], format="csc")
    return C, np.concatenate([constraint.pivots for constraint in constraints])


def _selection(chosen: Ints, size: int) -> sparse.csr_array:
    """(size, n_chosen) matrix that puts values to their places."""
    return sparse.csr_array(
        (np.ones(chosen.size), (chosen, np.arange(chosen.size))), shape=(size, chosen.size)
    )


def _rows(coefficients: Floats, columns: Ints, n_dofs: int) -> sparse.csr_array:
    m, k = coefficients.shape
    return sparse.csr_array(
        (coefficients.ravel(), np.ascontiguousarray(columns).ravel(), np.arange(0, m * k + 1, k)),
        shape=(m, n_dofs),
    )


def _pivots(rows: sparse.csr_array) -> Ints:
    """One column for each row, so that the block of these columns is far from singular."""
    columns = np.unique(rows.indices)
    order = linalg.qr(rows[:, columns].toarray(), mode="r", pivoting=True)[1]
    return np.asarray(columns[order[: rows.shape[0]]])
