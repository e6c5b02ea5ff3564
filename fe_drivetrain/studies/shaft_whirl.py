"""Whirl of a drivetrain's shafts: critical speeds, Campbell diagrams, unbalance, stability."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import ClassVar

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.comparison import grid_convergence
from fe_drivetrain.drivetrain_file import Drivetrain
from fe_drivetrain.dynamics import Level, System, machine_of, machine_system
from fe_drivetrain.dynamics.whirl.condensed import condensed_rotor
from fe_drivetrain.dynamics.whirl.modes import (
    Critical,
    chart_criticals,
    critical_speeds,
    is_damped,
    stability_limit,
    whirl_chart,
)
from fe_drivetrain.dynamics.whirl.rotor import THEORIES, Rotor, rigid_rotor
from fe_drivetrain.dynamics.whirl.unbalance import UnbalanceResponse, unbalance_response
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.rotor_speeds import FARTHEST, check_speed
from fe_drivetrain.studies.whirl_charts import whirl_campbell
from fe_drivetrain.studies.whirl_findings import state_rollers, state_whirl
from fe_drivetrain.studies.whirl_record import Rung, ShaftWhirl, excited_critical
from fe_drivetrain.studies.whirl_rollers import roller_tables
from fe_drivetrain.studies.whirl_shafts import ShaftRotor, critical_in_drivetrain, shaft_rotors

PARTS = 2
"""Parts of each element of a shaft between its bearings and steps."""
SERIES = (1, 2, 4)
"""Parts of the series that bands are of."""
BEYOND = 1.25
"""Highest speed that is looked at, over the first critical that unbalance excites."""
TWICE = 2.0
"""Highest speed that is looked at, over the largest of operation, at least."""
POINTS = 40
"""Speeds of a Campbell diagram."""
SHOWN = 8
"""Modes of a Campbell diagram."""
FURTHER = 1.5
"""Highest speed at which a shaft's critical is looked for in the whole drivetrain, over that."""
CONDENSED = {"condensed to bearings": 0, "condensed, and 4 modes": 4}
"""Condensed levels of the ladder, and the modes that each keeps."""
ROUND_OFF = 1e-9
"""Relative, of what no number of elements changes."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class WhirlResult(Result):
    """Whirl of the shafts of a drivetrain.

    Attributes
    ----------
    shafts : tuple of ShaftWhirl
        What was found of each shaft, from the rotor to the generator.
    speeds : tuple of float
        Least and largest speed of the rotor in operation [rad/s].
    """

    STUDY: ClassVar[str] = "whirl"
    SCHEMA_VERSION: ClassVar[int] = 1

    shafts: tuple[ShaftWhirl, ...] = field(repr=False)
    speeds: tuple[float, float]

    def chart(self) -> Chart:
        """Campbell diagram of the shaft whose criticals are nearest to its operation."""
        return whirl_campbell(min(self.shafts, key=lambda one: one.margin))


def whirl(
    drivetrain: Drivetrain,
    *,
    speeds: tuple[float, float] | None = None,
    matrices: bool = False,
    report: Progress = silent,
) -> WhirlResult:
    """Compute how the shafts of a drivetrain whirl on their bearings.

    Each shaft is a rotor with the bodies at its ends. The bodies of its neighbours stand still, so
    that their gears hold it by the stiffness of the meshes; without these is the other bound.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain; ``whirl`` of its file has damping, unbalance, and bearings over the speed.
    speeds : tuple of float or None
        Least and largest speed of the rotor in operation [rad/s]; None for ``rotor_speed`` of its
        operation.
    matrices : bool
        Whether gearbox bearings with a catalogue entry have the 6 x 6 stiffness of their rollers at
        three speeds of operation, under a torque that goes with the square of the speed up to the
        rated one; see `roller_tables`.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        No speeds are known, the drivetrain lacks data, or no shaft whirls.
    """
    over = _speeds(drivetrain, speeds)
    found, steps = Findings(), Steps(report)
    found.seed = None
    found.about(drivetrain)
    machine = machine_of(drivetrain)
    if machine.not_given:
        raise InputError(
            f"whirl of {drivetrain.title!r} needs what its file does not state: "
            f"{', '.join(machine.not_given)}: add it"
        )
    rollers = None
    if matrices:
        with steps.step("stiffness of rollers"):
            rollers = roller_tables(drivetrain, machine, over)
    system = machine_system(machine, Level.FLEXIBLE, held_generator=True)
    shafts = []
    for shaft in shaft_rotors(machine, drivetrain.whirl, rollers):
        with steps.step(shaft.name):
            shafts.append(shaft_whirl(shaft, over, system))
    if not shafts:
        raise InputError(
            f"no shaft of {drivetrain.title!r} has a mass across its axis: give the rotor's mass, "
            "or diameters of its shafts"
        )
    state_whirl(found, machine, drivetrain.whirl, shafts)
    if rollers is not None:
        state_rollers(found, rollers)
    options = {"speeds": over, "matrices": matrices}
    return WhirlResult(shafts=tuple(shafts), speeds=over, **found.frozen(steps.times, **options))


def shaft_whirl(shaft: ShaftRotor, speeds: tuple[float, float], system: System) -> ShaftWhirl:
    """What is found of one shaft.

    Parameters
    ----------
    shaft : ShaftRotor
        The shaft.
    speeds : tuple of float
        Least and largest speed of the rotor in operation [rad/s].
    system : System
        The whole drivetrain.
    """
    low, high = (speed * shaft.ratio for speed in speeds)
    rotor = shaft.rotor(PARTS)
    limit = _limit(rotor, high)
    criticals = critical_speeds(rotor, limit)
    chart_speeds = np.linspace(limit / POINTS, limit, POINTS)
    return ShaftWhirl(
        name=shaft.name,
        ratio=shaft.ratio,
        range=(low, high),
        limit=limit,
        criticals=tuple(criticals),
        bands=_bands(shaft, limit, criticals),
        crossings=tuple(chart_criticals(rotor, limit)),
        chart=whirl_chart(rotor, chart_speeds.tolist(), SHOWN),
        damped=is_damped(rotor),
        unstable_from=stability_limit(rotor, limit) if is_damped(rotor) else None,
        response=_response(shaft, rotor, high, limit),
        bearings=tuple(one.name for one in rotor.bearings),
        without_meshes=_without_meshes(shaft, limit),
        in_drivetrain=(
            None if rotor.changes else critical_in_drivetrain(system, shaft, FURTHER * limit)
        ),
        ladder=tuple(_ladder(shaft, limit)),
        nodes=len(rotor.stations),
    )


def _speeds(drivetrain: Drivetrain, speeds: tuple[float, float] | None) -> tuple[float, float]:
    """Speeds of the rotor in operation [rad/s]."""
    own = None if drivetrain.operation is None else drivetrain.operation.rotor_speed
    over = speeds or own
    if over is None:
        raise InputError(
            f"{drivetrain.title!r} states no operation.rotor_speed, which critical speeds are "
            "compared with: give it, or `speeds`"
        )
    if not 0.0 <= over[0] <= over[1] < math.inf or over[1] == 0.0:
        raise InputError(
            f"speeds of the rotor are {over[0]:g} to {over[1]:g} rad/s but the least must be from "
            "0 and the largest not below it: change them"
        )
    check_speed("range of operation", over[1], own and own[1], FARTHEST, "change it")
    return over


def _limit(rotor: Rotor, high: float) -> float:
    """Highest speed that is looked at [rad/s]."""
    everything = [one for one in critical_speeds(rotor, 1e3 * high)]
    first = excited_critical(everything)
    return max(TWICE * high, 0.0 if first is None else BEYOND * first.speed)


def _bands(shaft: ShaftRotor, limit: float, criticals: Sequence[Critical]) -> Floats:
    """Half widths of what the number of elements leaves open, of each critical [rad/s]."""
    series = [
        [one.speed for one in critical_speeds(shaft.rotor(parts), 2.0 * limit)] for parts in SERIES
    ]
    found = []
    for k, one in enumerate(criticals):
        own = [row[k] for row in series if k < len(row)]
        if len(own) < len(SERIES):
            found.append(math.nan)
            continue
        open_left = grid_convergence([1 / p for p in SERIES], own, min_order=1.0).uncertainty
        found.append(max(abs(one.speed - own[-1]) + open_left, ROUND_OFF * one.speed))
    return np.array(found)


def _response(shaft: ShaftRotor, rotor: Rotor, high: float, limit: float) -> UnbalanceResponse:
    """Steady whirl by unbalance over the speed; the first speed is the largest of operation."""
    speeds = [high, *np.linspace(limit / 200, limit, 200).tolist()]
    return unbalance_response(rotor, shaft.unbalances(high, PARTS), speeds)


def _without_meshes(shaft: ShaftRotor, limit: float) -> float | None:
    """First critical that unbalance excites without the gear meshes; None where it is loose."""
    if not shaft.meshes:
        return None
    try:
        found = critical_speeds(shaft.rotor(PARTS, without=shaft.meshes), 4.0 * limit)
    except InputError:
        return None
    first = excited_critical(found)
    return None if first is None else first.speed


def _ladder(shaft: ShaftRotor, limit: float) -> list[Rung]:
    """First critical at each level of the model, from the simplest, with processor times."""
    levels: list[tuple[str, Callable[[], Rotor]]] = [
        ("rigid shaft", lambda: rigid_rotor(shaft.rotor()))
    ]
    if len(shaft.pieces):
        levels += [
            (f"{theory}, as few elements as it has pieces", partial(shaft.rotor, 1, theory))
            for theory in THEORIES
        ]
        levels.append(("timoshenko, 2 times as many", partial(shaft.rotor, 2)))
        levels += [
            (f"timoshenko, 4 times as many, {words}", partial(_condensed, shaft, modes))
            for words, modes in CONDENSED.items()
        ]
        levels.append(("timoshenko, 4 times as many", partial(shaft.rotor, 4)))
    found = []
    for name, made in levels:
        begin = time.process_time()
        rotor = made()
        first = excited_critical(critical_speeds(rotor, 10.0 * limit))
        seconds = time.process_time() - begin
        speed = None if first is None else first.speed
        found.append(Rung(name, 2 * len(rotor.mass), speed, seconds))
    return found


def _condensed(shaft: ShaftRotor, modes: int) -> Rotor:
    return condensed_rotor(shaft.rotor(4), modes)
