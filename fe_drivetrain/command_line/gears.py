"""The command ``gears``: load sharing, load over the face, safety and damage of gears."""

from __future__ import annotations

from pathlib import Path

import typer

from fe_drivetrain.command_line.answer_text import show_outcome
from fe_drivetrain.command_line.gears_request import GearsRequest
from fe_drivetrain.command_line.options import OF_FILES, require_beside, with_options
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.settings import parse_settings
from fe_drivetrain.command_line.showing import Shown
from fe_drivetrain.command_line.terminal import as_typed
from fe_drivetrain.common.jobs import scheduled_by
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain


@with_options(GearsRequest, kept="files that are read are kept: run again with --resume")
def gears_command(context: typer.Context, asked: GearsRequest) -> int:
    """Rate the gears of a drivetrain by ISO 6336, with its own spread of loads.

    Statics over a turn of the rotor give the share of each planet and the load along the face; from
    these follow safety of flanks and roots, and damage over hours, a torque spectrum or files of
    hub loads. Gears without the data are named, and not rated. Levels from formulas to flexible
    shafts are compared. Tables are beside the page as CSV.

    The exit status is 0 if every check passes.
    """
    hold_threads()
    from fe_drivetrain.report.suite.ownership import check_result_folder

    if not asked.loads:
        require_beside(context, OF_FILES, "--loads", "is about files of hub loads")
    check_result_folder(asked.folder)
    drivetrain = read_drivetrain(asked.drivetrain, parse_settings(asked.set_ or ()))
    from fe_drivetrain.command_line.gears_files import write_gears
    from fe_drivetrain.pages.gears import show_gears
    from fe_drivetrain.report.suite.case import Case
    from fe_drivetrain.report.suite.result_folders import run_case
    from fe_drivetrain.studies.gear_ratings import gears, prepared

    options, site = asked.options(), asked.place
    loading = asked.loading()
    with show_steps() as report, scheduled_by(asked.scheduler):
        # before the run: a mistake leaves no trace in a folder of reports
        prepared(drivetrain, asked.torque, options, loading)
        work = Shown(
            lambda run: gears(
                drivetrain,
                asked.torque,
                loading.files,
                site,
                options,
                hub=loading.hub,
                spectrum=loading.spectrum,
                resume=asked.resume,
                report=run.report,
            ),
            show_gears,
            write_gears,
        )
        case = Case(
            f"gears/{Path(asked.drivetrain).stem}",
            f"{drivetrain.title}: ratings of its gears",
            "the user's drivetrain and loads",
            work,
            command=as_typed(),
        )
        results = run_case(case, asked.folder.resolve(), report=report)
    return show_outcome(results, asked.folder / "report.html", work.result)
