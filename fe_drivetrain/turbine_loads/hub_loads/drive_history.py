"""What drives a drivetrain in a file: hub loads, speeds, and the generator's torque where it is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap
from fe_drivetrain.turbine_loads.hub_loads.channels import MOMENT_UNITS, Channel, in_si
from fe_drivetrain.turbine_loads.hub_loads.csv_columns import csv_channels
from fe_drivetrain.turbine_loads.hub_loads.histories import require_all_loads, require_even
from fe_drivetrain.turbine_loads.hub_loads.openfast_output import openfast_channels
from fe_drivetrain.turbine_loads.hub_loads.recorded import OWN_NAMES, SPEED_UNITS, read_recorded
from fe_drivetrain.turbine_loads.hub_loads.table_kinds import is_table

TORQUE, SPEED = "GenTq", "GenSpeed"
"""Names of the generator's torque and speed in files of OpenFAST, and in tables."""

_UNITS: Mapping[str, Mapping[str, float]] = {TORQUE: MOMENT_UNITS, SPEED: SPEED_UNITS}


@dataclass(frozen=True, eq=False)
class DriveHistory:
    """What drives a drivetrain, over time.

    Attributes
    ----------
    name : str
        Name of the history.
    time : ndarray, (n,)
        [s].
    loads : ndarray, (n, 6)
        Fx, Fy, Fz, Mx, My, Mz that the shaft feels at the hub [N, N m]; the torque Mx alone where
        others were not recorded.
    absent : tuple of str
        Loads that were not recorded.
    rotor_speed : ndarray, (n,) or None
        [rad/s].
    generator_torque : ndarray, (n,) or None
        Torque of the generator against its motion [N m].
    generator_speed : ndarray, (n,) or None
        [rad/s].
    wind : float
        Mean wind speed [m/s]; NaN where it was not recorded.
    """

    name: str
    time: Floats
    loads: Floats
    absent: tuple[str, ...]
    rotor_speed: Floats | None
    generator_torque: Floats | None
    generator_speed: Floats | None
    wind: float = np.nan

    __repr__ = short_repr

    @property
    def torque(self) -> Floats:
        """(n,) torque of the main shaft at the hub [N m]."""
        return self.loads[:, FORCES.index("Mx")]

    @property
    def has_all(self) -> bool:
        """Whether all six loads were recorded."""
        return not self.absent

    @property
    def seconds(self) -> float:
        """From the first sample to the last [s]."""
        return float(self.time[-1] - self.time[0])


def read_drive(path: Path, mapping: ChannelMap = OWN_NAMES, skip: float = 0.0) -> DriveHistory:
    """Read what drives a drivetrain.

    Parameters
    ----------
    path : Path
        A .out or .outb of OpenFAST, or a table: see `history_table`.
    mapping : ChannelMap
        How the file calls its channels, and their frame and origin.
    skip : float
        What is left out at the beginning [s].

    Raises
    ------
    InputError
        The file cannot be read, or has no torque.
    """
    there = csv_channels(path, ()) if is_table(path) else openfast_channels(path, ())
    also = [name for name in (TORQUE, SPEED) if name.lower() in there]
    recorded = read_recorded(path, mapping, skip, also, measured=True)
    beside = dict(zip(also, recorded.others.values(), strict=True))
    of_generator = {
        name: in_si(str(path), Channel(name, there[name.lower()].unit, values), _UNITS[name])
        for name, values in beside.items()
    }
    history, torque = recorded.history, FORCES.index("Mx")
    if history.torque_of:
        require_all_loads(replace(history, loads=np.nan_to_num(history.loads)))
    if "Mx" in history.absent:
        raise InputError(
            f"hub loads '{path}': it has no torque Mx, which drives a drivetrain: add RotTorq to "
            "OutList, or map yours"
        )
    require_even(history)
    loads = history.loads
    if history.absent:
        loads = np.zeros_like(loads)
        loads[:, torque] = history.loads[:, torque]
    return DriveHistory(
        history.name,
        history.time,
        loads,
        history.absent,
        recorded.rotor_speed,
        of_generator.get(TORQUE),
        of_generator.get(SPEED),
        np.nan if recorded.wind_speed is None else float(recorded.wind_speed.mean()),
    )
