"""A gearbox whose housing stands beside the main shaft: shifted along and turned about each axis.

All that the housing holds moves with it: its bearings and rings. Seen from the housing, the ground
of all others moves the other way: main bearings and the generator. Their springs are then free at
another place, which stays where it is as carriers turn, so that the offset is a load of springs
that are there anyway, in six degrees of freedom.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_solve
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.dynamics.bodies.bodies import assemble
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
            There is no gearbox.
        """
        if not self.gearbox.any():
            return equations
        if not of.machine.stages:
            raise InputError(f"{of.machine.title!r} has no gearbox: leave its offset out")
        free = elongations(of, self.gearbox)
        offset = equations.springs.offset.copy()
        offset[: len(free)] += free
        return replace(equations, springs=replace(equations.springs, offset=offset))

    def of_generator(self, of: Running) -> Floats:
        """(2,) y and z of a generator that stands on its foundation, seen from the housing [m]."""
        if "generator uy" in of.system.names or not self.gearbox.any():
            return np.zeros(2)
        built = assembly(of.machine, of.level, flexible=of.flexible)
        (body,) = (one for one in built.bodies if one.name == "generator")
        return -_motion_at(of.machine, body.position, self.gearbox)[1:3]


def _motion_at(machine: Machine, at: tuple[float, float, float], motion: Floats) -> Floats:
    """(6,) motion at a place of what moves about the end of the main shaft."""
    moved = wrench_transport(np.subtract(at, machine.axes[1])).T @ motion
    return np.asarray(moved)


def elongations(of: Running, motion: Floats) -> Floats:
    """(m,) elongation at which each spring of a system is free, once the housing has moved.

    Parameters
    ----------
    of : Running
        The machine at a level.
    motion : ndarray, (6,)
        Shift and rotation of the housing about the end of the main shaft [m, rad].
    """
    machine = of.machine
    built = assembly(machine, of.level, flexible=of.flexible)
    bodies = {body.name: body for body in built.bodies}
    apart = (machine.shafts[0].name, "rotor", "generator")
    others = {one.name for one in machine.bearings if one.holds in apart}
    found = np.zeros(len(built.springs))
    for i, spring in enumerate(built.springs):
        if spring.name.rpartition(" ")[0] in others:
            for name, row in spring.by.items():
                found[i] -= float(row @ _motion_at(machine, bodies[name].position, motion))
    # nodes without mass, which follow what they are connected to, follow the offset, too
    whole = assemble(built.bodies, built.springs, built.superelements)
    gone = np.flatnonzero(whole.mass.diagonal() <= 0.0)
    if gone.size:
        H, K = whole.rows[:, gone], whole.K[np.ix_(gone, gone)]
        found -= H @ scaled_solve(K, H.T @ (whole.stiffness * found))
    return found
