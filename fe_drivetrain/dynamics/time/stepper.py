"""Steps of one length: matrices and what acts in the form of the compiled loop, and its records."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.equations import Loads
from fe_drivetrain.dynamics.time.bearing_loops import Rolling, rolling_of
from fe_drivetrain.dynamics.time.energy_account import STRAIN
from fe_drivetrain.dynamics.time.law_loops import Laws
from fe_drivetrain.dynamics.time.loop_forms import (
    A0,
    MOVED_ROW,
    PHASE_ROW,
    TILTED_ROW,
    U0,
    A,
    Drive,
    Kept,
    Model,
    Span,
    Stop,
    U,
    V,
    memory,
)
from fe_drivetrain.dynamics.time.mechanism import Mechanism
from fe_drivetrain.dynamics.time.motion import NO_BEARINGS, STANDING, BearingHistory, Motion, State
from fe_drivetrain.dynamics.time.schemes import Scheme
from fe_drivetrain.dynamics.time.sparse_steps import NO_SPARSE, sparse_of
from fe_drivetrain.dynamics.time.spring_forces import SpringForces, spring_forces
from fe_drivetrain.dynamics.time.step_loop import march
from fe_drivetrain.dynamics.time.turning_rows import NOTHING_TURNS, Matrices, Turning, constrain

TOLERANCE = 1e-10
"""Tolerance of Newton's method: change of an elongation over its maximum so far."""


@dataclass(frozen=True)
class Stepper:
    """What moves and acts prepared for a scheme and a length of step; see `prepared`.

    Attributes
    ----------
    mechanism : Mechanism
        What moves and acts.
    model : Model
        Matrices of the step with the inverse, and laws.
    rolling : Rolling
        Rolling bearings.
    turning : Turning or None
        Rows that turn, where there are some.
    springs : SpringForces
        Forces of linear springs whose rows stand, by what was recorded.
    """

    __repr__ = short_repr

    mechanism: Mechanism
    model: Model
    rolling: Rolling
    turning: Turning | None
    springs: SpringForces


@dataclass(frozen=True)
class Piece:
    """Some steps of one length.

    Attributes
    ----------
    motion : Motion
        Motion up to the last record.
    before : State
        State before the last step.
    stopped : bool
        Whether an event came in it.
    gripped : Floats
        Accelerations (k, h) along held motions that all forces would give, were they free.
    """

    __repr__ = short_repr

    motion: Motion
    before: State
    stopped: bool
    gripped: Floats


@dataclass(frozen=True)
class _Places:
    """Places of unknowns: laws (q,), phases of those that turn, drifts, bearings and theirs."""

    laws: Ints
    phases: Ints
    turning: Ints
    bearings: int
    drift: int
    bearing_drift: int
    count: int


def _places(mechanism: Mechanism) -> _Places:
    s = mechanism.equations.springs
    which = np.flatnonzero(s.special)
    varies = (s.wave >= 0) | (s.error >= 0)
    turning = np.array([i for i in which if varies[i] and s.turns[i].any()], dtype=np.int64)
    phases = np.full(len(s.rows), -1)
    q, p, b = len(which), len(turning), 5 * len(mechanism.bearings.seats)
    phases[turning] = q + np.arange(p)
    first = q + p + b
    travels = mechanism.carriers is not None
    damped = travels and bool(mechanism.bearings.seconds.any())
    return _Places(
        which,
        phases[which],
        turning,
        q + p,
        first if travels else -1,
        first + q if damped else -1,
        first + (q if travels else 0) + (b if damped else 0),
    )


def prepared(
    mechanism: Mechanism, dt: float, scheme: Scheme, held: Floats | None = None
) -> Stepper:
    """The matrix of a step inverted, and what acts in the form of the compiled loop.

    Parameters
    ----------
    mechanism : Mechanism
        What moves and acts.
    dt : float
        Length of a step [s].
    scheme : Scheme
        Time integration scheme.
    held : Floats, optional
        Rows (h, n) of motions that are held.

    Returns
    -------
    stepper : Stepper

    Raises
    ------
    InputError
        The step is not positive, or the matrix is singular.
    """
    if not (np.isfinite(dt) and dt > 0.0):
        raise InputError(f"time step is {dt:g} s but must be above 0 s: change it")
    places, bearings = _places(mechanism), mechanism.bearings
    matrices = _matrices(mechanism, places, float(dt), scheme, held)
    if held is not None and len(held):
        constrain(matrices)
    kinds = np.zeros((3, places.count))
    kinds[PHASE_ROW, len(places.laws) : places.bearings] = 1.0
    first = places.bearings + 5 * np.arange(len(bearings.seats))[:, None]
    kinds[MOVED_ROW, first + np.arange(3)] = 1.0
    kinds[TILTED_ROW, first + np.arange(3, 5)] = 1.0
    rolling = rolling_of(
        tuple(seat.bearing for seat in bearings.seats),
        tuple(bearings.seconds.tolist()),
        places.bearings,
        places.bearing_drift,
    )
    model = Model(matrices, _laws(mechanism, places), kinds, places.bearings)
    turning = _turning(mechanism, places)
    return Stepper(mechanism, model, rolling, turning, spring_forces(mechanism.equations.springs))


def _matrices(
    mechanism: Mechanism, places: _Places, dt: float, scheme: Scheme, held: Floats | None
) -> Matrices:
    """Matrices of springs that stand; where rows turn, the loop makes them again."""
    e = mechanism.equations
    s, n, constant = e.springs, len(e.mass), ~e.springs.special
    rows = np.zeros((places.count, n))
    rows[: len(places.laws)] = s.rows[places.laws]
    rows[len(places.laws) : places.bearings] = s.turns[places.turning]
    on_rollers = mechanism.bearings.rows.reshape(-1, n)
    rows[places.bearings : places.bearings + len(on_rollers)] = on_rollers
    K, C = e.K, e.C
    factors = scheme.coefficients(dt)
    A = (1.0 - scheme.alpha_m) * factors[0] * e.mass + (1.0 - scheme.alpha_f) * (factors[1] * C + K)
    inverse = np.linalg.inv(A)
    columns = inverse @ rows.T
    still = np.zeros((2, 0, n))
    if held is not None and len(held):
        still = np.array([np.linalg.qr(held.T)[0].T, np.linalg.solve(e.mass, held.T).T])
    return Matrices(
        dt,
        factors,
        np.array([e.mass, C, K, inverse, np.zeros((n, n))]),
        np.asarray(s.rows[constant].T @ (s.stiffness * s.offset)[constant], dtype=np.float64),
        np.array([rows, columns.T]),
        np.ascontiguousarray(rows @ columns),
        still,
        NO_SPARSE
        if mechanism.carriers is not None
        else sparse_of([e.mass, C, K], None if still.size else A),
    )


def _laws(mechanism: Mechanism, places: _Places) -> Laws:
    s, which = mechanism.equations.springs, places.laws
    q = len(which)
    drift = places.drift + np.arange(q) if places.drift >= 0 else np.full(q, -1)
    numbers = np.array([np.arange(q), places.phases, drift, s.wave[which], s.error[which]])
    values = np.array(
        [
            one[which]
            for one in (
                s.stiffness, s.damping, s.lower, s.upper, s.exponent, s.offset,
                s.phase, s.frequency, s.power, s.speed, s.error_phase, s.error_turns,
            )
        ]
    )  # fmt: skip
    return Laws(
        np.ascontiguousarray(numbers, dtype=np.int64), values, s.waves, s.errors, mechanism.driven
    )


def _turning(mechanism: Mechanism, places: _Places) -> Turning | None:
    """Rows that turn: all springs, then all bearings."""
    if mechanism.carriers is None:
        return None
    e, n = mechanism.equations, len(mechanism.equations.mass)
    s, q, m = e.springs, len(places.laws), len(e.springs.rows)
    found, W = mechanism.carriers.carriers, mechanism.carriers.speed
    seats, own, of_seats = 5 * len(mechanism.bearings.seats), len(found.rows), 5 * len(found.seats)
    mean = np.zeros((2, m + seats, n))  # and a sine of order 0
    mean[0, :m], mean[0, m:] = s.rows, mechanism.bearings.rows.reshape(-1, n)
    mean[0, :own], mean[0, m : m + of_seats] = found.rows, found.bearings.reshape(-1, n)
    extra = np.zeros((2, n, n))
    extra[0] = found.extra + mechanism.beside
    orders, waves = [np.zeros(2)], [mean]
    orders2, waves2 = [np.zeros(2)], [extra]
    for one in found.turning:
        change = np.zeros((len(one.rows), m + seats, n))
        change[:, :own] = one.rows
        change[:, m : m + of_seats] = one.bearings.reshape(len(one.rows), -1, n)
        orders.append(_orders(W * one.ratio, len(one.rows)))
        orders2.append(_orders(W * one.ratio, len(one.extra)))
        waves.append(change)
        waves2.append(one.extra)
    of_bearings = np.array([places.bearings + np.arange(seats), m + np.arange(seats)])
    drifts = np.array([places.drift + np.arange(q), places.laws])
    if places.bearing_drift >= 0:
        of_drifts = np.array([places.bearing_drift + np.arange(seats), m + np.arange(seats)])
        drifts = np.hstack([drifts, of_drifts])
    return Turning(
        np.concatenate(orders),
        np.concatenate(waves).reshape(-1, (m + seats) * n),
        np.concatenate(orders2),
        np.concatenate(waves2).reshape(-1, n * n),
        np.array([s.stiffness, s.damping, s.offset, ~s.special], dtype=np.float64),
        e.damping,
        np.hstack([np.array([np.arange(q), places.laws]), of_bearings]),
        drifts,
        np.zeros((2, m + seats, n)),
        np.zeros((n, n)),
    )


def _orders(speed: float, count: int) -> Floats:
    """Orders of cosine and sine of each degree [rad/s]."""
    return np.repeat(speed * np.arange(1, count // 2 + 1), 2)


def run_steps(
    stepper: Stepper,
    loads: Loads,
    begin: State,
    steps: int,
    every: int,
    watch: ArrayLike | None,
    stop: Stop,
    tolerance: float = TOLERANCE,
) -> Piece:
    """Some steps, which may end at an event.

    Parameters
    ----------
    stepper : Stepper
        What moves and acts, scheme and step, from `prepared`.
    loads : Loads
        Loads that act.
    begin : State
        State at the beginning, with its accelerations.
    steps, every : int
        Number of steps, and of steps from record to record.
    watch : array_like or None
        Rows whose values and rates are recorded, see `integrate`.
    stop : Stop
        Event that ends the steps.
    tolerance : float
        Tolerance of Newton's method: change of an elongation over its maximum so far.

    Returns
    -------
    piece : Piece
    """
    n, springs, b = len(begin.q), stepper.mechanism.equations.springs, len(stepper.rolling.seconds)
    kept = _records(stepper, n, steps // every + 1)
    counts: Ints = np.zeros(3, dtype=np.int64)
    drive = Drive(
        np.ascontiguousarray(loads.patterns)[None],
        np.ascontiguousarray(loads.times),
        np.ascontiguousarray(loads.histories),
    )
    span = Span(int(steps), int(every), float(begin.time), float(tolerance))
    turns = len(springs.rows) if stepper.turning is not None else 0
    work = memory(stepper.model, b, turns, drive.histories.shape[1])
    state = work.vectors
    state[U], state[V], state[A] = begin.q, begin.velocity, begin.acceleration
    state[U0 : A0 + 1] = state[U : A + 1]
    model, turning = stepper.model, stepper.turning
    rolling = None
    if b or turning is not None:  # what a run has nothing of is not compiled for it
        rolling, turning = stepper.rolling, turning or NOTHING_TURNS
    done = march(span, model, rolling, turning, drive, stop, work, kept, counts)
    dt = model.matrices.dt
    end, before = (
        State(q.copy(), v.copy(), a.copy(), begin.time + steps * dt)
        for (q, v, a), steps in ((state[U : A + 1], done), (state[U0 : A0 + 1], done - 1))
    )
    seen = None if watch is None else np.atleast_2d(np.asarray(watch, dtype=np.float64))
    motion = _motion(stepper, kept, done // every + 1, seen, counts, end)
    passed = stop.signs * (stop.rows @ end.velocity)
    stopped = bool(np.any((stop.signs != 0.0) & (passed <= 0.0)))
    return Piece(motion, before, stopped, kept.gripped[: len(motion.times)])


def _records(stepper: Stepper, n: int, k: int) -> Kept:
    """Memory for k records."""
    springs, turns = stepper.mechanism.equations.springs.rows, stepper.turning is not None
    return Kept(
        np.empty(k),
        np.empty((k, n)),
        np.empty((k, n)),
        np.empty((k, stepper.model.laws.values.shape[1])),
        np.empty((k, len(springs) if turns else 0)),
        np.empty((2, k, 5 * len(stepper.rolling.seconds))),
        np.empty((k, stepper.model.matrices.held.shape[1])),
        np.empty((k, 5)),
    )


def _motion(
    stepper: Stepper, kept: Kept, k: int, seen: Floats | None, counts: Ints, end: State
) -> Motion:
    """The history of k records of all degrees of freedom, or of rows (w, n)."""
    mechanism = stepper.mechanism
    s, law = mechanism.equations.springs, mechanism.equations.springs.special
    q, velocity = kept.places[:k], kept.rates[:k]
    forces = kept.along[:k] if mechanism.carriers else stepper.springs.of(q, velocity)
    forces[:, law] = kept.forces[:k]
    energies = kept.energies[:k]
    # the constant of a spring's energy that its offset leaves
    energies[:, STRAIN] += 0.5 * float((s.stiffness * s.offset**2)[~law].sum())
    bearings, azimuth = NO_BEARINGS, STANDING
    if mechanism.bearings.seats:
        seats = mechanism.bearings.seats
        motions, loads = kept.bearings[:, :k].reshape(2, k, len(seats), 5)
        energies[:, STRAIN] += mechanism.bearings.rollers.energies(motions)
        bearings = BearingHistory(seats, motions, loads)
    if mechanism.carriers is not None:
        azimuth = mechanism.carriers.speed * kept.times[:k]
    return Motion(
        kept.times[:k],
        q if seen is None else q @ seen.T,
        velocity if seen is None else velocity @ seen.T,
        forces,
        energies,
        int(counts[0]),
        int(counts[1]),
        int(counts[2]),
        end,
        bearings,
        azimuth=azimuth,
    )
