"""Wind fields of other programs: full-field files of TurbSim (.bts) and boxes of HAWC2 (.bin).

Layouts: InflowWind of OpenFAST (`IfW_TSFFWind.f90`, `IfW_HAWCWind.f90`), TurbSim User's Guide
(Jonkman 2009). A box of HAWC2 is plane after plane in the order in which they pass the rotor; in a
plane, points upwards are the fastest, then those from the left to the right, looking downwind. In a
file of TurbSim the component is the fastest, then points from the right to the left, then upwards.

Only the along-wind component is used: see `wind`.
"""

from __future__ import annotations

import os
import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.turbine_loads.hub_loads.aero_rotor import (
    Rotor,
    aerodynamic_hub_loads,
    operating_point,
)
from fe_drivetrain.turbine_loads.hub_loads.channels import existing_file
from fe_drivetrain.turbine_loads.hub_loads.histories import Attribute, LoadHistory
from fe_drivetrain.turbine_loads.hub_loads.wind import power_law

_HEADER = struct.Struct("<h4i12fi")
_IDENTIFIERS = (7, 8)  # not periodic, periodic
_TOLERANCE = 1e-6  # of the extent: grids are written in single precision


@dataclass(frozen=True, eq=False)
class WindBox:
    """Along-wind speed on an even grid of points in planes that pass the rotor one by one.

    Attributes
    ----------
    name : str
        Name of its file.
    step : float
        Between two planes [s].
    y : ndarray, (ny,)
        Rising, to the left looking downwind, 0 at the rotor's axis [m].
    z : ndarray, (nz,)
        Height above ground, rising [m].
    speed : ndarray, (n, ny, nz)
        Along-wind, the mean included [m/s].

    Raises
    ------
    InputError
        Shapes disagree, a value is not finite, or the grid is not even and rising.
    """

    name: str
    step: float
    y: Floats
    z: Floats
    speed: NDArray[np.float32]

    __repr__ = short_repr

    def __post_init__(self) -> None:
        if self.speed.shape[1:] != (len(self.y), len(self.z)) or min(self.speed.shape) < 2:
            raise InputError(
                f"wind '{self.name}': {self.speed.shape} speeds on {len(self.y)} x {len(self.z)} "
                "points: give (n, ny, nz), 2 or more of each"
            )
        even = all((np.diff(a) > 0.0).all() and np.ptp(np.diff(a)) < 1e-3 for a in (self.y, self.z))
        if not even or not self.step > 0.0 or not np.isfinite(self.speed).all():
            raise InputError(
                f"wind '{self.name}': points and planes must be evenly spaced, and speeds finite"
            )

    @property
    def time(self) -> Floats:
        """(n,) when each plane passes the rotor [s]."""
        return self.step * np.arange(len(self.speed), dtype=np.float64)

    def at(self, time: ArrayLike, y: ArrayLike, z: ArrayLike) -> Floats:
        """Speed where and when it is asked for, linear between points and planes [m/s].

        Parameters
        ----------
        time, y, z : array_like
            Times and places, of one shape [s, m, m].

        Raises
        ------
        InputError
            A point is outside of the grid, or a time after its end.
        """
        from scipy.ndimage import map_coordinates

        places = []
        for what, unit, values, axis in (
            ("t", "s", time, self.time),
            ("y", "m", y, self.y),
            ("z", "m", z, self.z),
        ):
            at = np.asarray(values, dtype=float)
            spare = _TOLERANCE * float(np.ptp(axis))
            if at.min() < axis[0] - spare or at.max() > axis[-1] + spare:
                raise InputError(
                    f"wind '{self.name}' reaches from {what} = {axis[0]:g} to {axis[-1]:g} {unit} "
                    f"and is asked for from {at.min():g} to {at.max():g} {unit}: give a larger "
                    "field, a smaller rotor or a shorter history"
                )
            places.append((at - axis[0]) / (axis[1] - axis[0]))
        found = map_coordinates(self.speed, places, order=1, mode="nearest", output=np.float64)
        return np.asarray(found)

    def on_blades(self, rotor: Rotor, time: ArrayLike, azimuth: ArrayLike) -> Floats:
        """What the elements of the blades meet: (b, n, r) [m/s], for `aerodynamic_hub_loads`.

        Parameters
        ----------
        rotor : Rotor
            Its hub is at y = 0, in the plane that passes.
        time : array_like, (n,)
            [s].
        azimuth : array_like, (n,)
            Azimuth of blade 1 from upwards, clockwise looking downwind [rad].

        Raises
        ------
        InputError
            The same as for `at`.
        """
        radius, _ = rotor.element_radius()
        shape = (len(np.asarray(time)), len(radius))
        when = np.broadcast_to(np.asarray(time, dtype=float)[:, None], shape)
        wind = np.empty((rotor.blades, *shape))
        for blade in range(rotor.blades):
            angle = np.asarray(azimuth, dtype=float) + 2.0 * np.pi * blade / rotor.blades
            across = -np.outer(np.sin(angle), radius)
            above = np.outer(np.cos(angle), radius) * np.cos(rotor.shaft_tilt)
            wind[blade] = self.at(when, across, rotor.hub_height + above)
        return wind

    def ring_harmonics(self, rotor: Rotor, time: ArrayLike, highest: int) -> NDArray[np.float32]:
        """The wind around each ring of blade elements, in harmonics of azimuth.

        Parameters
        ----------
        rotor : Rotor
            Its elements are the rings.
        time : array_like, (n,)
            [s].
        highest : int
            Highest harmonic M; the 2 M + 1 nodes of a ring have the wind of the field exactly.

        Returns
        -------
        ndarray, (2 M + 1, r, n)
            Mean, cosines, sines [m/s]: what `wind.at_azimuth` takes.

        Raises
        ------
        InputError
            The same as for `at`.
        """
        radius, _ = rotor.element_radius()
        when = np.asarray(time, dtype=float)
        nodes = 2.0 * np.pi * np.arange(2 * highest + 1) / (2 * highest + 1)
        shape = (len(nodes), len(radius), len(when))
        y = -np.sin(nodes)[:, None] * radius
        z = rotor.hub_height + np.cos(nodes)[:, None] * radius * np.cos(rotor.shaft_tilt)
        places = (np.broadcast_to(a[..., None], shape) for a in (y, z))
        wind = self.at(np.broadcast_to(when, shape), *places)
        turns = np.outer(np.arange(1, highest + 1), nodes)
        waves = np.concatenate([np.ones((1, len(nodes))), 2.0 * np.cos(turns), 2.0 * np.sin(turns)])
        return np.asarray(np.tensordot(waves / len(nodes), wind, axes=1), dtype=np.float32)

    def mean_speed(self, rotor: Rotor) -> float:
        """Mean over time at a rotor's hub [m/s]."""
        zero = np.zeros(len(self.speed))
        return float(self.at(self.time, zero, zero + rotor.hub_height).mean())


def box_hub_loads(
    box: WindBox, rotor: Rotor | None = None, azimuth: float = 0.0, rate: float | None = None
) -> LoadHistory:
    """Hub loads of a rotor in a wind field, at the speed and pitch of the mean wind at its hub.

    Parameters
    ----------
    box : WindBox
        The wind.
    rotor : Rotor, optional
        The default one.
    azimuth : float
        Azimuth of blade 1 at the beginning [rad].
    rate : float, optional
        Samples per second [Hz]; the planes' where it is not given.

    Returns
    -------
    LoadHistory
        As long as the wind.

    Raises
    ------
    InputError
        The rotor reaches out of the field, or cannot work in its mean wind.
    """
    rotor = rotor or Rotor()
    end = float(box.time[-1])
    time = box.time if rate is None else np.arange(int(end * rate * (1.0 + 1e-12)) + 1) / rate
    mean = box.mean_speed(rotor)
    point = operating_point(rotor, mean)
    psi = azimuth + point.rotor_speed * time
    loads = aerodynamic_hub_loads(rotor, point, box.on_blades(rotor, time, psi), psi)
    source: dict[str, Attribute] = {
        "source": f"surrogate in the wind of {box.name}",
        "wind_speed": mean,
    }
    return LoadHistory(box.name, time, loads + rotor.weight(), source, about="front face")


def read_bts(path: str | os.PathLike[str]) -> WindBox:
    """Read the along-wind speed of a full-field file of TurbSim.

    Parameters
    ----------
    path : str or path-like
        A .bts file.

    Raises
    ------
    InputError
        It is missing, or of another kind.
    """
    file = existing_file(path, "wind")
    with file.open("rb") as stream:
        head = stream.read(_HEADER.size)
        if len(head) < _HEADER.size:
            raise InputError(f"wind '{file}': it is shorter than the header of a .bts file")
        identifier, nz, ny, tower, n, dz, dy, step, _, _, bottom, *scaling, text = _HEADER.unpack(
            head
        )
        stride = 3 * (ny * nz + tower)
        whole = _HEADER.size + text + 2 * n * stride
        if identifier not in _IDENTIFIERS or min(nz, ny, n) < 1 or tower < 0 or text < 0:
            raise InputError(f"wind '{file}': identifier {identifier} is not one of a .bts file")
        if file.stat().st_size != whole:
            raise InputError(
                f"wind '{file}': {file.stat().st_size} bytes, and its header states {whole}: run "
                "TurbSim again"
            )
        stream.seek(text, 1)
        speed = np.empty((n, ny, nz), dtype=np.float32)
        for k in range(n):  # plane by plane, in the memory of one component
            plane = np.frombuffer(stream.read(2 * stride), "<i2")[: 3 * ny * nz : 3]
            speed[k] = plane.reshape(nz, ny).T
    speed -= scaling[1]
    speed /= scaling[0]
    y = dy * (np.arange(ny) - 0.5 * (ny - 1))
    return WindBox(file.stem, float(step), y, bottom + dz * np.arange(nz), speed)


def write_bts(box: WindBox, path: str | os.PathLike[str], hub_height: float) -> None:
    """Write a wind field as TurbSim does, to 16 bits; other components are zero.

    Parameters
    ----------
    box : WindBox
        The wind.
    path : str or path-like
        A .bts file.
    hub_height : float
        Stated in the header, with the mean speed there [m].
    """
    low, high = float(box.speed.min()), float(box.speed.max())
    slope = 65535.0 / (high - low) if high > low else 1.0
    offset = -32768.0 - slope * low
    n, ny, nz = box.speed.shape
    zero = np.zeros(n)
    mean = float(box.at(box.time, zero, zero + hub_height).mean())
    text = b"fe-drivetrain"
    values = np.zeros((n, nz, ny, 3), dtype="<i2")
    values[..., 0] = np.round(slope * box.speed.transpose(0, 2, 1).astype(float) + offset)
    spacing = box.z[1] - box.z[0], box.y[1] - box.y[0], box.step, mean, hub_height, box.z[0]
    head = _HEADER.pack(7, nz, ny, 0, n, *spacing, slope, offset, 1.0, 0.0, 1.0, 0.0, len(text))
    with atomic_path(Path(path)) as unfinished:
        unfinished.write_bytes(head + text + values.tobytes())


def read_hawc2(
    path: str | os.PathLike[str],
    shape: tuple[int, int, int],
    spacing: tuple[float, float, float],
    wind_speed: float,
    hub_height: float,
    shear: float = 0.0,
) -> WindBox:
    """Read the along-wind component of a turbulence box of HAWC2, and add the mean wind.

    Parameters
    ----------
    path : str or path-like
        The file of the component u: numbers alone, so that all else is stated here.
    shape : tuple of int
        Points along the wind, across and upwards, as in HAWC2's ``box_dim_u`` and so on.
    spacing : tuple of float
        Between them [m].
    wind_speed : float
        Mean at the hub, which carries the box past the rotor [m/s].
    hub_height : float
        Height of the middle of the box [m].
    shear : float
        Exponent of the mean wind's power law.

    Raises
    ------
    InputError
        The file is missing or of another size, or the wind speed is not positive.
    """
    file = existing_file(path, "wind")
    n, ny, nz = shape
    if file.stat().st_size != 4 * n * ny * nz:
        raise InputError(
            f"wind '{file}': {file.stat().st_size} bytes are not {n} x {ny} x {nz} numbers of 4: "
            "state the points along the wind, across and upwards"
        )
    if not wind_speed > 0.0 or not min(spacing) > 0.0:
        raise InputError(f"wind '{file}': wind speed and spacing must be above 0")
    fluctuation = np.fromfile(file, "<f4").reshape(n, ny, nz)[:, ::-1]
    y = spacing[1] * (np.arange(ny, dtype=np.float64) - 0.5 * (ny - 1))
    z = hub_height + spacing[2] * (np.arange(nz, dtype=np.float64) - 0.5 * (nz - 1))
    if not z[0] > 0.0:
        raise InputError(
            f"wind '{file}': the box reaches {-z[0]:g} m below the ground: raise hub_height"
        )
    mean = power_law(wind_speed, z, hub_height, shear)
    speed = (fluctuation + mean).astype(np.float32)
    return WindBox(file.stem, spacing[0] / wind_speed, y, z, speed)


def write_hawc2(
    box: WindBox, path: str | os.PathLike[str], wind_speed: float, hub_height: float, shear: float
) -> None:
    """Write what a wind field has beyond a mean wind as the component u of a box of HAWC2.

    Parameters
    ----------
    box : WindBox
        The wind.
    path : str or path-like
        Takes numbers alone.
    wind_speed, hub_height, shear : float
        The mean wind that is taken off, as of `read_hawc2` [m/s, m, -].
    """
    mean = power_law(wind_speed, box.z, hub_height, shear)
    with atomic_path(Path(path)) as unfinished:
        (box.speed - mean)[:, ::-1].astype("<f4").tofile(unfinished)
