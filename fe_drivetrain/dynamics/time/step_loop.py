"""The loop in time, compiled: steps of equal length, Newton's method on few values alone.

The matrix A of a step is made once, with each spring's mean stiffness, or where rows turn for each
step at its end. What laws and bearings add are forces along few rows R (elongations, phases,
motions of inner rings), and the unknowns of Newton's method are the r values z = R q only
(Sherman, Morrison and Woodbury):

    z = z_free - (1 - a_f) S d(z, z'),    S = R A^-1 R^T

where z_free is what the matrix gives and d are the forces beyond it. Motions that are held leave no
share in the inverse.
"""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import inner_loop, njit
from fe_drivetrain.dynamics.time.bearing_loops import Rolling, bearing_forces, new_dampers
from fe_drivetrain.dynamics.time.energy_account import (
    CLOCK,
    DISSIPATED,
    FOLLOWED,
    KINETIC,
    LOST,
    POWER,
    STORED,
    STRAIN,
    WORK,
    powers_of_bearings,
    powers_of_laws,
    powers_of_springs,
)
from fe_drivetrain.dynamics.time.law_loops import (
    BASE,
    D1,
    DAMPER,
    DAMPER1,
    FREE,
    NEW,
    ROW,
    SPRING,
    ZA,
    ZR,
    D,
    Z,
    law_forces,
    touching,
)
from fe_drivetrain.dynamics.time.loop_forms import (
    CV,
    DU,
    INSIDE,
    KU,
    MV,
    OUTSIDE,
    OUTSIDE0,
    RHS,
    STEP,
    TERM,
    TERM2,
    U0,
    A,
    Drive,
    Kept,
    Model,
    Span,
    Stop,
    U,
    V,
    Work,
)
from fe_drivetrain.dynamics.time.newton_steps import newton, scales
from fe_drivetrain.dynamics.time.sparse_steps import product, solve
from fe_drivetrain.dynamics.time.turning_rows import (
    DAMPING,
    DRIFT,
    INVERSE,
    MASS,
    STIFFNESS,
    Matrices,
    Turning,
    turn,
)

#: Degrees of freedom from which a library's product is faster than a loop.
MANY = 12


@inner_loop
def _by_library(
    matrices: Floats, k: int, x: Floats, i: int, y: Floats, j: int
) -> None:  # pragma: no cover - compiled
    np.dot(matrices[k], x[i], y[j])


@inner_loop
def _times(
    matrices: Floats, k: int, x: Floats, i: int, y: Floats, j: int
) -> None:  # pragma: no cover - compiled
    """``matrices[k] x[i]`` into ``y[j]``; vectors by number, since each view takes time."""
    if matrices.shape[2] > MANY:
        _by_library(matrices, k, x, i, y, j)
        return
    for row in range(matrices.shape[1]):
        total = 0.0
        for column in range(matrices.shape[2]):
            total += matrices[k, row, column] * x[i, column]
        y[j, row] = total


@inner_loop
def _square(
    m: Matrices, k: int, x: Floats, i: int, y: Floats, j: int
) -> None:  # pragma: no cover - compiled
    """Square matrix k by ``x[i]`` into ``y[j]``, by its entries or its factors where these are few.

    A solution overwrites `TERM2`.
    """
    known = len(m.sparse.starts)
    if k == INVERSE and known > INVERSE:
        solve(m.sparse, x, i, TERM2, j)
    elif k < INVERSE and known > 0:
        product(m.sparse, k, x, i, y, j)
    else:
        _times(m.squares, k, x, i, y, j)


@inner_loop
def _product(x: Floats, i: int, y: Floats, j: int) -> float:  # pragma: no cover - compiled
    """Sum of ``x[i] y[j]``."""
    total = 0.0
    for k in range(x.shape[1]):
        total += x[i, k] * y[j, k]
    return total


@inner_loop
def _copy(x: Floats, i: int, y: Floats, j: int) -> None:  # pragma: no cover - compiled
    """``x[i]`` into ``y[j]``."""
    for k in range(x.shape[1]):
        y[j, k] = x[i, k]


@inner_loop
def histories_at(
    times: Floats, histories: Floats, t: float, place: int, values: Floats
) -> int:  # pragma: no cover - compiled
    """Histories at t into values; the place in the table from which to look on."""
    last = len(times) - 1
    if t <= times[0]:
        place = 0
    while place < last and times[place + 1] < t:
        place += 1
    share = 0.0
    if t > times[0] and place < last:
        share = (t - times[place]) / (times[place + 1] - times[place])
    for j in range(histories.shape[1]):
        values[j] = histories[place, j]
        if share != 0.0:
            values[j] += share * (histories[place + 1, j] - histories[place, j])
    return place


@inner_loop
def _load(
    drive: Drive, t: float, place: int, w: Work, into: int
) -> int:  # pragma: no cover - compiled
    """Loads at t into a vector; the place in the table from which to look on."""
    place = histories_at(drive.times, drive.histories, t, place, w.load[0])
    _times(drive.patterns, 0, w.load, 0, w.vectors, into)
    return place


@inner_loop
def _free_step(
    model: Model, turning: Turning | None, t: float, w: Work
) -> None:  # pragma: no cover - compiled
    """The step that the matrix of its end gives, and what the rows are after it."""
    m, b, x, y = model.matrices, model.matrices.coefficients, w.vectors, w.rows
    am, af, n, r = b[6], b[7], x.shape[1], y.shape[1]
    if af != 0.0:
        _inside(model, w, INSIDE)
    if turning is not None and len(turning.orders) > 0:
        turn(turning, m, t)
        _square(m, STIFFNESS, x, U, x, KU)
        _times(m.squares, DRIFT, x, U, x, DU)
        if r > 0:
            _times(m.rows, 0, x, U, y, BASE)
            _times(m.rows, 0, x, V, y, ZR)
            _times(m.rows, 0, x, A, y, ZA)
    for i in range(n):
        force = x[OUTSIDE, i] + m.constant[i] - x[KU, i] - x[DU, i]
        x[RHS, i] = (1.0 - af) * force
        if af != 0.0:
            x[RHS, i] += af * (x[OUTSIDE0, i] - x[INSIDE, i])
        x[TERM, i] = (am - (1.0 - am) * b[3]) * x[A, i] - (1.0 - am) * b[2] * x[V, i]
    _square(m, MASS, x, TERM, x, TERM2)
    for i in range(n):
        x[RHS, i] -= x[TERM2, i]
        x[TERM, i] = (1.0 - af) * (b[4] * x[V, i] + b[5] * x[A, i])
    _square(m, DAMPING, x, TERM, x, TERM2)
    for i in range(n):
        x[RHS, i] -= x[TERM2, i]
    _square(m, INVERSE, x, RHS, x, STEP)
    if r > 0:
        _times(m.rows, 0, x, STEP, y, FREE)
        for i in range(r):
            y[FREE, i] += y[BASE, i]


@inner_loop
def _inside(model: Model, w: Work, into: int) -> None:  # pragma: no cover - compiled
    """Forces of springs, dampers, laws and bearings at the beginning of a step, into a vector."""
    m, x, y = model.matrices, w.vectors, w.rows
    for i in range(x.shape[1]):
        x[into, i] = x[KU, i] + x[CV, i] + x[DU, i] - m.constant[i]
    for j in range(y.shape[1]):
        if y[D, j] != 0.0:
            for i in range(x.shape[1]):
                x[into, i] += m.rows[0, j, i] * y[D, j]


@inner_loop
def _hold(held: Floats, x: Floats, i: int) -> None:  # pragma: no cover - compiled
    """Nothing of a vector along motions that are held."""
    for k in range(held.shape[1]):
        along = 0.0
        for j in range(x.shape[1]):
            along += held[0, k, j] * x[i, j]
        for j in range(x.shape[1]):
            x[i, j] -= along * held[0, k, j]


@inner_loop
def _powers(model: Model, turning: Turning, w: Work) -> None:  # pragma: no cover - compiled
    """Power that dampers take and the clock gives, where rows turn."""
    x, y, sums, many = w.vectors, w.rows, w.sums, w.resisted.shape[1]
    lost, clock = powers_of_springs(turning, x[U], x[V], w.along[0])
    more, turned = powers_of_laws(model.laws, y, w.laws)
    lost, clock = lost + more - sums[0, FOLLOWED], clock + turned
    if many > 0:
        loads = y[D, model.bearing : model.bearing + many]
        more, turned = powers_of_bearings(turning, x[U], x[V], loads, w.resisted[0])
        lost, clock = lost + more, clock + turned
    sums[0, LOST] = lost
    sums[0, POWER] += clock


@inner_loop
def _end_step(model: Model, w: Work) -> float:  # pragma: no cover - compiled
    """Motion at the end of a step; what constant dampers took."""
    m, b, x, y, sums = model.matrices, model.matrices.coefficients, w.vectors, w.rows, w.sums
    n = x.shape[1]
    for j in range(y.shape[1]):
        by = (1.0 - b[7]) * y[D1, j]
        if by != 0.0:
            for i in range(n):
                x[STEP, i] -= m.rows[1, j, i] * by
    _hold(m.held, x, STEP)
    taken = 0.0
    for i in range(n):
        step = x[STEP, i]
        new_a = b[0] * step - b[2] * x[V, i] - b[3] * x[A, i]
        x[V, i] = b[1] * step + b[4] * x[V, i] + b[5] * x[A, i]
        x[A, i] = new_a
        x[U, i] += step
        sums[0, WORK] += 0.5 * (x[OUTSIDE0, i] + x[OUTSIDE, i]) * step
        x[OUTSIDE0, i] = x[OUTSIDE, i]
        taken += 0.5 * x[CV, i] * step
    _hold(m.held, x, V)
    _hold(m.held, x, A)
    _square(m, DAMPING, x, V, x, CV)
    _square(m, MASS, x, V, x, MV)
    _square(m, STIFFNESS, x, U, x, KU)
    return taken + 0.5 * _product(x, CV, x, STEP)


@inner_loop
def _end_rows(model: Model, w: Work) -> float:  # pragma: no cover - compiled
    """Rows at the end of a step; what dampers of laws and bearings took."""
    x, y, of = w.vectors, w.rows, w.laws
    taken = 0.0
    for i in range(of.shape[1]):
        h = model.laws.numbers[ROW, i]
        taken += 0.5 * (of[DAMPER, i] + of[DAMPER1, i]) * (y[NEW, h] - y[BASE, h])
    for i in range(w.resisted.shape[1]):
        h = model.bearing + i
        taken += 0.5 * (w.resisted[0, i] + w.resisted[1, i]) * (y[NEW, h] - y[BASE, h])
    _copy(of, DAMPER1, of, DAMPER)
    _copy(w.resisted, 1, w.resisted, 0)
    _copy(y, D1, y, D)
    _copy(y, NEW, y, Z)
    _copy(y, NEW, y, BASE)
    _times(model.matrices.rows, 0, x, V, y, ZR)
    _times(model.matrices.rows, 0, x, A, y, ZA)
    return taken


@inner_loop
def _begin(
    model: Model, rolling: Rolling | None, turning: Turning | None, t: float, w: Work
) -> None:  # pragma: no cover - compiled
    """Forces and motions at the beginning of a run."""
    m, x, y, sums, tangent = model.matrices, w.vectors, w.rows, w.sums, w.squares[0]
    if turning is not None and len(turning.orders) > 0:
        turn(turning, m, t)
        _times(m.squares, DRIFT, x, U, x, DU)
    _square(m, MASS, x, V, x, MV)
    _square(m, DAMPING, x, V, x, CV)
    _square(m, STIFFNESS, x, U, x, KU)
    if y.shape[1] > 0:
        _times(m.rows, 0, x, U, y, Z)
        _times(m.rows, 0, x, V, y, ZR)
        _times(m.rows, 0, x, A, y, ZA)
        _copy(y, Z, y, BASE)
    touching(model.laws, t, y, w.laws)
    sums[0, STORED], sums[0, POWER], sums[0, FOLLOWED] = law_forces(
        model.laws, t, 0.0, int(np.int64(0)), y, w.laws, tangent
    )
    if rolling is not None:
        for _ in range(2):  # for the tangents of the dampers first
            new_dampers(rolling, w.bearings)
            bearing_forces(
                rolling, 0.0, int(np.int64(0)), y, tangent, w.bearings, w.resisted, w.scratch
            )
    if turning is not None and len(turning.orders) > 0:
        _powers(model, turning, w)


@inner_loop
def _record(
    model: Model, k: int, t: float, w: Work, kept: Kept
) -> None:  # pragma: no cover - compiled
    """Record k of the motion."""
    x, y, first = w.vectors, w.rows, model.bearing
    kept.times[k] = t
    _copy(x, U, kept.places, k)
    _copy(x, V, kept.rates, k)
    _copy(w.laws, SPRING, kept.forces, k)
    _copy(w.along, 0, kept.along, k)
    for i in range(kept.bearings.shape[2]):
        kept.bearings[0, k, i] = y[Z, first + i]
        kept.bearings[1, k, i] = y[D, first + i]
    for i in range(5):
        kept.energies[k, i] = w.sums[0, i]
    strain = 0.5 * _product(x, U, x, KU)
    for i in range(x.shape[1]):
        strain -= model.matrices.constant[i] * x[U, i]
    kept.energies[k, KINETIC] = 0.5 * _product(x, V, x, MV)
    kept.energies[k, STRAIN] = strain + w.sums[0, STORED]
    if model.matrices.held.shape[1] > 0:
        _inside(model, w, TERM)
        for i in range(x.shape[1]):
            x[TERM, i] = x[OUTSIDE0, i] - x[TERM, i]
        _times(model.matrices.held, 1, x, TERM, kept.gripped, k)


@inner_loop
def _turned(model: Model, turning: Turning, w: Work) -> None:  # pragma: no cover - compiled
    """Losses of a step whose rows turn."""
    _times(model.matrices.squares, DRIFT, w.vectors, U, w.vectors, DU)
    _powers(model, turning, w)
    w.sums[0, DISSIPATED] += 0.5 * model.matrices.dt * (w.sums[1, LOST] + w.sums[0, LOST])


@inner_loop
def _stops(stop: Stop, x: Floats) -> bool:  # pragma: no cover - compiled
    """Whether an event has come."""
    for i in range(len(stop.signs)):
        speed = 0.0
        for j in range(x.shape[1]):
            speed += stop.rows[i, j] * x[V, j]
        if stop.signs[i] != 0.0 and stop.signs[i] * speed <= 0.0:
            return True
    return False


@njit(cache=True, error_model="numpy")
def march(
    span: Span,
    model: Model,
    rolling: Rolling | None,
    turning: Turning | None,
    drive: Drive,
    stop: Stop,
    w: Work,
    kept: Kept,
    counts: Ints,
) -> int:  # pragma: no cover - compiled
    """March in equal steps.

    Parameters
    ----------
    span, model, rolling, turning, drive, stop : NamedTuple
        Steps, what moves and acts, loads and events; None of bearings and rows that turn where
        there are neither. Where there are bearings alone, the rows that turn are `NOTHING_TURNS`.
    w, kept : Work, Kept
        Memory, zero but for displacements, velocities and accelerations, which become those of the
        end, with those before the last step behind them; and records, overwritten.
    counts : Ints
        Numbers (3,) of Newton steps, in all and at most in a step, and of steps not converged.

    Returns
    -------
    done : int
        Number of steps that were made, up to an event.
    """
    dt, rows, none = model.matrices.dt, w.rows.shape[1] > 0, int(np.int64(0))
    half = 0.5 * dt
    place = _load(drive, span.begin, none, w, OUTSIDE0)  # a literal would be a type of its own
    _begin(model, rolling, turning, span.begin, w)
    record = none
    for s in range(span.steps + 1):
        t = span.begin + s * dt
        if s > 0:
            for k in range(3):
                _copy(w.vectors, U + k, w.vectors, U0 + k)
            place = _load(drive, t, place, w, OUTSIDE)
            touching(model.laws, t - dt, w.rows, w.laws)
            if rolling is not None:
                new_dampers(rolling, w.bearings)
            _free_step(model, turning, t, w)
            _copy(w.sums, 0, w.sums, 1)
            for i in range(STORED, LOST + 1):
                w.sums[0, i] = 0.0
            if rows:
                scales(model.kinds, w.rows)
                newton(model, rolling, t, span.tolerance, w, counts)
            taken = _end_step(model, w)
            if rows:
                taken += _end_rows(model, w)
            if turning is not None and len(turning.orders) > 0:
                _turned(model, turning, w)
            else:
                w.sums[0, DISSIPATED] += taken - half * (w.sums[1, FOLLOWED] + w.sums[0, FOLLOWED])
            w.sums[0, CLOCK] += half * (w.sums[1, POWER] + w.sums[0, POWER])
        if s % span.every == 0:
            _record(model, record, t, w, kept)
            record += 1
        if s > 0 and _stops(stop, w.vectors):
            return s
    return span.steps
