"""Newton's method of one step in time, compiled: the values of few rows are the unknowns.

z = z_free - (1 - a_f) S d(z, z'),    S = R A^-1 R^T
"""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import inner_loop
from fe_drivetrain.dynamics.time.bearing_loops import Rolling, bearing_forces
from fe_drivetrain.dynamics.time.energy_account import FOLLOWED, POWER, STORED
from fe_drivetrain.dynamics.time.law_loops import (
    BASE,
    CHANGE,
    D1,
    FREE,
    NEW,
    PIVOT,
    RATE,
    RESIDUAL,
    SCALE,
    ZA,
    ZR,
    law_forces,
)
from fe_drivetrain.dynamics.time.loop_forms import MOVED_ROW, PHASE_ROW, TILTED_ROW, Model, Work

#: Newton steps after which a time step counts as not converged; half of them at full length.
MAX_STEPS = 40

#: Residual over that before, up to which the tangent before is kept; on rollers alone.
ENOUGH = 0.03


@inner_loop
def factorise(A: Floats, y: Floats) -> None:  # pragma: no cover - compiled
    """Factors in place of A, by Gauss with row pivots, which go to y[PIVOT]; without a library."""
    n = y.shape[1]
    for k in range(n):
        p = k
        for i in range(k + 1, n):
            if abs(A[i, k]) > abs(A[p, k]):
                p = i
        y[PIVOT, k] = p
        if p != k:
            for j in range(n):
                A[k, j], A[p, j] = A[p, j], A[k, j]
        for i in range(k + 1, n):
            f = A[i, k] / A[k, k]
            A[i, k] = f
            if f != 0.0:
                for j in range(k + 1, n):
                    A[i, j] -= f * A[k, j]


@inner_loop
def solve(A: Floats, y: Floats) -> None:  # pragma: no cover - compiled
    """A^-1 y[CHANGE] into it, by the factors."""
    n = y.shape[1]
    for k in range(n):
        p = int(y[PIVOT, k])
        if p != k:
            y[CHANGE, k], y[CHANGE, p] = y[CHANGE, p], y[CHANGE, k]
    for k in range(n):
        for j in range(k):
            y[CHANGE, k] -= A[k, j] * y[CHANGE, j]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            y[CHANGE, k] -= A[k, j] * y[CHANGE, j]
        y[CHANGE, k] /= A[k, k]


@inner_loop
def _forces_at(
    model: Model, rolling: Rolling | None, t: float, w: Work, tangent: Floats
) -> None:  # pragma: no cover - compiled
    """Forces beyond the matrices at values of the rows at the end of a step, and their tangent."""
    b, y = model.matrices.coefficients, w.rows
    for i in range(y.shape[1]):
        y[RATE, i] = b[1] * (y[NEW, i] - y[BASE, i]) + b[4] * y[ZR, i] + b[5] * y[ZA, i]
    w.sums[0, STORED], w.sums[0, POWER], w.sums[0, FOLLOWED] = law_forces(
        model.laws, t, b[1], 1, y, w.laws, tangent
    )
    if rolling is not None:
        bearing_forces(rolling, b[1], 1, y, tangent, w.bearings, w.resisted, w.scratch)


@inner_loop
def _residual(share: float, S: Floats, y: Floats) -> None:  # pragma: no cover - compiled
    for i in range(len(S)):
        y[RESIDUAL, i] = y[FREE, i] - y[NEW, i]
        for j in range(len(S)):
            y[RESIDUAL, i] -= share * S[i, j] * y[D1, j]


@inner_loop
def _jacobian(
    share: float, S: Floats, tangent: Floats, A: Floats
) -> None:  # pragma: no cover - compiled
    """I + share S tangent, into A."""
    r = len(S)
    for i in range(r):
        for j in range(r):
            A[i, j] = 1.0 if i == j else 0.0
    for j in range(r):
        for k in range(r):
            by = tangent[j, k]
            if by != 0.0:
                for i in range(r):
                    A[i, k] += share * S[i, j] * by


@inner_loop
def _unbalance(kinds: Floats, y: Floats) -> float:  # pragma: no cover - compiled
    """Maximum residual over what its value has been."""
    most = 0.0
    for i in range(y.shape[1]):
        size = 1.0 if kinds[PHASE_ROW, i] != 0.0 or y[SCALE, i] == 0.0 else y[SCALE, i]
        if not np.isfinite(y[RESIDUAL, i]):  # the larger of a number and none is the number
            return np.inf
        most = max(most, abs(y[RESIDUAL, i]) / size)
    return most


@inner_loop
def scales(kinds: Floats, y: Floats) -> None:  # pragma: no cover - compiled
    """Maximum of each value so far; of bearings that of all motions, and of all tilts."""
    moved = tilted = 0.0
    for i in range(y.shape[1]):
        y[SCALE, i] = max(y[SCALE, i], abs(y[FREE, i]), abs(y[BASE, i]))
        moved = max(moved, kinds[MOVED_ROW, i] * y[SCALE, i])
        tilted = max(tilted, kinds[TILTED_ROW, i] * y[SCALE, i])
    for i in range(y.shape[1]):
        if kinds[MOVED_ROW, i] != 0.0:
            y[SCALE, i] = moved
        if kinds[TILTED_ROW, i] != 0.0:
            y[SCALE, i] = max(tilted, moved)  # a metre away


@inner_loop
def newton(
    model: Model, rolling: Rolling | None, t: float, tolerance: float, w: Work, counts: Ints
) -> None:  # pragma: no cover - compiled
    """Values of the rows at the end of a step, and the forces there.

    With bearings, whose rollers leave and come back, changes are as short as the residual falls,
    and begin where motions would go on to: what the matrix gives is far from where rollers hold.
    Their tangent is kept while the residual falls fast.
    """
    y, S, bearings = w.rows, model.matrices.compliance, w.resisted.shape[1] > 0
    dt = model.matrices.dt
    share, r = 1.0 - model.matrices.coefficients[7], len(S)
    tangent, A = w.squares[0], w.squares[1]
    for i in range(r):
        y[NEW, i] = y[FREE, i]
        if bearings:
            y[NEW, i] = y[BASE, i] + dt * (y[ZR, i] + 0.5 * dt * y[ZA, i])
    _forces_at(model, rolling, t, w, tangent)
    _residual(share, S, y)
    count, converged, fresh = 0, False, True
    while not converged and count < MAX_STEPS:
        before = _unbalance(model.kinds, y) if bearings else 0.0
        if fresh:
            _jacobian(share, S, tangent, A)
            factorise(A, y)
        for i in range(r):
            y[CHANGE, i] = y[RESIDUAL, i]
        solve(A, y)
        count += 1
        length = 1.0 if bearings or count <= MAX_STEPS // 2 else 0.5
        converged = True
        for i in range(r):
            y[NEW, i] += length * y[CHANGE, i]
            bound = tolerance if model.kinds[PHASE_ROW, i] != 0.0 else tolerance * y[SCALE, i]
            if not abs(y[CHANGE, i]) <= bound:
                converged = False
        _forces_at(model, rolling, t, w, tangent)
        if converged and not bearings:
            break
        _residual(share, S, y)
        while bearings:
            after = _unbalance(model.kinds, y)
            if after <= before or length < 1e-3 or before < tolerance:
                # as good as a new tangent, for a fraction of its time
                fresh = after > ENOUGH * before
                # the next change is no longer than the residual: springs and rollers only resist
                converged = converged or after <= tolerance
                break
            length *= 0.5
            converged, fresh = False, True
            for i in range(r):
                y[NEW, i] -= length * y[CHANGE, i]
            _forces_at(model, rolling, t, w, tangent)
            _residual(share, S, y)
    counts[0] += count
    counts[1] = max(counts[1], count)
    counts[2] += 0 if converged else 1
