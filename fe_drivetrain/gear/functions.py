"""The involute function, its inverse, and where tips of internal gears get in each other's way."""

from __future__ import annotations

from math import acos, atan, isfinite, pi, tan

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError


def involute_of(angle: float | Floats) -> Floats:
    """Involute function, tan(angle) - angle.

    Parameters
    ----------
    angle : float or (n,) array
        Profile angles [rad].

    Returns
    -------
    array
        Polar angles of the involute's points from its start on the base circle [rad].
    """
    return np.asarray(np.tan(angle) - angle, dtype=np.float64)


def inverse_involute(value: float) -> float:
    """Profile angle at which the involute function has a value.

    Parameters
    ----------
    value : float
        Value of the involute function [rad], zero or positive.

    Returns
    -------
    float
        Profile angle [rad], below pi/2.

    Raises
    ------
    InputError
        If the value is negative: no profile has it.
    """
    from scipy.optimize import brentq

    if not (isfinite(value) and value >= 0.0):
        raise InputError(
            f"an involute function of {value:g}: it is zero or positive; give less negative "
            "profile shifts"
        )
    if value == 0.0:
        return 0.0
    # the tangent of the angle lies between these; tan(x) - x < value below, > value above
    low, high = atan(value), atan(value + pi / 2.0)
    return float(brentq(lambda x: tan(x) - x - value, low, high, xtol=1e-15, rtol=1e-14))


def spare_angle_of_tips(
    teeth: tuple[int, int], bases: tuple[float, float], tips: tuple[float, float], centres: float
) -> float:
    """Spare angle of a pinion's tip corners as they leave the spaces of an internal gear.

    Where both tip circles cross, the internal gear's corner must be ahead (Maitra 1994, Handbook
    of gear design, sec. 2.27).

    Parameters
    ----------
    teeth : tuple of two ints
        Numbers of teeth of the pinion and the internal gear, both positive.
    bases, tips : tuples of two floats
        Base and tip radii of both [m].
    centres : float
        Centre distance [m].

    Returns
    -------
    float
        Spare angle [rad]; 0 where the tip circles do not cross, negative where teeth are cut.
    """
    one, two = tips
    if two - one >= centres:
        return 0.0
    at_first = acos((two**2 - one**2 - centres**2) / (2.0 * centres * one))
    at_second = acos((two**2 - one**2 + centres**2) / (2.0 * centres * two))
    ends = [float(involute_of(acos(b / t))) for b, t in zip(bases, tips, strict=True)]
    working = float(involute_of(acos((bases[1] - bases[0]) / centres)))
    spare = teeth[0] * (ends[0] + at_first) - teeth[1] * (ends[1] + at_second)
    return (spare + (teeth[1] - teeth[0]) * working) / teeth[1]
