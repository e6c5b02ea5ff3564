"""A drivetrain driven by a history, in pieces of bounded memory: of hub loads, or of its base.

What a file has at the hub is what the shaft feels there. The rotor's inertia stands before it, so
the torque that drives the rotor is that of the shaft and what speeds the rotor up, ``Mx + J w'``,
with the speed w of the file. Across the axis the loads at the hub hold what the rotor's mass takes,
its weight, too: a rotor that swung on the main bearings beside them would be there twice, so it
keeps its polar inertia alone. The generator
has the file's own torque, held to the file's speed by a line so weak that it answers in some
seconds: gear ratios and inertias of file and drivetrain are never quite the same, and the speed
would drift. A file without the generator's torque gets a line of slip about its own speed.

A history of the base moves what turns steadily under rated torque.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.equations import Equations, Loads, SpringLaws, summed, varying
from fe_drivetrain.dynamics.bodies.levels import Level, assembly
from fe_drivetrain.dynamics.time.base_motion import base_acceleration, on_base
from fe_drivetrain.dynamics.time.energy_account import WORK
from fe_drivetrain.dynamics.time.integration import equal_steps
from fe_drivetrain.dynamics.time.machines import slip_line
from fe_drivetrain.dynamics.time.mechanism import Act
from fe_drivetrain.dynamics.time.motion import Motion, State
from fe_drivetrain.dynamics.time.running import Running
from fe_drivetrain.dynamics.time.steady_turning import with_laws
from fe_drivetrain.procedure.steady_running import steady_run, wound_up
from fe_drivetrain.turbine_loads.hub_loads.base_history import BaseHistory
from fe_drivetrain.turbine_loads.hub_loads.drive_history import DriveHistory

HOLD = 10.0
"""Time in which the generator's line brings the speed back to that of the file [s]."""

AT_ONCE = 10_000
"""Steps of a piece."""


@dataclass(frozen=True)
class Operation:
    """A machine driven by a history.

    Attributes
    ----------
    of : Running
        The machine.
    equations : Equations
        Equations of motion with the generator's line.
    loads : Loads
        All loads over time.
    start : State
        State wound up under the first sample.
    end : float
        Time of the last sample [s].
    """

    __repr__ = short_repr

    of: Running
    equations: Equations
    loads: Loads
    start: State
    end: float

    def pieces(self, step: float, until: float | None = None) -> Iterator[Motion]:
        """The motion piece by piece, each from the end of the one before.

        Parameters
        ----------
        step : float
            Length of equal steps [s].
        until : float, optional
            Time at which to end, the last sample's where left out [s].
        """
        state, rollers = self.start, self.of.rollers
        acting: list[Act] = [self.loads]
        if rollers is not None:
            acting.append(rollers.acting)
        steps = equal_steps(self.equations, acting, step)
        end = self.end if until is None else min(until, self.end)
        turning = self.of.turning
        while end - state.time > 0.5 * step:
            count = min(AT_ONCE, round((end - state.time) / step))
            found = steps.motion(state, count)
            yield found if rollers is None else rollers.felt(found)
            # turning back as a whole changes nothing, and keeps the digits of windings
            q = found.end.q
            angle = float(turning.to_rotor @ q) / float(turning.to_rotor @ turning.velocity)
            varies = self.equations.springs.turns.any()
            state = found.end if varies else replace(found.end, q=q - angle * turning.velocity)


class EnergyAccount:
    """The account of the energy of a motion in pieces."""

    def __init__(self) -> None:
        self._first: float | None = None
        self._before = np.zeros(3)
        self._most = self._largest = 0.0

    def add(self, piece: Motion) -> None:
        """Add a piece."""
        energies = piece.energies.copy()
        energies[:, WORK:] += self._before
        self._before = energies[-1, WORK:].copy()
        whole = replace(piece, energies=energies)
        self._first = float(whole.energy[0]) if self._first is None else self._first
        gained = whole.imbalance + whole.energy[0] - self._first
        self._most = max(self._most, float(np.abs(gained).max()))
        self._largest = max(self._largest, float(np.abs(energies).max()))

    @property
    def relative_imbalance(self) -> float:
        """Maximum imbalance over the maximum of the energies, as that of `Motion`."""
        return self._most / max(self._largest, 1e-300)


def operation(of: Running, history: DriveHistory, slip: float) -> Operation:
    """A machine driven by a history.

    Parameters
    ----------
    of : Running
        The machine at a level.
    history : DriveHistory
        What drives it.
    slip : float
        Slip of the generator's line at rated torque, where the file has no torque of it.
    """
    speed = _rotor_speed(of, history)
    law, pull = _generator(of, history, speed, slip)
    loads = summed(_at_hub(of, history, speed), pull, *of_weights(of, history, of.rotor_weight))
    equations = with_laws(of.equations, law)
    velocity = speed[0] / float(of.turning.to_rotor @ of.turning.velocity) * of.turning.velocity
    found = of.wind_up(equations, loads.at(history.time[0]), velocity)
    start = State(found.q, velocity, found.acceleration, float(history.time[0]))
    return Operation(of, equations, loads, start, float(history.time[-1]))


def shaken(of: Running, history: BaseHistory, slip: float) -> Operation:
    """A machine that turns steadily on a base that moves.

    Parameters
    ----------
    of : Running
        The machine at a level with all motions.
    history : BaseHistory
        Acceleration of the base; its velocity has no mean.
    slip : float
        Slip of the generator at rated torque.
    """
    from scipy.integrate import cumulative_trapezoid, trapezoid

    bodies = assembly(of.machine, of.level, flexible=of.flexible).bodies
    time, a = history.time, history.accelerations
    moved = a.any(axis=0)
    gained = cumulative_trapezoid(a[:, moved], time, axis=0, initial=0.0)
    velocity = -trapezoid(gained, time, axis=0) / history.seconds
    base = base_acceleration(on_base(of.system, bodies)[:, moved], time, a[:, moved], velocity)
    equations, acting = steady_run(of, slip)
    acting = [*acting, base.loads_on(equations)]
    turning, begin = of.turning.velocity, float(time[0])
    if of.rollers is None:
        start = wound_up(equations, acting, turning, begin)
    else:
        load = np.asarray(np.sum([one.at(begin) for one in acting], axis=0))
        found = of.wind_up(equations, load, turning, begin)
        start = State(found.q, turning, found.acceleration, begin)
    return Operation(of, equations, summed(*acting), start, float(time[-1]))


def _rotor_speed(of: Running, history: DriveHistory) -> Floats:
    """(n,) speed of the rotor: the file's, or the rated one [rad/s]."""
    if history.rotor_speed is not None:
        return history.rotor_speed
    if history.generator_speed is not None:
        return np.asarray(history.generator_speed / abs(of.turning.ratio))
    rated = float(of.turning.to_rotor @ of.turning.velocity)
    return np.full(len(history.time), rated)


def _at_hub(of: Running, history: DriveHistory, speed: Floats) -> Loads:
    """Loads of the file on the rotor, with what speeds its inertia up."""
    from scipy.interpolate import CubicSpline

    wrench = history.loads.copy()
    rate = np.asarray(CubicSpline(history.time, speed)(history.time, 1))
    wrench[:, 3] += of.machine.rotor.inertia * rate
    patterns = np.column_stack([of.system.load_on("rotor", unit) for unit in np.eye(6)])
    moved = patterns.any(axis=0)
    return varying(patterns[:, moved], history.time, wrench[:, moved])


def _generator(
    of: Running, history: DriveHistory, speed: Floats, slip: float
) -> tuple[SpringLaws, Loads]:
    """The generator's line, and its load over time."""
    turning = of.turning
    row, ratio = turning.to_generator, turning.ratio
    if history.generator_torque is None:
        slope = abs(turning.generator_torque / (slip * turning.generator_speed))
        # the line goes with the file's speed, through the torque of the shaft
        torque = history.torque / ratio
    else:
        slope = of.inertia / (HOLD * ratio**2)
        torque = _own_torque(history, ratio) * np.sign(ratio)
    law, _ = slip_line(row, 0.0, 0.0, slope)
    return law, varying(row, history.time, slope * ratio * speed - torque)


def _own_torque(history: DriveHistory, ratio: float) -> Floats:
    """(n,) torque of the file's generator, of the same power at the drivetrain's gear ratio."""
    assert history.generator_torque is not None
    if history.generator_speed is None or history.rotor_speed is None:
        return history.generator_torque
    of_file = float(history.generator_speed.mean() / history.rotor_speed.mean())
    return np.asarray(history.generator_torque * abs(of_file / ratio))


def of_weights(of: Running, history: DriveHistory, rotor_weight: float) -> list[Loads]:
    """Weights of all bodies; without the rotor's where the file's loads have it.

    Parameters
    ----------
    of : Running
        The machine at a level.
    history : DriveHistory
        What drives it.
    rotor_weight : float
        Weight of the rotor [N].
    """
    if of.level is Level.TORSIONAL or of.turning.beside is None:
        return []
    weights = of.turning.beside
    if history.has_all:
        lifted = np.array([0.0, 0.0, rotor_weight, 0.0, 0.0, 0.0])
        weights = weights + of.system.load_on("rotor", lifted)
    return [varying(weights, [0.0], [1.0])]
