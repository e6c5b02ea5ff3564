"""A machine as lines of nodes, one for each shaft, and the stages between them.

What a rotor program takes: beams with diameters between nodes, discs, stiffness to ground at a
node, and between the end of a line and the front of the next what a stage's teeth and pins do.
Planets, and a ring that moves, are nodes in front of the line that their sun drives.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.turning_parts import ShaftData
from fe_drivetrain.dynamics.bodies.bodies import Body, assemble
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.levels import Assembly, Level, bodies_and_stages
from fe_drivetrain.dynamics.bodies.machine_shafts import (
    heavier,
    shaft_slices,
    shaft_springs,
    shaft_stations,
    spline_springs,
    station_names,
)
from fe_drivetrain.dynamics.bodies.springs import Place, Spring, bushing

STIFFER, HELD = 1e3, 1e6
"""How many times what is rigid, and what holds a motion, are stiffer than the stiffest spring."""

ELEMENTS = 6
"""Elements of a shaft with mass, beside its steps and bearings."""

NO_MASS, STANDS_IN = 1e-6, 1e-4
"""Masses and inertias below the one, over the largest of their line, are none for a rotor program,
which needs some at each node: they get the other, over the smallest of the others."""

FASTEST = 1e5
"""Frequency of motions that are held, at most [rad/s]."""

STUB = 0.01
"""Length that a node of a planet takes in a drawing [m]."""

_TURN = 3  # rx among the six motions of a body


@dataclass(frozen=True)
class Beam:
    """A round beam between two nodes; diameters at both ends [m]."""

    length: float
    outer: tuple[float, float]
    inner: float
    shaft: ShaftData

    __repr__ = short_repr


@dataclass(frozen=True)
class Link:
    """A stiffness (12, 12) between two nodes, of ux to rz of each [N/m, N, N m/rad]."""

    length: float
    stiffness: Floats

    __repr__ = short_repr


@dataclass(frozen=True)
class Support:
    """A stiffness (6, 6) of a node to ground [N/m, N, N m/rad]."""

    name: str
    node: int
    stiffness: Floats

    __repr__ = short_repr


@dataclass(frozen=True)
class Line:
    """A shaft with all that is on it.

    Attributes
    ----------
    name : str
        Name of the shaft.
    speed : float
        Speed over the rotor's.
    planets : int
        Number of nodes in front of the shaft: planets and ring of the stage before.
    bodies : tuple of Body
        Bodies at its nodes, from front to rear, with the masses that are no beam's.
    pieces : tuple of Beam or Link
        What is between each node and the next.
    supports : tuple of Support
        Bearings, grid, and what holds motions that the drivetrain does not have.
    """

    name: str
    speed: float
    planets: int
    bodies: tuple[Body, ...]
    pieces: tuple[Beam | Link, ...]
    supports: tuple[Support, ...]

    __repr__ = short_repr

    def disc(self, node: int) -> tuple[float, float, float] | None:
        """Mass, transverse and polar inertia of a node beside its beams, none of which is zero.

        None where its beams have all of its mass. What has no mass, or stands still, gets as much
        as leaves it swinging far above what the drivetrain does, but less than round-off lets in.
        """
        body = self.bodies[node]
        beside = [piece for piece in self.pieces[max(node - 1, 0) : node + 1]]
        heavy = any(isinstance(piece, Beam) and piece.shaft.has_mass for piece in beside)
        if heavy and not body.mass and not body.polar:
            return None
        hold = sum(np.abs(s.stiffness.diagonal()) for s in self.supports if s.node == node)
        stood = np.broadcast_to(hold, 6) / FASTEST**2
        free = np.array([motion in body.free for motion in MOTIONS])
        stood = np.where(free, 0.0, stood)
        return (
            max(self._or_some("mass", body), float(stood[:3].max())),
            max(self._or_some("transverse", body), float(stood[4:].max())),
            max(self._or_some("polar", body), float(stood[_TURN])),
        )

    def _or_some(self, what: str, body: Body) -> float:
        own = float(getattr(body, what))
        all_of_line = [float(getattr(one, what)) for one in self.bodies]
        some = [value for value in all_of_line if value > NO_MASS * max(all_of_line)]
        return own if own in some else STANDS_IN * min(some, default=1.0)


@dataclass(frozen=True)
class Coupling:
    """What a stage does between the rear end of a line and the front of the next.

    Attributes
    ----------
    number : int
        Number of the stage.
    stiffness, mass : Floats
        Matrices (6 k, 6 k) of ux to rz of the driving body, of planets and ring, and of the driven
        body; the mass is what bodies carry of those that are tied to them.
    """

    number: int
    stiffness: Floats
    mass: Floats

    __repr__ = short_repr


def turning_lines(
    machine: MachineTable, level: Level, held: bool = False
) -> tuple[list[Line], list[Coupling]]:
    """Lines of a machine and the stages between them.

    Parameters
    ----------
    machine : MachineTable
        Table of the machine.
    level : Level
        Flexible; or torsional, whose other motions are held to ground.
    held : bool
        Whether the generator is held.
    """
    built, ends = bodies_and_stages(machine, level, 0.0, False, Flexible())
    stiffest = _stiffest(machine, built, level)
    lines = [
        _line(machine, k, ends[k], level, built, held, stiffest) for k in range(len(machine.shafts))
    ]
    couplings = [
        _coupling(number, (ends[number - 1][1], ends[number][0]), built)
        for number in range(1, len(machine.stages) + 1)
    ]
    return lines, couplings


def _stiffest(machine: MachineTable, built: Assembly, level: Level) -> Floats:
    """(6,) the largest stiffness of any spring along and about the axes [N/m, N m/rad]."""
    found = np.zeros(6)
    springs = [*built.springs]
    for k, shaft in enumerate(machine.shafts):
        if shaft.kind != "rigid":
            places = [Place("front", (0.0, 0.0, 0.0)), Place("rear", (shaft.length, 0.0, 0.0))]
            springs += shaft_springs(str(k), shaft, places, (0.0, shaft.length), (0.0, 0.0, 0.0))
    if level is not Level.TORSIONAL:
        for bearing in machine.bearings:
            at = (0.0, 0.0, 0.0)
            springs += bushing(bearing.name, Place("front", at), None, at, bearing.stiffness)
    for spring in springs:
        for row in spring.by.values():
            found = np.maximum(found, spring.stiffness * row**2)
    return np.where(found > 0.0, found, 1.0)


def _line(
    machine: MachineTable,
    k: int,
    ends: tuple[str, str],
    level: Level,
    built: Assembly,
    held: bool,
    stiffest: Floats,
) -> Line:
    shaft, begin = machine.shafts[k], machine.axes[k]
    bends = level is Level.FLEXIBLE
    # a beam is exact in one piece, and what has no mass needs no more; hinges are one an element
    count = ELEMENTS if shaft.has_mass or shaft.bending is not None else 1
    stations = shaft_stations(machine, k, count if bends else 0)
    of_name = {body.name: body for body in built.bodies}
    before = _between(k, ends[0], built)
    bodies, places = [], []
    for x, *names in zip(stations, *station_names(shaft, ends, stations), strict=True):
        for name in dict.fromkeys(names):
            inner = Body(name, (begin[0] + x, *begin[1:]), speed=machine.speeds[k])
            bodies.append(of_name.get(name, inner))
            places.append(x)
    pieces: list[Beam | Link] = []
    for i, span in enumerate(pairwise(places)):
        if span[0] == span[1] or (shaft.kind == "rigid" and shaft.spline is not None):
            springs = spline_springs(machine, k, bodies[i + 1], bodies[i])
            K = _of_springs(springs, (bodies[i].name, bodies[i + 1].name))
            pieces.append(Link(span[1] - span[0] or STUB, _that_moves(K, level)))
            continue
        if bends and shaft.kind == "shaft" and shaft.bending is None:
            pieces.append(_beam(shaft, span))
            continue
        pieces.append(_link(shaft, bodies[i], bodies[i + 1], begin, stiffest, level))
        if shaft.has_mass:
            bodies[i], bodies[i + 1] = (heavier(bodies[j], shaft, span) for j in (i, i + 1))
    supports = [] if level is Level.TORSIONAL else _bearings(machine, shaft, places, bodies)
    bodies = [*before, *bodies]
    pieces = [*(Link(STUB, np.zeros((12, 12))) for _ in before), *pieces]
    supports = [replace(one, node=one.node + len(before)) for one in supports]
    grid = [spring for spring in built.springs if spring.name.startswith("grid ")]
    if ends[1] == "generator" and grid:
        supports.append(Support("grid", len(bodies) - 1, _of_springs(grid, ("generator",))))
    stand = np.eye(6, dtype=bool)[_TURN] if held else np.zeros(6, dtype=bool)
    for i, body in enumerate(bodies):
        fixed = np.array([motion not in body.free for motion in MOTIONS])
        fixed |= stand & (body.name == "generator")
        if fixed.any():
            hold = np.diag(np.where(fixed, HELD * stiffest, 0.0))
            supports.append(Support(f"{body.name}, held", i, hold))
    return Line(
        shaft.name,
        machine.speeds[k],
        len(before),
        tuple(bodies),
        tuple(pieces),
        tuple(supports),
    )


def _between(number: int, rear: str, built: Assembly) -> list[Body]:
    """Bodies of a stage that move beside its two ends: planets, and a ring on springs."""
    mark = f"stage {number} "
    found = [body for body in built.bodies if body.name.startswith(mark) and body.free]
    return [body for body in found[1:] if body.name != rear]


def _beam(shaft: ShaftData, span: tuple[float, float]) -> Beam:
    """A beam between two stations of a shaft, which are in one of its sections."""
    length, middle, begin = span[1] - span[0], 0.5 * sum(span), 0.0
    for piece in shaft.sections or ():
        if begin < middle < begin + piece.length:
            ends = [
                piece.outer_diameter
                + (x - begin) / piece.length * (piece.end_diameter - piece.outer_diameter)
                for x in span
            ]
            return Beam(length, (ends[0], ends[1]), piece.inner_diameter, shaft)
        begin += piece.length
    if shaft.outer is not None:
        return Beam(length, (shaft.outer, shaft.outer), shaft.inner, shaft)
    (slice_,) = shaft_slices(shaft, *span)
    outer = float((32.0 * slice_.section.torsion / np.pi) ** 0.25)
    return Beam(length, (outer, outer), 0.0, shaft)


def _link(
    shaft: ShaftData,
    front: Body,
    rear: Body,
    begin: tuple[float, float, float],
    stiffest: Floats,
    level: Level,
) -> Link:
    """What is no beam: a coupling, a hinge, what is rigid, or torsion alone."""
    pair = [Place(body.name, body.position) for body in (front, rear)]
    if shaft.kind == "rigid":
        springs = bushing(shaft.name, pair[0], pair[1], rear.position, STIFFER * stiffest)
    else:
        span = (front.position[0] - begin[0], rear.position[0] - begin[0])
        springs = shaft_springs(shaft.name, shaft, pair, span, begin)
    K = _of_springs(springs, (front.name, rear.name))
    return Link(rear.position[0] - front.position[0], _that_moves(K, level))


def _that_moves(K: Floats, level: Level) -> Floats:
    """A stiffness (6 k, 6 k) on the motions that a level has."""
    if level is not Level.TORSIONAL:
        return K
    only = np.tile(np.arange(6) == _TURN, len(K) // 6)
    return np.where(np.outer(only, only), K, 0.0)


def _of_springs(springs: Sequence[Spring], bodies: Sequence[str]) -> Floats:
    """(6 k, 6 k) stiffness of springs on the motions of k bodies."""
    K = np.zeros((6 * len(bodies),) * 2)
    for spring in springs:
        row = np.concatenate([spring.by.get(name, np.zeros(6)) for name in bodies])
        K += spring.stiffness * np.outer(row, row)
    return K


def _bearings(
    machine: MachineTable, shaft: ShaftData, stations: Sequence[float], bodies: Sequence[Body]
) -> list[Support]:
    """Bearings that hold a line's shaft or one of its bodies."""
    found = []
    names = [body.name for body in bodies]
    for bearing in machine.bearings:
        if bearing.holds == shaft.name:
            away = [abs(x - bearing.at) for x in stations]
            node, x = away.index(min(away)), bodies[0].position[0] + bearing.at
        elif bearing.holds in names:
            node = names.index(bearing.holds)
            x = bodies[node].position[0] + bearing.at
        else:
            continue
        place = Place(names[node], bodies[node].position)
        at = (x, *place.centre[1:])
        springs = bushing(bearing.name, place, None, at, bearing.stiffness)
        found.append(Support(bearing.name, node, _of_springs(springs, (place.body,))))
    return found


def _coupling(number: int, ends: tuple[str, str], built: Assembly) -> Coupling:
    """A stage between its driving and its driven body."""
    mark, between = f"stage {number} ", _between(number, ends[1], built)
    bodies = [
        replace(body, mass=0.0, polar=0.0, transverse=0.0) if body.name in ends else body
        for body in built.bodies
        if body.name.startswith(mark)
    ]
    springs = [spring for spring in built.springs if spring.name.startswith(mark)]
    system = assemble(bodies, springs)
    names = [ends[0], *(body.name for body in between), ends[1]]
    labels = [f"{name} {motion}" for name in names for motion in MOTIONS]
    T = np.zeros((len(system.names), len(labels)))
    T[np.arange(len(T)), [labels.index(name) for name in system.names]] = 1.0
    tied = system.mass.copy()
    for body in between:
        at = [i for i, name in enumerate(system.names) if name.rpartition(" ")[0] == body.name]
        tied[np.ix_(at, at)] = 0.0
    return Coupling(number, np.asarray(T.T @ system.K @ T), np.asarray(T.T @ tied @ T))
