"""Hub loads from and to CSV tables with units in the header."""

from __future__ import annotations

import csv
import math
import os
import re
from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.csv_cells import cell_as_given, comment_as_given, comment_line, table_row
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.turbine_loads.hub_loads.channels import (
    FORCE_UNITS,
    MOMENT_UNITS,
    TIME_UNITS,
    Channel,
    existing_file,
    in_si,
    not_utf8,
    parse_number,
)
from fe_drivetrain.turbine_loads.hub_loads.histories import (
    UNITS,
    About,
    Attribute,
    LoadHistory,
    require_sound,
)

_CSV_COLUMNS = ("time", *FORCES)
_TABLES = (FORCE_UNITS,) * 3 + (MOMENT_UNITS,) * 3
_ABOUT = "moments about"  # key of a line before the header: x [m], or "front face"
_CSV_EXAMPLE = "time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m]"


def read_csv(path: str | os.PathLike[str]) -> LoadHistory:
    """Read hub loads from a table with named columns and their units in the header.

    The header is like ``time [s],Fx [kN],...,Mz [kN m]``, columns in any order, others ignored.
    Columns like ``brake.Fz [kN]`` are loads at another point of the shaft; those that a point does
    not have are zero.
    Lines ``# key = value`` before it become the attributes; ``# moments about = 0.7`` is x [m] of
    the point that moments are about, where that is another than a scene states.

    Raises
    ------
    InputError
        If the file is missing, a column or its unit is missing or unknown, a cell is not a number,
        or the samples are unsound.
    """
    file = existing_file(path)
    attributes: dict[str, Attribute] = {}
    try:
        with file.open(encoding="utf-8-sig") as stream:
            channels, rows, unread = _channels(file, stream, attributes)
    except UnicodeDecodeError as error:
        raise not_utf8("hub loads", file) from error
    except csv.Error as error:
        raise InputError(f"hub loads '{file}': {error}; correct the table") from error

    source = str(file)
    time = in_si(source, channels["time"], TIME_UNITS)
    loads = [
        in_si(source, channels[name], table) for name, table in zip(FORCES, _TABLES, strict=True)
    ]
    columns = dict(zip(FORCES, loads, strict=True))
    others = [name for name in channels if name not in _CSV_COLUMNS]
    at = point_loads(source, [channels[name] for name in others])
    for point, values in at.items():
        columns |= {f"{point}.{c}": v for c, v in zip(FORCES, values.T, strict=True)}
    require_sound(f"hub loads '{source}'", time, columns, rows)
    read = ", ".join(f"{name} [{channels[name].unit}]" for name in (*FORCES, *others))
    origin = {"source": file.name, "channels": f"{read}; signs as in the file, nothing turned"}
    about = _about(attributes)
    return LoadHistory(
        file.stem, time, np.column_stack(loads), origin | attributes, at, unread, about
    )


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


def _channels(
    file: Path, stream: Iterable[str], attributes: dict[str, Attribute]
) -> tuple[dict[str, Channel], Sequence[int], tuple[str, ...]]:
    """Columns that are read, the line of each row, and titles of other columns.

    Memory is that of the numbers that are read.
    """
    rows = array("q")

    def kept() -> Iterator[str]:
        for number, line in enumerate(stream, start=1):
            if line.startswith("#"):
                key, equals, value = comment_as_given(line[1:]).partition("=")
                if equals:
                    attributes[key.strip()] = _number_or_text(value.strip())
            elif line.strip():
                rows.append(number)
                yield line

    table = csv.reader(kept())
    header = [cell_as_given(title) for title in next(table, [])]
    if not header:
        raise InputError(f"hub loads '{file}': empty; begin with the header '{_CSV_EXAMPLE}'")
    if len(header) == 1 and ";" in header[0]:
        raise InputError(
            f"hub loads '{file}': columns are separated by semicolons but must be by commas, and "
            "decimals must have a point: export the table so"
        )
    places = _csv_places(file, header)
    del rows[:]
    columns = {name: array("d") for name in places}
    for row in table:
        # more cells than columns: decimal commas would shift every number into another column
        if len(row) > len(header) and any(cell.strip() for cell in row[len(header) :]):
            raise InputError(
                f"hub loads '{file}': line {rows[-1]} has {len(row)} values for {len(header)} "
                "columns, as decimal commas make: write decimals with a point, and one value for "
                "each column"
            )
        for name, (place, _) in places.items():
            text = row[place].strip() if place < len(row) else ""
            try:
                columns[name].append(parse_number(text))
            except ValueError as error:
                if re.fullmatch(r"[-+]?\d+,\d*(e[-+]?\d+)?", text, re.IGNORECASE):
                    raise InputError(
                        f"hub loads '{file}': line {rows[-1]}, column {name}: {shown(text)} has a "
                        "decimal comma: write decimals with a point"
                    ) from error
                raise InputError(
                    f"hub loads '{file}': line {rows[-1]}, column {name}: {shown(text)} is not a "
                    "number; correct it or remove the line and all after it"
                ) from error
    channels = {
        name: Channel(name, unit, np.array(columns[name])) for name, (_, unit) in places.items()
    }
    taken = {place for place, _ in places.values()}
    unread = tuple(title.strip() for k, title in enumerate(header) if k not in taken)
    return channels, rows, unread


def write_hub_loads(
    history: LoadHistory,
    path: str | os.PathLike[str],
    beside: Mapping[str, Floats] | None = None,
) -> None:
    """Write a history as ``read_csv`` reads it, exactly, and whole or not at all.

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
    table = np.column_stack((history.time, history.loads, *history.at.values(), *columns))
    others = [f"{p}.{c} [{u}]" for p in history.at for c, u in zip(FORCES, UNITS, strict=True)]
    facts = dict(history.attributes)
    facts |= {} if history.about is None else {_ABOUT: str(history.about)}
    lines = [comment_line(f"{key} = {value}") for key, value in facts.items()]
    lines.append(table_row([*_CSV_EXAMPLE.split(","), *others, *more]))
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
    for place, title in enumerate(header):
        match = re.fullmatch(r"\s*([\w.-]+)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*", title)
        name = _wanted(match[1]) if match else None
        if match is None or name is None:
            continue
        if name in places:
            raise InputError(f"hub loads '{file}': column {name} is there twice; remove one")
        if not match[2]:
            component = name.rpartition(".")[2]
            unit = "s" if name == "time" else UNITS[FORCES.index(component)]
            raise InputError(
                f"hub loads '{file}': column '{title.strip()}' has no unit; write it like "
                f"'{name} [{unit}]'"
            )
        places[name] = (place, match[2])
    missing = [name for name in _CSV_COLUMNS if name not in places]
    if missing:
        raise InputError(
            f"hub loads '{file}': no column {', '.join(missing)}; the header must name all of "
            f"{', '.join(_CSV_COLUMNS)}, like '{_CSV_EXAMPLE}'"
        )
    return places


def _wanted(title: str) -> str | None:
    """The name of a column that is read, its component as `FORCES` has it; None of any other."""
    point, dot, component = title.rpartition(".")
    known = {name.lower(): name for name in (FORCES if point else _CSV_COLUMNS)}
    name = known.get(component.lower())
    return None if name is None or (dot and not point) else f"{point}{dot}{name}"


def _number_or_text(text: str) -> Attribute:
    for kind in (int, float):
        try:
            number = kind(text)
            return number if math.isfinite(number) else text
        except (ValueError, OverflowError):
            continue
    return text
