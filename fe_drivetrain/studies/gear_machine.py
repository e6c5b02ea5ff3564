"""What a drivetrain's file states for a rating of its gears, and which keys it lacks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.components import ONE_RPM
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.entrance import Entrance
from fe_drivetrain.drivetrain_file.gear_strength import GearStrength
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.dynamics.bodies.advice import Rung
from fe_drivetrain.dynamics.bodies.condensed_rungs import Rungs, plain_rungs, with_rollers
from fe_drivetrain.dynamics.bodies.machine import machine_of, rated_torque
from fe_drivetrain.dynamics.bodies.roller_matrices import with_matrices
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.gear_stresses import Conditions
from fe_drivetrain.studies.mode_levels import WORDS, named_rung
from fe_drivetrain.studies.rotor_speeds import rated_speed

NOTHING: Mapping[str, str] = MappingProxyType({})


@dataclass(frozen=True)
class GearTrain:
    """A machine whose gears are rated.

    Attributes
    ----------
    machine : MachineTable
        Bodies, shafts and stages.
    rungs : tuple of Rung
        Levels that its data allow, from the simplest to the finest.
    rung : Rung
        Level of the rating, one of them.
    left_out : Mapping of str to str
        Levels and parts that the ladder does not have, and why.
    strengths : dict of int to GearStrength
        Strength of stages by their number, from 1.
    conditions : Conditions
        Rated speed of the rotor, and oil.
    torque : float
        Reference torque of the rotor [N m].
    entrance : Entrance or None
        Where hub loads enter; None of a main shaft without sections.
    stated : str
        Where the torque comes from.
    missing : tuple of str
        Keys that every rating needs and the file lacks.
    """

    machine: MachineTable
    rungs: tuple[Rung, ...]
    rung: Rung
    left_out: Mapping[str, str]
    strengths: dict[int, GearStrength]
    conditions: Conditions
    torque: float
    entrance: Entrance | None
    stated: str
    missing: tuple[str, ...]


def gear_train(
    drivetrain: Drivetrain,
    options: GearOptions,
    torque: float | None,
    condensed: Rungs | None = None,
) -> GearTrain:
    """What a rating needs of a drivetrain.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain, with a rotor, stages and a generator.
    options : GearOptions
        What is given beside the file.
    torque : float or None
        Torque of the rotor [N m]; None takes that of the file's rated power.
    condensed : Rungs or None
        Ladder with what is condensed, once that is done; None for the levels without it.

    Raises
    ------
    InputError
        The file has no gears, or no torque is known.
    """
    if not drivetrain.gearbox.stages:
        raise InputError(f"{drivetrain.title!r} has no gears: give gearbox.stages")
    machine, operation = machine_of(drivetrain), drivetrain.operation
    speed, oil = rated_speed(drivetrain), None
    if operation is not None and operation.lubricant is not None:
        oil = 1e-6 * float(operation.lubricant.split()[1])
    if options.rotor_speed_rpm:
        speed = options.rotor_speed_rpm * ONE_RPM
    if options.lubricant is not None:
        oil = 1e-6 * options.lubricant
    stated = "as asked"
    if torque is None:
        rated = rated_torque(drivetrain, machine)
        if rated is None:
            raise InputError(
                f"{drivetrain.title!r} states no torque: give generator.rated_torque, or "
                "operation.rated_power and operation.rotor_speed in the file, or "
                f"{argument('torque')} in N m"
            )
        torque, stated = rated
    if not 0.0 < torque < 1e10:
        raise InputError(
            f"torque of the rotor is {torque:g} N m but must be above 0 and below 1e10 N m: "
            "give that which drives the gears"
        )
    strengths = {
        number: stage.strength
        for number, stage in enumerate(machine.stages, start=1)
        if stage.strength is not None
    }
    where = drivetrain.entrance if isinstance(drivetrain, Scene) else None
    missing = ["operation.rotor_speed"] if speed is None else []
    missing += ["operation.lubricant"] if oil is None else []
    ladder = Rungs(plain_rungs(drivetrain, machine), NOTHING) if condensed is None else condensed
    ladder = with_rollers(ladder, machine) if options.rollers else ladder
    ladder = with_matrices(ladder, machine, torque) if options.matrices else ladder
    rungs, left_out = ladder.rungs, ladder.left_out
    # the name of a condensed level is known once that is made
    waits = condensed is None and options.condensed and options.level not in WORDS
    rung = named_rung(None if waits else options.level, rungs, machine)
    return GearTrain(
        machine,
        rungs,
        rung,
        left_out,
        strengths,
        Conditions(speed, oil),
        torque,
        where,
        stated,
        tuple(missing),
    )
