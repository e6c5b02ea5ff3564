"""The system that is solved: constraints eliminated, still in 3x3 node blocks.

Eliminated degrees of freedom keep their place, with a diagonal entry and nothing else. So nodes
stay blocks, whatever an interface took from them, and solvers learn of nodes, rigid motions and
corner nodes.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
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
from fe_drivetrain.elasticity.operator import graph, kernels
from fe_drivetrain.elasticity.solve.linear_elements import from_linear
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
    diagonal = diagonal_blocks(K)
    elements = Elements(points, cells, diagonal[: len(points)], elimination.T, elimination.free)
    means = [c.is_mean for c in elimination.constraints] + [point.is_mean for point, _ in springs]
    mine = overwrite and not any(means)
    reduced = partial(reduced_stiffness, K, elimination, mine, diagonal)
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

    def on_ground() -> sparse.bsr_array:
        bodies = reduced_stiffness(_added(K.copy(), -sums.springs), sums.elimination)
        return _added(bodies, ground.tocsr())

    return Joints(_system(points, cells, on_ground, sums.elimination), sums, elimination.free)


def _system(
    points: Floats, cells: Ints, reduced: Callable[[], sparse.bsr_array], elimination: Elimination
) -> System:
    """A reduced stiffness with its corners, motions and bodies, found beside it."""
    with ThreadPoolExecutor(1) as pool:
        beside = pool.submit(_coarse, points, cells, elimination)
        K = reduced()
    return System(K, *beside.result(), int(elimination.free.sum()))


def _coarse(
    points: Floats, cells: Ints, elimination: Elimination
) -> tuple[sparse.csr_array | None, Floats, Ints]:
    """What multigrid wants to know about a mesh: prolongation, motions and bodies."""
    body = np.full(len(elimination.free) // 3, -1)
    body[: len(points)] = connected_bodies(cells, len(points))
    if cells.shape[1] in (4, 8):
        return None, motions_with_points(points, elimination), body
    way, corners = from_linear(cells, len(points), elimination.T, elimination.free)
    return way, motions_with_points(points, elimination, corners), body[corners[::3] // 3]


def diagonal_blocks(K: sparse.bsr_array) -> Floats:
    """(n_blocks, 3, 3) diagonal blocks; zero where there are none."""
    return graph.diagonal(*kernels.pattern_of(K), K.data)


def reduced_stiffness(
    K: sparse.bsr_array,
    elimination: Elimination,
    overwrite: bool = False,
    diagonal: Floats | None = None,
) -> sparse.bsr_array:
    """T^T K T, with the mean diagonal at eliminated degrees of freedom; K may be overwritten.

    Where the diagonal blocks are known, they need not be found again.
    """
    T, free = elimination.T, elimination.free
    if diagonal is None:
        diagonal = diagonal_blocks(K)
    mean = float(np.einsum("nii->", diagonal)) / len(free)
    passed = passed_on(K, T, free)
    indptr, indices = kernels.pattern_of(K)
    data = K.data if overwrite else np.empty_like(K.data)
    kernels.kept_blocks(indptr, indices, K.data, free.reshape(-1, 3), data)
    kept = sparse.bsr_array((data, indices, indptr), shape=K.shape)
    gone = np.flatnonzero(~free)
    places = graph.places(indptr, indices, gone // 3, gone // 3)
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


def motions_with_points(
    points: Floats, elimination: Elimination, chosen: Ints | None = None
) -> Floats:
    """(n_dofs, 6) rigid motions; reference points follow through their constraints.

    Where some are chosen, those of their degrees of freedom alone: all three of each node.
    """
    n, centre = 3 * len(points), points.mean(axis=0)
    if chosen is not None and n == len(elimination.free):
        motions = rigid_motions(points[chosen[::3] // 3], centre)
        motions[~elimination.free[chosen]] = 0.0
        return motions
    motions = np.zeros((len(elimination.free), 6))
    motions[:n] = rigid_motions(points, centre)
    if n < len(motions) and elimination.constraints:
        rows = sparse.vstack([c.rows for c in elimination.constraints], format="csr")
        own = rows[:, n:]
        touching = np.flatnonzero(np.diff(own.indptr))
        right = -(rows[touching][:, :n] @ motions[:n])
        motions[n:] = np.linalg.lstsq(own[touching].toarray(), right, rcond=None)[0]
    motions[~elimination.free] = 0.0
    return motions if chosen is None else motions[chosen]
