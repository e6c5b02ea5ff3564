"""Spectra of several loads in one history, and their means over histories of any sampling.

Lines of all histories are 1/`SEGMENT` Hz apart, so that spectra add up line by line as far as the
slowest sampling shows them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.histories.spectra import (
    FEWEST,
    MULTIPLES,
    SEGMENT,
    Campbell,
    campbell,
    multiples,
    spectrum,
)

HIGHEST = 10.0
"""Highest frequency of spectra [Hz]."""

SPEED_STEP = 0.05
"""Width of the classes of rotor speed in the Campbell diagram [rad/s]."""


@dataclass(frozen=True, eq=False)
class SpeedSpectra:
    """Spectra of one load by classes of rotor speed that are filled.

    Attributes
    ----------
    classes : ndarray, (b,)
        Numbers of the classes, each `SPEED_STEP` wide.
    segments : ndarray, (b,)
        How many segments each has.
    frequency : ndarray, (f,)
        [Hz].
    density : ndarray, (b, f)
        Mean of the segments, unit squared per Hz.
    load : str
        Which load.
    """

    classes: Floats
    segments: Floats
    frequency: Floats
    density: Floats
    load: str


@dataclass(frozen=True, eq=False)
class HistorySpectra:
    """Spectra of the loads of one history.

    Attributes
    ----------
    density : ndarray, (c, f)
        Power spectral density of each load, unit squared per Hz, at multiples of 1/`SEGMENT` Hz.
    multiples : ndarray, (c, 4) or None
        Amplitudes at `MULTIPLES` of the mean rotor speed, NaN where the samples cannot show them;
        None where the rotor's speed is not known.
    appears_at : ndarray, (4,) or None
        Where they appear [Hz]: another frequency where the sampling is too slow.
    by_speed : SpeedSpectra or None
        Spectra of one load by rotor speed; None where no segment fits, or no speed is known.
    """

    density: Floats
    multiples: Floats | None
    appears_at: Floats | None
    by_speed: SpeedSpectra | None


def history_spectra(
    channels: Mapping[str, Floats],
    step: float,
    rotor_speed: Floats | None,
    shown: str,
    mean_speed: float | None = None,
) -> HistorySpectra | None:
    """Spectra of a history; None of one shorter than half a segment, whose lines are too far apart,
    or of one with too few samples in a segment.

    Parameters
    ----------
    channels : Mapping[str, ndarray]
        Samples (n,) of each load.
    step : float
        Between two samples [s].
    rotor_speed : ndarray, (n,) or None
        [rad/s].
    shown : str
        The load of the Campbell diagram.
    mean_speed : float, optional
        Mean size of the rotor speed where this is a piece of a history, whose multiples count
        [rad/s]; that of `rotor_speed` where left out.
    """
    if len(channels[shown]) * step < 0.5 * SEGMENT:
        return None  # lines would be wider apart than 1P and 3P may be
    if round(SEGMENT / step) < FEWEST:
        return None
    lines = np.arange(0.0, min(HIGHEST, 0.5 / step), 1.0 / SEGMENT)
    spectra = [spectrum(samples, step) for samples in channels.values()]
    density = np.array([np.interp(lines, s.frequency, s.density) for s in spectra])
    if rotor_speed is None:
        return HistorySpectra(density, None, None, None)
    amplitudes = appears_at = None
    speed = np.abs(rotor_speed)
    turning = float(speed.mean()) if mean_speed is None else mean_speed
    if turning > 0.0:
        rows = [multiples(s, turning, MULTIPLES) for s in spectra]
        amplitudes = np.array(
            [[np.nan if m.amplitude is None else m.amplitude for m in row] for row in rows]
        )
        appears_at = np.array([m.appears_at for m in rows[0]])
    by_speed = _by_speed(channels[shown], step, speed, shown)
    return HistorySpectra(density, amplitudes, appears_at, by_speed)


def joined_spectra(parts: Sequence[tuple[HistorySpectra, float]]) -> HistorySpectra | None:
    """Spectra of a history in pieces, each weighted by its time; None where there is no piece.

    Parameters
    ----------
    parts : sequence of (HistorySpectra, float)
        Of each piece, in which the same channels are known, and its time [s].
    """
    if len(parts) < 2:
        return parts[0][0] if parts else None
    share = np.array([seconds for _, seconds in parts])
    share /= share.sum()
    lines = min(one.density.shape[1] for one, _ in parts)
    density = sum(k * one.density[:, :lines] for k, (one, _) in zip(share, parts, strict=True))
    turning = [
        (k, one) for k, (one, _) in zip(share, parts, strict=True) if one.multiples is not None
    ]
    multiples = appears_at = None
    if turning:
        powers = sum(k * np.asarray(one.multiples) ** 2 for k, one in turning)
        multiples = np.sqrt(powers / sum(k for k, _ in turning))
        appears_at = turning[0][1].appears_at
    return HistorySpectra(np.asarray(density), multiples, appears_at, _joined_by_speed(parts))


def _joined_by_speed(parts: Sequence[tuple[HistorySpectra, float]]) -> SpeedSpectra | None:
    """Spectra by rotor speed of all pieces, each class the mean of its segments."""
    found = [one.by_speed for one, _ in parts if one.by_speed is not None]
    if not found:
        return None
    lines = min(len(one.frequency) for one in found)
    classes = np.unique(np.concatenate([one.classes for one in found]))
    segments, density = np.zeros(len(classes)), np.zeros((len(classes), lines))
    for one in found:
        places = np.searchsorted(classes, one.classes)
        segments[places] += one.segments
        density[places] += one.segments[:, None] * one.density[:, :lines]
    mean = density / segments[:, None]
    return SpeedSpectra(classes, segments, found[0].frequency[:lines], mean, found[0].load)


def _by_speed(samples: Floats, step: float, speed: Floats, load: str) -> SpeedSpectra | None:
    edges = SPEED_STEP * np.arange(np.ceil(speed.max() / SPEED_STEP) + 1)
    try:
        found: Campbell = campbell([(samples, speed, step)], edges)
    except InputError:
        return None  # shorter than a segment
    filled = found.segments > 0.0
    kept = found.frequency < HIGHEST
    return SpeedSpectra(
        np.flatnonzero(filled).astype(float),
        found.segments[filled],
        found.frequency[kept],
        found.density[filled][:, kept],
        load,
    )


@dataclass(frozen=True, eq=False)
class Aliased:
    """A history that is sampled too slowly for a multiple of its rotor's speed.

    Attributes
    ----------
    file : str
        Its name.
    appears_at : ndarray, (4,)
        Where each of `MULTIPLES` appears [Hz].
    step : float
        Between two samples [s].
    """

    file: str
    appears_at: Floats
    step: float


@dataclass(frozen=True, eq=False)
class MeanSpectra:
    """Spectra of c loads, mean of histories.

    Attributes
    ----------
    frequency : ndarray, (f,)
        [Hz], as far as the slowest sampling shows; empty where no history lasts half a segment.
    density : ndarray, (c, f)
        Power spectral density, unit squared per Hz, histories weighted by their time.
    rates : int
        How many different ends the spectra of the histories have.
    multiples : ndarray, (c, 4) or None
        Median amplitude at `MULTIPLES` of the rotor speed over histories, NaN where none shows it;
        None where no speed is known.
    aliased : tuple of Aliased
        Histories that are sampled too slowly for one of them.
    by_speed : Campbell or None
        Spectra of one load by rotor speed; None where fewer than two classes of speed are filled,
        or histories have them of different loads.
    load : str
        Which load; empty where there is none.
    """

    frequency: Floats
    density: Floats
    rates: int
    multiples: Floats | None
    aliased: tuple[Aliased, ...]
    by_speed: Campbell | None
    load: str


class SpectrumSums:
    """Sums over histories, one after the other, of which `MeanSpectra` are made."""

    def __init__(self) -> None:
        self._density: dict[int, tuple[Floats, float]] = {}  # by number of lines, and seconds
        self._by_speed: dict[int, tuple[Floats, float]] = {}  # by class of speed, and segments
        self._lines = np.zeros(0)
        self._multiples: list[Floats] = []
        self._aliased: list[Aliased] = []
        self._loads: set[str] = set()  # of the spectra by speed

    def add(self, file: str, found: HistorySpectra, seconds: float, step: float) -> None:
        """Add a history of that name, which lasts so many seconds in steps of `step` [s]."""
        density = found.density
        total, time = self._density.get(density.shape[1], (np.zeros_like(density), 0.0))
        self._density[density.shape[1]] = (total + seconds * density, time + seconds)
        if found.multiples is not None:
            self._multiples.append(found.multiples)
            if found.appears_at is not None and np.isnan(found.multiples).all(axis=0).any():
                self._aliased.append(Aliased(file, found.appears_at, step))
        if found.by_speed is not None:
            self._add_by_speed(found.by_speed)

    def _add_by_speed(self, found: SpeedSpectra) -> None:
        if not len(self._lines) or len(found.frequency) < len(self._lines):
            self._lines = found.frequency
        kept = len(self._lines)
        self._loads.add(found.load)
        rows = zip(found.classes.astype(int).tolist(), found.segments, found.density, strict=True)
        for place, number, density in rows:
            total, before = self._by_speed.get(place, (np.zeros(kept), 0.0))
            added = total[:kept] + (float(number) * density)[:kept]
            self._by_speed[place] = (added, before + float(number))

    def mean(self) -> MeanSpectra:
        """The means of all histories so far."""
        lines = min(self._density, default=0)
        density = np.zeros((0, 0))
        if lines:
            total = sum(one[:, :lines] for one, _ in self._density.values())
            density = np.asarray(total) / sum(seconds for _, seconds in self._density.values())
        return MeanSpectra(
            np.arange(lines) / SEGMENT,
            density,
            len(self._density),
            self._median_multiples(),
            tuple(self._aliased),
            self._mean_by_speed(),
            min(self._loads, default=""),
        )

    def _median_multiples(self) -> Floats | None:
        if not self._multiples:
            return None
        with np.errstate(all="ignore"):
            table = np.array(self._multiples)
            known = ~np.isnan(table).all(axis=0)
            result = np.full(table.shape[1:], np.nan)
            result[known] = np.nanmedian(table[:, known], axis=0)
        return result

    def _mean_by_speed(self) -> Campbell | None:
        if len(self._by_speed) < 2 or len(self._loads) > 1:
            return None
        first, last = min(self._by_speed), max(self._by_speed)
        density = np.full((last - first + 1, len(self._lines)), np.nan)
        segments = np.zeros(len(density))
        for place, (total, number) in self._by_speed.items():
            density[place - first] = total[: len(self._lines)] / number
            segments[place - first] = number
        edges = SPEED_STEP * np.arange(first, last + 2, dtype=float)
        return Campbell(edges, self._lines, density, segments)
