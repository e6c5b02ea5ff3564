"""A gearbox whose housing stands beside the main shaft: shifted along and turned about each axis.

All that the housing holds moves with it: its bearings and rings. Springs to them are then free at
another place, by the motion of the housing where each of them is, so that the offset is a load of
springs that are there anyway, in six degrees of freedom, and main bearings, shafts and the
generator take what it needs to bend them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.dynamics.bodies.equations import Equations
from fe_drivetrain.dynamics.bodies.levels import assembly
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.dynamics.time.running import Running

FARTHEST, STEEPEST = 0.05, 0.02
"""Largest offset [m] and tilt [rad]."""


@dataclass(frozen=True)
class GearboxOffset:
    """Offset of a gearbox's housing, of its point on the axis at the end of the main shaft.

    Attributes
    ----------
    gearbox_ux, gearbox_uy, gearbox_uz : float
        Shift along the rotor's axis downwind, to the side, and up [m].
    gearbox_rx, gearbox_ry, gearbox_rz : float
        Rotation about these [rad].
    """

    gearbox_ux: float = 0.0
    gearbox_uy: float = 0.0
    gearbox_uz: float = 0.0
    gearbox_rx: float = 0.0
    gearbox_ry: float = 0.0
    gearbox_rz: float = 0.0

    @property
    def gearbox(self) -> Floats:
        """(6,) shift and rotation [m, rad]."""
        return np.array([getattr(self, f"gearbox_{motion}") for motion in MOTIONS])

    def check_gearbox(self) -> None:
        """Refuse values that are out of their range."""
        for motion, value in zip(MOTIONS, self.gearbox.tolist(), strict=True):
            most, unit = (FARTHEST, "m") if motion.startswith("u") else (STEEPEST, "rad")
            if not -most <= value <= most:
                raise InputError(
                    f"gearbox_{motion} of the event is {value:g} {unit} but must be from "
                    f"{-most:g} to {most:g} {unit}: change it"
                )

    def moved(self, of: Running, equations: Equations) -> Equations:
        """Equations whose housing stands at the offset.

        Parameters
        ----------
        of : Running
            The machine at a level with all motions.
        equations : Equations
            Its equations, whose first springs are those of its system.

        Raises
        ------
        InputError
            A bearing of the gearbox is on a shaft without mass, or there is no gearbox.
        """
        if not self.gearbox.any():
            return equations
        if not of.machine.stages:
            raise InputError(f"{of.machine.title!r} has no gearbox: leave its offset out")
        free = elongations(of.machine, of, self.gearbox)
        lost = [
            name
            for name, value in zip(of.system.spring_names, free.tolist(), strict=True)
            if value and name in of.system.unchangeable
        ]
        if lost:
            raise InputError(
                f"{lost[0].rpartition(' ')[0]!r} is on a shaft without mass, whose nodes follow "
                "what holds them where it is: give the shaft its size, or take the level 'rigid'"
            )
        offset = equations.springs.offset.copy()
        offset[: len(free)] += free
        return replace(equations, springs=replace(equations.springs, offset=offset))


def elongations(machine: Machine, of: Running, motion: Floats) -> Floats:
    """(m,) elongation at which each spring of a system is free, once its housing has moved.

    Parameters
    ----------
    machine : Machine
        Table of the machine.
    of : Running
        The machine at a level.
    motion : ndarray, (6,)
        Shift and rotation of the housing about the end of the main shaft [m, rad].
    """
    built = assembly(machine, of.level)
    bodies = {body.name: body for body in built.bodies}
    held = (machine.shafts[0].name, "rotor", "generator")
    of_gearbox = {one.name for one in machine.bearings if one.holds not in held}
    of_gearbox |= {f"stage {k} ring support" for k in range(1, len(machine.stages) + 1)}
    about = np.asarray(machine.axes[1])
    found = np.zeros(len(built.springs))
    for i, spring in enumerate(built.springs):
        to_ground = spring.name.rpartition(" ")[0] in of_gearbox
        for name, row in spring.by.items():
            body = bodies[name]
            moved = wrench_transport(np.subtract(body.position, about)).T @ motion
            if to_ground:
                found[i] += float(row @ moved)
            elif name.endswith(" ring") and not body.free:
                found[i] -= float(row @ moved)
    return found
