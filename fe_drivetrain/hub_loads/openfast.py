"""Hub loads from OpenFAST output files, text (.out) or binary (.outb).

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

import os
import re
import struct
from collections.abc import Mapping, Sequence
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.hub_loads.channels import (
    ANGLE_UNITS,
    FORCE_UNITS,
    MOMENT_UNITS,
    TIME_UNITS,
    Channel,
    existing_file,
    in_si,
    parse_number,
)
from fe_drivetrain.hub_loads.histories import LoadHistory, require_sound

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
    path : str or path-like
        File to read; units are the file's own.
    gage_distance : float or None
        ShftGagL of the ElastoDyn input [m], to carry strain-gage moments to the hub where the file
        has no others.
    azimuth_blade1_up : float
        AzimB1Up of the ElastoDyn input [rad]: the azimuth that is printed when blade 1 points up.

    Raises
    ------
    InputError
        If the file is missing or unreadable, a channel or the azimuth is missing, a unit is
        unknown, or the samples are unsound.
    """
    file = existing_file(path)
    channels = openfast_channels(file)
    time, loads, read = loads_from_channels(str(file), channels, gage_distance, azimuth_blade1_up)
    return LoadHistory(
        file.stem, time, loads, {"source": f"OpenFAST, {file.name}", "channels": read}
    )


def loads_from_channels(
    source: str,
    channels: Mapping[str, Channel],
    gage_distance: float | None = None,
    azimuth_blade1_up: float = 0.0,
) -> tuple[Floats, Floats, str]:
    """Hub loads from the channels of a file.

    Parameters
    ----------
    source : str
        The file, for messages.
    channels : mapping
        Channels by their names in lower case.
    gage_distance, azimuth_blade1_up : float
        As of `read_openfast`.

    Returns
    -------
    time : ndarray, (n,)
        [s].
    loads : ndarray, (n, 6)
        [N, N m].
    read : str
        Which channels these were, in words.

    Raises
    ------
    InputError
        As of `read_openfast`.
    """
    used: dict[str, Channel] = {}

    def first(names: Sequence[str]) -> Channel | None:
        found = next((channels[n.lower()] for n in names if n.lower() in channels), None)
        if found is not None:
            used[found.name] = found
        return found

    def needed(names: Sequence[str], what: str) -> Channel:
        found = first(names)
        if found is None:
            raise InputError(
                f"hub loads '{source}': no channel for the {what}; add one of "
                f"{', '.join(names)} to OutList and run again"
            )
        return found

    def pair(fixed: Sequence[str], rotating: Sequence[str]) -> tuple[list[Channel], bool] | None:
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

    seconds = in_si(source, time, TIME_UNITS)
    columns = {name: channel.values for name, channel in used.items() if channel is not time}
    require_sound(f"hub loads '{source}'", seconds, columns)

    psi = np.zeros_like(seconds)
    if azimuth is not None:
        psi = in_si(source, azimuth, ANGLE_UNITS) - azimuth_blade1_up
    fy, fz = (in_si(source, c, FORCE_UNITS) for c in shear[0])
    if shear[1]:
        fy, fz = turn_to_fixed(fy, fz, psi)
    my, mz = (in_si(source, c, MOMENT_UNITS) for c in bending[0])
    if bending[1]:
        my, mz = turn_to_fixed(my, mz, psi)
    if at_gage and gage_distance is not None:
        # M_gage = M_hub + (-L, 0, 0) cross F
        my, mz = my - gage_distance * fz, mz + gage_distance * fy
    fx = in_si(source, axial, FORCE_UNITS)
    mx = in_si(source, torque, MOMENT_UNITS)
    turned = "" if azimuth is None else f", turned back by {azimuth.name} [{azimuth.unit}]"
    if azimuth is not None and azimuth_blade1_up:
        turned += f" less {azimuth_blade1_up:g} rad"
    carried = f", carried {gage_distance:g} m from the gage to the hub" if at_gage else ""
    changed = any(_reversed(c.name) for c in (axial, torque, *shear[0], *bending[0]))
    read = "; ".join(
        (
            f"Fx = {_as_read(axial)}",
            f"Fy, Fz = {_as_read(*shear[0])}{turned if shear[1] else ''}",
            f"Mx = {_as_read(torque)}",
            f"My, Mz = {_as_read(*bending[0])}{turned if bending[1] else ''}{carried}",
            f"{'other ' if changed else ''}signs as in the file",
            "nothing turned" if azimuth is None else "others not turned",
        )
    )
    return seconds, np.column_stack((fx, fy, fz, mx, my, mz)), read


def _as_read(*channels: Channel) -> str:
    """Names and units of channels as the file has them, and whether their sign was changed."""
    return ", ".join(
        f"{c.name} [{c.unit.strip('()')}]" + (", sign changed" if _reversed(c.name) else "")
        for c in channels
    )


def _reversed(name: str) -> re.Match[str] | None:
    """Whether OutList reversed the sign of a channel: with a leading -, _, m or M."""
    return re.fullmatch(r"[-_m]((?:LSS|Rot|Azimuth).*)", name, re.IGNORECASE)


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


def openfast_channels(file: Path) -> dict[str, Channel]:
    """Every channel of an OpenFAST output file, by its name in lower case.

    Parameters
    ----------
    file : Path
        Text (.out) or binary (.outb).

    Raises
    ------
    InputError
        The file cannot be read.
    """
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
    by_name: dict[str, Channel] = {}
    for name, unit, values in zip(names, units, data.T, strict=True):
        reversed_name = _reversed(name)
        key = (reversed_name[1] if reversed_name else name).lower()
        by_name.setdefault(key, Channel(name, unit, -values if reversed_name else values))
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
                parse_number(cell)
            except ValueError:
                return f"line {number}, channel {name}: {shown(cell)} is not a number"
    return None
