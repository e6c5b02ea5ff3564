"""All statistics of a model against a reference, of histories in memory or in chunks.

A history in memory is one chunk.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.comparison.moments import Moments, moments
from fe_drivetrain.comparison.statistics import CONSTANT, check_excluded, ratio

Chunk = tuple[ArrayLike, ArrayLike]
"""Reference and model (n, k): some samples of k quantities."""

BLOCK = 1 << 14
"""Samples at a time, so that temporary arrays stay in the cache."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Every statistic of a model against a reference; arrays (N, k) by history and quantity.

    Attributes
    ----------
    names, units : tuple of str, (k,)
        Names and units of the quantities.
    samples : int
        Per history.
    reference_rms, rmse, bias : ndarray
        In the quantity's unit.
    relative_scatter, relative_error : ndarray
        Fractions of the reference's rms and of its mean magnitude.
    mean_percentage_error : ndarray
        Percent.
    excluded_share : ndarray
        Share of the samples that the percentage leaves out.
    correlation : ndarray
        Pearson.
    slope, cov : ndarray
        Model uncertainty, reference over model.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    samples: int
    reference_rms: Floats
    rmse: Floats
    bias: Floats
    relative_scatter: Floats
    relative_error: Floats
    mean_percentage_error: Floats
    excluded_share: Floats
    correlation: Floats
    slope: Floats
    cov: Floats

    __repr__ = short_repr

    def index(self, name: str) -> int:
        """Column of a quantity.

        Raises
        ------
        InputError
            If there is no such quantity.
        """
        if name not in self.names:
            raise InputError(
                f"quantity '{name}' is not compared: choose one of {', '.join(self.names)}."
            )
        return self.names.index(name)


def compare(
    reference: ArrayLike,
    model: ArrayLike,
    names: Sequence[str],
    units: Sequence[str],
    negligible: float | Sequence[float] = 0.0,
    exclude_below: float = 1e-3,
) -> Comparison:
    """All statistics of each history and quantity.

    Parameters
    ----------
    reference, model : array_like, (N, n, k)
        N histories of n samples of k quantities.
    names, units : sequence of str, (k,)
        Such as "Fy" and "N".
    negligible : float or (k,)
        A reference whose rms is at or below this, in the quantity's unit, counts as zero: its
        relative statistics, correlation and model uncertainty are NaN rather than a ratio of
        rounding errors. Give it for the moments of a spherical bearing; 0 leaves only a reference
        that is zero throughout.
    exclude_below : float
        See `mean_percentage_error`.

    Returns
    -------
    Comparison

    Raises
    ------
    InputError
        If a shape, name or unit does not fit, a value is not finite, or there are fewer than 2
        samples.
    """
    r, m = np.asarray(reference, dtype=float), np.asarray(model, dtype=float)
    if r.ndim != 3 or r.shape != m.shape:
        raise InputError(
            f"reference {r.shape} and model {m.shape} must have one shape (histories, samples, "
            "quantities): add or reorder axes."
        )
    if not len(r):
        raise InputError("0 histories to compare: give at least 1.")
    if not len(names) == len(units) == r.shape[2]:
        raise InputError(
            f"{len(names)} names and {len(units)} units for {r.shape[2]} quantities: give one of "
            "each for every quantity."
        )
    settings = (names, units, negligible, exclude_below)
    each = [compare_streamed(partial(_whole, a, b), *settings) for a, b in zip(r, m, strict=True)]
    arrays = [f.name for f in fields(Comparison) if f.name not in ("names", "units", "samples")]
    joined: dict[str, Any] = {
        name: np.concatenate([getattr(c, name) for c in each]) for name in arrays
    }
    return replace(each[0], **joined)


def compare_streamed(
    chunks: Callable[[], Iterable[Chunk]],
    names: Sequence[str],
    units: Sequence[str],
    negligible: float | Sequence[float] = 0.0,
    exclude_below: float = 1e-3,
) -> Comparison:
    """`compare` of one history that comes in chunks, for histories too long for memory.

    Parameters
    ----------
    chunks : callable
        Called twice; gives the same chunks in the same order each time. Twice, because what the
        percentage leaves out, and the residuals of the model uncertainty, depend on sums over all.
    names, units, negligible, exclude_below : see `compare`
        The same as for `compare`.

    Returns
    -------
    Comparison
        Arrays (1, k).

    Raises
    ------
    InputError
        As `compare`; also if the second time gives other samples than the first.
    """
    check_excluded(exclude_below)
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
    total = _total(chunks, k)
    n = total.count
    size_r, size_m, rms = np.sqrt(total.squares)
    mean_product = total.products[0, 1] / n + total.mean[0] * total.mean[1]
    slope = ratio(mean_product, size_m**2)
    kept, shares, residual = _second_sums(chunks, exclude_below * size_r, slope, n)

    deviation = _deviations(total)
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


def _total(chunks: Callable[[], Iterable[Chunk]], count: int) -> Moments:
    """Moments of all samples of a number of quantities."""
    total: Moments | None = None
    for r, m in _blocks(chunks(), count):
        if total is None:
            origin = np.array([r[0], m[0], m[0] - r[0]])
        some = moments(r, m, origin)
        total = some if total is None else total.merged(some)
    if total is None or total.count < 2:
        n = 0 if total is None else total.count
        raise InputError(f"histories of {n} samples must have at least 2: give longer ones.")
    return total


def _deviations(total: Moments) -> Floats:
    """Standard deviations of reference, model and difference; 0 of what is constant."""
    spread = np.maximum(total.largest - total.mean[:2], total.mean[:2] - total.least)
    largest = np.maximum(np.abs(total.largest), np.abs(total.least))
    deviation = np.asarray(np.sqrt(np.einsum("iik->ik", total.products) / total.count))
    deviation[:2][spread <= CONSTANT * largest] = 0.0
    return deviation


def _second_sums(
    chunks: Callable[[], Iterable[Chunk]], floor: Floats, slope: Floats, samples: int
) -> tuple[Floats, Floats, Floats]:
    """Number of references above a floor, sums of errors over these, and of squared residuals."""
    k = len(floor)
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
    if again != samples:
        raise InputError(
            f"chunks gave {samples} samples the first time and {again} the second: give the same "
            "twice."
        )
    return kept, shares, residual


def _whole(reference: Floats, model: Floats) -> list[Chunk]:
    return [(reference, model)]


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
