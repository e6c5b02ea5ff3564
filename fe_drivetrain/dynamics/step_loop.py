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
from numba import njit

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.dynamics.bearing_loops import Rolling, bearing_forces, new_dampers
from fe_drivetrain.dynamics.energy_account import (
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
    product,
)
from fe_drivetrain.dynamics.law_loops import ROW, law_forces, touching
from fe_drivetrain.dynamics.loop_forms import (
    BASE,
    CV,
    D1,
    DAMPER,
    DAMPER1,
    DAMPS,
    DU,
    FREE,
    INSIDE,
    KU,
    MV,
    NEW,
    OUTSIDE,
    OUTSIDE0,
    RHS,
    SPRING,
    STEP,
    TERM,
    TERM2,
    ZA,
    ZR,
    D,
    Drive,
    Kept,
    Model,
    Span,
    Stop,
    Work,
    Z,
)
from fe_drivetrain.dynamics.newton_steps import newton, scales
from fe_drivetrain.dynamics.turning_rows import (
    DAMPING,
    DRIFT,
    INVERSE,
    MASS,
    STIFFNESS,
    Turning,
    turn,
)


@njit(cache=True, error_model="numpy")
def _times(A: Floats, x: Floats, y: Floats) -> None:  # pragma: no cover - compiled
    """A x into y; one call, for a loop that is short to compile."""
    np.dot(A, x, y)


@njit(cache=True, error_model="numpy")
def _copy(x: Floats, y: Floats) -> None:  # pragma: no cover - compiled
    """Values x into y."""
    for i in range(len(x)):
        y[i] = x[i]


@njit(cache=True, error_model="numpy")
def _load(drive: Drive, t: float, place: int, value: Floats) -> int:  # pragma: no cover
    """Histories at t into `value`; the place in the table from which to look on."""
    times = drive.times
    last = len(times) - 1
    if t <= times[0]:
        for j in range(len(value)):
            value[j] = drive.histories[0, j]
        return 0
    while place < last and times[place + 1] < t:
        place += 1
    if place >= last:
        for j in range(len(value)):
            value[j] = drive.histories[last, j]
        return last
    share = (t - times[place]) / (times[place + 1] - times[place])
    for j in range(len(value)):
        one = drive.histories[place, j]
        value[j] = one + share * (drive.histories[place + 1, j] - one)
    return place


@njit(cache=True, error_model="numpy")
def _free_step(
    model: Model, turning: Turning | None, t: float, state: Floats, w: Work
) -> None:  # pragma: no cover - compiled
    """The step that the matrix of its end gives, and what the rows are after it."""
    m, b, x, y = model.matrices, model.matrices.coefficients, w.vectors, w.rows
    am, af, n, r = b[6], b[7], x.shape[1], y.shape[1]
    u, v, a = state[0], state[1], state[2]
    if af != 0.0:
        _inside(model, w, x[INSIDE])
    if turning is not None:
        turn(turning, m, t)
        _times(m.squares[STIFFNESS], u, x[KU])
        _times(m.squares[DRIFT], u, x[DU])
        if r > 0:
            _times(m.rows[0], u, y[BASE])
            _times(m.rows[0], v, y[ZR])
            _times(m.rows[0], a, y[ZA])
    for i in range(n):
        force = x[OUTSIDE, i] + m.constant[i] - x[KU, i] - x[DU, i]
        x[RHS, i] = (1.0 - af) * force
        if af != 0.0:
            x[RHS, i] += af * (x[OUTSIDE0, i] - x[INSIDE, i])
        x[TERM, i] = (am - (1.0 - am) * b[3]) * a[i] - (1.0 - am) * b[2] * v[i]
    _times(m.squares[MASS], x[TERM], x[TERM2])
    for i in range(n):
        x[RHS, i] -= x[TERM2, i]
        x[TERM, i] = (1.0 - af) * (b[4] * v[i] + b[5] * a[i])
    _times(m.squares[DAMPING], x[TERM], x[TERM2])
    for i in range(n):
        x[RHS, i] -= x[TERM2, i]
    _times(m.squares[INVERSE], x[RHS], x[STEP])
    if r > 0:
        _times(m.rows[0], x[STEP], y[FREE])
        for i in range(r):
            y[FREE, i] += y[BASE, i]


@njit(cache=True, error_model="numpy")
def _inside(model: Model, w: Work, force: Floats) -> None:  # pragma: no cover - compiled
    """Forces of springs, dampers, laws and bearings at the beginning of a step, into `force`."""
    m, x, y = model.matrices, w.vectors, w.rows
    for i in range(len(force)):
        force[i] = x[KU, i] + x[CV, i] + x[DU, i] - m.constant[i]
    for j in range(y.shape[1]):
        for i in range(len(force)):
            force[i] += m.rows[0, j, i] * y[D, j]


@njit(cache=True, error_model="numpy")
def _hold(held: Floats, x: Floats) -> None:  # pragma: no cover - compiled
    """Nothing of x along motions that are held."""
    for k in range(len(held)):
        along = product(held[k], x)
        for i in range(len(x)):
            x[i] -= along * held[k, i]


@njit(cache=True, error_model="numpy")
def _powers(
    model: Model, turning: Turning, rolling: Rolling, state: Floats, w: Work
) -> None:  # pragma: no cover - compiled
    """Power that dampers take and the clock gives, where rows turn."""
    x, of, sums = w.rows, w.laws, w.sums[0]
    lost, clock = powers_of_springs(turning, state[0], state[1], w.along)
    more, turned = powers_of_laws(model.laws, x[Z], x[ZR], of[SPRING], of[DAMPER])
    lost, clock = lost + more - sums[FOLLOWED], clock + turned
    many = len(w.resisted[0])
    if many > 0:
        loads = x[D, rolling.row : rolling.row + many]
        more, turned = powers_of_bearings(turning, state[0], state[1], loads, w.resisted[0])
        lost, clock = lost + more, clock + turned
    sums[LOST] = lost
    sums[POWER] += clock


@njit(cache=True, error_model="numpy")
def _end_step(model: Model, state: Floats, w: Work) -> float:  # pragma: no cover - compiled
    """Motion at the end of a step; what constant dampers took."""
    m, b, x, y, sums = model.matrices, model.matrices.coefficients, w.vectors, w.rows, w.sums[0]
    u, v, a = state[0], state[1], state[2]
    for j in range(y.shape[1]):
        for i in range(len(u)):
            x[STEP, i] -= (1.0 - b[7]) * m.rows[1, j, i] * y[D1, j]
    _hold(m.held[0], x[STEP])
    taken = 0.0
    for i in range(len(u)):
        new_a = b[0] * x[STEP, i] - b[2] * v[i] - b[3] * a[i]
        v[i] = b[1] * x[STEP, i] + b[4] * v[i] + b[5] * a[i]
        a[i] = new_a
        u[i] += x[STEP, i]
        sums[WORK] += 0.5 * (x[OUTSIDE0, i] + x[OUTSIDE, i]) * x[STEP, i]
        x[OUTSIDE0, i] = x[OUTSIDE, i]
        taken += 0.5 * x[CV, i] * x[STEP, i]
    _hold(m.held[0], v)
    _hold(m.held[0], a)
    _times(m.squares[DAMPING], v, x[CV])
    _times(m.squares[MASS], v, x[MV])
    _times(m.squares[STIFFNESS], u, x[KU])
    return taken + 0.5 * product(x[CV], x[STEP])


@njit(cache=True, error_model="numpy")
def _end_rows(model: Model, rolling: Rolling, state: Floats, w: Work) -> float:  # pragma: no cover
    """Rows at the end of a step; what dampers of laws and bearings took."""
    x, of, many = w.rows, w.laws, len(w.resisted[0])
    taken = 0.0
    for i in range(of.shape[1]):
        h = model.laws.numbers[ROW, i]
        taken += 0.5 * (of[DAMPER, i] + of[DAMPER1, i]) * (x[NEW, h] - x[BASE, h])
    for i in range(many):
        h = rolling.row + i
        taken += 0.5 * (w.resisted[0, i] + w.resisted[1, i]) * (x[NEW, h] - x[BASE, h])
    _copy(of[DAMPER1], of[DAMPER])
    _copy(w.resisted[1], w.resisted[0])
    _copy(x[D1], x[D])
    _copy(x[NEW], x[Z])
    if x.shape[1] > 0:
        _times(model.matrices.rows[0], state[1], x[ZR])
        _times(model.matrices.rows[0], state[2], x[ZA])
    return taken


@njit(cache=True, error_model="numpy")
def _begin(
    model: Model,
    rolling: Rolling,
    turning: Turning | None,
    drive: Drive,
    t: float,
    state: Floats,
    w: Work,
) -> None:  # pragma: no cover - compiled
    """Forces and motions at the beginning of a run."""
    m, x, y, of, sums = model.matrices, w.vectors, w.rows, w.laws, w.sums[0]
    u, v = state[0], state[1]
    if turning is not None:
        turn(turning, m, t)
        _times(m.squares[DRIFT], u, x[DU])
    _times(drive.patterns, w.load, x[OUTSIDE0])
    _times(m.squares[MASS], v, x[MV])
    _times(m.squares[DAMPING], v, x[CV])
    _times(m.squares[STIFFNESS], u, x[KU])
    if y.shape[1] > 0:
        _times(m.rows[0], u, y[Z])
        _times(m.rows[0], v, y[ZR])
        _times(m.rows[0], state[2], y[ZA])
        _copy(y[Z], y[BASE])
    touching(model.laws, t, y[Z], of[DAMPS])
    sums[STORED], sums[POWER], sums[FOLLOWED] = law_forces(
        model.laws, t, y[Z], y[ZR], of[DAMPS], 0.0, y[D], w.squares[0], of[SPRING], of[DAMPER]
    )
    for _ in range(2 if len(rolling.seconds) > 0 else 0):  # for the tangents of the dampers first
        new_dampers(rolling, w.bearings)
        bearing_forces(
            rolling, y[Z], y[ZR], 0.0, y[D], w.squares[0], w.bearings, w.resisted[0], w.scratch
        )
    if turning is not None:
        _powers(model, turning, rolling, state, w)


@njit(cache=True, error_model="numpy")
def _record(
    model: Model, first: int, k: int, t: float, state: Floats, w: Work, kept: Kept
) -> None:  # pragma: no cover - compiled
    """Record k of the motion; `first`: row of the first bearing."""
    u, v, x, y, energies = state[0], state[1], w.vectors, w.rows, kept.energies[k]
    kept.times[k] = t
    _times(kept.watch, u, kept.places[k])
    _times(kept.watch, v, kept.rates[k])
    _copy(w.laws[SPRING], kept.forces[k])
    _copy(w.along, kept.along[k])
    for i in range(kept.bearings.shape[2]):
        kept.bearings[0, k, i] = y[Z, first + i]
        kept.bearings[1, k, i] = y[D, first + i]
    _copy(w.sums[0, :5], energies)
    energies[KINETIC] = 0.5 * product(v, x[MV])
    strain = 0.5 * product(u, x[KU]) - product(model.matrices.constant, u)
    energies[STRAIN] = strain + w.sums[0, STORED]
    if model.matrices.held.shape[1] > 0:
        _inside(model, w, x[TERM])
        for i in range(len(u)):
            x[TERM, i] = x[OUTSIDE0, i] - x[TERM, i]
        _times(model.matrices.held[1], x[TERM], kept.gripped[k])


@njit(cache=True, error_model="numpy")
def _account(
    model: Model,
    rolling: Rolling,
    turning: Turning | None,
    taken: float,
    state: Floats,
    w: Work,
) -> None:  # pragma: no cover - compiled
    """Losses and the clock's part of a step."""
    sums, before, half = w.sums[0], w.sums[1], 0.5 * model.matrices.dt
    if turning is not None:
        _times(model.matrices.squares[DRIFT], state[0], w.vectors[DU])
        _powers(model, turning, rolling, state, w)
        sums[DISSIPATED] += half * (before[LOST] + sums[LOST])
    else:
        _copy(w.rows[NEW], w.rows[BASE])
        sums[DISSIPATED] += taken - half * (before[FOLLOWED] + sums[FOLLOWED])
    sums[CLOCK] += half * (before[POWER] + sums[POWER])


@njit(cache=True, error_model="numpy")
def march(
    span: Span,
    model: Model,
    rolling: Rolling,
    turning: Turning | None,
    drive: Drive,
    stop: Stop,
    state: Floats,
    w: Work,
    kept: Kept,
    counts: Ints,
) -> int:  # pragma: no cover - compiled
    """March in equal steps.

    Parameters
    ----------
    span, model, rolling, turning, drive, stop : NamedTuple
        Steps, what moves and acts, loads and events, in the form of the compiled loop; no turning
        where all rows stand.
    state : Floats
        Displacements, velocities and accelerations (6, n), overwritten by those of the end; behind
        them the same before the last step, where the steps may stop at an event.
    w, kept : Work, Kept
        Memory, all zero, and records, overwritten.
    counts : Ints
        Numbers (3,) of Newton steps: in all, and the maximum in a step; and of steps that have not
        converged.

    Returns
    -------
    done : int
        Number of steps that were made.
    """
    dt, rows, none = model.matrices.dt, w.rows.shape[1] > 0, int(np.int64(0))
    place = _load(drive, span.begin, none, w.load)  # a literal would be a type of its own
    _begin(model, rolling, turning, drive, span.begin, state, w)
    record = none
    for s in range(span.steps + 1):
        t = span.begin + s * dt
        if s > 0:
            for k in range(3):
                _copy(state[k], state[3 + k])
            place = _load(drive, t, place, w.load)
            _times(drive.patterns, w.load, w.vectors[OUTSIDE])
            touching(model.laws, t - dt, w.rows[Z], w.laws[DAMPS])
            new_dampers(rolling, w.bearings)
            _free_step(model, turning, t, state, w)
            _copy(w.sums[0], w.sums[1])
            for i in range(STORED, LOST + 1):
                w.sums[0, i] = 0.0
            if rows:
                scales(model.kinds, w.rows)
                newton(model, rolling, t, span.tolerance, w, counts)
            taken = _end_step(model, state, w)
            taken += _end_rows(model, rolling, state, w)
            _account(model, rolling, turning, taken, state, w)
        if s % span.every == 0:
            _record(model, rolling.row, record, t, state, w, kept)
            record += 1
        for i in range(len(stop.signs) if s > 0 else 0):
            if stop.signs[i] != 0.0 and stop.signs[i] * product(stop.rows[i], state[1]) <= 0.0:
                return s
    return span.steps
