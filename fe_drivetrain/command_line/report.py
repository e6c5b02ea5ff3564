"""The command ``report``: the dossier of a drivetrain, for who decides."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from fe_drivetrain.command_line.answer_text import show_outcome
from fe_drivetrain.command_line.dossier import GROUP, OVERVIEW, make_dossier
from fe_drivetrain.command_line.options import with_options
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.report_request import ReportRequest
from fe_drivetrain.command_line.settings import parse_settings
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import named_scene
from fe_drivetrain.report.suite.ownership import check_result_folder

if TYPE_CHECKING:
    from fe_drivetrain.report.results import Results

PRINTED = "printed"


@with_options(ReportRequest, kept="pages that are done are kept, and are not made again")
def report_command(context: typer.Context, asked: ReportRequest) -> int:
    """Make the dossier of a drivetrain: loads, reactions, lives, and the model that is enough.

    One folder with a page for each question and a first page that answers all of them. Pages that
    the same program has made of the same drivetrain, files and options are kept; all others are
    made again, side by side in two processes where there are cores for them.

    The exit status is 0 if every check passes.
    """
    hold_threads()
    scene = named_scene(asked.scene, parse_settings(asked.set_ or ()))
    from fe_drivetrain.command_line.printing import browser
    from fe_drivetrain.studies.study_loads import own_loads
    from fe_drivetrain.turbine_loads.histories.sites import require_several

    needs_browser = browser() if asked.pdf or asked.png else ""
    own = own_loads(asked.loads, asked.skip, scene, asked.channels)
    require_several(asked.place, len(own.histories))
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
