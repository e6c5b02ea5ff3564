"""Flexible parts of a machine: carriers, shafts and a housing that are condensed elsewhere.

A carrier comes as a free body at its hub and the middles of its pins, of beams or of finite
elements (`fe_drivetrain.shafts.fidelity.component_frames`, `component_solid`); a shaft as one at
its ends and its bearings (`fe_drivetrain.shafts.fidelity.shafts.condensed_shaft`: beam, meridian or
solid); a housing on its supports as the spring that it is at the axis of its ring, or as a
superelement at its ring and bearings. The rim of a ring bends by its harmonics.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import cos, sin

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import along_x, wrench_transport
from fe_drivetrain.dynamics.bodies.bodies import Body, Superelement
from fe_drivetrain.dynamics.bodies.elastic_ring import Rim
from fe_drivetrain.dynamics.bodies.planetary import PlanetarySet, pin_place
from fe_drivetrain.dynamics.bodies.springs import Place, Spring, bushing
from fe_drivetrain.elasticity.solve.condensation import Condensed

#: Allowed distance of a carrier's pin from its planet, over the length.
PLACED = 1e-6

MOUNT = "gearbox mount"
"""Name of the springs that a housing rigid in itself stands on."""


@dataclass(frozen=True)
class Housing:
    """A housing that is rigid in itself, on elastic supports.

    Attributes
    ----------
    position : tuple[float, float, float]
        Position of the point where the stiffness is given [m].
    stiffness : Floats
        Stiffness (6, 6) of supports and arms at that point [N/m, N, N m/rad].
    mass, polar, transverse : float
        Mass [kg], and inertias about x and across it [kg m^2].
    """

    position: tuple[float, float, float]
    stiffness: Floats
    mass: float
    polar: float
    transverse: float

    __repr__ = short_repr


@dataclass(frozen=True)
class ElasticHousing:
    """A housing that deforms between its ring and its bearings, on its supports.

    Attributes
    ----------
    points : tuple[str, ...]
        Names of bearings of the machine, and "stage 1 ring" and so on; what has no point of its own
        is held at the nearest one, as if rigidly joined to it.
    positions : Floats
        Positions (p, 3) of the points [m].
    stiffness : Floats
        Stiffness (6 p, 6 p) with the supports [N/m, N, N m/rad].
    mass : Floats or None
        Mass (6 p, 6 p) [kg, kg m, kg m^2].
    """

    points: tuple[str, ...]
    positions: Floats
    stiffness: Floats
    mass: Floats | None = None

    __repr__ = short_repr

    def holds(self, name: str, at: ArrayLike) -> Place:
        """Place that holds a ring or bearing of a name at a place (3,) [m]."""
        away = np.linalg.norm(self.positions - np.asarray(at, dtype=float), axis=1)
        k = self.points.index(name) if name in self.points else int(away.argmin())
        x, y, z = self.positions[k]
        return Place(f"housing at {self.points[k]}", (float(x), float(y), float(z)))


@dataclass(frozen=True)
class Flexible:
    """Flexible bodies of a machine beside shafts and bearings.

    Attributes
    ----------
    carriers : Mapping[int, Condensed]
        Condensed carriers by the number of the planetary stage, from 1: a free body with the points
        "hub", "pin_1" and so on.
    housing : Housing or ElasticHousing or None
        Housing that rings and bearings are in; none where they are in the ground.
    shafts : Mapping[str, Condensed]
        Condensed shafts by name, in place of their beams: a free body with its points in the order
        of x, the first and the last at its ends, others at its bearings.
    rims : Mapping[int, tuple[Rim, tuple[int, ...]]]
        Rims of rings by the number of the planetary stage, and the harmonics that each bends in,
        from 2 on.
    bearings : Mapping[str, Floats]
        Stiffness (6, 6) of bearings with their housings by name, in place of that of their rows
        [N/m, N, N m/rad]; of planets by the names of their springs, as in "stage 1 pin 1 upwind",
        along and about x, the radius and the tangent.
    apart : frozenset[str]
        Names of bearings that stand on the ground beside a housing, as those of the main shaft and
        of the generator do.
    """

    carriers: Mapping[int, Condensed] = field(default_factory=dict)
    housing: Housing | ElasticHousing | None = None
    shafts: Mapping[str, Condensed] = field(default_factory=dict)
    rims: Mapping[int, tuple[Rim, tuple[int, ...]]] = field(default_factory=dict)
    bearings: Mapping[str, Floats] = field(default_factory=dict)
    apart: frozenset[str] = frozenset()


def carrier_element(
    body: Condensed, stage: PlanetarySet, carrier: str
) -> tuple[list[Body], Superelement, tuple[Place, ...]]:
    """A carrier's pins as bodies, and what joins them to its hub.

    The hub moves with the carrier's own body, which keeps all of its mass; pins have none. The
    condensed body is turned to the angle of the first planet, and moved so that its pins are there.

    Parameters
    ----------
    body : Condensed
        Free, "hub" and as many pins as planets.
    stage : PlanetarySet
        The stage at its azimuth.
    carrier : str
        Name of the carrier's body.

    Raises
    ------
    InputError
        Pins are not where planets are.
    """
    names = [f"pin_{k + 1}" for k in range(len(stage.angles))]
    wanted = ("hub", *names)
    if set(body.names) != set(wanted):
        raise InputError(
            f"carrier of {stage.name!r} has the points {', '.join(body.names)} but must have "
            f"{', '.join(wanted)}, one pin for each planet: condense it at these"
        )
    order = [body.names.index(name) for name in wanted]
    rows = np.concatenate([6 * k + np.arange(6) for k in order])
    own = body.positions[order]
    first = np.arctan2(own[1][2], own[1][1])
    angle = stage.angles[0] - first
    turn = np.array([[1, 0, 0], [0, cos(angle), -sin(angle)], [0, sin(angle), cos(angle)]])
    shift = np.asarray(stage.position) - along_x(own[1][0])
    places = own @ turn.T + shift
    centres = np.array([stage.centre(), *(stage.centre(k) for k in range(len(stage.angles)))])
    apart = float(np.abs(places[1:] - centres[1:]).max())
    if apart > PLACED * stage.centre_distance:
        raise InputError(
            f"carrier of {stage.name!r} has pins {apart:.3g} m from where its planets are: give "
            f"one with pins at equal angles on a circle of {2 * stage.centre_distance:g} m"
        )
    whole = np.kron(np.eye(2 * len(own)), turn)
    K = whole @ body.stiffness[np.ix_(rows, rows)] @ whole.T
    arm = np.eye(6 * len(own))
    arm[:6, :6] = wrench_transport(places[0] - centres[0])
    K = arm @ K @ arm.T
    pins = tuple(pin_place(stage, k, flexible=True, bushed=False) for k in range(len(stage.angles)))
    bodies = [Body(pin.body, pin.centre) for pin in pins]
    joined = (carrier, *(pin.body for pin in pins))
    return bodies, Superelement(f"{stage.name} carrier", joined, (K + K.T) / 2), pins


def housing_bodies(
    housing: Housing | ElasticHousing,
) -> tuple[list[Body], list[Superelement], list[Spring]]:
    """The housing's body, or those of its points, and what holds it on the ground."""
    if isinstance(housing, ElasticHousing):
        places = [
            housing.holds(n, p) for n, p in zip(housing.points, housing.positions, strict=True)
        ]
        names = tuple(place.body for place in places)
        K = np.asarray(housing.stiffness, dtype=float)
        bodies = [Body(place.body, place.centre) for place in places]
        return bodies, [Superelement("housing", names, K, housing.mass)], []
    at = housing.position
    body = Body("housing", at, housing.mass, housing.polar, housing.transverse)
    K = np.asarray(housing.stiffness, dtype=float)
    coupled = (np.diag(K.diagonal()) != K).any()
    # springs, not a superelement: dampers, forces and energy are those of springs
    springs = bushing(MOUNT, Place("housing", at), None, at, K if coupled else K.diagonal())
    return [body], [], springs


def held_by(housing: Housing | ElasticHousing | None, name: str, at: ArrayLike) -> Place | None:
    """Place that holds a ring or bearing of a name at a place (3,); none is the ground."""
    if isinstance(housing, ElasticHousing):
        return housing.holds(name, at)
    return None if housing is None else Place("housing", housing.position)


def shaft_element(
    name: str,
    body: Condensed,
    begin: tuple[float, float, float],
    length: float,
    ends: tuple[Place, Place],
    with_mass: bool,
) -> tuple[list[Place], Superelement]:
    """A shaft's points, and what joins them.

    Parameters
    ----------
    name : str
        Name of the shaft.
    body : Condensed
        Condensed body, free, at its ends and bearings.
    begin : tuple of float
        Position of the shaft's beginning [m].
    length : float
        Length of the shaft [m].
    ends : tuple of Place
        Bodies that its ends are fixed to.
    with_mass : bool
        Whether its mass counts.

    Returns
    -------
    points : list of Place
        Points in the order of x, those of both ends among them.
    element : Superelement

    Raises
    ------
    InputError
        Its points are not on its axis, or not as far apart as it is long.
    """
    order = np.argsort(body.positions[:, 0])
    own = body.positions[order]
    off = max(abs(float(np.ptp(own[:, 0])) - length), float(np.abs(own[:, 1:]).max()))
    if off > PLACED * length:
        raise InputError(
            f"shaft {name!r}: its condensed body is {np.ptp(own[:, 0]):.6g} m long between its "
            f"outermost points, or these are off its axis, but it must be {length:.6g} m long: "
            "condense it at its ends and bearings"
        )
    places = own - own[0] + np.asarray(begin)
    inner = [
        Place(f"{name} node {i}", (float(p[0]), float(p[1]), float(p[2])))
        for i, p in enumerate(places[1:-1], start=1)
    ]
    points = [ends[0], *inner, ends[1]]
    rows = np.concatenate([6 * k + np.arange(6) for k in order])
    arm = np.zeros((6 * len(points),) * 2)
    for k, (point, place) in enumerate(zip(points, places, strict=True)):
        part = slice(6 * k, 6 * k + 6)
        arm[part, part] = wrench_transport(place - np.asarray(point.centre))

    def moved(matrix: Floats) -> Floats:
        found = arm @ matrix[np.ix_(rows, rows)] @ arm.T
        return np.asarray((found + found.T) / 2)

    heavy = with_mass and body.mass is not None
    return points, Superelement(
        name,
        tuple(point.body for point in points),
        moved(body.stiffness),
        moved(np.asarray(body.mass)) if heavy else None,
        np.asarray(arm @ body.gravity[rows]) if heavy else None,
    )
