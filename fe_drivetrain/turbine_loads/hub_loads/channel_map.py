"""How someone's files call their channels, and in which frame and about which point loads are."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, field_validator

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import parse_mapping, read_text, validated

HIGH_SPEED_TORQUE = "high-speed torque"
"""Torque of the generator's shaft, as its channel is mapped; the gearbox ratio makes Mx of it."""

LOAD_NAMES = {
    "time": "time",
    "Fx": "lsshftfxa",
    "Fy": "lsshftfys",
    "Fz": "lsshftfzs",
    "Mx": "rottorq",
    "My": "lsstipmys",
    "Mz": "lsstipmzs",
    "azimuth": "lsstippxa",
    HIGH_SPEED_TORQUE: "gentq",
}
"""What is read by `loads_from_channels`, and the name of OpenFAST that it is read under."""

ACCELERATIONS = ("ax", "ay", "az", "arx", "ary", "arz")
"""Accelerations of a nacelle, along and about x, y and z of the shaft's frame."""

NAMES = (*LOAD_NAMES, "rotor speed", "generator speed", "wind speed", *ACCELERATIONS)
"""What a channel of a file can be mapped as."""

_ACROSS = ("Fy", "Fz", "My", "Mz")


class ChannelMap(BaseModel):
    """Names, signs, units, frame and origin of the loads in someone's files.

    Attributes
    ----------
    channels : dict
        What a channel is, of `NAMES`, and how the files call it, in upper or lower case; a minus
        before it turns its sign.
    units : dict
        Unit of columns, by the files' names, where the header has none or a wrong one.
    rotating : bool
        Fy, Fz, My, Mz of a table, or those that are mapped, turn with the rotor; the files need an
        azimuth then.
    azimuth_blade1_up : float
        Azimuth that is written when blade 1 points up [deg].
    tilt : float
        Tilt of the shaft, positive with the rotor raised, where loads are in a horizontal frame:
        they are turned into the shaft's [deg].
    moments_at : float
        How far downwind of the hub along the shaft the point is that moments are about, where it
        is not the hub; of OpenFAST's LSSGagM channels, ShftGagL [m].
    gearbox_ratio : float or None
        Speed of the generator over that of the rotor: a torque that files have at the high-speed
        shaft alone, as GenTq, becomes the rotor's Mx, without losses and inertia between, and a
        speed of the generator alone that of the rotor.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    channels: dict[str, str] = Field(default_factory=dict)
    units: dict[str, str] = Field(default_factory=dict)
    rotating: bool = False
    azimuth_blade1_up: Annotated[float, Field(ge=-360.0, le=360.0)] = 0.0
    tilt: Annotated[float, Field(ge=-30.0, le=30.0)] = 0.0
    moments_at: Annotated[float, Field(ge=-20.0, le=20.0)] = 0.0
    gearbox_ratio: Annotated[float, Field(ge=1.0, le=1000.0)] | None = None

    @field_validator("channels")
    @classmethod
    def _known(cls, channels: dict[str, str]) -> dict[str, str]:
        for name in channels:
            if name not in NAMES:
                raise InputError(f"channel '{name}' is not one of {', '.join(NAMES)}")
        return channels

    @field_validator("tilt")
    @classmethod
    def _one_frame(cls, tilt: float, info: object) -> float:
        if tilt and getattr(info, "data", {}).get("rotating"):
            raise InputError(
                "rotating loads are about the shaft's own axis, which has no tilt: leave out tilt "
                "or rotating"
            )
        return tilt

    @property
    def loads_mapped(self) -> list[str]:
        """Mapped channels that loads are made of."""
        return [name for name in self.channels if name in LOAD_NAMES]

    def column(self, name: str) -> tuple[str, float]:
        """Name in the files and sign of a mapped channel."""
        text = self.channels[name]
        return text.removeprefix("-").strip(), -1.0 if text.startswith("-") else 1.0

    def read_as(self, name: str) -> str:
        """The name of OpenFAST, in lower case, that a mapped load is read under."""
        standard = LOAD_NAMES[name]
        return f"{standard[:-1]}a" if self.rotating and name in _ACROSS else standard

    def with_columns(self, columns: Mapping[str, str]) -> ChannelMap:
        """The same, but for what some channels are called."""
        return self.model_copy(update={"channels": {**self.channels, **columns}})

    def content(self) -> dict[str, object]:
        """All of it, as plain data."""
        return self.model_dump(mode="json")


def read_channel_map(path: str | Path) -> ChannelMap:
    """Read a mapping of channels.

    Parameters
    ----------
    path : str or Path
        YAML with the attributes of `ChannelMap` as keys.

    Raises
    ------
    InputError
        The file cannot be read, or a key or value is wrong.
    """
    source = f"mapping file {path}"
    return validated(ChannelMap, parse_mapping(read_text(path, "mapping"), source), source)


def to_shaft_frame(loads: Floats, tilt: float) -> Floats:
    """Loads (n, 6) of a horizontal frame in the frame of a shaft whose rotor is raised.

    Parameters
    ----------
    loads : ndarray, (n, 6)
        Forces and moments; x horizontal downwind, z up.
    tilt : float
        Tilt of the shaft [deg].
    """
    cos, sin = np.cos(np.radians(tilt)), np.sin(np.radians(tilt))
    turned = loads.copy()
    for first in (0, 3):  # downwind along the shaft leads downwards
        x, z = loads[:, first], loads[:, first + 2]
        turned[:, first], turned[:, first + 2] = cos * x - sin * z, sin * x + cos * z
    return turned
