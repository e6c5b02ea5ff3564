"""Start-up, stops and normal operation as torque and thrust, to stated statistics of their cycles.

Al-Hamadani 2018, chapter 3, has measured torque of a 2 MW turbine in statistics only: largest
range, median range and mean, largest negative mean, damage-equivalent load.  `made_event` makes
histories that have these: it draws cycles of random size to the stated largest, median and sum of
sixth powers, gives half of them a mean below and half above the stated median, and lays them on
one large cycle so that rainflow counting (the history followed by itself, as in the thesis) finds
each.  They are no evidence for these statistics, to which they are drawn.  `grid_loss` has none
there; it is the motion of two masses.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import ONE_RPM
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.turbine_loads.hub_loads.turbine import Turbine

State = Literal["normal operation", "start-up", "normal stop", "emergency stop"]
Shaft = Literal["slow", "fast"]

RATED = {"slow": 2e6 / (18.1 * ONE_RPM), "fast": 2e6 / (1680.0 * ONE_RPM)}
"""Torque of 2 MW at 18.1 and 1680 rpm (Al-Hamadani 2018, Table 3.1) [N m]."""

SWING = 0.814
"""Cycles a second: the two-mass frequency of that drivetrain on a held fast shaft [Hz]."""

SLOPE = 6.0
"""Exponent of the damage-equivalent loads of the thesis."""

_HALF = 24  # samples in half a cycle


@dataclass(frozen=True)
class Statistics:
    """What a state of operation is made to; torques over rated, of cycles by rainflow counting.

    Attributes
    ----------
    seconds : float
        Duration [s].
    largest, median : float
        Ranges.
    mean : float
        Median of the means.
    min_mean : float or None
        Smallest mean; not made to one where there is none.
    equivalent : float or None
        Damage-equivalent load at 1 Hz, slope 6; not made to one where there is none.
    begin, end : float
        Torque at the beginning and at the end.
    """

    seconds: float
    largest: float
    median: float
    mean: float
    min_mean: float | None
    equivalent: float | None
    begin: float
    end: float


def stated(state: State, shaft: Shaft) -> Statistics:
    """Statistics of a state of operation, from the thesis (its lines 761 to 822) and from choices.

    The thesis states ratios to the emergency stop: medians of ranges 5, 1.3, 1.76 (fast), 8.9, 1.5,
    1.92 (slow), of means 2, 1.92, 2.47 and 2.2, 2.1, 2.6 under that of normal operation, negative
    means 4 and 5.8, equivalent loads 3.65, 1.1, 1.43 (fast); largest ranges 3.8 and 19 kN m (fast),
    250 and 2000 kN m (slow); negative means to -4 kN m (fast).  Chosen here: normal operation at
    80 % of rated torque, its median range, the equivalent load of the emergency stop, largest
    ranges of start-up and normal stop, which it says lie between the others.

    Parameters
    ----------
    state : State
        State of operation.
    shaft : Shaft
        "slow" (rotor) or "fast" (generator).
    """
    fast = shaft == "fast"
    rated = RATED[shaft] / 1e3
    level = 0.8
    largest = {
        "normal operation": 3.8 if fast else 250.0,
        "start-up": 12.0 if fast else 1250.0,
        "normal stop": 17.0 if fast else 1750.0,
        "emergency stop": 19.5 if fast else 2010.0,
    }[state]
    ranges = dict.fromkeys(("emergency stop",), 1.0)
    ranges |= {
        "normal operation": 5.0 if fast else 8.9,
        "normal stop": 1.3 if fast else 1.5,
        "start-up": 1.76 if fast else 1.92,
    }
    means = {
        "normal operation": 1.0,
        "emergency stop": 2.0 if fast else 2.2,
        "normal stop": 1.92 if fast else 2.1,
        "start-up": 2.47 if fast else 2.6,
    }
    equivalents = {
        "normal operation": 3.65,
        "emergency stop": 1.0,
        "normal stop": 1.1,
        "start-up": 1.43,
    }
    negative = {"emergency stop": 1.0, "normal stop": 4.0, "start-up": 5.8}
    seconds = {
        "normal operation": 20.0,
        "emergency stop": 30.0,
        "normal stop": 48.0,
        "start-up": 70.0,
    }
    median = (6.0 if fast else 620.0) / ranges[state] / rated
    mean = level / means[state]
    begin, end = {
        "normal operation": (mean, mean),
        "start-up": (0.0, mean),
        "normal stop": (level, 0.0),
        "emergency stop": (level, 0.0),
    }[state]
    least = None
    if state in negative:
        least = -(4.0 / (RATED["fast"] / 1e3)) / negative[state]
    equivalent = 11.5 / equivalents[state] / rated if fast else None
    return Statistics(seconds[state], largest / rated, median, mean, least, equivalent, begin, end)


@dataclass(frozen=True, eq=False)
class Event:
    """A history of torque and thrust.

    Attributes
    ----------
    name : str
        What happens.
    time : ndarray, (n,)
        [s].
    torque : ndarray, (n,)
        [N m].
    thrust : ndarray, (n,)
        Over that of the operation before it, or after a start-up.
    """

    name: str
    time: Floats
    torque: Floats
    thrust: Floats

    __repr__ = short_repr


def made_event(state: State, shaft: Shaft, seed: int) -> Event:
    """Draw a history of a state of operation; see the module.

    Thrust follows pitch, of which the thesis says "fast" and no more: it rises or falls over a
    third of a start-up or normal stop, and over 3 s in an emergency stop (8 deg/s over 24 deg).

    Parameters
    ----------
    state : State
        State of operation.
    shaft : Shaft
        "slow" or "fast".
    seed : int
        Seed of the random numbers; the largest cycle and the statistics are the same for all.
    """
    asked = stated(state, shaft)
    random = np.random.default_rng(np.random.SeedSequence([seed, sum(map(ord, state + shaft))]))
    ranges, means = drawn_cycles(asked, random)
    turning = laid_out(asked, ranges, means, random)
    before = 0.5 + 0.5 * np.cos(np.pi * np.arange(_HALF) / _HALF)
    # a turning point is a sample, to the last digit
    path = turning[:-1, None] * before + turning[1:, None] * (1.0 - before)
    torque = RATED[shaft] * np.append(path.ravel(), turning[-1])
    time = np.linspace(0.0, asked.seconds, torque.size)
    third = 3.0 if state == "emergency stop" else asked.seconds / 3.0
    ramp = 0.5 - 0.5 * np.cos(np.pi * np.clip(time / third, 0.0, 1.0))
    thrust = np.ones_like(time)
    if state != "normal operation":
        thrust = ramp if state == "start-up" else 1.0 - ramp
    return Event(state, time, torque, thrust)


def drawn_cycles(asked: Statistics, random: np.random.Generator) -> tuple[Floats, Floats]:
    """Ranges and means (n,) of cycles that have stated statistics, the largest first.

    Parameters
    ----------
    asked : Statistics
        To which they are made.
    random : numpy.random.Generator
        Where sizes and means come from.

    Raises
    ------
    InputError
        No cycles have them.
    """
    from scipy.optimize import brentq

    half = round(0.5 * (asked.seconds * SWING - 1.0))  # above the median, and below
    grown = np.append(random.uniform(0.0, 1.0, half - 1), 1.0)
    small = asked.median * np.append(random.uniform(0.2, 1.0, half - 1), 0.2)
    ratio = asked.largest / asked.median

    def upper(power: float) -> Floats:
        return np.asarray(asked.median * ratio ** (grown**power))

    power = 2.0
    if asked.equivalent is not None:
        total = float(asked.seconds * asked.equivalent**SLOPE)
        total -= float((small**SLOPE).sum() + asked.median**SLOPE)

        def surplus(log_power: float) -> float:
            return float((upper(math.exp(log_power)) ** SLOPE).sum()) / total - 1.0

        if not surplus(-12.0) > 0.0 > surplus(12.0):
            raise InputError(
                f"event: {2 * half + 1} cycles of at most {asked.largest:.3g} times rated torque, "
                f"half of them below {asked.median:.3g}, have no equivalent load of "
                f"{asked.equivalent:.3g}: change one of them"
            )
        power = math.exp(float(brentq(surplus, -12.0, 12.0, xtol=1e-14)))
    ranges = np.sort(np.concatenate([upper(power), [asked.median], small]))[::-1]
    # the largest cycle has the median mean; all others lie within it, on either side of that
    room = 0.5 * (asked.largest - ranges)
    side = np.zeros(len(ranges))
    side[1:] = random.permutation(np.repeat([1.0, -1.0], half))
    shift = side * random.uniform(0.0, 1.0, len(ranges))
    if asked.min_mean is None:
        return ranges, asked.mean + shift * room
    deepest = asked.mean - asked.min_mean
    if deepest > room[-1]:
        raise InputError(
            f"event: the least mean {asked.min_mean:.3g} times rated torque leaves the smallest "
            f"cycle, {ranges[-1]:.3g}, outside of the largest: raise one of them"
        )
    below = np.flatnonzero(side < 0.0)
    side[below[-1]], side[-1] = side[-1], -1.0  # the smallest cycle has the least mean
    shift = side * np.abs(shift)
    shift[-1] = -1.0
    return ranges, asked.mean + shift * np.where(side < 0.0, np.minimum(room, deepest), room)


def laid_out(
    asked: Statistics, ranges: Floats, means: Floats, random: np.random.Generator
) -> Floats:
    """Turning points of a history of which rainflow counting finds these cycles.

    On a rise cycles close that stand in the order of their tops, on a fall in that of their
    bottoms.  The history begins on the rise to the top of the largest cycle, falls to its bottom,
    and ends on the way up, where it began or below; a start-up falls before it rises.

    Parameters
    ----------
    asked : Statistics
        Where it begins and ends.
    ranges, means : ndarray, (n,)
        The cycles, the largest first.
    random : numpy.random.Generator
        Which cycles come on the rise and which on the fall.
    """
    low, high = means - 0.5 * ranges, means + 0.5 * ranges
    rising = random.uniform(size=len(ranges)) < 0.5
    starts = asked.end > asked.begin
    if starts:  # what closes neither before the end nor after the beginning is on the rise
        rising |= (low < asked.end) & (low > asked.begin)
    else:
        rising &= (high > asked.begin) | (low <= asked.end)
    falling = ~rising
    rising[0] = falling[0] = False
    rise = sorted(zip(high[rising], low[rising], strict=True))
    fall = sorted(zip(low[falling], high[falling], strict=True), reverse=True)
    of_max = [[high[0]], [low[0]]]
    if starts:
        first = [pair for pair in fall if pair[0] <= asked.begin]
        last = [pair for pair in fall if pair[0] > asked.begin]
        parts = [*first, of_max[1], *rise, of_max[0], *last]
    else:
        first = [pair for pair in rise if pair[0] > asked.begin]
        last = [pair for pair in rise if pair[0] <= asked.begin]
        parts = [*first, of_max[0], *fall, of_max[1], *last]
    return np.array([asked.begin, *(value for part in parts for value in part), asked.end])


def grid_loss(turbine: Turbine, torque: float, seconds: float = 20.0, rate: float = 100.0) -> Event:
    """Torque of the slow shaft after the generator has lost its own, at t = 0.

    Two masses on a shaft: it unwinds and swings about what the generator's inertia takes of the
    rotor's torque, which falls with thrust over 3 s.

    Parameters
    ----------
    turbine : Turbine
        Its inertias, shaft stiffness and damping.
    torque : float
        Before [N m].
    seconds, rate : float
        Length [s], samples per second [Hz].
    """
    twist = grid_loss_twist(turbine, torque, seconds, rate)
    spun = turbine.shaft_stiffness * twist.angle + turbine.shaft_damping * twist.speed
    return Event("grid loss", twist.time, spun, twist.thrust)


class Twist(NamedTuple):
    """Motion of a rotor against its generator, each (n,).

    Attributes
    ----------
    time : ndarray
        Even steps [s].
    thrust : ndarray
        Over that of operation, as is the rotor's torque.
    angle, speed : ndarray
        Twist of the shaft [rad] and its rate [rad/s].
    """

    time: Floats
    thrust: Floats
    angle: Floats
    speed: Floats


def grid_loss_twist(
    turbine: Turbine, torque: float, seconds: float = 20.0, rate: float = 100.0
) -> Twist:
    """Twist of the shaft in `grid_loss`, exact for a torque that is straight between samples.

    Parameters
    ----------
    turbine, torque : Turbine, float
        As there.
    seconds, rate : float
        As there.
    """
    from scipy.signal import StateSpace, lsim

    time = np.arange(round(seconds * rate)) / rate
    thrust = 0.5 + 0.5 * np.cos(np.pi * np.clip(time / 3.0, 0.0, 1.0))
    stiffness, damping = turbine.shaft_stiffness, turbine.shaft_damping
    inverse = 1.0 / turbine.rotor_inertia + 1.0 / turbine.generator_inertia
    motion = StateSpace(
        [[0.0, 1.0], [-stiffness * inverse, -damping * inverse]],
        [[0.0], [1.0 / turbine.rotor_inertia]],
        np.eye(2),
        np.zeros((2, 1)),
    )
    _, found, _ = lsim(motion, torque * thrust, time, [torque / stiffness, 0.0])
    return Twist(time, thrust, *np.asarray(found, dtype=np.float64).T)
