"""The command ``validate``: the six steps of a project as one report that grows with it."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.commands.new_scene import SUFFIXES, write_all
from fe_drivetrain.commands.progress import show_steps
from fe_drivetrain.commands.terminal import FAILED, PASSED, as_typed, guarded, write
from fe_drivetrain.common.errors import InputError

if TYPE_CHECKING:
    from fe_drivetrain.commands.validate_page import Standing
    from fe_drivetrain.procedure.iteration_log import Entry
    from fe_drivetrain.procedure.project import Project
    from fe_drivetrain.scene.scene import Scene


def validate_command(
    project: Annotated[
        Path, typer.Argument(metavar="PROJECT", help="A project file, as in project.yaml.")
    ],
    new: Annotated[
        bool,
        typer.Option(
            "--new", help="Write a project to start from, with its schema for editors, and exit."
        ),
    ] = False,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="With --new: replace existing files.")
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="DIR",
            help="Result folder. Default: validate/PROJECT in the project's folder of reports.",
        ),
    ] = None,
) -> None:
    """Validate a model in the six steps of PROTEST 2010: one report, from failure modes on.

    The project file has the decisions of each step, and links the cases that they rest on. The
    report shows their verdicts, bands, dates and versions, names what is stale, and states what
    each step still lacks. What has changed since the last run is added to PROJECT.log.jsonl.

    The exit status is 0 if all six steps are complete, 1 if not, 2 for a faulty file.
    """

    def work() -> int:
        if project.suffix.lower() not in SUFFIXES:
            raise InputError(
                f"{project} must end in {' or '.join(SUFFIXES)}: name it as in project.yaml"
            )
        if new:
            from fe_drivetrain.procedure.project import (
                PROJECT_SCHEMA_FILE,
                project_schema,
                starting_project,
            )

            texts = {
                project: starting_project(),
                project.with_name(PROJECT_SCHEMA_FILE): project_schema(),
            }
            write_all(texts, overwrite)
            write(
                sys.stdout, f"Edit it, then: fe-drivetrain validate {shlex.quote(str(project))}\n"
            )
            return PASSED
        return _validated(project, out)

    raise typer.Exit(guarded(work, "existing files are unchanged"))


def _validated(path: Path, out: Path | None) -> int:
    from fe_drivetrain.commands.validate_page import show_project
    from fe_drivetrain.procedure.iteration_log import log_file
    from fe_drivetrain.procedure.project import read_project
    from fe_drivetrain.suite.case import Case
    from fe_drivetrain.suite.ownership import check_result_folder
    from fe_drivetrain.suite.result_folders import run_case

    project = read_project(path)
    reports = path.parent / project.reports
    folder = (reports / "validate" / path.stem if out is None else out).resolve()
    check_result_folder(folder)
    standing = standing_of(project, path.parent)
    log = _logged(standing, log_file(path))
    case = Case(
        f"validate/{path.stem}",
        f"{project.subject}: from failure modes to comparison",
        "PROTEST 2010, ECN-E--10-100: six steps; Tables 4.1 to 4.10",
        lambda run, page: show_project(page, standing, log, reports.resolve(), folder),
        command=as_typed(),
    )
    with show_steps() as report:
        results = run_case(case, folder, report=report)
    lines = [*results.summary, "", f"Report: {folder / 'report.html'}"]
    write(sys.stdout, "".join(f"{line}\n" for line in lines))
    return PASSED if results.passed else FAILED


def standing_of(project: Project, folder: Path) -> Standing:
    """How a project stands.

    Parameters
    ----------
    project : Project
        As read.
    folder : Path
        What names of files and the folder of reports are relative to.

    Returns
    -------
    Standing

    Raises
    ------
    InputError
        A file that the project names is faulty.
    """
    from fe_drivetrain.commands.validate_page import Standing
    from fe_drivetrain.procedure.assessment import Measured, assessed, links_of
    from fe_drivetrain.procedure.channels import missing_file
    from fe_drivetrain.procedure.evidence import find_evidence
    from fe_drivetrain.procedure.failure_modes import protest_catalogue, read_catalogue
    from fe_drivetrain.procedure.measured_channels import captured, compared, windows_by_wind

    catalogue = (
        read_catalogue(folder / project.catalogue) if project.catalogue else protest_catalogue()
    )
    scene = _scene(project, folder)
    evidence = {
        link: find_evidence(link, folder / project.reports, project.accept, scene)
        for links in links_of(project)
        for link in links
    }
    capture = project.campaign.capture if project.campaign else None
    absent = {5: missing_file(capture.files if capture else None, folder)}
    if comparison := project.comparison:
        files = (comparison.measured, comparison.computed)
        absent[6] = next(filter(None, (missing_file(one, folder) for one in files)), "")
    missing = {step: sentence for step, sentence in absent.items() if sentence}
    matrix = captured(capture, folder) if capture and 5 not in missing else None
    measured = Measured(
        windows_by_wind(matrix) if matrix else None,
        compared(comparison, folder) if comparison and 6 not in missing else (),
        missing,
    )
    states = assessed(project, catalogue, evidence, measured)
    return Standing(project, catalogue, states, matrix, measured.verdicts)


def _logged(standing: Standing, file: Path) -> tuple[Entry, ...]:
    """The log, with what this run adds to it."""
    from datetime import UTC, datetime
    from importlib.metadata import version

    from fe_drivetrain.common.made_by import program_hash
    from fe_drivetrain.procedure.iteration_log import next_entry, read_log, write_log

    log = read_log(file)
    now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")
    made_by = f"{version('fe-drivetrain')} {program_hash()[:8]}"
    entry = next_entry(log, standing.project, standing.states, now, made_by)
    if entry is not None:
        log = (*log, entry)
        write_log(file, log)
    return log


def _scene(project: Project, folder: Path) -> Scene | None:
    """The scene that the model is of; None of a machine, or before step 2."""
    from fe_drivetrain.commands.scenes import named_scene

    name = project.model.scene if project.model else ""
    if not name:
        return None
    file = folder / name
    return named_scene(str(file) if file.is_file() else name, {})
