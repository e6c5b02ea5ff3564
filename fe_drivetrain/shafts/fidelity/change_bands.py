"""Bands of the change of a quantity from one design to another.

Two designs share the errors of what they have in common: a mesh that makes one 2 % too stiff makes
a nearly equal one 2 % too stiff, too, and their change is not 4 % uncertain. So the rule that
gives a value its band is applied to the change itself: on both bounds of the housings, from beam to
meridian, over the same series of meshes, from the difference of the recovered errors.

Designs have less in common the more they differ. So a share of the sum of their own bands is added,
up to the whole: what the values differ by, relative, and what the squares of the sizes of their
elements differ by. A quantity that doubles has the band of two values that know nothing of each
other, and so has one whose second design has a wall that asks for elements of half the size.
Random scenes with a like design show how often such bands hold
(`cases/verification/band_coverage_scenes.py`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.comparison.convergence import SAFETY
from fe_drivetrain.shafts.fidelity.assembly_bands import AssemblyBand, assembly_band


@dataclass(frozen=True)
class OnSprings:
    """A quantity of the shaft on housings as springs.

    Attributes
    ----------
    values, bound : Floats
        (k,) of the meridian on housings whose faces keep their shape, and on the softest.
    cheaper : Floats
        (k,) of the beam on the first.
    """

    values: Floats
    bound: Floats
    cheaper: Floats

    @property
    def parts(self) -> tuple[float, float]:
        """Half of what the bounds differ by, and the change from the beam, in the unit of it."""
        housing = float(np.linalg.norm(self.bound - self.values)) / 2.0
        return housing, float(np.linalg.norm(self.cheaper - self.values))

    @property
    def half_width(self) -> float:
        """Half width of the band of the values' norm, in the unit of the quantity."""
        return sum(self.parts)

    def __sub__(self, other: OnSprings) -> OnSprings:
        """The change from another design, on each of the three models."""
        return OnSprings(
            self.values - other.values, self.bound - other.bound, self.cheaper - other.cheaper
        )


@dataclass(frozen=True)
class OnMeshes:
    """A quantity of an assembly on a series of meshes.

    Attributes
    ----------
    sizes : tuple[float, ...]
        Mean size of the elements of each mesh, coarse first [m].
    values : tuple[Floats, ...]
        (k,) of each mesh.
    recovered : Floats
        (k,) errors of the values of the finest mesh, estimated from recovered stresses.
    factors : tuple[float, ...]
        Sizes of each mesh as asked for, over those of the finest.
    """

    sizes: tuple[float, ...]
    values: tuple[Floats, ...]
    recovered: Floats
    factors: tuple[float, ...]

    @property
    def band(self) -> AssemblyBand:
        """The band of the values of the finest mesh, relative to their norm."""
        return assembly_band(self.sizes, self.values, self.recovered)

    @property
    def half_width(self) -> float:
        """Half width of the band of the values' norm, in the unit of the quantity."""
        size = float(np.linalg.norm(self.values[-1]))
        return self.band.half_width * size if size > 0.0 else 0.0

    def __sub__(self, other: OnMeshes) -> OnMeshes:
        """The change from another design, on meshes that both have."""
        both = [f for f in self.factors if f in other.factors]
        one, two = ([of.factors.index(f) for f in both] for of in (self, other))
        return OnMeshes(
            tuple((self.sizes[a] + other.sizes[b]) / 2.0 for a, b in zip(one, two, strict=True)),
            tuple(self.values[a] - other.values[b] for a, b in zip(one, two, strict=True)),
            self.recovered - other.recovered,
            tuple(both),
        )

    @property
    def scatter(self) -> float:
        """What meshes add by chance, in the unit of the quantity; NaN where there is but one.

        A series has it in its band. Meshes whose sizes are too near each other for a series still
        differ by their topology: `SAFETY` times the largest difference from the finest.
        """
        if len(self.band.sizes) > 1:
            return 0.0
        apart = [float(np.linalg.norm(v - self.values[-1])) for v in self.values[:-1]]
        return SAFETY * max(apart) if any(apart) else float("nan")


def change_band(
    first: OnSprings | OnMeshes | None,
    other: OnSprings | OnMeshes | None,
    sizes: tuple[float, float],
) -> float | None:
    """Half width of the band of a change, in the unit of the quantity.

    Parameters
    ----------
    first, other : OnSprings or OnMeshes, or None
        What the values of both designs rest on.
    sizes : tuple[float, float]
        The values of both, or the norms of several.

    Returns
    -------
    float or None
        None where nothing is known of what the two have in common: levels differ, or there is but
        one mesh, whose scatter is not known.
    """
    change: OnSprings | OnMeshes
    if isinstance(first, OnSprings) and isinstance(other, OnSprings):
        change, difference = other - first, other.values - first.values
    elif isinstance(first, OnMeshes) and isinstance(other, OnMeshes):
        change, difference = other - first, other.values[-1] - first.values[-1]
    else:
        return None
    if not difference.any():
        return 0.0
    scatter = change.scatter if isinstance(change, OnMeshes) else 0.0
    if np.isnan(scatter):
        return None
    whole = first.half_width + other.half_width
    apart = float(np.linalg.norm(difference)) / max(map(abs, sizes)) + _unlike(first, other)
    return min(whole, change.half_width + scatter + apart * whole)


def _unlike(first: OnSprings | OnMeshes, other: OnSprings | OnMeshes) -> float:
    """What the squares of the finest elements' sizes differ by, relative; 0 on springs."""
    if not (isinstance(first, OnMeshes) and isinstance(other, OnMeshes)):
        return 0.0
    sizes = first.sizes[-1], other.sizes[-1]
    return (max(sizes) / min(sizes)) ** 2 - 1.0
