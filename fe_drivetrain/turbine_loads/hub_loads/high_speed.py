"""Torque that is recorded at the high-speed shaft, and what it is at the rotor."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.channels import Channel

TORQUE_OF = "torque of"
"""Attribute of a history whose Mx is not the rotor's: what it is of."""

HIGH_SPEED = "high-speed shaft"


class TorqueAt(NamedTuple):
    """Where Mx was recorded.

    Attributes
    ----------
    words : str
        What was done with it; empty of the rotor's own torque.
    attributes : Mapping[str, str]
        Attributes of the history.
    """

    words: str
    attributes: Mapping[str, str]


def at_rotor(
    source: str, loads: Mapping[str, Floats], high_speed: Channel | None, ratio: float | None
) -> tuple[dict[str, Floats], TorqueAt]:
    """Loads with the torque at the rotor, where the gearbox ratio is known, and what it is.

    Parameters
    ----------
    source : str
        The file, for messages.
    loads : Mapping[str, ndarray]
        By component [N, N m].
    high_speed : Channel or None
        The channel of the high-speed shaft that Mx was read from; None where it is the rotor's.
    ratio : float or None
        Speed of the generator over that of the rotor.

    Raises
    ------
    InputError
        A ratio is given, and Mx is the rotor's own torque.
    """
    if high_speed is None:
        if ratio is not None:
            raise InputError(
                f"hub loads '{source}': gearbox_ratio is {ratio:g}, but no torque of the "
                "high-speed shaft is read: leave it out, or map high-speed torque"
            )
        return dict(loads), TorqueAt("", {})
    if ratio is None:
        words = "Mx is the torque of the high-speed shaft, not the rotor's"
        return dict(loads), TorqueAt(words, {TORQUE_OF: HIGH_SPEED})
    words = f"Mx times the gearbox ratio {ratio:g}, without losses and inertia between"
    return {**loads, "Mx": ratio * loads["Mx"]}, TorqueAt(words, {})
