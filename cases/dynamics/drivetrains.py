"""The four drivetrains of the thesis with rated power and speed, for the cases in time."""

from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.dynamics.torsion import GearTable

#: Damping ratios of shafts and of meshes (Al-Hamadani 2018, section 4.1).
RATIOS = (0.006, 0.1)


class Rated(NamedTuple):
    """A drivetrain, its rated power [W] and its rotor's rated speed [1/min].

    ``table`` is of `published_drivetrains`, ``ratios`` are damping ratios where its table has no
    dampers, ``peak`` is the printed peak of the torque's spectrum in a shutdown [Hz], ``held`` what
    two masses swing at with the generator's shaft held [Hz].
    """

    letter: str
    table: GearTable
    power: float
    per_minute: float
    ratios: tuple[float, float] | None
    peak: float
    held: float
    tripped: float

    @property
    def speed(self) -> float:
        """Speed of the rotor [rad/s]."""
        return self.per_minute * np.pi / 30.0

    @property
    def torque(self) -> float:
        """Torque of the rotor [N m]."""
        return self.power / self.speed


def drivetrains() -> list[Rated]:
    """A, B, C and D; `tripped` is T (J2 - J1) / (J1 + J2) over T of two masses."""
    return [
        Rated("A", published.table("drivetrain_a"), 3e6, 14.8, RATIOS, 9.1, 4.74, -0.514),
        Rated("B", published.table("drivetrain_b"), 3e6, 16.1, RATIOS, 4.664, 4.41, 0.546),
        Rated("C", published.table("drivetrain_c"), 2e6, 18.1, RATIOS, 2.503, 0.814, -0.795),
        Rated("D", published.table("nrel_750kw"), 750e3, 22.1, None, 2.61, 0.945, -0.720),
    ]
