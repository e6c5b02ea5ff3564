"""Virtual sensors: what a campaign would record of simulated signals (PROTEST 2010, section 4.6.2).

Strain gauges have a gain, an offset, noise and a resolution; encoders give pulses, which are
counted at each sample or timed by a fast clock. Torque is scaled by electrical power, as strain
gauges on a large shaft have no calibration by weights.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

CLOCK = 32e6
"""Frequency of the counter that times pulses [Hz] (PROTEST 2010, p. 63)."""


@dataclass(frozen=True)
class Sensor:
    """A sensor with an amplifier and a recorder.

    Attributes
    ----------
    gain : float
        Recorded over true.
    offset : float
        Recorded at zero, in the unit of the signal.
    noise : float
        Standard deviation of white noise, in that unit.
    resolution : float
        Step of the digits, in that unit; 0 of none.
    every : int
        Takes every n-th sample of the signal, without a filter before it.
    """

    gain: float = 1.0
    offset: float = 0.0
    noise: float = 0.0
    resolution: float = 0.0
    every: int = 1

    def __post_init__(self) -> None:
        if self.every < 1 or self.noise < 0.0 or self.resolution < 0.0:
            raise InputError(
                f"a sensor that takes every {self.every}th sample with noise {self.noise:g} and "
                f"resolution {self.resolution:g}: give a number from 1, and values from 0"
            )


def measured(sensor: Sensor, signal: Floats, seed: int) -> Floats:
    """What a sensor records of a signal.

    Parameters
    ----------
    sensor : Sensor
        Its errors.
    signal : ndarray, (n,)
        The truth.
    seed : int
        Seed of the noise.

    Returns
    -------
    ndarray
        Every `sensor.every`-th sample.
    """
    taken = np.asarray(signal, dtype=np.float64)[:: sensor.every]
    noise = sensor.noise * np.random.default_rng(seed).standard_normal(len(taken))
    found = sensor.gain * taken + sensor.offset + noise
    return (
        found
        if sensor.resolution == 0.0
        else np.round(found / sensor.resolution) * sensor.resolution
    )


def counted_angle(angle: Floats, pulses: int) -> Floats:
    """Angle by counting pulses up to each sample: it stands still between two of them.

    Parameters
    ----------
    angle : ndarray, (n,)
        True angle of the shaft [rad].
    pulses : int
        Number of pulses of one turn.

    Returns
    -------
    ndarray, (n,)
        [rad], up to one pulse too small.
    """
    pitch = 2.0 * np.pi / pulses
    return np.asarray(np.floor(np.asarray(angle) / pitch) * pitch)


def timed_angle(
    time: Floats, angle: Floats, pulses: int, samples: Floats, clock: float = CLOCK
) -> Floats:
    """Angle by timing each pulse with a fast clock, straight between two pulses.

    Parameters
    ----------
    time, angle : ndarray, (n,)
        Times and angles of a shaft that turns forward [s], [rad].
    pulses : int
        Number of pulses of one turn.
    samples : ndarray, (m,)
        When the angle is asked for [s].
    clock : float
        Frequency of the counter [Hz].

    Returns
    -------
    ndarray, (m,)
        [rad].

    Raises
    ------
    InputError
        The shaft does not turn forward all the time, or by fewer than two pulses.
    """
    if not (np.diff(angle) > 0.0).all():
        raise InputError(
            "pulses of one encoder track do not say which way a shaft turns, and this one turns "
            "back: give an angle that rises all the time, or use counted_angle"
        )
    pitch = 2.0 * np.pi / pulses
    numbers = np.arange(np.ceil(angle[0] / pitch), np.floor(angle[-1] / pitch) + 1)
    if len(numbers) < 2:
        raise InputError(
            f"the shaft turns by {angle[-1] - angle[0]:g} rad, which is less than two pulses of "
            f"{pitch:g} rad: give a longer history, or more pulses a turn"
        )
    passed = np.ceil(np.interp(numbers * pitch, angle, time) * clock) / clock
    return np.asarray(np.interp(samples, passed, numbers * pitch))


def scaled_to_power(torque: Floats, speed: Floats, power: Floats, efficiency: float) -> float:
    """Factor on a measured torque, so that its mean is that of the electrical power and losses.

    Parameters
    ----------
    torque, speed : ndarray, (n,)
        Torque and speed of one shaft, torque as recorded [N m], [rad/s].
    power : ndarray, (n,)
        Electrical [W].
    efficiency : float
        Electrical power over that of the shaft.

    Returns
    -------
    float
        What the recorded torque is to be multiplied by. It takes out a gain in full; of an offset
        it makes an error of gain.

    Raises
    ------
    InputError
        The efficiency is not above 0 and at most 1, or the mean torque is zero.
    """
    if not 0.0 < efficiency <= 1.0:
        raise InputError(f"efficiency {efficiency:g} must be above 0 and at most 1: change it")
    mean = float(np.mean(torque))
    if mean == 0.0:
        raise InputError(
            "a torque with a mean of 0 N m cannot be scaled by power: give one under load"
        )
    return float(np.mean(power)) / efficiency / float(np.mean(speed)) / mean


def sampling_rates(frequency: float) -> tuple[float, float]:
    """Least and better sampling rate for a frequency: 3 and 5 times (PROTEST 2010, section 4.5).

    Parameters
    ----------
    frequency : float
        Highest that matters [Hz].
    """
    return 3.0 * frequency, 5.0 * frequency
