"""Files that processes of `petsc` take their part of a system from."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.elasticity.mesh.bodies import connected_bodies
from fe_drivetrain.elasticity.solve.element_system import ElementSystem, cut, parts, sizes
from fe_drivetrain.elasticity.solve.rank_rows import keep
from fe_drivetrain.elasticity.solve.reduction import GROUND, Elements, System
from fe_drivetrain.elasticity.solve.sums import Sums


def hand_over(folder: Path, system: ElementSystem | System, method: str, count: int) -> Ints:
    """Write files of which each process reads its part.

    Parameters
    ----------
    folder : Path
        Folder that the files are written to.
    system : ElementSystem or System
        System that is handed over.
    method : str
        Method "petsc", which wants joints that take means apart, or "petsc-mumps".
    count : int
        Number of processes.

    Returns
    -------
    order
        Node blocks (n_blocks,) in the order of the processes.
    """
    if isinstance(system, ElementSystem):
        order, setup = _elements(folder, system, method, count)
    else:
        order, setup = _matrices(folder, system, method, count)
    (folder / "setup.json").write_text(json.dumps({"method": method, **setup}))
    return order


def _elements(
    folder: Path, system: ElementSystem, method: str, count: int
) -> tuple[Ints, dict[str, object]]:
    aggregates = method == "petsc"
    whole = cut(system, count, apart=aggregates)
    for number, (share, reductions) in enumerate(whole.shares()):
        keep(folder / f"share-{number}.npz", share, reductions)
    np.save(folder / "motions.npy", blockwise(system.motions(aggregates), whole.order))
    joined = aggregates and system.sums is not None
    if joined:
        assert system.sums is not None
        (folder / "bodies").mkdir()
        _write_joints(folder / "bodies", system.sums, system.elimination.free, whole.order)
    return whole.order, {
        "elements": True,
        "starts": whole.starts.tolist(),
        "apart": aggregates and (joined or int(system.body.max()) > 0),
        "joined": joined,
        "ground": GROUND,
    }


def _matrices(
    folder: Path, system: System, method: str, count: int
) -> tuple[Ints, dict[str, object]]:
    blocks = system.K.shape[0] // 3
    order = np.arange(blocks)
    starts = np.concatenate([[0], np.cumsum(sizes(blocks, count))])
    if system.elements is not None:
        # reference points have no place, and go with the last part
        points = system.elements.points
        order = np.concatenate([parts(points, count), order[len(points) :]])
        starts = np.append(0, np.cumsum(sizes(len(points), count)))
        starts[-1] = blocks
    _write_matrix(folder, system.K, order)
    joints = system.joints() if method == "petsc" and system.joints is not None else None
    bodies = system if joints is None else joints.bodies
    motions = bodies.near_nullspace
    if bodies.prolongation is not None:
        motions = bodies.prolongation @ motions
    np.save(folder / "motions.npy", blockwise(motions, order))
    apart = _apart(bodies.K, system.elements) if method == "petsc" else system.K
    if apart is not system.K:
        _write_matrix(folder / "bodies", apart, order)
    if joints is not None:
        _write_joints(folder / "bodies", joints.sums, joints.free, order)
    return order, {
        "elements": False,
        "starts": starts.tolist(),
        "apart": apart is not system.K,
        "joined": joints is not None,
    }


def _apart(K: sparse.bsr_array, elements: Elements | None) -> sparse.bsr_array:
    """The stiffness without what couples bodies, for an aggregate must not be of two of them.

    What is left of a symmetric positive definite matrix is so, too. The few motions of bodies
    against each other that the coupling adds cost an iteration each.
    """
    if elements is None:
        return K
    body = np.full(K.shape[0] // 3, -1)
    body[: len(elements.points)] = connected_bodies(elements.cells, len(elements.points))
    a, b = body[np.repeat(np.arange(len(body)), np.diff(K.indptr))], body[K.indices]
    dropped = (a != b) & (a >= 0) & (b >= 0)
    if not dropped.any():
        return K
    data = np.where(dropped[:, None, None], 0.0, K.data)
    return sparse.bsr_array((data, K.indices, K.indptr), shape=K.shape)


def _write_matrix(folder: Path, K: sparse.bsr_array, order: Ints) -> None:
    folder.mkdir(exist_ok=True)
    blocks = len(order)
    number = np.arange(1, len(K.indices) + 1)
    places = sparse.csr_array((number, K.indices, K.indptr), shape=(blocks, blocks))
    places = places[order][:, order]
    places.sort_indices()
    np.save(folder / "indptr.npy", places.indptr.astype(np.int64))
    np.save(folder / "indices.npy", places.indices)
    np.save(folder / "data.npy", K.data[places.data - 1])


def _write_joints(folder: Path, sums: Sums, free: Bools, order: Ints) -> None:
    """Joints that take means over faces; see `multigrid.Joined`."""
    dofs = (3 * order[:, None] + np.arange(3)).ravel()
    place = np.empty_like(dofs)
    place[dofs] = np.arange(len(dofs))
    sparse.save_npz(folder / "rows.npz", sums.rows.tocsc()[:, dofs].tocsr())
    sparse.save_npz(folder / "shares.npz", sums.shares.tocsc()[:, dofs].tocsr())
    np.save(folder / "flexibility.npy", sums.flexibility)
    np.save(folder / "dofs.npy", place[sums.dofs])
    np.save(folder / "free.npy", free[dofs])


def blockwise(values: Floats, order: Ints) -> Floats:
    """(3 n, m) values in another order of nodes (n,)."""
    return np.ascontiguousarray(values.reshape(len(order), -1)[order]).reshape(values.shape)
