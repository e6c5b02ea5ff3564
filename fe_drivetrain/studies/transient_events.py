"""Events of a drivetrain in time at one level: what it runs at, and the event there with a step."""

from __future__ import annotations

from collections.abc import Callable

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.dynamics.bodies.advice import RUNGS, Rung
from fe_drivetrain.dynamics.bodies.damping_ratios import ASSUMED_RATIOS
from fe_drivetrain.dynamics.bodies.machine import Machine, machine_of, rated_torque
from fe_drivetrain.procedure.drivetrain_events import SLIP, Event, event_of
from fe_drivetrain.procedure.travelling_planets import has_planets, with_travelling_planets
from fe_drivetrain.studies.part_loads import NO_PARTS, CountedParts
from fe_drivetrain.studies.transient_runs import LevelRun, Prepared, Rated, with_bands


def rated_of(drivetrain: Drivetrain, backlash: float = 0.0) -> Rated:
    """What a drivetrain runs at, from its file.

    Parameters
    ----------
    drivetrain : Drivetrain
        With `operation`, or the rated torque of its generator and a speed of the rotor.
    backlash : float
        Backlash of all meshes along their lines of action [m].

    Raises
    ------
    InputError
        A value is missing; the message names its key.
    """
    of, generator = drivetrain.operation, drivetrain.generator
    if of is None or of.rotor_speed is None:
        raise InputError(
            f"{drivetrain.title!r} does not state the speed of its rotor: add operation: "
            "{rotor_speed: [least, rated]} in rad/s"
        )
    rated = rated_torque(drivetrain, machine_of(drivetrain))
    if rated is None:
        raise InputError(
            f"{drivetrain.title!r} does not state its rated power: add operation: "
            "{rated_power: ...} in W"
        )
    slip = None if generator is None else generator.slip
    return Rated(
        rated.torque,
        of.rotor_speed[1],
        SLIP if slip is None else slip,
        drivetrain.damping or ASSUMED_RATIOS,
        backlash,
    )


def values_of_file(drivetrain: Drivetrain, event: str) -> dict[str, float | str]:
    """Values of an event that the drivetrain's file states: its brake.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    event : str
        Name of the event.
    """
    brake = drivetrain.brake
    if event != "stop" or brake is None:
        return {}
    return {"shaft": brake.shaft, "brake_torque": brake.torque, "rise": brake.rise}


def prepared_event(
    machine: Machine,
    rated: Rated,
    event: Event,
    duration: float,
    rung: Rung,
    counted: CountedParts,
    planets_travel: bool = False,
) -> tuple[Prepared, Callable[[float | None], LevelRun]]:
    """A drivetrain at a level, and its event there with a step; that which it needs for None.

    Parameters
    ----------
    machine, rated : Machine, Rated
        The drivetrain, and what it runs at.
    event : Event
        The event.
    duration : float
        How long it lasts [s].
    rung : Rung
        The level.
    counted : CountedParts
        Bearings whose damage is counted.
    planets_travel : bool
        Whether planets are where their carrier is.
    """
    of = Prepared(machine, rung, rated, event.teeth, parts=counted)
    planned = event.plan(of.of, duration, rated.slip)
    if planets_travel and has_planets(machine, rung.level):
        planned = with_travelling_planets(of.of, planned)
    return of, lambda step: of.event(planned, event.step(of.of) if step is None else step)


def event_at(
    drivetrain: Drivetrain, event: str, rung: Rung, counted: CountedParts = NO_PARTS
) -> LevelRun:
    """An event of a drivetrain at one level, with all defaults, and the bands of its step.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    event : str
        Name of an event, not of operation.
    rung : Rung
        The level, at which the event can happen.
    counted : CountedParts
        Bearings whose damage is counted.

    Raises
    ------
    InputError
        See `transient`.
    """
    machine, rated = machine_of(drivetrain), rated_of(drivetrain)
    happens = event_of(event, values_of_file(drivetrain, event))
    duration = happens.lasts(rated.running(machine, RUNGS[0]))
    _, run = prepared_event(machine, rated, happens, duration, rung, counted)
    return with_bands(run(None), run)
