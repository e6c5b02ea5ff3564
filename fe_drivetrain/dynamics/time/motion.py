"""Histories of motion: states, what was recorded, and the account of the energy.

What loads and the clock of stiffnesses that vary with time put in is what goes into motion and
strain, and what dampers take out; the rest is the error of the integration (`Motion.imbalance`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.equations import Equations
from fe_drivetrain.dynamics.bodies.roller_seats import Seat, seat_number
from fe_drivetrain.dynamics.time.energy_account import CLOCK, DISSIPATED, KINETIC, STRAIN, WORK


@dataclass(frozen=True)
class State:
    """State of a system at a time.

    Attributes
    ----------
    q, velocity, acceleration : Floats
        Displacements (n,) and their rates.
    time : float
        Time [s].
    """

    __repr__ = short_repr

    q: Floats
    velocity: Floats
    acceleration: Floats
    time: float = 0.0


@dataclass(frozen=True)
class BearingHistory:
    """What rolling bearings do in a history of motion.

    Attributes
    ----------
    seats : tuple[Seat, ...]
        Seats (b,) of the bearings.
    motions, loads : Floats
        Motion (k, b, 5) of each inner ring against the outer one [m, rad], and the load that it
        carries there, with its damper [N, N m], along and about the axes of its seat.
    """

    __repr__ = short_repr

    seats: tuple[Seat, ...]
    motions: Floats
    loads: Floats

    def of(self, name: str) -> int:
        """Number of a bearing.

        Raises
        ------
        InputError
            There is none of that name.
        """
        return seat_number(self.seats, name)

    def radial(self, name: str) -> Floats:
        """(k,) radial load of a bearing [N]."""
        y, z = self.loads[:, self.of(name), 1:3].T
        return np.asarray(np.hypot(y, z))


@dataclass(frozen=True)
class Braking:
    """What brakes do in a history of motion.

    Attributes
    ----------
    torque : Floats
        Torque (k, b) of each brake on its disc [N m].
    held : Bools
        Flags (k, b): whether the disc stands.
    events : tuple of (float, str)
        Times [s] at which a disc "stops", "sticks" and "slips".
    of : tuple[int, ...]
        Number of the brake of each event.
    """

    __repr__ = short_repr

    torque: Floats
    held: Bools
    events: tuple[tuple[float, str], ...]
    of: tuple[int, ...]


@dataclass(frozen=True)
class StepHistory:
    """Steps that were chosen by their error.

    Attributes
    ----------
    steps, errors : Floats
        Lengths (accepted,) of the steps [s], and error estimate of each over the maximum
        elongation so far.
    rejected : int
        Steps that were tried and made again shorter.
    matrices : int
        Lengths for which a matrix was inverted.
    """

    __repr__ = short_repr

    steps: Floats
    errors: Floats
    rejected: int
    matrices: int


NO_BEARINGS = BearingHistory((), np.zeros((0, 0, 5)), np.zeros((0, 0, 5)))
NO_BRAKES = Braking(np.zeros((0, 0)), np.zeros((0, 0), dtype=bool), (), ())
EQUAL_STEPS = StepHistory(np.zeros(0), np.zeros(0), 0, 0)
STANDING = np.zeros(0)
"""What a history has of what did not act."""


@dataclass(frozen=True)
class Motion:
    """A history of motion.

    Attributes
    ----------
    times : Floats
        Times (k,) [s].
    q, velocity : Floats
        Values (k, w) of the rows that were watched, and their rates: of all degrees of freedom
        where none were named.
    forces : Floats
        Forces (k, m) of all springs with their dampers: [N], or [N m].
    energies : Floats
        (k, 5): kinetic and strain energy, and since the beginning work of the loads, what dampers
        and machines took out, and what the clock of varying stiffnesses put in [J].
    iterations : int
        Newton steps, all.
    max_iterations : int
        Maximum number of Newton steps in one time step.
    not_converged : int
        Time steps in which Newton's method did not converge.
    end : State
        State at the last step.
    bearings : BearingHistory
        Motions and loads of rolling bearings; none where there are none.
    braking : Braking
        Torques and events of brakes; none where there are none.
    control : StepHistory
        Lengths of the steps where they were chosen by their error; none of equal steps.
    azimuth : Floats
        Angle (k,) that the ratios of travelling carriers refer to [rad]; (0,) where none travel.
    """

    __repr__ = short_repr

    times: Floats
    q: Floats
    velocity: Floats
    forces: Floats
    energies: Floats
    iterations: int
    max_iterations: int
    not_converged: int
    end: State
    bearings: BearingHistory = NO_BEARINGS
    braking: Braking = NO_BRAKES
    control: StepHistory = EQUAL_STEPS
    azimuth: Floats = field(default_factory=lambda: STANDING)

    @property
    def converged(self) -> bool:
        """Whether Newton's method converged in every time step."""
        return self.not_converged == 0

    @property
    def energy(self) -> Floats:
        """(k,) kinetic and strain energy [J]."""
        return np.asarray(self.energies[:, KINETIC] + self.energies[:, STRAIN])

    @property
    def imbalance(self) -> Floats:
        """(k,) energy that appeared from nowhere since the beginning [J]: error of the integration.

        Below zero where a scheme damps.
        """
        e = self.energies
        gained = self.energy - self.energy[0]
        return np.asarray(gained + e[:, DISSIPATED] - e[:, WORK] - e[:, CLOCK])

    @property
    def relative_imbalance(self) -> float:
        """Maximum imbalance over the maximum of the energies."""
        return float(np.abs(self.imbalance).max() / max(np.abs(self.energies).max(), 1e-300))


def at_rest(equations: Equations) -> State:
    """No displacement, no velocity, at time 0; accelerations follow from the loads."""
    zero = np.zeros(len(equations.mass))
    return State(zero, zero, zero)


def joined(parts: Sequence[Motion]) -> Motion:
    """Histories that follow each other, as one; work and losses go on.

    Parameters
    ----------
    parts : sequence of Motion
        Histories, each from the end of the one before, with the same bearings.
    """
    energies = [parts[0].energies]
    for part in parts[1:]:
        later = part.energies.copy()
        later[:, WORK:] += energies[-1][-1, WORK:]
        energies.append(later)
    found = [part.bearings for part in parts]
    bearings = BearingHistory(
        found[0].seats,
        behind([one.motions for one in found]),
        behind([one.loads for one in found]),
    )
    return Motion(
        behind([part.times for part in parts]),
        behind([part.q for part in parts]),
        behind([part.velocity for part in parts]),
        behind([part.forces for part in parts]),
        behind(energies),
        sum(part.iterations for part in parts),
        max(part.max_iterations for part in parts),
        sum(part.not_converged for part in parts),
        parts[-1].end,
        bearings if bearings.seats else NO_BEARINGS,
        azimuth=behind([part.azimuth for part in parts]),
    )


def behind(parts: Sequence[Floats]) -> Floats:
    """Records one behind the other, without the first of all later parts."""
    first, *rest = parts
    return np.concatenate([first, *(one[1:] for one in rest)])


def thinned(motion: Motion, which: Ints) -> Motion:
    """Some records of a history.

    Parameters
    ----------
    motion : Motion
        History of k records.
    which : Ints
        Numbers of records.
    """
    bearings, braking = motion.bearings, motion.braking
    if bearings.seats:
        bearings = replace(bearings, motions=bearings.motions[which], loads=bearings.loads[which])
    if braking.torque.size:
        braking = replace(braking, torque=braking.torque[which], held=braking.held[which])
    kept = {name: getattr(motion, name)[which] for name in _RECORDS}
    azimuth = motion.azimuth[which] if motion.azimuth.size else STANDING
    return replace(motion, **kept, bearings=bearings, braking=braking, azimuth=azimuth)


_RECORDS = ("times", "q", "velocity", "forces", "energies")
