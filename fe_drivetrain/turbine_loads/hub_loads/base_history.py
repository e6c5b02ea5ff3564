"""Acceleration of a nacelle over time in a file, of OpenFAST or measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.turbine_loads.hub_loads.channel_map import (
    ACCELERATIONS,
    ChannelMap,
    to_shaft_frame,
)
from fe_drivetrain.turbine_loads.hub_loads.channels import (
    ACCELERATION_UNITS,
    ANGLE_UNITS,
    LENGTH_UNITS,
    TIME_UNITS,
    TURN_UNITS,
    Channel,
    existing_file,
    in_si,
)
from fe_drivetrain.turbine_loads.hub_loads.csv_columns import csv_channels
from fe_drivetrain.turbine_loads.hub_loads.histories import MIN_SAMPLES, require_sound
from fe_drivetrain.turbine_loads.hub_loads.openfast_output import openfast_channels
from fe_drivetrain.turbine_loads.hub_loads.recorded import OWN_NAMES
from fe_drivetrain.turbine_loads.hub_loads.table_kinds import is_table, require_kind
from fe_drivetrain.turbine_loads.hub_loads.table_names import TABLE_NAMES

KIND = "motion of a nacelle"
"""What a file is, for messages."""

FASTEST = 1e3
"""Largest acceleration that is taken for one [m/s^2, rad/s^2]: a hundred times that of gravity."""


class _Set(NamedTuple):
    """Names of six channels, along and about x, y, z.

    Attributes
    ----------
    names : tuple of str
        Names, as files have them.
    displacement : bool
        Whether they are displacements, whose second derivative is taken.
    horizontal : bool
        Whether their x is horizontal rather than along the shaft.
    """

    names: tuple[str, ...]
    displacement: bool = False
    horizontal: bool = False


def _named(along: str, about: str) -> tuple[str, ...]:
    return tuple(pattern.format(axis) for pattern in (along, about) for axis in "xyz")


_OPENFAST = (
    _Set(_named("NcIMUTA{}s", "NcIMURA{}s")),
    _Set(_named("YawBrTA{}p", "YawBrRA{}p"), horizontal=True),
    _Set(_named("YawBrTD{}p", "YawBrRD{}p"), displacement=True, horizontal=True),
)
"""Channels of OpenFAST, the best first: the nacelle's sensor, the top of the tower, its motion."""

_TABLES = (_Set(ACCELERATIONS), _Set(_named("u{}", "r{}"), displacement=True), *_OPENFAST)


@dataclass(frozen=True)
class BaseReading:
    """How the acceleration of a nacelle is read.

    Attributes
    ----------
    place : tuple of float
        Place (x, y, z) of the sensor from the rotor's centre, in the shaft's frame [m].
    keep_mean : bool
        Whether the mean of each channel stays. A nacelle that goes on standing has none: what a
        sensor has of it is gravity or drift.
    """

    place: tuple[float, float, float] = (0.0, 0.0, 0.0)
    keep_mean: bool = False


@dataclass(frozen=True)
class BaseFacts:
    """What an acceleration of a nacelle amounts to.

    Attributes
    ----------
    read : str
        What was read, and what was done to it.
    seconds : float
        From the first sample to the last [s].
    largest : tuple of float
        Largest acceleration along and about x, y, z [m/s^2, rad/s^2].
    rms : tuple of float
        Root of the mean square along x, y, z [m/s^2].
    mean : float
        Largest mean along x, y, z that was taken off, or is kept [m/s^2].
    missed : float
        What lines between samples miss of the acceleration, RMS, over its RMS.
    """

    read: str
    seconds: float
    largest: tuple[float, ...]
    rms: tuple[float, ...]
    mean: float
    missed: float

    @property
    def turns(self) -> bool:
        """Whether the nacelle turns, too."""
        return any(self.largest[3:])


@dataclass(frozen=True, eq=False)
class BaseHistory:
    """Acceleration of a nacelle over time.

    Attributes
    ----------
    name : str
        Name of the history.
    time : ndarray, (n,)
        [s].
    accelerations : ndarray, (n, 6)
        Along and about x, y, z of the shaft's frame, of the rotor's centre [m/s^2, rad/s^2].
    read : str
        What was read, and what was done to it.
    mean : ndarray, (6,)
        Mean that was taken off, or that is kept [m/s^2, rad/s^2].
    """

    name: str
    time: Floats
    accelerations: Floats
    read: str
    mean: Floats

    __repr__ = short_repr

    @property
    def seconds(self) -> float:
        """From the first sample to the last [s]."""
        return float(self.time[-1] - self.time[0])

    @property
    def facts(self) -> BaseFacts:
        """What it amounts to.

        A curve with the second difference d of its samples leaves the line between two of them by
        d/8 at most.
        """
        along = self.accelerations[:, :3]
        a = along - along.mean(axis=0)
        bent = np.diff(a, 2, axis=0) / 8.0
        return BaseFacts(
            self.read,
            self.seconds,
            tuple(np.abs(self.accelerations).max(axis=0).tolist()),
            tuple(np.sqrt((along**2).mean(axis=0)).tolist()),
            float(np.abs(self.mean[:3]).max()),
            float(np.sqrt((bent**2).sum() / max(float((a**2).sum()), 1e-300))),
        )


def read_base_history(
    path: Path,
    mapping: ChannelMap = OWN_NAMES,
    skip: float = 0.0,
    reading: BaseReading | None = None,
) -> BaseHistory:
    """Read how a nacelle moves.

    Parameters
    ----------
    path : Path
        A .out or .outb of OpenFAST with NcIMUTAxs and others, or else YawBrTAxp, or else the
        displacements YawBrTDxp; or a table with some of ax, ay, az [m/s^2], arx, ary, arz
        [rad/s^2], or ux [m] to rz [rad], or any names that the mapping has for the first.
    mapping : ChannelMap
        How the file calls its channels, their units, and the tilt of the shaft where its x is
        horizontal.
    skip : float
        What is left out at the beginning [s].
    reading : BaseReading, optional
        Where the sensor is, and whether means stay.

    Raises
    ------
    InputError
        The file cannot be read, or has no such channel.
    """
    from scipy.interpolate import CubicSpline

    file, reading = existing_file(path, KIND), reading or BaseReading()
    require_kind(file, KIND)
    channels = _channels(file, mapping)
    time = in_si(str(file), _time(file, channels, mapping), TIME_UNITS, KIND)
    found, chosen = _chosen(file, channels, mapping)
    values = np.zeros((len(time), 6))
    for k, channel in found.items():
        values[:, k] = _in_si(file, channel, k, chosen.displacement)
    columns = {channel.name: values[:, k] for k, channel in found.items()}
    require_sound(f"{KIND} '{file}'", time, columns)
    read = ", ".join(f"{one.name} [{one.unit.strip('()')}]" for one in found.values())
    if not np.ptp(values, axis=0).any():
        raise InputError(
            f"{KIND} '{file}': {read} never changes, so that nothing moves: let the model's tower "
            "bend, or name other channels"
        )
    if chosen.displacement:
        values = np.asarray(CubicSpline(time, values)(time, 2))
        read += ", differentiated twice"
    if mapping.tilt and not chosen.horizontal and not _is_mapped(mapping):
        raise InputError(
            f"{KIND} '{file}': {read} is along the shaft already: leave out tilt, or map channels "
            "of a horizontal frame"
        )
    if mapping.tilt:
        values = to_shaft_frame(values, mapping.tilt)
        read += f", turned by the shaft's tilt of {mapping.tilt:g} deg"
    _require_possible(file, time, values)
    kept = time >= time[0] + skip
    if kept.sum() < MIN_SAMPLES:
        raise InputError(
            f"{KIND} '{file}': it lasts {time[-1] - time[0]:g} s, so that nothing is left without "
            f"the first {skip:g} s: skip less"
        )
    return _at_centre(file.stem, time[kept], values[kept], read, reading)


def _require_possible(file: Path, time: Floats, values: Floats) -> None:
    """Refuse accelerations (n, 6) that no nacelle has, as of a column in another unit."""
    if (peak := float(np.abs(values).max())) > FASTEST:
        at = time[np.abs(values).max(axis=1).argmax()]
        raise InputError(
            f"{KIND} '{file}': its acceleration is {peak:g} m/s^2 or rad/s^2 at t = {at:g} s but "
            f"must be at most {FASTEST:g}: check units in the heads of columns"
        )


def _at_centre(
    name: str, time: Floats, values: Floats, read: str, reading: BaseReading
) -> BaseHistory:
    """The history about the rotor's centre, without its mean where that is not kept."""
    from scipy.integrate import trapezoid

    carried = values.copy()
    carried[:, :3] -= np.cross(values[:, 3:], np.array(reading.place))
    mean = np.asarray(trapezoid(carried, time, axis=0) / (time[-1] - time[0]))
    if not reading.keep_mean:
        carried -= np.where(carried.any(axis=0), mean, 0.0)
    return BaseHistory(name, time, carried, read, mean)


def _channels(file: Path, mapping: ChannelMap) -> dict[str, Channel]:
    """Channels of the file that may be read, by their names in lower case."""
    wanted = {name.lower() for one in _TABLES for name in one.names}
    wanted |= {mapping.column(name)[0].lower() for name in mapping.channels}
    times = {"time", *TABLE_NAMES["time"]}
    if "time" in mapping.channels:
        times = {mapping.column("time")[0].lower()}
    if is_table(file):
        found = csv_channels(file, wanted | times, mapping.units, times=times)
    else:
        found = openfast_channels(file, wanted | {"time"})
    units = {name.lower(): unit for name, unit in mapping.units.items()}
    return {
        key: Channel(one.name, units.get(key, one.unit), one.values, one.note, one.rows)
        for key, one in found.items()
        if not one.invalid
    }


def _time(file: Path, channels: Mapping[str, Channel], mapping: ChannelMap) -> Channel:
    own = mapping.channels.get("time")
    names = [own.lower()] if own else ["time", *TABLE_NAMES["time"]]
    found = next((channels[name] for name in names if name in channels), None)
    if found is None:
        raise InputError(f"{KIND} '{file}': it has no column {names[0]} [s]: add it, or map yours")
    return found


def _is_mapped(mapping: ChannelMap) -> bool:
    return any(name in mapping.channels for name in ACCELERATIONS)


def _chosen(
    file: Path, channels: Mapping[str, Channel], mapping: ChannelMap
) -> tuple[dict[int, Channel], _Set]:
    """Channels by their place in the six motions, and the names that they are of."""
    if _is_mapped(mapping):
        return _mapped(file, channels, mapping), _TABLES[0]
    for one in _TABLES if is_table(file) else _OPENFAST:
        there = {
            k: channels[name.lower()]
            for k, name in enumerate(one.names)
            if name.lower() in channels
        }
        if there:
            return there, one
    raise InputError(
        f"{KIND} '{file}': it has none of NcIMUTAxs, YawBrTAxp, YawBrTDxp of OpenFAST, and no "
        "column ax [m/s^2] to arz [rad/s^2] or ux [m] to rz [rad]: add one of them to OutList, or "
        "map yours, as in ax: ACC_X"
    )


def _mapped(file: Path, channels: Mapping[str, Channel], mapping: ChannelMap) -> dict[int, Channel]:
    found = {}
    for k, name in enumerate(ACCELERATIONS):
        if name not in mapping.channels:
            continue
        column, sign = mapping.column(name)
        one = channels.get(column.lower())
        if one is None:
            raise InputError(
                f"{KIND} '{file}': there is no channel '{column}', which is mapped as {name}: "
                "correct the mapping"
            )
        found[k] = Channel(("-" if sign < 0.0 else "") + one.name, one.unit, sign * one.values)
    return found


def _in_si(file: Path, channel: Channel, k: int, displacement: bool) -> Floats:
    along, about = ACCELERATION_UNITS, TURN_UNITS
    if displacement:
        along, about = LENGTH_UNITS, ANGLE_UNITS
    return in_si(str(file), channel, along if k < 3 else about, KIND)
