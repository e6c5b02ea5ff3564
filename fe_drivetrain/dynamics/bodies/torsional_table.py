"""The table of a drivetrain in torsion, from its file: what lumped masses are made of."""

from __future__ import annotations

from typing import Any

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.gear_stages import ParallelData, PlanetaryData
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.dynamics.bodies.levels import shaft_ends, torsional
from fe_drivetrain.dynamics.bodies.machine import machine_of
from fe_drivetrain.dynamics.bodies.machine_shafts import shaft_torsion, spline_bodies
from fe_drivetrain.dynamics.torsion.gear_table import GearTable


def gear_table(drivetrain: Drivetrain | MachineTable) -> GearTable:
    """Inertias, stiffnesses and ratios of a drivetrain, each about the part's own axis.

    Planets with a mass are points of their carrier, and half of a shaft with a mass turns with
    each of its ends, as in `torsional`, so that both have the same frequencies.

    Parameters
    ----------
    drivetrain : Drivetrain or MachineTable
        The drivetrain, with a rotor and a generator.

    Returns
    -------
    GearTable
        For `two_masses`, `stage_masses` and `gear_masses`.

    Raises
    ------
    InputError
        The file lacks what any model of all that turns needs, and the message names its key; or a
        shaft is rigid.
    """
    machine = drivetrain if isinstance(drivetrain, MachineTable) else machine_of(drivetrain)
    system = torsional(machine)
    inertias = {part.name: part.inertia for part in system.inertias}
    stiffness = {shaft.name: shaft_torsion(shaft) for shaft in machine.shafts}
    for k, shaft in enumerate(machine.shafts):
        if stiffness[shaft.name] is None:
            raise InputError(
                f"shaft {shaft.name!r} of {machine.title!r} is rigid, which a table of torsional "
                "springs cannot have: give its torsion, in N m/rad"
            )
        for part, end in zip(spline_bodies(shaft), shaft_ends(machine, k), strict=True):
            inertias[end] += inertias.get(part, 0.0)
    own = machine.generator
    return GearTable.model_validate(
        {
            "title": machine.title,
            "rotor": inertias["rotor"],
            "shafts": [
                {
                    "name": shaft.name,
                    "stiffness": stiffness[shaft.name],
                    "damping": shaft.damping,
                }
                for shaft in machine.shafts
            ],
            "stages": [
                _stage(stage, f"stage {number}", inertias)
                for number, stage in enumerate(machine.stages, start=1)
            ],
            "generator": {
                "inertia": inertias["generator"],
                "stiffness": own.stiffness,
                "damping": own.damping,
            },
        }
    )


def _stage(
    stage: PlanetaryData | ParallelData, name: str, inertias: dict[str, float]
) -> dict[str, Any]:
    """A stage's row; its mesh stiffness and damping about the planet's, or the gear's, axis."""
    if isinstance(stage, ParallelData):
        found: dict[str, Any] = {
            "kind": "parallel",
            "gear": inertias[f"{name} gear"],
            "pinion": inertias[f"{name} pinion"],
            "mesh": stage.about_axis(stage.stiffness),
            "mesh_damping": stage.about_axis(stage.damping),
        }
    else:
        found = {
            "kind": "planetary",
            "planets": stage.planets,
            "carrier": inertias[f"{name} carrier"],
            "planet": inertias[f"{name} planet 1"],
            "sun": inertias[f"{name} sun"],
            "ring_planet": stage.about_axis(stage.ring_planet),
            "sun_planet": stage.about_axis(stage.sun_planet),
            "ring_planet_damping": stage.about_axis(stage.ring_planet_damping),
            "sun_planet_damping": stage.about_axis(stage.sun_planet_damping),
        }
        if stage.teeth is not None:
            found["planet_teeth"] = stage.teeth.planet
    if stage.teeth is None:
        return {**found, "ratio": stage.speed_ratio}
    return {**found, "teeth": (stage.teeth[0], stage.teeth[-1])}
