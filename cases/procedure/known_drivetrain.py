"""A drivetrain whose stiffness, damping and inertia are known, and its simulated twist."""

import numpy as np

from fe_drivetrain.dynamics.torsion import Inertia, chain
from fe_drivetrain.procedure import (
    Sensor,
    Twist,
    band_torque,
    element_torques,
    periodic_motions,
    reduced_torque,
)

FRONT, REAR, STIFFNESS, RATIO = 150.34, 24.0, 5296.0, 0.03  # kg m^2, N m/rad, of critical damping
GEAR, SPEED, MEAN = 81.49, 188.5, 4000.0  # -, rad/s and N m of the high-speed shaft
REDUCED = FRONT * REAR / (FRONT + REAR)
OMEGA = float(np.sqrt(STIFFNESS / REDUCED))
DAMPING = 2.0 * RATIO * REDUCED * OMEGA
TRUTH = np.array([REDUCED, DAMPING, STIFFNESS])
SYSTEM = chain(
    (Inertia("rotor", FRONT), Inertia("generator", REAR)), [("shaft", STIFFNESS, DAMPING)]
)
TURN = 2.0 * np.pi * GEAR / SPEED  # s
STEP = 0.005  # s
DRIVING, BRAKING = 100.0, 40.0  # N m, standard deviations of a broadband run
BROAD, NARROW, USED = (0.05, 20.0), (2.4, 2.7), (1.0, 5.0)  # Hz
GAUGE = Sensor(gain=0.93, offset=20.0, noise=25.0)


def simulated(
    samples: int,
    band: tuple[float, float],
    braking: float,
    braking_band: tuple[float, float] | None = None,
) -> dict[str, Twist]:
    """The twist with three torques that could be called T_rot."""
    driving = band_torque(samples, STEP, band, DRIVING, 1)
    load = band_torque(samples, STEP, braking_band or band, 1.0, 2) * braking
    motions = periodic_motions(SYSTEM, np.stack([driving, -load]), STEP)
    twist = [a[0] - a[1] for a in (motions.angle, motions.speed, motions.acceleration)]
    reduced, _ = reduced_torque(driving, load, FRONT, REAR)
    torques = {
        "shaft": element_torques(SYSTEM, motions)[0],
        "reduced": reduced,
        "aerodynamic": driving,
    }
    return {name: Twist(STEP, torque, *twist) for name, torque in torques.items()}
