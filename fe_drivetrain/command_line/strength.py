"""The command ``strength``: static and fatigue safety of the main shaft and its joints."""

from __future__ import annotations

from pathlib import Path

import typer

from fe_drivetrain.command_line.answer_text import show_outcome
from fe_drivetrain.command_line.options import OF_FILES, require_beside, with_options
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.settings import parse_settings
from fe_drivetrain.command_line.showing import Shown
from fe_drivetrain.command_line.strength_request import StrengthRequest
from fe_drivetrain.command_line.terminal import as_typed
from fe_drivetrain.common.jobs import scheduled_by
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain


@with_options(StrengthRequest, kept="files that are read are kept: run again with --resume")
def strength_command(context: typer.Context, asked: StrengthRequest) -> int:
    """Assess the main shaft by DIN 743 under load histories, and its flange and press fits.

    Internal forces of every section come from the shaft on its bearings; stress at fillets from
    elasticity, with bands. Each point of the turning shaft is counted by rainflow, mean stress
    included, and damage adds up over the life. Sections whose notch the file does not state are
    named. Tables are beside the page as CSV.

    The exit status is 0 if every check passes.
    """
    hold_threads()
    from fe_drivetrain.report.suite.ownership import check_result_folder

    if not asked.loads:
        require_beside(context, OF_FILES, "--loads", "is about files of hub loads")
    check_result_folder(asked.folder)
    scene = read_drivetrain(asked.scene, parse_settings(asked.set_ or ()))
    from fe_drivetrain.command_line.strength_files import write_strength
    from fe_drivetrain.pages.strength import show_strength
    from fe_drivetrain.report.suite.case import Case
    from fe_drivetrain.report.suite.result_folders import run_case
    from fe_drivetrain.studies.shaft_strength import checked, strength

    options, loading = asked.options(), asked.loading()
    with show_steps() as report, scheduled_by(asked.scheduler):
        # before the run: a mistake leaves no trace in a folder of reports
        checked(scene, options, loading)
        work = Shown(
            lambda run: strength(
                scene,
                loading.files,
                loading.site,
                options,
                hub=loading.hub,
                spectrum=loading.spectrum,
                resume=asked.resume,
                report=run.report,
            ),
            show_strength,
            write_strength,
        )
        case = Case(
            f"strength/{Path(asked.scene).stem}",
            f"{scene.title}: strength of its main shaft",
            "the user's drivetrain and loads",
            work,
            command=as_typed(),
        )
        results = run_case(case, asked.folder.resolve(), report=report)
    return show_outcome(results, asked.folder / "report.html", work.result)
