"""The first stage of a drivetrain whose planets are on bearings, and what it is turned under."""

from fe_drivetrain.common import InputError
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.drivetrain_file.turning_parts import diagonal
from fe_drivetrain.dynamics import Machine

TURNS = ("torque and gravity", "tilt at the hub, too")
"""Loads of a user's drivetrain over a turn of the carrier."""


def first_stage(machine: Machine) -> tuple[PlanetaryData, list[str]]:
    """The first stage, and the names of the bearings on each pin.

    Raises
    ------
    InputError
        It is no planetary stage, or states no bearings of its planets.
    """
    stage = machine.stages[0] if machine.stages else None
    if not isinstance(stage, PlanetaryData) or not stage.pins:
        raise InputError(
            f"{machine.title!r}: stage 1 must be planetary with bearings of its planets: give "
            "gearbox.stages.0.pins"
        )
    return stage, [pin.name for pin in stage.pins]


def isotropic(stage: PlanetaryData, machine: Machine) -> bool:
    """Whether all bearings are as stiff in both radial directions, and see gravity once a turn."""
    held = [
        *(bearing.stiffness for bearing in machine.bearings),
        *(p.stiffness for p in stage.pins),
    ]
    return all(len(set(diagonal(one)[1:3])) == 1 for one in held)
