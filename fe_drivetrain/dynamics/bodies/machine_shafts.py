"""Shafts of a machine between the bodies that they hold: beams of several elements, or solids."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, fsum, pi

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.drivetrain_file.turning_parts import STEEL, ShaftData
from fe_drivetrain.dynamics.bodies.bodies import Body, Superelement
from fe_drivetrain.dynamics.bodies.flexible import PLACED, shaft_element
from fe_drivetrain.dynamics.bodies.springs import Place, Spring, bushing
from fe_drivetrain.elasticity.solve.condensation import Condensed
from fe_drivetrain.shafts.beam.frame import CrossSection, round_section

#: Uniform slices of a tapered section.
SLICES = 8
#: Length between two stations over that of the shaft, below which they are one: sums round.
APART = 1e-6


@dataclass(frozen=True)
class Slice:
    """A uniform length of a shaft.

    Attributes
    ----------
    middle, length : float
        x of its middle from where the shaft begins, and its length [m].
    section : CrossSection
        Its cross-section.
    """

    middle: float
    length: float
    section: CrossSection


def shaft_slices(shaft: ShaftData, start: float, stop: float) -> list[Slice]:
    """Uniform slices of a shaft between two places; a taper is cut into eight a section.

    Parameters
    ----------
    shaft : ShaftData
        The shaft; one of a torsional stiffness alone is the solid steel bar that has it.
    start, stop : float
        x from where the shaft begins [m].
    """
    nu = shaft.material.poisson_ratio
    if shaft.sections is None:
        if shaft.outer is not None:
            section = round_section(shaft.outer, nu, shaft.inner)
        else:
            area = float(shaft.torsion or 0.0) * shaft.length / STEEL.shear_modulus
            section = round_section((32 * area / pi) ** 0.25, STEEL.poisson_ratio)
        return [Slice((start + stop) / 2, stop - start, section)]
    found, begin = [], 0.0
    for piece in shaft.sections:
        end = begin + piece.length
        low, high = max(begin, start), min(end, stop)
        if high - low > 1e-9 * piece.length:
            tapered = piece.end_diameter != piece.outer_diameter
            count = max(1, ceil(SLICES * (high - low) / piece.length)) if tapered else 1
            edges = np.linspace(low, high, count + 1)
            for one, two in pairwise(edges.tolist()):
                at = (one + two) / 2
                share = (at - begin) / piece.length
                outer = piece.outer_diameter + share * (piece.end_diameter - piece.outer_diameter)
                found.append(Slice(at, two - one, round_section(outer, nu, piece.inner_diameter)))
        begin = end
    return found


def in_series(
    slices: Sequence[Slice], material: Material
) -> tuple[float, tuple[float, float, float, float, float, float]]:
    """Elastic centre of slices in series [m], and their six stiffnesses there.

    About the middle of a uniform beam its six deformations do no work on each other (Przemieniecki
    1968, section 5.6); in series flexibilities add, and about the centre of bending a transverse
    force does not turn the ends against each other, so that six springs are exact for any steps.

    Parameters
    ----------
    slices : sequence of Slice
        Slices from one end to the other.
    material : Material
        Their material.
    """
    E, G = material.youngs_modulus, material.shear_modulus
    along = fsum(s.length / (E * s.section.area) for s in slices)
    twist = fsum(s.length / (G * s.section.torsion) for s in slices)
    bent = [s.length / (E * s.section.inertias[0]) for s in slices]
    centre = fsum(f * s.middle for f, s in zip(bent, slices, strict=True)) / fsum(bent)
    sheared = fsum(s.length / (G * s.section.shear_areas[0]) for s in slices)
    across = sheared + fsum(
        f * (s.length**2 / 12 + (s.middle - centre) ** 2) for f, s in zip(bent, slices, strict=True)
    )
    bending = 1 / fsum(bent)
    return centre, (1 / along, 1 / across, 1 / across, 1 / twist, bending, bending)


def beam_shaft(
    machine: MachineTable,
    k: int,
    ends: tuple[str, str],
    bodies: list[Body],
    bends: bool,
    elements: int,
    free: frozenset[str],
    seats: dict[str, tuple[str, tuple[float, float, float]]],
) -> tuple[list[Body], list[Spring]]:
    """The shaft's nodes and springs, its mass, and what its bearings hold."""
    shaft = machine.shafts[k]
    x, y, z = machine.axes[k]
    on = [b for b in machine.bearings if b.holds == shaft.name]
    if shaft.kind == "rigid":
        return _rigid_shaft(machine, k, ends, bodies, seats)
    stations = shaft_stations(machine, k, elements if bends else 0)
    rears, fronts = station_names(shaft, ends, stations)
    new = [
        Body(name, (x + s, y, z), speed=machine.speeds[k], free=free)
        for pair in zip(rears, fronts, stations, strict=True)
        for s, name in ((pair[2], one) for one in dict.fromkeys(pair[:2]))
        if name not in ends
    ]
    bodies = [*bodies, *new]
    index = {body.name: i for i, body in enumerate(bodies)}
    springs: list[Spring] = []
    for one, two in zip(rears, fronts, strict=True):
        if one != two:
            springs += spline_springs(machine, k, bodies[index[two]], bodies[index[one]])
    for i, (start, stop) in enumerate(pairwise(stations)):
        pair = fronts[i], rears[i + 1]
        label = shaft.name if len(stations) == 2 else f"{shaft.name} element {i + 1}"
        places = [Place(name, bodies[index[name]].position) for name in pair]
        springs += shaft_springs(label, shaft, places, (start, stop), (x, y, z))
        if shaft.has_mass:
            for name in pair:
                place = index[name]
                bodies[place] = heavier(bodies[place], shaft, (start, stop))
    for bearing in on:
        where = x + bearing.at
        nearest = min(range(len(stations)), key=lambda i: abs(stations[i] - bearing.at))
        side = rears if bearing.at <= stations[nearest] else fronts
        seats[bearing.name] = (side[nearest], (where, y, z))
    return bodies, springs


def _rigid_shaft(
    machine: MachineTable,
    k: int,
    ends: tuple[str, str],
    bodies: list[Body],
    seats: dict[str, tuple[str, tuple[float, float, float]]],
) -> tuple[list[Body], list[Spring]]:
    """Both ends as one body, or on the spline between them; the front one has the bearings."""
    shaft, (x, y, z) = machine.shafts[k], machine.axes[k]
    on = [b for b in machine.bearings if b.holds == shaft.name]
    seats.update({b.name: (ends[0], (x + b.at, y, z)) for b in on})
    if shaft.spline is not None:
        named = {body.name: body for body in bodies}
        return bodies, spline_springs(machine, k, named[ends[1]], named[ends[0]])
    bodies = [
        replace(b, free=frozenset(), tied_to=ends[0]) if b.name == ends[1] else b for b in bodies
    ]
    return bodies, []


def station_names(
    shaft: ShaftData, ends: tuple[str, str], stations: Sequence[float]
) -> tuple[list[str], list[str]]:
    """Bodies at a shaft's stations: where the piece before ends, and where the next one begins.

    They are two at its spline, of which one may be an end of the shaft.

    Parameters
    ----------
    shaft : ShaftData
        The shaft.
    ends : tuple of str
        Bodies at its ends.
    stations : sequence of float
        x of its stations from where it begins [m], see `shaft_stations`.
    """
    rears = [ends[0], *(f"{shaft.name} node {i}" for i in range(1, len(stations) - 1)), ends[1]]
    fronts = list(rears)
    if shaft.spline is not None and shaft.kind == "shaft":
        at, last = shaft.spline.at, len(stations) - 1
        j = min(range(len(stations)), key=lambda i: abs(stations[i] - at))
        before, behind = spline_bodies(shaft)
        rears[j] = before if j > 0 else ends[0]
        fronts[j] = behind if j < last else ends[1]
    return rears, fronts


def spline_bodies(shaft: ShaftData) -> tuple[str, str]:
    """Names of what is before the spline of a shaft, and behind it."""
    return f"{shaft.name} before spline", f"{shaft.name} behind spline"


def spline_springs(machine: MachineTable, k: int, behind: Body, before: Body) -> list[Spring]:
    """Springs "SHAFT spline ux" and so on, of a spline with all flanks in contact.

    Parameters
    ----------
    machine : MachineTable
        Table of the machine.
    k : int
        Number of the shaft, from 0.
    behind, before : Body
        What the spline joins.
    """
    shaft, (x, y, z) = machine.shafts[k], machine.axes[k]
    if shaft.spline is None:
        return []
    one, other = (Place(body.name, body.position) for body in (behind, before))
    at = (x + shaft.spline.at, y, z)
    return bushing(f"{shaft.name} spline", one, other, at, shaft.spline.bushing)


def shaft_torsion(shaft: ShaftData) -> float | None:
    """Torsional stiffness of a shaft with its spline [N m/rad]; none of what is rigid."""
    parts = [] if shaft.spline is None else [shaft.spline.bushing[3]]
    if shaft.kind != "rigid":
        slices = shaft_slices(shaft, 0.0, shaft.length)
        parts.append(shaft.torsion or in_series(slices, shaft.material)[1][3])
    return 1 / fsum(1 / k for k in parts) if len(parts) > 1 else next(iter(parts), None)


def shaft_stations(machine: MachineTable, k: int, elements: int) -> list[float]:
    """x of a shaft's nodes from where it begins: elements, bearings, steps, spline [m].

    Parameters
    ----------
    machine : MachineTable
        Table of the machine.
    k : int
        Number of the shaft, from 0.
    elements : int
        Number of elements; 0 of a shaft in one piece on each side of its spline.
    """
    shaft = machine.shafts[k]
    shaft_bends = shaft.kind == "shaft"
    places = [shaft.spline.at] if shaft.spline is not None and shaft_bends else []
    if elements and shaft_bends:
        places += np.linspace(0.0, shaft.length, elements + 1).tolist()
        places += [b.at for b in machine.bearings if b.holds == shaft.name]
        if shaft.sections is not None:
            places += np.cumsum([s.length for s in shaft.sections]).tolist()
    least = APART * shaft.length
    found = [0.0]
    for at in sorted(places):
        if found[-1] + least < at < shaft.length - least:
            found.append(round(float(at), 9))
    return [*found, shaft.length]


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
        for pair, span in zip(pairwise(points), pairwise(along.tolist()), strict=True):
            for point in pair:
                place = index[point.body]
                bodies[place] = heavier(bodies[place], shaft, span)
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


def shaft_springs(
    label: str,
    shaft: ShaftData,
    places: Sequence[Place],
    span: tuple[float, float],
    begin: tuple[float, float, float],
) -> list[Spring]:
    """Springs of a shaft between two of its stations, at their elastic centre."""
    x, y, z = begin
    centre, k = in_series(shaft_slices(shaft, *span), shaft.material)
    length = span[1] - span[0]
    if shaft.kind == "coupling":
        k = (0.0, 0.0, 0.0, k[3], 0.0, 0.0)
    elif shaft.bending is not None:
        # a hinge of given stiffness at the middle, between links that are rigid
        bent = shaft.bending * shaft.length / length
        k = (*k[:4], bent, bent)
    whole = in_series(shaft_slices(shaft, 0.0, shaft.length), shaft.material)[1][3]
    damping = (0.0, 0.0, 0.0, shaft.damping * k[3] / whole, 0.0, 0.0)
    return bushing(label, places[0], places[1], (x + centre, y, z), k, damping)


def heavier(body: Body, shaft: ShaftData, span: tuple[float, float]) -> Body:
    """A body with half of an element of the shaft on it."""
    slices, half = shaft_slices(shaft, *span), shaft.material.density / 2
    return replace(
        body,
        mass=body.mass + half * fsum(s.length * s.section.area for s in slices),
        polar=body.polar + half * fsum(s.length * s.section.torsion for s in slices),
        transverse=body.transverse + half * fsum(s.length * s.section.inertias[0] for s in slices),
    )
