"""Motion of a turbine in time: compiled, one history at a time.

State: azimuth, rotor speed, twist of the shaft, generator speed, tower (fore-aft, side) with rates,
and two modes of each blade with rates.  Equations are those of `moving`, whose docstring
has them; the induced velocities are beside the state, since they are slow.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.compiled import inner_loop, njit
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
    SUMS,
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
    min_pitch: float
    proportional: float
    integral: float
    doubling: float
    filter: float
    pitch_rate: float
    torque_rate: float
    held: bool


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
    cos_tilt, sin_tilt = math.cos(parts.tilt), math.sin(parts.tilt)
    g, speed = parts.gravity, state[SPEED]
    for j in range(STATES):
        rates[j] = 0.0
    rates[PSI] = speed
    sin1, cos1 = math.sin(state[PSI]), math.cos(state[PSI])

    # hub: fore-aft, side, rotation
    right, inertia, hub = np.zeros(3), np.zeros((3, 3)), np.zeros(3)
    thrust = sums[0, 0] + sums[1, 0] + sums[2, 0]
    right[0] = thrust
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

    # blades: what each would do on a hub that stands, and how it answers the hub
    alone, answer = np.zeros((3, 2)), np.zeros((3, 2, 3))
    force, moment, coupled = np.zeros((3, 2, 2)), np.zeros((3, 2, 2)), np.zeros((2, 3))
    for i in range(3):
        angle = state[PSI] + 2.0 * math.pi * i / 3.0
        cos, sin = math.cos(angle), math.sin(angle)
        right[1] -= sums[i, 2] * cos
        if not parts.blades_move:
            continue
        turn = pitch + parts.pitch_errors[i]
        c, s = math.cos(turn), math.sin(turn)
        for a in range(2):
            force[i, a, 0] = parts.force[a, 0] * c - parts.force[a, 1] * s
            force[i, a, 1] = parts.force[a, 0] * s + parts.force[a, 1] * c
            moment[i, a, 0] = parts.moment[a, 0] * c - parts.moment[a, 1] * s
            moment[i, a, 1] = parts.moment[a, 0] * s + parts.moment[a, 1] * c
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
            alone[i, a] = own
            right[2] += force[i, a, 1] * at * g * cos_tilt * cos
            right[1] -= force[i, a, 1] * speed**2 * at * cos
            right[1] -= 2.0 * speed * force[i, a, 1] * state[RATES + 6 * a + i] * sin
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
        for k in range(3):
            for a in range(2):
                right[k] -= coupled[a, k] * alone[i, a]
                for m in range(3):
                    inertia[k, m] -= coupled[a, k] * answer[i, a, m]
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

    # loads on the shaft
    weight = parts.rotor_mass * g
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


@inner_loop(error_model="python")
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


@inner_loop(error_model="python")
def asked_torque(control: Control, speed: float, pitch: float) -> float:
    """Torque that `Controller.torque` asks for."""
    if speed >= control.torque_speed or pitch >= control.min_pitch:
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
    ndarray, (n, 4 + 20 + 20 + 24)
        Pitch [rad], torque of the generator [N m], power of the air [W], mean wind over the disc
        [m/s], the state, its rates, and what `blade_sums` gives of each blade.
    ndarray, (n, 8 + 7)
        What `stored` gives [J], and since the beginning the integrals of `powers` [J]; no rows
        without an account.
    """
    count, rows, rings = turbulence.shape
    step = sample / steps
    state, at = first.copy(), np.zeros(STATES)
    made = np.zeros((count, 6))
    beside = np.zeros((count, 4 + 2 * STATES + 3 * SUMS))
    now, wind = np.zeros((rows, rings)), np.zeros((3, rings))
    waves = np.zeros(rows)
    sums = np.zeros((5, max(rings, SUMS)))
    loads, rate = np.zeros(6), np.zeros((4, STATES))
    free = np.zeros(rings)
    books = np.zeros((count if accounted else 0, ENERGIES + WORKS))
    works, power = np.zeros(WORKS), np.zeros((4, WORKS))
    energy, pitched = np.zeros(ENERGIES), np.zeros(ENERGIES)
    filtered = state[GENERATOR]
    torque = asked_torque(control, filtered, pitch)
    whole = pitch
    smoothing = 1.0 - math.exp(-2.0 * math.pi * control.filter * step)
    area = 0.0
    for i in range(rings):
        area += parts.weight[i] * parts.radius[i]
    for n in range(count):
        after = min(n + 1, count - 1)
        for part in range(steps):
            if accounted:
                stored(parts, state, pitch, energy)
            if not control.held:
                # each step of the integral is scaled by itself, so that its sum is a pitch
                filtered += smoothing * (state[GENERATOR] - filtered)
                error = filtered - control.rated_speed
                factor = 1.0 / (1.0 + pitch / control.doubling)
                whole += factor * control.integral * error * step
                whole = min(max(whole, 0.0), 0.5 * math.pi)
                asked = whole + factor * control.proportional * error
                asked = min(max(asked, 0.0), 0.5 * math.pi)
                change = control.pitch_rate * step
                pitch += min(max(asked - pitch, -change), change)
                change = control.torque_rate * step
                goal = asked_torque(control, filtered, pitch)
                torque += min(max(goal - torque, -change), change)
            if accounted:
                stored(parts, state, pitch, pitched)
                for j in range(ENERGIES):
                    works[OF_PITCHING] += pitched[j] - energy[j]
            for stage in range(4):
                part_of = 0.0 if stage == 0 else (1.0 if stage == 3 else 0.5)
                share = (part + part_of) / steps
                for m in range(rows):
                    for i in range(rings):
                        one, other = turbulence[n, m, i], turbulence[after, m, i]
                        now[m, i] = one + share * (other - one)
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
                    beside[n, 0], beside[n, 1] = pitch, torque
                    drive = sums[0, 3] + sums[1, 3] + sums[2, 3]
                    beside[n, 2] = drive * state[SPEED]
                    for i in range(rings):
                        beside[n, 3] += free[i] * parts.weight[i] * parts.radius[i] / area
                    for j in range(STATES):
                        beside[n, 4 + j] = state[j]
                        beside[n, 4 + STATES + j] = rate[0, j]
                    for i in range(3):
                        for j in range(SUMS):
                            beside[n, 4 + 2 * STATES + SUMS * i + j] = sums[i, j]
                    if accounted:
                        for j in range(ENERGIES):
                            books[n, j] = pitched[j]
                        for j in range(WORKS):
                            books[n, ENERGIES + j] = works[j]
            if not parts.frozen:  # with the loading at the end of the step
                wake_answers(parts, at, sums, free, wake, step)
            for j in range(STATES):
                twice = 2.0 * (rate[1, j] + rate[2, j])
                state[j] += step / 6.0 * (rate[0, j] + twice + rate[3, j])
            if accounted:
                for j in range(WORKS):
                    twice = 2.0 * (power[1, j] + power[2, j])
                    works[j] += step / 6.0 * (power[0, j] + twice + power[3, j])
            if not math.isfinite(state[SPEED]) or state[SPEED] < 0.0:
                return made[: n + 1], beside[: n + 1], books[: n + 1]
    return made, beside, books
