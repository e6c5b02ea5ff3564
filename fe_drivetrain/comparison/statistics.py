"""Error of a model against a reference, over load histories.

Every statistic takes `reference` and `model` of one shape and works along the last axis, the
samples; the axes before it are histories, quantities or whatever they are. The difference is
always model minus reference.

NaN has one meaning here, *undefined*, and only three causes: a correlation with a constant
signal, an error relative to a reference that is zero, and a model uncertainty of a model that is
zero or not correlated at all. It never comes from the data, since values that are not finite are
refused.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

# A signal that varies by less than this share of its largest value is constant but for rounding.
CONSTANT = 1e-12


def resultant(fy: ArrayLike, fz: ArrayLike) -> Floats:
    """Magnitude of the radial force (or moment) of two planes, any shapes that broadcast."""
    return np.asarray(np.hypot(fy, fz), dtype=float)


def rmse(reference: ArrayLike, model: ArrayLike) -> Floats:
    """Root mean square of the difference, in the unit of the data, (..., n) -> (...).

    Raises
    ------
    InputError
        If shapes differ, values are not finite or there are fewer than 2 samples; so do all
        statistics of this module.
    """
    return _rms(_difference(*_pair(reference, model)))


def bias(reference: ArrayLike, model: ArrayLike) -> Floats:
    """Mean of the difference, positive where the model is too high, (..., n) -> (...)."""
    return np.asarray(_difference(*_pair(reference, model)).mean(axis=-1))


def relative_scatter(reference: ArrayLike, model: ArrayLike) -> Floats:
    """Standard deviation of the difference over the rms of the reference, (..., n) -> (...).

    What would be left of the error if the bias were taken out. The rms is the scale because, unlike
    the mean, it is zero only for a reference that is zero throughout (then NaN). Sample standard
    deviation (ddof = 1).
    """
    r, m = _pair(reference, model)
    return ratio(_difference(r, m).std(axis=-1, ddof=1), _rms(r))


def relative_error(reference: ArrayLike, model: ArrayLike) -> Floats:
    """Mean absolute difference over mean absolute reference, a fraction, (..., n) -> (...).

    The robust neighbour of `mean_percentage_error`: every newton counts equally, zero crossings do
    no harm. NaN for a reference that is zero throughout.
    """
    r, m = _pair(reference, model)
    return ratio(_mean_absolute(_difference(r, m)), _mean_absolute(r))


def median_error(reference: ArrayLike, model: ArrayLike) -> Floats:
    """Median of the absolute difference, in the unit of the data, (..., n) -> (...).

    The robust neighbour of `rmse`: whatever up to half of the samples do, it stays within the
    differences of the others (Huber 1981, Robust Statistics, section 1.4).
    """
    return np.asarray(np.median(np.abs(_difference(*_pair(reference, model))), axis=-1))


def mean_percentage_error(
    reference: ArrayLike, model: ArrayLike, exclude_below: float = 1e-3
) -> Floats:
    """Mean of |model - reference| / |reference| in percent, (..., n) -> (...).

    The "mean percentage error" of Stirling 2023, section 3.2, there over resultant magnitudes.
    Samples near a zero of the reference would rule the mean, so those with |reference| at or below
    `exclude_below` times its rms are left out (`excluded_share` tells how many; 0 leaves out
    exact zeros only). Of a reference that passes through zero it still says more about
    `exclude_below` than about the model: 1 / |r| has no mean there, and that of what is left grows
    with the logarithm of 1 / `exclude_below`. Read `relative_error` beside it.

    Returns
    -------
    ndarray
        Percent; NaN for a reference that is zero throughout.

    Raises
    ------
    InputError
        See `rmse`; also if `exclude_below` is not between 0 and 1.
    """
    r, m = _pair(reference, model)
    kept = _kept(r, exclude_below)
    return _mean_percentage(np.abs(_difference(r, m)), np.abs(r), kept)


def excluded_share(reference: ArrayLike, exclude_below: float = 1e-3) -> Floats:
    """Share of the samples that `mean_percentage_error` leaves out, (..., n) -> (...)."""
    r, _ = _pair(reference, reference)
    return np.asarray(1.0 - _kept(r, exclude_below).mean(axis=-1))


def correlation(reference: ArrayLike, model: ArrayLike) -> Floats:
    """Pearson's correlation coefficient, (..., n) -> (...).

    NaN where either signal is constant (to 1e-12 of its largest value): a signal that does not
    vary says nothing about how another varies with it. Blind to scale and bias, so never to be
    read without them.
    """
    return _correlation(*_pair(reference, model))


@dataclass(frozen=True, eq=False)
class ErrorsAtOnce:
    """Statistics of one pair, for which their common parts are computed once; (...) each.

    Attributes
    ----------
    mean_percentage_error, relative_error, correlation, excluded_share : Floats
        As the functions of these names have them.
    """

    mean_percentage_error: Floats
    relative_error: Floats
    correlation: Floats
    excluded_share: Floats


def errors_at_once(
    reference: ArrayLike, model: ArrayLike, exclude_below: float = 1e-3
) -> ErrorsAtOnce:
    """Several statistics of one pair, to the last digit as the functions of their names.

    Parameters
    ----------
    reference, model : array_like, (..., n)
        Samples along the last axis.
    exclude_below : float
        See `mean_percentage_error`.
    """
    r, m = _pair(reference, model)
    kept, apart, size = _kept(r, exclude_below), np.abs(_difference(r, m)), np.abs(r)
    return ErrorsAtOnce(
        _mean_percentage(apart, size, kept),
        ratio(np.asarray(apart.mean(axis=-1)), np.asarray(size.mean(axis=-1))),
        _correlation(r, m),
        np.asarray(1.0 - kept.mean(axis=-1)),
    )


def model_uncertainty(reference: ArrayLike, model: ArrayLike) -> tuple[Floats, Floats]:
    """Model uncertainty X = reference / model: its mean and coefficient of variation.

    As in EN 1990, Annex D.8, the mean is the slope of the least-squares line through the origin,
    ``b = sum(r m) / sum(m^2)``: multiply the model by b to make it right on the mean. Annex D
    takes the scatter from ``ln(r / (b m))``, which loses its meaning at a zero crossing; here it
    is that of the residuals over the model's rms::

        COV = sqrt(sum((r - b m)^2) / (n - 1)) / (|b| rms(m))

    For a model of constant magnitude the two are exactly mean(X) and std(X) / |mean(X)|.

    Returns
    -------
    slope, cov : ndarray, (...)
        b is NaN for a model that is zero throughout, COV also where b is 0.
    """
    r, m = _pair(reference, model)
    n = r.shape[-1]
    size = _rms(m)
    unit = m / np.where(size > 0.0, size, 1.0)[..., None]
    slope_size = np.einsum("...i,...i->...", r, unit) / n
    residual = r - slope_size[..., None] * unit
    scatter = _rms(residual) * np.sqrt(n / (n - 1))
    # Left of a model that is orthogonal to the reference is only rounding.
    correlated = np.where(np.abs(slope_size) > CONSTANT * _rms(r), np.abs(slope_size), 0.0)
    return ratio(slope_size, size), np.where(size > 0.0, ratio(scatter, correlated), np.nan)


@dataclass(frozen=True, eq=False)
class GroupStatistics:
    """Mean and spread over each group of histories.

    Attributes
    ----------
    groups : tuple, (g,)
        Labels in order of first appearance.
    count : ndarray of int, (g,)
        Histories in each group.
    mean, std : ndarray, (g, ...)
        Over the histories of a group; sample standard deviation (ddof = 1).
    """

    groups: tuple[Hashable, ...]
    count: NDArray[np.int64]
    mean: Floats
    std: Floats


def by_group(values: ArrayLike, groups: Sequence[Hashable]) -> GroupStatistics:
    """Mean and standard deviation over each group, such as the six seeds of one wind condition.

    Parameters
    ----------
    values : array_like, (N, ...)
        One statistic for each history.
    groups : sequence of hashable, (N,)
        Which group each history is in: a name, or a tuple of wind speed, turbulence and shear.

    Returns
    -------
    GroupStatistics

    Raises
    ------
    InputError
        If the lengths differ, a value is not finite, or a group has one history only and so no
        standard deviation.
    """
    value = np.asarray(values, dtype=float)
    if value.ndim < 1 or len(value) != len(groups):
        raise InputError(
            f"values of shape {value.shape} and {len(groups)} group labels must have one label "
            "for each history: give as many labels as rows."
        )
    if not len(value):
        raise InputError("0 histories to group: give at least 1 group of 2.")
    if not np.isfinite(value).all():
        raise InputError(
            "values to group hold an undefined (NaN) or infinite one: leave out the quantity for "
            "which the statistic has no meaning."
        )
    members: dict[Hashable, list[int]] = {}
    for i, label in enumerate(groups):
        members.setdefault(label, []).append(i)
    for label, rows in members.items():
        if len(rows) < 2:
            raise InputError(
                f"group {label!r} has 1 history and needs at least 2 for a standard deviation: "
                "add seeds or merge groups."
            )
    split = [value[rows] for rows in members.values()]
    return GroupStatistics(
        groups=tuple(members),
        count=np.array([len(part) for part in split], dtype=np.int64),
        mean=np.array([part.mean(axis=0) for part in split]),
        std=np.array([part.std(axis=0, ddof=1) for part in split]),
    )


def _pair(reference: ArrayLike, model: ArrayLike) -> tuple[Floats, Floats]:
    r, m = np.asarray(reference, dtype=float), np.asarray(model, dtype=float)
    if r.shape != m.shape or r.ndim < 1:
        raise InputError(
            f"reference {r.shape} and model {m.shape} must have one shape with the samples last: "
            "bring them to the same time steps."
        )
    if r.shape[-1] < 2:
        raise InputError(
            f"histories of {r.shape[-1]} samples must have at least 2: give longer ones."
        )
    for name, values in (("reference", r), ("model", m)):
        if not np.isfinite(values).all():
            raise InputError(
                f"{name} holds a value that is not finite: remove NaN and infinity first."
            )
    return r, m


def _mean_percentage(apart: Floats, size: Floats, kept: NDArray[np.bool_]) -> Floats:
    share = np.zeros(size.shape)
    np.divide(apart, size, out=share, where=kept)
    return 100.0 * ratio(share.sum(axis=-1), kept.sum(axis=-1))


def _correlation(r: Floats, m: Floats) -> Floats:
    a, b = _centred(r), _centred(m)
    product = np.einsum("...i,...i->...", a, b)
    return np.clip(ratio(product / r.shape[-1], _rms(a) * _rms(b)), -1.0, 1.0)


def _difference(r: Floats, m: Floats) -> Floats:
    return np.asarray(m - r)


def _rms(values: Floats) -> Floats:
    return np.asarray(np.sqrt(np.einsum("...i,...i->...", values, values) / values.shape[-1]))


def _mean_absolute(values: Floats) -> Floats:
    return np.asarray(np.abs(values).mean(axis=-1))


def _centred(values: Floats) -> Floats:
    """Values less their mean; exactly zero where only rounding is left."""
    centred = values - values.mean(axis=-1, keepdims=True)
    largest = np.abs(values).max(axis=-1)
    constant = np.abs(centred).max(axis=-1) <= CONSTANT * largest
    centred[constant] = 0.0
    return np.asarray(centred)


def check_excluded(exclude_below: float) -> None:
    """Refuse an `exclude_below` that is not a share, see `mean_percentage_error`."""
    if not 0.0 <= exclude_below < 1.0:
        raise InputError(
            f"exclude_below = {exclude_below:g} must be at least 0 and below 1, as a share of the "
            "reference's rms: 0.001 is usual."
        )


def _kept(reference: Floats, exclude_below: float) -> NDArray[np.bool_]:
    check_excluded(exclude_below)
    return np.asarray(np.abs(reference) > exclude_below * _rms(reference)[..., None])


def ratio(numerator: Floats, denominator: Floats) -> Floats:
    """Quotient, NaN where the denominator is zero."""
    safe = np.where(denominator == 0.0, 1.0, denominator)
    return np.asarray(np.where(denominator == 0.0, np.nan, numerator / safe))
