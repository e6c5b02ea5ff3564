"""Stiffness, damping and inertia of a drivetrain from its twist: equations 2 to 13 as printed.

PROTEST 2010 (ECN-E--10-100, section 4.6.2.6) writes ``T = I x'' + D x' + K x`` for the twist x, all
on the high-speed side, with T the torque in the rotor's shaft (Eq 1). That holds for no torque that
is measured: the torque in a shaft is K x + D x', and the inertia belongs to the reduced torque ``J*
(T_aero / J_r + T_gen / J_g)``, J* = J_r J_g / (J_r + J_g) (`reduced_torque`). The methods from
ranges drop the phase: acceleration opposes displacement, so that ranges cannot be added. They stand
here to show what they give; what works is `least_squares` without noise, and `spectral_fit` (module
`spectral_fit`) of measured signals.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class Twist:
    """Twist between two ends of a drivetrain and a torque, all referred to one side.

    Attributes
    ----------
    step : float
        Between two samples [s].
    torque : ndarray, (n,)
        Left side of Eq 1 [N m]: whichever torque it is.
    angle, speed, acceleration : ndarray, (n,)
        Front against rear end [rad], [rad/s], [rad/s^2].
    """

    step: float
    torque: Floats
    angle: Floats
    speed: Floats
    acceleration: Floats

    __repr__ = short_repr


def reduced_torque(
    driving: Floats, braking: Floats, front: float, rear: float
) -> tuple[Floats, float]:
    """Torque and inertia of the one oscillator that two free inertias are.

    Parameters
    ----------
    driving : ndarray, (n,)
        On the front inertia, in the direction of turning [N m].
    braking : ndarray, (n,)
        On the rear inertia, against it [N m].
    front, rear : float
        Inertias, referred to one side [kg m^2].

    Returns
    -------
    torque : ndarray, (n,)
        J* x'' + D x' + K x [N m].
    inertia : float
        J* [kg m^2].
    """
    inertia = front * rear / (front + rear)
    return inertia * (np.asarray(driving) / front + np.asarray(braking) / rear), inertia


@dataclass(frozen=True, eq=False)
class Solutions:
    """All answers that a printed method gives of one history.

    Attributes
    ----------
    inertia, damping : ndarray, (n,)
        [kg m^2], [N m s/rad].
    """

    inertia: Floats
    damping: Floats

    __repr__ = short_repr

    @property
    def plausible(self) -> Bools:
        """(n,) whether both are above zero, as the report keeps them."""
        return np.asarray((self.inertia > 0.0) & (self.damping > 0.0))

    def medians(self, plausible: bool = False) -> tuple[float, float]:
        """Medians of inertia and damping, of all or of plausible answers; NaN of none.

        Parameters
        ----------
        plausible : bool
            Whether others are left out.
        """
        kept = self.plausible if plausible else np.isfinite(self.inertia + self.damping)
        if not kept.any():
            return float("nan"), float("nan")
        return float(np.median(self.inertia[kept])), float(np.median(self.damping[kept]))


def window_ranges(signal: Floats, length: int) -> Floats:
    """Largest minus least value in windows one after another; an end that fills none is left out.

    Parameters
    ----------
    signal : ndarray, (n,)
        Any channel.
    length : int
        Samples of a window.

    Raises
    ------
    InputError
        The signal is shorter than a window, or a window than two samples.
    """
    values = np.asarray(signal, dtype=np.float64)
    count = len(values) // max(length, 1)
    if length < 2 or count == 0:
        raise InputError(
            f"windows of {length} samples in a history of {len(values)}: give from 2 samples to "
            "the whole history"
        )
    return np.asarray(np.ptp(values[: count * length].reshape(count, length), axis=1))


def stiffness_by_ranges(twist: Twist, seconds: float = 5.0) -> Floats:
    """Range of torque over range of twist, window by window (Eq 4) [N m/rad].

    Of the torque in a shaft at one frequency w this is sqrt(K^2 + (w D)^2).

    Parameters
    ----------
    twist : Twist
        Near resonance, as the report asks for.
    seconds : float
        Length of a window [s].
    """
    length = round(seconds / twist.step)
    return window_ranges(twist.torque, length) / window_ranges(twist.angle, length)


def ratio_by_ranges(twist: Twist, seconds: float = 5.0) -> Floats:
    """Inertia over damping by Eq 5, window by window [s].

    Printed, the sum of two ranges times I and D is zero, which two positive ranges make negative;
    the sign is left out here. At one frequency w it is 1 / w, whatever inertia and damping are.

    Parameters
    ----------
    twist : Twist
        Near resonance.
    seconds : float
        Length of a window [s].
    """
    length = round(seconds / twist.step)
    return window_ranges(twist.speed, length) / window_ranges(twist.acceleration, length)


def method_a(twist: Twist, stiffness: float, ratio: float) -> Solutions:
    """Method A, "time": Eq 6 for each sample, with inertia over damping known.

    Parameters
    ----------
    twist : Twist
        Any operation.
    stiffness : float
        From Eq 4 [N m/rad].
    ratio : float
        Inertia over damping from Eq 5 [s].
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        damping = (twist.torque - stiffness * twist.angle) / (
            ratio * twist.acceleration + twist.speed
        )
    return Solutions(ratio * damping, damping)


def method_b(twist: Twist, seconds: float, stiffness: float = 0.0) -> Solutions:
    """Method B, "differential": ranges of rates in neighbouring windows (Eq 7 to 11).

    Parameters
    ----------
    twist : Twist
        Any operation.
    seconds : float
        Mean time of a turn of the rotor [s].
    stiffness : float
        0 where twist is called constant in a window, as printed; else that of Eq 8 [N m/rad].
    """
    length = round(seconds / twist.step)
    A = window_ranges(np.gradient(twist.torque, twist.step), length)
    A = A - stiffness * window_ranges(twist.speed, length)
    first = window_ranges(twist.acceleration, length)
    second = window_ranges(np.gradient(twist.acceleration, twist.step), length)
    return _pairs(A, A, second, first)


def method_c(twist: Twist, seconds: float, stiffness: float, sampled: bool = False) -> Solutions:
    """Method C, "constant": ranges in neighbouring windows (Eq 12, 13).

    The torque of Eq 13 is printed as a sample; it is a range here, as everything else in it.

    Parameters
    ----------
    twist : Twist
        Any operation.
    seconds : float
        Mean time of a turn of the rotor [s].
    stiffness : float
        Known [N m/rad].
    sampled : bool
        Whether the torque of Eq 13 is the first sample of its window, as printed.
    """
    length = round(seconds / twist.step)
    held = stiffness * window_ranges(twist.angle, length)
    A = window_ranges(twist.torque, length) - held
    second = np.asarray(twist.torque)[: len(A) * length : length] - held if sampled else A
    return _pairs(
        A,
        second,
        window_ranges(twist.acceleration, length),
        window_ranges(twist.speed, length),
    )


def _pairs(A: Floats, second: Floats, inertial: Floats, damped: Floats) -> Solutions:
    """Eq 10 and 11 of each window and the next: A (then second) = inertial I + damped D."""
    A1, A2, b1, b2 = A[:-1], second[1:], inertial[:-1], inertial[1:]
    d1, d2 = damped[:-1], damped[1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        damping = (A2 * b1 - A1 * b2) / (b1 * d2 - b2 * d1)
        return Solutions(np.asarray((A1 - damping * d1) / b1), np.asarray(damping))


@dataclass(frozen=True, eq=False)
class Fit:
    """Inertia, damping and stiffness with what is known of their errors.

    Attributes
    ----------
    values : ndarray, (3,)
        [kg m^2], [N m s/rad], [N m/rad].
    covariance : ndarray, (3, 3)
        Covariance of these, from the residual.
    """

    values: Floats
    covariance: Floats

    __repr__ = short_repr

    @property
    def bands(self) -> Floats:
        """(3,) half widths that hold the truth 19 times of 20, of Gaussian errors without bias."""
        return np.asarray(1.959964 * np.sqrt(np.diag(self.covariance)))


def least_squares(twist: Twist) -> Fit:
    """Eq 1 fitted to all samples at once.

    Exact for the reduced torque without noise. Noise in the twist is amplified by its derivatives
    and biases the answer, whatever the band says: of measured signals use `spectral_fit`.

    Parameters
    ----------
    twist : Twist
        With the reduced torque; of the torque in a shaft the inertia comes out as zero.

    Returns
    -------
    Fit
        With the covariance of a white residual.

    Raises
    ------
    InputError
        The history does not tell the three apart, as a single frequency does not.
    """
    columns = np.stack([twist.acceleration, twist.speed, twist.angle], axis=1)
    columns = np.column_stack([columns - columns.mean(axis=0), np.ones(len(columns))])
    scale = np.linalg.norm(columns, axis=0)
    if not scale.all() or np.linalg.cond(columns / scale) > 1e10:
        raise InputError(
            "the twist has one frequency only, which does not tell inertia from stiffness: give a "
            "history with several"
        )
    scaled = columns / scale
    found, *_ = np.linalg.lstsq(scaled, twist.torque, rcond=None)
    residual = twist.torque - scaled @ found
    variance = float(residual @ residual) / max(len(residual) - 4, 1)
    covariance = variance * np.linalg.inv(scaled.T @ scaled) / np.outer(scale, scale)
    return Fit(np.asarray((found / scale)[:3]), np.asarray(covariance[:3, :3]))
