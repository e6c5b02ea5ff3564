"""Motions of torsional systems under torques that repeat, or that are straight between samples.

Of torques that repeat a history of n samples is taken as one period, so that speeds and
accelerations are those of the model itself, not differences, and what a method makes of them is the
method's error alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.equations import varying
from fe_drivetrain.dynamics.time.stopping import torsional_equations
from fe_drivetrain.dynamics.time.superposition import energy_error
from fe_drivetrain.dynamics.torsion.system import Torsional


@dataclass(frozen=True, eq=False)
class Motions:
    """Deviations from steady turning, one row for each inertia.

    Attributes
    ----------
    step : float
        Between two samples [s].
    angle, speed, acceleration : ndarray, (n, samples)
        [rad], [rad/s], [rad/s^2].
    """

    step: float
    angle: Floats
    speed: Floats
    acceleration: Floats

    __repr__ = short_repr

    @property
    def time(self) -> Floats:
        """(samples,) from 0 [s]."""
        return np.asarray(np.arange(self.angle.shape[1], dtype=np.float64) * self.step)


def periodic_motions(system: Torsional, torques: Floats, step: float) -> Motions:
    """Motions under torques of which the samples are one period.

    Parameters
    ----------
    system : Torsional
        Inertias, springs, dampers.
    torques : ndarray, (n, samples)
        On each inertia [N m]; the line at half the sampling rate, which has no phase, is left out.
    step : float
        Between two samples [s].

    Returns
    -------
    Motions
        Motions of a system that turns freely, without its free turning.

    Raises
    ------
    InputError
        Mean torques would speed up a system that turns freely.
    """
    given = np.asarray(torques, dtype=np.float64)
    count = given.shape[1]
    lines = np.fft.rfft(given, axis=1)
    if count % 2 == 0:
        lines[:, -1] = 0.0
    omega = 2.0 * np.pi * np.fft.rfftfreq(count, step)
    M, C, K = system.M, system.C, system.K
    angles = np.zeros_like(lines)
    moved = np.flatnonzero(np.abs(lines[:, 1:]).max(axis=0) > 0.0) + 1
    w = omega[moved, None, None]
    dynamic = K - w**2 * M + 1j * w * C
    angles[:, moved] = np.linalg.solve(dynamic, lines[:, moved].T[..., None])[..., 0].T
    angles[:, 0] = count * _static(system, given.mean(axis=1), float(np.abs(given).max()))
    turning = 1j * omega
    return Motions(
        step, *(np.fft.irfft(turning**order * angles, count, axis=1) for order in range(3))
    )


def _static(system: Torsional, torque: Floats, largest: float) -> Floats:
    """Angles under constant torques, without free turning."""
    root = np.sqrt(system.J)
    # stiffness is W^T W, and squaring would cost half of the digits
    W = np.sqrt(system.k)[:, None] * system.B / root
    wound = np.linalg.lstsq(W.T, torque / root, rcond=None)[0]
    found = np.asarray(np.linalg.lstsq(W, wound, rcond=None)[0] / root)
    if np.abs(system.K @ found - torque).max() > 1e-9 * largest:
        raise InputError(
            f"mean torques of {torque.sum():g} N m in sum speed up a system that turns freely: "
            "let driving and braking torques have the same mean, or hold an inertia by a spring"
        )
    return found


def driven_motions(system: Torsional, torques: Floats, step: float) -> Motions:
    """Motions under any torques, straight between samples, from steady turning under the first.

    Exact for such torques (exponential of the state matrix with a ramp as input), at any step.

    Parameters
    ----------
    system : Torsional
        Inertias, springs, dampers.
    torques : ndarray, (n, samples)
        On each inertia [N m].
    step : float
        Between two samples [s].

    Returns
    -------
    Motions
        With the change of speed of a system that turns freely.

    Raises
    ------
    InputError
        The first torques would speed up a system that turns freely.
    """
    given = np.asarray(torques, dtype=np.float64)
    n, count = given.shape
    J = system.J[:, None]
    A = np.zeros((4 * n, 4 * n))
    A[:n, n : 2 * n] = np.eye(n)
    A[n : 2 * n, :n], A[n : 2 * n, n : 2 * n] = -system.K / J, -system.C / J
    # torque and its change over a step, both as states
    A[n : 2 * n, 2 * n : 3 * n] = np.diag(1.0 / system.J)
    A[2 * n : 3 * n, 3 * n :] = np.eye(n) / step
    matrix = expm(A * step)[: 2 * n]
    free, forced = matrix[:, : 2 * n], matrix[:, 2 * n :]
    inputs = forced @ np.vstack([given[:, :-1], np.diff(given, axis=1)])
    states = np.zeros((2 * n, count))
    states[:n, 0] = _static(system, given[:, 0], float(np.abs(given).max()))
    for i in range(count - 1):
        states[:, i + 1] = free @ states[:, i] + inputs[:, i]
    angle, speed = states[:n], states[n:]
    acceleration = (given - system.K @ angle - system.C @ speed) / J
    return Motions(step, angle, speed, acceleration)


def motions_energy_error(system: Torsional, torques: Floats, motions: Motions) -> float:
    """Energy that appears from nowhere in motions under torques, over the largest.

    Parameters
    ----------
    system : Torsional
        Inertias, springs, dampers.
    torques : ndarray, (n, samples)
        On each inertia, straight between samples [N m].
    motions : Motions
        Motions from `driven_motions`.

    Returns
    -------
    float
        Energy error, as `fe_drivetrain.dynamics.energy_error` defines it.
    """
    loads = varying(np.eye(len(torques)), motions.time, torques.T)
    equations = torsional_equations(system)
    return energy_error(equations, loads, motions.time, motions.angle.T, motions.speed.T)


def element_torques(system: Torsional, motions: Motions) -> Floats:
    """Torque in each spring and damper, stiffness times winding and damping times its rate.

    Parameters
    ----------
    system : Torsional
        Whose motions they are.
    motions : Motions
        Motions of all its inertias.

    Returns
    -------
    ndarray, (elements, samples)
        [N m].
    """
    dampings = np.array([element.damping for element in system.elements])
    B = system.B
    return np.asarray(
        system.k[:, None] * (B @ motions.angle) + dampings[:, None] * (B @ motions.speed)
    )


def band_torque(
    samples: int, step: float, band: tuple[float, float], deviation: float, seed: int
) -> Floats:
    """A Gaussian torque without mean, of equal power at all frequencies of a band.

    Parameters
    ----------
    samples : int
        How many.
    step : float
        Between two of them [s].
    band : tuple of float
        Lowest and highest frequency [Hz].
    deviation : float
        Standard deviation [N m].
    seed : int
        Seed of the random phases and amplitudes.

    Returns
    -------
    ndarray, (samples,)
        [N m], one period.

    Raises
    ------
    InputError
        No line of the spectrum is in the band.
    """
    frequency = np.fft.rfftfreq(samples, step)
    inside = (frequency >= band[0]) & (frequency <= band[1]) & (frequency > 0.0)
    inside[-1] = False
    if not inside.any():
        raise InputError(
            f"{samples} samples of {step:g} s have no line from {band[0]:g} to {band[1]:g} Hz: "
            "give a longer history, or a wider band below half the sampling rate"
        )
    lines = np.zeros(len(frequency), dtype=complex)
    normal = np.random.default_rng(seed).standard_normal((2, int(inside.sum())))
    lines[inside] = normal[0] + 1j * normal[1]
    signal = np.fft.irfft(lines, samples)
    return np.asarray(signal * (deviation / signal.std()))
