"""Two sets of load histories compared by wind: what differs by more than seeds scatter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.studies.load_digest import LOADS, UNITS, Digest
from fe_drivetrain.studies.load_reactions import ALONE, FileDigest
from fe_drivetrain.studies.shown_units import shown_unit
from fe_drivetrain.turbine_loads.histories.sets import CHANCE, Difference, differences
from fe_drivetrain.turbine_loads.histories.sites import WIND_BIN, rounded_wind
from fe_drivetrain.turbine_loads.histories.spectra import MULTIPLES
from fe_drivetrain.turbine_loads.histories.windows import COLUMNS


class Feature(NamedTuple):
    """A quantity of a history.

    Attributes
    ----------
    source : str
        Reaction, as "main_bearing", or another channel of the files; empty for hub loads.
    load : str
        One of `LOADS`, or loops of a plane; empty for another channel, which is one.
    what : str
        Statistic, equivalent load or multiple.
    unit : str
        Its unit; empty for another channel, which has that of the files.
    """

    source: str
    load: str
    what: str
    unit: str

    def __str__(self) -> str:
        """The quantity as tables have it: "main_bearing: My, mean [kN m]"."""
        of = ": ".join(filter(None, (self.source, self.load)))
        return f"{of}, {self.what}" + (f" [{self.unit}]" if self.unit else "")


def features(found: Digest, slopes: Sequence[float], source: str = "") -> dict[Feature, float]:
    """Quantities of one history that are compared [kN, kN m].

    Parameters
    ----------
    found : Digest
        The history.
    slopes : sequence of float
        With which it was counted.
    source : str
        Reaction that it is of; empty for hub loads.
    """
    result: dict[Feature, float] = {}
    for name, unit in zip(LOADS, UNITS, strict=False):
        if name not in found.cycles.ranges:
            continue
        for what, value in _of_load(found, name, slopes).items():
            result[Feature(source, name, what, shown_unit(unit))] = value / 1e3
    for name, plane in found.planes.items():
        loops = f"loops of {name}"
        share = 100.0 * plane.loop_seconds / found.span.seconds
        result[Feature(source, loops, "share of time", "%")] = share
        if not np.isnan(plane.over_passing):
            result[Feature(source, loops, "over blade passages", "-")] = plane.over_passing
    if "Mx" in found.cycles.ranges:
        torque = found.torque.equivalent_over_time(found.span.seconds)
        result[Feature(source, "Mx", "equivalent over time", shown_unit("N m"))] = torque / 1e3
    return result


def _of_load(found: Digest, load: str, slopes: Sequence[float]) -> dict[str, float]:
    """Statistics, equivalent loads and multiples of one load, in its own unit."""
    place, seconds = LOADS.index(load), found.span.seconds
    result = dict(zip(COLUMNS, found.windows.together()[place].tolist(), strict=True))
    for k, slope in enumerate(slopes):
        rate = float(found.cycles.damage[place, k]) / seconds
        result[f"DEL of m = {slope:g} at 1 Hz"] = rate ** (1.0 / slope)
    amplitudes = None if found.spectra is None else found.spectra.multiples
    if amplitudes is not None:
        values = zip(MULTIPLES, amplitudes[place].tolist(), strict=True)
        result |= {f"{n}P": value for n, value in values}
    return result


def all_features(found: FileDigest, slopes: Sequence[float]) -> dict[Feature, float]:
    """Quantities of one history, of each reaction to it, and of its other channels.

    Parameters
    ----------
    found : FileDigest
        The history.
    slopes : sequence of float
        With which it was counted.
    """
    result = features(found.hub, slopes)
    for name, part in found.reactions.items():
        result |= features(part, slopes, name)
    for name, part in found.others.items():
        for what, value in _of_load(part, ALONE, slopes).items():
            result[Feature(name, "", what, "")] = value
    return result


@dataclass(frozen=True, eq=False)
class WindComparison:
    """Two sets at one mean wind speed.

    Attributes
    ----------
    wind : str
        The mean wind speed, as "8 m/s".
    counts : tuple of int
        Histories of each set.
    differences : tuple of Difference
        Each quantity that all histories have.
    spectra : Mapping[str, tuple of ndarray]
        Mean power spectral densities (f,) of both sets, unit squared per Hz, by load, as in "My" or
        "main_bearing, Fz".
    """

    wind: str
    counts: tuple[int, int]
    differences: tuple[Difference, ...]
    spectra: Mapping[str, tuple[Floats, Floats]]

    @property
    def beyond(self) -> list[Difference]:
        """What differs by more than the scatter of seeds, farthest first."""
        found = (one for one in self.differences if one.beyond)
        return sorted(found, key=lambda one: -abs(one.one - one.other) / one.allowed)


@dataclass(frozen=True, eq=False)
class Comparison:
    """Two sets of histories.

    Attributes
    ----------
    names : tuple of str
        What the sets are called.
    winds : tuple of WindComparison
        Each mean wind speed of which there are histories of both.
    alone : tuple of str
        Mean wind speeds that are not compared.
    """

    names: tuple[str, str]
    winds: tuple[WindComparison, ...]
    alone: tuple[str, ...]

    @property
    def sentences(self) -> list[str]:
        """How many quantities differ at each wind."""
        return [
            f"{one.wind}: {len(one.beyond)} of {len(one.differences)} quantities differ between "
            f"{self.names[0]} ({one.counts[0]}) and {self.names[1]} ({one.counts[1]}) by more than "
            f"the scatter of seeds; {CHANCE * len(one.differences):.1g} would by chance."
            for one in self.winds
        ]


class LoadSet:
    """One of the sets, of which files are added one after the other.

    Parameters
    ----------
    slopes : sequence of float
        With which files are counted.

    Attributes
    ----------
    features : dict
        Quantities of each history, by mean wind speed.
    own_speeds : list of ndarray
        (2,) least and largest rotor speed that each states [1/min]; NaN where it has none.
    """

    def __init__(self, slopes: Sequence[float]) -> None:
        self._slopes = slopes
        self.features: dict[str, list[dict[Feature, float]]] = {}
        self.own_speeds: list[Floats] = []
        self._spectra: dict[str, dict[str, Floats] | None] = {}

    def add(self, found: FileDigest) -> None:
        """Add the digest of a file."""
        self.own_speeds.append(found.hub.own_speeds)
        wind = found.hub.mean_of("wind speed")
        name = "wind not known" if np.isnan(wind) else f"{rounded_wind(wind):g} m/s"
        self.features.setdefault(name, []).append(all_features(found, self._slopes))
        before, own = self._spectra.get(name, {}), _densities(found)
        if before is None or own is None:
            self._spectra[name] = None
            return
        if before:
            own = {load: _added(before[load], own[load]) for load in own if load in before}
        self._spectra[name] = own or None

    def spectra(self, wind: str) -> dict[str, Floats]:
        """Mean densities at a wind by load; none where a file is too short."""
        number = len(self.features[wind])
        return {load: one / number for load, one in (self._spectra[wind] or {}).items()}


def _added(one: Floats, other: Floats) -> Floats:
    """Two densities line by line, as far as both go."""
    lines = min(len(one), len(other))
    return np.asarray(one[:lines] + other[:lines])


def _densities(found: FileDigest) -> dict[str, Floats] | None:
    """Spectra of the moment across the shaft and of what bearings carry; None of a short file."""
    result = {}
    for name, part in {"": found.hub, **found.reactions}.items():
        if part.spectra is None:
            return None
        for load in ("Fz", "My") if name else filter(None, (part.moment,)):
            result[f"{name}, {load}" if name else load] = part.spectra.density[LOADS.index(load)]
    return result


def compare_sets(
    one: LoadSet, other: LoadSet, names: tuple[str, str] = ("these files", "the others")
) -> Comparison:
    """Compare two sets wind by wind.

    Parameters
    ----------
    one, other : LoadSet
        The two sets.
    names : tuple of str
        What the sets are called.

    Raises
    ------
    InputError
        No wind has histories of both, and three or more together.
    """
    winds, alone = [], []
    for wind in sorted(one.features.keys() | other.features.keys()):
        first, second = one.features.get(wind, []), other.features.get(wind, [])
        if not first or not second or len(first) + len(second) < 3:
            alone.append(wind)
            continue
        mine, its = one.spectra(wind), other.spectra(wind)
        winds.append(
            WindComparison(
                wind,
                (len(first), len(second)),
                tuple(differences(first, second)),
                {load: (mine[load], its[load]) for load in mine if load in its},
            )
        )
    if not winds:
        raise InputError(
            f"{argument('against')}: no mean wind speed, to {WIND_BIN:g} m/s, has histories of "
            "both sets and three or more together: give more histories of the same winds"
        )
    return Comparison(names, tuple(winds), tuple(alone))
