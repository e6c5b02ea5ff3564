"""Motion of a turbine in time: compiled, one history at a time.

State: azimuth, rotor speed, twist of the shaft, generator speed, tower (fore-aft, side) with rates,
and two modes of each blade with rates.  Equations are those of `moving`, whose docstring
has them; the induced velocities are beside the state, since they are slow.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.turbine_loads.hub_loads.turbine_air import (
    FORE,
    FORE_RATE,
    GENERATOR,
    MODES,
    PSI,
    RATES,
    SIDE,
    SIDE_RATE,
    SPEED,
    STATES,
    TWIST,
    Parts,
    blade_sums,
    met_wind,
    wake_answers,
)
from fe_drivetrain.turbine_loads.hub_loads.turbine_energy import (
    ENERGIES,
    OF_PITCHING,
    WORKS,
    powers,
    stored,
)
from fe_drivetrain.turbine_loads.hub_loads.wind import Singles

#: Places of what the controller keeps: filtered speed, integral of the pitch, pitch, torque.
FILTERED, INTEGRAL, PITCH, TORQUE = range(4)


class Control(NamedTuple):
    """The controller; see `Controller` and `Tuning`."""

    optimal: float
    slope: float
    origin: float
    cut_in: float
    full: float
    transition: float
    torque_speed: float
    rated_speed: float
    rated_torque: float
    rated_power: float
    constant_power: bool
    least_pitch: float
    proportional: float
    integral: float
    doubling: float
    filter: float
    pitch_rate: float
    torque_rate: float
    held: bool


#: Cosines and sines of the tilt and of the azimuth, or of a blade's azimuth and of its pitch.
Turns = tuple[float, float, float, float]


@njit(cache=True)
def moving(
    parts: Parts,
    state: Floats,
    sums: Floats,
    pitch: float,
    torque: float,
    rates: Floats,
    loads: Floats,
) -> None:
    """Rates of the state, and loads of the rotor on the shaft.

    Modes q of a blade at psi, with components X out of the plane of rotation and T in it after
    pitch, their integrals F = S m f, R = S m r f, M, stiffening N, in-plane mass G = S m T T, speed
    of rotation W, cone b and tilt t:

    M q'' + C q' + (K + W^2 (N - G)) q + FX x'' - FT cos psi y'' + RT W' = air + FX g sin t
    + FT g cos t sin psi + b (W^2 RX - FX g cos t cos psi);
    hub: m x'' + S FX q'' = thrust - tower; m y'' - S FT cos psi q'' = side - tower;
    J W' + S RT q'' = torque of air and weights less that of the shaft.

    What they leave out of Lagrange's equations is in `turbine_energy`.
    """
    for j in range(STATES):
        rates[j] = 0.0
    rates[PSI] = state[SPEED]
    right, inertia, hub = np.zeros(3), np.zeros((3, 3)), np.zeros(3)
    turns = (math.cos(parts.tilt), math.sin(parts.tilt), math.cos(state[PSI]), math.sin(state[PSI]))
    in_shaft = _hub(parts, state, sums, torque, turns, right, inertia, rates)
    blades = _Blades(
        np.zeros((3, 2)), np.zeros((3, 2, 3)), np.zeros((3, 2, 2)), np.zeros((3, 2, 2))
    )
    _blades_answer(parts, state, sums, pitch, turns, right, inertia, blades)
    if parts.tower_moves:
        solved(inertia, right, hub)
        rates[FORE], rates[FORE_RATE] = state[FORE_RATE], hub[0]
        rates[SIDE], rates[SIDE_RATE] = state[SIDE_RATE], hub[1]
    else:
        hub[2] = right[2] / inertia[2, 2]
    rates[SPEED] = hub[2]
    if not parts.torsion:
        rates[GENERATOR] = hub[2]
        in_shaft = torque + parts.generator_inertia * hub[2]
    _shaft_loads(parts, state, sums, hub, blades, in_shaft, turns, rates, loads)


# What `moving` and the loop are made of is written into them: handing the turbine on takes longer
# than the work.


class _Blades(NamedTuple):
    """Answers of the blades' modes, each by blade and mode.

    Attributes
    ----------
    alone : Floats
        Acceleration (3, 2) on a hub that stands.
    answer : Floats
        Acceleration (3, 2, 3) that each acceleration of the hub takes from it.
    force, moment : Floats
        Integrals F and R (3, 2, 2) out of the plane of rotation and in it, after pitch.
    """

    alone: Floats
    answer: Floats
    force: Floats
    moment: Floats


@njit(cache=True, inline="always")
def _hub(
    parts: Parts,
    state: Floats,
    sums: Floats,
    torque: float,
    turns: Turns,
    right: Floats,
    inertia: Floats,
    rates: Floats,
) -> float:
    """Right sides and inertia of the hub's motion without the blades'; the torque of the shaft."""
    g, speed = parts.gravity, state[SPEED]
    cos_tilt, _, cos1, sin1 = turns
    right[0] = sums[0, 0] + sums[1, 0] + sums[2, 0]
    right[1] = -parts.imbalance * speed**2 * sin1
    right[2] = sums[0, 3] + sums[1, 3] + sums[2, 3] + parts.imbalance * g * cos_tilt * sin1
    inertia[0, 0] = inertia[1, 1] = parts.top_mass
    inertia[1, 2] = inertia[2, 1] = -parts.imbalance * cos1
    for k, at in ((0, FORE), (1, SIDE)):
        w = parts.tower_rate
        spring = 2.0 * parts.tower_damping * w * state[at + 1] + w**2 * state[at]
        right[k] -= parts.top_mass * spring
    if parts.torsion:
        in_shaft = parts.shaft_stiffness * state[TWIST]
        in_shaft += parts.shaft_damping * (speed - state[GENERATOR])
        rates[TWIST] = speed - state[GENERATOR]
        rates[GENERATOR] = (in_shaft - torque) / parts.generator_inertia
        right[2] -= in_shaft
        inertia[2, 2] = parts.rotor_inertia
    else:
        in_shaft = 0.0
        right[2] -= torque
        inertia[2, 2] = parts.rotor_inertia + parts.generator_inertia
    return in_shaft


@njit(cache=True, inline="always")
def _blades_answer(
    parts: Parts,
    state: Floats,
    sums: Floats,
    pitch: float,
    turns: Turns,
    right: Floats,
    inertia: Floats,
    blades: _Blades,
) -> None:
    """What each blade would do on a hub that stands, how it answers the hub, and what that adds."""
    coupled = np.zeros((2, 3))
    for i in range(3):
        angle = state[PSI] + 2.0 * math.pi * i / 3.0
        cos = math.cos(angle)
        right[1] -= sums[i, 2] * cos
        if not parts.blades_move:
            continue
        turn = pitch + parts.pitch_errors[i]
        own = (cos, math.sin(angle), math.cos(turn), math.sin(turn))
        _turned(parts, own, i, blades)
        _modes(parts, state, sums, turns, own, i, right, blades, coupled)
        _answers(parts, i, coupled, blades)
        for k in range(3):
            for a in range(2):
                right[k] -= coupled[a, k] * blades.alone[i, a]
                for m in range(3):
                    inertia[k, m] -= coupled[a, k] * blades.answer[i, a, m]


@njit(cache=True, inline="always")
def _turned(parts: Parts, own: Turns, i: int, blades: _Blades) -> None:
    """Integrals of a blade's modes, turned by its pitch."""
    _, _, c, s = own
    force, moment = blades.force, blades.moment
    for a in range(2):
        force[i, a, 0] = parts.force[a, 0] * c - parts.force[a, 1] * s
        force[i, a, 1] = parts.force[a, 0] * s + parts.force[a, 1] * c
        moment[i, a, 0] = parts.moment[a, 0] * c - parts.moment[a, 1] * s
        moment[i, a, 1] = parts.moment[a, 0] * s + parts.moment[a, 1] * c


@njit(cache=True, inline="always")
def _modes(
    parts: Parts,
    state: Floats,
    sums: Floats,
    turns: Turns,
    angles: Turns,
    i: int,
    right: Floats,
    blades: _Blades,
    coupled: Floats,
) -> None:
    """Force on each mode of a blade, what couples it with the hub, and what it adds there."""
    g, speed = parts.gravity, state[SPEED]
    cos_tilt, sin_tilt, _, _ = turns
    cos, sin, c, s = angles
    force, moment = blades.force, blades.moment
    for a in range(2):
        coupled[a, 0] = force[i, a, 0]
        coupled[a, 1] = -force[i, a, 1] * cos
        coupled[a, 2] = moment[i, a, 1]
        own = sums[i, 4 + a] + force[i, a, 0] * g * sin_tilt
        own += force[i, a, 1] * g * cos_tilt * sin
        own += parts.cone * (speed**2 * moment[i, a, 0] - force[i, a, 0] * g * cos_tilt * cos)
        at = state[MODES + 6 * a + i]
        own -= parts.damping[a] * state[RATES + 6 * a + i] + parts.stiffness[a] * at
        for b in range(2):
            of = parts.products[a, b]
            plane = s * s * of[0, 0] + s * c * (of[0, 1] + of[1, 0]) + c * c * of[1, 1]
            own -= speed**2 * (parts.stiffening[a, b] - plane) * state[MODES + 6 * b + i]
        blades.alone[i, a] = own
        right[2] += force[i, a, 1] * at * g * cos_tilt * cos
        right[1] -= force[i, a, 1] * speed**2 * at * cos
        right[1] -= 2.0 * speed * force[i, a, 1] * state[RATES + 6 * a + i] * sin


@njit(cache=True, inline="always")
def _answers(parts: Parts, i: int, coupled: Floats, blades: _Blades) -> None:
    """Accelerations of a blade's two modes, from the forces on them."""
    alone, answer = blades.alone, blades.answer
    ff = parts.products[0, 0, 0, 0] + parts.products[0, 0, 1, 1]
    fe = parts.products[0, 1, 0, 0] + parts.products[0, 1, 1, 1]
    ee = parts.products[1, 1, 0, 0] + parts.products[1, 1, 1, 1]
    whole = ff * ee - fe * fe
    one, other = alone[i, 0], alone[i, 1]
    alone[i, 0] = (ee * one - fe * other) / whole
    alone[i, 1] = (ff * other - fe * one) / whole
    for k in range(3):
        answer[i, 0, k] = (ee * coupled[0, k] - fe * coupled[1, k]) / whole
        answer[i, 1, k] = (ff * coupled[1, k] - fe * coupled[0, k]) / whole


@njit(cache=True, inline="always")
def _shaft_loads(
    parts: Parts,
    state: Floats,
    sums: Floats,
    hub: Floats,
    blades: _Blades,
    in_shaft: float,
    turns: Turns,
    rates: Floats,
    loads: Floats,
) -> None:
    """Loads of the rotor on the shaft, and the rates of the blades' modes."""
    g, speed = parts.gravity, state[SPEED]
    cos_tilt, sin_tilt, cos1, sin1 = turns
    alone, answer, force, moment = blades
    weight = parts.rotor_mass * g
    thrust = sums[0, 0] + sums[1, 0] + sums[2, 0]
    loads[0] = thrust + weight * sin_tilt - parts.rotor_mass * hub[0]
    loads[1] = -parts.rotor_mass * hub[1]
    loads[2] = -weight * cos_tilt
    loads[3] = in_shaft
    loads[4] = -3.0 * parts.cone * parts.first_moment * g * cos_tilt
    loads[5] = 0.0
    for i in range(3):
        angle = state[PSI] + 2.0 * math.pi * i / 3.0
        cos, sin = math.cos(angle), math.sin(angle)
        along, outward, bending = sums[i, 2], 0.0, sums[i, 1]
        if parts.blades_move:
            for a in range(2):
                faster = alone[i, a]
                for k in range(3):
                    faster -= answer[i, a, k] * hub[k]
                at, rate = state[MODES + 6 * a + i], state[RATES + 6 * a + i]
                rates[MODES + 6 * a + i] = rate
                rates[RATES + 6 * a + i] = faster
                loads[0] -= force[i, a, 0] * faster
                along -= force[i, a, 1] * (faster - speed**2 * at)
                outward += 2.0 * speed * force[i, a, 1] * rate
                bending -= moment[i, a, 0] * (faster + speed**2 * at)
                loads[4] += force[i, a, 0] * at * g * cos_tilt
        loads[1] -= along * cos + outward * sin
        loads[2] -= along * sin - outward * cos
        loads[4] += bending * cos
        loads[5] += bending * sin
    loads[1] -= parts.imbalance * (speed**2 * sin1 - hub[2] * cos1)
    loads[2] += parts.imbalance * (speed**2 * cos1 + hub[2] * sin1)
    loads[4] += parts.imbalance * g * sin_tilt * cos1
    loads[5] += parts.imbalance * g * sin_tilt * sin1


@njit(cache=True)
def solved(matrix: Floats, right: Floats, result: Floats) -> None:
    """Three equations, symmetric and positive definite."""
    a, b, c = matrix[0]
    d, e, f = matrix[1, 1], matrix[1, 2], matrix[2, 2]
    x, y, z = d * f - e * e, c * e - b * f, b * e - c * d
    u, v, w = a * f - c * c, b * c - a * e, a * d - b * b
    whole = a * x + b * y + c * z
    result[0] = (x * right[0] + y * right[1] + z * right[2]) / whole
    result[1] = (y * right[0] + u * right[1] + v * right[2]) / whole
    result[2] = (z * right[0] + v * right[1] + w * right[2]) / whole


@njit(cache=True)
def asked_torque(control: Control, speed: float, pitch: float) -> float:
    """Torque that `Controller.torque` asks for."""
    if speed >= control.torque_speed or pitch >= control.least_pitch:
        if control.constant_power:
            return control.rated_power / max(speed, 0.5 * control.rated_speed)
        return control.rated_torque
    if speed < control.cut_in:
        return 0.0
    if speed < control.full:
        share = (speed - control.cut_in) / (control.full - control.cut_in)
        return control.optimal * control.full**2 * share
    if speed < control.transition:
        return control.optimal * speed**2
    return control.slope * (speed - control.origin)


@njit(cache=True)
def run_turbine(
    parts: Parts,
    control: Control,
    turbulence: Singles,
    mean_shear: Floats,
    first: Floats,
    pitch: float,
    wake: Floats,
    sample: float,
    steps: int,
    accounted: bool,
) -> tuple[Floats, Floats, Floats]:
    """Integrate by Runge and Kutta's fourth-order method.

    Parameters
    ----------
    parts, control : Parts, Control
        The turbine and its controller.
    turbulence : ndarray, (n, 2 M + 1, r)
        Harmonics of the wind at each sample [m/s], by azimuth.
    mean_shear : ndarray, (r,)
        Mean over a turn of the steady wind over that at the hub.
    first : ndarray, (20,)
        The state at the beginning.
    pitch : float
        At the beginning [rad].
    wake : ndarray, (4, r)
        Induced velocities there, twice; overwritten.
    sample : float
        Time between two samples [s].
    steps : int
        Number of steps of the integration in each.
    accounted : bool
        Whether to keep an account of the energy, whose works are integrated as the state is.

    Returns
    -------
    ndarray, (n, 6)
        Loads at the hub [N, N m]; fewer rows where the rotor stopped or ran away.
    ndarray, (n, 4 + 20)
        Pitch [rad], torque of the generator [N m], power of the air [W], mean wind over the disc
        [m/s], the state.
    ndarray, (n, 8 + 7)
        What `stored` gives [J], and since the beginning the integrals of `powers` [J]; no rows
        without an account.
    """
    count, rows, rings = turbulence.shape
    step = sample / steps
    state, at = first.copy(), np.zeros(STATES)
    made = np.zeros((count, 6))
    beside = np.zeros((count, 4 + STATES))
    now, wind = np.zeros((rows, rings)), np.zeros((3, rings))
    waves = np.zeros(rows)
    sums = np.zeros((5, max(rings, 6)))
    loads, rate = np.zeros(6), np.zeros((4, STATES))
    free = np.zeros(rings)
    books = np.zeros((count if accounted else 0, ENERGIES + WORKS))
    works, power = np.zeros(WORKS), np.zeros((4, WORKS))
    energy, pitched = np.zeros(ENERGIES), np.zeros(ENERGIES)
    acts = np.zeros(4)
    acts[FILTERED], acts[INTEGRAL], acts[PITCH] = state[GENERATOR], pitch, pitch
    acts[TORQUE] = asked_torque(control, state[GENERATOR], pitch)
    smoothing = 1.0 - math.exp(-2.0 * math.pi * control.filter * step)
    for n in range(count):
        for part in range(steps):
            if accounted:
                stored(parts, state, acts[PITCH], energy)
            if not control.held:
                _controlled(control, state[GENERATOR], smoothing, step, acts)
            pitch, torque = acts[PITCH], acts[TORQUE]
            if accounted:
                stored(parts, state, pitch, pitched)
                for j in range(ENERGIES):
                    works[OF_PITCHING] += pitched[j] - energy[j]
            for stage in range(4):
                part_of = 0.0 if stage == 0 else (1.0 if stage == 3 else 0.5)
                _wind_at(turbulence, n, (part + part_of) / steps, now)
                for j in range(STATES):  # written out, since array expressions compile slowly
                    at[j] = state[j]
                    if stage > 0:
                        at[j] += part_of * step * rate[stage - 1, j]
                met_wind(parts, now, at[PSI], wind, waves)
                blade_sums(parts, at, pitch, wind, wake, sums)
                moving(parts, at, sums, pitch, torque, rate[stage], loads)
                if accounted:
                    powers(parts, at, rate[stage], sums, pitch, torque, power[stage])
                for i in range(rings):
                    free[i] = parts.wind_speed * mean_shear[i] + now[0, i]
                if stage == 0 and part == 0:
                    for j in range(6):
                        made[n, j] = loads[j]
                    _noted(parts, state, acts, sums, free, beside[n])
                    if accounted:
                        for j in range(ENERGIES):
                            books[n, j] = pitched[j]
                        for j in range(WORKS):
                            books[n, ENERGIES + j] = works[j]
            if not parts.frozen:  # with the loading at the end of the step
                wake_answers(parts, at, sums, free, wake, step)
            _advanced(state, rate, step)
            if accounted:
                _advanced(works, power, step)
            if not math.isfinite(state[SPEED]) or state[SPEED] < 0.0:
                return made[: n + 1], beside[: n + 1], books[: n + 1]
    return made, beside, books


@njit(cache=True, inline="always")
def _controlled(
    control: Control, speed: float, smoothing: float, step: float, acts: Floats
) -> None:
    """Pitch and torque after a step, at the limits of their rates."""
    acts[FILTERED] += smoothing * (speed - acts[FILTERED])
    # each step of the integral is scaled by itself, so that its sum is a pitch
    error = acts[FILTERED] - control.rated_speed
    factor = 1.0 / (1.0 + acts[PITCH] / control.doubling)
    whole = acts[INTEGRAL] + factor * control.integral * error * step
    acts[INTEGRAL] = min(max(whole, 0.0), 0.5 * math.pi)
    asked = acts[INTEGRAL] + factor * control.proportional * error
    asked = min(max(asked, 0.0), 0.5 * math.pi)
    change = control.pitch_rate * step
    acts[PITCH] += min(max(asked - acts[PITCH], -change), change)
    change = control.torque_rate * step
    goal = asked_torque(control, acts[FILTERED], acts[PITCH])
    acts[TORQUE] += min(max(goal - acts[TORQUE], -change), change)


@njit(cache=True, inline="always")
def _wind_at(turbulence: Singles, n: int, share: float, now: Floats) -> None:
    """Harmonics of the wind between a sample and the next."""
    after = min(n + 1, len(turbulence) - 1)
    rows, rings = now.shape
    for m in range(rows):
        for i in range(rings):
            one, other = turbulence[n, m, i], turbulence[after, m, i]
            now[m, i] = one + share * (other - one)


@njit(cache=True, inline="always")
def _noted(
    parts: Parts, state: Floats, acts: Floats, sums: Floats, free: Floats, beside: Floats
) -> None:
    """Fill pitch, torque, power of the air, mean wind over the disc, and the state."""
    area = 0.0
    for i in range(len(free)):
        area += parts.weight[i] * parts.radius[i]
    beside[0], beside[1] = acts[PITCH], acts[TORQUE]
    drive = sums[0, 3] + sums[1, 3] + sums[2, 3]
    beside[2] = drive * state[SPEED]
    for i in range(len(free)):
        beside[3] += free[i] * parts.weight[i] * parts.radius[i] / area
    for j in range(STATES):
        beside[4 + j] = state[j]


@njit(cache=True, inline="always")
def _advanced(values: Floats, rates: Floats, step: float) -> None:
    """Add a step of Runge and Kutta's with rates (4, n) of its stages."""
    for j in range(len(values)):
        twice = 2.0 * (rates[1, j] + rates[2, j])
        values[j] += step / 6.0 * (rates[0, j] + twice + rates[3, j])
