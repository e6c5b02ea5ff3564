"""The command ``report``: the dossier of a drivetrain, for who decides."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fe_drivetrain.command_line.answer_text import show_outcome
from fe_drivetrain.command_line.options import (
    Catalogues,
    LoadFiles,
    RotorSpeed,
    SceneName,
    Skip,
    with_options,
)
from fe_drivetrain.command_line.options import Mapping as ChannelMapping
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.run import Quick
from fe_drivetrain.command_line.settings import SceneSettings, parse_settings
from fe_drivetrain.command_line.showing import Shown
from fe_drivetrain.command_line.terminal import as_typed
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import named_scene
from fe_drivetrain.report.suite.ownership import check_result_folder

if TYPE_CHECKING:
    from fe_drivetrain.drivetrain_file.scene import Scene
    from fe_drivetrain.report.results import Results
    from fe_drivetrain.report.suite.page import Page
    from fe_drivetrain.report.suite.run import Run
    from fe_drivetrain.studies.scene_study import StudyResult
    from fe_drivetrain.studies.study_loads import StudyLoads
    from fe_drivetrain.turbine_loads.histories.sites import Site
    from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap

    Work = Callable[[Run, Page], None]

GROUP, OVERVIEW, PRINTED = "dossier", "overview", "printed"
TOLERANCE = 0.05
"""Within which the cheapest model has to have the first bearing's vertical force."""
TITLES: Mapping[str, str] = {
    OVERVIEW: "Overview",
    "loads": "Loads",
    "reactions": "Reactions",
    "life": "Life",
    "strength": "Shaft strength",
    "modes": "Modes",
    "gears": "Gears",
    "stop": "Emergency stop",
    "model": "Which model",
    "check": "The drivetrain",
    "export": "Export",
}
"""Parts of a dossier as its menu has them."""


@dataclass(frozen=True)
class ReportRequest:
    """Arguments and options of ``report`` as typed; each help text says what one is."""

    scene: SceneName
    loads: LoadFiles
    site: Annotated[
        str | None,
        typer.Option(
            "--site",
            metavar="CLASS",
            help="Weight winds for lives: a class of IEC 61400-1, as in class-II, or a mean wind "
            "speed in m/s.",
        ),
    ] = None
    skip: Skip = 0.0
    mapping: ChannelMapping = None
    rotor_speed: RotorSpeed = None
    catalogue: Catalogues = None
    quick: Quick = False
    pdf: Annotated[
        bool,
        typer.Option(
            "--pdf",
            help="Print the first page as printed/dossier.pdf, too; needs Chromium or Chrome.",
        ),
    ] = False
    png: Annotated[
        bool,
        typer.Option(
            "--png",
            help="Write the charts of the first page as pictures into printed, too, each with "
            "title and source; needs Chromium or Chrome.",
        ),
    ] = False
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Folder. Default: reports/dossiers/SCENE."),
    ] = None
    set_: SceneSettings = None

    @property
    def folder(self) -> Path:
        """The folder of the dossier."""
        return self.out or Path("reports", "dossiers", Path(self.scene).stem)

    @property
    def channels(self) -> ChannelMap | None:
        """How files of other programs call their channels."""
        from fe_drivetrain.turbine_loads.hub_loads.channel_map import read_channel_map

        return None if self.mapping is None else read_channel_map(self.mapping)

    @property
    def place(self) -> Site | None:
        """The site whose winds are weighted; None without one."""
        from fe_drivetrain.command_line.option_values import parse_site

        return None if self.site is None else parse_site(self.site)


@with_options(ReportRequest, kept="pages that are done are kept, and are not made again")
def report_command(context: typer.Context, asked: ReportRequest) -> int:
    """Make the dossier of a drivetrain: loads, reactions, lives, and the model that is enough.

    One folder with a page for each question and a first page that answers all of them. Pages that
    the same program has made of the same drivetrain, files and options are kept; all others are
    made again.

    The exit status is 0 if every check passes.
    """
    hold_threads()
    scene = named_scene(asked.scene, parse_settings(asked.set_ or ()))
    from fe_drivetrain.command_line.printing import browser
    from fe_drivetrain.studies.study_loads import own_loads

    needs_browser = browser() if asked.pdf or asked.png else ""
    own = own_loads(asked.loads, asked.skip, scene, asked.channels)
    folder = asked.folder.resolve()
    if needs_browser:
        check_result_folder(folder / PRINTED)
    from fe_drivetrain.elasticity.compiled_ahead import compiled_ahead

    with show_steps() as report:
        with compiled_ahead("solver", "meridian", "bearing"):
            results = _dossier(folder, asked, scene, own, report)
        if needs_browser:
            _print(needs_browser, folder, asked, results, report)
    shown_page = asked.folder / GROUP / OVERVIEW / "report.html"
    return show_outcome(results, shown_page)


def _print(
    program: str, folder: Path, asked: ReportRequest, results: Results, report: Progress
) -> None:
    """Print the first page into a folder whose other files stay, as those of results do."""
    from fe_drivetrain.command_line.printing import write_pdf, write_pictures
    from fe_drivetrain.report.suite.result_folders import new_folder, put_in_place

    target = folder / PRINTED
    made = new_folder(target)
    try:
        if asked.pdf:
            report("PDF")
            page = folder / GROUP / OVERVIEW / "report.html"
            write_pdf(program, page, made.path / "dossier.pdf")
        if asked.png:
            report("pictures")
            write_pictures(program, results, made.path)
        put_in_place(made, target)
    finally:
        made.discard()


def _dossier(
    folder: Path, asked: ReportRequest, scene: Scene, own: StudyLoads, report: Progress
) -> Results:
    """Make every part that is not kept, and the first page of all; its results."""
    from fe_drivetrain.pages.dossier import show_dossier
    from fe_drivetrain.studies.dossier_overview import dossier

    works = _works(asked, scene, own)
    names = [OVERVIEW, *works]
    content = content_of(asked, scene)
    parts = {
        name: _made(folder, name, names, scene, work, content, asked.quick, report)
        for name, work in works.items()
    }
    of_parts = {**content, "parts": {name: part.digest for name, part in parts.items()}}
    overview = Shown(lambda run: dossier(scene, parts), show_dossier)
    return _made(folder, OVERVIEW, names, scene, overview, of_parts, asked.quick, report)


def content_of(asked: ReportRequest, scene: Scene) -> dict[str, Any]:
    """All that the pages of a dossier depend on beside the program.

    Parameters
    ----------
    asked : ReportRequest
        Names the files.
    scene : Scene
        The drivetrain.

    Returns
    -------
    dict
        Hash of the drivetrain and of the content of its files, SHA-256 of each file of loads by
        path, and the options.
    """
    from fe_drivetrain.common.provenance import file_digest
    from fe_drivetrain.report.seal import content_hash
    from fe_drivetrain.shafts.response.cached import whole_content
    from fe_drivetrain.turbine_loads.hub_loads.recorded import recorded_files
    from fe_drivetrain.turbine_loads.hub_loads.table_kinds import history_digest

    files = {str(path): history_digest(path) for path in recorded_files(asked.loads)}
    beside = [path for path in (asked.mapping, *(asked.catalogue or ())) if path is not None]
    return {
        "drivetrain": content_hash(whole_content(scene)),
        "files": files | {str(path): file_digest(str(path)) for path in beside},
        "site": asked.site or "",
        "skip": asked.skip,
        "rotor speed": asked.rotor_speed or 0.0,
    }


def _works(asked: ReportRequest, scene: Scene, own: StudyLoads) -> dict[str, Work]:
    """What makes each part; a part that says nothing of this drivetrain is left out."""
    from fe_drivetrain.command_line.export_files import write_shaft
    from fe_drivetrain.command_line.life_files import write_life
    from fe_drivetrain.command_line.loads_files import write_loads
    from fe_drivetrain.command_line.study_files import write_study
    from fe_drivetrain.pages.advise import show_advise
    from fe_drivetrain.pages.check import show_check
    from fe_drivetrain.pages.export import show_export
    from fe_drivetrain.pages.life import show_life
    from fe_drivetrain.pages.loads import show_loads
    from fe_drivetrain.pages.study import show_study
    from fe_drivetrain.studies.bearing_lives import life
    from fe_drivetrain.studies.dossier_overview import extremes_of
    from fe_drivetrain.studies.export_content import prepare_export
    from fe_drivetrain.studies.gearbox_bearings import catalogue_entries
    from fe_drivetrain.studies.level_advice import advise
    from fe_drivetrain.studies.life_options import LifeOptions
    from fe_drivetrain.studies.load_digest import LoadOptions
    from fe_drivetrain.studies.load_histories import loads
    from fe_drivetrain.studies.scene_check import check
    from fe_drivetrain.studies.scene_study import study

    channels, rpm = asked.channels, asked.rotor_speed
    catalogues = tuple(asked.catalogue or ())
    first = f"{scene.bearing_names[0]}.Fz"

    def write_reactions(run: Run, page: Page, result: StudyResult) -> None:
        for name, table in extremes_of(result, own.histories).items():
            page.data(name, table)
        write_study(run, page, result, own.histories)

    works: dict[str, Work] = {
        "loads": Shown(
            lambda run: loads(
                asked.loads,
                LoadOptions(skip=asked.skip, channels=channels, rotor_speed_rpm=rpm),
                report=run.report,
            ),
            show_loads,
            write_loads,
        ),
        "reactions": Shown(
            lambda run: study(scene, own, quick=run.quick, report=run.report),
            show_study,
            write_reactions,
            draws=True,
        ),
        "life": Shown(
            lambda run: life(
                scene,
                asked.loads,
                asked.place,
                LifeOptions(
                    skip=asked.skip, catalogues=catalogues, channels=channels, rotor_speed_rpm=rpm
                ),
                report=run.report,
            ),
            show_life,
            write_life,
        ),
        **strength_works(asked, scene),
        **turning_works(asked, scene),
        "model": Shown(lambda run: advise(scene, first, TOLERANCE, report=run.report), show_advise),
        "check": Shown(
            lambda run: check(scene, catalogues, report=run.report), show_check, draws=True
        ),
        "export": Shown(
            lambda run: prepare_export(scene, report=run.report), show_export, write_shaft
        ),
    }
    if not catalogue_entries(scene):
        del works["life"]
    return works


def strength_works(asked: ReportRequest, scene: Scene) -> dict[str, Work]:
    """What makes the part of the main shaft's strength; none where the file states none.

    Parameters
    ----------
    asked : ReportRequest
        Names the files of loads.
    scene : Scene
        The drivetrain.
    """
    from fe_drivetrain.command_line.strength_files import write_strength
    from fe_drivetrain.pages.strength import show_strength
    from fe_drivetrain.studies.shaft_strength import strength
    from fe_drivetrain.studies.strength_options import StrengthOptions

    if scene.strength is None:
        return {}
    options = StrengthOptions(
        skip=asked.skip, channels=asked.channels, rotor_speed_rpm=asked.rotor_speed
    )
    return {
        "strength": Shown(
            lambda run: strength(scene, asked.loads, asked.place, options, report=run.report),
            show_strength,
            write_strength,
        )
    }


def turning_works(asked: ReportRequest, scene: Scene) -> dict[str, Work]:
    """What makes the parts of all that turns; none where the file does not state it.

    Parameters
    ----------
    asked : ReportRequest
        Names the files of loads.
    scene : Scene
        The drivetrain.

    Returns
    -------
    dict
        By name: modes of what has rotor and generator, gears of what has stages, and an emergency
        stop of what has a brake, too.
    """
    from fe_drivetrain.command_line.gears_files import write_gears
    from fe_drivetrain.dynamics import machine_of
    from fe_drivetrain.pages.gears import show_gears
    from fe_drivetrain.pages.modes import show_modes
    from fe_drivetrain.pages.transient import show_transient
    from fe_drivetrain.studies.drivetrain_modes import modes
    from fe_drivetrain.studies.drivetrain_transient import transient
    from fe_drivetrain.studies.gear_options import GearOptions
    from fe_drivetrain.studies.gear_ratings import gears

    if scene.rotor is None or scene.generator is None or machine_of(scene).not_given:
        return {}
    works: dict[str, Work] = {
        "modes": Shown(lambda run: modes(scene, report=run.report), show_modes)
    }
    if not scene.gearbox.stages:
        return works
    options = GearOptions(
        skip=asked.skip, channels=asked.channels, rotor_speed_rpm=asked.rotor_speed
    )
    works["gears"] = Shown(
        lambda run: gears(
            scene, loads=asked.loads, site=asked.place, options=options, report=run.report
        ),
        show_gears,
        write_gears,
    )
    if scene.brake is not None:
        works["stop"] = Shown(
            lambda run: transient(scene, "stop", report=run.report), show_transient
        )
    return works


def _made(
    folder: Path,
    name: str,
    names: Sequence[str],
    scene: Scene,
    work: Work,
    content: Mapping[str, Any],
    quick: bool,
    report: Progress,
) -> Results:
    """Results of one part: those that are kept, if they are of the same content, or made now."""
    from fe_drivetrain.report.results import PageLink, read_results
    from fe_drivetrain.report.suite.case import Case
    from fe_drivetrain.report.suite.result_folders import run_case
    from fe_drivetrain.report.suite.resuming import finished_cases

    links = tuple(
        PageLink(title=TITLES[one], address="" if one == name else f"../{one}/report.html")
        for one in names
    )
    case = Case(
        f"{GROUP}/{name}",
        f"{scene.title}: {TITLES[name].lower()}",
        "the user's drivetrain and files",
        work,
        settings=tuple(content),
        command=as_typed(),
        links=links,
    )
    if finished_cases([case], folder, content, quick):
        return read_results(folder / GROUP / name / "results.json")
    report(TITLES[name])
    return run_case(case, folder / GROUP / name, content, quick, report)
