"""The study of load histories: statistics, spectra, cycles, time at level, load loops."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar, Literal

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.reading import with_sections
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.charts import chart, trace
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.response.stated import Stated, stated_hub_loads
from fe_drivetrain.studies import load_tables as rows
from fe_drivetrain.studies.load_cautions import left_out
from fe_drivetrain.studies.load_comparison import Comparison, LoadSet, compare_sets
from fe_drivetrain.studies.load_digest import UNIT_OF, Digest, LoadOptions, OneShaft
from fe_drivetrain.studies.load_findings import (
    check_classes,
    hub_findings,
    note_unused_speed,
    state_answer,
)
from fe_drivetrain.studies.load_lifetime import Event, Lifetime, event, lifetime
from fe_drivetrain.studies.load_reactions import SceneReactions, digests, scene_reactions
from fe_drivetrain.studies.load_records import (
    lifetime_rows,
    other_rows,
    reaction_loop_rows,
    reaction_rows,
)
from fe_drivetrain.studies.load_totals import EquivalentLoad, LoadSums, LoadTotals
from fe_drivetrain.studies.load_winds import Capture, CaptureTarget, captured
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.shown_units import shown_unit
from fe_drivetrain.studies.torque_limits import limit_of_histories
from fe_drivetrain.turbine_loads.histories.sites import Site, require_winds
from fe_drivetrain.turbine_loads.hub_loads.recorded import Files, recorded_files, short_name

Transients = Sequence[tuple[float, Files]]
"""Events of a lifetime: how many a year, and histories of one each."""

_Event = tuple[float, Sequence[Path]]


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class LoadsResult(Result):
    """What is in load histories.

    Attributes
    ----------
    asked : LoadOptions
        How histories were read and counted.
    hub : LoadTotals
        Hub loads of all files.
    reactions : Mapping[str, LoadTotals]
        Reactions of a scene to them, by bearing, and "gearbox"; empty without a scene, and where
        a file lacks components.
    others : Mapping[str, LoadTotals]
        Other channels, by name and unit, each as the load "Fx".
    capture : Capture or None
        Windows by wind speed and turbulence; None where no file has a wind speed.
    lifetime : Lifetime or None
        Loads weighted by the winds of a site, where one is given.
    comparison : Comparison or None
        These files beside another set, where one is given.
    scene_reactions : SceneReactions or None
        The scene with its reaction matrices; not part of the JSON.
    """

    STUDY: ClassVar[str] = "loads"
    SCHEMA_VERSION: ClassVar[int] = 3

    asked: LoadOptions
    hub: LoadTotals
    reactions: Mapping[str, LoadTotals]
    others: Mapping[str, LoadTotals]
    capture: Capture | None
    lifetime: Lifetime | None
    comparison: Comparison | None
    scene_reactions: SceneReactions | None

    @property
    def stated(self) -> Stated:
        """What the hub loads are: sign, frame, origin."""
        of = self.scene_reactions
        return _stated(self.hub, None if of is None else of.scene)

    @property
    def equivalent_loads(self) -> dict[str, dict[float, EquivalentLoad]]:
        """Damage-equivalent loads of hub loads with their bands, by load and slope [N, N m]."""
        return _equivalents(self.hub, self.asked)

    def file_tables(self) -> dict[str, list[Record]]:
        """Long tables by name, as they go to files: windows, ranges, levels, spectra, loops.

        Those without rows are in it, too; the order is that in which a page lists them.
        """
        hub = self.hub
        found = {
            "files": rows.file_rows(hub),
            "windows": rows.window_rows(hub),
            "wind_and_turbulence": rows.turbulence_rows(hub),
            "capture_matrix": [] if self.capture is None else rows.capture_rows(self.capture),
            "spectra": rows.spectrum_rows(hub),
            "loops": rows.each_loop_rows(hub),
            "equivalent_loads": rows.equivalent_rows(hub, self.asked),
            "ranges": rows.range_rows(hub),
            "range_mean": rows.range_mean_rows(hub),
            "levels": rows.level_rows(hub),
        }
        if self.scene_reactions is not None:
            found["reactions"] = self.tables["reactions"]
            found["reaction_loops"] = reaction_loop_rows(self.reactions)
        if self.others:
            found["other_channels"] = self.tables["other_channels"]
            found["other_windows"] = rows.other_window_rows(self.others)
        if self.lifetime is not None:
            found |= rows.lifetime_tables(self.lifetime, self.asked)
        if self.comparison is not None:
            found["beside"] = rows.comparison_rows(self.comparison)
        return found

    def frames(self) -> Mapping[str, Any]:
        """Tables that `to_frame` gives, by name: those of `file_tables`, and those of the page."""
        return {**self.tables, **self.file_tables()}

    def chart(self) -> Chart:
        """Cycles of a range or a larger one, of the moments, or else of the forces."""
        caption, traces, x, y, logarithmic = self.exceedances(self.hub.by_kind[-1])
        return chart(caption, traces, x, y, logarithmic)

    def exceedances(self, loads: Sequence[str]) -> tuple[str, list[Any], str, str, str]:
        """Caption, curves, axes and logarithmic axes of cycles over ranges, of loads of a unit."""
        traces = []
        for name in loads:
            classes = self.hub.cycles.ranges[name]
            traces.append(trace(name, classes.edges()[:-1] / 1e3, classes.at_least))
        unit = shown_unit(UNIT_OF[loads[0]])
        what = "forces" if UNIT_OF[loads[0]] == "N" else "moments"
        what = "the torque" if list(loads) == ["Mx"] else what
        caption = f"Cycles of a range or a larger one, of {what}; {self.asked.counted}"
        return caption, traces, f"range [{unit}]", "cycles", "y"


def loads(
    files: Files,
    options: LoadOptions | None = None,
    target: CaptureTarget | None = None,
    *,
    site: Site | None = None,
    transients: Transients = (),
    against: Files = (),
    scene: Scene | None = None,
    level: Literal[1, 4] = 1,
    resume: bool = False,
    report: Progress = silent,
) -> LoadsResult:
    """Read load histories one by one, and add up what they hold.

    Memory holds a file at a time for each process, and of each file its statistics by window, its
    damage and its loops.

    Parameters
    ----------
    files : str, path, or sequence of these
        Hub loads of any length and step: files (.out, .outb, .csv, or of other programs),
        folders, or patterns as ``"outputs/*.outb"``.
    options : LoadOptions or None
        How they are read and counted; None takes all defaults.
    target : CaptureTarget or None
        What the capture matrix should hold; None takes six windows at each wind speed of the files.
    site : Site, optional
        Site whose winds weight the files over a lifetime.
    transients : sequence of (float, files)
        Events of the lifetime: how many a year, and histories of one each, as `files`.
    against : str, path, or sequence of these
        Another set of histories, with which these are compared, as `files`.
    scene : Scene, optional
        Scene whose bearing reactions to these loads are counted, too.
    level : int
        Model of the scene: 1, a beam on rigid housings, or 4, the assembly of solids.
    resume : bool
        Take digests that an earlier run kept.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        There is no file, one cannot be read, all hold zeros alone, a site is given and files have
        no wind speed, transients are given without a site, or no wind has histories of both sets.
    """
    if scene is not None:
        scene = with_sections(scene, scene.title)
    asked = _Asked(
        recorded_files(files),
        options or LoadOptions(),
        target or CaptureTarget(),
        site,
        [(a_year, recorded_files(of)) for a_year, of in transients],
        recorded_files(against),
        scene,
        level,
        resume,
    )
    return _counted(asked, Steps(report))


@dataclass(frozen=True)
class _Asked:
    """What is asked of load histories."""

    files: Sequence[Path]
    options: LoadOptions
    target: CaptureTarget
    site: Site | None
    transients: Sequence[_Event]
    against: Sequence[Path]
    scene: Scene | None
    level: int
    resume: bool
    shaft: OneShaft = field(default_factory=OneShaft)

    def __post_init__(self) -> None:
        if not self.files:
            raise InputError("load histories: there are no files: give one or more")
        if self.transients and self.site is None:
            raise InputError(
                f"load histories: {argument('transients')} count events of a lifetime: give "
                f"{argument('site')}, too"
            )

    def plain(self) -> dict[str, Any]:
        """All of it as plain data, files by their names."""
        options = self.options
        return {
            "files": [short_name(path, self.files) for path in self.files],
            "skip": options.skip,
            "slopes": [float(slope) for slope in options.slopes],
            "residue": options.residue,
            "gate": options.gate,
            "rotor_speed_rpm": options.rotor_speed_rpm,
            "ultimate": dict(options.ultimate),
            "frequency": options.frequency,
            "channels": options.names.content(),
            "also": list(options.also),
            "target": asdict(self.target),
            "site": None if self.site is None else asdict(self.site),
            "transients": [
                [a_year, [short_name(path, of) for path in of]] for a_year, of in self.transients
            ],
            "against": [short_name(path, self.against) for path in self.against],
            "level": None if self.scene is None else self.level,
        }


def _counted(asked: _Asked, steps: Steps) -> LoadsResult:
    """Count the files, weight them over a lifetime, and compare them, as far as that is asked."""
    found, options, scene = Findings(), asked.options, asked.scene
    found.seed = None
    reactions = None if scene is None else _reactions(found, steps, scene, asked.level)
    mine, its = LoadSet(options.slopes), LoadSet(options.slopes)
    sums = _added_up(asked, steps, reactions, mine)
    if not sums.hub.has_loads:
        raise InputError("all hub loads of all files are zero: give histories with loads")
    _check_ultimate(options, sums.hub)
    if not sums.reactions:
        reactions = None
    capture = captured(sums.hub.statistics, asked.target)
    found.notes += left_out(sums.hub, with_reactions=scene is not None)
    hub_findings(found, sums.hub, options, asked.target, capture)
    found.data("hub_loads_stated", _stated(sums.hub, scene).facts())
    if reactions is not None:
        found.data("reactions", reaction_rows(sums.reactions, options))
        found.data("reactions_stated", reactions.stated.facts())
    if sums.others:
        found.data("other_channels", other_rows(sums.others, options))
    life = None if asked.site is None else _lifetime(found, steps, asked, asked.site, sums.hub)
    comparison = _compared(found, steps, asked, reactions, mine, its) if asked.against else None
    of_events = [] if life is None else [one.own_speeds for one in life.events]
    note_unused_speed(found, options, [sums.hub.files.own_speeds, *of_events, its.own_speeds])
    check_classes(found, sums.hub)
    limit = limit_of_histories(scene, sums.hub.files.torque_of)
    state_answer(found, sums.hub, comparison, limit)
    return LoadsResult(
        asked=options,
        hub=sums.hub,
        reactions=sums.reactions,
        others=sums.others,
        capture=capture,
        lifetime=life,
        comparison=comparison,
        scene_reactions=reactions,
        **found.frozen(steps.times, **asked.plain()),
    )


def _check_ultimate(options: LoadOptions, hub: LoadTotals) -> None:
    """Refuse ultimate loads of what the files do not have."""
    for name in options.ultimate:
        if name not in hub.loads:
            raise InputError(
                f"load histories: an ultimate load of {name} is given, which not every file has "
                f"({', '.join(hub.loads)} are there): leave it out"
            )


def _stated(hub: LoadTotals, scene: Scene | None) -> Stated:
    """What hub loads are: sign, frame, origin; of a torque alone less."""
    found, shaft = stated_hub_loads(scene), hub.files.torque_of
    if hub.loads == ("Mx",):
        return replace(
            found,
            load=f"torque of the {shaft or 'rotor on the shaft'}",
            origin="about the axis of the shaft",
            weight="no part of a torque about the axis",
        )
    return replace(found, load=f"{found.load}, Mx of the {shaft}") if shaft else found


def _reactions(found: Findings, steps: Steps, scene: Scene, level: int) -> SceneReactions:
    """The scene, solved for unit loads."""
    found.about(scene)
    return steps.timed("scene", scene_reactions, scene, level)


def _lifetime(
    found: Findings, steps: Steps, asked: _Asked, site: Site, hub: LoadTotals
) -> Lifetime:
    """Loads weighted by the winds of the site, and by the number of events."""
    require_winds(asked.files, hub.statistics.mean_of("wind speed").tolist())
    with steps.step("transients"):
        life = lifetime(hub, site, _events(asked, steps.report))
    found.data("lifetime", lifetime_rows(life, asked.options))
    return life


def _compared(
    found: Findings,
    steps: Steps,
    asked: _Asked,
    reactions: SceneReactions | None,
    mine: LoadSet,
    its: LoadSet,
) -> Comparison:
    """The files beside another set, which is read into `its`."""
    with steps.step("the others"):
        for file, one in digests(
            asked.against, asked.options, asked.resume, "the others", steps.report, reactions
        ):
            asked.shaft.add(file.stem, one.hub)
            its.add(one)
        comparison = compare_sets(mine, its)
    found.say(*comparison.sentences)
    return comparison


@dataclass(frozen=True, eq=False)
class _Totals:
    """Totals of hub loads, of each reaction, and of other channels."""

    hub: LoadTotals
    reactions: dict[str, LoadTotals]
    others: dict[str, LoadTotals]


def _added_up(
    asked: _Asked,
    steps: Steps,
    reactions: SceneReactions | None,
    mine: LoadSet,
) -> _Totals:
    """Totals of all files; each is added to `mine` where another set is compared.

    There are none of reactions where a file lacks components.
    """
    hub = LoadSums()
    of_scene = {name: LoadSums() for name in (reactions.names if reactions else ())}
    others: dict[str, LoadSums] = {}
    with steps.step("files"):
        for file, one in digests(
            asked.files, asked.options, asked.resume, "files", steps.report, reactions
        ):
            name = short_name(file, asked.files)
            asked.shaft.add(name, one.hub)
            hub.add(name, one.hub)
            if not one.reactions:
                of_scene = {}
            for reaction, sums in of_scene.items():
                sums.add(name, one.reactions[reaction])
            for channel, part in one.others.items():
                others.setdefault(channel, LoadSums()).add(name, part)
            if asked.against:
                mine.add(one)
    return _Totals(
        hub.totals(),
        {name: sums.totals() for name, sums in of_scene.items()},
        {name: sums.totals() for name, sums in others.items()},
    )


def _events(asked: _Asked, report: Progress) -> list[Event]:
    return [
        event(a_year, files, _of_event(asked, files, report)) for a_year, files in asked.transients
    ]


def _of_event(asked: _Asked, files: Sequence[Path], report: Progress) -> Iterator[Digest]:
    """Hub loads of the files of an event."""
    for file, one in digests(files, asked.options, asked.resume, "transients", report):
        asked.shaft.add(file.stem, one.hub)
        yield one.hub


def _equivalents(found: LoadTotals, options: LoadOptions) -> dict[str, dict[float, EquivalentLoad]]:
    return {
        name: {slope: found.equivalent_load(name, slope, options) for slope in options.slopes}
        for name in found.loads
    }
