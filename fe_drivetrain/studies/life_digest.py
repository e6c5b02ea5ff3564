"""What a life needs of one bearing under one file, in little memory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.bearing.answers import race_pressures
from fe_drivetrain.bearing.geometry import RollerRow
from fe_drivetrain.bearing_life.coupled.reaction_paths import ReactionPath
from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.limits import check_speed
from fe_drivetrain.bearing_life.life.roller_damage import Damage, damage_of_steps
from fe_drivetrain.bearing_life.life.steps import Steps
from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats, chunks
from fe_drivetrain.common.cache import user_cache
from fe_drivetrain.common.components import RPM
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.provenance import program_hash
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.response.cached import whole_content
from fe_drivetrain.shafts.response.entering import AtFront, Entered, entering
from fe_drivetrain.studies.life_assumptions import effects, what_ifs
from fe_drivetrain.studies.life_inside import inside_effects
from fe_drivetrain.studies.life_series import has_series, series_values
from fe_drivetrain.studies.rolling_bearings import Choices, OneBearing
from fe_drivetrain.studies.unused import own_speeds, require_samples
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap
from fe_drivetrain.turbine_loads.hub_loads.histories import MIN_SAMPLES
from fe_drivetrain.turbine_loads.hub_loads.point_loads import PointLoads
from fe_drivetrain.turbine_loads.hub_loads.recorded import Recorded, read_recorded
from fe_drivetrain.turbine_loads.hub_loads.table_kinds import history_digest
from fe_drivetrain.turbine_loads.hub_loads.turbines import vertical_forces

WINDOWS = 60
"""Parts of a file, over which the damage map follows the time."""

MAXIMUM = 512
"""Steps at a time, at most."""

LONGEST = 20000
"""Steps of the hub at a time, at most, where no rollers are solved."""


@dataclass(frozen=True)
class Reading:
    """How files are read.

    Attributes
    ----------
    names : ChannelMap
        How files call their channels, and their frame and origin.
    skip : float
        Time that is left out at the beginning of each [s].
    every : int
        Every n-th sample is used.
    rotor_speed : float or None
        Rotor speed of files that have none [1/min].
    """

    names: ChannelMap
    skip: float
    every: int
    rotor_speed: float | None


@dataclass(frozen=True, eq=False)
class LifeDigest:
    """One bearing under one file.

    Attributes
    ----------
    damage : Damage
        Damage of the whole file.
    wind : float
        Mean wind speed [m/s]; not a number where the file has none.
    speed : float
        Mean speed of one ring against the other [1/min].
    samples : float
        Number of samples that were taken.
    mean_load, peak_load : Floats
        (rows, elements) of each roller's place, over time [N].
    times, over_time : Floats
        (w,) middles of windows [s], and (w, rows, elements) damage of both rings in them.
    worst : Floats
        (rows, 2, laminae) pressure along the roller that has the most of it, on the inner and the
        outer race [Pa].
    vertical : tuple of float
        Mean and standard deviation of Fz at the hub [N].
    own_speeds : Floats
        (2,) least and largest rotor speed that the file states [1/min]; NaN where it has none.
    ratios : Floats
        Damage with other values of what was assumed, see `fe_drivetrain.studies.life_assumptions`.
    levels : Floats
        Damage by L10 at each level of `OneBearing.levels`, over that of the load path.
    flanges : float
        Largest axial force that rolling elements do not carry [N].
    series : Floats
        Time [s], and the columns of `life_series.series_columns` over it; empty where none is
        asked for.
    inside : Floats
        What other insides do that fit the bearing's page, see
        `fe_drivetrain.studies.life_inside`.
    """

    damage: Damage
    wind: float
    speed: float
    samples: float
    mean_load: Floats
    peak_load: Floats
    times: Floats
    over_time: Floats
    worst: Floats
    vertical: tuple[float, float]
    own_speeds: Floats
    ratios: Floats
    levels: Floats
    flanges: float
    series: Floats
    inside: Floats


def content(
    file: Path,
    one: OneBearing,
    rules: LifeRules,
    reading: Reading,
    drivetrain: Drivetrain,
    choices: Choices,
    series: Sequence[int] | None = None,
) -> dict[str, Any]:
    """All that a digest depends on.

    Parameters
    ----------
    file : Path
        File with the history.
    one : OneBearing
        The bearing.
    rules : LifeRules
        Rules of the life.
    reading : Reading
        How the file is read.
    drivetrain : Drivetrain
        The drivetrain.
    choices : Choices
        Choices of the model.
    series : sequence of int, optional
        Rolling elements whose loads are kept over time.

    Returns
    -------
    content : dict
        For the cache. What is in files counts, not their names.
    """
    return {
        "code": program_hash(),
        "file": history_digest(file),
        "bearing": one.name,
        "rated": repr(one.rated),
        "clearance": None if one.clearance is None else repr(one.clearance.radial),
        "page": repr(one.entry.page),
        "rollers": {name: repr(b) for name, b in one.path.bearings.items()},
        "rules": repr(one.rules(rules)),
        "reactions": [path.key for path in reactions_of(one)],
        "mapping": reading.names.content(),
        "reading": [reading.skip, reading.every, reading.rotor_speed],
        "scene": whole_content(drivetrain) if isinstance(drivetrain, Scene) else None,
        "choices": repr(choices),
        "series": None if series is None else list(series),
    }


def digest(
    file: Path,
    one: OneBearing,
    rules: LifeRules,
    reading: Reading,
    drivetrain: Drivetrain,
    choices: Choices,
    report: Progress = silent,
    series: Sequence[int] | None = None,
) -> LifeDigest:
    """Damage, load zone and pressures of a bearing under a file.

    Parameters
    ----------
    file : Path
        File with the history.
    one : OneBearing
        The bearing.
    rules : LifeRules
        Rules of the life.
    reading : Reading
        How the file is read.
    drivetrain : Drivetrain
        Says which point of the shaft hub loads are about.
    choices : Choices
        Choices of the model.
    report : Progress
        Told how far it is.
    series : sequence of int, optional
        Rolling elements whose loads are kept over time, beside those of raceways; None keeps no
        load over time, and that of a planet's bearing never is.

    Returns
    -------
    digest : LifeDigest
        What adds up over files.

    Raises
    ------
    InputError
        The file cannot be read, has no rotor speed, or too few samples are taken.
    """
    found = read_recorded(file, reading.names, reading.skip)
    history, speed = found.history, _speed_rpm(file, found, reading)
    require_samples(file, len(history), reading.every, MIN_SAMPLES)
    loads, speed = (
        entering(loaded_at(drivetrain), history)[:: reading.every],
        speed[:: reading.every],
    )
    turns, own = speed * one.path.speed_ratio, one.rules(rules)
    check_speed(one.rated, turns)
    n, step = len(loads), history.step * reading.every
    sums = _Sums(one, series if has_series(one) else None)
    chunk = int(np.clip(-(-n // WINDOWS), 1, MAXIMUM))
    done = 0
    for steps in one.path.steps(loads, speed, step, chunk):
        sums.add(steps, damage_of_steps(steps, one.rated, own), (done + 0.5 * chunk) * step)
        done += len(steps.loads) // one.path.repeats
        report(f"{one.name}, {file.stem}: load steps ({done} of {n})")
    wind = np.nan if found.wind_speed is None else float(found.wind_speed.mean())
    made = sums.digest(wind, float(np.abs(turns).mean()), float(n))
    others = what_ifs(one, own, choices)
    changed = effects(one, own, others, loads, speed, sums.weights)[:, 1]
    levels, flanges = by_levels(one, loads, speed)
    return replace(
        made,
        vertical=vertical_forces([history])[history.name],
        own_speeds=own_speeds(found.rotor_speed),
        ratios=changed,
        levels=levels,
        flanges=flanges,
        series=sums.over_time(history.time[:: reading.every]),
        inside=inside_effects(one, own, choices, loads, speed, sums.weights),
    )


def _speed_rpm(file: Path, found: Recorded, reading: Reading) -> Floats:
    """Rotor speed (n,) of a file, or the one that is given for files without [1/min]."""
    if found.rotor_speed is not None:
        return np.asarray(found.rotor_speed * RPM)
    if reading.rotor_speed is not None:
        return np.full(len(found.history), reading.rotor_speed)
    raise InputError(
        f"hub loads '{file}': there is no rotor speed, by which lives count turns: give "
        f"{argument('LifeOptions.rotor_speed_rpm')} in 1/min, or its channel, as in "
        "`ChannelMap(channels={'rotor speed': 'RotSpeed'})`"
    )


def loaded_at(drivetrain: Drivetrain) -> Entered:
    """Where the hub loads of a drivetrain enter.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    """
    return drivetrain if isinstance(drivetrain, Scene) else AtFront()


def reactions_of(one: OneBearing) -> list[ReactionPath]:
    """All ways of the load to a bearing by reactions: by level, and with other stiffnesses."""
    return [*one.levels.values(), *(other.path for other in one.others)]


def by_levels(one: OneBearing, loads: PointLoads, speed_rpm: Floats) -> tuple[Floats, float]:
    """Damage by L10 at each level over that of the load path, and force on flanges.

    Parameters
    ----------
    one : OneBearing
        The bearing.
    loads : PointLoads
        Load steps as they enter the drivetrain, (n, 6) [N, N m].
    speed_rpm : Floats
        Speed (n,) of the rotor [1/min].

    Returns
    -------
    levels : Floats
        One for each of `OneBearing.levels`; 1 where none does damage.
    flanges : float
        Largest axial force that rolling elements do not carry [N].
    """
    if not isinstance(one.path, ReactionPath):
        return np.zeros(0), 0.0
    paths = [one.path, *one.levels.values()]
    sums, flanges = np.zeros(len(paths)), 0.0
    for part in chunks(len(loads), LONGEST):
        for i, path in enumerate(paths):
            found, beside = path.carried(loads[part])
            used = one.rated.equivalent_load(found) ** one.rated.exponent
            each = used.reshape(-1, path.repeats).mean(axis=1)
            sums[i] += float(each @ np.abs(speed_rpm[part]))
            flanges = max(flanges, float(beside.max())) if path is one.path else flanges
    return sums[1:] / sums[0] if sums[0] else np.ones(len(paths) - 1), flanges


def kept_digest(
    report: Progress,
    file: Path,
    one: OneBearing,
    rules: LifeRules,
    reading: Reading,
    drivetrain: Drivetrain,
    choices: Choices,
    resume: bool,
    series: Sequence[int] | None = None,
) -> LifeDigest:
    """The digest of a bearing under a file, or what an earlier run kept where that is asked for.

    Parameters
    ----------
    report : Progress
        Told how far it is.
    file : Path
        File with the history.
    one : OneBearing
        The bearing.
    rules : LifeRules
        Rules of the life.
    reading : Reading
        How the file is read.
    drivetrain : Drivetrain
        Says which point of the shaft hub loads are about.
    choices : Choices
        Choices of the model.
    resume : bool
        Take what is kept.
    series : sequence of int, optional
        Rolling elements whose loads are kept over time.
    """
    cache, key = user_cache(), content(file, one, rules, reading, drivetrain, choices, series)
    kept = cache.load_record("life-digests", key, LifeDigest) if resume else None
    if kept is None:
        kept = digest(file, one, rules, reading, drivetrain, choices, report, series)
        cache.keep_record("life-digests", key, kept)
    return kept


class _Sums:
    """Sums over chunks of steps."""

    def __init__(self, one: OneBearing, series: Sequence[int] | None) -> None:
        self.one = one
        self.series = series
        self.damage: Damage | None = None
        self.load_seconds = np.zeros(0)
        self.peak = np.zeros(0)
        self.times: list[float] = []
        self.windows: list[Floats] = []
        self.worst = np.zeros(0)
        self._weights: list[Floats] = []
        self._series: list[Floats] = []

    @property
    def weights(self) -> Floats:
        """(n,) of all steps of the hub so far, about in proportion to their damage."""
        each = np.concatenate(self._weights).reshape(-1, self.one.path.repeats)
        return np.asarray(each.sum(axis=1))

    def over_time(self, time: Floats) -> Floats:
        """(n, columns) time [s] and loads of all steps so far; empty where none is asked for."""
        if self.series is None:
            return np.zeros((0, 0))
        return np.column_stack([time, np.concatenate(self._series)])

    def add(self, steps: Steps, damage: Damage, time: float) -> None:
        rollers = [q.sum(axis=2) for q in steps.laminae]
        seconds = np.stack([steps.seconds @ Q for Q in rollers])
        peaks = np.stack([Q.max(axis=0) for Q in rollers])
        worst = np.stack([self._pressures(r, q) for r, q in enumerate(steps.laminae)])
        if self.damage is None:
            self.damage, self.load_seconds, self.peak, self.worst = damage, seconds, peaks, worst
        else:
            self.damage = self.damage + damage
            self.load_seconds = self.load_seconds + seconds
            self.peak = np.maximum(self.peak, peaks)
            self.worst = worse(self.worst, worst)
        turns = np.abs(steps.speed_rpm) * steps.seconds
        self._weights.append(turns * np.sum([(Q**4).mean(axis=1) for Q in rollers], axis=0))
        self.times.append(time)
        if self.series is not None:
            self._series.append(series_values(self.one, self.series, steps))
        self.windows.append(
            np.stack([damage.of_positions(r).sum(axis=0) for r in range(len(rollers))])
        )

    def _pressures(self, r: int, q: Floats) -> Floats:
        """(2, laminae) along the roller with the most loaded lamina; zeros of balls."""
        row = self.one.rated.bearing.rows[r]
        if not isinstance(row, RollerRow):
            return np.zeros((2, q.shape[2]))
        step, roller, _ = np.unravel_index(int(np.argmax(q)), q.shape)
        return np.stack(race_pressures(row, q[step, roller], q.shape[2]))

    def digest(self, wind: float, speed: float, samples: float) -> LifeDigest:
        assert self.damage is not None
        return LifeDigest(
            self.damage,
            wind,
            speed,
            samples,
            self.load_seconds / self.damage.seconds,
            self.peak,
            np.array(self.times),
            np.stack(self.windows),
            self.worst,
            (np.nan, np.nan),
            own_speeds(None),
            np.zeros(0),
            np.zeros(0),
            0.0,
            np.zeros((0, 0)),
            np.zeros((0, 0)),
        )


def worse(mine: Floats, its: Floats) -> Floats:
    """The roller of each row with the higher pressure, (rows, 2, laminae) [Pa]."""
    higher = its.max(axis=(1, 2)) > mine.max(axis=(1, 2))
    return np.where(higher[:, None, None], its, mine)
