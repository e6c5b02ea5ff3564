"""Damping from a free decay, by the logarithmic decrement of all of its peaks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError


@dataclass(frozen=True)
class Decay:
    """Logarithmic decrement and frequency of a free decay.

    Attributes
    ----------
    decrement : float
        Logarithm of a peak over the next of the same sign (PROTEST 2010, Eq 3).
    frequency : float
        Frequency of the damped oscillation [Hz].
    band : float
        Half width of the decrement that holds the truth 19 times of 20, from the scatter of the
        peaks about a straight line; NaN of fewer than three.
    """

    decrement: float
    frequency: float
    band: float

    @property
    def ratio(self) -> float:
        """Damping over critical damping, Lambda / sqrt(4 pi^2 + Lambda^2)."""
        return self.decrement / float(np.hypot(2.0 * np.pi, self.decrement))


def logarithmic_decrement(signal: Floats, step: float, peaks: int | None = None) -> Decay:
    """Straight line through the logarithms of peaks, at parabolas through their three samples.

    Parameters
    ----------
    signal : ndarray, (n,)
        Decays about zero, with one frequency.
    step : float
        Between two samples [s].
    peaks : int, optional
        How many, from the first; all where left out.

    Returns
    -------
    Decay

    Raises
    ------
    InputError
        There are fewer than two positive peaks.
    """
    values = np.asarray(signal, dtype=np.float64)
    before, here, after = values[:-2], values[1:-1], values[2:]
    at = np.flatnonzero((here > before) & (here >= after) & (here > 0.0))[:peaks] + 1
    if len(at) < 2:
        raise InputError(
            f"a decay with {len(at)} positive peaks: two are needed, so give a longer "
            "history, or one that decays about zero"
        )
    a, b, c = values[at - 1], values[at], values[at + 1]
    shift = 0.5 * (a - c) / (a - 2.0 * b + c)
    times = (at + shift) * step
    heights = np.log(b - 0.25 * (a - c) * shift)
    numbers = np.arange(len(at), dtype=np.float64)
    slope, first = np.polyfit(numbers, heights, 1)
    period = float(np.polyfit(numbers, times, 1)[0])
    band = float("nan")
    if len(at) > 2:
        from scipy.stats import t

        scatter = float(np.sum((heights - first - slope * numbers) ** 2)) / (len(at) - 2)
        spread = float(np.sum((numbers - numbers.mean()) ** 2))
        band = float(t.ppf(0.975, len(at) - 2)) * float(np.sqrt(scatter / spread))
    return Decay(-float(slope), 1.0 / period, band)
