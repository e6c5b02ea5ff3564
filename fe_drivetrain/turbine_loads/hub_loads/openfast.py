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
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.channels import (
    ANGLE_UNITS,
    FORCE_UNITS,
    MOMENT_UNITS,
    TIME_UNITS,
    Channel,
    existing_file,
    in_si,
)
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory, require_sound
from fe_drivetrain.turbine_loads.hub_loads.openfast_output import openfast_channels, reversed_name

_AXIAL = ("LSShftFxa", "LSShftFxs", "LSSGagFxa", "LSSGagFxs", "RotThrust")
_TORQUE = ("LSShftMxa", "LSShftMxs", "LSSGagMxa", "LSSGagMxs", "RotTorq", "LSShftTq")
AZIMUTH = ("LSSTipPxa", "LSSTipPxs", "LSSTipP", "Azimuth")
"""By which names files have the azimuth, the best first."""

_PAIRS = tuple(
    f"{n}*{frame}" for n in ("LSShftF", "LSSGagF", "LSSTipM", "LSSGagM") for frame in "sa"
)

LOAD_CHANNELS = frozenset(
    name.lower()
    for name in (
        *("Time", *_AXIAL, *_TORQUE, *AZIMUTH),
        *(pair.replace("*", axis) for pair in _PAIRS for axis in "yz"),
    )
)
"""Names, in lower case, of all channels that `loads_from_channels` may use."""


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
    channels = openfast_channels(file, LOAD_CHANNELS)
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
                f"{', '.join(names)} to OutList and run again, or map yours (--mapping)"
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
            "to OutList and run again, or map yours, both Fy and Fz (--mapping)"
        )
    bending = pair(("LSSTipM*s",), ("LSSTipM*a",))
    at_gage = bending is None
    if bending is None:
        bending = pair(("LSSGagM*s",), ("LSSGagM*a",))
        if bending is None:
            raise InputError(
                f"hub loads '{source}': no pair of bending-moment channels; add LSSTipMys and "
                "LSSTipMzs to OutList and run again, or map yours, both My and Mz (--mapping)"
            )
        if gage_distance is None:
            raise InputError(
                f"hub loads '{source}': {bending[0][0].name} and {bending[0][1].name} are moments "
                "at the strain gage, not at the hub; add LSSTipMys and LSSTipMzs to OutList, or "
                "give gage_distance (ShftGagL of the ElastoDyn file)"
            )

    azimuth = None
    if shear[1] or bending[1]:
        azimuth = first(AZIMUTH)
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
    changed = any(reversed_name(c.name) for c in (axial, torque, *shear[0], *bending[0]))
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
        f"{c.name} [{c.unit.strip('()')}]" + (", sign changed" if reversed_name(c.name) else "")
        for c in channels
    )


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
