"""How far a model is from a reference over histories too long for memory.

The statistics are those of `statistics`. Sums of chunks are merged about their means
(Welford 1962, Technometrics 4, 419-420; Chan, Golub and LeVeque 1983, The American Statistician 37,
242-247), so that nothing cancels where the mean is many times the variation, and memory is that of
a chunk.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.compare.statistics import CONSTANT, Comparison, ratio

Chunk = tuple[ArrayLike, ArrayLike]
"""Reference and model (n, k): some samples of k quantities."""

BLOCK = 1 << 14
"""Samples at a time, so that temporary arrays stay in the cache."""


@dataclass(frozen=True, eq=False)
class Moments:
    """What samples of a reference and a model leave behind.

    Parameters
    ----------
    count
        Samples.
    origin : (3, k)
        Of reference, model and their difference: a value near their means.
    offset : (3, k)
        Their means less the origin. Kept apart, since a mean of many times the variation is rounded
        by a share of the variation that would tell.
    products : (3, 3, k)
        Sums of products of the three less their means.
    absolute : (2, k)
        Sums of |reference| and |difference|.
    least, largest : (2, k)
        Of reference and model.
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


def compare_streamed(
    chunks: Callable[[], Iterable[Chunk]],
    names: Sequence[str],
    units: Sequence[str],
    negligible: float | Sequence[float] = 0.0,
    exclude_below: float = 1e-3,
) -> Comparison:
    """`fe_drivetrain.compare.statistics.compare` of one history that comes in chunks.

    Parameters
    ----------
    chunks
        Called twice; gives the same chunks in the same order each time. Twice, because what the
        percentage leaves out, and the residuals of the model uncertainty, hang on sums over all.
    names, units, negligible, exclude_below
        As for `fe_drivetrain.compare.statistics.compare`.

    Returns
    -------
    Comparison
        Arrays (1, k).

    Raises
    ------
    InputError
        As `compare`; also if the second time gives other samples than the first.
    """
    if not 0.0 <= exclude_below < 1.0:
        raise InputError(
            f"exclude_below = {exclude_below:g} must be at least 0 and below 1, as a share of the "
            "reference's rms: 0.001 is usual."
        )
    k = len(names)
    if len(units) != k:
        raise InputError(f"{k} names and {len(units)} units: give one of each for every quantity.")
    try:
        limit = np.broadcast_to(np.asarray(negligible, dtype=float), (k,))
    except ValueError:
        raise InputError(
            f"negligible of shape {np.shape(negligible)} must be one value or {k}: give one for "
            "each quantity."
        ) from None
    total: Moments | None = None
    for r, m in _blocks(chunks(), k):
        if total is None:
            origin = np.array([r[0], m[0], m[0] - r[0]])
        some = moments(r, m, origin)
        total = some if total is None else total.merged(some)
    if total is None or total.count < 2:
        count = 0 if total is None else total.count
        raise InputError(f"histories of {count} samples must have at least 2: give longer ones.")
    n = total.count
    size_r, size_m, rms = np.sqrt(total.squares)
    mean_product = total.products[0, 1] / n + total.mean[0] * total.mean[1]
    slope = ratio(mean_product, size_m**2)

    floor = exclude_below * size_r
    kept, shares, residual, again = np.zeros(k), np.zeros(k), np.zeros(k), 0
    for r, m in _blocks(chunks(), k):
        again += len(r)
        size = np.abs(r)
        here = size > floor
        share = np.zeros(r.shape)
        np.divide(np.abs(m - r), size, out=share, where=here)
        kept += here.sum(axis=0)
        shares += share.T.copy().sum(axis=-1)
        rest = (r - np.nan_to_num(slope) * m).T.copy()
        residual += np.einsum("kn,kn->k", rest, rest)
    if again != n:
        raise InputError(
            f"chunks gave {n} samples the first time and {again} the second: give the same twice."
        )

    spread = np.maximum(total.largest - total.mean[:2], total.mean[:2] - total.least)
    largest = np.maximum(np.abs(total.largest), np.abs(total.least))
    deviation = np.sqrt(np.einsum("iik->ik", total.products) / n)
    deviation[:2][spread <= CONSTANT * largest] = 0.0
    pearson = np.clip(ratio(total.products[0, 1] / n, deviation[0] * deviation[1]), -1.0, 1.0)
    slope_size = np.abs(mean_product) / np.where(size_m > 0.0, size_m, 1.0)
    correlated = np.where(slope_size > CONSTANT * size_r, slope_size, 0.0)
    cov = np.where(size_m > 0.0, ratio(np.sqrt(residual / (n - 1)), correlated), np.nan)
    relative = np.array(
        [
            ratio(deviation[2] * np.sqrt(n / (n - 1)), size_r),
            ratio(total.absolute[1], total.absolute[0]),
            100.0 * ratio(shares, kept),
            pearson,
            slope,
            cov,
        ]
    )
    relative[:, size_r <= limit] = np.nan
    table = [size_r, rms, total.mean[2], 1.0 - kept / n, *relative]
    scale, error, bias, left_out, scatter, absolute, percent, pearson, slope, cov = (
        np.asarray(row)[None] for row in table
    )
    return Comparison(
        names=tuple(names),
        units=tuple(units),
        samples=n,
        reference_rms=scale,
        rmse=error,
        bias=bias,
        relative_scatter=scatter,
        relative_error=absolute,
        mean_percentage_error=percent,
        excluded_share=left_out,
        correlation=pearson,
        slope=slope,
        cov=cov,
    )


def _blocks(chunks: Iterable[Chunk], k: int) -> Iterator[tuple[Floats, Floats]]:
    """Checked samples, `BLOCK` at a time."""
    before = 0
    for reference, model in chunks:
        r, m = np.asarray(reference, dtype=float), np.asarray(model, dtype=float)
        if r.shape != m.shape or r.ndim != 2 or r.shape[1] != k:
            raise InputError(
                f"chunk of reference {r.shape} and model {m.shape}: both must be (samples, {k}), "
                "one column for each quantity."
            )
        for start in range(0, len(r), BLOCK):
            some = slice(start, start + BLOCK)
            for name, values in (("reference", r[some]), ("model", m[some])):
                finite = np.isfinite(values)
                if not finite.all():
                    sample = before + start + int(np.argmin(finite.all(axis=1))) + 1
                    raise InputError(
                        f"{name} holds a value that is not finite in sample {sample}: remove NaN "
                        "and infinity first."
                    )
            yield r[some], m[some]
        before += len(r)
