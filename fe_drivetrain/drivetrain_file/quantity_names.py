"""Names of quantities, known before what computes them is loaded: reactions, and what turns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from fe_drivetrain.common.components import FORCES, MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.near_words import did_you_mean
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.scene import Scene

FIRST = "modes.torsional.1"
"""What is asked for where nothing is, of a main shaft without sections."""
STUDIES = ("modes", "gears", "transient", "life")
"""Studies whose quantities have a name, the first part of it."""


def check_reaction(name: str, scene: Scene) -> None:
    """Refuse what is no reaction of the scene, and no stiffness at its hub.

    Parameters
    ----------
    name : str
        Name of a quantity.
    scene : Scene
        The scene.

    Raises
    ------
    InputError
        The name is none of the scene's.
    """
    owners = [*scene.bearing_names, "gearbox"]
    known = [f"{owner}.{force}" for owner in owners for force in FORCES]
    known += [f"hub.stiffness.{motion}" for motion in MOTIONS]
    if name not in known:
        near = did_you_mean(name, known)
        raise InputError(
            f"quantity {name!r} is unknown: {near + ' ' if near else ''}use one of "
            f"{', '.join(known)}"
        )


def is_turning(name: str, drivetrain: Drivetrain) -> bool:
    """Whether a name is meant as that of a quantity of all that turns, not of a bearing.

    Parameters
    ----------
    name : str
        Name of a quantity.
    drivetrain : Drivetrain
        The drivetrain, whose bearings may have any name.
    """
    owner = name.partition(".")[0]
    return owner in STUDIES and owner not in getattr(drivetrain, "bearing_names", ())


def turning_names(
    drivetrain: Drivetrain, names: Sequence[str], load: Mapping[str, float] | None
) -> tuple[str, ...]:
    """Names of what turns, where that is asked for.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    names : sequence of str
        Names that are asked for; without any, and without sections of the main shaft, the first
        torsional frequency is.
    load : mapping of str to float, or None
        Load of the hub, which is for reactions.

    Raises
    ------
    InputError
        Reactions or stiffnesses are asked for beside, or a load is given.
    """
    turning = tuple(name for name in names if is_turning(name, drivetrain))
    if not names and not isinstance(drivetrain, Scene):
        turning = (FIRST,)
    if turning and len(turning) < len(names):
        other = next(name for name in names if name not in turning)
        raise InputError(
            f"{other} and {turning[0]} are of different models, that of the main shaft and that of "
            "all that turns: ask for them one by one"
        )
    if turning and load is not None:
        raise InputError(
            f"a load is given for {turning[0]} but is for reactions: leave it out, gears are under "
            "the torque of the rated power and the weight of the rotor"
        )
    return turning
