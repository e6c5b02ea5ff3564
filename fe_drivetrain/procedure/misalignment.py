"""Forces in supports that are not where they should be: offsets and tilts of a drivetrain.

PROTEST 2010 names misalignment as a load that no load case covers (section 4.2): a tolerance
between main shaft, gearbox and generator that holds in operation. Here the ground of each support
is moved by an offset u. Forces f of the supports are self-equilibrated, ``R^T H^T f = 0`` with R
the rigid motions of the free structure and H the supports' rows, so f = N c with N a basis of
these, and

    f = N (N^T C N)^-1 N^T u,   C = diag(1 / k) + H K^+ H^T.

A statically determinate drivetrain has no such forces: N is empty, and misalignment has none
exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.bodies import assemble
from fe_drivetrain.dynamics.bodies.levels import Level, assembly
from fe_drivetrain.dynamics.bodies.machine import Machine

_SMALL = 1e-9


@dataclass(frozen=True, eq=False)
class Misalignment:
    """Forces that offsets of supports bring about.

    Attributes
    ----------
    names : tuple of str
        Names of the supports' rows.
    influence : ndarray, (m, m)
        Force of each row on the structure, by offset of each [N/m, N/rad, N m/rad]; symmetric.
    """

    names: tuple[str, ...]
    influence: Floats

    __repr__ = short_repr

    @property
    def degree(self) -> int:
        """To which the supports are statically indeterminate."""
        if not self.influence.any():
            return 0
        size = np.sqrt(np.diag(self.influence).clip(min=0.0))
        scaled = self.influence / np.outer(np.where(size > 0, size, 1), np.where(size > 0, size, 1))
        return int(np.linalg.matrix_rank(scaled, _SMALL, hermitian=True))

    def forces(self, offsets: Floats) -> Floats:
        """Forces of given offsets, to be added to those of the loads.

        Parameters
        ----------
        offsets : ndarray, (m,) or (..., m)
            [m] or [rad].
        """
        return np.asarray(np.asarray(offsets) @ self.influence.T)

    def worst(self, tolerances: Floats) -> tuple[Floats, Floats]:
        """Largest force of each row anywhere in a box of offsets, and the corner that gives it.

        Parameters
        ----------
        tolerances : ndarray, (m,)
            Half widths [m] or [rad].

        Returns
        -------
        forces : ndarray, (m,)
            Sums of absolute influences: forces are linear.
        corners : ndarray, (m, m)
            A row for each force.
        """
        wide = np.abs(np.asarray(tolerances, dtype=np.float64))
        return np.abs(self.influence) @ wide, np.sign(self.influence) * wide


def influence_of_offsets(
    stiffness: Floats, rows: Floats, supports: Floats, names: tuple[str, ...]
) -> Misalignment:
    """Influence of offsets of supports on the forces in them.

    Parameters
    ----------
    stiffness : ndarray, (n, n)
        Stiffness of the free structure, in any degrees of freedom.
    rows : ndarray, (m, n)
        H: the motion that each support holds.
    supports : ndarray, (m,)
        Stiffness of each; infinite of a rigid one.
    names : tuple of str
        Names of the rows.

    Raises
    ------
    InputError
        The supports do not hold the structure, a stiffness is not above zero, or counts differ.
    """
    H, k = np.asarray(rows, dtype=np.float64), np.asarray(supports, dtype=np.float64)
    if not len(H) == len(k) == len(names) or (k <= 0.0).any():
        raise InputError(
            f"{len(names)} names, {len(H)} rows and {len(k)} stiffnesses of supports, the least "
            f"{k.min(initial=np.inf):g}: give as many of each, and stiffnesses above 0"
        )
    # translations and rotations have different units: scaled by the diagonal
    root = np.sqrt(np.diag(stiffness))
    root = np.where(root > 0.0, root, root.max())
    values, vectors = np.linalg.eigh(stiffness / np.outer(root, root))
    free = values < _SMALL * values.max()
    rigid = vectors[:, free] / root[:, None]
    elastic = vectors[:, ~free] / root[:, None]
    moved = H @ rigid
    size = np.linalg.norm(moved, axis=1)
    u, s, _ = np.linalg.svd(moved / np.where(size > 0.0, size, 1.0)[:, None])
    rank = int((s > _SMALL * s.max(initial=1.0)).sum())
    if rank < int(free.sum()):
        raise InputError(
            f"the supports hold {rank} of {int(free.sum())} rigid motions of the drivetrain: add "
            "supports, so that it cannot move freely"
        )
    N = u[:, rank:] / np.where(size > 0.0, size, 1.0)[:, None]
    if not N.shape[1]:
        return Misalignment(names, np.zeros((len(k), len(k))))
    bent = H @ elastic
    C = np.diag(1.0 / k) + bent @ (bent / values[~free]).T
    influence = N @ np.linalg.solve(N.T @ C @ N, N.T)
    return Misalignment(names, np.asarray(0.5 * (influence + influence.T)))


def machine_misalignment(machine: Machine, level: Level = Level.FLEXIBLE) -> Misalignment:
    """Influence of offsets of a machine's bearings, each of which the ground may move.

    Parameters
    ----------
    machine : Machine
        With bearings in the housing; gears mesh where they stand, and the generator does not turn.
    level : Level
        What may move: shafts bend at the flexible one.

    Returns
    -------
    Misalignment
        Rows are bearing and motion, as in "main bearing uz".

    Raises
    ------
    InputError
        Its bearings do not hold it.
    """
    made = assembly(machine, level, held_generator=True)
    # with all of its motions: the condensed system has bearings within its stiffness
    system = assemble(made.bodies, made.springs, made.superelements)
    bearings = {bearing.name for bearing in machine.bearings}
    held = np.array([name.rpartition(" ")[0] in bearings for name in system.spring_names])
    rows, stiffness = system.rows[~held], system.stiffness[~held]
    free = rows.T @ (stiffness[:, None] * rows) + system.extra
    names = tuple(str(name) for name in np.array(system.spring_names)[held])
    return influence_of_offsets(free, system.rows[held], system.stiffness[held], names)
