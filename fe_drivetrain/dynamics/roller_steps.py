"""Time steps with rolling bearings: their forces and tangents inside each step's Newton method.

As in the compiled loop, the constant matrix of a step is inverted once and the unknowns are few
values z = R q, here those of the laws and the five motions of each bearing:

    z + (1 - a_f) S d(z, z') = z_free,    S = R A^-1 R^T

Bearings add the gradient of their energy V(u), convex, and where asked for dampers of a time times
the tangent at the beginning of a step: C = seconds d2V/du2. What they store is on the account of
strain energy by V itself, not by the sum of its steps, so that the imbalance is an error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.equations import Equations, Loads
from fe_drivetrain.dynamics.integration import (
    AVERAGE,
    TOLERANCE,
    Motion,
    Scheme,
    State,
    at_rest,
    prepared,
)
from fe_drivetrain.dynamics.roller_seats import Rollers, Seat, rollers_of, seat_number
from fe_drivetrain.dynamics.steady_state import restoring
from fe_drivetrain.dynamics.system import System
from fe_drivetrain.dynamics.time_steps import MOST_STEPS, Laws, law_forces, touching


@dataclass(frozen=True)
class RollerMotion:
    """A history of motion on rolling bearings.

    Attributes
    ----------
    motion : Motion
        Motion with what the bearings store in the strain energy, and what they damp in the losses;
        forces of springs without them.
    seats : tuple[Seat, ...]
        Seats (b,) of the bearings.
    motions, loads : Floats
        Motion (k, b, 5) of each inner ring against the outer one [m, rad], and the load that it
        carries there, with its damper [N, N m].
    """

    motion: Motion
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


def integrate_on_rollers(
    equations: Equations,
    system: System,
    seats: Sequence[Seat],
    loads: Loads,
    duration: float,
    dt: float,
    scheme: Scheme = AVERAGE,
    start: State | None = None,
    *,
    damping: float = 0.0,
    every: int = 1,
    tolerance: float = TOLERANCE,
) -> RollerMotion:
    """Integrate in equal steps with rolling bearings.

    Parameters
    ----------
    equations : Equations
        Equations of the system without the springs of these bearings: `without_bearings`.
    system : System
        System whose degrees of freedom the equations have.
    seats : sequence of Seat
        Rolling bearings.
    loads : Loads
        Loads on the system.
    duration, dt : float
        Duration of the whole motion and length of a step [s]; the number of steps is rounded up.
    scheme : Scheme
        Time integration scheme, see `integrate`.
    start : State, optional
        Displacements, velocities and time, at rest where left out; such as `static_on_rollers`.
    damping : float
        Damping of each bearing: this time [s] times its tangent stiffness at the beginning of a
        step.
    every : int
        Steps from record to record.
    tolerance : float
        Tolerance of Newton's method: change of an elongation or a bearing's motion over its maximum
        so far.

    Returns
    -------
    motion : RollerMotion
        Motion, converged in every step, or it says in how many it did not.

    Raises
    ------
    InputError
        A duration, step or damping is out of its range, or the equations are of another system.
    """
    if not (np.isfinite(duration) and duration > 0.0):
        raise InputError(f"duration is {duration:g} s but must be above 0 s: change it")
    if not damping >= 0.0:
        raise InputError(f"damping of bearings is {damping:g} s but must be at least 0 s: raise it")
    if len(equations.mass) != len(system.names):
        raise InputError(
            f"equations have {len(equations.mass)} degrees of freedom and the system "
            f"{len(system.names)}: make them from this system without its bearings"
        )
    run = _Run(equations, rollers_of(system, seats), loads, dt, scheme, damping, tolerance)
    steps = ceil(duration / dt * (1.0 - 1e-12))
    return run.march(start or at_rest(equations), steps, every, tuple(seats))


class _Run:
    """A run of equal steps; arrays of its laws first, then of its bearings."""

    def __init__(
        self,
        equations: Equations,
        rollers: Rollers,
        loads: Loads,
        dt: float,
        scheme: Scheme,
        damping: float,
        tolerance: float,
    ) -> None:
        stepper = prepared(equations, dt, scheme)
        self.equations, self.rollers, self.loads = equations, rollers, loads
        self.dt, self.damping, self.tolerance = dt, damping, tolerance
        self.matrices, self.laws = stepper.matrices, stepper.laws
        self.first = len(self.matrices.rows)
        on_rollers = rollers.rows.reshape(-1, len(equations.mass))
        self.R = np.vstack([self.matrices.rows, on_rollers])
        self.columns = self.matrices.inverse @ self.R.T
        self.S = self.R @ self.columns
        self.phases = np.zeros(len(self.R), dtype=bool)
        self.phases[self.laws.angle[self.laws.angle >= 0]] = True
        # the maximum translation and rotation of all bearings so far
        self.turns = np.zeros(len(self.R), dtype=bool)
        self.turns[self.first :] = np.tile([False] * 3 + [True] * 2, len(rollers.kinds))
        self.moves = ~self.turns
        self.moves[: self.first] = False

    def forces(
        self, t: float, z: Floats, rate: Floats, damps: Floats, D: Floats, by_rate: float
    ) -> _At:
        """Forces beyond the constant matrices at values z of the rows, and their tangent."""
        r, q, m = self.first, len(self.laws.row), len(z)
        extra, tangent, spring, damper = (np.zeros(s) for s in ((r,), (r, r), (q,), (q,)))
        energy, power, followed = law_forces(
            self.laws, t, z[:r], rate[:r], damps, by_rate, extra, tangent, spring, damper
        )
        u, v = z[r:].reshape(-1, 5), rate[r:].reshape(-1, 5)
        F, K = self.rollers.carried(u)
        resisted = np.einsum("bij,bj->bi", D, v)
        d, T = np.concatenate([extra, (F + resisted).ravel()]), np.zeros((m, m))
        T[:r, :r] = tangent
        for b, block in enumerate(K + by_rate * D):
            at = slice(r + 5 * b, r + 5 * b + 5)
            T[at, at] = block
        return _At(d, T, spring, damper, resisted, K, energy, power, followed)

    def sizes(self, z: Floats, before: Floats) -> Floats:
        """Scale by which a change of each row is measured."""
        found = np.maximum(before, np.abs(z))
        moved = found[self.moves].max(initial=0.0)
        found[self.moves] = moved
        found[self.turns] = max(found[self.turns].max(initial=0.0), moved)  # a metre away
        found[self.phases] = 1.0
        return np.asarray(found)

    def march(self, begin: State, steps: int, every: int, seats: tuple[Seat, ...]) -> RollerMotion:
        """All steps, and what is recorded of them."""
        e, M, C, K = (
            self.equations,
            self.matrices.mass,
            self.matrices.damping,
            self.matrices.stiffness,
        )
        b, dt, r = self.matrices.coefficients, self.dt, self.first
        am, af = b[6], b[7]
        u, v = begin.q.astype(float), begin.velocity.astype(float)
        q, pairs = len(self.laws.row), len(self.rollers.kinds)
        damps, D = np.zeros(q), np.zeros((pairs, 5, 5))
        z, zr = self.R @ u, self.R @ v
        touching(self.laws, begin.time, z[:r], damps)
        D = self.damping * self.rollers.carried(z[r:].reshape(-1, 5))[1]
        now = self.forces(begin.time, z, zr, damps, D, 0.0)
        outside = self.loads.at(begin.time)
        inside = restoring(e, begin.time, u, v)[0] + self.R[r:].T @ now.d[r:]
        a = np.linalg.solve(M, outside - inside)
        za: Floats = np.asarray(self.R @ a, dtype=np.float64)
        size = np.zeros(len(self.R))
        work = lost = clock = 0.0
        kept, counts, state = _Records(), [0, 0, 0], begin
        for s in range(steps + 1):
            t = begin.time + s * dt
            if s > 0:
                outside1 = self.loads.at(t)
                rhs = (1 - af) * outside1 + af * outside + self.matrices.constant - K @ u
                rhs -= M @ ((am - (1 - am) * b[3]) * a - (1 - am) * b[2] * v)
                rhs -= C @ ((af + (1 - af) * b[4]) * v + (1 - af) * b[5] * a)
                rhs -= af * (self.R.T @ now.d)
                step = self.matrices.inverse @ rhs
                free = z + self.R @ step
                touching(self.laws, t - dt, z[:r], damps)
                D = np.asarray(self.damping * now.K, dtype=np.float64)
                size = self.sizes(np.maximum(np.abs(z), np.abs(free)), size)
                new, then, count, converged = self.newton(t, z, zr, za, free, damps, D, size)
                counts[0] += count
                counts[1] = max(counts[1], count)
                counts[2] += not converged
                step = step - (1 - af) * (self.columns @ then.d)
                v1 = b[1] * step + b[4] * v + b[5] * a
                a = b[0] * step - b[2] * v - b[3] * a
                work += 0.5 * float((outside + outside1) @ step)
                lost += 0.5 * float((C @ (v + v1)) @ step)
                moved = new - z
                lost += 0.5 * float((now.damper + then.damper) @ moved[self.laws.row])
                lost += 0.5 * float((now.resisted + then.resisted).ravel() @ moved[r:])
                lost -= 0.5 * dt * (now.followed + then.followed)
                clock += 0.5 * dt * (now.power + then.power)
                u, v, now, outside = u + step, v1, then, outside1
                z, zr, za = new, self.R @ v, self.R @ a
            if s % every == 0:
                stored = now.energy + self.rollers.energy(z[r:].reshape(-1, 5))
                strain = 0.5 * u @ K @ u - self.matrices.constant @ u + stored
                kept.add(
                    t, u, v, now.spring, now.d[r:], z[r:],
                    [0.5 * v @ M @ v, strain, work, lost, clock],
                )  # fmt: skip
        state = State(u, v, np.asarray(a, dtype=np.float64), begin.time + steps * dt)
        return kept.history(e, self.laws, counts, state, seats)

    def newton(
        self,
        t: float,
        z: Floats,
        zr: Floats,
        za: Floats,
        free: Floats,
        damps: Floats,
        D: Floats,
        size: Floats,
    ) -> tuple[Floats, _At, int, bool]:
        """Values of the rows at the end of a step; shorter changes where the residual grows."""
        b = self.matrices.coefficients
        share = 1.0 - b[7]

        def at(values: Floats) -> tuple[Floats, _At]:
            rate = b[1] * (values - z) + b[4] * zr + b[5] * za
            found = self.forces(t, values, rate, damps, D, float(b[1]))
            return free - values - share * (self.S @ found.d), found

        new = free
        if not len(new):
            return new, at(new)[1], 0, True
        scale = np.where(size > 0.0, size, 1.0)
        residual, found = at(new)
        for count in range(1, MOST_STEPS + 1):
            jacobian = np.eye(len(new)) + share * (self.S @ found.T)
            change = np.linalg.solve(jacobian, residual)
            before, length = float(np.abs(residual / scale).max()), 1.0
            while True:
                trial = at(new + length * change)
                after = float(np.abs(trial[0] / scale).max())
                if after <= before or length < 1e-3 or before < self.tolerance:
                    break
                length *= 0.5
            new = new + length * change
            residual, found = trial
            if length == 1.0 and bool(np.all(np.abs(change) <= self.tolerance * size)):
                return new, found, count, True
        return new, found, MOST_STEPS, False


@dataclass(frozen=True)
class _At:
    """Forces d beyond the constant matrices and what belongs to them, see `law_forces`."""

    d: Floats
    T: Floats
    spring: Floats
    damper: Floats
    resisted: Floats
    K: Floats
    energy: float
    power: float
    followed: float


class _Records:
    """Records of a run."""

    def __init__(self) -> None:
        self.rows: list[tuple[Floats, ...]] = []

    def add(self, t: float, *values: object) -> None:
        self.rows.append((np.array([t]), *(np.array(one, dtype=float) for one in values)))

    def history(
        self, e: Equations, laws: Laws, counts: list[int], end: State, seats: tuple[Seat, ...]
    ) -> RollerMotion:
        t, q, v, spring, loads, motions, energies = (
            np.array(of) for of in zip(*self.rows, strict=True)
        )
        s = e.springs
        forces = (q @ s.rows.T - s.offset) * s.stiffness + (v @ s.rows.T) * s.damping
        forces[:, s.special] = spring
        constant = ~s.special
        energies[:, 1] += 0.5 * float((s.stiffness * s.offset**2)[constant].sum())
        iterations, most, missed = counts
        motion = Motion(t[:, 0], q, v, forces, energies, iterations, most, missed, end)
        shape = (len(t), len(seats), 5)
        return RollerMotion(motion, seats, motions.reshape(shape), loads.reshape(shape))
