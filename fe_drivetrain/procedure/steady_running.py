"""A drivetrain that turns steadily under rated torque: its loads, and its state wound up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.dynamics.bodies.equations import Equations, Loads, varying
from fe_drivetrain.dynamics.bodies.steady_state import wind_up
from fe_drivetrain.dynamics.time.motion import State
from fe_drivetrain.dynamics.time.running import Running
from fe_drivetrain.dynamics.time.steady_turning import with_laws

ROUNDS = 8
"""Rounds in which the phases of stiffnesses at the beginning are found: each leaves a fifth or
less of what the one before did."""


def steady_rotor(of: Running) -> Loads:
    """Rated torque on the rotor.

    Parameters
    ----------
    of : Running
        The machine at a level.
    """
    return varying(of.turning.to_rotor, [0.0], [of.turning.torque])


def steady_run(of: Running, slip: float) -> tuple[Equations, list[Loads]]:
    """Equations with the generator's line, and loads of turning steadily at rated torque.

    Parameters
    ----------
    of : Running
        The machine at a level.
    slip : float
        Slip of the generator at rated torque.
    """
    machine, pull = of.turning.line(slip)
    return with_laws(of.equations, machine), [steady_rotor(of), pull, *of.turning.loads()]


def wound_up(
    equations: Equations, acting: Sequence[Loads], velocity: Floats, time: float = 0.0
) -> State:
    """State without vibration under the loads at a time.

    Stiffnesses that go with an angle are those of the state itself, found by a few rounds with
    phases that stand.

    Parameters
    ----------
    equations : Equations
        Equations of motion.
    acting : sequence of Loads
        All loads.
    velocity : ndarray, (n,)
        Velocities of steady turning [m/s, rad/s].
    time : float
        The time [s].
    """
    load = np.sum([one.at(time) for one in acting], axis=0)
    s, q = equations.springs, np.zeros(len(velocity))
    for _ in range(ROUNDS if s.turns.any() else 1):
        stands = replace(s, phase=s.phase + s.turns @ q, turns=np.zeros_like(s.turns))
        found = wind_up(replace(equations, springs=stands), load, velocity)
        q = found.q
    return State(found.q, velocity, found.acceleration, time)
