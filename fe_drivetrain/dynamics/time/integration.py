"""Integration in time of equations of motion and all that acts on them: one engine.

Springs with laws, dead zones, generators, rolling bearings, carriers that travel, brakes that stick
and a base that moves act together; steps are equal, or as long as their error allows. Laws and
bearings are met by Newton's method in each step, to a stated tolerance, or the run says in how many
steps they were not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.equations import Equations
from fe_drivetrain.dynamics.time.brakes import Brake
from fe_drivetrain.dynamics.time.loop_forms import Stop
from fe_drivetrain.dynamics.time.mechanism import Acting, Mechanism, mechanism_of
from fe_drivetrain.dynamics.time.motion import Motion, State, StepHistory, at_rest
from fe_drivetrain.dynamics.time.pace import ControlledPace, Pace
from fe_drivetrain.dynamics.time.schemes import AVERAGE, Scheme
from fe_drivetrain.dynamics.time.step_control import StepControl
from fe_drivetrain.dynamics.time.stepper import TOLERANCE, Stepper, prepared, run_steps
from fe_drivetrain.dynamics.time.stick_slip import Course


def integrate(
    equations: Equations,
    acting: Acting,
    duration: float,
    step: float | StepControl,
    scheme: Scheme = AVERAGE,
    start: State | None = None,
    *,
    every: int = 1,
    watch: ArrayLike | None = None,
    driven: bool = True,
    tolerance: float = TOLERANCE,
) -> Motion:
    """Integrate in time.

    Parameters
    ----------
    equations : Equations
        Equations of motion of the system.
    acting : Loads, or sequence
        Loads, or a list of all that acts: `Loads`, further `SpringLaws` such as generators,
        `RollingBearings`, `TravellingCarriers`, `Brake`, `BaseMotion`.
    duration : float
        Duration of the whole motion [s].
    step : float or StepControl
        Length of equal steps [s], whose number is rounded up; or the tolerance of their error, for
        steps of their own choice.
    scheme : Scheme
        `AVERAGE`, `LINEAR`, or one of `generalised_alpha`.
    start : State, optional
        Displacements, velocities and time at the beginning, at rest where left out; accelerations
        are those of the equations of motion.
    every : int
        Steps from record to record; those of events and of the end of a run with brakes or step
        control are kept, too.
    watch : array_like, optional
        Rows (w, n) whose values and rates are recorded in place of all degrees of freedom.
    driven : bool
        Whether a stiffness that varies with an angle acts on that angle; without, as Park et al.
        2021 have it, energy is not conserved.
    tolerance : float
        Tolerance of Newton's method: change of an elongation, or of a bearing's motion, over its
        maximum so far.

    Returns
    -------
    motion : Motion
        Motion, converged in every step, or it says in how many it did not.

    Raises
    ------
    InputError
        The step or the duration is not positive, no step is short enough, or what acts does not fit
        the equations or each other.
    """
    if not (np.isfinite(duration) and duration > 0.0):
        raise InputError(f"duration is {duration:g} s but must be above 0 s: change it")
    if every < 1:
        raise InputError(f"every is {every} steps but must be at least 1: change it")
    mechanism = mechanism_of(equations, acting, driven)
    begin = start or at_rest(equations)
    if not (mechanism.brakes or isinstance(step, StepControl)):
        steps = ceil(duration / step * (1.0 - 1e-12)) if step > 0.0 else 0
        equal = EqualSteps(prepared(mechanism, step, scheme))
        return equal.motion(begin, steps, every, watch, tolerance)
    pace = _pace(step, scheme, tolerance)
    if not isinstance(step, StepControl):
        duration = ceil(duration / step * (1.0 - 1e-12)) * step
    course = Course(pace, begin, mechanism.brakes)
    course.phase(mechanism, begin.time + duration)
    motion = _with_control(course.history(every), pace)
    if watch is None:
        return motion
    seen = np.atleast_2d(np.asarray(watch, dtype=np.float64))
    return replace(motion, q=motion.q @ seen.T, velocity=motion.velocity @ seen.T)


@dataclass(frozen=True)
class EqualSteps:
    """Equal steps without events, whose matrices are made once; see `equal_steps`."""

    __repr__ = short_repr

    stepper: Stepper

    def motion(
        self,
        begin: State,
        steps: int,
        every: int = 1,
        watch: ArrayLike | None = None,
        tolerance: float = TOLERANCE,
    ) -> Motion:
        """Some steps, in one call of the loop.

        Parameters
        ----------
        begin : State
            State at the beginning.
        steps, every : int
            Number of steps, and of steps from record to record.
        watch : array_like or None
            Rows that are recorded, as of `integrate`.
        tolerance : float
            Tolerance of Newton's method, as of `integrate`.
        """
        mechanism = self.stepper.mechanism
        mechanism.check_base(begin.time, begin.time + steps * self.stepper.model.matrices.dt)
        none = np.zeros((0, len(begin.q)))
        state = mechanism.settled(begin, mechanism.loads)
        stop = Stop(none, np.zeros(0))
        return run_steps(
            self.stepper, mechanism.loads, state, steps, every, watch, stop, tolerance
        ).motion


def equal_steps(
    equations: Equations, acting: Acting, step: float, scheme: Scheme = AVERAGE
) -> EqualSteps:
    """Equal steps of what moves and acts, for a motion in pieces.

    Parameters
    ----------
    equations : Equations
        Equations of motion.
    acting : Acting
        What acts, without brakes.
    step : float
        Length of a step [s].
    scheme : Scheme
        The scheme, as of `integrate`.

    Raises
    ------
    InputError
        The step is not positive, or what acts does not fit the equations or each other.
    """
    return EqualSteps(prepared(mechanism_of(equations, acting), step, scheme))


@dataclass(frozen=True)
class Phase:
    """Part of a transient: what moves, and all that acts on it, until when [s]."""

    until: float
    equations: Equations
    acting: Acting


def transient(
    phases: Sequence[Phase],
    step: float | StepControl,
    start: State,
    scheme: Scheme = AVERAGE,
    *,
    tolerance: float = TOLERANCE,
) -> Motion:
    """Integrate a series of phases, each from the end of the one before.

    Parameters
    ----------
    phases : Sequence[Phase]
        Phases with the same degrees of freedom and bearings, and as many springs.
    step : float or StepControl
        Length of equal steps [s], the last one before an event being shorter; or the tolerance of
        their error.
    start : State
        State at the beginning of the first phase.
    scheme : Scheme
        Time integration scheme of the steps.
    tolerance : float
        Tolerance of Newton's method, see `integrate`.

    Returns
    -------
    motion : Motion
        A record at each step, and at each event.

    Raises
    ------
    InputError
        Phases do not follow each other, or have other springs or bearings; or what acts does not
        fit.
    """
    mechanisms = [mechanism_of(phase.equations, phase.acting) for phase in phases]
    _check_phases(mechanisms)
    brakes: list[Brake] = []
    for one in mechanisms:
        brakes += [brake for brake in one.brakes if not any(brake is known for known in brakes)]
    pace = _pace(step, scheme, tolerance)
    course = Course(pace, start, brakes)
    for phase, mechanism in zip(phases, mechanisms, strict=True):
        if not phase.until > course.state.time:
            raise InputError(
                f"a phase ends at {phase.until:g} s but begins at {course.state.time:g} s: give "
                "them in the order of time"
            )
        course.phase(mechanism, phase.until)
    return _with_control(course.history(1), pace)


def _pace(step: float | StepControl, scheme: Scheme, tolerance: float) -> Pace:
    if isinstance(step, StepControl):
        return ControlledPace(scheme, step, tolerance)
    return Pace(scheme, step, tolerance)


def _with_control(motion: Motion, pace: Pace) -> Motion:
    """A history with the lengths of its steps, where they were chosen."""
    if not isinstance(pace, ControlledPace):
        return motion
    found = StepHistory(np.array(pace.steps), np.array(pace.errors), pace.rejected, pace.matrices)
    return replace(motion, control=found)


def _check_phases(mechanisms: Sequence[Mechanism]) -> None:
    """Refuse phases whose records do not fit each other."""
    springs = {len(one.equations.springs.rows) for one in mechanisms}
    if len(springs) > 1:
        raise InputError(
            f"phases have {' and '.join(map(str, sorted(springs)))} springs but must have equally "
            "many: give a machine that is off no damping, instead of leaving it out"
        )
    seats = {tuple(seat.name for seat in one.bearings.seats) for one in mechanisms}
    if len(seats) > 1:
        raise InputError(
            f"phases have {' and '.join(str(len(names)) for names in sorted(seats))} rolling "
            "bearings, but must have the same: give each phase those of the others"
        )
    if len({one.carriers is None for one in mechanisms}) > 1:
        raise InputError(
            "carriers travel in some phases and stand in others, which is not possible: give all "
            "phases the same travelling carriers"
        )
