"""Linear systems of bodies and springs: mass, gyroscopic terms, and a row for each spring.

A spring's elongation is ``h . q`` with its row h, so that K = sum k h h^T is symmetric, has no
negative stiffness, and is zero for every motion that no row feels. Beside the springs there may be
a dense stiffness, of superelements. In a frame that turns at the speed W about x, the motion obeys

    M q'' + (C + W G) q' + (K - W^2 Z) q = f

with the skew gyroscopic matrix G and the centripetal matrix Z, both for 1 rad/s.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_solve
from fe_drivetrain.common.short_repr import short_repr


def springs_named(names: Sequence[str], name: str, what: str = "spring") -> list[int]:
    """Numbers of the springs of that name, or of all slices of the mesh of that name.

    Parameters
    ----------
    names : sequence of str
        Names of all springs.
    name : str
        Name of a spring or a mesh.
    what : str
        Word for either in the message.

    Raises
    ------
    InputError
        There is none.
    """
    found = [k for k, n in enumerate(names) if n == name or n.startswith(f"{name} slice ")]
    if not found:
        raise InputError(f"no {what} {name!r}: use one of {', '.join(names[:40])}")
    return found


def wrench_of(names: Sequence[str], directions: Floats, name: str, forces: Floats) -> Floats:
    """(..., 6) force and moment of a bearing at its centre, see `System.wrench`.

    Parameters
    ----------
    names, directions : sequence of str, ndarray (m, 6)
        Names and directions of all springs.
    name, forces : str, ndarray (..., m)
        Name of the bearing, and forces of all springs [N, N m].
    """
    found = bearing_springs(names, name)
    if not found:
        ends = tuple(f" {motion}" for motion in (*MOTIONS, "1"))
        known = dict.fromkeys(n.rpartition(" ")[0] for n in names if n.endswith(ends))
        raise InputError(f"no bearing {name!r}: use one of {', '.join(list(known)[:40])}")
    return np.asarray(np.asarray(forces, dtype=float)[..., found] @ directions[found])


def bearing_springs(names: Sequence[str], name: str) -> list[int]:
    """Numbers of the springs of a bearing: "NAME ux" and so on, or "NAME 1" to "NAME 6".

    Parameters
    ----------
    names : sequence of str
        Names of all springs.
    name : str
        Name of the bearing.
    """
    own = {f"{name} {end}" for end in (*MOTIONS, *range(1, 7))}
    return [k for k, spring in enumerate(names) if spring in own]


@dataclass(frozen=True)
class System:
    """Bodies on springs.

    Attributes
    ----------
    names : tuple[str, ...]
        Names (n,) of the degrees of freedom, body and motion: "sun ux", ..., "sun rx".
    mass : Floats
        Mass matrix (n, n) [kg, kg m, kg m^2].
    gyroscopic : Floats
        Gyroscopic matrix (n, n), skew, for a reference speed of 1 rad/s [kg, kg m, kg m^2].
    centripetal : Floats
        Centripetal matrix (n, n) for a reference speed of 1 rad/s, taken off the stiffness [kg, kg
        m, kg m^2].
    rows : Floats
        Elongation (m, n) of each spring [m, or rad] by the degrees of freedom.
    stiffness : Floats
        Stiffness (m,) of each spring [N/m, or N m/rad].
    damping : Floats
        Damping (m,) of each spring [N s/m, or N m s/rad].
    spring_names : tuple[str, ...]
        Name (m,) of each spring.
    extra : Floats
        Stiffness (n, n) of superelements, dense.
    bodies : tuple[str, ...]
        Names (b,) of all bodies, those that are held or tied, too.
    expansion : Floats
        Motions (6 b, n) of all bodies by the degrees of freedom.
    body_mass : Floats
        Masses (b,) of the bodies [kg].
    weight : Floats
        Load (n, 3) of superelements under a unit acceleration along x, y, z.
    directions : Floats
        Direction (m, 6) of the force and moment of each spring at the point where its bodies meet;
        zeros of a spring that is on other motions.
    unchangeable : tuple[str, ...]
        Springs by whose stiffness motions without mass have been eliminated.
    """

    names: tuple[str, ...]
    mass: Floats
    gyroscopic: Floats
    centripetal: Floats
    rows: Floats
    stiffness: Floats
    damping: Floats
    spring_names: tuple[str, ...]
    extra: Floats
    bodies: tuple[str, ...]
    expansion: Floats
    body_mass: Floats
    weight: Floats
    directions: Floats
    unchangeable: tuple[str, ...] = ()

    __repr__ = short_repr

    @property
    def K(self) -> Floats:
        """(n, n) stiffness at rest [N/m, N, N m/rad]."""
        return np.asarray(self.rows.T @ (self.stiffness[:, None] * self.rows)) + self.extra

    @property
    def C(self) -> Floats:
        """(n, n) damping of the springs [N s/m, N s, N m s/rad]."""
        return np.asarray(self.rows.T @ (self.damping[:, None] * self.rows))

    def place(self, name: str) -> int:
        """Number of a degree of freedom.

        Raises
        ------
        InputError
            There is none of that name.
        """
        if name not in self.names:
            raise InputError(
                f"no degree of freedom {name!r}: use one of {', '.join(self.names[:40])}"
            )
        return self.names.index(name)

    def spring(self, name: str) -> int:
        """Number of a spring.

        Raises
        ------
        InputError
            There is none of that name.
        """
        if name not in self.spring_names:
            raise InputError(f"no spring {name!r}: use one of {', '.join(self.spring_names[:40])}")
        return self.spring_names.index(name)

    def changeable(self, name: str) -> int:
        """Number of a spring that may get another stiffness, a gap, or lose contact.

        Raises
        ------
        InputError
            There is none of that name, or a motion without mass was eliminated by its stiffness.
        """
        if name in self.unchangeable:
            raise InputError(
                f"spring {name!r} holds a body without mass, which was eliminated by its "
                "stiffness, and cannot change: make the system as assemble(a.bodies, a.springs, "
                "a.superelements) with a = assembly(machine, ...)"
            )
        return self.spring(name)

    def wrench(self, name: str, forces: Floats) -> Floats:
        """(..., 6) force and moment of a bearing at its centre, along and about x, y, z [N, N m].

        K u of the motion u of what it holds against what holds it, whether its stiffness is six
        numbers, whose springs are "NAME ux" and so on, or six rows, whose springs are "NAME 1" to
        "NAME 6" along the eigenvectors.

        Parameters
        ----------
        name : str
            Name of a bearing, a planet's pin or another bushing.
        forces : Floats
            Forces (..., m) of all springs [N, N m], as of `Static`, `Turn` or a motion in time.

        Raises
        ------
        InputError
            There is no bearing of that name.
        """
        return wrench_of(self.spring_names, self.directions, name, forces)

    def motion_of(self, body: str, q: Floats) -> Floats:
        """(6, ...) motion of a body that belongs to degrees of freedom (n, ...).

        Raises
        ------
        InputError
            There is no such body.
        """
        return np.asarray(self.expansion[self._rows_of(body)] @ q)

    def load_on(self, body: str, wrench: Floats) -> Floats:
        """(n,) generalised load of a force and moment (6,) at a body's centre [N, N m].

        Raises
        ------
        InputError
            There is no such body.
        """
        return np.asarray(self.expansion[self._rows_of(body)].T @ np.asarray(wrench, dtype=float))

    def gravity(self, acceleration: Floats) -> Floats:
        """(n,) load of a uniform acceleration (3,) on all bodies and superelements [N, N m]."""
        a, wrenches = np.asarray(acceleration, dtype=float), np.zeros((len(self.bodies), 6))
        wrenches[:, :3] = self.body_mass[:, None] * a
        return np.asarray(self.expansion.T @ wrenches.ravel() + self.weight @ a)

    @property
    def body_of(self) -> Ints:
        """(n,) number of the body that each degree of freedom belongs to."""
        return np.array([self.bodies.index(n.rpartition(" ")[0]) for n in self.names])

    def _rows_of(self, body: str) -> slice:
        if body not in self.bodies:
            raise InputError(f"no body {body!r}: use one of {', '.join(self.bodies)}")
        first = 6 * self.bodies.index(body)
        return slice(first, first + 6)


def with_stiffness(system: System, stiffness: dict[str, float]) -> System:
    """The system with other stiffnesses of some springs, by name [N/m, or N m/rad].

    Raises
    ------
    InputError
        A name is no spring, or one that cannot change.
    """
    values = system.stiffness.copy()
    for name, value in stiffness.items():
        values[system.changeable(name)] = value
    return replace(system, stiffness=values)


def with_proportional_damping(system: System, seconds: float) -> System:
    """The system with dampers of a time times the stiffness in all springs, as Rayleigh's second.

    A mode of frequency f then has the damping ratio pi f times that time.

    Parameters
    ----------
    system : System
        System without superelements, which have no dampers.
    seconds : float
        Damping over stiffness [s].

    Raises
    ------
    InputError
        The time is negative.
    """
    if not seconds >= 0:
        raise InputError(
            f"damping over stiffness is {seconds:g} s but must be at least 0 s: change it"
        )
    return replace(system, damping=seconds * system.stiffness)


def without_massless(system: System) -> System:
    """The system with what has no mass eliminated, which is exact for linear springs.

    Nodes of a shaft without mass follow what they are connected to; nothing may load them, and the
    springs on them may not change.
    """
    empty = system.mass.diagonal() <= 0
    if not empty.any():
        return system
    kept, gone = np.flatnonzero(~empty), np.flatnonzero(empty)
    K = system.K
    S = np.zeros((len(system.names), len(kept)))
    S[kept, np.arange(len(kept))] = 1.0
    held = K[np.ix_(gone, gone)]
    loose = gone[held.diagonal() <= 0]
    if loose.size:
        raise InputError(
            f"{system.names[int(loose[0])]} has neither mass nor stiffness: give it one, or hold it"
        )
    S[gone] = -scaled_solve(held, K[np.ix_(gone, kept)])

    def on(A: Floats) -> Floats:
        return np.asarray(S.T @ A @ S)

    held_by = np.flatnonzero(system.rows[:, gone].any(axis=1))
    return replace(
        system,
        unchangeable=tuple(system.spring_names[int(k)] for k in held_by),
        names=tuple(system.names[int(k)] for k in kept),
        mass=on(system.mass),
        gyroscopic=on(system.gyroscopic),
        centripetal=on(system.centripetal),
        rows=np.asarray(system.rows @ S),
        extra=on(system.extra),
        expansion=np.asarray(system.expansion @ S),
        weight=np.asarray(S.T @ system.weight),
    )
