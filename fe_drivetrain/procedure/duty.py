"""Duty of pitch and yaw drives: starts, pauses, peaks, teeth in mesh, heat, transients."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.turbine_loads.histories.levels import Levels

THERMAL = 600.0
"""Averaging time of a motor's heat [s] (PROTEST 2010, sections 7.1.2.3 and 7.2.2.3)."""


@dataclass(frozen=True, eq=False)
class Moves:
    """Motions of a drive, one after another; what began before the history or ends after it, too.

    Attributes
    ----------
    first, last : ndarray, (m,)
        First sample of each motion, and the first one of the pause after it.
    angle : ndarray, (m,)
        Turned by, in the direction of the net motion [rad].
    step : float
        Between two samples [s].
    samples : int
        Number of samples of the whole history.
    """

    first: Ints
    last: Ints
    angle: Floats
    step: float
    samples: int

    __repr__ = short_repr

    @property
    def durations(self) -> Floats:
        """(m,) of the motions [s]."""
        return np.asarray((self.last - self.first) * self.step)

    @property
    def pauses(self) -> Floats:
        """(m - 1,) from each stop to the next start [s]."""
        return np.asarray((self.first[1:] - self.last[:-1]) * self.step)

    @property
    def duty(self) -> float:
        """Share of the time in motion."""
        return float((self.last - self.first).sum()) / self.samples

    @property
    def starts(self) -> int:
        """How many began within the history."""
        return int((self.first > 0).sum())


def moves(speed: Floats, step: float, threshold: float) -> Moves:
    """Where a drive moves.

    Parameters
    ----------
    speed : ndarray, (n,)
        Speed of the part or the motor [rad/s].
    step : float
        Between two samples [s].
    threshold : float
        At or below which it stands [rad/s].
    """
    values = np.asarray(speed, dtype=np.float64)
    moving: Bools = np.abs(values) > threshold
    change = np.diff(np.concatenate([[0], moving.astype(int), [0]]))
    first, last = np.flatnonzero(change == 1), np.flatnonzero(change == -1)
    turned = np.concatenate([[0.0], np.cumsum(values) * step])
    return Moves(first, last, np.abs(turned[last] - turned[first]), step, len(values))


def peak_times(torque: Floats, found: Moves) -> Floats:
    """When each motion has its largest torque, from its start over its duration: (m,), 0 to 1.

    Parameters
    ----------
    torque : ndarray, (n,)
        Torque of the motor.
    found : Moves
        Moves of the same history.
    """
    size = np.abs(np.asarray(torque))
    ends = zip(found.first, found.last, strict=True)
    return np.array([float(size[a:b].argmax()) / max(b - a - 1, 1) for a, b in ends])


def thermal_torque(torque: Floats, step: float, seconds: float = THERMAL) -> float:
    """Largest root mean square in any window of a time, of the whole history if it is shorter.

    Parameters
    ----------
    torque : ndarray, (n,)
        Torque of the motor [N m].
    step : float
        Between two samples [s].
    seconds : float
        Length of a window [s].

    Returns
    -------
    float
        [N m].

    Raises
    ------
    InputError
        The time is shorter than a sample.
    """
    values = np.asarray(torque, dtype=np.float64)
    length = min(round(seconds / step), len(values))
    if length < 1:
        raise InputError(f"a window of {seconds:g} s with samples of {step:g} s: give a longer one")
    sums = np.concatenate([[0.0], np.cumsum(values**2)])
    return float(np.sqrt((sums[length:] - sums[:-length]).max() / length))


def tooth_counts(angle: Floats, teeth: int, weights: Floats | None = None) -> Floats:
    """How often each tooth of a ring is in mesh with one pinion.

    A way of one pitch is one mesh, parts of it are parts, so that their sum is the travel over the
    pitch. Tooth 0 is the one from angle 0 to one pitch.

    Parameters
    ----------
    angle : ndarray, (n,)
        Angle of the ring [rad]; it goes straight from sample to sample.
    teeth : int
        Number of teeth of the whole ring.
    weights : ndarray, (n - 1,), optional
        Factor of what each sample's way counts, as a torque to the power of a gear's exponent.

    Returns
    -------
    ndarray, (teeth,)
        Meshes of each tooth.

    Raises
    ------
    InputError
        The ring has no teeth.
    """
    if teeth < 1:
        raise InputError(f"a ring of {teeth} teeth: give a number from 1")
    place = np.asarray(angle, dtype=np.float64) * teeth / (2.0 * np.pi)
    low, high = np.minimum(place[:-1], place[1:]), np.maximum(place[:-1], place[1:])
    factor = np.ones(len(low)) if weights is None else np.asarray(weights, dtype=np.float64)
    counts = np.zeros(teeth)
    for tooth in range(int(np.floor(low.min())), int(np.ceil(high.max()))):
        within = np.minimum(high, tooth + 1.0) - np.maximum(low, float(tooth))
        counts[tooth % teeth] += factor @ np.maximum(within, 0.0)
    return counts


def with_transients(levels: Levels, torque: float, starts: int, seconds: float = 0.03) -> Levels:
    """A load duration distribution with a transient torque at each start.

    Motors that are switched directly have about three times their mean torque for 30 ms (PROTEST
    2010, section 7.2.2.1).

    Parameters
    ----------
    levels : Levels
        Without transients [s].
    torque : float
        Torque of the transient, in the unit of the levels.
    starts : int
        How many.
    seconds : float
        Duration of each [s].

    Raises
    ------
    InputError
        The torque is at no level.
    """
    edges = levels.edges
    if not edges[0] <= torque <= edges[-1]:
        raise InputError(
            f"a transient of {torque:g} is outside of the levels from {edges[0]:g} to "
            f"{edges[-1]:g}: let them hold it"
        )
    added, _ = np.histogram([torque], edges, weights=[starts * seconds])
    return Levels(edges, levels.amount + added)


@dataclass(frozen=True)
class Governing:
    """The largest torque that a gearbox of a pitch or yaw drive must carry.

    Attributes
    ----------
    by : str
        What gives it.
    torque : float
        [N m].
    brake_covers : bool
        Whether the motor's brake gives it, as in common designs.
    """

    by: str
    torque: float
    brake_covers: bool


def governing_torque(
    brake: float, motor: float, aerodynamic: float, transient: float = 0.0
) -> Governing:
    """Torque of the static strength of gear and gearbox (PROTEST 2010, 7.1.2.2 and 7.2.2.2).

    It is that at which the motor's brake slides, unless the motor, the air, or of a yaw system a
    transient of switching has more.

    Parameters
    ----------
    brake : float
        Dynamic sliding torque of the brakes of pitch motors, largest torque of those of yaw motors,
        at the motor [N m].
    motor, aerodynamic, transient : float
        Largest of the motor, of the part at the motor (over the ratio), of switching [N m].

    Raises
    ------
    InputError
        One of them is below zero.
    """
    torques = {
        "motor brake": brake,
        "motor": motor,
        "aerodynamic forces": aerodynamic,
        "transient": transient,
    }
    for name, torque in torques.items():
        if not torque >= 0.0:
            raise InputError(f"largest torque of the {name} is {torque:g} N m: give its size")
    by = max(torques, key=lambda name: torques[name])
    return Governing(by, torques[by], by == "motor brake")
