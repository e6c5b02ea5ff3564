"""A machine that runs on the rollers of its catalogued bearings, in place of their springs.

The springs of a bearing keep their dampers and lose their stiffness, rollers with their laminae and
clearance carry in their place. What they carry is put where the forces of these springs would be,
so that whatever reads the forces of a bearing does not ask what carries it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.catalogue_seats import bearing_of, catalogued, seats_of
from fe_drivetrain.dynamics.bodies.equations import Equations
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.levels import Level, assembly
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.dynamics.bodies.roller_seats import (
    Seat,
    static_on_rollers,
    without_bearings,
)
from fe_drivetrain.dynamics.bodies.steady_state import WoundUp, free_motions, restoring, wind_up
from fe_drivetrain.dynamics.bodies.system import System, bearing_springs
from fe_drivetrain.dynamics.time.motion import Motion
from fe_drivetrain.dynamics.time.rolling_bearings import RollingBearings, rolling_bearings

_CLOSE = 1e-9
"""Part of the rows of rollers that those of the springs in their place may miss, relative."""


@dataclass(frozen=True)
class RunningRollers:
    """Rollers in place of the springs of bearings.

    Attributes
    ----------
    acting : RollingBearings
        The bearings (b,), without dampers of their own.
    on_springs : System
        The system with the springs of these bearings.
    springs : Ints
        Numbers (s,) of these springs.
    spread : Floats
        Forces (s, 5 b) of these springs that act as the loads of the bearings do.
    """

    __repr__ = short_repr

    acting: RollingBearings
    on_springs: System
    springs: Ints
    spread: Floats

    def put(self, forces: Floats, loads: Floats) -> Floats:
        """Forces (k, m) of springs with what rollers carry, of loads (k, b, 5), in their place."""
        found = forces.copy()
        found[:, self.springs] += loads.reshape(len(forces), -1) @ self.spread.T
        return found

    def at(self, forces: Floats, q: Floats) -> Floats:
        """Forces (m,) of springs with what rollers carry in their place at displacements (n,)."""
        loads = self.acting.rollers.carried(np.asarray(self.acting.rows @ q))[0]
        return np.asarray(self.put(forces[None], loads[None])[0])

    def felt(self, motion: Motion) -> Motion:
        """A motion in whose forces of springs is what rollers carry."""
        return replace(motion, forces=self.put(motion.forces, motion.bearings.loads))

    def wind_up(
        self, equations: Equations, load: Floats, velocity: Floats, time: float = 0.0
    ) -> WoundUp:
        """State without vibration on the rollers, see `wind_up`.

        Parameters
        ----------
        equations : Equations
            Equations of motion without the springs of these bearings; others are linear.
        load, velocity : ndarray, (n,)
            Load, and velocities of what turns freely.
        time : float
            Time [s].

        Raises
        ------
        InputError
            There is no equilibrium on the rollers.
        """
        springs, s = self.on_springs, equations.springs
        stiffness = np.concatenate([springs.stiffness, s.stiffness[len(springs.stiffness) :]])
        before = wind_up(
            replace(equations, springs=replace(s, stiffness=stiffness)), load, velocity, time=time
        )
        # dampers, the generator's line, and what accelerates all, beside what springs carry
        taken = restoring(equations, time, np.zeros(len(load)), velocity)[0]
        balanced = load - taken - equations.mass @ before.acceleration
        free = free_motions(replace(equations, springs=replace(s, stiffness=stiffness)))
        still = equations.mass @ free
        # what holds what turns freely feels nothing of loads in balance, and leaves it where it is
        firm = float(np.abs(springs.K.diagonal()).mean()) / max(np.square(still).sum(), 1e-300)
        held = replace(springs, extra=springs.extra + firm * still @ still.T)
        found = static_on_rollers(held, np.asarray(balanced), self.acting.seats)
        if not found.converged:
            raise InputError(
                "bearings on their rollers find no equilibrium under the first loads: a clearance "
                "leaves a part loose; give less clearance, or leave rollers out"
            )
        return WoundUp(
            found.static.q,
            before.acceleration,
            found.residual,
            before.iterations + found.iterations,
        )


def on_rollers(
    machine: Machine, level: Level, gives: Flexible, system: System
) -> tuple[System, RunningRollers]:
    """A system without the springs of catalogued bearings, and the rollers in their place.

    Parameters
    ----------
    machine : Machine
        Table of the machine.
    level, gives : Level, Flexible
        What may move and give; without the own housings of these bearings.
    system : System
        Its system with the springs of all bearings.

    Raises
    ------
    InputError
        No bearing has an entry of the catalogue, or rollers resist a motion for which its row
        has no spring.
    """
    kinds = {name: bearing_of(row) for name, row in catalogued(machine).items()}
    if level is Level.TORSIONAL or not kinds:
        raise InputError(
            f"no bearing of {machine.title!r} has a catalogue entry and a load, whose rollers "
            "could carry it: give bearings catalogue, or leave rollers out"
        )
    seats = seats_of(machine, assembly(machine, level, flexible=gives), kinds, gives)
    bare = without_bearings(system, seats)
    acting = rolling_bearings(bare, seats)
    numbers = [bearing_springs(system.spring_names, seat.name) for seat in seats]
    spread = np.zeros((sum(map(len, numbers)), 5 * len(seats)))
    first = 0
    for k, (seat, own) in enumerate(zip(seats, numbers, strict=True)):
        block = _spread(seat, system.rows[own], acting.rows[k])
        spread[first : first + len(own), 5 * k : 5 * k + 5] = block
        first += len(own)
    return bare, RunningRollers(acting, system, np.concatenate(numbers), spread)


def _spread(seat: Seat, rows: Floats, of_rollers: Floats) -> Floats:
    """(s, 5) forces along rows (s, n) that act on all bodies as loads along those of rollers do."""
    found = np.linalg.lstsq(rows.T, of_rollers.T, rcond=None)[0]
    missed = np.abs(rows.T @ found - of_rollers.T).max(axis=0)
    if missed.max() > _CLOSE * np.abs(of_rollers).max():
        raise InputError(
            f"bearing {seat.name!r} on its rollers has no springs for all motions that these "
            "resist: give its stiffness six numbers"
        )
    return np.asarray(found)
