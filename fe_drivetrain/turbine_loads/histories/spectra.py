"""Spectra of channels, what stands at multiples of the rotor's speed, and how both vary with it.

A rotor of three equal blades passes on 3P, 6P, 9P to the part that does not turn; 1P is imbalance,
or a channel that turns with the rotor.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr

MULTIPLES = (1, 3, 6, 9)
"""Of the rotor's speed, that are named."""

SEGMENT = 60.0
"""Length of a segment [s]: lines 1/60 Hz apart."""

FEWEST = 8
"""Samples of a segment, at least."""

NEAR = 0.05
"""About a multiple, as a share of it: a rotor's speed varies by as much."""

WINDOW = "Welch's mean over Hann windows, half overlapped, each without its mean"


@dataclass(frozen=True, eq=False)
class Spectrum:
    """One-sided power spectral density.

    Attributes
    ----------
    frequency : ndarray, (f,)
        [Hz], from 0 to half the sampling rate.
    density : ndarray, (f,)
        Unit of the channel squared per Hz; its integral is the variance.
    segments : int
        How many are averaged.
    """

    frequency: Floats
    density: Floats
    segments: int

    __repr__ = short_repr

    @property
    def spacing(self) -> float:
        """Between two lines [Hz]."""
        return float(self.frequency[1] - self.frequency[0])

    def amplitude(self, frequency: float, near: float = NEAR) -> float:
        """Amplitude of the sine that has the power of a band about a frequency.

        Parameters
        ----------
        frequency : float
            Middle of the band [Hz].
        near : float
            Half the band over its middle; at least two lines, as wide as the window makes a sine.
        """
        half = max(near * frequency, 2.0 * self.spacing)
        inside = np.abs(self.frequency - frequency) <= half * (1.0 + 1e-9)
        return float(np.sqrt(2.0 * self.density[inside].sum() * self.spacing))


def spectrum(signal: ArrayLike, step: float, segment: float = SEGMENT) -> Spectrum:
    """Power spectral density of a channel, by Welch's method (1967).

    Parameters
    ----------
    signal : array_like, (n,)
        The channel.
    step : float
        Between two samples [s].
    segment : float
        Length of each segment [s]; the whole where it is shorter.

    Raises
    ------
    InputError
        A segment would have fewer than eight samples.
    """
    from scipy.signal import welch

    values = np.asarray(signal, dtype=float)
    length = min(round(segment / step), len(values))
    if length < FEWEST:
        raise InputError(
            f"spectrum: a segment of {length * step:g} s has {length} samples of {step:g} s and "
            f"needs {FEWEST}: give a longer history, or longer segments"
        )
    frequency, density = welch(values, 1.0 / step, "hann", length, detrend="constant")
    overlap = length // 2
    return Spectrum(frequency, density, 1 + (len(values) - length) // (length - overlap))


def alias(frequency: float, step: float) -> float:
    """Where a frequency appears in samples of a step: itself below half the sampling rate [Hz].

    Parameters
    ----------
    frequency : float
        [Hz].
    step : float
        Between two samples [s].
    """
    rate = 1.0 / step
    return abs(frequency - rate * round(frequency / rate))


@dataclass(frozen=True)
class Multiple:
    """What stands at a multiple of the rotor's speed.

    Attributes
    ----------
    name : str
        As in "3P".
    frequency : float
        [Hz].
    amplitude : float or None
        In the unit of the channel; None where the samples cannot show it.
    appears_at : float
        [Hz]; another frequency where the sampling is too slow.
    """

    name: str
    frequency: float
    amplitude: float | None
    appears_at: float


def multiples(
    found: Spectrum, rotor_speed: float, numbers: Sequence[int] = MULTIPLES
) -> list[Multiple]:
    """Amplitudes at multiples of the rotor's speed.

    Parameters
    ----------
    found : Spectrum
        Spectrum of a channel.
    rotor_speed : float
        Mean [rad/s].
    numbers : sequence of int
        The multiples.
    """
    half_rate = float(found.frequency[-1])
    result = []
    for number in numbers:
        frequency = number * rotor_speed / (2.0 * np.pi)
        shown = frequency < half_rate
        result.append(
            Multiple(
                f"{number}P",
                frequency,
                found.amplitude(frequency) if shown else None,
                alias(frequency, 0.5 / half_rate),
            )
        )
    return result


@dataclass(frozen=True, eq=False)
class Campbell:
    """Spectra by the rotor's speed.

    Attributes
    ----------
    speed : ndarray, (s + 1,)
        Limits of the speeds [rad/s].
    frequency : ndarray, (f,)
        [Hz].
    density : ndarray, (s, f)
        Mean of the segments at each speed; NaN where there is none.
    segments : ndarray, (s,)
        How many.
    """

    speed: Floats
    frequency: Floats
    density: Floats
    segments: Floats

    __repr__ = short_repr


def campbell(
    parts: Iterable[tuple[ArrayLike, ArrayLike, float]],
    speed: ArrayLike,
    segment: float = SEGMENT,
) -> Campbell:
    """Spectra of segments, averaged by the mean speed of the rotor in each.

    Parameters
    ----------
    parts : iterable of (signal, speed, step)
        Histories: a channel (n,), the rotor's speed (n,) [rad/s], the step [s].
    speed : array_like, (s + 1,)
        Limits of the speeds [rad/s].
    segment : float
        Length of a segment [s]; consecutive ones overlap by half.

    Raises
    ------
    InputError
        No segment fits.
    """
    edges = np.asarray(speed, dtype=float)
    sums: dict[int, Floats] = {}
    counts = np.zeros(len(edges) - 1)
    frequency = np.zeros(0)
    for signal, turning, step in parts:
        values, speeds = np.asarray(signal, dtype=float), np.asarray(turning, dtype=float)
        length = round(segment / step)
        for start in range(0, len(values) - length + 1, max(length // 2, 1)):
            own = slice(start, start + length)
            place = int(np.searchsorted(edges, speeds[own].mean(), "right")) - 1
            if not 0 <= place < len(counts):
                continue
            one = spectrum(values[own], step, segment)
            # histories of other steps have the same lines, up to another highest one
            if not len(frequency) or len(one.frequency) < len(frequency):
                frequency = one.frequency
            kept = len(frequency)
            sums = {p: s[:kept] for p, s in sums.items()}
            sums[place] = sums.get(place, np.zeros(kept)) + one.density[:kept]
            counts[place] += 1.0
    if not len(frequency):
        raise InputError(
            f"no history holds a segment of {segment:g} s at a rotor speed from {edges[0]:g} to "
            f"{edges[-1]:g} rad/s: give longer histories, shorter segments, or other speeds"
        )
    density = np.full((len(counts), len(frequency)), np.nan)
    for place, total in sums.items():
        density[place] = total / counts[place]
    return Campbell(edges, frequency, density, counts)
