"""The command ``validate``: the six steps of a project as one report that grows with it."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.answer_text import show_outcome, write_json
from fe_drivetrain.command_line.new_scene import SUFFIXES, write_all
from fe_drivetrain.command_line.output_options import wants_json
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.terminal import PASSED, as_typed, guarded, write
from fe_drivetrain.common.errors import InputError

if TYPE_CHECKING:
    from fe_drivetrain.procedure.iteration_log import Entry
    from fe_drivetrain.studies.project_validation import ValidateResult


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
    drivetrain: Annotated[
        str | None,
        typer.Option(
            "--drivetrain",
            metavar="FILE",
            help="With --new: the project's drivetrain, a file or a name of the library; its "
            "evidence is then that of commands on it.",
        ),
    ] = None,
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
            _write_new(project, drivetrain, overwrite)
            return PASSED
        if drivetrain is not None:
            raise InputError(
                f"--drivetrain {drivetrain} is for --new: an existing project names its drivetrain "
                "under model"
            )
        return _validated(project, out)

    raise typer.Exit(guarded(work, "existing files are unchanged"))


def _write_new(path: Path, drivetrain: str | None, overwrite: bool) -> None:
    """Write a project to start from, of a drivetrain or of the example, and say what is next."""
    from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
    from fe_drivetrain.procedure.project import (
        PROJECT_SCHEMA_FILE,
        project_schema,
        starting_project,
    )

    if drivetrain is None:
        text, whose = starting_project(), "the 750 kW reference drivetrain: put in your own"
    else:
        found = read_drivetrain(drivetrain)
        text = starting_project(found, _seen_from(path.parent, drivetrain))
        whose = f"{found.title!r}: decide, and state your limits"
    write_all({path: text, path.with_name(PROJECT_SCHEMA_FILE): project_schema()}, overwrite)
    if wants_json():
        write_json({"file": str(path)})
    else:
        write(sys.stdout, _begun(path, whose))


def _seen_from(folder: Path, name: str) -> str:
    """A drivetrain's file relative to the project's folder; a name of the library as it is."""
    if not Path(name).is_file():
        return name
    return Path(os.path.relpath(Path(name).resolve(), folder.resolve())).as_posix()


def _begun(path: Path, whose: str) -> str:
    """What a new project is, and what to type next."""
    from fe_drivetrain.command_line.validate_commands import ready_commands
    from fe_drivetrain.procedure.project import read_project
    from fe_drivetrain.studies.project_validation import validate

    result = validate(read_project(path), path.parent)
    lines = [
        f"{path} has the six steps of {whose}.",
        "Its evidence is made, and looked at, by:",
        *(f"  {command}" for command in ready_commands(result, path)),
        "It stays open where a value, a limit or a measurement is missing: its page says what.",
    ]
    return "".join(f"{line}\n" for line in lines)


def _validated(path: Path, out: Path | None) -> int:
    from fe_drivetrain.command_line.showing import Shown
    from fe_drivetrain.command_line.validate_commands import ready_commands
    from fe_drivetrain.pages.validate import show_validate
    from fe_drivetrain.procedure.iteration_log import log_file
    from fe_drivetrain.procedure.project import read_project
    from fe_drivetrain.report.suite.case import Case
    from fe_drivetrain.report.suite.ownership import check_result_folder
    from fe_drivetrain.report.suite.result_folders import run_case
    from fe_drivetrain.studies.project_validation import validate

    project = read_project(path)
    reports = path.parent / project.reports
    folder = (reports / "validate" / path.stem if out is None else out).resolve()
    check_result_folder(folder)
    found = validate(project, path.parent)
    result = replace(
        found,
        log=_logged(found, log_file(path)),
        commands=tuple(ready_commands(found, path)),
    )
    work = Shown(lambda run: result, show_validate)
    case = Case(
        f"validate/{path.stem}",
        f"{project.subject}: from failure modes to comparison",
        "PROTEST 2010, ECN-E--10-100: six steps; Tables 4.1 to 4.10",
        work,
        command=as_typed(),
    )
    with show_steps() as report:
        results = run_case(case, folder, report=report)
    return show_outcome(results, folder / "report.html", work.result, _what_is_open(result))


def _what_is_open(result: ValidateResult) -> list[str]:
    """Why each step is open, and what to type next."""
    from fe_drivetrain.procedure.steps import STEPS
    from fe_drivetrain.studies.project_validation import reasons

    lines = []
    for state in result.states:
        if not state.complete:
            lines += ["", f"Step {state.number}, {STEPS[state.number - 1]}:"]
            lines += [f"  {text}." for text in reasons(state)]
    if result.commands:
        lines += ["", "Run next:", *(f"  {command}" for command in result.commands)]
    return [*lines, ""] if lines else []


def _logged(result: ValidateResult, file: Path) -> tuple[Entry, ...]:
    """The log, with what this run adds to it."""
    from datetime import UTC, datetime
    from importlib.metadata import version

    from fe_drivetrain.common.provenance import program_hash
    from fe_drivetrain.procedure.iteration_log import next_entry, read_log, write_log

    log = read_log(file)
    now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")
    made_by = f"{version('fe-drivetrain')} {program_hash()[:8]}"
    entry = next_entry(log, result.project, result.states, now, made_by)
    if entry is not None:
        log = (*log, entry)
        write_log(file, log)
    return log
