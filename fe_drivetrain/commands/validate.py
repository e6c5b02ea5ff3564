"""The command ``validate``: the six steps of a project as one report that grows with it."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.commands.new_scene import SUFFIXES, write_all
from fe_drivetrain.commands.progress import show_steps
from fe_drivetrain.commands.terminal import FAILED, PASSED, as_typed, guarded, write
from fe_drivetrain.common.errors import InputError

if TYPE_CHECKING:
    from fe_drivetrain.commands.validate_steps import Standing
    from fe_drivetrain.dynamics.tables import Machine
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
            write(sys.stdout, _begun(project))
            return PASSED
        return _validated(project, out)

    raise typer.Exit(guarded(work, "existing files are unchanged"))


def _begun(path: Path) -> str:
    """What a new project is, and what to type next."""
    from fe_drivetrain.commands.validate_commands import ready_commands
    from fe_drivetrain.procedure.project import read_project

    standing = standing_of(read_project(path), path.parent)
    lines = [
        f"{path} has the six steps of the 750 kW reference drivetrain: put in your own.",
        "Its evidence is made, and looked at, by:",
        *(f"  {command}" for command in ready_commands(standing, path)),
        "It stays open where nothing is published: its page says what, step by step.",
    ]
    return "".join(f"{line}\n" for line in lines)


def _validated(path: Path, out: Path | None) -> int:
    from fe_drivetrain.commands.validate_commands import ready_commands
    from fe_drivetrain.commands.validate_page import show_project
    from fe_drivetrain.procedure.iteration_log import log_file
    from fe_drivetrain.procedure.project import read_project
    from fe_drivetrain.procedure.steps import STEPS
    from fe_drivetrain.suite.case import Case
    from fe_drivetrain.suite.ownership import check_result_folder
    from fe_drivetrain.suite.result_folders import run_case

    project = read_project(path)
    reports = path.parent / project.reports
    folder = (reports / "validate" / path.stem if out is None else out).resolve()
    check_result_folder(folder)
    standing = standing_of(project, path.parent)
    log = _logged(standing, log_file(path))
    commands = ready_commands(standing, path)
    case = Case(
        f"validate/{path.stem}",
        f"{project.subject}: from failure modes to comparison",
        "PROTEST 2010, ECN-E--10-100: six steps; Tables 4.1 to 4.10",
        lambda run, page: show_project(page, standing, log, reports.resolve(), folder, commands),
        command=as_typed(),
    )
    with show_steps() as report:
        results = run_case(case, folder, report=report)
    lines = [*results.notes, *([""] if results.notes else []), results.summary[0]]
    for state in standing.states:
        if not state.complete:
            lines += ["", f"Step {state.number}, {STEPS[state.number - 1]}:"]
            lines += [f"  {text}." for text in standing.reasons(state)]
    lines.append("")
    if commands:
        lines += ["Run next:", *(f"  {command}" for command in commands), ""]
    lines += [f"Report: {folder / 'report.html'}"]
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
    from fe_drivetrain.commands.validate_steps import Standing
    from fe_drivetrain.procedure.assessment import Measured, assessed, claims_of
    from fe_drivetrain.procedure.channels import missing_file
    from fe_drivetrain.procedure.evidence import each_for_one, find_evidence, subject_of
    from fe_drivetrain.procedure.failure_modes import protest_catalogue, read_catalogue
    from fe_drivetrain.procedure.measured_channels import (
        Outcome,
        captured,
        compared,
        faults_of_files,
        windows_by_wind,
    )

    catalogue = (
        read_catalogue(folder / project.catalogue) if project.catalogue else protest_catalogue()
    )
    drivetrain = _drivetrain(project, folder)
    subject = None if drivetrain is None else subject_of(drivetrain)
    record = subject.record if subject else None
    evidence = {
        found.claim: found
        for claims in claims_of(project)
        for found in each_for_one(
            find_evidence(claim, folder / project.reports, project.accept, subject)
            for claim in claims
        )
    }
    capture = project.campaign.capture if project.campaign else None
    absent = {5: missing_file(capture.files if capture else None, folder)}
    if comparison := project.comparison:
        files = (comparison.measured, comparison.computed)
        absent[6] = next(filter(None, (missing_file(one, folder) for one in files)), "")
    missing = {step: sentence for step, sentence in absent.items() if sentence}
    matrix = captured(capture, folder) if capture and 5 not in missing else None
    outcome = Outcome()
    faults: tuple[str, ...] = ()
    if comparison and 6 not in missing:
        outcome = compared(comparison, folder)
        faults = faults_of_files(capture, comparison, record.hash if record else "", folder)
    measured = Measured(
        windows_by_wind(matrix) if matrix else None,
        outcome.verdicts,
        missing,
        faults,
        outcome.spreads,
    )
    states = assessed(project, catalogue, evidence, measured)
    return Standing(project, catalogue, states, matrix, measured, record)


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


def _drivetrain(project: Project, folder: Path) -> Scene | Machine | None:
    """The scene or machine that the model is of; None before step 2."""
    from fe_drivetrain.commands.scenes import named_scene
    from fe_drivetrain.dynamics.tables import named_machine

    if project.model is None:
        return None
    name = project.model.scene or project.model.machine
    file = folder / name
    given = str(file) if file.is_file() else name
    return named_scene(given, {}) if project.model.scene else named_machine(given)
