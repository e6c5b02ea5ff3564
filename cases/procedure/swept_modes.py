"""Exact response of a mode to a frequency that rises evenly: a run-up through a resonance.

PROTEST 2010 (appendix A.3.3) asks for a run-up by steadily rising speed. A mode then answers an
excitation whose phase is 2 pi (f0 t + r t^2 / 2), with the response of Lewis (1932, Vibration
during acceleration through a critical speed, Transactions of the ASME 54): lower than at rest in
the resonance, later than the crossing, and followed by beats. It is an integral of a Gaussian of
complex argument, here by the Faddeeva function.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import wofz

from fe_drivetrain.common import Floats, InputError

Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Sweep:
    """A frequency that rises, or falls, evenly.

    Attributes
    ----------
    start : float
        Frequency at t = 0 [Hz].
    rate : float
        Rise of the frequency [Hz/s], not 0.

    Raises
    ------
    InputError
        The rate is 0.
    """

    start: float
    rate: float

    def __post_init__(self) -> None:
        if self.rate == 0.0 or not np.isfinite([self.start, self.rate]).all():
            raise InputError(
                f"a sweep from {self.start:g} Hz at {self.rate:g} Hz/s: give a rate other than 0, "
                "or use the response to a constant frequency"
            )

    def phase(self, time: ArrayLike) -> Floats:
        """Phase at times from 0 on [rad].

        Parameters
        ----------
        time : array_like
            [s].
        """
        t = np.asarray(time, dtype=np.float64)
        return np.asarray(2.0 * np.pi * (self.start * t + 0.5 * self.rate * t**2))

    def time_of(self, frequency: float) -> float:
        """When the frequency is met [s].

        Parameters
        ----------
        frequency : float
            [Hz].
        """
        return (frequency - self.start) / self.rate


def swept_response(frequency: float, ratio: float, sweep: Sweep, time: ArrayLike) -> Complex:
    """Motion of x'' + 2 zeta w x' + w^2 x = exp(i phase(t)) from rest, exactly.

    Parameters
    ----------
    frequency : float
        Natural frequency, w / 2 pi [Hz].
    ratio : float
        Damping ratio zeta, from 0 and below 1.
    sweep : Sweep
        Sweep of the excitation.
    time : array_like, (n,)
        Times from 0 on [s].

    Returns
    -------
    ndarray, (n,)
        Complex: its real part answers cos(phase). At rest in the resonance it would have the size
        1 / (2 zeta w^2).

    Raises
    ------
    InputError
        The frequency or the ratio is out of its range.
    """
    if frequency <= 0.0 or not 0.0 <= ratio < 1.0:
        raise InputError(
            f"a mode of {frequency:g} Hz with a damping ratio of {ratio:g}: give a frequency above "
            "0 and a ratio from 0 to below 1"
        )
    t = np.atleast_1d(np.asarray(time, dtype=np.float64))
    w = 2.0 * np.pi * frequency
    damped = w * float(np.sqrt(1.0 - ratio**2))
    one, other = (_memory(complex(-ratio * w, sign * damped), sweep, t) for sign in (1.0, -1.0))
    return np.asarray((one - other) / (2j * damped), dtype=np.complex128)


def _memory(root: complex, sweep: Sweep, t: Floats) -> Complex:
    """Integral of exp(root (t - s)) exp(i phase(s)) ds from 0 to t."""
    if sweep.rate < 0.0:
        # the conjugate of a frequency that rises from below zero
        return np.conj(_memory(root.conjugate(), Sweep(-sweep.start, -sweep.rate), t))
    alpha = 2.0 * np.pi * sweep.rate
    scale = np.exp(-0.25j * np.pi) * np.sqrt(0.5 * alpha)
    middle = (2.0 * np.pi * sweep.start + 1j * root) / alpha
    begin, end = scale * middle, scale * (t + middle)
    # erfc on the side where it is small; where both are on the other, its 2 drops out
    before = np.where(end.real < 0.0, -1.0, 1.0)
    first = -1.0 if begin.real < 0.0 else 1.0
    passed = (first < 0.0) & (before > 0.0)
    found = first * wofz(1j * first * begin) * np.exp(root * t)
    found -= before * wofz(1j * before * end) * np.exp(1j * sweep.phase(t))
    found[passed] += 2.0 * np.exp(begin**2 + root * t[passed])
    return np.asarray(0.5 * np.sqrt(np.pi) / scale * found, dtype=np.complex128)


@dataclass(frozen=True)
class RunUpPeak:
    """Peak response of a mode in a sweep.

    Attributes
    ----------
    amplification : float
        Peak over the static response to the same force.
    share : float
        Peak over the response at rest in the resonance.
    frequency : float
        Frequency of the excitation at that time [Hz].
    """

    amplification: float
    share: float
    frequency: float


def run_up_peak(frequency: float, ratio: float, sweep: Sweep, periods: int = 40) -> RunUpPeak:
    """Peak of the envelope in a sweep through a mode.

    Parameters
    ----------
    frequency : float
        Natural frequency [Hz].
    ratio : float
        Damping ratio, above 0.
    sweep : Sweep
        Sweep that meets the frequency after its start.
    periods : int
        Points in a period of the mode.

    Returns
    -------
    RunUpPeak

    Raises
    ------
    InputError
        The sweep starts beyond the frequency, or the ratio is out of its range.
    """
    met = sweep.time_of(frequency)
    if met <= 0.0:
        raise InputError(
            f"a sweep from {sweep.start:g} Hz at {sweep.rate:g} Hz/s does not meet {frequency:g} "
            "Hz: let it start on the other side"
        )
    if ratio <= 0.0:
        raise InputError(f"a damping ratio of {ratio:g} has no response at rest: give one above 0")
    # the peak comes within a few widths of the passing, or of the decay, of the crossing
    late = 4.0 / float(np.sqrt(abs(sweep.rate))) + 4.0 * ratio * frequency / abs(sweep.rate)
    step = 1.0 / (periods * frequency)
    time = np.arange(max(0.0, met - late), met + late, step)
    size = np.abs(swept_response(frequency, ratio, sweep, time))
    at = int(size.argmax())
    amplification = float(size[at]) * (2.0 * np.pi * frequency) ** 2
    rest = 1.0 / (2.0 * ratio * float(np.sqrt(1.0 - ratio**2)))
    return RunUpPeak(
        amplification, amplification / rest, sweep.start + sweep.rate * float(time[at])
    )
