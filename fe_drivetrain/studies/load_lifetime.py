"""What load histories mean over a lifetime at a site: damage and levels, weighted by its winds."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.studies.load_digest import LOADS, Digest
from fe_drivetrain.studies.load_totals import LoadTotals
from fe_drivetrain.turbine_loads.histories.classes import Classes, added
from fe_drivetrain.turbine_loads.histories.level_sums import LevelSums
from fe_drivetrain.turbine_loads.histories.sites import (
    HOURS_A_YEAR,
    Site,
    Transient,
    lifetime_damage,
    midpoint_edges,
    rounded_wind,
    time_factors,
)

CYCLES = 1e7
"""Number of cycles of the equivalent load of a lifetime."""


@dataclass(frozen=True, eq=False)
class Event:
    """Starts or stops of a lifetime.

    Attributes
    ----------
    transient : Transient
        What it is, how often it comes, and how long its histories last on average.
    damage : ndarray, (loads, slopes)
        Sums of n r^m of one event.
    levels : tuple of LevelSums
        Time and turns at level of each history; each stands for as many events.
    own_speeds : tuple of ndarray
        (2,) least and largest rotor speed that each history states [1/min]; NaN where it has none.
    """

    transient: Transient
    damage: Floats
    levels: tuple[LevelSums, ...]
    own_speeds: tuple[Floats, ...]


def event(a_year: float, files: Sequence[Path], found: Iterable[Digest]) -> Event:
    """An event of so many a year, of which there are histories of one each.

    Parameters
    ----------
    a_year : float
        How many a year.
    files : sequence of Path
        The files.
    found : iterable of Digest
        Their digests.
    """
    seconds, damages, levels, speeds = [], [], [], []
    for one in found:
        seconds.append(one.span.seconds)
        damages.append(one.cycles.damage)
        levels.append(one.levels)
        speeds.append(one.own_speeds)
    first = files[0].stem
    name = first if len(files) == 1 else f"{first} and {len(files) - 1} more"
    transient = Transient(name, a_year, float(np.mean(seconds)))
    return Event(transient, np.asarray(np.mean(damages, axis=0)), tuple(levels), tuple(speeds))


@dataclass(frozen=True, eq=False)
class Lifetime:
    """Loads of the lifetime at a site.

    Attributes
    ----------
    site : Site
        Whose winds are weighted.
    speeds, edges : ndarray, (w,) and (w + 1,)
        Mean wind speeds of the files, and how far each reaches [m/s].
    hours, seconds, factors : ndarray, (w,)
        Time of the lifetime at each [h], how long its files last [s], and how often these stand
        for it.
    sources : tuple of str
        What damage comes from: each wind speed, then each event.
    damage : ndarray, (loads, slopes, sources)
        Sums of n r^m of the lifetime; NaN of loads that a file lacks.
    total : ndarray, (loads, slopes)
        Their sums.
    events : tuple of Event
        Transients.
    hours_at_level, turns_at_level : Mapping[str, Classes]
        Time [h] and turns of the rotor of the lifetime at each level, by load, transients included.
    """

    site: Site
    speeds: Floats
    edges: Floats
    hours: Floats
    seconds: Floats
    factors: Floats
    sources: tuple[str, ...]
    damage: Floats
    total: Floats
    events: tuple[Event, ...]
    hours_at_level: Mapping[str, Classes]
    turns_at_level: Mapping[str, Classes]

    def equivalent_loads(self, slopes: Sequence[float]) -> Floats:
        """(loads, slopes) ranges of `CYCLES` cycles that do the damage of the lifetime [N, N m]."""
        return np.asarray((self.total / CYCLES) ** (1.0 / np.array(slopes, dtype=float)))

    @property
    def covered(self) -> float:
        """Share of the lifetime that the files stand for."""
        return float(self.hours.sum()) / (HOURS_A_YEAR * self.site.years)


def lifetime(found: LoadTotals, site: Site, events: Sequence[Event] = ()) -> Lifetime:
    """Weight files by the winds of a site, and add transients.

    Parameters
    ----------
    found : LoadTotals
        All files, of two winds or more: see
        `fe_drivetrain.turbine_loads.histories.sites.require_winds`.
    site : Site
        The site.
    events : sequence of Event
        Transients of the lifetime.
    """
    bins = np.array([rounded_wind(wind) for wind in found.statistics.mean_of("wind speed")])
    speeds = np.unique(bins)
    edges = midpoint_edges(speeds)
    hours = site.hours(edges)
    seconds = np.array([span.seconds for span in found.files.spans])
    at_wind = np.array([found.damages[bins == speed].sum(axis=0) for speed in speeds])
    lasting = np.array([seconds[bins == speed].sum() for speed in speeds])
    factors = time_factors(hours, lasting)
    sources = [*(f"{speed:g} m/s" for speed in speeds), *(e.transient.name for e in events)]
    damage = np.zeros((*at_wind.shape[1:], len(sources)))
    total = np.zeros(at_wind.shape[1:])
    for c, k in np.ndindex(*total.shape):
        of_events = [(one.transient, float(one.damage[c, k])) for one in events]
        total[c, k] = lifetime_damage(at_wind[:, c, k], factors, of_events, site.years)
        damage[c, k] = [
            *(at_wind[:, c, k] * factors),
            *(transient.a_year * site.years * each for transient, each in of_events),
        ]
    standing = dict(zip(speeds.tolist(), factors.tolist(), strict=True))
    return Lifetime(
        site,
        speeds,
        edges,
        hours,
        lasting,
        factors,
        tuple(sources),
        damage,
        total,
        tuple(events),
        _levels(found, site, standing, events, "seconds", 3600.0),
        _levels(found, site, standing, events, "turns", 1.0),
    )


def _levels(
    found: LoadTotals,
    site: Site,
    factors: Mapping[float, float],
    events: Sequence[Event],
    kind: str,
    size: float,
) -> dict[str, Classes]:
    """Distributions of the lifetime by load, in units of so many of those of the histories."""
    result = {}
    known = set(found.loads).intersection(*(levels.seconds for e in events for levels in e.levels))
    for name in LOADS:
        parts = []
        if name not in known:
            continue
        for speed, factor in factors.items():
            own = getattr(found.levels_by_wind[speed], kind)
            parts += [_scaled(own[name], factor / size)] if name in own else []
        for one in events:
            each = one.transient.a_year * site.years / len(one.levels) / size
            of_event = [getattr(levels, kind) for levels in one.levels]
            parts += [_scaled(own[name], each) for own in of_event if name in own]
        if parts:
            result[name] = added(parts)
    return result


def _scaled(classes: Classes, factor: float) -> Classes:
    return replace(classes, amount=factor * classes.amount)
