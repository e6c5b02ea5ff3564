"""A machine that runs: its equations of motion at a level, its ends, and what is read from it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.turning_parts import DampingRatios
from fe_drivetrain.dynamics.bodies.catalogue_seats import catalogued, without_housings
from fe_drivetrain.dynamics.bodies.damping_ratios import (
    ASSUMED_RATIOS,
    condensed_seconds,
    element_of,
    mesh_names,
    with_damping_ratios,
)
from fe_drivetrain.dynamics.bodies.equations import Equations
from fe_drivetrain.dynamics.bodies.flexible import Flexible, Housing
from fe_drivetrain.dynamics.bodies.gear_pairs import contact_ratios
from fe_drivetrain.dynamics.bodies.gearbox_mount import assumed_inertia, mass_inside
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system, shaft_ends
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.dynamics.bodies.meshing import machine_meshing, varying_equations
from fe_drivetrain.dynamics.bodies.steady_state import WoundUp, free_motions, wind_up
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.dynamics.time.running_rollers import RunningRollers, on_rollers
from fe_drivetrain.dynamics.time.steady_turning import Turning

LIGHT = 1e-3
"""Part of a rotor's mass that is left where loads at the hub hold what it takes, and of the mass in
a housing that it has where none is stated: their swings are then far above what is resolved."""

_ABOUT_AXIS = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0])


@dataclass(frozen=True)
class Running:
    """A machine at a level that turns steadily, before anything happens.

    Attributes
    ----------
    machine : Machine
        Table of the machine, its generator free of any grid.
    level : Level
        What may move.
    flexible : Flexible
        What gives beside shafts and bearings, such as the gearbox's housing on its mount.
    system : System
        System with its dampers.
    equations : Equations
        Equations of motion without the generator's law.
    turning : Turning
        Rated torque and speed.
    rotor_weight : float
        Weight of the rotor [N].
    rollers : RunningRollers or None
        Rollers of catalogued bearings, which act beside the equations; None where springs do.
    """

    __repr__ = short_repr

    machine: Machine
    level: Level
    flexible: Flexible
    system: System
    equations: Equations
    turning: Turning
    rotor_weight: float
    rollers: RunningRollers | None = None

    def row(self, body: str) -> Floats:
        """(n,) row to the angle of a body, and load of a unit torque on it.

        Raises
        ------
        InputError
            There is no such body.
        """
        return self.system.load_on(body, _ABOUT_AXIS)

    def disc(self, on: str) -> Floats:
        """(n,) row of a brake's disc on a body, or where a shaft of that name begins.

        Raises
        ------
        InputError
            There is neither a shaft nor a body of that name.
        """
        fronts = {
            shaft.name: shaft_ends(self.machine, k)[0]
            for k, shaft in enumerate(self.machine.shafts)
        }
        body = fronts.get(on, on)
        if body not in self.system.bodies:
            raise InputError(
                f"a brake on {on!r}: there is no such shaft or body; use one of "
                f"{', '.join((*fronts, 'generator'))}"
            )
        row = self.row(body)
        if not row.any():
            raise InputError(f"a brake on {on!r}, which does not turn: put it on another shaft")
        return row

    def wind_up(
        self, equations: Equations, load: Floats, velocity: Floats, time: float = 0.0
    ) -> WoundUp:
        """State without vibration, on rollers where the machine is on these.

        Parameters
        ----------
        equations : Equations
            Its equations of motion, with whatever laws act beside them.
        load, velocity : ndarray, (n,)
            Load, and velocities of steady turning.
        time : float
            Time [s].

        Raises
        ------
        InputError
            See `steady_state.wind_up`, or rollers find no equilibrium.
        """
        if self.rollers is None:
            return wind_up(equations, load, velocity, time=time)
        return self.rollers.wind_up(equations, load, velocity, time)

    @property
    def inertia(self) -> float:
        """Inertia of all that turns, referred to the rotor [kg m^2]."""
        v = self.turning.velocity / float(self.turning.to_rotor @ self.turning.velocity)
        return float(v @ self.equations.mass @ v)


def running(
    machine: Machine,
    level: Level,
    torque: float,
    rotor_speed: float,
    damping: DampingRatios = ASSUMED_RATIOS,
    *,
    backlash: float = 0.0,
    teeth: bool = False,
    hub_loads: bool = False,
    flexible: Flexible | None = None,
    rollers: bool = False,
) -> Running:
    """A machine that turns steadily at a level.

    Parameters
    ----------
    machine : Machine
        Table of the machine; a grid that holds its generator is left out.
    level : Level
        What may move.
    torque, rotor_speed : float
        Torque on the rotor that the generator holds, and speed of the rotor [N m, rad/s].
    damping : DampingRatios
        Dampers of springs for which the table gives none.
    backlash : float
        Backlash of all meshes along their lines of action [m].
    teeth : bool
        Whether the stiffness of meshes varies with the angle of their gears, as a square wave of
        the contact ratio; each mesh is then in one point.
    hub_loads : bool
        Whether loads will act that a history has at the hub: they hold what the rotor's mass takes
        already, so that the rotor keeps its polar inertia alone, and its weight.
    flexible : Flexible, optional
        What gives beside shafts and bearings. A gearbox housing without mass follows its mount at
        once; where meshes in it vary or part, it has a thousandth of the mass of what is inside,
        with which it follows as good as at once.

    Raises
    ------
    InputError
        Torque, speed or backlash is out of range, or teeth are asked for and gears lack data.
    """
    _check(torque, rotor_speed, backlash)
    free = machine.generator.model_copy(update={"stiffness": 0.0})
    machine = machine.model_copy(update={"generator": free})
    if teeth:
        # a wave in each slice would cost the square of their number
        one = tuple(stage.model_copy(update={"slices": 1}) for stage in machine.stages)
        machine = machine.model_copy(update={"stages": one})
    gives = flexible or Flexible()
    if rollers:
        gives = without_housings(gives, catalogued(machine))
    if teeth or backlash:
        gives = _with_light_housing(machine, gives)
    system = machine_system(machine, level, flexible=gives)
    whole = system.gravity(np.array([0.0, 0.0, -GRAVITY]))
    if hub_loads and level is not Level.TORSIONAL:
        system = _light_rotor(machine, system)
    system, found = with_damping_ratios(machine, system, damping), None
    if rollers:
        system, found = on_rollers(machine, level, gives, system)
    meshing = machine_meshing(machine, rotor_speed, contact_ratios(machine)) if teeth else {}
    equations = varying_equations(system, meshing, rotor_speed, by="angle")
    if backlash:
        equations = _with_backlash(machine, system, equations, backlash)
    if system.extra.any():
        condensed = condensed_seconds(machine, damping) * system.extra
        equations = replace(equations, damping=equations.damping + condensed)
    to_rotor = system.load_on("rotor", _ABOUT_AXIS)
    whole_springs = system if found is None else found.on_springs
    motion = free_motions(varying_equations(whole_springs, {}))[:, 0]
    velocity = rotor_speed * motion / float(to_rotor @ motion)
    return Running(
        machine,
        level,
        gives,
        system,
        equations,
        Turning(
            to_rotor,
            system.load_on("generator", _ABOUT_AXIS),
            torque,
            machine.speeds[-1],
            velocity,
            None if level is Level.TORSIONAL else whole,
        ),
        GRAVITY * machine.rotor.apart[0],
        found,
    )


def _with_light_housing(machine: Machine, gives: Flexible) -> Flexible:
    """What gives, with some mass of a housing without any: springs of its meshes may then change.

    A body without mass is eliminated by the stiffness of the springs on it.
    """
    housing = gives.housing
    if not isinstance(housing, Housing) or housing.mass > 0.0:
        return gives
    mass = LIGHT * mass_inside(machine)
    polar, transverse = assumed_inertia(machine, mass)
    some = replace(housing, mass=mass, polar=polar, transverse=transverse)
    return replace(gives, housing=some)


def _light_rotor(machine: Machine, system: System) -> System:
    """The system with a small part of its rotor's mass, and its polar inertia alone."""
    mass, across = machine.rotor.apart
    found, turned = system.mass.copy(), system.gyroscopic.copy()
    at = [system.place(f"rotor {motion}") for motion in ("ux", "uy", "uz", "ry", "rz")]
    found[at, at] -= (1.0 - LIGHT) * np.array([mass, mass, mass, across, across])
    turned[np.ix_(at[3:], at[3:])] = 0.0
    masses = system.body_mass.copy()
    masses[system.bodies.index("rotor")] -= (1.0 - LIGHT) * mass
    return replace(system, mass=found, gyroscopic=turned, body_mass=masses)


def _check(torque: float, rotor_speed: float, backlash: float) -> None:
    for name, value, unit in (
        ("rated torque of the rotor", torque, "N m"),
        ("rated speed of the rotor", rotor_speed, "rad/s"),
    ):
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g} {unit} but must be above 0 {unit}: change it")
    if not 0.0 <= backlash < 0.01:
        raise InputError(f"backlash is {backlash:g} m but must be from 0 to 0.01 m: change it")


def _with_backlash(
    machine: Machine, system: System, equations: Equations, backlash: float
) -> Equations:
    meshes = set(mesh_names(machine))
    half = np.zeros(len(system.spring_names))
    for name in system.spring_names:
        if element_of(name) in meshes:
            half[system.changeable(name)] = 0.5 * backlash
    springs = replace(equations.springs, lower=-half, upper=half)
    return replace(equations, springs=springs)
