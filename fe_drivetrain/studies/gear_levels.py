"""How each level of a drivetrain's model spreads the load of its meshes over planets and face."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.dynamics.bodies.advice import Rung
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.mesh_loads import MeshLoads, MeshResponses, mesh_springs
from fe_drivetrain.dynamics.bodies.rolling_meshes import RollingMeshes
from fe_drivetrain.gear.load_factors import LoadFactors
from fe_drivetrain.studies.gear_stresses import SHARING, MeshStresses, spread_at_ends

NO_FACTORS: Mapping[str, float] = MappingProxyType({})

LEAST = 0.01
"""Share of the reference torque below which loads are spread as at that share."""


@dataclass(frozen=True, eq=False)
class Spread:
    """How a mesh spreads its load.

    Attributes
    ----------
    azimuths : ndarray, (a,)
        Azimuths of the rotor [rad].
    share : ndarray, (a, p)
        Load of each planet over the mean of all.
    face : ndarray, (a, p, s)
        Load per face width over the planet's mean, from the end at the smallest x to the other;
        with the share that the helix deviation of the accuracy grade adds.
    mean : float
        Mean force of a planet's mesh by statics, normal to the flanks [N]; NaN without statics.
    """

    azimuths: Floats
    share: Floats
    face: Floats
    mean: float = float("nan")

    __repr__ = short_repr

    @property
    def sharing(self) -> float:
        """K_gamma: the largest load of a planet over the mean."""
        return float(self.share.max())

    @property
    def face_load(self) -> float:
        """K_Hbeta: with K_gamma it makes the largest load per face width of all planets.

        A planet that hardly carries has a large load over its own mean, and a small load.
        """
        return float((self.share[..., None] * self.face).max()) / self.sharing

    @property
    def halves(self) -> tuple[Spread, Spread]:
        """The same at every other azimuth, from the first and from the second."""
        first, second = (
            Spread(self.azimuths[k::2], self.share[k::2], self.face[k::2], self.mean)
            if len(self.azimuths) > 1
            else self
            for k in (0, 1)
        )
        return first, second


class LoadSpread:
    """Spread of the loads of all meshes, at one level.

    Parameters
    ----------
    machine : MachineTable
        The machine.
    stresses : mapping of str to MeshStresses
        Meshes that are rated, by name.
    rung : Rung
        Level, and what gives. Torsional: planets and face share by formula; else by statics.
    count : int
        Number of azimuths.
    slices : int
        Number of slices of each mesh.
    weight : bool
        Whether the rotor has its weight.
    reference : float
        Reference torque of the rotor [N m].
    """

    def __init__(
        self,
        machine: MachineTable,
        stresses: Mapping[str, MeshStresses],
        rung: Rung,
        count: int,
        slices: int,
        weight: bool,
        reference: float,
    ) -> None:
        self._stresses, self._least = stresses, LEAST * abs(reference)
        self._planets = {name: len(springs) for name, springs in mesh_springs(machine).items()}
        self._responses: MeshResponses | RollingMeshes | None = None
        level, gives = rung.level, rung.flexible
        if rung.rollers:
            self._responses = RollingMeshes(machine, rung, count, slices, weight)
        elif level is not Level.TORSIONAL:
            self._responses = MeshResponses(machine, level, count, slices, weight, gives)

    def under(
        self,
        torque: float,
        hub: Floats,
        speed: float | None = None,
        application: Mapping[str, float] = NO_FACTORS,
    ) -> dict[str, Spread]:
        """Spread of all meshes under a torque of the rotor and other loads of the hub.

        A torque of the other sense, or hardly any, is spread as one of the driving sense.

        Parameters
        ----------
        torque : float
            Torque of the rotor [N m].
        hub : ndarray, (6,)
            Other loads of the hub [N, N m].
        speed : float or None
            Speed of the rotor, for K_v beside the misalignment [rad/s].
        application : mapping of str to float
            K_A by mesh, beside it; 1 of all others.
        """
        return self.spread(self.statics(torque, hub), torque, speed, application)

    def statics(self, torque: float, hub: Floats) -> MeshLoads | None:
        """Forces of all meshes as in `under`; None of the torsional level, which has none."""
        if self._responses is None:
            return None
        return self._responses.under(self._size(torque), hub)

    def _size(self, torque: float) -> float:
        return max(abs(torque), self._least)

    def spread(
        self,
        loads: MeshLoads | None,
        torque: float,
        speed: float | None,
        application: Mapping[str, float] = NO_FACTORS,
    ) -> dict[str, Spread]:
        """What `under` gives, of forces that `statics` has found."""
        size = self._size(torque)
        at = {name: (size, speed, application.get(name, 1.0)) for name in self._planets}
        if loads is None:
            return {name: self._by_formula(name, *at[name]) for name in self._planets}
        return {
            # teeth do not pull: what does by round-off of a planet without load has no root
            name: self._by_statics(name, at[name], loads.azimuths, np.maximum(forces, 0.0))
            for name, forces in loads.slices.items()
        }

    def _by_formula(
        self, name: str, torque: float, speed: float | None, application: float
    ) -> Spread:
        sharing, face = SHARING.get(self._planets[name], SHARING[7]), 1.0
        if name in self._stresses:
            sharing, face = self._stresses[name].formula(torque, speed, application)
        return Spread(np.zeros(1), np.full((1, 1), sharing), np.full((1, 1, 1), face))

    def _by_statics(
        self,
        name: str,
        at: tuple[float, float | None, float],
        azimuths: Floats,
        forces: Floats,
    ) -> Spread:
        each = forces.sum(axis=2)
        mean = each.mean(axis=1, keepdims=True)
        added, (torque, speed, application) = 0.0, at
        if not mean.all():
            raise InputError(
                f"{name}: a torque of the rotor of {torque:g} N m is lost in the round-off of the "
                "weights beside it, and no tooth carries load in statics: give a larger torque"
            )
        share = each / mean
        slices = np.where(each > 0.0, each, 1.0)[..., None] / forces.shape[2]
        face = np.where(each[..., None] > 0.0, spread_at_ends(forces) / slices, 1.0)
        if name in self._stresses:
            start = LoadFactors(application, float(share.max()))
            added = self._stresses[name].misaligned(torque, speed, start) - 1.0
        return Spread(azimuths, share, face + added, float(each.mean()))
