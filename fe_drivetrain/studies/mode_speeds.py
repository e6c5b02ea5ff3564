"""Natural frequencies over the speed of the rotor, and where excitations meet them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics import System, SystemModes, likest_modes, turning_modes
from fe_drivetrain.dynamics.bodies.modes import Complex
from fe_drivetrain.procedure import Excitation, Meeting, resonances

MARGIN_BEYOND = 1.2
"""Highest speed of a Campbell diagram, over the largest of operation."""


@dataclass(frozen=True)
class Campbell:
    """Natural frequencies at several speeds of the rotor.

    Attributes
    ----------
    speeds : Floats
        Speeds (s,) of the rotor, from 0 [rad/s].
    frequencies : Floats
        Frequencies (s, n) of all modes in the order at rest [Hz]; damped ones but at rest. NaN
        where a mode does not oscillate.
    ratios : Floats
        Damping ratios (s, n); 0 at rest, where damping does not count.
    """

    speeds: Floats
    frequencies: Floats
    ratios: Floats

    __repr__ = short_repr

    def only(self, modes: Bools) -> Campbell:
        """The same of some of the modes (n,) alone."""
        return Campbell(self.speeds, self.frequencies[:, modes], self.ratios[:, modes])

    def at(self, speed: float) -> Floats:
        """Frequencies (n,) at a speed [Hz], straight between those that were solved.

        Parameters
        ----------
        speed : float
            Speed of the rotor [rad/s].
        """
        last = len(self.speeds) - 1
        k = min(int(np.searchsorted(self.speeds, speed, side="right")), last) or 1
        low, high = self.speeds[k - 1], self.speeds[k]
        part = (speed - low) / (high - low)
        return np.asarray((1 - part) * self.frequencies[k - 1] + part * self.frequencies[k])


@dataclass(frozen=True)
class InOperation:
    """Modes while the rotor turns, and which excitations meet them; free motions left out.

    Attributes
    ----------
    speed : float or None
        Speed of the rotor of the frequencies [rad/s]; None where none is known.
    running : Floats
        Frequencies (n,) at that speed [Hz]; NaN of a mode that does not oscillate.
    damping : Floats
        Damping ratios (n,).
    campbell : Campbell or None
        Frequencies over the speed; None where none is known.
    meetings : tuple[Meeting, ...]
        Every excitation against every mode; empty where no range of speeds is known.
    """

    speed: float | None
    running: Floats
    damping: Floats
    campbell: Campbell | None
    meetings: tuple[Meeting, ...]

    __repr__ = short_repr


def in_operation(
    system: System,
    modes: SystemModes,
    excitations: Sequence[Excitation],
    speeds: tuple[float, float] | None,
    speed: float | None,
) -> InOperation:
    """Modes at the speeds of operation.

    Parameters
    ----------
    system : System
        System in the frame at rest.
    modes : SystemModes
        Its modes at rest.
    excitations : sequence of Excitation
        All that may excite.
    speeds : tuple of float or None
        Least and largest speed of the rotor in operation [rad/s].
    speed : float or None
        Speed of the frequencies in operation [rad/s]; None for the largest.
    """
    moving = modes.frequencies > 0.0
    at = speed if speed is not None or speeds is None else speeds[1]
    if at is None:
        own = modes.frequencies[moving]
        return InOperation(None, own, np.zeros_like(own), None, ())
    whole = campbell(system, modes, solved_speeds(speeds or (at, at), at))
    meetings: list[Meeting] = []
    if speeds is not None:
        meetings = resonances(excitations, modes, speeds, turning=followed(whole))
    only = whole.only(moving)
    row = int(np.flatnonzero(only.speeds == at)[0])
    return InOperation(at, only.frequencies[row], only.ratios[row], only, tuple(meetings))


def campbell(system: System, modes: SystemModes, speeds: Sequence[float]) -> Campbell:
    """Natural frequencies over the speed, each mode followed by its shape.

    Parameters
    ----------
    system : System
        System in the frame at rest.
    modes : SystemModes
        Its modes at rest.
    speeds : sequence of float
        Speeds of the rotor, ascending and above 0 [rad/s].

    Returns
    -------
    Campbell
        Modes at rest, and those at each speed with the gyroscopic terms of all spinning bodies and
        with the damping of the springs.
    """
    moving = np.flatnonzero(modes.frequencies > 0.0)
    shapes: Floats | Complex = modes.shapes[:, moving]
    rows, ratios = [modes.frequencies], [np.zeros_like(modes.frequencies)]
    for speed in speeds:
        turning = turning_modes(system, speed)
        of = likest_modes(system, shapes, turning)
        known = of >= 0
        frequencies = np.where(modes.frequencies > 0.0, np.nan, 0.0)
        damping = np.zeros_like(frequencies)
        frequencies[moving[known]] = turning.frequencies[of[known]]
        if system.damping.any():
            damping[moving[known]] = turning.ratios[of[known]]
        rows.append(frequencies)
        ratios.append(damping)
        # from here on each whirl is like itself
        shapes = np.where(known, turning.shapes[:, of], shapes)
    return Campbell(np.array([0.0, *speeds]), np.array(rows), np.array(ratios))


def followed(found: Campbell) -> Callable[[float], Floats]:
    """Frequencies (n,) of all modes [Hz] by the speed; one that is lost keeps that at rest.

    Parameters
    ----------
    found : Campbell
        Frequencies over the speed.
    """
    at_rest = found.frequencies[0]

    @cache
    def at(speed: float) -> Floats:
        frequencies = found.at(speed)
        return np.where(np.isnan(frequencies), at_rest, frequencies)

    return at


def solved_speeds(speeds: tuple[float, float], running: float) -> list[float]:
    """Speeds at which a Campbell diagram is solved: ends of operation, running, and beyond.

    Parameters
    ----------
    speeds : tuple of float
        Least and largest speed of the rotor in operation [rad/s].
    running : float
        Speed of the frequencies in operation [rad/s].
    """
    low, high = speeds
    every = {low, 0.5 * (low + high), high, running, MARGIN_BEYOND * high}
    return sorted(speed for speed in every if speed > 0.0)
