"""Planets at their azimuth as carriers turn, in an event at about its rated speed.

The engine's travelling carriers turn at a steady speed, and displacements are from places that turn
with them. So the motion is the steady turning and a rest: what stands in the equations by velocity
(a generator's line, gyroscopic terms) gets the steady part as a load, and what goes with an angle
gets it as a frequency. The rest turns planets as far as the carrier is beside its steady azimuth,
which only shifts the azimuth that weights are taken at; beyond `FARTHEST` that is refused.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError, require_known
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics.bodies.equations import Equations, Loads, steady
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.dynamics.bodies.steady_state import free_motions, wind_up
from fe_drivetrain.dynamics.time.integration import Phase
from fe_drivetrain.dynamics.time.motion import Motion, State
from fe_drivetrain.dynamics.time.running import Running
from fe_drivetrain.dynamics.time.travelling import Travelling, TravellingCarriers, travelling
from fe_drivetrain.procedure.drivetrain_events import EVENTS, Planned

STAND, TRAVEL = "stand", "travel"
"""What planets do: stand at one azimuth, or travel with their carriers."""

FARTHEST = 0.35
"""How far a carrier may come beside its steady azimuth [rad]: a twentieth of a turn."""

_TURN = 1e-3
"""Azimuth over which the winding at the beginning is differentiated [rad]."""


def travels(event: str, planets: str, machine: Machine, level: Level | None = None) -> bool:
    """Whether planets travel in an event.

    Parameters
    ----------
    event : str
        Name of the event.
    planets : str
        "stand" or "travel".
    machine : Machine
        The machine whose planets these are.
    level : Level, optional
        The one level that is asked for.

    Raises
    ------
    InputError
        It is neither of these, the speed changes too far in the event, or there are no planets.
    """
    require_known("planets", planets, (STAND, TRAVEL))
    able = [name for name, kind in EVENTS.items() if kind.keeps_speed]
    if planets == TRAVEL and event not in able:
        raise InputError(
            f"planets travel at a speed that is kept, in {', '.join(able)}, but the speed changes "
            f"in {event}: let {argument('planets')} stand"
        )
    if planets == TRAVEL and not has_planets(machine, Level.RIGID if level is None else level):
        where = f" at the level {level.name.lower()}" if level is Level.TORSIONAL else ""
        raise InputError(
            f"{machine.title!r} has no planets that could travel{where}: let "
            f"{argument('planets')} stand"
        )
    return planets == TRAVEL


def has_planets(machine: Machine, level: Level) -> bool:
    """Whether a machine has planets with motions beside their carrier's at a level."""
    planetary = any(isinstance(stage, PlanetaryData) for stage in machine.stages)
    return planetary and level is not Level.TORSIONAL


def with_travelling_planets(of: Running, planned: Planned) -> Planned:
    """An event with planets that travel.

    Parameters
    ----------
    of : Running
        The machine that it is of, see `has_planets`.
    planned : Planned
        The event with planets at one azimuth, beginning at 0 s.
    """
    reference = of.turning.velocity
    speed = float(of.turning.to_rotor @ reference)
    carriers = travelling(of.machine, of.level, flexible=of.flexible)
    phases = []
    for phase in planned.phases:
        made = _beside_turning(phase.equations, reference)
        acting = [phase.acting] if isinstance(phase.acting, Loads) else list(phase.acting)
        held = steady(-phase.equations.C @ reference)
        turning = TravellingCarriers(carriers, speed)
        phases.append(Phase(phase.until, made, [*acting, held, turning]))
    start = _start(carriers, phases[0], of, speed)
    return replace(planned, phases=tuple(phases), start=start, reference=reference)


def _beside_turning(equations: Equations, reference: Floats) -> Equations:
    """Equations of what is beside a steady turning (n,) [rad/s, m/s]."""
    s = equations.springs
    moved = replace(
        s, frequency=s.frequency + s.turns @ reference, speed=s.speed + s.rows @ reference
    )
    return replace(equations, springs=moved)


def _start(carriers: Travelling, phase: Phase, of: Running, speed: float) -> State:
    """State wound up at azimuth 0, moving as the winding changes on from there."""
    acting = [phase.acting] if isinstance(phase.acting, Loads) else list(phase.acting)
    load = np.sum([one.at(0.0) for one in acting if isinstance(one, Loads)], axis=0)
    found = []
    for azimuth in (-_TURN, 0.0, _TURN):
        rows, extra, _ = carriers.at(azimuth)
        springs = phase.equations.springs
        springs = replace(springs, rows=np.vstack([rows, springs.rows[len(rows) :]]))
        there = replace(
            phase.equations,
            springs=springs,
            extra=phase.equations.extra - carriers.system.extra + extra,
        )
        q = wind_up(there, load, time=azimuth / speed).q
        free = free_motions(there)[:, 0]
        found.append(q - free * float(of.turning.to_rotor @ q / (of.turning.to_rotor @ free)))
    before, q, behind = found
    velocity = (behind - before) * speed / (2.0 * _TURN)
    return State(q, np.asarray(velocity), np.zeros(len(q)))


def with_turning(of: Running, motion: Motion, reference: Floats) -> Motion:
    """A motion beside a steady turning, with it.

    Parameters
    ----------
    of : Running
        The machine.
    motion : Motion
        What it did beside the turning, from 0 s on.
    reference : ndarray, (n,)
        Velocities of the turning.

    Raises
    ------
    InputError
        A carrier left its steady azimuth by more than `FARTHEST`.
    """
    beside = float(np.abs(motion.q @ of.turning.to_rotor).max())
    planetary = [
        abs(speed)
        for speed, stage in zip(of.machine.speeds, of.machine.stages, strict=False)
        if isinstance(stage, PlanetaryData)
    ]
    if max(planetary) * beside > FARTHEST:
        raise InputError(
            f"a carrier comes {max(planetary) * beside:.2g} rad beside its steady azimuth but "
            f"planets travel up to {FARTHEST:g} rad: end the event before, or let "
            f"{argument('planets')} stand"
        )
    return replace(
        motion,
        q=motion.q + np.outer(motion.times, reference),
        velocity=motion.velocity + reference,
    )
