"""Time integration in equal steps: Newmark and generalised alpha, with a record of the energy.

The unknown of a step is the change of the displacements (Park et al. 2021, Table 1, Eq 29-34), so
that a turning drivetrain loses no digits to its angle. Laws of springs are met by Newton's method
in each step, to a stated tolerance, or the run says in how many steps they were not.

What loads and the clock of stiffnesses that vary with time put in is what goes into motion and
strain, and what dampers take out; the rest is the error of the integration (`Motion.imbalance`).
"""

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.equations import Equations, Loads
from fe_drivetrain.dynamics.steady_state import restoring
from fe_drivetrain.dynamics.time_steps import (
    CLOCK,
    DISSIPATED,
    KINETIC,
    STRAIN,
    WORK,
    Drive,
    Laws,
    Matrices,
    Stop,
    march,
)

TOLERANCE = 1e-10
"""Tolerance of Newton's method: change of an elongation over its maximum so far."""


@dataclass(frozen=True)
class Scheme:
    """Newmark's method, or generalised alpha (Chung and Hulbert 1993, with their signs).

    Attributes
    ----------
    name : str
        Name for charts.
    beta, gamma : float
        Newmark's parameters; Park et al. 2021 call them alpha and beta.
    alpha_m, alpha_f : float
        Shares of the step's beginning in the balance of inertia and of other forces.
    """

    name: str
    beta: float
    gamma: float
    alpha_m: float = 0.0
    alpha_f: float = 0.0

    def coefficients(self, dt: float) -> Floats:
        """(8,) as `march` takes them."""
        b, g = self.beta, self.gamma
        return np.array(
            [
                1.0 / (b * dt**2),
                g / (b * dt),
                1.0 / (b * dt),
                0.5 / b - 1.0,
                1.0 - g / b,
                dt * (1.0 - 0.5 * g / b),
                self.alpha_m,
                self.alpha_f,
            ]
        )


AVERAGE = Scheme("average acceleration", 0.25, 0.5)
"""Constant average acceleration, the trapezoidal rule: unconditionally stable, no damping."""

LINEAR = Scheme("linear acceleration", 1.0 / 6.0, 0.5)
"""Stable while the step is below 0.551 of the shortest period."""


def generalised_alpha(spectral_radius: float) -> Scheme:
    """Generalised alpha with a spectral radius at infinite frequency (Chung and Hulbert 1993).

    Parameters
    ----------
    spectral_radius : float
        Factor of the highest frequencies in each step: 1 leaves them, 0 removes them in one.

    Returns
    -------
    scheme : Scheme
        Scheme of second order, with the minimum damping of low frequencies for that of high ones.

    Raises
    ------
    InputError
        The radius is not between 0 and 1.
    """
    r = spectral_radius
    if not 0.0 <= r <= 1.0:
        raise InputError(f"spectral radius is {r:g} but must be 0 to 1: change it")
    m, f = (2.0 * r - 1.0) / (r + 1.0), r / (r + 1.0)
    return Scheme(f"generalised alpha, {r:g}", 0.25 * (1.0 - m + f) ** 2, 0.5 - m + f, m, f)


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

    q: Floats
    velocity: Floats
    acceleration: Floats
    time: float = 0.0

    __repr__ = short_repr


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
    most_iterations : int
        Maximum number of Newton steps in one time step.
    not_converged : int
        Time steps in which Newton's method did not converge.
    end : State
        State at the last step.
    """

    times: Floats
    q: Floats
    velocity: Floats
    forces: Floats
    energies: Floats
    iterations: int
    most_iterations: int
    not_converged: int
    end: State

    __repr__ = short_repr

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


@dataclass(frozen=True)
class Stepper:
    """Equations prepared for a scheme and a length of step; see `prepared`.

    Attributes
    ----------
    equations : Equations
        Equations of motion of the system.
    matrices : Matrices
        Matrices of the step, with the inverse.
    laws : Laws
        Laws of springs that are more than a constant stiffness.
    """

    equations: Equations
    matrices: Matrices
    laws: Laws


def prepared(
    equations: Equations, dt: float, scheme: Scheme = AVERAGE, driven: bool = True
) -> Stepper:
    """The constant matrix of a step inverted, and the laws in the form of the compiled loop.

    Parameters
    ----------
    equations : Equations
        Equations of motion of the system.
    dt : float
        Length of a step [s].
    scheme : Scheme
        Time integration scheme.
    driven : bool
        Whether a stiffness that varies with an angle acts on that angle; without, as Park et al.
        2021 have it, energy is not conserved.

    Returns
    -------
    stepper : Stepper

    Raises
    ------
    InputError
        The step is not positive, or the matrix is singular.
    """
    if not (np.isfinite(dt) and dt > 0.0):
        raise InputError(f"time step is {dt:g} s but must be above 0 s: change it")
    s = equations.springs
    which = np.flatnonzero(s.special)
    varies = (s.wave >= 0) | (s.error >= 0)
    turning = [i for i in which if varies[i] and s.turns[i].any()]
    angle = np.full(len(s.rows), -1)
    angle[turning] = len(which) + np.arange(len(turning))
    R = np.ascontiguousarray(np.vstack([s.rows[which], s.turns[turning]]))
    constant = ~s.special
    K, C = equations.K, equations.C
    factors = scheme.coefficients(dt)
    A = (1.0 - scheme.alpha_m) * factors[0] * equations.mass + (1.0 - scheme.alpha_f) * (
        factors[1] * C + K
    )
    inverse = np.linalg.inv(A)
    columns = np.ascontiguousarray(inverse @ R.T)
    matrices = Matrices(
        float(dt),
        factors,
        equations.mass,
        np.ascontiguousarray(C),
        np.ascontiguousarray(K),
        np.asarray(s.rows[constant].T @ (s.stiffness * s.offset)[constant], dtype=np.float64),
        R,
        np.ascontiguousarray(inverse),
        columns,
        np.ascontiguousarray(R @ columns),
    )
    laws = Laws(
        np.arange(len(which)),
        angle[which],
        s.stiffness[which],
        s.damping[which],
        s.lower[which],
        s.upper[which],
        s.exponent[which],
        s.offset[which],
        s.wave[which],
        s.phase[which],
        s.frequency[which],
        s.power[which],
        s.speed[which],
        s.waves,
        s.error[which],
        s.error_phase[which],
        s.error_turns[which],
        s.errors,
        driven,
    )
    return Stepper(equations, matrices, laws)


def at_rest(equations: Equations) -> State:
    """No displacement, no velocity, at time 0; accelerations follow from the loads."""
    zero = np.zeros(len(equations.mass))
    return State(zero, zero, zero)


def integrate(
    equations: Equations,
    loads: Loads,
    duration: float,
    dt: float,
    scheme: Scheme = AVERAGE,
    start: State | None = None,
    *,
    every: int = 1,
    watch: ArrayLike | None = None,
    driven: bool = True,
    tolerance: float = TOLERANCE,
) -> Motion:
    """Integrate in equal steps.

    Parameters
    ----------
    equations : Equations
        Equations of motion of the system.
    loads : Loads
        Loads on the system.
    duration, dt : float
        Duration of the whole motion and length of a step [s]; the number of steps is rounded up.
    scheme : Scheme
        `AVERAGE`, `LINEAR`, or one of `generalised_alpha`.
    start : State, optional
        Displacements, velocities and time at the beginning, at rest where left out; accelerations
        are those of the equations of motion.
    every : int
        Steps from record to record.
    watch : array_like, optional
        Rows (w, n) whose values and rates are recorded in place of all degrees of freedom.
    driven : bool
        Whether a stiffness that varies with an angle acts on that angle, see `prepared`.
    tolerance : float
        Tolerance of Newton's method: change of an elongation over its maximum so far.

    Returns
    -------
    motion : Motion

    Raises
    ------
    InputError
        The step or the duration is not positive.
    """
    if not (np.isfinite(duration) and duration > 0.0):
        raise InputError(f"duration is {duration:g} s but must be above 0 s: change it")
    stepper = prepared(equations, dt, scheme, driven)
    begin = settled(equations, loads, start or at_rest(equations), driven)
    steps = ceil(duration / dt * (1.0 - 1e-12))
    never = Stop(np.zeros(len(equations.mass)), 0.0)
    motion, _, _ = run_steps(stepper, loads, begin, steps, every, watch, never, tolerance)
    return motion


def settled(equations: Equations, loads: Loads, state: State, driven: bool = True) -> State:
    """The state with the accelerations of the equations of motion."""
    force = restoring(equations, state.time, state.q, state.velocity, driven)[0]
    a = np.linalg.solve(equations.mass, loads.at(state.time) - force)
    return State(state.q, state.velocity, np.asarray(a), state.time)


def run_steps(
    stepper: Stepper,
    loads: Loads,
    begin: State,
    steps: int,
    every: int,
    watch: ArrayLike | None,
    stop: Stop,
    tolerance: float = TOLERANCE,
) -> tuple[Motion, State, bool]:
    """Some steps, which may end at an event.

    Parameters
    ----------
    stepper : Stepper
        Equations, scheme and step, from `prepared`.
    loads : Loads
        Loads on the system.
    begin : State
        State at the beginning, with its accelerations.
    steps, every : int
        Number of steps, and of steps from record to record, see `march`.
    watch : array_like or None
        Rows whose values and rates are recorded, see `integrate`.
    stop : Stop
        Event that ends the steps.
    tolerance : float
        Tolerance of Newton's method: change of an elongation over its maximum so far.

    Returns
    -------
    motion : Motion
        Motion up to the last record.
    before : State
        State before the last step.
    stopped : bool
        Whether the event came in it.
    """
    equations, n = stepper.equations, len(stepper.equations.mass)
    s = equations.springs
    seen = np.eye(n) if watch is None else np.atleast_2d(np.asarray(watch, dtype=np.float64))
    rows = np.ascontiguousarray(np.vstack([seen, s.rows]))
    k = steps // every + 1
    times, places, rates = np.empty(k), np.empty((k, len(rows))), np.empty((k, len(rows)))
    law_forces, energies = np.empty((k, len(stepper.laws.row))), np.empty((k, 5))
    counts: Ints = np.zeros(3, dtype=np.int64)
    state = np.zeros((6, n))
    state[0], state[1], state[2] = begin.q, begin.velocity, begin.acceleration
    state[3:] = state[:3]
    drive = Drive(
        np.ascontiguousarray(loads.patterns),
        np.ascontiguousarray(loads.times),
        np.ascontiguousarray(loads.histories),
    )
    done = march(
        steps,
        every,
        begin.time,
        stepper.matrices,
        stepper.laws,
        drive,
        stop,
        tolerance,
        state,
        rows,
        times,
        places,
        rates,
        law_forces,
        energies,
        counts,
    )
    k = done // every + 1
    w, law = len(seen), s.special
    forces = np.empty((k, len(s.rows)))
    forces[:, ~law] = ((places[:k, w:] - s.offset) * s.stiffness + rates[:k, w:] * s.damping)[
        :, ~law
    ]
    forces[:, law] = law_forces[:k]
    constant = ~law
    # the constant of a spring's energy that its offset leaves
    energies[:k, STRAIN] += 0.5 * float((s.stiffness * s.offset**2)[constant].sum())
    dt = stepper.matrices.dt
    before = State(state[3], state[4], state[5], begin.time + (done - 1) * dt)
    motion = Motion(
        times[:k],
        places[:k, :w],
        rates[:k, :w],
        forces,
        energies[:k],
        int(counts[0]),
        int(counts[1]),
        int(counts[2]),
        State(state[0], state[1], state[2], begin.time + done * dt),
    )
    return motion, before, stop.sign != 0.0 and stop.sign * float(stop.row @ state[1]) <= 0.0
