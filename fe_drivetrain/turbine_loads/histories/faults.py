"""Samples that look like faults of a recording: single ones far from both neighbours."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats, Ints

FAR = 20.0
"""Distance from the middle of both neighbours, over its usual size, from which on it is odd."""

OF_SCATTER = 0.5
"""The same over the standard deviation of the channel: smaller ones load nothing."""

_NORMAL = 1.4826  # standard deviation over median size, of a normal distribution


def lone_samples(signal: ArrayLike) -> Ints:
    """Places of single samples that are far from both of their neighbours, on one side.

    A load moves with inertia, so that its samples lie near the middle of their neighbours; what
    does not is a fault of sensor, telemetry or conversion, or an event shorter than the sampling.
    Nothing is taken out: who reads the history decides.

    Parameters
    ----------
    signal : array_like, (n,)
        A channel.

    Returns
    -------
    ndarray, (m,)
        Numbers of samples, from 0.
    """
    values: Floats = np.asarray(signal, dtype=float)
    if values.size < 3:
        return np.zeros(0, dtype=np.intp)
    before, after, away, usual = _distances(values)
    least = max(FAR * usual, OF_SCATTER * float(values.std()))
    # one step leads there and another of its size back: neither a jump that stays, nor what stands
    # beside a spike
    there_and_back = np.minimum(before * np.sign(away), after * np.sign(away)) > 0.5 * np.abs(away)
    return np.flatnonzero((np.abs(away) > least) & there_and_back & (least > 0.0)) + 1


def times_as_far(signal: ArrayLike, places: Ints) -> Floats:
    """How far samples are from the middle of both their neighbours, over its usual size.

    Parameters
    ----------
    signal : array_like, (n,)
        A channel.
    places : ndarray, (m,)
        Numbers of samples, as of `lone_samples`.

    Returns
    -------
    ndarray, (m,)
        From `FAR` on; infinite where the usual distance is 0, as of a channel that else stands
        still.
    """
    *_, away, usual = _distances(np.asarray(signal, dtype=float))
    with np.errstate(divide="ignore"):
        return np.asarray(np.abs(away[places - 1]) / usual)


def _distances(values: Floats) -> tuple[Floats, Floats, Floats, float]:
    """From each sample but the first and last to its neighbours and their middle; the usual one."""
    before, after = np.diff(values)[:-1], -np.diff(values)[1:]
    away = 0.5 * (before + after)
    return before, after, away, _NORMAL * float(np.median(np.abs(away)))
