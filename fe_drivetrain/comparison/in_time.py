"""How far what is computed in time is from its limit: over the step, and over harmonics.

A run in time has an account of its energy, whose error falls with the square of the step, and a
value of each quantity asked for, which has a limit as steps shorten. Where stiffnesses vary as a
square wave does, a Fourier series of it has a number of harmonics, and the value has another limit
as they grow. Both bands are grid convergence indices: of three steps, with the second order of the
methods expected and the first counted on; and of three numbers of harmonics, with the first order
of jumps expected and a quarter counted on, since each harmonic that comes in may meet a resonance.
The bands of a suddenly loaded mass on a mesh of random contact ratio, frequency, phase and damping
hold all of 120 peaks over the step, and 194 of 200 over the harmonics. Peaks must be those of
`peak_between`: nested steps sample a peak at the same instants, and agree on what they all miss.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison.convergence import SOLVER_ROUND_OFF, grid_convergence


def peak_between(values: ArrayLike) -> float:
    """The largest value of a smooth history, between samples: a parabola through three of them.

    Parameters
    ----------
    values : array_like, (n,)
        At even steps; of the smallest give ``-peak_between(-values)``.
    """
    y = np.asarray(values, dtype=np.float64)
    k = int(y.argmax())
    if k in (0, len(y) - 1):
        return float(y[k])
    before, at, after = y[k - 1 : k + 2]
    bend = before - 2.0 * at + after
    return float(at - (before - after) ** 2 / (8.0 * bend)) if bend < 0.0 else float(at)


class InTime(NamedTuple):
    """What one run in time gave.

    Attributes
    ----------
    values : mapping of str to float
        Value of each quantity, its unit in the key.
    energy_error : float
        Energy that appears from nowhere, over the largest, as of `Motion.relative_imbalance`.
    converged : bool
        Whether every step converged, where steps are iterated.
    """

    values: Mapping[str, float]
    energy_error: float
    converged: bool = True


@dataclass(frozen=True)
class ConvergenceInTime:
    """Runs with ever shorter steps, and with ever more harmonics at the shortest step.

    Attributes
    ----------
    steps : tuple of float
        Longest first [s].
    by_step : tuple of InTime
        One for each step, all harmonics.
    harmonics : tuple of int
        Fewest first; empty where nothing varies.
    by_harmonics : tuple of InTime
        One for each number of harmonics; the last is that of the shortest step.
    """

    steps: tuple[float, ...]
    by_step: tuple[InTime, ...]
    harmonics: tuple[int, ...] = ()
    by_harmonics: tuple[InTime, ...] = ()

    @property
    def finest(self) -> InTime:
        """Values of the shortest step and all harmonics."""
        return self.by_step[-1]

    @property
    def energy_error(self) -> float:
        """Energy error of the shortest step, over the largest energy."""
        return self.finest.energy_error

    @property
    def converged(self) -> bool:
        """Whether the steps of all runs converged."""
        return all(one.converged for one in (*self.by_step, *self.by_harmonics))

    def value(self, key: str) -> float:
        """The finest value of a quantity."""
        return self.finest.values[key]

    def step_band(self, key: str) -> float:
        """Half width of what the step leaves uncertain, in the unit of the quantity."""
        values = [one.values[key] for one in self.by_step]
        return grid_convergence(
            self.steps, values, expected_order=2.0, min_order=1.0, round_off=SOLVER_ROUND_OFF
        ).uncertainty

    def harmonics_band(self, key: str) -> float:
        """Half width of what the number of harmonics leaves uncertain; 0 where nothing varies."""
        if not self.harmonics:
            return 0.0
        sizes = [1.0 / count for count in self.harmonics]
        values = [one.values[key] for one in self.by_harmonics]
        return grid_convergence(
            sizes, values, expected_order=1.0, min_order=0.25, round_off=SOLVER_ROUND_OFF
        ).uncertainty

    def band(self, key: str) -> float:
        """Half width of both together."""
        return self.step_band(key) + self.harmonics_band(key)


def converge_in_time(
    run: Callable[[float, int], InTime], step: float, harmonics: int = 0
) -> ConvergenceInTime:
    """Run with the step, twice and four times it, and with a half and a quarter of the harmonics.

    Parameters
    ----------
    run : callable
        What a step [s] and a number of harmonics give.
    step : float
        The shortest [s].
    harmonics : int
        The most, 4 or more; 0 where no stiffness varies.

    Returns
    -------
    found : ConvergenceInTime

    Raises
    ------
    InputError
        There are too few harmonics for a series of them.
    """
    if harmonics and harmonics < 4:
        raise InputError(
            f"{harmonics} harmonics have no series of a quarter, a half and all of them: take 4 or "
            "more, or 0 where no stiffness varies"
        )
    steps = (4.0 * step, 2.0 * step, step)
    by_step = tuple(run(dt, harmonics) for dt in steps)
    counts = (harmonics // 4, harmonics // 2, harmonics) if harmonics else ()
    by_harmonics = (*(run(step, count) for count in counts[:-1]), by_step[-1]) if counts else ()
    return ConvergenceInTime(steps, by_step, counts, by_harmonics)
