"""Frequency response to loads and to meshes; crossings of natural frequencies with orders."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.mesh_errors import harmonic_of
from fe_drivetrain.dynamics.bodies.meshing import Meshing
from fe_drivetrain.dynamics.bodies.modes import Complex, SystemModes, turning_modes
from fe_drivetrain.dynamics.bodies.system import System, springs_named
from fe_drivetrain.dynamics.torsion.orders import crossing_speed


def frequency_response(
    system: System, load: Floats, frequencies: ArrayLike, speed: float = 0.0
) -> Complex:
    """Motions for a harmonic load, by the whole matrices.

    Parameters
    ----------
    system : System
        System with the damping of its springs.
    load : ndarray, (n,)
        Amplitude [N, N m].
    frequencies : array_like, (s,)
        Frequencies [Hz]; none of them that of an undamped mode.
    speed : float
        Reference speed [rad/s].

    Returns
    -------
    ndarray, (s, n)
        Complex amplitudes of the degrees of freedom [m, rad].
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
    """Frequency response by modes, with one damping ratio for all and the highest modes left out.

    Parameters
    ----------
    modes : SystemModes
        Modes of the system at rest.
    load : ndarray, (n,)
        Amplitude of the load [N, N m].
    frequencies : array_like, (s,)
        Frequencies, above zero [Hz].
    ratio : float
        Damping over critical damping.
    count : int, optional
        Number of modes from the lowest; all where left out.
    """
    w = 2 * np.pi * np.atleast_1d(np.asarray(frequencies, dtype=float))[:, None]
    own = 2 * np.pi * modes.frequencies[:count]
    shapes = modes.shapes[:, :count]
    q = (shapes.T @ load) / (own**2 - w**2 + 2j * ratio * own * w)
    return np.asarray(q @ shapes.T)


@dataclass(frozen=True)
class MeshResponse:
    """Steady vibration that meshes excite, of one harmonic of the mesh frequency.

    Attributes
    ----------
    frequencies : ndarray, (s,)
        Frequencies of the vibration [Hz].
    motions : ndarray, (s, n)
        Complex amplitudes of the degrees of freedom [m, rad].
    forces : ndarray, (s, m)
        Complex amplitudes of the forces of all springs with their dampers [N, N m], beside those of
        the mean load.
    """

    frequencies: Floats
    motions: Complex
    forces: Complex

    __repr__ = short_repr


def mesh_response(
    system: System,
    meshing: Mapping[str, Meshing],
    frequencies: ArrayLike,
    order: int = 1,
    *,
    still: Floats | None = None,
    speed: float = 0.0,
    damping: float = 0.0,
) -> MeshResponse:
    """Frequency response to transmission errors, and to stiffness that varies under a mean load.

    To first order in both, a mesh with the mean k, the course k (1 + kappa), the error e and the
    mean elongation delta is a linear one under the load k (e - kappa delta) + c e' along its row:
    the static transmission error under load excites (Gregory, Harris and Munro 1963).

    Parameters
    ----------
    system : System
        System whose meshes have their mean stiffness.
    meshing : Mapping[str, Meshing]
        Meshes of one frequency that excite, with their phases and errors; their own frequencies do
        not count.
    frequencies : array_like, (s,)
        Frequencies of these meshes [Hz].
    order : int
        Number of the harmonic.
    still : ndarray, (n,), optional
        Motions under the mean load, see `wind_up`: courses of stiffness count; without, errors
        alone excite.
    speed : float
        Reference speed, for gyroscopic terms [rad/s].
    damping : float
        Damping as in `varying_equations`: C is this time [s] times the stiffness of the springs,
        beside their dampers.

    Returns
    -------
    response : MeshResponse

    Raises
    ------
    InputError
        A mesh is not in the system, was eliminated with a body without mass, or has no error; or
        errors do not all repeat with their meshes in the same way.
    """
    s, at = system, np.atleast_1d(np.asarray(frequencies, dtype=np.float64))
    turns = {mesh.error.turns for mesh in meshing.values() if mesh.error is not None}
    turns |= set() if still is None else {1.0}
    if len(turns) != 1 or (still is None and any(m.error is None for m in meshing.values())):
        raise InputError(
            "meshes of one frequency response must all have errors with the same number of periods "
            "per mesh period, 1 where stiffness varies, too: leave the others out"
        )
    each = turns.pop()
    e, kappa = (np.zeros(len(s.spring_names), dtype=complex) for _ in range(2))
    for name, mesh in meshing.items():
        of = springs_named(s.spring_names, name, "mesh")
        for i in of:
            s.changeable(s.spring_names[i])
        turned = np.exp(2j * np.pi * order * each * mesh.phase)
        if mesh.error is not None:
            own = np.exp(2j * np.pi * order * mesh.error.phase)
            e[of] = mesh.error.harmonic(order) * own * turned
        if still is not None:
            kappa[of] = harmonic_of(mesh.wave()[:, 0], order) * turned
    wound = 0.0 if still is None else s.stiffness * (s.rows @ still) * kappa
    f = at * order * each
    omega = 2.0 * np.pi * f[:, None]
    along = s.stiffness + 1j * omega * (s.damping + damping * s.stiffness)
    K = s.K - speed**2 * s.centripetal
    C = s.C + damping * (s.rows.T @ (s.stiffness[:, None] * s.rows)) + speed * s.gyroscopic
    whole = K - omega[..., None] ** 2 * s.mass + 1j * omega[..., None] * C
    q = np.linalg.solve(whole, ((along * e - wound) @ s.rows)[..., None])[..., 0]
    return MeshResponse(f, np.asarray(q), np.asarray(along * (q @ s.rows.T - e) + wound))


@dataclass(frozen=True)
class Crossing:
    """Crossing of a harmonic of an order with a natural frequency.

    Attributes
    ----------
    order : str
        Name of the order, such as "stage 2 mesh".
    harmonic : int
        Multiple of it.
    frequency : float
        Frequency [Hz].
    speed : float
        Speed of the rotor [rad/s].
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
        Minimum and maximum speed of the rotor [rad/s].
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
