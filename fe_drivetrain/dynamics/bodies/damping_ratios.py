"""Dampers of a machine's springs from damping ratios, the same in torsion at every level."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.turning_parts import DampingRatios
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.dynamics.torsion.damping import shaft_damping

ASSUMED_RATIOS = DampingRatios(shafts=0.006, meshes=0.1)
"""Those of a 2 MW and a 3 MW turbine (Al-Hamadani 2018, section 4.1)."""


def mesh_names(machine: MachineTable) -> list[str]:
    """Names of all meshes: "stage 1 sun-planet 1", "stage 3 mesh" and so on."""
    found = []
    for number, stage in enumerate(machine.stages, start=1):
        if isinstance(stage, PlanetaryData):
            for kind in ("sun-planet", "ring-planet"):
                found += [f"stage {number} {kind} {k + 1}" for k in range(stage.planets)]
        else:
            found.append(f"stage {number} mesh")
    return found


def element_of(spring: str) -> str:
    """Name of the mesh or shaft that a slice or an element of it belongs to; else the spring's."""
    return re.sub(r" (slice|element) \d+(?=( |$))", "", spring)


def with_damping_ratios(
    machine: MachineTable, system: System, ratios: DampingRatios = ASSUMED_RATIOS
) -> System:
    """A machine's system with dampers in all springs that have none.

    In torsion of shafts and in meshes they are those of the torsional level, C = 2 zeta sqrt(k J)
    with J the inertia that both sides oppose to each other (Al-Hamadani 2018, Eq 4.5 and 4.7), so
    that levels differ by their motions alone. Other springs have theirs by the masses of the level
    itself.

    Parameters
    ----------
    machine : MachineTable
        Table of the machine.
    system : System
        System of the machine at any level.
    ratios : DampingRatios
        Damping ratios.
    """
    seconds = _torsional_seconds(machine, ratios)
    own = _dampers(system.rows, system.mass, system.stiffness, ratios.shafts)
    by_name = [seconds.get(element_of(name)) for name in system.spring_names]
    found = np.array(
        [
            given if given > 0.0 else (alone if time is None else time * k)
            for given, alone, time, k in zip(
                system.damping, own, by_name, system.stiffness, strict=True
            )
        ]
    )
    return replace(system, damping=found)


def condensed_seconds(machine: MachineTable, ratios: DampingRatios = ASSUMED_RATIOS) -> float:
    """Damping over stiffness of condensed parts [s]: that of the torsion of the main shaft.

    A condensed main shaft then is damped in torsion as its beam is; 0 of a rigid one.

    Parameters
    ----------
    machine : MachineTable
        Table of the machine.
    ratios : DampingRatios
        Damping ratios of what the table gives no damper for.
    """
    name, simple = f"{machine.shafts[0].name} rx", machine_system(machine, Level.TORSIONAL)
    if name not in simple.spring_names:
        return 0.0
    given = float((simple.damping / simple.stiffness)[simple.spring(name)])
    return given if given > 0.0 else _torsional_seconds(machine, ratios).get(name, 0.0)


def _torsional_seconds(machine: MachineTable, ratios: DampingRatios) -> dict[str, float]:
    """Damping over stiffness of each mesh and each shaft's torsion [s]."""
    simple = machine_system(machine, Level.TORSIONAL)
    meshes, found = set(mesh_names(machine)), {}
    names = np.array([element_of(name) for name in simple.spring_names])
    for name in dict.fromkeys(names.tolist()):
        of = np.flatnonzero(names == name)
        stiffness = float(simple.stiffness[of].sum())
        if not stiffness > 0.0:
            continue
        row = simple.stiffness[of] @ simple.rows[of] / stiffness
        if row.any():
            ratio = ratios.meshes if name in meshes else ratios.shafts
            damper = _dampers(row[None], simple.mass, np.array([stiffness]), ratio)
            found[name] = float(damper[0]) / stiffness
    return found


def _dampers(rows: Floats, mass: Floats, stiffness: Floats, ratio: float) -> Floats:
    """(m,) damper of each row alone, of the inertia that its two sides oppose to each other."""
    moved = np.einsum("ij,ji->i", rows, np.linalg.solve(mass, rows.T))
    found = np.zeros(len(rows))
    for i in np.flatnonzero(moved > 0.0):
        found[i] = shaft_damping(ratio, 1.0 / float(moved[i]), float(stiffness[i]))
    return found
