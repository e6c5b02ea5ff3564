"""Planetary stages, each planet apart, in the frame of the carrier.

The carrier, the ring and the sun have their centres on one axis along x, and planet k stands at the
angle psi_k about it, from y to z. Every body has up to six degrees of freedom; in the frame that
turns with the carrier, the springs of equal planets do not change in time.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import cos, pi, sin

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import along_x
from fe_drivetrain.dynamics.bodies.bodies import ALL, Body
from fe_drivetrain.dynamics.bodies.springs import Place, Spring, bushing, gear_mesh
from fe_drivetrain.gear.working_angles import Mesh

RIGHT_HAND, SPUR, LEFT_HAND = 1, 0, -1
"""Hands of a sun's teeth."""


@dataclass(frozen=True)
class Inertias:
    """Mass and inertias of a body that is symmetric about x.

    Attributes
    ----------
    mass : float
        Mass [kg].
    polar, transverse : float
        Inertias about x and across it, through the centre of mass [kg m^2].
    """

    mass: float
    polar: float
    transverse: float = 0.0


@dataclass(frozen=True)
class PinBearing:
    """A bearing between a planet and its pin, or the flexible pin itself.

    Attributes
    ----------
    stiffness : ArrayLike
        Stiffness (6,), or (6, 6) with couplings, along and about (x, radial, tangential) of the
        planet [N/m, N, N m/rad].
    offset : float
        x from the planet's centre [m].
    name : str
        Name after the planet's number in the names of its springs, such as "upwind"; may be empty.
    damping : ArrayLike
        Damping (6,), or one for all [N s/m, N m s/rad].
    """

    stiffness: ArrayLike
    offset: float = 0.0
    name: str = ""
    damping: ArrayLike = 0.0


@dataclass(frozen=True)
class PlanetarySet:
    """A planetary stage.

    Attributes
    ----------
    name : str
        Prefix of the names of its bodies, "NAME sun", "NAME planet 1" and so on; may be empty.
    centre_distance : float
        Distance of the planets from the axis [m].
    sun_radius : float
        Working pitch radius of the sun [m].
    sun_mesh, ring_mesh : Mesh
        Working angles; `base_helix` of both is the angle alone, and `hand` its sense.
    angles : tuple[float, ...]
        psi of each planet [rad].
    carrier, ring, sun, planet : Inertias
        Inertias of the bodies, the carrier without planets, all planets the same.
    sun_stiffness, ring_stiffness : float
        Stiffness of one planet's mesh along the line of action [N/m].
    bearings : tuple[PinBearing, ...]
        Bearings between each planet and the carrier.
    hand : int
        Hand of the sun's teeth: 1 right, -1 left, 0 spur.
    driving : int
        1 where the carrier drives the sun as it turns about +x (speed up); -1 where the sun drives.
    slices : int
        Number of slices of each mesh over its face width.
    position : tuple[float, float, float]
        Position of the centre of sun, ring and carrier [m].
    free : frozenset[str]
        Degrees of freedom of the bodies; `PLANE` of a stage that stays in its plane.
    pins : tuple[Place, ...]
        Bodies that the planets are on, of a flexible carrier or in bushings; the carrier where
        there are none.
    sun_damping, ring_damping : float
        Damping of each mesh along its line of action [N s/m].
    own : Mapping[str, ArrayLike]
        Stiffness of single bearings in place of that of their row, by the names of their springs,
        as in "NAME pin 1 upwind".
    """

    name: str
    centre_distance: float
    sun_radius: float
    sun_mesh: Mesh
    ring_mesh: Mesh
    angles: tuple[float, ...]
    carrier: Inertias
    ring: Inertias
    sun: Inertias
    planet: Inertias
    sun_stiffness: float
    ring_stiffness: float
    bearings: tuple[PinBearing, ...]
    hand: int = SPUR
    driving: int = 1
    slices: int = 1
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    free: frozenset[str] = ALL
    pins: tuple[Place, ...] = ()
    sun_damping: float = 0.0
    ring_damping: float = 0.0
    own: Mapping[str, ArrayLike] = field(default_factory=dict)
    ratio: float = field(init=False)

    def __post_init__(self) -> None:
        if not 0 < self.sun_radius < self.centre_distance:
            raise InputError(
                f"planetary stage {self.name!r}: the sun's pitch radius is {self.sun_radius:g} m "
                f"but must be above 0 and below the centre distance, {self.centre_distance:g} m: "
                "correct one of them"
            )
        psi = np.sort(np.mod(self.angles, 2 * pi))
        steps = np.diff(np.append(psi, psi[:1] + 2 * pi))
        radius = self.centre_distance - self.sun_radius
        apart = 2 * self.centre_distance * sin(float(steps.min(initial=pi)) / 2)
        if len(psi) > 1 and not apart > 2 * radius:
            raise InputError(
                f"planetary stage {self.name!r}: planets of radius {radius:.4g} m overlap, "
                f"{apart:.4g} m apart: give fewer or smaller ones, or other angles"
            )
        object.__setattr__(self, "ratio", 1 + self.ring_base_radius / self.sun_base_radius)

    @property
    def sun_base_radius(self) -> float:
        """Base radius of the sun in the transverse section [m]."""
        return self.sun_radius * cos(self.sun_mesh.pressure_angle)

    @property
    def planet_base_radius(self) -> float:
        """Base radius of the planet in the transverse section [m]."""
        return (self.centre_distance - self.sun_radius) * cos(self.sun_mesh.pressure_angle)

    @property
    def planet_ring_radius(self) -> float:
        """Working pitch radius of the planet in the ring [m]."""
        return self.planet_base_radius / cos(self.ring_mesh.pressure_angle)

    @property
    def ring_base_radius(self) -> float:
        """Base radius of the ring in the transverse section [m]."""
        turned = self.centre_distance * cos(self.ring_mesh.pressure_angle)
        return turned + self.planet_base_radius

    def full_name(self, part: str) -> str:
        """Name of a body: of "sun", "planet 1" and so on."""
        return f"{self.name} {part}".strip()

    @property
    def planet_names(self) -> tuple[str, ...]:
        """Names of the planets."""
        return tuple(self.full_name(f"planet {k + 1}") for k in range(len(self.angles)))

    def centre(self, k: int | None = None) -> tuple[float, float, float]:
        """Centre of planet k, counted from 0, or of the other bodies [m]."""
        if k is None:
            return self.position
        a, psi = self.centre_distance, self.angles[k]
        x, y, z = self.position
        return (x, y + a * cos(psi), z + a * sin(psi))


def equal_angles(planets: int, first: float = 0.0) -> tuple[float, ...]:
    """Angles of equally spaced planets [rad]."""
    return tuple(first + 2 * pi * k / planets for k in range(planets))


def bodies_of(stage: PlanetarySet, carrier_speed: float = 1.0) -> list[Body]:
    """Carrier, ring, sun and planets, with absolute speeds over the reference speed.

    Parameters
    ----------
    stage : PlanetarySet
        Planetary stage with its ring at rest.
    carrier_speed : float
        Speed of the carrier, over the reference speed.
    """
    planet_ratio = 1 - stage.ring_base_radius / stage.planet_base_radius
    found = []
    for part, inertias, speed in (
        ("carrier", stage.carrier, 1.0),
        ("ring", stage.ring, 0.0),
        ("sun", stage.sun, stage.ratio),
    ):
        found.append(_body(stage, part, inertias, carrier_speed * speed, stage.centre()))
    for k in range(len(stage.angles)):
        speed = carrier_speed * planet_ratio
        found.append(_body(stage, f"planet {k + 1}", stage.planet, speed, stage.centre(k)))
    return found


def _body(
    stage: PlanetarySet,
    part: str,
    inertias: Inertias,
    speed: float,
    centre: tuple[float, float, float],
) -> Body:
    return Body(
        stage.full_name(part),
        centre,
        inertias.mass,
        inertias.polar,
        inertias.transverse,
        speed,
        stage.free,
    )


def springs_of(stage: PlanetarySet) -> list[Spring]:
    """Meshes and pins: "NAME sun-planet 1", "NAME ring-planet 1", "NAME pin 1 ux" and so on.

    Those of the pins are along and about x, the radius and the tangent of their planet, in this
    order of (ux, uy, uz, rx, ry, rz); of six rows they are "NAME pin 1 1" and so on.
    """
    sun = Place(stage.full_name("sun"), stage.centre())
    ring = Place(stage.full_name("ring"), stage.centre())
    carrier = Place(stage.full_name("carrier"), stage.centre())
    found: list[Spring] = []
    for k, name in enumerate(stage.planet_names):
        planet = Place(name, stage.centre(k))
        out = np.array([0.0, cos(stage.angles[k]), sin(stage.angles[k])])
        axis = np.asarray(stage.centre())
        found += gear_mesh(
            stage.full_name(f"sun-planet {k + 1}"),
            sun,
            planet,
            axis + stage.sun_radius * out,
            _handed(stage.sun_mesh, stage.hand),
            stage.sun_stiffness,
            stage.sun_damping,
            -stage.driving,
            stage.slices,
        )
        found += gear_mesh(
            stage.full_name(f"ring-planet {k + 1}"),
            planet,
            ring,
            np.asarray(planet.centre) + stage.planet_ring_radius * out,
            _handed(stage.ring_mesh, -stage.hand),
            stage.ring_stiffness,
            stage.ring_damping,
            stage.driving,
            stage.slices,
        )
        found += pin_springs(stage, k, planet, stage.pins[k] if stage.pins else carrier)
    return found


def pin_place(stage: PlanetarySet, k: int, *, flexible: bool, bushed: bool) -> Place:
    """What planet k, from 0, is on: its pin in a bushing, on a carrier that gives, or the carrier.

    Parameters
    ----------
    stage : PlanetarySet
        The stage.
    k : int
        Number of the planet, from 0.
    flexible, bushed : bool
        Whether the carrier gives, and whether the pin is in a bushing.
    """
    if bushed:
        return Place(stage.full_name(f"bushed pin {k + 1}"), stage.centre(k))
    if flexible:
        return Place(stage.full_name(f"pin body {k + 1}"), stage.centre(k))
    return Place(stage.full_name("carrier"), stage.centre())


def in_bushings(
    stage: PlanetarySet, stiffness: ArrayLike
) -> tuple[list[Body], list[Spring], PlanetarySet]:
    """Pins that sit in the carrier with a bushing each (Al-Hamadani 2018, Eq 5.5).

    Parameters
    ----------
    stage : PlanetarySet
        The stage, with the pins of its carrier where that gives.
    stiffness : array_like, (6,)
        Stiffness along and about x, the radius and the tangent of the planet [N/m, N m/rad].

    Returns
    -------
    bodies : list of Body
        Pins without mass, "NAME bushed pin 1" and so on.
    springs : list of Spring
        Bushings, "NAME bushing 1 ux" and so on, at the middles of the pins.
    stage : PlanetarySet
        The stage with its planets on these pins.
    """
    pins = tuple(pin_place(stage, k, flexible=False, bushed=True) for k in range(len(stage.angles)))
    springs: list[Spring] = []
    for k, pin in enumerate(pins):
        host = stage.pins[k] if stage.pins else pin_place(stage, k, flexible=False, bushed=False)
        name, axes = stage.full_name(f"bushing {k + 1}"), _axes_of(stage, k)
        springs += bushing(name, pin, host, pin.centre, stiffness, 0.0, axes)
    return [Body(pin.body, pin.centre) for pin in pins], springs, replace(stage, pins=pins)


def _axes_of(stage: PlanetarySet, k: int) -> Floats:
    """(3, 3) x, the radius and the tangent of planet k."""
    psi = stage.angles[k]
    return np.array([[1.0, 0.0, 0.0], [0.0, cos(psi), sin(psi)], [0.0, -sin(psi), cos(psi)]])


def pin_springs(stage: PlanetarySet, k: int, planet: Place, carrier: Place) -> list[Spring]:
    """The springs between planet k, from 0, and what carries it."""
    axes = _axes_of(stage, k)
    found: list[Spring] = []
    for bearing in stage.bearings:
        at = np.asarray(planet.centre) + along_x(bearing.offset)
        name = stage.full_name(f"pin {k + 1} {bearing.name}".strip())
        if name in stage.own:
            found += bushing(name, planet, carrier, at, stage.own[name], 0.0, axes)
        else:
            found += bushing(name, planet, carrier, at, bearing.stiffness, bearing.damping, axes)
    return found


def _handed(mesh: Mesh, hand: int) -> Mesh:
    return Mesh(mesh.pressure_angle, hand * mesh.base_helix, mesh.face_width)


def excited_motion(teeth: int, planets: int, harmonic: int = 1) -> str:
    """Effect of a harmonic of the mesh on a sun with equal, equally spaced planets.

    Its forces sum to a torque alone where l z_s mod N is 0, to a force alone where it is 1 or
    N - 1, and to nothing otherwise (Kahraman and Blankenship 1994; Ambarisha and Parker 2006).

    Parameters
    ----------
    teeth : int
        Number of teeth of the sun.
    planets : int
        Number of planets N.
    harmonic : int
        Harmonic l of the mesh frequency.

    Returns
    -------
    "torque", "force" or "nothing".
    """
    k = (harmonic * teeth) % planets
    return "torque" if k == 0 else "force" if k in (1, planets - 1) else "nothing"
