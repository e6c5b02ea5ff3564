"""Matrices of a step with their entries alone, and the factors of the one that is solved.

A drivetrain's bodies are in a row, so that its matrices have few entries in a row and their factors
hardly more. Beyond some size these are faster than dense products, and the time of a step grows as
the number of degrees of freedom, not as its square.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import inner_loop, places

FULL = 0.2
"""Share of entries from which on a dense product is faster."""

FEW = 32
"""Degrees of freedom below which a dense product is faster, whatever is in it."""

LOWER, UPPER = places(2, 3)
"""Numbers of the factors among the matrices, behind mass, damping and stiffness."""


class Sparse(NamedTuple):
    """Matrices of n rows one behind the other; without any where dense ones are faster.

    ``starts`` (5, n + 1) of the rows in ``columns`` and ``values`` (nnz,): mass, damping,
    stiffness, the lower factor without its diagonal of ones, and the upper one without its
    diagonal. ``orders`` (2, n) of the rows and the columns of the factors; ``scales`` (2, n) of the
    unknowns, and the inverse diagonal of the upper factor. Factors may be absent, (3, n + 1).
    """

    starts: Ints
    columns: Ints
    values: Floats
    orders: Ints
    scales: Floats


NO_SPARSE = Sparse(
    np.zeros((0, 1), dtype=np.int64),
    np.zeros(0, dtype=np.int64),
    np.zeros(0),
    np.zeros((2, 0), dtype=np.int64),
    np.zeros((2, 0)),
)


def sparse_of(squares: list[Floats], A: Floats | None) -> Sparse:
    """Matrices by their entries, where these are few.

    Parameters
    ----------
    squares : list of ndarray, (n, n)
        Mass, damping and stiffness.
    A : ndarray (n, n) or None
        Matrix of a step, to be factorised; None where it is not to be.

    Returns
    -------
    found : Sparse
        `NO_SPARSE` where the matrices are filled; without factors where these are, or without A.
    """
    from scipy import sparse

    n = len(squares[0])
    if n < FEW:
        return NO_SPARSE
    matrices = [sparse.csr_array(one) for one in squares]
    if max(one.nnz for one in matrices) > FULL * n * n:
        return NO_SPARSE
    orders, scales = np.zeros((2, n), dtype=np.int64), np.ones((2, n))
    if A is not None:
        matrices += _factors(A, orders, scales)
    starts, columns, values, before = [], [], [], 0
    for one in matrices:
        starts.append(one.indptr.astype(np.int64) + before)
        columns.append(one.indices.astype(np.int64))
        values.append(np.asarray(one.data, dtype=np.float64))
        before += one.nnz
    return Sparse(np.array(starts), np.concatenate(columns), np.concatenate(values), orders, scales)


def _factors(A: Floats, orders: Ints, scales: Floats) -> list[Any]:
    """Lower and upper factor beside their diagonals, none where filled; orders and scales."""
    from scipy import sparse
    from scipy.sparse.linalg import splu

    n = len(A)
    # masses and stiffnesses hold what they are on, so that the diagonal can be pivots
    scales[0] = 1.0 / np.sqrt(A.diagonal())
    scaled = sparse.csc_array(scales[0][:, None] * A * scales[0])
    found = splu(
        scaled,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    if found.L.nnz + found.U.nnz > FULL * n * n:
        return []
    orders[0, found.perm_r] = np.arange(n)
    orders[1] = found.perm_c
    scales[1] = 1.0 / found.U.diagonal()
    return [sparse.csr_array(sparse.tril(found.L, -1)), sparse.csr_array(sparse.triu(found.U, 1))]


@inner_loop
def product(
    sparse: Sparse, k: int, x: Floats, i: int, y: Floats, j: int
) -> None:  # pragma: no cover - compiled
    """Matrix k by ``x[i]`` into ``y[j]``."""
    starts, columns, values = sparse.starts, sparse.columns, sparse.values
    for row in range(starts.shape[1] - 1):
        total = 0.0
        for place in range(starts[k, row], starts[k, row + 1]):
            total += values[place] * x[i, columns[place]]
        y[j, row] = total


@inner_loop
def solve(
    sparse: Sparse, x: Floats, i: int, scratch: int, j: int
) -> None:  # pragma: no cover - compiled
    """A^-1 ``x[i]`` into ``x[j]``, by way of ``x[scratch]``."""
    starts, columns, values = sparse.starts, sparse.columns, sparse.values
    orders, scales, n = sparse.orders, sparse.scales, starts.shape[1] - 1
    for row in range(n):
        at = orders[0, row]
        total = scales[0, at] * x[i, at]
        for place in range(starts[LOWER, row], starts[LOWER, row + 1]):
            total -= values[place] * x[scratch, columns[place]]
        x[scratch, row] = total
    for back in range(n):
        row = n - 1 - back
        total = x[scratch, row]
        for place in range(starts[UPPER, row], starts[UPPER, row + 1]):
            total -= values[place] * x[scratch, columns[place]]
        x[scratch, row] = total * scales[1, row]
    for row in range(n):
        x[j, row] = scales[0, row] * x[scratch, orders[1, row]]
