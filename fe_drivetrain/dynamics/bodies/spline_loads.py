"""Loads of a machine's splines in statics, and how near their teeth are to lifting."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.couplings import SplineData
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.dynamics.bodies.advice import Rung
from fe_drivetrain.dynamics.bodies.levels import Level, azimuths, machine_system, steady_load
from fe_drivetrain.dynamics.bodies.static import Static, static
from fe_drivetrain.gear.splines import LoadedSpline, loaded_spline

_ACROSS = [1, 2, 4, 5]
"""Shifts and tilts across the axis among six motions."""


@dataclass(frozen=True)
class SplineLoad:
    """A spline over a turn of the rotor.

    Attributes
    ----------
    data : SplineData
        The spline.
    torque : float
        Its torque, the size [N m].
    motion : Floats
        Motion (a, 4) uy, uz, ry, rz of what is behind it against what is before it [m, rad].
    """

    data: SplineData
    torque: float
    motion: Floats

    __repr__ = short_repr

    @property
    def shift(self) -> float:
        """Largest shift across its axis [m]."""
        return float(np.hypot(*self.motion[:, :2].T).max())

    @property
    def tilt(self) -> float:
        """Largest tilt [rad]; 0 of a spline of one slice, which no moment tells."""
        return float(np.hypot(*self.motion[:, 2:].T).max())

    @property
    def used(self) -> float:
        """Largest share of the teeth's indentation that shift and tilt take at an edge.

        No tooth lifts below 1, and the springs of the spline are exact.
        """
        spline = self.data.spline
        out = np.hypot(*self.motion[:, :2].T) + spline.edge * np.hypot(*self.motion[:, 2:].T)
        return float(out.max()) / spline.indentation(self.torque)

    @property
    def worst(self) -> LoadedSpline:
        """Loads of the teeth where one slice carries most."""
        each = [loaded_spline(self.data.spline, self.torque, motion) for motion in self.motion]
        return max(each, key=lambda one: one.peak_over_mean)


def spline_motion(state: Static, name: str, data: SplineData) -> tuple[float, Floats]:
    """Torque, its size [N m], and motion (4,) of a spline in an equilibrium, as in `SplineLoad`.

    Parameters
    ----------
    state : Static
        The equilibrium.
    name : str
        Name of the spline's shaft.
    data : SplineData
        The spline.
    """
    wrench, k = state.wrench(f"{name} spline"), np.array(data.bushing)[_ACROSS]
    motion = np.divide(wrench[_ACROSS], k, out=np.zeros(4), where=k > 0.0)
    return abs(float(wrench[3])), np.asarray(motion)


def spline_loads(
    machine: MachineTable,
    rung: Rung,
    torque: float,
    hub: ArrayLike = (0.0,) * 6,
    *,
    count: int = 12,
    weight: bool = True,
) -> dict[str, SplineLoad]:
    """Loads of all splines of a machine by the names of their shafts, over a turn of the rotor.

    Parameters
    ----------
    machine : MachineTable
        The machine.
    rung : Rung
        Level and what gives; bearings are springs. The torsional one has none but torques.
    torque : float
        Torque on the rotor, its size [N m].
    hub : array_like, (6,)
        Other forces and moments on the rotor [N, N m].
    count : int
        Number of azimuths.
    weight : bool
        Whether the rotor has its weight: loads of a hub as files have them hold it already.
    """
    data = {s.name: s.spline for s in machine.shafts if s.spline is not None}
    if not data or rung.level is Level.TORSIONAL:
        return {}
    wrench = np.array(hub, dtype=float)
    wrench[2] += 0.0 if weight else GRAVITY * machine.rotor.apart[0]
    found: dict[str, list[tuple[float, Floats]]] = {name: [] for name in data}
    for azimuth in azimuths(count).tolist():
        system = machine_system(
            machine, rung.level, azimuth, held_generator=True, flexible=rung.flexible
        )
        state = static(system, steady_load(machine, system, torque, wrench))
        for name, one in data.items():
            found[name].append(spline_motion(state, name, one))
    return {
        name: SplineLoad(
            data[name], max(each[0] for each in rows), np.array([each[1] for each in rows])
        )
        for name, rows in found.items()
    }
