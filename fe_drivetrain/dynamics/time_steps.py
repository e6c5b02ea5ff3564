"""Time steps of equal length, compiled: one constant matrix, Newton on the laws alone.

The matrix of a step is constant, with each spring's mean stiffness, so that its inverse is computed
once. What the laws add are forces along few rows R (elongations and phases), and the unknowns of
Newton's method are the r values z = R q only (Sherman, Morrison and Woodbury):

    z = z_free - (1 - a_f) S d(z, z'),    S = R A^-1 R^T

where z_free is what the constant matrix gives and d are the forces beyond it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from fe_drivetrain.common.arrays import Floats, Ints

#: Newton steps after which a time step counts as not converged; half of them at full length.
MOST_STEPS = 40

KINETIC, STRAIN, WORK, DISSIPATED, CLOCK = range(5)
"""Columns of the energies."""


class Laws(NamedTuple):
    """SpringLaws that are more than a constant stiffness; fields as of `SpringLaws`.

    ``row`` is the place of the elongation among the rows, ``angle`` that of the phase or -1.
    """

    row: Ints
    angle: Ints
    stiffness: Floats
    damping: Floats
    lower: Floats
    upper: Floats
    exponent: Floats
    offset: Floats
    wave: Ints
    phase: Floats
    frequency: Floats
    power: Floats
    speed: Floats
    waves: Floats
    error: Ints
    error_phase: Floats
    error_turns: Floats
    errors: Floats
    driven: bool


class Matrices(NamedTuple):
    """Matrices of one scheme and one length of step.

    ``coefficients``: those of `Scheme.coefficients`; ``inverse`` (n, n) of A; ``columns`` (n, r)
    A^-1 R^T; ``compliance`` (r, r) R A^-1 R^T.
    """

    dt: float
    coefficients: Floats
    mass: Floats
    damping: Floats
    stiffness: Floats
    constant: Floats
    rows: Floats
    inverse: Floats
    columns: Floats
    compliance: Floats


class Drive(NamedTuple):
    """Loads: patterns (n, p), times (s,) and histories (s, p)."""

    patterns: Floats
    times: Floats
    histories: Floats


class Stop(NamedTuple):
    """The steps end where ``sign * (row . q')`` is no longer positive; a sign of 0 never ends."""

    row: Floats
    sign: float


@njit(cache=True, error_model="numpy")
def _wave(table: Floats, phase: float) -> tuple[float, float, float]:  # pragma: no cover
    """A wave at a phase, and its first and second derivative by the phase."""
    p = len(table)
    s = (phase - np.floor(phase)) * p
    j = min(int(s), p - 1)
    s = (s - j) / p
    c0, c1, c2, c3 = table[j, 0], table[j, 1], table[j, 2], table[j, 3]
    return (
        c0 + s * (c1 + s * (c2 + s * c3)),
        c1 + s * (2.0 * c2 + 3.0 * c3 * s),
        2.0 * c2 + 6.0 * c3 * s,
    )


@njit(cache=True, error_model="numpy")
def _factor(
    laws: Laws, i: int, phase: float
) -> tuple[float, float, float]:  # pragma: no cover - compiled
    """Stiffness over its mean at a phase, and its first and second derivative by the phase."""
    if laws.wave[i] < 0:
        return 1.0, 0.0, 0.0
    return _wave(laws.waves[laws.wave[i]], phase)


@njit(cache=True, error_model="numpy")
def _error(
    laws: Laws, i: int, phase: float
) -> tuple[float, float, float]:  # pragma: no cover - compiled
    """The error at a phase of the stiffness [m], and its first and second derivative by that."""
    if laws.error[i] < 0:
        return 0.0, 0.0, 0.0
    r = laws.error_turns[i]
    e, slope, bend = _wave(laws.errors[laws.error[i]], laws.error_phase[i] + r * phase)
    return e, r * slope, r * r * bend


@njit(cache=True, error_model="numpy")
def _phase(laws: Laws, i: int, t: float, z: Floats) -> float:  # pragma: no cover - compiled
    at = laws.phase[i] + laws.frequency[i] * t
    return float(at + z[laws.angle[i]] if laws.angle[i] >= 0 else at)


@njit(cache=True, error_model="numpy")
def _potential(laws: Laws, i: int, x: float) -> tuple[float, float, float]:  # pragma: no cover
    """Phi and its first and second derivative by the elongation x."""
    p = laws.exponent[i]
    if laws.lower[i] == laws.upper[i]:
        side, sign = abs(x), (1.0 if x >= 0.0 else -1.0)
    elif x > laws.upper[i]:
        side, sign = x - laws.upper[i], 1.0
    elif x < laws.lower[i]:
        side, sign = laws.lower[i] - x, -1.0
    else:
        return 0.0, 0.0, 0.0
    if p == 1.0:
        return 0.5 * side * side, sign * side, 1.0
    force = side**p
    return force * side / (p + 1.0), sign * force, (p * force / side if side > 0.0 else 0.0)


@njit(cache=True, error_model="numpy")
def _touches(laws: Laws, i: int, t: float, z: Floats) -> bool:  # pragma: no cover
    x = z[laws.row[i]] - laws.offset[i] - _error(laws, i, _phase(laws, i, t, z))[0]
    return bool(laws.lower[i] == laws.upper[i] or x > laws.upper[i] or x < laws.lower[i])


@njit(cache=True, error_model="numpy")
def touching(laws: Laws, t: float, z: Floats, damps: Floats) -> None:  # pragma: no cover
    """Into damps (q,): 1 of each law in contact at values z (r,) of the rows, else 0."""
    for i in range(len(laws.row)):
        damps[i] = 1.0 if _touches(laws, i, t, z) else 0.0


@njit(cache=True, error_model="numpy")
def law_forces(
    laws: Laws,
    t: float,
    z: Floats,
    rate: Floats,
    damps: Floats,
    by_rate: float,
    extra: Floats,
    tangent: Floats,
    forces: Floats,
    damper: Floats,
) -> tuple[float, float, float]:  # pragma: no cover
    """Forces of all laws beyond the constant matrices.

    Parameters
    ----------
    laws : Laws
        Laws of q springs on r rows.
    t : float
        Time [s].
    z, rate : Floats
        Elongations and phases (r,), and their rates.
    damps : Floats
        Flags (q,): 1 where a damper works, else 0.
    by_rate : float
        Change of a rate by the change of its value, in a step.
    extra, tangent : Floats
        Vector d (r,), and its derivative by z (r, r) at that `by_rate`, overwritten.
    forces : Floats
        Forces of each spring along its row (q,), overwritten.
    damper : Floats
        Part of d that damper and machine have (q,), overwritten.

    Returns
    -------
    energy, power, followed : float
        Energy of the springs beyond the constant stiffness; power that the clock of stiffnesses and
        errors that vary with time puts in; and power of the dampers along the errors, which they do
        not take out.
    """
    extra[:] = 0.0
    tangent[:] = 0.0
    energy = power = followed = 0.0
    for i in range(len(laws.row)):
        h, g = laws.row[i], laws.angle[i]
        phase = _phase(laws, i, t, z)
        factor, slope, bend = _factor(laws, i, phase)
        e, e1, e2 = _error(laws, i, phase)
        turning = laws.frequency[i] + (rate[g] if g >= 0 else 0.0)
        k, c = laws.stiffness[i], laws.damping[i]
        phi, first, second = _potential(laws, i, z[h] - laws.offset[i] - e)
        force = k * factor * first
        stiff = k * factor * second
        damper[i] = (damps[i] - 1.0) * c * rate[h] - damps[i] * c * e1 * turning
        resists = (damps[i] - 1.0) * c
        if laws.power[i] != 0.0:
            speed = laws.speed[i] + rate[h]
            damper[i] += laws.power[i] / speed
            resists -= laws.power[i] / speed**2
        forces[i] = force + damper[i] + c * rate[h]
        extra[h] += force + damper[i] - k * z[h]
        tangent[h, h] += stiff - k + by_rate * resists
        resisted = forces[i] - force
        if g >= 0:
            # of the damper, by the phase and by its rate
            by_phase = -damps[i] * c * (e2 * turning + by_rate * e1)
            tangent[h, g] += k * slope * first - stiff * e1 + by_phase
            if laws.driven:
                extra[g] += k * slope * phi - forces[i] * e1
                tangent[g, h] += k * slope * first - (stiff + by_rate * (resists + c)) * e1
                tangent[g, g] += (
                    k * bend * phi
                    - 2.0 * k * slope * first * e1
                    + stiff * e1 * e1
                    - by_phase * e1
                    - forces[i] * e2
                )
        energy += k * factor * phi - 0.5 * k * z[h] * z[h]
        power += (k * slope * phi - forces[i] * e1) * laws.frequency[i]
        followed += resisted * e1 * turning
    return energy, power, followed


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
def _times(A: Floats, x: Floats, y: Floats) -> None:  # pragma: no cover - compiled
    """A x into y; one call, for a loop that is short to compile."""
    np.dot(A, x, y)


@njit(cache=True, error_model="numpy")
def _product(x: Floats, y: Floats) -> float:  # pragma: no cover - compiled
    total = 0.0
    for i in range(len(x)):
        total += x[i] * y[i]
    return total


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
def march(
    steps: int,
    every: int,
    begin: float,
    matrices: Matrices,
    laws: Laws,
    drive: Drive,
    stop: Stop,
    tolerance: float,
    state: Floats,
    watch: Floats,
    times: Floats,
    places: Floats,
    rates: Floats,
    forces: Floats,
    energies: Floats,
    counts: Ints,
) -> int:  # pragma: no cover - compiled
    """March in equal steps.

    Parameters
    ----------
    steps, every : int
        Number of steps, and after how many of them a record is made; that of the beginning is 0.
    begin : float
        Time of the beginning [s].
    matrices, laws, drive, stop : NamedTuple
        Step, springs, loads and stop event, in the form of the compiled loop.
    tolerance : float
        Tolerance of Newton's method: change of an elongation over its maximum so far, and of a
        phase in periods.
    state : Floats
        Displacements, velocities and accelerations (6, n), overwritten by those of the end; behind
        them the same before the last step, where the steps may stop at an event.
    watch : Floats
        Rows (w, n) whose values and rates are recorded.
    times, places, rates, forces, energies : Floats
        Records (k,), (k, w), (k, w), (k, q) and (k, 5); energies as `KINETIC` ...
    counts : Ints
        Numbers (3,) of Newton steps: in all, and the maximum in a step; and of steps that have not
        converged.

    Returns
    -------
    done : int
        Number of steps that were made.
    """
    dt, b = matrices.dt, matrices.coefficients
    am, af = b[6], b[7]
    M, C, K, R = matrices.mass, matrices.damping, matrices.stiffness, matrices.rows
    n, r, q, p = len(M), len(R), len(laws.row), drive.histories.shape[1]
    u, v, a = state[0], state[1], state[2]
    value, vectors, small = np.zeros(p), np.zeros((11, n)), np.zeros((9, r))
    Mv, Cv, Ku, F0, F1 = vectors[0], vectors[1], vectors[2], vectors[3], vectors[4]
    step, rhs, term, outside, outside0 = vectors[5], vectors[6], vectors[7], vectors[8], vectors[9]
    term2 = vectors[10]
    d, d1, free, residual, new = small[0], small[1], small[2], small[3], small[4]
    rate, z, zr, za = small[5], small[6], small[7], small[8]
    tangent, jacobian = np.zeros((r, r)), np.zeros((r, r))
    spring, damper, damper1, damps = np.zeros(q), np.zeros(q), np.zeros(q), np.zeros(q)
    scale, is_phase = np.zeros(r), np.zeros(r)
    first = int(np.int64(0))  # a literal would be a type of its own, compiled by itself
    place = _load(drive, begin, first, value)
    _times(drive.patterns, value, outside0)
    for i in range(n):
        F0[i] = outside0[i] + matrices.constant[i]
    _times(M, v, Mv)
    _times(C, v, Cv)
    _times(K, u, Ku)
    _times(R, u, z)
    _times(R, v, zr)
    _times(R, a, za)
    touching(laws, begin, z, damps)
    for i in range(q):
        if laws.angle[i] >= 0:
            is_phase[laws.angle[i]] = 1.0
    stored, power, followed = law_forces(laws, begin, z, zr, damps, 0.0, d, tangent, spring, damper)
    work = dissipated = clock = 0.0
    record = 0
    for s in range(steps + 1):
        t = begin + s * dt
        if s > 0:
            for i in range(n):
                state[3, i] = u[i]
                state[4, i] = v[i]
                state[5, i] = a[i]
            place = _load(drive, t, place, value)
            _times(drive.patterns, value, outside)
            # what the constant matrix gives
            for i in range(n):
                F1[i] = outside[i] + matrices.constant[i]
                rhs[i] = (1.0 - af) * F1[i] + af * F0[i] - Ku[i]
                term[i] = (am - (1.0 - am) * b[3]) * a[i] - (1.0 - am) * b[2] * v[i]
            _times(M, term, term2)
            for i in range(n):
                rhs[i] -= term2[i]
                term[i] = (af + (1.0 - af) * b[4]) * v[i] + (1.0 - af) * b[5] * a[i]
            _times(C, term, term2)
            for i in range(n):
                rhs[i] -= term2[i]
                if af != 0.0:
                    for j in range(r):
                        rhs[i] -= af * R[j, i] * d[j]
            _times(matrices.inverse, rhs, step)
            energy = power1 = followed1 = 0.0
            if q > 0:
                _times(R, step, free)
                touching(laws, t - dt, z, damps)
                for i in range(r):
                    free[i] += z[i]
                    new[i] = free[i]
                    scale[i] = max(scale[i], abs(free[i]), abs(z[i]))
                count, converged = 0, False
                while True:
                    for i in range(r):
                        rate[i] = b[1] * (new[i] - z[i]) + b[4] * zr[i] + b[5] * za[i]
                    energy, power1, followed1 = law_forces(
                        laws, t, new, rate, damps, b[1], d1, tangent, spring, damper1
                    )
                    if converged or count == MOST_STEPS:
                        break
                    for i in range(r):
                        residual[i] = free[i] - new[i]
                        for j in range(r):
                            of = (1.0 - af) * matrices.compliance[i, j]
                            residual[i] -= of * d1[j]
                            jacobian[i, j] = 1.0 if i == j else 0.0
                        for j in range(r):
                            of = (1.0 - af) * matrices.compliance[i, j]
                            for k in range(r):
                                if tangent[j, k] != 0.0:
                                    jacobian[i, k] += of * tangent[j, k]
                    _solve(jacobian, residual)
                    count += 1
                    short = 1.0 if count <= MOST_STEPS // 2 else 0.5
                    converged = True
                    for i in range(r):
                        new[i] += short * residual[i]
                        bound = tolerance if is_phase[i] != 0.0 else tolerance * scale[i]
                        if not abs(residual[i]) <= bound:
                            converged = False
                counts[0] += count
                counts[1] = max(counts[1], count)
                if not converged:
                    counts[2] += 1
                for i in range(n):
                    for j in range(r):
                        step[i] -= (1.0 - af) * matrices.columns[i, j] * d1[j]
            for i in range(n):
                new_a = b[0] * step[i] - b[2] * v[i] - b[3] * a[i]
                v[i] = b[1] * step[i] + b[4] * v[i] + b[5] * a[i]
                a[i] = new_a
                u[i] += step[i]
                work += 0.5 * (outside0[i] + outside[i]) * step[i]
                outside0[i] = outside[i]
                F0[i] = F1[i]
                dissipated += 0.5 * Cv[i] * step[i]
            _times(C, v, Cv)
            _times(M, v, Mv)
            _times(K, u, Ku)
            dissipated += 0.5 * _product(Cv, step)
            if q > 0:
                for i in range(q):
                    h = laws.row[i]
                    dissipated += 0.5 * (damper[i] + damper1[i]) * (new[h] - z[h])
                    damper[i] = damper1[i]
                clock += 0.5 * dt * (power + power1)
                dissipated -= 0.5 * dt * (followed + followed1)
                power, followed, stored = power1, followed1, energy
                for i in range(r):
                    d[i] = d1[i]
                    z[i] = new[i]
                _times(R, v, zr)
                _times(R, a, za)
        if s % every == 0:
            times[record] = t
            _times(watch, u, places[record])
            _times(watch, v, rates[record])
            for i in range(q):
                forces[record, i] = spring[i]
            energies[record, 0] = 0.5 * _product(v, Mv)
            energies[record, 1] = 0.5 * _product(u, Ku) - _product(matrices.constant, u) + stored
            energies[record, 2] = work
            energies[record, 3] = dissipated
            energies[record, 4] = clock
            record += 1
        if stop.sign != 0.0 and s > 0 and stop.sign * _product(stop.row, v) <= 0.0:
            return s
    return steps
