"""Loads of bearings and the speeds of their rings, read from a machine that runs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics.bodies.bearing_reactions import planet_bearing_name
from fe_drivetrain.dynamics.bodies.levels import Level, assembly
from fe_drivetrain.dynamics.bodies.system import bearing_springs, wrench_of
from fe_drivetrain.dynamics.time.motion import Motion
from fe_drivetrain.dynamics.time.running import Running


@dataclass(frozen=True, eq=False)
class BearingForces:
    """A bearing of a machine that runs, or the same one of all planets of a stage.

    Attributes
    ----------
    name : str
        Name as lives have it: "HS-A"; of planets "stage 1 pin upwind".
    springs : tuple of str
        Name of its springs, one for each planet; one of a bearing in the housing.
    turns : Floats
        Weights (p, n) of the velocities: speed of what a bearing holds against what holds it.
    """

    name: str
    springs: tuple[str, ...]
    turns: Floats

    __repr__ = short_repr

    def of(self, running: Running, motion: Motion) -> tuple[Floats, Floats]:
        """Loads and speeds over a motion that recorded all degrees of freedom.

        Parameters
        ----------
        running : Running
            The machine.
        motion : Motion
            What it did, k records.

        Returns
        -------
        loads : ndarray, (k, p, 6)
            Force and moment at the bearing's centre, in the machine's frame [N, N m].
        speeds : ndarray, (k, p)
            Speed of one ring against the other [rad/s].
        """
        system = running.system
        forces = motion.forces[:, : len(system.spring_names)]
        each = [
            wrench_of(system.spring_names, system.directions, name, forces) for name in self.springs
        ]
        return np.stack(each, axis=1), np.asarray(motion.velocity @ self.turns.T)


def bearing_forces(of: Running) -> dict[str, BearingForces]:
    """All bearings of a machine that runs, by name: in the housing, then of planets.

    Parameters
    ----------
    of : Running
        The machine; bodies that only turn have none.
    """
    if of.level is Level.TORSIONAL:
        return {}
    found = {}
    springs = of.system.spring_names
    for name, (body, _) in assembly(of.machine, of.level, flexible=of.flexible).seats.items():
        if bearing_springs(springs, name):
            found[name] = BearingForces(name, (name,), of.row(body)[None])
    for number, stage in enumerate(of.machine.stages, start=1):
        if not isinstance(stage, PlanetaryData):
            continue
        planets = range(1, stage.planets + 1)
        carrier = of.row(f"stage {number} carrier")
        turns = np.array([of.row(f"stage {number} planet {k}") - carrier for k in planets])
        for pin in stage.pins:
            name = planet_bearing_name(number, pin.name)
            own = tuple(f"stage {number} pin {k} {pin.name}".strip() for k in planets)
            found[name] = BearingForces(name, own, turns)
    return found
