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
from typing import NamedTuple

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
        The same as for `read_openfast`.

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
        The same as for `read_openfast`.
    """
    chosen = _Chosen(source, channels)
    time = chosen.needed(("Time",), "time")
    axial, torque = chosen.needed(_AXIAL, "thrust"), chosen.needed(_TORQUE, "torque")
    shear = chosen.shear()
    bending, at_gage = chosen.bending(gage_distance)
    azimuth = chosen.azimuth(shear, bending)

    seconds = in_si(source, time, TIME_UNITS)
    columns = {name: one.values for name, one in chosen.used.items() if one is not time}
    require_sound(f"hub loads '{source}'", seconds, columns)

    psi = np.zeros_like(seconds)
    if azimuth is not None:
        psi = in_si(source, azimuth, ANGLE_UNITS) - azimuth_blade1_up
    fy, fz = _fixed(source, shear, FORCE_UNITS, psi)
    my, mz = _fixed(source, bending, MOMENT_UNITS, psi)
    if at_gage and gage_distance is not None:
        # M_gage = M_hub + (-L, 0, 0) cross F
        my, mz = my - gage_distance * fz, mz + gage_distance * fy
    fx = in_si(source, axial, FORCE_UNITS)
    mx = in_si(source, torque, MOMENT_UNITS)
    turned = "" if azimuth is None else f", turned back by {azimuth.name} [{azimuth.unit}]"
    if azimuth is not None and azimuth_blade1_up:
        turned += f" less {azimuth_blade1_up:g} rad"
    carried = f", carried {gage_distance:g} m from the gage to the hub" if at_gage else ""
    changed = any(
        reversed_name(c.name) for c in (axial, torque, *shear.channels, *bending.channels)
    )
    read = "; ".join(
        (
            f"Fx = {_as_read(axial)}",
            f"Fy, Fz = {_as_read(*shear.channels)}{turned if shear.rotating else ''}",
            f"Mx = {_as_read(torque)}",
            f"My, Mz = {_as_read(*bending.channels)}{turned if bending.rotating else ''}{carried}",
            f"{'other ' if changed else ''}signs as in the file",
            "nothing turned" if azimuth is None else "others not turned",
        )
    )
    return seconds, np.column_stack((fx, fy, fz, mx, my, mz)), read


class _Pair(NamedTuple):
    """Channels along y and z, and whether these axes turn with the rotor."""

    channels: list[Channel]
    rotating: bool


def _fixed(
    source: str, pair: _Pair, units: Mapping[str, float], psi: Floats
) -> tuple[Floats, Floats]:
    """Components along the y and z that do not turn."""
    y, z = (in_si(source, c, units) for c in pair.channels)
    return turn_to_fixed(y, z, psi) if pair.rotating else (y, z)


class _Chosen:
    """Channels of a file that hub loads are read from, chosen by what they are for."""

    def __init__(self, source: str, channels: Mapping[str, Channel]) -> None:
        self._source, self._channels = source, channels
        self.used: dict[str, Channel] = {}

    def first(self, names: Sequence[str]) -> Channel | None:
        """The first of some channels that the file has."""
        channels = self._channels
        found = next((channels[n.lower()] for n in names if n.lower() in channels), None)
        if found is not None:
            self.used[found.name] = found
        return found

    def needed(self, names: Sequence[str], what: str) -> Channel:
        """The same; refused where the file has none."""
        found = self.first(names)
        if found is None:
            raise InputError(
                f"hub loads '{self._source}': no channel for the {what}; add one of "
                f"{', '.join(names)} to OutList and run again, or map yours (`ChannelMap`)"
            )
        return found

    def pair(self, fixed: Sequence[str], rotating: Sequence[str]) -> _Pair | None:
        """A pair that is complete: one component alone cannot be turned."""
        for prefixes, turning in ((fixed, False), (rotating, True)):
            for prefix in prefixes:
                names = [prefix.replace("*", axis) for axis in "yz"]
                if all(n.lower() in self._channels for n in names):
                    return _Pair([self.needed([n], n) for n in names], turning)
        return None

    def shear(self) -> _Pair:
        """The shear forces."""
        found = self.pair(("LSShftF*s", "LSSGagF*s"), ("LSShftF*a", "LSSGagF*a"))
        if found is None:
            raise InputError(
                f"hub loads '{self._source}': no pair of shear-force channels; add LSShftFys and "
                "LSShftFzs to OutList and run again, or map yours, both Fy and Fz (`ChannelMap`)"
            )
        return found

    def bending(self, gage_distance: float | None) -> tuple[_Pair, bool]:
        """The bending moments, and whether they are those at the strain gage."""
        at_hub = self.pair(("LSSTipM*s",), ("LSSTipM*a",))
        if at_hub is not None:
            return at_hub, False
        found = self.pair(("LSSGagM*s",), ("LSSGagM*a",))
        if found is None:
            raise InputError(
                f"hub loads '{self._source}': no pair of bending-moment channels; add LSSTipMys "
                "and LSSTipMzs to OutList and run again, or map yours, both My and Mz "
                "(`ChannelMap`)"
            )
        if gage_distance is None:
            y, z = found.channels
            raise InputError(
                f"hub loads '{self._source}': {y.name} and {z.name} are moments at the strain "
                "gage, not at the hub; add LSSTipMys and LSSTipMzs to OutList, or give "
                "gage_distance (ShftGagL of the ElastoDyn file)"
            )
        return found, True

    def azimuth(self, *pairs: _Pair) -> Channel | None:
        """The azimuth, where pairs turn with the rotor."""
        rotating = ", ".join(c.name for pair in pairs if pair.rotating for c in pair.channels)
        if not rotating:
            return None
        found = self.first(AZIMUTH)
        if found is None:
            raise InputError(
                f"hub loads '{self._source}': {rotating} turn with the rotor and the file has no "
                "azimuth to turn them back; add Azimuth, or LSShftFys, LSShftFzs, LSSTipMys and "
                "LSSTipMzs, to OutList"
            )
        return found


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
