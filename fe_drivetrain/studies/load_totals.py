"""Digests of many files added up, one after the other, so that memory does not grow with them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.studies.load_digest import CHANNELS, LOADS, Digest, LoadOptions, Span
from fe_drivetrain.studies.load_planes import PLANES, PlaneSums, PlaneTotals
from fe_drivetrain.turbine_loads.histories.cycle_sums import CycleSums, equivalent_loads
from fe_drivetrain.turbine_loads.histories.level_sums import LevelSums, TorqueSums
from fe_drivetrain.turbine_loads.histories.sites import rounded_wind
from fe_drivetrain.turbine_loads.histories.spectrum_sums import MeanSpectra, SpectrumSums
from fe_drivetrain.turbine_loads.histories.windows import Windows, joined_windows
from fe_drivetrain.turbine_loads.hub_loads.sampling import Steps


@dataclass(frozen=True, eq=False)
class LoadFiles:
    """Which histories were read.

    Attributes
    ----------
    names : tuple of str
        Name of each file.
    spans : tuple of Span
        When each is.
    channels : Mapping[str, int]
        Which channels were read, and in how many files.
    own_speeds : tuple of ndarray
        (2,) least and largest rotor speed that each states [1/min]; NaN where it has none.
    steps : tuple of Steps
        Steps of time in each, and gaps.
    torque_of : str
        The shaft that Mx was recorded at, where that is not the rotor's; else empty.
    """

    names: tuple[str, ...]
    spans: tuple[Span, ...]
    channels: Mapping[str, int]
    own_speeds: tuple[Floats, ...]
    steps: tuple[Steps, ...]
    torque_of: str

    @property
    def seconds(self) -> float:
        """How long all last [s]."""
        return sum(span.seconds for span in self.spans)

    @property
    def samples(self) -> int:
        """Samples of all."""
        return sum(span.samples for span in self.spans)


@dataclass(frozen=True, eq=False)
class LoadStatistics:
    """Statistics of `CHANNELS`.

    Attributes
    ----------
    windows : tuple of Windows
        Windows of each file.
    means : ndarray, (files, channels)
        Mean over each file; NaN of what it has not.
    """

    windows: tuple[Windows, ...]
    means: Floats

    @property
    def joined(self) -> Windows:
        """Windows of all files, one after the other."""
        return joined_windows(self.windows)

    @property
    def overall(self) -> Floats:
        """(channels, 4) min, mean, max, standard deviation of all samples."""
        return self.joined.together()

    def of_windows(self, channel: str) -> Floats:
        """(windows, 4) min, mean, max, standard deviation of one of `CHANNELS`."""
        return np.asarray(self.joined.values[:, CHANNELS.index(channel)])

    def mean_of(self, channel: str) -> Floats:
        """(files,) means of one of `CHANNELS`."""
        return np.asarray(self.means[:, CHANNELS.index(channel)])

    def mean_and_deviation(self, load: str) -> list[tuple[float, float]]:
        """Mean and standard deviation of a load in each file."""
        place = LOADS.index(load)
        found = []
        for windows, mean in zip(self.windows, self.means[:, place].tolist(), strict=True):
            own, share = windows.values[:, place], windows.seconds / windows.seconds.sum()
            squares = share @ (own[:, 3] ** 2 + (own[:, 1] - mean) ** 2)
            found.append((mean, float(np.sqrt(squares))))
        return found


@dataclass(frozen=True, eq=False)
class Suspects:
    """What may be a fault of a recording.

    Attributes
    ----------
    lone : tuple of (str, str, int, float, float)
        File, component, number of samples that stand alone, time of the first [s], and how many
        times as far from its neighbours as usual the farthest is.
    still : Mapping[str, int]
        Loads that do not vary, and in how many files.
    """

    lone: tuple[tuple[str, str, int, float, float], ...]
    still: Mapping[str, int]


@dataclass(frozen=True)
class EquivalentLoad:
    """Range of a sine that does the same damage as counted cycles.

    Attributes
    ----------
    load : float
        The range [N, N m].
    band : float or None
        What whole cycles in place of half ones would add; None where there are none by the rule.
    """

    load: float
    band: float | None


@dataclass(frozen=True, eq=False)
class LoadTotals:
    """What all files have together: of hub loads, a reaction to them, or another channel.

    Loads that a file lacks are not known of all: arrays have NaN of them, mappings leave them out.

    Attributes
    ----------
    files : LoadFiles
        Which histories were read.
    statistics : LoadStatistics
        Statistics of `CHANNELS`, by file and window.
    cycles : CycleSums
        Cycles of `LOADS`.
    damages : ndarray, (files, loads, slopes)
        Sums of n r^m of each file; NaN of what it has not.
    levels : LevelSums
        Time and turns at each level of `LOADS`.
    levels_by_wind : Mapping[float, LevelSums]
        The same by mean wind speed of the file, rounded [m/s].
    torque : TorqueSums
        Reversals of the torque, and its equivalents.
    spectra : MeanSpectra
        Spectra of `LOADS`.
    planes : Mapping[str, PlaneTotals]
        Force and moment across the shaft.
    suspects : Suspects
        What may be a fault of a recording.
    """

    files: LoadFiles
    statistics: LoadStatistics
    cycles: CycleSums
    damages: Floats
    levels: LevelSums
    levels_by_wind: Mapping[float, LevelSums]
    torque: TorqueSums
    spectra: MeanSpectra
    planes: Mapping[str, PlaneTotals]
    suspects: Suspects

    @property
    def loads(self) -> tuple[str, ...]:
        """Those of `LOADS` that every file has."""
        values = self.statistics.overall[: len(LOADS)]
        return tuple(n for n, row in zip(LOADS, values, strict=True) if not np.isnan(row).any())

    @property
    def by_kind(self) -> list[tuple[str, ...]]:
        """Forces, and moments, that every file has; without a kind that is not there."""
        kinds = (tuple(n for n in of if n in self.loads) for of in (FORCES[:3], FORCES[3:]))
        return [names for names in kinds if names]

    @property
    def absent(self) -> tuple[str, ...]:
        """Components that a file or more lacks."""
        return tuple(name for name in FORCES if name not in self.loads)

    def equivalent_loads(self, options: LoadOptions) -> Floats:
        """(loads, slopes) damage-equivalent loads of all files [N, N m]."""
        slopes = np.array(options.slopes, dtype=float)
        return equivalent_loads(self.cycles.damage, self.files.seconds, slopes, options.frequency)

    def equivalent_loads_about_zero(self, options: LoadOptions) -> Floats:
        """(loads, slopes) the same of cycles about zero mean; NaN without an ultimate load."""
        slopes, sums = np.array(options.slopes, dtype=float), self.cycles.about_zero
        return equivalent_loads(sums, self.files.seconds, slopes, options.frequency)

    def equivalent_load(self, load: str, slope: float, options: LoadOptions) -> EquivalentLoad:
        """The damage-equivalent load of one load and slope, with its band.

        Parameters
        ----------
        load : str
            One of `LOADS`.
        slope : float
            One of those that were counted.
        options : LoadOptions
            How histories were counted.
        """
        place = LOADS.index(load), list(options.slopes).index(slope)
        total, halves = self.cycles.damage[place], self.cycles.halves[place]
        least, most = (
            float(
                equivalent_loads(
                    np.array([[damage]]), self.files.seconds, np.array([slope]), options.frequency
                )[0, 0]
            )
            for damage in (total, total + halves)
        )
        return EquivalentLoad(least, most - least if options.residue == "half" else None)

    @property
    def rotor_frequency(self) -> float | None:
        """Mean frequency of the rotor [Hz]; None where a file has no rotor speed."""
        speed = float(self.statistics.overall[CHANNELS.index("rotor speed"), 1])
        return None if np.isnan(speed) else abs(speed) / (2.0 * np.pi)

    @property
    def has_loads(self) -> bool:
        """Whether any load of any file is not zero."""
        values = self.statistics.joined.values[:, : len(LOADS)]
        return bool(np.nanmax(np.abs(values), initial=0.0) > 0.0)


class LoadSums:
    """Sums over files, one after the other, of which `LoadTotals` are made."""

    def __init__(self) -> None:
        self._names: list[str] = []
        self._spans: list[Span] = []
        self._channels: dict[str, int] = {}
        self._own_speeds: list[Floats] = []
        self._steps: list[Steps] = []
        self._torque_of = ""
        self._windows: list[Windows] = []
        self._means: list[Floats] = []
        self._damages: list[Floats] = []
        self._sums: tuple[CycleSums, LevelSums, TorqueSums] | None = None
        self._by_wind: dict[float, LevelSums] = {}
        self._spectra = SpectrumSums()
        self._planes = {name: PlaneSums() for name, _ in PLANES}
        self._lone: list[tuple[str, str, int, float, float]] = []
        self._still: dict[str, int] = {}

    def add(self, name: str, found: Digest) -> None:
        """Add the digest of a file of that name."""
        seconds = found.span.seconds
        self._names.append(name)
        self._spans.append(found.span)
        self._channels[found.channels] = self._channels.get(found.channels, 0) + 1
        self._own_speeds.append(found.own_speeds)
        self._steps.append(found.steps)
        self._torque_of = found.torque_of or self._torque_of
        self._windows.append(found.windows)
        means = found.windows.values[:, :, 1].T @ found.windows.seconds / seconds
        self._means.append(means)
        self._damages.append(found.cycles.damage)
        self._add_sums(found, float(means[CHANNELS.index("wind speed")]))
        if found.spectra is not None:
            self._spectra.add(name, found.spectra, seconds, found.span.step)
        for plane, sums in self._planes.items():
            sums.add(found.planes.get(plane), seconds)
        for c, component in enumerate(FORCES):
            number, first, far = found.lone[c].tolist()
            if number:
                self._lone.append((name, component, int(number), first, far))
            if found.cycles.largest[c] == 0.0:
                self._still[component] = self._still.get(component, 0) + 1

    def _add_sums(self, found: Digest, wind: float) -> None:
        own, before = (found.cycles, found.levels, found.torque), self._sums
        if before is None:
            self._sums = own
        else:
            self._sums = before[0] + own[0], before[1] + own[1], before[2] + own[2]
        if not np.isnan(wind):
            place = rounded_wind(wind)
            others = self._by_wind.get(place)
            self._by_wind[place] = found.levels if others is None else others + found.levels

    def totals(self) -> LoadTotals:
        """All files so far, one or more."""
        assert self._sums is not None
        cycles, levels, torque = self._sums
        statistics = LoadStatistics(tuple(self._windows), np.array(self._means))
        rows = zip(LOADS, statistics.overall, strict=False)
        known = [name for name, row in rows if not np.isnan(row).any()]
        planes = {name: sums.totals() for name, sums in self._planes.items()}
        return LoadTotals(
            LoadFiles(
                tuple(self._names),
                tuple(self._spans),
                dict(self._channels),
                tuple(self._own_speeds),
                tuple(self._steps),
                self._torque_of,
            ),
            statistics,
            cycles.of(known),
            np.array(self._damages),
            levels.of(known),
            {wind: own.of(known) for wind, own in self._by_wind.items()},
            torque,
            self._spectra.mean(),
            {name: one for name, one in planes.items() if one is not None},
            Suspects(tuple(self._lone), dict(self._still)),
        )
