"""A variable-speed, pitch-controlled turbine's controller, after Jonkman 2009, section 7.

Torque of the generator by its speed: none below a least speed, a line up from there (region 1 1/2),
proportional to its square (region 2), a steep line up to rated torque (region 2 1/2), rated torque
or rated power (region 3).  Pitch by a PI controller of the speed's error whose gains fall as pitch
grows, since torque answers more to pitch there.  Both act on the speed behind a low-pass filter,
and neither changes faster than its rate limit.
All values are at the slow shaft.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.aero_rotor import (
    CUT_OUT,
    OperatingPoint,
    aerodynamic_hub_loads,
    operating_point,
    steady_state,
)
from fe_drivetrain.turbine_loads.hub_loads.turbine import Turbine

SLIP = 0.10
"""Of region 2 1/2: its line has no torque at 1 / 1.1 of its highest speed (Jonkman 2009)."""

TORQUE_SPEED = 0.99
"""Speed of rated torque over the speed that pitch holds, so that both do not act at once."""

CUT_IN_SHARE, FULL_SHARE = 70.16224 / 121.6805, 91.21091 / 121.6805
"""Speeds over that of rated torque where region 1 1/2 begins and ends (Jonkman 2009, Table 7-1)."""

MIN_PITCH = math.radians(1.0)
"""From here on torque is that of region 3 whatever the speed, so that no gust brings dips."""

_AZIMUTHS = 12


@dataclass(frozen=True)
class Tuning:
    """What an engineer chooses.

    Attributes
    ----------
    frequency : float
        Frequency of the speed's answer above rated wind [rad/s].
    damping : float
        Damping of that answer, as a share of critical.
    filter : float
        Corner of the low-pass filter on the speed [Hz].
    pitch_rate : float
        Limit [rad/s].
    torque_rate : float
        Limit, as rated torques a second.
    constant_power : bool
        Above rated wind; else torque is constant.
    """

    frequency: float = 0.6
    damping: float = 0.7
    filter: float = 0.25
    pitch_rate: float = math.radians(8.0)
    torque_rate: float = 0.35
    constant_power: bool = True

    def __post_init__(self) -> None:
        for name in ("frequency", "damping", "filter", "pitch_rate", "torque_rate"):
            value = getattr(self, name)
            if not value > 0.0:
                raise InputError(f"controller: {name} is {value}; it must be positive")


@dataclass(frozen=True)
class Controller:
    """Gains and limits, at the slow shaft.

    Attributes
    ----------
    tuning : Tuning
        From which the gains were made.
    optimal : float
        Torque over speed squared in region 2 [N m s^2].
    rated_speed : float
        That pitch holds [rad/s].
    rated_torque, rated_power : float
        [N m], [W].
    proportional, integral : float
        Gains at zero pitch [s], [-].
    doubling : float
        Pitch at which torque answers twice as much to pitch as at zero [rad].
    """

    tuning: Tuning
    optimal: float
    rated_speed: float
    rated_torque: float
    rated_power: float
    proportional: float
    integral: float
    doubling: float

    @property
    def torque_speed(self) -> float:
        """Where region 3 begins [rad/s]."""
        return TORQUE_SPEED * self.rated_speed

    @property
    def slope(self) -> float:
        """Slope of region 2 1/2 [N m s]."""
        return self.rated_torque / (self.torque_speed * (1.0 - 1.0 / (1.0 + SLIP)))

    @property
    def transition(self) -> float:
        """Where region 2 ends [rad/s]: its parabola meets the line of region 2 1/2."""
        origin = self.torque_speed / (1.0 + SLIP)
        root = self.slope * (self.slope - 4.0 * self.optimal * origin)
        if root < 0.0:
            return self.torque_speed
        return min((self.slope - math.sqrt(root)) / (2.0 * self.optimal), self.torque_speed)

    def torque(self, speed: float, pitch: float = 0.0) -> float:
        """Torque of the generator at a speed [rad/s] and pitch [rad], without rate limit [N m]."""
        if speed >= self.torque_speed or pitch >= MIN_PITCH:
            if self.tuning.constant_power:
                return self.rated_power / max(speed, 0.5 * self.rated_speed)
            return self.rated_torque
        begin, full = (share * self.torque_speed for share in (CUT_IN_SHARE, FULL_SHARE))
        if speed < full:
            return self.optimal * full**2 * max(speed - begin, 0.0) / (full - begin)
        if speed < self.transition:
            return self.optimal * speed**2
        return self.slope * (speed - self.torque_speed / (1.0 + SLIP))

    def schedule(self, pitch: float) -> float:
        """Factor of both gains at a pitch [rad]."""
        return 1.0 / (1.0 + pitch / self.doubling)


def designed_controller(turbine: Turbine, tuning: Tuning | None = None) -> Controller:
    """Gains by which speed answers with the frequency and damping of a tuning (Jonkman 2009, 7.2).

    Parameters
    ----------
    turbine : Turbine
        Its rotor gives power by pitch, induced velocities held; its inertia is that which turns.
    tuning : Tuning or None
        That of the NREL 5 MW turbine if not given.

    Raises
    ------
    InputError
        The rotor reaches its rated power nowhere, or more pitch does not lower it.
    """
    chosen = tuning or Tuning()
    rotor = turbine.rotor
    rated = rotor.tip_speed_limit / rotor.radius
    reached = rotor.tip_speed_limit / rotor.design_tip_speed_ratio
    best = steady_state(rotor, 0.8 * reached, rotor.rotor_speed(0.8 * reached), 0.0)
    pitch, answer = [], []
    for wind in np.linspace(reached, CUT_OUT, 16):
        point = operating_point(rotor, float(wind))
        if point.pitch > 0.0:
            pitch.append(point.pitch)
            answer.append(rated * torque_slopes(turbine, point)[1])
    if len(pitch) < 4:
        raise InputError(
            f"controller: the rotor gives rated_power {rotor.rated_power} W in less than a quarter "
            f"of the winds up to {CUT_OUT:g} m/s; lower rated_power or enlarge the rotor"
        )
    slope, at_zero = np.polyfit(pitch, answer, 1)
    if not (slope < 0.0 and at_zero < 0.0):
        raise InputError(
            "controller: power does not fall with pitch as gain scheduling needs; check the "
            "rotor's stall_angle and design_attack"
        )
    inertia = turbine.rotor_inertia + turbine.generator_inertia
    unit = inertia * rated / -at_zero
    return Controller(
        tuning=chosen,
        optimal=best.torque / best.rotor_speed**2,
        rated_speed=rated,
        rated_torque=rotor.rated_power / (TORQUE_SPEED * rated),
        rated_power=rotor.rated_power,
        proportional=float(2.0 * unit * chosen.damping * chosen.frequency),
        integral=float(unit * chosen.frequency**2),
        doubling=float(at_zero / slope),
    )


def held_torque(turbine: Turbine, point: OperatingPoint, speed: float, pitch: float) -> float:
    """Mean torque over a turn with the induced velocities of an operating point [N m].

    Parameters
    ----------
    turbine : Turbine
        Its rotor is used.
    point : OperatingPoint
        Gives wind and induced velocities.
    speed, pitch : float
        In place of the point's [rad/s], [rad].
    """
    # the swirl is held as a speed, the point has it as a share of the speed of rotation
    swirl = point.tangential * point.rotor_speed / speed
    moved = replace(point, rotor_speed=speed, pitch=pitch, tangential=swirl)
    azimuth = 2.0 * np.pi / 3.0 / _AZIMUTHS * np.arange(_AZIMUTHS)
    wind = np.full((turbine.rotor.blades, _AZIMUTHS, point.radius.size), point.wind_speed)
    return float(aerodynamic_hub_loads(turbine.rotor, moved, wind, azimuth)[:, 3].mean())


def torque_slopes(turbine: Turbine, point: OperatingPoint) -> tuple[float, float]:
    """How torque answers to speed [N m s] and to pitch [N m/rad], induced velocities held.

    Parameters
    ----------
    turbine : Turbine
        Its rotor is used.
    point : OperatingPoint
        About which.
    """
    step_speed, step_pitch = 1e-4 * point.rotor_speed, 1e-5
    speed, pitch = point.rotor_speed, point.pitch

    def torque(of_speed: float, of_pitch: float) -> float:
        return held_torque(turbine, point, of_speed, of_pitch)

    by_speed = torque(speed + step_speed, pitch) - torque(speed - step_speed, pitch)
    by_pitch = torque(speed, pitch + step_pitch) - torque(speed, pitch - step_pitch)
    return by_speed / (2.0 * step_speed), by_pitch / (2.0 * step_pitch)


def speed_poles(
    turbine: Turbine, controller: Controller, point: OperatingPoint
) -> tuple[complex, complex]:
    """Poles of the speed's answer above rated wind, without filter [1/s].

    From inertia x'' + (slopes of torques) x' + gains: Jonkman 2009, Eq 7-9, with the slopes of
    aerodynamic and generator torque by speed, which he leaves out.

    Parameters
    ----------
    turbine, controller : Turbine, Controller
        The turbine and its controller.
    point : OperatingPoint
        Above rated wind.
    """
    by_speed, by_pitch = torque_slopes(turbine, point)
    factor = controller.schedule(point.pitch)
    of_generator = (
        -controller.rated_power / point.rotor_speed**2 if controller.tuning.constant_power else 0.0
    )
    inertia = turbine.rotor_inertia + turbine.generator_inertia
    damping = of_generator - by_speed - by_pitch * controller.proportional * factor
    stiffness = -by_pitch * controller.integral * factor
    one, other = np.roots([inertia, damping, stiffness])
    return complex(one), complex(other)


def steady_operation(turbine: Turbine, controller: Controller, wind_speed: float) -> OperatingPoint:
    """Where torque of the rotor and of the generator are equal, in a steady and even wind.

    Parameters
    ----------
    turbine, controller : Turbine, Controller
        The turbine and its controller.
    wind_speed : float
        [m/s].

    Raises
    ------
    InputError
        The wind speed is outside the operating range.
    """
    from scipy.optimize import brentq

    rotor = turbine.rotor
    operating_point(rotor, wind_speed)  # says what is wrong with the wind speed
    rated = controller.rated_speed
    torque = controller.torque(rated, MIN_PITCH)

    def left(pitch: float) -> float:
        return steady_state(rotor, wind_speed, rated, pitch).torque - torque

    if left(0.0) > 0.0:
        pitch = float(brentq(left, 0.0, math.radians(40.0), xtol=1e-12))
        return steady_state(rotor, wind_speed, rated, pitch)

    def surplus(speed: float) -> float:
        at = steady_state(rotor, wind_speed, speed, 0.0)
        return at.torque - controller.torque(speed)

    # about the best tip-speed ratio: far slower, a rotor stalls and has other equilibria
    low = high = min(rotor.design_tip_speed_ratio * wind_speed / rotor.radius, 0.999 * rated)
    while surplus(low) < 0.0:
        low *= 0.97
    while surplus(high) > 0.0:
        high = min(1.03 * high, rated)
    speed = float(brentq(surplus, low, high, xtol=1e-12))
    return steady_state(rotor, wind_speed, speed, 0.0)
