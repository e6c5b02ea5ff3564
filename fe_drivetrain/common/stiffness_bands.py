"""Bands of a stiffness by kind of motion: axial, torsion, bending.

To a body of revolution these are three problems that know nothing of each other: harmonic 0 along
the axis and about it, harmonic 1 across it. Each has its own error, and one number for all of them
is that of the worst.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.scaling import diagonal_roots, scaled_to_unit_diagonal

#: Kinds of the six motions of a point, in the order of `components.MOTIONS`: ux, uy, uz, rx, ry, rz
_KINDS = ("axial", "bending", "bending", "torsion", "bending", "bending")


@dataclass(frozen=True)
class StiffnessBands:
    """Half widths of the bands of a (6 n, 6 n) stiffness, relative.

    That of an entry is relative to the roots of the diagonal entries of its row and column, and is
    the root of the product of the bands of the two: an error is positive semidefinite, so that none
    off its diagonal is larger.

    Attributes
    ----------
    axial : float
        Along x, the axis.
    torsion : float
        About x.
    bending : float
        Across x: forces along y and z, moments about them.
    """

    axial: float
    torsion: float
    bending: float

    @classmethod
    def uniform(cls, value: float) -> StiffnessBands:
        """One number for all."""
        return cls(value, value, value)

    @classmethod
    def of_motions(cls, values: Floats) -> StiffnessBands:
        """The largest of each kind.

        Parameters
        ----------
        values : Floats
            (6 n,) bands of the motions of n points.
        """
        kinds = np.resize(_KINDS, len(values))
        return cls(**{kind: float(values[kinds == kind].max()) for kind in KINDS})

    @classmethod
    def of_difference(cls, matrix: Floats, reference: Floats) -> StiffnessBands:
        """By what two stiffnesses differ, the reference with a diagonal of ones.

        Parameters
        ----------
        matrix, reference : Floats
            (6 n, 6 n) of the same points.
        """
        apart = np.abs(scaled_to_unit_diagonal(matrix - reference, reference.diagonal()))
        return cls.of_motions(apart.max(axis=1))

    @property
    def largest(self) -> float:
        """The band of any entry."""
        return max(self)

    def __iter__(self) -> Iterator[float]:
        """The values, in the order of `KINDS`."""
        return iter((self.axial, self.torsion, self.bending))

    def __add__(self, other: StiffnessBands) -> StiffnessBands:
        """The band of two causes of error."""
        return self.each(lambda a, b: a + b, other)

    def __or__(self, other: StiffnessBands) -> StiffnessBands:
        """The wider band of each kind."""
        return self.each(max, other)

    def each(self, rule: Callable[..., float], *others: StiffnessBands) -> StiffnessBands:
        """A function of the values of each kind, of this one and of others."""
        return StiffnessBands(*(rule(*values) for values in zip(self, *others, strict=True)))

    def half_widths(self, stiffness: Floats) -> Floats:
        """(6 n, 6 n) half widths of the bands of all entries, in their units.

        Parameters
        ----------
        stiffness : Floats
            (6 n, 6 n) what has these bands.
        """
        by_kind = dict(zip(KINDS, self, strict=True))
        bands = np.array([by_kind[kind] for kind in np.resize(_KINDS, len(stiffness))])
        roots = diagonal_roots(stiffness.diagonal()) * np.sqrt(bands)
        return np.asarray(np.outer(roots, roots))

    @property
    def are_numbers(self) -> bool:
        """Whether each is from 0 on, and finite."""
        return all(math.isfinite(value) and value >= 0.0 for value in self)

    @property
    def in_percent(self) -> str:
        """The values as a person reads them, as in "axial 1 %, torsion 0.1 %, bending 2 %"."""
        return ", ".join(f"{k} {100 * v:.2g} %" for k, v in zip(KINDS, self, strict=True))

    def __str__(self) -> str:
        """The values with every digit, as in "axial 0.01, torsion 0.001, bending 0.02"."""
        return ", ".join(f"{kind} {value!r}" for kind, value in zip(KINDS, self, strict=True))


KINDS = tuple(field.name for field in fields(StiffnessBands))
"""Names of the kinds, in their order."""
