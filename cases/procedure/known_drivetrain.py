"""A drivetrain whose stiffness, damping and inertia are known, and its simulated twist."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics import gear_table
from fe_drivetrain.dynamics.torsion import (
    Inertia,
    Torsional,
    chain,
    damped_modes,
    two_masses,
)
from fe_drivetrain.procedure import (
    Sensor,
    Twist,
    band_torque,
    element_torques,
    periodic_motions,
    reduced_torque,
)
from fe_drivetrain.report.suite import ChosenDrivetrain, Page

DRIVING, BRAKING = 100.0, 40.0  # N m, standard deviations of a broadband run
BROAD, NARROW, USED = (0.05, 20.0), (2.4, 2.7), (1.0, 5.0)  # Hz


@dataclass(frozen=True)
class Known:
    """A drivetrain as two inertias on a damped shaft, all on the high-speed side.

    ``front`` and ``rear`` are inertias [kg m^2], ``stiffness`` is between them [N m/rad], ``ratio``
    that of damping over critical, ``gear`` the speed of the high-speed side over the rotor's,
    ``speed`` [rad/s] and ``torque`` [N m] the rated ones.
    """

    front: float
    rear: float
    stiffness: float
    ratio: float
    gear: float
    speed: float
    torque: float

    @property
    def reduced(self) -> float:
        """Inertia of the one oscillator that both are [kg m^2]."""
        return self.front * self.rear / (self.front + self.rear)

    @property
    def omega(self) -> float:
        """Natural frequency without damping [rad/s]."""
        return float(np.sqrt(self.stiffness / self.reduced))

    @property
    def damping(self) -> float:
        """Damper of the shaft [N m s/rad]."""
        return 2.0 * self.ratio * self.reduced * self.omega

    @property
    def truth(self) -> Floats:
        """(3,) inertia, damping and stiffness."""
        return np.array([self.reduced, self.damping, self.stiffness])

    @property
    def system(self) -> Torsional:
        """Both inertias and the shaft."""
        return chain(
            (Inertia("rotor", self.front), Inertia("generator", self.rear)),
            [("shaft", self.stiffness, self.damping)],
        )

    @property
    def turn(self) -> float:
        """Time of a turn of the rotor [s]."""
        return 2.0 * np.pi * self.gear / self.speed

    @property
    def slower(self) -> float:
        """Its period over that of `KNOWN`, in whose measure runs and steps are long."""
        return KNOWN.omega / self.omega

    @property
    def stronger(self) -> float:
        """Its rated torque over that of `KNOWN`, in whose measure torques and noise are large."""
        return self.torque / KNOWN.torque

    @property
    def gauge(self) -> Sensor:
        """A strain gauge with a wrong gain, an offset and noise."""
        own = 20.0 * self.stronger, 25.0 * self.stronger
        return Sensor(gain=0.93, offset=own[0], noise=own[1])


KNOWN = Known(150.34, 24.0, 5296.0, 0.03, 81.49, 188.5, 4000.0)
FRONT, REAR, STIFFNESS, RATIO = KNOWN.front, KNOWN.rear, KNOWN.stiffness, KNOWN.ratio
GEAR, SPEED, MEAN = KNOWN.gear, KNOWN.speed, KNOWN.torque
REDUCED, OMEGA, DAMPING, TRUTH = KNOWN.reduced, KNOWN.omega, KNOWN.damping, KNOWN.truth
SYSTEM, TURN, GAUGE = KNOWN.system, KNOWN.turn, KNOWN.gauge
STEP = 0.005  # s


def known_of(page: Page, chosen: ChosenDrivetrain) -> Known:
    """A user's drivetrain as two inertias, with the damping of its file or an assumed one.

    Raises
    ------
    InputError
        The file does not state rated power and speeds, or what all that turns needs.
    """
    table = gear_table(chosen.drivetrain)
    both, gear = two_masses(table, "free"), abs(table.speeds[-1])
    torque, speed = chosen.rated_torque() / gear, chosen.rotor_speeds()[1] * gear
    front, rear = (float(J) / gear**2 for J in both.J)
    stiffness = float(both.k[0]) / gear**2
    own = chosen.drivetrain.damping
    if both.elements[0].damping > 0.0:
        ratio = float(damped_modes(both).ratios[0])
    elif own is not None and own.shafts > 0.0:
        ratio = own.shafts
    else:
        ratio = KNOWN.ratio
        page.assume("damping ratio of the drivetrain", ratio, "", "the file states no damping")
    page.assume_all(table.assumptions())
    return Known(front, rear, stiffness, ratio, gear, speed, torque)


def simulated(
    samples: int,
    band: tuple[float, float],
    braking: float,
    braking_band: tuple[float, float] | None = None,
    known: Known = KNOWN,
) -> dict[str, Twist]:
    """The twist with three torques that could be called T_rot; arguments are those of `KNOWN`."""
    step, size = STEP * known.slower, known.stronger
    bands = [tuple(f / known.slower for f in one) for one in (band, braking_band or band)]
    driving = band_torque(samples, step, (bands[0][0], bands[0][1]), size * DRIVING, 1)
    load = band_torque(samples, step, (bands[1][0], bands[1][1]), 1.0, 2) * size * braking
    motions = periodic_motions(known.system, np.stack([driving, -load]), step)
    twist = [a[0] - a[1] for a in (motions.angle, motions.speed, motions.acceleration)]
    reduced, _ = reduced_torque(driving, load, known.front, known.rear)
    torques = {
        "shaft": element_torques(known.system, motions)[0],
        "reduced": reduced,
        "aerodynamic": driving,
    }
    return {name: Twist(step, torque, *twist) for name, torque in torques.items()}
