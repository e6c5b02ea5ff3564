"""Stiffness of rolling bearings over the speed of a drivetrain, by the torque that it has there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file import Drivetrain
from fe_drivetrain.drivetrain_file.turning_parts import STEEL
from fe_drivetrain.dynamics import Machine, Operation, RollerMatrices, plain_rungs, roller_matrices
from fe_drivetrain.dynamics.bodies.machine import rated_torque
from fe_drivetrain.report.suite.records import Record

STEPS = 3
"""Speeds of operation at which rollers are put into equilibrium."""


@dataclass(frozen=True)
class RollerTables:
    """Stiffness of bearings by their rollers at some speeds.

    Attributes
    ----------
    speeds : Floats
        Speeds (k,) of the rotor, ascending [rad/s].
    torques : Floats
        Torques (k,) of the rotor there [N m].
    stiffness : Mapping of str to Floats
        (k, 6, 6) of each bearing [N/m, N, N m/rad].
    rows : tuple of Record
        Centrifugal force of a roller of each bearing at the largest speed, and what it is of the
        load of the most loaded one at most.
    """

    speeds: Floats
    torques: Floats
    stiffness: Mapping[str, Floats]
    rows: tuple[Record, ...]

    __repr__ = short_repr


def roller_tables(
    drivetrain: Drivetrain, machine: Machine, speeds: tuple[float, float]
) -> RollerTables:
    """Stiffness of gearbox bearings by their rollers over the speeds of operation.

    The torque goes with the square of the speed up to the rated torque at the largest speed, as of
    a rotor at its best tip speed ratio. A speed whose equilibrium is not found is left out.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    machine : Machine
        Its machine.
    speeds : tuple of float
        Least and largest speed of the rotor in operation [rad/s].

    Raises
    ------
    InputError
        No rated torque is known, no bearing has a catalogue entry, or rollers find no equilibrium
        at rated torque.
    """
    rated = rated_torque(drivetrain, machine)
    if rated is None:
        raise InputError(
            f"{drivetrain.title!r} states no torque at which rollers of bearings stand: give "
            "generator.rated_torque, or operation.rated_power and operation.rotor_speed"
        )
    rung, high = plain_rungs(drivetrain, machine)[-1], speeds[1]
    found: dict[float, RollerMatrices] = {}
    for speed in np.unique(np.linspace(*speeds, STEPS))[::-1].tolist():
        torque = rated.torque * (speed / high) ** 2
        try:
            found[speed] = roller_matrices(machine, rung, Operation(torque))
        except InputError:
            if speed == high:
                raise
    at = sorted(found)
    names = {row.name for row in machine.bearings} & found[high].stiffness.keys()
    return RollerTables(
        np.array(at),
        np.array([rated.torque * (speed / high) ** 2 for speed in at]),
        {name: np.array([found[speed].stiffness[name] for speed in at]) for name in sorted(names)},
        tuple(centrifugal_rows(machine, found[high], names, high)),
    )


def centrifugal_rows(
    machine: Machine, found: RollerMatrices, names: set[str], speed: float
) -> list[Record]:
    """Centrifugal forces of rollers, and their largest share of a roller's load.

    The cage turns at half of (1 - d cos(angle) / pitch diameter) of the shaft, the outer ring
    standing. A radial force F on Z rollers loads one of them with pi F / Z at least: all rollers of
    one half, equally loaded, carry Z / pi times as much as one.

    Parameters
    ----------
    machine : Machine
        The machine.
    found : RollerMatrices
        Equilibrium at the largest speed.
    names : set of str
        Names of bearings.
    speed : float
        Speed of the rotor [rad/s].
    """
    rows: list[Record] = []
    for seat, load in zip(found.found.seats, found.found.loads, strict=True):
        if seat.name not in names:
            continue
        row = seat.bearing.rows[0]
        turn = abs(_ratio(machine, seat.name)) * speed
        cage = turn / 2 * (1 - row.diameter * np.cos(row.angle) / (2 * row.radius))
        length = getattr(row, "length", 2 * row.diameter / 3)  # a ball is as heavy as that
        mass = STEEL.density * np.pi / 4 * row.diameter**2 * length
        force = float(mass * row.radius * cage**2)
        radial = float(np.hypot(load[1], load[2]))
        least = np.pi * radial / sum(seat.bearing.counts)
        rows.append(
            {
                "bearing": seat.name,
                "speed [rpm]": turn * 30 / np.pi,
                "centrifugal force of a roller [N]": force,
                "load of the most loaded roller, at least [N]": least,
                "centrifugal force over that load, at most [%]": (
                    100 * force / least if least > 0 else None
                ),
            }
        )
    return rows


def _ratio(machine: Machine, name: str) -> float:
    """Speed of what a bearing holds, over the rotor's."""
    holds = next(row.holds for row in machine.bearings if row.name == name)
    shafts = [shaft.name for shaft in machine.shafts]
    if holds in shafts:
        return machine.speeds[shafts.index(holds)]
    word, _, rest = holds.partition(" ")
    if word != "stage":
        return machine.speeds[-1] if holds == "generator" else 1.0
    number, _, part = rest.partition(" ")
    return machine.speeds[int(number) - (part in ("carrier", "gear", "ring"))]
