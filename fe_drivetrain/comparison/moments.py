"""Sums of histories that come in chunks, merged about their means.

So nothing cancels where the mean is many times the variation, and memory is that of a chunk
(Welford 1962, Technometrics 4, 419-420; Chan, Golub and LeVeque 1983, The American Statistician 37,
242-247).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats


@dataclass(frozen=True, eq=False)
class Moments:
    """Sums over samples of a reference and a model, from which all but two statistics follow.

    Attributes
    ----------
    count : int
        Samples.
    origin : (3, k)
        Origin of reference, model and their difference: a value near their means.
    offset : (3, k)
        Their means less the origin. Kept apart, since a mean of many times the variation is rounded
        by a share of the variation that would tell.
    products : (3, 3, k)
        Sums of products of the three less their means.
    absolute : (2, k)
        Sums of |reference| and |difference|.
    least, largest : (2, k)
        Minima and maxima of reference and model.
    """

    count: int
    origin: Floats
    offset: Floats
    products: Floats
    absolute: Floats
    least: Floats
    largest: Floats

    @property
    def mean(self) -> Floats:
        """Means of reference, model and difference, (3, k)."""
        return np.asarray(self.origin + self.offset)

    @property
    def squares(self) -> Floats:
        """Mean squares of reference, model and difference, (3, k)."""
        return np.asarray(np.einsum("iik->ik", self.products) / self.count + self.mean**2)

    def merged(self, other: Moments) -> Moments:
        """Those of the samples of both, of one origin: Chan, Golub and LeVeque 1983, Eq 2.1."""
        n = self.count + other.count
        step = other.offset - self.offset
        return Moments(
            n,
            self.origin,
            self.offset + step * (other.count / n),
            self.products + other.products + step[:, None] * step * (self.count * other.count / n),
            self.absolute + other.absolute,
            np.minimum(self.least, other.least),
            np.maximum(self.largest, other.largest),
        )


def moments(reference: ArrayLike, model: ArrayLike, origin: Floats | None = None) -> Moments:
    """Moments of samples (n, k) that are in memory; of an origin, see `Moments`, or of zero."""
    r, m = (np.ascontiguousarray(np.asarray(v, dtype=float).T) for v in (reference, model))
    signals = np.stack([r, m, m - r])
    if origin is None:
        origin = np.zeros(signals.shape[:2])
    shifted = signals - origin[..., None]
    offset = shifted.mean(axis=-1)
    shifted -= offset[..., None]
    return Moments(
        r.shape[-1],
        origin,
        offset,
        np.einsum("ikn,jkn->ijk", shifted, shifted),
        np.abs(signals[::2]).sum(axis=-1),
        signals[:2].min(axis=-1),
        signals[:2].max(axis=-1),
    )
