"""What to type next for a project: commands that make evidence which does not count yet."""

from __future__ import annotations

import shlex
from collections.abc import Iterable
from pathlib import Path

from fe_drivetrain.procedure.project import Capture, Comparison, Project
from fe_drivetrain.report.suite.case import Case, all_cases
from fe_drivetrain.report.suite.chosen import SETTING
from fe_drivetrain.studies.drivetrain_transient import EVENT_NAMES
from fe_drivetrain.studies.project_validation import ValidateResult
from fe_drivetrain.studies.transient_histories import OPERATION

_MADE_AGAIN = frozenset({"missing", "edited", "stale", "quick", "of another drivetrain"})
"""States of evidence that a run may change."""

_ON_DRIVETRAINS = (
    "advise",
    "check",
    "gears",
    "life",
    "loads",
    "modes",
    "study",
    "transient",
    "uncertainty",
)
"""Commands on a drivetrain, whose results have its hash."""

_FILES = "outputs/*.outb"
"""Histories in commands to be copied, as in the examples of all commands: a user has others."""

_VALUES = {"offset": ("coupling=1000000", "y=0.001"), "base": ("file=base.csv",)}
"""Values of events that do not happen without them, to be replaced by one's own."""


def ready_commands(result: ValidateResult, path: Path) -> list[str]:
    """Commands to be copied, with all names and paths quoted; the last one validates again.

    Parameters
    ----------
    result : ValidateResult
        How the project stands.
    path : Path
        The project file, as the user named it.

    Returns
    -------
    list of str
        Empty where no run would change anything.
    """
    project = result.project
    reports = path.parent / project.reports
    wanted = _missing(result, path.parent, reports)
    known = all_cases()
    drivetrain = _drivetrain(project, path.parent)
    cases = [known[name] for name in wanted if name in known]
    groups = [
        [case for case in cases if drivetrain and SETTING in case.settings],
        [case for case in cases if not (drivetrain and SETTING in case.settings)],
    ]
    commands = [
        _run(group, project, reports, drivetrain if number == 0 else "")
        for number, group in enumerate(groups)
        if group
    ]
    commands += [
        command
        for name in wanted
        if name not in known
        if (command := _as_it_ran(result, name, drivetrain) or _of_drivetrain(name, path, project))
    ]
    return [*commands, shlex.join(["fe-drivetrain", "validate", str(path)])] if commands else []


def _missing(result: ValidateResult, folder: Path, reports: Path) -> list[str]:
    """Names of results that are to be made: of evidence, and beside files of channels."""
    found = [
        one.link.case
        for state in result.states
        for one in state.evidence
        if one.state in _MADE_AGAIN and not one.counts
    ]
    project = result.project
    given: Iterable[str] = (
        *_files(project.campaign.capture if project.campaign else None),
        *_files(project.comparison),
    )
    for name in given:
        file = folder / name
        if not file.is_file() and reports in file.parents:
            found.append(file.parent.relative_to(reports).as_posix())
    return list(dict.fromkeys(found))


def _files(of: Capture | Comparison | None) -> list[str]:
    if of is None:
        return []
    if isinstance(of, Capture):
        return [of.files.file]
    return [of.measured.file, *([of.computed.file] if of.computed else [])]


def _drivetrain(project: Project, folder: Path) -> str:
    """The drivetrain as a case takes it: a file by its path, or a name of the library."""
    name = project.model.drivetrain if project.model else ""
    return str(folder / name) if name and (folder / name).is_file() else name


def _run(cases: list[Case], project: Project, reports: Path, drivetrain: str) -> str:
    # of one case, --out is its own folder
    out = reports if len(cases) > 1 else reports / cases[0].name
    words = ["fe-drivetrain", "run", "--out", str(out)]
    words += ["--quick"] if "quick" in project.accept else []
    words += ["--set", f"{SETTING}={drivetrain}"] if drivetrain else []
    return shlex.join([*words, *(case.name for case in cases)])


def _as_it_ran(result: ValidateResult, name: str, drivetrain: str) -> str:
    """The command that made results, where it was on the project's drivetrain; empty else.

    It has what no name of results says: files of loads, catalogues, values of an event.
    """
    every = (one for state in result.states for one in state.evidence if one.link.case == name)
    made = next((one.results.environment for one in every if one.results is not None), None)
    words = shlex.split(made.command) if made else []
    if words[:2] != ["fe-drivetrain", name.partition("/")[0]] or drivetrain not in words:
        return ""
    words = [word for word in words if word != "--quick"]
    if OPERATION in words and "--csv" not in words:  # samples are what step 6 compares
        words.append("--csv")
    return shlex.join(words)


def _of_drivetrain(name: str, path: Path, project: Project) -> str:
    """The command whose results a name is of; empty where it is of none on drivetrains."""
    command, _, own = name.partition("/")
    drivetrain = _drivetrain(project, path.parent)
    if not drivetrain or command not in _ON_DRIVETRAINS:
        return ""
    asked: list[str] | None = [drivetrain]
    if command == "loads":
        asked = [_FILES, "--scene", drivetrain]
    elif command == "life":
        asked = [drivetrain, "--loads", _FILES]
    elif command == "transient":
        asked = _in_time(own, drivetrain)
    elif command == "advise":
        asked = [drivetrain, *_quantity(project)]
    if asked is None:
        return ""
    words = ["fe-drivetrain", command, *asked]
    return shlex.join([*words, "--out", str(path.parent / project.reports / name)])


def _in_time(name: str, drivetrain: str) -> list[str] | None:
    """What is asked of a drivetrain in time, by the name of results, as in mine-stop.

    None where that ends with no event.
    """
    event = next((e for one in EVENT_NAMES if name.endswith(e := one.replace("_", "-"))), None)
    if event is None:
        return None
    values = [word for value in _VALUES.get(event, ()) for word in ("--value", value)]
    # samples are what step 6 compares
    histories = ["--loads", _FILES, "--csv"] if event == OPERATION else []
    return [drivetrain, event, *values, *histories]


def _quantity(project: Project) -> list[str]:
    """The quantity and tolerance of advice: the first need whose name is one of the adviser."""
    for need in project.model.needs if project.model else ():
        if " [" not in need.quantity and "." in need.quantity:
            return ["--quantity", need.quantity, "--tolerance", f"{100 * need.tolerance:g}%"]
    return []
