"""Mathieu's equation x'' + (1 + e cos W t) x = 0, integrated by itself."""

import numpy as np
from scipy.integrate import solve_ivp

from fe_drivetrain.common.arrays import Floats


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
