"""Mathieu's equation x'' + (1 + e cos W t) x = 0: exactly, and as a spring in time steps."""

import numpy as np
from scipy.integrate import solve_ivp

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.dynamics.bodies.equations import (
    Equations,
    equations_of_motion,
    fourier_wave,
    spring_laws,
    steady,
)
from fe_drivetrain.dynamics.time.integration import integrate
from fe_drivetrain.dynamics.time.motion import State


def exact_growth(depth: float, frequency: float) -> float:
    """Rate at which its motion grows [1/s]: ln of the largest Floquet multiplier over the period.

    Parameters
    ----------
    depth : float
        e.
    frequency : float
        W [rad/s].

    Returns
    -------
    rate : float
        0 where motion is bounded.
    """
    period = 2.0 * np.pi / frequency

    def rates(t: float, y: Floats) -> Floats:
        k = 1.0 + depth * np.cos(frequency * t)
        return np.array([y[1], -k * y[0], y[3], -k * y[2]])

    end = solve_ivp(rates, (0.0, period), [1, 0, 0, 1], "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    values = np.linalg.eigvals(end.reshape(2, 2).T)
    return float(np.log(np.abs(values).max()) / period)


def varying_spring(depth: float, frequency: float, damping: float = 0.0) -> Equations:
    """A unit mass on a spring of 1 + e cos W t; arguments as of `stepped_growth`."""
    springs = spring_laws([[1.0]], 1.0, 2.0 * damping).in_phase(frequency=0.5 * frequency / np.pi)
    return equations_of_motion([1.0], springs.with_waves([fourier_wave([depth], [0.0])]))


def stepped_growth(depth: float, frequency: float, steps: int, damping: float = 0.0) -> float:
    """Rate of growth [1/s] by average acceleration, from the motion over one period of the spring.

    Parameters
    ----------
    depth : float
        e.
    frequency : float
        W [rad/s].
    steps : int
        In a period.
    damping : float
        Ratio to critical damping.
    """
    period, one = 2.0 * np.pi / frequency, varying_spring(depth, frequency, damping)

    def after(q: float, velocity: float) -> Floats:
        start = State(np.array([q]), np.array([velocity]), np.zeros(1))
        end = integrate(one, steady([0.0]), period, period / steps, start=start).end
        return np.array([end.q[0], end.velocity[0]])

    step = np.column_stack([after(1.0, 0.0), after(0.0, 1.0)])
    return float(np.log(np.abs(np.linalg.eigvals(step)).max()) / period)
