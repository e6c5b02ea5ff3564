"""The command ``report``: the dossier of a drivetrain, for who decides."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.answer_text import show_outcome
from fe_drivetrain.command_line.dossier import GROUP, OVERVIEW, make_dossier
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
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import named_scene
from fe_drivetrain.report.suite.ownership import check_result_folder

if TYPE_CHECKING:
    from fe_drivetrain.report.results import Results
    from fe_drivetrain.turbine_loads.histories.sites import Site
    from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap

PRINTED = "printed"


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
    with show_steps() as report:
        results = make_dossier(folder, asked, scene, own, report)
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
