"""Transmission error of a mesh in slices: under load, and the part that remains without load.

Under the torque T the first gear is ahead by delta(psi), the static transmission error (Harris
1958). About that state the mesh is a spring of the stiffness k(psi) of all slices in contact with
the free place e(psi) = delta(psi) - F / k(psi), on the line of action: F = k(psi) (delta - e(psi)).
The error e is what tips, crowning and misalignment leave between the flanks that carry.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.gear.load_distribution import loaded
from fe_drivetrain.gear.meshes import StiffnessTable
from fe_drivetrain.gear.slices import SlicedMesh


@dataclass(frozen=True)
class TransmissionError:
    """A mesh about its state under load, over one period; transverse, along the line of action.

    Attributes
    ----------
    force : float
        Force of the mesh [N].
    static : ndarray, (n,)
        Transmission error under load at phases 0, 1/n, ... from the loaded flank without load and
        modifications [m].
    stiffness : StiffnessTable
        Stiffness of the slices in contact [N/m].
    unloaded : ndarray, (n,)
        Free place e at the same phases [m].
    """

    force: float
    static: Floats
    stiffness: StiffnessTable
    unloaded: Floats

    __repr__ = short_repr

    @property
    def ripple(self) -> float:
        """Peak-to-peak static transmission error [m]."""
        return float(np.ptp(self.static))


def transmission_error(
    mesh: SlicedMesh, torque: float, motion: ArrayLike | None = None, phases: int = 64
) -> TransmissionError:
    """Stiffness and transmission error of a mesh under a torque.

    Parameters
    ----------
    mesh : SlicedMesh
        Pair of gears, its teeth in slices, with its modifications.
    torque : float
        Torque on the first gear [N m], above zero.
    motion : array_like, (12,), optional
        Position of the first and of the second gear, see `loaded` [m, rad].
    phases : int
        Number of phases, evenly spaced over a period, from 0.

    Returns
    -------
    TransmissionError
        Exact tangent at this torque: it holds for vibrations in which no slice comes or goes.

    Raises
    ------
    InputError
        The torque does not press the driving flanks.
    """
    if not torque > 0.0:
        raise InputError(
            f"torque on a mesh is {torque:g} N m but must be above 0 N m for its transmission "
            "error: give the torque that loads the driving flanks"
        )
    force = torque / mesh.pair.first.base_radius
    found = [loaded(mesh, k / phases, torque, motion) for k in range(phases)]
    static = np.array([one.approach for one in found]) - 0.5 * max(mesh.play, 0.0)
    stiffness = np.array([one.contacts.stiffness[one.forces > 0.0].sum() for one in found])
    table = StiffnessTable(stiffness, mesh.pair.contact_ratio)
    return TransmissionError(force, static, table, np.asarray(static - force / stiffness))
