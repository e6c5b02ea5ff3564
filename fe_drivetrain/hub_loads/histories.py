"""Hub-load histories: what the rotor puts on the end of the shaft, in from files.

A history is six components against time at the hub (the apex of the rotor), in the shaft frame that
does NOT rotate: x along the shaft downwind, z up (square to x, in the vertical plane), y = z cross
x.  It is the load of the rotor on the shaft: rotor weight is a negative Fz.

OpenFAST frames and signs, checked against the ElastoDyn sources and on a real output file:

- xs is downwind along the tilted shaft, zs up, ys = zs cross xs: our frame.
- The rotating frame a is the frame s turned about +xs by the rotor azimuth
  (ya = cos(psi) ys + sin(psi) zs), the rotor turning positively about +xs (clockwise when looking
  downwind); psi = 0 with blade 1 up, unless the input file shifts the printed azimuth (AzimB1Up).
- Shear force, thrust and torque are constant along ElastoDyn's massless shaft, so the channels
  called LSSGagF... and RotTorq are hub loads too.  Bending moment is not constant: LSSTipM... is at
  the hub, LSSGagM... at the strain gage a distance ShftGagL behind it.
"""

from __future__ import annotations

import csv
import math
import os
import re
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.compare.statistics import CONSTANT

UNITS = ("N", "N", "N", "N m", "N m", "N m")

LARGEST_LOAD = 1e12
"""A hub load beyond this (N, N m) is a slip of the pen or of the unit."""

MIN_SAMPLES = 3
"""Two samples of any two signals correlate perfectly, so three is the fewest for which a mean
error, an RMSE and a correlation all say something."""

STEP_TOLERANCE = 0.25
"""Largest departure of one time step from the median step, as a fraction of it.  Time columns are
often printed with three decimals (a step of 0.00625 s shows as 0.006 and 0.007, 17 % apart); one
missing sample is a departure of 100 %."""

SHORTEST_STEP, LONGEST_STEP = 1e-9, 1e9
"""Time steps [s] beyond these are a slip of the pen or of the unit."""

Attribute = float | int | str


@dataclass(frozen=True, eq=False)
class LoadHistory:
    """Hub loads against time, in the shaft frame that does not rotate.

    Parameters
    ----------
    name
        What the history is called in tables and messages.
    time : (n,) [s]
        Uniform to within ``STEP_TOLERANCE``, increasing, at least ``MIN_SAMPLES`` long.
    loads : (n, 6) [N, N, N, N m, N m, N m]
        Fx, Fy, Fz, Mx, My, Mz of the rotor on the shaft, at the hub.
    attributes
        What is known of the conditions: wind_speed [m/s], turbulence, shear, seed, source.

    Raises
    ------
    InputError
        If the shapes disagree, a value is NaN or infinite, time does not increase or has a gap,
        or there are too few samples.
    """

    name: str
    time: Floats
    loads: Floats
    attributes: Mapping[str, Attribute] = field(default_factory=dict)

    def __post_init__(self) -> None:
        time = _frozen(self.time)
        loads = _frozen(self.loads)
        if time.ndim != 1 or loads.shape != (time.size, len(FORCES)):
            raise InputError(
                f"load history '{self.name}': time has shape {time.shape} and loads {loads.shape}; "
                f"give (n,) and (n, 6) in the order {', '.join(FORCES)}"
            )
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "loads", loads)
        object.__setattr__(self, "attributes", dict(self.attributes))
        columns = dict(zip(FORCES, loads.T, strict=True))
        _require_sound(f"load history '{self.name}'", time, columns)

    def __len__(self) -> int:
        return int(self.time.size)

    def component(self, name: str) -> Floats:
        """One component by its name, for example ``"My"``: (n,) [N or N m].

        Raises
        ------
        InputError
            If there is no component of that name.
        """
        if name not in FORCES:
            raise InputError(f"hub-load component '{name}' is not one of {', '.join(FORCES)}")
        return self.loads[:, FORCES.index(name)]

    def between(self, start: float, stop: float = np.inf) -> LoadHistory:
        """The samples with start <= time <= stop [s], for example without a start-up transient."""
        kept = (self.time >= start) & (self.time <= stop)
        return LoadHistory(self.name, self.time[kept], self.loads[kept], self.attributes)


def read_hub_loads(path: str | os.PathLike[str]) -> LoadHistory:
    """Read a history, the format told by the suffix: .out or .outb (OpenFAST), or .csv.

    Raises
    ------
    InputError
        If the file is missing, of another kind, or unsound, or if its loads never vary.
    """
    file = Path(path)
    suffix = file.suffix.lower()
    if suffix not in (".out", ".outb", ".csv"):
        raise InputError(
            f"hub loads '{file}': the suffix '{file.suffix}' is not one of .out, .outb (OpenFAST) "
            "and .csv; convert the file or rename it"
        )
    history = read_csv(file) if suffix == ".csv" else read_openfast(file)
    _require_variation(f"hub loads '{file}'", history.loads)
    return history


# --- OpenFAST ------------------------------------------------------------------------------------

_AXIAL = ("LSShftFxa", "LSShftFxs", "LSSGagFxa", "LSSGagFxs", "RotThrust")
_TORQUE = ("LSShftMxa", "LSShftMxs", "LSSGagMxa", "LSSGagMxs", "RotTorq", "LSShftTq")
_AZIMUTH = ("LSSTipPxa", "LSSTipPxs", "LSSTipP", "Azimuth")


def read_openfast(
    path: str | os.PathLike[str],
    *,
    gage_distance: float | None = None,
    azimuth_blade1_up: float = 0.0,
) -> LoadHistory:
    """Read hub loads from an OpenFAST output file, text (.out) or binary (.outb).

    Non-rotating channels are used where they are there; rotating ones (LSShftFya, LSSTipMya, ...)
    are turned by the azimuth, and refused without it.  Moments at the strain gage (LSSGagM...) are
    not hub loads and are refused unless their distance from the hub is given, because it is in
    ElastoDyn's input, not in the output file.

    Parameters
    ----------
    path
        File to read; units are the file's own.
    gage_distance [m]
        ShftGagL of the ElastoDyn input, to carry strain-gage moments to the hub where the file has
        no others.
    azimuth_blade1_up [rad]
        AzimB1Up of the ElastoDyn input: the azimuth that is printed when blade 1 points up.

    Raises
    ------
    InputError
        If the file is missing or unreadable, a channel or the azimuth is missing, a unit is
        unknown, or the samples are unsound.
    """
    file = _existing(path)
    channels = _openfast_channels(file)
    time, loads = _loads_from_channels(str(file), channels, gage_distance, azimuth_blade1_up)
    return LoadHistory(file.stem, time, loads, {"source": f"OpenFAST, {file.name}"})


@dataclass(frozen=True, eq=False)
class _Channel:
    """One column of a file: its name there, its unit there, its samples (n,) as written."""

    name: str
    unit: str
    values: Floats


def _loads_from_channels(
    source: str,
    channels: Mapping[str, _Channel],
    gage_distance: float | None = None,
    azimuth_blade1_up: float = 0.0,
) -> tuple[Floats, Floats]:
    """Time (n,) [s] and hub loads (n, 6) [N, N m] from OpenFAST channels keyed in lower case."""
    used: dict[str, _Channel] = {}

    def first(names: Sequence[str]) -> _Channel | None:
        found = next((channels[n.lower()] for n in names if n.lower() in channels), None)
        if found is not None:
            used[found.name] = found
        return found

    def needed(names: Sequence[str], what: str) -> _Channel:
        found = first(names)
        if found is None:
            raise InputError(
                f"hub loads '{source}': no channel for the {what}; add one of "
                f"{', '.join(names)} to OutList and run again"
            )
        return found

    def pair(fixed: Sequence[str], rotating: Sequence[str]) -> tuple[list[_Channel], bool] | None:
        # Either frame is complete or it is of no use: one component alone cannot be turned.
        for prefixes, turning in ((fixed, False), (rotating, True)):
            for prefix in prefixes:
                names = [prefix.replace("*", axis) for axis in "yz"]
                if all(n.lower() in channels for n in names):
                    return [needed([n], n) for n in names], turning
        return None

    time = needed(("Time",), "time")
    axial = needed(_AXIAL, "thrust")
    torque = needed(_TORQUE, "torque")
    shear = pair(("LSShftF*s", "LSSGagF*s"), ("LSShftF*a", "LSSGagF*a"))
    if shear is None:
        raise InputError(
            f"hub loads '{source}': no pair of shear-force channels; add LSShftFys and LSShftFzs "
            "to OutList and run again"
        )
    bending = pair(("LSSTipM*s",), ("LSSTipM*a",))
    at_gage = bending is None
    if bending is None:
        bending = pair(("LSSGagM*s",), ("LSSGagM*a",))
        if bending is None:
            raise InputError(
                f"hub loads '{source}': no pair of bending-moment channels; add LSSTipMys and "
                "LSSTipMzs to OutList and run again"
            )
        if gage_distance is None:
            raise InputError(
                f"hub loads '{source}': {bending[0][0].name} and {bending[0][1].name} are moments "
                "at the strain gage, not at the hub; add LSSTipMys and LSSTipMzs to OutList, or "
                "give gage_distance (ShftGagL of the ElastoDyn file)"
            )

    azimuth = None
    if shear[1] or bending[1]:
        azimuth = first(_AZIMUTH)
        if azimuth is None:
            rotating = ", ".join(c.name for p, turns in (shear, bending) if turns for c in p)
            raise InputError(
                f"hub loads '{source}': {rotating} turn with the rotor and the file has no azimuth "
                "to turn them back; add Azimuth, or LSShftFys, LSShftFzs, LSSTipMys and LSSTipMzs, "
                "to OutList"
            )

    seconds = _in_si(source, time, _TIME_UNITS)
    columns = {name: channel.values for name, channel in used.items() if channel is not time}
    _require_sound(f"hub loads '{source}'", seconds, columns)

    psi = np.zeros_like(seconds)
    if azimuth is not None:
        psi = _in_si(source, azimuth, _ANGLE_UNITS) - azimuth_blade1_up
    fy, fz = (_in_si(source, c, _FORCE_UNITS) for c in shear[0])
    if shear[1]:
        fy, fz = turn_to_fixed(fy, fz, psi)
    my, mz = (_in_si(source, c, _MOMENT_UNITS) for c in bending[0])
    if bending[1]:
        my, mz = turn_to_fixed(my, mz, psi)
    if at_gage and gage_distance is not None:
        # M_gage = M_hub + (-L, 0, 0) cross F
        my, mz = my - gage_distance * fz, mz + gage_distance * fy
    fx = _in_si(source, axial, _FORCE_UNITS)
    mx = _in_si(source, torque, _MOMENT_UNITS)
    return seconds, np.column_stack((fx, fy, fz, mx, my, mz))


def turn_to_fixed(y: ArrayLike, z: ArrayLike, azimuth: ArrayLike) -> tuple[Floats, Floats]:
    """Components in the fixed frame of a vector given in the frame turned by azimuth about +x.

    Parameters
    ----------
    y, z : (n,)
        Components along the rotating axes ya and za.
    azimuth : (n,) [rad]
        Angle from the fixed to the rotating axes, positive about +x.

    Returns
    -------
    (n,), (n,)
        Components along the fixed axes y and z.
    """
    y, z = np.asarray(y, dtype=float), np.asarray(z, dtype=float)
    cos, sin = np.cos(azimuth), np.sin(azimuth)
    return y * cos - z * sin, y * sin + z * cos


def _openfast_channels(file: Path) -> dict[str, _Channel]:
    from openfast_io.FAST_output_reader import load_ascii_output, load_binary_output

    try:
        if file.suffix.lower() == ".outb":
            # The reader trusts the counts that follow this identifier, so a file of another kind
            # would make it ask for any amount of memory.
            with file.open("rb") as stream:
                identifier = int.from_bytes(stream.read(2), "little")
                if identifier not in (1, 2, 3, 4):
                    raise ValueError(f"format identifier {identifier}, not 1 to 4")
                stream.seek(4 if identifier == 4 else 2)  # 4 states the length of names before
                channels, samples = struct.unpack("<2i", stream.read(8))
            least = channels * samples * (8 if identifier == 3 else 2)
            if channels < 1 or samples < 1 or least > file.stat().st_size:
                raise ValueError(f"it states {channels} channels of {samples} samples")
            data, info, _ = load_binary_output(str(file))
        else:
            data, info = load_ascii_output(str(file))
            with file.open("rb") as stream:
                if any(re.search(rb"[_\x80-\xff]", line) for line in islice(stream, 8, None)):
                    raise ValueError("a cell is not a number")
    except Exception as error:  # the reader raises bare Exception, struct.error, ValueError, ...
        where = _first_bad_cell(file) or f"it cannot be read as OpenFAST output ({error})"
        raise InputError(f"hub loads '{file}': {where}; run OpenFAST again") from error
    data = np.asarray(data, dtype=float)
    if data.size == 0:
        raise InputError(f"hub loads '{file}': it has no samples; run OpenFAST again")
    names, units = info["attribute_names"], info["attribute_units"]
    if data.ndim != 2 or not data.shape[1] == len(names) == len(units):
        raise InputError(
            f"hub loads '{file}': {len(names)} channel names, {len(units)} units and data of shape "
            f"{data.shape} disagree; run OpenFAST again"
        )
    by_name: dict[str, _Channel] = {}
    for name, unit, values in zip(names, units, data.T, strict=True):
        # OutList takes a leading -, _, m or M to reverse a channel's sign.
        reversed_name = re.fullmatch(r"[-_m]((?:LSS|Rot|Azimuth).*)", name, re.IGNORECASE)
        key = (reversed_name[1] if reversed_name else name).lower()
        by_name.setdefault(key, _Channel(name, unit, -values if reversed_name else values))
    return by_name


def _first_bad_cell(file: Path, header_lines: int = 8, name_line: int = 6) -> str | None:
    """What is wrong with the first unreadable line of a text output file, or None."""
    if file.suffix.lower() != ".out":
        return None
    try:
        lines = file.read_text().splitlines()
    except (OSError, UnicodeDecodeError):
        return None
    if len(lines) <= header_lines:
        return f"it has {len(lines)} lines and no samples"
    names = lines[name_line].split()
    for number, line in enumerate(lines[header_lines:], start=header_lines + 1):
        cells = line.split()
        if len(cells) != len(names):
            return f"line {number} has {len(cells)} values for {len(names)} channels"
        for name, cell in zip(names, cells, strict=True):
            try:
                _number(cell)
            except ValueError:
                return f"line {number}, channel {name}: {shown(cell)} is not a number"
    return None


# --- CSV -----------------------------------------------------------------------------------------

_CSV_COLUMNS = ("time", *FORCES)
_CSV_EXAMPLE = "time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m]"


def read_csv(path: str | os.PathLike[str]) -> LoadHistory:
    """Read hub loads from a table with named columns and their units in the header.

    The header is like ``time [s],Fx [kN],...,Mz [kN m]``, columns in any order, others ignored.
    Lines ``# key = value`` before it become the attributes.

    Raises
    ------
    InputError
        If the file is missing, a column or its unit is missing or unknown, a cell is not a number,
        or the samples are unsound.
    """
    file = _existing(path)
    try:
        lines = file.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        raise InputError(f"hub loads '{file}': not UTF-8 text; save it as UTF-8 CSV") from error

    attributes: dict[str, Attribute] = {}
    rows: list[int] = []
    kept: list[str] = []
    for number, line in enumerate(lines, start=1):
        if line.startswith("#"):
            key, equals, value = line[1:].partition("=")
            if equals:
                attributes[key.strip()] = _number_or_text(value.strip())
        elif line.strip():
            rows.append(number)
            kept.append(line)
    try:
        cells = list(csv.reader(kept))
    except csv.Error as error:
        raise InputError(f"hub loads '{file}': {error}; correct the table") from error
    if not cells:
        raise InputError(f"hub loads '{file}': empty; begin with the header '{_CSV_EXAMPLE}'")
    header, rows, body = cells[0], rows[1:], cells[1:]
    places = _csv_places(file, header)
    for number, row in zip(rows, body, strict=False):
        # more cells than columns: decimal commas would shift every number into another column
        if any(cell.strip() for cell in row[len(header) :]):
            raise InputError(
                f"hub loads '{file}': line {number} has {len(row)} values for {len(header)} "
                "columns; write decimals with a point, and one value for each column"
            )
    channels: dict[str, _Channel] = {}
    for name, (place, unit) in places.items():
        values = np.empty(len(body))
        for i, row in enumerate(body):
            text = row[place].strip() if place < len(row) else ""
            try:
                values[i] = _number(text)
            except ValueError as error:
                raise InputError(
                    f"hub loads '{file}': line {rows[i]}, column {name}: {shown(text)} is not a "
                    "number; "
                    "correct it or remove the line and all after it"
                ) from error
        channels[name] = _Channel(name, unit, values)

    source = str(file)
    time = _in_si(source, channels["time"], _TIME_UNITS)
    tables = (_FORCE_UNITS,) * 3 + (_MOMENT_UNITS,) * 3
    loads = [
        _in_si(source, channels[name], table) for name, table in zip(FORCES, tables, strict=True)
    ]
    columns = dict(zip(FORCES, loads, strict=True))
    _require_sound(f"hub loads '{source}'", time, columns, rows)
    return LoadHistory(file.stem, time, np.column_stack(loads), {"source": file.name} | attributes)


def write_csv(history: LoadHistory, path: str | os.PathLike[str]) -> None:
    """Write a history as ``read_csv`` reads it, exactly, and whole or not at all.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    file = Path(path)
    table = np.column_stack((history.time, history.loads))
    lines = [f"# {key} = {value}" for key, value in history.attributes.items()]
    lines.append(_CSV_EXAMPLE)
    lines += [",".join(map(repr, row)) for row in table.tolist()]
    try:
        with atomic_path(file) as temporary:
            temporary.write_text("\n".join(lines) + "\n", encoding="utf-8")
    except OSError as error:
        raise InputError(f"hub loads '{file}': cannot be written ({error.strerror})") from error


def _csv_places(file: Path, header: Sequence[str]) -> dict[str, tuple[int, str]]:
    """Where each wanted column is and its unit."""
    wanted = {name.lower(): name for name in _CSV_COLUMNS}
    places: dict[str, tuple[int, str]] = {}
    for place, title in enumerate(header):
        match = re.fullmatch(r"\s*(\w+)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*", title)
        name = wanted.get(match[1].lower()) if match else None
        if match is None or name is None:
            continue
        if name in places:
            raise InputError(f"hub loads '{file}': column {name} is there twice; remove one")
        if not match[2]:
            raise InputError(
                f"hub loads '{file}': column '{title.strip()}' has no unit; write it like "
                f"'{name} [{'s' if name == 'time' else UNITS[FORCES.index(name)]}]'"
            )
        places[name] = (place, match[2])
    missing = [name for name in _CSV_COLUMNS if name not in places]
    if missing:
        raise InputError(
            f"hub loads '{file}': no column {', '.join(missing)}; the header must name all of "
            f"{', '.join(_CSV_COLUMNS)}, like '{_CSV_EXAMPLE}'"
        )
    return places


def _number(text: str) -> float:
    """The number that a cell holds; ValueError where it holds none.

    Python takes 1_0 for ten, and digits of any script: in a table these are slips.
    """
    if "_" in text or not text.isascii():
        raise ValueError(text)
    return float(text)


def _number_or_text(text: str) -> Attribute:
    for kind in (int, float):
        try:
            number = kind(text)
            return number if math.isfinite(number) else text
        except (ValueError, OverflowError):
            continue
    return text


# --- units, soundness, files ---------------------------------------------------------------------

_TIME_UNITS = {"s": 1.0, "sec": 1.0, "ms": 1e-3}
_ANGLE_UNITS = {"deg": np.pi / 180.0, "rad": 1.0}
_FORCE_UNITS = {"N": 1.0, "kN": 1e3, "MN": 1e6}
_MOMENT_UNITS = {"Nm": 1.0, "kNm": 1e3, "MNm": 1e6}


def _in_si(source: str, channel: _Channel, units: Mapping[str, float]) -> Floats:
    # "N m", "N-m", "N.m", "N*m" and "N·m" are one unit; upper and lower case are not (mN, MN).
    unit = re.sub(r"[\s·⋅*.\-]", "", channel.unit)
    if unit not in units:
        raise InputError(
            f"hub loads '{source}': channel {channel.name} has the unit '{channel.unit}', not one "
            f"of {', '.join(units)}; correct the unit or the channel"
        )
    with np.errstate(over="ignore"):  # an infinity is refused with its place
        return np.asarray(channel.values * units[unit])


def _require_sound(
    source: str,
    time: Floats,
    columns: Mapping[str, Floats],
    rows: Sequence[int] | None = None,
) -> None:
    """Raise InputError at the first NaN, infinity, backward step or gap, and for too few samples.

    Parameters
    ----------
    time : (n,) [s]
    columns : name to (n,)
    rows : (n,)
        Line of each sample in a text file; without it samples are counted from 1.
    """

    def at(i: int) -> str:
        place = f"line {rows[i]}" if rows is not None else f"sample {i + 1}"
        return f"{place} (t = {time[i]:g} s)"

    if time.size < MIN_SAMPLES:
        raise InputError(
            f"{source}: {time.size} samples, fewer than the {MIN_SAMPLES} that a mean error, an "
            "RMSE and a correlation need; give a longer history"
        )
    for name, values in {"time": time, **columns}.items():
        bad = np.flatnonzero(~np.isfinite(values))
        if bad.size:
            raise InputError(
                f"{source}: {name} is {values[bad[0]]} at {at(bad[0])}, one of {bad.size} such "
                "samples; a finite number is needed, so repair it or cut the history there"
            )
    for name, values in columns.items():
        huge = np.flatnonzero(np.abs(values) > LARGEST_LOAD)
        if huge.size:
            raise InputError(
                f"{source}: {name} is {values[huge[0]]:.3g} N or N m at {at(huge[0])}; a load must "
                f"be at most {LARGEST_LOAD:.0e}, so check the unit in the column's heading"
            )
    with np.errstate(over="ignore"):
        steps = np.diff(time)
        median = float(np.median(steps))
    back = np.flatnonzero(steps <= 0.0)
    if back.size:
        raise InputError(
            f"{source}: time does not increase after {at(back[0])}, the next is "
            f"{time[back[0] + 1]:g} s; sort the samples and remove repeated ones"
        )
    if not SHORTEST_STEP <= median <= LONGEST_STEP:
        raise InputError(
            f"{source}: the time step is {median:g} s but must be from {SHORTEST_STEP:g} to "
            f"{LONGEST_STEP:g} s: check the unit of time"
        )
    uneven = np.flatnonzero(np.abs(steps - median) > STEP_TOLERANCE * median)
    if uneven.size:
        i = uneven[0]
        raise InputError(
            f"{source}: the time step after {at(i)} is {steps[i]:g} s where the others are "
            f"{median:g} s (allowed: within {STEP_TOLERANCE:.0%}); samples are missing or the step "
            "changes, so resample to one step or cut the history there"
        )


def _require_variation(source: str, loads: Floats) -> None:
    """Raise InputError where all samples are one load but for rounding, and that is not zero."""
    largest = np.abs(loads).max(axis=0)
    if largest.any() and (np.ptp(loads, axis=0) <= CONSTANT * largest).all():
        raise InputError(
            f"{source}: all {len(loads)} samples are the same load, so that nothing can be said "
            "about how two models vary with it; give a history whose loads vary"
        )


def _frozen(values: ArrayLike) -> Floats:
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


def _existing(path: str | os.PathLike[str]) -> Path:
    file = Path(path)
    if not file.is_file():
        raise InputError(f"hub loads '{file}': no such file; check the path")
    return file
