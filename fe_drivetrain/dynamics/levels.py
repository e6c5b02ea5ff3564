"""One drivetrain at several levels: torsional, rigid bodies, flexible shafts.

All levels are of one table, with the same inertias, meshes and bearings, and of one assembly, so
that a level differs from the one below by nothing but the degrees of freedom that it lets move.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from itertools import pairwise
from math import cos, pi, radians, sin

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies import ALL, Body, Superelement, assemble
from fe_drivetrain.dynamics.elastic_ring import Rim, with_rim
from fe_drivetrain.dynamics.flexible import (
    PLACED,
    Flexible,
    carrier_element,
    held_by,
    housing_bodies,
    shaft_element,
)
from fe_drivetrain.dynamics.machine_parts import STEEL, ShaftData
from fe_drivetrain.dynamics.machine_rows import MachineTable, ParallelData, PlanetaryData
from fe_drivetrain.dynamics.planetary import (
    Inertias,
    PinBearing,
    PlanetarySet,
    bodies_of,
    equal_angles,
    springs_of,
)
from fe_drivetrain.dynamics.springs import (
    Place,
    Spring,
    bushing,
    gear_mesh,
    uniform_shaft,
)
from fe_drivetrain.dynamics.system import System, without_massless
from fe_drivetrain.dynamics.torsion.system import Element, Inertia, Torsional
from fe_drivetrain.elasticity.solve.condensation import Condensed

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
    free = TURNS if level is Level.TORSIONAL else ALL
    gives = flexible or Flexible()
    bodies: list[Body] = []
    springs: list[Spring] = []
    superelements: list[Superelement] = []
    housing = None if level is Level.TORSIONAL else gives.housing
    if housing is not None:
        of_housing, element = housing_bodies(housing)
        bodies += of_housing
        superelements.append(element)
    mass, across = machine.rotor.apart
    bodies.append(Body("rotor", (0.0, 0.0, 0.0), mass, machine.rotor.inertia, across, 1.0, free))
    driving, ends = "rotor", []
    for number, stage in enumerate(machine.stages, start=1):
        name = f"stage {number}"
        turned = (
            azimuth.get(number, 0.0)
            if isinstance(azimuth, Mapping)
            else azimuth * machine.speeds[number - 1]
        )
        if isinstance(stage, PlanetaryData):
            carrier = None if level is Level.TORSIONAL else gives.carriers.get(number)
            built = planetary_set(machine, number, free, turned)
            if carrier is not None:
                pins, element, places = carrier_element(carrier, built, f"{name} carrier")
                built = replace(built, pins=places)
                superelements.append(element)
            ground = held_by(housing, f"{name} ring", built.position)
            rim = None if level is Level.TORSIONAL else gives.rims.get(number)
            made, rows = _planetary(machine, stage, number, built, ground, rim)
            if carrier is not None:
                made += pins
            front, rear = f"{name} carrier", f"{name} sun"
        else:
            made, rows = _parallel(machine, stage, number, free)
            front, rear = f"{name} gear", f"{name} pinion"
        bodies += made
        springs += rows
        ends.append((driving, front))
        driving = rear
    x, y, z = machine.axes[-1]
    own = machine.generator
    moves = TURNS if own.mass is None else free
    at = (x + machine.shafts[-1].length, y, z)
    mass, across = own.apart
    moves = moves - TURNS if held_generator else moves
    bodies.append(Body("generator", at, mass, own.inertia, across, machine.speeds[-1], moves))
    ends.append((driving, "generator"))
    if own.stiffness > 0:
        grid = (0, 0, 0, own.stiffness, 0, 0)
        springs += bushing("grid", Place("generator", at), None, at, grid)
    seats: dict[str, tuple[str, tuple[float, float, float]]] = {}
    solid = {} if level is Level.TORSIONAL else gives.shafts
    for name in solid.keys() - {shaft.name for shaft in machine.shafts if shaft.kind == "shaft"}:
        raise InputError(
            f"no shaft {name!r} that bends is in {machine.title!r}: name another, or leave it out"
        )
    for k, shaft in enumerate(machine.shafts):
        if shaft.name in solid:
            bodies, element = _solid_shaft(machine, k, ends[k], bodies, solid[shaft.name], seats)
            superelements.append(element)
            continue
        bodies, rows = _shaft(machine, k, ends[k], bodies, level, elements, seats)
        springs += rows
    centres = {body.name: body.position for body in bodies}
    shafts = {shaft.name for shaft in machine.shafts}
    holders: dict[str, Place | None] = {}
    for bearing in machine.bearings:
        if bearing.holds not in shafts:
            c = centres[bearing.holds]
            seats[bearing.name] = (bearing.holds, (c[0] + bearing.at, c[1], c[2]))
        body, at = seats[bearing.name]
        holders[bearing.name] = held_by(housing, bearing.name, at)
        place = Place(body, centres[body])
        springs += bushing(bearing.name, place, holders[bearing.name], at, bearing.stiffness)
    return Assembly(bodies, springs, seats, superelements, holders)


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
        mesh_damping=stage.mesh_damping,
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
        stage.along_line,
        stage.mesh_damping,
        1 if machine.speeds[number - 1] > 0 else -1,
        stage.slices,
    )
    return bodies, springs


def _shaft(
    machine: MachineTable,
    k: int,
    ends: tuple[str, str],
    bodies: list[Body],
    level: Level,
    elements: int,
    seats: dict[str, tuple[str, tuple[float, float, float]]],
) -> tuple[list[Body], list[Spring]]:
    """The shaft's nodes and springs, its mass, and what its bearings hold."""
    shaft = machine.shafts[k]
    x, y, z = machine.axes[k]
    on = [b for b in machine.bearings if b.holds == shaft.name]
    stations = [0.0, shaft.length]
    if level is Level.FLEXIBLE and shaft.kind == "shaft":
        own = {*np.linspace(0.0, shaft.length, elements + 1), *(b.at for b in on)}
        inside = [s for s in own if 0 <= s <= shaft.length]
        stations = sorted({round(s, 9) for s in inside} | {0.0, shaft.length})
    names = [ends[0], *(f"{shaft.name} node {i}" for i in range(1, len(stations) - 1)), ends[1]]
    speed = machine.speeds[k]
    if shaft.kind == "rigid":
        bodies = [
            replace(b, free=frozenset(), tied_to=ends[0]) if b.name == ends[1] else b
            for b in bodies
        ]
        seats.update({b.name: (ends[0], (x + b.at, y, z)) for b in on})
        return bodies, []
    bodies = [
        *bodies,
        *(
            Body(n, (x + s, y, z), speed=speed)
            for n, s in zip(names, stations, strict=True)
            if n not in ends
        ),
    ]
    index = {body.name: i for i, body in enumerate(bodies)}
    springs: list[Spring] = []
    for i, (start, stop) in enumerate(pairwise(stations)):
        pair = names[i], names[i + 1]
        label = shaft.name if len(stations) == 2 else f"{shaft.name} element {i + 1}"
        springs += _element(label, shaft, pair, (x + start, x + stop), (y, z), bodies, index)
        if shaft.has_mass:
            for name in pair:
                place = index[name]
                bodies[place] = _heavier(bodies[place], shaft, stop - start)
    for bearing in on:
        where = x + bearing.at
        nearest = min(range(len(stations)), key=lambda i: abs(stations[i] - bearing.at))
        seats[bearing.name] = (names[nearest], (where, y, z))
    return bodies, springs


def _solid_shaft(
    machine: MachineTable,
    k: int,
    ends: tuple[str, str],
    bodies: list[Body],
    body: Condensed,
    seats: dict[str, tuple[str, tuple[float, float, float]]],
) -> tuple[list[Body], Superelement]:
    """A condensed shaft's points, what joins them, and what its bearings hold."""
    shaft, begin = machine.shafts[k], machine.axes[k]
    centres = {one.name: one.position for one in bodies}
    first, last = (Place(name, centres[name]) for name in ends)
    points, element = shaft_element(
        shaft.name, body, begin, shaft.length, (first, last), shaft.has_mass
    )
    speed = machine.speeds[k]
    bodies = [*bodies, *(Body(p.body, p.centre, speed=speed) for p in points[1:-1])]
    along = np.sort(body.positions[:, 0]) - body.positions[:, 0].min()
    if shaft.has_mass and element.mass is None:
        index = {one.name: i for i, one in enumerate(bodies)}
        for pair, length in zip(pairwise(points), np.diff(along), strict=True):
            for point in pair:
                place = index[point.body]
                bodies[place] = _heavier(bodies[place], shaft, float(length))
    for bearing in machine.bearings:
        if bearing.holds == shaft.name:
            nearest = int(np.abs(along - bearing.at).argmin())
            if abs(along[nearest] - bearing.at) > PLACED * shaft.length:
                raise InputError(
                    f"shaft {shaft.name!r}: no point of its condensed body is at the bearing "
                    f"{bearing.name!r}, {bearing.at:g} m from its begin: condense it there, too"
                )
            x, y, z = begin
            seats[bearing.name] = (points[nearest].body, (x + bearing.at, y, z))
    return bodies, element


def _element(
    label: str,
    shaft: ShaftData,
    pair: tuple[str, str],
    span: tuple[float, float],
    axis: tuple[float, float],
    bodies: list[Body],
    index: dict[str, int],
) -> list[Spring]:
    ends = ((span[0], *axis), (span[1], *axis))
    places = [Place(name, bodies[index[name]].position) for name in pair]
    found = uniform_shaft(label, places[0], places[1], ends, shaft.section, STEEL)
    torsion = shaft.section.torsion * STEEL.shear_modulus / (span[1] - span[0])
    if shaft.kind == "coupling":
        middle = ((span[0] + span[1]) / 2, *axis)
        return bushing(label, places[0], places[1], middle, (0, 0, 0, torsion, 0, 0))
    if shaft.bending is not None:
        # a hinge of given stiffness at the middle, between links that are rigid
        length = span[1] - span[0]
        bent = shaft.bending * shaft.length / length
        stiff = [s.stiffness for s in found]
        k = (stiff[0], stiff[1], stiff[2], torsion, bent, bent)
        middle = ((span[0] + span[1]) / 2, *axis)
        return bushing(label, places[0], places[1], middle, k)
    return found


def _heavier(body: Body, shaft: ShaftData, length: float) -> Body:
    """A body with half of an element of the shaft on it."""
    section, half = shaft.section, STEEL.density * length / 2
    return replace(
        body,
        mass=body.mass + half * section.area,
        polar=body.polar + half * section.torsion,
        transverse=body.transverse + half * section.inertias[0],
    )


def torsional(machine: MachineTable) -> Torsional:
    """The machine at the torsional level, for what `dynamics.torsion` does with one.

    Windings of meshes are along the lines of action [m/rad], so that their stiffness is in N/m;
    else these are the systems of `gear_masses` of a gear table with the planets' teeth.
    """
    system = machine_system(machine, Level.TORSIONAL)
    inertias = [
        Inertia(name.removesuffix(" rx"), float(J))
        for name, J in zip(system.names, system.mass.diagonal(), strict=True)
    ]
    parts = [part.name for part in inertias]
    elements = []
    for name, row, k in zip(system.spring_names, system.rows, system.stiffness, strict=True):
        winding = {part: float(by) for part, by in zip(parts, row, strict=True) if by}
        if winding:
            elements.append(Element(name.removesuffix(" rx"), winding, float(k)))
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
