"""Steady whirl of a rotor by unbalance, forces on its bearings, and where the power goes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.whirl.rotor import Rotor, equations, hysteresis

Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Unbalance:
    """A mass times its distance from the axis, at a node.

    Attributes
    ----------
    node : int
        Number of the node.
    moment : float
        Mass times distance [kg m].
    angle : float
        Angle about the shaft [rad].
    """

    node: int
    moment: float
    angle: float = 0.0


@dataclass(frozen=True)
class UnbalanceResponse:
    """Steady whirl over the speed.

    Attributes
    ----------
    speeds : Floats
        (s,) speeds of the shaft [rad/s].
    amplitudes : Floats
        (s, n) half the longer axis of the ellipse of each node [m].
    forces : Floats
        (s, b) largest force across of each bearing, of stiffness and damping [N].
    power, absorbed, inner : Floats
        (s,) mean power of the unbalance, what bearings take of it, and what damping of the turning
        shaft takes; negative where that drives the whirl [W].
    swinging : Floats
        (s,) power that goes to and fro between springs and masses, at most [W].
    """

    speeds: Floats
    amplitudes: Floats
    forces: Floats
    power: Floats
    absorbed: Floats
    inner: Floats
    swinging: Floats

    __repr__ = short_repr


def balance_moment(grade: float, mass: float, speed: float) -> float:
    """Permissible residual unbalance [kg m]: e W = G (ISO 21940-11:2016, balance quality grade).

    Parameters
    ----------
    grade : float
        G, permissible speed of the centre of mass [m/s]: 6.3e-3 of G 6.3.
    mass : float
        Mass of the rotor [kg].
    speed : float
        Highest speed of service [rad/s].
    """
    return grade * mass / speed


def unbalance_response(
    rotor: Rotor, unbalances: Sequence[Unbalance], speeds: Sequence[float]
) -> UnbalanceResponse:
    """Steady whirl of a rotor by unbalance.

    Parameters
    ----------
    rotor : Rotor
        Rotor with its damping.
    unbalances : sequence of Unbalance
        What is off the axis.
    speeds : sequence of float
        Speeds of the shaft, above 0 [rad/s].
    """
    size = len(rotor.mass)
    rows = []
    for speed in speeds:
        at = equations(rotor, speed)
        D, K = at.rates, at.stiffness.astype(complex)
        if rotor.loss_factor:
            # forward whirl strains nothing as the shaft turns, so that backward alone is damped
            K += 0.5 * (hysteresis(rotor, True) + hysteresis(rotor, False))
        force = np.zeros(2 * size, dtype=complex)
        for one in unbalances:
            whole = one.moment * speed**2 * np.exp(1j * one.angle)
            force[2 * one.node] += whole
            force[size + 2 * one.node] += -1j * whole
        q = np.linalg.solve(K + 1j * speed * D - speed**2 * at.mass, force)
        rate = 1j * speed * q
        supported = at.supports @ q + at.absorbing @ rate
        inner = (K - at.supports) @ q + (D - at.absorbing) @ rate
        rows.append(
            (
                _longer_axis(q[:size:2], q[size::2]),
                _bearing_forces(rotor, q, speed),
                0.5 * np.vdot(rate, force).real,
                0.5 * np.vdot(rate, supported).real,
                0.5 * np.vdot(rate, inner).real,
                0.5 * float(np.abs(rate) @ (np.abs(K) @ np.abs(q))),
            )
        )
    parts = [np.array(one) for one in zip(*rows, strict=True)]
    return UnbalanceResponse(np.asarray(speeds, dtype=float), *parts)


def _longer_axis(a: Complex, b: Complex) -> Floats:
    """Half the longer axis of ellipses of motions Re(a e^iwt) and Re(b e^iwt) across each other."""
    return np.asarray((np.abs(a + 1j * b) + np.abs(a - 1j * b)) / 2)


def _bearing_forces(rotor: Rotor, q: Complex, speed: float) -> Floats:
    """(b,) largest force of each bearing across the axis [N]."""
    size, found = len(rotor.mass), []
    for bearing in rotor.bearings:
        first = 2 * bearing.node
        own = q[[first, first + 1, size + first, size + first + 1]]
        K, C = bearing.at(speed)
        force = (K + 1j * speed * C) @ own
        found.append(float(_longer_axis(force[0], force[2])))
    return np.array(found)
