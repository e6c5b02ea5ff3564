"""Sections of a run between events: which discs turn and to which side, and which stand."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.equations import Loads, summed
from fe_drivetrain.dynamics.time.loop_forms import Stop
from fe_drivetrain.dynamics.time.mechanism import Mechanism
from fe_drivetrain.dynamics.time.motion import Motion, State
from fe_drivetrain.dynamics.time.stepper import Piece


@dataclass(frozen=True)
class Section:
    """What acts between two events.

    Attributes
    ----------
    mechanism : Mechanism
        What moves and acts.
    slipping : dict[int, float]
        Side (1 or -1) to which each disc turns that its brake slows down, by number of the brake.
    standing : tuple[int, ...]
        Numbers of the brakes whose discs stand.
    begin, end : float
        Times between which it is asked for [s].
    """

    __repr__ = short_repr

    mechanism: Mechanism
    slipping: dict[int, float]
    standing: tuple[int, ...]
    begin: float
    end: float

    @cached_property
    def loads(self) -> Loads:
        """Loads, and the friction of discs that turn."""
        brakes = self.mechanism.brakes
        friction = [
            brakes[k].friction(side, self.begin, self.end) for k, side in self.slipping.items()
        ]
        return summed(self.mechanism.loads, *friction) if friction else self.mechanism.loads

    @cached_property
    def held(self) -> Floats:
        """(h, n) rows of the discs that stand."""
        n = len(self.mechanism.equations.mass)
        rows = [self.mechanism.brakes[k].row for k in self.standing]
        return np.array(rows, dtype=np.float64).reshape(-1, n)

    @cached_property
    def stop(self) -> Stop:
        """Event of a disc that turns no longer."""
        n, brakes = len(self.mechanism.equations.mass), self.mechanism.brakes
        rows = [brakes[k].row for k in self.slipping]
        return Stop(
            np.array(rows, dtype=np.float64).reshape(-1, n),
            np.array(list(self.slipping.values()), dtype=np.float64),
        )

    @cached_property
    def _mobility(self) -> Floats:
        """(h, h) accelerations of the discs that stand by torques on them."""
        return np.asarray(self.held @ np.linalg.solve(self.mechanism.equations.mass, self.held.T))

    def begun(self, state: State) -> State:
        """A state with the accelerations here, and no motion of discs that stand."""
        if self.standing:
            still = np.linalg.qr(self.held.T)[0]
            state = replace(state, velocity=state.velocity - still @ (still.T @ state.velocity))
        return self.mechanism.settled(state, self.loads, self.held)

    def holding(self, gripped: Floats) -> Floats:
        """Torques (k, h) that keep discs at rest, by what they would do without (k, h)."""
        if not self.standing:
            return np.zeros((len(gripped), 0))
        return np.asarray(-np.linalg.solve(self._mobility, gripped.T).T, dtype=np.float64)

    def holding_at(self, state: State) -> Floats:
        """(h,) the same at a state, apart from the compiled loop."""
        free = self.mechanism.settled(state, self.loads).acceleration
        return np.asarray(self.holding((self.held @ free)[None])[0])

    def sizes(self, times: Floats) -> Floats:
        """(k, h) maximum torques of the brakes of discs that stand."""
        brakes = self.mechanism.brakes
        return np.stack([brakes[k].sizes(times) for k in self.standing], axis=1)

    def margins(self, piece: Piece, before: State) -> dict[int, float]:
        """What is left at the end of a piece until an event of each brake; 1 at its beginning."""
        found = {}
        for k, side in self.slipping.items():
            row = self.mechanism.brakes[k].row
            began = abs(float(row @ before.velocity))
            found[k] = side * float(row @ piece.motion.end.velocity) / (began or 1.0)
        times = piece.motion.times[-1:]
        torque = self.holding(piece.gripped[-1:])
        for j, k in enumerate(self.standing):
            size = float(self.sizes(times)[0, j])
            found[k] = (size - abs(float(torque[0, j]))) / (size or 1.0)
        return found

    def good_steps(self, piece: Piece) -> int | None:
        """Number of steps of a piece before that of its first event; none where there is none."""
        steps = len(piece.motion.times) - 1
        found = steps - 1 if piece.stopped else None
        if self.standing:
            torque, sizes = self.holding(piece.gripped), self.sizes(piece.motion.times)
            over = np.flatnonzero((np.abs(torque) > sizes)[1:].any(axis=1))
            if len(over):
                found = int(over[0])
        return found

    def torques(self, motion: Motion, gripped: Floats) -> tuple[Floats, Bools]:
        """Torques (k, b) of all brakes on their discs, and whether each stands."""
        brakes = self.mechanism.brakes
        found = np.zeros((len(motion.times), len(brakes)))
        held = np.zeros(found.shape, dtype=bool)
        for k, side in self.slipping.items():
            found[:, k] = -side * brakes[k].sizes(motion.times)
        if self.standing:
            found[:, self.standing] = self.holding(gripped)
            held[:, self.standing] = True
        return found, held
