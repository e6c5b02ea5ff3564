"""The project to start from for a drivetrain of one's own: all six steps on results of commands."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from importlib.resources import files as package_files
from pathlib import Path

from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics.bodies.machine import Machine, machine_of
from fe_drivetrain.dynamics.bodies.machine_shafts import in_series, shaft_slices
from fe_drivetrain.procedure.failure_modes import (
    BEARING_RATING,
    GEAR_RATING,
    TORQUE_AND_BENDING,
)


def own_project(drivetrain: Drivetrain, file: str) -> str:
    """A project of a drivetrain, with the names of its shafts and bearings, as YAML text.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain, with rotor and generator.
    file : str
        Its file as the project names it, relative to the project's, or its name in the library.

    Raises
    ------
    InputError
        The file lacks what any model of all that turns needs; the message names its key.
    """
    machine = machine_of(drivetrain)
    main = f"torque of {machine.shafts[0].name}"
    words = {
        "TITLE": " ".join(drivetrain.title.split()),
        "SUBJECT": _quoted(drivetrain.title),
        "DRIVETRAIN": _quoted(file),
        "STEM": Path(file).stem,
        "MAIN": _quoted(main),
        "MAIN_MOST": _quoted(f"largest {main}"),
        "MAIN_LEAST": _quoted(f"least {main}"),
        "BEARING": _quoted(f"largest force of {_last_bearing(machine)}"),
        "GEAR_RATING": GEAR_RATING,
        "BEARING_RATING": BEARING_RATING,
        "TORQUE_AND_BENDING": TORQUE_AND_BENDING,
        "INPUTS": "\n".join(f"    - {_row(row)}" for row in _inputs(drivetrain, machine)),
    }
    text = package_files("fe_drivetrain.procedure").joinpath("project_own.yaml").read_text("utf-8")
    for key, word in words.items():
        text = text.replace(f"@{key}@", word)
    return text


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _row(values: Mapping[str, str | float]) -> str:
    words = {k: _quoted(v) if isinstance(v, str) else f"{v!r}" for k, v in values.items()}
    return f"{{{', '.join(f'{key}: {word}' for key, word in words.items())}}}"


def _last_bearing(machine: Machine) -> str:
    """The bearing that is nearest to the generator: of the last gear, or of the last shaft."""
    number = len(machine.stages)
    last = (f"stage {number} pinion", f"stage {number} sun", machine.shafts[-1].name)
    names = [one.name for one in machine.bearings]
    return next((one.name for one in machine.bearings if one.holds in last), ["", *names][-1])


def _inputs(drivetrain: Drivetrain, machine: Machine) -> Iterator[dict[str, str | float]]:
    """Inputs of Table 4.7 as the file has them; values without a number stay open."""

    def row(name: str, value: float | None, unit: str) -> dict[str, str | float]:
        known: dict[str, str | float] = {"name": name}
        if value is not None:
            known |= {"value": float(f"{value:.6g}"), "unit": unit}
        return {**known, "source": "the drivetrain's file: state its document"}

    yield row("mass of drivetrain parts: rotor", machine.rotor.mass, "kg")
    yield row("inertia of drivetrain parts: rotor", machine.rotor.inertia, "kg m^2")
    yield row("inertia of drivetrain parts: generator", machine.generator.inertia, "kg m^2")
    for shaft in machine.shafts:
        if shaft.kind != "rigid":
            k = in_series(shaft_slices(shaft, 0.0, shaft.length), shaft.material)[1][3]
            yield row(f"stiffness of shafts: {shaft.name}", k, "N m/rad")
    for number, stage in enumerate(machine.stages, start=1):
        mesh = stage.sun_planet if isinstance(stage, PlanetaryData) else stage.stiffness
        unit = "N/m" if stage.stiffness_of == "line" else "N m/rad"
        yield row(f"stiffness of meshes: stage {number}", mesh, unit)
    yield row("stiffness of gearbox mount", None, "N/m")
    of = drivetrain.damping
    yield row("damping of shafts", None if of is None else of.shafts, "-")
    yield row("damping of meshes", None if of is None else of.meshes, "-")
