"""Interface loads of a drivetrain on three points: main bearing and two torque arms.

Shaft and gearbox are one rigid body, held by the forces of a main bearing that takes no moments, by
vertical forces of both arms, and by a lateral force that the arms share: statically determinate, so
that loads follow from those of the hub alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.dynamics.bodies.machine import machine_of
from fe_drivetrain.dynamics.bodies.machine_shafts import shaft_slices
from fe_drivetrain.procedure.interface_loads import GROUND, Body, Interface, LoadTable


@dataclass(frozen=True)
class ThreePoints:
    """Places along the shaft [m], masses [kg] and ratio of a drivetrain on three points.

    Attributes
    ----------
    hub, bearing, entrance, arms, output, generator : float
        x of hub, main bearing, entrance of the gearbox, torque arms, high-speed shaft's coupling,
        generator's supports.
    between_arms : float
        Distance of the arms across the shaft [m].
    offset : float
        y of the high-speed shaft [m].
    shaft_mass, shaft_centre, gearbox_mass, gearbox_centre, generator_mass : float
        Masses, and x of the first two centres; the generator's is above its supports.
    ratio : float
        Speed of the high-speed shaft over that of the rotor; negative where it turns against it.
    """

    hub: float
    bearing: float
    entrance: float
    arms: float
    output: float
    generator: float
    between_arms: float
    offset: float
    shaft_mass: float
    shaft_centre: float
    gearbox_mass: float
    gearbox_centre: float
    generator_mass: float
    ratio: float

    def __post_init__(self) -> None:
        if self.between_arms <= 0.0 or self.arms == self.bearing or self.ratio == 0.0:
            raise InputError(
                f"torque arms {self.between_arms:g} m apart at {self.arms:g} m, main bearing at "
                f"{self.bearing:g} m, ratio {self.ratio:g}: the first must be above 0, arms and "
                "bearing at two places, the ratio not 0"
            )

    @property
    def positions(self) -> dict[str, Floats]:
        """(3,) of each interface [m]."""
        return {
            "hub": np.array([self.hub, 0.0, 0.0]),
            "main bearing": np.array([self.bearing, 0.0, 0.0]),
            "gearbox entrance": np.array([self.entrance, 0.0, 0.0]),
            "left arm": np.array([self.arms, 0.5 * self.between_arms, 0.0]),
            "right arm": np.array([self.arms, -0.5 * self.between_arms, 0.0]),
            "high-speed shaft": np.array([self.output, self.offset, 0.0]),
            "generator supports": np.array([self.generator, self.offset, 0.0]),
        }

    @property
    def centres(self) -> dict[str, Floats]:
        """(3,) centre of mass of each body [m]."""
        return {
            "shaft": np.array([self.shaft_centre, 0.0, 0.0]),
            "gearbox": np.array([self.gearbox_centre, 0.0, 0.0]),
            "generator": self.positions["generator supports"],
        }

    @property
    def interfaces(self) -> tuple[tuple[str, str, str], ...]:
        """Name of each, body that gives its loads, and body that takes them."""
        return (
            ("hub", GROUND, "shaft"),
            ("main bearing", GROUND, "shaft"),
            ("gearbox entrance", "shaft", "gearbox"),
            ("left arm", GROUND, "gearbox"),
            ("right arm", GROUND, "gearbox"),
            ("high-speed shaft", "generator", "gearbox"),
            ("generator supports", GROUND, "generator"),
        )


def three_points_of(
    scene: Scene, between_arms: float, generator_mass: float | None = None
) -> ThreePoints:
    """Places and masses of a drivetrain's file that has one main bearing and a geared gearbox.

    The gearbox is where its weight and its mount are: at the main shaft's rear face.

    Parameters
    ----------
    scene : Scene
        The drivetrain, with ``gearbox.weight``.
    between_arms : float
        Distance of the torque arms across the shaft [m], which no file states.
    generator_mass : float, optional
        Mass of a generator that only turns in the file [kg]; ``generator.mass`` where left out.

    Returns
    -------
    ThreePoints

    Raises
    ------
    InputError
        It has not one main bearing, no gearbox, or no mass of gearbox or generator.
    """
    units = scene.bearing_units
    if len(units) != 1:
        raise InputError(
            f"{scene.title!r} has {len(units)} main bearings but a drivetrain on three points has "
            "one: use a file with one bearing unit"
        )
    machine = machine_of(scene)
    mass = generator_mass or machine.generator.mass
    lacks = {"gearbox.stages": machine.stages, "gearbox.weight": scene.gearbox.weight}
    for key, value in {**lacks, "generator.mass": mass}.items():
        if not value:
            raise InputError(f"{scene.title!r} does not state {key}: add it")
    main, last = machine.shafts[0], machine.shafts[-1]
    slices = shaft_slices(main, 0.0, main.length)
    masses = np.array([main.material.density * s.section.area * s.length for s in slices])
    front, (x, y, _) = scene.shaft.front, machine.axes[-1]
    return ThreePoints(
        hub=front,
        bearing=units[0].bearing.x,
        entrance=front + main.length,
        arms=front + main.length,
        output=front + x,
        generator=front + x + last.length,
        between_arms=between_arms,
        offset=y,
        shaft_mass=float(masses.sum()),
        shaft_centre=front + float(masses @ [s.middle for s in slices] / masses.sum()),
        gearbox_mass=scene.gearbox.weight / GRAVITY,
        gearbox_centre=front + main.length,
        generator_mass=float(mass or 0.0),
        ratio=machine.speeds[-1],
    )


def three_point_loads(places: ThreePoints, time: Floats, hub: Floats) -> LoadTable:
    """Loads at hub, main bearing, entrance, arms, high-speed shaft and generator's supports.

    Quasi-static, without losses: the inertia of the rotor is in the loads of the hub already.

    Parameters
    ----------
    places : ThreePoints
        The drivetrain.
    time : ndarray, (n,)
        [s].
    hub : ndarray, (n, 6)
        Loads of the rotor on the shaft, at the hub [N, N m].
    """
    n = len(time)
    zero = np.zeros(n)
    at, centres = places.positions, places.centres
    masses = (places.shaft_mass, places.gearbox_mass, places.generator_mass)
    weights = {
        name: (mass, centre) for (name, centre), mass in zip(centres.items(), masses, strict=True)
    }
    own = {
        name: np.array([0.0, 0.0, -mass * GRAVITY, 0.0, 0.0, 0.0])
        for name, (mass, _) in weights.items()
    }
    # of gearbox and generator on each other the coupling carries torque alone
    on_gearbox = np.stack([zero, zero, zero, -hub[:, 3] / places.ratio, zero, zero], axis=1)

    def about_bearing(loads: Floats, position: Floats) -> Floats:
        return np.asarray(loads @ wrench_transport(position - at["main bearing"]).T)

    given = about_bearing(hub, at["hub"]) + about_bearing(on_gearbox, at["high-speed shaft"])
    for name in ("shaft", "gearbox"):
        given = given + about_bearing(own[name], weights[name][1])
    # main bearing Fx Fy Fz, lateral force of both arms, vertical force of each
    unit = np.eye(6)
    held = np.stack(
        [
            *unit[:3],
            about_bearing(unit[1], 0.5 * (at["left arm"] + at["right arm"])),
            about_bearing(unit[2], at["left arm"]),
            about_bearing(unit[2], at["right arm"]),
        ],
        axis=1,
    )
    forces = -np.linalg.solve(held, given.T)
    bearing = np.column_stack([*forces[:3], zero, zero, zero])
    left, right = (
        np.column_stack([zero, 0.5 * forces[3], forces[i], zero, zero, zero]) for i in (4, 5)
    )
    entrance = own["shaft"] @ wrench_transport(weights["shaft"][1] - at["gearbox entrance"]).T
    for loads, name in ((hub, "hub"), (bearing, "main bearing")):
        entrance = entrance + loads @ wrench_transport(at[name] - at["gearbox entrance"]).T
    found = {
        "hub": hub,
        "main bearing": bearing,
        "gearbox entrance": entrance,
        "left arm": left,
        "right arm": right,
        "high-speed shaft": on_gearbox,
        "generator supports": on_gearbox - own["generator"],
    }
    return LoadTable(
        np.asarray(time, dtype=np.float64),
        tuple(
            Interface(name, of, on, at[name], np.asarray(found[name]))
            for name, of, on in places.interfaces
        ),
        tuple(Body(name, centre, own[name]) for name, (_, centre) in weights.items()),
    )
