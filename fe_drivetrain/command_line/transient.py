"""The command ``transient``: a drivetrain in time, in an event or in operation."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from fe_drivetrain.command_line.answer_text import show_outcome
from fe_drivetrain.command_line.options import require_beside, with_options
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.settings import parse_settings, parse_tolerance
from fe_drivetrain.command_line.showing import Shown
from fe_drivetrain.command_line.terminal import as_typed
from fe_drivetrain.command_line.transient_request import TransientRequest
from fe_drivetrain.common.jobs import scheduled_by
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain

if TYPE_CHECKING:
    from fe_drivetrain.report.suite.page import Page
    from fe_drivetrain.report.suite.run import Run
    from fe_drivetrain.studies.transient_result import TransientResult

_OF_HISTORIES = {
    "channel": "--channel",
    "mapping": "--mapping",
    "skip": "--skip",
    "slope": "--slope",
    "resume": "--resume",
    "scheduler": "--scheduler",
    "site": "--site",
}


@with_options(TransientRequest, kept="files that are done are kept: run again with --resume")
def transient_command(context: typer.Context, asked: TransientRequest) -> int:
    """Torque, speeds, forces of meshes and bearings of a drivetrain in time.

    Stops it with its brake, takes its grid away, lets the voltage dip, runs it up through its
    resonances, moves its generator out of line or its base, or drives it by histories of hub loads:
    torsional, as rigid bodies and with flexible shafts; the cheapest level that is enough is
    reported. Each event begins from steady turning under rated torque.

    The exit status is 0 if every check passes.
    """
    hold_threads()
    from fe_drivetrain.pages.transient import show_transient
    from fe_drivetrain.report.suite.case import Case
    from fe_drivetrain.report.suite.ownership import check_result_folder
    from fe_drivetrain.report.suite.result_folders import run_case
    from fe_drivetrain.studies.drivetrain_transient import transient

    event, values, share = asked.name, asked.values, parse_tolerance(asked.tolerance)
    if not asked.loads:
        require_beside(context, _OF_HISTORIES, "--loads", "is about histories of operation")
    check_result_folder(asked.folder)
    drivetrain = read_drivetrain(asked.drivetrain, parse_settings(asked.set_ or ()))
    options, damage = asked.options(), asked.damage()
    work = Shown(
        lambda run: transient(
            drivetrain,
            event,
            values,
            loads=asked.loads or (),
            level=asked.level,
            condensed=asked.condensed,
            matrices=asked.matrices,
            rollers=asked.on_rollers,
            quantity=asked.quantity,  # type: ignore[arg-type]
            tolerance=share,
            duration=asked.duration,
            step=asked.step,
            backlash=asked.backlash,
            planets=asked.planets,
            options=options,
            resume=asked.resume,
            damage=damage,
            report=run.report,
        ),
        show_transient,
        _write_samples if asked.csv else None,
    )
    case = Case(
        f"transient/{asked.folder.name}",
        f"{drivetrain.title}: {asked.event.replace('-', ' ')}",
        "the user's drivetrain",
        work,
        command=as_typed(),
    )
    with show_steps() as report, scheduled_by(asked.scheduler):
        results = run_case(case, asked.folder.resolve(), report=report)
    return show_outcome(results, asked.folder / "report.html", work.result)


def _write_samples(run: Run, page: Page, result: TransientResult) -> None:
    """Write all channels over time beside the page."""
    from fe_drivetrain.common.csv_cells import SafeWriter

    samples = result.samples
    with (run.folder / "samples.csv").open("w", encoding="utf-8", newline="") as file:
        writer = SafeWriter(file)
        names = zip(samples.names, samples.units, strict=True)
        writer.writerow(["time [s]", *(f"{name} [{unit}]" for name, unit in names)])
        for time, row in zip(samples.times.tolist(), samples.values.tolist(), strict=True):
            writer.writerow([f"{time:.9g}", *(f"{value:.7g}" for value in row)])
    page.section("Files")
    page.text("samples.csv beside this page has all channels over time.")
