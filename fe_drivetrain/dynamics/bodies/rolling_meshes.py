"""Loads of gear meshes with catalogued bearings on their rollers, over a turn of the rotor."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.dynamics.bodies.advice import Operation, Rung
from fe_drivetrain.dynamics.bodies.catalogue_seats import on_catalogue
from fe_drivetrain.dynamics.bodies.levels import azimuths
from fe_drivetrain.dynamics.bodies.mesh_loads import MeshLoads, mesh_springs, with_slices
from fe_drivetrain.dynamics.bodies.system import springs_named


class RollingMeshes:
    """Loads of all meshes of a machine on rollers; each load is an equilibrium of its own.

    Parameters
    ----------
    machine : MachineTable
        The machine, with catalogue entries of bearings.
    rung : Rung
        Level, and what gives beside rollers.
    count : int
        Number of azimuths over a turn of the rotor.
    slices : int
        Number of slices of each mesh, which only press.
    weight : bool
        Whether the rotor has its weight: loads of a hub as files have them hold it already.
    """

    def __init__(
        self, machine: MachineTable, rung: Rung, count: int, slices: int, weight: bool = True
    ) -> None:
        self._machine, self._rung, self._weight = with_slices(machine, slices), rung, weight
        self.azimuths = azimuths(count)
        self.meshes = mesh_springs(machine)
        self._known: dict[bytes, MeshLoads] = {}

    def under(self, torque: float, hub: ArrayLike = (0.0,) * 6) -> MeshLoads:
        """Forces under a torque and a wrench of the hub; arguments as of `MeshResponses.under`.

        Raises
        ------
        InputError
            Rollers or contacts find no equilibrium.
        """
        wrench = np.array(hub, dtype=float)
        wrench[2] += 0.0 if self._weight else GRAVITY * self._machine.rotor.apart[0]
        asked = np.append(wrench, torque).tobytes()
        if asked not in self._known:
            each = [self._at(float(at), torque, wrench) for at in self.azimuths]
            forces = {name: np.array([of[name] for of in each]) for name in self.meshes}
            self._known[asked] = MeshLoads(self.azimuths, forces)
        return self._known[asked]

    def _at(self, azimuth: float, torque: float, hub: Floats) -> dict[str, Floats]:
        """(p, s) forces of each mesh at an azimuth [rad]."""
        found = on_catalogue(
            self._machine,
            self._rung,
            Operation(torque),
            azimuth=azimuth,
            hub=hub,
            pressing=[spring for springs in self.meshes.values() for spring in springs],
        )
        if not found.converged:
            raise InputError(
                f"bearings on their rollers find no equilibrium at {np.degrees(azimuth):.3g} deg: "
                "a clearance leaves a part loose; give less clearance, or leave rollers out"
            )
        state = found.static
        return {
            name: np.array(
                [state.forces[springs_named(state.system.spring_names, one)] for one in springs]
            )
            for name, springs in self.meshes.items()
        }
