"""Motion of a turbine in time: compiled, one history at a time.

State: azimuth, rotor speed, twist of the shaft, generator speed, tower (fore-aft, side), and for
each blade flap and edge, each with its rate.  Equations are those of `moving`, whose docstring
has them; the induced velocities are beside the state, since they are slow.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.hub_loads.wind import Singles


class Parts(NamedTuple):
    """What the equations need, all in SI units."""

    # where the blade elements are, and what they are
    radius: Floats
    weight: Floats
    chord: Floats
    twist: Floats
    flap: Floats
    edge: Floats
    # aerofoil: slope of lift, angle without lift, stall, its width, least drag
    lift_slope: float
    zero_lift: float
    stall: float
    stall_width: float
    drag: float
    density: float
    tip_radius: float
    tilt: float
    cone: float
    gravity: float
    # masses, and integrals over a blade: force, moment, mass, stiffening
    rotor_mass: float
    first_moment: float
    rotor_inertia: float
    generator_inertia: float
    of_flap: Floats
    of_edge: Floats
    flap_rate: float
    edge_rate: float
    blade_damping: float
    shaft_stiffness: float
    shaft_damping: float
    top_mass: float
    tower_rate: float
    tower_damping: float
    imbalance: float
    pitch_errors: Floats
    blades_move: bool
    tower_moves: bool
    torsion: bool
    frozen: bool
    # mean wind, its power law and the tower in it
    wind_speed: float
    hub_height: float
    shear: float
    shadow: bool
    overhang: float
    tower_height: float
    tower_foot: float
    tower_head: float


class Control(NamedTuple):
    """The controller; see `Controller` and `Tuning`."""

    optimal: float
    slope: float
    origin: float
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


PSI, SPEED, TWIST, GENERATOR, FORE, FORE_RATE, SIDE, SIDE_RATE, FLAP, FLAP_RATE, EDGE, EDGE_RATE = (
    *range(8),
    8,
    11,
    14,
    17,
)
STATES = 20
"""Entries of the state; three of each of the last four."""


@njit(cache=True)
def coefficients(parts: Parts, attack: float) -> tuple[float, float]:
    """Lift and drag, as `aero_rotor.polar`."""
    from_zero = attack - parts.zero_lift
    past = (abs(from_zero) - (parts.stall - parts.zero_lift)) / parts.stall_width
    fade = math.exp(-abs(past))
    attached = math.sqrt(1.0 - 0.3 * fade if past <= 0.0 else 0.04 + 0.66 * fade)
    full = parts.lift_slope * math.sin(from_zero)
    normal = full * (0.5 * (1.0 + attached)) ** 2
    sin, cos = math.sin(attack), math.cos(attack)
    suction = full * sin * attached
    return normal * cos + suction * sin, parts.drag + normal * sin - suction * cos


@njit(cache=True)
def slowed(parts: Parts, radius: float, azimuth: float) -> float:
    """Share of the wind that is left before the tower: flow about a cylinder (no wake)."""
    height = parts.hub_height + radius * math.cos(azimuth) * math.cos(parts.tilt)
    if height > parts.tower_height or math.cos(azimuth) > 0.0:
        return 1.0
    size = parts.tower_foot + (parts.tower_head - parts.tower_foot) * height / parts.tower_height
    across = radius * math.sin(azimuth)
    before = parts.overhang * math.cos(parts.tilt)
    before -= radius * math.cos(azimuth) * math.sin(parts.tilt + parts.cone)
    square = before**2 + across**2
    return 1.0 - size**2 * (before**2 - across**2) / square**2


@njit(cache=True)
def met_wind(parts: Parts, turbulence: Floats, azimuth: float, wind: Floats, waves: Floats) -> None:
    """Horizontal wind (3, r) at the elements of the blades, from harmonics (2 M + 1, r)."""
    harmonics = (turbulence.shape[0] - 1) // 2
    for blade in range(3):
        angle = azimuth + 2.0 * math.pi * blade / 3.0
        cos, sin = math.cos(angle), math.sin(angle)
        waves[0] = 1.0
        c, s = 1.0, 0.0
        for m in range(1, harmonics + 1):
            c, s = c * cos - s * sin, s * cos + c * sin
            waves[m] = c
            waves[harmonics + m] = s
        for i in range(parts.radius.size):
            height = parts.hub_height + parts.radius[i] * cos * math.cos(parts.tilt)
            wind[blade, i] = parts.wind_speed * (height / parts.hub_height) ** parts.shear
        for m in range(turbulence.shape[0]):
            for i in range(parts.radius.size):
                wind[blade, i] += waves[m] * turbulence[m, i]
        if parts.shadow:
            for i in range(parts.radius.size):
                wind[blade, i] *= slowed(parts, parts.radius[i], angle)


@njit(cache=True)
def blade_sums(
    parts: Parts, state: Floats, pitch: float, wind: Floats, induced: Floats, sums: Floats
) -> None:
    """Forces of the air on each blade.

    Sums over a blade (3, 6): force and moment out of the plane of rotation, on the flap mode;
    force and torque in the plane, on the edge mode; then means over blades by element
    (2, r) behind them: force out of and in the plane per length.
    """
    for j in range(sums.shape[0]):
        for i in range(sums.shape[1]):
            sums[j, i] = 0.0
    cos_tilt, sin_tilt = math.cos(parts.tilt), math.sin(parts.tilt)
    for blade in range(3):
        angle = state[PSI] + 2.0 * math.pi * blade / 3.0
        turn = pitch + parts.pitch_errors[blade]
        cos, sin = math.cos(angle), math.sin(angle)
        for i in range(parts.radius.size):
            r = parts.radius[i]
            through = wind[blade, i] * cos_tilt - induced[0, i]
            through -= state[FLAP_RATE + blade] * parts.flap[i] + state[FORE_RATE]
            along = state[SPEED] * r + induced[1, i] + wind[blade, i] * sin_tilt * sin
            along += state[EDGE_RATE + blade] * parts.edge[i] - state[SIDE_RATE] * cos
            attack = math.atan2(through, along) - parts.twist[i] - turn
            lift, drag = coefficients(parts, attack)
            speed = math.hypot(through, along)
            pressure = 0.5 * parts.density * parts.chord[i] * speed
            out = pressure * (lift * along + drag * through)
            drive = pressure * (lift * through - drag * along)
            w = parts.weight[i]
            sums[blade, 0] += w * out
            sums[blade, 1] += w * out * r
            sums[blade, 2] += w * out * parts.flap[i]
            sums[blade, 3] += w * drive
            sums[blade, 4] += w * drive * r
            sums[blade, 5] += w * drive * parts.edge[i]
            sums[3, i] += out / 3.0
            sums[4, i] += drive / 3.0


@njit(cache=True)
def moving(
    parts: Parts, state: Floats, sums: Floats, torque: float, rates: Floats, loads: Floats
) -> None:
    """Rates of the state, and loads of the rotor on the shaft.

    With S0, S1, M and N the integrals of a mode (`ModeIntegrals`), A the force of the air on it,
    W the speed of rotation, x and y the hub's motion, cone b and tilt t, blade i at psi:

    flap: M (f'' + 2 z w f') + (M w^2 + W^2 N) f = A + S0 g sin t + b (W^2 S1 - S0 g cos t cos psi)
    - S0 x''; edge: M (e'' + 2 z w e') + (M w^2 + W^2 (N - M)) e = A + S0 g cos t sin psi - S1 W'
    + S0 y'' cos psi; rotor: J W' + S1 sum e'' = torque of air, of weights less that of the shaft;
    tower: m x'' + ... = thrust - S0 sum f''.
    """
    cos_tilt, sin_tilt = math.cos(parts.tilt), math.sin(parts.tilt)
    g, speed = parts.gravity, state[SPEED]
    for j in range(STATES):
        rates[j] = 0.0
    rates[PSI] = speed
    thrust = sums[0, 0] + sums[1, 0] + sums[2, 0]
    drive = sums[0, 4] + sums[1, 4] + sums[2, 4]
    sin1, cos1 = math.sin(state[PSI]), math.cos(state[PSI])
    drive += parts.imbalance * g * cos_tilt * sin1

    # flap and fore-aft
    force, moment, mass, stiffening = parts.of_flap
    flap = np.zeros(3)
    fore_mass = parts.top_mass
    fore = thrust
    if parts.blades_move:
        w = parts.flap_rate
        for i in range(3):
            angle = state[PSI] + 2.0 * math.pi * i / 3.0
            own = sums[i, 2] + force * g * sin_tilt
            own += parts.cone * (speed**2 * moment - force * g * cos_tilt * math.cos(angle))
            own -= 2.0 * parts.blade_damping * w * mass * state[FLAP_RATE + i]
            own -= (mass * w**2 + speed**2 * stiffening) * state[FLAP + i]
            flap[i] = own
            fore -= force * own / mass
        fore_mass -= 3.0 * force**2 / mass
    x = 0.0
    if parts.tower_moves:
        w = parts.tower_rate
        fore -= parts.top_mass * (
            2.0 * parts.tower_damping * w * state[FORE_RATE] + w**2 * state[FORE]
        )
        x = fore / fore_mass
        rates[FORE] = state[FORE_RATE]
        rates[FORE_RATE] = x
    if parts.blades_move:
        for i in range(3):
            flap[i] = (flap[i] - force * x) / mass
            rates[FLAP + i] = state[FLAP_RATE + i]
            rates[FLAP_RATE + i] = flap[i]

    # shaft
    if parts.torsion:
        in_shaft = parts.shaft_stiffness * state[TWIST]
        in_shaft += parts.shaft_damping * (speed - state[GENERATOR])
        rates[TWIST] = speed - state[GENERATOR]
        rates[GENERATOR] = (in_shaft - torque) / parts.generator_inertia
        turning = drive - in_shaft
        inertia = parts.rotor_inertia
    else:
        in_shaft = 0.0
        turning = drive - torque
        inertia = parts.rotor_inertia + parts.generator_inertia

    # edge, speed and side
    force_e, moment_e, mass_e, stiffening_e = parts.of_edge
    edge = np.zeros(3)
    side = parts.imbalance * speed**2 * -sin1
    for i in range(3):
        side -= sums[i, 3] * math.cos(state[PSI] + 2.0 * math.pi * i / 3.0)
    side_mass = parts.top_mass
    if parts.blades_move:
        w = parts.edge_rate
        for i in range(3):
            angle = state[PSI] + 2.0 * math.pi * i / 3.0
            cos, sin = math.cos(angle), math.sin(angle)
            own = sums[i, 5] + force_e * g * cos_tilt * sin
            own -= 2.0 * parts.blade_damping * w * mass_e * state[EDGE_RATE + i]
            own -= (mass_e * w**2 + speed**2 * (stiffening_e - mass_e)) * state[EDGE + i]
            edge[i] = own
            turning += force_e * state[EDGE + i] * g * cos_tilt * cos - moment_e * own / mass_e
            side -= force_e * (speed**2 * state[EDGE + i] - own / mass_e) * cos
            side -= 2.0 * speed * force_e * state[EDGE_RATE + i] * sin
        inertia -= 3.0 * moment_e**2 / mass_e
        side_mass -= 1.5 * force_e**2 / mass_e
    faster = turning / inertia
    rates[SPEED] = faster
    if not parts.torsion:
        rates[GENERATOR] = faster
        in_shaft = torque + parts.generator_inertia * faster
    y = 0.0
    if parts.tower_moves:
        w = parts.tower_rate
        side -= parts.top_mass * (
            2.0 * parts.tower_damping * w * state[SIDE_RATE] + w**2 * state[SIDE]
        )
        side += parts.imbalance * faster * cos1
        y = side / side_mass
        rates[SIDE] = state[SIDE_RATE]
        rates[SIDE_RATE] = y
    if parts.blades_move:
        for i in range(3):
            cos = math.cos(state[PSI] + 2.0 * math.pi * i / 3.0)
            edge[i] = (edge[i] - moment_e * faster + force_e * y * cos) / mass_e
            rates[EDGE + i] = state[EDGE_RATE + i]
            rates[EDGE_RATE + i] = edge[i]

    # loads on the shaft
    weight = parts.rotor_mass * g
    loads[0] = thrust + weight * sin_tilt - parts.rotor_mass * x
    loads[1] = -parts.rotor_mass * y
    loads[2] = -weight * cos_tilt
    loads[3] = in_shaft
    loads[4] = -3.0 * parts.cone * parts.first_moment * g * cos_tilt
    loads[5] = 0.0
    for i in range(3):
        angle = state[PSI] + 2.0 * math.pi * i / 3.0
        cos, sin = math.cos(angle), math.sin(angle)
        loads[0] -= force * flap[i]
        along = sums[i, 3] - force_e * (edge[i] - speed**2 * state[EDGE + i])
        outward = 2.0 * speed * force_e * state[EDGE_RATE + i]
        loads[1] -= along * cos + outward * sin
        loads[2] -= along * sin - outward * cos
        bending = sums[i, 1] - moment * (flap[i] + speed**2 * state[FLAP + i])
        loads[4] += bending * cos + force * state[FLAP + i] * g * cos_tilt
        loads[5] += bending * sin
    loads[1] -= parts.imbalance * (speed**2 * sin1 - faster * cos1)
    loads[2] += parts.imbalance * (speed**2 * cos1 + faster * sin1)
    loads[4] += parts.imbalance * g * sin_tilt * cos1
    loads[5] += parts.imbalance * g * sin_tilt * sin1


@njit(cache=True)
def wake_answers(
    parts: Parts, state: Floats, sums: Floats, free: Floats, wake: Floats, step: float
) -> None:
    """Induced velocities (2, r) follow the loading (rows 2 and 3 of the wake are between).

    Momentum of an annulus with Prandtl's tip loss and Buhl's heavy loading, through two delays
    (Oye; Snel and Schepers 1995, ECN-C-94-107, section 3.4).
    """
    for i in range(parts.radius.size):
        r = parts.radius[i]
        wind = free[i] * math.cos(parts.tilt)
        through = max(wind - wake[0, i], 0.1 * wind)
        along = state[SPEED] * r + wake[1, i]
        sin = through / math.hypot(through, along)
        loss = 2.0 / math.pi * math.acos(math.exp(-1.5 * (parts.tip_radius - r) / (r * sin)))
        ring = 2.0 * math.pi * r * parts.density
        loading = 3.0 * sums[3, i] / (0.5 * ring * wind**2)
        if loading < 0.96 * loss:
            share = 0.5 * (1.0 - math.sqrt(1.0 - loading / loss))
        else:
            root = loading * (50.0 - 36.0 * loss) + 12.0 * loss * (3.0 * loss - 4.0)
            share = (18.0 * loss - 20.0 - 3.0 * math.sqrt(root)) / (36.0 * loss - 50.0)
        share = min(share, 0.9)
        asked = share * wind
        swirl = 3.0 * sums[4, i] / (2.0 * ring * through * loss)
        slow = 1.1 / (1.0 - 1.3 * min(share, 0.5)) * parts.tip_radius / wind
        fast = (0.39 - 0.26 * (r / parts.tip_radius) ** 2) * slow
        for k, goal in ((0, asked), (1, swirl)):
            wake[2 + k, i] = goal + (wake[2 + k, i] - goal) * math.exp(-step / slow)
            between = 0.6 * goal + 0.4 * wake[2 + k, i]
            wake[k, i] = between + (wake[k, i] - between) * math.exp(-step / fast)


@njit(cache=True)
def asked_torque(control: Control, speed: float, pitch: float) -> float:
    """As `Controller.torque`."""
    if speed >= control.torque_speed or pitch >= control.least_pitch:
        if control.constant_power:
            return control.rated_power / max(speed, 0.5 * control.rated_speed)
        return control.rated_torque
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
) -> tuple[Floats, Floats]:
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
        Between two samples [s].
    steps : int
        Of the integration in each.

    Returns
    -------
    ndarray, (n, 6)
        Loads at the hub [N, N m]; fewer rows where the rotor stopped or ran away.
    ndarray, (n, 4 + 20)
        Pitch [rad], torque of the generator [N m], power of the air [W], mean wind over the disc
        [m/s], the state.
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
                moving(parts, at, sums, torque, rate[stage], loads)
                for i in range(rings):
                    free[i] = parts.wind_speed * mean_shear[i] + now[0, i]
                if stage == 0 and part == 0:
                    for j in range(6):
                        made[n, j] = loads[j]
                    beside[n, 0], beside[n, 1] = pitch, torque
                    drive = sums[0, 4] + sums[1, 4] + sums[2, 4]
                    beside[n, 2] = drive * state[SPEED]
                    for i in range(rings):
                        beside[n, 3] += free[i] * parts.weight[i] * parts.radius[i] / area
                    for j in range(STATES):
                        beside[n, 4 + j] = state[j]
            if not parts.frozen:  # with the loading at the end of the step
                wake_answers(parts, at, sums, free, wake, step)
            for j in range(STATES):
                twice = 2.0 * (rate[1, j] + rate[2, j])
                state[j] += step / 6.0 * (rate[0, j] + twice + rate[3, j])
            if not math.isfinite(state[SPEED]) or state[SPEED] < 0.0:
                return made[: n + 1], beside[: n + 1]
    return made, beside
