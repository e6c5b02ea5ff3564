"""The command ``life``: rating life of a drivetrain's rolling bearings under load histories."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import typer

from fe_drivetrain.command_line.answer_text import show_outcome
from fe_drivetrain.command_line.life_request import LifeRequest
from fe_drivetrain.command_line.options import with_options
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.settings import parse_settings
from fe_drivetrain.command_line.showing import Shown
from fe_drivetrain.command_line.terminal import as_typed
from fe_drivetrain.common.jobs import scheduled_by
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain


@with_options(LifeRequest, kept="files that are done are kept: run again with --resume")
def life_command(context: typer.Context, asked: LifeRequest) -> int:
    """Rating life of a drivetrain's bearings under load histories, by ISO 281 and ISO/TS 16281.

    Main bearings are in equilibrium with shaft and rollers at each load step; bearings of the
    gearbox have their loads from statics of the whole drivetrain. The page has the lives L10, L10m,
    L10r and L10mr, the damage by wind speed, row, ring and place of the rollers, and the time in
    which the methods are outside of their range. Tables are beside the page as CSV.

    The exit status is 0 if every check passes.
    """
    hold_threads()
    from fe_drivetrain.report.suite.ownership import check_result_folder

    check_result_folder(asked.folder)
    found = read_drivetrain(asked.scene, parse_settings(asked.set_ or ()))
    from fe_drivetrain.command_line.life_files import SeriesFiles, write_life
    from fe_drivetrain.pages.life import show_life
    from fe_drivetrain.report.suite.case import Case
    from fe_drivetrain.report.suite.result_folders import run_case
    from fe_drivetrain.studies.bearing_lives import DrivetrainBearings, lives_under
    from fe_drivetrain.studies.life_events import check_events
    from fe_drivetrain.turbine_loads.histories.sites import require_several
    from fe_drivetrain.turbine_loads.hub_loads.recorded import recorded_files

    options, place, events = asked.options(context), asked.place, asked.events
    check_events(found, events)
    files = recorded_files(asked.loads)
    require_several(place, len(files))
    series = SeriesFiles(files)
    from fe_drivetrain.elasticity.compiled_ahead import compiled_ahead

    with show_steps() as report, scheduled_by(asked.scheduler), compiled_ahead("bearing"):
        # before the run: a mistake leaves no trace in a folder of reports
        report("bearings")
        drivetrain = DrivetrainBearings(found, options)
        work = Shown(
            lambda run: lives_under(
                drivetrain,
                files,
                place,
                events=events,
                resume=asked.resume,
                each=series.into(run.folder),
                report=run.report,
            ),
            show_life,
            partial(write_life, series=series.written),
        )
        case = Case(
            f"life/{Path(asked.scene).stem}",
            f"{drivetrain.drivetrain.title}: rating life of its bearings",
            "the user's scene and files",
            work,
            command=as_typed(),
        )
        results = run_case(case, asked.folder.resolve(), report=report)
    return show_outcome(results, asked.folder / "report.html", work.result)
