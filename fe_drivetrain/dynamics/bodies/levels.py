"""One drivetrain at several levels: torsional, rigid bodies, flexible shafts.

All levels are of one table, with the same inertias, meshes and bearings, and of one assembly, so
that a level differs from the one below by nothing but the degrees of freedom that it lets move.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from math import cos, pi, radians, sin

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.gear_stages import ParallelData, PlanetaryData
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.dynamics.bodies.bodies import ALL, Body, Superelement, assemble
from fe_drivetrain.dynamics.bodies.elastic_ring import Rim, with_rim
from fe_drivetrain.dynamics.bodies.flexible import (
    Flexible,
    carrier_element,
    held_by,
    housing_bodies,
)
from fe_drivetrain.dynamics.bodies.machine_shafts import beam_shaft, solid_shaft
from fe_drivetrain.dynamics.bodies.planetary import (
    Inertias,
    PinBearing,
    PlanetarySet,
    bodies_of,
    equal_angles,
    in_bushings,
    springs_of,
)
from fe_drivetrain.dynamics.bodies.springs import (
    Place,
    Spring,
    bushing,
    gear_mesh,
)
from fe_drivetrain.dynamics.bodies.system import System, without_massless
from fe_drivetrain.dynamics.torsion.system import Element, Inertia, Torsional

TURNS = frozenset({"rx"})
"""Degree of freedom of a body in a torsional model."""


class Level(Enum):
    """Level of a drivetrain's model: what may move."""

    TORSIONAL = "torsional"
    """Each body turns about its axis; planets go with their carrier."""
    RIGID = "rigid bodies"
    """Each body has six degrees of freedom; a shaft is one beam, its mass at its ends."""
    FLEXIBLE = "flexible shafts"
    """Shafts have nodes between their ends, and bearings hold them where they are."""


@dataclass(frozen=True)
class Assembly:
    """Parts of a machine at one level, before it is one system.

    Attributes
    ----------
    bodies : list[Body]
        Bodies, from the rotor on.
    springs : list[Spring]
        Shafts, meshes, pins and bearings.
    seats : dict[str, tuple[str, tuple[float, float, float]]]
        Body that each bearing holds, and its place [m].
    superelements : list[Superelement]
        Superelements of flexible carriers, of shafts and of the housing.
    holders : dict[str, Place | None]
        Place that each bearing is held by; none is the ground.
    """

    bodies: list[Body]
    springs: list[Spring]
    seats: dict[str, tuple[str, tuple[float, float, float]]]
    superelements: list[Superelement]
    holders: dict[str, Place | None] = field(default_factory=dict)


def machine_system(
    machine: MachineTable,
    level: Level = Level.RIGID,
    azimuth: float | Mapping[int, float] = 0.0,
    elements: int = 6,
    held_generator: bool = False,
    flexible: Flexible | None = None,
) -> System:
    """The system of a machine, in the frame that stands still, carriers at one azimuth.

    Gyroscopic terms are those of the spinning bodies, at a reference speed that is the rotor's;
    those of planets on their turning carrier are left out, some 1e-4 of the stiffness at a rotor's
    speed.

    Parameters
    ----------
    machine : MachineTable
        Table of the machine.
    level : Level
        Level of the model: what may move.
    azimuth : float or mapping of int to float
        Azimuth of the rotor's shaft [rad], carriers behind it turning at their own ratios; or
        azimuths of carriers by the number of their stage, from 1, others being at 0.
    elements : int
        Number of beam elements of each flexible shaft, beside the stations of its bearings.
    held_generator : bool
        Whether the generator does not turn, for statics.
    flexible : Flexible, optional
        Carriers and housing that give.
    """
    found = assembly(machine, level, azimuth, elements, held_generator, flexible)
    return without_massless(assemble(found.bodies, found.springs, found.superelements))


def assembly(
    machine: MachineTable,
    level: Level = Level.RIGID,
    azimuth: float | Mapping[int, float] = 0.0,
    elements: int = 6,
    held_generator: bool = False,
    flexible: Flexible | None = None,
) -> Assembly:
    """Bodies and springs of a machine; arguments as in `machine_system`."""
    if level is not Level.TORSIONAL and machine.not_given:
        raise InputError(
            f"{machine.title!r} at level {level.value!r} needs what its file does not state: "
            f"{', '.join(machine.not_given)}: add it, or take level 'torsional'"
        )
    gives = flexible or Flexible()
    if level is Level.TORSIONAL:
        gives = Flexible()
    built, ends = bodies_and_stages(machine, level, azimuth, held_generator, gives)
    _add_shafts(machine, ends, level, elements, gives, built)
    _add_bearings(machine, gives, built)
    return built


def bodies_and_stages(
    machine: MachineTable,
    level: Level,
    azimuth: float | Mapping[int, float],
    held_generator: bool,
    gives: Flexible,
) -> tuple[Assembly, list[tuple[str, str]]]:
    """Bodies and the springs of stages, before there are shafts and bearings.

    Arguments as in `machine_system`; the names are those of the bodies that each shaft joins.
    """
    free = TURNS if level is Level.TORSIONAL else ALL
    built = Assembly([], [], {}, [])
    if gives.housing is not None:
        of_housing, condensed, mount = housing_bodies(gives.housing)
        built.bodies.extend(of_housing)
        built.superelements.extend(condensed)
        built.springs.extend(mount)
    mass, across = machine.rotor.apart
    built.bodies.append(
        Body("rotor", (0.0, 0.0, 0.0), mass, machine.rotor.inertia, across, 1.0, free)
    )
    driving, ends = "rotor", []
    for number in range(1, len(machine.stages) + 1):
        front, rear = _add_stage(machine, number, free, azimuth, gives, built)
        ends.append((driving, front))
        driving = rear
    _add_generator(machine, free, held_generator, built)
    ends.append((driving, "generator"))
    return built, ends


def _add_stage(
    machine: MachineTable,
    number: int,
    free: frozenset[str],
    azimuth: float | Mapping[int, float],
    gives: Flexible,
    built: Assembly,
) -> tuple[str, str]:
    """Add a stage's bodies and springs; the names of what the shafts before and behind it hold."""
    stage, name = machine.stages[number - 1], f"stage {number}"
    if not isinstance(stage, PlanetaryData):
        made, rows = _parallel(machine, stage, number, free)
        built.bodies.extend(made)
        built.springs.extend(rows)
        return f"{name} gear", f"{name} pinion"
    turned = (
        azimuth.get(number, 0.0)
        if isinstance(azimuth, Mapping)
        else azimuth * machine.speeds[number - 1]
    )
    planets, carrier = planetary_set(machine, number, free, turned), gives.carriers.get(number)
    planets = replace(planets, own=gives.bearings)
    pins: list[Body] = []
    if carrier is not None:
        pins, element, places = carrier_element(carrier, planets, f"{name} carrier")
        planets = replace(planets, pins=places)
        built.superelements.append(element)
    if stage.bushing is not None and free is not TURNS:
        bushed, rows, planets = in_bushings(planets, stage.bushing)
        pins += bushed
        built.springs.extend(rows)
    ground = held_by(gives.housing, f"{name} ring", planets.position)
    made, rows = _planetary(machine, stage, number, planets, ground, gives.rims.get(number))
    built.bodies.extend([*made, *pins])
    built.springs.extend(rows)
    return f"{name} carrier", f"{name} sun"


def _add_generator(
    machine: MachineTable, free: frozenset[str], held: bool, built: Assembly
) -> None:
    """Add the generator, and its spring to the grid."""
    x, y, z = machine.axes[-1]
    own = machine.generator
    moves = TURNS if own.mass is None else free
    at = (x + machine.shafts[-1].length, y, z)
    mass, across = own.apart
    moves = moves - TURNS if held else moves
    built.bodies.append(Body("generator", at, mass, own.inertia, across, machine.speeds[-1], moves))
    if own.stiffness > 0:
        grid, lost = (0, 0, 0, own.stiffness, 0, 0), (0, 0, 0, own.damping, 0, 0)
        built.springs.extend(bushing("grid", Place("generator", at), None, at, grid, lost))


def _add_shafts(
    machine: MachineTable,
    ends: Sequence[tuple[str, str]],
    level: Level,
    elements: int,
    gives: Flexible,
    built: Assembly,
) -> None:
    """Add shafts between the bodies that they hold, as beams or as solids."""
    bends, free = level is Level.FLEXIBLE, TURNS if level is Level.TORSIONAL else ALL
    for name in gives.shafts.keys() - {s.name for s in machine.shafts if s.kind == "shaft"}:
        raise InputError(
            f"no shaft {name!r} that bends is in {machine.title!r}: name another, or leave it out"
        )
    bodies = list(built.bodies)
    for k, shaft in enumerate(machine.shafts):
        if shaft.name in gives.shafts:
            if shaft.spline is not None:
                raise InputError(
                    f"shaft {shaft.name!r} has a spline, which a condensed shaft cannot have: "
                    "leave the condensed one out"
                )
            solid = gives.shafts[shaft.name]
            bodies, element = solid_shaft(machine, k, ends[k], bodies, solid, built.seats)
            built.superelements.append(element)
        else:
            bodies, rows = beam_shaft(
                machine, k, ends[k], bodies, bends, elements, free, built.seats
            )
            built.springs.extend(rows)
    built.bodies[:] = bodies


def _add_bearings(machine: MachineTable, gives: Flexible, built: Assembly) -> None:
    """Add the bearings, each between a body and what holds it."""
    known = {bearing.name for bearing in machine.bearings}
    known |= {spring.name.rpartition(" ")[0] for spring in built.springs if " pin " in spring.name}
    for name in sorted({*gives.bearings, *gives.apart} - known):
        raise InputError(
            f"no bearing {name!r} is in {machine.title!r}: name another, or leave it out"
        )
    centres = {body.name: body.position for body in built.bodies}
    shafts = {shaft.name for shaft in machine.shafts}
    for bearing in machine.bearings:
        if bearing.holds not in shafts:
            c = centres[bearing.holds]
            built.seats[bearing.name] = (bearing.holds, (c[0] + bearing.at, c[1], c[2]))
        body, at = built.seats[bearing.name]
        holder = None if bearing.name in gives.apart else held_by(gives.housing, bearing.name, at)
        built.holders[bearing.name] = holder
        place = Place(body, centres[body])
        stiffness = gives.bearings.get(bearing.name, bearing.stiffness)
        built.springs.extend(bushing(bearing.name, place, holder, at, stiffness))


def shaft_ends(machine: MachineTable, k: int) -> tuple[str, str]:
    """Bodies at the ends of a shaft by its number, from 0."""
    kinds = [stage.kind == "planetary" for stage in machine.stages]
    rears = [f"stage {n} {'carrier' if kind else 'gear'}" for n, kind in enumerate(kinds, 1)]
    fronts = [f"stage {n} {'sun' if kind else 'pinion'}" for n, kind in enumerate(kinds, 1)]
    return ["rotor", *fronts][k], [*rears, "generator"][k]


def is_bushed(machine: MachineTable, number: int) -> bool:
    """Whether the pins of a stage, by its number from 1, sit in bushings."""
    stage = machine.stages[number - 1]
    return isinstance(stage, PlanetaryData) and stage.bushing is not None


def planetary_set(
    machine: MachineTable, number: int, free: frozenset[str] = ALL, turned: float = 0.0
) -> PlanetarySet:
    """A machine's planetary stage by its number, from 1, with the first planet at an angle [rad].

    Raises
    ------
    InputError
        It is a parallel stage.
    """
    stage = machine.stages[number - 1]
    if not isinstance(stage, PlanetaryData):
        raise InputError(f"stage {number} of {machine.title!r} is parallel: name a planetary one")
    sun_mesh, ring_mesh = stage.meshes
    a, width = stage.centre_distance, stage.face_width
    planet_radius = a - stage.sun_radius
    inertias = {}
    for part, data, radius in (
        ("carrier", stage.carrier, a),
        ("planet", stage.planet, planet_radius),
        ("sun", stage.sun, stage.sun_radius),
    ):
        mass, across = data.inertias(radius, width)
        inertias[part] = Inertias(mass, data.inertia, across)
    ring = Inertias(0.0, 0.0)
    if stage.ring is not None:
        mass, across = stage.ring.inertias(a + planet_radius, width)
        ring = Inertias(mass, stage.ring.inertia, across)
    return PlanetarySet(
        f"stage {number}",
        a,
        stage.sun_radius,
        sun_mesh,
        ring_mesh,
        equal_angles(stage.planets, turned),
        inertias["carrier"],
        ring,
        inertias["sun"],
        inertias["planet"],
        stage.along_line(stage.sun_planet),
        stage.along_line(stage.ring_planet),
        tuple(PinBearing(p.stiffness, p.offset, p.name) for p in stage.pins),
        hand=stage.hand,
        driving=1 if machine.speeds[number - 1] > 0 else -1,
        slices=stage.slices,
        position=(machine.axes[number][0], *machine.axes[number - 1][1:]),
        free=free,
        sun_damping=stage.along_line(stage.sun_planet_damping),
        ring_damping=stage.along_line(stage.ring_planet_damping),
    )


def _planetary(
    machine: MachineTable,
    stage: PlanetaryData,
    number: int,
    built: PlanetarySet,
    ground: Place | None,
    rim: tuple[Rim, tuple[int, ...]] | None,
) -> tuple[list[Body], list[Spring]]:
    """The stage's bodies and springs."""
    bodies, torsional = [], built.free == TURNS
    for body in bodies_of(built, machine.speeds[number - 1]):
        moved = body
        if body.name.endswith("ring") and (stage.ring_support is None or torsional):
            host = None if ground is None or torsional else ground.body
            moved = replace(body, free=frozenset(), tied_to=host)
        elif torsional and "planet" in body.name:
            moved = replace(body, tied_to=f"stage {number} carrier")
        bodies.append(moved)
    springs = [s for s in springs_of(built) if not (torsional and " pin " in s.name)]
    if rim is not None:
        more, springs = with_rim(built, springs, *rim)
        bodies += more
    if stage.ring_support is not None and not torsional:
        place = Place(f"stage {number} ring", built.position)
        springs += bushing(
            f"stage {number} ring support", place, ground, place.centre, stage.ring_support
        )
    return bodies, springs


def _parallel(
    machine: MachineTable, stage: ParallelData, number: int, free: frozenset[str]
) -> tuple[list[Body], list[Spring]]:
    begin = machine.axes[number - 1]
    x = machine.axes[number][0]
    radius = stage.gear_radius
    gear_at, pinion_at = (x, begin[1], begin[2]), machine.axes[number]
    bodies = []
    for part, data, r, at, speed in (
        ("gear", stage.gear, radius, gear_at, machine.speeds[number - 1]),
        ("pinion", stage.pinion, stage.centre_distance - radius, pinion_at, machine.speeds[number]),
    ):
        mass, across = data.inertias(r, stage.face_width)
        name = f"stage {number} {part}"
        bodies.append(Body(name, at, mass, data.inertia, across, speed, free))
    out = np.array([0.0, cos(radians(stage.angle)), sin(radians(stage.angle))])
    mesh = stage.meshing
    springs = gear_mesh(
        f"stage {number} mesh",
        Place(bodies[0].name, gear_at),
        Place(bodies[1].name, pinion_at),
        np.asarray(gear_at) + radius * out,
        replace(mesh, base_helix=stage.hand * mesh.base_helix),
        stage.along_line(stage.stiffness),
        stage.along_line(stage.damping),
        1 if machine.speeds[number - 1] > 0 else -1,
        stage.slices,
    )
    return bodies, springs


def torsional(machine: MachineTable, held_generator: bool = False) -> Torsional:
    """The machine at the torsional level, for what `dynamics.torsion` does with one.

    Windings of meshes are along the lines of action [m/rad], so that their stiffness is in N/m;
    else these are the systems of `gear_masses` of a gear table with the planets' teeth.

    Parameters
    ----------
    machine : MachineTable
        Table of the machine.
    held_generator : bool
        Whether the generator does not turn.
    """
    system = machine_system(machine, Level.TORSIONAL, held_generator=held_generator)
    inertias = [
        Inertia(name.removesuffix(" rx"), float(J))
        for name, J in zip(system.names, system.mass.diagonal(), strict=True)
    ]
    parts = [part.name for part in inertias]
    elements = []
    springs = zip(system.spring_names, system.rows, system.stiffness, system.damping, strict=True)
    for name, row, k, c in springs:
        winding = {part: float(by) for part, by in zip(parts, row, strict=True) if by}
        if winding:
            elements.append(Element(name.removesuffix(" rx"), winding, float(k), float(c)))
    return Torsional(tuple(inertias), tuple(elements))


def steady_load(machine: MachineTable, system: System, torque: float, hub: Floats) -> Floats:
    """(n,) load of gravity, of the rotor's torque and of a wrench on the hub [N, N m].

    Parameters
    ----------
    machine : MachineTable
        Table of the machine whose rotor it is.
    system : System
        System of the machine.
    torque : float
        Torque on the rotor about x [N m].
    hub : ndarray, (6,)
        Other forces and moments on the rotor.
    """
    wrench = np.asarray(hub, dtype=float).copy()
    wrench[3] += torque
    return system.load_on("rotor", wrench) + system.gravity(np.array([0.0, 0.0, -GRAVITY]))


def azimuths(count: int) -> Floats:
    """(count,) equal steps of a turn, its end left out [rad]."""
    return np.arange(count) * 2 * pi / count
