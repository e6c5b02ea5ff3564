"""Rolling bearings that act in time: their forces, tangents and dampers on a system's motions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.roller_seats import Rollers, Seat, rollers_of
from fe_drivetrain.dynamics.bodies.system import System


@dataclass(frozen=True)
class RollingBearings:
    """Rolling bearings on the degrees of freedom of equations.

    Attributes
    ----------
    seats : tuple[Seat, ...]
        Seats (b,) of the bearings.
    rows : Floats
        Motion (b, 5, n) of each inner ring against the outer one.
    seconds : Floats
        Damping (b,) of each: this time [s] times its tangent stiffness at the beginning of a step.
    """

    __repr__ = short_repr

    seats: tuple[Seat, ...]
    rows: Floats
    seconds: Floats

    @property
    def rollers(self) -> Rollers:
        """The bearings, to be evaluated together."""
        return Rollers(tuple(one.bearing for one in self.seats), self.rows)

    def loads(self, u: Floats, rate: Floats) -> Floats:
        """Loads (b, 5) at motions (b, 5) and their rates, with the dampers there."""
        F, K = self.rollers.carried(u)
        return np.asarray(F + np.einsum("b,bij,bj->bi", self.seconds, K, rate))


def rolling_bearings(
    system: System, seats: Sequence[Seat], damping: ArrayLike = 0.0
) -> RollingBearings:
    """Rolling bearings that act on a system in time.

    Parameters
    ----------
    system : System
        System without the springs of these bearings: `without_bearings`.
    seats : sequence of Seat
        Rolling bearings.
    damping : array_like
        Damping of all bearings, or of each (b,): this time [s] times its tangent stiffness at the
        beginning of a step.

    Raises
    ------
    InputError
        A damping is negative.
    """
    return bearings_on(seats, rollers_of(system, seats).rows, damping)


def bearings_on(seats: Sequence[Seat], rows: Floats, damping: ArrayLike) -> RollingBearings:
    """The same where rows (b, 5, n) are known."""
    seconds = np.array(np.broadcast_to(np.asarray(damping, dtype=np.float64), len(seats)))
    bad = np.flatnonzero(~(seconds >= 0.0))
    if len(bad):
        raise InputError(
            f"damping of bearings is {seconds[bad[0]]:g} s but must be at least 0 s: raise it"
        )
    return RollingBearings(tuple(seats), rows, seconds)
