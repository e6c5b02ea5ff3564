"""Newton's method of one step in time, compiled: the values of few rows are the unknowns.

z = z_free - (1 - a_f) S d(z, z'),    S = R A^-1 R^T
"""

from __future__ import annotations

from numba import njit

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.dynamics.bearing_loops import Rolling, bearing_forces
from fe_drivetrain.dynamics.energy_account import FOLLOWED, POWER, STORED
from fe_drivetrain.dynamics.law_loops import law_forces
from fe_drivetrain.dynamics.loop_forms import (
    BASE,
    CHANGE,
    D1,
    DAMPER1,
    DAMPS,
    FREE,
    MOVED_ROW,
    NEW,
    PHASE_ROW,
    RATE,
    RESIDUAL,
    SCALE,
    SPRING,
    TILTED_ROW,
    ZA,
    ZR,
    Model,
    Work,
)

#: Newton steps after which a time step counts as not converged; half of them at full length.
MOST_STEPS = 40


@njit(cache=True, error_model="numpy")
def _solve(A: Floats, b: Floats) -> None:  # pragma: no cover - compiled
    """A^-1 b into b, A overwritten: Gauss with row pivots; small, so that no library is called."""
    n = len(b)
    for k in range(n):
        p = k
        for i in range(k + 1, n):
            if abs(A[i, k]) > abs(A[p, k]):
                p = i
        if p != k:
            for j in range(k, n):
                A[k, j], A[p, j] = A[p, j], A[k, j]
            b[k], b[p] = b[p], b[k]
        for i in range(k + 1, n):
            f = A[i, k] / A[k, k]
            if f != 0.0:
                for j in range(k + 1, n):
                    A[i, j] -= f * A[k, j]
                b[i] -= f * b[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            b[k] -= A[k, j] * b[j]
        b[k] /= A[k, k]


@njit(cache=True, error_model="numpy")
def _forces_at(model: Model, rolling: Rolling, t: float, w: Work) -> None:  # pragma: no cover
    """Forces beyond the matrices at values of the rows at the end of a step, and their tangent."""
    b, x, of = model.matrices.coefficients, w.rows, w.laws
    for i in range(x.shape[1]):
        x[RATE, i] = b[1] * (x[NEW, i] - x[BASE, i]) + b[4] * x[ZR, i] + b[5] * x[ZA, i]
    w.sums[0, STORED], w.sums[0, POWER], w.sums[0, FOLLOWED] = law_forces(
        model.laws, t, x[NEW], x[RATE], of[DAMPS], b[1], x[D1], w.squares[0], of[SPRING],
        of[DAMPER1],
    )  # fmt: skip
    if len(rolling.seconds) > 0:
        bearing_forces(
            rolling, x[NEW], x[RATE], b[1], x[D1], w.squares[0], w.bearings, w.resisted[1],
            w.scratch,
        )  # fmt: skip


@njit(cache=True, error_model="numpy")
def _residual(share: float, S: Floats, x: Floats) -> None:  # pragma: no cover - compiled
    for i in range(len(S)):
        x[RESIDUAL, i] = x[FREE, i] - x[NEW, i]
        for j in range(len(S)):
            x[RESIDUAL, i] -= share * S[i, j] * x[D1, j]


@njit(cache=True, error_model="numpy")
def _jacobian(share: float, S: Floats, squares: Floats) -> None:  # pragma: no cover - compiled
    """I + share S tangent, from squares[0] into squares[1]."""
    tangent, found, r = squares[0], squares[1], len(S)
    for i in range(r):
        for j in range(r):
            found[i, j] = 1.0 if i == j else 0.0
    for j in range(r):
        for k in range(r):
            by = tangent[j, k]
            if by != 0.0:
                for i in range(r):
                    found[i, k] += share * S[i, j] * by


@njit(cache=True, error_model="numpy")
def _unbalance(kinds: Floats, x: Floats) -> float:  # pragma: no cover - compiled
    """Maximum residual over what its value has been."""
    most = 0.0
    for i in range(x.shape[1]):
        size = 1.0 if kinds[PHASE_ROW, i] != 0.0 or x[SCALE, i] == 0.0 else x[SCALE, i]
        most = max(most, abs(x[RESIDUAL, i]) / size)
    return most


@njit(cache=True, error_model="numpy")
def scales(kinds: Floats, x: Floats) -> None:  # pragma: no cover - compiled
    """Maximum of each value so far; of bearings that of all motions, and of all tilts."""
    moved = tilted = 0.0
    for i in range(x.shape[1]):
        x[SCALE, i] = max(x[SCALE, i], abs(x[FREE, i]), abs(x[BASE, i]))
        moved = max(moved, kinds[MOVED_ROW, i] * x[SCALE, i])
        tilted = max(tilted, kinds[TILTED_ROW, i] * x[SCALE, i])
    for i in range(x.shape[1]):
        if kinds[MOVED_ROW, i] != 0.0:
            x[SCALE, i] = moved
        if kinds[TILTED_ROW, i] != 0.0:
            x[SCALE, i] = max(tilted, moved)  # a metre away


@njit(cache=True, error_model="numpy")
def newton(
    model: Model, rolling: Rolling, t: float, tolerance: float, w: Work, counts: Ints
) -> None:  # pragma: no cover - compiled
    """Values of the rows at the end of a step, and the forces there.

    With bearings, whose rollers leave and come back, changes are as short as the residual falls.
    """
    x, S, bearings = w.rows, model.matrices.compliance, len(rolling.seconds) > 0
    share, r = 1.0 - model.matrices.coefficients[7], len(S)
    for i in range(r):
        x[NEW, i] = x[FREE, i]
    _forces_at(model, rolling, t, w)
    _residual(share, S, x)
    count, converged = 0, False
    while not converged and count < MOST_STEPS:
        before = _unbalance(model.kinds, x) if bearings else 0.0
        _jacobian(share, S, w.squares)
        for i in range(r):
            x[CHANGE, i] = x[RESIDUAL, i]
        _solve(w.squares[1], x[CHANGE])
        count += 1
        length = 1.0 if bearings or count <= MOST_STEPS // 2 else 0.5
        converged = True
        for i in range(r):
            x[NEW, i] += length * x[CHANGE, i]
            bound = tolerance if model.kinds[PHASE_ROW, i] != 0.0 else tolerance * x[SCALE, i]
            if not abs(x[CHANGE, i]) <= bound:
                converged = False
        _forces_at(model, rolling, t, w)
        if converged and not bearings:
            break
        _residual(share, S, x)
        while bearings:
            after = _unbalance(model.kinds, x)
            if after <= before or length < 1e-3 or before < tolerance:
                break
            length *= 0.5
            converged = False
            for i in range(r):
                x[NEW, i] -= length * x[CHANGE, i]
            _forces_at(model, rolling, t, w)
            _residual(share, S, x)
    counts[0] += count
    counts[1] = max(counts[1], count)
    counts[2] += 0 if converged else 1
