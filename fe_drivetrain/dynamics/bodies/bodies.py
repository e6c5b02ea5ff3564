"""Rigid bodies with six degrees of freedom each, held, tied to each other or free."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.dynamics.bodies.springs import Spring
from fe_drivetrain.dynamics.bodies.system import System

ALL = frozenset(MOTIONS)
"""All six degrees of freedom of a body."""

PLANE = frozenset({"uy", "uz", "rx"})
"""Degrees of freedom of a gear that stays in its plane."""


@dataclass(frozen=True)
class Body:
    """A rigid body, symmetric about its axis along x, which is where it turns.

    Attributes
    ----------
    name : str
        Unique, without a space at its end.
    position : tuple[float, float, float]
        Centre of mass [m].
    mass : float
        Mass of the body [kg].
    polar : float
        Inertia about x through the centre [kg m^2].
    transverse : float
        Inertia about any axis across, through the centre [kg m^2].
    speed : float
        Speed at which it spins about x, over the reference speed of the system.
    free : frozenset[str]
        Degrees of freedom that it has of its own; others are held, or those of `tied_to`.
    tied_to : str or None
        Body that the degrees of freedom which are not free follow, as parts of one rigid body do;
        where none, they are held.
    """

    name: str
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    mass: float = 0.0
    polar: float = 0.0
    transverse: float = 0.0
    speed: float = 0.0
    free: frozenset[str] = ALL
    tied_to: str | None = None


def disc(mass: float, radius: float, width: float) -> tuple[float, float]:
    """Polar and transverse inertia of a solid disc [kg m^2]; radius and width [m]."""
    return mass * radius**2 / 2, mass * (3 * radius**2 + width**2) / 12


@dataclass(frozen=True)
class Superelement:
    """A condensed elastic body between bodies, which it moves with at their centres.

    Attributes
    ----------
    name : str
        Name of the superelement in messages.
    bodies : tuple[str, ...]
        Names (k,) of the bodies that it joins.
    stiffness : Floats
        Stiffness (6 k, 6 k) [N/m, N, N m/rad].
    mass : Floats or None
        Mass (6 k, 6 k) [kg, kg m, kg m^2]; none where it has no mass.
    weight : Floats or None
        Forces and moments (6 k, 3) of its mass under a unit acceleration along x, y, z.
    """

    name: str
    bodies: tuple[str, ...]
    stiffness: Floats
    mass: Floats | None = field(default=None)
    weight: Floats | None = field(default=None)

    __repr__ = short_repr


def assemble(
    bodies: Sequence[Body],
    springs: Sequence[Spring],
    superelements: Sequence[Superelement] = (),
    frame_speed: float = 0.0,
) -> System:
    """One system of bodies, springs and superelements; what is held or tied is eliminated.

    In a frame that turns about x at ``frame_speed`` times the reference speed W, a body of mass m
    feels 2 m W x u' and -m W^2 u across the axis, and its tilt, with the absolute spin s W,
    (2 J_t - s J_p) W and (J_t - s J_p) W^2 in their place. In a frame at rest, it is -s J_p W alone
    (Lin and Parker 1999 for the former; Lalanne and Ferraris 1998, chapter 1, for a rotor at rest).

    Parameters
    ----------
    bodies : Sequence[Body]
        Bodies with names of their own; a tied body's host comes before it.
    springs : Sequence[Spring]
        Springs with names of their own.
    superelements : Sequence[Superelement]
        Dense stiffness and mass beside them.
    frame_speed : float
        Speed of the frame, over the reference speed: 1 for that of the carrier, 0 at rest.

    Raises
    ------
    InputError
        Names are used twice or are not known, or a mass or an inertia is negative.
    """
    names = [body.name for body in bodies]
    _check(bodies, names, springs)
    number = {name: k for k, name in enumerate(names)}
    labels = [f"{b.name} {m}" for b in bodies for m in MOTIONS if m in b.free]
    T = _motions(bodies, number, len(labels))
    M, G, Z = _inertias(bodies, frame_speed)
    extra, weight = np.zeros_like(M), np.zeros((len(M), 3))
    for element in superelements:
        at = np.concatenate([6 * number[name] + np.arange(6) for name in element.bodies])
        extra[np.ix_(at, at)] += element.stiffness
        if element.mass is not None:
            M[np.ix_(at, at)] += element.mass
        if element.weight is not None:
            weight[at] += element.weight
    rows = np.zeros((len(springs), 6 * len(bodies)))
    for i, spring in enumerate(springs):
        for name, part_row in spring.by.items():
            rows[i, 6 * number[name] : 6 * number[name] + 6] += part_row
    return System(
        tuple(labels),
        np.asarray(T.T @ M @ T),
        np.asarray(T.T @ G @ T),
        np.asarray(T.T @ Z @ T),
        np.asarray(rows @ T),
        np.array([spring.stiffness for spring in springs]),
        np.array([spring.damping for spring in springs]),
        tuple(spring.name for spring in springs),
        np.asarray(T.T @ extra @ T),
        tuple(names),
        T,
        np.array([body.mass for body in bodies]),
        np.asarray(T.T @ weight),
        np.array([spring.direction for spring in springs]).reshape(-1, 6),
    )


def _motions(bodies: Sequence[Body], number: Mapping[str, int], count: int) -> Floats:
    """(6 bodies, count) motion of all bodies for each free one; tied bodies follow their hosts."""
    T = np.zeros((6 * len(bodies), count))
    column = 0
    for k, body in enumerate(bodies):
        own = T[6 * k : 6 * k + 6]
        if body.tied_to is not None:
            host = number[body.tied_to]
            arm = np.subtract(body.position, bodies[host].position)
            own[:] = wrench_transport(arm).T @ T[6 * host : 6 * host + 6]
        for i, motion in enumerate(MOTIONS):
            if motion in body.free:
                own[i] = 0.0
                own[i, column] = 1.0
                column += 1
    return T


def _inertias(bodies: Sequence[Body], frame_speed: float) -> tuple[Floats, Floats, Floats]:
    """Mass, gyroscopic and centripetal matrices of all bodies."""
    M, G, Z = (np.zeros((6 * len(bodies),) * 2) for _ in range(3))
    for k, body in enumerate(bodies):
        part = slice(6 * k, 6 * k + 6)
        J, s, f = body.transverse, body.speed * body.polar, frame_speed
        M[part, part] = np.diag([body.mass] * 3 + [body.polar, J, J])
        across = np.diag([1.0, 1.0])
        turned = np.array([[0.0, -1.0], [1.0, 0.0]])
        move, tilt = slice(6 * k + 1, 6 * k + 3), slice(6 * k + 4, 6 * k + 6)
        G[move, move] = 2 * f * body.mass * turned
        Z[move, move] = f**2 * body.mass * across
        G[tilt, tilt] = (2 * f * J - s) * turned
        Z[tilt, tilt] = (f**2 * J - f * s) * across
    return M, G, Z


def _check(bodies: Sequence[Body], names: Sequence[str], springs: Sequence[Spring]) -> None:
    for kind, given in (("body", names), ("spring", [spring.name for spring in springs])):
        twice = {name for name in given if given.count(name) > 1}
        if twice:
            raise InputError(f"{kind} {min(twice)!r} is there twice: give each a name of its own")
    known: set[str] = set()
    for body in bodies:
        if body.tied_to is not None and body.tied_to not in known:
            raise InputError(
                f"body {body.name!r} is tied to {body.tied_to!r}, which must be a body before it: "
                "correct the name or the order"
            )
        for what, value in (
            ("mass [kg]", body.mass),
            ("polar inertia [kg m^2]", body.polar),
            ("transverse inertia [kg m^2]", body.transverse),
        ):
            if isinstance(value, bool) or not (np.isfinite(value) and value >= 0):
                raise InputError(
                    f"body {body.name!r}: {what} is {value:g} but must be a finite number of at "
                    "least 0: change it"
                )
        known.add(body.name)
    for spring in springs:
        missing = spring.by.keys() - known
        if missing:
            raise InputError(f"spring {spring.name!r} is on {min(missing)!r}, which is no body")
        for what, value in (("stiffness", spring.stiffness), ("damping", spring.damping)):
            if isinstance(value, bool) or not (np.isfinite(value) and value >= 0):
                raise InputError(
                    f"spring {spring.name!r}: {what} is {value:g} but must be a finite number of "
                    "at least 0: change it"
                )
