"""Hub loads with the rotor's speed and the wind beside them, whatever a file calls its channels."""

from __future__ import annotations

import csv
import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.hub_loads.channels import Channel, existing_file, in_si
from fe_drivetrain.hub_loads.csv_table import read_csv
from fe_drivetrain.hub_loads.files import SUFFIXES, hub_load_files
from fe_drivetrain.hub_loads.histories import (
    MIN_SAMPLES,
    Attribute,
    LoadHistory,
    require_sound,
)
from fe_drivetrain.hub_loads.openfast import LOAD_CHANNELS, loads_from_channels
from fe_drivetrain.hub_loads.openfast_output import openfast_channels

SPEED_UNITS = {"rad/s": 1.0, "rpm": np.pi / 30.0, "deg/s": np.pi / 180.0}
WIND_UNITS = {"m/s": 1.0}

KNOWN = {
    "rotor speed": ("rotor speed", "RotSpeed", "LSSTipVxa", "LSSTipVxs", "LSSTipV"),
    "wind speed": ("wind speed", "RtVAvgxh", "WindHubVelX", "Wind1VelX", "HorWindV", "WindVxi"),
}
"""Channels beside the loads, and by which names files have them, the best first."""

#: Names of OpenFAST, under which mapped loads are read; time, too.
_STANDARD = {
    "time": "time",
    "Fx": "lsshftfxa",
    "Fy": "lsshftfys",
    "Fz": "lsshftfzs",
    "Mx": "rottorq",
    "My": "lsstipmys",
    "Mz": "lsstipmzs",
}

NAMES = (*_STANDARD, *KNOWN)
"""What a channel of a file can be named as."""


@dataclass(frozen=True, eq=False)
class Recorded:
    """A history with what was recorded beside it.

    Attributes
    ----------
    history : LoadHistory
        The hub loads.
    rotor_speed : ndarray, (n,) or None
        [rad/s].
    wind_speed : ndarray, (n,) or None
        [m/s].
    """

    history: LoadHistory
    rotor_speed: Floats | None = None
    wind_speed: Floats | None = None


def recorded_files(patterns: list[str]) -> list[Path]:
    """Files that several patterns find, each once; see `hub_load_files`."""
    found = [file for pattern in patterns for file in hub_load_files(pattern)]
    return list(dict.fromkeys(found))


def read_recorded(
    path: Path, columns: Mapping[str, str] | None = None, skip: float = 0.0
) -> Recorded:
    """Read a history of any format, with rotor speed and wind speed where the file has them.

    Parameters
    ----------
    path : Path
        A .out or .outb of OpenFAST, or a .csv.
    columns : mapping, optional
        What a channel is (of `NAMES`), and how the file calls it, in upper or lower case; a load
        that is mapped does not turn with the rotor and is in the shaft frame, at the hub.
    skip : float
        What is left out at the beginning [s].

    Raises
    ------
    InputError
        The file cannot be read, or has no channel of a name.
    """
    file = existing_file(path)
    mapped = dict(columns or {})
    if wrong := [name for name in mapped if name not in NAMES]:
        raise InputError(f"channel '{wrong[0]}' is not one of {', '.join(NAMES)}")
    suffix = file.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(
            f"hub loads '{file}': the suffix '{file.suffix}' is not one of {', '.join(SUFFIXES)}; "
            "convert the file or rename it"
        )
    loads_mapped = [name for name in mapped if name in _STANDARD]
    known = [name for names in KNOWN.values() for name in names]
    wanted = {n.lower() for n in (*_STANDARD, *known, *mapped.values())}
    if suffix == ".csv":
        channels = csv_channels(file, wanted)
    else:
        channels = openfast_channels(file, wanted | LOAD_CHANNELS)
    named = {name: _named(file, channels, column) for name, column in mapped.items()}
    attributes: dict[str, Attribute] = {}
    if suffix == ".csv" and not loads_mapped:
        history = read_csv(file)
    else:
        if suffix == ".csv":  # the seven columns of a table, but for those that are mapped
            shared = {name: channels.get(name.lower()) for name in _STANDARD}
            channels |= {_STANDARD[n]: c for n, c in shared.items() if c is not None}
        channels |= {_STANDARD[name]: named[name] for name in loads_mapped}
        time, loads, read = loads_from_channels(str(file), channels)
        attributes = {"source": file.name, "channels": read}
        history = LoadHistory(file.stem, time, loads, attributes)
    beside = {}
    for name, units in (("rotor speed", SPEED_UNITS), ("wind speed", WIND_UNITS)):
        candidates = (channels.get(candidate.lower()) for candidate in KNOWN[name])
        channel = named.get(name) or next((c for c in candidates if c is not None), None)
        if channel is not None:
            beside[name] = in_si(str(file), channel, units)
            require_sound(f"hub loads '{file}'", history.time, {channel.name: beside[name]})
    kept = history.time >= history.time[0] + skip
    if kept.sum() < MIN_SAMPLES:
        raise InputError(
            f"hub loads '{file}': it lasts {history.seconds:g} s, so that nothing is left without "
            f"the first {skip:g} s: skip less"
        )
    speed, wind = (beside.get(name) for name in KNOWN)
    return Recorded(
        replace(history, time=history.time[kept], loads=history.loads[kept]),
        None if speed is None else speed[kept],
        None if wind is None else wind[kept],
    )


def csv_channels(file: Path, wanted: Collection[str]) -> dict[str, Channel]:
    """Columns of a table that have a unit, by their names in lower case.

    Parameters
    ----------
    file : Path
        A table with a header like ``time [s],thrust [kN]``; lines with # before it are left out.
    wanted : collection of str
        Names in lower case; other columns have no values, so that a large table is read in the
        memory of what is used.

    Raises
    ------
    InputError
        A cell of a wanted column is not a number.
    """
    before, titles = 0, ""
    try:
        with file.open(encoding="utf-8-sig") as stream:
            for before, line in enumerate(stream, 1):  # noqa: B007
                if line.strip() and not line.startswith("#"):
                    titles = line
                    break
    except UnicodeDecodeError as error:
        raise InputError(f"hub loads '{file}': not UTF-8 text; save it as UTF-8 CSV") from error
    found: dict[str, Channel] = {}
    places: list[int] = []
    for place, title in enumerate(next(csv.reader([titles]), [])):
        match = re.fullmatch(r"\s*(.+?)\s*[\[(]\s*(.*?)\s*[\])]\s*", title)
        if match is not None and match[1].lower() not in found:
            found[match[1].lower()] = Channel(match[1], match[2], np.zeros(0))
            if match[1].lower() in wanted:
                places.append(place)
    if not places:
        return found
    try:
        values = np.loadtxt(
            file, delimiter=",", skiprows=before, usecols=places, ndmin=2, encoding="utf-8-sig"
        )
    except ValueError as error:
        raise InputError(
            f"hub loads '{file}': {error}, counted below the header: correct the cell, or remove "
            "the line"
        ) from error
    used = [name for name in found if name in wanted]
    for name, column in zip(used, values.T, strict=True):
        found[name] = Channel(found[name].name, found[name].unit, column)
    return found


def _named(file: Path, channels: Mapping[str, Channel], column: str) -> Channel:
    found = channels.get(column.lower())
    if found is None:
        names = ", ".join(channel.name for channel in list(channels.values())[:12])
        raise InputError(
            f"hub loads '{file}': there is no channel '{column}'; it has {names}"
            + (" and others" if len(channels) > 12 else "")
        )
    return found
