"""Whirl over the speed: modes with their sense, critical speeds in two ways, stability."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import linalg
from scipy.optimize import brentq

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import diagonal_roots
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.modes import likest_shapes
from fe_drivetrain.dynamics.whirl.rotor import Rotor, equations, hysteresis

Complex = NDArray[np.complex128]

FORWARD, BACKWARD, STRAIGHT = "forward", "backward", "neither"
SORTED = 0.1
"""Least share of whirl of one sense over the other, of all, at which a mode has that sense."""
SPEEDS = 48
"""Intervals of speed in which crossings and the loss of stability are looked for."""
GROWS = 1e-9
"""Negative damping ratio that is no round-off."""
RINGS = 0.5**0.5
"""Damping ratio from which a mode has no peak of resonance, and is left out."""
_HELD = 1e-13  # least eigenvalue of the stiffness of unit diagonal, below which a rotor is loose
_EXACT = 1e-12  # relative, of speeds


@dataclass(frozen=True)
class WhirlModes:
    """Modes of a rotor at a speed, by ascending frequency.

    Attributes
    ----------
    values : Complex
        Eigenvalues (k,) with a positive imaginary part, and a damping ratio below `RINGS` [1/s].
    shapes : Complex
        (4 n, k) motions of the first plane before those of the second.
    senses : Floats
        (k,) forward less backward whirl over both, by the mass: 1 forward, -1 backward.
    growth : float
        Largest negative damping ratio of any motion; 1 of what grows without turning, 0 without
        damping, and below zero where all is damped.
    """

    values: Complex
    shapes: Complex
    senses: Floats
    growth: float

    __repr__ = short_repr

    @property
    def frequencies(self) -> Floats:
        """(k,) damped frequencies [Hz]."""
        return np.asarray(self.values.imag / (2 * np.pi))

    @property
    def decrements(self) -> Floats:
        """(k,) logarithmic decrements, negative of what grows."""
        return np.asarray(-2 * np.pi * self.values.real / self.values.imag)


@dataclass(frozen=True)
class WhirlChart:
    """Modes of a rotor over the speed, each followed by its shape.

    Attributes
    ----------
    speeds : Floats
        (s,) speeds of the shaft, from 0 [rad/s].
    frequencies, decrements, senses : Floats
        (s, k) of each mode; NaN where it is lost. Senses at rest are NaN, since whirls of round
        shafts are pairs of equal frequency there.
    """

    speeds: Floats
    frequencies: Floats
    decrements: Floats
    senses: Floats

    __repr__ = short_repr


@dataclass(frozen=True)
class Critical:
    """A critical speed.

    Attributes
    ----------
    speed : float
        Speed of the shaft [rad/s].
    sense : float
        Forward less backward whirl over both.
    shape : Complex
        (4 n,) motions of the first plane before those of the second.
    """

    speed: float
    sense: float
    shape: Complex

    __repr__ = short_repr


def sense_word(sense: float) -> str:
    """Forward, backward, or neither of them."""
    if abs(sense) < SORTED or not np.isfinite(sense):
        return STRAIGHT
    return FORWARD if sense > 0 else BACKWARD


def whirl_modes(rotor: Rotor, speed: float, count: int | None = None) -> WhirlModes:
    """Modes of a rotor at a speed, with all damping.

    Eigenvalues are found as reciprocals, so that the lowest have all digits and motions without
    mass none; without damping from a Hermitian matrix, which never fails.

    Parameters
    ----------
    rotor : Rotor
        The rotor.
    speed : float
        Speed of the shaft, at least 0 [rad/s].
    count : int or None
        Number of the lowest modes; None for all.

    Raises
    ------
    InputError
        The rotor is not held across its axis.
    """
    at = equations(rotor, speed)
    _check_held(rotor, at.stiffness)
    if not is_damped(rotor):
        values, vectors = _conservative(at.mass, at.rates, at.stiffness)
        return WhirlModes(
            values[:count], vectors[:, :count], _senses(rotor, vectors[:, :count]), 0.0
        )
    if rotor.loss_factor:
        # whirl slower than the shaft, and faster, have different stiffness
        parts = [
            _solved(at.mass, at.rates, at.stiffness + hysteresis(rotor, faster), speed, faster)
            for faster in (False, True)
        ]
        values, vectors, loose = (np.concatenate(one, axis=-1) for one in zip(*parts, strict=True))
    else:
        values, vectors, loose = _solved(at.mass, at.rates, at.stiffness, speed, None)
    order = np.argsort(values.imag, kind="stable")
    values, vectors = values[order], vectors[:, order]
    growth = max(float((values.real / np.abs(values)).max(initial=-1.0)), *loose, -1.0)
    rings = -values.real < RINGS * np.abs(values)
    values, vectors = values[rings], vectors[:, rings]
    return WhirlModes(
        values[:count], vectors[:, :count], _senses(rotor, vectors[:, :count]), growth
    )


def is_damped(rotor: Rotor) -> bool:
    """Whether anything of a rotor damps."""
    return bool(
        rotor.viscous or rotor.loss_factor or any(one.damping.any() for one in rotor.bearings)
    )


def _conservative(M: Floats, G: Floats, K: Floats) -> tuple[Complex, Complex]:
    """Eigenvalues i w and shapes of M q'' + G q' + K q = 0 with a skew G, by ascending w.

    With K = L L^T, q = L^-T p and v = 1 / w, v^2 p = N p + v H p has the Hermitian matrix
    [[H, R], [R^T, 0]] of the eigenvalues v, where H = -i L^-1 G L^-T and R R^T = N = L^-1 M L^-T.
    """
    size = diagonal_roots(K.diagonal())
    L = size[:, None] * np.linalg.cholesky((K + K.T) / 2 / np.outer(size, size))

    def within(A: Floats) -> Floats:
        half = linalg.solve_triangular(L, A, lower=True)
        return np.asarray(linalg.solve_triangular(L, half.T, lower=True).T)

    masses, basis = np.linalg.eigh(within(M))
    R = basis * np.sqrt(np.clip(masses, 0.0, None))
    unit = float(np.sqrt(masses[-1]))
    H = -1j * within(G)
    whole = np.block([[H, R], [R.T, np.zeros_like(R)]]) / unit
    found, vectors = np.linalg.eigh((whole + whole.conj().T) / 2)
    n = len(M)
    kept = np.flatnonzero(found > 1e3 * n * np.finfo(float).eps)[::-1]
    shapes = linalg.solve_triangular(L, vectors[:n, kept], lower=True, trans=1)
    values = np.asarray(1j / (unit * found[kept]), dtype=np.complex128)
    return values, np.asarray(shapes, dtype=np.complex128)


def _solved(
    M: Floats, D: Floats, K: Floats | Complex, speed: float, faster: bool | None
) -> tuple[Complex, Complex, Floats]:
    """Eigenvalues that turn, their shapes, and 1 for one that grows without turning.

    With `faster`, whirl that is faster than the speed alone, or slower alone.
    """
    n = len(M)
    scale = 1 / diagonal_roots(np.where(np.abs(K.diagonal()) > 0, np.abs(K.diagonal()), 1.0))
    both = np.outer(scale, scale)
    inverse = np.linalg.inv(both * K)
    mass = inverse @ (both * M)
    size = float(np.sqrt(np.linalg.norm(mass, 2))) or 1.0

    def reciprocal(unit: float) -> tuple[Complex, Complex]:
        rates = -inverse @ (both * D) / unit
        found, vectors = np.linalg.eig(
            np.block([[np.zeros((n, n)), np.eye(n)], [-mass / unit**2, rates]])
        )
        return np.asarray(found * (unit / size), dtype=np.complex128), np.asarray(
            vectors, dtype=np.complex128
        )

    try:
        found, vectors = reciprocal(size)
    except np.linalg.LinAlgError:
        # the solver may go round on a matrix that is nearly a permutation: not with other units
        found, vectors = reciprocal(1.25 * size)
    unit = size
    least = 1e3 * n * np.finfo(float).eps
    turning = np.abs(found) > least
    values = 1.0 / (unit * found[turning])
    vectors = scale[:, None] * vectors[:n, turning]
    swings = values.imag > 1e-9 * np.abs(values)
    if faster is not None:
        swings &= (values.imag > speed) == faster
    real = values[np.abs(values.imag) <= 1e-9 * np.abs(values)].real
    loose = np.array([1.0 if np.any(real > 0) else -1.0])
    return np.asarray(values[swings]), np.asarray(vectors[:, swings]), loose


def _check_held(rotor: Rotor, K: Floats) -> None:
    """Refuse a rotor that moves across its axis without any stiffness."""
    own = (K + K.T) / 2
    size = np.where(own.diagonal() > 0, own.diagonal(), 1.0)
    unit = own / np.sqrt(np.outer(size, size))
    if np.linalg.eigvalsh(unit)[0] < _HELD:
        raise InputError(
            f"rotor {rotor.name!r} is not held across its axis: give bearings of its shaft, or of "
            "the bodies at its ends, stiffness along y and z and about them"
        )


def _senses(rotor: Rotor, shapes: Complex) -> Floats:
    """(k,) forward less backward whirl over both, by the mass."""
    a, b = np.split(shapes, 2)
    forward, backward = (
        np.einsum("ik,ij,jk->k", w.conj(), rotor.mass, w).real for w in (a + 1j * b, a - 1j * b)
    )
    return np.asarray((forward - backward) / (forward + backward))


def whirl_chart(rotor: Rotor, speeds: Sequence[float], count: int) -> WhirlChart:
    """Modes over the speed, each followed by its shape.

    Parameters
    ----------
    rotor : Rotor
        The rotor.
    speeds : sequence of float
        Speeds of the shaft, ascending and above 0 [rad/s].
    count : int
        Number of modes, the lowest at the first speed.
    """
    rest, first = whirl_modes(rotor, 0.0, count), whirl_modes(rotor, speeds[0], count)
    # strong damping may leave fewer at one of the speeds
    kept = min(len(rest.values), len(first.values))
    mass = np.asarray(np.kron(np.eye(2), rotor.mass), dtype=np.float64)
    rows = [(rest.frequencies[:kept], rest.decrements[:kept], np.full(kept, np.nan))]
    shapes = first.shapes[:, :kept]
    for speed in speeds:
        # more than asked for: one may come from above
        now = whirl_modes(rotor, speed, count + 8)
        of = likest_shapes(mass, shapes, now.shapes)
        known = of >= 0
        parts = (now.frequencies, now.decrements, now.senses)
        row = np.full((3, kept), np.nan)
        row[:, known] = [part[of[known]] for part in parts]
        rows.append((row[0], row[1], row[2]))
        shapes = shapes.copy()
        shapes[:, known] = now.shapes[:, of[known]]
    frequencies, decrements, senses = (np.array(one) for one in zip(*rows, strict=True))
    return WhirlChart(np.array([0.0, *speeds]), frequencies, decrements, senses)


def critical_speeds(rotor: Rotor, limit: float, order: float = 1.0) -> list[Critical]:
    """Undamped speeds at which whirl has a multiple of the speed, by one eigenproblem.

    With f = order times W, whirl obeys K q = W^2 (order^2 M - i order G) q, which is Hermitian: all
    criticals come at once. Where bearings change with the speed, each is the speed at which the
    critical of the bearings' stiffness there is the speed itself.

    Parameters
    ----------
    rotor : Rotor
        The rotor.
    limit : float
        Highest speed [rad/s].
    order : float
        Frequency of the whirl over the speed: 1 for unbalance.

    Raises
    ------
    InputError
        The rotor is not held across its axis.
    """
    if not rotor.changes:
        return [one for one in _frozen(rotor, 0.0, order) if one.speed <= limit]
    grid = _grid(rotor, limit)
    count = len(_frozen(rotor, 0.0, order))

    def beyond(k: int) -> Callable[[float], float]:
        return lambda speed: _frozen(rotor, speed, order)[k].speed - speed

    met = np.array([[one.speed - speed for one in _frozen(rotor, speed, order)] for speed in grid])
    found = []
    for k in range(count):
        for speed in _roots(beyond(k), grid, met[:, k]):
            found.append(_frozen(rotor, speed, order)[k])
    return sorted(found, key=lambda one: one.speed)


def _frozen(rotor: Rotor, speed: float, order: float) -> list[Critical]:
    """Criticals of the stiffness that bearings have at a speed."""
    quiet = _undamped(rotor)
    at = equations(quiet, speed)
    K = (at.stiffness + at.stiffness.T) / 2
    _check_held(rotor, K)
    gyroscopic = np.kron(np.array([[0.0, 1.0], [-1.0, 0.0]]), rotor.gyroscopic)
    speeds, shapes = synchronous(at.mass, gyroscopic, K, order)
    senses = _senses(rotor, shapes)
    return [Critical(float(speeds[k]), float(senses[k]), shapes[:, k]) for k in range(len(speeds))]


def synchronous(
    mass: Floats, gyroscopic: Floats, stiffness: Floats, order: float = 1.0
) -> tuple[Floats, Complex]:
    """Speeds W at which M q'' + W G q' + K q = 0 swings with order times W, and shapes.

    K q = W^2 (order^2 M - i order G) q: both matrices are Hermitian, and K holds all motions.

    Parameters
    ----------
    mass, gyroscopic, stiffness : ndarray, (n, n)
        Mass, gyroscopic matrix for 1 rad/s, which is skew, and stiffness.
    order : float
        Frequency over the speed.

    Returns
    -------
    speeds : ndarray, (k,)
        Ascending [rad/s].
    shapes : ndarray, (n, k)
        What swings as q exp(i order W t).
    """
    inertia = order**2 * mass - 1j * order * gyroscopic
    scale = 1 / diagonal_roots(stiffness.diagonal())
    both = np.outer(scale, scale)
    values, vectors = linalg.eigh(both * inertia, both * stiffness)
    kept = np.flatnonzero(values > 1e-13 * np.abs(values).max())[::-1]
    return 1 / np.sqrt(values[kept]), scale[:, None] * vectors[:, kept]


def chart_criticals(rotor: Rotor, limit: float, order: float = 1.0) -> list[Critical]:
    """Speeds at which an order crosses the undamped frequencies of the Campbell diagram.

    Beside `critical_speeds` a second way: the k-th frequency goes steadily with the speed, so that
    every crossing is between two speeds where it is on different sides of the order.

    Parameters
    ----------
    rotor : Rotor
        The rotor.
    limit : float
        Highest speed [rad/s].
    order : float
        Frequency of the whirl over the speed.
    """
    quiet, grid = _undamped(rotor), _grid(rotor, limit)
    solved = [whirl_modes(quiet, speed).values.imag for speed in grid]
    count = min(len(one) for one in solved)
    found = []

    def beyond(k: int) -> Callable[[float], float]:
        return lambda speed: float(whirl_modes(quiet, speed).values[k].imag) - order * speed

    for k in range(count):
        above = np.array([one[k] for one in solved]) - order * grid
        for speed in _roots(beyond(k), grid, above):
            modes = whirl_modes(quiet, speed)
            found.append(Critical(speed, float(modes.senses[k]), modes.shapes[:, k]))
    return sorted(found, key=lambda one: one.speed)


def stability_limit(rotor: Rotor, limit: float) -> float | None:
    """Lowest speed from which a whirl grows; None where all is damped up to the limit [rad/s].

    Parameters
    ----------
    rotor : Rotor
        Rotor with its damping.
    limit : float
        Highest speed that is looked at [rad/s].
    """

    def grows(speed: float) -> float:
        return whirl_modes(rotor, speed).growth - GROWS

    grid = _grid(rotor, limit)
    if grows(float(grid[0])) > 0:
        return 0.0
    for low, high in zip(grid[:-1].tolist(), grid[1:].tolist(), strict=True):
        if grows(high) > 0:
            return float(brentq(grows, low, high, xtol=_EXACT * limit, rtol=1e-10))
    return None


def _undamped(rotor: Rotor) -> Rotor:
    """The rotor without any damping."""
    bearings = tuple(replace(one, damping=np.zeros_like(one.damping)) for one in rotor.bearings)
    return replace(rotor, bearings=bearings, viscous=0.0, loss_factor=0.0)


def _grid(rotor: Rotor, limit: float) -> Floats:
    """Speeds from nearly 0 to a limit, among them those where bearings are stated."""
    own = [speed for bearing in rotor.bearings for speed in bearing.speeds if 0 < speed < limit]
    return np.unique([*np.linspace(1e-6 * limit, limit, SPEEDS + 1), *own])


def _roots(function: Callable[[float], float], grid: Floats, values: Floats) -> list[float]:
    """Zeros of a function between points of a grid where its sign changes."""
    found = []
    for low, high, one, two in zip(grid[:-1], grid[1:], values[:-1], values[1:], strict=True):
        if one > 0 >= two or one < 0 <= two:
            found.append(float(brentq(function, low, high, xtol=_EXACT * grid[-1], rtol=1e-13)))
    return found
