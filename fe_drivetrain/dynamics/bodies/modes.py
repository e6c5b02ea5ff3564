"""Natural and damped modes of a system, where their energy is, and of which kind they are."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import diagonal_roots, scaled_to_unit_diagonal
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.dynamics.torsion.system import Oscillations

Complex = NDArray[np.complex128]

_ALIKE = 0.1
"""Likeness that two pairs of modes may lose where they are exchanged, as whirls may be."""


@dataclass(frozen=True)
class SystemModes:
    """Undamped natural modes at rest.

    Attributes
    ----------
    names : tuple[str, ...]
        Names (n,) of the degrees of freedom.
    bodies, springs : tuple[str, ...]
        Names (b,) and (m,), in the order of the shares.
    frequencies : Floats
        Frequencies (n,), ascending [Hz]; exactly 0 where the system moves freely.
    shapes : Floats
        Mode shapes (n, n), a mode a column, ``shapes.T @ mass @ shapes`` is 1.
    strain_shares : Floats
        (m, n) share of each spring in the strain energy of each mode; 0 of free motion. What is
        left to 1 is in superelements.
    kinetic_shares : Floats
        (b, n) share of each body in the kinetic energy of each mode, that of a tied body in what
        it is tied to.
    """

    names: tuple[str, ...]
    bodies: tuple[str, ...]
    springs: tuple[str, ...]
    frequencies: Floats
    shapes: Floats
    strain_shares: Floats
    kinetic_shares: Floats

    def __repr__(self) -> str:
        """One line: how many, and the lowest and the highest of those that are not free."""
        stiff = self.frequencies[self.frequencies > 0]
        free = self.frequencies.size - stiff.size
        span = f"{stiff[0]:.4g} to {stiff[-1]:.4g} Hz" if stiff.size else "none"
        return f"<{stiff.size} modes of {len(self.bodies)} bodies: {span}; free motions: {free}>"

    @property
    def energy_shares(self) -> dict[str, Floats]:
        """By name of each body (kinetic) and spring (strain), (n,) shares in each mode.

        Slices of a mesh are taken together, and springs of one place: "LSS ux" is also in "LSS".
        """
        found = dict(zip(self.bodies, self.kinetic_shares, strict=True))
        for name, shares in zip(self.springs, self.strain_shares, strict=True):
            mesh, sliced, _ = name.partition(" slice ")
            place, _, direction = name.rpartition(" ")
            under = [mesh] if sliced else [name]
            if not sliced and direction in MOTIONS and place not in self.bodies:
                under.append(place)
            for key in under:
                found[key] = found[key] + shares if key in found else shares
        return found


def system_modes(system: System) -> SystemModes:
    """Undamped modes of a system that does not turn.

    Without superelements, frequencies are the singular values of ``sqrt(k) H`` over the root of the
    mass, which keeps the low ones of a system whose highest is thousands of times above. Motions
    without frequency come apart by direction, as far as they do: turning about x first, then moving
    along it, then the others.

    Raises
    ------
    InputError
        Something moves without any mass.
    """
    root = _mass_root(system)
    n = len(system.names)
    if np.any(system.extra):
        K = linalg.solve_triangular(root, system.K, lower=True)
        K = linalg.solve_triangular(root, K.T, lower=True)
        values, basis = np.linalg.eigh((K + K.T) / 2)
        omega = np.sqrt(np.clip(values, 0.0, None))
        omega[omega <= np.sqrt(n * np.finfo(float).eps) * omega.max(initial=0.0)] = 0.0
    else:
        wound = _wound(system, root)
        _, sizes, right = np.linalg.svd(wound, full_matrices=True)
        omega = np.zeros(n)
        omega[: len(sizes)] = sizes[:n]
        omega[omega <= max(wound.shape) * np.finfo(float).eps * omega.max(initial=0.0)] = 0.0
        order = np.argsort(omega, kind="stable")
        omega, basis = omega[order], right[order].T
    shapes = linalg.solve_triangular(root, basis, lower=True, trans=1)
    moving = omega > 0.0
    shapes[:, ~moving] = _by_direction(system, shapes[:, ~moving])
    elongations = system.rows @ shapes
    strain = np.zeros_like(elongations)
    strain[:, moving] = system.stiffness[:, None] * elongations[:, moving] ** 2 / omega[moving] ** 2
    energy = shapes * (system.mass @ shapes)
    kinetic = np.zeros((len(system.bodies), n))
    np.add.at(kinetic, system.body_of, energy)
    return SystemModes(
        system.names,
        system.bodies,
        system.spring_names,
        omega / (2 * np.pi),
        shapes,
        strain,
        kinetic,
    )


def spring_frequencies(system: System) -> Floats:
    """The frequencies of `system_modes`, of a system without superelements, and no more.

    Returns
    -------
    ndarray, (n,)
        Ascending [Hz]; what is 0 but for round-off as it comes.
    """
    sizes = np.linalg.svd(_wound(system, _mass_root(system)), compute_uv=False)
    missing = np.zeros(max(len(system.names) - len(sizes), 0))
    return np.sort(np.concatenate([missing, sizes])) / (2 * np.pi)


def _wound(system: System, root: Floats) -> Floats:
    """(m, n) sqrt(k) H over the root of the mass, whose singular values are the frequencies."""
    rows = np.sqrt(system.stiffness)[:, None] * system.rows
    return np.asarray(linalg.solve_triangular(root, rows.T, lower=True).T)


def _by_direction(system: System, free: Floats) -> Floats:
    """Motions of one frequency (n, k), of unit mass, combined so that each is of one direction.

    A solver combines them as its rounding says, which differs between processors.
    """
    parts = _directions(system)
    ranks = 1.0 * parts[AXIAL] + 2.0 * parts[LATERAL]
    ranked = free.T @ (ranks[:, None] * (system.mass @ free))
    return np.asarray(free @ np.linalg.eigh((ranked + ranked.T) / 2)[1])


def _mass_root(system: System) -> Floats:
    """Lower Cholesky factor of the mass."""
    empty = np.flatnonzero(system.mass.diagonal() <= 0)
    if empty.size:
        raise InputError(
            f"{system.names[int(empty[0])]} has no mass or inertia, so that it has no natural "
            "frequency: give it one, or hold or tie that degree of freedom"
        )
    size = diagonal_roots(system.mass.diagonal())
    scaled = scaled_to_unit_diagonal(system.mass)
    return np.asarray(size[:, None] * np.linalg.cholesky((scaled + scaled.T) / 2))


@dataclass(frozen=True)
class TurningModes(Oscillations):
    """Modes of a damped or turning system.

    Attributes
    ----------
    shapes : Complex
        Mode shapes (n, k), each of unit length.
    growing : Floats
        (j,) real eigenvalues above zero, of what diverges without oscillating [1/s].
    """

    shapes: Complex
    growing: Floats

    __repr__ = short_repr


def turning_modes(system: System, speed: float = 0.0, damped: bool = True) -> TurningModes:
    """Modes of M q'' + (C + W G) q' + (K - W^2 Z) q = 0.

    Parameters
    ----------
    system : System
        System with a mass for each degree of freedom.
    speed : float
        Reference speed W [rad/s].
    damped : bool
        Whether the damping of the springs counts.
    """
    root = _mass_root(system)

    def scaled(A: Floats) -> Floats:
        half = linalg.solve_triangular(root, A, lower=True)
        return np.asarray(linalg.solve_triangular(root, half.T, lower=True).T)

    K = scaled(system.K - speed**2 * system.centripetal)
    D = scaled(speed * system.gyroscopic + (system.C if damped else 0.0))
    n = len(K)
    # velocities are measured in units of a middle frequency, so that both halves compare
    unit = np.sqrt(np.linalg.norm(K, 2)) or 1.0
    A = np.block([[np.zeros((n, n)), unit * np.eye(n)], [-K / unit, -D]])
    values, vectors = np.linalg.eig(A)
    tiny = 1e3 * n * np.finfo(float).eps * unit
    # free motion is a double root of zero, which round-off spreads as its square root
    least = 10 * np.sqrt(n * np.finfo(float).eps) * unit
    swinging = np.flatnonzero(values.imag > least)
    swinging = swinging[np.argsort(values[swinging].imag)]
    shapes = linalg.solve_triangular(root, vectors[:n, swinging], lower=True, trans=1)
    real = values[(np.abs(values.imag) <= tiny) & (values.real > least)].real
    return TurningModes(
        np.asarray(values[swinging], dtype=np.complex128),
        np.asarray(shapes / np.linalg.norm(shapes, axis=0), dtype=np.complex128),
        np.sort(np.asarray(real, dtype=np.float64)),
    )


def likest_modes(system: System, shapes: Floats | Complex, turning: TurningModes) -> Ints:
    """For each shape the number of the mode of a turning system that is most like it.

    Each mode is taken once, so that the likeness of all pairs, by the mass, is the largest in sum.
    The two whirls of a shaft that is equally stiff in all planes are equally like both of its modes
    at rest: the slower one goes with the first.

    Parameters
    ----------
    system : System
        System of both.
    shapes : ndarray, (n, k)
        Shapes of modes at rest or at another speed, by ascending frequency.
    turning : TurningModes
        Modes at a speed.

    Returns
    -------
    ndarray, (k,)
        -1 where there is no mode left.
    """
    return likest_shapes(system.mass, shapes, turning.shapes)


def likest_shapes(mass: Floats, shapes: Floats | Complex, others: Floats | Complex) -> Ints:
    """For each shape the number of the other one that is most like it; see `likest_modes`.

    Parameters
    ----------
    mass : ndarray, (n, n)
        Mass, by which likeness is measured.
    shapes, others : ndarray, (n, k) and (n, m)
        Shapes, each by ascending frequency.

    Returns
    -------
    ndarray, (k,)
        -1 where there is none left.
    """
    from scipy.optimize import linear_sum_assignment

    sizes = [np.einsum("ij,ij->j", of.conj(), mass @ of).real for of in (shapes, others)]
    likeness = np.abs(shapes.conj().T @ (mass @ others)) ** 2 / np.outer(*sizes)
    found = np.full(shapes.shape[1], -1)
    rows, columns = linear_sum_assignment(likeness, maximize=True)
    found[rows] = columns
    for i, j in pairwise(rows):
        first, second = found[i], found[j]
        lost = likeness[i, first] + likeness[j, second] - likeness[i, second] - likeness[j, first]
        if first > second and lost < _ALIKE:
            found[i], found[j] = second, first
    return found


def divergence_speeds(system: System) -> Floats:
    """Speeds W [rad/s] above zero at which K - W^2 Z is singular, ascending.

    There an eigenvalue is zero: the frame's frequency of a whirl, and the beginning or end of a
    range of speeds where the undamped system may diverge.
    """
    values = linalg.eigvals(system.centripetal, system.K)
    real = values[(np.abs(values.imag) < 1e-9 * np.abs(values).max()) & (values.real > 0)].real
    least = 1e-12 * real.max(initial=0.0)
    return np.sort(1 / np.sqrt(np.asarray(real[real > least], dtype=np.float64)))


def distinct(frequencies: Floats, tolerance: float = 1e-6) -> list[tuple[float, int]]:
    """Frequencies and how often each is there.

    Parameters
    ----------
    frequencies : ndarray, (n,)
        Ascending.
    tolerance : float
        Relative, within which two are the same.
    """
    found: list[tuple[float, int]] = []
    for f in frequencies:
        if found and abs(f - found[-1][0]) <= tolerance * max(abs(f), 1e-300):
            found[-1] = (found[-1][0], found[-1][1] + 1)
        else:
            found.append((float(f), 1))
    return found


AXIAL, TORSIONAL, LATERAL, MIXED = "axial", "torsional", "lateral", "mixed"


def direction_kinds(system: System, modes: SystemModes, most: float = 0.9) -> list[str]:
    """For each mode, the direction that has most of its kinetic energy.

    "torsional" of turning about x, "axial" along it, "lateral" of moving and tilting across; those
    with less than ``most`` in any of them are "mixed". Shares are those of energy; a geared
    system's torsional modes may move its gears a little.
    """
    energy = modes.shapes * (system.mass @ modes.shapes)
    parts = _directions(system)
    shares = np.array([energy[part].sum(axis=0) for part in parts.values()])
    names = list(parts)
    return [
        names[int(column.argmax())] if column.max() >= most else MIXED
        for column in (shares / shares.sum(axis=0)).T
    ]


def _directions(system: System) -> dict[str, Bools]:
    """Which degrees of freedom (n,) are of each direction."""
    motions = np.array([name.rpartition(" ")[2] for name in system.names])
    axial, torsional = motions == "ux", motions == "rx"
    return {AXIAL: axial, TORSIONAL: torsional, LATERAL: ~(axial | torsional)}


ROTATIONAL, TRANSLATIONAL, PLANET, OTHER = "rotational", "translational", "planet", "no pure kind"


def planetary_kinds(
    system: System, modes: SystemModes, central: Sequence[str], within: float = 1e-6
) -> list[str]:
    """Motion of a planetary stage's central bodies in each mode (Lin and Parker 1999).

    In "rotational" ones (rotational-axial in three dimensions) they turn about x and move along it
    only; in "translational" ones (translational-tilting) they move and tilt across only; in
    "planet" modes they stand still. Modes of equal frequency are taken together.

    Parameters
    ----------
    system : System
        System with the stage's bodies.
    modes : SystemModes
        Modes of the system.
    central : sequence of str
        Names of carrier, ring and sun.
    within : float
        Share of kinetic energy below which a body counts as standing still.
    """
    energy = modes.shapes * (system.mass @ modes.shapes)
    shares: dict[bool, Floats] = {}
    for about in (True, False):
        chosen = [
            name.rpartition(" ")[0] in central and (name.endswith(("ux", "rx")) == about)
            for name in system.names
        ]
        shares[about] = energy[np.array(chosen)].sum(axis=0)
    kinds, start = [], 0
    scale = modes.frequencies.max(initial=1.0)
    groups = distinct(modes.frequencies + scale * 1e-9, 1e-7)
    for _, count in groups:
        part = slice(start, start + count)
        turning, moving = (bool(shares[about][part].max() > within) for about in (True, False))
        kind = {
            (True, False): ROTATIONAL,
            (False, True): TRANSLATIONAL,
            (False, False): PLANET,
            (True, True): OTHER,
        }[turning, moving]
        kinds += [kind] * count
        start += count
    return kinds
