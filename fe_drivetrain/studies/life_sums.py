"""What files do to a bearing, added up file by file: memory hardly grows with their number."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fe_drivetrain.bearing.geometry import Row
from fe_drivetrain.bearing_life.life.at_site import SiteLife, site_lives
from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.limits import Limits
from fe_drivetrain.bearing_life.life.roller_damage import KINDS, Damage
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.studies.life_assumptions import Assumption, what_ifs
from fe_drivetrain.studies.life_digest import LifeDigest, worse
from fe_drivetrain.studies.life_inside import InsideBand, inside_band
from fe_drivetrain.studies.rolling_bearings import Choices, OneBearing
from fe_drivetrain.turbine_loads.histories.sites import Site, require_winds, rounded_wind


@dataclass(frozen=True, eq=False)
class FileLife:
    """What one file does to a bearing, without where in the bearing.

    Attributes
    ----------
    file : Path
        The file.
    damage : Damage
        Damage and limits of the whole file; its parts by row, place and lamina are left out.
    wind : float
        Mean wind speed [m/s]; NaN where the file has none.
    speed : float
        Mean speed of one ring against the other [1/min].
    samples : float
        Samples that were used.
    vertical : tuple of float
        Mean and standard deviation of Fz at the hub [N].
    own_speeds : ndarray, (2,)
        Least and largest rotor speed that the file states [1/min]; NaN where it has none.
    ratios : ndarray, (assumptions,)
        Damage by L10mr with another value of each assumption, over that with the one taken.
    levels : ndarray, (levels,)
        Damage by L10 at each level of the drivetrain's statics, over that of the one taken.
    flanges : float
        Largest axial force that rolling elements do not carry [N].
    inside : ndarray, (insides, 4)
        What other insides do that fit its page, see `fe_drivetrain.studies.life_inside`.
    """

    file: Path
    damage: Damage
    wind: float
    speed: float
    samples: float
    vertical: tuple[float, float]
    own_speeds: Floats
    ratios: Floats
    levels: Floats
    flanges: float
    inside: Floats

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class DamageOverTime:
    """Where and when a file does its damage.

    Attributes
    ----------
    file : Path
        The file.
    rate : float
        Damage by L10r over time [1/s].
    times : ndarray, (w,)
        Middles of windows [s].
    values : ndarray, (w, rows, elements)
        Damage by L10r of both rings in each window, at each place of the rolling elements.
    """

    file: Path
    rate: float
    times: Floats
    values: Floats

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class WindLoads:
    """Loads of the places of rolling elements in all files of one wind.

    Attributes
    ----------
    wind : float
        Wind speed for which the files stand [m/s].
    seconds : float
        How long they last together.
    mean, peak : ndarray, (rows, elements)
        Mean over that time, and largest [N].
    """

    wind: float
    seconds: float
    mean: Floats
    peak: Floats

    __repr__ = short_repr

    def __add__(self, other: WindLoads) -> WindLoads:
        """Both together; they are of the same wind."""
        seconds = self.seconds + other.seconds
        mean = (self.seconds * self.mean + other.seconds * other.mean) / seconds
        return WindLoads(self.wind, seconds, mean, np.maximum(self.peak, other.peak))


@dataclass(frozen=True, eq=False)
class BearingLife:
    """Life of one bearing, what takes it, and where.

    Attributes
    ----------
    bearing : OneBearing
        The bearing with its catalogue entry, ratings and load path.
    files : tuple of FileLife
        What each file does.
    damage : Damage
        Damage of all files together, or of a year at the site, by row, ring, place and lamina.
    site : SiteLife or None
        Lives and damage by wind, where a site weights the files.
    limits : Limits
        Limits of the methods in the files as they are, not weighted by a site.
    mean_load, peak_load : ndarray, (rows, elements)
        Load of each place of the rolling elements, mean over time and largest [N].
    pressures : ndarray, (rows, 2, laminae)
        Hertz pressure along the roller that has most of it in all files, on inner and outer race
        [Pa]; zero of balls.
    worst : DamageOverTime
        The file with the highest rate of damage by L10r.
    assumptions : tuple of Assumption
        What was not stated, and what it does to L10mr.
    by_wind : tuple of WindLoads
        Loads of each place by wind, the weakest first; empty where a file has no wind speed.
    levels : Mapping[str, float]
        Constant load of the same L10 at each level of the drivetrain's statics over that of the
        level taken; none of a bearing whose rollers are in equilibrium with the shaft.
    inside : InsideBand or None
        Lives, pressure and stiffness over the insides that fit its catalogue's page; None of a
        bearing whose inside is stated.
    clearances : tuple of Assumption
        L10mr with other clearances, those of its band among them.
    """

    bearing: OneBearing
    files: tuple[FileLife, ...]
    damage: Damage
    site: SiteLife | None
    limits: Limits
    mean_load: Floats
    peak_load: Floats
    pressures: Floats
    worst: DamageOverTime
    assumptions: tuple[Assumption, ...]
    by_wind: tuple[WindLoads, ...]
    levels: Mapping[str, float]
    inside: InsideBand | None = None
    clearances: tuple[Assumption, ...] = ()

    def __repr__(self) -> str:
        """One line: the bearing, and its life of each kind."""
        years = ", ".join(f"{kind} {value:.3g}" for kind, value in self.years.items())
        return f"<life of bearing {self.name} [years]: {years}>"

    @property
    def name(self) -> str:
        """Name of the bearing in the scene."""
        return self.bearing.name

    @property
    def rows(self) -> tuple[Row, ...]:
        """Rows of rolling elements, upwind first."""
        return self.bearing.rated.bearing.rows

    @property
    def years(self) -> Mapping[str, float]:
        """Lives L10, L10m, L10r and L10mr [years]; infinite without damage."""
        return self.damage.lives("years") if self.site is None else self.site.years

    @property
    def million_revolutions(self) -> Mapping[str, float]:
        """The same lives [million revolutions]."""
        return self.damage.lives("Mrev")

    @property
    def speed(self) -> float:
        """Mean speed of one ring against the other over all files [1/min]."""
        seconds = [one.damage.seconds for one in self.files]
        return float(np.average([one.speed for one in self.files], weights=seconds))

    @property
    def flanges(self) -> float:
        """Largest axial force that rolling elements do not carry [N]."""
        return max(one.flanges for one in self.files)

    @property
    def bands(self) -> Mapping[str, float | None]:
        """Scatter of each of the lives over files of a wind [years]; see `scatter`."""
        return {kind: scatter(self, kind) for kind in KINDS}


class BearingSums:
    """Sums over the files of one bearing.

    Parameters
    ----------
    bearing : OneBearing
        The bearing.
    site : Site or None
        Whose winds weight the files.
    """

    def __init__(self, bearing: OneBearing, site: Site | None) -> None:
        self._bearing = bearing
        self._site = site
        self._files: list[FileLife] = []
        self._at: dict[float, Damage] = {}
        self._load_seconds: Floats | float = 0.0
        self._peak: Floats | None = None
        self._pressures = np.zeros(0)
        self._worst: DamageOverTime | None = None
        self._winds: dict[float, WindLoads] = {}

    def add(self, file: Path, digest: LifeDigest) -> None:
        """Add the digest of a file."""
        damage = digest.damage
        # all files are one condition where no site weights their winds
        wind = 0.0 if self._site is None else rounded_wind(digest.wind)
        self._at[wind] = self._at[wind] + damage if wind in self._at else damage
        self._load_seconds = self._load_seconds + damage.seconds * digest.mean_load
        if self._peak is None:
            self._peak, self._pressures = digest.peak_load, digest.worst
        else:
            self._peak = np.maximum(self._peak, digest.peak_load)
            self._pressures = worse(self._pressures, digest.worst)
        loads = WindLoads(
            rounded_wind(digest.wind), damage.seconds, digest.mean_load, digest.peak_load
        )
        known = self._winds.get(loads.wind)
        self._winds[loads.wind] = loads if known is None else known + loads
        rate = damage.totals["L10r"] / damage.seconds
        if self._worst is None or rate > self._worst.rate:
            self._worst = DamageOverTime(file, rate, digest.times, digest.over_time)
        whole = replace(damage, basic=(), modified=())
        self._files.append(
            FileLife(
                file,
                whole,
                digest.wind,
                digest.speed,
                digest.samples,
                digest.vertical,
                digest.own_speeds,
                digest.ratios,
                digest.levels,
                digest.flanges,
                digest.inside,
            )
        )

    def life(self, rules: LifeRules, choices: Choices) -> BearingLife:
        """The life that follows, with what assumptions do to it.

        Parameters
        ----------
        rules : LifeRules
            Choices that change lives.
        choices : Choices
            With the options that stayed at their default.

        Raises
        ------
        InputError
            A site weights winds, and files have no wind speed, or all have the same.
        """
        if self._site is not None:
            require_winds([one.file for one in self._files], [one.wind for one in self._files])
        damage, at_site = _together(self._at.items(), self._site)
        assert self._peak is not None
        assert self._worst is not None
        limits = self._files[0].damage.limits
        for one in self._files[1:]:
            limits = limits + one.damage.limits
        seconds = sum(one.damage.seconds for one in self._files)
        ifs = what_ifs(self._bearing, self._bearing.rules(rules), choices)
        others = [
            Assumption(
                other.assumed, other.instead, self._years_with(i), other.clearance, other.stated
            )
            for i, other in enumerate(ifs)
        ]
        return BearingLife(
            self._bearing,
            tuple(self._files),
            damage,
            at_site,
            limits,
            np.asarray(self._load_seconds / seconds),
            self._peak,
            self._pressures,
            self._worst,
            tuple(one for one in others if not one.stated),
            tuple(self._winds[wind] for wind in sorted(self._winds))
            if np.isfinite(list(self._winds)).all()
            else (),
            {
                name: self._load_at(i, damage.totals["L10"])
                for i, name in enumerate(self._bearing.levels)
            },
            self._inside(),
            tuple(one for one in others if one.clearance is not None),
        )

    def _load_at(self, level: int, used: float) -> float:
        """Constant load of the same L10 at a level, over that of a damage by the level taken."""
        changed = [
            (
                rounded_wind(one.wind),
                replace(one.damage, of_standard=one.damage.of_standard * one.levels[level]),
            )
            for one in self._files
        ]
        there = _together(changed, self._site)[0].totals["L10"]
        return float((there / used) ** (1.0 / self._bearing.rated.exponent)) if used else 1.0

    def _years_with(self, i: int) -> float:
        """L10mr with another value of the i-th assumption [years]."""
        return self._lives_with([np.array([1.0, one.ratios[i]]) for one in self._files])["L10mr"]

    def _lives_with(self, ratios: Sequence[Floats]) -> Mapping[str, float]:
        """Lives [years] with so many times the damage by L10r and by L10mr of each file."""
        changed = [
            (rounded_wind(one.wind), _with_ratios(one.damage, ratio))
            for one, ratio in zip(self._files, ratios, strict=True)
        ]
        damage, at_site = _together(changed, self._site)
        return damage.lives("years") if at_site is None else at_site.years

    def _inside(self) -> InsideBand | None:
        """Bands over the insides that fit the bearing's page."""
        if not self._files[0].inside.size:
            return None
        effects = np.stack([one.inside for one in self._files])
        lives = [self._lives_with(list(effects[:, k, :2])) for k in range(effects.shape[1])]
        pressures = [one.damage.limits.max_pressure for one in self._files]
        return inside_band(self._bearing, lives, effects, np.array(pressures))


def _together(
    damages: Iterable[tuple[float, Damage]], site: Site | None
) -> tuple[Damage, SiteLife | None]:
    """Damage of all winds as they come, or of a year at a site."""
    if site is not None:
        life = site_lives(list(damages), site)
        return life.a_year, life
    (_, whole), *others = damages
    for _, one in others:
        whole = whole + one
    return whole, None


def _with_ratios(damage: Damage, ratios: Floats) -> Damage:
    """The damage, with so many times its own by L10r and by L10mr."""
    return replace(damage, of_bearing=damage.of_bearing * ratios)


def scatter(life: BearingLife, kind: str = "L10mr") -> float | None:
    """Two standard errors of a life over files of a wind [years]; None where one stands alone.

    Each wind's mean rate of damage has the standard error s / sqrt(n) of its n files; those of all
    winds, weighted by their time at the site, add up as squares.

    Parameters
    ----------
    life : BearingLife
        The bearing.
    kind : str
        Kind of life, one of `fe_drivetrain.bearing_life.life.KINDS`.
    """
    site = life.site
    if site is None:
        return None
    rates: dict[float, list[float]] = {}
    for one in life.files:
        rate = one.damage.totals[kind] / one.damage.seconds
        rates.setdefault(rounded_wind(one.wind), []).append(rate)
    if min(map(len, rates.values())) < 2:
        return None
    each = [rates[float(speed)] for speed in site.speeds]
    mean = float(site.shares @ [np.mean(one) for one in each])
    errors = site.shares * [np.std(one, ddof=1) / np.sqrt(len(one)) for one in each]
    return 2.0 * float(np.linalg.norm(errors)) / mean * site.years[kind] if mean else None
