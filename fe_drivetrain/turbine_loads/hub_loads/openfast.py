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
from fe_drivetrain.common.components import FORCES
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
from fe_drivetrain.turbine_loads.hub_loads.high_speed import at_rotor
from fe_drivetrain.turbine_loads.hub_loads.histories import NEED_ALL, LoadHistory, require_sound
from fe_drivetrain.turbine_loads.hub_loads.openfast_output import openfast_channels, reversed_name

_AXIAL = ("LSShftFxa", "LSShftFxs", "LSSGagFxa", "LSSGagFxs", "RotThrust")
_TORQUE = ("LSShftMxa", "LSShftMxs", "LSSGagMxa", "LSSGagMxs", "RotTorq", "LSShftTq")
_HIGH_SPEED = ("GenTq", "HSShftTq")
AZIMUTH = ("LSSTipPxa", "LSSTipPxs", "LSSTipP", "Azimuth")
"""By which names files have the azimuth, the best first."""

_PAIRS = tuple(
    f"{n}*{frame}" for n in ("LSShftF", "LSSGagF", "LSSTipM", "LSSGagM") for frame in "sa"
)

LOAD_CHANNELS = frozenset(
    name.lower()
    for name in (
        *("Time", *_AXIAL, *_TORQUE, *_HIGH_SPEED, *AZIMUTH),
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
    found = loads_from_channels(str(file), channels, gage_distance, azimuth_blade1_up)
    origin = {"source": f"OpenFAST, {file.name}", "channels": found.read}
    return LoadHistory(file.stem, found.time, found.loads, origin)


class ChannelLoads(NamedTuple):
    """Hub loads of the channels of a file.

    Attributes
    ----------
    time : ndarray, (n,)
        [s].
    loads : ndarray, (n, 6)
        [N, N m]; NaN of components that the file does not have, where these may be absent.
    read : str
        Which channels these were, in words.
    attributes : Mapping[str, str]
        What is to be known of them.
    """

    time: Floats
    loads: Floats
    read: str
    attributes: Mapping[str, str]


def loads_from_channels(
    source: str,
    channels: Mapping[str, Channel],
    gage_distance: float | None = None,
    azimuth_blade1_up: float = 0.0,
    measured: bool = False,
    gearbox_ratio: float | None = None,
) -> ChannelLoads:
    """Hub loads from the channels of a file.

    Parameters
    ----------
    source : str
        The file, for messages.
    channels : mapping
        Channels by their names in lower case.
    gage_distance, azimuth_blade1_up : float
        The same as for `read_openfast`.
    measured : bool
        Take what components there are, at whatever times.
    gearbox_ratio : float, optional
        Makes the rotor's torque of that of the high-speed shaft, where the file has that alone.

    Raises
    ------
    InputError
        The same as for `read_openfast`.
    """
    chosen = _Chosen(source, channels, measured)
    time = chosen.needed(("Time",), "time")
    axial, torque = chosen.wanted(_AXIAL, "thrust"), chosen.first(_TORQUE)
    high_speed = None
    if torque is None and (measured or gearbox_ratio):
        torque = high_speed = chosen.first(_HIGH_SPEED)
    torque = torque or chosen.wanted(_TORQUE, "torque")
    shear = chosen.shear()
    bending, at_gage = chosen.bending(gage_distance)
    azimuth = chosen.azimuth(shear, bending)
    if azimuth is None:
        shear, bending = (_Pair(None, None) if p.rotating else p for p in (shear, bending))
    chosen.require()

    seconds = in_si(source, time, TIME_UNITS)
    columns = {name: one.values for name, one in chosen.used.items() if one is not time}
    require_sound(f"hub loads '{source}'", seconds, columns, time.rows, even=not measured)

    psi = np.zeros_like(seconds)
    if azimuth is not None:
        psi = in_si(source, azimuth, ANGLE_UNITS) - azimuth_blade1_up
    loads: dict[str, Floats] = {}
    if axial is not None:
        loads["Fx"] = in_si(source, axial, FORCE_UNITS)
    if torque is not None:
        loads["Mx"] = in_si(source, torque, MOMENT_UNITS)
    loads |= _fixed(source, shear, FORCE_UNITS, psi)
    loads |= _fixed(source, bending, MOMENT_UNITS, psi)
    if at_gage and gage_distance is not None:
        # M_gage = M_hub + (-L, 0, 0) cross F
        loads = _from_gage(loads, gage_distance)
    words = _Words(azimuth, azimuth_blade1_up, gage_distance if at_gage else None)
    loads, where = at_rotor(source, loads, high_speed, gearbox_ratio)
    read = words.read(axial, shear, torque, bending)
    read = "; ".join(filter(None, (read, where.words, time.note, *chosen.left_out)))
    if not loads:
        raise chosen.refusal()
    missing = np.full(len(seconds), np.nan)
    six = np.column_stack([loads.get(name, missing) for name in FORCES])
    return ChannelLoads(seconds, six, read, where.attributes)


def _from_gage(loads: Mapping[str, Floats], distance: float) -> dict[str, Floats]:
    """Bending moments at the hub, of those at the strain gage and the shear force."""
    found = dict(loads)
    for moment, force, sign in (("My", "Fz", -1.0), ("Mz", "Fy", 1.0)):
        own = found.pop(moment, None)
        if own is not None and force in loads:
            found[moment] = own + sign * distance * loads[force]
    return found


class _Words(NamedTuple):
    """How channels were turned and carried, as sentences have it."""

    azimuth: Channel | None
    blade1_up: float
    gage_distance: float | None

    def read(
        self, axial: Channel | None, shear: _Pair, torque: Channel | None, bending: _Pair
    ) -> str:
        """Which channels loads were read from."""
        azimuth, used = self.azimuth, [*shear.channels, *bending.channels]
        turned = "" if azimuth is None else f", turned back by {azimuth.name} [{azimuth.unit}]"
        if azimuth is not None and self.blade1_up:
            turned += f" less {self.blade1_up:g} rad"
        distance = self.gage_distance
        carried = "" if distance is None else f", carried {distance:g} m from the gage to the hub"
        changed = any(reversed_name(c.name) for c in (axial, torque, *used) if c is not None)
        parts = [
            f"Fx = {_as_read(axial)}" if axial else "",
            shear.read("F", turned),
            f"Mx = {_as_read(torque)}" if torque else "",
            bending.read("M", turned, carried),
            f"{'other ' if changed else ''}signs as in the file",
            "nothing turned" if azimuth is None else "others not turned",
        ]
        return "; ".join(filter(None, parts))


class _Pair(NamedTuple):
    """Channels along y and z, and whether these axes turn with the rotor; one may be absent."""

    y: Channel | None
    z: Channel | None
    rotating: bool = False

    @property
    def channels(self) -> list[Channel]:
        """Those that are there."""
        return [channel for channel in (self.y, self.z) if channel is not None]

    def read(self, letter: str, turned: str, carried: str = "") -> str:
        """What was read, in words; empty where nothing was."""
        names = [f"{letter}{axis}" for axis, c in (("y", self.y), ("z", self.z)) if c is not None]
        if not names:
            return ""
        how = f"{turned if self.rotating else ''}{carried}"
        return f"{', '.join(names)} = {_as_read(*self.channels)}{how}"


def _fixed(source: str, pair: _Pair, units: Mapping[str, float], psi: Floats) -> dict[str, Floats]:
    """Components along the y and z that do not turn, by name."""
    letter = "F" if units is FORCE_UNITS else "M"
    found = {
        f"{letter}{axis}": in_si(source, channel, units)
        for axis, channel in (("y", pair.y), ("z", pair.z))
        if channel is not None
    }
    if pair.rotating:
        turned = turn_to_fixed(found[f"{letter}y"], found[f"{letter}z"], psi)
        return dict(zip(found, turned, strict=True))
    return found


class _Chosen:
    """Channels of a file that hub loads are read from, chosen by what they are for."""

    def __init__(self, source: str, channels: Mapping[str, Channel], measured: bool) -> None:
        self._source, self._measured = source, measured
        self._channels = {key: channel for key, channel in channels.items() if not channel.invalid}
        self._missing: list[tuple[str, str]] = []
        self.left_out: list[str] = []
        invalid = [c.name for key, c in channels.items() if c.invalid and key in LOAD_CHANNELS]
        if invalid:
            self.left_out.append(f"not read, since INVALID in the file: {', '.join(invalid)}")
        self.used: dict[str, Channel] = {}

    def first(self, names: Sequence[str]) -> Channel | None:
        """The first of some channels that the file has."""
        channels = self._channels
        found = next((channels[n.lower()] for n in names if n.lower() in channels), None)
        if found is not None:
            self.used[found.name] = found
        return found

    def wanted(self, names: Sequence[str], what: str) -> Channel | None:
        """The same; noted as missing where the file has none."""
        found = self.first(names)
        if found is None:
            self._missing.append((f"no channel for the {what}", f"one of {', '.join(names)}"))
        return found

    def needed(self, names: Sequence[str], what: str) -> Channel:
        """The same; refused where the file has none."""
        found = self.wanted(names, what)
        if found is None:
            raise self.refusal()
        return found

    def require(self) -> None:
        """Refuse a file without components that are needed."""
        if self._missing and not self._measured:
            raise self.refusal()

    def refusal(self) -> InputError:
        """The sentence about all that is missing."""
        what, names = (list(column) for column in zip(*self._missing, strict=True))
        end = "" if self._measured else f"; {NEED_ALL}"
        return InputError(
            f"hub loads '{self._source}': {', '.join((*what, *self.left_out))}; add "
            f"{', and '.join(names)} to OutList and run again, or map yours (`ChannelMap`){end}"
        )

    def pair(self, fixed: Sequence[str], rotating: Sequence[str]) -> _Pair | None:
        """A pair that is complete: one component alone cannot be turned."""
        for prefixes, turning in ((fixed, False), (rotating, True)):
            for prefix in prefixes:
                names = [prefix.replace("*", axis) for axis in "yz"]
                if all(n.lower() in self._channels for n in names):
                    y, z = (self.needed([n], n) for n in names)
                    return _Pair(y, z, turning)
        return None

    def _one_of(self, fixed: str) -> _Pair:
        """What there is of a pair that does not turn, of a file that may lack the other one."""
        if not self._measured:
            return _Pair(None, None)
        y, z = (self.first([fixed.replace("*", axis)]) for axis in "yz")
        return _Pair(y, z)

    def shear(self) -> _Pair:
        """The shear forces."""
        found = self.pair(("LSShftF*s", "LSSGagF*s"), ("LSShftF*a", "LSSGagF*a"))
        if found is not None:
            return found
        names = "LSShftFys and LSShftFzs (mapped: both Fy and Fz)"
        self._missing.append(("no pair of shear-force channels", names))
        return self._one_of("LSShftF*s")

    def bending(self, gage_distance: float | None) -> tuple[_Pair, bool]:
        """The bending moments, and whether they are those at the strain gage."""
        at_hub = self.pair(("LSSTipM*s",), ("LSSTipM*a",))
        if at_hub is not None:
            return at_hub, False
        found = self.pair(("LSSGagM*s",), ("LSSGagM*a",))
        if found is None:
            names = "LSSTipMys and LSSTipMzs (mapped: both My and Mz)"
            self._missing.append(("no pair of bending-moment channels", names))
            return self._one_of("LSSTipM*s"), False
        if gage_distance is None:
            names = ", ".join(channel.name for channel in found.channels)
            self._cannot(
                f"{names.replace(', ', ' and ')} are moments at the strain gage, not at the hub",
                "add LSSTipMys and LSSTipMzs to OutList, or give moments_at in `ChannelMap`, which "
                "is ShftGagL of the ElastoDyn file [m]",
            )
            return _Pair(None, None), False
        return found, True

    def azimuth(self, *pairs: _Pair) -> Channel | None:
        """The azimuth, where pairs turn with the rotor."""
        rotating = ", ".join(c.name for pair in pairs if pair.rotating for c in pair.channels)
        if not rotating:
            return None
        found = self.first(AZIMUTH)
        if found is None:
            self._cannot(
                f"{rotating} turn with the rotor and the file has no azimuth to turn them back",
                "add Azimuth, or LSShftFys, LSShftFzs, LSSTipMys and LSSTipMzs, to OutList",
            )
        return found

    def _cannot(self, why: str, remedy: str) -> None:
        """Note channels that cannot be used, or refuse them where all components are needed."""
        if not self._measured:
            raise InputError(f"hub loads '{self._source}': {why}; {remedy}")
        self.left_out.append(f"left out: {why} ({remedy})")


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
