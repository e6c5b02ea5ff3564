"""Rows of a reduced stiffness that one process of many makes for itself, of NumPy and SciPy alone.

A process knows the elements that its rows come from: those of its own nodes, and those of nodes
that follow its own by a constraint. No row needs a number of another process, and none has the
whole matrix. Elements at the border of two parts are integrated by both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import CHUNK, Bools, Floats, Ints, chunks
from fe_drivetrain.elasticity.operator.element_matrices import Rule, element_stiffness


@dataclass(frozen=True)
class Reduction:
    """Constraints as one process needs them, and springs.

    Attributes
    ----------
    T : sparse.csr_array
        Matrix (3 n, 3 n) of the elimination, between the n node blocks of the share.
    free : Bools
        Flags (3 n,): degrees of freedom that are left.
    motions : sparse.csr_array
        Motions (s, 3 N) that stretch the springs, from the degrees of freedom of all processes.
    stiffness : Floats
        Stiffness (s, s) of the springs [N/m, N, N m/rad].
    trace : float
        Trace of what the springs add to the stiffness before any constraint [N/m].
    grounded : Bools
        Flags (3 n,): degrees of freedom that have a ground beside.
    """

    T: sparse.csr_array
    free: Bools
    motions: sparse.csr_array
    stiffness: Floats
    trace: float
    grounded: Bools


@dataclass(frozen=True)
class Share:
    """Elements from which one process makes its rows.

    Attributes
    ----------
    blocks : Ints
        Numbers (n,) of its node blocks among all, ascending.
    low, high : int
        Range of its own node blocks among all, low to high - 1.
    points : Floats
        Points (n, 3) [m]; anything at reference points.
    cells : Ints
        Places (n_cells, k) in ``blocks`` of the nodes of its elements.
    material : Ints
        Row (n_cells,) of ``lame``.
    lame : Floats
        Lame's constants (n_materials, 2) [Pa].
    functions : Ints
        Functions (n_materials,), see `element_stiffness`.
    rule : Rule
        Quadrature rule of the elements.
    body : Ints
        Body (n,) that each block belongs to, -1 of reference points.
    """

    blocks: Ints
    low: int
    high: int
    points: Floats
    cells: Ints
    material: Ints
    lame: Floats
    functions: Ints
    rule: Rule
    body: Ints

    @property
    def own(self) -> slice:
        """Places in ``blocks`` of its own."""
        low, high = np.searchsorted(self.blocks, (self.low, self.high))
        return slice(int(low), int(high))


def assembled(share: Share) -> sparse.bsr_array:
    """Stiffness (3 n, 3 n) of a share's elements before any constraint, in 3x3 blocks [N/m].

    Rows of nodes that have elements beyond the share are not complete.
    """
    n, (n_cells, k) = len(share.blocks), share.cells.shape
    touched = sparse.csr_array(
        (np.ones(n_cells * k, bool), share.cells.ravel(), k * np.arange(n_cells + 1)),
        shape=(n_cells, n),
    )
    pattern = (touched.T @ touched).tocsr()
    pattern.sort_indices()
    rows = np.repeat(np.arange(n, dtype=np.int64), np.diff(pattern.indptr))
    places = rows * n + pattern.indices
    data = np.zeros((len(places), 3, 3))
    for number, (constants, functions) in enumerate(zip(share.lame, share.functions, strict=True)):
        cells = share.cells[share.material == number]
        for chunk in chunks(len(cells), CHUNK // 4):
            some = cells[chunk]
            lam, mu = (float(value) for value in constants)
            K = element_stiffness(share.points, some, share.rule, (lam, mu), int(functions))
            wanted = some[:, :, None] * np.int64(n) + some[:, None, :]
            _add(data, np.searchsorted(places, wanted.ravel()), K.reshape(-1, 3, 3))
    return sparse.bsr_array((data, pattern.indices, pattern.indptr), shape=(3 * n, 3 * n))


def _add(data: Floats, places: Ints, blocks: Floats) -> None:
    """Add blocks at their places, of which some are the same."""
    order = np.argsort(places, kind="stable")
    here, starts = np.unique(places[order], return_index=True)
    data[here] += np.add.reduceat(blocks[order], starts, axis=0)


def own_trace(K: sparse.bsr_array, share: Share) -> float:
    """Sum of the diagonal of a share's own rows [N/m]."""
    own = share.own
    return float(K.diagonal()[3 * own.start : 3 * own.stop].sum())


def own_rows(
    K: sparse.bsr_array,
    share: Share,
    reduction: Reduction,
    mean: float,
    ground: float = 0.0,
    within_bodies: bool = False,
) -> sparse.csr_array:
    """A share's rows of T^T (K + springs) T.

    Parameters
    ----------
    K : sparse.bsr_array
        Stiffness from `assembled`.
    share : Share
        Share of the process.
    reduction : Reduction
        Constraints and springs.
    mean : float
        Stiffness at eliminated degrees of freedom [N/m].
    ground : float
        Stiffness under those that have a ground [N/m].
    within_bodies : bool
        Whether entries that couple two bodies are left out.

    Returns
    -------
    rows
        Rows (3 (high - low), 3 N), columns ascending; zeros are left out.
    """
    own, free = share.own, reduction.free
    dofs = slice(3 * own.start, 3 * own.stop)
    first, last = K.indptr[own.start], K.indptr[own.stop]
    indptr, indices = K.indptr[own.start : own.stop + 1] - first, K.indices[first:last]
    mask = free.reshape(-1, 3)
    left = np.repeat(mask[own], np.diff(indptr), axis=0)
    data = K.data[first:last] * (left[:, :, None] & mask[indices][:, None, :])
    height, width = dofs.stop - dofs.start, reduction.motions.shape[1]
    plain = sparse.bsr_array((data, indices, indptr), shape=(height, K.shape[1])).tocsr()
    del data
    diagonal = np.where(free[dofs], ground * reduction.grounded[dofs], mean)
    there = np.flatnonzero(diagonal)
    stands = sparse.csr_array(
        (diagonal[there], (there, dofs.start + there)), shape=(height, K.shape[1])
    )
    rows = (plain + (passed_on(K, reduction.T, free)[dofs] + stands)).tocsr()
    del plain
    if within_bodies:
        rows.data[_between_bodies(rows, share)] = 0.0
    rows.eliminate_zeros()
    rows.sort_indices()
    columns = 3 * share.blocks[rows.indices // 3] + rows.indices % 3
    rows = sparse.csr_array((rows.data, columns, rows.indptr), shape=(height, width))
    if reduction.motions.shape[0]:
        stretched = reduction.motions[:, 3 * share.low : 3 * share.high]
        forces = sparse.csr_array(reduction.stiffness) @ reduction.motions
        rows = (rows + stretched.T @ forces).tocsr()
        rows.sort_indices()
    return rows


def _between_bodies(rows: sparse.csr_array, share: Share) -> Bools:
    """Which entries of rows of a share couple two bodies."""
    a = np.repeat(np.repeat(share.body[share.own], 3), np.diff(rows.indptr))
    b = share.body[rows.indices // 3]
    return np.asarray((a != b) & (a >= 0) & (b >= 0))


def passed_on(K: sparse.bsr_array, T: sparse.csr_array, free: Bools) -> sparse.csr_array:
    """Terms that eliminated degrees of freedom pass on to the others, (n, n).

    It is T^T K T without what stands between those that are left. For supports it is nothing, for
    joints little.

    Parameters
    ----------
    K : sparse.bsr_array
        Stiffness (n, n), symmetric, before any constraint.
    T, free : sparse.csr_array, Bools
        Matrix (n, n) and flags (n,) of the elimination.
    """
    pivots = np.flatnonzero(~free & (np.diff(T.indptr) > 0))
    if not len(pivots):
        return sparse.csr_array(K.shape)
    rows = rows_of(K, pivots)
    dependent = T[pivots]
    between = rows[:, pivots]
    rows = rows.copy()
    rows.data *= free[rows.indices]
    rows.eliminate_zeros()
    across = dependent.T @ rows
    return (across + across.T + dependent.T @ between @ dependent).tocsr()


def rows_of(K: sparse.bsr_array, chosen: Ints) -> sparse.csr_array:
    """Some rows of a matrix in blocks; to select them by a product would convert all of it."""
    nodes, place = np.unique(chosen // 3, return_inverse=True)
    counts = np.diff(K.indptr)[nodes]
    starts = np.concatenate([[0], np.cumsum(counts)])
    entries = np.arange(starts[-1]) + np.repeat(K.indptr[nodes] - starts[:-1], counts)
    blocks = sparse.bsr_array(
        (K.data[entries], K.indices[entries], starts), shape=(3 * len(nodes), K.shape[1])
    )
    return blocks.tocsr()[3 * place + chosen % 3]


def keep(file: Path, share: Share, reductions: Sequence[Reduction]) -> None:
    """Keep a share and its reductions, for `kept`."""
    values: dict[str, Any] = {"own": np.array([share.low, share.high])}
    values |= {f"share {name}": getattr(share, name) for name in _ARRAYS}
    values |= {f"rule {name}": getattr(share.rule, name) for name in _RULE}
    for number, found in enumerate(reductions):
        named = {"free": found.free, "stiffness": found.stiffness, "grounded": found.grounded}
        named["trace"] = np.array(found.trace)
        for name, matrix in (("T", found.T), ("motions", found.motions)):
            named |= {f"{name} {part}": getattr(matrix, part) for part in _PARTS}
            named[f"{name} shape"] = np.array(matrix.shape)
        values |= {f"{number} {name}": value for name, value in named.items()}
    np.savez(file, **values)


def kept(file: Path) -> tuple[Share, tuple[Reduction, ...]]:
    """Load what `keep` has kept."""
    with np.load(file) as values:

        def matrix(name: str) -> sparse.csr_array:
            data, indices, indptr = (values[f"{name} {part}"] for part in _PARTS)
            return sparse.csr_array((data, indices, indptr), shape=tuple(values[f"{name} shape"]))

        low, high = values["own"].tolist()
        arrays = {name: values[f"share {name}"] for name in _ARRAYS}
        rule = Rule(*(values[f"rule {name}"] for name in _RULE))
        share = Share(low=low, high=high, rule=rule, **arrays)
        numbers = [n for n in ("0", "1") if f"{n} free" in values]
        reductions = tuple(
            Reduction(
                matrix(f"{n} T"),
                values[f"{n} free"],
                matrix(f"{n} motions"),
                values[f"{n} stiffness"],
                float(values[f"{n} trace"]),
                values[f"{n} grounded"],
            )
            for n in numbers
        )
    return share, reductions


_ARRAYS = ("blocks", "points", "cells", "material", "lame", "functions", "body")
_RULE = ("gradients", "weights", "values")
_PARTS = ("data", "indices", "indptr")
