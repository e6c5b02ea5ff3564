"""Planets that travel round the sun in time: rows and superelements that turn with their carriers.

Displacements are those in space, from places that turn steadily with each carrier. A row of a
planet is then h(psi), with psi = omega t of its carrier, and since its geometry turns as a whole it
is a trigonometric polynomial in psi: of degree 1, of an elastic ring by its harmonics n of degree
n + 1, and a stiffness that turns of twice that. Its coefficients follow exactly from as many
azimuths as they are. Masses stand still in space, so that what Coriolis and centripetal terms of a
turning frame stand for is here in the rows alone. The equations

    M q'' + (C + W G) q' + sum_i F_i h_i(psi) + E(psi) q = f(t),    F of delta = h(psi) q

are those of a system that depends on time: what turning the rows against the forces of the springs
takes, F omega h' q, is on the account of the clock, as a drive that holds the speed would have it.
The steady centrifugal forces of the planets, which are in balance, are left out.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import ceil, pi

import numpy as np

from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.dynamics.equations import Equations, Loads
from fe_drivetrain.dynamics.flexible import Flexible
from fe_drivetrain.dynamics.integration import AVERAGE, TOLERANCE, Motion, Scheme, State, at_rest
from fe_drivetrain.dynamics.levels import Level, machine_system
from fe_drivetrain.dynamics.machine_rows import PlanetaryData
from fe_drivetrain.dynamics.roller_seats import (
    Rollers,
    Seat,
    planet_seats,
    rollers_of,
    without_bearings,
)
from fe_drivetrain.dynamics.steady_state import SpringsAt, gathered, springs_at
from fe_drivetrain.dynamics.system import System
from fe_drivetrain.dynamics.tables import Machine
from fe_drivetrain.dynamics.time_steps import MOST_STEPS

EXACT = 1e-9
"""Allowed error of the coefficients at another azimuth, over the maximum entry of the system."""


@dataclass(frozen=True)
class Turning:
    """Terms that turn with one carrier, as cosines and sines of its azimuth from degree 1 on.

    Attributes
    ----------
    carrier : int
        Number of the carrier.
    ratio : float
        Speed of the carrier over that of reference.
    rows : Floats
        Change (2 d, m, n) of the springs' rows: cosine and sine of degree 1, of degree 2, ...
    extra : Floats
        Change (2 d', n, n) of the stiffness of superelements.
    bearings : Floats
        Change (2 d, b, 5, n) of the rows of rolling bearings.
    """

    carrier: int
    ratio: float
    rows: Floats
    extra: Floats
    bearings: Floats


@dataclass(frozen=True)
class Travelling:
    """A system whose carriers travel.

    Attributes
    ----------
    system : System
        System with all carriers at azimuth 0.
    turning : tuple[Turning, ...]
        One for each carrier.
    rows, extra, bearings : Floats
        Means (m, n), (n, n), (b, 5, n) over the azimuths.
    seats : tuple[Seat, ...]
        Rolling bearings, at azimuth 0; their springs are taken out of the system.
    """

    system: System
    turning: tuple[Turning, ...]
    rows: Floats
    extra: Floats
    bearings: Floats
    seats: tuple[Seat, ...] = ()

    def at(self, angle: float) -> tuple[Floats, Floats, Floats]:
        """Rows (m, n), superelements (n, n), rows of bearings (b, 5, n) at an angle of reference.

        Parameters
        ----------
        angle : float
            Angle that the ratios refer to [rad].
        """
        parts = [self.rows, self.extra, self.bearings]
        for one in self.turning:
            for k, change in enumerate((one.rows, one.extra, one.bearings)):
                parts[k] = parts[k] + np.tensordot(_waves(one.ratio * angle, change), change, 1)
        return parts[0], parts[1], parts[2]

    def slopes(self, angle: float) -> tuple[Floats, Floats, Floats]:
        """Derivatives of the same by the angle."""
        parts = [np.zeros_like(one) for one in (self.rows, self.extra, self.bearings)]
        for one in self.turning:
            for k, change in enumerate((one.rows, one.extra, one.bearings)):
                by = one.ratio * _slopes(one.ratio * angle, change)
                parts[k] = parts[k] + np.tensordot(by, change, 1)
        return parts[0], parts[1], parts[2]


def _waves(angle: float, change: Floats) -> Floats:
    degrees = np.arange(1, len(change) // 2 + 1)
    both = np.stack([np.cos(degrees * angle), np.sin(degrees * angle)], axis=1)
    return np.asarray(both.ravel(), dtype=np.float64)


def _slopes(angle: float, change: Floats) -> Floats:
    n = np.arange(1, len(change) // 2 + 1)
    both = np.stack([-n * np.sin(n * angle), n * np.cos(n * angle)], axis=1)
    return np.asarray(both.ravel(), dtype=np.float64)


Placed = tuple[System, Sequence[Seat]]
"""A system at an azimuth, and its rolling bearings."""


def travelling_of(
    at: Callable[[Mapping[int, float]], Placed], ratios: Mapping[int, float], degree: int = 1
) -> Travelling:
    """A system whose carriers travel, from what it is at single azimuths.

    Parameters
    ----------
    at : callable
        Function from azimuths of carriers by number [rad], 0 of those that are left out, to the
        system in the frame that stands still, and its rolling bearings.
    ratios : mapping of int to float
        Speed of each carrier over that of reference.
    degree : int
        Degree of the rows in the azimuth: 1, and n + 1 of a ring with harmonics up to n.

    Returns
    -------
    found : Travelling

    Raises
    ------
    InputError
        Masses change with an azimuth, or rows are not of that degree.
    """
    system, seats = at({})
    rows, extra, bearings = _parts(system, seats)
    means, turning = [rows, extra, bearings], []
    degrees = (degree, 2 * degree, degree)
    for number, ratio in ratios.items():
        count = 4 * degree + 1
        angles = 2 * pi * np.arange(count) / count
        found = [at({number: float(angle)}) for angle in angles]
        if any(
            np.abs(one.mass - system.mass).max() > EXACT * system.mass.max() for one, _ in found
        ):
            raise InputError(
                f"masses of the system change with the azimuth of carrier {number}, which is not "
                "possible: let its planets move by themselves"
            )
        samples = [np.array(part) for part in zip(*(_parts(*one) for one in found), strict=True)]
        waves = []
        for k, (sample, most) in enumerate(zip(samples, degrees, strict=True)):
            means[k] = means[k] + sample.mean(axis=0) - sample[0]
            n = np.arange(1, most + 1)[:, None] * angles
            by = np.stack([np.cos(n), np.sin(n)], axis=1).reshape(2 * most, count) * 2.0 / count
            waves.append(np.tensordot(by, sample, 1))
        turning.append(Turning(number, ratio, waves[0], waves[1], waves[2]))
    rows, extra, bearings = means
    carriers = Travelling(system, tuple(turning), rows, extra, bearings, tuple(seats))
    for number in ratios:
        _check(carriers, at, number)
    return carriers


def _parts(system: System, seats: Sequence[Seat]) -> tuple[Floats, Floats, Floats]:
    return system.rows, system.extra, rollers_of(system, seats).rows


def _check(carriers: Travelling, at: Callable[[Mapping[int, float]], Placed], number: int) -> None:
    """Refuse coefficients that miss the system where none were taken."""
    only = tuple(replace(one, ratio=float(one.carrier == number)) for one in carriers.turning)
    angle = 0.7
    found, exact = replace(carriers, turning=only).at(angle), _parts(*at({number: angle}))
    for one, other in zip(found, exact, strict=True):
        missed = float(np.abs(one - other).max(initial=0.0))
        if missed > EXACT * float(np.abs(other).max(initial=0.0)):
            raise InputError(
                f"rows of carrier {number} are not of the degree that is given in its azimuth: "
                "give n + 1 for a ring with harmonics up to n"
            )


def travelling(
    machine: Machine,
    level: Level = Level.RIGID,
    elements: int = 6,
    held_generator: bool = False,
    flexible: Flexible | None = None,
    rollers: Mapping[int, Bearing] | None = None,
) -> Travelling:
    """A machine whose planets travel with their carriers, over the rotor's speed.

    Parameters
    ----------
    machine : Machine
        Table of the machine.
    level, elements, held_generator, flexible : Level, int, bool, Flexible
        Level and its options, see `machine_system`.
    rollers : mapping of int to Bearing, optional
        Rolling bearings of the planets by the number of their stage, in place of their springs.

    Returns
    -------
    found : Travelling
    """
    kinds = rollers or {}

    def at(angles: Mapping[int, float]) -> Placed:
        system = machine_system(machine, level, angles, elements, held_generator, flexible)
        seats = [
            one
            for number, bearing in kinds.items()
            for one in planet_seats(
                machine,
                number,
                bearing,
                angles.get(number, 0.0) / machine.speeds[number - 1],
                flexible,
            )
        ]
        return without_bearings(system, seats), seats

    ratios = {
        number: machine.speeds[number - 1]
        for number, stage in enumerate(machine.stages, start=1)
        if isinstance(stage, PlanetaryData)
    }
    rims = flexible.rims.values() if flexible is not None else ()
    return travelling_of(at, ratios, 1 + max((n for _, found in rims for n in found), default=0))


@dataclass(frozen=True)
class Travelled:
    """A history of motion with carriers that travel.

    Attributes
    ----------
    motion : Motion
        Displacements in space, and forces of springs.
    azimuth : Floats
        Reference angle (k,), such as that of the rotor [rad].
    seats : tuple[Seat, ...]
        Seats (b,) of the rolling bearings.
    loads : Floats
        Loads (k, b, 5) that they carry, see `OnRollers` [N, N m].
    """

    motion: Motion
    azimuth: Floats
    seats: tuple[Seat, ...]
    loads: Floats


def integrate_travelling(
    equations: Equations,
    carriers: Travelling,
    speed: float,
    loads: Loads,
    duration: float,
    dt: float,
    scheme: Scheme = AVERAGE,
    start: State | None = None,
    *,
    every: int = 1,
    tolerance: float = TOLERANCE,
) -> Travelled:
    """Integrate in equal steps while carriers turn at steady speeds.

    Parameters
    ----------
    equations : Equations
        Equations of `carriers.system`, from `varying_equations`: meshes that vary, gaps, errors.
    carriers : Travelling
        System whose carriers travel, from `travelling`.
    speed : float
        Reference speed [rad/s]; the angle is 0 at t = 0.
    loads : Loads
        Loads on the system, in space.
    duration, dt : float
        Duration of the whole motion and length of a step [s]; the number of steps is rounded up.
    scheme : Scheme
        Time integration scheme, see `integrate`.
    start : State, optional
        Displacements, velocities and time, at rest where left out.
    every : int
        Steps from record to record.
    tolerance : float
        Tolerance of Newton's method: residual over the forces, both on a unit diagonal.

    Returns
    -------
    found : Travelled
        Motion, converged in every step, or it says in how many it did not.

    Raises
    ------
    InputError
        The step or the duration is not positive, or the equations are of another system.
    """
    for name, value in (("duration", duration), ("time step", dt)):
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g} s but must be above 0 s: change it")
    if equations.springs.rows.shape != carriers.rows.shape:
        raise InputError(
            f"equations have rows of shape {equations.springs.rows.shape} but must have "
            f"{carriers.rows.shape}: make them from the system of the carriers"
        )
    run = _Run(equations, carriers, speed, loads)
    return run.march(
        start or at_rest(equations),
        ceil(duration / dt * (1.0 - 1e-12)),
        dt,
        scheme,
        every,
        tolerance,
    )


@dataclass(frozen=True)
class _At:
    """Forces and their derivatives at a time and place, and what belongs to the energy."""

    force: Floats
    K: Floats
    C: Floats
    springs: SpringsAt
    bearings: Floats
    strain: float
    lost: float
    clock: float


class _Run:
    """A run of equal steps."""

    def __init__(
        self, equations: Equations, carriers: Travelling, speed: float, loads: Loads
    ) -> None:
        self.equations, self.carriers = equations, carriers
        self.speed, self.loads = speed, loads
        self.beside = equations.extra - carriers.system.extra
        self.kinds = tuple(one.bearing for one in carriers.seats)

    def forces(self, t: float, q: Floats, v: Floats) -> _At:
        """All forces on the left side but inertia."""
        angle, W = self.speed * t, self.speed
        rows, turned, on_bearings = self.carriers.at(angle)
        row_slopes, turned_slopes, bearing_slopes = self.carriers.slopes(angle)
        extra = turned + self.beside
        now = replace(
            self.equations, springs=replace(self.equations.springs, rows=rows), extra=extra
        )
        at = springs_at(now, t, q, v, W * (row_slopes @ q))
        force, K = gathered(now, at, q, v)
        # dampers feel the turning of their rows, too
        K = K + rows.T @ ((at.damped * W)[:, None] * row_slopes)
        C = rows.T @ (at.damped[:, None] * rows) + now.damping
        strain = float(at.energy.sum()) + 0.5 * float(q @ extra @ q)
        clock = float(at.clock.sum()) + 0.5 * W * float(q @ turned_slopes @ q)
        lost = float(at.lost.sum()) + float(v @ now.damping @ v)
        F = np.zeros((len(self.kinds), 5))
        if self.kinds:
            rollers = Rollers(self.kinds, on_bearings)
            u = np.asarray(on_bearings @ q)
            F, tangents = rollers.carried(u)
            force = force + np.einsum("bia,bi->a", on_bearings, F)
            K = K + np.einsum("bia,bij,bjc->ac", on_bearings, tangents, on_bearings, optimize=True)
            strain += rollers.energy(u)
            clock += W * float(np.einsum("bi,bia,a->", F, bearing_slopes, q))
        return _At(force, K, C, at, F, strain, lost, clock)

    def march(
        self,
        begin: State,
        steps: int,
        dt: float,
        scheme: Scheme,
        every: int,
        tolerance: float,
    ) -> Travelled:
        """All steps, and what is recorded of them."""
        M, b = self.equations.mass, scheme.coefficients(dt)
        am, af = b[6], b[7]
        q, v = begin.q.astype(float), begin.velocity.astype(float)
        now, outside = self.forces(begin.time, q, v), self.loads.at(begin.time)
        a = np.linalg.solve(M, outside - now.force)
        work = lost = clock = 0.0
        iterations = most = missed = 0
        kept = []
        for s in range(steps + 1):
            t = begin.time + s * dt
            if s > 0:
                outside1 = self.loads.at(t)
                behind = am * (M @ a) + af * (now.force - outside)
                step, then, count, converged = self.newton(
                    t,
                    q,
                    v,
                    np.asarray(a, dtype=np.float64),
                    (1 - af) * outside1 - behind,
                    b,
                    tolerance,
                )
                iterations, most = iterations + count, max(most, count)
                missed += not converged
                work += 0.5 * float((outside + outside1) @ step)
                lost += 0.5 * dt * (now.lost + then.lost)
                clock += 0.5 * dt * (now.clock + then.clock)
                v1 = b[1] * step + b[4] * v + b[5] * a
                a = b[0] * step - b[2] * v - b[3] * a
                q, v, now, outside = q + step, v1, then, outside1
            if s % every == 0:
                energies = np.array([0.5 * v @ M @ v, now.strain, work, lost, clock])
                kept.append((np.array(t), q, v, now.springs.along, energies, now.bearings))
        times, places, rates, forces, energies, carried = (
            np.array(of) for of in zip(*kept, strict=True)
        )
        end = State(q, v, np.asarray(a, dtype=np.float64), begin.time + steps * dt)
        motion = Motion(times, places, rates, forces, energies, iterations, most, missed, end)
        return Travelled(motion, self.speed * times, self.carriers.seats, carried)

    def newton(
        self,
        t: float,
        q: Floats,
        v: Floats,
        a: Floats,
        given: Floats,
        b: Floats,
        tolerance: float,
    ) -> tuple[Floats, _At, int, bool]:
        """Change of the displacements in a step."""
        M, am, af = self.equations.mass, b[6], b[7]
        step = np.zeros(len(q))
        for count in range(MOST_STEPS + 1):
            v1 = b[1] * step + b[4] * v + b[5] * a
            inertia = (1 - am) * (M @ (b[0] * step - b[2] * v - b[3] * a))
            then = self.forces(t, q + step, v1)
            inside = (1 - af) * then.force
            residual = given - inertia - inside
            A = (1 - am) * b[0] * M + (1 - af) * (then.K + b[1] * then.C)
            diagonal = np.abs(A.diagonal())
            root = np.sqrt(diagonal)
            size = max(float(np.abs(part / root).max()) for part in (given, inertia, inside))
            if float(np.abs(residual / root).max()) <= tolerance * size:
                return step, then, count, True
            if count < MOST_STEPS:
                scaled = scaled_to_unit_diagonal(A, diagonal)
                change = np.linalg.solve(scaled, residual / root) / root
                step = step + (1.0 if count < MOST_STEPS // 2 else 0.5) * change
        return step, then, MOST_STEPS, False
