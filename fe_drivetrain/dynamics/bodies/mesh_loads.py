"""Loads of gear meshes over the face width and over a turn of the rotor, for any load of the hub.

At each azimuth the springs of the meshes answer linearly to gravity and to the six loads of the
hub. Slices that would pull are apart: their gaps follow from the forces that gaps cause, which is
`static` with contacts, solved in the forces of the meshes alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.dynamics.bodies.bodies import assemble
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.levels import Level, assembly, azimuths
from fe_drivetrain.dynamics.bodies.static import solved
from fe_drivetrain.dynamics.bodies.system import System, springs_named

AnyMachine = TypeVar("AnyMachine", bound=MachineTable)

_CONTACT = 1e-12
"""Forces below this share of the largest one count as none."""


@dataclass(frozen=True)
class MeshLoads:
    """Forces of the meshes under one load.

    Attributes
    ----------
    azimuths : ndarray, (a,)
        Azimuths of the rotor [rad].
    slices : dict of str to ndarray, (a, p, s)
        Force of each slice of each planet's mesh along the line of action in space [N], from the
        end at the smallest x; p is 1 of a pair. By the names of `machine_pairs`.
    """

    azimuths: Floats
    slices: dict[str, Floats]

    __repr__ = short_repr


class MeshResponses:
    """Responses of all meshes of a machine to gravity and to loads of the hub.

    Parameters
    ----------
    machine : MachineTable
        The machine, with a rotor that has a mass.
    level : Level
        Rigid bodies, or flexible shafts.
    count : int
        Number of azimuths over a turn of the rotor.
    slices : int
        Number of slices of each mesh.
    weight : bool
        Whether the rotor has its weight: loads of a hub as files have them hold it already.
    flexible : Flexible or None
        What gives beside meshes, bearings and shafts; None for nothing.

    Raises
    ------
    InputError
        Something moves freely.
    """

    def __init__(
        self,
        machine: MachineTable,
        level: Level,
        count: int,
        slices: int,
        weight: bool = True,
        flexible: Flexible | None = None,
    ) -> None:
        sliced = with_slices(machine, slices)
        self.azimuths = azimuths(count)
        self.meshes = mesh_springs(machine)
        self._at = [
            _responses(sliced, level, float(at), self.meshes, weight, flexible)
            for at in self.azimuths
        ]

    def under(self, torque: float, hub: ArrayLike = (0.0,) * 6) -> MeshLoads:
        """Forces under a torque and a wrench of the hub.

        Parameters
        ----------
        torque : float
            Torque of the rotor, in the sense in which it drives [N m].
        hub : array_like, (6,)
            Other forces and moments on the rotor [N, N m].

        Raises
        ------
        InputError
            The contacts do not settle.
        """
        wrench = np.asarray(hub, dtype=float).copy()
        wrench[3] += torque
        found: dict[str, list[Floats]] = {name: [] for name in self.meshes}
        for one in self._at:
            forces = one.pressed(np.concatenate([[1.0], wrench]))
            for name, places in one.places.items():
                found[name].append(forces[places])
        return MeshLoads(self.azimuths, {name: np.array(rows) for name, rows in found.items()})


def with_slices(machine: AnyMachine, slices: int) -> AnyMachine:
    """The machine with a number of slices of each mesh."""
    stages = tuple(stage.model_copy(update={"slices": slices}) for stage in machine.stages)
    return machine.model_copy(update={"stages": stages})


def mesh_springs(machine: MachineTable) -> dict[str, tuple[str, ...]]:
    """Names of the springs of each mesh, one for each planet, by the names of `machine_pairs`."""
    found: dict[str, tuple[str, ...]] = {}
    for number, stage in enumerate(machine.stages, start=1):
        if isinstance(stage, PlanetaryData):
            for mesh in ("sun-planet", "ring-planet"):
                name = f"stage {number} {mesh}"
                found[name] = tuple(f"{name} {k + 1}" for k in range(stage.planets))
        else:
            name = f"stage {number} mesh"
            found[name] = (name,)
    return found


@dataclass(frozen=True)
class _Responses:
    """Forces (m, 7) of the meshes' springs to unit loads, and (m, m) to unit gaps; see `static`."""

    forces: Floats
    of_gaps: Floats
    places: dict[str, Ints]

    def pressed(self, loads: Floats) -> Floats:
        """(m,) forces under the loads (7,), none of which pulls."""
        linear = self.forces @ loads
        apart = np.zeros(len(linear), dtype=bool)
        tried: set[bytes] = set()
        while True:
            tried.add(apart.tobytes())
            forces, gaps = self._with(linear, apart)
            tiny = _CONTACT * float(np.abs(linear).max(initial=0.0))
            wanted: Bools = np.where(apart, gaps < 0.0, forces < -tiny)
            if np.array_equal(wanted, apart):
                return forces
            apart = wanted
            if apart.tobytes() in tried:
                raise InputError(
                    "the contacts of the gears do not settle: the same slices open and close in "
                    "turn; give more torque, or less load on the hub"
                )

    def _with(self, linear: Floats, apart: Bools) -> tuple[Floats, Floats]:
        """Forces and gaps (m,) with some springs apart."""
        gaps = np.zeros(len(linear))
        if not apart.any():
            return linear, gaps
        of = self.of_gaps[np.ix_(apart, apart)]
        gaps[apart] = np.linalg.solve(of, linear[apart])
        forces = linear - self.of_gaps @ gaps
        forces[apart] = 0.0
        return forces, gaps


def _responses(
    machine: MachineTable,
    level: Level,
    azimuth: float,
    meshes: dict[str, tuple[str, ...]],
    weight: bool,
    flexible: Flexible | None,
) -> _Responses:
    """Responses of the meshes with the rotor at an azimuth [rad]."""
    built = assembly(machine, level, azimuth, held_generator=True, flexible=flexible)
    # with bodies without mass: gaps load a housing that has none, too
    system = assemble(built.bodies, built.springs, built.superelements)
    chosen, places = _chosen(system, meshes)
    rows, k = system.rows[chosen], system.stiffness[chosen]
    loads = np.column_stack([_gravity(system, weight), _hub(system)])
    q = solved(system, system.K, np.column_stack([loads, rows.T * k]))
    stretch = rows @ q
    forces = k[:, None] * stretch
    return _Responses(forces[:, :7], np.diag(k) - forces[:, 7:], places)


def _chosen(
    system: System, meshes: dict[str, tuple[str, ...]]
) -> tuple[list[int], dict[str, Ints]]:
    """Numbers of the springs of all meshes, and where those of each planet's are among them."""
    chosen: list[int] = []
    places: dict[str, Ints] = {}
    for name, springs in meshes.items():
        rows: list[Sequence[int]] = []
        for spring in springs:
            numbers = springs_named(system.spring_names, spring)
            rows.append(range(len(chosen), len(chosen) + len(numbers)))
            chosen.extend(numbers)
        places[name] = np.array(rows)
    return chosen, places


def _gravity(system: System, weight: bool) -> Floats:
    """(n,) load of gravity, without the rotor's where that is in the loads of the hub."""
    down = np.array([0.0, 0.0, -GRAVITY])
    load = system.gravity(down)
    if weight:
        return load
    mass = system.body_mass[system.bodies.index("rotor")]
    return load - system.load_on("rotor", np.concatenate([mass * down, np.zeros(3)]))


def _hub(system: System) -> Floats:
    """(n, 6) loads of a unit force and moment on the rotor."""
    return np.column_stack([system.load_on("rotor", row) for row in np.eye(6)])
