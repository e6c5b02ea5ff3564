"""The command ``loads``: statistics, spectra, cycles, distributions and loops of histories."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import typer

from fe_drivetrain.command_line.answer_text import show_outcome
from fe_drivetrain.command_line.loads_request import LoadsRequest
from fe_drivetrain.command_line.options import with_options
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.showing import Shown
from fe_drivetrain.command_line.terminal import as_typed
from fe_drivetrain.common.jobs import scheduled_by
from fe_drivetrain.common.threads import hold_threads

if TYPE_CHECKING:
    from fe_drivetrain.report.suite.run import Run
    from fe_drivetrain.studies.load_histories import LoadsResult


@with_options(LoadsRequest, kept="files that are done are kept: run again with --resume")
def loads_command(context: typer.Context, asked: LoadsRequest) -> int:
    """Show what is in load histories: statistics, spectra, cycles, time at level, load loops.

    Reads one file after the other in bounded memory. The page has statistics by wind, a capture
    matrix, planes of force and moment, spectra with multiples of the rotor's speed, rainflow
    counts with damage-equivalent loads, load duration and revolution distributions, and load
    loops; all tables stand beside it as CSV. Files may have some of the six components alone:
    what needs the others is left out by name.

    The exit status is 0 if every check passes.
    """
    hold_threads()
    from fe_drivetrain.command_line.loads_files import write_loads
    from fe_drivetrain.command_line.table_files import parquet_writer
    from fe_drivetrain.pages.loads import show_loads
    from fe_drivetrain.report.suite.case import Case
    from fe_drivetrain.report.suite.ownership import check_result_folder
    from fe_drivetrain.report.suite.result_folders import run_case

    check_result_folder(asked.out)
    count, study = _study(context, asked)
    writer = parquet_writer() if asked.parquet else None
    work = Shown(study, show_loads, lambda run, page, of: write_loads(run, page, of, writer))
    case = Case(
        "loads/histories",
        f"Load histories of {count} file{'s' * (count > 1)}",
        "the user's files",
        work,
        command=as_typed(),
    )
    with show_steps() as report, scheduled_by(asked.scheduler):
        results = run_case(case, asked.out.resolve(), report=report)
    return show_outcome(results, asked.out / "report.html", work.result)


def _study(context: typer.Context, asked: LoadsRequest) -> tuple[int, Callable[[Run], LoadsResult]]:
    """How many files there are, and the study that was asked for; every mistake is found here."""
    from fe_drivetrain.command_line.option_values import parse_transients, parse_winds
    from fe_drivetrain.drivetrain_file.named_scenes import named_scene
    from fe_drivetrain.studies.load_histories import loads
    from fe_drivetrain.turbine_loads.hub_loads.recorded import recorded_files

    options, target = asked.options(), parse_winds(asked.winds, asked.target)
    place = asked.place(context)
    events = parse_transients(asked.transient or ())
    level = asked.scene_level(context)
    scene = None if asked.scene is None else named_scene(asked.scene, {})
    files = recorded_files(asked.files)
    others = recorded_files(asked.against or [])

    def study(run: Run) -> LoadsResult:
        return loads(
            files,
            options,
            target,
            site=place,
            transients=events,
            against=others,
            scene=scene,
            level=level,
            resume=asked.resume,
            report=run.report,
        )

    return len(files), study
