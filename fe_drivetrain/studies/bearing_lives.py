"""Rating lives of a drivetrain's rolling bearings under load histories: ISO 281, ISO/TS 16281.

Each load step is brought to equilibrium with shaft and rollers; damage adds up step by step and
file by file, so that memory does not grow with the length of histories, and little with their
number.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import islice
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.roller_damage import KINDS
from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.jobs import mapped
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.drivetrain_file.without_weight import weightless
from fe_drivetrain.dynamics.bodies.condensed_rungs import plain_rungs
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.report.charts import bars, error_bars
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies.gearbox_bearings import (
    MachineBearings,
    catalogue_entries,
    machine_bearings,
    machine_with_bearings,
)
from fe_drivetrain.studies.gearbox_findings import assume_reactions, name_unrated, say_levels
from fe_drivetrain.studies.life_answer import state_answer
from fe_drivetrain.studies.life_digest import kept_digest
from fe_drivetrain.studies.life_events import (
    LifeEvent,
    check_events,
    life_events,
    state_events,
    years_with,
)
from fe_drivetrain.studies.life_findings import answers, assumptions, cautions, checks
from fe_drivetrain.studies.life_options import LifeOptions
from fe_drivetrain.studies.life_series import LoadSeries, require_rollers, series_columns
from fe_drivetrain.studies.life_sums import BearingLife, BearingSums
from fe_drivetrain.studies.life_tables import limit_rows, long_tables, result_tables
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.rolling_bearings import OneBearing, bearings_of
from fe_drivetrain.turbine_loads.histories.sites import Site, require_several
from fe_drivetrain.turbine_loads.hub_loads.recorded import Files, recorded_files, short_name

_SEEN = 4  # bearings of which a chart shows lives of all kinds at one view
_LEAST_SHOWN = 0.1  # of a life: where its band is cut on a logarithmic axis
_MANY = 8  # files, each of every bearing, for which it pays to start processes


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class LifeResult(Result):
    """Lives of bearings, what takes them, and where the methods end.

    ``result.bearings["front"].years["L10mr"]`` is a life. Tables by file, wind, place of the
    rollers, wind and place, and lamina are those of `to_frame` with "files", "winds", "places",
    "rollers" and "laminae"; they are in the JSON, too.

    Attributes
    ----------
    bearings : Mapping[str, BearingLife]
        Life by bearing: main bearings, those of the gearbox in the order of the file, planets'.
    site : Site or None
        Whose winds are weighted; None where files repeat for ever.
    rules : LifeRules
        Choices that change lives.
    not_rated : tuple of str
        Bearings of the drivetrain without a catalogue entry.
    events : tuple of LifeEvent
        Events that come beside the histories; `with_events` has lives with them.
    """

    STUDY: ClassVar[str] = "life"
    SCHEMA_VERSION: ClassVar[int] = 3

    bearings: Mapping[str, BearingLife]
    site: Site | None
    rules: LifeRules
    not_rated: tuple[str, ...] = ()
    events: tuple[LifeEvent, ...] = ()

    @property
    def with_events(self) -> Mapping[str, Mapping[str, float]]:
        """Lives [years] of each kind with all events beside the histories, by bearing."""
        return {life.name: years_with(life, self.events) for life in self.lives}

    @property
    def lives(self) -> tuple[BearingLife, ...]:
        """Lives of all bearings."""
        return tuple(self.bearings.values())

    def all_tables(self) -> Mapping[str, Any]:
        """Tables of the page, and those by file, wind, place of the rollers and lamina."""
        return {**self.tables, **long_tables(self.lives)}

    def chart(self) -> Chart:
        """Lives of all bearings, of each kind; of many L10mr alone; those without end left out."""
        kinds = KINDS if len(self.lives) <= _SEEN else KINDS[-1:]
        ending = {
            kind: [life for life in self.lives if np.isfinite(life.years[kind])] for kind in kinds
        }
        groups = {
            kind: {life.name: life.years[kind] for life in lives} for kind, lives in ending.items()
        }
        least = min((v for values in groups.values() for v in values.values()), default=1.0)
        caption = "Lives of the bearings"
        if len(kinds) == 1:
            caption += f", {kinds[0]}"
        if any(life.bands["L10mr"] is not None for life in self.lives):
            caption += ", ± two standard errors of files of the same wind"
        if any(life.inside is not None for life in self.lives):
            caption += ", over all insides that fit the page"
        found = bars(caption, groups, "life [years]", least=least)
        for trace, (kind, lives) in zip(found.figure["data"], ending.items(), strict=True):
            years = np.array([life.years[kind] for life in lives])
            low, high = np.array([_ends(life, kind) for life in lives]).reshape(-1, 2).T
            trace |= error_bars("x", low, years, high)
        return found


def _ends(one: BearingLife, kind: str) -> tuple[float, float]:
    """Least and largest life [years] by its bands, of what is drawn on a logarithmic axis."""
    years, band = one.years[kind], one.bands[kind] or 0.0
    low, high = years - band, years + band
    if one.inside is not None and kind in one.inside.years:
        least, most = one.inside.years[kind]
        low, high = min(low, least), max(high, most)
    # two standard errors may reach below zero, where such an axis ends
    return max(low, _LEAST_SHOWN * years), high


def life(
    drivetrain: Drivetrain,
    files: Files,
    site: Site | None = None,
    options: LifeOptions | None = None,
    *,
    events: Mapping[str, float] | None = None,
    resume: bool = False,
    each: Callable[[LoadSeries], None] | None = None,
    report: Progress = silent,
) -> LifeResult:
    """Rating lives of a drivetrain's rolling bearings under hub loads.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain: main bearings, and those of its gearbox.
    files : str, path, or sequence of these
        Hub loads: files (.out, .outb, .csv, or of other programs), folders, or patterns as
        ``"outputs/*.outb"``.
    site : Site or None
        Whose winds weight the files; without one they repeat for ever.
    options : LifeOptions or None
        Bearings, lubricant, models and how files are read; None takes all defaults.
    events : Mapping[str, float], optional
        Events of `transient` that come beside the histories, and how often in a year, as
        ``{"stop": 700}``.
    resume : bool
        Take what an earlier run of the same program has done with the same files and options.
    each : callable, optional
        Called with the `LoadSeries` of each bearing under each file, where
        ``LifeOptions(series=...)`` asks for them; none is kept.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        The drivetrain has no rolling bearing or an unknown one, a file cannot be read, a site is
        given and files have no wind speed, or an event or a rolling element is unknown.
    """
    asked = LifeOptions() if options is None else options
    paths = recorded_files(files)
    require_several(site, len(paths))
    report("bearings")
    return lives_under(
        DrivetrainBearings(drivetrain, asked),
        paths,
        site,
        events=events,
        resume=resume,
        each=each,
        report=report,
    )


class DrivetrainBearings:
    """A drivetrain whose rolling bearings are ready for lives.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    options : LifeOptions
        What is asked for.

    Attributes
    ----------
    drivetrain : Drivetrain
        The drivetrain, without its weight where that is asked for.
    options : LifeOptions
        What is asked for.
    bearings : list of OneBearing
        Its bearings, or the one that is asked for: main bearings, then those of the gearbox.
    machine : MachineBearings
        Those by statics of the whole, those without a catalogue entry, and the levels of loads.

    Raises
    ------
    InputError
        The drivetrain has no rolling bearing or an unknown one, or no bearing has a rolling element
        whose load is asked for.
    """

    def __init__(self, drivetrain: Drivetrain, options: LifeOptions) -> None:
        self.options = options
        self.drivetrain = drivetrain
        if isinstance(drivetrain, Scene) and not options.weight:
            self.drivetrain = weightless(drivetrain)
        found = machine_with_bearings(drivetrain)
        self.machine = MachineBearings()
        if isinstance(found, Machine):
            self.bearings = self._all_bearings(found)
        else:
            assert isinstance(self.drivetrain, Scene)
            self.machine = MachineBearings(lacks=found)
            self.bearings = bearings_of(self.drivetrain, options.choices)
        if options.series is not None:
            require_rollers(self.bearings, options.series)

    def _all_bearings(self, machine: Machine) -> list[OneBearing]:
        """Main bearings on their rollers where all have an entry, and those by statics."""
        choices, drivetrain = self.options.choices, self.drivetrain
        named = {**catalogue_entries(drivetrain), **choices.named}
        main: list[OneBearing] = []
        on_rollers: list[str] = []
        if isinstance(drivetrain, Scene):
            units = [unit.bearing.name for unit in drivetrain.bearing_units]
            on_rollers = units if all(name in named for name in units) else []
            if on_rollers and choices.only in (None, *on_rollers):
                of_units = {name: entry for name, entry in named.items() if name in units}
                main = bearings_of(drivetrain, replace(choices, named=of_units))
        oil = self.options.oil(drivetrain.operation)
        finest = plain_rungs(drivetrain, machine)[-1]
        self.machine = machine_bearings(machine, named, choices, oil, on_rollers, finest)
        found = [*main, *self.machine.rated]
        if not found:
            raise InputError(
                f"no bearing of {machine.title!r} has an entry of the catalogue: name one under "
                f"'catalogue' in its file, or with "
                f"{argument('LifeOptions.bearings', {self.machine.unrated[0].name: 'ENTRY'})}"
            )
        return found


def lives_under(
    drivetrain: DrivetrainBearings,
    files: Sequence[Path],
    site: Site | None,
    *,
    events: Mapping[str, float] | None = None,
    resume: bool = False,
    each: Callable[[LoadSeries], None] | None = None,
    report: Progress = silent,
) -> LifeResult:
    """Rating lives of bearings that are ready, under hub loads; see `life`.

    Parameters
    ----------
    drivetrain : DrivetrainBearings
        The drivetrain.
    files : sequence of Path
        Hub loads, each of one file.
    site : Site or None
        Whose winds weight the files.
    events : Mapping[str, float], optional
        Events that come beside the files, and how often in a year.
    resume : bool
        Take what an earlier run has done.
    each : callable, optional
        Called with the `LoadSeries` of each bearing under each file, where they are asked for.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        A file cannot be read, a site is given and files have no wind speed, or an event is
        unknown.
    """
    check_events(drivetrain.drivetrain, events or {})
    found, steps = Findings(), Steps(report)
    asked = drivetrain.options
    found.seed = None
    found.about(drivetrain.drivetrain)
    happened: tuple[LifeEvent, ...] = ()
    if events:
        with steps.step("events"):
            happened = life_events(drivetrain.drivetrain, asked, events, report)
    with steps.step("load steps"):
        lives = list(_lives(drivetrain, files, site, resume, each, report))
    machine = drivetrain.machine
    answers(found, lives, asked.rules, site)
    say_levels(found, lives, machine)
    name_unrated(found, machine)
    cautions(found, drivetrain.drivetrain, lives, asked, limit_rows(lives))
    assumptions(found, lives, asked)
    assume_reactions(found, lives, machine)
    checks(found, lives, asked.rings)
    with_events = state_events(found, lives, happened, site)
    state_answer(found, lives, site, len(machine.unrated), with_events)
    for name, table in result_tables(lives, machine).items():
        found.data(name, table)
    return LifeResult(
        bearings={one.name: one for one in lives},
        site=site,
        rules=asked.rules,
        not_rated=tuple(one.name for one in machine.unrated),
        events=happened,
        **found.frozen(steps.times, events=dict(events or {}), **_stated(files, site, asked)),
    )


def _lives(
    drivetrain: DrivetrainBearings,
    files: Sequence[Path],
    site: Site | None,
    resume: bool,
    each: Callable[[LoadSeries], None] | None,
    report: Progress,
) -> Iterator[BearingLife]:
    """Lives of bearings one after the other; digests of files are added up as they come."""
    options, of = drivetrain.options, drivetrain.drivetrain
    rules, choices, reading = options.rules, options.choices, options.reading
    rollers = None if each is None else options.series
    items = [
        (file, one, rules, reading, of, choices, resume, rollers)
        for one in drivetrain.bearings
        for file in files
    ]
    made = mapped(kept_digest, items, len(items) if len(items) >= _MANY else 1, report)
    for one in drivetrain.bearings:
        sums = BearingSums(one, site)
        for file, digest in zip(files, islice(made, len(files)), strict=True):
            sums.add(file, digest)
            if each is not None and rollers is not None and len(digest.series):
                columns = series_columns(one, rollers)
                each(LoadSeries(one.name, file, columns, digest.series[:, 0], digest.series[:, 1:]))
        yield sums.life(rules, choices)


def _stated(files: Sequence[Path], site: Site | None, options: LifeOptions) -> dict[str, Any]:
    """What was asked for, as plain data."""
    asked = {name: getattr(options, name) for name in vars(options)}
    channels = options.channels
    return asked | {
        "catalogues": [Path(path).name for path in options.catalogues],
        "channels": None if channels is None else channels.model_dump(mode="json"),
        "files": [short_name(file, files) for file in files],
        "site": None if site is None else asdict(site),
    }
