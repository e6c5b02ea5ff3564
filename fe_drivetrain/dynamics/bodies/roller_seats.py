"""Rolling bearings in statics: rollers, laminae and clearance in place of the springs of a bearing.

A bearing with the potential V(u) of the motion u = R q of its inner ring against its outer one
loads the system by -R^T F, F = dV/du, as springs do by their rows: forces on the two rings are in
balance by construction. With springs, gaps and contacts that only press, the energy stays convex,
so that Newton's method, damped along its steps, leads to the one equilibrium.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, sin

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.contact_forces import forces
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing.newton import FIRMEST, MAX_STEPS, MAX_TRIALS, narrowed, next_firmness
from fe_drivetrain.bearing.rolling import free_motions
from fe_drivetrain.bearing.stored_energy import energy_of
from fe_drivetrain.common.arrays import Bools, Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import diagonal_roots, scaled_to_unit_diagonal
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.levels import Assembly, is_bushed, planetary_set
from fe_drivetrain.dynamics.bodies.planetary import pin_place
from fe_drivetrain.dynamics.bodies.springs import Place, Spring, directed
from fe_drivetrain.dynamics.bodies.static import Static, gaps_and_contacts, static
from fe_drivetrain.dynamics.bodies.system import System, with_stiffness

TOLERANCE = 1e-9
"""Residual over load, both on a unit diagonal of the stiffness."""

ROUND_OFF = 1e-13
"""Residual over the maximum force inside, where the loads are small beside it."""

FIVE = ("ux", "uy", "uz", "ry", "rz")
"""Motions of a bearing's inner ring."""


@dataclass(frozen=True)
class Seat:
    """A rolling bearing where it sits.

    Attributes
    ----------
    name : str
        Name of the bearing: its springs "NAME ux", "NAME uy" and so on carry until the rollers do.
    bearing : Bearing
        Bearing with the inner ring on the body that moves positive.
    motions : tuple[Spring, ...]
        Rows (5,) of the inner ring's motion against the outer one, `FIVE`; their stiffness is 0.
    """

    name: str
    bearing: Bearing
    motions: tuple[Spring, ...]

    def rows(self, system: System) -> Floats:
        """(5, n) motion of the inner ring against the outer one by the degrees of freedom."""
        found = np.zeros((5, len(system.names)))
        for body in self.motions[0].by:
            moves = system.motion_of(body, np.eye(len(system.names)))
            found += [spring.by[body] @ moves for spring in self.motions]
        return found


def seat(
    name: str,
    bearing: Bearing,
    inner: Place,
    outer: Place | None,
    point: ArrayLike,
    angle: float = 0.0,
) -> Seat:
    """A bearing between two bodies.

    Parameters
    ----------
    name : str
        Name of the springs in whose place it is.
    bearing : Bearing
        Rollers and rings.
    inner, outer : Place, Place or None
        Bodies of its rings; none is the ground.
    point : array_like, (3,)
        Centre of the bearing [m].
    angle : float
        Angle from y to z, by which the bearing's own y is turned about x [rad], as that of a
        planet's pin is, whose inner ring turns with the carrier.
    """
    y, z = np.array([0.0, cos(angle), sin(angle)]), np.array([0.0, -sin(angle), cos(angle)])
    directions = np.zeros((5, 6))
    directions[0, 0] = 1.0
    directions[1:3, :3] = directions[3:, 3:] = [y, z]
    rows = tuple(
        directed(f"{name} {motion}", inner, outer, point, direction, 0.0)
        for motion, direction in zip(FIVE, directions, strict=True)
    )
    return Seat(name, bearing, rows)


def planet_seats(
    machine: MachineTable,
    number: int,
    bearing: Bearing,
    azimuth: float = 0.0,
    flexible: Flexible | None = None,
) -> list[Seat]:
    """The same bearing in all planets of a stage: inner rings on the pins, outer in the planets.

    Parameters
    ----------
    machine : MachineTable
        Table of the machine, with the bearings' places under ``pins``.
    number : int
        Number of the planetary stage, from 1.
    bearing : Bearing
        Bearing at each place.
    azimuth, flexible : float, Flexible
        Azimuth of the rotor's shaft [rad] and flexible bodies, see `machine_system`.

    Returns
    -------
    seats : list[Seat]
        Seats "stage 1 pin 1 upwind" and so on, y along the radius of the planet, z along the
        tangent.
    """
    stage = planetary_set(machine, number, turned=azimuth * machine.speeds[number - 1])
    on_pins = flexible is not None and number in flexible.carriers
    bushed = is_bushed(machine, number)
    found = []
    for k, angle in enumerate(stage.angles):
        centre = stage.centre(k)
        planet = Place(stage.planet_names[k], centre)
        pin = pin_place(stage, k, flexible=on_pins, bushed=bushed)
        for place in stage.bearings:
            at = (centre[0] + place.offset, centre[1], centre[2])
            label = stage.full_name(f"pin {k + 1} {place.name}").strip()
            found.append(seat(label, bearing, pin, planet, at, angle))
    return found


def machine_seat(found: Assembly, name: str, bearing: Bearing) -> Seat:
    """A bearing of a shaft or a carrier: inner ring on it, outer in the housing or the ground.

    Parameters
    ----------
    found : Assembly
        Assembly of the machine.
    name : str
        Name of one of its bearings.
    bearing : Bearing
        Rollers and rings.

    Raises
    ------
    InputError
        There is no bearing of that name.
    """
    if name not in found.seats:
        raise InputError(f"no bearing {name!r}: use one of {', '.join(found.seats)}")
    body, at = found.seats[name]
    centres = {b.name: b.position for b in found.bodies}
    return seat(name, bearing, Place(body, centres[body]), found.holders[name], at)


def seat_number(seats: Sequence[Seat], name: str) -> int:
    """Number of a bearing among others.

    Raises
    ------
    InputError
        There is none of that name.
    """
    names = [seat.name for seat in seats]
    if name not in names:
        raise InputError(f"no rolling bearing {name!r}: use one of {', '.join(names)}")
    return names.index(name)


@dataclass(frozen=True)
class OnRollers:
    """An equilibrium with rolling bearings.

    Attributes
    ----------
    static : Static
        Motions and the forces of springs; those in whose place rollers are carry nothing.
    seats : tuple[Seat, ...]
        Seats (b,) of the bearings.
    motions, loads : Floats
        Motion (b, 5) of each inner ring against the outer one [m, rad], and the load that it
        carries there [N, N m], along and about the axes of its seat.
    residual : float
        Residual of the balance over what is allowed: at most 1 where it has converged.
    converged : bool
        Whether it has.
    iterations : int
        Steps of Newton's method.
    """

    static: Static
    seats: tuple[Seat, ...]
    motions: Floats
    loads: Floats
    residual: float
    converged: bool
    iterations: int

    __repr__ = short_repr

    def of(self, name: str) -> int:
        """Number of a bearing.

        Raises
        ------
        InputError
            There is none of that name.
        """
        return seat_number(self.seats, name)

    def wrench(self, name: str) -> Floats:
        """(6,) that the rollers of a bearing carry from its inner ring, see `System.wrench`.

        Springs that stay beside the rollers, such as an axial guide, are not in it.
        """
        k = self.of(name)
        directions = np.array([row.direction for row in self.seats[k].motions])
        return np.asarray(self.loads[k] @ directions)

    def radial(self, name: str) -> float:
        """Radial load of a bearing [N]."""
        return float(np.hypot(*self.loads[self.of(name), 1:3]))


def static_on_rollers(
    system: System,
    load: Floats,
    seats: Sequence[Seat],
    gaps: Mapping[str, float] | None = None,
    contacts: Sequence[str] = (),
) -> OnRollers:
    """Equilibrium of springs, contacts and rolling bearings under a load.

    Parameters
    ----------
    system : System
        System with the springs of all bearings, from whose equilibrium the iteration starts.
    load : ndarray, (n,)
        Generalised load [N, N m].
    seats : sequence of Seat
        Rolling bearings. Springs of the motions that their rollers resist are taken out; others, as
        the axial one of a cylindrical bearing, stay: they are its flanges and guides.
    gaps, contacts : mapping, sequence
        Gaps of springs by name, and names of springs that only press, see `static`.

    Returns
    -------
    found : OnRollers
        Equilibrium, converged or flagged: a body that nothing holds but bearings inside their
        clearances may have no equilibrium, or more than one.

    Raises
    ------
    InputError
        The springs do not hold every motion, a name is no spring, two seats have one name, or
        rollers would take the place of a spring by which a body without mass was eliminated.
    """
    names = [one.name for one in seats]
    if len(set(names)) < len(names):
        raise InputError("two rolling bearings have the same name: give each its own place")
    q = static(system, load, gaps, contacts).q
    problem = _Problem(without_bearings(system, seats), load, seats, gaps, contacts)
    root = diagonal_roots(system.K.diagonal())
    size = float(np.linalg.norm(load / root))
    firm, steps = FIRMEST, 0
    while True:
        g, K, inside = problem.at(q)
        norm = float(np.linalg.norm(g / root))
        allowed = max(TOLERANCE * size, ROUND_OFF * float(np.linalg.norm(inside / root)))
        residual = norm / allowed if norm else 0.0
        if residual <= 1.0 or steps == MAX_STEPS:
            break
        held = scaled_to_unit_diagonal(K, system.K.diagonal())
        held[np.diag_indices_from(held)] += firm * min(1.0, norm / max(size, norm * 1e-3))
        d = -np.linalg.solve(held, g / root) / root
        step, q = _along(problem, q, d, float(g @ d))
        firm = float(next_firmness(firm, step))
        steps += 1
    stretch = problem.system.rows @ q - problem.gaps
    closed = ~problem.presses | (stretch > 0.0)
    carried = np.where(closed, problem.system.stiffness * stretch, 0.0)
    state = Static(problem.system, q, carried, closed)
    u, F, _ = problem.bearings(q)
    return OnRollers(state, tuple(seats), u, F, residual, residual <= 1.0, steps)


def without_bearings(system: System, seats: Sequence[Seat]) -> System:
    """The system without the springs of the motions that rollers resist.

    Parameters
    ----------
    system : System
        System with the springs of all bearings.
    seats : sequence of Seat
        Rolling bearings in their place.

    Returns
    -------
    system : System
        System with the same number of springs, those of the bearings with a stiffness of zero.

    Raises
    ------
    InputError
        A bearing has no springs in the system, or a body without mass was eliminated by them.
    """
    none = {}
    for one in seats:
        resisted = np.abs(free_motions(one.bearing)[0]).max(axis=1) > 0
        for motion, carried in zip(FIVE, resisted, strict=True):
            spring = f"{one.name} {motion}"
            if carried and spring in system.spring_names:
                none[spring] = 0.0
        if f"{one.name} 1" in system.spring_names:
            raise InputError(
                f"bearing {one.name!r} has a stiffness of six rows, in whose place rollers cannot "
                "stand: give it six numbers, which hold what its rollers leave free"
            )
        if not any(name.startswith(f"{one.name} u") for name in system.spring_names):
            raise InputError(
                f"no springs of a bearing {one.name!r} in the system: correct its name"
            )
    return with_stiffness(system, none)


@dataclass(frozen=True)
class Rollers:
    """Rolling bearings on a system's degrees of freedom; equal ones are evaluated together.

    Attributes
    ----------
    kinds : tuple[Bearing, ...]
        Bearings (b,).
    rows : Floats
        Motion (b, 5, n) of each inner ring against the outer one.
    """

    kinds: tuple[Bearing, ...]
    rows: Floats

    def carried(self, u: Floats) -> tuple[Floats, Floats]:
        """Loads (b, 5) and tangents (b, 5, 5) at motions (b, 5)."""
        F, K = np.zeros_like(u), np.zeros((len(u), 5, 5))
        for kind, of in self._equal():
            F[of], K[of] = forces(kind, u[of])
        return F, K

    def energies(self, u: Floats) -> Floats:
        """(k,) stored in all of them at motions (k, b, 5) [J]."""
        found = np.zeros(len(u))
        for kind, of in self._equal():
            found += energy_of(kind, u[:, of].reshape(-1, 5)).reshape(-1, len(of)).sum(axis=1)
        return found

    def _equal(self) -> list[tuple[Bearing, list[int]]]:
        return [
            (kind, [k for k, other in enumerate(self.kinds) if other == kind])
            for kind in dict.fromkeys(self.kinds)
        ]


def rollers_of(system: System, seats: Sequence[Seat]) -> Rollers:
    """The bearings of seats on the degrees of freedom of a system."""
    n = len(system.names)
    rows = np.array([one.rows(system) for one in seats]).reshape(len(seats), 5, n)
    return Rollers(tuple(one.bearing for one in seats), rows)


class _Problem:
    """Gradient and tangent of the energy."""

    def __init__(
        self,
        system: System,
        load: Floats,
        seats: Sequence[Seat],
        gaps: Mapping[str, float] | None,
        contacts: Sequence[str],
    ) -> None:
        self.system, self.load = system, load
        self.gaps, self.presses = gaps_and_contacts(system, gaps, contacts)
        self.rollers = rollers_of(system, seats)
        self.rows = self.rollers.rows
        self.linear = ~self.presses
        fixed = np.where(self.linear, system.stiffness, 0.0)
        self.K = system.rows.T @ (fixed[:, None] * system.rows) + system.extra

    def bearings(self, q: Floats) -> tuple[Floats, Floats, Floats]:
        """Motions and loads (b, 5), tangents (b, 5, 5)."""
        u = np.asarray(self.rows @ q)
        F, K = self.rollers.carried(u)
        return u, F, K

    def at(self, q: Floats) -> tuple[Floats, Floats, Floats]:
        """Unbalanced forces (n,), tangent (n, n), and the sizes of forces inside (n,)."""
        system = self.system
        _, F, tangents = self.bearings(q)
        stretch = system.rows @ q - self.gaps
        closed: Bools = self.linear | (stretch > 0.0)
        k = system.stiffness * closed
        pressed = np.where(self.linear, 0.0, k)
        K = self.K + system.rows.T @ (pressed[:, None] * system.rows)
        K += np.einsum("bia,bij,bjc->ac", self.rows, tangents, self.rows, optimize=True)
        bent = system.extra @ q
        g = system.rows.T @ (k * stretch) + bent + np.einsum("bia,bi->a", self.rows, F) - self.load
        inside = np.abs(system.rows).T @ np.abs(k * stretch) + np.abs(system.extra) @ np.abs(q)
        inside += np.einsum("bia,bi->a", np.abs(self.rows), np.abs(F))
        return g, K, inside


def _along(problem: _Problem, q: Floats, d: Floats, slope: float) -> tuple[float, Floats]:
    """A step along d after which the slope of the energy, which only grows, has fallen."""
    low, high, slope_low, slope_high, step = 0.0, -1.0, slope, 0.0, 1.0
    for _ in range(MAX_TRIALS):
        here = float(problem.at(q + step * d)[0] @ d)
        if abs(here) <= 0.6 * abs(slope):
            break
        low, high, slope_low, slope_high, step = narrowed(
            low, high, slope_low, slope_high, step, here
        )
        if step in (low, high):
            break
    return step, q + step * d
