"""Speeds of a rotor that are asked for: which of them a machine may have."""

from __future__ import annotations

from math import inf

from fe_drivetrain.common.components import RPM
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain

FASTEST = 2.0
"""Most that a rotor turns, over its rated speed: machines are stopped at 1.1 to 1.5 of it."""

FARTHEST = 10.0
"""Most over its rated speed at which modes and whirl are asked for: criticals are looked for beyond
operation, and gears and bearings of a machine bear no more."""

_LARGEST = 100.0
"""Speed of a rotor whose rated one is not stated [rad/s]: a file may state as much."""


def rated_speed(drivetrain: Drivetrain) -> float | None:
    """Rated speed of the rotor [rad/s], where the file states it."""
    operation = drivetrain.operation
    if operation is None or operation.rotor_speed is None:
        return None
    return operation.rotor_speed[1]


def check_speed(name: str, speed: float, rated: float | None, times: float, fix: str) -> None:
    """Refuse a speed that is negative, or that no rotor of this rated speed reaches.

    Parameters
    ----------
    name : str
        What has the speed.
    speed : float
        Speed that is checked [rad/s].
    rated : float or None
        Its rated speed [rad/s].
    times : float
        Most over that.
    fix : str
        What to do.

    Raises
    ------
    InputError
        See above.
    """
    most = _LARGEST if rated is None else times * rated
    if 0.0 <= speed <= most and speed < inf:
        return
    of = f", {times:g} times the rated speed" if rated is not None else ""
    raise InputError(
        f"{name} has a speed of {speed * RPM:.4g} 1/min but must have one from 0 to "
        f"{most * RPM:.4g} 1/min{of}: {fix}"
    )
