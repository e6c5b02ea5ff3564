"""What moves and all that acts on it, gathered for time integration, or refused by name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.equations import (
    Equations,
    Loads,
    SpringLaws,
    joined_laws,
    summed,
)
from fe_drivetrain.dynamics.bodies.steady_state import gathered, springs_at
from fe_drivetrain.dynamics.time.base_motion import BaseMotion
from fe_drivetrain.dynamics.time.brakes import Brake
from fe_drivetrain.dynamics.time.motion import State
from fe_drivetrain.dynamics.time.rolling_bearings import RollingBearings, bearings_on
from fe_drivetrain.dynamics.time.travelling import TravellingCarriers

Act = Loads | SpringLaws | RollingBearings | TravellingCarriers | Brake | BaseMotion
"""What can act in time."""

Acting = Loads | Sequence[Act]
"""Loads alone, or a list of all that acts."""


@dataclass(frozen=True)
class Rows:
    """Rows at a time, and their derivatives by time at constant displacements.

    Attributes
    ----------
    springs, spring_slopes : Floats
        Rows (m, n) of the springs.
    extra : Floats
        Stiffness (n, n) of superelements.
    bearings, bearing_slopes : Floats
        Rows (b, 5, n) of the rolling bearings.
    """

    __repr__ = short_repr

    springs: Floats
    spring_slopes: Floats
    extra: Floats
    bearings: Floats
    bearing_slopes: Floats


@dataclass(frozen=True)
class Mechanism:
    """Equations of motion and all that acts.

    Attributes
    ----------
    equations : Equations
        Equations of motion, with all springs.
    loads : Loads
        All loads.
    bearings : RollingBearings
        All rolling bearings, those of travelling carriers first.
    carriers : TravellingCarriers or None
        Carriers that travel.
    brakes : tuple[Brake, ...]
        Disc brakes.
    bases : tuple[BaseMotion, ...]
        Motions of the base, whose loads are among all loads.
    driven : bool
        Whether a stiffness that varies with an angle acts on that angle.
    """

    __repr__ = short_repr

    equations: Equations
    loads: Loads
    bearings: RollingBearings
    carriers: TravellingCarriers | None
    brakes: tuple[Brake, ...]
    bases: tuple[BaseMotion, ...]
    driven: bool

    @property
    def beside(self) -> Floats:
        """(n, n) stiffness beside springs that does not turn."""
        if self.carriers is None:
            return self.equations.extra
        return np.asarray(self.equations.extra - self.carriers.carriers.system.extra)

    def rows_at(self, t: float) -> Rows:
        """All rows at a time [s]."""
        springs, bearings = self.equations.springs.rows, self.bearings.rows
        still = Rows(
            springs,
            np.zeros_like(springs),
            self.equations.extra,
            bearings,
            np.zeros_like(bearings),
        )
        if self.carriers is None:
            return still
        turning, W = self.carriers.carriers, self.carriers.speed
        rows, extra, seats = turning.at(W * t)
        slopes, _, seat_slopes = turning.slopes(W * t)
        m, b = len(rows), len(seats)
        return Rows(
            np.vstack([rows, springs[m:]]),
            np.vstack([W * slopes, still.spring_slopes[m:]]),
            extra + self.beside,
            np.concatenate([seats, bearings[b:]]),
            np.concatenate([W * seat_slopes, still.bearing_slopes[b:]]),
        )

    def inside(self, t: float, q: Floats, velocity: Floats) -> Floats:
        """(n,) all forces on the left side but inertia, apart from the compiled loop."""
        e, rows = self.equations, self.rows_at(t)
        now = replace(e, springs=replace(e.springs, rows=rows.springs), extra=rows.extra)
        at = springs_at(now, t, q, velocity, rows.spring_slopes @ q)
        force = gathered(now, at, q, velocity, self.driven)[0]
        if not len(rows.bearings):
            return force
        rate = rows.bearings @ velocity + rows.bearing_slopes @ q
        F = self.bearings.loads(np.asarray(rows.bearings @ q), np.asarray(rate))
        return np.asarray(force + np.einsum("bia,bi->a", rows.bearings, F))

    def check_base(self, begin: float, end: float) -> None:
        """Refuse a run that is not within the samples of the base's motion [s]."""
        for one in self.bases:
            one.check(begin, end)

    def settled(self, state: State, loads: Loads, held: Floats | None = None) -> State:
        """The state with the accelerations of the equations of motion.

        Parameters
        ----------
        state : State
            Displacements and velocities.
        loads : Loads
            Loads that act.
        held : Floats, optional
            Rows (h, n) of motions that are held.
        """
        M = self.equations.mass
        force = self.inside(state.time, state.q, state.velocity)
        a = np.linalg.solve(M, loads.at(state.time) - force)
        if held is not None and len(held):
            pull = np.linalg.solve(M, held.T)
            a = a - pull @ np.linalg.solve(held @ pull, held @ a)
        return State(state.q, state.velocity, np.asarray(a), state.time)


def mechanism_of(equations: Equations, acting: Acting, driven: bool = True) -> Mechanism:
    """Equations of motion with all that acts on them.

    Parameters
    ----------
    equations : Equations
        Equations of motion of a system.
    acting : Loads or sequence
        What acts: loads, springs, rolling bearings, travelling carriers, brakes, motion of the
        base.
    driven : bool
        Whether a stiffness that varies with an angle acts on that angle.

    Raises
    ------
    InputError
        Something cannot act in time, is of another system, or not with something else.
    """
    acts = [acting] if isinstance(acting, Loads) else list(acting)
    n = len(equations.mass)
    for one in acts:
        _checked(one, n)
    carriers = [one for one in acts if isinstance(one, TravellingCarriers)]
    if len(carriers) > 1:
        raise InputError(
            f"{len(carriers)} sets of travelling carriers act together, which is not possible: "
            "give all carriers of a machine in one `travelling`"
        )
    if carriers:
        _of_carriers(equations.springs.rows, carriers[0].carriers.rows)
    springs = [one for one in acts if isinstance(one, SpringLaws)]
    if springs:
        equations = replace(equations, springs=joined_laws(equations.springs, *springs))
    loads = [one for one in acts if isinstance(one, Loads)]
    bases = tuple(one for one in acts if isinstance(one, BaseMotion))
    loads += [one.loads_on(equations) for one in bases]
    brakes = tuple(one for one in acts if isinstance(one, Brake))
    _distinct(brakes)
    return Mechanism(
        equations,
        summed(*loads) if len(loads) > 1 else loads[0] if loads else _none(n),
        _bearings(acts, n),
        carriers[0] if carriers else None,
        brakes,
        bases,
        driven,
    )


def _of_carriers(rows: Floats, own: Floats) -> None:
    """Refuse springs that do not begin with those of the system whose carriers travel."""
    if rows.shape[1] != own.shape[1] or len(rows) < len(own):
        raise InputError(
            f"equations have rows of shape {rows.shape} but must begin with {own.shape} of "
            "travelling ones: make them from the system of the carriers"
        )


def _none(n: int) -> Loads:
    return Loads(np.zeros((n, 1)), np.zeros(1), np.zeros((1, 1)))


def _checked(act: Act, n: int) -> None:
    """Refuse what cannot act, or acts on other degrees of freedom."""
    match act:
        case Loads():
            found = act.patterns.shape[0]
        case SpringLaws():
            found = act.rows.shape[1]
        case RollingBearings():
            found = act.rows.shape[2]
        case TravellingCarriers():
            found = len(act.carriers.system.names)
        case Brake():
            found = len(act.row)
        case BaseMotion():
            found = act.motions.shape[0]
        case _:
            raise InputError(
                f"a {type(act).__name__} cannot act in time: give Loads, SpringLaws, "
                "RollingBearings, TravellingCarriers, Brake or BaseMotion"
            )
    if found != n:
        raise InputError(
            f"a {type(act).__name__} acts on {found} degrees of freedom and the equations have "
            f"{n}: make both from the same system"
        )


def _distinct(brakes: Sequence[Brake]) -> None:
    """Refuse brakes that hold the same motion, whose torques are not determined."""
    if brakes:
        rows = np.array([one.row / np.linalg.norm(one.row) for one in brakes])
        if np.linalg.matrix_rank(rows) < len(rows):
            raise InputError(
                f"{len(brakes)} brakes hold motions that depend on each other, so that which of "
                "them holds is not determined: give brakes of one disc as one, with all of their "
                "torque"
            )


def _bearings(acts: Sequence[Act], n: int) -> RollingBearings:
    """All rolling bearings, those of travelling carriers first."""
    groups = [one for one in acts if isinstance(one, RollingBearings)]
    for one in acts:
        if isinstance(one, TravellingCarriers):
            groups.insert(0, bearings_on(one.carriers.seats, one.carriers.bearings, one.damping))
    seats = [seat for group in groups for seat in group.seats]
    names = [seat.name for seat in seats]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(f"two rolling bearings are {twice!r}: give each its own place")
    return RollingBearings(
        tuple(seats),
        np.concatenate([np.zeros((0, 5, n)), *(group.rows for group in groups)]),
        np.concatenate([np.zeros(0), *(group.seconds for group in groups)]),
    )
