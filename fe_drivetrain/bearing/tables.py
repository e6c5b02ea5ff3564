"""Equilibrium from a table: a bearing without clearance answers all loads from three numbers.

Loads times s are roller loads times s and displacements times s^(1/n), exactly; a turn of the loads
about the axis turns the answer, but for the ripple of the rollers' number. What is left of a load
are the ratios of its axial, radial and tilting parts, and the angle between force and moment.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import RegularGridInterpolator

from fe_drivetrain.bearing.contact_forces import checked_loads, roller_loads, turn
from fe_drivetrain.bearing.geometry import BallRow, Bearing
from fe_drivetrain.bearing.rolling import equilibrium
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

#: Nodes over the axial share, over moment against radial force, and round the circle.
NODES = (25, 13, 36)

#: The radial force of the table's loads points down, at a roller.
DOWN = 1.5 * np.pi


@dataclass(frozen=True)
class ReducedTable:
    """Displacements and peak rollers at the nodes of reduced loads; see `reduced_table`.

    Attributes
    ----------
    bearing : Bearing
        Bearing that the table is made for.
    exponent : float
        Exponent of its contact law.
    interpolator : RegularGridInterpolator
        Interpolator from the reduced load to displacements of a unit load, then the peak of each
        row.
    """

    bearing: Bearing
    exponent: float
    interpolator: RegularGridInterpolator

    def __call__(self, loads: ArrayLike) -> tuple[Floats, Floats]:
        """Interpolated answers.

        Parameters
        ----------
        loads : array_like
            Loads (n, 5) or (5,) [N, N m].

        Returns
        -------
        displacements, peaks : Floats
            Displacements (n, 5) [m, rad], and maximum load (n, rows) of a rolling element in each
            row [N]; with the error of the interpolation and the ripple of the rollers' number.
        """
        F = checked_loads(self.bearing, loads)
        radial = np.hypot(F[:, 1], F[:, 2])
        tilting = np.hypot(F[:, 3], F[:, 4]) / self.bearing.arm
        size = np.sqrt(F[:, 0] ** 2 + radial**2 + tilting**2)
        share = np.divide(F[:, 0], size, out=np.zeros(len(F)), where=size > 0.0)
        force, moment = np.arctan2(F[:, 2], -F[:, 1]), np.arctan2(F[:, 4], -F[:, 3])
        reduced = np.column_stack(
            [
                np.arccos(np.clip(share, -1.0, 1.0)),
                np.arctan2(tilting, radial),
                (moment - force) % (2.0 * np.pi),
            ]
        )
        found = self.interpolator(reduced)
        unit = found[:, :5] * size[:, None] ** (1.0 / self.exponent)
        return turn(unit, force - DOWN), found[:, 5:] * size[:, None]


def reduced_table(bearing: Bearing, nodes: tuple[int, int, int] = NODES) -> ReducedTable:
    """Solve a bearing once at the nodes of all reduced loads.

    Parameters
    ----------
    bearing : Bearing
        Rollers without clearance, preload or profile, of one exponent; every load carried.
    nodes : tuple of int
        Numbers of nodes over the axial share, over moment against radial force, and round the
        circle.

    Returns
    -------
    table : ReducedTable
        Linear between the nodes.

    Raises
    ------
    InputError
        Loads are not homogeneous: balls, clearance, profile, or two exponents.
    """
    rows = [row for row in bearing.rows if not isinstance(row, BallRow)]
    exponents = {row.law.exponent for row in rows}
    if (
        len(rows) < len(bearing.rows)
        or len(exponents) != 1
        or any(row.clearance or row.crown for row in rows)
    ):
        raise InputError(
            f"{bearing.name} has balls, clearance, preload, a profile or two contact laws, so that "
            "its answer to a load does not scale: use equilibrium instead of a table"
        )
    if min(nodes) < 2:
        raise InputError(f"a table of {nodes} nodes: give 2 or more along each axis")
    (exponent,) = exponents
    axes = (
        np.linspace(0.0, np.pi, nodes[0]),
        np.linspace(0.0, 0.5 * np.pi, nodes[1]),
        np.linspace(0.0, 2.0 * np.pi, nodes[2] + 1),
    )
    polar, mix, between = (a.ravel() for a in np.meshgrid(*axes, indexing="ij"))
    moment = DOWN + between
    across = np.sin(polar)
    loads = np.column_stack(
        [
            np.cos(polar),
            0.0 * polar,
            -across * np.cos(mix),
            -across * np.sin(mix) * np.cos(moment) * bearing.arm,
            across * np.sin(mix) * np.sin(moment) * bearing.arm,
        ]
    )
    # of a usual size, so that deflections are not round-off
    typical = 1e5
    found = equilibrium(bearing, typical * loads)
    if not found.converged.all():
        raise InputError(f"{bearing.name} does not carry every load: use equilibrium instead")
    Q = roller_loads(bearing, found.displacements) / typical
    peaks = [part.max(axis=1) for part in np.split(Q, np.cumsum(bearing.counts)[:-1], axis=1)]
    values = np.column_stack([found.displacements / typical ** (1.0 / exponent), *peaks])
    shape = (*(len(a) for a in axes), values.shape[1])
    return ReducedTable(bearing, exponent, RegularGridInterpolator(axes, values.reshape(shape)))
