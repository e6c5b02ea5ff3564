"""All methods of identification on one record: as printed, least squares, spectra, decrement."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.procedure.decay import Decay, logarithmic_decrement
from fe_drivetrain.procedure.identification import (
    Fit,
    Twist,
    least_squares,
    method_a,
    method_b,
    method_c,
    ratio_by_ranges,
    stiffness_by_ranges,
)
from fe_drivetrain.report.number_text import formatted

WINDOW = 5.0
"""Length of the windows of equations 4 and 5 [s]."""

STOP_PEAKS = 6
"""Peaks of a decay that are used, from the first."""

SPECTRA = "fit of spectra"
"""The method that others are put beside."""

_SHORTEST_DECAY = 10


@dataclass(frozen=True)
class MethodAnswer:
    """What one method finds of a record.

    Attributes
    ----------
    method : str
        As in "A, time".
    inertia, damping, stiffness : float or None
        [kg m^2], [N m s/rad], [N m/rad]; medians of the printed methods, None of what a method
        does not give.
    words : str
        What else it says.
    """

    method: str
    inertia: float | None
    damping: float | None
    stiffness: float | None
    words: str


def twist_of(torque: Floats, angle: Floats, step: float) -> Twist:
    """A measured twist, whose rates are differences between samples.

    Parameters
    ----------
    torque, angle : ndarray, (n,)
        Torque in the shaft [N m], and front against rear end [rad], on one side.
    step : float
        Between two samples [s].
    """
    rate = np.asarray(np.gradient(angle, step))
    return Twist(step, torque, angle, rate, np.asarray(np.gradient(rate, step)))


def answers_by_methods(
    twist: Twist, turn: float, fit: Fit, band: tuple[float, float]
) -> tuple[MethodAnswer, ...]:
    """Put every method to a record: equations 4 to 13 as printed, least squares, spectra.

    Parameters
    ----------
    twist : Twist
        With the torque in the shaft, of which an inertia has to come out as zero.
    turn : float
        Mean time of a turn of the rotor [s].
    fit : Fit
        That of `spectral_fit`.
    band : tuple of float
        Its frequencies [Hz].

    Raises
    ------
    InputError
        The record is shorter than a window or a turn, or has one frequency only.
    """
    stiffness = float(np.median(stiffness_by_ranges(twist, WINDOW)))
    ratio = float(np.median(ratio_by_ranges(twist, WINDOW)))
    found = [
        MethodAnswer("Eq 4, ranges", None, None, stiffness, f"windows of {WINDOW:g} s"),
        MethodAnswer("Eq 5, ranges", None, None, None, f"inertia over damping {ratio:.4g} s"),
    ]
    for method, of in (
        ("A, time", method_a(twist, stiffness, ratio)),
        ("B, differential", method_b(twist, turn)),
        ("C, constant", method_c(twist, turn, stiffness)),
    ):
        inertia, damping = of.medians()
        share = 100.0 * float(of.plausible.mean())
        words = f"{share:.0f} % of answers above zero"
        found.append(MethodAnswer(method, inertia, damping, None, words))
    J, D, K = (float(v) for v in least_squares(twist).values)
    found.append(MethodAnswer("least squares", J, D, K, "noise of the twist biases it"))
    bands = ", ".join(formatted(float(band), 2) for band in fit.bands)
    J, D, K = (float(v) for v in fit.values)
    words = f"bands {bands}; {band[0]:.3g} to {band[1]:.3g} Hz"
    return (*found, MethodAnswer(SPECTRA, J, D, K, words))


def decay_after(angle: Floats, step: float, stop: float) -> tuple[Decay, Floats]:
    """Logarithmic decrement of a twist after its torque was lost, and the swing itself.

    Parameters
    ----------
    angle : ndarray, (n,)
        Twist over the whole record [rad].
    step : float
        Between two samples [s].
    stop : float
        When the torque was lost, from the beginning of the record [s].

    Raises
    ------
    InputError
        The record is over by then, or nothing swings.
    """
    late = angle[round(stop / step) :]
    if stop < 0.0 or len(late) < _SHORTEST_DECAY:
        raise InputError(
            f"stop = {stop:g} s is at the end of a record of {len(angle) * step:g} s, or not in "
            "it: give the time at which the torque was lost, from its begin"
        )
    swing = np.asarray(late - late[len(late) // 2 :].mean())
    return logarithmic_decrement(swing, step, STOP_PEAKS), swing


def damping_of_decay(decay: Decay, stiffness: float) -> tuple[float, float]:
    """Damper of a shaft whose twist decays, with the band of its decrement [N m s/rad].

    All that swings is wound up in the shaft, as between rotor and generator: D = 2 zeta K / w,
    w being the frequency without damping.

    Parameters
    ----------
    decay : Decay
        Decay of its twist.
    stiffness : float
        Stiffness of the shaft [N m/rad].

    Raises
    ------
    InputError
        The twist grows.
    """
    if decay.decrement <= 0.0:
        raise InputError(
            f"the twist does not decay after the stop (decrement {decay.decrement:.3g}): give the "
            "time at which the torque was lost"
        )
    natural = 2.0 * np.pi * decay.frequency / float(np.sqrt(1.0 - decay.ratio**2))
    damping = 2.0 * decay.ratio * stiffness / natural
    return damping, damping * decay.band / decay.decrement
