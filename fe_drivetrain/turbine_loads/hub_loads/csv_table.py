"""Hub loads from and to CSV tables with units in the header."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.csv_cells import comment_line, table_row
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.turbine_loads.hub_loads.channel_map import HIGH_SPEED_TORQUE
from fe_drivetrain.turbine_loads.hub_loads.channels import (
    FORCE_UNITS,
    MOMENT_UNITS,
    TIME_UNITS,
    Channel,
    existing_file,
    in_si,
    without_unit,
)
from fe_drivetrain.turbine_loads.hub_loads.high_speed import at_rotor
from fe_drivetrain.turbine_loads.hub_loads.histories import (
    NEED_ALL,
    UNITS,
    About,
    Attribute,
    LoadHistory,
    require_sound,
)
from fe_drivetrain.turbine_loads.hub_loads.history_table import HistoryTable
from fe_drivetrain.turbine_loads.hub_loads.stamps import EXAMPLE
from fe_drivetrain.turbine_loads.hub_loads.table_kinds import history_table
from fe_drivetrain.turbine_loads.hub_loads.table_names import HUB, named_columns

_CSV_COLUMNS = ("time", *FORCES)
_TABLES = (FORCE_UNITS,) * 3 + (MOMENT_UNITS,) * 3
_UNITS = {"time": "s", HIGH_SPEED_TORQUE: "kN m", **dict(zip(FORCES, UNITS, strict=True))}
_ABOUT = "moments about"  # key of a line before the header: x [m], or "front face"
_CSV_EXAMPLE = "time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m]"


def read_csv(
    path: str | os.PathLike[str],
    measured: bool = False,
    gearbox_ratio: float | None = None,
    units: Mapping[str, str] | None = None,
) -> LoadHistory:
    """Read hub loads from a table with named columns and their units in the header, or below it.

    The header is like ``time [s],Fx [kN],...,Mz [kN m]``, columns in any order, others ignored;
    other names that are known are in `TABLE_NAMES`. Time may be date-times. Which kinds of files
    are tables: `history_table`.
    Columns like ``brake.Fz [kN]`` are loads at another point of the shaft; those that a point does
    not have are zero.
    Lines ``# key = value`` before it become the attributes; ``# moments about = 0.7`` is x [m] of
    the point that moments are about, where that is another than a scene states.

    Parameters
    ----------
    path : str or path-like
        The file.
    measured : bool
        Take what components there are, at whatever times.
    gearbox_ratio : float, optional
        Makes the rotor's torque of that of the high-speed shaft, where the table has that alone.
    units : mapping, optional
        Units of columns, by their names in the file, which go before those of the file.

    Raises
    ------
    InputError
        If the file is missing, a column or its unit is missing or unknown, a cell is not a number,
        or the samples are unsound.
    """
    table = history_table(existing_file(path))
    source = str(table.file)
    channels, unread = _read_table(table, measured, bool(measured or gearbox_ratio), units or {})
    torque = channels.pop(HIGH_SPEED_TORQUE, None)
    if torque is not None:
        channels["Mx"] = torque
    time = in_si(source, channels["time"], TIME_UNITS)
    loads = {
        name: in_si(source, channels[name], units)
        for name, units in zip(FORCES, _TABLES, strict=True)
        if name in channels
    }
    others = [name for name in channels if name not in _CSV_COLUMNS]
    at = point_loads(source, [channels[name] for name in others])
    columns = dict(loads)
    for point, values in at.items():
        columns |= {f"{point}.{c}": v for c, v in zip(FORCES, values.T, strict=True)}
    rows = channels["time"].rows
    require_sound(f"hub loads '{source}'", time, columns, rows, even=not measured)
    read = ", ".join(_as_read(name, channels[name]) for name in (*loads, *others))
    attributes = {key: _number_or_text(value) for key, value in table.facts.items()}
    origin: dict[str, Attribute] = {"source": table.file.name}
    loads, where = at_rotor(source, loads, torque, gearbox_ratio)
    read = "; ".join(filter(None, (read, where.words, channels["time"].note)))
    about = _about(attributes)
    origin |= {"channels": f"{read}; signs as in the file, nothing turned", **where.attributes}
    missing = np.full(len(time), np.nan)
    return LoadHistory(
        table.file.stem,
        time,
        np.column_stack([loads.get(name, missing) for name in FORCES]),
        origin | attributes,
        at,
        unread,
        about,
        measured,
    )


def _title(name: str, title: str) -> str:
    """The name of a column as it is stated: its own, or the other one that the file has."""
    own = without_unit(title)
    return name if own.lower() == name.lower() else own


def _as_read(name: str, channel: Channel) -> str:
    """A column as the file calls it, with what it is where that is another name."""
    title = f"{channel.name} [{channel.unit}]"
    return title if channel.name == name else f"{name} = {title}"


def is_of_point(title: str) -> bool:
    """Whether a column is a load at a load point, like "brake.Fz" (a title without its unit)."""
    name = _wanted(title)
    return name is not None and "." in name


def point_loads(source: str, channels: Iterable[Channel]) -> dict[str, Floats]:
    """Loads (n, 6) at load points [N, N m], by the point's name; components without a column are 0.

    Parameters
    ----------
    source : str
        The file, for messages.
    channels : iterable of Channel
        With names like "brake.Fz", see `is_of_point`.

    Raises
    ------
    InputError
        A unit is unknown.
    """
    at: dict[str, Floats] = {}
    for channel in channels:
        point, _, component = channel.name.rpartition(".")
        c = [name.lower() for name in FORCES].index(component.lower())
        values = in_si(source, channel, _TABLES[c])
        at.setdefault(point, np.zeros((values.size, len(FORCES))))[:, c] = values
    return at


def _read_table(
    table: HistoryTable, measured: bool, high_speed: bool, units: Mapping[str, str]
) -> tuple[dict[str, Channel], tuple[str, ...]]:
    """Columns of a table that are read, by what they are, and titles of the others.

    With `high_speed` the torque of that shaft stands for Mx where there is no other.
    """
    titles, file = table.titles, table.file
    own = {name.lower(): unit for name, unit in units.items()}
    named = [own.get(without_unit(title).lower()) for title in titles]
    given = [f"{without_unit(t)} [{u}]" if u else t for t, u in zip(titles, named, strict=True)]
    places = _csv_places(file, given)
    if not table.frame_known:
        places = {name: place for name, place in places.items() if name == "time"}
    if "Mx" in places or not high_speed:
        places.pop(HIGH_SPEED_TORQUE, None)
    _require_columns(table, places, measured)
    time = places["time"][0]
    found = table.columns([place for place, _ in places.values()], [time])
    channels = {
        name: Channel(_title(name, titles[place]), unit, found.values[place])
        for name, (place, unit) in places.items()
    }
    unit = "s" if found.words else channels["time"].unit
    if not unit:
        raise _no_unit(file, titles[time], "time")
    channels["time"] = replace(channels["time"], unit=unit, note=found.words, rows=found.rows)
    taken = {place for place, _ in places.values()}
    return channels, tuple(title.strip() for k, title in enumerate(titles) if k not in taken)


def write_hub_loads(
    history: LoadHistory,
    path: str | os.PathLike[str],
    beside: Mapping[str, Floats] | None = None,
) -> None:
    """Write a history as ``read_csv`` reads it, exactly, and whole or not at all.

    Components that are absent have no column.

    Parameters
    ----------
    history : LoadHistory
        The loads.
    path : str or path-like
        The file.
    beside : mapping, optional
        Other columns (n,) by title, as in "rotor speed [rad/s]".

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    file = Path(path)
    more = dict(beside or {})
    columns = [values[:, None] for values in more.values()]
    there = [k for k, name in enumerate(FORCES) if name not in history.absent]
    loads = history.loads[:, there]
    table = np.column_stack((history.time, loads, *history.at.values(), *columns))
    others = [f"{p}.{c} [{u}]" for p in history.at for c, u in zip(FORCES, UNITS, strict=True)]
    facts = dict(history.attributes)
    facts |= {} if history.about is None else {_ABOUT: str(history.about)}
    lines = [comment_line(f"{key} = {value}") for key, value in facts.items()]
    titles = _CSV_EXAMPLE.split(",")
    lines.append(table_row([titles[0], *(titles[k + 1] for k in there), *others, *more]))
    lines += [",".join(map(repr, row)) for row in table.tolist()]
    try:
        with atomic_path(file) as temporary:
            temporary.write_text("\n".join(lines) + "\n", encoding="utf-8")
    except OSError as error:
        raise InputError(f"hub loads '{file}': cannot be written ({error.strerror})") from error


def _about(attributes: dict[str, Attribute]) -> About:
    """The point that a file says its moments are about, taken from its attributes."""
    stated = attributes.get(_ABOUT)
    if stated != "front face" and not isinstance(stated, int | float):
        return None
    del attributes[_ABOUT]
    return "front face" if isinstance(stated, str) else float(stated)


def _csv_places(file: Path, header: Sequence[str]) -> dict[str, tuple[int, str]]:
    """Where each wanted column is and its unit."""
    places: dict[str, tuple[int, str]] = {}
    named = named_columns(str(file), [without_unit(title) for title in header])
    for place, title in enumerate(header):
        match = re.fullmatch(r"\s*([\w. -]+?)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*", title)
        if match is None:
            continue
        name = named.get(place) or (None if " " in match[1] else _wanted(match[1]))
        if name is None:
            continue
        if name in places:
            raise InputError(f"hub loads '{file}': column {name} is there twice; remove one")
        if not match[2] and name != "time":
            raise _no_unit(file, title, name)
        places[name] = (place, match[2] or "")
    return places


def _no_unit(file: Path, title: str, name: str) -> InputError:
    """The sentence about a column without a unit."""
    unit = _UNITS[name if name in _UNITS else name.rpartition(".")[2]]
    return InputError(
        f"hub loads '{file}': column '{title.strip()}' has no unit; write it like "
        f"'{without_unit(title)} [{unit}]'"
    )


def _require_columns(table: HistoryTable, columns: Collection[str], measured: bool) -> None:
    """Refuse a table without time, or without the components that are needed."""
    file, advice = table.file, table.advice
    if len(table.titles) == 1:
        advice += (
            f"; the header is one column, {shown(table.titles[0])}: put commas, semicolons or "
            "tabs between columns"
        )
    torque = {"Mx"} if HIGH_SPEED_TORQUE in columns else set()
    missing = [name for name in _CSV_COLUMNS if name not in torque.union(columns)]
    if measured:
        if "time" in missing:
            raise InputError(
                f"hub loads '{file}': no column time; give one, like 'time [s]' or of "
                f"date-times like {EXAMPLE}, or map yours, as in "
                f"`ChannelMap(channels={{'time': 'Timestamp'}})`{advice}"
            )
        if set(FORCES) <= set(missing):
            raise InputError(
                f"hub loads '{file}': no column of a load; name one or more of "
                f"{', '.join(FORCES)}, like 'Mx [kN m]', or map yours, as in "
                f"`ChannelMap(channels={{'Mx': 'Torque'}})`{advice}"
            )
    elif missing and advice:
        raise InputError(f"hub loads '{file}': no column {', '.join(missing)}{advice}; {NEED_ALL}")
    elif missing:
        what = f"; {NEED_ALL}" if set(missing) & set(FORCES) else ""
        raise InputError(
            f"hub loads '{file}': no column {', '.join(missing)}; the header must name all of "
            f"{', '.join(_CSV_COLUMNS)}, like '{_CSV_EXAMPLE}'{what}"
        )


def _wanted(title: str) -> str | None:
    """The name of a column that is read, its component as `FORCES` has it; None of any other."""
    point, dot, component = title.rpartition(".")
    known = {name.lower(): name for name in (FORCES if point else _CSV_COLUMNS)}
    name = known.get(component.lower())
    if name is None or (dot and not point) or f"{point.lower()}{dot}" == HUB:
        return None
    return f"{point}{dot}{name}"


def _number_or_text(text: str) -> Attribute:
    for kind in (int, float):
        try:
            number = kind(text)
            return number if math.isfinite(number) else text
        except (ValueError, OverflowError):
            continue
    return text
