"""How a turbine runs in twenty years at a site: torques of its rotor, turns at each, and stops."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.stats import norm

from fe_drivetrain.common import Floats
from fe_drivetrain.turbine_loads.histories import Site

SITE = Site(mean_wind=10.0, years=20.0)
WINDS = np.arange(4.0, 26.0)
SCATTER = 0.1
"""Standard deviation of the torque over its mean: assumed."""

RATED_WIND = 11.4
"""Wind of rated power [m/s]; Jonkman et al. 2009 of the NREL 5 MW turbine, assumed of others."""


class Duty(NamedTuple):
    """How a turbine runs, and what the torque of its rotor swings at in a stop.

    Attributes
    ----------
    power : float
        Rated power [W].
    least, speed : float
        Least and rated speed of the rotor [rad/s].
    swing : float
        Frequency of the swing of a stop [Hz].
    """

    power: float
    least: float
    speed: float
    swing: float

    @property
    def torque(self) -> float:
        """Rated torque of the rotor [N m]."""
        return self.power / self.speed


def operation(duty: Duty, levels: int = 41) -> Iterator[tuple[float, Floats, Floats]]:
    """Wind speed, torques of the rotor and its turns at each over the life, normal about means."""
    hours = SITE.hours(np.append(WINDS - 0.5, WINDS[-1] + 0.5))
    ends = np.linspace(-4.0, 4.0, levels + 1)
    share = np.diff(norm.cdf(ends)) / (norm.cdf(4.0) - norm.cdf(-4.0))
    for wind, time in zip(WINDS, hours, strict=True):
        power = duty.power * min((wind / RATED_WIND) ** 3, 1.0)
        speed = min(max(duty.speed * wind / RATED_WIND, duty.least), duty.speed)
        torque = power / speed * (1.0 + SCATTER * 0.5 * (ends[1:] + ends[:-1]))
        yield float(wind), torque, share * time * 3600.0 * speed / (2.0 * np.pi)


def shutdown(duty: Duty) -> tuple[Floats, Floats, float]:
    """Torque and speed of a stop: a swing of the shaft that dies out while the rotor slows down."""
    step = min(0.01, 0.02 / duty.swing)
    t = np.arange(0.0, 30.0, step)
    torque = duty.torque * 1.2 * np.exp(-0.15 * t) * np.cos(2.0 * np.pi * duty.swing * t)
    return torque, duty.speed * (1.0 - t / 30.0), step
