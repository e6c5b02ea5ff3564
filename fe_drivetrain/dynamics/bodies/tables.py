"""Machines: drivetrains in three dimensions that pass the gate, from YAML or built in Python."""

from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any, Self

from pydantic import model_validator

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import parse_mapping, read_text, validated
from fe_drivetrain.dynamics.bodies.machine_gate import check_machine
from fe_drivetrain.dynamics.bodies.machine_rows import MachineTable


class Machine(MachineTable):
    """A drivetrain in three dimensions whose geometry fits and whose bodies are held.

    Raises
    ------
    InputError
        See `machine_gate.check_machine`.
    """

    @model_validator(mode="after")
    def _gate(self) -> Self:
        check_machine(self)
        return self

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """A copy, which passes the gate again where values are changed."""
        copied = super().model_copy(deep=deep)
        return type(self).model_validate({**dict(copied), **update}) if update else copied


MACHINES = ("nrel_5mw", "nrel_750kw", "synthetic_2mw", "park_2021")
"""Names of the tables that come with the package."""


def library_machine(name: str) -> Machine:
    """A table that comes with the package.

    Parameters
    ----------
    name : str
        One of `MACHINES`.

    Raises
    ------
    InputError
        There is none of that name.
    """
    if name not in MACHINES:
        raise InputError(f"no machine {name!r}: use one of {', '.join(MACHINES)}")
    text = (files("fe_drivetrain.dynamics") / f"{name}.yaml").read_text("utf-8")
    return parse_machine(text, name)


def named_machine(name: str) -> Machine:
    """The machine in a file or of the library.

    Parameters
    ----------
    name : str
        A file, or one of `MACHINES`.

    Raises
    ------
    InputError
        There is none of that name, or the file does not describe a machine.
    """
    if name not in MACHINES and (Path(name).suffix or Path(name).exists()):
        return read_machine(name)
    return library_machine(name)


def read_machine(path: str | Path) -> Machine:
    """Read a machine's table from a YAML file of at most 1 MB.

    Parameters
    ----------
    path : str or Path
        Plain YAML without anchors, aliases or tags.

    Raises
    ------
    InputError
        The file cannot be read, or does not describe a machine.
    """
    return parse_machine(read_text(path, "machine"), str(path))


def parse_machine(text: str, source: str = "machine") -> Machine:
    """A machine from YAML text; see `read_machine`."""
    return validated(Machine, parse_mapping(text, source), source)
