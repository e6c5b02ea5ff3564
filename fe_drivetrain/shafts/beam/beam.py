"""A shaft of sections on supports: what `shaft` solves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import diagonal_roots, scaled_to_unit_diagonal
from fe_drivetrain.drivetrain_file.materials import MATERIALS, Material
from fe_drivetrain.shafts.beam.sections import Section

# Stations closer than this share of the beam's length are one station.
SAME_STATION = 1e-9


@dataclass(frozen=True, eq=False)
class Support:
    """A connection of one station to the ground.

    Attributes
    ----------
    name : str
        Used in errors and to find the reaction.
    x : float
        Station, m.
    stiffness : array_like
        Six stiffnesses (N/m for x, y, z, then N m/rad about x, y, z), each 0 (free) to `inf`
        (rigid); or a symmetric positive semi-definite 6x6 matrix, where a direction with `inf` on
        the diagonal is rigid and has no other entry. Kept as the 6x6 matrix.

    Raises
    ------
    InputError
        If the stiffness has another shape, is not symmetric or is negative in some direction.
    """

    name: str
    x: float
    stiffness: ArrayLike

    def __post_init__(self) -> None:
        matrix = np.array(self.stiffness, dtype=float)
        if matrix.shape == (6,):
            matrix = np.diag(matrix)
        if matrix.shape != (6, 6):
            raise InputError(
                f"support '{self.name}': stiffness of shape {np.shape(self.stiffness)} must be 6 "
                "values or a 6x6 matrix: give Fx, Fy, Fz, Mx, My, Mz against ux, uy, uz, rx, ry, "
                "rz."
            )
        if not np.isfinite(self.x):
            raise InputError(f"support '{self.name}': x = {self.x} must be a finite station in m.")
        _check_support_matrix(self.name, matrix)
        matrix.flags.writeable = False
        object.__setattr__(self, "stiffness", matrix)

    @property
    def directions(self) -> tuple[Floats, Floats]:
        """Directions that this support holds, (m, 6), and the compliance of each, (m,).

        The load on the support is ``sum_a t_a rho_a`` with ``t_a . u = c_a rho_a``. A coupled
        matrix is scaled to a unit diagonal before its eigenvectors are taken, so that metres and
        radians, and soft and stiff directions, do not drown each other.
        """
        matrix = np.asarray(self.stiffness, dtype=float)
        rigid = np.isinf(np.diag(matrix))
        held = ~rigid & (np.diag(matrix) > 0.0)
        springs = matrix[np.ix_(held, held)]
        root = diagonal_roots(np.diag(springs))
        value, vector = np.linalg.eigh(scaled_to_unit_diagonal(springs))
        real = value > 1e-12
        elastic = np.zeros((int(real.sum()), 6))
        elastic[:, held] = (vector[:, real] * root[:, None]).T
        directions = np.vstack([np.eye(6)[rigid], elastic])
        return directions, np.concatenate([np.zeros(int(rigid.sum())), 1.0 / value[real]])


@dataclass(frozen=True, eq=False)
class Beam:
    """A shaft of sections on supports.

    Attributes
    ----------
    sections : sequence of BeamSection or RigiditySection
        Sections, from the upwind end on.
    supports : sequence of Support
        Supports at any stations on the beam, each with its own name.
    start : float
        Axial place x of the upwind end, m.
    material : Material
        Material of every section given by its shape; the density counts only where gravity does.
    shear : bool
        Whether shear deforms the beam (Timoshenko, Cowper's coefficient); False is
        Euler-Bernoulli.

    Raises
    ------
    InputError
        If there is no section, a support is not on the beam or a name is taken twice.
    """

    sections: Sequence[Section]
    supports: Sequence[Support]
    start: float = 0.0
    material: Material = MATERIALS["steel"]
    shear: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "sections", tuple(self.sections))
        object.__setattr__(self, "supports", tuple(self.supports))
        if not self.sections:
            raise InputError("beam with 0 sections needs at least 1: give a BeamSection.")
        if not np.isfinite(self.start):
            raise InputError(f"beam start x = {self.start} must be finite: give it in m.")
        names = [support.name for support in self.supports]
        for name in names:
            if names.count(name) > 1:
                raise InputError(
                    f"support name '{name}' is used {names.count(name)} times and must be used "
                    "once: rename one of them."
                )
        for support in self.supports:
            stations_on(self, f"support '{support.name}'", support.x)

    @property
    def ends(self) -> Floats:
        """Stations where sections begin and end, (n_sections + 1,), m."""
        return self.start + np.cumsum([0.0, *(section.length for section in self.sections)])

    @property
    def length(self) -> float:
        """Whole length, m."""
        return float(sum(section.length for section in self.sections))


def _check_support_matrix(name: str, matrix: Floats) -> None:
    diagonal = np.diag(matrix)
    if np.isnan(matrix).any() or not np.all(diagonal >= 0.0):
        raise InputError(
            f"support '{name}': stiffness {diagonal.tolist()} must be 0 or more in each "
            "direction, inf for rigid: correct the negative or missing value."
        )
    off = matrix - np.diag(np.where(np.isinf(diagonal), 0.0, diagonal))
    off[np.isinf(diagonal), np.isinf(diagonal)] = 0.0
    alone = np.isinf(diagonal) | (diagonal == 0.0)
    if not np.isfinite(off).all() or np.any(off[alone] != 0.0) or np.any(off[:, alone] != 0.0):
        raise InputError(
            f"support '{name}': a direction whose stiffness is 0 or inf must have no coupling "
            "terms: set the rest of its row and column to 0."
        )
    scaled = scaled_to_unit_diagonal(off, np.where(alone, 1.0, diagonal))
    worst = float(np.abs(scaled - scaled.T).max())
    if worst > 1e-6:
        raise InputError(
            f"support '{name}': stiffness is asymmetric by {worst:.1e} of its diagonal, at most "
            "1e-6 is allowed: give the symmetric matrix."
        )
    # Each half of a small asymmetry is noise of whatever made the matrix; the mean stands.
    matrix[:] = (matrix + matrix.T) / 2.0
    lowest = float(np.linalg.eigvalsh(scaled + np.diag(np.where(alone, 0.0, 1.0))).min())
    if lowest < -1e-9:
        raise InputError(
            f"support '{name}': stiffness has the negative eigenvalue {lowest:.2e} (scaled to a "
            "unit diagonal) and must have none below 0: check its coupling terms' signs."
        )


def stations_on(beam: Beam, what: str, stations: ArrayLike) -> Floats:
    x = np.asarray(stations, dtype=float)
    if x.ndim > 1:
        raise InputError(f"{what}s of shape {x.shape} must be one value or a list: flatten them.")
    low, high = beam.ends[0], beam.ends[-1]
    slack = SAME_STATION * beam.length
    outside = x[~((x >= low - slack) & (x <= high + slack))]
    if outside.size:
        raise InputError(
            f"{what} at x = {outside[0]:g} m must be on the beam, from {low:g} to {high:g} m: "
            "move it or lengthen the beam."
        )
    return x
