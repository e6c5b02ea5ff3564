"""Planets that travel round the sun in time: rows and superelements that turn with their carriers.

Displacements are those in space, from places that turn steadily with each carrier. A row of a
planet is then h(psi), with psi = omega t of its carrier, and since its geometry turns as a whole it
is a trigonometric polynomial in psi: of degree 1, of an elastic ring by its harmonics n of degree
n + 1, and a stiffness that turns of twice that. Its coefficients follow exactly from as many
azimuths as they are. Masses stand still in space, so that what Coriolis and centripetal terms of a
turning frame stand for is here in the rows alone. The equations

    M q'' + (C + W G) q' + sum_i F_i h_i(psi) + E(psi) q = f(t),    F of delta = h(psi) q

are those of a system that depends on time: what turning the rows against the forces of the springs
takes, F omega h' q, is on the account of the clock, as a drive that holds the speed would have it.
The steady centrifugal forces of the planets, which are in balance, are left out.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi

import numpy as np

from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.dynamics.bodies.roller_seats import (
    Seat,
    planet_seats,
    rollers_of,
    without_bearings,
)
from fe_drivetrain.dynamics.bodies.system import System

EXACT = 1e-9
"""Allowed error of the coefficients at another azimuth, over the maximum entry of the system."""


@dataclass(frozen=True)
class Turning:
    """Terms that turn with one carrier, as cosines and sines of its azimuth from degree 1 on.

    Attributes
    ----------
    carrier : int
        Number of the carrier.
    ratio : float
        Speed of the carrier over that of reference.
    rows : Floats
        Change (2 d, m, n) of the springs' rows: cosine and sine of degree 1, of degree 2, ...
    extra : Floats
        Change (2 d', n, n) of the stiffness of superelements.
    bearings : Floats
        Change (2 d, b, 5, n) of the rows of rolling bearings.
    """

    carrier: int
    ratio: float
    rows: Floats
    extra: Floats
    bearings: Floats


@dataclass(frozen=True)
class Travelling:
    """A system whose carriers travel.

    Attributes
    ----------
    system : System
        System with all carriers at azimuth 0.
    turning : tuple[Turning, ...]
        One for each carrier.
    rows, extra, bearings : Floats
        Means (m, n), (n, n), (b, 5, n) over the azimuths.
    seats : tuple[Seat, ...]
        Rolling bearings, at azimuth 0; their springs are taken out of the system.
    """

    system: System
    turning: tuple[Turning, ...]
    rows: Floats
    extra: Floats
    bearings: Floats
    seats: tuple[Seat, ...] = ()

    def at(self, angle: float) -> tuple[Floats, Floats, Floats]:
        """Rows (m, n), superelements (n, n), rows of bearings (b, 5, n) at an angle of reference.

        Parameters
        ----------
        angle : float
            Angle that the ratios refer to [rad].
        """
        parts = [self.rows, self.extra, self.bearings]
        for one in self.turning:
            for k, change in enumerate((one.rows, one.extra, one.bearings)):
                parts[k] = parts[k] + np.tensordot(_waves(one.ratio * angle, change), change, 1)
        return parts[0], parts[1], parts[2]

    def slopes(self, angle: float) -> tuple[Floats, Floats, Floats]:
        """Derivatives of the same by the angle."""
        parts = [np.zeros_like(one) for one in (self.rows, self.extra, self.bearings)]
        for one in self.turning:
            for k, change in enumerate((one.rows, one.extra, one.bearings)):
                by = one.ratio * _slopes(one.ratio * angle, change)
                parts[k] = parts[k] + np.tensordot(by, change, 1)
        return parts[0], parts[1], parts[2]


def _waves(angle: float, change: Floats) -> Floats:
    degrees = np.arange(1, len(change) // 2 + 1)
    both = np.stack([np.cos(degrees * angle), np.sin(degrees * angle)], axis=1)
    return np.asarray(both.ravel(), dtype=np.float64)


def _slopes(angle: float, change: Floats) -> Floats:
    n = np.arange(1, len(change) // 2 + 1)
    both = np.stack([-n * np.sin(n * angle), n * np.cos(n * angle)], axis=1)
    return np.asarray(both.ravel(), dtype=np.float64)


Placed = tuple[System, Sequence[Seat]]
"""A system at an azimuth, and its rolling bearings."""


def travelling_of(
    at: Callable[[Mapping[int, float]], Placed], ratios: Mapping[int, float], degree: int = 1
) -> Travelling:
    """A system whose carriers travel, from what it is at single azimuths.

    Parameters
    ----------
    at : callable
        Function from azimuths of carriers by number [rad], 0 of those that are left out, to the
        system in the frame that stands still, and its rolling bearings.
    ratios : mapping of int to float
        Speed of each carrier over that of reference.
    degree : int
        Degree of the rows in the azimuth: 1, and n + 1 of a ring with harmonics up to n.

    Returns
    -------
    found : Travelling

    Raises
    ------
    InputError
        Masses change with an azimuth, or rows are not of that degree.
    """
    system, seats = at({})
    rows, extra, bearings = _parts(system, seats)
    means, turning = [rows, extra, bearings], []
    degrees = (degree, 2 * degree, degree)
    for number, ratio in ratios.items():
        count = 4 * degree + 1
        angles = 2 * pi * np.arange(count) / count
        found = [at({number: float(angle)}) for angle in angles]
        if any(
            np.abs(one.mass - system.mass).max() > EXACT * system.mass.max() for one, _ in found
        ):
            raise InputError(
                f"masses of the system change with the azimuth of carrier {number}, which is not "
                "possible: let its planets move by themselves"
            )
        samples = [np.array(part) for part in zip(*(_parts(*one) for one in found), strict=True)]
        waves = []
        for k, (sample, most) in enumerate(zip(samples, degrees, strict=True)):
            means[k] = means[k] + sample.mean(axis=0) - sample[0]
            n = np.arange(1, most + 1)[:, None] * angles
            by = np.stack([np.cos(n), np.sin(n)], axis=1).reshape(2 * most, count) * 2.0 / count
            waves.append(np.tensordot(by, sample, 1))
        turning.append(Turning(number, ratio, waves[0], waves[1], waves[2]))
    rows, extra, bearings = means
    carriers = Travelling(system, tuple(turning), rows, extra, bearings, tuple(seats))
    for number in ratios:
        _check(carriers, at, number)
    return carriers


def _parts(system: System, seats: Sequence[Seat]) -> tuple[Floats, Floats, Floats]:
    return system.rows, system.extra, rollers_of(system, seats).rows


def _check(carriers: Travelling, at: Callable[[Mapping[int, float]], Placed], number: int) -> None:
    """Refuse coefficients that miss the system where none were taken."""
    only = tuple(replace(one, ratio=float(one.carrier == number)) for one in carriers.turning)
    angle = 0.7
    found, exact = replace(carriers, turning=only).at(angle), _parts(*at({number: angle}))
    for one, other in zip(found, exact, strict=True):
        missed = float(np.abs(one - other).max(initial=0.0))
        if missed > EXACT * float(np.abs(other).max(initial=0.0)):
            raise InputError(
                f"rows of carrier {number} are not of the degree that is given in its azimuth: "
                "give n + 1 for a ring with harmonics up to n"
            )


def travelling(
    machine: Machine,
    level: Level = Level.RIGID,
    elements: int = 6,
    held_generator: bool = False,
    flexible: Flexible | None = None,
    rollers: Mapping[int, Bearing] | None = None,
) -> Travelling:
    """A machine whose planets travel with their carriers, over the rotor's speed.

    Parameters
    ----------
    machine : Machine
        Table of the machine.
    level, elements, held_generator, flexible : Level, int, bool, Flexible
        Level and its options, see `machine_system`.
    rollers : mapping of int to Bearing, optional
        Rolling bearings of the planets by the number of their stage, in place of their springs.

    Returns
    -------
    found : Travelling
    """
    kinds = rollers or {}

    def at(angles: Mapping[int, float]) -> Placed:
        system = machine_system(machine, level, angles, elements, held_generator, flexible)
        seats = [
            one
            for number, bearing in kinds.items()
            for one in planet_seats(
                machine,
                number,
                bearing,
                angles.get(number, 0.0) / machine.speeds[number - 1],
                flexible,
            )
        ]
        return without_bearings(system, seats), seats

    ratios = {
        number: machine.speeds[number - 1]
        for number, stage in enumerate(machine.stages, start=1)
        if isinstance(stage, PlanetaryData)
    }
    rims = flexible.rims.values() if flexible is not None else ()
    return travelling_of(at, ratios, 1 + max((n for _, found in rims for n in found), default=0))


@dataclass(frozen=True)
class TravellingCarriers:
    """Carriers that travel in time, at steady speeds.

    Attributes
    ----------
    carriers : Travelling
        System whose carriers travel, from `travelling`, with its rolling bearings.
    speed : float
        Reference speed [rad/s]; the angle is 0 at t = 0.
    damping : float
        Damping of its rolling bearings, see `rolling_bearings` [s].
    """

    __repr__ = short_repr

    carriers: Travelling
    speed: float
    damping: float = 0.0
