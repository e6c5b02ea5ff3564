"""Compiled rows that turn with carriers: matrices of a step made again at its end.

All rows are those of the springs, then five of each bearing. At a time they are sums of cosines and
sines of orders times t, the mean being the cosine of order 0; so is the stiffness of superelements.
What dampers feel of displacements that stay is the drift, the derivative of the rows by time, q
being constant.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import inner_loop, njit, places
from fe_drivetrain.dynamics.time.sparse_steps import Sparse

MASS, DAMPING, STIFFNESS, INVERSE, DRIFT = places(5)
"""Square matrices: of the equations, the inverse of A, and what dampers have of displacements where
rows turn."""


class Matrices(NamedTuple):
    """Matrices of one scheme and one length of step.

    ``coefficients``: those of `Scheme.coefficients`; ``squares`` (5, n, n); ``constant`` (n,)
    forces of offsets; ``rows`` (2, r, n): R and (A^-1 R^T)^T; ``compliance`` (r, r) R A^-1 R^T;
    ``held`` (2, h, n): motions that stay, at right angles, and accelerations along them by forces;
    ``sparse``: the same squares by their entries, where these are few and stay.
    """

    dt: float
    coefficients: Floats
    squares: Floats
    constant: Floats
    rows: Floats
    compliance: Floats
    held: Floats
    sparse: Sparse


class Turning(NamedTuple):
    """Rows that turn, in the form of the compiled loop.

    ``orders`` (T,) of cosine and sine, one after the other [rad/s], and ``waves`` (T, N n) of the
    rows; ``orders2``, ``waves2`` (T2, n n) of the superelements; ``springs`` (4, m): stiffness,
    damping, offset of all, and 1 where they are linear; ``damping`` (n, n) beside them. Rows
    ``rows_of[1]`` are ``rows_of[0]`` of the unknowns, derivatives ``drifts_of[1]`` are
    ``drifts_of[0]``. Overwritten: ``now`` (2, N, n), rows and their derivatives by time, and
    ``slopes`` (n, n) of the superelements.
    """

    orders: Floats
    waves: Floats
    orders2: Floats
    waves2: Floats
    springs: Floats
    damping: Floats
    rows_of: Ints
    drifts_of: Ints
    now: Floats
    slopes: Floats


NOTHING_TURNS = Turning(
    np.zeros(0),
    np.zeros((0, 0)),
    np.zeros(0),
    np.zeros((0, 0)),
    np.zeros((4, 0)),
    np.zeros((0, 0)),
    np.zeros((2, 0), dtype=np.int64),
    np.zeros((2, 0), dtype=np.int64),
    np.zeros((2, 0, 0)),
    np.zeros((0, 0)),
)
"""No rows that turn: orders, of which others have two at least, are none.

Loops on rolling bearings take it, so that these are compiled once, whether rows turn or not.
"""


@inner_loop
def _sum(
    orders: Floats, waves: Floats, t: float, now: Floats, slopes: Floats
) -> None:  # pragma: no cover - compiled
    """Sum of waves at a time, and its derivative, overwritten."""
    by, slope = np.empty(len(orders)), np.empty(len(orders))
    for k in range(0, len(orders), 2):
        c, s = np.cos(orders[k] * t), np.sin(orders[k] * t)
        by[k], by[k + 1] = c, s
        slope[k], slope[k + 1] = -orders[k] * s, orders[k] * c
    np.dot(by, waves, now)
    np.dot(slope, waves, slopes)


@inner_loop
def turn(turning: Turning, matrices: Matrices, t: float) -> None:  # pragma: no cover - compiled
    """Rows and matrices at a time, overwritten."""
    b, squares, springs = matrices.coefficients, matrices.squares, turning.springs
    n, m = squares.shape[1], springs.shape[1]
    _sum(turning.orders, turning.waves, t, turning.now[0].ravel(), turning.now[1].ravel())
    extra = np.empty(n * n)
    _sum(turning.orders2, turning.waves2, t, extra, turning.slopes.ravel())
    H, S = turning.now[0, :m], turning.now[1, :m]
    stiff, damped = np.empty((n, m)), np.empty((n, m))
    for j in range(n):
        matrices.constant[j] = 0.0
        for i in range(m):
            stiff[j, i] = springs[0, i] * H[i, j]
            damped[j, i] = springs[1, i] * H[i, j]
            matrices.constant[j] += springs[3, i] * springs[2, i] * stiff[j, i]
    np.dot(stiff, H, squares[STIFFNESS])
    np.dot(damped, H, squares[DAMPING])
    np.dot(damped, S, squares[DRIFT])
    A = np.empty((n, n))
    for i in range(n):
        for j in range(n):
            squares[STIFFNESS, i, j] += extra[i * n + j]
            squares[DAMPING, i, j] += turning.damping[i, j]
            inside = squares[STIFFNESS, i, j] + squares[DRIFT, i, j]
            inside += b[1] * squares[DAMPING, i, j]
            A[i, j] = (1.0 - b[6]) * b[0] * squares[MASS, i, j] + (1.0 - b[7]) * inside
    inverse = np.linalg.inv(A)
    for i in range(n):
        for j in range(n):
            squares[INVERSE, i, j] = inverse[i, j]
    _place(turning.rows_of, turning.now[0], matrices.rows[0])
    _place(turning.drifts_of, turning.now[1], matrices.rows[0])
    constrain(matrices)


@inner_loop
def _place(of: Ints, rows: Floats, R: Floats) -> None:  # pragma: no cover - compiled
    """Rows where they are among the unknowns."""
    for k in range(of.shape[1]):
        for j in range(R.shape[1]):
            R[of[0, k], j] = rows[of[1, k], j]


@njit(cache=True, error_model="numpy")
def constrain(matrices: Matrices) -> None:  # pragma: no cover - compiled
    """Project the inverse so that it leaves held motions as they are, and update the rows."""
    A, rows = matrices.squares[INVERSE], matrices.rows
    n = len(A)
    by, of = np.empty(n), np.empty(n)
    for k in range(matrices.held.shape[1]):
        g = matrices.held[0, k]
        np.dot(A, g, by)
        np.dot(A.T, g, of)
        size = 0.0
        for i in range(n):
            size += g[i] * by[i]
        for i in range(n):
            share = by[i] / size
            for j in range(n):
                A[i, j] -= share * of[j]
    if rows.shape[1] > 0:
        np.dot(rows[0], A.T, rows[1])
        np.dot(rows[0], rows[1].T, matrices.compliance)
