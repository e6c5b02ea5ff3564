"""Spectra of the load of a raceway over the operating range, beside Stirling 2023, appendix B."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.turbine_loads.histories import Spectrum, spectrum
from fe_drivetrain.turbine_loads.hub_loads import Condition, TurbineHistory

SEGMENT = 120.0
"""Length of a segment [s]."""
RATED_ON = 12.0
"""Wind from which on the rotor keeps its speed, so that multiples of it are lines [m/s]."""
HIGHEST = 12.0
"""Multiple of the rotor's speed up to which spectra are kept."""
FEWEST = 20
"""Segments of a mean from which on its peaks are no scatter: each line is off by 1/20^0.5."""
STANDS_OUT = 2.0
"""Times by which a peak exceeds the higher of the valleys beside it."""
NEAR = 0.15
"""How far from its frequency a peak may stand, over the rotor's speed."""
AROUND = 0.5
"""Half the band of a peak, over the rotor's speed; the background is beside it, as wide."""


@dataclass(frozen=True, eq=False)
class Raceway:
    """Spectra of a raceway's load.

    Attributes
    ----------
    stands : Spectrum
        Spectrum of the sum of all contacts of the row, which a race feels that stands [kN].
    turns : Spectrum
        Spectrum of the load at a point of the inner race, which turns with the rotor [kN].
    speed : float
        Mean speed of the rotor [Hz].
    """

    stands: Spectrum
    turns: Spectrum
    speed: float


READINGS = ("stands", "turns")
"""What "raceway load" may mean, none of which the thesis says."""


def raceway_spectra(row: Floats, history: TurbineHistory) -> Raceway:
    """Spectra of the upwind raceway's load in one history.

    Parameters
    ----------
    row : Floats
        (n, rollers) load of each place of the row, counted from the right upward [kN].
    history : TurbineHistory
        With azimuth and speed.
    """
    step = history.history.step
    speed = abs(float(history.rotor_speed.mean())) / (2.0 * np.pi)
    return Raceway(
        _lower(spectrum(row.sum(axis=1), step, SEGMENT), speed),
        _lower(spectrum(on_turning_race(row, history.azimuth), step, SEGMENT), speed),
        speed,
    )


def on_turning_race(row: Floats, azimuth: Floats) -> Floats:
    """(n,) load at a point of the inner race, between the places beside it.

    Parameters
    ----------
    row : Floats
        (n, rollers) load of each place, counted from the right upward, looking downwind.
    azimuth : Floats
        (n,) angle by which the rotor has turned about +x, which is clockwise there [rad].
    """
    count = row.shape[1]
    place = (-azimuth / (2.0 * np.pi)) % 1.0 * count
    before, steps = np.floor(place).astype(int), np.arange(len(place))
    share = place - before
    return np.asarray(
        (1.0 - share) * row[steps, before % count] + share * row[steps, (before + 1) % count]
    )


def _lower(found: Spectrum, speed: float) -> Spectrum:
    kept = found.frequency <= HIGHEST * speed
    return Spectrum(found.frequency[kept], found.density[kept], found.segments)


@dataclass(frozen=True)
class Peak:
    """A peak of a spectrum.

    Attributes
    ----------
    at : float
        Frequency over the rotor's speed.
    height : float
        Root of the density [kN/Hz^0.5].
    breadth : float
        Width of a rectangle of the same height and power above the background, over the rotor's
        speed; 0 where the background is as high.
    """

    at: float
    height: float
    breadth: float


def peaks(found: Spectrum, speed: float) -> list[Peak]:
    """Peaks that stand out of a spectrum.

    Parameters
    ----------
    found : Spectrum
        The spectrum.
    speed : float
        Speed of the rotor [Hz].
    """
    from scipy.signal import find_peaks

    density = found.density[1:]
    places, _ = find_peaks(np.log(density), prominence=np.log(STANDS_OUT))
    return [_peak(found.frequency[1:] / speed, density, int(i)) for i in places]


def _peak(order: Floats, density: Floats, i: int) -> Peak:
    away = np.abs(order - order[i])
    beside = density[(away > AROUND) & (away <= 2.0 * AROUND)]
    ground = float(np.median(beside)) if len(beside) else 0.0
    above = np.maximum(density[away <= AROUND] - ground, 0.0)
    top = float(density[i]) - ground
    breadth = float(above.sum()) * float(order[1] - order[0]) / top if top > 0.0 else 0.0
    return Peak(float(order[i]), float(np.sqrt(density[i])), breadth)


@dataclass(frozen=True, eq=False)
class OfSet:
    """Mean spectra of a set of winds.

    Attributes
    ----------
    spectra : dict of str to Spectrum
        By reading.
    peaks : dict of str to list of Peak
        What stands out of each.
    speed : float
        Speed of the rotor [Hz].
    """

    spectra: dict[str, Spectrum]
    peaks: dict[str, list[Peak]]
    speed: float

    def near(self, reading: str, orders: Sequence[float]) -> Peak | None:
        """The highest peak near one of some multiples of the rotor's speed; None without one."""
        spacing = self.spectra[reading].spacing / self.speed
        allowed = max(NEAR, 1.5 * spacing)
        found = [
            peak
            for peak in self.peaks[reading]
            if min(abs(peak.at - order) for order in orders) <= allowed
        ]
        return max(found, key=lambda peak: peak.height, default=None)


def of_sets(
    grid: Sequence[Condition],
    names: Sequence[str],
    found: Sequence[Raceway],
) -> dict[str, OfSet]:
    """Mean spectra from rated wind on, by set.

    Parameters
    ----------
    grid : sequence of Condition
        The conditions.
    names : sequence of str
        Set of each.
    found : sequence of Raceway
        Spectra of each.
    """
    result: dict[str, OfSet] = {}
    for own in dict.fromkeys(names):
        part = [
            one
            for condition, name, one in zip(grid, names, found, strict=True)
            if name == own and condition.wind_speed >= RATED_ON
        ]
        speed = float(np.mean([one.speed for one in part]))
        spectra = {reading: _mean([getattr(one, reading) for one in part]) for reading in READINGS}
        of = {reading: peaks(one, speed) for reading, one in spectra.items()}
        result[own] = OfSet(spectra, of, speed)
    return result


def _mean(spectra: Sequence[Spectrum]) -> Spectrum:
    """Mean of spectra of equal lines, up to where the shortest ends."""
    count = min(len(one.frequency) for one in spectra)
    density = np.mean([one.density[:count] for one in spectra], axis=0)
    return Spectrum(spectra[0].frequency[:count], density, sum(one.segments for one in spectra))


def labels(modes: Mapping[str, float], speed: float) -> dict[str, list[float]]:
    """Frequencies at which a peak may stand for each label of the appendix, over the rotor's speed.

    Parameters
    ----------
    modes : mapping of str to float
        "flap" and "edge" of a turning blade [Hz]; a frame that stands has them less and plus that
        of rotation.
    speed : float
        Speed of the rotor [Hz].
    """
    found: dict[str, list[float]] = {"1P": [1.0], "3P": [3.0]}
    flap, edge = modes["flap"] / speed, modes["edge"] / speed
    found["flap"] = [flap - 1.0, flap, flap + 1.0]
    found["6P"] = [6.0]
    found["edge"] = [edge - 1.0, edge, edge + 1.0]
    found["9P"] = [9.0]
    return found
