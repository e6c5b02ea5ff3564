"""Classes of a torque spectrum that is stated: torque, hours and speed, checked once."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import NamedTuple

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.components import LARGEST_LOAD
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.studies.rotor_speeds import FASTEST, check_speed

Rows = Sequence[Sequence[float]]
"""Torque [N m], hours and, where it differs, speed [rad/s] of each class of a spectrum."""

_FIX = "correct it; a torque against the driving sense has a negative torque, not a negative speed"


class TorqueClass(NamedTuple):
    """A class of a torque spectrum.

    Attributes
    ----------
    torque : float
        Torque of the rotor [N m]; negative ones load the other flanks.
    hours : float
        Time [h].
    speed : float
        Speed of the rotor [rad/s].
    """

    torque: float
    hours: float
    speed: float


def torque_classes(rows: Rows, rated_speed: float | None) -> list[TorqueClass]:
    """Classes of a spectrum, checked.

    Parameters
    ----------
    rows : sequence of sequence of float
        Torque [N m] and hours of each class, and its speed [rad/s] where there is a third number.
    rated_speed : float or None
        Rated speed of the rotor [rad/s]: of classes without one, and what bounds those of others.

    Raises
    ------
    InputError
        There is no class, a row is none, no speed is known, or one is out of range.
    """
    if not len(rows):
        raise InputError("the torque spectrum has no class: give torque in N m and hours of one")
    found = []
    for number, row in enumerate(rows, start=1):
        name = f"class {number} of the torque spectrum"
        if len(row) not in (2, 3) or not all(map(isfinite, row)) or not row[1] >= 0.0:
            raise InputError(
                f"{name} is {list(row)}: give its torque in N m, its hours, at least 0, and its "
                "speed in rad/s where that is another one"
            )
        torque, hours = float(row[0]), float(row[1])
        if not abs(torque) < LARGEST_LOAD:
            raise InputError(
                f"{name} has a torque of {torque:g} N m but must be below {LARGEST_LOAD:g} N m: "
                "correct it"
            )
        speed = float(row[2]) if len(row) == 3 else rated_speed
        if speed is None:
            raise InputError(
                "no speed of the rotor is known, by which a torque spectrum counts turns: give "
                f"operation.rotor_speed, {argument('rotor_speed_rpm')}, or a speed of each class"
            )
        check_speed(name, speed, rated_speed, FASTEST, _FIX)
        found.append(TorqueClass(torque, hours, speed))
    return found
