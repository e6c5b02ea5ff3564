"""Frequency response, and crossings of natural frequencies with orders of the rotor's speed."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.dynamics.modes import Complex, SystemModes, turning_modes
from fe_drivetrain.dynamics.system import System
from fe_drivetrain.torsion.orders import crossing_speed


def frequency_response(
    system: System, load: Floats, frequencies: ArrayLike, speed: float = 0.0
) -> Complex:
    """Motions for a harmonic load, by the whole matrices.

    Parameters
    ----------
    system : System
        With the damping of its springs.
    load : ndarray, (n,)
        Amplitude [N, N m].
    frequencies : array_like, (s,)
        [Hz]; none of them that of an undamped mode.
    speed : float
        Reference speed [rad/s].

    Returns
    -------
    ndarray, (s, n)
        [m, rad].
    """
    omega = 2 * np.pi * np.atleast_1d(np.asarray(frequencies, dtype=float))[:, None, None]
    K = system.K - speed**2 * system.centripetal
    C = system.C + speed * system.gyroscopic
    dynamic = K - omega**2 * system.mass + 1j * omega * C
    right = np.broadcast_to(load[:, None], (len(omega), len(load), 1))
    return np.asarray(np.linalg.solve(dynamic, right)[..., 0])


def modal_response(
    modes: SystemModes, load: Floats, frequencies: ArrayLike, ratio: float, count: int | None = None
) -> Complex:
    """The same by modes, with one damping ratio for all and the highest modes left out.

    Parameters
    ----------
    modes : SystemModes
        Of the system at rest.
    load : ndarray, (n,)
        Amplitude [N, N m].
    frequencies : array_like, (s,)
        Above zero [Hz].
    ratio : float
        Of critical damping.
    count : int, optional
        Number of modes from the lowest; all where left out.
    """
    w = 2 * np.pi * np.atleast_1d(np.asarray(frequencies, dtype=float))[:, None]
    own = 2 * np.pi * modes.frequencies[:count]
    shapes = modes.shapes[:, :count]
    q = (shapes.T @ load) / (own**2 - w**2 + 2j * ratio * own * w)
    return np.asarray(q @ shapes.T)


@dataclass(frozen=True)
class Crossing:
    """Where a harmonic of an order meets a natural frequency.

    Attributes
    ----------
    order : str
        Name of the order, such as "stage 2 mesh".
    harmonic : int
        Multiple of it.
    frequency : float
        [Hz].
    speed : float
        Of the rotor [rpm].
    mode : int
        Number of the frequency, from 0.
    """

    order: str
    harmonic: int
    frequency: float
    speed: float
    mode: int


def crossings(
    frequencies: ArrayLike,
    orders: Mapping[str, float],
    speeds: tuple[float, float],
    harmonics: Iterable[int] = (1, 2, 3),
) -> list[Crossing]:
    """All crossings within a range of speeds, by order, harmonic and frequency.

    Parameters
    ----------
    frequencies : array_like, (n,)
        Natural, that do not change with the speed [Hz].
    orders : mapping of str to float
        Cycles in a turn of the rotor.
    speeds : tuple of float
        Least and largest of the rotor [rpm].
    harmonics : iterable of int
        Multiples of each order.
    """
    found = []
    for name, order in orders.items():
        for harmonic in harmonics:
            for mode, frequency in enumerate(np.asarray(frequencies, dtype=float)):
                speed = crossing_speed(float(frequency), order * harmonic)
                if speeds[0] <= speed <= speeds[1]:
                    found.append(Crossing(name, harmonic, float(frequency), speed, mode))
    return found


def speed_diagram(system: System, speeds: ArrayLike) -> list[Floats]:
    """Undamped frequencies [Hz] in the system's frame at each reference speed [rad/s]."""
    return [
        turning_modes(system, float(speed), damped=False).frequencies
        for speed in np.atleast_1d(np.asarray(speeds, dtype=float))
    ]
