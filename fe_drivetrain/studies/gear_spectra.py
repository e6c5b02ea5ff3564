"""Torque spectra: turns of the rotor, and the other loads of the hub, by classes of its torque."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.cache import user_cache
from fe_drivetrain.common.components import ONE_RPM
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.jobs import mapped
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.provenance import program_hash
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.entrance import Entrance
from fe_drivetrain.shafts.response.entering import AtFront, at_front
from fe_drivetrain.studies.history_options import HistoryOptions
from fe_drivetrain.studies.torque_classes import Rows, torque_classes
from fe_drivetrain.turbine_loads.histories.sites import (
    HOURS_A_YEAR,
    Site,
    midpoint_edges,
    require_winds,
    rounded_wind,
)
from fe_drivetrain.turbine_loads.hub_loads.channels import MOMENT_UNITS, existing_file, in_si
from fe_drivetrain.turbine_loads.hub_loads.csv_columns import csv_channels
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory
from fe_drivetrain.turbine_loads.hub_loads.recorded import SPEED_UNITS, read_recorded
from fe_drivetrain.turbine_loads.hub_loads.table_kinds import history_digest

TORQUE = 3
"""Number of Mx among the loads of the hub."""

_TIMES = {"h": 1.0, "s": 1.0 / 3600.0, "min": 1.0 / 60.0}  # in hours

_MANY = 8  # files for which it pays to start processes


@dataclass(frozen=True, eq=False)
class TorqueSpectrum:
    """How long, and over how many turns, the rotor has which torque.

    Attributes
    ----------
    width : float
        Width of the classes [N m].
    torques : ndarray, (n,)
        Mean torque of each class [N m]; negative ones load the other flanks.
    seconds, turns : ndarray, (n,)
        Time, and turns of the rotor.
    hub : ndarray, (n, 6)
        Mean of the other loads of the hub in each class, Mx being 0 [N, N m].
    """

    width: float
    torques: Floats
    seconds: Floats
    turns: Floats
    hub: Floats

    __repr__ = short_repr

    @property
    def hours(self) -> float:
        """Time of all classes [h]."""
        return float(self.seconds.sum()) / 3600.0

    def times(self, count: float) -> TorqueSpectrum:
        """The same, that many times."""
        return replace(self, seconds=count * self.seconds, turns=count * self.turns)

    def speeds(self, otherwise: float) -> Floats:
        """(n,) mean speed of each class [rad/s]; `otherwise` where it has no time."""
        known = self.seconds > 0.0
        mean = 2.0 * np.pi * self.turns / np.where(known, self.seconds, 1.0)
        return np.asarray(np.where(known, mean, otherwise))

    def coarser(self) -> TorqueSpectrum:
        """The same with classes of twice the width."""
        return merged([self], 2.0 * self.width)


@dataclass(frozen=True)
class Reading:
    """How files of hub loads become spectra.

    Attributes
    ----------
    options : HistoryOptions
        How they are read.
    width : float
        Width of the classes of torque [N m].
    entrance : Entrance or None
        Where loads enter the drivetrain, and which point those of files are about; None where the
        hub is all that is known of its shaft.
    """

    options: HistoryOptions
    width: float
    entrance: Entrance | None

    @property
    def content(self) -> list[Any]:
        """All of it, for the cache."""
        options = self.options
        return [options.skip, options.rotor_speed_rpm, self.width, repr(self.entrance)]

    def loads(self, history: LoadHistory) -> Floats:
        """(n, 6) loads of a history about the point where they enter; zeros where some are absent.

        Raises
        ------
        InputError
            The history has no torque of the rotor.
        """
        if "Mx" in history.absent or history.torque_of:
            which = f"that of the {history.torque_of}" if history.torque_of else "none"
            raise InputError(
                f"hub loads: {history.name} has no torque of the rotor but {which}: name its "
                "channel, or give gearbox_ratio in a mapping"
            )
        if history.absent:
            found = np.zeros_like(history.loads)
            found[:, TORQUE] = history.loads[:, TORQUE]
            return found
        if self.entrance is None:
            return history.loads
        return at_front(AtFront(self.entrance), history).loads


@dataclass(frozen=True, eq=False)
class FileSpectrum:
    """The spectrum of one file.

    Attributes
    ----------
    spectrum : TorqueSpectrum
        Torque and other loads.
    wind : float
        Mean wind speed [m/s]; NaN where the file has none.
    alone : float
        1 where the file has the torque, and not all other loads of the hub; else 0.
    """

    spectrum: TorqueSpectrum
    wind: float
    alone: float


def spectrum_of(
    torque: Floats, loads: Floats, turns: Floats, seconds: Floats, width: float
) -> TorqueSpectrum:
    """Spectrum of samples.

    Parameters
    ----------
    torque : ndarray, (n,)
        Torque of the rotor [N m].
    loads : ndarray, (n, 6)
        Loads of the hub [N, N m].
    turns : ndarray, (n,)
        Turns of the rotor in each sample.
    seconds : ndarray, (n,)
        Time that each sample stands for [s].
    width : float
        Width of the classes [N m].
    """
    other = loads.copy()
    other[:, TORQUE] = 0.0
    return _in_classes(torque, seconds, turns, other, width)


def merged(spectra: Iterable[TorqueSpectrum], width: float) -> TorqueSpectrum:
    """Several spectra together, in classes of a width [N m]."""
    parts = list(spectra)
    torques, seconds, turns, hub = (
        np.concatenate([getattr(one, name) for one in parts])
        for name in ("torques", "seconds", "turns", "hub")
    )
    return _in_classes(torques, seconds, turns, hub, width)


def _in_classes(
    torques: Floats, seconds: Floats, turns: Floats, hub: Floats, width: float
) -> TorqueSpectrum:
    """Means over time of torque and loads by class."""
    numbers: Ints = np.round(torques / width).astype(np.int64)
    _, index = np.unique(numbers, return_inverse=True)
    count = int(index.max(initial=-1)) + 1

    def summed(values: Floats) -> Floats:
        return np.asarray(np.bincount(index, values, count), dtype=np.float64)

    time = summed(seconds)
    mean = np.column_stack([summed(seconds * column) / time for column in (torques, *hub.T)])
    return TorqueSpectrum(width, mean[:, 0], time, summed(turns), mean[:, 1:])


def constant_spectrum(torque: float, hub: Floats, hours: float, speed: float) -> TorqueSpectrum:
    """The spectrum of one torque [N m] for so many hours at a speed [rad/s]."""
    seconds = np.array([3600.0 * hours])
    turns = seconds * speed / (2.0 * np.pi)
    return TorqueSpectrum(abs(torque), np.array([torque]), seconds, turns, hub[None, :])


def stated_spectrum(rows: Rows, hub: Floats, speed: float | None, width: float) -> TorqueSpectrum:
    """A spectrum that is given.

    Parameters
    ----------
    rows : sequence of sequence of float
        Torque of the rotor [N m] and hours of each class, and its speed [rad/s] where there is a
        third number.
    hub : ndarray, (6,)
        Other loads of the hub, of all classes [N, N m].
    speed : float or None
        Rated speed, of classes without one [rad/s].
    width : float
        Width of the classes, for their band [N m].

    Raises
    ------
    InputError
        A class is none, see `torque_classes`.
    """
    torques, hours, speeds = np.array(torque_classes(rows, speed)).T
    seconds = 3600.0 * hours
    turns = seconds * speeds / (2.0 * np.pi)
    return TorqueSpectrum(width, torques, seconds, turns, np.tile(hub, (len(rows), 1)))


def read_spectrum(path: Path) -> list[tuple[float, ...]]:
    """Torque [N m], hours, and speed [rad/s] where there is one, of a table of classes.

    Parameters
    ----------
    path : Path
        CSV with columns as ``torque [kNm]``, ``time [h]`` and ``rotor speed [rpm]``.

    Raises
    ------
    InputError
        There is no such file or column, or a unit is another.
    """
    file = existing_file(path, "torque spectrum")
    columns = csv_channels(file, {"torque", "time", "rotor speed"})
    found = []
    for name, units in (("torque", MOMENT_UNITS), ("time", _TIMES), ("rotor speed", SPEED_UNITS)):
        if name in columns:
            found.append(in_si(str(file), columns[name], units))
        elif name != "rotor speed":
            raise InputError(
                f"torque spectrum '{file}': there is no column {name!r}: give 'torque [kNm]' and "
                "'time [h]'"
            )
    return [tuple(row) for row in np.column_stack(found).tolist()]


def file_spectrum(report: Progress, file: Path, reading: Reading, resume: bool) -> FileSpectrum:
    """The spectrum of a file, or what an earlier run kept where that is asked for.

    Parameters
    ----------
    report : Progress
        Told which file is read.
    file : Path
        File with hub loads.
    reading : Reading
        How it is read.
    resume : bool
        Take what is kept.

    Raises
    ------
    InputError
        The file cannot be read, or has no rotor speed and none is given.
    """
    report(f"{file.stem}: torque spectrum")
    content = {
        "code": program_hash(),
        "file": history_digest(file),
        "mapping": reading.options.names.content(),
        "reading": reading.content,
    }
    cache = user_cache()
    kept = cache.load_record("gear-spectra", content, FileSpectrum) if resume else None
    if kept is None:
        kept = _read(file, reading)
        cache.keep_record("gear-spectra", content, kept)
    return kept


def _read(file: Path, reading: Reading) -> FileSpectrum:
    options = reading.options
    found = read_recorded(file, options.names, options.skip, measured=True)
    history, speed = found.history, found.rotor_speed
    if speed is None and options.rotor_speed_rpm is None:
        raise InputError(
            f"hub loads '{file}': there is no rotor speed, by which gears count turns: give "
            f"{argument('rotor_speed_rpm')} in 1/min, or its channel, as in "
            "`ChannelMap(channels={'rotor speed': 'RotSpeed'})`"
        )
    if speed is None:
        speed = np.full(len(history), (options.rotor_speed_rpm or 0.0) * ONE_RPM)
    seconds = np.broadcast_to(np.asarray(history.sampling.weights), len(history)).astype(float)
    turns = np.abs(speed) * seconds / (2.0 * np.pi)
    loads = reading.loads(history)
    wind = np.nan if found.wind_speed is None else float(found.wind_speed.mean())
    spectrum = spectrum_of(loads[:, TORQUE], loads, turns, seconds, reading.width)
    return FileSpectrum(spectrum, wind, float(bool(history.absent)))


def files_spectrum(
    files: Sequence[Path],
    reading: Reading,
    site: Site | None,
    resume: bool,
    report: Progress,
) -> tuple[TorqueSpectrum, bool]:
    """The spectrum of files together, or of the life of a site whose winds weight them.

    Parameters
    ----------
    files : sequence of Path
        Files with hub loads.
    reading : Reading
        How they are read.
    site : Site or None
        Whose winds weight the files; the time outside of all of them has no load.
    resume : bool
        Take what an earlier run kept.
    report : Progress
        Told which file is read.

    Returns
    -------
    spectrum : TorqueSpectrum
        Torque and other loads.
    alone : bool
        Whether a file has no other loads of the hub, so that they are zero in all.

    Raises
    ------
    InputError
        A file cannot be read, or a site is given and files have no wind speed.
    """
    width = reading.width
    items = [(file, reading, resume) for file in files]
    local = len(items) if len(items) >= _MANY else 1
    found = list(mapped(file_spectrum, items, local, report))
    alone = any(one.alone for one in found)
    if site is None:
        return _kept(merged((one.spectrum for one in found), width), alone), alone
    require_winds(files, [one.wind for one in found])
    at: dict[float, list[TorqueSpectrum]] = {}
    for one in found:
        at.setdefault(rounded_wind(one.wind), []).append(one.spectrum)
    speeds = sorted(at)
    shares = site.shares(midpoint_edges(speeds))
    parts = []
    for speed, share in zip(speeds, shares.tolist(), strict=True):
        pooled = merged(at[speed], width)
        parts.append(pooled.times(share * site.years * HOURS_A_YEAR / pooled.hours))
    return _kept(merged(parts, width), alone), alone


def _kept(spectrum: TorqueSpectrum, alone: bool) -> TorqueSpectrum:
    """The spectrum, without other loads of the hub where those of a file are not known."""
    return replace(spectrum, hub=np.zeros_like(spectrum.hub)) if alone else spectrum
