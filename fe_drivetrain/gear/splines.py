"""Spline couplings: the flanks of all teeth in slices over their width, under torque and tilt.

Each tooth of a slice presses along the normal of its flank. With equal teeth all round, loaded by a
torque, the slices are one spring in each direction as long as no flank lifts; from then on the
flanks that are left carry more. There is no friction, and the shaft slides.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, inf, pi

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr


@dataclass(frozen=True)
class Spline:
    """A spline coupling.

    Attributes
    ----------
    teeth : int
        Number of teeth, all of which carry.
    diameter, length : float
        Pitch diameter, and width over which teeth engage [m].
    stiffness : float
        Stiffness of a pair of teeth along the normal of its flanks, for each width [N/m^2].
    pressure_angle : float
        Pressure angle [rad].
    slices : int
        Number of slices over the width; one leaves the shaft free to tilt.
    """

    teeth: int
    diameter: float
    length: float
    stiffness: float
    pressure_angle: float
    slices: int

    @property
    def flanks(self) -> float:
        """Stiffness of all teeth along the normals of their flanks [N/m]."""
        return self.teeth * self.stiffness * self.length

    @property
    def base_radius(self) -> float:
        """Arm of the flanks' normals [m]."""
        return 0.5 * self.diameter * cos(self.pressure_angle)

    @property
    def edge(self) -> float:
        """Distance of the outermost slice from the middle [m]."""
        return 0.5 * self.length * (1.0 - 1.0 / self.slices)

    @property
    def springs(self) -> tuple[float, float, float]:
        """Stiffness across the axis, in torsion and against tilt, all flanks in contact.

        Normals of flanks all round hold either direction across with half of their stiffness, and n
        slices hold a tilt with (1 - 1/n^2) L^2 / 12 of it [N/m, N m/rad, N m/rad].
        """
        across = 0.5 * self.flanks
        tilt = across * self.length**2 * (1.0 - 1.0 / self.slices**2) / 12.0
        return across, self.flanks * self.base_radius**2, tilt

    def indentation(self, torque: float) -> float:
        """Deformation of all flanks by a torque [N m], the shafts in line [m]."""
        return torque / (self.flanks * self.base_radius)

    def capacity(self, torque: float) -> float:
        """Tilt at which a torque [N m] no longer keeps all flanks in contact, centred [rad]."""
        return self.indentation(torque) / self.edge if self.edge else inf


@dataclass(frozen=True)
class LoadedSpline:
    """Loads of a spline's teeth.

    Attributes
    ----------
    forces : Floats
        Force (slices, teeth) of each flank along its normal, 0 where it has lifted [N].
    wrench : Floats
        What the shaft carries to the other one (5,): forces along y, z, moments about x, y, z at
        the middle of the width [N, N m].
    turn : float
        Turn of the shaft against the other one [rad].
    """

    forces: Floats
    wrench: Floats
    turn: float

    __repr__ = short_repr

    @property
    def peak_over_mean(self) -> float:
        """Peak force of a flank's slice over the mean of all."""
        return float(self.forces.max() / self.forces.mean())

    @property
    def carrying(self) -> float:
        """Share of the flanks' slices that are in contact."""
        return float((self.forces > 0.0).mean())


def loaded_spline(
    spline: Spline, torque: float, motion: ArrayLike = (0.0, 0.0, 0.0, 0.0)
) -> LoadedSpline:
    """Teeth of a spline under a torque, its shafts out of line: exact, flanks that lift included.

    Parameters
    ----------
    spline : Spline
        The coupling.
    torque : float
        Torque, its size [N m].
    motion : array_like, (4,)
        Motion uy, uz, ry, rz of the shaft against the other one at the middle of the width [m,
        rad].

    Raises
    ------
    InputError
        The torque is not above 0: nothing then centres the teeth.
    """
    if not torque > 0.0:
        raise InputError(
            f"torque of a spline is {torque:g} N m but must be above 0 N m, which centres it: "
            "give its size"
        )
    uy, uz, ry, rz = np.asarray(motion, dtype=float)
    angles = 2 * pi * np.arange(spline.teeth) / spline.teeth
    ny, nz = np.cos(angles), np.sin(angles)
    steps = (np.arange(spline.slices) + 0.5) / spline.slices - 0.5
    x = (spline.length * steps)[:, None]
    gone = (uy + rz * x) * ny + (uz - ry * x) * nz
    each = spline.flanks / gone.size
    # of the m flanks that are deepest, the turn follows; those are in contact that it leaves so
    deepest = np.sort(gone, axis=None)[::-1]
    arm = spline.base_radius
    turns = (torque / (each * arm) - np.cumsum(deepest)) / np.arange(1, gone.size + 1)
    turned = float(turns[np.flatnonzero(deepest + turns > 0.0)[-1]])
    forces = each * np.maximum(gone + turned, 0.0)
    fy, fz = forces * ny, forces * nz
    wrench = [fy.sum(), fz.sum(), arm * forces.sum(), -(x * fz).sum(), (x * fy).sum()]
    return LoadedSpline(forces, np.array(wrench), turned / arm)
