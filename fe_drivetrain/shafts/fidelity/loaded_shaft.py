"""A shaft on its springs under one load: deflection, tilt in its bearings, stress of its sections.

Forces of sections follow from those at the points of the condensed body and the weight between
them, as equilibrium has it. Stress is the nominal one of a beam's section, bending, axial force and
torque together by von Mises, without any notch (Budynas and Nisbett 2015, Shigley's Mechanical
Engineering Design, 7-4).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.solve.condensation import Condensed, supported
from fe_drivetrain.foreign.assembly import solids_of_unit
from fe_drivetrain.geometry import LENGTH_TOLERANCE, Shaft
from fe_drivetrain.shafts.fidelity.bearing_units import scene_supports
from fe_drivetrain.shafts.fidelity.ladder import point_loads
from fe_drivetrain.shafts.fidelity.quantities import Solved
from fe_drivetrain.shafts.fidelity.shafts import ringed_shaft

# Gauss's rule along a piece of an outline: exact to round-off for arcs, too
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


@dataclass(frozen=True, eq=False)
class LoadedShaft:
    """A shaft at level 1 or 2 under one load.

    Attributes
    ----------
    scene : Scene
        The scene.
    body : Condensed
        The free shaft.
    motions : Floats
        (n, 6) of the n points of the body [m, rad].
    forces : Floats
        (n, 6) on the shaft at its points, loads and supports together [N, N m].
    acceleration : Floats
        (3,) that gives all parts their weight, as a force on a unit of mass [m/s^2].
    """

    scene: Scene
    body: Condensed
    motions: Floats
    forces: Floats
    acceleration: Floats

    __repr__ = short_repr

    @property
    def deflection(self) -> float:
        """How far the hub moves [m]."""
        return float(np.linalg.norm(self.motions[self.body.names.index("hub"), :3]))

    def tilt(self, name: str) -> float:
        """How far the shaft turns out of its axis in a bearing, against the ground [rad]."""
        return float(np.linalg.norm(self.motions[self.body.names.index(name), 4:]))

    def section_forces(self, x: float, including: bool = True) -> Floats:
        """(6,) forces and moments that the shaft in front of a section puts on it [N, N m].

        Parameters
        ----------
        x : float
            Place of the section [m].
        including : bool
            Whether points at the section itself count as in front of it.
        """
        places = self.body.positions[:, 0]
        margin = LENGTH_TOLERANCE if including else -LENGTH_TOLERANCE
        found = np.zeros(6)
        for place, force in zip(places, self.forces, strict=True):
            if place <= x + margin:
                found += _moved(force, place - x)
        weight, middle = _weight_in_front(ringed_shaft(self.scene)[0], x)
        force = self.scene.material_of("shaft").density * weight * self.acceleration
        return found + _moved(np.concatenate([force, np.zeros(3)]), middle - x)

    def stresses(self) -> list[Floats]:
        """(2 n,) nominal stress of each section of the shaft, a flange first [Pa].

        At the n points of the body, those outside of a section at its end, on both sides of what
        acts there: each value is smooth in the dimensions, which the largest of them is not.
        """
        stations, found = self.scene.shaft.stations, []
        ends = zip(self.scene.shaft.pieces, stations, stations[1:], strict=False)
        for piece, low, high in ends:
            values = []
            for x in np.clip(self.body.positions[:, 0], low, high).tolist():
                share = (x - low) / piece.length
                outer = piece.outer_diameter + share * (piece.end_diameter - piece.outer_diameter)
                for including in (False, True):
                    # what is at an end acts on the section on its other side
                    before = (including or x == low) and x != high
                    forces = self._forces_at(x, before)
                    values.append(section_stress(forces, outer, piece.inner_diameter))
            found.append(np.array(values))
        return found

    def _forces_at(self, x: float, including: bool) -> Floats:
        """`section_forces`, each once."""
        if (x, including) not in self._known:
            self._known[x, including] = self.section_forces(x, including)
        return self._known[x, including]

    @cached_property
    def _known(self) -> dict[tuple[float, bool], Floats]:
        """Forces of sections so far, by place and side."""
        return {}


def section_stress(forces: Floats, outer: float, inner: float) -> float:
    """Nominal von Mises stress at the surface of a hollow round section [Pa].

    Parameters
    ----------
    forces : ndarray, (6,)
        Forces of the section, the first and the fourth along and about the axis [N, N m].
    outer, inner : float
        Diameters [m].
    """
    area = np.pi * (outer**2 - inner**2) / 4.0
    modulus = np.pi * (outer**4 - inner**4) / (32.0 * outer)
    normal = abs(forces[0]) / area + float(np.hypot(forces[4], forces[5])) / modulus
    return float(np.sqrt(normal**2 + 3.0 * (forces[3] / (2.0 * modulus)) ** 2))


def loaded_shaft(scene: Scene, solved: Solved, factors: Floats) -> LoadedShaft:
    """The shaft of a solved scene under a load.

    Parameters
    ----------
    scene : Scene
        The scene.
    solved : Solved
        At level 1 or 2.
    factors : Floats
        (n,) of the scene's unit loads, see `fe_drivetrain.shafts.response.scene_loads`.

    Raises
    ------
    InputError
        The scene has a nose, whose bearings are inside of the shaft.
    """
    if scene.nose is not None:
        raise InputError(
            f"scene {scene.title!r} has a nose: deflection, tilt and stress are of a shaft on "
            "bearing units alone; ask for reactions or stiffnesses of the hub"
        )
    body = solved.body
    assert body is not None  # an assembly has no shaft alone
    on = supported(body, scene_supports(scene, solved.springs), scene.coupled_units)
    columns = point_loads(scene, body) @ factors
    u = on.motions @ columns
    acceleration = columns[6 * len(body.names) :]
    forces = body.stiffness @ u - body.gravity @ acceleration
    return LoadedShaft(scene, body, u.reshape(-1, 6), forces.reshape(-1, 6), acceleration)


def shaft_volume(shaft: Shaft, x: float = np.inf) -> float:
    """Volume of a shaft in front of a section, fillets included [m^3].

    Parameters
    ----------
    shaft : Shaft
        The shaft.
    x : float
        Place of the section [m]; the whole shaft where left out.
    """
    return _weight_in_front(shaft, x)[0]


def part_masses(scene: Scene) -> dict[str, float]:
    """Mass of shaft, nose, bearings, housings and further parts, by name, without a mesh [kg].

    Parameters
    ----------
    scene : Scene
        The scene; a housing that is a stiffness alone has no mass.
    """
    found = {"shaft": scene.material_of("shaft").density * shaft_volume(scene.shaft)}
    if scene.nose is not None:
        found["nose"] = scene.material_of("nose").density * shaft_volume(scene.nose.body)
    for unit in scene.bearing_units:
        bore = scene.seat_diameter(unit.bearing.name)
        for part, solid in solids_of_unit(unit, bore, scene.mesh).items():
            found[part] = scene.material_of(part).density * solid.volume
    return found


def _moved(force: Floats, ahead: float) -> Floats:
    """Force and moment about a point of the axis, from those about another one [N, N m]."""
    found = np.array(force)
    found[4] -= ahead * force[2]
    found[5] += ahead * force[1]
    return found


def _weight_in_front(shaft: Shaft, x: float) -> tuple[float, float]:
    """Volume in front of a section [m^3], and its centre on the axis [m]."""
    volume = moment = 0.0
    for segment in shaft.outer_profile():
        a, b = segment.start, segment.end
        if min(a[0], b[0]) >= x:
            continue
        if segment.centre is None:
            share = min((x - a[0]) / (b[0] - a[0]), 1.0) if b[0] != a[0] else 1.0
            t = share * (_NODES + 1.0) / 2.0
            at = a[0] + t * (b[0] - a[0])
            rate = np.full(len(t), share * (b[0] - a[0]) / 2.0)
            radius = a[1] + t * (b[1] - a[1])
        else:
            at, radius, rate = _along_arc(segment.start, segment.end, segment.centre, _NODES, x)
        part = np.pi * radius**2 * rate * _WEIGHTS
        volume, moment = volume + float(part.sum()), moment + float(part @ at)
    stations = shaft.stations
    for piece, low, high in zip(shaft.pieces, stations, stations[1:], strict=False):
        end = min(high, x)
        bore = np.pi * piece.inner_diameter**2 / 4.0 * max(end - low, 0.0)
        volume, moment = volume - bore, moment - bore * (low + end) / 2.0
    return volume, moment / volume if volume > 0.0 else 0.0


def _along_arc(
    start: tuple[float, float],
    end: tuple[float, float],
    centre: tuple[float, float],
    nodes: Floats,
    x: float,
) -> tuple[Floats, Floats, Floats]:
    """Places, radii, and rates dx/dt of an arc of a meridian in front of a section."""
    size = float(np.hypot(start[0] - centre[0], start[1] - centre[1]))
    first = float(np.arctan2(start[1] - centre[1], start[0] - centre[0]))
    turn = float(np.arctan2(end[1] - centre[1], end[0] - centre[0])) - first
    turn = float(np.remainder(turn + np.pi, 2.0 * np.pi) - np.pi)
    if end[0] > x:
        cut = float(np.arccos(np.clip((x - centre[0]) / size, -1.0, 1.0)))
        both = [np.remainder(s * cut - first + np.pi, 2.0 * np.pi) - np.pi for s in (1.0, -1.0)]
        turn = float(min(both, key=lambda one: abs(one - np.clip(one, min(0, turn), max(0, turn)))))
    angle = first + turn * (nodes + 1.0) / 2.0
    at, radius = centre[0] + size * np.cos(angle), centre[1] + size * np.sin(angle)
    return at, radius, -size * np.sin(angle) * turn / 2.0
