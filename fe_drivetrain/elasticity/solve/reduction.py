"""The system that is solved: constraints eliminated, still in 3x3 node blocks.

Eliminated degrees of freedom keep their place, with a diagonal entry and nothing else. So nodes
stay blocks, whatever an interface took from them, and solvers learn of nodes, rigid motions and
corner nodes.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.elasticity.interfaces.constraints import Elimination, ReferencePoint
from fe_drivetrain.elasticity.mesh.bodies import connected_bodies
from fe_drivetrain.elasticity.mesh.shapes import element_kind
from fe_drivetrain.elasticity.operator import graph, kernels
from fe_drivetrain.elasticity.solve.rank_rows import passed_on
from fe_drivetrain.elasticity.solve.sums import Sums, sums_of

#: Ground under the faces of joints, relative to the mean stiffness of a degree of freedom. It is in
#: preconditioners alone: answers are without it.
GROUND = 1e-4


@dataclass(frozen=True)
class Elements:
    """Elements of a system, for methods that cut it up.

    Attributes
    ----------
    points : Floats
        Node coordinates (n_nodes, 3) [m].
    cells : Ints
        Node numbers (n_cells, k) in VTK's order.
    diagonal : Floats
        Diagonal blocks (n_nodes, 3, 3) of the stiffness before any constraint [N/m].
    T, free : sparse.csr_array, NDArray[np.bool_]
        Matrix and free degrees of freedom of the
        `fe_drivetrain.elasticity.interfaces.constraints.Elimination`.
    """

    points: Floats
    cells: Ints
    diagonal: Floats
    T: sparse.csr_array
    free: NDArray[np.bool_]


@dataclass(frozen=True)
class System:
    """K q = T^T f, with what a multigrid method wants to know about it.

    Attributes
    ----------
    K : sparse.bsr_array
        Stiffness (n, n), symmetric positive definite, 3x3 blocks; rows of eliminated degrees of
        freedom are diagonal.
    prolongation : sparse.csr_array or None
        Matrix (n, n_corner) from the linear elements on the same corners to the quadratic ones, in
        degrees of freedom that fulfil the constraints; None where the elements are linear.
    near_nullspace : Floats
        (n_corner, 6), or (n, 6) of linear elements: the rigid motions.
    body : Ints
        (n_corner / 3,), or (n / 3,) of linear elements: which body each node belongs to, -1 of
        reference points. Bodies that a joint couples must not share an aggregate: each has its own
        six rigid motions.
    n_free : int
        Number of degrees of freedom that are left.
    elements : Elements or None
        Elements that it was made of; None where they are not known.
    joints : callable or None
        Makes its joints that take means over faces, apart from its bodies, for methods that want
        them so; None where there are none.
    """

    K: sparse.bsr_array
    prolongation: sparse.csr_array | None
    near_nullspace: Floats
    body: Ints
    n_free: int
    elements: Elements | None = None
    joints: "Callable[[], Joints] | None" = None

    __repr__ = short_repr


@dataclass(frozen=True)
class Joints:
    """Bodies without those of their joints that take means over faces, and these joints.

    Attributes
    ----------
    bodies : System
        Bodies on a soft ground under the joints' faces, for without the joints they may float.
    sums : Sums
        The joints.
    free : NDArray[np.bool_]
        Flags (n,): degrees of freedom that are left where the joints' conditions hold, too.
    """

    bodies: System
    sums: Sums
    free: NDArray[np.bool_]


def reduce(
    points: Floats,
    cells: Ints,
    K: sparse.bsr_array,
    elimination: Elimination,
    springs: Sequence[tuple[ReferencePoint, Floats]] = (),
    overwrite: bool = False,
) -> System:
    """Eliminate the constraints from a stiffness.

    Parameters
    ----------
    points : Floats
        (n_nodes, 3) [m].
    cells : Ints
        (n_cells, k) node numbers in VTK's order.
    K : sparse.bsr_array
        (n_dofs, n_dofs) stiffness before any constraint, three degrees of freedom a node first
        [N/m].
    elimination : Elimination
        The constraints.
    springs : sequence of (ReferencePoint, ndarray (6, 6))
        Those of K's springs that may be between means of faces: multigrid takes them apart again.
    overwrite : bool
        Whether the system may take the place of K where nothing else needs it: K is lost, and half
        of the memory saved.
    """
    places = _diagonal_places(K)
    diagonal = _blocks_at(K, places[: len(points)])
    elements = Elements(points, cells, diagonal, elimination.T, elimination.free)
    means = [c.is_mean for c in elimination.constraints] + [point.is_mean for point, _ in springs]
    reduced = reduced_stiffness(K, elimination, overwrite and not any(means), places)
    system = _system(points, cells, reduced, elimination)
    joints = partial(_joints, points, cells, K, elimination, springs) if any(means) else None
    return replace(system, elements=elements, joints=joints)


def _joints(
    points: Floats,
    cells: Ints,
    K: sparse.bsr_array,
    elimination: Elimination,
    springs: Sequence[tuple[ReferencePoint, Floats]],
) -> Joints:
    """Joints and bodies apart; arguments of `reduce`."""
    sums = sums_of(elimination, springs)
    faces = np.diff(sums.rows.tocsc().indptr) > 0
    ground = GROUND * float(K.diagonal().mean()) * sparse.diags_array(faces.astype(float))
    bodies = reduced_stiffness(_added(K.copy(), -sums.springs), sums.elimination)
    on_ground = _added(bodies, ground.tocsr())
    return Joints(_system(points, cells, on_ground, sums.elimination), sums, elimination.free)


def _system(
    points: Floats, cells: Ints, reduced: sparse.bsr_array, elimination: Elimination
) -> System:
    """A reduced stiffness with its corners, motions and bodies."""
    T, free = elimination.T, elimination.free
    motions = motions_with_points(points, elimination)
    body = np.full(len(free) // 3, -1)
    body[: len(points)] = connected_bodies(cells, len(points))
    prolongation = None
    if cells.shape[1] not in (4, 8):
        prolongation, corners = _prolongation(cells, len(points), T, free)
        motions, body = motions[corners], body[corners[::3] // 3]
    return System(reduced, prolongation, motions, body, int(free.sum()))


def diagonal_blocks(K: sparse.bsr_array) -> Floats:
    """(n_blocks, 3, 3) diagonal blocks; zero where there are none."""
    return _blocks_at(K, _diagonal_places(K))


def _blocks_at(K: sparse.bsr_array, places: Ints) -> Floats:
    blocks: Floats = K.data[places]
    blocks[places < 0] = 0.0
    return blocks


def _diagonal_places(K: sparse.bsr_array) -> Ints:
    """Places of the diagonal blocks; -1 where there are none."""
    nodes = np.arange(len(K.indptr) - 1)
    return np.asarray(graph.places(*kernels.pattern_of(K), nodes, nodes), dtype=np.int64)


def reduced_stiffness(
    K: sparse.bsr_array,
    elimination: Elimination,
    overwrite: bool = False,
    diagonal: Ints | None = None,
) -> sparse.bsr_array:
    """T^T K T, with the mean diagonal at eliminated degrees of freedom; K may be overwritten.

    Where the places of the diagonal blocks are known, they need not be found again.
    """
    T, free = elimination.T, elimination.free
    if diagonal is None:
        diagonal = _diagonal_places(K)
    mean = float(np.einsum("nii->", K.data[diagonal[diagonal >= 0]])) / len(free)
    passed = passed_on(K, T, free)
    indptr, indices = kernels.pattern_of(K)
    data = K.data if overwrite else np.empty_like(K.data)
    kernels.kept_blocks(indptr, indices, K.data, free.astype(float).reshape(-1, 3), data)
    kept = sparse.bsr_array((data, indices, indptr), shape=K.shape)
    gone = np.flatnonzero(~free)
    places = diagonal[gone // 3]
    has = places >= 0
    data[places[has], gone[has] % 3, gone[has] % 3] = mean
    # Degrees of freedom of reference points have no block of their own yet.
    bare = np.zeros(len(free))
    bare[gone[~has]] = mean
    if passed.nnz == 0 and not bare.any():
        return kept
    passed = passed + sparse.diags_array(bare)
    return in_blocks(kept + passed.tocsr().tobsr((3, 3)))


def _added(K: sparse.bsr_array, few: sparse.csr_array) -> sparse.bsr_array:
    """K with a few entries added: to itself where it has places for them."""
    blocks = few.tobsr((3, 3))
    rows = np.repeat(np.arange(len(blocks.indptr) - 1), np.diff(blocks.indptr))
    columns = blocks.indices.astype(np.int64)
    places = graph.places(*kernels.pattern_of(K), rows, columns)
    if (places < 0).any():
        return in_blocks(K + blocks)
    K.data[places] += blocks.data
    return K


def in_blocks(K: sparse.sparray) -> sparse.bsr_array:
    """The matrix in 3x3 blocks, sorted, with 32-bit indices as `kernels` is compiled for."""
    blocks = K.tobsr((3, 3))
    blocks.sort_indices()
    indptr, indices = kernels.pattern_of(blocks)
    return sparse.bsr_array((blocks.data, indices, indptr), shape=K.shape)


def motions_with_points(points: Floats, elimination: Elimination) -> Floats:
    """(n_dofs, 6) rigid motions; reference points follow through their constraints."""
    n = 3 * len(points)
    motions = np.zeros((len(elimination.free), 6))
    motions[:n] = rigid_motions(points, points.mean(axis=0))
    if n < len(motions) and elimination.constraints:
        rows = sparse.vstack([c.rows for c in elimination.constraints], format="csr")
        own = rows[:, n:]
        touching = np.flatnonzero(np.diff(own.indptr))
        right = -(rows[touching][:, :n] @ motions[:n])
        motions[n:] = np.linalg.lstsq(own[touching].toarray(), right, rcond=None)[0]
    motions[~elimination.free] = 0.0
    return motions


def _prolongation(
    cells: Ints, n_nodes: int, T: sparse.csr_array, free: np.ndarray
) -> tuple[sparse.csr_array, Ints]:
    """Prolongation from corner nodes (and reference points) to all, constraints fulfilled.

    Returns
    -------
    prolongation, corners
        (n, n_corner), and which degrees of freedom the columns are.
    """
    kind = element_kind(cells.shape[1])
    corners = cells[:, : kind.n_corners]
    # Any cell that has the node will do: on shared nodes all agree.
    place = np.zeros(n_nodes, dtype=np.int64)
    place[cells.ravel()] = np.arange(cells.size)
    cell, local = np.divmod(place, cells.shape[1])
    weights = kind.corner_weights()[local]
    has = weights != 0.0
    is_corner = np.zeros(n_nodes, dtype=bool)
    is_corner[corners] = True
    corner, number = np.flatnonzero(is_corner), np.cumsum(is_corner) - 1
    from_corners = sparse.csr_array(
        (weights[has], number[corners[cell][has]], np.append(0, np.cumsum(has.sum(axis=1)))),
        shape=(n_nodes, len(corner)),
    )
    n = T.shape[0]
    columns = np.concatenate(
        [(3 * corner[:, None] + np.arange(3)).ravel(), np.arange(3 * n_nodes, n)]
    )
    spread = _for_each_axis(from_corners, n - 3 * n_nodes)
    if T.nnz > np.count_nonzero(free):  # some follow others
        keeps = sparse.csr_array(
            (np.ones(len(columns)), (columns, np.arange(len(columns)))), shape=spread.shape
        )
        spread = (spread @ T[columns][:, columns] + keeps).tocsr()
    row, column = np.repeat(np.arange(n), np.diff(spread.indptr)), columns[spread.indices]
    spread.data *= free[row] & free[column]
    spread.data[row == column] = 1.0
    spread.eliminate_zeros()
    return spread, columns


def _for_each_axis(weights: sparse.csr_array, others: int) -> sparse.csr_array:
    """Weights of nodes for each of their three displacements; others keep to themselves.

    What `scipy.sparse.kron` and `block_diag` give, which sort all entries by their places.
    """
    counts = np.repeat(np.diff(weights.indptr), 3)
    indptr = np.concatenate([[0], np.cumsum(counts)])
    entries = np.arange(indptr[-1]) + np.repeat(
        np.repeat(weights.indptr[:-1], 3) - indptr[:-1], counts
    )
    axes = np.repeat(np.arange(len(counts)) % 3, counts)
    n, m = 3 * weights.shape[0], 3 * weights.shape[1]
    return sparse.csr_array(
        (
            np.concatenate([weights.data[entries], np.ones(others)]),
            np.concatenate([3 * weights.indices[entries] + axes, np.arange(m, m + others)]),
            np.concatenate([indptr, indptr[-1] + np.arange(1, others + 1)]),
        ),
        shape=(n + others, m + others),
    )
