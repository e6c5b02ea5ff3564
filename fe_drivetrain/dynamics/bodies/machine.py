"""Machines: drivetrains in three dimensions that pass the gate, of a file or built in Python."""

from collections.abc import Mapping
from typing import Any, NamedTuple, Self

from pydantic import model_validator

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.left_out import LeftOut
from fe_drivetrain.drivetrain_file.lumped import LumpedDrivetrain
from fe_drivetrain.drivetrain_file.machine_gate import check_table
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.drivetrain_file.scene import Scene, main_bearings, main_shaft
from fe_drivetrain.drivetrain_file.turning_gate import table_of
from fe_drivetrain.dynamics.bodies.machine_motions import check_held


class Machine(MachineTable):
    """A drivetrain in three dimensions whose geometry fits and whose bodies are held.

    Raises
    ------
    InputError
        See `machine_gate.check_table` and `machine_motions.check_held`.
    """

    @model_validator(mode="after")
    def _gate(self) -> Self:
        check_table(self)
        if not self.not_given:
            check_held(self)
        return self

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """A copy, which passes the gate again where values are changed."""
        copied = super().model_copy(deep=deep)
        return type(self).model_validate({**dict(copied), **update}) if update else copied


def derived_values(drivetrain: Drivetrain) -> list[LeftOut]:
    """What was derived or assumed of all that turns, where a drivetrain's file does not state it.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.

    Raises
    ------
    InputError
        See `machine_of`.
    """
    table, derived = _table(drivetrain, None)
    rows = [LeftOut(name, "derived", "", how) for name, how in derived.items()]
    return rows + [LeftOut(*row) for row in table.assumptions()]


MACHINES = ("nrel_5mw", "nrel_750kw", "synthetic_2mw", "park_2021")
"""Names of the library's drivetrains with a gearbox in three dimensions."""


def machine_of(drivetrain: Drivetrain, supports: Mapping[str, Floats] | None = None) -> Machine:
    """The bodies, shafts, stages and bearings of a drivetrain's file, for all that moves.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain, with a rotor and a generator.
    supports : mapping of str to ndarray (6, 6), optional
        Stiffness of main bearings with their housings, see `main_bearings`; rigid housings where
        left out.

    Returns
    -------
    Machine
        What is not stated for three dimensions is in `not_given`: such a machine only turns.

    Raises
    ------
    InputError
        The file lacks what any model of all that turns needs, and the message names its key; or
        something moves freely.
    """
    table, _ = _table(drivetrain, supports)
    return Machine.model_validate(dict(table))


class RatedTorque(NamedTuple):
    """Torque of the rotor in steady turning at rated speed [N m], and what it follows from."""

    torque: float
    source: str


def rated_torque(drivetrain: Drivetrain, machine: MachineTable) -> RatedTorque | None:
    """Rated torque at the rotor: that of the generator, where the file states it, or of its power.

    Rated power is often that which is fed in: what the generator loses is then in its torque alone.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    machine : MachineTable
        Its rows, for the ratio of all stages.

    Returns
    -------
    RatedTorque or None
        None where the file states neither.
    """
    generator, operation = drivetrain.generator, drivetrain.operation
    if generator is not None and generator.rated_torque is not None:
        at_rotor = generator.rated_torque * abs(machine.speeds[-1])
        return RatedTorque(at_rotor, "generator: rated_torque times the ratio of all stages")
    torque = None if operation is None else operation.rated_torque
    if torque is None:
        return None
    return RatedTorque(torque, "operation: rated_power over rotor_speed, without losses")


def _table(
    drivetrain: Drivetrain, supports: Mapping[str, Floats] | None
) -> tuple[MachineTable, Mapping[str, str]]:
    """Rows of a drivetrain, and what was derived."""
    if isinstance(drivetrain, Scene):
        bearings = main_bearings(drivetrain, supports)
        return table_of(drivetrain, main_shaft(drivetrain), bearings)
    if isinstance(drivetrain, LumpedDrivetrain):
        return table_of(drivetrain, drivetrain.shaft)
    raise InputError(f"{drivetrain.title!r} has no main shaft: give shaft")


def library_machine(name: str) -> Machine:
    """The machine of a drivetrain that comes with the package.

    Parameters
    ----------
    name : str
        One of `MACHINES`, or another drivetrain of the library with a rotor and a generator.

    Raises
    ------
    InputError
        There is none of that name, or it lacks what a machine needs.
    """
    return machine_of(read_drivetrain(name))
