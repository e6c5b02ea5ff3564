"""Torsional systems: inertias on elements that wind up, their frequencies, shapes and damping.

An element's winding is a sum of coefficients times angles, e = sum b_i theta_i: 1 and -1 of a shaft
between two inertias, ratios where gears mesh, a single 1 of a spring to the ground. With the
windings as rows of B, M = diag(J), K = B^T diag(k) B and C = B^T diag(c) B, so that a system is
symmetric, has no negative stiffness, and turns freely wherever nothing is wound up.

Natural frequencies are the singular values of diag(sqrt k) B diag(1 / sqrt J) rather than roots of
the eigenvalues of K: the lowest of a drivetrain is thousands of times below its highest, and
squaring costs half of the digits.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr

Complex = NDArray[np.complex128]

#: Frequency over the highest and the count of motions, in units of round-off, below which it is 0.
ROUND_OFF = 1e3


@dataclass(frozen=True)
class Inertia:
    """Something that turns with one angle.

    Attributes
    ----------
    name : str
        Unique in its system.
    inertia : float
        Moment of inertia about its axis [kg m^2].
    """

    name: str
    inertia: float


@dataclass(frozen=True)
class Element:
    """A spring and damper between inertias, or to the ground.

    Attributes
    ----------
    name : str
        Unique in its system.
    winding : Mapping[str, float]
        Name of each inertia that winds it up, and by how much for an angle of 1.
    stiffness, damping : float
        Torque per winding [N m/rad] and per its rate [N m s/rad].
    """

    name: str
    winding: Mapping[str, float]
    stiffness: float
    damping: float = 0.0


@dataclass(frozen=True)
class Torsional:
    """Inertias and what is between them.

    Raises
    ------
    InputError
        A name is used twice or unknown, or a number is out of its range.
    """

    inertias: tuple[Inertia, ...]
    elements: tuple[Element, ...]

    def __post_init__(self) -> None:
        if not self.inertias:
            raise InputError("a torsional system needs at least one inertia: add one")
        names = [*self.names, *(e.name for e in self.elements)]
        for name in names:
            if names.count(name) > 1:
                raise InputError(f"two parts of a torsional system are called {name!r}: rename one")
        for part in self.inertias:
            _check(f"inertia {part.name!r}", part.inertia, "kg m^2", zero=False)
        for element in self.elements:
            _check(f"stiffness of {element.name!r}", element.stiffness, "N m/rad", zero=True)
            _check(f"damping of {element.name!r}", element.damping, "N m s/rad", zero=True)
            for name, by in element.winding.items():
                if name not in self.names:
                    raise InputError(
                        f"element {element.name!r} is wound up by {name!r}, which is no inertia: "
                        f"use one of {', '.join(self.names)}"
                    )
                if not math.isfinite(by):
                    raise InputError(
                        f"element {element.name!r} is wound {by} for each angle of {name!r}, but "
                        "must be by a finite number: change it"
                    )

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the inertias, in their order."""
        return tuple(part.name for part in self.inertias)

    @property
    def J(self) -> Floats:
        """(n,) inertias [kg m^2]."""
        return np.array([part.inertia for part in self.inertias])

    @property
    def k(self) -> Floats:
        """(m,) stiffnesses of the elements [N m/rad]."""
        return np.array([element.stiffness for element in self.elements])

    @property
    def B(self) -> Floats:
        """(m, n) windings of the elements by the angles of the inertias."""
        return np.array(
            [[e.winding.get(name, 0.0) for name in self.names] for e in self.elements]
        ).reshape(len(self.elements), len(self.inertias))

    @property
    def M(self) -> Floats:
        """(n, n) [kg m^2]."""
        return np.diag(self.J)

    @property
    def K(self) -> Floats:
        """(n, n) [N m/rad]."""
        return np.asarray(self.B.T @ (self.k[:, None] * self.B))

    @property
    def C(self) -> Floats:
        """(n, n) [N m s/rad]."""
        c = np.array([element.damping for element in self.elements])
        return np.asarray(self.B.T @ (c[:, None] * self.B))

    def place(self, name: str) -> int:
        """Number of an inertia in the system.

        Raises
        ------
        InputError
            There is none of that name.
        """
        if name not in self.names:
            raise InputError(f"no inertia {name!r}: use one of {', '.join(self.names)}")
        return self.names.index(name)


def _check(what: str, value: float, unit: str, zero: bool) -> None:
    if isinstance(value, bool) or not (
        math.isfinite(value) and (value > 0 or (zero and value == 0))
    ):
        raise InputError(
            f"{what} is {value:g} {unit} but must be a finite number "
            f"{'of at least' if zero else 'above'} 0: change it"
        )


@dataclass(frozen=True)
class Modes:
    """Undamped natural modes.

    Attributes
    ----------
    names, elements : tuple[str, ...]
        Names of the inertias, and of the elements.
    frequencies : Floats
        Frequencies (n,), ascending [Hz]; exactly 0 where the system turns freely.
    shapes : Floats
        Mode shapes (n, n), a mode a column, ``shapes.T @ M @ shapes`` is 1; the entry of maximum
        size of each positive. Modes of equal frequency are any basis of theirs.
    stiffness_shares : Floats
        Share (m, n) of each element in the strain energy of each mode; 0 where nothing is wound.
    inertia_shares : Floats
        Share (n, n) of each inertia (row) in the kinetic energy of each mode.
    """

    names: tuple[str, ...]
    elements: tuple[str, ...]
    frequencies: Floats
    shapes: Floats
    stiffness_shares: Floats
    inertia_shares: Floats

    __repr__ = short_repr

    @property
    def energy_shares(self) -> dict[str, Floats]:
        """Shares (n,) in each mode, by name of each inertia (kinetic) and element (strain)."""
        return dict(
            zip(
                (*self.names, *self.elements),
                (*self.inertia_shares, *self.stiffness_shares),
                strict=True,
            )
        )

    @property
    def to_one(self) -> Floats:
        """Shapes with the entry of maximum size of each made 1."""
        return np.asarray(self.shapes / np.abs(self.shapes).max(axis=0))


def natural_modes(system: Torsional) -> Modes:
    """Undamped natural frequencies and mode shapes (Al-Hamadani 2018, Eq 4.38)."""
    root = np.sqrt(system.J)
    n = len(root)
    wound = np.sqrt(system.k)[:, None] * system.B / root
    _, values, basis = np.linalg.svd(wound, full_matrices=True)
    omega = np.zeros(n)
    omega[: len(values)] = values[:n]
    omega[omega <= max(wound.shape) * np.finfo(float).eps * omega.max(initial=0.0)] = 0.0
    order = np.argsort(omega, kind="stable")
    omega, basis = omega[order], basis[order].T
    largest = np.abs(basis / root[:, None]).argmax(axis=0)
    basis = basis * np.where(basis[largest, np.arange(n)] < 0, -1.0, 1.0)
    turning = omega > 0.0
    energy = (wound @ basis) ** 2
    shares = np.zeros_like(energy)
    shares[:, turning] = energy[:, turning] / omega[turning] ** 2
    return Modes(
        system.names,
        tuple(element.name for element in system.elements),
        omega / (2 * np.pi),
        basis / root[:, None],
        shares,
        np.asarray(basis**2),
    )


def resolved(frequencies: Floats, free: int) -> bool:
    """Whether all frequencies but those of free motions are above what round-off leaves of 0.

    Parameters
    ----------
    frequencies : ndarray, (n,)
        Ascending.
    free : int
        Number of motions that have a frequency of 0.
    """
    least = ROUND_OFF * len(frequencies) * float(np.finfo(float).eps)
    return len(frequencies) == free or bool(frequencies[free] > least * frequencies[-1])


def relative_sensitivities(system: Torsional) -> dict[str, Floats]:
    """d ln f / d ln p, (n,) by mode, of every stiffness and inertia p, by its name.

    From Rayleigh's quotient: half of an element's share in the strain energy, and minus half of an
    inertia's in the kinetic energy. 0 for free turning. Not defined one by one for modes of equal
    frequency.
    """
    modes = natural_modes(system)
    moving = modes.frequencies > 0.0
    found = {
        e.name: row / 2 for e, row in zip(system.elements, modes.stiffness_shares, strict=True)
    }
    for part, row in zip(system.inertias, modes.inertia_shares, strict=True):
        found[part.name] = np.where(moving, -row / 2, 0.0)
    return found


def frequency_bands(system: Torsional, relative: Mapping[str, float]) -> Floats:
    """Half width [Hz] of the band of each frequency, where inputs are known to a relative band.

    Parameters
    ----------
    system : Torsional
        System at its middle values.
    relative : Mapping[str, float]
        Half width over value, by the name of an element (its stiffness) or inertia.

    Returns
    -------
    (n,) of first order, all inputs at their worst at once.

    Raises
    ------
    InputError
        A name is not in the system.
    """
    found = relative_sensitivities(system)
    band = np.zeros(len(system.inertias))
    for name, width in relative.items():
        if name not in found:
            raise InputError(f"no part {name!r} in the system: use one of {', '.join(found)}")
        band += np.abs(found[name]) * abs(width)
    return np.asarray(band * natural_modes(system).frequencies)


def changed(system: Torsional, values: Mapping[str, float]) -> Torsional:
    """The system with other stiffnesses [N m/rad] and inertias [kg m^2], by name.

    Raises
    ------
    InputError
        A name is not in the system.
    """
    known = {*system.names, *(e.name for e in system.elements)}
    for name in values:
        if name not in known:
            raise InputError(f"no part {name!r} in the system: use one of {', '.join(known)}")
    return Torsional(
        tuple(replace(p, inertia=values.get(p.name, p.inertia)) for p in system.inertias),
        tuple(replace(e, stiffness=values.get(e.name, e.stiffness)) for e in system.elements),
    )


def damped(system: Torsional, dampings: Mapping[str, float]) -> Torsional:
    """The system with other dampings [N m s/rad], by the name of the element.

    Raises
    ------
    InputError
        A name is no element.
    """
    known = [e.name for e in system.elements]
    for name in dampings:
        if name not in known:
            raise InputError(f"no element {name!r}: use one of {', '.join(known)}")
    return Torsional(
        system.inertias,
        tuple(replace(e, damping=dampings.get(e.name, e.damping)) for e in system.elements),
    )


def referred(system: Torsional, speeds: Mapping[str, float]) -> Torsional:
    """System in other angles: that of each inertia over its speed ratio.

    An angle theta' = theta / s is that seen from a shaft that turns 1 / s as fast; its inertia is
    s^2 J (Al-Hamadani 2018, Eq 4.8-4.12), windings by it are s times as large. Frequencies stay.

    Parameters
    ----------
    speeds : Mapping[str, float]
        s by name of the inertia, 1 where none is given.
    """
    s = {name: speeds.get(name, 1.0) for name in system.names}
    return Torsional(
        tuple(Inertia(p.name, p.inertia * s[p.name] ** 2) for p in system.inertias),
        tuple(
            replace(e, winding={name: by * s[name] for name, by in e.winding.items()})
            for e in system.elements
        ),
    )


def chain(
    inertias: Iterable[Inertia],
    shafts: Iterable[tuple[str, float, float]],
    ground: tuple[str, float, float] | None = None,
) -> Torsional:
    """Inertias in a row.

    Parameters
    ----------
    inertias : Iterable[Inertia]
        n of them.
    shafts : Iterable[tuple[str, float, float]]
        Name, stiffness [N m/rad] and damping [N m s/rad] of the n - 1 between neighbours.
    ground : tuple[str, float, float] or None
        The same of a spring from the last to the ground.

    Raises
    ------
    InputError
        There is not one shaft less than inertias.
    """
    parts, given = tuple(inertias), tuple(shafts)
    if len(given) != len(parts) - 1:
        raise InputError(
            f"a chain of {len(parts)} inertias has {len(given)} shafts but must have one less than "
            "inertias: add or remove some"
        )
    between = [
        Element(name, {one.name: 1.0, two.name: -1.0}, k, c)
        for (name, k, c), (one, two) in zip(given, pairwise(parts), strict=True)
    ]
    if ground is not None:
        name, k, c = ground
        between.append(Element(name, {parts[-1].name: 1.0}, k, c))
    return Torsional(parts, tuple(between))


@dataclass(frozen=True)
class Oscillations:
    """Complex eigenvalues of what oscillates.

    Attributes
    ----------
    eigenvalues : Complex
        Eigenvalues (k,), imaginary parts above zero and ascending [1/s].
    """

    eigenvalues: Complex

    @property
    def frequencies(self) -> Floats:
        """Damped natural frequencies, Im / 2 pi [Hz]."""
        return np.asarray(self.eigenvalues.imag / (2 * np.pi))

    @property
    def ratios(self) -> Floats:
        """Damping ratios, -Re / |.|."""
        return np.asarray(-self.eigenvalues.real / np.abs(self.eigenvalues))


@dataclass(frozen=True)
class DampedModes(Oscillations):
    """Modes of the damped system.

    Attributes
    ----------
    creeping : Floats
        Real eigenvalues (j,) below zero, of what comes back without oscillating [1/s].
    """

    creeping: Floats


def damped_modes(system: Torsional) -> DampedModes:
    """Eigenvalues of M theta'' + C theta' + K theta = 0 (Al-Hamadani 2018, Eq 4.22).

    In the natural modes, the state matrix is [[0, W], [-W, -D]] with W the undamped frequencies and
    D the modal damping: nothing in it is larger than the highest frequency.
    """
    modes = natural_modes(system)
    n = len(modes.frequencies)
    W = np.diag(2 * np.pi * modes.frequencies)
    D = modes.shapes.T @ system.C @ modes.shapes
    found = np.linalg.eigvals(np.block([[np.zeros((n, n)), W], [-W, -D]]))
    tiny = 1e3 * n * np.finfo(float).eps * np.abs(found).max(initial=0.0)
    swinging = found[found.imag > tiny]
    real = found[(np.abs(found.imag) <= tiny) & (found.real < -tiny)].real
    return DampedModes(
        np.asarray(swinging[np.argsort(swinging.imag)], dtype=complex), np.sort(np.asarray(real))
    )


def modal_damping(system: Torsional) -> Floats:
    """Damping ratios of first order, phi^T C phi / (2 omega), (n,); NaN of free turning."""
    modes = natural_modes(system)
    omega = 2 * np.pi * modes.frequencies
    dissipated = np.einsum("im,ij,jm->m", modes.shapes, system.C, modes.shapes)
    return np.asarray(
        np.divide(dissipated, 2 * omega, out=np.full(len(omega), np.nan), where=omega > 0)
    )


def response(system: Torsional, at: str, frequencies: ArrayLike) -> Complex:
    """Angles [rad] for a harmonic torque of 1 N m at an inertia, (len(frequencies), n).

    Parameters
    ----------
    at : str
        Name of the inertia.
    frequencies : ArrayLike
        Frequencies [Hz]; none of them that of an undamped mode.
    """
    omega = 2 * np.pi * np.atleast_1d(np.asarray(frequencies, dtype=float))
    load = np.zeros(len(system.inertias))
    load[system.place(at)] = 1.0
    M, C, K = system.M, system.C, system.K
    w = omega[:, None, None]
    dynamic = K - w**2 * M + 1j * w * C
    return np.asarray(
        np.linalg.solve(dynamic, np.broadcast_to(load[:, None], (len(omega), len(load), 1)))[..., 0]
    )


def static_stiffness(system: Torsional, at: str, held: str) -> float:
    """Torque at one inertia over its angle, another held [N m/rad] (PROTEST 2010).

    Raises
    ------
    InputError
        The two are not connected, or something between them turns freely.
    """
    inside = [i for i in range(len(system.inertias)) if i != system.place(held)]
    row = inside.index(system.place(at)) if at != held else -1
    B = np.sqrt(system.k)[:, None] * system.B[:, inside]
    sizes = np.linalg.norm(B, axis=0)
    if row < 0 or not sizes.all() or np.linalg.matrix_rank(B / sizes) < len(inside):
        raise InputError(
            f"torque at {at!r} with {held!r} held meets no stiffness: name two inertias that are "
            "connected"
        )
    load = np.zeros(len(inside))
    load[row] = 1.0
    # K = B^T B, so that its inverse is R^-1 R^-T: without squaring
    turned = np.linalg.solve(np.linalg.qr(B)[1].T, load)
    return float(1.0 / (turned @ turned))
