"""The study of load histories: statistics, spectra, cycles, time at level, load loops."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.procedure.failure_modes import ROTOR_TORQUE
from fe_drivetrain.report.answer import value_with_band
from fe_drivetrain.report.charts import chart, trace
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies import load_tables as rows
from fe_drivetrain.studies.load_cautions import cautions
from fe_drivetrain.studies.load_comparison import Comparison, LoadSet, compare_sets
from fe_drivetrain.studies.load_digest import CHANNELS, LOADS, LoadOptions
from fe_drivetrain.studies.load_lifetime import Event, Lifetime, event, lifetime
from fe_drivetrain.studies.load_reactions import SceneReactions, digests, scene_reactions
from fe_drivetrain.studies.load_records import (
    by_slope,
    lifetime_rows,
    loop_rows,
    other_rows,
    reaction_loop_rows,
    reaction_rows,
    torque_rows,
)
from fe_drivetrain.studies.load_totals import EquivalentLoad, LoadSums, LoadTotals
from fe_drivetrain.studies.load_winds import Capture, CaptureTarget, captured, winds_not_used
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.unused import RPM, speed_not_used
from fe_drivetrain.turbine_loads.histories.sites import Site, require_winds
from fe_drivetrain.turbine_loads.histories.spectra import MULTIPLES
from fe_drivetrain.turbine_loads.hub_loads.recorded import Files, recorded_files, short_name

if TYPE_CHECKING:
    pass

_NAMED = 3  # files that are sampled too slowly

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
        Reactions of a scene to them, by bearing, and "gearbox"; empty without a scene.
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

    asked: LoadOptions
    hub: LoadTotals
    reactions: Mapping[str, LoadTotals]
    others: Mapping[str, LoadTotals]
    capture: Capture | None
    lifetime: Lifetime | None
    comparison: Comparison | None
    scene_reactions: SceneReactions | None

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
        """Cycles of a range or a larger one, of the moments."""
        caption, traces, x, y, logarithmic = self.exceedances(("Mx", "My", "Mz"))
        return chart(caption, traces, x, y, logarithmic)

    def exceedances(self, loads: Sequence[str]) -> tuple[str, list[Any], str, str, str]:
        """Caption, curves, axes and logarithmic axes of cycles over ranges, of loads of a unit."""
        traces = []
        for name in loads:
            classes = self.hub.cycles.ranges[name]
            traces.append(trace(name, classes.edges()[:-1] / 1e3, classes.at_least))
        unit = "kN" if loads[0].startswith("F") else "kN m"
        caption = f"Cycles of a range or a larger one; {self.asked.counted}"
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
        Hub loads of any length and step: files (.out, .outb of OpenFAST, or .csv), folders, or
        patterns as ``"outputs/*.outb"``.
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
    paths, others_of = recorded_files(files), recorded_files(against)
    events = [(a_year, recorded_files(of)) for a_year, of in transients]
    if not paths:
        raise InputError("load histories: there are no files: give one or more")
    if events and site is None:
        raise InputError("load histories: transients count events of a lifetime: give a site, too")
    asked, aim = options or LoadOptions(), target or CaptureTarget()
    found, steps = Findings(), Steps(report)
    found.seed = None
    reactions = None
    if scene is not None:
        found.about(scene)
        reactions = steps.timed("scene", scene_reactions, scene, level)
    mine, its = LoadSet(asked.slopes), LoadSet(asked.slopes)
    hub, of_scene, others = _added_up(
        paths, asked, resume, steps, reactions, mine if others_of else None
    )
    if not hub.has_loads:
        raise InputError("all hub loads of all files are zero: give histories with loads")
    capture = captured(hub.statistics, aim)
    _hub_findings(found, hub, asked, aim, capture)
    if reactions is not None:
        found.data("reactions", reaction_rows(of_scene, asked))
        found.data("reactions_stated", reactions.stated.facts())
    if others:
        found.data("other_channels", other_rows(others, asked))
    life = comparison = None
    if site is not None:
        require_winds(paths, hub.statistics.mean_of("wind speed").tolist())
        with steps.step("transients"):
            life = lifetime(hub, site, _events(events, asked, resume, report))
        found.data("lifetime", lifetime_rows(life, asked))
    if others_of:
        with steps.step("the others"):
            for _, one in digests(others_of, asked, resume, "the others", report, reactions):
                its.add(one)
            comparison = compare_sets(mine, its)
        found.answer(*comparison.sentences)
    of_events = [] if life is None else [one.own_speeds for one in life.events]
    _speed_not_used(found, asked, [hub.files.own_speeds, *of_events, its.own_speeds])
    _checks(found, hub)
    return LoadsResult(
        asked=asked,
        hub=hub,
        reactions=of_scene,
        others=others,
        capture=capture,
        lifetime=life,
        comparison=comparison,
        scene_reactions=reactions,
        **found.frozen(
            steps.times,
            level=None if scene is None else level,
            **_options(paths, asked, aim, site, events, others_of),
        ),
    )


def _hub_findings(
    found: Findings,
    hub: LoadTotals,
    options: LoadOptions,
    target: CaptureTarget,
    capture: Capture | None,
) -> None:
    """Answer, cautions and numbers of the hub loads."""
    _answer(found, hub, options)
    if capture is not None:
        found.answer(capture.sentence)
    for sentence in cautions(hub, options):
        found.note(sentence)
    for sentence in winds_not_used(target, capture):
        found.note(sentence)
    for sentence in _aliased(hub):
        found.note(sentence)
    _data(found, hub, options, capture)


def _speed_not_used(
    found: Findings, options: LoadOptions, stated: Sequence[Sequence[Floats]]
) -> None:
    """Note files that state a speed of their own where another one is given."""
    given = None if options.rotor_speed is None else options.rotor_speed * RPM
    if unused := speed_not_used(given, [speeds for own in stated for speeds in own]):
        found.note(unused)


def _added_up(
    files: Sequence[Path],
    options: LoadOptions,
    resume: bool,
    steps: Steps,
    reactions: SceneReactions | None,
    mine: LoadSet | None,
) -> tuple[LoadTotals, dict[str, LoadTotals], dict[str, LoadTotals]]:
    """Totals of hub loads, of each reaction, and of other channels; files are added to `mine`."""
    hub = LoadSums()
    of_scene = {name: LoadSums() for name in (reactions.names if reactions else ())}
    others: dict[str, LoadSums] = {}
    with steps.step("files"):
        for file, one in digests(files, options, resume, "files", steps.report, reactions):
            name = short_name(file, files)
            hub.add(name, one.hub)
            for reaction, sums in of_scene.items():
                sums.add(name, one.reactions[reaction])
            for channel, part in one.others.items():
                others.setdefault(channel, LoadSums()).add(name, part)
            if mine is not None:
                mine.add(one)
    return (
        hub.totals(),
        {name: sums.totals() for name, sums in of_scene.items()},
        {name: sums.totals() for name, sums in others.items()},
    )


def _events(
    transients: Sequence[_Event], options: LoadOptions, resume: bool, report: Progress
) -> list[Event]:
    return [
        event(
            a_year,
            files,
            (one.hub for _, one in digests(files, options, resume, "transients", report)),
        )
        for a_year, files in transients
    ]


def _equivalents(found: LoadTotals, options: LoadOptions) -> dict[str, dict[float, EquivalentLoad]]:
    return {
        name: {slope: found.equivalent_load(name, slope, options) for slope in options.slopes}
        for name in LOADS
    }


def _answer(found: Findings, hub: LoadTotals, options: LoadOptions) -> None:
    """The equivalent tilting moment and torque, with what the residue leaves open."""
    slope, hertz = options.slopes[0], options.frequency
    words = []
    for name in ("My", "Mx"):
        one = hub.equivalent_load(name, slope, options)
        if not one.load:
            continue
        band = None if one.band is None else one.band / 1e3
        quantity = f"equivalent load of {name}, slope {slope:g} [kN m]"
        found.found(quantity, one.load / 1e3, band, (ROTOR_TORQUE,) if name == "Mx" else ())
        words.append(f"{value_with_band(found.answers[-1])} in {name}")
    open_ends = " (± what whole cycles in place of half ones would add)"
    rule = open_ends if options.residue == "half" else ""
    said = (
        f"These loads do the damage of a sine of {hertz:g} Hz with a range of "
        f"{' and '.join(words)} at a slope of {slope:g}{rule}: "
    )
    files = hub.files
    count = len(files.names)
    found.answer(
        f"{said if words else ''}{count} file{'s' * (count > 1)}, {files.samples:,} samples over "
        f"{files.seconds:,.6g} s; {options.counted}."
    )


def _aliased(hub: LoadTotals) -> list[str]:
    """Sentences on files that are sampled too slowly for multiples of their rotor's speed."""
    turning = dict(zip(hub.files.names, hub.statistics.mean_of("rotor speed"), strict=True))
    said = []
    for one in hub.spectra.aliased[:_NAMED]:
        # less a little for round-off
        hertz = float(turning[one.file]) / (2.0 * np.pi) * (1.0 - 1e-6)
        shown = ", ".join(
            f"{n}P appears at {at:.3g} Hz"
            for n, at in zip(MULTIPLES, one.appears_at.tolist(), strict=True)
            if at < hertz * n
        )
        said.append(
            f"{one.file} is sampled every {one.step:g} s, too slowly for its multiples of rotor "
            f"speed: {shown}. What stands there in its spectra is not there in the load; sample "
            "faster."
        )
    return said


def _data(found: Findings, hub: LoadTotals, options: LoadOptions, capture: Capture | None) -> None:
    """Numbers of the hub loads for other programs."""
    overall = hub.statistics.overall
    found.data("statistics", dict(zip(CHANNELS, overall.tolist(), strict=True)))
    if capture is not None:
        found.data(
            "capture",
            {
                "wind": capture.matrix.wind,
                "turbulence": capture.matrix.turbulence,
                "counts": capture.matrix.counts,
                "missing": capture.missing,
            },
        )
    found.data("loops", loop_rows(hub))
    found.data("equivalent_loads", by_slope(hub.equivalent_loads(options), options))
    if options.ultimate:
        about_zero = by_slope(hub.equivalent_loads_about_zero(options), options)
        found.data(
            "equivalent_loads_about_zero",
            {name: row for name, row in about_zero.items() if name in options.ultimate},
        )
    found.data("torque", {row["quantity"]: row["value"] for row in torque_rows(hub)})


def _checks(found: Findings, hub: LoadTotals) -> None:
    for what, classes in (
        ("time at the levels", list(hub.levels.seconds.values())),
        (
            "time in the planes of force and moment",
            [plane.positions for plane in hub.planes.values()],
        ),
    ):
        worst = max(abs(one.amount.sum() / hub.files.seconds - 1.0) for one in classes)
        found.vanishes(
            f"{what}, less that of all samples, as a share",
            worst,
            within=1e-9,
            why="each sample is in one class: rounding of the sums",
            source="number of samples times their step",
            basis="self-consistency",
        )


def _options(
    files: Sequence[Path],
    options: LoadOptions,
    target: CaptureTarget,
    site: Site | None,
    transients: Sequence[_Event],
    against: Sequence[Path],
) -> dict[str, Any]:
    """What was asked for, as plain data."""
    return {
        "files": [path.name for path in files],
        "columns": dict(options.columns),
        "skip": options.skip,
        "slopes": [float(slope) for slope in options.slopes],
        "residue": options.residue,
        "gate": options.gate,
        "rotor_speed": options.rotor_speed,
        "ultimate": dict(options.ultimate),
        "frequency": options.frequency,
        "mapping": options.mapping.content(),
        "also": list(options.also),
        "target": asdict(target),
        "site": None if site is None else asdict(site),
        "transients": [[a_year, [path.name for path in of]] for a_year, of in transients],
        "against": [path.name for path in against],
    }
