"""Air on the blades of a turbine that moves, and its wake: compiled, for `turbine_kernel`."""

from __future__ import annotations

import math
from typing import NamedTuple

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.compiled import inner_loop, njit


class Parts(NamedTuple):
    """What the equations need, all in SI units."""

    # where the blade elements are, and what they are
    radius: Floats
    weight: Floats
    chord: Floats
    twist: Floats
    shape: Floats  # (2, 2, r), see `BladeModes`
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
    # masses, and the modes of a blade with their integrals, stiffness and damping
    rotor_mass: float
    first_moment: float
    rotor_inertia: float
    generator_inertia: float
    force: Floats
    moment: Floats
    products: Floats
    stiffening: Floats
    stiffness: Floats
    damping: Floats
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


PSI, SPEED, TWIST, GENERATOR, FORE, FORE_RATE, SIDE, SIDE_RATE = range(8)
MODES, RATES = 8, 11
"""Of blade i in mode a, at + 6 a + i."""
STATES = 20
SUMS = 8
"""Sums of the air over a blade, see `blade_sums`."""


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

    Sums over a blade (3, 8): force and moment out of the plane of rotation, force and torque in
    it, force on each mode, torsion at the root for each unit of a mode; then means over blades by
    element (2, r) behind them: force out of and in the plane per length.
    """
    for j in range(sums.shape[0]):
        for i in range(sums.shape[1]):
            sums[j, i] = 0.0
    cos_tilt, sin_tilt = math.cos(parts.tilt), math.sin(parts.tilt)
    for blade in range(3):
        angle = state[PSI] + 2.0 * math.pi * blade / 3.0
        turn = pitch + parts.pitch_errors[blade]
        cos, sin = math.cos(angle), math.sin(angle)
        c, s = math.cos(turn), math.sin(turn)
        for i in range(parts.radius.size):
            r = parts.radius[i]
            through = wind[blade, i] * cos_tilt - induced[0, i] - state[FORE_RATE]
            along = state[SPEED] * r + induced[1, i] + wind[blade, i] * sin_tilt * sin
            along -= state[SIDE_RATE] * cos
            for a in range(2):
                rate = state[RATES + 6 * a + blade]
                through -= rate * (parts.shape[a, 0, i] * c - parts.shape[a, 1, i] * s)
                along += rate * (parts.shape[a, 0, i] * s + parts.shape[a, 1, i] * c)
            attack = math.atan2(through, along) - parts.twist[i] - turn
            lift, drag = coefficients(parts, attack)
            speed = math.hypot(through, along)
            pressure = 0.5 * parts.density * parts.chord[i] * speed
            out = pressure * (lift * along + drag * through)
            drive = pressure * (lift * through - drag * along)
            w = parts.weight[i]
            sums[blade, 0] += w * out
            sums[blade, 1] += w * out * r
            sums[blade, 2] += w * drive
            sums[blade, 3] += w * drive * r
            for a in range(2):
                across = parts.shape[a, 0, i] * c - parts.shape[a, 1, i] * s
                beside = parts.shape[a, 0, i] * s + parts.shape[a, 1, i] * c
                sums[blade, 4 + a] += w * (out * across + drive * beside)
                sums[blade, 6 + a] += w * (out * beside - drive * across)
            sums[3, i] += out / 3.0
            sums[4, i] += drive / 3.0


@inner_loop(error_model="python")
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
