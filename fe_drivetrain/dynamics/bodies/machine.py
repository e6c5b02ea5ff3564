"""Machines: drivetrains in three dimensions that pass the gate, of a file or built in Python."""

from collections.abc import Mapping
from typing import Any, Self

from pydantic import model_validator

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
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
    if isinstance(drivetrain, Scene):
        table, _ = table_of(drivetrain, main_shaft(drivetrain), main_bearings(drivetrain, supports))
    elif isinstance(drivetrain, LumpedDrivetrain):
        table, _ = table_of(drivetrain, drivetrain.shaft)
    else:
        raise InputError(f"{drivetrain.title!r} has no main shaft: give shaft")
    return Machine.model_validate(dict(table))


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
