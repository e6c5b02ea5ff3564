"""A drivetrain in two stages of detail, as PROTEST 2010 has them, and a turbine that turns it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicSpline

from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.dynamics import Machine, damped_by_ratio, torsional
from fe_drivetrain.dynamics.torsion import (
    GENERATOR,
    ROTOR,
    Element,
    Inertia,
    Torsional,
    chain,
    modal_damping,
    natural_modes,
    static_stiffness,
)
from fe_drivetrain.procedure import driven_motions, element_torques
from fe_drivetrain.turbine_loads.hub_loads import (
    Controller,
    Rotor,
    Turbine,
    blade_modes,
    designed_controller,
    similar_turbine,
)

SHAFTS = "shafts"
RATIO = 0.01  # of critical damping, of each shaft and mesh
RATE = 100.0  # Hz
SETTLED = 60.0  # s, left out at the beginning
PITCH_ERRORS = (math.radians(0.3), 0.0, math.radians(-0.3))
"""Pitch of blades 3, 1 and 2 of the report, beyond the controller's: blade 3 is blade 1 here."""
SURPLUS = 0.01
"""Share of its mass that blade 3 of the report is heavier by."""


def off_grid(machine: Machine) -> Torsional:
    """The machine in torsion, its generator with a torque in place of the grid's spring."""
    free = machine.generator.model_copy(update={"stiffness": 0.0})
    system = torsional(machine.model_copy(update={"generator": free}))
    return damped_by_ratio(system, {element.name: RATIO for element in system.elements})


@dataclass(frozen=True)
class Stages:
    """A drivetrain in two stages of detail.

    Attributes
    ----------
    simple : Torsional
        Stage 1: rotor, total stiffness and damping, and all other inertias in one body behind the
        gear ratio; angles are those of the rotor's side.
    detailed : Torsional
        Stage 2: a body each for generator and all gears, shafts and meshes as springs.
    ratio : float
        Speed of the generator over that of the rotor.
    low, high : str
        Names of the main shaft and of the high-speed shaft in stage 2.
    """

    simple: Torsional
    detailed: Torsional
    ratio: float
    low: str
    high: str

    @property
    def inertias(self) -> tuple[float, float]:
        """Inertia of the rotor, and of all else as the rotor feels it [kg m^2]."""
        front, rear = self.simple.J
        return float(front), float(rear)

    @property
    def shaft(self) -> Element:
        """Spring and damper of stage 1."""
        return self.simple.elements[0]


def stages_of(machine: Machine, ratio: float) -> Stages:
    """Both stages of a drivetrain whose generator is free to turn.

    The total stiffness of stage 1 is that of stage 2 with the generator blocked; a damper beside
    the main shaft gives the first mode its damping ratio, as all of a turbine's parts and its
    controls do together.

    Parameters
    ----------
    machine : Machine
        The drivetrain.
    ratio : float
        Damping ratio of the first mode.
    """
    detailed = _damped(off_grid(machine), machine.shafts[0].name, ratio)
    modes = natural_modes(detailed)
    at = detailed.names.index(ROTOR)
    turning = modes.shapes[:, 0] / modes.shapes[at, 0]
    front = float(detailed.J[at])
    rear = float(turning @ detailed.M @ turning) - front
    stiffness = static_stiffness(detailed, ROTOR, GENERATOR)
    reduced = front * rear / (front + rear)
    damping = 2.0 * float(modal_damping(detailed)[1]) * math.sqrt(stiffness * reduced)
    simple = chain(
        [Inertia(ROTOR, front), Inertia(GENERATOR, rear)], [(SHAFTS, stiffness, damping)]
    )
    names = [shaft.name for shaft in machine.shafts]
    return Stages(simple, detailed, machine.speeds[-1], names[0], names[-1])


def _damped(system: Torsional, name: str, ratio: float) -> Torsional:
    """With what an element's damper has to have beside for a damping ratio of the first mode."""
    at = [element.name for element in system.elements].index(name)
    modes, known = natural_modes(system), float(modal_damping(system)[1])
    winding = float(system.B[at] @ modes.shapes[:, 1])
    more = 4.0 * math.pi * float(modes.frequencies[1]) * max(ratio - known, 0.0) / winding**2
    damper = system.elements[at]
    elements = list(system.elements)
    elements[at] = replace(damper, damping=damper.damping + more)
    return Torsional(system.inertias, tuple(elements))


def turbine_of(stages: Stages, power: float, speed: float) -> tuple[Turbine, Controller]:
    """A turbine whose drivetrain is stage 1, with the report's imbalance.

    Its rotor is that of the surrogate with its tip speed, of such a mass that its inertia is that
    of the drivetrain's file.

    Parameters
    ----------
    stages : Stages
        The drivetrain.
    power : float
        Rated power [W].
    speed : float
        Rated speed of the rotor [rad/s].
    """
    known = Rotor()
    size = known.tip_speed_limit / (speed * known.radius)
    rotor = replace(
        known,
        rated_power=power,
        radius=size * known.radius,
        hub_height=size * known.hub_height,
        blade_start=size * known.blade_start,
    )
    front, rear = stages.inertias
    rotor = replace(
        rotor, rotor_mass=rotor.rotor_mass * front / similar_turbine(rotor).rotor_inertia
    )
    plain = similar_turbine(
        rotor,
        rotor_inertia=front,
        generator_inertia=rear,
        shaft_stiffness=stages.shaft.stiffness,
        shaft_damping=stages.shaft.damping,
    )
    heavier = SURPLUS * blade_modes(plain).first_moment
    turbine = replace(plain, mass_imbalance=heavier, pitch_errors=PITCH_ERRORS)
    return turbine, designed_controller(turbine)


def balanced(turbine: Turbine) -> Turbine:
    """The same turbine with equal blades."""
    return replace(turbine, mass_imbalance=0.0, pitch_errors=(0.0, 0.0, 0.0))


def with_blades(system: Torsional, turbine: Turbine) -> Torsional:
    """A torsional system whose rotor has the edgewise mode of all blades together.

    A mode of mass M whose moment about the axis is R takes 3 R^2 / M of the rotor's inertia.
    """
    modes = blade_modes(turbine)
    moved = 3.0 * float(modes.moment[1, 1]) ** 2 / float(modes.mass[1, 1])
    rest = float(system.J[system.names.index(ROTOR)]) - moved
    if rest <= 0.0:
        raise InputError(
            f"blades of {3.0 * turbine.blade_mass:.4g} kg have more inertia in their edgewise mode "
            "than the rotor has: state the inertia of the rotor with its blades, as rotor.inertia"
        )
    stiffness = moved * (2.0 * math.pi * turbine.edge_frequency) ** 2
    blades = Element("edgewise mode", {"blades": 1.0, ROTOR: -1.0}, stiffness)
    others = [one for one in system.inertias if one.name != ROTOR]
    return Torsional(
        (Inertia("blades", moved), Inertia(ROTOR, rest), *others), (blades, *system.elements)
    )


@dataclass(frozen=True)
class Driving:
    """What drives a drivetrain [N m], at `RATE`: on the rotor, and of the generator at its side."""

    front: Floats
    braking: Floats
    shaft: Floats
    speed: Floats


def driving_of(
    loads: Floats, speed: Floats, braking: Floats, stages: Stages, rate: float = RATE
) -> Driving:
    """Torque on a rotor by that in its shaft and what speeds it up; the first sample in balance.

    Parameters
    ----------
    loads : ndarray, (n, 6)
        Loads of the rotor on the shaft [N, N m].
    speed, braking : ndarray, (n,)
        Speed of the rotor [rad/s], torque of the generator at the slow shaft [N m].
    stages : Stages
        The drivetrain.
    rate : float
        Samples a second [Hz].
    """
    time = np.arange(len(speed)) / rate
    faster = np.asarray(CubicSpline(time, speed)(time, 1))
    front = loads[:, 3] + stages.inertias[0] * faster
    held = braking.copy()
    held[0] = front[0]
    return Driving(front, held, loads[:, 3], speed)


@dataclass(frozen=True)
class Torques:
    """Torque of main and high-speed shaft over time, as the rotor feels them, and its speed."""

    low: Floats
    high: Floats
    speed: Floats


def simple_torques(stages: Stages, driving: Driving, step: float = 1.0 / RATE) -> Torques:
    """Torques of stage 1, whose gear ratio is rigid and without mass between: both are the same."""
    motions = driven_motions(stages.simple, np.array([driving.front, -driving.braking]), step)
    (torque,) = element_torques(stages.simple, motions)
    return Torques(torque, torque, motions.speed[0])


def detailed_torques(stages: Stages, driving: Driving, step: float = 1.0 / RATE) -> Torques:
    """Torques of stage 2."""
    system = stages.detailed
    torques = np.zeros((len(system.names), len(driving.front)))
    torques[system.names.index(ROTOR)] = driving.front
    torques[system.names.index(GENERATOR)] = -driving.braking / stages.ratio
    motions = driven_motions(system, torques, step)
    found = element_torques(system, motions)
    names = [element.name for element in system.elements]
    low, high = found[names.index(stages.low)], found[names.index(stages.high)]
    sign = np.sign([low.mean(), high.mean()])
    return Torques(
        sign[0] * low,
        sign[1] * high * abs(stages.ratio),
        motions.speed[system.names.index(ROTOR)],
    )
