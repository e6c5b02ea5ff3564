"""Channels of a campaign: a team's own measurements and virtual ones go in by the same door.

A channel file is CSV with units in its header, ``time [s],torque [kN m],...``, and a mapping says
which column is which channel, with its sign and, where the header has none, its unit.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY, ONE_RPM
from fe_drivetrain.common.csv_cells import SafeWriter
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.turbine_loads.hub_loads.csv_columns import csv_channels

_TURN = np.pi / 180.0
_UNITS: Mapping[str, tuple[float, str]] = {
    unit: (size, base)
    for base, sizes in {
        "s": {"s": 1.0, "ms": 1e-3},
        "N": {"N": 1.0, "kN": 1e3, "MN": 1e6},
        "N m": {"Nm": 1.0, "kNm": 1e3, "MNm": 1e6},
        "rad": {"rad": 1.0, "deg": _TURN},
        "rad/s": {"rad/s": 1.0, "rpm": ONE_RPM, "deg/s": _TURN},
        "m": {"m": 1.0, "mm": 1e-3, "um": 1e-6},
        "m/s": {"m/s": 1.0},
        "m/s^2": {"m/s^2": 1.0, "m/s2": 1.0, "g": GRAVITY},
        "rad/s^2": {"rad/s^2": 1.0, "rad/s2": 1.0},
        "W": {"W": 1.0, "kW": 1e3, "MW": 1e6},
        "C": {"C": 1.0, "degC": 1.0},
        "": {"": 1.0, "-": 1.0},
        "Pa": {"Pa": 1.0, "kPa": 1e3, "bar": 1e5, "MPa": 1e6},
    }.items()
    for unit, size in sizes.items()
}
_UNEVEN = 1e-3
"""Share of the step by which a sample may be late in a history that counts as even."""


class ChannelFile(BaseModel):
    """A file of channels, and how it calls them.

    Attributes
    ----------
    file : str
        CSV with names and units in its header.
    channels : dict
        The column of each channel; a minus before it turns its sign. Others keep their names.
    units : dict
        Unit of columns, by the file's names, where the header has none or a wrong one.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    file: str = Field(min_length=1, description="CSV with a header such as time [s],torque [kN m]")
    channels: dict[str, str] = Field(
        default_factory=dict,
        description="the column of each channel; a minus before it turns its sign",
    )
    units: dict[str, str] = Field(
        default_factory=dict, description="units of columns whose header has none"
    )


@dataclass(frozen=True, eq=False)
class Channels:
    """Channels of one recording, in SI units.

    Attributes
    ----------
    source : str
        The file, for messages.
    span : tuple of float
        Time of the first and of the last sample, as the file has it [s].
    step : float
        Between two samples [s].
    values : Mapping[str, ndarray]
        (n,) of each.
    units : Mapping[str, str]
        SI unit of each.
    """

    source: str
    span: tuple[float, float]
    step: float
    values: Mapping[str, Floats]
    units: Mapping[str, str]

    __repr__ = short_repr

    def of(self, name: str) -> Floats:
        """Samples of a channel.

        Parameters
        ----------
        name : str
            Name in the mapping, or in the file.

        Raises
        ------
        InputError
            There is none.
        """
        if name not in self.values:
            raise InputError(
                f"{self.source} has no channel {name!r}: use one of {', '.join(self.values)}, or "
                "map it under channels"
            )
        return self.values[name]


def missing_file(given: ChannelFile | None, folder: Path) -> str:
    """That a file is not there, in a sentence; empty where it is, or is not asked for.

    Parameters
    ----------
    given : ChannelFile or None
        The file.
    folder : Path
        What its name is relative to.
    """
    if given is None or (folder / given.file).is_file():
        return ""
    return f"there is no file {folder / given.file}: record it, or run the case that writes it"


def read_channels(given: ChannelFile, folder: Path, wanted: frozenset[str]) -> Channels:
    """Read some channels of a file.

    Parameters
    ----------
    given : ChannelFile
        The file and its mapping.
    folder : Path
        What the file's name is relative to.
    wanted : frozenset of str
        Channels; time is read in any case.

    Returns
    -------
    Channels

    Raises
    ------
    InputError
        The file cannot be read, has no such channel, a unit is unknown, samples are not finite, or
        the step is not uniform.
    """
    if absent := missing_file(given, folder):
        raise InputError(absent)
    file = folder / given.file
    columns = {name: given.channels.get(name, name) for name in ("time", *sorted(wanted))}
    bare = {name: text.removeprefix("-").strip() for name, text in columns.items()}
    found = csv_channels(file, {name.lower() for name in bare.values()}, given.units)
    units = {name.lower(): unit for name, unit in given.units.items()}
    values, bases = {}, {}
    for name, column in bare.items():
        channel = found.get(column.lower())
        if channel is None:
            known = ", ".join(f"{c.name} [{c.unit}]" for c in list(found.values())[:12])
            known = known or "no column with a unit"
            raise InputError(
                f"{file} has no column {column!r} with a unit for the channel {name!r}; it has "
                f"{known}: map the channel, or state the unit under units"
            )
        unit = units.get(column.lower(), channel.unit)
        size, base = _unit(file, channel.name, unit)
        sign = -1.0 if columns[name].startswith("-") else 1.0
        if not np.isfinite(channel.values).all():
            raise InputError(
                f"{file}: column {channel.name!r} has a sample that is not finite: remove it"
            )
        values[name], bases[name] = np.asarray(sign * size * channel.values), base
    time, unit = values.pop("time"), bases.pop("time")
    step = _step(file, time, unit)
    return Channels(str(file), (float(time[0]), float(time[-1])), step, values, bases)


def _unit(file: Path, name: str, unit: str) -> tuple[float, str]:
    plain = unit.replace(" ", "").replace("*", "").replace("·", "").replace("N-m", "Nm")
    if plain not in _UNITS:
        raise InputError(
            f"{file}: column {name!r} has the unit {unit!r}, not one of "
            f"{', '.join(u for u in _UNITS if u)}: correct it under units"
        )
    return _UNITS[plain]


def _step(file: Path, time: Floats, unit: str) -> float:
    if unit != "s":
        raise InputError(f"{file}: time has no unit of time: give it in s or ms")
    if len(time) < 2:
        raise InputError(f"{file} has {len(time)} samples, but two are needed: give a longer one")
    step = float(time[-1] - time[0]) / (len(time) - 1)
    late = np.abs(time - time[0] - step * np.arange(len(time)))
    if not step > 0.0 or late.max() > _UNEVEN * step * max(1.0, 1e-3 * len(time)):
        row = int(late.argmax())
        raise InputError(
            f"{file}: time is not uniform: sample {row + 1} at {time[row]:g} s is {late[row]:g} s "
            f"from where a step of {step:g} s has it: resample the file"
        )
    return step


def write_channels(path: str | Path, step: float, columns: Mapping[str, Floats]) -> None:
    """Write channels as `read_channels` reads them.

    Parameters
    ----------
    path : str or Path
        File, which appears whole.
    step : float
        Between two samples [s].
    columns : mapping of str to ndarray, (n,)
        By name and unit, as in "torque [N m]".
    """
    count = len(next(iter(columns.values())))
    table = np.column_stack([np.arange(count) * step, *columns.values()])
    with atomic_path(Path(path)) as hidden, hidden.open("w", newline="") as file:
        writer = SafeWriter(file)
        writer.writerow(["time [s]", *columns])
        writer.writerows([[repr(float(value)) for value in row] for row in table])
