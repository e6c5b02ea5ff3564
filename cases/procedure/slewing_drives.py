"""Assumed pitch and yaw drives of a machine of 2 MW, and an emergency stop that they make."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.procedure import (
    SlewingDrive,
    drive_torque,
    friction_torque,
    gyroscopic_torque,
    printed_drive_torque,
)

PITCH = SlewingDrive(part=12e3, drive=0.02, ratio=1500.0)
YAW = SlewingDrive(part=2.0e6, drive=0.08, ratio=1200.0)
DIAMETER, TEETH = 2.0, 130
STEP = 0.01  # s
MOMENT, AXIAL, RADIAL = 3000e3, 200e3, 100e3  # N m, N
STOP_SPEED, STOP_RAMP = np.radians(7.0), 0.3  # rad/s, s
DURATION, TURNED = 12.0, np.radians(5.0)  # s, rad, of a motion of the yaw drives
#: Distance of two bending bridges of a tower, and what its shear by them lacks of the measured.
BRIDGES, DEFICIT = 35.576, -0.09  # m, share


def stop_motion() -> tuple[Floats, Floats, Floats, Floats]:
    """Time, angle, speed, acceleration of pitching by 70 degrees, ramps without corners."""
    time = np.arange(0.0, 13.0, STEP)
    hold = np.radians(70.0) / STOP_SPEED - STOP_RAMP
    start = 1.0
    end = start + STOP_RAMP + hold

    def ramp(at: float) -> tuple[Floats, Floats]:
        x = np.clip((time - at) / STOP_RAMP, 0.0, 1.0)
        speed = 0.5 * (1.0 - np.cos(np.pi * x))
        return speed, 0.5 * np.pi / STOP_RAMP * np.sin(np.pi * x) * ((x > 0) & (x < 1))

    up, down = ramp(start), ramp(end)
    speed, acceleration = (STOP_SPEED * (a - b) for a, b in zip(up, down, strict=True))
    speed = np.where(time > end + STOP_RAMP, 0.0, speed)
    return time, np.cumsum(speed) * STEP, speed, acceleration


@dataclass(frozen=True)
class Stop:
    """Motion of a pitch drive in a shutdown, and torques of load, friction and motor [N m]."""

    time: Floats
    speed: Floats
    load: Floats
    friction: Floats
    right: Floats
    printed: Floats


def stopped() -> Stop:
    """A shutdown, with the printed signs of Eq 5.1 and with the right ones."""
    time, angle, speed, acceleration = stop_motion()
    left = np.cos(angle)
    load = 8e3 + 3e3 * np.sin(1.8 * time)
    friction = friction_torque(MOMENT * (0.25 + 0.75 * left), AXIAL, RADIAL, DIAMETER)
    right = drive_torque(PITCH, load, friction, speed, acceleration)
    printed = printed_drive_torque(PITCH, load, friction, speed, acceleration)
    return Stop(time, speed, load, friction, right, printed)


def rotor_in_yaw() -> Floats:
    """Gyroscopic torque of a tilted rotor of 4e6 kg m^2 at 2 rad/s while the nacelle yaws [N m]."""
    spin = 2.0 * np.array([np.cos(0.09), 0.0, np.sin(0.09)])
    return gyroscopic_torque(4e6, spin, np.array([0.0, 0.0, TURNED / DURATION]))
