"""Design loads of the catalogue that extremes of a drivetrain in time are values of."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import NamedTuple

from fe_drivetrain.procedure.failure_modes import (
    BEARING_RATING,
    DIPS,
    ELECTRICAL_FAULT,
    HIGH_SPEED_REVERSALS,
    MISALIGNMENT,
    OVERLOAD,
    RESONANCE,
    REVERSALS,
    ROTOR_TORQUE,
    TORQUE_AND_BENDING,
)
from fe_drivetrain.studies.transient_runs import Extreme

OF_EVENTS: Mapping[str, tuple[str, ...]] = {
    "grid_loss": (ELECTRICAL_FAULT,),
    "dip": (DIPS, ELECTRICAL_FAULT),
    "run_up": (RESONANCE,),
    "offset": (MISALIGNMENT,),
}
"""Design loads that an event brings about, by its name."""


class ExtremeLoads(NamedTuple):
    """Design loads that both extremes of a channel are values of."""

    most: tuple[str, ...]
    least: tuple[str, ...]


def design_loads(
    event: str, extremes: Mapping[str, Extreme], main: Collection[str]
) -> dict[str, ExtremeLoads]:
    """Design loads that the largest and the least value of each channel are values of.

    Speeds are values of none: no limit of the catalogue is one of a speed.

    Parameters
    ----------
    event : str
        Name of the event, or "operation".
    extremes : Mapping[str, Extreme]
        Extremes by channel, torques from the rotor on.
    main : collection of str
        Names of the main bearings.
    """
    torques = [name for name, one in extremes.items() if one.kind == "torque"]
    by_event = OF_EVENTS.get(event, ())
    found = {name: ExtremeLoads((), ()) for name in extremes}
    for name, one in extremes.items():
        if one.kind == "torque":
            of_rotor = event == "operation" and name == torques[0]
            most = (*((ROTOR_TORQUE,) if of_rotor else ()), TORQUE_AND_BENDING)
            least = (REVERSALS, *((HIGH_SPEED_REVERSALS,) if name == torques[-1] else ()))
            found[name] = ExtremeLoads((*most, *by_event), (*least, *by_event))
        elif one.kind == "mesh":
            found[name] = ExtremeLoads((OVERLOAD, *by_event), (REVERSALS, *by_event))
        elif one.kind == "bearing":
            of_main = name.partition("force of ")[2] in main
            load = TORQUE_AND_BENDING if of_main else BEARING_RATING
            found[name] = ExtremeLoads((load, *by_event), (load, *by_event))
    return found
