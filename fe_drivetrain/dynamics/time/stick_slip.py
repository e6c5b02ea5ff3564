"""Discs that slip, stick and let go: sections of a run, and the events between them.

A brake's torque is that of dry friction: of full size against the motion while the disc turns, and
whatever holds it while it stands, up to the same size. Both changes are found within a step, by a
shorter one that ends there; a disc that stands is held by a constraint of the steps, so that it
does not creep.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.dynamics.time.brakes import Brake
from fe_drivetrain.dynamics.time.mechanism import Mechanism
from fe_drivetrain.dynamics.time.motion import Braking, Motion, State, behind, joined, thinned
from fe_drivetrain.dynamics.time.pace import Pace
from fe_drivetrain.dynamics.time.sections import Section


class Course:
    """A run so far.

    Parameters
    ----------
    pace : Pace
        Steps of the run.
    state : State
        Where it begins.
    brakes : sequence of Brake
        Brakes (b,) of all phases, in the order of their records.
    """

    def __init__(self, pace: Pace, state: State, brakes: Sequence[Brake]) -> None:
        self.pace, self.state, self.brakes = pace, state, tuple(brakes)
        self.parts: list[Motion] = []
        self.torques: list[Floats] = []
        self.holds: list[Bools] = []
        self.events: list[tuple[float, str]] = []
        self.of: list[int] = []

    def phase(self, mechanism: Mechanism, until: float) -> None:
        """Go on with a mechanism to a time [s]."""
        mechanism.check_base(self.state.time, until)
        starts = {one.start for one in mechanism.brakes if self.state.time < one.start < until}
        slipping: dict[int, float] = {}
        standing: list[int] = []
        for end in [*sorted(starts), until]:
            now = self.state.time
            new = [
                k
                for k, one in enumerate(mechanism.brakes)
                if one.start <= now and k not in slipping and k not in standing
            ]
            still = []
            for k in new:
                side = float(np.sign(mechanism.brakes[k].row @ self.state.velocity))
                if side:
                    slipping[k] = side
                else:
                    still.append(k)
            self._settle(mechanism, slipping, standing, still, end)
            self._section(mechanism, slipping, standing, end)

    def _section(
        self, mechanism: Mechanism, slipping: dict[int, float], standing: list[int], end: float
    ) -> None:
        """Slip, stick and slip again, to a time at which no further brake begins."""
        while end - self.state.time > 1e-12 * abs(end):
            section = Section(mechanism, dict(slipping), tuple(standing), self.state.time, end)
            pieces, brake = self.pace.advance(section, section.begun(self.state))
            for piece in pieces:
                torques, held = section.torques(piece.motion, piece.gripped)
                self._keep(mechanism, piece.motion, torques, held)
            if brake is None:
                return
            if brake in slipping:
                self._event(mechanism, brake, "stops")
                del slipping[brake]
                self._settle(mechanism, slipping, standing, [brake], end)
            else:
                self._event(mechanism, brake, "slips")
                standing.remove(brake)
                slipping[brake] = -float(np.sign(torques[-1, brake]))

    def _settle(
        self,
        mechanism: Mechanism,
        slipping: dict[int, float],
        standing: list[int],
        still: list[int],
        end: float,
    ) -> None:
        """Which of the discs at rest are held, and to which side the others go."""
        while standing or still:
            both = (*standing, *still)
            section = Section(mechanism, dict(slipping), both, self.state.time, end)
            torque = section.holding_at(self.state)
            sizes = np.array([mechanism.brakes[k].size(self.state.time) for k in both])
            over = np.abs(torque) - sizes
            worst = int(np.argmax(over))
            if not over[worst] > 0.0:
                break
            brake = both[worst]
            if brake in standing:
                self._event(mechanism, brake, "slips")
                standing.remove(brake)
            else:
                still.remove(brake)
            slipping[brake] = -float(np.sign(torque[worst]))
        for brake in still:
            self._event(mechanism, brake, "sticks")
            standing.append(brake)

    def _number(self, brake: Brake) -> int:
        return next(k for k, one in enumerate(self.brakes) if one is brake)

    def _event(self, mechanism: Mechanism, brake: int, what: str) -> None:
        self.events.append((self.state.time, what))
        self.of.append(self._number(mechanism.brakes[brake]))

    def _keep(self, mechanism: Mechanism, motion: Motion, torques: Floats, held: Bools) -> None:
        """Records of a piece, torques under the numbers of all brakes."""
        places = [self._number(one) for one in mechanism.brakes]
        whole = np.zeros((len(motion.times), len(self.brakes)))
        flags = np.zeros(whole.shape, dtype=bool)
        whole[:, places], flags[:, places] = torques, held
        self.parts.append(motion)
        self.torques.append(whole)
        self.holds.append(flags)
        self.state = motion.end

    def history(self, every: int) -> Motion:
        """All records, or every n-th beside those of events and of the end."""
        motion = joined(self.parts)
        if self.brakes:
            braking = Braking(
                behind(self.torques),
                np.concatenate([self.holds[0], *(one[1:] for one in self.holds[1:])]),
                tuple(self.events),
                tuple(self.of),
            )
            motion = replace(motion, braking=braking)
        if every == 1:
            return motion
        which: Ints = np.arange(len(motion.times))
        at = np.array([t for t, _ in self.events])
        kept = (which % every == 0) | np.isin(motion.times, at) | (which == which[-1])
        return thinned(motion, which[kept])
