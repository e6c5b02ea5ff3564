"""Steady turning of a drivetrain: its ends, the torque between them, and its generator's laws."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.equations import (
    Equations,
    Loads,
    SpringLaws,
    joined_laws,
    steady,
)
from fe_drivetrain.dynamics.time.machines import slip_line


@dataclass(frozen=True)
class Turning:
    """A drivetrain that turns steadily: its ends, and what drives it.

    Attributes
    ----------
    to_rotor, to_generator : Floats
        Load (n,) of a unit torque on the rotor, and on the generator; rows to their angles.
    torque : float
        Torque on the rotor, which the generator holds [N m].
    ratio : float
        Speed of the generator over that of the rotor.
    velocity : Floats
        Velocities (n,).
    beside : Floats, optional
        Steady load (n,) beside both torques, such as weights.
    """

    __repr__ = short_repr

    to_rotor: Floats
    to_generator: Floats
    torque: float
    ratio: float
    velocity: Floats
    beside: Floats | None = None

    @property
    def generator_torque(self) -> float:
        """Torque of the generator against the motion, at rest with that of the rotor [N m]."""
        return self.torque / self.ratio

    @property
    def generator_speed(self) -> float:
        """Speed of the generator [rad/s]."""
        return float(self.to_generator @ self.velocity)

    def line(self, slip: float) -> tuple[SpringLaws, Loads]:
        """The generator on a line of slip through its torque and speed, see `slip_line`."""
        torque, speed = self.generator_torque, self.generator_speed
        return slip_line(self.to_generator, torque, speed, abs(torque / (slip * speed)))

    def off(self) -> SpringLaws:
        """The generator without torque: as many springs as `line` has."""
        return slip_line(self.to_generator, 0.0, 0.0, 0.0)[0]

    def loads(self) -> list[Loads]:
        """Steady loads beside both torques; none where there are none."""
        return [] if self.beside is None else [steady(self.beside)]


def with_laws(chain: Equations, *laws: SpringLaws) -> Equations:
    """Equations with further springs, such as a generator's."""
    return replace(chain, springs=joined_laws(chain.springs, *laws))
