"""Events: phases with other loads and machines, and a disc brake that slips, sticks and lets go.

A brake's torque is that of dry friction: of full size against the motion while the disc turns, and
whatever holds it while it stands, up to the same size. Both changes are found within a step, by a
shorter one that ends there; a disc that stands is taken out of the degrees of freedom, so that it
does not creep.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy import linalg
from scipy.optimize import brentq

from fe_drivetrain.common.arrays import Bools, Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.equations import (
    Equations,
    Loads,
    SpringLaws,
    joined_laws,
    spring_laws,
    summed,
    varying,
)
from fe_drivetrain.dynamics.integration import (
    AVERAGE,
    TOLERANCE,
    Motion,
    Scheme,
    State,
    Stepper,
    prepared,
    run_steps,
    settled,
)
from fe_drivetrain.dynamics.step_control import joined
from fe_drivetrain.dynamics.time_steps import Stop

#: Steps between looks at whether a brake still holds.
AT_ONCE = 256


@dataclass(frozen=True)
class Brake:
    """A disc brake.

    Attributes
    ----------
    row : Floats
        Row (n,) from the velocities to the speed of the disc.
    torque : float
        Friction torque, at full size [N m].
    start, rise : float
        Time at which it is applied, and time that its torque takes to grow to full size, evenly
        [s].
    """

    row: Floats
    torque: float
    start: float
    rise: float = 0.0

    __repr__ = short_repr

    def size(self, t: float) -> float:
        """Maximum torque at a time [N m]."""
        if t < self.start:
            return 0.0
        return self.torque * (min((t - self.start) / self.rise, 1.0) if self.rise > 0.0 else 1.0)


@dataclass(frozen=True)
class Phase:
    """Part of a transient: what moves, under which loads, until when [s], braked or not."""

    until: float
    equations: Equations
    loads: Loads
    brake: Brake | None = None


@dataclass(frozen=True)
class Transient:
    """A history with events.

    Attributes
    ----------
    motion : Motion
        A record at each step, and at each event.
    brake : Floats
        Torque (k,) of the brake on the disc [N m].
    held : Bools
        Flags (k,): whether the disc stands.
    events : tuple of (float, str)
        Times [s] at which the disc "stops", "sticks" and "slips".
    """

    motion: Motion
    brake: Floats
    held: Bools
    events: tuple[tuple[float, str], ...]

    __repr__ = short_repr


def transient(
    phases: Sequence[Phase], dt: float, start: State, scheme: Scheme = AVERAGE
) -> Transient:
    """Integrate a series of phases, each from the end of the one before.

    Parameters
    ----------
    phases : Sequence[Phase]
        Phases with the same degrees of freedom, and as many springs.
    dt : float
        Length of a step [s]; the last one before an event is shorter.
    start : State
        State at the beginning of the first phase.
    scheme : Scheme
        Time integration scheme of the steps.

    Returns
    -------
    found : Transient

    Raises
    ------
    InputError
        Phases do not follow each other, or have other springs; or a stiffness that varies with an
        angle is braked.
    """
    springs = {len(phase.equations.springs.rows) for phase in phases}
    if len(springs) > 1:
        raise InputError(
            f"phases have {' and '.join(map(str, sorted(springs)))} springs but must have equally "
            "many: give a machine that is off no damping, instead of leaving it out"
        )
    run = _Run(dt, scheme, start)
    for phase in phases:
        if not phase.until > run.state.time:
            raise InputError(
                f"a phase ends at {phase.until:g} s but begins at {run.state.time:g} s: give them "
                "in the order of time"
            )
        brake = phase.brake
        if brake is None or brake.start >= phase.until:
            run.advance(phase.equations, phase.loads, phase.until)
            continue
        if brake.start > run.state.time:
            run.advance(phase.equations, phase.loads, brake.start)
        run.braked(phase, brake)
    return Transient(
        joined(run.parts),
        np.concatenate([run.torques[0], *(one[1:] for one in run.torques[1:])]),
        np.concatenate([run.holds[0], *(one[1:] for one in run.holds[1:])]),
        tuple(run.events),
    )


class _Run:
    """Results so far, and the factors of the matrices."""

    def __init__(self, dt: float, scheme: Scheme, start: State) -> None:
        self.dt, self.scheme, self.state = dt, scheme, start
        self.parts: list[Motion] = []
        self.torques: list[Floats] = []
        self.holds: list[Bools] = []
        self.events: list[tuple[float, str]] = []

    def keep(self, motion: Motion, torque: Floats, held: bool) -> None:
        self.parts.append(motion)
        self.torques.append(torque)
        self.holds.append(np.full(len(motion.times), held))
        self.state = motion.end

    def advance(
        self,
        equations: Equations,
        loads: Loads,
        until: float,
        brake: Brake | None = None,
        side: float = 0.0,
    ) -> bool:
        """Integrate to a time, or until a disc that turns to one side stops: whether it has."""
        stop = Stop(np.zeros(len(equations.mass)) if brake is None else brake.row, side)

        def torque(motion: Motion) -> Floats:
            sizes = [0.0 if brake is None else -side * brake.size(t) for t in motion.times]
            return np.array(sizes)

        state = settled(equations, loads, self.state)
        left = until - state.time
        whole = int(left / self.dt * (1.0 + 1e-12))
        rest = left - whole * self.dt
        for steps, h in ((whole, self.dt), (1, rest)):
            if not steps or h <= 1e-9 * self.dt:
                continue
            stepper = prepared(equations, h, self.scheme)
            motion, before, stopped = run_steps(stepper, loads, state, steps, 1, None, stop)
            if stopped and brake is not None:
                motion = _shortened(motion, before)
                self.keep(motion, torque(motion), False)
                step = _until(equations, loads, before, h, self.scheme, partial(_speed, brake))
                self.keep(step, torque(step), False)
                return True
            self.keep(motion, torque(motion), False)
            state = motion.end
        return False

    def braked(self, phase: Phase, brake: Brake) -> None:
        """Slip, stick and slip again, until the end of a phase."""
        equations, loads = phase.equations, phase.loads
        if equations.springs.turns.any():
            raise InputError(
                "a brake acts beside a stiffness that varies with an angle, which is not possible: "
                "let it vary with time"
            )
        side = float(np.sign(brake.row @ self.state.velocity))
        while self.state.time < phase.until * (1.0 - 1e-12):
            if side:
                friction = _friction(brake, side, self.state.time, phase.until)
                acting = summed(loads, friction)
                if not self.advance(equations, acting, phase.until, brake, side):
                    return
                self.events.append((self.state.time, "stops"))
            holding = _holding(equations, loads, brake, self.state)
            if abs(holding) > brake.size(self.state.time):
                side = -float(np.sign(holding))
                continue
            self.events.append((self.state.time, "sticks"))
            if not self.hold(phase, brake):
                return
            self.events.append((self.state.time, "slips"))
            side = -float(np.sign(self.torques[-1][-1]))

    def hold(self, phase: Phase, brake: Brake) -> bool:
        """Until the phase ends, or the brake slips: whether it does."""
        loads, state = phase.loads, self.state
        row = brake.row / np.linalg.norm(brake.row)
        rest = linalg.null_space(row[None])
        fixed = row * float(row @ state.q)
        inner = _standing(phase.equations, fixed).within(rest)
        inside = Loads(np.ascontiguousarray(rest.T @ loads.patterns), loads.times, loads.histories)
        m = len(phase.equations.springs.rows)

        def outer(motion: Motion) -> Motion:
            end = motion.end
            return replace(
                motion,
                q=motion.q @ rest.T + fixed,
                velocity=motion.velocity @ rest.T,
                forces=motion.forces[:, :m],
                end=State(
                    rest @ end.q + fixed, rest @ end.velocity, rest @ end.acceleration, end.time
                ),
            )

        def excess(at: State) -> float:
            whole = State(rest @ at.q + fixed, rest @ at.velocity, rest @ at.acceleration, at.time)
            holding = _holding(phase.equations, loads, brake, whole)
            return abs(holding) - brake.size(at.time)

        y = State(rest.T @ state.q, rest.T @ state.velocity, np.zeros(rest.shape[1]), state.time)
        y = settled(inner, inside, y)
        stepper = prepared(inner, self.dt, self.scheme)
        while True:
            left = phase.until - y.time
            if left <= 1e-9 * self.dt:
                return False
            steps = min(AT_ONCE, int(left / self.dt * (1.0 + 1e-12)))
            h = self.dt
            if not steps:
                steps, h = 1, left
                stepper = prepared(inner, h, self.scheme)
            motion, _, _ = run_steps(stepper, inside, y, steps, 1, None, _never(y))
            found = outer(motion)
            holding = _holdings(phase.equations, loads, brake, found)
            sizes = np.array([brake.size(t) for t in found.times])
            over = np.flatnonzero(np.abs(holding[1:]) > sizes[1:])
            if not len(over):
                self.keep(found, holding, True)
                y = motion.end
                continue
            good = int(over[0])
            if good:
                motion, _, _ = run_steps(stepper, inside, y, good, 1, None, _never(y))
                self.keep(outer(motion), holding[: good + 1], True)
                y = motion.end
            step = _until(inner, inside, y, h, self.scheme, excess)
            found = outer(step)
            self.keep(found, _holdings(phase.equations, loads, brake, found), True)
            return True


def _shortened(motion: Motion, before: State) -> Motion:
    """Motion without the last step."""
    return replace(
        motion,
        times=motion.times[:-1],
        q=motion.q[:-1],
        velocity=motion.velocity[:-1],
        forces=motion.forces[:-1],
        energies=motion.energies[:-1],
        end=before,
    )


def _speed(brake: Brake, state: State) -> float:
    return float(brake.row @ state.velocity)


def _never(state: State) -> Stop:
    return Stop(np.zeros(len(state.q)), 0.0)


def _friction(brake: Brake, side: float, begin: float, end: float) -> Loads:
    """Friction of a disc that turns to one side."""
    full = brake.start + brake.rise
    times = np.unique([begin, *([full] if begin < full < end else []), end])
    return varying(brake.row, times, [-side * brake.size(t) for t in times])


def _until(
    equations: Equations,
    loads: Loads,
    before: State,
    dt: float,
    scheme: Scheme,
    changes_sign: Callable[[State], float],
) -> Motion:
    """One step that is as long as something keeps its sign."""

    def after(h: float) -> Motion:
        stepper: Stepper = prepared(equations, h, scheme)
        return run_steps(stepper, loads, before, 1, 1, None, _never(before), TOLERANCE)[0]

    def value(h: float) -> float:
        return float(changes_sign(after(h).end))

    shortest = 1e-6 * dt
    if np.sign(value(shortest)) != np.sign(value(dt)):
        return after(float(brentq(value, shortest, dt, xtol=1e-9 * dt, rtol=1e-12)))
    return after(shortest)


def _holding(equations: Equations, loads: Loads, brake: Brake, state: State) -> float:
    """Torque that keeps a disc at rest [N m]."""
    free = settled(equations, loads, state).acceleration
    return -float(brake.row @ free) / _mobility(equations, brake)


def _mobility(equations: Equations, brake: Brake) -> float:
    return float(brake.row @ np.linalg.solve(equations.mass, brake.row))


def _holdings(equations: Equations, loads: Loads, brake: Brake, motion: Motion) -> Floats:
    """(k,) the same at each record of a motion."""
    inside = (
        motion.forces @ equations.springs.rows
        + motion.q @ equations.extra
        + motion.velocity @ equations.damping.T
    )
    free = np.linalg.solve(equations.mass, (loads.at(motion.times) - inside).T)
    return np.asarray(-(brake.row @ free) / _mobility(equations, brake))


def _standing(equations: Equations, fixed: Floats) -> Equations:
    """Equations beside a displacement that stays; a dense stiffness becomes springs."""
    s = equations.springs
    if equations.extra.any():
        values, vectors = linalg.eigh(equations.extra)
        s = joined_laws(s, spring_laws(vectors.T, np.maximum(values, 0.0)))
    moved: SpringLaws = replace(s, offset=s.offset - s.rows @ fixed)
    return Equations(equations.mass, moved, equations.damping, np.zeros_like(equations.extra))
