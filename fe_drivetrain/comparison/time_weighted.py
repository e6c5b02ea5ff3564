"""Statistics of histories of any length and step together: each counts by the time it lasts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.common.arrays import Floats


def sample_weights(counts: Sequence[int], steps: Sequence[float]) -> Floats:
    """Share of each sample in the whole time, for histories one after the other.

    Parameters
    ----------
    counts : sequence of int
        Samples of each history.
    steps : sequence of float
        Time between two of its samples [s].

    Returns
    -------
    ndarray, (n,)
        Their sum is 1.
    """
    seconds = np.repeat(np.asarray(steps, dtype=float), counts)
    return np.asarray(seconds / seconds.sum())


def weighted_statistics(samples: Floats, weights: Floats) -> Floats:
    """Extremes, mean and standard deviation.

    Parameters
    ----------
    samples : ndarray, (n, k)
        Samples of k quantities.
    weights : ndarray, (n,)
        Weights of the samples; their sum is 1.

    Returns
    -------
    ndarray, (k, 4)
        Least, mean, largest, standard deviation.
    """
    mean = weights @ samples
    deviation = np.sqrt(weights @ (samples - mean) ** 2)
    return np.column_stack([samples.min(axis=0), mean, samples.max(axis=0), deviation])


def weighted_rms(samples: Floats, weights: Floats) -> Floats:
    """Root mean square over time.

    Parameters
    ----------
    samples : ndarray, (n, k)
        Samples of k quantities.
    weights : ndarray, (n,)
        Weights of the samples; their sum is 1.

    Returns
    -------
    ndarray, (k,)
    """
    return np.asarray(np.sqrt(weights @ samples**2))
