"""The gearbox's housing as a body on its mount: the arms and bushings of a drivetrain's file."""

from __future__ import annotations

from dataclasses import replace
from math import fsum

import numpy as np

from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.drivetrain_file.joint_springs import as_numbers
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.scene import RIGID, Scene
from fe_drivetrain.dynamics.bodies.flexible import Flexible, Housing
from fe_drivetrain.dynamics.bodies.machine_shafts import shaft_slices


def gearbox_housing(scene: Scene, machine: MachineTable) -> Housing:
    """The housing of a drivetrain's gearbox on the springs of its mount, at the shaft's rear face.

    ``gearbox.weight`` is that of the gearbox with all that is in it: the housing has what gears and
    shafts leave of it. Its centre of mass is at the shaft's rear face, where the file's weight is.

    Parameters
    ----------
    scene : Scene
        The drivetrain.
    machine : MachineTable
        Its rows, see `machine_of`.

    Returns
    -------
    Housing
        Rigid in itself; its inertias are those of ``gearbox.housing_inertia``, or of
        `assumed_inertia`.

    Raises
    ------
    InputError
        There are no stages; nothing of the mount takes the torque of the ring or gears; or what is
        inside weighs more than the gearbox.
    """
    if not machine.stages:
        raise InputError(f"{scene.title!r} has no gear stages, whose housing could move: add some")
    k = as_numbers(scene.gearbox.stiffness)
    k[~np.isfinite(k)] = RIGID
    if k[3] <= 0:
        raise InputError(
            "gearbox.stiffness is 0 N m/rad about x but the mount must take the torque of the "
            "housing: give its fourth value, of arms at a distance y along z k y^2"
        )
    mass = 0.0
    if scene.gearbox.weight > 0:
        inside = mass_inside(machine)
        mass = scene.gearbox.weight / GRAVITY - inside
        if mass < 0:
            raise InputError(
                f"gearbox.weight is {scene.gearbox.weight:g} N but gears and shafts in it weigh "
                f"{inside * GRAVITY:.6g} N: give the weight of the whole gearbox"
            )
    given = scene.gearbox.housing_inertia
    polar, transverse = given or assumed_inertia(machine, mass)
    at = (machine.shafts[0].length, 0.0, 0.0)
    return Housing(at, np.diag(k), mass, polar, transverse)


def on_mount(scene: Scene, machine: MachineTable, gives: Flexible | None = None) -> Flexible:
    """What gives with the gearbox's housing on its mount, its ring and bearings in it.

    Main bearings, and those of rotor and generator, stand on the ground beside it.

    Parameters
    ----------
    scene, machine : Scene, MachineTable
        The drivetrain and its rows.
    gives : Flexible, optional
        What gives beside the housing.

    Raises
    ------
    InputError
        See `gearbox_housing`.
    """
    housing = gearbox_housing(scene, machine)
    outside = {b.name for b in scene.gearbox.bearings if b.holds in ("rotor", "generator")}
    mains = {bearing.name for bearing in machine.bearings} & set(scene.bearing_names)
    return replace(gives or Flexible(), housing=housing, apart=frozenset(outside | mains))


def stated_mount(drivetrain: Drivetrain, machine: MachineTable) -> Flexible:
    """What gives by a drivetrain's file alone: the gearbox's housing on its mount, see `on_mount`.

    Nothing where the file has no gears, or gives its mount no stiffness: the housing then is rigid
    and stands on the ground.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    machine : MachineTable
        Its rows, see `machine_of`.

    Raises
    ------
    InputError
        See `gearbox_housing`.
    """
    if not isinstance(drivetrain, Scene) or not machine.stages:
        return Flexible()
    if not as_numbers(drivetrain.gearbox.stiffness).any():
        return Flexible()
    return on_mount(drivetrain, machine)


def mass_inside(machine: MachineTable) -> float:
    """Mass of gears, carriers and shafts of a gearbox, without the main shaft [kg]."""
    found = []
    for stage in machine.stages:
        a, width = stage.centre_distance, stage.face_width
        if isinstance(stage, PlanetaryData):
            planet = a - stage.sun_radius
            found.append(stage.carrier.inertias(a, width)[0])
            found.append(stage.planets * stage.planet.inertias(planet, width)[0])
            found.append(stage.sun.inertias(stage.sun_radius, width)[0])
            if stage.ring is not None:
                found.append(stage.ring.inertias(a + planet, width)[0])
        else:
            found.append(stage.gear.inertias(stage.gear_radius, width)[0])
            found.append(stage.pinion.inertias(a - stage.gear_radius, width)[0])
    for shaft in machine.shafts[1:]:
        if shaft.has_mass:
            slices = shaft_slices(shaft, 0.0, shaft.length)
            found.append(shaft.material.density * fsum(s.length * s.section.area for s in slices))
    return fsum(found)


def assumed_inertia(machine: MachineTable, mass: float) -> tuple[float, float]:
    """Inertia about x and across of a housing that is a thin tube round the largest gear [kg m^2].

    Its radius is that of the largest ring, or half of the largest pair; it reaches from the first
    stage to the last.

    Parameters
    ----------
    machine : MachineTable
        The machine.
    mass : float
        Mass of the housing [kg].
    """
    radius = max(
        2 * stage.centre_distance - stage.sun_radius
        if isinstance(stage, PlanetaryData)
        else stage.centre_distance
        for stage in machine.stages
    )
    length = machine.axes[-1][0] - machine.axes[1][0]
    return mass * radius**2, mass * (radius**2 / 2 + length**2 / 12)
