"""Energy of a turbine that moves, and what changes it: compiled, beside `turbine_kernel`.

The equations of `moving` are Lagrange's of the energy that `stored` has, but for terms of second
order that they leave out (in symbols of its docstring):

- turning: torque d/dt(W q (G - N) q + 2 b W RX q) by which bent blades slow the rotor as it takes
  them along, in return for the centrifugal forces that bend them;
- leaning: side force FT q sin psi W' and torque FT q sin psi y'' of blades bent in the plane, which
  move the rotor's centre away from the axis;
- coned weight: torque b FX q g cos t sin psi of blades bent out of the plane.

So the work of these terms appears in the equations from nowhere, and has an account of its own.
"""

from __future__ import annotations

import math

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
    TWIST,
    Parts,
)

ENERGIES, WORKS = 8, 7
"""How many there are of each."""

IN_ROTOR, IN_GENERATOR, IN_TOP, IN_BLADES, IN_SHAFT, IN_BENDING, IN_TOWER, IN_HEIGHT = range(8)
"""Kinetic energy of rotor, generator, tower's top and what bending adds; strain; weights."""

OF_AIR, OF_GENERATOR, OF_DAMPERS, OF_PITCHING, OF_TURNING, OF_LEANING, OF_CONED_WEIGHT = range(7)


@inner_loop(error_model="python")
def turned(values: Floats, mode: int, angle: float) -> tuple[float, float]:
    """Components of a mode (2, 2) out of the plane of rotation and in it, after pitch."""
    c, s = math.cos(angle), math.sin(angle)
    one, other = values[mode, 0], values[mode, 1]
    return one * c - other * s, one * s + other * c


@inner_loop(error_model="python")
def in_plane_less_stiffening(parts: Parts, a: int, b: int, angle: float) -> float:
    """G - N of two modes after pitch [kg]."""
    c, s = math.cos(angle), math.sin(angle)
    of = parts.products[a, b]
    plane = s * s * of[0, 0] + s * c * (of[0, 1] + of[1, 0]) + c * c * of[1, 1]
    return float(plane - parts.stiffening[a, b])


@njit(cache=True)
def stored(parts: Parts, state: Floats, pitch: float, energy: Floats) -> None:
    """Energies [J] of a state, each in its place of (8,); that of weights is zero at rest."""
    weight = parts.gravity * math.cos(parts.tilt)
    speed, fore, side = state[SPEED], state[FORE_RATE], state[SIDE_RATE]
    cos1 = math.cos(state[PSI])
    energy[IN_ROTOR] = 0.5 * parts.rotor_inertia * speed**2
    energy[IN_GENERATOR] = 0.5 * parts.generator_inertia * state[GENERATOR] ** 2
    energy[IN_TOP] = 0.5 * parts.top_mass * (fore**2 + side**2)
    energy[IN_TOP] -= parts.imbalance * cos1 * side * speed
    energy[IN_SHAFT] = 0.5 * parts.shaft_stiffness * state[TWIST] ** 2 if parts.torsion else 0.0
    spring = parts.top_mass * parts.tower_rate**2
    energy[IN_TOWER] = 0.5 * spring * (state[FORE] ** 2 + state[SIDE] ** 2)
    energy[IN_HEIGHT] = parts.imbalance * weight * cos1
    energy[IN_BLADES] = energy[IN_BENDING] = 0.0
    if parts.blades_move:
        for i in range(3):
            add_blade(parts, state, pitch, i, energy)


@inner_loop(error_model="python")
def add_blade(parts: Parts, state: Floats, pitch: float, i: int, energy: Floats) -> None:
    """Add what bending of blade i is to kinetic energy, strain and height."""
    turn = pitch + parts.pitch_errors[i]
    angle = state[PSI] + 2.0 * math.pi * i / 3.0
    cos, sin = math.cos(angle), math.sin(angle)
    sin_weight = parts.gravity * math.sin(parts.tilt)
    weight = parts.gravity * math.cos(parts.tilt)
    speed, fore, side = state[SPEED], state[FORE_RATE], state[SIDE_RATE]
    for a in range(2):
        q, rate = state[MODES + 6 * a + i], state[RATES + 6 * a + i]
        out, along = turned(parts.force, a, turn)
        moment_out, moment_along = turned(parts.moment, a, turn)
        energy[IN_BENDING] += 0.5 * parts.stiffness[a] * q**2
        energy[IN_HEIGHT] -= (out * sin_weight + along * weight * sin) * q
        energy[IN_HEIGHT] += parts.cone * out * weight * cos * q
        energy[IN_BLADES] += rate * (out * fore - along * cos * side + moment_along * speed)
        energy[IN_BLADES] += q * speed * (along * sin * side + parts.cone * moment_out * speed)
        for b in range(2):
            mass = parts.products[a, b, 0, 0] + parts.products[a, b, 1, 1]
            centrifugal = speed**2 * in_plane_less_stiffening(parts, a, b, turn)
            energy[IN_BLADES] += 0.5 * mass * rate * state[RATES + 6 * b + i]
            energy[IN_BLADES] += 0.5 * centrifugal * q * state[MODES + 6 * b + i]


@njit(cache=True)
def powers(
    parts: Parts,
    state: Floats,
    rates: Floats,
    sums: Floats,
    pitch: float,
    torque: float,
    power: Floats,
) -> None:
    """Power [W] of what changes the energy, each in its place of (7,); pitching is by steps."""
    speed, fore, side = state[SPEED], state[FORE_RATE], state[SIDE_RATE]
    for k in range(WORKS):
        power[k] = 0.0
    power[OF_GENERATOR] = -torque * state[GENERATOR]
    tower = 2.0 * parts.tower_damping * parts.tower_rate * parts.top_mass
    power[OF_DAMPERS] = -tower * (fore**2 + side**2)
    if parts.torsion:
        power[OF_DAMPERS] -= parts.shaft_damping * (speed - state[GENERATOR]) ** 2
    for i in range(3):
        cos = math.cos(state[PSI] + 2.0 * math.pi * i / 3.0)
        power[OF_AIR] += sums[i, 0] * fore - sums[i, 2] * cos * side + sums[i, 3] * speed
        if parts.blades_move:
            for a in range(2):
                rate = state[RATES + 6 * a + i]
                power[OF_AIR] += sums[i, 4 + a] * rate
                power[OF_DAMPERS] -= parts.damping[a] * rate**2
            add_left_out(parts, state, rates, pitch, i, power)


@inner_loop(error_model="python")
def add_left_out(
    parts: Parts, state: Floats, rates: Floats, pitch: float, i: int, power: Floats
) -> None:
    """Add the power of what the equations leave out, of blade i."""
    turn = pitch + parts.pitch_errors[i]
    sin = math.sin(state[PSI] + 2.0 * math.pi * i / 3.0)
    speed, faster = state[SPEED], rates[SPEED]
    for a in range(2):
        q, rate = state[MODES + 6 * a + i], state[RATES + 6 * a + i]
        out, along = turned(parts.force, a, turn)
        coned = 2.0 * parts.cone * turned(parts.moment, a, turn)[0]
        power[OF_TURNING] += speed * coned * (faster * q + speed * rate)
        leaning = state[SIDE_RATE] * faster + speed * rates[SIDE_RATE]
        power[OF_LEANING] += along * q * sin * leaning
        weight = parts.gravity * math.cos(parts.tilt)
        power[OF_CONED_WEIGHT] -= speed * parts.cone * out * q * weight * sin
        for b in range(2):
            less = in_plane_less_stiffening(parts, a, b, turn)
            also = state[MODES + 6 * b + i]
            power[OF_TURNING] += speed * less * (faster * q + 2.0 * speed * rate) * also
