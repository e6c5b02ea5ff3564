"""Shafts of a machine between the bodies that they hold: beams of several elements, or solids."""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.bodies import Body, Superelement
from fe_drivetrain.dynamics.bodies.flexible import PLACED, shaft_element
from fe_drivetrain.dynamics.bodies.machine_parts import STEEL, ShaftData
from fe_drivetrain.dynamics.bodies.machine_rows import MachineTable
from fe_drivetrain.dynamics.bodies.springs import Place, Spring, bushing, uniform_shaft
from fe_drivetrain.elasticity.solve.condensation import Condensed


def beam_shaft(
    machine: MachineTable,
    k: int,
    ends: tuple[str, str],
    bodies: list[Body],
    bends: bool,
    elements: int,
    seats: dict[str, tuple[str, tuple[float, float, float]]],
) -> tuple[list[Body], list[Spring]]:
    """The shaft's nodes and springs, its mass, and what its bearings hold."""
    shaft = machine.shafts[k]
    x, y, z = machine.axes[k]
    on = [b for b in machine.bearings if b.holds == shaft.name]
    stations = [0.0, shaft.length]
    if bends and shaft.kind == "shaft":
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


def solid_shaft(
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
