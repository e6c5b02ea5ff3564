"""Statistics of channels in windows of ten minutes, and how many windows each wind has.

The capture matrix counts windows by mean wind speed and turbulence intensity, beside the number
that a campaign asks for (IEC 61400-13).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr

TEN_MINUTES = 600.0

COLUMNS = ("min", "mean", "max", "standard deviation")
"""Statistics of a channel, in the order in which arrays have them."""


@dataclass(frozen=True, eq=False)
class Windows:
    """Statistics of k channels in w windows.

    Attributes
    ----------
    start, seconds : ndarray, (w,)
        When each begins, and how long it lasts [s].
    values : ndarray, (w, k, 4)
        Min, mean, max, standard deviation.
    """

    start: Floats
    seconds: Floats
    values: Floats

    __repr__ = short_repr

    def chosen(self, which: ArrayLike) -> Windows:
        """Those for which a mask (w,) holds."""
        mask = np.asarray(which, dtype=bool)
        return Windows(self.start[mask], self.seconds[mask], self.values[mask])

    def together(self) -> Floats:
        """(k, 4) min, mean, max, standard deviation of all samples of all windows."""
        share = self.seconds / self.seconds.sum()
        means = self.values[:, :, 1]
        mean = np.einsum("w,wc->c", share, means)
        within = np.einsum("w,wc->c", share, self.values[:, :, 3] ** 2)
        between = np.einsum("w,wc->c", share, (means - mean) ** 2)
        return np.column_stack(
            [
                self.values[:, :, 0].min(0),
                mean,
                self.values[:, :, 2].max(0),
                np.sqrt(within + between),
            ]
        )


def joined_windows(parts: Sequence[Windows]) -> Windows:
    """Windows of several histories, one after the other; none where there is no history."""
    if not parts:
        return Windows(np.zeros(0), np.zeros(0), np.zeros((0, 0, len(COLUMNS))))
    return Windows(
        np.concatenate([one.start for one in parts]),
        np.concatenate([one.seconds for one in parts]),
        np.concatenate([one.values for one in parts]),
    )


def window_statistics(
    time: ArrayLike,
    samples: ArrayLike,
    seconds: float = TEN_MINUTES,
    weights: ArrayLike | None = None,
) -> Windows:
    """Statistics in windows of one length; each sample is in one of them.

    What is left at the end is a window of its own if it is half as long or longer, and else part of
    the last one, whose length says so.

    Parameters
    ----------
    time : array_like, (n,)
        Times, of uniform step unless there are weights [s].
    samples : array_like, (n, k)
        Channels.
    seconds : float
        Length of a window [s].
    weights : array_like, (n,), optional
        Time that each sample stands for, where steps differ or leave gaps [s]: a window then lasts
        as long as its samples do, and one without samples is left out.

    Raises
    ------
    InputError
        The length is not positive.
    """
    if not seconds > 0.0:
        raise InputError(f"windows of {seconds:g} s: give a length above 0 s, as 600")
    at, values = np.asarray(time, dtype=float), np.asarray(samples, dtype=float)
    if weights is not None:
        return _weighted(at, values, seconds, np.asarray(weights, dtype=float))
    step = float(at[-1] - at[0]) / (len(at) - 1)
    count = max(1, int(np.floor(len(at) * step / seconds + 0.5)))
    # half a step forward, so that round-off of the time column moves no sample
    window = np.minimum(((at - at[0] + 0.5 * step) // seconds).astype(int), count - 1)
    first = np.searchsorted(window, np.arange(count))
    number = np.diff(first, append=len(at))[:, None]
    mean = np.add.reduceat(values, first) / number
    squares = np.add.reduceat((values - mean[window]) ** 2, first) / number
    table = np.stack(
        [
            np.minimum.reduceat(values, first),
            mean,
            np.maximum.reduceat(values, first),
            np.sqrt(squares),
        ],
        axis=2,
    )
    return Windows(at[first], number[:, 0] * step, table)


def _weighted(at: Floats, values: Floats, seconds: float, weights: Floats) -> Windows:
    """Statistics in windows of the clock, in which each sample counts for its own time."""
    whole = max(1, int(np.floor((at[-1] - at[0]) / seconds + 0.5)))
    window = np.minimum(((at - at[0]) // seconds).astype(int), whole - 1)
    first = np.unique(window, return_index=True)[1]
    lasting = np.add.reduceat(weights, first)
    own = np.repeat(np.arange(len(first)), np.diff(first, append=len(at)))
    each = weights[:, None]
    mean = np.add.reduceat(each * values, first) / lasting[:, None]
    squares = np.add.reduceat(each * (values - mean[own]) ** 2, first) / lasting[:, None]
    low, high = (ufunc.reduceat(values, first) for ufunc in (np.minimum, np.maximum))
    return Windows(at[first], lasting, np.stack([low, mean, high, np.sqrt(squares)], axis=2))


@dataclass(frozen=True, eq=False)
class CaptureMatrix:
    """Number of windows by turbulence intensity (rows) and mean wind speed (columns).

    Attributes
    ----------
    wind : ndarray, (c + 1,)
        Limits of the columns [m/s].
    turbulence : ndarray, (r + 1,)
        Limits of the rows, as shares of the mean.
    counts : ndarray, (r, c)
        Windows in each.
    outside : int
        Windows in none.
    """

    wind: Floats
    turbulence: Floats
    counts: Ints
    outside: int

    __repr__ = short_repr

    def missing(self, target: int) -> Ints:
        """(r, c) windows that each still needs, where each should have `target`."""
        return np.maximum(target - self.counts, 0)

    @property
    def mean_turbulence(self) -> float:
        """Mean turbulence of all windows inside, each with the middle of its row; NaN of none."""
        middles = 0.5 * (self.turbulence[1:] + self.turbulence[:-1])
        total = self.counts.sum()
        return float(middles @ self.counts.sum(axis=1) / total) if total else float("nan")


def capture_matrix(
    mean_wind: ArrayLike, deviation: ArrayLike, wind: ArrayLike, turbulence: ArrayLike
) -> CaptureMatrix:
    """Count windows by their wind.

    Parameters
    ----------
    mean_wind, deviation : array_like, (w,)
        Mean and standard deviation of the wind speed in each window [m/s].
    wind, turbulence : array_like
        Limits of the columns [m/s] and rows, rising.
    """
    mean, spread = np.asarray(mean_wind, dtype=float), np.asarray(deviation, dtype=float)
    edges = [np.asarray(turbulence, dtype=float), np.asarray(wind, dtype=float)]
    with np.errstate(divide="ignore", invalid="ignore"):
        table, _, _ = np.histogram2d(spread / mean, mean, bins=edges)
    counts = table.astype(int)
    return CaptureMatrix(edges[1], edges[0], counts, int(mean.size - counts.sum()))
