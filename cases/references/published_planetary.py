"""Planetary stages with printed natural frequencies: Lin and Parker 1999, Cooley and Parker 2012.

Inputs and frequencies were read in the tests of a public program that follows these papers
(gfsReboucas/Drivetrain-python, tests/test_lin_parker_1999.py), not in the papers: second-hand.
"""

from dataclasses import dataclass, replace
from math import cos, radians

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.dynamics.bodies.bodies import PLANE, assemble
from fe_drivetrain.dynamics.bodies.planetary import (
    Inertias,
    PinBearing,
    PlanetarySet,
    bodies_of,
    equal_angles,
    springs_of,
)
from fe_drivetrain.dynamics.bodies.springs import Place, Spring, bushing
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.gear.working_angles import Mesh

LIN_PARKER = "Lin and Parker 1999, J. Vib. Acoust. 121, 316, Table 2, as in a public program"
COOLEY_PARKER = "Cooley and Parker 2012, J. Vib. Acoust. 134, 061014, as in a public program"


@dataclass(frozen=True)
class PlaneStage:
    """Inputs of a planetary stage in its plane, as these papers give them.

    Attributes
    ----------
    masses : tuple[float, float, float, float]
        Masses of sun, ring, carrier and planet [kg].
    inertias : tuple[float, float, float, float]
        The same over the radius squared, of the base circles and of the carrier's pins [kg].
    base_diameters : tuple[float, float]
        Base diameters of sun and planet [m].
    mesh, pin, sun, ring, carrier : float
        Stiffness of a mesh, of a planet's bearing and across each central body's [N/m].
    turning : tuple[float, float, float]
        Stiffness of sun, ring and carrier about their axis, over the radius squared [N/m].
    pressure_angle : float
        Pressure angle of both meshes [deg].
    """

    masses: tuple[float, float, float, float]
    inertias: tuple[float, float, float, float]
    base_diameters: tuple[float, float]
    mesh: float
    pin: float
    sun: float
    ring: float
    carrier: float
    turning: tuple[float, float, float]
    pressure_angle: float


LIN_PARKER_STAGE = PlaneStage(
    masses=(0.4, 2.35, 5.43, 0.66),
    inertias=(0.39, 3.0, 6.29, 0.61),
    base_diameters=(0.0774, 0.1003),
    mesh=5e8,
    pin=1e8,
    sun=1e8,
    ring=1e8,
    carrier=1e8,
    turning=(0.0, 1e9, 0.0),
    pressure_angle=24.6,
)
COOLEY_PARKER_STAGE = PlaneStage(
    masses=(3.0, 7.64, 12.0, 1.86),
    inertias=(1.75, 8.09, 6.80, 1.25),
    base_diameters=(0.05575, 0.027),
    mesh=1e8,
    pin=1e7,
    sun=2e7,
    ring=1e8,
    carrier=5e7,
    turning=(2e7, 1e8, 1e8),
    pressure_angle=20.0,
)


@dataclass(frozen=True)
class Printed:
    """Frequencies as printed: of rotational, translational (each twice) and planet modes.

    Attributes
    ----------
    rotational, translational, planet : tuple[str, ...]
        Digits as printed.
    """

    rotational: tuple[str, ...]
    translational: tuple[str, ...]
    planet: tuple[str, ...] = ()


_PLANET = ("1808.2", "5963.8", "6981.7")
#: [Hz], by the number of planets; planet modes are there N - 3 times.
LIN_PARKER_PRINTED = {
    3: Printed(
        ("0", "1475.7", "1930.3", "2658.3", "7462.8", "11775.3"),
        ("743.2", "1102.4", "1896.0", "2276.4", "6986.3", "9647.9"),
    ),
    4: Printed(
        ("0", "1536.6", "1970.6", "2625.7", "7773.6", "13071.1"),
        ("727.0", "1091.0", "1892.8", "2342.5", "7189.9", "10437.6"),
        _PLANET,
    ),
    5: Printed(
        ("0", "1567.4", "2006.1", "2614.8", "8065.4", "14253.1"),
        ("710.0", "1072.0", "1888.1", "2425.3", "7382.4", "11172.3"),
        _PLANET,
    ),
}
_OTHER_PLANET = ("0.9617", "4.320", "5.672")
#: Over sqrt(k_p / m_p), at rest.
COOLEY_PARKER_PRINTED = {
    3: Printed(
        ("0.9296", "1.090", "1.358", "1.931", "5.566", "7.741"),
        ("0.7432", "1.018", "1.265", "1.487", "4.976", "6.282"),
    ),
    4: Printed(
        ("0.9077", "1.046", "1.317", "2.013", "5.809", "8.383"),
        ("0.7199", "1.001", "1.317", "1.481", "5.153", "6.488"),
        _OTHER_PLANET,
    ),
    5: Printed(
        ("0.8802", "1.019", "1.281", "2.090", "6.030", "8.986"),
        ("0.6992", "0.9863", "1.344", "1.496", "5.317", "6.693"),
        _OTHER_PLANET,
    ),
}


def lin_parker_stage(planets: int) -> PlaneStage:
    """The stage of Lin and Parker 1999; of six planets with smaller ones, as the printed overlap.

    Kinds of modes and how often each is there hold for any sizes.
    """
    if planets < 6:
        return LIN_PARKER_STAGE
    return replace(LIN_PARKER_STAGE, base_diameters=(LIN_PARKER_STAGE.base_diameters[0], 0.07))


def plane_stage(stage: PlaneStage, planets: int) -> PlanetarySet:
    """The stage with a geometry that has its base circles; driven by the sun, as in the papers.

    Their model has inertias and stiffnesses about base radii only: the centre distance that the
    base circles of sun and planet ask for, 98 mm in place of the 88 mm of the carrier's diameter in
    the first, and the ring that fits, leave all frequencies as they are.
    """
    angle = radians(stage.pressure_angle)
    sun, planet = (d / 2 for d in stage.base_diameters)
    distance = (sun + planet) / cos(angle)
    ring = sun + 2 * planet
    radii = (sun, ring, distance, planet)
    s, r, c, p = (
        Inertias(m, i * radius**2)
        for m, i, radius in zip(stage.masses, stage.inertias, radii, strict=True)
    )
    return PlanetarySet(
        "",
        distance,
        sun / cos(angle),
        Mesh(angle),
        Mesh(angle),
        equal_angles(planets),
        carrier=c,
        ring=r,
        sun=s,
        planet=p,
        sun_stiffness=stage.mesh,
        ring_stiffness=stage.mesh,
        bearings=(PinBearing((0, stage.pin, stage.pin, 0, 0, 0)),),
        driving=-1,
        free=PLANE,
    )


def plane_system(stage: PlaneStage, planets: int) -> System:
    """The system of such a stage in the frame of the carrier, at 1 rad/s of it."""
    built = plane_stage(stage, planets)
    springs = [*springs_of(built), *plane_supports(stage, built)]
    return assemble(bodies_of(built), springs, frame_speed=1.0)


def plane_supports(stage: PlaneStage, built: PlanetarySet) -> list[Spring]:
    """Springs of the central bodies to the ground."""
    springs: list[Spring] = []
    for part, across, turning, radius in (
        ("sun", stage.sun, stage.turning[0], built.sun_base_radius),
        ("ring", stage.ring, stage.turning[1], built.ring_base_radius),
        ("carrier", stage.carrier, stage.turning[2], built.centre_distance),
    ):
        springs += support(part, (0, across, across, turning * radius**2, 0, 0))
    return springs


def support(body: str, stiffness: tuple[float, float, float, float, float, float]) -> list[Spring]:
    """Springs of a central body at the origin to the ground."""
    origin = (0.0, 0.0, 0.0)
    return bushing(f"{body} support", Place(body, origin), None, origin, stiffness)


def helical_stage(planets: int, offset: float = 0.002) -> PlanetarySet:
    """A helical stage with all degrees of freedom, of the sizes of Lin and Parker's.

    Its teeth, face width and stiffnesses along x and against tilt are assumed: what is asked of it
    is the kinds and multiplicities of its modes (Eritenel and Parker 2009), which hold for any. The
    bearings of the planets are off their middle: with all of them on it, planets that tilt in step
    about their radii push nothing, and one rotational-axial mode is theirs alone.
    """
    flat = plane_stage(lin_parker_stage(planets), planets)
    width, angle = 0.03, np.radians(20.0)

    def thick(inertias: Inertias) -> Inertias:
        mass, polar = inertias.mass, inertias.polar
        return Inertias(mass, polar, polar / 2 + mass * width**2 / 12)

    pitch = flat.sun_mesh.pressure_angle
    mesh = Mesh(pitch, float(angle), width)
    pin = (3e7, 1e8, 1e8, 0, 4e4, 4e4)
    return PlanetarySet(
        "",
        flat.centre_distance,
        flat.sun_radius,
        mesh,
        mesh,
        flat.angles,
        thick(flat.carrier),
        thick(flat.ring),
        thick(flat.sun),
        thick(flat.planet),
        flat.sun_stiffness,
        flat.ring_stiffness,
        (PinBearing(pin, offset),),
        hand=1,
        slices=5,
    )


def helical_system(planets: int, offset: float = 0.002) -> System:
    """The system of `helical_stage`, each central body on a bearing of all six stiffnesses."""
    built = helical_stage(planets, offset)
    springs = springs_of(built)
    for part, radius in (
        ("sun", built.sun_base_radius),
        ("ring", built.ring_base_radius),
        ("carrier", built.centre_distance),
    ):
        turning = 1e9 * radius**2 if part == "ring" else 0.0
        springs += support(part, (5e7, 1e8, 1e8, turning, 1e8 * radius**2, 1e8 * radius**2))
    return assemble(bodies_of(built), springs, frame_speed=1.0)


def printed_values(printed: Printed, planets: int) -> Floats:
    """All frequencies, ascending, each as often as it is there."""
    values = [*printed.rotational, *2 * printed.translational, *(planets - 3) * printed.planet]
    return np.sort(np.array([float(value) for value in values]))
