"""Hub loads with the rotor's speed and the wind beside them, whatever a file calls its channels."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES, ONE_RPM
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.turbine_loads.hub_loads.channel_map import (
    LOAD_NAMES,
    ChannelMap,
    to_shaft_frame,
)
from fe_drivetrain.turbine_loads.hub_loads.channels import (
    ANGLE_UNITS,
    Channel,
    existing_file,
    in_si,
    without_unit,
)
from fe_drivetrain.turbine_loads.hub_loads.csv_columns import csv_channels
from fe_drivetrain.turbine_loads.hub_loads.csv_table import is_of_point, point_loads, read_csv
from fe_drivetrain.turbine_loads.hub_loads.files import files_of_patterns
from fe_drivetrain.turbine_loads.hub_loads.histories import (
    MIN_SAMPLES,
    LoadHistory,
    require_sound,
    require_variation,
)
from fe_drivetrain.turbine_loads.hub_loads.openfast import (
    AZIMUTH,
    LOAD_CHANNELS,
    loads_from_channels,
    turn_to_fixed,
)
from fe_drivetrain.turbine_loads.hub_loads.openfast_output import openfast_channels
from fe_drivetrain.turbine_loads.hub_loads.point_loads import moved_moments
from fe_drivetrain.turbine_loads.hub_loads.table_kinds import history_table, is_table, require_kind
from fe_drivetrain.turbine_loads.hub_loads.table_names import HUB, TABLE_NAMES, named_columns

SPEED_UNITS = {"rad/s": 1.0, "rpm": ONE_RPM, "deg/s": np.pi / 180.0}
WIND_UNITS = {"m/s": 1.0}

KNOWN = {
    "rotor speed": (
        *("rotor speed", "RotSpeed", "LSSTipVxa", "LSSTipVxs", "LSSTipV"),
        *("Rotordrehzahl", "Rotor-Drehzahl", "Omega"),
    ),
    "wind speed": (
        *("wind speed", "RtVAvgxh", "WindHubVelX", "Wind1VelX", "HorWindV", "WindVxi"),
        *("Windgeschwindigkeit", "Hub wind speed magnitude"),
    ),
}
"""Channels beside the loads, and by which names files have them, the best first."""

_GENERATOR_SPEEDS = ("generator speed", "GenSpeed", "HSS speed", "Generatordrehzahl")

_NOTHING_TURNED = ", nothing turned"

Files = str | os.PathLike[str] | Sequence[str | os.PathLike[str]]
"""A file, a folder or a pattern, or several of these."""

OWN_NAMES = ChannelMap()
"""Files whose channels have the names of OpenFAST, or of the tables that are written here."""


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
    others : Mapping[str, ndarray]
        Further channels (n,), each in the file's unit, by name and unit as in "BldPitch1 [deg]".
    """

    history: LoadHistory
    rotor_speed: Floats | None = None
    wind_speed: Floats | None = None
    others: Mapping[str, Floats] = field(default_factory=dict)

    __repr__ = short_repr


def recorded_files(files: Files) -> list[Path]:
    """Files that are named, or found by patterns, each once.

    Parameters
    ----------
    files : str, path, or sequence of these
        Files, folders, or patterns as ``"outputs/*.outb"``: see `files_of_patterns`.

    Raises
    ------
    InputError
        None is found, or a file that is named does not exist.
    """
    patterns = [files] if isinstance(files, str | os.PathLike) else files
    found = files_of_patterns([os.fspath(pattern) for pattern in patterns])
    return [existing_file(file) for file in found]


def short_name(file: Path, files: Sequence[Path]) -> str:
    """Name of a file in tables: its stem, or its whole path where another has the same stem.

    Parameters
    ----------
    file : Path
        The file.
    files : sequence of Path
        All files that are named beside each other.
    """
    return str(file) if sum(other.stem == file.stem for other in files) > 1 else file.stem


def read_recorded(
    path: Path,
    mapping: ChannelMap = OWN_NAMES,
    skip: float = 0.0,
    also: Sequence[str] = (),
    measured: bool = False,
) -> Recorded:
    """Read a history of any format, with rotor speed and wind speed where the file has them.

    Parameters
    ----------
    path : Path
        A .out or .outb of OpenFAST, or a table: see `history_table`.
    mapping : ChannelMap
        How the file calls its channels, and their frame and origin.
    skip : float
        What is left out at the beginning [s].
    also : sequence of str
        Further channels, as the file calls them.
    measured : bool
        Take what components there are, at whatever times: see `LoadHistory.measured`.

    Raises
    ------
    InputError
        The file cannot be read, or has no channel of a name.
    """
    file = existing_file(path)
    require_kind(file)
    table, loads_mapped = is_table(file), mapping.loads_mapped
    wanted = _wanted(mapping, also, table)
    channels = (
        csv_channels(file, wanted, mapping.units, bool(loads_mapped), _times(mapping))
        if table
        else openfast_channels(file, wanted | LOAD_CHANNELS)
    )
    for name in mapping.units:
        _named(file, channels, name, why="the mapping states its unit")
    units = {name.lower(): unit for name, unit in mapping.units.items()}
    channels = {n: replace(c, unit=units.get(n, c.unit)) for n, c in channels.items()}
    valid = {name: channel for name, channel in channels.items() if not channel.invalid}
    named = {name: _named(file, channels, *mapping.column(name)) for name in mapping.channels}
    further = [_named(file, channels, name) for name in also]
    azimuth = _azimuth(file, valid, named) if table and mapping.rotating else None
    if table and not loads_mapped:
        history = read_csv(file, measured, mapping.gearbox_ratio, mapping.units)
        if azimuth is not None:
            history = _turned_back(history, azimuth, mapping)
    else:
        history = _of_channels(file, channels, named, mapping, measured)
        if table:
            history = _with_points(file, history, channels, mapping, azimuth)
    history = _at_hub(history, mapping, own_names=not (table or loads_mapped))
    unread = [t for t in history.unread if without_unit(t).lower() not in wanted]
    history = replace(history, unread=tuple(unread))
    history, named = _with_ratio(history, valid, named, mapping.gearbox_ratio)
    beside = _beside_loads(file, history, valid, named)
    history = _with_invalid(history, (c for n, c in channels.items() if n in wanted))
    others = {f"{c.name} [{c.unit.strip('()')}]": c.values for c in further}
    require_sound(f"hub loads '{file}'", history.time, others, even=not measured)
    kept = history.time >= history.time[0] + skip
    if kept.sum() < MIN_SAMPLES:
        raise InputError(
            f"hub loads '{file}': it lasts {history.seconds:g} s, so that nothing is left without "
            f"the first {skip:g} s: skip less"
        )
    speed, wind = (beside.get(name) for name in KNOWN)
    return Recorded(
        history.between(float(history.time[0]) + skip),
        None if speed is None else speed[kept],
        None if wind is None else wind[kept],
        {name: values[kept] for name, values in others.items()},
    )


def _wanted(mapping: ChannelMap, also: Sequence[str], table: bool) -> set[str]:
    """Names in lower case of channels that are looked for, beside OpenFAST's loads."""
    known = (*KNOWN.values(), _GENERATOR_SPEEDS)
    beside_loads = [n.lower() for names in known for n in names]
    wanted = {*beside_loads, *(mapping.column(name)[0].lower() for name in mapping.channels)}
    wanted |= {name.lower() for name in also}
    if table and mapping.rotating:
        wanted |= {name.lower() for name in AZIMUTH}
    if table and mapping.loads_mapped:
        wanted |= {name.lower() for name in LOAD_NAMES} | LOAD_CHANNELS
        wanted |= {name for names in TABLE_NAMES.values() for name in names}
        wanted |= {f"{HUB}{name.lower()}" for name in FORCES}
    return wanted


def _times(mapping: ChannelMap) -> set[str]:
    """Names of the columns of a table that may hold date-times, in lower case."""
    own = mapping.channels.get("time")
    return {own.lower()} if own else {"time", *TABLE_NAMES["time"]}


def _beside_loads(
    file: Path,
    history: LoadHistory,
    channels: Mapping[str, Channel],
    named: Mapping[str, Channel],
) -> dict[str, Floats]:
    """Rotor speed [rad/s] and wind speed [m/s], where a file has them."""
    beside = {}
    for name, sizes in (("rotor speed", SPEED_UNITS), ("wind speed", WIND_UNITS)):
        candidates = (channels.get(candidate.lower()) for candidate in KNOWN[name])
        channel = named.get(name) or next((c for c in candidates if c is not None), None)
        if channel is not None:
            beside[name] = in_si(str(file), channel, sizes)
            found = {channel.name: beside[name]}
            require_sound(f"hub loads '{file}'", history.time, found, even=not history.measured)
    return beside


def _with_invalid(history: LoadHistory, beside: Iterable[Channel]) -> LoadHistory:
    """A history that states which channels beside the loads OpenFAST did not compute."""
    names = [channel.name for channel in beside if channel.invalid]
    if not names:
        return history
    read = f"{_read_of(history)}; not read, since INVALID in the file: {', '.join(names)}"
    return replace(history, attributes={**history.attributes, "channels": read})


def _with_ratio(
    history: LoadHistory,
    channels: Mapping[str, Channel],
    named: dict[str, Channel],
    ratio: float | None,
) -> tuple[LoadHistory, dict[str, Channel]]:
    """The rotor speed of a file that has that of the generator alone, and what was done."""
    known = {*named, *channels}
    if ratio is None or not known.isdisjoint(name.lower() for name in KNOWN["rotor speed"]):
        return history, named
    candidates = (channels.get(name.lower()) for name in _GENERATOR_SPEEDS)
    of_generator = named.get("generator speed") or next((c for c in candidates if c), None)
    if of_generator is None:
        return history, named
    title = f"{of_generator.name} [{of_generator.unit}]"
    read = f"{_read_of(history)}; rotor speed = {title} over the gearbox ratio {ratio:g}"
    speed = replace(of_generator, values=of_generator.values / ratio)
    attributes = {**history.attributes, "channels": read}
    return replace(history, attributes=attributes), {**named, "rotor speed": speed}


def read_mapped(mapping: ChannelMap, path: Path, skip: float = 0.0) -> LoadHistory:
    """Hub loads alone, as `read_recorded` reads them.

    Parameters
    ----------
    mapping : ChannelMap
        How the file calls its channels, and their frame and origin.
    path : Path
        The file.
    skip : float
        What is left out at the beginning [s].

    Raises
    ------
    InputError
        The same as for `read_recorded`, or the loads never vary.
    """
    history = read_recorded(path, mapping, skip).history
    require_variation(f"hub loads '{path}'", history.loads)
    return history


def _of_channels(
    file: Path,
    channels: dict[str, Channel],
    named: Mapping[str, Channel],
    mapping: ChannelMap,
    measured: bool,
) -> LoadHistory:
    """Loads of OpenFAST's channels, or of those that are mapped in their place."""
    if is_table(file):  # the columns of a table, but for those that are mapped
        taken = {mapping.column(name)[0].lower() for name in mapping.channels}
        own = [(key, channel) for key, channel in channels.items() if key not in taken]
        known = named_columns(str(file), [key for key, _ in own], mapping.channels)
        ours = history_table(file).frame_known
        shared = {name: own[k][1] for k, name in known.items() if ours or name == "time"}
        azimuth = {"azimuth": channels["azimuth"]} if "azimuth" in channels else {}
        named = {**azimuth, **shared, **named}
    channels = dict(channels)
    for name in LOAD_NAMES:
        if name in named:
            channels.pop(LOAD_NAMES[name], None)  # fixed ones would be taken before rotating ones
            channels[mapping.read_as(name)] = named[name]
    at_gage = mapping.moments_at if "My" not in mapping.channels and mapping.moments_at else None
    found = loads_from_channels(
        str(file),
        channels,
        at_gage,
        np.radians(mapping.azimuth_blade1_up),
        measured,
        mapping.gearbox_ratio,
    )
    origin = {"source": file.name, "channels": found.read, **found.attributes}
    return LoadHistory(file.stem, found.time, found.loads, origin, measured=measured)


def _with_points(
    file: Path,
    history: LoadHistory,
    channels: Mapping[str, Channel],
    mapping: ChannelMap,
    azimuth: Channel | None,
) -> LoadHistory:
    """With the loads at load points, which have columns like brake.Fz of a table."""
    taken = {mapping.column(name)[0].lower() for name in mapping.channels}
    own = [c for key, c in channels.items() if key not in taken and is_of_point(c.name)]
    read_ones = {c.name for c in own}
    unread = (title for title in history_table(file).titles if without_unit(title) not in read_ones)
    history = replace(history, unread=tuple(unread))
    if not own:
        return history
    read = f"{_read_of(history)}; {', '.join(f'{c.name} [{c.unit}]' for c in own)}"
    at = point_loads(str(history.attributes["source"]), own)
    if azimuth is not None:  # those at the hub are turned already
        angle = _angle(history, azimuth, mapping)
        at = {point: _of_fixed_frame(loads, angle) for point, loads in at.items()}
        read += " turned back, too"
    return replace(history, at=at, attributes={**history.attributes, "channels": read})


def _at_hub(history: LoadHistory, mapping: ChannelMap, own_names: bool) -> LoadHistory:
    """Loads in the shaft's frame, about the hub; those of OpenFAST's names stand there already."""
    loads, at, read = history.loads, history.at, _read_of(history)
    if mapping.rotating and own_names:
        raise InputError(
            f"hub loads '{history.attributes['source']}': the names of OpenFAST's own channels say "
            "which of them turn with the rotor: leave out rotating, or map the loads"
        )
    if mapping.tilt and own_names:
        raise InputError(
            f"hub loads '{history.attributes['source']}': loads of OpenFAST's own names are in the "
            "shaft's frame: leave out tilt, or map the loads"
        )
    if mapping.tilt:
        loads = to_shaft_frame(loads, mapping.tilt)
        if not np.isfinite(loads).any():
            raise InputError(
                f"hub loads '{history.attributes['source']}': tilt makes Fx and Fz, or Mx and Mz, "
                "from each other, and the file has one of them alone: leave out tilt, or map both"
            )
        at = {point: to_shaft_frame(own, mapping.tilt) for point, own in at.items()}
        read = read.removesuffix(_NOTHING_TURNED)
        read += f"; turned from a horizontal frame by the shaft's tilt of {mapping.tilt:g} deg"
    if mapping.moments_at and (not own_names or "My" in mapping.channels):
        loads = moved_moments(loads, mapping.moments_at)
        read += f"; moments carried to the hub from {mapping.moments_at:g} m downwind of it"
    if loads is history.loads:
        return history
    attributes = {**history.attributes, "channels": read}
    return replace(history, loads=loads, at=at, attributes=attributes, about=None)


def _read_of(history: LoadHistory) -> str:
    """What loads were read from, in words."""
    return str(history.attributes.get("channels", "as in the file"))


def _azimuth(file: Path, channels: Mapping[str, Channel], named: Mapping[str, Channel]) -> Channel:
    """The azimuth of a table whose loads turn with the rotor."""
    candidates = [named.get("azimuth"), *(channels.get(name.lower()) for name in AZIMUTH)]
    found = next((channel for channel in candidates if channel is not None), None)
    if found is None:
        raise InputError(
            f"hub loads '{file}': with rotating, Fy, Fz, My and Mz turn with the rotor, and the "
            "file has no azimuth to turn them back: add a column 'azimuth [deg]', name that of the "
            "file in the mapping, as in channels: {azimuth: Psi}, or leave out rotating"
        )
    return found


def _angle(history: LoadHistory, azimuth: Channel, mapping: ChannelMap) -> Floats:
    """Angle by which the rotor has turned since blade 1 pointed up [rad]."""
    source = str(history.attributes["source"])
    angle = in_si(source, azimuth, ANGLE_UNITS)
    columns = {azimuth.name: angle}
    require_sound(f"hub loads '{source}'", history.time, columns, even=not history.measured)
    return np.asarray(angle - np.radians(mapping.azimuth_blade1_up))


def _turned_back(history: LoadHistory, azimuth: Channel, mapping: ChannelMap) -> LoadHistory:
    """Loads of a rotating frame, at the hub and at load points, in the frame that does not turn."""
    angle, back = _angle(history, azimuth, mapping), mapping.azimuth_blade1_up
    read = _read_of(history).removesuffix(_NOTHING_TURNED)
    read += f"; Fy, Fz, My, Mz turned back by {azimuth.name} [{azimuth.unit}]"
    read += f" less {back:g} deg" if back else ""
    return replace(
        history,
        loads=_of_fixed_frame(history.loads, angle),
        at={point: _of_fixed_frame(own, angle) for point, own in history.at.items()},
        attributes={**history.attributes, "channels": read},
    )


def _of_fixed_frame(loads: Floats, angle: Floats) -> Floats:
    """Loads (n, 6) of a frame turned by an angle (n,) about +x."""
    turned = loads.copy()
    for y in (1, 4):
        turned[:, y], turned[:, y + 1] = turn_to_fixed(loads[:, y], loads[:, y + 1], angle)
    return turned


def _named(
    file: Path,
    channels: Mapping[str, Channel],
    column: str,
    sign: float = 1.0,
    why: str = "",
) -> Channel:
    found = channels.get(column.lower())
    if found is None:
        names = ", ".join(channel.name for channel in list(channels.values())[:12])
        though = f", though {why}" if why else ""
        raise InputError(
            f"hub loads '{file}': there is no channel '{column}'{though}; it has {names}"
            + (" and others" if len(channels) > 12 else "")
        )
    if found.invalid:
        raise InputError(
            f"hub loads '{file}': channel {found.name} is INVALID, which OpenFAST writes of a "
            "channel that the model does not have: name another, or correct OutList"
        )
    if sign > 0.0:
        return found
    return replace(found, name=f"-{found.name}", values=-found.values)
