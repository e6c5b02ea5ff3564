"""Statics: spring forces under loads and with gaps, contacts that only press, over a turn."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import diagonal_roots, scaled_to_unit_diagonal
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.system import System, springs_named, wrench_of

#: Eigenvalue of the stiffness on a unit diagonal below which a motion is free.
FREE = 1e-12


@dataclass(frozen=True)
class Static:
    """An equilibrium.

    Attributes
    ----------
    system : System
        System that it is the equilibrium of.
    q : Floats
        Displacements (n,) [m, rad].
    forces : Floats
        Forces (m,) of the springs, positive where they are stretched, which presses a mesh [N, N
        m].
    closed : Bools
        Flags (m,): springs that carry; False of contacts that are apart.
    """

    system: System
    q: Floats
    forces: Floats
    closed: Bools

    __repr__ = short_repr

    def force(self, name: str) -> float:
        """Force of a spring, or of all slices of a mesh.

        Raises
        ------
        InputError
            There is no such spring.
        """
        return float(self.forces[springs_named(self.system.spring_names, name)].sum())

    def wrench(self, name: str) -> Floats:
        """(6,) force and moment of a bearing at its centre, see `System.wrench` [N, N m].

        Raises
        ------
        InputError
            There is no bearing of that name.
        """
        return self.system.wrench(name, self.forces)

    def radial(self, name: str) -> float:
        """Radial load of a bearing, whatever the kind of its stiffness [N]."""
        return float(np.hypot(*self.wrench(name)[1:3]))


def static(
    system: System,
    load: Floats,
    gaps: Mapping[str, float] | None = None,
    contacts: Sequence[str] = (),
) -> Static:
    """Equilibrium of K q = f, springs being short of contact by a gap each.

    The force of a spring is ``k (h . q - gap)``; one that is a contact is apart while this would
    pull. Which contacts are closed is found by opening all that pull and closing all that overlap,
    until none does: the energy is convex, so that this equilibrium is the only one.

    Parameters
    ----------
    system : System
        System with springs that hold every motion.
    load : ndarray, (n,)
        Generalised load [N, N m].
    gaps : mapping of str to float
        Gaps of springs by name [m, rad]; negative for one that presses before the load comes.
    contacts : sequence of str
        Names of the springs that only press.

    Raises
    ------
    InputError
        Something moves freely, a name is no spring, or one that cannot change, or the contacts do
        not settle.
    """
    short, one_sided = gaps_and_contacts(system, gaps, contacts)
    closed = np.ones(len(short), dtype=bool)
    tried: set[bytes] = set()
    while True:
        tried.add(closed.tobytes())
        k = np.where(closed, system.stiffness, 0.0)
        K = system.rows.T @ (k[:, None] * system.rows) + system.extra
        q = solved(system, K, load + system.rows.T @ (k * short))
        stretch = system.rows @ q - short
        tiny = 1e-12 * float(np.abs(stretch).max(initial=0.0))
        wanted = np.where(one_sided, stretch > -tiny, True)
        if np.array_equal(wanted, closed):
            return Static(system, q, k * stretch, closed)
        closed = wanted
        if closed.tobytes() in tried:
            raise InputError(
                "the contacts of the system do not settle: the same ones open and close in turn; "
                "give the bodies that they hold a weak bearing, or less load"
            )


def gaps_and_contacts(
    system: System, gaps: Mapping[str, float] | None, contacts: Sequence[str]
) -> tuple[Floats, Bools]:
    """(m,) gaps of all springs [m, rad], and whether each only presses; arguments of `static`."""
    short = np.zeros(len(system.spring_names))
    for name, gap in (gaps or {}).items():
        short[system.changeable(name)] = gap
    one_sided = np.zeros(len(short), dtype=bool)
    one_sided[[system.changeable(name) for name in contacts]] = True
    return short, one_sided


def solved(system: System, K: Floats, f: Floats) -> Floats:
    """Displacements of K q = f, with a refinement.

    Parameters
    ----------
    system : System
        System whose degrees of freedom they are.
    K : ndarray, (n, n)
        Stiffness.
    f : ndarray, (n,) or (n, loads)
        Loads.

    Raises
    ------
    InputError
        Something moves freely.
    """
    root = diagonal_roots(np.where(K.diagonal() > 0, K.diagonal(), 1.0))
    loose = np.flatnonzero(K.diagonal() <= 0)
    scaled = scaled_to_unit_diagonal(K, root**2)
    values, vectors = np.linalg.eigh((scaled + scaled.T) / 2)
    if loose.size or values[0] < FREE:
        moving = int(loose[0]) if loose.size else int(np.abs(vectors[:, 0]).argmax())
        raise InputError(
            f"{system.names[moving]} can move freely, so that there is no equilibrium: hold it, or "
            "give it a spring"
        )
    right = (f.T / root).T
    q = vectors @ ((vectors.T @ right).T / values).T
    q += vectors @ ((vectors.T @ (right - scaled @ q)).T / values).T
    return np.asarray((q.T / root).T)


@dataclass(frozen=True)
class Turn:
    """Equilibria over one turn of a carrier.

    Attributes
    ----------
    azimuths : Floats
        Azimuths (s,) of the carrier [rad].
    spring_names : tuple[str, ...]
        Names (m,) of the springs.
    forces : Floats
        Forces (s, m) of the springs [N, N m].
    directions : Floats
        Directions (s, m, 6) of the springs, where those of planets' pins turn with the carrier; or
        (m, 6), along and about axes that do so.
    """

    azimuths: Floats
    spring_names: tuple[str, ...]
    forces: Floats
    directions: Floats

    __repr__ = short_repr

    def of(self, name: str) -> Floats:
        """(s,) force of a spring, or of all slices of a mesh.

        Raises
        ------
        InputError
            There is no such spring.
        """
        return np.asarray(self.forces[:, springs_named(self.spring_names, name)].sum(axis=1))

    def resultant(self, name: str) -> Floats:
        """(s,) radial load of a bearing, whatever the kind of its stiffness [N]."""
        wrench = self.wrench(name)
        return np.hypot(wrench[:, 1], wrench[:, 2])

    def wrench(self, name: str) -> Floats:
        """(s, 6) force and moment of a bearing at its centre, see `System.wrench` [N, N m].

        Raises
        ------
        InputError
            There is no bearing of that name.
        """
        turned = np.broadcast_to(self.directions, (*self.forces.shape, 6))
        each = zip(turned, self.forces, strict=True)
        return np.array([wrench_of(self.spring_names, d, name, f) for d, f in each])

    def amplitudes(self, values: Floats) -> Floats:
        """Amplitudes of the orders 0P, 1P and so on, of values at equal steps of one turn."""
        found = np.abs(np.fft.rfft(values)) / len(values)
        found[1:] *= 2
        return np.asarray(found)


def over_a_turn(
    at: Callable[[float], System],
    loads: Callable[[System], Floats],
    azimuths: Floats,
    gaps: Mapping[str, float] | None = None,
    contacts: Sequence[str] = (),
) -> Turn:
    """Equilibria with the carrier at a series of azimuths, inertia left out.

    Parameters
    ----------
    at : callable
        Function from the azimuth [rad] to the system in the frame that stands still.
    loads : callable
        Function from that system to its load (n,), such as gravity, torque and hub moments.
    azimuths : ndarray, (s,)
        Equally spaced over a turn, its end left out [rad].
    gaps, contacts : mapping, sequence
        Gaps of springs by name, and names of springs that only press, see `static`.
    """
    forces, directions, names = [], [], None
    for azimuth in azimuths:
        system = at(float(azimuth))
        forces.append(static(system, loads(system), gaps, contacts).forces)
        directions.append(system.directions)
        names = system.spring_names
    angles = np.asarray(azimuths, dtype=float)
    return Turn(angles, names or (), np.array(forces), np.array(directions))


def load_sharing(forces: Floats) -> float:
    """K_gamma: the maximum load of a planet over the mean."""
    return float(np.max(forces) / np.mean(forces))
