"""A machine under simulated wind at its rated power, and stopped by a brake of a stated effect."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import newton

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison.in_time import peak_between
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.dynamics.bodies.advice import Rung
from fe_drivetrain.dynamics.bodies.condensed_rungs import plain_rungs
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.machine import Machine, machine_of
from fe_drivetrain.procedure.drivetrain_events import event_of
from fe_drivetrain.procedure.drivetrain_operation import operation
from fe_drivetrain.studies.part_loads import NO_PARTS
from fe_drivetrain.studies.transient_events import prepared_event, rated_of, values_of_file
from fe_drivetrain.studies.transient_runs import LevelRun, Prepared, Rated
from fe_drivetrain.turbine_loads.hub_loads.aero_rotor import Rotor
from fe_drivetrain.turbine_loads.hub_loads.drive_history import DriveHistory
from fe_drivetrain.turbine_loads.hub_loads.moving_turbine import TurbineHistory, turbine_history
from fe_drivetrain.turbine_loads.hub_loads.surrogate import Condition
from fe_drivetrain.turbine_loads.hub_loads.turbine import similar_turbine

RATED_WIND = 16.0
"""Mean wind of normal operation [m/s]: rated wind of Al-Hamadani 2018, Table 7.1."""

LASTING = 20.0
"""Length of normal operation there [s]."""

PEAK = 1.32
"""Largest torque of the fast shaft in a shutdown, over rated: his 2 MW machine, section 6.2.2."""

SIZED = 4.5
"""Length of stops by which a brake is sized [s]."""

HISTORY_STEP, EVENT_STEP = 2e-3, 5e-4
"""Steps of operation and of stops [s]."""

SPEED = 1.895
"""Rated speed of his rotor [rad/s]: 18.1 rpm, Table 3.1."""


def turbine_in_wind(
    wind: float = RATED_WIND, turbulence: str = "medium", seed: int = 1
) -> TurbineHistory:
    """The generic 2 MW turbine with its controller in turbulent wind, for 20 s.

    Parameters
    ----------
    wind : float
        Mean wind speed [m/s].
    turbulence : str
        Turbulence, as `Condition` has it.
    seed : int
        Seed of the wind.
    """
    rotor = replace(Rotor(), tip_speed_limit=SPEED * Rotor.radius)
    condition = Condition(wind, turbulence, 0.2, seed)
    return turbine_history(condition, similar_turbine(rotor), duration=LASTING)


def scaled_to(made: TurbineHistory, power: float, speed: float) -> TurbineHistory:
    """A history of the 2 MW turbine as that of another: forces go with power, moments with torque.

    Parameters
    ----------
    made : TurbineHistory
        History of `turbine_in_wind`.
    power, speed : float
        Rated power and speed of the other's rotor [W, rad/s].
    """
    of_power, of_speed = power / Rotor.rated_power, speed / SPEED
    of_torque = of_power / of_speed
    sizes = np.array([of_power] * 3 + [of_torque] * 3)
    return replace(
        made,
        history=replace(made.history, loads=sizes * made.history.loads),
        rotor_speed=of_speed * made.rotor_speed,
        generator_torque=of_torque * made.generator_torque,
        power=of_power * made.power,
    )


def driving(made: TurbineHistory, torque_alone: bool = False) -> DriveHistory:
    """What a history of a turbine drives a drivetrain with.

    Parameters
    ----------
    made : TurbineHistory
        Its history.
    torque_alone : bool
        Whether the other loads of the hub are left out.
    """
    loads, absent = made.history.loads, made.history.absent
    if torque_alone:
        loads = np.where(np.arange(6) == 3, loads, 0.0)
        absent = ("Fx", "Fy", "Fz", "My", "Mz")
    wind = float(made.wind_speed.mean())
    name, time = made.history.name, made.history.time
    return DriveHistory(name, time, loads, absent, made.rotor_speed, None, None, wind)


@dataclass(frozen=True, eq=False)
class Rig:
    """A machine at a level, ready to be run.

    Attributes
    ----------
    machine : Machine
        Its table.
    rated : Rated
        What it runs at.
    rung : Rung
        What may move.
    """

    machine: Machine
    rated: Rated
    rung: Rung

    def normal(self, history: DriveHistory, step: float = HISTORY_STEP) -> LevelRun:
        """Operation under a history.

        Parameters
        ----------
        history : DriveHistory
            What drives it.
        step : float
            Step [s].
        """
        of = Prepared(self.machine, self.rung, self.rated, hub_loads=history.has_all)
        return of.window(operation(of.of, history, self.rated.slip), step, history.seconds)

    def stop(
        self,
        values: Mapping[str, float | str],
        step: float = EVENT_STEP,
        duration: float | None = None,
    ) -> LevelRun:
        """An emergency stop.

        Parameters
        ----------
        values : mapping
            Values of the event, see `EmergencyStop`.
        step : float
            Step [s].
        duration : float, optional
            Length [s]; what shows the event where left out.
        """
        event = event_of("stop", values)
        lasts = duration or event.lasts(self.rated.running(self.machine, self.rung))
        _, run = prepared_event(self.machine, self.rated, event, lasts, self.rung, NO_PARTS)
        return run(step)


def rig_of(drivetrain: Drivetrain, level: Level) -> Rig:
    """A drivetrain at a plain level.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    level : Level
        The level.

    Raises
    ------
    InputError
        Its file does not state what the level needs, nor rated power and speed.
    """
    machine = machine_of(drivetrain)
    rung = next((one for one in plain_rungs(drivetrain, machine) if one.level is level), None)
    if rung is None:
        raise InputError(
            f"{drivetrain.title!r} does not state {', '.join(machine.not_given)}: add it, so that "
            "bodies move in six degrees of freedom"
        )
    return Rig(machine, rated_of(drivetrain), rung)


def stop_values(
    drivetrain: Drivetrain, rig: Rig, peak: float = PEAK, **others: float | str
) -> dict[str, float | str]:
    """Values of an emergency stop: the file's brake, or one that gives a peak of the fast shaft.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    rig : Rig
        The drivetrain at a level.
    peak : float
        Largest torque of its last shaft once the brake is on, over rated.
    **others : float or str
        Other values of the event.

    Raises
    ------
    InputError
        No brake gives that peak.
    """
    if stated := values_of_file(drivetrain, "stop"):
        return {**stated, **others}
    fast = f"torque of {rig.machine.shafts[-1].name}"

    def excess(brake: float) -> float:
        values = {**others, "brake": min(max(brake, 0.0), 50.0)}
        run = rig.stop(values, 2.0 * EVENT_STEP, SIZED)
        braked = run.samples.times >= run.marks["brake on"]
        return peak_between(run.samples.of(fast)[braked]) / run.extremes[fast].rated - peak

    try:
        brake = float(newton(excess, 0.6, x1=0.9, tol=1e-3))
    except RuntimeError as error:
        raise InputError(
            f"{drivetrain.title!r}: no brake brings its last shaft to {peak:g} of rated torque: "
            "state one, as in brake: {shaft: HSS, torque: 1.0e4}"
        ) from error
    return {**others, "brake": brake}
