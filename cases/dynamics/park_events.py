"""Events that Park et al. 2021 have or name: operation, a torque step, a start, a stop."""

from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases.dynamics.park_models import SPEED, torque
from fe_drivetrain.cases.references import park_2021 as park
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics import System, equations_of, free_motions

HARMONICS = 8
"""Harmonics of the stiffness, as printed with Eq 10."""
BRAKE = 0.5
"""Torque of the stop's brake over the torque of operation: the source names stops alone."""
UNBOUND = 50.0
"""Mesh force over the static one past which vibration has no bound: the load is some 3 times it."""
TIME, ANGLE, DRIFT = "K(t)", "K(theta)", "K(theta) without its force on the angle"


class Event(NamedTuple):
    """A load from t = 0, and the state before it.

    Attributes
    ----------
    load : Floats
        Load that acts [N, N m].
    wound : bool
        Whether the shafts are wound up by the balanced torque already.
    turning : bool
        Whether all turns with the printed speed already.
    duration : float
        Time looked at [s].
    """

    load: Floats
    wound: bool
    turning: bool
    duration: float


def events(system: System) -> dict[str, Event]:
    """Operation, a torque step, the beginning of a start from rest, and that of a stop."""
    balanced = torque(system, 1.0 / park.ratio())
    ahead = torque(system, 0.0)
    return {
        "steady operation": Event(balanced, True, True, 1.0),
        "torque step": Event(balanced, False, True, 1.5),
        "start": Event(ahead, False, False, 1.5),
        "stop": braked(system, BRAKE),
    }


def braked(system: System, brake: float) -> Event:
    """The beginning of a stop by a brake, whose torque is over that of operation."""
    return Event(torque(system, (1.0 + brake) / park.ratio()), True, True, 1.5)


def speeds(system: System) -> Floats:
    """(n,) velocities of steady turning at the printed speed [m/s, rad/s]."""
    rigid = free_motions(equations_of(system))[:, 0]
    rotor = system.load_on("rotor", np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0]))
    return np.asarray(SPEED * rigid / float(rotor @ rigid))
