"""Internal forces of the main shaft at any section, from unit loads on a beam with its supports.

Forces at a section are those of the part in front of it on the part behind it: the loads on the
front part, its weight, less what its supports take. They are linear in the loads at hub and load
points, so that a history costs a product of matrices for each section.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.drivetrain_file.joint_springs import as_numbers, free_to_turn, joint_stiffness
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.geometry import Section
from fe_drivetrain.shafts.beam.beam import Beam, Support
from fe_drivetrain.shafts.beam.of_scene import beam_of_scene
from fe_drivetrain.shafts.beam.shaft import unit_load_response

_TURN = 3  # about x, among the six motions
_POINTS = 8  # of Gauss's rule along a section, for its weight


@dataclass(frozen=True, eq=False)
class SectionLoads:
    """Internal forces at sections of the shaft.

    Attributes
    ----------
    x : ndarray, (s,)
        Where the sections are [m].
    unit : ndarray, (s, 6, 6 + 6 m)
        Forces and moments about the section's middle for unit loads at the hub, about the front
        face, and at m load points.
    constant : ndarray, (s, 6)
        Those of the weights [N, N m].
    imbalance : float
        Largest force that is left behind the rear face, over the load; moments over the length.
    """

    x: Floats
    unit: Floats
    constant: Floats
    imbalance: float

    __repr__ = short_repr

    def at(self, section: int, loads: Floats) -> Floats:
        """Forces (n, 6) at a section under loads (n, 6 + 6 m) of `entering` [N, N m]."""
        unit = self.unit[section][:, : loads.shape[-1]]
        return np.asarray(loads @ unit.T + self.constant[section])


def section_loads(
    scene: Scene,
    x: Sequence[float],
    supports: Mapping[str, ArrayLike] | None = None,
    weight: bool = True,
) -> SectionLoads:
    """Internal forces at sections for unit loads, with the weight of shaft and gearbox.

    A bearing's force acts in its middle: a section there is in front of it. Bearings carry no
    torque about x where the gearbox holds it. Rings of bearings have no weight here; those of load
    points are in the loads of `shafts.response.entering`.

    Parameters
    ----------
    scene : Scene
        The scene; a nose is rigid.
    x : sequence of float
        Where the sections are, on the shaft [m].
    supports : mapping of str to array_like (6, 6), optional
        Stiffness of bearings with their housings; others are the joint alone, in a rigid housing.
    weight : bool
        Whether shaft and gearbox have their weight.

    Raises
    ------
    InputError
        The supports leave the shaft free to move.
    """
    beam = _beam(scene, supports or {})
    shaft = scene.shaft
    stations = [shaft.front, *((band.low + band.high) / 2 for band in scene.bands.values())]
    found = unit_load_response(beam, [*stations, shaft.rear], [shaft.front])
    n = 6 * len(stations)
    reactions = found.reaction.reshape(len(beam.supports), 6, -1)
    hanging, g = (scene.gearbox.weight, GRAVITY) if weight else (0.0, 0.0)
    weighed = -hanging * reactions[:, :, n + 2] - g * found.gravity_reaction[:, :, 2]
    places = np.append(np.asarray(x, dtype=float), shaft.rear)
    unit, constant = np.zeros((len(places), 6, n)), np.zeros((len(places), 6))
    for s, place in enumerate(places):
        rear = s == len(places) - 1
        for k, station in enumerate(stations):
            if station < place or k == 0:
                unit[s, :, 6 * k : 6 * k + 6] += _carried(station, place)
        for support, R, fixed in zip(beam.supports, reactions, weighed, strict=True):
            if support.x < place or rear:
                unit[s] -= _carried(support.x, place) @ R[:, :n]
                constant[s] -= _carried(support.x, place) @ fixed
        constant[s] += g * _mass_in_front(scene, place)
    constant[-1, 2] -= hanging
    length = np.array([1.0] * 3 + [shaft.length] * 3)
    left = unit[-1] * np.tile(length, len(stations)) / length[:, None]
    weights = constant[-1] / length / max(g * -_mass_in_front(scene, shaft.rear)[2], 1.0)
    imbalance = float(max(np.abs(left).max(), np.abs(weights).max()))
    return SectionLoads(places[:-1], unit[:-1], constant[:-1], imbalance)


def _carried(start: float, place: float) -> Floats:
    """(6, 6) resultant about one point of the axis of loads at another."""
    return wrench_transport(np.array([start - place, 0.0, 0.0]))


def _beam(scene: Scene, supports: Mapping[str, ArrayLike]) -> Beam:
    """The scene's shaft on its bearings, which let it turn where the gearbox does not."""
    turns = scene.gearbox.stiffness[_TURN] != 0
    held: dict[str, Floats] = {}
    for unit in scene.bearing_units:
        name = unit.bearing.name
        K = np.array(supports.get(name, joint_stiffness(unit)), dtype=float)
        if turns and np.isinf(K[_TURN, _TURN]):
            K[_TURN, _TURN] = 0.0
        held[name] = free_to_turn(K) if turns and K[_TURN, _TURN] != 0.0 else K
    beam = beam_of_scene(scene, held)
    on_nose = [Support(b.name, b.x, np.diag(as_numbers(b.stiffness))) for b in scene.nose_bearings]
    return Beam(beam.sections, [*beam.supports, *on_nose], beam.start, beam.material, beam.shear)


def _mass_in_front(scene: Scene, place: float) -> Floats:
    """(6,) force about a place of the shaft in front of it, by a unit of gravity [kg, kg m]."""
    density = scene.material_of("shaft").density
    force = moment = 0.0
    start = scene.shaft.front
    for piece in scene.shaft.pieces:
        end = min(start + piece.length, place)
        if end <= start:
            break
        along, weights = np.polynomial.legendre.leggauss(_POINTS)
        at = start + 0.5 * (end - start) * (along + 1.0)
        mass = 0.5 * (end - start) * weights * density * _area(piece, (at - start) / piece.length)
        force += float(mass.sum())
        moment += float(mass @ (at - place))
        start += piece.length
    # a force -F at an arm a along x has the moment a F about y
    return np.array([0.0, 0.0, -force, 0.0, moment, 0.0])


def _area(piece: Section, share: Floats) -> Floats:
    outer = piece.outer_diameter + share * (piece.end_diameter - piece.outer_diameter)
    return np.asarray(np.pi / 4.0 * (outer**2 - piece.inner_diameter**2))
