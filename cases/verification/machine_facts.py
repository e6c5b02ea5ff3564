"""What every drivetrain must do, of its table alone, beside what the program makes of it."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import pi
from typing import TypeVar

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import min_eigenvalue, symmetry_error
from fe_drivetrain.drivetrain_file.gear_stages import ParallelData, PlanetaryData
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.turning_parts import RotorBody, ShaftData
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.static import static
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.dynamics.torsion.gear_table import (
    GearTable,
    PlanetaryStage,
    gear_masses,
    stage_masses,
)
from fe_drivetrain.dynamics.torsion.system import Torsional, natural_modes

EPS = float(np.finfo(float).eps)
#: Roundings of a motion, of a mode or of an equilibrium, each of n numbers.
ROUNDINGS = 1e3
TORQUE = 1e6  # N m

T = TypeVar("T")


@dataclass(frozen=True)
class Fact:
    """Something that holds but for round-off.

    Attributes
    ----------
    name : str
        What it is.
    error : float
        How far it is from being so.
    within : float
        What round-off may leave.
    """

    name: str
    error: float
    within: float

    @property
    def holds(self) -> bool:
        """Whether it does; what is no number does not."""
        return bool(self.error <= self.within)


def own_ratios(machine: MachineTable) -> list[float]:
    """Speed of each shaft over the rotor's, of teeth, or of radii where there are none."""
    found = [1.0]
    for stage in machine.stages:
        if isinstance(stage, PlanetaryData):
            large, small = _sizes(stage)[0], _sizes(stage)[2]
            found.append(found[-1] * (1 + large / small))
        else:
            large, small = stage.teeth or stage.radii or (1, 1)
            found.append(-found[-1] * large / small)
    return found


def _sizes(stage: PlanetaryData) -> tuple[float, float, float]:
    """Sizes of ring, planet and sun: teeth, or radii where they sum to the centre distance."""
    if stage.teeth is not None:
        ring, planet, sun = stage.teeth
        return ring, planet, sun
    of_sun, of_planet = stage.radii or (1.0, 1.0)
    return of_sun + 2 * of_planet, of_planet, of_sun


def own_motion(machine: MachineTable, names: tuple[str, ...]) -> Floats:
    """(n,) motion by degree of freedom as the rotor turns by 1 rad: planets go round with it."""
    ratios = own_ratios(machine)
    turn = {"rotor": 1.0, "generator": ratios[-1]}
    moved: dict[str, tuple[float, float]] = {}
    for number, stage in enumerate(machine.stages, start=1):
        name, front, rear = f"stage {number}", ratios[number - 1], ratios[number]
        if isinstance(stage, ParallelData):
            turn |= {f"{name} gear": front, f"{name} pinion": rear}
            continue
        ring, planet, _ = _sizes(stage)
        turn |= {f"{name} carrier": front, f"{name} sun": rear}
        for k in range(stage.planets):
            psi, a = 2 * pi * k / stage.planets, stage.centre_distance
            turn[f"{name} planet {k + 1}"] = front * (1 - ring / planet)
            moved[f"{name} planet {k + 1}"] = (
                -front * a * float(np.sin(psi)),
                front * a * float(np.cos(psi)),
            )
    q = np.zeros(len(names))
    for i, label in enumerate(names):
        body, _, motion = label.rpartition(" ")
        if motion == "rx":
            q[i] = turn.get(body, 0.0)
        elif motion in ("uy", "uz") and body in moved:
            q[i] = moved[body][motion == "uz"]
    return q


def _uniform_lengths(shaft: ShaftData) -> list[tuple[float, float, float]]:
    """Length, outer and inner diameter of each uniform part of a shaft that has a mass [m]."""
    if shaft.sections is not None:
        return [(s.length, s.outer_diameter, s.inner_diameter) for s in shaft.sections]
    return [] if shaft.outer is None else [(shaft.length, shaft.outer, shaft.inner)]


def own_energy(machine: MachineTable) -> float:
    """Kinetic energy [J] at 1 rad/s of the rotor: sum of J (ratio w)^2 / 2, planets' paths."""
    ratios = own_ratios(machine)
    twice = machine.rotor.inertia + machine.generator.inertia * ratios[-1] ** 2
    for shaft, speed in zip(machine.shafts, ratios, strict=True):
        for length, outer, inner in _uniform_lengths(shaft):
            polar = pi / 32 * (outer**4 - inner**4)
            twice += shaft.material.density * length * polar * speed**2
    for stage, front, rear in zip(machine.stages, ratios, ratios[1:], strict=False):
        if isinstance(stage, ParallelData):
            twice += stage.gear.inertia * front**2 + stage.pinion.inertia * rear**2
            continue
        ring, planet, sun = _sizes(stage)
        a = stage.centre_distance
        mass = _mass(stage.planet, a * planet / (sun + planet))
        own = stage.planet.inertia * (1 - ring / planet) ** 2 + mass * a**2
        twice += (stage.carrier.inertia + stage.planets * own) * front**2
        twice += stage.sun.inertia * rear**2
    return twice / 2


def _mass(body: RotorBody, radius: float) -> float:
    return 2 * body.inertia / radius**2 if body.mass is None else body.mass


def machine_facts(machine: MachineTable) -> list[Fact]:
    """Facts of a machine at the torsional level and as rigid bodies.

    Parameters
    ----------
    machine : MachineTable
        From the gate, or, as a control, without it.
    """
    free = 0 if machine.generator.stiffness > 0 else 1
    found: list[Fact] = []
    for level in (Level.TORSIONAL, Level.RIGID):
        system = machine_system(machine, level)
        facts = [*_of_matrices(system), *_of_modes(system, free)]
        facts += _of_turning(machine, system, level)
        found += [replace(fact, name=f"{level.value}: {fact.name}") for fact in facts]
    return [*found, _power(machine)]


def _of_matrices(system: System) -> list[Fact]:
    n = len(system.names)
    M, K = system.mass, system.K
    return [
        Fact("mass is symmetric", symmetry_error(M), ROUNDINGS * n * EPS),
        Fact("mass is positive", -min_eigenvalue(M), 0.0),
        Fact("stiffness is symmetric", symmetry_error(K), ROUNDINGS * n * EPS),
        Fact("stiffness is not negative", -min_eigenvalue(K), ROUNDINGS * n * EPS),
    ]


def _of_modes(system: System, free: int) -> list[Fact]:
    n = len(system.names)
    modes = system_modes(system)
    omega, top = 2 * pi * modes.frequencies, 2 * pi * float(modes.frequencies.max())
    zero = ROUNDINGS * n * EPS * top
    # Rayleigh's quotient of each mode, by the springs and the masses
    wound = np.sqrt(system.stiffness)[:, None] * (system.rows @ modes.shapes)
    mass = np.einsum("im,ij,jm->m", modes.shapes, system.mass, modes.shapes)
    quotient = np.linalg.norm(wound, axis=0) / np.sqrt(mass)
    stiffer = system_modes(replace(system, stiffness=4 * system.stiffness)).frequencies
    return [
        Fact("frequencies are numbers", float(not np.isfinite(omega).all()), 0.0),
        Fact("motions of 0 Hz beside turning", float(abs(int((omega <= zero).sum()) - free)), 0.0),
        Fact("Rayleigh's quotients are frequencies", float(np.abs(quotient - omega).max()), zero),
        Fact(
            "four times the stiffness doubles frequencies",
            float(np.abs(2 * pi * stiffer - 2 * omega).max()),
            2 * zero,
        ),
    ]


def _of_turning(machine: MachineTable, system: System, level: Level) -> list[Fact]:
    q = own_motion(machine, system.names)
    felt = np.array([not name.startswith("grid") for name in system.spring_names])
    size = np.abs(system.rows) @ np.abs(q)
    wound = np.abs(system.rows @ q)[felt]
    most = float((wound / np.where(size[felt] > 0, size[felt], 1.0)).max(initial=0.0))
    energy = own_energy(machine)
    got = float(q @ system.mass @ q) / 2
    return [
        # radii of three digits may be a thousandth from the centre distance
        Fact("turning at the ratio of the teeth winds no spring", most, _rounded(machine)),
        Fact(
            f"kinetic energy of turning, {level.value}",
            abs(got / energy - 1),
            _rounded(machine) * 10,
        ),
    ]


def _rounded(machine: MachineTable) -> float:
    """Error of a ratio by round-off, or by radii of three digits beside the centre distance."""
    off = [
        min(abs(sum(stage.radii) / stage.centre_distance - 1), 1e-3)
        * stage.centre_distance
        / min(stage.radii)
        for stage in machine.stages
        if stage.radii is not None
    ]
    return ROUNDINGS * EPS + 4 * sum(off)


def _power(machine: MachineTable) -> Fact:
    """Torque on the generator's spring times the ratio of the teeth is that on the rotor."""
    held = machine.generator.model_copy(update={"stiffness": 1e8})
    table = MachineTable.model_validate({**dict(machine), "generator": held})
    system = machine_system(table, Level.RIGID)
    load = system.load_on("rotor", np.array([0, 0, 0, TORQUE, 0, 0]))
    # what statics refuses is refused with one sentence: no answer, and none wrong
    try:
        torque = static(system, load).force("grid rx")
    except InputError:
        return Fact("power balance", 0.0, 0.0)
    values = np.linalg.eigvalsh(_unit(system.K))
    lost = ROUNDINGS * EPS * float(values[-1] / max(values[0], EPS))
    error = abs(torque * own_ratios(machine)[-1] / TORQUE - 1)
    return Fact("power balance", error, min(lost, 1e-3) + _rounded(machine))


def _unit(K: Floats) -> Floats:
    root = np.sqrt(K.diagonal())
    return np.asarray(K / np.outer(root, root))


def table_facts(table: GearTable) -> list[Fact]:
    """Facts of a gear table with a mass for each gear, and for each stage."""
    ratios, twice = [1.0], table.rotor
    speeds = {"rotor": 1.0}
    for number, stage in enumerate(table.stages, start=1):
        name, front = f"stage {number}", ratios[-1]
        large, small = stage.teeth or (stage.ratio or 0.0, 1.0)
        if isinstance(stage, PlanetaryStage):
            ratio = 1 + large / small if stage.teeth else large
            ring = (ratio - 1) * small
            planet = stage.planet_teeth or (ring - small) / 2
            speeds |= {f"{name} carrier": front, f"{name} sun": front * ratio}
            for k in range(stage.planets):
                speeds[f"{name} planet {k + 1}"] = front * (1 - ring / planet)
            own = stage.carrier + stage.planets * stage.planet * (1 - ring / planet) ** 2
            twice += front**2 * (own + stage.sun * ratio**2)
            ratios.append(front * ratio)
        else:
            ratio = large / small
            speeds |= {f"{name} gear": front, f"{name} pinion": -front * ratio}
            twice += front**2 * (stage.gear + stage.pinion * ratio**2)
            ratios.append(-front * ratio)
    speeds["generator"] = ratios[-1]
    twice += ratios[-1] ** 2 * table.generator.inertia
    system = gear_masses(table, "free")
    q = np.array([speeds[name] for name in system.names])
    wound = np.abs(system.B @ q) / (np.abs(system.B) @ np.abs(q))
    return [
        Fact("turning winds no spring", float(wound.max()), ROUNDINGS * EPS),
        Fact("kinetic energy", abs(float(q**2 @ system.J) / twice - 1), ROUNDINGS * EPS),
        *_of_torsion(system, "a mass for each gear"),
        *_of_torsion(stage_masses(table, "free"), "a mass for each stage"),
    ]


def _of_torsion(system: Torsional, name: str) -> list[Fact]:
    modes = natural_modes(system)
    omega = 2 * pi * modes.frequencies
    zero = ROUNDINGS * len(omega) * EPS * float(omega.max())
    wound = np.linalg.norm(np.sqrt(system.k)[:, None] * (system.B @ modes.shapes), axis=0)
    return [
        Fact(f"{name}: frequencies are numbers", float(not np.isfinite(omega).all()), 0.0),
        Fact(f"{name}: motions of 0 Hz", float(abs(int((omega <= zero).sum()) - 1)), 0.0),
        Fact(f"{name}: Rayleigh's quotients", float(np.abs(wound - omega).max()), zero),
    ]


@dataclass(frozen=True)
class Outcome:
    """What became of a changed table.

    Attributes
    ----------
    refused : str
        The sentence that refused it; empty of one that was taken.
    wrong : tuple of str
        What is wrong with its answers, or with the way in which it was refused.
    """

    refused: str
    wrong: tuple[str, ...]


def tried(read: Callable[[], T], facts: Callable[[T], list[Fact]]) -> Outcome:
    """Read a table, and hold what was taken to its facts."""
    try:
        taken = read()
    except InputError as error:
        text = str(error)
        one = text.strip() and "\n" not in text and len(text) < 800
        return Outcome(text or "nothing", () if one else ("not refused with one sentence",))
    except Exception as error:  # the point of the exercise
        return Outcome("", (f"{type(error).__name__}: {error}"[:200],))
    try:
        wrong = [
            f"{fact.name}: {fact.error:.3g}, within {fact.within:.3g}"
            for fact in facts(taken)
            if not fact.holds
        ]
    except Exception as error:  # a table that was taken must be solved
        wrong = [f"taken, and then {type(error).__name__}: {error}"[:200]]
    return Outcome("", tuple(wrong))
