"""Compiled laws of springs: what they add to the constant matrices of a step.

Rows that turn with a carrier have a rate at constant displacements, too, which dampers feel: the
drift, a row of its own.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import inner_loop, places

ROW, ANGLE, DRIFT, WAVE, ERROR = places(5)
"""Numbers of a law: places of its elongation, its phase and its drift among the rows, or -1; wave
and error."""

(
    STIFFNESS, DAMPING, LOWER, UPPER, EXPONENT, OFFSET,
    PHASE, FREQUENCY, POWER, SPEED, ERROR_PHASE, ERROR_TURNS,
) = places(12)  # fmt: skip
"""Values of a law, as `SpringLaws` has them."""


Z, NEW, ZR, RATE, D, D1, ZA, BASE, FREE, RESIDUAL, CHANGE, SCALE, PIVOT = places(13)
"""Vectors of r, at the beginning and the end of a step: values of the rows, their rates, forces
beyond the matrices; accelerations and values at the beginning by the rows of the end; values that
the matrix gives, residual, change, maximum so far, and rows that Gauss exchanges."""

DAMPER, DAMPER1, SPRING, DAMPS = places(4)
"""Vectors of q: parts of d of dampers at the beginning and the end of a step, forces, contact."""


class Laws(NamedTuple):
    """SpringLaws that are more than a constant stiffness: ``numbers`` (5, q), ``values`` (12, q).

    Few arrays, since each that is handed on takes time to compile.
    """

    numbers: Ints
    values: Floats
    waves: Floats
    errors: Floats
    driven: bool


@inner_loop
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


@inner_loop
def _factor(
    laws: Laws, i: int, phase: float
) -> tuple[float, float, float]:  # pragma: no cover - compiled
    """Stiffness over its mean at a phase, and its first and second derivative by the phase."""
    if laws.numbers[WAVE, i] < 0:
        return 1.0, 0.0, 0.0
    return _wave(laws.waves[laws.numbers[WAVE, i]], phase)


@inner_loop
def _error(
    laws: Laws, i: int, phase: float
) -> tuple[float, float, float]:  # pragma: no cover - compiled
    """The error at a phase of the stiffness [m], and its first and second derivative by that."""
    if laws.numbers[ERROR, i] < 0:
        return 0.0, 0.0, 0.0
    r = laws.values[ERROR_TURNS, i]
    e, slope, bend = _wave(
        laws.errors[laws.numbers[ERROR, i]], laws.values[ERROR_PHASE, i] + r * phase
    )
    return e, r * slope, r * r * bend


@inner_loop
def _phase(laws: Laws, i: int, t: float, y: Floats, z: int) -> float:  # pragma: no cover - compiled
    at = laws.values[PHASE, i] + laws.values[FREQUENCY, i] * t
    return float(at + y[z, laws.numbers[ANGLE, i]] if laws.numbers[ANGLE, i] >= 0 else at)


@inner_loop
def _potential(laws: Laws, i: int, x: float) -> tuple[float, float, float]:  # pragma: no cover
    """Phi and its first and second derivative by the elongation x."""
    p, lower, upper = laws.values[EXPONENT, i], laws.values[LOWER, i], laws.values[UPPER, i]
    if lower == upper:
        side, sign = abs(x), (1.0 if x >= 0.0 else -1.0)
    elif x > upper:
        side, sign = x - upper, 1.0
    elif x < lower:
        side, sign = lower - x, -1.0
    else:
        return 0.0, 0.0, 0.0
    if p == 1.0:
        return 0.5 * side * side, sign * side, 1.0
    force = side**p
    return force * side / (p + 1.0), sign * force, (p * force / side if side > 0.0 else 0.0)


@inner_loop
def touching(laws: Laws, t: float, y: Floats, of: Floats) -> None:  # pragma: no cover
    """Into ``of[DAMPS]``: 1 of each law in contact at values ``y[Z]`` of the rows, else 0."""
    for i in range(of.shape[1]):
        lower, upper = laws.values[LOWER, i], laws.values[UPPER, i]
        e = _error(laws, i, _phase(laws, i, t, y, Z))[0]
        x = y[Z, laws.numbers[ROW, i]] - laws.values[OFFSET, i] - e
        of[DAMPS, i] = 1.0 if lower == upper or x > upper or x < lower else 0.0


@inner_loop
def _damper(
    laws: Laws, i: int, rate: float, damps: float, along_error: float
) -> tuple[float, float]:  # pragma: no cover - compiled
    """Force of damper and machine beyond the constant damper, and its derivative by the rate."""
    c = laws.values[DAMPING, i]
    force = (damps - 1.0) * c * rate - damps * c * along_error
    by_rate = (damps - 1.0) * c
    if laws.values[POWER, i] != 0.0:
        speed = laws.values[SPEED, i] + rate
        force += laws.values[POWER, i] / speed
        by_rate -= laws.values[POWER, i] / speed**2
    return force, by_rate


@inner_loop
def law_forces(
    laws: Laws, t: float, by_rate: float, at: int, y: Floats, of: Floats, tangent: Floats
) -> tuple[float, float, float]:  # pragma: no cover
    """Forces of all laws beyond the constant matrices.

    Parameters
    ----------
    laws : Laws
        Laws of q springs on r rows.
    t, by_rate : float
        Time [s], and change of a rate by the change of its value in a step.
    at : int
        0 at the beginning of a step and 1 at its end: behind each of `Z`, `ZR`, `D`, `DAMPER`.
    y : Floats
        Vectors of r: values of the rows and their rates; forces d, overwritten.
    of : Floats
        Vectors of q: `DAMPS`; forces of each spring along its row, and the part of d that damper
        and machine have, overwritten.
    tangent : Floats
        Derivative of d by the values (r, r) at that `by_rate`, overwritten.

    Returns
    -------
    energy, power, followed : float
        Energy of the springs beyond the constant stiffness; power that the clock of stiffnesses and
        errors that vary with time puts in; and power of the dampers along the errors, which they do
        not take out.
    """
    for i in range(y.shape[1]):
        y[D + at, i] = 0.0
        for j in range(y.shape[1]):
            tangent[i, j] = 0.0
    energy = power = followed = 0.0
    for i in range(of.shape[1]):
        h, g, drift = laws.numbers[ROW, i], laws.numbers[ANGLE, i], laws.numbers[DRIFT, i]
        phase = _phase(laws, i, t, y, Z + at)
        factor, slope, _ = _factor(laws, i, phase)
        e, e1, _ = _error(laws, i, phase)
        turning = laws.values[FREQUENCY, i] + (y[ZR + at, g] if g >= 0 else 0.0)
        z, along = y[Z + at, h], y[ZR + at, h] + (y[Z + at, drift] if drift >= 0 else 0.0)
        k, c = laws.values[STIFFNESS, i], laws.values[DAMPING, i]
        phi, first, second = _potential(laws, i, z - laws.values[OFFSET, i] - e)
        force = k * factor * first
        damper, resists = _damper(laws, i, along, of[DAMPS, i], e1 * turning)
        whole = force + damper + c * along
        of[DAMPER + at, i], of[SPRING, i] = damper, whole
        y[D + at, h] += force + damper - k * z
        tangent[h, h] += k * factor * second - k + by_rate * resists
        if drift >= 0:
            tangent[h, drift] += resists
        if g >= 0:
            state = (phase, turning, phi, first, second, of[DAMPS, i], resists, whole, by_rate)
            y[D + at, g] += _on_phase(laws, i, state, tangent)
        energy += k * factor * phi - 0.5 * k * z * z
        power += (k * slope * phi - whole * e1) * laws.values[FREQUENCY, i]
        followed += (whole - force) * e1 * turning
    return energy, power, followed


@inner_loop
def _on_phase(
    laws: Laws, i: int, state: tuple[float, ...], tangent: Floats
) -> float:  # pragma: no cover - compiled
    """What a law whose phase goes with an angle adds: derivatives by it, and what drives it."""
    phase, turning, phi, first, second, damps, resists, whole, by_rate = state
    h, g, drift = laws.numbers[ROW, i], laws.numbers[ANGLE, i], laws.numbers[DRIFT, i]
    k, c = laws.values[STIFFNESS, i], laws.values[DAMPING, i]
    factor, slope, bend = _factor(laws, i, phase)
    _, e1, e2 = _error(laws, i, phase)
    stiff = k * factor * second
    # of the damper, by the phase and by its rate
    by_phase = -damps * c * (e2 * turning + by_rate * e1)
    tangent[h, g] += k * slope * first - stiff * e1 + by_phase
    if not laws.driven:
        return 0.0
    tangent[g, h] += k * slope * first - (stiff + by_rate * (resists + c)) * e1
    if drift >= 0:
        tangent[g, drift] -= (resists + c) * e1
    tangent[g, g] += (
        k * bend * phi - 2.0 * k * slope * first * e1 + stiff * e1 * e1 - by_phase * e1 - whole * e2
    )
    return float(k * slope * phi - whole * e1)
