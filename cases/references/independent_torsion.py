"""Frequencies of torsional systems, independent of `fe_drivetrain.dynamics.torsion`."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import numpy as np
from scipy.optimize import brentq

from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics.torsion import Torsional


def holzer(
    inertias: Sequence[float] | Floats,
    springs: Sequence[float] | Floats,
    ground: float,
    omega: float,
) -> tuple[float, Floats]:
    """Torque left over at the end of a chain that swings at omega [rad/s], and its angles.

    The first angle is 1; each shaft's torque is what the inertias before it need (Holzer 1921,
    recalled): equilibrium, mass by mass. Nothing is left over at a frequency.
    """
    angle, torque = 1.0, 0.0
    angles: list[float] = [angle]
    for place, inertia in enumerate(inertias):
        torque += omega**2 * inertia * angle
        if place < len(springs):
            angle -= torque / springs[place]
            angles.append(angle)
    return torque - ground * angle, np.array(angles)


def holzer_frequencies(
    inertias: Sequence[float] | Floats, springs: Sequence[float] | Floats, ground: float = 0.0
) -> Floats:
    """All natural frequencies of a chain above zero [Hz]: roots of what Holzer's table leaves.

    Raises
    ------
    ValueError
        Not all were found between 1e-3 and 1e5 Hz.
    """

    def left(omega: float) -> float:
        return holzer(inertias, springs, ground, omega)[0]

    grid = 2 * np.pi * np.geomspace(1e-3, 1e5, 4001)
    values = [left(w) for w in grid]
    found = [
        brentq(left, a, b, xtol=1e-13, rtol=1e-14)
        for a, b, u, v in zip(grid, grid[1:], values, values[1:], strict=False)
        if np.sign(u) * np.sign(v) < 0
    ]
    if len(found) != len(inertias) - (ground == 0):
        raise ValueError(f"{len(found)} frequencies found of {len(inertias)} inertias")
    return np.array(found) / (2 * np.pi)


def two_mass_frequencies(
    rotor: float, generator: float, shaft: float, ground: float
) -> tuple[float, float]:
    """Both frequencies of two masses [Hz], the roots of the characteristic quadratic."""
    a = rotor * generator
    b = shaft * generator + (shaft + ground) * rotor
    root = np.sqrt(b**2 - 4 * a * shaft * ground)
    # the smaller root without cancellation
    high = (b + root) / (2 * a)
    low = shaft * ground / (a * high)
    return float(np.sqrt(low) / (2 * np.pi)), float(np.sqrt(high) / (2 * np.pi))


def modes_below(system: Torsional, frequency: float) -> int:
    """How many natural frequencies lie below one [Hz], exactly, by Sylvester's law of inertia.

    The count of negative pivots of K - omega^2 M, eliminated in rational arithmetic without any
    rounding; M and K are put together here from the parts, likewise.
    """
    square = (2 * Fraction(float(np.pi)) * Fraction(frequency)) ** 2
    names = system.names
    n = len(names)
    A = [[Fraction(0)] * n for _ in range(n)]
    for i, part in enumerate(system.inertias):
        A[i][i] -= square * Fraction(part.inertia)
    for element in system.elements:
        for one, by in element.winding.items():
            for two, also in element.winding.items():
                A[names.index(one)][names.index(two)] += (
                    Fraction(element.stiffness) * Fraction(by) * Fraction(also)
                )
    negative = 0
    for p in range(n):
        pivot = A[p][p]
        if pivot == 0:
            raise ValueError("a pivot vanishes: ask for another frequency")
        negative += pivot < 0
        for i in range(p + 1, n):
            factor = A[i][p] / pivot
            if factor:
                for j in range(p + 1, n):
                    A[i][j] -= factor * A[p][j]
    return negative


def certified(system: Torsional, frequencies: Floats, within: float = 1e-9) -> int:
    """How many of the frequencies [Hz] are none: with no such mode within a relative distance.

    Of every group of equal ones, as many modes must lie between its bounds as it has members; below
    the first bound, as many as came before.
    """
    wrong = 0
    values = np.sort(frequencies)
    for f in values[values > 0]:
        low, high = f * (1 - within), f * (1 + within)
        below = int(np.sum(values < low))
        inside = int(np.sum((values >= low) & (values <= high)))
        if (modes_below(system, low), modes_below(system, high)) != (below, below + inside):
            wrong += 1
    return wrong


def inverse_squares(system: Torsional) -> float:
    """Sum of 1 / omega^2 of a held system [s^2]: the trace of K^-1 M."""
    return float(np.trace(np.linalg.solve(system.K, system.M)))
