"""All that turns of a drivetrain as matrices for other programs, and its one torsional spring.

The matrices are those that `fe_drivetrain.modes` solves, at the same level and with the same names.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.metadata import version
from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_solve
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file import Drivetrain, Scene
from fe_drivetrain.dynamics import Level, Machine, System, machine_of, machine_system
from fe_drivetrain.dynamics.bodies.damping_ratios import with_damping_ratios
from fe_drivetrain.dynamics.bodies.gearbox_mount import stated_mount
from fe_drivetrain.dynamics.bodies.levels import torsional
from fe_drivetrain.dynamics.torsion import changed, natural_modes
from fe_drivetrain.export.formats.elastodyn import Torsion
from fe_drivetrain.report.seal import drivetrain_hash

FRAME = "x along the rotor's shaft downwind, z up, y = z cross x; origin at the rotor"
UNITS = "N/m, N, N m/rad; kg, kg m, kg m^2; N s/m, N s, N m s/rad"
EQUATION = (
    "M q'' + (C + W G) q' + K q = f, with W the rotor's speed in rad/s: the gyroscopic matrix is "
    "that of 1 rad/s"
)
GRID = "grid"
"""Name of the generator's spring to the grid."""

_NOT_HERE = {
    Level.TORSIONAL: "bearings, bending of shafts, and planets beside their carrier",
    Level.RIGID: "bending of shafts, carriers and housing that give, play and friction",
    Level.FLEXIBLE: "carriers and housing that give, play and friction",
}


class OneSpring(NamedTuple):
    """A drivetrain as the one torsional spring that aeroelastic programs have.

    Attributes
    ----------
    torsion : Torsion
        Spring [N m/rad] and damper [N m s/rad], on the rotor's side: `DTTorSpr` and `DTTorDmp`.
    gear_ratio : float
        Speed of the generator over the rotor's; negative where they turn in opposite senses.
    rotor, generator : float
        Inertias about their own shafts [kg m^2].
    free, held : float
        First torsional frequency of the whole drivetrain, without grid and with the generator
        held [Hz].
    free_of_two, held_of_two : float
        The same of rotor and generator on the one spring [Hz].
    """

    torsion: Torsion
    gear_ratio: float
    rotor: float
    generator: float
    free: float
    held: float
    free_of_two: float
    held_of_two: float

    @property
    def ratio(self) -> float:
        """Damping ratio of rotor and generator on the one spring, free-free."""
        return float(np.pi * self.free_of_two * self.torsion.damper / self.torsion.spring)


@dataclass(frozen=True)
class Turning:
    """Matrices of all that turns of a drivetrain at one level, and what they are of.

    Attributes
    ----------
    title, hash : str
        The drivetrain, and the hash of all its values, as results state them.
    program : str
        Name and version.
    options : dict of str to str
        What was asked for: level, generator.
    drivetrain : Drivetrain
        The drivetrain as its file states it.
    machine : Machine
        Bodies, shafts, stages and bearings.
    names : tuple of str
        Names (n,) of the degrees of freedom, body and motion: "rotor rx".
    mass, stiffness, damping, gyroscopic : ndarray (n, n)
        See `EQUATION` and `UNITS`.
    spring : OneSpring
        Its torsion as one spring.
    """

    title: str
    hash: str
    program: str
    options: dict[str, str]
    drivetrain: Drivetrain
    machine: Machine
    names: tuple[str, ...]
    mass: Floats
    stiffness: Floats
    damping: Floats
    gyroscopic: Floats
    spring: OneSpring
    not_here: str

    __repr__ = short_repr

    @property
    def matrices(self) -> dict[str, Floats]:
        """Matrices by name: mass, stiffness, damping, gyroscopic."""
        return {
            "mass": self.mass,
            "stiffness": self.stiffness,
            "damping": self.damping,
            "gyroscopic": self.gyroscopic,
        }

    def source(self) -> dict[str, str]:
        """What a file is of: title, hash, options and program, by key."""
        return {
            "program": self.program,
            "drivetrain": self.title,
            "drivetrain hash": self.hash,
            **self.options,
        }

    def statement(self) -> dict[str, str]:
        """What text formats state beside numbers, by key."""
        entries = {
            **self.source(),
            "frame": FRAME,
            "units": UNITS,
            "equation": EQUATION,
            "not in the model": self.not_here,
            **{key: repr(value) for key, value in self.spring_record().items()},
        }
        for number, name in enumerate(self.names, start=1):
            entries[f"degree of freedom {number}"] = name
        return {key: " ".join(value.split()) for key, value in entries.items()}

    def spring_record(self) -> dict[str, float]:
        """The one spring and its frequencies, by name with its unit."""
        one = self.spring
        return {
            "DTTorSpr [N m/rad]": one.torsion.spring,
            "DTTorDmp [N m s/rad]": one.torsion.damper,
            "gear ratio [-]": one.gear_ratio,
            "inertia of the rotor [kg m^2]": one.rotor,
            "inertia of the generator [kg m^2]": one.generator,
            "first torsional frequency, free-free [Hz]": one.free,
            "first torsional frequency, generator held [Hz]": one.held,
            "frequency of the one spring, free-free [Hz]": one.free_of_two,
            "frequency of the one spring, generator held [Hz]": one.held_of_two,
            "damping ratio of the one spring, free-free [-]": one.ratio,
        }


def turning_of(drivetrain: Drivetrain, level: Level, held: bool = False) -> Turning:
    """All that turns of a drivetrain as matrices.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain, with a rotor and a generator.
    level : Level
        What may move.
    held : bool
        Whether the generator is held.

    Raises
    ------
    InputError
        The drivetrain lacks data that the level needs; the message names them.
    """
    machine = machine_of(drivetrain)
    gives = stated_mount(drivetrain, machine)
    system = machine_system(machine, level, held_generator=held, flexible=gives)
    system = _damped(drivetrain, machine, system)
    housings = isinstance(drivetrain, Scene) and drivetrain.bearing_units
    not_here = _NOT_HERE[level]
    if housings and level is not Level.TORSIONAL:
        not_here += "; housings of main bearings are rigid"
    return Turning(
        title=drivetrain.title,
        hash=drivetrain_hash(drivetrain),
        program=f"fe-drivetrain {version('fe-drivetrain')}",
        options={"level": level.name.lower(), "generator": "held" if held else "free"},
        drivetrain=drivetrain,
        machine=machine,
        names=system.names,
        mass=system.mass,
        stiffness=system.K,
        damping=system.C,
        gyroscopic=system.gyroscopic,
        spring=one_spring(drivetrain, machine),
        not_here=not_here,
    )


def one_spring(drivetrain: Drivetrain, machine: Machine) -> OneSpring:
    """The torsion of a drivetrain as one spring and damper on the rotor's side.

    A torque on the rotor, the generator held, winds up shafts and meshes. The spring is torque over
    angle of the rotor, and the damper dissipates what all dampers do in that motion, at the same
    speed of the rotor. Inertias between rotor and generator are in neither.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain; of its damping ratios are the dampers.
    machine : Machine
        Its bodies, shafts and stages.

    Raises
    ------
    InputError
        All between rotor and generator is rigid.
    """
    system = machine_system(machine, Level.TORSIONAL, held_generator=True)
    torque = system.load_on("rotor", np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0]))
    if not torque.any():
        raise InputError(
            f"{machine.title!r} is rigid from the rotor to the generator: give a shaft its "
            "torsion, in N m/rad, or a mesh its stiffness"
        )
    damped = _damped(drivetrain, machine, system)
    wound = scaled_solve(system.K, torque)
    twist = float(torque @ wound)
    torsion = Torsion(1.0 / twist, float(wound @ damped.C @ wound) / twist**2)
    free = torsional(machine)
    if any(element.name == GRID for element in free.elements):
        free = changed(free, {GRID: 0.0})
    ratio, rotor, generator = (
        machine.speeds[-1],
        machine.rotor.inertia,
        machine.generator.inertia,
    )
    far = generator * ratio**2
    return OneSpring(
        torsion,
        ratio,
        rotor,
        generator,
        _first(natural_modes(free).frequencies),
        _first(natural_modes(torsional(machine, held_generator=True)).frequencies),
        _frequency(torsion.spring, rotor * far / (rotor + far)),
        _frequency(torsion.spring, rotor),
    )


def _damped(drivetrain: Drivetrain, machine: Machine, system: System) -> System:
    """The system with the damping ratios of the file, where it has them."""
    if drivetrain.damping is None:
        return system
    return with_damping_ratios(machine, system, drivetrain.damping)


def _first(frequencies: Floats) -> float:
    """The lowest frequency above 0 [Hz]."""
    return float(frequencies[frequencies > 0.0][0])


def _frequency(stiffness: float, inertia: float) -> float:
    return float(np.sqrt(stiffness / inertia) / (2.0 * np.pi))
