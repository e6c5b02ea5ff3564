"""Pace of a run: equal steps, or steps as long as their error allows, up to an event."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fe_drivetrain.common.arrays import Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.time.motion import State, thinned
from fe_drivetrain.dynamics.time.schemes import Scheme
from fe_drivetrain.dynamics.time.sections import Section
from fe_drivetrain.dynamics.time.step_control import MAX_HALVINGS, Estimate, StepControl
from fe_drivetrain.dynamics.time.stepper import Piece, Stepper, prepared, run_steps

#: Steps between looks at whether a brake still holds.
AT_ONCE = 256


class Pace:
    """Equal steps, the last one before the end or an event being shorter.

    Parameters
    ----------
    scheme : Scheme
        Time integration scheme.
    dt : float
        Length of a step [s].
    tolerance : float
        Tolerance of Newton's method.
    """

    def __init__(self, scheme: Scheme, dt: float, tolerance: float) -> None:
        self.scheme, self.dt, self.tolerance = scheme, dt, tolerance
        self._steppers: dict[tuple[int, float, tuple[int, ...]], Stepper] = {}

    def stepper(self, section: Section, h: float) -> Stepper:
        """Steps of a length in a section; those of full length are kept."""
        key = (id(section.mechanism), h, section.standing)
        found = self._steppers.get(key) or prepared(section.mechanism, h, self.scheme, section.held)
        if h == self.dt:
            self._steppers[key] = found
        return found

    def take(self, section: Section, state: State, steps: int, h: float) -> Piece:
        """Some steps of one length, which may end where a disc stops."""
        stepper = self.stepper(section, h)
        return run_steps(
            stepper, section.loads, state, steps, 1, None, section.stop, self.tolerance
        )

    def advance(self, section: Section, state: State) -> tuple[list[Piece], int | None]:
        """Steps to the end of a section, or to an event.

        Parameters
        ----------
        section : Section
            What acts, and until when.
        state : State
            State at the beginning, with its accelerations.

        Returns
        -------
        pieces : list[Piece]
            Steps that were made.
        brake : int or None
            Number of the brake whose event came at the end of them.
        """
        pieces: list[Piece] = []
        while (left := section.end - state.time) > 1e-9 * self.dt:
            steps, h = int(left / self.dt * (1.0 + 1e-12)), self.dt
            if not steps:
                steps, h = 1, left
            if section.standing:
                steps = min(steps, AT_ONCE)
            piece = self.take(section, state, steps, h)
            good = section.good_steps(piece)
            if good is None:
                pieces.append(piece)
                state = piece.motion.end
                continue
            if good == len(piece.motion.times) - 2:
                pieces.append(_shortened(piece))
                state = piece.before
            elif good:
                pieces.append(self.take(section, state, good, h))
                state = pieces[-1].motion.end
            last, brake = self.event(section, state, h)
            return [*pieces, last], brake
        return pieces, None

    def event(self, section: Section, state: State, h: float) -> tuple[Piece, int]:
        """The step that ends at an event within a length, and whose event it is."""
        from scipy.optimize import brentq

        def after(length: float) -> Piece:
            stepper = prepared(section.mechanism, length, self.scheme, section.held)
            none = section.stop._replace(signs=0.0 * section.stop.signs)
            return run_steps(stepper, section.loads, state, 1, 1, None, none, self.tolerance)

        def left(length: float) -> float:
            return min(section.margins(after(length), state).values())

        shortest = 1e-6 * h
        if np.sign(left(shortest)) != np.sign(left(h)):
            piece = after(float(brentq(left, shortest, h, xtol=1e-9 * h, rtol=1e-12)))
        else:
            piece = after(shortest)
        margins = section.margins(piece, state)
        return piece, min(margins, key=lambda k: margins[k])


def _shortened(piece: Piece) -> Piece:
    """A piece without its last step."""
    which: Ints = np.arange(len(piece.motion.times) - 1)
    motion = replace(thinned(piece.motion, which), end=piece.before)
    return Piece(motion, piece.before, False, piece.gripped[:-1])


class ControlledPace(Pace):
    """Steps that keep the error of each within a tolerance.

    Parameters
    ----------
    scheme : Scheme
        Time integration scheme, with an estimate.
    control : StepControl
        First length, and tolerance of the error.
    tolerance : float
        Tolerance of Newton's method.
    """

    def __init__(self, scheme: Scheme, control: StepControl, tolerance: float) -> None:
        control.check(scheme)
        super().__init__(scheme, control.first, tolerance)
        self.control = control
        self.steps: list[float] = []
        self.errors: list[float] = []
        self.rejected = 0
        self._estimate: Estimate | None = None

    @property
    def matrices(self) -> int:
        """Lengths for which a matrix was inverted and kept."""
        return len(self._steppers)

    def advance(self, section: Section, state: State) -> tuple[list[Piece], int | None]:
        """Steps to the end of a section, or to an event, as `Pace.advance`."""
        estimate = self._estimate_of(section, state)
        pieces: list[Piece] = []
        while section.end - state.time > 1e-12 * abs(section.end):
            h = min(self.dt, section.end - state.time)
            piece = self.take(section, state, 1, h)
            error, strain = estimate.of(state, piece.motion.end, h)
            if error > self.control.tolerance or not piece.motion.converged:
                self._shorten()
                continue
            brake = None
            if section.good_steps(piece) is not None:
                piece, brake = self.event(section, state, h)
                h = piece.motion.end.time - state.time
                error, strain = estimate.of(state, piece.motion.end, h)
            pieces.append(piece)
            self.steps.append(h)
            self.errors.append(error)
            state, estimate.largest = piece.motion.end, strain
            self._lengthen(error)
            if brake is not None:
                return pieces, brake
        return pieces, None

    def _estimate_of(self, section: Section, state: State) -> Estimate:
        known = self._estimate
        if known is None or known.mechanism is not section.mechanism:
            found = Estimate(section.mechanism, self.scheme, state)
            found.largest = max(found.largest, known.largest if known else 0.0)
            self._estimate = found
            return found
        return known

    def _shorten(self) -> None:
        self.rejected += 1
        self.dt *= 0.5
        if self.dt < self.control.first * 0.5**MAX_HALVINGS:
            raise InputError(
                f"no step down to {self.dt:.1e} s keeps its error within "
                f"{self.control.tolerance:g}: raise the tolerance"
            )

    def _lengthen(self, error: float) -> None:
        longest = self.control.longest
        # third order: a step twice as long has eight times the error
        if error < self.control.tolerance / 12.0 and (longest is None or 2.0 * self.dt <= longest):
            self.dt *= 2.0
