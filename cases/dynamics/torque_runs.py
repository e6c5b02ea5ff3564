"""Drivetrains in torsion on torque histories: two steps of a measurement, and generators.

A turbine's torque is measured on its low-speed shaft, and Al-Hamadani 2018 puts the measured
history on the rotor of a model. Both steps are made here: `measured` drives the masses with the
torque of the air and the generator that the turbine has, and gives the torque that a gauge on the
low-speed shaft would show; `driven` puts a torque on the rotor and holds the generator as the
thesis does. All motion is that beside steady turning at rated speed.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm

from fe_drivetrain.cases.dynamics.drivetrains import Rated, damped_masses, mean_torques, unit
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics import (
    Equations,
    Loads,
    Motion,
    SpringLaws,
    State,
    grid_spring,
    integrate,
    joined_laws,
    slip_line,
    summed,
    torsional_equations,
    varying,
    wind_up,
)
from fe_drivetrain.dynamics.torsion import Torsional, gear_speeds
from fe_drivetrain.turbine_loads.hub_loads import (
    Condition,
    Controller,
    Physics,
    Rotor,
    Turbine,
    TurbineHistory,
    designed_controller,
    similar_turbine,
    turbine_history,
)

WIND = 16.0
"""Mean wind of the thesis's history of normal operation (section 7.3) [m/s]."""
TURBULENCE, SHEAR = "medium", 0.2
SECONDS, SETTLED = 110.0, 20.0
"""Length of a history, and what is left out of it until its beginning is forgotten [s]."""
HOLD = 10.0
"""Time in which a converter's generator comes back to the speed of its controller [s]."""


class Air(NamedTuple):
    """What drives a turbine, over rated values of its rotor, each (n,).

    Attributes
    ----------
    times : ndarray
        Even steps [s].
    torque : ndarray
        Torque of the air.
    held : ndarray
        Torque of the generator that its controller asks for.
    speed : ndarray
        Speed.
    """

    times: Floats
    torque: Floats
    held: Floats
    speed: Floats


class Generator(NamedTuple):
    """How a model holds its generator.

    Attributes
    ----------
    name : str
        In words.
    slip : float
        Slip at rated torque of a line; 0 of a spring.
    stiffness : float
        Stiffness of a spring to the grid [N m/rad].
    """

    name: str
    slip: float = 0.0
    stiffness: float = 0.0

    def law(self, one: Rated, system: Torsional) -> SpringLaws:
        """Spring or line, of deviations from steady turning."""
        row = unit(system, "generator")
        if self.stiffness:
            return grid_spring(row, self.stiffness, 0.0, 1.0)[0]
        ratio = ratio_of(one)
        slope = one.torque / (self.slip * one.speed * ratio**2)
        return slip_line(row, 0.0, 0.0, slope)[0]

    def rated(self, one: Rated) -> float:
        """Torque on the generator beside the law, at rated torque of the rotor [N m]."""
        return 0.0 if self.stiffness else -one.torque / ratio_of(one)


class Driven(NamedTuple):
    """A drivetrain that was driven by a history.

    Attributes
    ----------
    one : Rated
        The drivetrain.
    system : Torsional
        Its masses.
    motion : Motion
        Motion beside steady turning.
    generator : Generator
        How the generator was held.
    """

    one: Rated
    system: Torsional
    motion: Motion
    generator: Generator

    @property
    def late(self) -> slice:
        """What is left when the beginning is forgotten."""
        return slice(int(np.searchsorted(self.motion.times, SETTLED - 1e-9)), None)

    def torque(self, element: str) -> Floats:
        """(k,) torque of an element over its torque at rated torque of the rotor."""
        k = [e.name for e in self.system.elements].index(element)
        rated = self.one.torque * mean_torques(self.system, ratio_of(self.one))[k]
        return np.asarray(self.motion.forces[:, k] / rated)

    def per_minute(self, mass: str) -> Floats:
        """(k,) speed of a mass [1/min], positive as it turns."""
        steady = self.one.speed * gear_speeds(self.one.table)[mass]
        rates = self.motion.velocity[:, self.system.place(mass)]
        return np.asarray((steady + rates) * np.sign(steady) * 30.0 / np.pi)

    def power(self) -> Floats:
        """(k,) power that the generator takes [W]."""
        held = -self.generator.rated(self.one) + self.motion.forces[:, len(self.system.elements)]
        ratio = ratio_of(self.one)
        speed = self.one.speed * ratio + self.motion.velocity[:, self.system.place("generator")]
        return np.asarray(held * speed)

    @property
    def mesh(self) -> str:
        """The first sun-planet mesh; the first mesh where there are no planets."""
        return mesh_of(self.system, self.one)


def mesh_of(system: Torsional, one: Rated) -> str:
    """The first sun-planet mesh of a drivetrain; its first mesh where there are no planets."""
    shafts = {shaft.name for shaft in one.table.shafts}
    names = [e.name for e in system.elements if e.name not in shafts]
    return next((name for name in names if "sun-planet" in name), names[0])


def ratio_of(one: Rated) -> float:
    """Speed of the generator over that of the rotor, with its sign."""
    return float(gear_speeds(one.table)["generator"])


def air_on(one: Rated, seed: int, wind_speed: float = WIND, turbulence: str = TURBULENCE) -> Air:
    """What drives a turbine of this power and speed in turbulent wind, see `moving_turbine`.

    Parameters
    ----------
    one : Rated
        Drivetrain, whose power and speed the turbine has.
    seed : int
        Seed of the wind.
    wind_speed : float
        Mean wind [m/s].
    turbulence : str
        "low", "medium" or "high".
    """
    made = _history(one.power, one.speed, Condition(wind_speed, turbulence, SHEAR, seed))
    return Air(
        made.history.time - made.history.time[0],
        made.power / made.rotor_speed / one.torque,
        made.generator_torque / one.torque,
        made.rotor_speed / one.speed,
    )


@cache
def _history(power: float, speed: float, condition: Condition) -> TurbineHistory:
    turbine, controller = _turbine(power, speed)
    return turbine_history(condition, turbine, controller, Physics(torsion=False), SECONDS)


@cache
def _turbine(power: float, speed: float) -> tuple[Turbine, Controller]:
    """A rotor similar to the generic one of 2 MW, its area in proportion to rated power."""
    usual = Rotor()
    size = (power / usual.rated_power) ** 0.5
    limit = speed * usual.radius * size
    rotor = Rotor(
        rated_power=power,
        radius=usual.radius * size,
        hub_height=usual.hub_height * size,
        rotor_mass=usual.rotor_mass * size**3,
        blade_start=usual.blade_start * size,
        tip_speed_limit=limit,
        # the wind of best efficiency at that speed stays, so that rated power is reached
        design_tip_speed_ratio=usual.design_tip_speed_ratio * limit / usual.tip_speed_limit,
    )
    turbine = similar_turbine(rotor)
    return turbine, designed_controller(turbine)


def measured(one: Rated, air: Air, dt: float, held: Generator | None = None) -> Driven:
    """Masses that the air drives; the generator is a converter's, or `held`.

    Parameters
    ----------
    one : Rated
        The drivetrain.
    air : Air
        What drives its rotor.
    dt : float
        Step [s].
    held : Generator, optional
        A generator on the grid; one behind a converter has the torque that the controller asks for,
        and a line so weak that it answers in `HOLD`.
    """
    system = damped_masses(one)
    ratio = ratio_of(one)
    if held is not None:
        return driven(one, air.times, air.torque, held, dt)
    inertia = float(system.J @ np.array(list(gear_speeds(one.table).values())) ** 2)
    slip = one.torque * HOLD / (one.speed * inertia)
    weak = Generator("converter", slip)
    slope = inertia / (HOLD * ratio**2)
    asked = slope * ratio * one.speed * (air.speed - 1.0) - one.torque / ratio * air.held
    on_generator = varying(unit(system, "generator"), air.times, asked)
    wind = varying(unit(system, "rotor"), air.times, one.torque * air.torque)
    return _run(one, system, weak, summed(wind, on_generator), dt)


def driven(one: Rated, times: Floats, torque: Floats, held: Generator, dt: float) -> Driven:
    """Masses with a torque on the rotor.

    Parameters
    ----------
    one : Rated
        The drivetrain.
    times, torque : ndarray, (n,)
        History of the torque on the rotor, over rated [s], [-].
    held : Generator
        The generator.
    dt : float
        Step [s].
    """
    system = damped_masses(one)
    wind = varying(unit(system, "rotor"), times, one.torque * torque)
    beside = varying(unit(system, "generator"), [0.0], [held.rated(one)])
    return _run(one, system, held, summed(wind, beside), dt)


def _run(one: Rated, system: Torsional, held: Generator, acting: Loads, dt: float) -> Driven:
    equations = _equations(one, system, held)
    still = np.zeros(len(system.J))
    start = wind_up(equations, acting.at(0.0), still)
    motion = integrate(
        equations,
        acting,
        float(acting.times[-1]),
        dt,
        start=State(start.q, still, start.acceleration),
    )
    return Driven(one, system, motion, held)


def _equations(one: Rated, system: Torsional, held: Generator) -> Equations:
    chain = torsional_equations(system)
    law = held.law(one, system)
    return Equations(chain.mass, joined_laws(chain.springs, law), chain.damping, chain.extra)


def exact(of: Driven, times: Floats, torque: Floats, element: str) -> Floats:
    """Torque of an element over rated at the samples of a load of straight lines between them.

    By the matrix exponential of the state and the load in one step, which is exact for such a load.

    Parameters
    ----------
    of : Driven
        Drivetrain and generator; nothing else of it is used.
    times, torque : ndarray, (n,)
        History on the rotor, over rated, at even steps.
    element : str
        Name of the element.
    """
    one, system = of.one, of.system
    equations = _equations(one, system, of.generator)
    laws, n, h = equations.springs, len(system.J), float(times[1] - times[0])
    stiffness = laws.rows.T @ (laws.stiffness[:, None] * laws.rows)
    damping = laws.rows.T @ (laws.damping[:, None] * laws.rows)
    load = np.outer(unit(system, "rotor"), one.torque * torque).T
    load = load + of.generator.rated(one) * unit(system, "generator")
    root = np.sqrt(system.J)
    scaled = stiffness / np.outer(root, root)
    # displacements over the fastest mode's, so that both halves of the state are of one size
    fast = float(np.sqrt(np.linalg.eigvalsh(scaled)[-1]))
    A = np.zeros((4 * n, 4 * n))
    A[:n, n : 2 * n] = fast * np.eye(n)
    A[n : 2 * n, :n] = -scaled / fast
    A[n : 2 * n, n : 2 * n] = -damping / np.outer(root, root)
    A[n : 2 * n, 2 * n : 3 * n] = np.eye(n)
    A[2 * n : 3 * n, 3 * n :] = np.eye(n) / h
    step = expm(h * A)[: 2 * n]
    f = load / root
    state = np.zeros(2 * n)
    state[:n] = fast * root * wind_up(equations, load[0], np.zeros(n)).q
    found = np.empty((len(times), 2 * n))
    found[0] = state
    for k in range(len(times) - 1):
        state = step @ np.concatenate([state, f[k], f[k + 1] - f[k]])
        found[k + 1] = state
    k = [e.name for e in system.elements].index(element)
    q, v = found[:, :n] / (fast * root), found[:, n:] / root
    rated = one.torque * mean_torques(system, ratio_of(one))[k]
    return np.asarray((laws.stiffness[k] * q + laws.damping[k] * v) @ laws.rows[k] / rated)
