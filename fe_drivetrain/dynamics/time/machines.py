"""Generators as laws of a row: torque on a line of slip, constant power, a spring to the grid."""

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.dynamics.bodies.equations import Loads, SpringLaws, spring_laws, steady, varying


def slip_line(
    row: ArrayLike, torque: float, speed: float, slope: float
) -> tuple[SpringLaws, Loads]:
    """A machine whose torque against the motion is ``torque + slope (w - speed)``.

    Parameters
    ----------
    row : array_like
        Row (n,) from the velocities to the speed w.
    torque, speed : float
        A point of the line [N m, rad/s].
    slope : float
        Torque for the speed [N m s/rad]: rated torque over rated slip of an induction machine.

    Returns
    -------
    law : SpringLaws
        A damper.
    load : Loads
        Load of the machine at speed 0.
    """
    h = np.asarray(row, dtype=np.float64)
    return spring_laws(h[None], 0.0, slope), steady((slope * speed - torque) * h)


def constant_power(row: ArrayLike, power: float, speed: float = 0.0) -> SpringLaws:
    """A machine that draws a power [W] whatever its speed ``speed + row . q'`` [rad/s]."""
    return spring_laws(np.asarray(row, dtype=np.float64)[None], 0.0).with_power(power, speed)


def grid_spring(
    row: ArrayLike, stiffness: float, speed: float, duration: float
) -> tuple[SpringLaws, Loads]:
    """A synchronous machine on a stiff grid: a spring to a field that turns at a steady speed.

    Parameters
    ----------
    row : array_like
        Row (n,) from the displacements to its angle.
    stiffness : float
        Stiffness between armature and field [N m/rad].
    speed, duration : float
        Speed of the field [rad/s], and the time for which it turns, from 0 [s].

    Returns
    -------
    law : SpringLaws
        Spring to the ground.
    load : Loads
        The field's part of its torque.
    """
    h = np.asarray(row, dtype=np.float64)
    field = varying(h, [0.0, duration], [0.0, stiffness * speed * duration])
    return spring_laws(h[None], stiffness), field
